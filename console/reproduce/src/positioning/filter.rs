//! Filters on the spiral: one cycle of ranges and one step of odometry in turn.

use super::{
    method,
    odometry::{Drive, SLIP_CHANCE, drive},
    scene::{Layout, Scene},
    tally::Outcome,
};
use crate::{
    bench::Bench,
    row::Row,
    sample::Sample,
    study::{Options, Problem, Study},
};
use nalgebra::Matrix2;
use positioning::{
    Aggregation, Ekf, FixedLag, MotionNoise, Nls, Particles, ParticlesConfig, PositionSolver, Ranging,
};
use sim::NoiseModel;
use world::{Point, RangeSet, Station};

pub(super) const STUDY: Study = Study {
    name: "positioning-filter",
    about: "filters over ranges and odometry along the spiral, on the same draws",
    layouts: 30,
    run,
};

/// What the filters expect of the tracks.
const MOTION: MotionNoise = MotionNoise {
    sigma_per_m: 0.03,
    way_sigma_ratio: 0.05,
    turn_sigma_ratio: 0.1,
    heading_sigma_per_tick_rad: 0.001,
    slip_chance: SLIP_CHANCE,
};
/// Steps that the smoother looks back.
const LAG: usize = 10;
/// How well the manway is surveyed, metres and radians.
const START: (f64, f64) = (0.01, 0.01);
const PARTICLES: usize = 2000;

/// The methods in the order of their outcomes.
const METHODS: [&str; 9] = [
    "dead-reckoning",
    "linear",
    "nls",
    "bounded",
    "ekf",
    "ekf/midrange",
    "fixed-lag",
    "fixed-lag/midrange",
    "particle",
];

fn cases() -> Vec<(String, Scene)> {
    let noises = [
        ("uniform-5", NoiseModel::Uniform { ratio: 0.05 }),
        ("triangular-5", NoiseModel::Triangular { ratio: 0.05 }),
    ];
    noises
        .into_iter()
        .flat_map(|noise| [1, 20].map(|n| (noise, n)))
        .map(|((name, noise), n)| (format!("spiral/{name}/n-{n}"), Scene::new(Layout::Paper, noise, n)))
        .collect()
}

fn run(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let cases: Vec<(String, Scene)> = cases().into_iter().filter(|(id, _)| options.has_case(id)).collect();
    let seeds: Vec<u64> = options.seeds(study.layouts).collect();
    let work: Vec<(usize, u64)> =
        (0..cases.len()).flat_map(|case| seeds.iter().map(move |seed| (case, *seed))).collect();
    let done = bench.map(&work, |_, (case, seed)| Ok(one_run(&cases[*case].1, *seed)))?;
    let mut rows = Vec::new();
    for (k, (id, _)) in cases.iter().enumerate() {
        for (m, method) in METHODS.iter().enumerate().filter(|(_, method)| options.has_method(method)) {
            let runs: Vec<&Vec<Outcome>> =
                work.iter().zip(&done).filter(|((case, _), _)| *case == k).map(|(_, run)| &run[m]).collect();
            let errors = |run: &[Outcome]| run.iter().filter_map(|o| o.error_m).collect::<Sample>();
            let means: Sample = runs.iter().filter_map(|run| errors(run).mean()).collect();
            let all: Vec<Outcome> = runs.iter().flat_map(|run| run.iter().copied()).collect();
            if means.is_empty() {
                continue;
            }
            let inside = all.iter().filter(|o| o.is_inside).count() as f64 / all.len() as f64;
            let row = |metric: &str, ours: Option<f64>, unit: &str| {
                Row::new(study.name, id, method, metric, ours, unit).of(runs.len())
            };
            rows.push(row("mean_error", means.mean(), "m"));
            rows.push(row("std", means.standard_deviation(), "m"));
            rows.push(row("p95_error", errors(&all).quantile(0.95), "m"));
            rows.push(row("worst", errors(&all).max(), "m"));
            if *method != METHODS[0] {
                rows.push(row("in_95_ellipse", Some(inside), ""));
            }
        }
    }
    Ok(rows)
}

fn one_run(scene: &Scene, seed: u64) -> Vec<Vec<Outcome>> {
    let drive = drive(seed);
    let truths: Vec<Point> = drive.steps.iter().map(|(_, truth)| *truth).collect();
    let cycles = super::scene::cycles(scene, &truths, seed);
    let noise = scene.noise();
    let single = |method: method::Method| {
        let pairs = truths.iter().zip(&cycles);
        pairs
            .map(|(truth, sets)| Outcome::of(&method.fix(sets, &scene.stations, &noise), *truth, 0.0))
            .collect()
    };
    let ranges = |how: Aggregation| -> Vec<Vec<Ranging>> {
        cycles.iter().map(|sets| how.aggregate(sets, &noise).unwrap_or_default()).collect()
    };
    let (mean, lagged) = filtered(&drive, &ranges(Aggregation::Mean), &scene.stations);
    let (midrange, lagged_midrange) = filtered(&drive, &ranges(Aggregation::Midrange), &scene.stations);
    vec![
        dead_reckoning(&drive),
        single(method::LINEAR),
        single(method::NLS),
        single(method::BOUNDED),
        mean,
        midrange,
        lagged,
        lagged_midrange,
        particles(&drive, &cycles, scene, seed),
    ]
}

fn dead_reckoning(drive: &Drive) -> Vec<Outcome> {
    let mut pose = drive.start;
    let step = |(odometry, truth): &(world::Odometry, Point)| {
        pose = pose.moved(odometry.forward_m, odometry.sideways_m, odometry.turn_rad);
        Outcome { error_m: Some((pose.position - truth).norm()), ..Outcome::default() }
    };
    drive.steps.iter().map(step).collect()
}

/// The filter's outcomes, and those of looking back.
fn filtered(drive: &Drive, ranges: &[Vec<Ranging>], stations: &[Station]) -> (Vec<Outcome>, Vec<Outcome>) {
    let mut smoother = FixedLag::new(Ekf::new(drive.start, START.0, START.1, MOTION), LAG);
    let (mut now, mut back) = (Vec::new(), Vec::new());
    for (k, ((odometry, truth), ranges)) in drive.steps.iter().zip(ranges).enumerate() {
        smoother.predict(odometry);
        if !smoother.update_ranges(ranges, stations) {
            smoother.doubt_motion(odometry);
            if !smoother.update_ranges(ranges, stations)
                && let Ok(fix) = Nls.solve(ranges, stations, None)
            {
                smoother.restart_at(fix.position, &fix.covariance, 0.3);
            }
        }
        let filter = smoother.filter();
        now.push(outcome(filter.pose().position, &filter.position_covariance(), *truth));
        let smoothed = smoother.smoothed();
        let past = |ago: usize| drive.steps.get((k + 1).checked_sub(ago + 1)?).map(|(_, truth)| *truth);
        if k + 1 == drive.steps.len() {
            // At the end everything remembered is reported.
            back.extend(
                smoothed.iter().filter_map(|s| Some(outcome(s.pose.position, &s.covariance, past(s.lag)?))),
            );
        } else if let Some(s) = smoothed.first().filter(|s| s.lag == LAG) {
            back.extend(past(LAG).map(|truth| outcome(s.pose.position, &s.covariance, truth)));
        }
    }
    (now, back)
}

fn outcome(position: Point, covariance: &Matrix2<f64>, truth: Point) -> Outcome {
    let off = position - truth;
    let squared = covariance.try_inverse().map(|inverse| off.dot(&(inverse * off)));
    Outcome {
        error_m: Some(off.norm()),
        is_inside: squared.is_some_and(|s| s < -2.0 * 0.05_f64.ln()),
        ..Outcome::default()
    }
}

fn particles(drive: &Drive, cycles: &[Vec<RangeSet>], scene: &Scene, seed: u64) -> Vec<Outcome> {
    let noise = scene.noise();
    let Some(ratio) = noise.bound_ratio() else { return Vec::new() };
    let config =
        ParticlesConfig { count: PARTICLES, ratio, odometry: MOTION, slip_chance: SLIP_CHANCE, seed };
    let mut filter = Particles::new(drive.start, START.0, START.1, config);
    let mut outcomes = Vec::new();
    for ((odometry, truth), sets) in drive.steps.iter().zip(cycles) {
        filter.predict(odometry);
        let ranges = Aggregation::Mean.aggregate(sets, &noise).unwrap_or_default();
        // Ranges that no place explains leave the guesses as they are.
        let _ = filter.update(&ranges, &scene.stations);
        let (pose, covariance) = filter.estimate();
        outcomes.push(outcome(pose.position, &covariance.fixed_view::<2, 2>(0, 0).into_owned(), *truth));
        filter.renew(&ranges, &scene.stations);
    }
    outcomes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_worth_more_than_the_ranges_of_a_step() {
        let (_, scene) = cases().swap_remove(0);
        let run = one_run(&scene, 3);
        let mean =
            |m: usize| run[m].iter().filter_map(|o| o.error_m).collect::<Sample>().mean().expect("fixes");
        let (nls, ekf, lagged) = (mean(2), mean(4), mean(6));
        assert!(ekf < 0.6 * nls && lagged < 0.9 * ekf, "{nls} {ekf} {lagged}");
        assert_eq!(run[6].len(), run[4].len(), "every step is reported once");
    }
}
