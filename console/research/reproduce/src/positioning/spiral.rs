//! The 500 points of the spiral, thirty runs.

use super::{
    bound::cramer_rao_m,
    estimator::{self, Estimator},
    outcome::{Outcome, run_rows},
    setup::{Layout, Setup, spiral},
};
use crate::study::{Block, Job, Result, Row, Sample, Study};
use sim::NoiseModel;

pub(super) const STUDY: Study = Study {
    name: "wang-spiral-fix",
    about: "Wang et al. 2023, section 3.3: positioning error along the spiral, and the theoretical limit with the same ranges",
    layouts: 30,
    run,
};

const METHODS: [Estimator; 5] = [
    estimator::LINEAR,
    estimator::NLS,
    estimator::NLS_MIDRANGE,
    estimator::NLS_POSTERIOR,
    estimator::BOUNDED,
];
/// Largest error of a range, as a share of the range.
const RATIO: f64 = 0.05;
const REPETITIONS: u32 = 20;
const LITERAL: &str = "spiral/literal";
/// The printed values of the paper's own method, metres.
const PRINTED: [(&str, f64); 2] = [("mean_error", 0.0748), ("std", 0.0032)];

fn run(job: &Job<'_>) -> Result<Vec<Row>> {
    let runs = job.runner.map(&job.seeds(), |_, seed| Ok(one_run(*seed)))?;
    let mut rows = Vec::new();
    for (k, method) in METHODS.iter().enumerate() {
        let block = job.block(LITERAL, method.id, "");
        let mut of_method = run_rows(&block, &runs.iter().map(|run| &run[k]).collect::<Vec<_>>());
        of_method.retain(|row| row.metric != "worst");
        if method.id == estimator::LINEAR.id {
            of_method = with_printed(&block, of_method);
        }
        rows.extend(of_method);
    }
    let stations = Layout::Paper.stations();
    let sigma_ratio = RATIO / 3.0_f64.sqrt();
    let bounds: Sample = spiral()
        .iter()
        .filter_map(|truth| cramer_rao_m(&stations, *truth, sigma_ratio, REPETITIONS))
        .collect();
    let block = job.block(LITERAL, "cramer-rao", "normal noise of the same variance");
    rows.push(block.row("bound", bounds.mean(), "m", bounds.len()));
    rows.retain(|row| job.has_case(&row.case) && job.has_method(&row.method));
    Ok(rows)
}

/// The rows of the paper's method, as printed and in the variant that gives the printed mean, with the printed
/// values.
fn with_printed(block: &Block<'_>, mut rows: Vec<Row>) -> Vec<Row> {
    let note = "error divided by the square root of two, which gives the printed mean";
    let parity = Block { case: "spiral/parity", note, ..*block };
    let is_printed = |row: &&Row| PRINTED.iter().any(|(metric, _)| *metric == row.metric);
    let scaled = |row: &Row| {
        let ours = row.ours.map(|value| value * 0.5_f64.sqrt());
        parity.row(&row.metric, ours, &row.unit, row.n)
    };
    let parity: Vec<Row> = rows.iter().filter(is_printed).map(scaled).collect();
    rows.extend(parity);
    for row in &mut rows {
        row.paper = PRINTED.iter().find(|(metric, _)| *metric == row.metric).map(|(_, value)| *value);
    }
    rows
}

fn one_run(seed: u64) -> [Vec<Outcome>; 5] {
    let setup = Setup::new(Layout::Paper, NoiseModel::Uniform { ratio: RATIO }, REPETITIONS);
    let cycles = setup.cycles(&spiral(), seed);
    METHODS.map(|method| method.outcomes(&setup, &cycles))
}
