//! Robots that brake slowly, turn slowly or have long ticks do not touch anything on the drawing, whatever planner
//! drives them.

use crate::bench::{Bench, Ended, scenario};

/// Pseudo-random numbers from 0 to 1, the same on every machine.
struct Draw(u64);

impl Draw {
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }
}

/// Runs a mission of a robot with other limits and a generous time limit.
fn fly(name: &str, planner: &str, seed: u64, set: &[String]) -> Ended {
    let bench = Bench::new();
    let seed = seed.to_string();
    let mut more =
        vec!["--no-record", "--planner", planner, "--seed", &seed, "--set", "mission.time_limit_s=100000"];
    more.extend(set.iter().flat_map(|setting| ["--set", setting]));
    bench.fly(&scenario(name), &more)
}

#[test]
fn a_scan_by_a_robot_that_brakes_slowly_is_complete_and_touches_nothing() {
    for slow in ["robot.acceleration_m_per_s2=0.2", "robot.speed_max_m_per_s=0.8"] {
        let flown = fly("cover-circle.toml", "tether-safe", 1, &[slow.to_owned()]).json();
        assert_eq!(flown["collisions"], 0, "{slow}: {flown}");
        assert_eq!(flown["outcome"], "complete", "{slow}: {flown}");
    }
}

#[test]
fn a_robot_that_knows_the_shell_only_by_its_position_keeps_off_it() {
    let set = [
        "robot.speed_max_m_per_s=0.344",
        "robot.acceleration_m_per_s2=0.862",
        "mission.tick_s=0.279",
        "robot.turn_rate_max_deg_per_s=94.356",
        "mission.clearance_m=0.019",
    ];
    let flown = fly("cover-circle.toml", "tether-safe", 1, &set.map(str::to_owned)).json();
    assert_eq!((&flown["outcome"], &flown["collisions"]), (&"complete".into(), &0.into()), "{flown}");
}

#[test]
fn whatever_the_robot_can_do_it_touches_nothing_that_is_drawn() {
    let cases = [
        ("goto-single-obstacle.toml", "apf"),
        ("goto-single-obstacle.toml", "navfn"),
        ("laboratory.toml", "shortest"),
        ("laboratory.toml", "bvo-apf"),
        ("demo.toml", "rpf"),
        ("demo.toml", "spiral-tangent"),
    ];
    let mut draw = Draw(20_261_125);
    for (k, (name, planner)) in cases.iter().cycle().take(36).enumerate() {
        let turn_deg = draw.within(10.0, 120.0);
        let set = [
            format!("robot.speed_max_m_per_s={:.3}", draw.within(0.1, 1.5)),
            format!("robot.acceleration_m_per_s2={:.3}", 0.05 * 40.0_f64.powf(draw.share())),
            format!("mission.tick_s={:.3}", draw.within(0.05, 0.5)),
            format!("robot.turn_rate_max_deg_per_s={turn_deg:.1}"),
            format!("mission.clearance_m={:.3}", draw.within(0.0, 0.3)),
        ];
        let flown = fly(name, planner, k as u64, &set);
        // A mission that does not complete is the planner's fault; a robot that touches something is ours.
        let figures = flown.json();
        assert_eq!(figures["collisions"], 0, "{name} {planner} {set:?}: {figures}");
    }
}

#[test]
fn a_planner_that_is_slowed_down_is_named_and_the_run_is_verified() {
    let bench = Bench::new();
    let more = [
        ["--planner", "navfn"],
        ["--set", "robot.speed_max_m_per_s=1.2"],
        ["--set", "robot.acceleration_m_per_s2=0.05"],
    ]
    .concat();
    let flown = bench.fly(&scenario("goto-single-obstacle.toml"), &more);
    assert!(matches!(flown.code, Some(0 | 1)), "{flown:?}");
    let run = bench.runs().pop().expect("it was recorded");
    let journal = crate::bench::journal_text(&run);
    assert!(journal.contains("\"asked\":"), "no command was limited");
    bench.prove(&run);
}
