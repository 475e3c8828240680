//! Parameter tuning, which Wang et al. 2023 name as future work: CMA-ES on a training set of layouts, evaluated on
//! another.

mod scale;

use crate::{
    bench::Bench,
    row::Row,
    spiral::{self, Group},
    study::{Options, Problem},
};
use cmaes::{CMAESOptions, DVector};
use mission::{ParamValue, Parameters, PlannerInfo};
use scale::Scale;
use std::cell::RefCell;

/// First step of the search as a share of each parameter's range.
const FIRST_STEP: f64 = 0.15;
/// What each unit of range outside the bounds costs, so that the search comes back.
const OUTSIDE_COST: f64 = 10.0;

/// What is to be tuned, and on what.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuning<'a> {
    /// The planner.
    pub planner: &'a PlannerInfo,
    /// Values to start from; the others start from their defaults.
    pub start: &'a Parameters,
    /// Keys of the parameters to tune.
    pub keys: &'a [String],
    /// The layouts.
    pub group: Group,
    /// Number and first seed of the layouts that it is tuned on.
    pub training: (usize, u64),
    /// Number and first seed of the layouts that it is evaluated on; none of the training set's.
    pub test: (usize, u64),
    /// Generations of the search.
    pub generations: usize,
    /// Seed of the search.
    pub seed: u64,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuned {
    /// The best values on the training set; all parameters that were tuned.
    pub values: Parameters,
    /// Loss on the training set: at the start, and of the best values.
    pub loss: (f64, f64),
    /// How many sets of values were tried.
    pub evaluations: usize,
    /// Figures on the test set, of the start (`ID/start`) and of the best values (`ID/tuned`).
    pub rows: Vec<Row>,
}

/// Searches for better values.
///
/// # Errors
/// A parameter that is unknown or no real number, sets of layouts that overlap, or a planner that breaks down.
pub fn tune(tuning: &Tuning<'_>, bench: &Bench<'_>) -> Result<Tuned, Problem> {
    check_sets(tuning)?;
    let scales = scales(tuning)?;
    let start: Vec<f64> = scales.iter().map(|scale| scale.share(tuning.start)).collect();
    let best = RefCell::new((f64::INFINITY, start.clone()));
    let broken: RefCell<Option<Problem>> = RefCell::new(None);
    let loss = |at: &DVector<f64>| {
        let outside: f64 = at.iter().map(|x| (x - x.clamp(0.0, 1.0)).abs()).sum();
        let inside: Vec<f64> = at.iter().map(|x| x.clamp(0.0, 1.0)).collect();
        if broken.borrow().is_some() {
            return f64::MAX;
        }
        let options = options(tuning.training);
        match spiral::loss(
            bench,
            &options,
            &tuning.planner.id,
            &merged(tuning, &scales, &inside),
            tuning.group,
        ) {
            Ok(loss) => {
                if loss < best.borrow().0 {
                    *best.borrow_mut() = (loss, inside);
                }
                loss + OUTSIDE_COST * outside
            }
            Err(problem) => {
                *broken.borrow_mut() = Some(problem);
                f64::MAX
            }
        }
    };
    let before = loss(&DVector::from_vec(start.clone()));
    let search = CMAESOptions::new(start, FIRST_STEP).seed(tuning.seed).max_generations(tuning.generations);
    let mut search =
        search.build(&loss).map_err(|e| Problem::Nothing(format!("the search cannot start: {e:?}")))?;
    while broken.borrow().is_none() && search.next().is_none() {}
    let evaluations = search.function_evals() + 1;
    drop(search);
    if let Some(problem) = broken.into_inner() {
        return Err(problem);
    }
    let (after, share) = best.into_inner();
    let tuned = merged(tuning, &scales, &share);
    let rows = evaluate(tuning, bench, &tuned)?;
    let values = scales.iter().map(|scale| (scale.key.clone(), tuned[&scale.key].clone())).collect();
    Ok(Tuned { values, loss: (before, after), evaluations, rows })
}

/// Rows of the start and of the tuned values on the test set.
fn evaluate(tuning: &Tuning<'_>, bench: &Bench<'_>, tuned: &Parameters) -> Result<Vec<Row>, Problem> {
    let options = options(tuning.test);
    let mut rows = Vec::new();
    for (name, parameters) in [("start", tuning.start), ("tuned", tuned)] {
        let method = format!("{}/{name}", tuning.planner.id);
        rows.extend(spiral::figures_of(
            bench,
            &options,
            (&tuning.planner.id, &method),
            parameters,
            tuning.group,
        )?);
    }
    Ok(rows)
}

fn options((layouts, first_seed): (usize, u64)) -> Options {
    Options { layouts: Some(layouts), first_seed, ..Options::default() }
}

fn merged(tuning: &Tuning<'_>, scales: &[Scale], shares: &[f64]) -> Parameters {
    let mut parameters = tuning.start.clone();
    for (scale, share) in scales.iter().zip(shares) {
        parameters.insert(scale.key.clone(), ParamValue::Float(scale.value(*share)));
    }
    parameters
}

fn scales(tuning: &Tuning<'_>) -> Result<Vec<Scale>, Problem> {
    if tuning.keys.is_empty() {
        return Err(Problem::Nothing("no parameter to tune".into()));
    }
    tuning.keys.iter().map(|key| Scale::of(tuning.planner, key).map_err(Problem::Nothing)).collect()
}

fn check_sets(tuning: &Tuning<'_>) -> Result<(), Problem> {
    let ((n, first), (m, other)) = (tuning.training, tuning.test);
    if first < other.saturating_add(m as u64) && other < first.saturating_add(n as u64) {
        return Err(Problem::Nothing(format!(
            "training seeds {first} to {} and test seeds {other} to {} overlap; figures on layouts that were tuned on \
             prove nothing",
            first + n as u64 - 1,
            other + m as u64 - 1,
        )));
    }
    Ok(())
}
