//! Missions among carts that cross the robot's way.

use crate::bench::{Bench, scenario};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::fmt::Write;

/// Seeds of layouts that were not used for tuning.
const SEEDS: std::ops::Range<u64> = 9101..9141;
/// Speed of the robot, metres per second, and radius of the tank, metres.
const ROBOT_M_PER_S: f64 = 0.4;
const TANK_M: f64 = 10.0;

/// Five carts and a column. The carts are at most as fast as the robot and drive on straight lines that cross its
/// path at about the time when it would be there undisturbed; none of the carts is on the drawing.
fn carts(seed: u64) -> String {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut text = String::new();
    let column =
        (random.random_range(-2.0..3.0), random.random_range(-1.0..1.0), random.random_range(0.3..0.7));
    let _ = write!(
        text,
        "name = \"carts-{seed}\"\nseed = {seed}\n\n[tank]\nradius_m = {TANK_M}\n\n[[obstacles]]\nkind = \"circle\"\n\
         center_m = [{:.3}, {:.3}]\nradius_m = {:.3}\n",
        column.0, column.1, column.2
    );
    let mut k = 0;
    while k < 5 {
        let x_m = f64::from(k) * 2.2 - 4.5 + random.random_range(-0.6..0.6);
        let meeting_s = (x_m + 8.0) / ROBOT_M_PER_S + random.random_range(-2.5..2.5);
        let speed = random.random_range(0.15..ROBOT_M_PER_S);
        let side = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        let bearing_rad: f64 = side * (std::f64::consts::FRAC_PI_2 + random.random_range(-0.4..0.4));
        let (east, north) = (speed * bearing_rad.cos(), speed * bearing_rad.sin());
        let (x_m, y_m) = (x_m - east * meeting_s, -north * meeting_s);
        let radius_m = random.random_range(0.3..0.5);
        if x_m.hypot(y_m) > TANK_M - radius_m - 0.2 || (x_m + 8.0).hypot(y_m) < 1.5 {
            continue;
        }
        let _ = write!(
            text,
            "\n[[obstacles]]\nkind = \"circle\"\ncenter_m = [{x_m:.3}, {y_m:.3}]\nradius_m = {radius_m:.3}\n\
             velocity_m_per_s = [{east:.3}, {north:.3}]\n"
        );
        k += 1;
    }
    text + "\n[robot]\nstart_m = [-8.0, 0.0]\nsensing_range_m = 4.0\n\n[ae]\nnoise = { model = \"uniform\", ratio = 0.02 }\n\
            stations = [\n    { name = \"A\", at_m = [10.0, 0.0] },\n    { name = \"B\", at_m = [0.0, 10.0] },\n    \
            { name = \"C\", at_m = [-10.0, 0.0] },\n    { name = \"D\", at_m = [0.0, -10.0] },\n]\n\n[mission]\n\
            kind = \"goto\"\ngoal_m = [8.0, 0.0]\ntime_limit_s = 300.0\ncell_m = 0.5\n\n[planner]\nid = \"apf-dwa\"\n"
}

#[test]
fn the_dynamic_window_touches_nothing_on_forty_floors_with_carts_and_arrives() {
    let bench = Bench::new();
    let missions = SEEDS.map(|seed| {
        let file = bench.file(&format!("carts-{seed}.toml"), carts(seed));
        bench.fly(&file, &["--no-record"]).json()
    });
    let missions: Vec<serde_json::Value> = missions.collect();
    for mission in &missions {
        assert_eq!(mission["collisions"], 0, "{mission}");
    }
    let n_arrived = missions.iter().filter(|mission| mission["outcome"] == "complete").count();
    assert!(n_arrived >= 38, "{n_arrived} of {}", missions.len());
}

#[test]
fn the_dynamic_window_passes_what_moves_in_the_shipped_scenarios() {
    let bench = Bench::new();
    for name in ["crossing-carts.toml", "moving-obstacles.toml"] {
        let mission = bench.fly(&scenario(name), &["--no-record", "--planner", "apf-dwa"]).json();
        assert_eq!(mission["collisions"], 0, "{mission}");
        assert_eq!(mission["outcome"], "complete", "{mission}");
    }
}
