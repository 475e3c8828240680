//! Measures the position in a tank whose stations fall silent for 60 s, with and without scan matching. Five seeds by
//! default; `FIRST_SEED` and `SEEDS` choose others:
//!
//! ```text
//! SEEDS=20 FIRST_SEED=7000 cargo test --release -p scenario --test matching -- --nocapture
//! ```
#![allow(clippy::unwrap_used, reason = "tests")]

use mission::Locator;
use perception::{Perception, View};
use planner_api::Drive;
use scenario::Scenario;
use sim::Simulator;
use world::{
    ObstacleMap, Point, Pose,
    geometry::{PathFollower, motion::drive_for},
};

const TICK_S: f64 = 0.1;
const SILENT_S: [f64; 2] = [60.0, 120.0];

/// The tank of `cover-scanner`.
fn tank(seed: u64, locates: bool) -> Scenario {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios");
    let text = std::fs::read_to_string(format!("{folder}/cover-scanner.toml")).unwrap();
    let text = text
        .replacen("seed = 1", &format!("seed = {seed}"), 1)
        .replace("lost_share = 0.02", &format!("lost_share = 0.02\nlocates = {locates}"))
        .replace(
            "repetitions = 20",
            &format!("repetitions = 20\noutages_s = [[{}, {}]]", SILENT_S[0], SILENT_S[1]),
        );
    let scenario = Scenario::parse(&text, "matching").unwrap();
    assert_eq!(scenario.mission.sensor.unwrap().locates, locates);
    scenario
}

/// The errors of the position while the stations are silent, metres, in ascending order.
fn errors_m(seed: u64, locates: bool) -> Vec<f64> {
    let scenario = tank(seed, locates);
    let drawing = scenario.sim.world.as_drawn();
    let map = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
    let mut simulator = Simulator::new(scenario.sim.clone(), seed);
    let mut locator = Locator::new(&scenario.mission, &drawing);
    let mut perception = Perception::new(scenario.mission.sensor.unwrap());
    // Up and down in lanes, between the columns.
    let lanes =
        (0..200).map(|n| Point::new(if n % 4 < 2 { -1.0 } else { 1.2 }, 0.5 + 0.6 * f64::from(n / 2 % 5)));
    let path: Vec<Point> = lanes.collect();
    let mut follower = PathFollower::exact(&path);
    let mut errors_m = Vec::new();
    for tick in 0..1300_u32 {
        let t_s = f64::from(tick) * TICK_S;
        let readings = simulator.sense();
        locator.take(&readings, t_s);
        let estimate = locator.pose_estimate();
        let pose = Pose { position: estimate.position, heading_rad: estimate.heading_rad };
        if let Some(scan) = &readings.scan {
            perception.look(&View {
                now_s: t_s,
                scan,
                pose,
                covariance: estimate.covariance,
                boundary: &drawing.boundary,
                charted: &drawing.obstacles,
                map: &map,
                hull_m: 0.2,
                reach_m: 2.2,
            });
            if locates {
                locator.keep_match(perception.matched());
            }
        }
        let truth = simulator.truth().pose;
        if (SILENT_S[0]..SILENT_S[1]).contains(&t_s) {
            errors_m.push((truth.position - pose.position).norm());
        }
        follower.advance(truth.position, |_| true);
        let to = follower.target() - truth.position;
        let wanted = Drive::Velocity(to * (0.3 / to.norm().max(1e-6)));
        simulator.act(drive_for(wanted, truth.heading_rad, &scenario.mission.limits, 0.3));
    }
    errors_m.sort_by(f64::total_cmp);
    errors_m
}

#[test]
fn scans_keep_the_position_while_the_stations_are_silent() {
    let number = |name: &str, default: u64| {
        std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
    };
    let (seeds, first) = (number("SEEDS", 5), number("FIRST_SEED", 1));
    for seed in first..first + seeds {
        let p95_m = |locates| {
            let errors_m = errors_m(seed, locates);
            errors_m[(errors_m.len() - 1) * 95 / 100]
        };
        let (with_m, without_m) = (p95_m(true), p95_m(false));
        println!("seed {seed}: p95 {with_m:.3} m with scan matching, {without_m:.3} m without");
        assert!(with_m <= 0.15 && with_m < without_m, "seed {seed}: {with_m} with, {without_m} without");
    }
}
