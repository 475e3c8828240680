//! `tankops new-vehicle`: creates a folder with an adapter that runs at once against its own small robot, from the files
//! of `console/adapters`.

use crate::{
    cli::{NewVehicleArgs, VehicleLang},
    new_planner::{check_name, write_folder},
};
use flight::failure::{COMPLETE, bad_input};
use report::print::say;
use std::{path::Path, process::ExitCode};

const PYTHON: &str = include_str!("../../adapters/python/adapter.py");
const RUST: &str = include_str!("../../adapters/rust/src/main.rs");
const CARGO: &str = include_str!("../../adapters/rust/Cargo.toml");
const SCENARIO: &str = include_str!("../../adapters/new/scenario.toml");

/// Runs `tankops new-vehicle`.
pub(crate) fn create(args: &NewVehicleArgs) -> anyhow::Result<ExitCode> {
    check_name("vehicle", &args.name).map_err(bad_input)?;
    let folder = args.out.join(&args.name);
    write_folder(&folder, files(&args.name, args.lang))?;
    say(&next_steps(&folder, &args.name, args.lang))?;
    Ok(ExitCode::from(COMPLETE))
}

/// The files of a new adapter with their names.
fn files(name: &str, lang: VehicleLang) -> Vec<(String, String)> {
    let mut files = match lang {
        VehicleLang::Python => {
            let adapter = PYTHON.replace("\"name\": \"disc\"", &format!("\"name\": \"{name}\""));
            vec![("adapter.py".into(), adapter)]
        }
        VehicleLang::Rust => {
            let adapter = RUST
                .replace("\"name\": \"disc\"", &format!("\"name\": \"{name}\""))
                .replace("target/release/disc", &format!("target/release/{name}"));
            // The new folder is a workspace of its own, wherever it is.
            let cargo = CARGO.replace("\"disc\"", &format!("\"{name}\"")) + "\n[workspace]\n";
            vec![
                ("Cargo.toml".into(), cargo),
                ("src/main.rs".into(), adapter),
                (".gitignore".into(), "/target\n".into()),
            ]
        }
    };
    files.push(("scenario.toml".into(), SCENARIO.into()));
    files
}

fn next_steps(folder: &Path, name: &str, lang: VehicleLang) -> String {
    let (build, command) = match lang {
        VehicleLang::Python => (String::new(), "python3 adapter.py".to_owned()),
        VehicleLang::Rust => ("    cargo build --release\n".to_owned(), format!("target/release/{name}")),
    };
    format!(
        "created {folder} with an adapter and its own small robot; try the robot, first without moving it, then drive \
         it:\n\n    cd {folder}\n{build}    tankops check --vehicle \"run:{command}\"\n    tankops check --vehicle \
         \"run:{command}\" --drive\n    tankops console scenario.toml --vehicle \"run:{command}\"\n\nThen replace `Disc` \
         with your robot. Guide: connect-a-robot.md\n",
        folder = folder.display(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vehicle_has_its_own_name() {
        for (lang, adapter) in [(VehicleLang::Python, "adapter.py"), (VehicleLang::Rust, "src/main.rs")] {
            let files = files("my-own", lang);
            assert!(files.iter().any(|(name, _)| name == "scenario.toml"));
            let (_, text) = files.iter().find(|(name, _)| name == adapter).unwrap();
            assert!(text.contains("\"name\": \"my-own\""));
            assert!(
                files.iter().all(|(_, text)| !text.contains("\"disc\"") && !text.contains("release/disc"))
            );
        }
    }

    #[test]
    fn the_first_drive_fits_the_robot() {
        let scenario = scenario::Scenario::parse(SCENARIO, "scenario.toml").unwrap();
        assert!(scenario.vehicle.without_ranges && scenario.vehicle.without_contact);
    }
}
