//! Yang et al. 2021, Figs 12 to 15: the hybrid planner from water to land.

use super::Method;
use crate::{
    bench::Bench,
    planners::Planners,
    row::Row,
    sample::Sample,
    study::{Options, Problem, Study},
};
use nalgebra::Matrix3;
use planner_api::{PlanRequest, PoseEstimate, Reason, Task};
use std::f64::consts::FRAC_PI_4;
use trials::shore::{Group, HULL_M, Shore};
use world::{
    Amphibious, Boundary, Medium, Mode, Point, Shape, Zone, ZoneKind, polyline, shortest::GrownFloor,
};

/// Steps of transition compared; the paper has none and 20.
const TRANSITIONS: [u32; 3] = [0, 20, 60];
/// Length of a step, seconds.
const STEP_S: f64 = 0.1;
/// The goal counts as reached at this distance, metres.
const TOLERANCE_M: f64 = 0.15;
/// Speeds above the limit by less than this are rounding, metres per second.
const ROUNDING_M_PER_S: f64 = 1e-6;

const OURS: &str = "virtual goals are the corners of the shortest way over the known map: ours";
const PAPER: &str =
    "virtual goals on a square round the goal, used in a minimum, as published; its size is not printed";
const LAYOUT: &str = "the paper shows one layout of each group and prints none; ours are random";

/// One run.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ran {
    arrived: bool,
    steps: f64,
    length_m: f64,
    ratio: f64,
    clearance_m: f64,
    overspeed_m_per_s: f64,
    plan_time_ms: f64,
}

fn methods() -> Vec<(Method, u32)> {
    let ids = [
        ["apf-dwa/steps-0", "apf-dwa/steps-20", "apf-dwa/steps-60"],
        ["apf-dwa/square/steps-0", "apf-dwa/square/steps-20", "apf-dwa/square/steps-60"],
    ];
    let guides = [("corners", OURS), ("square", PAPER)];
    let of_guide = |(guide, (word, note)): (usize, (&'static str, &'static str))| {
        TRANSITIONS.into_iter().enumerate().map(move |(index, steps)| {
            let method = Method::new(ids[guide][index], "apf-dwa", note).word("guide", word);
            (method.int("transition_steps", i64::from(steps)).number("guard_m", 0.1), steps)
        })
    };
    guides.into_iter().enumerate().flat_map(of_guide).collect()
}

/// Figs 12 to 15 on many layouts.
pub(super) fn hybrid(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let methods: Vec<(Method, u32)> =
        methods().into_iter().filter(|(method, _)| options.has_method(method.id)).collect();
    let groups: Vec<Group> = Group::ALL.into_iter().filter(|group| options.has_case(group.id())).collect();
    let cases: Vec<(Group, usize, u64)> = groups
        .iter()
        .flat_map(|group| (0..methods.len()).map(move |method| (*group, method)))
        .flat_map(|(group, method)| options.seeds(study.layouts).map(move |seed| (group, method, seed)))
        .collect();
    if cases.is_empty() {
        return Err(Problem::Nothing("no case or method of that name is left; cases are free, block".into()));
    }
    let ran = bench.map(&cases, |planners, (group, method, seed)| {
        let (method, steps) = &methods[*method];
        run(planners, method, *steps, *group, *seed)
    })?;
    let of = |group: Group, method: usize| -> Vec<Ran> {
        let is_meant = |case: &(Group, usize, u64)| case.0 == group && case.1 == method;
        cases.iter().zip(&ran).filter(|(case, _)| is_meant(case)).map(|(_, ran)| *ran).collect()
    };
    let mut rows = Vec::new();
    for group in groups {
        for (index, (method, _)) in methods.iter().enumerate() {
            rows.extend(summary(study.name, group, method, &of(group, index)));
        }
        for (one, (first, _)) in methods.iter().enumerate() {
            for (other, (second, _)) in methods.iter().enumerate().skip(one + 1) {
                if first.note == second.note {
                    rows.extend(differences(
                        study.name,
                        group,
                        [second, first],
                        [&of(group, other), &of(group, one)],
                    ));
                }
            }
        }
    }
    Ok(rows)
}

fn run(planners: &Planners, method: &Method, steps: u32, group: Group, seed: u64) -> Result<Ran, Problem> {
    let shore = Shore::random(group, seed);
    let (corners, obstacles, water) = (Shore::corners(), shore.obstacles(), Shore::water());
    let zones = Shore::zones(&water);
    let site = Shore::site(&corners, &obstacles, &zones);
    let start = PoseEstimate { position: shore.start, heading_rad: FRAC_PI_4, covariance: Matrix3::zeros() };
    let task = Task::Goto { goal: shore.goal, tolerance_m: TOLERANCE_M };
    let request = PlanRequest { reason: &Reason::Start, start, task, site: &site, previous: &[] };
    let planned = planners.plan(method.planner, &method.parameters, &request)?;
    let path = planned.path();
    let end = path.last().copied().unwrap_or(shore.start);
    let clearances = path.iter().map(|place| shore.hull_clearance_m(*place));
    let length_m = polyline::length_m(path);
    Ok(Ran {
        arrived: (shore.goal - end).norm() <= TOLERANCE_M + 1e-6,
        steps: path.len().saturating_sub(1) as f64,
        length_m,
        ratio: length_m / shortest_m(&shore, seed)?,
        clearance_m: clearances.fold(f64::INFINITY, f64::min),
        overspeed_m_per_s: overspeed_m_per_s(path, &water, steps),
        plan_time_ms: planned.plan_time_ms,
    })
}

fn shortest_m(shore: &Shore, seed: u64) -> Result<f64, Problem> {
    let shapes = shore.shapes();
    let wall = Boundary::Polygon { vertices: Shore::corners().to_vec() };
    let floor = GrownFloor::new(&wall, HULL_M, shapes.iter().map(|shape| (shape, HULL_M)));
    let way = floor.shortest(shore.start, shore.goal, &mut || true);
    way.map(|way| way.length_m).map_err(|no| Problem::Nothing(format!("seed {seed}: {no}")))
}

/// How far the speed from place to place exceeds the limit of the moment, at most, metres per second.
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
        let limit = now.map_or(f64::INFINITY, |mode| robot.pace(mode).v_max_m_per_s);
        most = most.max((pair[1] - pair[0]).norm() / STEP_S - limit);
    }
    if most > ROUNDING_M_PER_S { most } else { 0.0 }
}

fn summary(table: &str, group: Group, method: &Method, ran: &[Ran]) -> Vec<Row> {
    let n = ran.len();
    let row = |metric: &str, ours: Option<f64>, unit: &str, n: usize| {
        Row::new(table, group.id(), method.id, metric, ours, unit).of(n).note(method.note)
    };
    let count = |is: fn(&Ran) -> bool| ran.iter().filter(|one| is(one)).count() as f64;
    let sample = |of: fn(&Ran) -> f64| ran.iter().filter(|one| one.arrived).map(of).collect::<Sample>();
    let all = |of: fn(&Ran) -> f64| ran.iter().map(of).collect::<Sample>();
    let (ratios, steps) = (sample(|one| one.ratio), sample(|one| one.steps));
    let (over, clear) = (all(|one| one.overspeed_m_per_s), all(|one| one.clearance_m));
    let step_time = all(|one| 1e3 * one.plan_time_ms / one.steps.max(1.0));
    vec![
        row("success_rate", Some(count(|one| one.arrived) / n as f64), "", n)
            .printed(1.0)
            .note(format!("{}; {LAYOUT}", method.note)),
        row("collisions", Some(count(|one| one.clearance_m < 0.0)), "layouts", n),
        row("length_ratio_mean", ratios.mean(), "", ratios.len()),
        row("length_ratio_p95", ratios.quantile(0.95), "", ratios.len()),
        row("length_m", sample(|one| one.length_m).mean(), "m", ratios.len()),
        row("steps", steps.mean(), "", steps.len()),
        row("min_clearance", clear.min(), "m", n),
        row("overspeed", over.max(), "m/s", n).note("furthest above the limit of the moment in any step"),
        row("overspeed_rate", Some(count(|one| one.overspeed_m_per_s > 0.0) / n as f64), "", n),
        row("plan_time_ms", all(|one| one.plan_time_ms).mean(), "ms", n),
        row("step_time_us", step_time.median(), "us", n)
            .note("time of the plan over its steps, the way over the plugin boundary included"),
    ]
}

/// What more steps of transition change, layout by layout, where both arrive.
fn differences(table: &str, group: Group, methods: [&Method; 2], ran: [&[Ran]; 2]) -> Vec<Row> {
    let id = format!("{} against {}", methods[0].id, methods[1].id);
    let pairs = || ran[0].iter().zip(ran[1]).filter(|(a, b)| a.arrived && b.arrived);
    let row = |metric: &str, sample: &Sample, unit: &str| {
        let within = sample.mean_within().unwrap_or(f64::NAN);
        let mean = sample.mean();
        let verdict = match mean {
            Some(mean) if mean.abs() <= within => "no effect shown",
            Some(_) => "an effect",
            None => "nothing to compare",
        };
        let claim = "the paper claims one from one picture. A longer transition leaves the robot faster on land for longer";
        let note = format!("mean of paired differences, 95 % interval +-{within:.3}: {verdict}; {claim}");
        Row::new(table, group.id(), &id, metric, mean, unit).of(sample.len()).note(note)
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
        let water = Shore::water();
        // Into the land at the speed of swimming: with no transition 0.1 m/s too fast.
        let path: Vec<Point> = (0..5).map(|k| Point::new(-0.05 + 0.023 * f64::from(k), 0.0)).collect();
        assert!((overspeed_m_per_s(&path, &water, 0) - 0.1).abs() < 1e-9);
        assert!((overspeed_m_per_s(&path, &water, 20) - 0.005).abs() < 1e-9);
        assert!(overspeed_m_per_s(&path[..3], &water, 0).abs() < f64::EPSILON);
    }

    #[test]
    fn differences_are_of_layouts_on_which_both_arrive() {
        let ran = |arrived: bool, steps: f64| Ran {
            arrived,
            steps,
            length_m: 10.0,
            ratio: 1.0,
            clearance_m: 0.2,
            overspeed_m_per_s: 0.0,
            plan_time_ms: 1.0,
        };
        let (one, other) = ([ran(true, 100.0), ran(false, 1.0)], [ran(true, 90.0), ran(true, 80.0)]);
        let methods = methods();
        let rows = differences("t", Group::Free, [&methods[1].0, &methods[0].0], [&one, &other]);
        assert_eq!((rows[0].ours, rows[0].n), (Some(10.0), 1));
    }
}
