//! Filters on the spiral: cycles of ranges and steps of odometry alternate.

use super::{
    estimator,
    odometry::{SLIP_CHANCE, Track, track},
    outcome::{Outcome, run_rows},
    setup::{Layout, Setup},
};
use crate::study::{Job, Result, Row, Study};
use positioning::{
    Aggregation, Ekf, FixedLag, MotionNoise, Nls, Particles, ParticlesConfig, PositionSolver, Ranging,
};
use sim::NoiseModel;
use world::{Point, Station};

pub(super) const STUDY: Study = Study {
    name: "positioning-filter",
    about: "filters that combine ranges and odometry along the spiral, on the same draws",
    layouts: 30,
    run,
};

/// The odometry noise that the filters assume for the tracks.
const MOTION: MotionNoise = MotionNoise {
    sigma_per_m: 0.03,
    way_sigma_ratio: 0.05,
    turn_sigma_ratio: 0.1,
    heading_sigma_per_tick_rad: 0.001,
    slip_chance: SLIP_CHANCE,
};
/// Number of steps that the smoother looks back.
const LAG: usize = 10;
/// Standard deviations of position and heading at the start, a surveyed manway, metres and radians.
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

fn cases() -> Vec<(String, Setup)> {
    let noises = [
        ("uniform-5", NoiseModel::Uniform { ratio: 0.05 }),
        ("triangular-5", NoiseModel::Triangular { ratio: 0.05 }),
    ];
    noises
        .into_iter()
        .flat_map(|noise| [1, 20].map(|n| (noise, n)))
        .map(|((name, noise), n)| (format!("spiral/{name}/n-{n}"), Setup::new(Layout::Paper, noise, n)))
        .collect()
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let cases = job.cases(cases(), |(id, _)| id.clone())?;
    let methods = job.methods(METHODS.iter().enumerate(), |(_, id)| (**id).into())?;
    let done = job.runner.grid(&cases, &job.seeds(), |_, (_, setup), seed| Ok(one_run(setup, *seed)))?;
    let mut rows = Vec::new();
    for ((case, _), runs) in cases.iter().zip(&done) {
        for (m, method) in &methods {
            let of_method: Vec<&Vec<Outcome>> = runs.iter().map(|run| &run[*m]).collect();
            if of_method.iter().any(|run| run.iter().any(|o| o.error_m.is_some())) {
                rows.extend(run_rows(&job.block(case, method, ""), &of_method));
            }
        }
    }
    // Dead reckoning has no ellipse.
    rows.retain(|row| row.method != METHODS[0] || row.metric != "in_95_ellipse");
    Ok(rows)
}

fn one_run(setup: &Setup, seed: u64) -> Vec<Vec<Outcome>> {
    let (track, noise) = (track(seed), setup.noise());
    let truths: Vec<Point> = track.steps.iter().map(|(_, truth)| *truth).collect();
    let cycles = setup.cycles(&truths, seed);
    let ranges = |how: Aggregation| -> Vec<Vec<Ranging>> {
        cycles.iter().map(|cycle| how.aggregate(&cycle.sets, &noise).unwrap_or_default()).collect()
    };
    let means = ranges(Aggregation::Mean);
    let (mean, lagged) = filtered(&track, &means, &setup.stations);
    let (midrange, lagged_midrange) = filtered(&track, &ranges(Aggregation::Midrange), &setup.stations);
    vec![
        dead_reckoning(&track),
        estimator::LINEAR.outcomes(setup, &cycles),
        estimator::NLS.outcomes(setup, &cycles),
        estimator::BOUNDED.outcomes(setup, &cycles),
        mean,
        midrange,
        lagged,
        lagged_midrange,
        particles(&track, &means, setup, seed),
    ]
}

fn dead_reckoning(track: &Track) -> Vec<Outcome> {
    let mut pose = track.start;
    let step = |(odometry, truth): &(world::Odometry, Point)| {
        pose = pose.moved(odometry.forward_m, odometry.sideways_m, odometry.turn_rad);
        Outcome { error_m: Some((pose.position - truth).norm()), ..Outcome::default() }
    };
    track.steps.iter().map(step).collect()
}

/// The outcomes of the filter and of the smoother.
fn filtered(track: &Track, ranges: &[Vec<Ranging>], stations: &[Station]) -> (Vec<Outcome>, Vec<Outcome>) {
    let mut smoother = FixedLag::new(Ekf::new(track.start, START.0, START.1, MOTION), LAG);
    let (mut now, mut back) = (Vec::new(), Vec::new());
    for (k, ((odometry, truth), ranges)) in track.steps.iter().zip(ranges).enumerate() {
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
        now.push(Outcome::of_estimate(filter.pose().position, &filter.position_covariance(), *truth));
        let smoothed = smoother.smoothed();
        let past = |ago: usize| track.steps.get((k + 1).checked_sub(ago + 1)?).map(|(_, truth)| *truth);
        if k + 1 == track.steps.len() {
            // At the end, report all remaining steps.
            back.extend(
                smoothed
                    .iter()
                    .filter_map(|s| Some(Outcome::of_estimate(s.pose.position, &s.covariance, past(s.lag)?))),
            );
        } else if let Some(s) = smoothed.first().filter(|s| s.lag == LAG) {
            back.extend(past(LAG).map(|truth| Outcome::of_estimate(s.pose.position, &s.covariance, truth)));
        }
    }
    (now, back)
}

fn particles(track: &Track, ranges: &[Vec<Ranging>], setup: &Setup, seed: u64) -> Vec<Outcome> {
    let Some(ratio) = setup.noise().bound_ratio() else { return Vec::new() };
    let config =
        ParticlesConfig { count: PARTICLES, ratio, odometry: MOTION, slip_chance: SLIP_CHANCE, seed };
    let mut filter = Particles::new(track.start, START.0, START.1, config);
    let mut outcomes = Vec::new();
    for ((odometry, truth), ranges) in track.steps.iter().zip(ranges) {
        filter.predict(odometry);
        // Impossible ranges leave the particles unchanged.
        let _ = filter.update(ranges, &setup.stations);
        let (pose, covariance) = filter.estimate();
        let covariance = covariance.fixed_view::<2, 2>(0, 0).into_owned();
        outcomes.push(Outcome::of_estimate(pose.position, &covariance, *truth));
        filter.renew(ranges, &setup.stations);
    }
    outcomes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::positioning::outcome::errors;

    #[test]
    fn memory_is_worth_more_than_the_ranges_of_a_step() {
        let (_, setup) = cases().swap_remove(0);
        let run = one_run(&setup, 3);
        let mean = |m: usize| errors(&run[m]).mean().expect("fixes");
        let (nls, ekf, lagged) = (mean(2), mean(4), mean(6));
        assert!(ekf < 0.6 * nls && lagged < 0.9 * ekf, "{nls} {ekf} {lagged}");
        assert_eq!(run[6].len(), run[4].len(), "every step is reported once");
    }
}
