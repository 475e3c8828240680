//! Estimators with faulty ranges.

use super::{
    estimator::{self, Estimator},
    outcome::{Outcome, rows},
    setup::{Cycle, Layout, SESSION, Setup},
};
use crate::study::{Job, Result, Row, Study};
use positioning::{Calibration, Nls, PositionSolver, Unknowns};
use sim::{BehindColumns, NoiseModel};

pub(super) const STUDY: Study = Study {
    name: "positioning-robust",
    about: "estimators on the same ranges with hidden stations, outliers, echoes, survey errors and a wrong speed of sound",
    layouts: 10_000,
    run,
};

const METHODS: [Estimator; 6] = [
    estimator::LINEAR,
    estimator::NLS,
    estimator::NLS_TRIMMED,
    estimator::NLS_SCREENED,
    estimator::BOUNDED_OR_NLS,
    estimator::CONSENSUS,
];
/// Id of the method that estimates the speed of sound from its session.
const CALIBRATED: &str = "nls/calibrated";

/// The disturbance of a case, by its id.
type Impairment = (&'static str, fn(&mut Setup));

const IMPAIRMENTS: [Impairment; 13] = [
    ("clean", |_| {}),
    ("outliers-10", |setup| {
        let disturbances = &mut setup.ae.disturbances;
        (disturbances.outlier_probability, disturbances.outlier_factor) = (0.1, 10.0);
    }),
    ("late-pings-25", |setup| setup.ae.disturbances.late_ping_probability = 0.25),
    ("nlos-20", |setup| setup.ae.disturbances.nlos_probability = 0.2),
    ("bias-1", |setup| setup.is_biased = true),
    ("columns-creeping", |setup| columns(setup, BehindColumns::Creeping)),
    ("columns-late", |setup| columns(setup, BehindColumns::Late)),
    ("columns-echo", |setup| columns(setup, BehindColumns::WallEcho)),
    ("columns-silent", |setup| columns(setup, BehindColumns::Silent)),
    ("dropout-30", |setup| setup.ae.disturbances.ping_dropout_probability = 0.3),
    ("survey-0.05", |setup| setup.ae.disturbances.survey_sigma_m = 0.05),
    ("sound+1", |setup| setup.ae.disturbances.sound_speed_error_ratio = 0.01),
    ("sound+2", |setup| setup.ae.disturbances.sound_speed_error_ratio = 0.02),
];

fn columns(setup: &mut Setup, behind: BehindColumns) {
    setup.has_columns = true;
    setup.ae.disturbances.behind_columns = behind;
}

fn cases() -> Vec<(String, Setup)> {
    let layouts = [
        Layout::Paper,
        Layout::Ring(4, 7.5),
        Layout::Ring(6, 7.5),
        Layout::Ring(7, 7.5),
        Layout::Ring(8, 7.5),
    ];
    let case = |layout: Layout, (id, impair): Impairment| {
        let mut setup = Setup::new(layout, NoiseModel::Uniform { ratio: 0.05 }, 20);
        setup.ae.disturbances.excess_range_mean_m = 1.0;
        impair(&mut setup);
        (format!("disc/{}/{id}", layout.id()), setup)
    };
    layouts.into_iter().flat_map(|layout| IMPAIRMENTS.map(|impairment| case(layout, impairment))).collect()
}

/// An id and its estimator; `None` for the method that first calibrates the speed of sound.
type Entry = (&'static str, Option<Estimator>);

fn entries() -> impl Iterator<Item = Entry> {
    METHODS.into_iter().map(|method| (method.id, Some(method))).chain([(CALIBRATED, None)])
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let cases = job.cases(cases(), |(id, _)| id.clone())?;
    let entries = job.methods(entries(), |(id, _)| (*id).into())?;
    let seeds = job.seeds();
    let sessions: Vec<&[u64]> = seeds.chunks(SESSION).collect();
    let done =
        job.runner.grid(&cases, &sessions, |_, (_, setup), seeds| Ok(session(setup, seeds, &entries)))?;
    let mut all = Vec::new();
    for ((case, _), sessions) in cases.iter().zip(&done) {
        for (m, (method, _)) in entries.iter().enumerate() {
            let outcomes: Vec<Outcome> =
                sessions.iter().flat_map(|session| session[m].iter().copied()).collect();
            if !outcomes.is_empty() {
                all.extend(rows(&job.block(case, method, ""), &outcomes));
            }
        }
    }
    Ok(all)
}

/// The outcomes of each estimator.
fn session(setup: &Setup, seeds: &[u64], entries: &[Entry]) -> Vec<Vec<Outcome>> {
    let cycles = setup.session(seeds);
    let outcomes = |(_, estimator): &Entry| match estimator {
        Some(estimator) => estimator.outcomes(setup, &cycles),
        None => calibrated(setup, &cycles),
    };
    entries.iter().map(outcomes).collect()
}

/// Nonlinear least squares after the speed of sound was estimated from the ranges of the whole session.
fn calibrated(setup: &Setup, cycles: &[Cycle]) -> Vec<Outcome> {
    let (stations, noise) = (&setup.stations, setup.noise());
    if stations.len() < 4 {
        return Vec::new();
    }
    let mut calibration = Calibration::new(stations, Unknowns::default());
    for cycle in cycles {
        if let Ok(ranges) = estimator::NLS.ranges(&cycle.sets, &noise) {
            let _ = calibration.take(&ranges, None);
        }
    }
    let outcome = |cycle: &Cycle| {
        let ranges = estimator::NLS.ranges(&cycle.sets, &noise);
        let fix = ranges.and_then(|ranges| Nls.solve(&calibration.corrected(&ranges), stations, None));
        Outcome::of(&fix, cycle.truth, 0.0)
    };
    cycles.iter().map(outcome).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::positioning::outcome::errors;

    fn mean(id: &str, method: usize) -> f64 {
        let (_, setup) = cases().into_iter().find(|case| case.0 == id).expect("a case");
        let entries: Vec<Entry> = entries().collect();
        let done = session(&setup, &(0..400).collect::<Vec<_>>(), &entries);
        errors(&done[method]).mean().expect("fixes")
    }

    #[test]
    fn consensus_tolerates_hidden_stations_and_least_squares_do_not() {
        let (nls, consensus) = (mean("disc/8-stations/nlos-20", 1), mean("disc/8-stations/nlos-20", 5));
        assert!(consensus < 0.07 && consensus < 0.4 * nls, "{consensus} {nls}");
    }

    #[test]
    fn a_calibrated_session_does_not_mind_slow_sound() {
        let (slow, clean) = (mean("disc/6-stations/sound+2", 6), mean("disc/6-stations/clean", 1));
        assert!(slow < 1.08 * clean, "{slow} {clean}");
    }

    #[test]
    fn every_impairment_has_its_case_for_every_layout() {
        assert_eq!(cases().len(), 5 * IMPAIRMENTS.len());
    }
}
