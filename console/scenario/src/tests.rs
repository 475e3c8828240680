//! Valid scenarios, invalid scenarios, and the messages about their faults.

use super::*;
use mission::{ParamValue, TaskConfig};
use proptest::prelude::*;
use sim::NoiseModel;
use std::{fs, time::Instant};
use world::{ObstacleId, Point, Shape};

const DEMO: &str = include_str!("../../../scenarios/demo.toml");
const PAPER: &str = include_str!("../../../scenarios/spiral-paper.toml");
const GOTO: &str = include_str!("../../../scenarios/goto-single-obstacle.toml");
const DOC: &str = include_str!("../../docs/scenario-format.md");

/// The shortest valid scenario.
const SMALL: &str = r#"name = "small"
[tank]
radius_m = 5
[ae]
stations = [{ name = "A", at_m = [5, 0] }, { name = "B", at_m = [0, 5] }]
[mission]
kind = "goto"
goal_m = [3, 0]
[robot]
start_m = [-3, 0]
[planner]
id = "apf"
"#;

fn read(text: &str) -> Scenario {
    Scenario::parse(text, "x.toml").unwrap_or_else(|errors| panic!("{}", errors.render()))
}

fn errors(text: &str) -> ScenarioErrors {
    Scenario::parse(text, "x.toml").expect_err("something is wrong with it")
}

/// Replaces `from` by `to` in the small scenario; returns the line, column and sentence of the only problem.
fn complaint(from: &str, to: &str) -> String {
    assert!(SMALL.contains(from), "{from}");
    let errors = errors(&SMALL.replacen(from, to, 1));
    assert_eq!(errors.problems.len(), 1, "{}", errors.render());
    let shown = errors.render();
    let first = shown.lines().next().expect("a line");
    first.strip_prefix("error: x.toml:").expect("file first").to_owned()
}

#[test]
fn the_scenarios_in_the_box_are_right() {
    for text in [DEMO, PAPER, GOTO, SMALL] {
        read(text);
    }
}

#[test]
fn a_large_floor_to_be_crossed_has_cells_that_fit() {
    let large = SMALL.replacen("radius_m = 5", "radius_m = 300", 1);
    assert!((read(&large).mission.cell_m - 0.303).abs() < 1e-9);
    let cover = large.replacen("kind = \"goto\"\ngoal_m = [3, 0]", "kind = \"cover\"\nswath_m = 2", 1);
    assert!(errors(&cover).render().contains("help: write cell_m = 0.303 or more"));
}

#[test]
fn an_amphibious_robot_has_the_papers_limits_and_planners_get_the_faster_ones() {
    let scenario =
        read(&SMALL.replacen("start_m = [-3, 0]", "start_m = [-3, 0]\nmotion = \"amphibious\"", 1));
    let amphibious = scenario.sim.robot.amphibious.expect("it walks and swims");
    assert_eq!((amphibious.land.v_max_m_per_s, amphibious.transition_steps), (0.13, 20));
    assert!((amphibious.land.w_max_rad_per_s - 0.12).abs() < 1e-3);
    assert!((scenario.mission.limits.v_max_m_per_s - 0.23).abs() < 1e-12);
    assert_eq!(read(SMALL).sim.robot.amphibious, None);
}

#[test]
fn a_pressure_sensor_that_scatters_too_much_to_decide_is_refused_with_one_that_does_not() {
    let with = |keys: &str| {
        let keys = format!("start_m = [-3, 0]\nmotion = \"amphibious\"\n{keys}");
        Scenario::parse(&SMALL.replacen("start_m = [-3, 0]", &keys, 1), "x.toml")
    };
    let sensor = with("pressure_sigma_pa = 200").expect("right").mission.pressure.expect("a sensor");
    assert_eq!((sensor.depth_m, sensor.sigma_pa), (0.3, 200.0));
    let said = with("pressure_sigma_pa = 9000\npressure_depth_m = 0.2").expect_err("too noisy").render();
    let most = said.split("at most ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a number");
    assert!(said.contains("robot.pressure_sigma_pa = 9000: must be at most"), "{said}");
    assert!(with(&format!("pressure_sigma_pa = {most}\npressure_depth_m = 0.2")).is_ok(), "{most}");
    let said = with("pressure_sigma_pa = 200\npressure_depth_m = 0.00001").expect_err("too shallow").render();
    let most = said.split("at most ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a number");
    assert!(with(&format!("pressure_sigma_pa = {most}\npressure_depth_m = 0.00001")).is_ok(), "{most}");
    assert!(with("pressure_depth_m = 0.2").is_err());
    let walks = SMALL.replacen("start_m = [-3, 0]", "start_m = [-3, 0]\npressure_sigma_pa = 200", 1);
    let said = Scenario::parse(&walks, "x.toml").expect_err("a robot that does not swim").render();
    assert!(
        said.contains("robot.pressure_sigma_pa = 200: has no effect with motion = \"unicycle\""),
        "{said}"
    );
}

#[test]
fn the_demo_has_columns_on_the_drawing_and_surprises() {
    let demo = read(DEMO);
    assert_eq!(demo.sim.world.obstacles.iter().filter(|o| o.known).count(), 8);
    assert_eq!(demo.sim.world.obstacles.iter().filter(|o| !o.known).count(), 3);
    assert_eq!(demo.sim.world.stations.len(), 5);
    assert!(!demo.mission.planner.id.is_empty());
    let TaskConfig::Follow { path, .. } = &demo.mission.task else { panic!("it follows a spiral") };
    assert_eq!(path[0], Point::new(4.65, 0.0));
    assert_eq!(demo.mission.start.position, path[0], "it starts on the path");
    assert!((demo.mission.start.heading_rad - 95.0_f64.to_radians()).abs() < 0.1, "and along it");
}

#[test]
fn the_papers_scenario_has_the_papers_spiral_and_layout() {
    let paper = read(PAPER);
    let TaskConfig::Follow { path, .. } = &paper.mission.task else { panic!("it follows a spiral") };
    assert_eq!(path.len(), 2477);
    assert_eq!(paper.sim.world.obstacles.len(), 39);
    let other = Scenario::parse_with(PAPER, "x", &Settings { seed: Some(2), ..Settings::default() });
    assert_ne!(
        other.expect("right").sim.world.obstacles,
        paper.sim.world.obstacles,
        "the layout follows the seed"
    );
}

#[test]
fn defaults_are_those_of_the_document() {
    let small = read(SMALL);
    assert_eq!((small.seed, small.about.as_str()), (1, ""));
    assert!((small.sim.robot.radius_m - 0.25).abs() < 1e-12 && (small.sim.tick_s - 0.1).abs() < 1e-12);
    let ae = small.sim.ae.expect("stations");
    assert_eq!((ae.repetitions, ae.noise), (20, NoiseModel::Uniform { ratio: 0.05 }));
    assert!((small.mission.range_sigma_ratio - 0.05 / 3.0_f64.sqrt()).abs() < 1e-12);
    assert!(small.mission.start.heading_rad.abs() < 1e-12, "it looks towards the goal");
    assert_eq!(small.expect, Expect::default());
}

#[test]
fn a_tether_starts_where_the_robot_does_and_preset_points_may_be_written_out() {
    let text = SMALL
        .replace("kind = \"goto\"\ngoal_m = [3, 0]", "kind = \"follow\"\npath_m = [[-3, 0], [3, 0]]")
        .replace("[planner]", "[tether]\nreel_length_m = 9\n[planner]");
    let scenario = read(&text);
    let tether = scenario.mission.tether.expect("it has one");
    assert_eq!(tether.anchor, Point::new(-3.0, 0.0));
    assert_eq!(scenario.sim.tether_anchor, Some(tether.anchor));
    assert!((tether.limits.wrap_max_rad - std::f64::consts::TAU).abs() < 1e-12 && !tether.allow_uncertified);
    assert!(matches!(&scenario.mission.task, TaskConfig::Follow { path, .. } if path.len() == 2));
}

#[test]
fn a_robot_that_comes_back_to_the_anchor_has_room_there() {
    let cover = |start: &str, mission: &str, anchor: &str| {
        let text = SMALL
            .replace("start_m = [-3, 0]", &format!("start_m = {start}"))
            .replace("kind = \"goto\"\ngoal_m = [3, 0]", &format!("kind = \"cover\"\n{mission}"))
            .replace("[planner]", &format!("[tether]\nreel_length_m = 20\n{anchor}\n[planner]"));
        Scenario::parse(&text, "x.toml").map_err(|errors| errors.render())
    };
    let with = |anchor: &str, more: &str| cover("[-3, 0]", &format!("clearance_m = 0.1\n{more}"), anchor);
    // Hull radius 0.25 m, clearance 0.1 m, and back at the anchor within 0.2 m: plans end 0.1 m beside it at most.
    assert!(with("anchor_m = [0, -4.65]", "").is_ok() && with("anchor_m = [0, -4.74]", "").is_ok());
    assert!(with("anchor_m = [0, -4.74]", "tolerance_m = 0.1").is_err());
    for (anchor, away) in [("[0, -4.8]", "0.200"), ("[0, -5.0]", "0.000")] {
        let said = with(&format!("anchor_m = {anchor}"), "").expect_err("too near to the wall");
        let must_be = format!("tether.anchor_m = {anchor}: must be at least 0.250 m from the wall");
        assert!(said.contains(&must_be) && said.contains(&format!("the distance is {away} m")), "{said}");
    }
    let at_start = cover("[-4.6, 0]", "clearance_m = 0.3", "").expect_err("too near to the wall");
    assert!(at_start.contains("robot.start_m = [-4.6, 0]: must be at least 0.450 m from"), "{at_start}");
    // A mission that ends elsewhere may have its anchor in the shell.
    let elsewhere = SMALL.replace("[planner]", "[tether]\nreel_length_m = 20\nanchor_m = [0, -5]\n[planner]");
    assert!(Scenario::parse(&elsewhere, "x.toml").is_ok());
}

#[test]
fn the_text_of_a_scenario_gives_the_same_scenario_again() {
    let settings = Settings {
        set: ["k_rep=2", "mode=literal", "other=nan", "tank.radius_m=5.5", "obstacles.0.known=false"]
            .map(str::to_owned)
            .to_vec(),
        planner: Some("apf".into()),
        seed: Some(99),
    };
    let scenario = Scenario::parse_with(DEMO, "demo.toml", &settings).expect("right");
    assert_eq!((scenario.seed, scenario.mission.planner.id.as_str()), (99, "apf"));
    assert_eq!(scenario.mission.planner.parameters["k_rep"], ParamValue::Int(2));
    assert_eq!(scenario.mission.planner.parameters["mode"], ParamValue::Word("literal".into()));
    assert_eq!(scenario.mission.planner.parameters["other"], ParamValue::Word("nan".into()));
    assert!(!scenario.sim.world.obstacles[0].known);
    assert_eq!(Scenario::parse(&scenario.text, &scenario.shown_name).expect("right"), scenario);
}

#[test]
fn settings_that_do_not_fit_are_named_in_the_message() {
    let settings = Settings { set: vec!["tank.radius_m=0".into()], ..Settings::default() };
    let errors = Scenario::parse_with(SMALL, "x.toml", &settings).expect_err("no tank");
    let text = errors.render();
    assert!(
        text.starts_with("error: x.toml with --set tank.radius_m=0:3:12: tank.radius_m = 0: must be"),
        "{text}"
    );
    let settings = Settings { set: vec!["k_rep".into()], ..Settings::default() };
    let errors = Scenario::parse_with(SMALL, "x.toml", &settings).expect_err("no value");
    assert_eq!(errors.render(), "error: x.toml: --set k_rep: must be KEY=VALUE\n");
}

#[test]
fn an_option_that_adds_a_wrong_key_is_named_instead_of_a_line_that_the_file_does_not_have() {
    let lines = SMALL.lines().count();
    let settings = |set: &str| Settings { set: vec![set.into()], ..Settings::default() };
    let errors = Scenario::parse_with(SMALL, "x.toml", &settings("nosuch.key=2")).expect_err("no such key");
    let text = errors.render();
    assert!(text.starts_with("error: x.toml with --set nosuch.key=2: nosuch"), "{text}");
    // The line of another problem is that of the file, although an option added a line above it.
    let wrong = format!("{SMALL}\n[expect]\nnosuch = 1\n");
    let errors = Scenario::parse_with(&wrong, "x.toml", &settings("k_rep=2")).expect_err("no such key");
    let text = errors.render();
    assert!(text.contains(&format!("k_rep=2:{}:1: expect.nosuch = 1: unknown key", lines + 3)), "{text}");
}

#[test]
fn an_error_shows_file_line_column_key_value_and_remedy() {
    let text = SMALL.replace("radius_m = 5", "radius_m = 0  # empty");
    let shown = errors(&text).render();
    let first = "error: x.toml:3:12: tank.radius_m = 0: must be greater than 0 m\n  |\n3 | radius_m = 0  # empty\n  |            ^\n";
    assert!(shown.starts_with(first), "{shown}");
    let text = SMALL.replace("radius_m = 5", "radius_cm = 500");
    let shown = errors(&text).render();
    let first = "error: x.toml:3:1: tank.radius_cm = 500: unknown key\n  |\n3 | radius_cm = 500\n  | ^^^^^^^^^\n  help: the key is `radius_m`, in m: write radius_m = 5\n";
    assert!(shown.contains(first), "{shown}");
}

/// A text in the small scenario, a faulty replacement, and the resulting message.
const MISTAKES: &[(&str, &str, &str)] = &[
    ("radius_m = 5", "radius_m = -5", "3:12: tank.radius_m = -5: must be greater than 0 m"),
    ("radius_m = 5", "radius_m = 5e9", "3:12: tank.radius_m = 5e9: must be at most 1000 m"),
    ("radius_m = 5", "radius_m = nan", "3:12: tank.radius_m = nan: must be a finite number"),
    ("radius_m = 5", "radius_m = 1e999", "3:12: tank.radius_m = 1e999: must be a finite number"),
    ("radius_m = 5", "radius_m = \"5\"", "3:12: tank.radius_m = \"5\": must be a number"),
    (
        "radius_m = 5",
        "vertices_m = [[0, 0], [1, 1]]",
        "3:14: tank.vertices_m = [[0, 0], [1, 1]]: needs 3 or more entries, but has 2",
    ),
    (
        "radius_m = 5",
        "vertices_m = [[-5, -5], [5, 5], [5, -5], [-5, 5]]",
        "3:14: tank.vertices_m = [[-5, -5], [5, 5], [5, -5], [-5, 5]]: sides 1 and 3 cross",
    ),
    (
        "name = \"small\"",
        "name = \"../x\"",
        "1:8: name = \"../x\": must be at most 64 letters, digits, `-`, `_` or `.`, beginning with a letter or a digit",
    ),
    ("name = \"small\"", "name = \"small\"\nseed = -1", "2:8: seed = -1: must be at least 0"),
    ("name = \"small\"", "name = \"small\"\nseed = 1.5", "2:8: seed = 1.5: must be a whole number"),
    ("[planner]", "[winch]\nlength_m = 30\n[planner]", "11:2: winch: unknown key"),
    (
        "[planner]",
        "[tether]\nreel_length_m = 0\n[planner]",
        "12:17: tether.reel_length_m = 0: must be greater than 0 m",
    ),
    (
        "[planner]",
        "[tether]\nreel_length_m = 9\nanchor_m = [0, 7]\n[planner]",
        "13:12: tether.anchor_m = [0, 7]: is 2.000 m outside the tank",
    ),
    (
        "[planner]",
        "[tether]\nreel_length_m = 1\nanchor_m = [0, 0]\n[planner]",
        "12:17: tether.reel_length_m = 1: must be at least 3.00 m, the distance from the anchor to the start",
    ),
    (
        "kind = \"goto\"",
        "kind = \"hover\"",
        "7:8: mission.kind = \"hover\": must be one of goto, follow, cover, survey",
    ),
    ("goal_m = [3, 0]", "goal_m = [6, 0]", "8:10: mission.goal_m = [6, 0]: is 1.000 m outside the tank"),
    (
        "goal_m = [3, 0]",
        "goal_m = [4.9, 0]",
        "8:10: mission.goal_m = [4.9, 0]: the hull would reach 0.150 m into the wall",
    ),
    ("goal_m = [3, 0]", "goal_m = 3", "8:10: mission.goal_m = 3: must be a pair of numbers"),
    (
        "goal_m = [3, 0]",
        "goal_m = [3, 0]\ncell_m = 0.001",
        "9:10: mission.cell_m = 0.001: 100000000 cells; at most 4000000",
    ),
    (
        "goal_m = [3, 0]",
        "goal_m = [3, 0]\ntime_limit_s = 1e7",
        "9:16: mission.time_limit_s = 1e7: 100000000 ticks of 0.1 s; at most 10000000",
    ),
    (
        "goal_m = [3, 0]",
        "goal_m = [3, 0]\ntolerance_m = 0.001",
        "9:15: mission.tolerance_m = 0.001: must be at least 0.01 m: a robot that is steered once per tick cannot stop closer to a point",
    ),
    ("goal_m = [3, 0]", "goal_m = [3, 0]\ntick_s = 0", "9:10: mission.tick_s = 0: must be at least 0.001 s"),
    ("goal_m = [3, 0]", "goal_m = [3, 0]\ntick_s = 2", "4:1: ae.period_s: must be at least one tick, 2 s"),
    ("goal_m = [3, 0]", "", "6:1: mission.goal_m: missing"),
    ("start_m = [-3, 0]", "start_m = [-7, 0]", "10:11: robot.start_m = [-7, 0]: is 2.000 m outside the tank"),
    ("start_m = [-3, 0]", "", "9:1: robot.start_m: missing"),
    (
        "start_m = [-3, 0]",
        "start_m = [-3, 0]\nspeed_max_m_per_s = 0",
        "11:21: robot.speed_max_m_per_s = 0: must be greater than 0 m/s",
    ),
    (
        "start_m = [-3, 0]",
        "start_m = [-3, 0]\nspeed_max_kmh = 3.6",
        "11:1: robot.speed_max_kmh = 3.6: unknown key",
    ),
    (
        "start_m = [-3, 0]",
        "start_m = [-3, 0]\nradius_m = 0",
        "11:12: robot.radius_m = 0: must be greater than 0 m; only a robot with motion = \"point\" has no hull",
    ),
    (
        "start_m = [-3, 0]",
        "start_m = [-3, 0]\nmotion = \"amphibious\"\nspeed_max_m_per_s = 1",
        "12:21: robot.speed_max_m_per_s = 1: has no effect with motion = \"amphibious\"",
    ),
    (
        "start_m = [-3, 0]",
        "start_m = [-3, 0]\ntransition_ticks = 5",
        "11:20: robot.transition_ticks = 5: has no effect with motion = \"unicycle\"",
    ),
    ("at_m = [0, 5]", "at_m = [0, 5.5]", "5:65: ae.stations.1.at_m = [0, 5.5]: is 0.500 m outside the tank"),
    (
        "at_m = [0, 5]",
        "at_m = [5, 0]",
        "5:65: ae.stations.1.at_m = [5, 0]: is the same as that of station \"A\"",
    ),
    (
        "[ae]",
        "[ae]\nsession_calibration = \"cubic\"",
        "5:23: ae.session_calibration = \"cubic\": must be one of off, constant, linear",
    ),
    (
        "[ae]",
        "[ae]\nsession_calibration = \"linear\"",
        "5:23: ae.session_calibration = \"linear\": must be \"off\" with fewer than 4 stations: none of them could be tested",
    ),
    (
        "[ae]",
        "[ae]\nsession_fixes = 30",
        "5:17: ae.session_fixes = 30: has no effect with session_calibration = \"off\"",
    ),
    ("[ae]", "[ae]\nsession_fixes = 19", "5:17: ae.session_fixes = 19: must be at least 20"),
    ("[ae]", "[ae]\nsession_fixes = 201", "5:17: ae.session_fixes = 201: must be at most 200"),
    ("[ae]", "[ae]\nsession_fixes = 1e99", "5:17: ae.session_fixes = 1e99: must be a whole number"),
    (
        "[ae]",
        "[ae]\nbiased_station = \"correct\"",
        "5:18: ae.biased_station = \"correct\": has no effect with session_calibration = \"off\"",
    ),
    (
        "[ae]",
        "[ae]\nbiased_station = \"ignore\"",
        "5:18: ae.biased_station = \"ignore\": must be one of exclude, correct",
    ),
    (
        "[ae]",
        "[ae]\nclock_offset_sigma_m = 1",
        "5:24: ae.clock_offset_sigma_m = 1: has no effect with emission_time = \"known\"",
    ),
    (
        "[ae]",
        "[ae]\nemission_time = \"late\"",
        "5:17: ae.emission_time = \"late\": must be one of known, unknown",
    ),
    // One mistake has one message.
    (
        "[ae]",
        "[ae]\nclock_offset_sigma_m = 3\nemission_time = \"unknow\"",
        "6:17: ae.emission_time = \"unknow\": must be one of known, unknown",
    ),
    (
        "[ae]",
        "[ae]\nemission_time = \"unknown\"",
        "5:17: ae.emission_time = \"unknown\": must be \"known\" with fewer than 4 stations: the position has two unknowns, the time of emission is a third, and one station excludes mirror images",
    ),
    (
        "name = \"B\"",
        "name = \"A\"",
        "5:53: ae.stations.1.name = \"A\": is the same as that of ae.stations.0.name",
    ),
    (
        ", { name = \"B\", at_m = [0, 5] }",
        "",
        "5:12: ae.stations = [{ name = \"A\", at_m = [5, 0] }]: only 1 given; at least 2 stations are needed",
    ),
    ("id = \"apf\"", "", "11:1: planner.id: missing"),
    (
        "id = \"apf\"",
        "id = \"apf\"\nparameters.k = [1]",
        "13:16: planner.parameters.k = [1]: must be a number, a flag or a word",
    ),
    (
        "id = \"apf\"",
        "id = \"apf\"\n[expect]\noutcome = \"compete\"",
        "14:11: expect.outcome = \"compete\": must be one of complete, stuck, collision, time_limit, entangled, aborted",
    ),
];

#[test]
fn each_mistake_has_its_place_and_its_sentence() {
    let found: Vec<String> = MISTAKES.iter().map(|(from, to, _)| complaint(from, to)).collect();
    assert_eq!(found, MISTAKES.iter().map(|mistake| mistake.2).collect::<Vec<_>>());
}

#[test]
fn each_mistake_in_an_obstacle_has_its_sentence() {
    let cases: &[(&str, &str)] = &[
        ("kind = \"circle\"\ncenter_m = [0, 0]", "13:1: obstacles.0.radius_m: missing"),
        (
            "kind = \"circle\"\ncenter_m = [0, 0]\nradius_m = 0",
            "16:12: obstacles.0.radius_m = 0: must be greater than 0 m",
        ),
        (
            "kind = \"circle\"\ncenter_m = [0, 0]\nradius_m = 1\nwidth_m = 1",
            "17:11: obstacles.0.width_m = 1: has no effect with kind = \"circle\"",
        ),
        (
            "kind = \"circle\"\ncenter_m = [9, 0]\nradius_m = 1",
            "13:1: obstacles.0: is completely outside the tank",
        ),
        (
            "kind = \"circle\"\ncenter_m = [-3, 0]\nradius_m = 1",
            "10:11: robot.start_m = [-3, 0]: is inside obstacle \"obstacle 1\"",
        ),
        (
            "kind = \"circle\"\ncenter_m = [3, 1]\nradius_m = 0.9",
            "8:10: mission.goal_m = [3, 0]: the hull would reach 0.150 m into obstacle \"obstacle 1\"",
        ),
        (
            "kind = \"box\"\ncenter_m = [0, 0]\nsize_m = [1, 0]",
            "16:14: obstacles.0.size_m = 0: must be greater than 0 m",
        ),
        (
            "kind = \"polygon\"\nvertices_m = [[0, 0], [2, 1], [0, 2], [0.5, 1]]",
            "15:14: obstacles.0.vertices_m = [[0, 0], [2, 1], [0, 2], [0.5, 1]]: not convex at [0.5, 1]",
        ),
        (
            "kind = \"polygon\"\nvertices_m = [[0, 0], [1, 1], [2, 2]]",
            "15:14: obstacles.0.vertices_m = [[0, 0], [1, 1], [2, 2]]: the points enclose no area",
        ),
        (
            "kind = \"cirle\"",
            "14:8: obstacles.0.kind = \"cirle\": must be one of circle, box, polygon, polyline",
        ),
    ];
    let with = |obstacle: &str| format!("id = \"apf\"\n[[obstacles]]\n{obstacle}\n");
    let found: Vec<String> =
        cases.iter().map(|(obstacle, _)| complaint("id = \"apf\"\n", &with(obstacle))).collect();
    assert_eq!(found, cases.iter().map(|case| case.1).collect::<Vec<_>>());
}

#[test]
fn an_error_for_a_spiral_that_does_not_fit_names_one_that_does() {
    let spiral = |outer_m: f64| {
        let task = format!("kind = \"follow\"\nspiral = {{ outer_radius_m = {outer_m}, pitch_m = 1 }}");
        SMALL.replace("kind = \"goto\"\ngoal_m = [3, 0]", &task)
    };
    let shown = errors(&spiral(5.0)).render();
    assert!(shown.contains("larger than the tank minus the robot's radius: at most 4.75 m"), "{shown}");
    assert!(shown.contains("help: write outer_radius_m = 4.75"), "{shown}");
    read(&spiral(4.75));
}

#[test]
fn a_clockwise_polygon_is_turned_round() {
    let corners = "kind = \"polygon\"\nvertices_m = [[0, 0], [0, 1], [1, 1], [1, 0]]";
    let scenario = read(&format!("{SMALL}[[obstacles]]\n{corners}\n"));
    let Shape::Polygon { vertices } = &scenario.sim.world.obstacles[0].shape else { panic!("a polygon") };
    assert!((world::shape::ring_area_m2(vertices) - 1.0).abs() < 1e-12);
    assert_eq!(scenario.sim.world.obstacles[0].id, ObstacleId(1));
}

#[test]
fn all_errors_are_reported_at_once() {
    let text = SMALL
        .replace("radius_m = 5", "radius_m = 0\nraduis_m = 1")
        .replace("goal_m = [3, 0]", "goal_m = [3]\nswath = 0.5")
        .replace("id = \"apf\"", "id = 7");
    let errors = errors(&text);
    let keys: Vec<&str> = errors.problems.iter().map(|problem| problem.key.as_str()).collect();
    assert_eq!(keys, ["tank.radius_m", "tank.raduis_m", "mission.goal_m", "mission.swath", "planner.id"]);
    let shown = errors.render();
    assert!(
        shown.contains("did you mean `radius_m`?") && shown.contains("the key is `swath_m`, in m"),
        "{shown}"
    );
}

#[test]
fn single_brackets_round_obstacles_are_explained() {
    let shown = errors(&format!("{SMALL}[obstacles]\nkind = \"circle\"\n")).render();
    assert!(shown.contains("write [[obstacles]] in double brackets"), "{shown}");
}

#[test]
fn too_many_random_obstacles_say_how_many_found_room() {
    let crowd = "[random_obstacles]\ncount = 500\nradius_m = [0.5, 0.5]\nmin_gap_m = 0.6\n";
    let shown = errors(&format!("{SMALL}{crowd}")).render();
    assert!(
        shown.contains("random_obstacles.count = 500: only ") && shown.contains(" of them fit"),
        "{shown}"
    );
}

#[test]
fn what_is_no_scenario_at_all_is_refused_quickly_and_shortly() {
    let folder = tempfile::tempdir().expect("a folder");
    let noise: Vec<u8> = (0..10_000_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let cases: [(&str, &[u8], &str); 5] = [
        ("noise.toml", &noise, "larger than 8000 kB"),
        ("binary.toml", &noise[..5000], "is not UTF-8"),
        ("empty.toml", b"", "name: missing"),
        ("words.toml", b"this is not toml\n", "words.toml:1:"),
        ("deep.toml", &b"[".repeat(900_000), "invalid TOML"),
    ];
    for (name, bytes, expected) in cases {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("a file");
        let begun = Instant::now();
        let shown = Scenario::read_with(&path, &Settings::default()).expect_err(name).render();
        assert!(begun.elapsed().as_secs() < 5, "{name} took {:?}", begun.elapsed());
        assert!(shown.contains(expected) && shown.len() < 2500, "{name}: {shown}");
    }
    let missing = Scenario::read_with(&folder.path().join("none.toml"), &Settings::default())
        .expect_err("no file")
        .render();
    assert!(missing.contains("none.toml: cannot be read: No such file"), "{missing}");
}

#[test]
fn control_characters_of_the_file_do_not_reach_the_terminal() {
    let shown = errors(&SMALL.replace("radius_m = 5", "\"\\u001b[31m\" = \"\u{85}\"")).render();
    assert!(shown.chars().all(|c| c == '\n' || !c.is_control()), "{shown:?}");
}

#[test]
fn the_document_lists_every_key_with_unit_default_and_range() {
    for (path, keys) in schema::sections() {
        let head = if path.is_empty() { "## The whole file".to_owned() } else { format!("`{path}`") };
        let section = DOC
            .split("\n## ")
            .find(|section| section.lines().next().is_some_and(|line| format!("## {line}").contains(&head)))
            .unwrap_or_else(|| panic!("no section for {head}"));
        for key in keys {
            let row = document_row(key);
            assert!(section.contains(&row), "the section of {head} needs a row that begins with\n{row}");
        }
    }
}

/// The beginning of a key's row in the document.
fn document_row(key: &schema::Key) -> String {
    use schema::{Default, Kind};
    let holds = match key.kind {
        Kind::Number(span) => format!("number {span}"),
        Kind::Whole(low, i64::MAX) => format!("whole number ≥ {low}"),
        Kind::Whole(low, high) => format!("whole number ≥ {low}, ≤ {high}"),
        Kind::Flag => "`true` or `false`".into(),
        Kind::Text => "text".into(),
        Kind::Slug => "name without blanks".into(),
        Kind::Word(words) => words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", "),
        Kind::Point => "`[x, y]`".into(),
        Kind::Points(need) => format!("`[[x, y], ...]`, {need} or more"),
        Kind::Pair(span) => format!("`[a, b]`, each {span}"),
        Kind::Times => "`[[from, to], ...]`".into(),
        Kind::Texts => "`[\"...\", ...]`".into(),
        Kind::Boxes => "`[[west, south, east, north], ...]`".into(),
        Kind::Table(_) => "table".into(),
        Kind::Tables(_) => "list of tables".into(),
        Kind::Free => "table of numbers, flags, words".into(),
    };
    let default = match key.default {
        Default::Required => "**required**".into(),
        Default::Absent(instead) => instead.into(),
        Default::Number(number) => number.to_string(),
        Default::Whole(number) => number.to_string(),
        Default::Flag(flag) => format!("`{flag}`"),
        Default::Word(word) => format!("`{word}`"),
    };
    let unit = if key.unit.is_empty() { "" } else { key.unit };
    format!("| `{}` | {unit} | {holds} | {default} |", key.name).replace("|  |", "| |")
}

/// Texts that replace a value.
fn values() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<f64>().prop_map(|number| number.to_string()),
        any::<i64>().prop_map(|number| number.to_string()),
        (-20.0..20.0_f64).prop_map(|number| number.to_string()),
        (any::<i8>(), any::<i8>()).prop_map(|(x, y)| format!("[{x}, {y}]")),
        "[a-z\"\\[\\]{}=.,# ]{0,12}",
        Just("true".to_owned()),
        Just("[]".to_owned()),
        Just("{}".to_owned()),
    ]
}

/// Checks that a text is either accepted or refused with a message, within seconds.
fn survives(text: &str) -> Result<(), TestCaseError> {
    let begun = Instant::now();
    match Scenario::parse(text, "x.toml") {
        Err(errors) => prop_assert!(errors.render().starts_with("error: x.toml")),
        Ok(scenario) => {
            prop_assert!(scenario.mission.start.position.coords.iter().all(|number| number.is_finite()));
            prop_assert_eq!(&Scenario::parse(&scenario.text, &scenario.shown_name), &Ok(scenario.clone()));
        }
    }
    prop_assert!(begun.elapsed().as_secs() < 5, "took {:?}", begun.elapsed());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..2000)) {
        survives(&String::from_utf8_lossy(&bytes))?;
    }

    #[test]
    fn a_demo_with_other_values_never_panics(changes in prop::collection::vec((any::<prop::sample::Index>(), values()), 1..6)) {
        let mut lines: Vec<String> = DEMO.lines().map(str::to_owned).collect();
        for (at, value) in changes {
            let line = at.get(&lines).clone();
            if let Some((key, _)) = line.split_once('=') {
                let i = at.index(lines.len());
                lines[i] = format!("{key}= {value}");
            }
        }
        survives(&lines.join("\n"))?;
    }

    #[test]
    fn a_demo_with_lines_lost_doubled_and_swapped_never_panics(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..3_u8), 1..8)) {
        let mut lines: Vec<&str> = DEMO.lines().collect();
        for (a, b, what) in changes {
            let (a, b) = (a.index(lines.len()), b.index(lines.len()));
            match what {
                0 => drop(lines.remove(a)),
                1 => lines.insert(a, lines[b]),
                _ => lines.swap(a, b),
            }
        }
        survives(&lines.join("\n"))?;
    }

    #[test]
    fn a_demo_with_bytes_changed_never_panics(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..20)) {
        let mut bytes = DEMO.as_bytes().to_vec();
        for (at, byte) in changes {
            let i = at.index(bytes.len());
            bytes[i] = byte;
        }
        survives(&String::from_utf8_lossy(&bytes))?;
    }

    #[test]
    fn any_setting_is_put_in_or_refused(key in "[a-z_.0-9]{0,30}", value in values(), planner in "[a-z\"\\\\\n]{0,6}") {
        let settings = Settings { set: vec![format!("{key}={value}")], planner: Some(planner), seed: None };
        match Scenario::parse_with(DEMO, "x.toml", &settings) {
            Ok(scenario) => prop_assert_eq!(&Scenario::parse(&scenario.text, &scenario.shown_name), &Ok(scenario.clone())),
            Err(errors) => prop_assert!(errors.render().starts_with("error: x.toml")),
        }
    }
}

#[test]
fn plates_have_sizes_or_outlines() {
    let with = |plates: &str| format!("{SMALL}[plates]\n{plates}\n");
    let two = r#"outlines = [
    { name = "P-01", vertices_m = [[0, 0], [0, 2], [3, 2], [1, 1], [3, 0]] },
    { name = "P-02", vertices_m = [[-2, -2], [0, -2], [0, 0]] },
]"#;
    let Some(PlateLayout::Drawn { plates }) = read(&with(two)).plates else { panic!("they are drawn") };
    assert_eq!((plates.len(), plates[0].name.as_str(), plates[0].vertices_m.len()), (2, "P-01", 5));
    assert!(matches!(read(&with("")).plates, Some(PlateLayout::Regular(_))));
    let cases = [
        (format!("plate_width_m = 2\n{two}"), "plates.plate_width_m = 2"),
        (two.replace("P-02", "P-01"), "the same as that of plates.outlines.0.name"),
        (two.replace("P-02", "no plate"), "the same as that of the floor outside all plates"),
        (two.replace("[0, -2], [0, 0]", "[0, 0], [0, -2], [-2, 0]"), "sides 1 and 3 cross"),
        (
            two.replace("[[-2, -2], [0, -2], [0, 0]]", "[[7, 7], [8, 7], [8, 8]]"),
            "is completely outside the tank",
        ),
        (two.replace("name = \"P-02\", ", ""), "plates.outlines.1.name: missing"),
        ("outlines = []".into(), "plates.outlines"),
    ];
    for (plates, wanted) in cases {
        let shown = errors(&with(&plates)).render();
        assert!(shown.starts_with("error: x.toml:") && shown.contains(wanted), "{wanted}: {shown}");
        assert_eq!(errors(&with(&plates)).problems.len(), 1, "{shown}");
    }
}

#[test]
fn a_scanner_is_read_with_its_defaults_and_wrong_ones_are_named() {
    let with = |keys: &str| format!("{SMALL}[robot.scanner]\n{keys}");
    let found = read(&with("rays = 180\nheading_deg = 90.0\noffset_m = [0.1, 0.0]"));
    let scanner = found.sim.robot.scanner.unwrap();
    let wanted = world::Scanner {
        rays: 180,
        heading_rad: std::f64::consts::FRAC_PI_2,
        offset_m: [0.1, 0.0],
        ..world::Scanner::default()
    };
    assert_eq!(scanner, wanted);
    assert_eq!(found.mission.sensor, Some(mission::Sensor::of(&wanted)));
    assert!(found.mission.guard_reaction_s.is_some() && read(SMALL).mission.guard_reaction_s.is_none());
    for (keys, key, why) in [
        ("rays = 17", "robot.scanner.rays", "at least 18"),
        ("rate_hz = 1.0", "robot.scanner.rate_hz", "the guard must not drive blind"),
        ("offset_m = [3.0, 0.0]", "robot.scanner.offset_m", "within the hull"),
        ("range_m = 0.1", "robot.scanner.range_m", "greater than the radius of the hull"),
        ("lost_share = 0.71", "robot.scanner.lost_share", "at most 0.7"),
        ("ray = 9", "robot.scanner.ray", "rays"),
    ] {
        let text = errors(&with(keys)).render();
        assert!(text.contains(key) && text.contains(why), "{text}");
    }
}

#[test]
fn a_reel_is_read_with_its_defaults_and_wrong_keys_are_named() {
    let with = |keys: &str| format!("{SMALL}[tether]\nreel_length_m = 30.0\n{keys}");
    assert_eq!(read(&with("")).mission.tether.unwrap().reel, None);
    let wanted = world::tether::Reel {
        mass_kg_per_m: 0.1,
        floor_friction: 0.3,
        pull_n: 6.0,
        pay_out_n: 0.5,
        robot_pull_n: None,
        pull_ratio_max: 0.8,
    };
    let reel = read(&with("reel_pull_n = 6.0")).mission.tether.unwrap().reel;
    assert_eq!(reel, Some(wanted));
    let others = "reel_pull_n = 6.0\nmass_kg_per_m = 0.3\nrobot_pull_n = 40.0\npull_ratio_max = 0.7";
    let reel = read(&with(others)).mission.tether.unwrap().reel.unwrap();
    assert_eq!((reel.mass_kg_per_m, reel.robot_pull_n, reel.pull_ratio_max), (0.3, Some(40.0), 0.7));
    for (keys, key, why) in [
        ("mass_kg_per_m = 0.2", "tether.reel_pull_n", "tether.mass_kg_per_m has no effect"),
        ("reel_pull_n = 0.0", "tether.reel_pull_n", "at least 0.1 N"),
        ("reel_pull_n = 6.0\nrobot_pull_n = 1e-9", "tether.robot_pull_n", "at least 0.1 N"),
        ("reel_pull_n = nan", "tether.reel_pull_n", "finite"),
        ("reel_pull_n = 6.0\nmass_kg_per_m = 1e9", "tether.mass_kg_per_m", "at most 20 kg/m"),
        ("reel_pull_n = 6.0\nfloor_friction = -0.1", "tether.floor_friction", "at least 0"),
        ("reel_pull_n = 6.0\npull_ratio_max = 1.2", "tether.pull_ratio_max", "at most 1"),
        ("reel_pull_n = 6.0\nreel_speed_m_per_s = 0.01", "tether.reel_speed_m_per_s", "speed of the robot"),
        ("reel_pull = 6.0", "tether.reel_pull", "reel_pull_n"),
    ] {
        let text = errors(&with(keys)).render();
        assert!(text.contains(key) && text.contains(why), "{text}");
    }
}

#[test]
fn a_physical_cable_needs_a_reel_and_only_it_can_have_a_reel_that_fails() {
    let with = |keys: &str| format!("{SMALL}[tether]\nreel_length_m = 30.0\nreel_pull_n = 6.0\n{keys}");
    assert_eq!(read(&with("")).sim.physical, None);
    let scenario = read(&with(
        "model = \"physical\"\nreel_fails_at_s = 9.0\nbreaks_at_s = 12.0\nbreaks_at_n = 400.0\nfriction = 0.2",
    ));
    let physical = scenario.sim.physical.unwrap();
    let law = physical.law;
    assert_eq!((law.pull_n, law.pay_out_n, law.friction, law.length_m), (6.0, 0.5, 0.2, 30.0));
    assert!((law.floor_n_per_m - 0.3 * 0.1 * 9.80665).abs() < 1e-12);
    let faults = (physical.fails_at_s, physical.breaks_at_s, physical.breaks_at_n);
    assert_eq!(faults, (Some(9.0), Some(12.0), Some(400.0)));
    let weightless = format!("{SMALL}[tether]\nreel_length_m = 30.0\nmodel = \"physical\"");
    for (text, key, why) in [
        (weightless, "tether.reel_pull_n", "a physical cable needs it"),
        (with("reel_fails_at_s = 9.0"), "tether.reel_fails_at_s", "taut tether"),
        (with("breaks_at_s = 9.0"), "tether.breaks_at_s", "taut tether"),
        (with("breaks_at_n = 9.0"), "tether.breaks_at_n", "taut tether"),
        (with("model = \"physical\"\nbreaks_at_s = -1.0"), "tether.breaks_at_s", "at least 0"),
        (with("model = \"physical\"\nbreaks_at_s = nan"), "tether.breaks_at_s", "finite"),
        (with("model = \"physical\"\nbreaks_at_n = 0.0"), "tether.breaks_at_n", "at least 0.1 N"),
        (with("model = \"physical\"\nbreaks_at_n = inf"), "tether.breaks_at_n", "finite"),
        (with("model = \"elastic\""), "tether.model", "physical"),
        (with("model = \"physical\"").replace("= 30.0", "= 301.0"), "tether.reel_length_m", "at most 300 m"),
    ] {
        let text = errors(&text).render();
        assert!(text.contains(key) && text.contains(why), "{text}");
    }
}

#[test]
fn an_instrument_needs_welds_and_bands_that_cells_can_show() {
    let with = |rest: &str| format!("{SMALL}[instrument]\n{rest}\n");
    let welded = |rest: &str| format!("{SMALL}[plates]\n[instrument]\n{rest}\n");
    let instrument = |text: &str| read(text).mission.instrument;
    assert_eq!(instrument(SMALL), None);
    let ut = instrument(&with("kind = \"ut\"")).unwrap();
    assert_eq!((ut.kind, ut.dead_bands), (mission::InstrumentKind::Ut, None));
    let text = welded("kind = \"mfl\"\ndead_band_m = 0.03\ndead_square_m = 0.2");
    let bands = instrument(&text).unwrap().dead_bands.unwrap();
    assert_eq!((bands.band_m, bands.square_m), (0.03, 0.2));
    assert_eq!(Some(bands.plates), read(&text).plates);
    let cases = [
        (with(""), "instrument.kind: missing"),
        (with("kind = \"eddy\""), "instrument.kind = \"eddy\""),
        (with("kind = \"mfl\"\ndead_band_m = 0.05"), "add [plates], whose seams are the welds"),
        (
            welded("kind = \"mfl\"\ndead_band_m = 0.02"),
            "instrument.dead_band_m = 0.02: must be 0, or at least 0.025 m",
        ),
        (
            welded("kind = \"mfl\"\ndead_square_m = 0.04"),
            "instrument.dead_square_m = 0.04: must be 0, or at least 0.05 m",
        ),
        (welded("kind = \"mfl\"\ndead_bands_m = 0.04"), "dead_band_m"),
    ];
    for (text, wanted) in cases {
        let shown = errors(&text).render();
        assert!(shown.contains(wanted), "{wanted}:\n{shown}");
        assert_eq!(errors(&text).problems.len(), 1, "{shown}");
    }
}

#[test]
fn readings_need_a_thickness_and_losses_fit_into_the_floor() {
    let with = |rest: &str| format!("{SMALL}{rest}\n");
    let instrument = "[instrument]\nkind = \"mfl\"\nchannels = 20\n";
    let sampling = |text: &str| read(text).mission.instrument.unwrap().sampling.unwrap();
    let read_20 = sampling(&with(&format!("{instrument}thickness_mm = 8")));
    assert_eq!(
        (read_20.channels, read_20.pitch_m, read_20.sigma_mm, read_20.threshold),
        (20, 0.005, 0.3, 0.2)
    );
    let pits = "[wear]\nthickness_mm = 8\nrandom = { count = 50, radius_m = [0.01, 0.05], depth_mm = [1, 7] }\n\
                losses = [{ at_m = [1, 0], radius_m = 0.1, depth_mm = 2 }]";
    let wear = |text: &str| read(text).wear.unwrap();
    let first = wear(&with(pits));
    assert_eq!((first.losses.len(), first.left_mm(Point::new(1.0, 0.0)) <= 6.0), (51, true));
    assert_eq!(first, wear(&with(pits)), "the seed determines the pits");
    assert_ne!(
        first.losses,
        wear(&with(&pits.replace("depth_mm = [1, 7]", "depth_mm = [1, 7], seed = 9"))).losses
    );
    let cases = [
        (with(instrument), "add thickness_mm"),
        (with("[wear]"), "wear.thickness_mm: missing"),
        (with(&pits.replace("[1, 7]", "[1, 9]")), "wear.random.depth_mm = [1, 9]: must be at most 8 mm"),
        (with(&pits.replace("[1, 7]", "[7, 1]")), "[smallest, largest]"),
        (
            with(&pits.replace("depth_mm = 2", "depth_mm = 12")),
            "wear.losses.0.depth_mm = 12: must be at most 8 mm",
        ),
        (with(&pits.replace("at_m = [1, 0]", "at_m = [9, 0]")), "wear.losses.0.at_m"),
        (
            with(&pits.replace("depth_mm = 2", "depth_mm = -2")),
            "wear.losses.0.depth_mm = -2: must be greater than 0 mm",
        ),
    ];
    for (text, wanted) in cases {
        let shown = errors(&text).render();
        assert!(shown.contains(wanted), "{wanted}:\n{shown}");
        assert_eq!(errors(&text).problems.len(), 1, "{shown}");
    }
}

#[test]
fn dead_channels_are_channels_of_the_instrument_for_a_time() {
    let with = |rest: &str| format!("{SMALL}[instrument]\nkind = \"mfl\"\n{rest}\n");
    let twenty = |dead: &str| with(&format!("channels = 20\nthickness_mm = 8\ndead = [{dead}]"));
    let faults = read(&twenty("{ channel = 19, from_s = 60, to_s = 120 }")).sim.channel_faults;
    assert_eq!(faults, [sim::ChannelFault { channel: 19, from_s: 60.0, to_s: 120.0 }]);
    assert!(read(SMALL).sim.channel_faults.is_empty());
    let cases = [
        (twenty("{ channel = 20, from_s = 60, to_s = 120 }"), "0 to 19: [instrument] has 20 channels"),
        (twenty("{ channel = 2, from_s = 60, to_s = 60 }"), "greater than from_s, 60 s"),
        (twenty("{ from_s = 60, to_s = 70 }"), "channel: missing"),
        (with("dead = [{ channel = 2, from_s = 60, to_s = 70 }]"), "add channels = ..."),
    ];
    for (text, wanted) in cases {
        let shown = errors(&text).render();
        assert!(shown.contains(wanted), "{wanted}:\n{shown}");
        assert_eq!(errors(&text).problems.len(), 1, "{shown}");
    }
}

/// Five stations with clocks of their own, whose keys may be replaced.
fn differences(from: &str, to: &str) -> Result<Scenario, ScenarioErrors> {
    let stations = r#"emission_time = "unknown"
clock_offset_sigma_m = 3
integrity_risk = 1e-5
stations = [
    { name = "A", at_m = [5, 0] }, { name = "B", at_m = [0, 5] }, { name = "C", at_m = [-5, 0] },
    { name = "D", at_m = [0, -5] }, { name = "E", at_m = [3, 3] },
]"#;
    let from_small = "stations = [{ name = \"A\", at_m = [5, 0] }, { name = \"B\", at_m = [0, 5] }]";
    assert!(SMALL.contains(from_small) && stations.contains(from), "{from}");
    Scenario::parse(&SMALL.replace(from_small, &stations.replace(from, to)), "x.toml")
}

#[test]
fn an_unknown_time_of_emission_uses_differences_and_clocks_of_their_own_are_passed_on() {
    let read = differences("integrity_risk = 1e-5", "integrity_risk = 1e-5")
        .unwrap_or_else(|errors| panic!("{}", errors.render()));
    let locating = &read.mission.locating;
    assert_eq!(locating.solver, positioning::SolverKind::Differences);
    assert_eq!(locating.clocks.map(|clocks| clocks.offset_sigma_m), Some(3.0));
    assert!(read.sim.ae.unwrap().clocks.is_emission_unknown);
    assert!(read.mission.forecast(0.5).is_emission_unknown);
}

#[test]
fn stations_that_exchange_pulses_are_simulated_and_expected() {
    let with = differences("integrity_risk = 1e-5", "integrity_risk = 1e-5\npulse_rest_s = 5")
        .unwrap_or_else(|errors| panic!("{}", errors.render()));
    assert_eq!(with.mission.locating.pulse_rest_s, Some(5.0));
    assert_eq!(with.sim.ae.unwrap().pulse_rest_s, Some(5.0));
    let never = differences("integrity_risk = 1e-5", "integrity_risk = 1e-5\npulse_rest_s = 0")
        .map(|_| ())
        .map_err(|errors| errors.render());
    assert!(never.as_ref().is_err_and(|words| words.contains("ae.pulse_rest_s = 0")), "{never:?}");
}

#[test]
fn too_few_stations_for_differences_or_stations_on_one_line_are_refused_with_the_reason() {
    let said = |from: &str, to: &str| match differences(from, to) {
        Ok(_) => panic!("{to} is accepted"),
        Err(errors) => errors.render(),
    };
    let four = said(", { name = \"E\", at_m = [3, 3] }", "");
    assert!(four.contains("fewer than 5 stations: with four, a wrong clock would not show"), "{four}");
    assert!(four.contains("without one of them, the others give no fix"), "{four}");
    let on_line = "stations = [ { name = \"A\", at_m = [-4, 1] }, { name = \"B\", at_m = [-2, 1] }, \
                   { name = \"C\", at_m = [0, 1] }, { name = \"D\", at_m = [2, 1] }, { name = \"E\", at_m = [4, 1] }]\n";
    let all = r#"stations = [
    { name = "A", at_m = [5, 0] }, { name = "B", at_m = [0, 5] }, { name = "C", at_m = [-5, 0] },
    { name = "D", at_m = [0, -5] }, { name = "E", at_m = [3, 3] },
]"#;
    let line = said(all, on_line);
    assert!(line.contains("all stations on one line: every place has a mirror image"), "{line}");
    for (key, reason) in [
        ("solver = \"nls\"", "has no effect with emission_time = \"unknown\""),
        ("aggregation = \"midrange\"", "must be \"mean\" or \"trimmed-mean\""),
        ("calibrate_sound_speed = true", "must be false with emission_time = \"unknown\""),
        (
            "session_calibration = \"constant\"",
            "must be \"off\" with clock_offset_sigma_m or clock_drift_sigma_m_per_h: a bias of a station and the offset of \
             its clock",
        ),
    ] {
        let words = said("integrity_risk = 1e-5", &format!("integrity_risk = 1e-5\n{key}"));
        assert!(words.contains(reason), "{key}: {words}");
    }
}

#[test]
fn keys_without_meaning_in_a_survey_are_refused() {
    let survey = include_str!("../../../scenarios/survey-tank.toml");
    let words = |text: &str| match Scenario::parse(text, "x.toml") {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(errors) => errors.render(),
    };
    let expecting = |key: &str| survey.replace("[expect]\n", &format!("[expect]\n{key} = 0.9\n"));
    for key in ["coverage_truth_min", "overlap_max", "recall_min"] {
        assert!(words(&expecting(key)).contains(&format!("expect.{key}")), "{}", words(&expecting(key)));
    }
    assert!(survey.contains("\nexplored_min = ") && Scenario::parse(survey, "x.toml").is_ok());
    assert!(words(&format!("{SMALL}\n[expect]\nexplored_min = 0.9\n")).contains("expect.explored_min"));
    let continued = format!("continues_sha256 = [\"{}\"]\n{survey}", "0".repeat(64));
    assert!(words(&continued).contains("continues_sha256"), "{}", words(&continued));
    let short = words(&survey.replace("range_m = 8.0\nrate_hz", "range_m = 0.5\nrate_hz"));
    assert!(short.contains("range_m = 0.800 or more in a survey (now 0.5)"), "{short}");
}
