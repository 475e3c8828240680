//! Yang et al. 2021, Figs 12 to 15: the hybrid planner from water to land.

use crate::study::{Block, Job, Method, Planners, Result, Row, Runner, Sample, StudyError};
use planner_api::Task;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_4;
use trials::{
    amphibious::{AmphibiousLayout, Group, HULL_M},
    discs,
};
use world::{Amphibious, Boundary, Medium, Mode, Point, Pose, Shape, Zone, ZoneKind, polyline};

/// The numbers of transition steps compared; the paper has none and 20.
const TRANSITIONS: [u32; 3] = [0, 20, 60];
/// Duration of a step, seconds.
const STEP_S: f64 = 0.1;
/// Distance, metres, at which the goal counts as reached.
const TOLERANCE_M: f64 = 0.15;
/// Excess over the speed limit, metres per second, below which it counts as a rounding error.
const ROUNDING_M_PER_S: f64 = 1e-6;

const OURS: &str = "virtual goals are the corners of the shortest path on the known map (ours)";
const PAPER: &str = "virtual goals on a square round the goal, used in a local minimum, as published; the \
                     size of the square is not printed";
const LAYOUT: &str = "the paper shows one layout per group, without coordinates; ours are random";

/// A planner, set up with a number of transition steps.
struct Entry {
    method: Method,
    transition_steps: u32,
}

/// The figures of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Measured {
    arrived: bool,
    steps: f64,
    length_m: f64,
    ratio: f64,
    clearance_m: f64,
    overspeed_m_per_s: f64,
    plan_time_ms: f64,
}

fn entries() -> impl Iterator<Item = Entry> {
    let guides = [("", "corners", OURS), ("/square", "square", PAPER)];
    let entry = |(mode, guide, note): (&str, &str, &'static str), transition_steps: u32| {
        let method = Method::new(format!("apf-dwa{mode}/steps-{transition_steps}"), "apf-dwa", note);
        let method = method.word("guide", guide).int("transition_steps", i64::from(transition_steps));
        Entry { method: method.number("guard_m", 0.1), transition_steps }
    };
    guides.into_iter().flat_map(move |guide| TRANSITIONS.map(|steps| entry(guide, steps)))
}

/// The study of Figs 12 to 15 on many layouts.
pub(super) fn hybrid(job: &Job<'_>) -> Result<Vec<Row>> {
    let groups = job.cases(Group::ALL, |group| group.id().into())?;
    let entries = job.methods(entries(), |entry| entry.method.id.clone())?;
    let runs: Vec<(Group, &Entry)> =
        groups.iter().flat_map(|group| entries.iter().map(move |entry| (*group, entry))).collect();
    let measured = job.runner.grid(&runs, &job.seeds(), |planners, (group, entry), seed| {
        measure(job.runner, planners, entry, (*group, *seed))
    })?;
    let mut rows = Vec::new();
    for (group, measured) in groups.iter().zip(measured.chunks(entries.len())) {
        let of_method: Vec<(&Method, &Vec<Measured>)> =
            entries.iter().map(|entry| &entry.method).zip(measured).collect();
        for (method, measured) in &of_method {
            let block = job.block(group.id(), &method.id, method.note);
            rows.extend(summary(&block, measured));
        }
        for (index, first) in of_method.iter().enumerate() {
            let is_comparable = |second: &&(&Method, &Vec<Measured>)| second.0.note == first.0.note;
            for second in of_method[index + 1..].iter().filter(is_comparable) {
                let method = format!("{} against {}", second.0.id, first.0.id);
                let block = job.block(group.id(), &method, "");
                rows.extend(differences(&block, [second.1, first.1]));
            }
        }
    }
    Ok(rows)
}

fn measure(
    runner: &Runner<'_>,
    planners: &Planners,
    entry: &Entry,
    (group, seed): (Group, u64),
) -> Result<Measured> {
    let layout = AmphibiousLayout::random(group, seed);
    let (corners, obstacles) = (AmphibiousLayout::corners(), layout.obstacles());
    let water = AmphibiousLayout::water();
    let zones = AmphibiousLayout::zones(&water);
    let site = AmphibiousLayout::site(&corners, &obstacles, &zones);
    let start = Pose { position: layout.start, heading_rad: FRAC_PI_4 };
    let task = Task::Goto { goal: layout.goal, tolerance_m: TOLERANCE_M };
    let planned = planners.plan(&entry.method, start, task, &site)?;
    if let Some(gallery) = runner.gallery() {
        let world = discs::world(Boundary::Polygon { vertices: corners.clone() }, &layout.discs);
        gallery.add_path((group.id(), seed, &entry.method.id), &world, HULL_M, None, &planned.plan);
    }
    let path = planned.path();
    let length_m = polyline::length_m(path);
    let shortest = layout.shortest_path();
    let shortest = shortest.map_err(|no| StudyError::Refused(format!("seed {seed}: {no}")))?;
    let clearances = path.iter().map(|place| layout.hull_clearance_m(*place));
    Ok(Measured {
        arrived: (layout.goal - planned.end(layout.start)).norm() <= TOLERANCE_M + 1e-6,
        steps: planned.n_steps(),
        length_m,
        ratio: length_m / shortest.length_m,
        clearance_m: clearances.fold(f64::INFINITY, f64::min),
        overspeed_m_per_s: overspeed_m_per_s(path, &water, entry.transition_steps),
        plan_time_ms: planned.plan_time_ms,
    })
}

/// The largest amount by which the speed between two consecutive places exceeds the limit at that moment, metres per
/// second.
fn overspeed_m_per_s(path: &[Point], water: &[Point], transition_steps: u32) -> f64 {
    let zone = Zone {
        name: String::new(),
        kind: ZoneKind::Underwater,
        shape: Shape::Polygon { vertices: water.to_vec() },
    };
    let zones = [zone];
    let robot = Amphibious { transition_steps, ..Amphibious::YANG_2021 };
    let mut mode = path.first().map(|start| Mode::of(Medium::at(&zones, *start)));
    let mut most = 0.0_f64;
    for pair in path.windows(2) {
        let now = mode.map(|mode| mode.toward(Medium::at(&zones, pair[0]), transition_steps));
        mode = now;
        let limit = now.map_or(f64::INFINITY, |mode| robot.pace(mode.weight()).v_max_m_per_s);
        most = most.max((pair[1] - pair[0]).norm() / STEP_S - limit);
    }
    if most > ROUNDING_M_PER_S { most } else { 0.0 }
}

fn summary(block: &Block<'_>, all: &[Measured]) -> Vec<Row> {
    let n = all.len();
    let share = |is: fn(&Measured) -> bool| all.iter().filter(|one| is(one)).count() as f64 / n as f64;
    let of_all = |of: fn(&Measured) -> f64| all.iter().map(of).collect::<Sample>();
    let arrived = |of: fn(&Measured) -> f64| all.iter().filter(|m| m.arrived).map(of).collect::<Sample>();
    let (ratios, steps) = (arrived(|one| one.ratio), arrived(|one| one.steps));
    let collisions = all.iter().filter(|one| one.clearance_m < 0.0).count() as f64;
    let step_times = of_all(|one| 1e3 * one.plan_time_ms / one.steps.max(1.0));
    vec![
        block
            .row("success_rate", share(|one| one.arrived), "", n)
            .printed(1.0)
            .note(format!("{}; {LAYOUT}", block.note)),
        block.row("collisions", collisions, "layouts", n),
        block.row("length_ratio_mean", ratios.mean(), "", ratios.len()),
        block.row("length_ratio_p95", ratios.quantile(0.95), "", ratios.len()),
        block.row("length_m", arrived(|one| one.length_m).mean(), "m", ratios.len()),
        block.row("steps", steps.mean(), "", steps.len()),
        block.row("min_clearance", of_all(|one| one.clearance_m).min(), "m", n),
        block
            .row("overspeed", of_all(|one| one.overspeed_m_per_s).max(), "m/s", n)
            .note("largest amount by which the speed in any step exceeds the limit at that moment"),
        block.row("overspeed_rate", share(|one| one.overspeed_m_per_s > 0.0), "", n),
        block.row("plan_time_ms", of_all(|one| one.plan_time_ms).mean(), "ms", n),
        block.row("step_time_us", step_times.median(), "us", n).note(
            "planning time divided by the number of steps, including the call across the plugin boundary",
        ),
    ]
}

/// The effect of more transition steps, layout by layout, where both runs arrive.
fn differences(block: &Block<'_>, measured: [&[Measured]; 2]) -> Vec<Row> {
    let pairs = || measured[0].iter().zip(measured[1]).filter(|(a, b)| a.arrived && b.arrived);
    let row = |metric: &str, sample: &Sample, unit: &str| {
        let mean = sample.mean();
        let conclusion = match mean.zip(sample.mean_margin_95()) {
            None => "too few pairs to compare".into(),
            Some((mean, within)) => {
                let effect = if mean.abs() <= within { "shows no effect" } else { "shows an effect" };
                format!("95 % interval +-{within:.3}, which {effect}")
            }
        };
        block.row(metric, mean, unit, sample.len()).note(format!(
            "mean of paired differences, {conclusion}; the paper claims an effect from a single picture. \
             With a longer transition, the robot exceeds the speed limit on land for longer"
        ))
    };
    let steps: Sample = pairs().map(|(a, b)| a.steps - b.steps).collect();
    let length: Sample = pairs().map(|(a, b)| a.length_m - b.length_m).collect();
    vec![row("steps_difference", &steps, ""), row("length_difference_m", &length, "m")]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speed_is_held_against_the_limit_of_its_step() {
        let water = AmphibiousLayout::water();
        // The robot reaches the land at its swimming speed: without a transition, it is 0.1 m/s too fast.
        let path: Vec<Point> = (0..5).map(|k| Point::new(-0.05 + 0.023 * f64::from(k), 0.0)).collect();
        assert!((overspeed_m_per_s(&path, &water, 0) - 0.1).abs() < 1e-9);
        assert!((overspeed_m_per_s(&path, &water, 20) - 0.005).abs() < 1e-9);
        assert!(overspeed_m_per_s(&path[..3], &water, 0).abs() < f64::EPSILON);
    }

    #[test]
    fn differences_are_of_layouts_on_which_both_arrive() {
        let measured = |arrived: bool, steps: f64| Measured {
            arrived,
            steps,
            length_m: 10.0,
            ratio: 1.0,
            clearance_m: 0.2,
            overspeed_m_per_s: 0.0,
            plan_time_ms: 1.0,
        };
        let one = [measured(true, 100.0), measured(false, 1.0)];
        let other = [measured(true, 90.0), measured(true, 80.0)];
        let block = Block { table: "t", case: "free", method: "one against other", note: "" };
        let rows = differences(&block, [&one, &other]);
        assert_eq!((rows[0].ours, rows[0].n), (Some(10.0), 1));
    }
}
