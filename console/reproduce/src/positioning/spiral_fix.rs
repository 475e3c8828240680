//! The 500 points of the spiral, thirty runs.

use super::{
    method::{self, Method},
    scene::{Layout, Scene, spiral},
    tally::{Outcome, cramer_rao_m},
};
use crate::{
    bench::Bench,
    row::Row,
    sample::Sample,
    study::{Options, Problem, Study},
};
use sim::NoiseModel;

pub(super) const STUDY: Study = Study {
    name: "wang-spiral-fix",
    about: "Wang et al. 2023, section 3.3: positioning error along the spiral, and what is possible with the same ranges",
    layouts: 30,
    run,
};

const METHODS: [Method; 5] =
    [method::LINEAR, method::NLS, method::NLS_MIDRANGE, method::NLS_POSTERIOR, method::BOUNDED];
/// Largest error of a range as a share of it.
const RATIO: f64 = 0.05;
const REPETITIONS: u32 = 20;

fn run(study: &Study, bench: &Bench<'_>, options: &Options) -> Result<Vec<Row>, Problem> {
    let seeds: Vec<u64> = options.seeds(study.layouts).collect();
    let runs = bench.map(&seeds, |_, seed| Ok(one_run(*seed)))?;
    let mut rows = Vec::new();
    for (k, method) in METHODS.iter().enumerate() {
        let means: Sample = runs.iter().filter_map(|run| mean_error(&run[k])).collect();
        let all: Vec<Outcome> = runs.iter().flat_map(|run| run[k].iter().copied()).collect();
        let errors: Sample = all.iter().filter_map(|o| o.error_m).collect();
        let inside = all.iter().filter(|o| o.is_inside).count() as f64 / all.len() as f64;
        let printed = |value: f64| (method.id == method::LINEAR.id).then_some(value);
        let row = |case: &str, metric: &str, ours: Option<f64>, unit: &str| {
            Row::new(study.name, case, method.id, metric, ours, unit).of(runs.len())
        };
        rows.push(row("spiral/literal", "mean_error", means.mean(), "m").printed(printed(0.0748)));
        rows.push(row("spiral/literal", "std", means.standard_deviation(), "m").printed(printed(0.0032)));
        rows.push(row("spiral/literal", "p95_error", errors.quantile(0.95), "m"));
        rows.push(row("spiral/literal", "in_95_ellipse", Some(inside), ""));
        if method.id == method::LINEAR.id {
            let half = 0.5_f64.sqrt();
            let note = "error over the root of two: the printed mean comes out so";
            let parity = |metric: &str, ours: Option<f64>, paper: f64| {
                row("spiral/parity", metric, ours.map(|v| v * half), "m").printed(paper).note(note)
            };
            rows.push(parity("mean_error", means.mean(), 0.0748));
            rows.push(parity("std", means.standard_deviation(), 0.0032));
        }
    }
    let stations = Layout::Paper.stations();
    let sigma_ratio = RATIO / 3.0_f64.sqrt();
    let bounds: Sample = spiral()
        .iter()
        .filter_map(|truth| cramer_rao_m(&stations, *truth, sigma_ratio, REPETITIONS))
        .collect();
    rows.push(
        Row::new(study.name, "spiral/literal", "cramer-rao", "bound", bounds.mean(), "m")
            .of(bounds.len())
            .note("normal noise of the same variance"),
    );
    rows.retain(|row| options.has_case(&row.case) && options.has_method(&row.method));
    Ok(rows)
}

fn mean_error(outcomes: &[Outcome]) -> Option<f64> {
    outcomes.iter().filter_map(|o| o.error_m).collect::<Sample>().mean()
}

fn one_run(seed: u64) -> [Vec<Outcome>; 5] {
    let scene = Scene::new(Layout::Paper, NoiseModel::Uniform { ratio: RATIO }, REPETITIONS);
    let (noise, truths) = (scene.noise(), spiral());
    let cycles = super::scene::cycles(&scene, &truths, seed);
    METHODS.map(|method| {
        let pairs = truths.iter().zip(&cycles);
        pairs
            .map(|(truth, sets)| Outcome::of(&method.fix(sets, &scene.stations, &noise), *truth, 0.0))
            .collect()
    })
}
