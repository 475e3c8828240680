//! The author of a planner, who has only `tankops` and a compiler.

use crate::bench::{Bench, Ended, journal_text, workspace};
use std::{
    path::{Path, PathBuf},
    process::Command,
    sync::Mutex,
};

/// A new planner, and the file produced by building it as in the guide.
fn built(bench: &Bench, lang: &str) -> PathBuf {
    let created = bench.tankops(&["new-planner", "my-own", "--lang", lang]);
    assert_eq!(created.code, Some(0), "{created:?}");
    let folder = bench.path().join("my-own");
    if lang == "rust" {
        // The versions that were tested; the machine may be offline.
        std::fs::copy(workspace().join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
        return built_in_rust(bench);
    }
    let built = Command::new("make").arg("-s").current_dir(&folder).output().unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    folder.join("libplanner_my_own.so")
}

/// Builds the planner in Rust, in a folder that all tests share, because its dependencies take long to build. Only
/// one test builds at a time, and each gets its own copy of the result.
fn built_in_rust(bench: &Bench) -> PathBuf {
    static BUILDING: Mutex<()> = Mutex::new(());
    let _one_at_a_time = BUILDING.lock().unwrap();
    // Cargo treats the planners of all tests as one crate and compares only times: a source older than the output of
    // a different test would count as already built.
    let source = bench.path().join("my-own/src/lib.rs");
    std::fs::write(&source, std::fs::read(&source).unwrap()).unwrap();
    let made = Command::new(env!("CARGO"))
        .args(["build", "--release", "--offline"])
        .current_dir(bench.path().join("my-own"))
        .env("CARGO_TARGET_DIR", author_target())
        .env_remove("RUSTFLAGS")
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let own = bench.path().join("built");
    std::fs::create_dir_all(&own).unwrap();
    let name = "libplanner_my_own.so";
    std::fs::copy(author_target().join("release").join(name), own.join(name)).unwrap();
    own.join(name)
}

/// Built once for all runs of this test.
fn author_target() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("author")
}

fn fly_first(bench: &Bench, plugin: &Path) -> Ended {
    let folder = plugin.parent().unwrap().to_str().unwrap();
    let scenario = bench.path().join("my-own/scenario.toml");
    bench.fly(&scenario, &["--plugin-dir", folder])
}

#[test]
fn a_new_planner_in_each_language_builds_and_flies_at_once() {
    for lang in ["c", "cpp", "rust"] {
        let bench = Bench::new();
        let plugin = built(&bench, lang);
        let flown = fly_first(&bench, &plugin);
        assert_eq!(
            (flown.code, flown.json()["planner"].as_str()),
            (Some(0), Some("my-own")),
            "{lang}: {flown:?}"
        );
        bench.prove_with(&bench.runs()[0], &["--plugin-dir", plugin.parent().unwrap().to_str().unwrap()]);
    }
}

#[test]
fn a_new_planner_is_never_written_over_another() {
    let bench = Bench::new();
    bench.file("my-own", "precious");
    let refused = bench.tankops(&["new-planner", "my-own"]);
    assert!(refused.code == Some(2) && refused.err.contains("already exists"), "{refused:?}");
}

#[test]
fn a_planner_is_checked_and_flown_beside_others() {
    for lang in ["c", "rust"] {
        let bench = Bench::new();
        let plugin = built(&bench, lang);
        let tried = bench.tankops(&["check", plugin.to_str().unwrap(), "--fly", "2", "--json"]);
        let trial = &tried.json()[0];
        assert_eq!((tried.code, trial["planner"].as_str()), (Some(0), Some("my-own")), "{tried:?}");
        assert!(
            trial["checks"].as_array().unwrap().iter().all(|check| check["failure"].is_null()),
            "{trial}"
        );
        let rows: Vec<&str> =
            trial["rows"].as_array().unwrap().iter().map(|row| row["planner"].as_str().unwrap()).collect();
        assert!(rows[0] == "my-own" && rows.contains(&"navfn"), "{rows:?}");
        assert!(trial["rows"][0]["tanks"] == 2, "{trial}");
        assert!(trial["rows"][0]["memory_mb"].as_f64().is_some_and(|mb| mb > 1.0), "{trial}");
    }
}

#[test]
fn a_planner_that_breaks_a_rule_fails_its_checks() {
    let bench = Bench::new();
    let plugin = built(&bench, "c");
    let source = bench.path().join("my-own/my_own.c");
    let good = std::fs::read_to_string(&source).unwrap();
    let checked = |what: &str, by: &str| {
        std::fs::write(&source, good.replacen(what, by, 1)).unwrap();
        let plugin = rebuilt(&plugin);
        bench.tankops(&["check", plugin.to_str().unwrap(), "--fly", "1"])
    };
    let with = |by: &str| {
        let step = "  const direct *self = instance;";
        checked(step, &format!("{step}\n  {by}"))
    };
    let crashes = with("if (in->tick == 7) abort();");
    assert!(
        crashes.code == Some(1) && crashes.out.contains("FAIL  gives valid answers in every tank"),
        "{crashes:?}"
    );
    let stiff = checked("step, reconfigure, NULL", "step, NULL, NULL");
    assert!(
        stiff.code == Some(1) && stiff.out.contains("FAIL  accepts changes to its live parameters"),
        "{stiff:?}"
    );
    let clock = "static double noise; noise += (double)(size_t)in / 1e18; host->scalar(host->ctx, (tp_str)TP_STR(\"n\"), \
                 (double)(size_t)&noise, (tp_str)TP_STR(\"\"));";
    let hoards = with("static void *volatile kept; kept = memset(malloc(4096), 1, 4096);");
    assert!(hoards.code == Some(1) && hoards.out.contains("FAIL  does not leak memory"), "{hoards:?}");
    let random = with(clock);
    assert!(random.code == Some(1) && random.out.contains("FAIL  repeats its mission exactly"), "{random:?}");
}

fn rebuilt(plugin: &Path) -> PathBuf {
    let made = Command::new("make").arg("-sB").current_dir(plugin.parent().unwrap()).output().unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    plugin.to_owned()
}

#[test]
fn what_a_planner_prints_and_its_crash_are_kept_and_the_crash_can_be_replayed() {
    let bench = Bench::new();
    let plugin = built(&bench, "c");
    let source = bench.path().join("my-own/my_own.c");
    let good = std::fs::read_to_string(&source).unwrap();
    let by = "if (in->tick == 3) { puts(\"in step 3\"); fflush(stdout); }\n  if (in->tick == 7) { puts(\"bye\"); fflush(stdout); abort(); }";
    let step = "const direct *self = instance;";
    let bad = good.replacen(step, &format!("{step}\n  {by}"), 1).replacen(
        "#include <math.h>",
        "#include <math.h>\n#include <stdio.h>",
        1,
    );
    std::fs::write(&source, bad).unwrap();
    let flown = fly_first(&bench, &rebuilt(&plugin));
    assert_eq!(flown.code, Some(1), "{flown:?}");
    let run = &bench.runs()[0];
    let printed = std::fs::read_to_string(run.join("planner.log")).unwrap();
    assert!(printed.starts_with("T+0.3 s  my-own: in step 3\n"), "{printed}");
    assert!(!journal_text(run).contains("in step 3"));
    let bundle = run.join("crash-1");
    let replayed = bench.tankops(&["replay-worker", bundle.to_str().unwrap()]);
    assert!(replayed.code == Some(1) && replayed.out.contains("killed by SIGABRT"), "{replayed:?}");
    std::fs::write(&source, good).unwrap();
    rebuilt(&plugin);
    let replayed = bench.tankops(&["replay-worker", bundle.to_str().unwrap()]);
    assert!(
        replayed.code == Some(0) && replayed.out.contains("the plugin did not fail again"),
        "{replayed:?}"
    );
}

#[test]
fn a_panic_leaves_the_calls_by_which_it_came_if_that_is_asked() {
    let bench = Bench::new();
    built(&bench, "rust");
    let source = bench.path().join("my-own/src/lib.rs");
    let good = std::fs::read_to_string(&source).unwrap();
    let step = "let way = sensed.target";
    let by = "if sensed.tick == 7 {\n            look_up_nothing();\n        }\n        ";
    let bad = good.replacen(step, &format!("{by}{step}"), 1);
    let helper =
        "#[inline(never)]\nfn look_up_nothing() {\n    std::hint::black_box(Vec::<u8>::new())[3];\n}\n";
    std::fs::write(&source, format!("{bad}\n{helper}")).unwrap();
    let plugin = built_in_rust(&bench);
    for (asked, is_there) in [("1", true), ("0", false)] {
        let bench = Bench::new();
        let scenario = source.parent().unwrap().with_file_name("scenario.toml");
        let mut command = bench.command();
        command.env("RUST_BACKTRACE", asked).arg("run").arg(scenario).arg("--json");
        let flown = Ended::from(command.arg("--plugin-dir").arg(plugin.parent().unwrap()).output().unwrap());
        assert!(flown.out.contains("panicked at src/lib.rs:"), "{flown:?}");
        let run = &bench.runs()[0];
        let kept = |file: &str| std::fs::read_to_string(run.join(file)).unwrap_or_default();
        for text in [kept("planner.log"), kept("crash-1/output.txt")] {
            assert_eq!(text.contains("look_up_nothing"), is_there, "{asked}: {text}");
        }
        assert!(!journal_text(run).contains("look_up_nothing"));
    }
}

#[test]
fn gdb_knows_the_functions_of_a_plugin_and_leaves_a_core_if_it_is_there() {
    if Command::new("gdb").arg("--version").output().is_err() {
        return;
    }
    let bench = Bench::new();
    let plugin = built(&bench, "c");
    let source = bench.path().join("my-own/my_own.c");
    let good = std::fs::read_to_string(&source).unwrap();
    let step = "const direct *self = instance;";
    let bad = good.replacen(step, &format!("{step}\n  if (in->tick == 7) give_up();"), 1).replacen(
        "#include <math.h>",
        "#include <math.h>\n#include <stdlib.h>\n__attribute__((noinline)) static void give_up(void) { abort(); }",
        1,
    );
    std::fs::write(&source, bad).unwrap();
    fly_first(&bench, &rebuilt(&plugin));
    let bundle = bench.runs()[0].join("crash-1");
    let replayed = bench.tankops(&["replay-worker", bundle.to_str().unwrap(), "--core"]);
    assert_eq!(replayed.code, Some(1), "{replayed:?}");
    let trace = std::fs::read_to_string(bundle.join("backtrace.txt")).unwrap();
    assert!(trace.contains("give_up"), "{trace}");
    assert!(bundle.join("core").metadata().unwrap().len() > 100_000, "{trace}");
}

#[test]
fn a_run_looks_only_at_plugins_that_may_have_its_planner() {
    let bench = Bench::new();
    let cache = bench.path().join("cache");
    let fly = || {
        let mut command = bench.command();
        command.env("XDG_CACHE_HOME", &cache).args(["run", "--json", "--no-record"]);
        Ended::from(command.arg(crate::bench::scenario("corridor.toml")).output().unwrap())
    };
    let known = || {
        let files = std::fs::read_dir(cache.join("tankops/plugins")).unwrap();
        let texts = files.map(|file| std::fs::read_to_string(file.unwrap().path()).unwrap());
        texts.filter(|text| text.contains("\"parameters\"")).count()
    };
    assert!(fly().code.is_some_and(|code| code < 2));
    let first = known();
    assert!(first == 1, "{first} plugins were loaded to find one planner");
    fly();
    assert_eq!(known(), first);
}

#[test]
fn a_program_and_its_planners_work_below_any_prefix_from_any_folder() {
    let bench = Bench::new();
    let program = Path::new(env!("CARGO_BIN_EXE_tankops"));
    let (bin, plugins) = (bench.path().join("p/bin"), bench.path().join("p/lib/tankops/plugins"));
    let elsewhere = bench.path().join("elsewhere");
    for folder in [&bin, &plugins, &elsewhere] {
        std::fs::create_dir_all(folder).unwrap();
    }
    std::fs::copy(program, bin.join("tankops")).unwrap();
    let spiral = "libplanner_spiral.so";
    std::fs::copy(program.with_file_name("deps").join(spiral), plugins.join(spiral)).unwrap();
    let state = bench.path().join("state");
    let flown = Command::new(bin.join("tankops"))
        .current_dir(&elsewhere)
        .env_remove("TANKOPS_PLUGIN_PATH")
        .env("XDG_STATE_HOME", &state)
        .env("XDG_CACHE_HOME", bench.path().join("cache"))
        .output()
        .unwrap();
    let flown = Ended::from(flown);
    let kept = format!("run kept in {}", state.join("tankops/logs").display());
    assert!(flown.code == Some(0) && flown.out.contains(&kept), "{flown:?}");
    assert_eq!(std::fs::read_dir(&elsewhere).unwrap().count(), 0);
}
