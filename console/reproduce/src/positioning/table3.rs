//! Table 3: twelve environments, five levels of noise, thirty runs.

use super::{
    method::LINEAR,
    scene::{Layout, Scene, chance, in_square, on_disc},
    student::p_value,
};
use crate::{
    bench::Bench,
    row::Row,
    sample::Sample,
    study::{Options, Problem, Study},
};
use sim::NoiseModel;
use world::Point;

/// The printed values: environment, statistic, noise, value.
const PRINTED: &str = include_str!("table3.csv");
const POINTS: usize = 50;
const RUNS: usize = 30;
const LEVELS: [f64; 5] = [0.01, 0.02, 0.03, 0.04, 0.05];
const ENVIRONMENTS: u64 = 12;
/// Statistic of the printed table and metric id.
const STATISTICS: [(&str, &str); 5] =
    [("best", "best"), ("mean", "mean_error"), ("worst", "worst"), ("std", "std"), ("ttest_p", "p_value")];

pub(super) const STUDY: Study = Study {
    name: "wang-table3",
    about: "Wang et al. 2023, Table 3: positioning error of 12 environments at 5 levels of noise, with the t-test",
    layouts: 60,
    run,
};

/// How the table is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Profile {
    /// As the equations say: points on the floor, Euclidean error.
    Literal,
    /// As the printed numbers come out: points in the square around the floor, error over the root of two.
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
    seed: u64,
}

/// The statistics of one cell of one table.
type Cell = [Option<f64>; 5];

fn run(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let profiles = [Profile::Literal, Profile::Parity];
    let cases: Vec<Case> = profiles
        .into_iter()
        .flat_map(|profile| (1..=ENVIRONMENTS).map(move |environment| (profile, environment)))
        .flat_map(|(profile, environment)| {
            options.seeds(study.layouts).map(move |seed| Case { profile, environment, seed })
        })
        .collect();
    let cells = bench.map(&cases, |_, case| Ok(cells(*case)))?;
    let mut rows = Vec::new();
    for profile in profiles {
        for (level, nu) in LEVELS.into_iter().enumerate() {
            for (statistic, (printed_id, metric)) in STATISTICS.into_iter().enumerate() {
                let mut columns: Vec<(Option<f64>, Option<f64>)> = Vec::new();
                for environment in 1..=ENVIRONMENTS {
                    let values: Sample = cases
                        .iter()
                        .zip(&cells)
                        .filter(|(case, _)| case.profile == profile && case.environment == environment)
                        .filter_map(|(_, cells)| cells[level][statistic])
                        .collect();
                    let ours = if metric == "p_value" { values.median() } else { values.mean() };
                    let name = format!("P{environment:02}");
                    let paper = printed(&name, printed_id, nu);
                    columns.push((paper, ours));
                    let case = format!("{name}/nu-{nu}/{}", profile.id());
                    rows.push(row(study, &case, metric, ours, values.len()).printed(paper));
                }
                let mean_printed = columns.iter().filter_map(|column| column.0).collect::<Sample>().mean();
                let mean_ours = columns.iter().filter_map(|column| column.1).collect::<Sample>().mean();
                if metric != "p_value" {
                    let case = format!("all/nu-{nu}/{}", profile.id());
                    let n = cases.len() / profiles.len();
                    rows.push(row(study, &case, metric, mean_ours, n).printed(mean_printed));
                }
            }
        }
    }
    Ok(rows.into_iter().filter(|row| options.has_case(&row.case)).collect())
}

fn row(study: &Study, case: &str, metric: &str, ours: Option<f64>, n: usize) -> Row {
    let note = match metric {
        "p_value" => "one-sample two-sided t-test of the 30 means against 0; median over the tables",
        _ if case.ends_with("parity") => "points in the square around the floor, error over the root of two",
        _ => "",
    };
    let unit = if metric == "p_value" { "" } else { "m" };
    Row::new(study.name, case, LINEAR.id, metric, ours, unit).of(n).note(note)
}

fn cells(case: Case) -> [Cell; 5] {
    let mut rng = chance(case.seed, 100 + case.environment);
    let truths: Vec<Point> = (0..POINTS)
        .map(|_| if case.profile == Profile::Literal { on_disc(&mut rng) } else { in_square(&mut rng) })
        .collect();
    let scale = if case.profile == Profile::Literal { 1.0 } else { 0.5_f64.sqrt() };
    let mut level = 0;
    LEVELS.map(|ratio| {
        level += 1;
        let scene = Scene::new(Layout::Paper, NoiseModel::Uniform { ratio }, 20);
        let noise = scene.noise();
        let seed = case.seed.wrapping_mul(1000).wrapping_add(case.environment * 10 + level);
        let mut sounder = scene.sounder(seed);
        let means: Sample = (0..RUNS)
            .filter_map(|_| {
                let errors: Sample = truths
                    .iter()
                    .filter_map(|truth| {
                        let fix = LINEAR.fix(&sounder.cycle(0.0, *truth), &scene.stations, &noise).ok()?;
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
            let cells = (1..=3).map(|environment| cells(Case { profile, environment, seed: 5 })[4][1]);
            cells.flatten().collect::<Sample>().mean().expect("three cells")
        };
        assert!((all(Profile::Parity) / 0.1043 - 1.0).abs() < 0.12);
        assert!(all(Profile::Literal) > 0.115);
    }
}
