//! `tankops new-planner`: creates a folder with a planner that is ready to build and run, from the files of
//! `plugins/examples`.

use crate::cli::{Lang, NewPlannerArgs};
use anyhow::Context;
use flight::failure::{COMPLETE, bad_input};
use report::print::say;
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::ExitCode,
};
use toml_edit::Value;

const CARGO: &str = include_str!("../../../plugins/examples/straight/Cargo.toml");
const RUST: &str = include_str!("../../../plugins/examples/straight/src/lib.rs");
const C: &str = include_str!("../../../plugins/examples/direct-c/direct.c");
const C_MAKE: &str = include_str!("../../../plugins/examples/direct-c/Makefile");
const CPP: &str = include_str!("../../../plugins/examples/direct-cpp/direct.cpp");
const CPP_MAKE: &str = include_str!("../../../plugins/examples/direct-cpp/Makefile");
const HEADER: &str = include_str!("../../../plugins/planner-api/include/tankops_planner.h");
const SCENARIO: &str = include_str!("../../../plugins/examples/scenario.toml");

/// Runs `tankops new-planner`.
pub(crate) fn create(args: &NewPlannerArgs) -> anyhow::Result<ExitCode> {
    check_name("planner", &args.name).map_err(bad_input)?;
    let folder = args.out.join(&args.name);
    write_folder(&folder, files(&args.name, args.lang, &api(args.api.as_deref())?))?;
    say(&next_steps(&folder, &args.name, args.lang))?;
    Ok(ExitCode::from(COMPLETE))
}

/// Writes files, named from the folder, into a folder that does not exist yet.
pub(crate) fn write_folder(folder: &Path, files: Vec<(String, String)>) -> anyhow::Result<()> {
    if let Ok(there) = folder.symlink_metadata() {
        let what = if there.is_symlink() && !folder.exists() {
            "is a link to a folder that does not exist; remove the link or choose another name"
        } else {
            "already exists and is not overwritten; choose another name"
        };
        return Err(bad_input(format!("{} {what}", folder.display())));
    }
    for (name, text) in files {
        let file = folder.join(name);
        fs::create_dir_all(file.parent().unwrap_or(folder))
            .and_then(|()| fs::write(&file, text))
            .with_context(|| format!("writing {}", file.display()))?;
    }
    Ok(())
}

/// Checks the name of a planner or a vehicle; `kind` is the word for it in the message.
pub(crate) fn check_name(kind: &str, name: &str) -> Result<(), String> {
    let is_of_id = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_' || c == '-';
    let is_good = name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(is_of_id);
    if is_good && name.len() <= 32 {
        return Ok(());
    }
    Err(format!("`{name}` is not a valid {kind} name: write a letter, then up to 31 of a-z, 0-9, _ and -"))
}

/// The dependency entry in `Cargo.toml` for the crate that a Rust planner needs.
fn api(given: Option<&Path>) -> anyhow::Result<String> {
    let is_there = |folder: &PathBuf| folder.join("Cargo.toml").is_file();
    if let Some(missing) = given.map(Path::to_owned).filter(|folder| !is_there(folder)) {
        return Err(bad_input(format!("--api {}: has no Cargo.toml", missing.display())));
    }
    let program = env::current_exe().ok();
    let installed =
        program.as_deref().and_then(Path::parent).map(|bin| bin.join("../share/tankops/planner-api"));
    let of_build = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plugins/planner-api");
    let places = given.map(Path::to_owned).into_iter().chain(installed).chain([of_build]);
    Ok(match places.filter(is_there).find_map(|folder| folder.canonicalize().ok()) {
        Some(folder) => format!("{{ path = {} }}", Value::from(folder.display().to_string())),
        None => format!("\"{}\"", env!("CARGO_PKG_VERSION")),
    })
}

/// The files of a new planner with their names.
fn files(id: &str, lang: Lang, api: &str) -> Vec<(String, String)> {
    let library = library_name(id);
    let scenario = SCENARIO.replace("\"straight\"", &format!("\"{id}\""));
    let made = |make: &str| make.replace("NAME = direct", &format!("NAME = {library}"));
    let mut files = match lang {
        Lang::Rust => {
            let cargo = CARGO
                .replace("\"straight\"", &format!("\"{id}\""))
                .replace("planner_straight", &format!("planner_{library}"))
                .replace("{ path = \"../../planner-api\" }", api);
            // The new folder is a workspace of its own, wherever it is, and crashes of its planner show source lines in
            // a debugger.
            let profile = "[profile.release]\n# Lets `tankops replay-worker --gdb` show the source lines of a \
                           crash.\ndebug = \"line-tables-only\"\n";
            let cargo = format!("{cargo}\n{profile}\n[workspace]\n");
            vec![
                ("Cargo.toml".into(), cargo),
                ("src/lib.rs".into(), RUST.into()),
                (".gitignore".into(), "/target\n".into()),
            ]
        }
        Lang::C => {
            vec![(format!("{library}.c"), C.replace("direct-c", id)), ("Makefile".into(), made(C_MAKE))]
        }
        Lang::Cpp => {
            vec![
                (format!("{library}.cpp"), CPP.replace("direct-cpp", id)),
                ("Makefile".into(), made(CPP_MAKE)),
            ]
        }
    };
    if lang != Lang::Rust {
        files.extend([("tankops_planner.h".into(), HEADER.into()), (".gitignore".into(), "*.so\n".into())]);
    }
    files.push(("scenario.toml".into(), scenario));
    files
}

fn library_name(id: &str) -> String {
    id.replace('-', "_")
}

fn next_steps(folder: &Path, id: &str, lang: Lang) -> String {
    let (build, built) = match lang {
        Lang::Rust => ("cargo build --release", "target/release"),
        Lang::C | Lang::Cpp => ("make", "."),
    };
    format!(
        "created {folder}; build the planner, run it, and compare it with the other planners in random \
         tanks:\n\n    cd {folder}\n    {build}\n    tankops run scenario.toml --plugin-dir {built}\n    \
         tankops check {built}/libplanner_{library}.so --fly 10\n",
        folder = folder.display(),
        library = library_name(id),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_keeps_the_name_of_the_example() {
        for (lang, example) in [(Lang::Rust, "straight"), (Lang::C, "direct-c"), (Lang::Cpp, "direct-c")] {
            for (name, text) in files("my-own", lang, "\"0.1.0\"") {
                assert!(!text.contains(example) && !name.contains(example), "{name}: {text}");
            }
        }
    }

    #[test]
    fn a_name_that_is_none_is_refused() {
        for bad in ["", "1st", "Mine", "a b", "../x", &"x".repeat(33)] {
            assert!(check_name("planner", bad).is_err(), "{bad}");
        }
        assert_eq!(check_name("planner", "my-own_2"), Ok(()));
    }

    #[test]
    fn the_guide_shows_the_example() {
        let guide = include_str!("../../docs/planner-guide.md");
        assert!(
            guide.contains(&format!("```rust\n{RUST}```\n")),
            "console/docs/planner-guide.md shows other code"
        );
    }
}
