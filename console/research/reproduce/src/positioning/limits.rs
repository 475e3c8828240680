//! Every estimator at places all over the floor, on the same ranges, beside the theoretical bounds.

use super::{
    bound::cramer_rao_m,
    estimator::{self, Estimator},
    outcome::{Outcome, rows},
    setup::{Cycle, Layout, RADIUS_M, SESSION, Setup},
};
use crate::study::{Job, Result, Row, Sample, Study};
use serde::{Deserialize, Serialize};
use sim::NoiseModel;

pub(super) const STUDY: Study = Study {
    name: "positioning-limits",
    about: "every estimator at places all over the floor, on the same ranges, by stations, noise and \
            repetitions, with the theoretical bound",
    layouts: 10_000,
    run,
};

const METHODS: [Estimator; 7] = [
    estimator::LINEAR,
    estimator::WEIGHTED,
    estimator::NLS,
    estimator::NLS_MIDRANGE,
    estimator::NLS_POSTERIOR,
    estimator::BOUNDED,
    estimator::CONSENSUS,
];

fn cases() -> Vec<(String, Setup)> {
    let uniform = NoiseModel::Uniform { ratio: 0.05 };
    let sigma_ratio = 0.05 / 3.0_f64.sqrt();
    let others = [
        ("triangular-5", NoiseModel::Triangular { ratio: 0.05 }),
        ("gaussian-2.9", NoiseModel::Gaussian { sigma_ratio }),
        ("heavy-tailed-2.9", NoiseModel::HeavyTailed { sigma_ratio }),
    ];
    let case = |layout: Layout, name: &str, noise, repetitions| {
        (format!("disc/{}/{name}", layout.id()), Setup::new(layout, noise, repetitions))
    };
    let paper = Layout::Paper;
    let mut cases = vec![case(paper, "uniform-5", uniform, 20)];
    cases.extend([1, 5].map(|n| case(paper, &format!("uniform-5/n-{n}"), uniform, n)));
    cases.extend(others.map(|(name, noise)| case(paper, name, noise, 20)));
    cases.extend([4, 6, 8].map(|n| case(Layout::Ring(n, 7.5), "uniform-5", uniform, 20)));
    cases.extend([3, 4, 6, 8].map(|n| case(Layout::Ring(n, RADIUS_M), "uniform-5", uniform, 20)));
    cases
}

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let cases = job.cases(cases(), |(id, _)| id.clone())?;
    let methods: Vec<Estimator> = METHODS.into_iter().filter(|m| job.has_method(m.id)).collect();
    let seeds = job.seeds();
    let sessions: Vec<&[u64]> = seeds.chunks(SESSION).collect();
    let done =
        job.runner.grid(&cases, &sessions, |_, (_, setup), seeds| Ok(session(setup, seeds, &methods)))?;
    let mut all = Vec::new();
    for ((id, setup), sessions) in cases.iter().zip(&done) {
        for (m, method) in methods.iter().enumerate() {
            let outcomes: Vec<Outcome> =
                sessions.iter().flat_map(|session| session.outcomes[m].iter().copied()).collect();
            if outcomes.iter().any(|o| o.error_m.is_some()) {
                let block = job.block(id, method.id, "");
                all.extend(rows(&block, &outcomes));
            }
        }
        let bounds: Sample = sessions.iter().flat_map(|session| session.bounds_m.iter().copied()).collect();
        let note = format!("normal noise of the same variance, {} repetitions", setup.ae.repetitions);
        all.push(job.block(id, "cramer-rao", &note).row("bound", bounds.mean(), "m", bounds.len()));
    }
    Ok(all)
}

#[derive(Serialize, Deserialize)]
struct Session {
    /// The errors of each method, one per true position.
    outcomes: Vec<Vec<Outcome>>,
    bounds_m: Vec<f64>,
}

fn session(setup: &Setup, seeds: &[u64], methods: &[Estimator]) -> Session {
    let cycles = setup.session(seeds);
    let (stations, sigma_ratio) = (&setup.stations, setup.noise().sigma_ratio());
    let bound_m = |cycle: &Cycle| cramer_rao_m(stations, cycle.truth, sigma_ratio, setup.ae.repetitions);
    Session {
        outcomes: methods.iter().map(|method| method.outcomes(setup, &cycles)).collect(),
        bounds_m: cycles.iter().filter_map(bound_m).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::positioning::outcome::errors;

    #[test]
    fn the_better_the_method_the_smaller_the_error() {
        let (_, setup) = cases().swap_remove(0);
        let session = session(&setup, &(0..400).collect::<Vec<_>>(), &METHODS);
        let mean = |m: usize| errors(&session.outcomes[m]).mean().expect("fixes");
        let (linear, nls, bounded) = (mean(0), mean(2), mean(5));
        assert!(bounded < 0.5 * nls && nls < 0.7 * linear, "{bounded} {nls} {linear}");
        let bound = session.bounds_m.iter().sum::<f64>() / 400.0;
        assert!((nls / bound - 1.0).abs() < 0.1, "{nls} {bound}");
    }
}
