//! Every coverage planner on every tank.

use super::{
    measured::{Measured, measure},
    rows::rows,
};
use crate::study::{Job, Method, Result, Row};
use trials::tanks::{Known, Tank};

/// A kind of tank: the id of the case, and the function that makes the tank of a seed.
type Case = (&'static str, fn(u64) -> Tank);

fn methods() -> [Method; 6] {
    let method = |id: &str, planner: &str| Method::new(id, planner, "");
    [
        method("boustrophedon", "boustrophedon"),
        method("hull-partition/direct", "hull-partition").word("backtracking", "direct"),
        method("hull-partition/tree", "hull-partition").word("backtracking", "tree"),
        method("tether-safe", "tether-safe"),
        method("tether-safe/alpha-0", "tether-safe").number("alpha_deg", 0.0),
        method("tether-safe/fewest-turns", "tether-safe").word("choose", "fewest-turns"),
    ]
}

/// The named tanks.
pub(super) fn pan_maps(job: &Job<'_>) -> Result<Vec<Row>> {
    let cases: [Case; 3] = [
        (Known::E1.id(), |seed| Known::E1.tank(seed)),
        (Known::E2.id(), |seed| Known::E2.tank(seed)),
        (Known::E3.id(), |seed| Known::E3.tank(seed)),
    ];
    run(job, &cases)
}

/// Tanks of any size.
pub(super) fn random(job: &Job<'_>) -> Result<Vec<Row>> {
    run(job, &[("random", Tank::random)])
}

fn run(job: &Job<'_>, cases: &[Case]) -> Result<Vec<Row>> {
    let cases = job.cases(cases, |case| case.0.into())?;
    let methods = job.methods(methods(), |method| method.id.clone())?;
    let runs: Vec<(&Case, &Method)> =
        cases.iter().flat_map(|case| methods.iter().map(move |method| (*case, method))).collect();
    let seeds = job.seeds();
    let all = job.runner.grid(&runs, &seeds, |planners, ((case, tank), method), seed| {
        let measured = measure(job.runner, planners, (case, *seed, &tank(*seed)), method);
        measured.map_err(|error| error.in_case(format!("{case} seed {seed}, {}", method.id)))
    })?;
    let of_run = |(((case, _), method), measured): (&(&Case, &Method), &Vec<Measured>)| {
        let block = job.block(case, &method.id, "");
        rows(&block, &seeds.iter().copied().zip(measured).collect::<Vec<_>>())
    };
    Ok(runs.iter().zip(&all).flat_map(of_run).collect())
}
