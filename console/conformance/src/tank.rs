//! Random tanks.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use scenario::{Scenario, Settings};
use serde::Serialize;
use std::f64::consts::TAU;
use std::fmt::{self, Write};

/// The task in a tank.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Task {
    /// Drive from one side to the other.
    Goto,
    /// Scan the whole floor.
    Cover,
}

impl fmt::Display for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Goto => "goto",
            Self::Cover => "cover",
        })
    }
}

/// Smallest distance between an obstacle and anything else, metres. It lets the robot pass everywhere.
const GAP_M: f64 = 0.9;

/// Generates the tank for a seed: columns and boxes, each of which is on the drawing with a probability of two thirds.
///
/// # Panics
/// Never: the tests show that every generated text is a valid scenario.
pub(crate) fn draw(task: Task, seed: u64) -> Scenario {
    Scenario::parse_with(&text(task, seed, "it"), &format!("tank {seed}"), &Settings::default())
        .unwrap_or_else(|errors| panic!("{}", errors.render()))
}

/// Returns the text of the scenario for this tank and planner.
pub(crate) fn text(task: Task, seed: u64, planner: &str) -> String {
    let mut random = Pcg64::seed_from_u64(seed);
    let (tank_radius, most) = if task == Task::Goto { (5.0, 9) } else { (3.0, 4) };
    let n = random.random_range(2..=most);
    let (start, goal) = ([0.8 - tank_radius, 0.0], [tank_radius - 0.8, 0.0]);
    let mut placed: Vec<([f64; 2], f64)> = vec![(start, 0.0), (goal, 0.0)];
    let mut obstacles = String::new();
    for _ in 0..n * 20 {
        if placed.len() == n + 2 {
            break;
        }
        let (radius, angle) = (random.random_range(0.1..0.4), random.random_range(0.0..TAU));
        let from_center = (tank_radius - GAP_M - radius) * random.random_range(0.0_f64..1.0).sqrt();
        let at = [from_center * angle.cos(), from_center * angle.sin()];
        let is_free =
            |(other, r): &([f64; 2], f64)| (at[0] - other[0]).hypot(at[1] - other[1]) > radius + r + GAP_M;
        if placed.iter().all(is_free) {
            let known = random.random_bool(2.0 / 3.0);
            placed.push((at, radius));
            let [x, y] = at;
            let shape = if random.random_bool(0.5) {
                format!("kind = \"circle\"\nradius_m = {radius:.3}")
            } else {
                let (side, heading) = (radius * 1.4, random.random_range(0.0..90.0));
                format!("kind = \"box\"\nsize_m = [{side:.3}, {side:.3}]\nheading_deg = {heading:.1}")
            };
            let _ =
                write!(obstacles, "\n[[obstacles]]\n{shape}\ncenter_m = [{x:.3}, {y:.3}]\nknown = {known}\n");
        }
    }
    let heading = random.random_range(-180.0..180.0);
    let mission = match task {
        Task::Goto => format!("kind = \"goto\"\ngoal_m = [{}, {}]\ntime_limit_s = 180.0", goal[0], goal[1]),
        Task::Cover => "kind = \"cover\"\ntime_limit_s = 1200.0\nswath_m = 0.6".to_owned(),
    };
    format!(
        "name = \"random-{seed}\"\nseed = {seed}\n\n[tank]\nradius_m = {tank_radius}\n{obstacles}\n[robot]\n\
         motion = \"unicycle\"\nradius_m = 0.25\nspeed_max_m_per_s = 0.4\nturn_rate_max_deg_per_s = 90.0\n\
         start_m = [{}, {}]\nstart_heading_deg = {heading:.1}\n\n[ae]\nperiod_s = 1.0\nrepetitions = 20\n\
         noise = {{ model = \"uniform\", ratio = 0.02 }}\nstations = [{}]\n\n[mission]\n{mission}\ntolerance_m = 0.2\n\
         stuck_s = 20.0\n\n[planner]\nid = \"{planner}\"\n",
        start[0],
        start[1],
        stations(tank_radius),
    )
}

fn stations(radius: f64) -> String {
    let at = |n: usize| {
        let angle = TAU * n as f64 / 5.0;
        format!("{{ name = \"S{n}\", at_m = [{:.3}, {:.3}] }}", radius * angle.cos(), radius * angle.sin())
    };
    (0..5).map(at).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seed_draws_a_scenario_and_always_the_same() {
        for seed in 0..200 {
            for task in [Task::Goto, Task::Cover] {
                assert_eq!(draw(task, seed).text, draw(task, seed).text);
                assert!(text(task, seed, "my-own").contains("id = \"my-own\""));
            }
        }
        assert_ne!(draw(Task::Goto, 1).sim.world, draw(Task::Goto, 2).sim.world);
    }
}
