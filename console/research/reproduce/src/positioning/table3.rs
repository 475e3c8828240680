//! Table 3: twelve environments, five levels of noise, thirty runs.

use super::{
    estimator::LINEAR,
    setup::{Layout, Setup, in_square, on_disc, rng},
    significance::p_value,
};
use crate::study::{Job, Result, Row, Sample, Study};
use sim::NoiseModel;
use world::Point;

/// The printed values: environment, statistic, noise, value.
const PRINTED: &str = include_str!("table3.csv");
const POINTS: usize = 50;
const RUNS: usize = 30;
const LEVELS: [f64; 5] = [0.01, 0.02, 0.03, 0.04, 0.05];
const ENVIRONMENTS: u64 = 12;
/// Every statistic of the printed table, with its metric id.
const STATISTICS: [(&str, &str); 5] =
    [("best", "best"), ("mean", "mean_error"), ("worst", "worst"), ("std", "std"), ("ttest_p", "p_value")];

pub(super) const STUDY: Study = Study {
    name: "wang-table3",
    about: "Wang et al. 2023, Table 3: positioning error of 12 environments at 5 levels of noise, with the \
            t-test",
    layouts: 60,
    run,
};

/// The interpretation of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Profile {
    /// As in the equations: points on the floor, Euclidean error.
    Literal,
    /// In the way that gives the printed numbers: points in the square around the floor, error divided by the square
    /// root of two.
    Parity,
}

impl Profile {
    fn id(self) -> &'static str {
        match self {
            Self::Literal => "literal",
            Self::Parity => "parity",
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct Case {
    profile: Profile,
    environment: u64,
}

/// The statistics of one cell of one table.
type Cell = [Option<f64>; 5];

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let profiles = [Profile::Literal, Profile::Parity];
    let cases: Vec<Case> = profiles
        .into_iter()
        .flat_map(|profile| (1..=ENVIRONMENTS).map(move |environment| Case { profile, environment }))
        .collect();
    let seeds = job.seeds();
    let cells = job.runner.grid(&cases, &seeds, |_, case, seed| Ok(cells(*case, *seed)))?;
    let mut rows = Vec::new();
    for (profile, cells) in profiles.into_iter().zip(cells.chunks(ENVIRONMENTS as usize)) {
        for (level, nu) in LEVELS.into_iter().enumerate() {
            for (statistic, (printed_id, metric)) in STATISTICS.into_iter().enumerate() {
                let case = |name: &str| format!("{name}/nu-{nu}/{}", profile.id());
                let mut columns: Vec<(Option<f64>, Option<f64>)> = Vec::new();
                for (environment, cells) in (1..).zip(cells) {
                    let values: Sample = cells.iter().filter_map(|cells| cells[level][statistic]).collect();
                    let ours = if metric == "p_value" { values.median() } else { values.mean() };
                    let name = format!("P{environment:02}");
                    let paper = printed(&name, printed_id, nu);
                    columns.push((paper, ours));
                    let row = row(job, &case(&name), metric, ours, values.len()).printed(paper);
                    rows.push(row.of_one_draw(values.range_95()));
                }
                if metric != "p_value" {
                    let paper = columns.iter().filter_map(|column| column.0).collect::<Sample>().mean();
                    let means: Sample = columns.iter().filter_map(|column| column.1).collect();
                    let n = cells.len() * seeds.len();
                    let row = row(job, &case("all"), metric, means.mean(), n).printed(paper);
                    rows.push(row.within(means.mean_interval_95()));
                }
            }
        }
    }
    Ok(rows.into_iter().filter(|row| job.has_case(&row.case)).collect())
}

fn row(job: &Job<'_>, case: &str, metric: &str, ours: Option<f64>, n: usize) -> Row {
    let note = match metric {
        "p_value" => {
            "one-sample two-sided t-test of the 30 means against 0; median over the tables. The p-value changes by \
             orders of magnitude with the errors, so its printed digits can be matched only by chance"
        }
        _ if case.ends_with("parity") => {
            "points in the square around the floor, error divided by the square root of two"
        }
        _ => "",
    };
    let unit = if metric == "p_value" { "" } else { "m" };
    job.block(case, LINEAR.id, note).row(metric, ours, unit, n)
}

fn cells(case: Case, seed: u64) -> [Cell; 5] {
    let mut rng = rng(seed, 100 + case.environment);
    let truths: Vec<Point> = (0..POINTS)
        .map(|_| if case.profile == Profile::Literal { on_disc(&mut rng) } else { in_square(&mut rng) })
        .collect();
    let scale = if case.profile == Profile::Literal { 1.0 } else { 0.5_f64.sqrt() };
    let mut level = 0;
    LEVELS.map(|ratio| {
        level += 1;
        let setup = Setup::new(Layout::Paper, NoiseModel::Uniform { ratio }, 20);
        let mut sounder = setup.sounder(seed.wrapping_mul(1000).wrapping_add(case.environment * 10 + level));
        let means: Sample = (0..RUNS)
            .filter_map(|_| {
                let errors: Sample = truths
                    .iter()
                    .filter_map(|truth| {
                        let fix = LINEAR.fix(&setup, &sounder.cycle(0.0, *truth)).ok()?;
                        Some((fix.position - truth).norm() * scale)
                    })
                    .collect();
                errors.mean()
            })
            .collect();
        [means.min(), means.mean(), means.max(), means.standard_deviation(), p_value(&means)]
    })
}

fn printed(environment: &str, statistic: &str, nu: f64) -> Option<f64> {
    PRINTED.lines().find_map(|line| {
        let [name, what, level, value] = line.split(',').collect::<Vec<_>>()[..] else { return None };
        let is_it =
            name == environment && what == statistic && (level.parse::<f64>().ok()? - nu).abs() < 1e-9;
        is_it.then(|| value.parse().ok()).flatten()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_printed_cell_is_found() {
        for environment in 1..=ENVIRONMENTS {
            for (statistic, _) in STATISTICS {
                for nu in LEVELS {
                    assert!(printed(&format!("P{environment:02}"), statistic, nu).is_some());
                }
            }
        }
    }

    #[test]
    fn a_cell_of_parity_is_near_the_printed_one_and_the_literal_one_is_not() {
        let all = |profile| {
            let cells = (1..=3).map(|environment| cells(Case { profile, environment }, 5)[4][1]);
            cells.flatten().collect::<Sample>().mean().expect("three cells")
        };
        assert!((all(Profile::Parity) / 0.1043 - 1.0).abs() < 0.12);
        assert!(all(Profile::Literal) > 0.115);
    }
}
