//! The command line from the point of view of scripts: exit codes, JSON and clear refusals.

use crate::bench::{Bench, scenario};

const EVADES: &str = "evades moving obstacles";
const STANDING: &str = "treats moving obstacles as stationary";
/// The statements of planners about moving obstacles.
const ABOUT_WHAT_MOVES: [(&str, &str); 14] = [
    ("apf", EVADES),
    ("tapf", EVADES),
    ("apf-virtual-goals", EVADES),
    ("apf-dwa", EVADES),
    ("rpf", EVADES),
    ("vt", EVADES),
    ("iapf", EVADES),
    ("navfn", EVADES),
    ("shortest", EVADES),
    ("spiral-lattice", STANDING),
    ("spiral-tangent", STANDING),
    ("boustrophedon", STANDING),
    ("hull-partition", STANDING),
    ("tether-safe", STANDING),
];

#[test]
fn planners_are_listed_with_their_parameters() {
    let bench = Bench::new();
    let listed = bench.tankops(&["planners", "--json"]).json();
    let plugins = listed["plugins"].as_array().unwrap();
    let planners: Vec<&serde_json::Value> =
        plugins.iter().flat_map(|plugin| plugin["planners"].as_array().unwrap()).collect();
    let ids: Vec<&str> = planners.iter().map(|planner| planner["id"].as_str().unwrap()).collect();
    assert!(ids.contains(&"apf") && ids.contains(&"rpf"), "{ids:?}");
    for planner in planners {
        if let Some((_, moving)) = ABOUT_WHAT_MOVES.iter().find(|(id, _)| planner["id"] == *id) {
            assert!(planner["about"].as_str().unwrap().to_lowercase().contains(moving), "{planner}");
        }
        for parameter in planner["parameters"].as_array().unwrap() {
            assert_ne!(parameter["help"], "", "{}: {}", planner["id"], parameter["key"]);
        }
    }
}

#[test]
fn a_plan_is_printed_as_json_without_flying() {
    let bench = Bench::new();
    let planned = bench.command().args(["plan", "--json"]).arg(scenario("demo.toml")).output().unwrap();
    let plan: serde_json::Value = serde_json::from_slice(&planned.stdout).unwrap();
    assert_eq!(plan["planner"], "rpf");
    assert!(plan["path"].as_array().unwrap().len() > 100);
    assert!(plan["length_m"].as_f64() > Some(10.0));
    assert!(bench.runs().is_empty());
}

#[test]
fn damaged_scenarios_are_refused_with_file_line_key_and_remedy() {
    let demo = std::fs::read_to_string(scenario("demo.toml")).unwrap();
    let damaged = [
        ("unknown.toml", demo.replacen("[robot]", "[robot]\nrobot_colour = 3", 1), "robot_colour"),
        ("unit.toml", demo.replacen("radius_m", "radius_cm", 1), "radius_m"),
        ("noise.toml", "\u{1}%&~".repeat(2_500_000), "larger"),
        ("nan.toml", regex_free_replace(&demo, "swath_m", "nan"), "swath_m"),
        ("zero.toml", regex_free_replace(&demo, "radius_m", "0"), "radius_m"),
    ];
    let bench = Bench::new();
    for (name, text, word) in damaged {
        let file = bench.file(name, text);
        let flown = bench.tankops(&["run", file.to_str().unwrap()]);
        assert_eq!(flown.code, Some(2), "{name}: {flown:?}");
        assert!(flown.err.contains(name) && flown.err.contains(word), "{name}: {}", flown.err);
        assert!(flown.err.len() < 4000, "{name}: {} bytes of message", flown.err.len());
        assert_eq!(bench.tankops(&["check", file.to_str().unwrap()]).code, Some(2), "{name}");
    }
    assert!(bench.runs().is_empty());
}

/// The text with the first value of a key changed.
fn regex_free_replace(text: &str, key: &str, value: &str) -> String {
    let mut done = false;
    let lines: Vec<String> = text
        .lines()
        .map(|line| {
            if !done && line.trim_start().starts_with(&format!("{key} =")) {
                done = true;
                return format!("{key} = {value}");
            }
            line.to_owned()
        })
        .collect();
    assert!(done, "no {key} in the scenario");
    lines.join("\n")
}

#[test]
fn wrong_usage_is_exit_code_2_and_names_the_remedy() {
    let bench = Bench::new();
    let demo = scenario("demo.toml");
    let demo = demo.to_str().unwrap();
    for (arguments, word) in [
        (vec!["fly"], "--help"),
        (vec!["run", "nowhere.toml"], "nowhere.toml"),
        (vec!["run", demo, "--planner", "rfp", "--no-record"], "rpf"),
        (vec!["run", demo, "--set", "k_rpe=2", "--no-record"], "k_rep"),
        (vec!["run", demo, "--set", "k_rep=1e99", "--no-record"], "k_rep"),
    ] {
        let ended = bench.tankops(&arguments);
        assert_eq!(ended.code, Some(2), "{arguments:?}: {ended:?}");
        assert!(ended.err.contains(word), "{arguments:?}: {}", ended.err);
    }
}

#[test]
fn without_a_terminal_the_demo_is_flown_and_reported() {
    let bench = Bench::new();
    let flown = bench.tankops(&[]);
    assert_eq!(flown.code, Some(0), "{flown:?}");
    assert!(flown.out.contains("complete") && flown.out.contains("reachable"), "{flown:?}");
    assert_eq!(bench.runs().len(), 1);
}

#[test]
fn the_console_without_a_terminal_says_what_to_use_instead() {
    let ended = Bench::new().tankops(&["console"]);
    assert_eq!(ended.code, Some(2));
    assert!(ended.err.contains("tankops run"), "{ended:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn an_output_that_cannot_be_written_is_an_error_and_no_panic() {
    let bench = Bench::new();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let listed = bench.command().arg("planners").stdout(full).output().unwrap();
    let errors = String::from_utf8(listed.stderr).unwrap();
    assert_eq!(listed.status.code(), Some(3), "{errors}");
    assert!(errors.contains("writing to stdout") && !errors.contains("panicked"), "{errors}");
}

#[test]
fn check_refuses_a_planner_that_is_not_there() {
    let bench = Bench::new();
    let demo = std::fs::read_to_string(scenario("demo.toml")).unwrap();
    let file = bench.file("rfp.toml", demo.replace("id = \"rpf\"", "id = \"rfp\""));
    let checked = bench.tankops(&["check", file.to_str().unwrap()]);
    assert_eq!(checked.code, Some(2), "{checked:?}");
    assert!(checked.err.contains("rfp") && checked.err.contains("rpf"), "{checked:?}");
}

#[test]
fn check_warns_of_a_clearance_within_the_position_error() {
    let bench = Bench::new();
    let scan = std::fs::read_to_string(scenario("cover-circle.toml")).unwrap();
    assert!(scan.contains("clearance_m = 0.1") && scan.contains("repetitions = 20"));
    for (clearance, repetitions, is_warned) in
        [(0.1, 20, false), (0.02, 20, false), (0.02, 4, true), (0.3, 4, false)]
    {
        let scan = scan.replace("clearance_m = 0.1", &format!("clearance_m = {clearance}"));
        let scan = scan.replace("repetitions = 20", &format!("repetitions = {repetitions}"));
        let file = bench.file("scan.toml", scan);
        let checked = bench.tankops(&["check", file.to_str().unwrap()]);
        assert_eq!(checked.code, Some(0), "{checked:?}");
        assert_eq!(
            checked.err.contains("the hull keeps 0.08 m from solid objects (mission.clearance_m"),
            is_warned,
            "{checked:?}"
        );
    }
}

#[test]
fn every_objection_of_a_planner_is_reported_at_its_line() {
    let demo = std::fs::read_to_string(scenario("demo.toml")).unwrap();
    let bench = Bench::new();
    let head = "[planner]\n";
    assert!(demo.contains(head));
    let damaged = "[planner]\nparameters = { k_rep = -3.0, k_ratt = 1.0 }\n";
    let file = bench.file("objections.toml", demo.replacen(head, damaged, 1));
    for command in ["check", "run"] {
        let answer = bench.tankops(&[command, file.to_str().unwrap()]);
        assert_eq!(answer.code, Some(2), "{answer:?}");
        let line = |key: &str| answer.err.lines().find(|l| l.contains("objections.toml:") && l.contains(key));
        assert!(line("planner.parameters.k_rep = -3.0").is_some(), "{}", answer.err);
        assert!(line("planner.parameters.k_ratt").is_some_and(|l| l.contains("k_att")), "{}", answer.err);
    }
}

#[test]
fn a_plugin_folder_that_does_not_exist_is_an_error() {
    let answer = Bench::new().tankops(&["planners", "--plugin-dir", "no/such/folder"]);
    assert!(answer.code == Some(2) && answer.err.contains("no/such/folder"), "{answer:?}");
}

#[test]
fn a_run_that_lost_its_report_is_listed_from_its_journal() {
    let bench = Bench::new();
    assert_eq!(
        bench.tankops(&["run", scenario("goto-single-obstacle.toml").to_str().unwrap()]).code,
        Some(0)
    );
    let run = bench.runs().pop().unwrap();
    std::fs::remove_file(run.join("report.json")).unwrap();
    let listed = bench.tankops(&["runs", "--json"]).json();
    assert_eq!(listed[0]["end"], "complete", "{listed}");
}

#[test]
fn a_pipe_in_the_place_of_a_plan_or_a_configuration_is_refused_and_not_waited_for() {
    let bench = Bench::new();
    for name in ["plan.toml", "config.toml", "keys.toml"] {
        let file = bench.path().join(name);
        assert!(std::process::Command::new("mkfifo").arg(&file).status().unwrap().success());
        let words: &[&str] = if name == "plan.toml" { &["campaign", "run"] } else { &["check"] };
        let ended = bench.tankops(&[words, &[name]].concat());
        assert_eq!(ended.code, Some(2), "{ended:?}");
        assert!(ended.err.contains(&format!("{name}: it is not a regular file")), "{ended:?}");
        std::fs::remove_file(&file).unwrap();
    }
    bench.file("plan.toml", [b'#', 0xff, 0xfe]);
    let ended = bench.tankops(&["campaign", "run", "plan.toml"]);
    assert_eq!(ended.code, Some(2), "{ended:?}");
    assert!(ended.err.contains("plan.toml: ISO-8859-1 instead of UTF-8"), "{ended:?}");
}
