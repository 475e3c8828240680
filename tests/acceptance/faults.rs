//! Planners that misbehave: the robot is held within the tick, the operator sees the reason, and the mission can
//! continue.

use crate::bench::{Bench, Ended, journal, of_kind, passed_over, scenario};

/// Runs the goto scenario with the faulty planner; the fallback is `apf`.
fn fly_faulty(bench: &Bench, fault: &str) -> Ended {
    // In quotes, because `nan` would otherwise be a number.
    let set = format!("fault=\"{fault}\"");
    bench.fly(
        &scenario("goto-single-obstacle.toml"),
        &["--planner", "faulty", "--set", &set, "--set", "at_step=12", "--set", "planner.fallback.id=apf"],
    )
}

#[test]
fn whatever_a_planner_does_the_robot_holds_and_another_planner_ends_the_mission() {
    let faults = [
        ("panic", "panic"),
        ("segv", "SIGSEGV"),
        ("abort", "SIGABRT"),
        ("exit", "exit"),
        ("hang", "did not finish"),
        ("alloc", "memory"),
        ("nan", "not a number"),
        ("stack", "SIG"),
        ("error", "faulty"),
    ];
    for (fault, word) in faults {
        let bench = Bench::new();
        let flown = fly_faulty(&bench, fault);
        let report = flown.json();
        assert_eq!(report["outcome"], "complete", "{fault}: {flown:?}");
        assert_eq!(report["planner_faults"], 1, "{fault}: {flown:?}");
        let events = journal(&bench.runs()[0]);
        let failed = of_kind(&events, "planner_failed");
        let message = failed[0]["fault"]["message"].as_str().unwrap();
        assert!(message.contains("faulty") && message.contains(word), "{fault}: {message}");
        assert!(message.contains("step"), "{fault}: {message}");
        let held = of_kind(&events, "held");
        assert_eq!(held[0]["tick"], failed[0]["tick"], "{fault}");
        let verified = bench.tankops(&["verify", bench.runs()[0].to_str().unwrap()]);
        assert_eq!(verified.code, Some(0), "{fault}: {verified:?}");
    }
}

#[test]
fn without_a_fallback_and_an_operator_the_mission_ends_with_the_planners_sentence() {
    let bench = Bench::new();
    let flown =
        bench.fly(&scenario("goto-single-obstacle.toml"), &["--planner", "faulty", "--set", "fault=segv"]);
    assert_eq!(flown.code, Some(1), "{flown:?}");
    let report = flown.json();
    assert_eq!(report["outcome"], "aborted");
    assert!(report["reason"].as_str().unwrap().contains("SIGSEGV"), "{report}");
    assert!(bench.runs()[0].join("recording.rrd").metadata().unwrap().len() > 1000);
}

#[test]
fn a_planner_that_panics_or_hangs_while_it_is_made_is_refused_with_a_sentence() {
    for (fault, word) in
        [("configure_panic", "panic"), ("configure_hang", "configure"), ("plan_panic", "panic")]
    {
        let bench = Bench::new();
        let flown = fly_faulty(&bench, fault);
        let report = flown.json();
        assert_eq!(report["outcome"], "complete", "{fault}: {flown:?}");
        let events = journal(&bench.runs()[0]);
        let message = of_kind(&events, "planner_failed")[0]["fault"]["message"].as_str().unwrap().to_owned();
        assert!(message.contains(word), "{fault}: {message}");
    }
}

#[test]
fn a_planner_in_plain_c_flies() {
    let bench = Bench::new();
    let plugins = bench.path().join("plugins-in-c");
    std::fs::create_dir(&plugins).unwrap();
    compile("direct.c", &plugins.join("libplanner_direct_c.so"));
    let flown = bench.fly(
        &scenario("goto-single-obstacle.toml"),
        &["--planner", "direct-c", "--plugin-dir", plugins.to_str().unwrap(), "--no-record"],
    );
    let report = flown.json();
    assert_eq!(report["planner"], "direct-c", "{flown:?}");
    assert!(report["ticks"].as_u64() > Some(50), "{flown:?}");
    assert_eq!(report["planner_faults"], 0, "{flown:?}");
}

#[test]
fn the_example_of_the_planner_guide_flies() {
    let bench = Bench::new();
    let flown = bench.fly(&scenario("goto-single-obstacle.toml"), &["--planner", "straight", "--no-record"]);
    let report = flown.json();
    assert_eq!(report["planner"], "straight", "{flown:?}");
    assert!(report["ticks"].as_u64() > Some(50), "{flown:?}");
    assert_eq!(report["planner_faults"], 0, "{flown:?}");
}

#[test]
fn a_plugin_for_another_abi_is_listed_with_the_remedy() {
    let bench = Bench::new();
    let plugins = bench.path().join("old");
    std::fs::create_dir(&plugins).unwrap();
    let source =
        bench.file("old.c", "#include \"tankops_planner.h\"\nTP_STAMP(9, 0);\nint tank_planner_entry;\n");
    compile_file(&source, &plugins.join("libplanner_old.so"));
    let listed = bench.tankops(&["planners", "--plugin-dir", plugins.to_str().unwrap()]);
    assert_eq!(listed.code, Some(0), "{listed:?}");
    assert!(listed.out.contains("ABI 9.0") && listed.out.contains("update the console"), "{listed:?}");
}

#[cfg(unix)]
#[test]
fn a_machine_that_lets_a_process_open_few_files_is_said_so_before_anything_is_flown() {
    let bench = Bench::new();
    let tankops = bench.command();
    let mut limited = std::process::Command::new("sh");
    limited
        .args(["-c", "ulimit -n 128; exec \"$@\"", "sh"])
        .arg(tankops.get_program())
        .args(tankops.get_args());
    let envs = tankops.get_envs().filter_map(|(name, value)| Some((name, value?)));
    limited.envs(envs).current_dir(bench.path()).arg("run").arg(scenario("corridor.toml"));
    let ended = Ended::from(limited.output().unwrap());
    assert!(ended.code == Some(3) && ended.err.contains("`ulimit -n 256`"), "{ended:?}");
    assert!(bench.runs().is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn a_machine_that_grants_few_threads_is_said_so_before_anything_is_begun() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::new();
    let (program, mission) = (bench.path().join("tankops"), bench.path().join("mission.toml"));
    std::fs::copy(bench.command().get_program(), &program).unwrap();
    std::fs::copy(scenario("goto-single-obstacle.toml"), &mission).unwrap();
    std::fs::set_permissions(bench.path(), PermissionsExt::from_mode(0o755)).unwrap();
    // The limit applies to a user who runs nothing else, but not to root.
    let user = (70_000 + std::process::id() % 1000).to_string();
    let other = [format!("--reuid={user}"), format!("--regid={user}"), "--clear-groups".to_owned()];
    let is_possible = std::process::Command::new("setpriv").args(&other).arg("true").status();
    if !is_possible.is_ok_and(|status| status.success()) {
        passed_over("this is not root, or setpriv is not installed");
        return;
    }
    bench.fly(&mission, &[]);
    let run = bench.runs()[0].to_str().unwrap().to_owned();
    let (run, mission) = (run.as_str(), mission.to_str().unwrap());
    let limited = |threads: usize, command: &[&str]| {
        let mut limited = std::process::Command::new("setpriv");
        limited.args(&other).arg("prlimit").arg(format!("--nproc={threads}")).arg(&program).args(command);
        Ended::from(limited.env_clear().current_dir(bench.path()).output().unwrap())
    };
    // With less than a command needs, nothing is started.
    let commands: [(usize, &[&str]); 6] = [
        (3, &["report", run]),
        (3, &["rescan", run, "-o", "again.toml"]),
        (3, &["runs"]),
        (8, &["verify", run]),
        (13, &["run", mission]),
        (16, &["console", mission]),
    ];
    for (needed, command) in commands {
        for threads in 1..needed {
            let ended = limited(threads, command);
            assert!(ended.code == Some(3) && ended.err.contains("`ulimit -u`"), "{threads}: {ended:?}");
            assert_eq!(ended.err.lines().count(), 1, "{threads} for {command:?}: {ended:?}");
        }
    }
    for (enough, command) in [(1, ["events", run]), (3, ["report", run])] {
        let ended = limited(enough, &command);
        assert_eq!(ended.code, Some(0), "{enough} for {command:?}: {ended:?}");
    }
}

/// Compiles one of the examples in C into a plugin.
pub(crate) fn compile(example: &str, library: &std::path::Path) {
    compile_file(&crate::bench::workspace().join("plugins/examples/direct-c").join(example), library);
}

pub(crate) fn compile_file(source: &std::path::Path, library: &std::path::Path) {
    let include = crate::bench::workspace().join("plugins/planner-api/include");
    let compiled = std::process::Command::new("cc")
        .args(["-std=c11", "-shared", "-fPIC", "-O1", "-Wall", "-Werror", "-o"])
        .arg(library)
        .arg(source)
        .arg("-I")
        .arg(include)
        .arg("-lm")
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
}
