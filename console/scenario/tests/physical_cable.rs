//! Physical cables with properties at the ends of what a scenario may say: a scenario is refused by naming the key, or the
//! simulated cable has finite figures, and slack of some length is reported.

use mission::{EventKind, tether::Tether};
use planner_api::Drive;
use proptest::{prelude::*, strategy::ValueTree};
use scenario::Scenario;
use sim::Simulator;
use world::{ObstacleMap, Readings};

/// Position error that the rules of the mission allow for, metres.
const ERROR_M: f64 = 0.05;
/// Length of cable off the reel beyond the taut line that must have been reported, metres.
const REPORTED_M: f64 = 1.0;

/// Properties of a cable and its reel, and a column that it may rub on.
#[derive(Debug, Clone)]
struct Extreme {
    mass_kg_per_m: f64,
    floor_friction: f64,
    friction: f64,
    reel_pull_n: f64,
    reel_length_m: f64,
    fault: String,
    /// Distance of the tip of the column, a triangle, from the start, metres.
    tip_m: f64,
    /// Half of the width of the other side of the triangle, metres.
    half_m: f64,
}

impl Extreme {
    fn text(&self) -> String {
        let Self {
            mass_kg_per_m,
            floor_friction,
            friction,
            reel_pull_n,
            reel_length_m,
            fault,
            tip_m,
            half_m,
        } = self;
        format!(
            r#"name = "extreme"
[tank]
radius_m = 5
[[obstacles]]
name = "blade"
kind = "polygon"
vertices_m = [[{:e}, 0.0], [{:e}, -{half_m:e}], [{:e}, {half_m:e}]]
[ae]
stations = [{{ name = "A", at_m = [5, 0] }}, {{ name = "B", at_m = [0, 5] }}]
[mission]
kind = "goto"
goal_m = [3, 3]
[robot]
start_m = [-3, 0]
speed_max_m_per_s = 0.5
[planner]
id = "apf"
[tether]
model = "physical"
mass_kg_per_m = {mass_kg_per_m:e}
floor_friction = {floor_friction:e}
friction = {friction:e}
reel_pull_n = {reel_pull_n:e}
reel_length_m = {reel_length_m:e}
{fault}
"#,
            tip_m - 3.0,
            tip_m - 2.0,
            tip_m - 2.0,
        )
    }
}

/// Numbers over many orders of magnitude.
fn magnitude(low: i32, high: i32) -> impl Strategy<Value = f64> {
    (f64::from(low)..f64::from(high)).prop_map(|power| 10.0_f64.powf(power))
}

/// Mostly a usual number, else one at the ends of what can be written.
fn mostly(
    usual: std::ops::Range<f64>,
    extreme: impl Strategy<Value = f64> + 'static,
) -> impl Strategy<Value = f64> {
    prop_oneof![4 => usual.boxed(), 1 => extreme.boxed()]
}

fn extremes() -> impl Strategy<Value = Extreme> {
    let friction = || mostly(0.0..1.0, prop_oneof![Just(0.0), Just(1.0), 1.0..2.0_f64]);
    let fault = prop_oneof![
        Just(String::new()),
        (0.0..9.0_f64).prop_map(|at_s| format!("reel_fails_at_s = {at_s}")),
        (0.0..9.0_f64).prop_map(|at_s| format!("breaks_at_s = {at_s}")),
        magnitude(-1, 5).prop_map(|at_n| format!("breaks_at_n = {at_n:e}")),
    ];
    (
        mostly(1e-9..20.0, magnitude(-9, 6)),
        friction(),
        friction(),
        mostly(0.1..50.0, magnitude(-9, 9)),
        mostly(1.0..20.0, magnitude(-1, 4)),
        fault,
        0.4..2.5_f64,
        magnitude(-3, 0),
    )
        .prop_map(
            |(mass_kg_per_m, floor_friction, friction, reel_pull_n, reel_length_m, fault, tip_m, half_m)| {
                Extreme {
                    mass_kg_per_m,
                    floor_friction,
                    friction,
                    reel_pull_n,
                    reel_length_m,
                    fault,
                    tip_m,
                    half_m,
                }
            },
        )
}

/// Drives, and the readings and rules of the tether; returns how much cable lay slack at most, metres, and the kinds of
/// alarms whose limit was reached.
fn drive(scenario: &Scenario, drives: &[(f64, f64)]) -> (f64, Vec<&'static str>) {
    let mut sim = Simulator::new(scenario.sim.clone(), 1);
    let config = scenario.mission.tether.as_ref().expect("the scenario has a tether");
    let (world, start) = (&scenario.sim.world, scenario.sim.robot.start.position);
    let map = ObstacleMap::new(&world.boundary, &world.obstacles);
    let mut rules = Tether::new(config, 0.2, world, start).expect("the start is free");
    let (mut slack_m, mut reached) = (0.0_f64, Vec::new());
    for (v_m_per_s, w_rad_per_s) in drives.iter().flat_map(|drive| std::iter::repeat_n(*drive, 20)) {
        let (readings, truth) = (sim.sense(), sim.truth());
        let Readings { paid_out_m, reel_pull_n, robot_pull_n, .. } = readings;
        let figures = [paid_out_m, reel_pull_n, robot_pull_n].map(|figure| figure.expect("it is measured"));
        assert!(figures.iter().all(|figure| figure.is_finite() && *figure >= 0.0), "{figures:?}");
        let lies = truth.tether.expect("there is a tether").lies.expect("the tether is physical");
        assert!(lies.line.iter().all(|at| at.x.is_finite() && at.y.is_finite()), "{:?}", lies.line);
        rules.drag_to(truth.pose.position);
        rules.measure(&readings, Some(ERROR_M), world, scenario.sim.tick_s);
        for event in rules.update(world, &map, scenario.sim.tick_s) {
            match event {
                EventKind::Tethered { length_m, free_m, pull_n, measured, .. } => {
                    slack_m = slack_m.max(figures[0] - length_m);
                    let measured = measured.expect("it is measured");
                    let figures = [length_m, free_m, pull_n.expect("there is a reel"), measured.slack_m];
                    assert!(figures.iter().all(|figure| figure.is_finite()), "{figures:?}");
                }
                EventKind::TetherAlarmRaised { alarm, reached: true } => reached.push(alarm.word()),
                _ => {}
            }
        }
        sim.act(Drive::Twist { v_m_per_s, w_rad_per_s });
    }
    (slack_m, reached)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn absurd_cables_are_refused_by_name_or_have_finite_figures_and_report_their_slack(
        extreme in extremes(),
        drives in prop::collection::vec((-0.3..0.5_f64, -0.8..0.8_f64), 10),
    ) {
        match Scenario::parse(&extreme.text(), "x.toml") {
            Err(errors) => {
                let text = errors.render();
                prop_assert!(text.contains("tether.") || text.contains("blade"), "{text}");
            }
            Ok(scenario) => {
                let (slack_m, reached) = drive(&scenario, &drives);
                prop_assert!(slack_m < REPORTED_M || !reached.is_empty(), "{slack_m} m");
            }
        }
    }
}

#[test]
fn many_of_these_cables_are_simulated() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let made = (0..100).map(|_| extremes().new_tree(&mut runner).expect("it can be made").current());
    let accepted = made.filter(|extreme| Scenario::parse(&extreme.text(), "x.toml").is_ok()).count();
    assert!((20..80).contains(&accepted), "{accepted} of 100");
}
