//! Parameter tuning, which Wang et al. 2023 name as future work: CMA-ES on a training set of layouts, evaluated on
//! another.

mod scale;

use crate::{
    spiral::{Group, Trained},
    study::{Method, Result, Row, Runner, StudyError},
    table::table,
};
use cmaes::{CMAESOptions, DVector, options::InvalidOptionsError};
use mission::{ParamKind, ParamValue, Parameters, PlannerInfo};
use scale::Scale;
use std::cell::RefCell;

/// Initial step of the search, as a share of each parameter's range.
const FIRST_STEP: f64 = 0.15;
/// Penalty for each unit of range outside the bounds; it leads the search back inside.
const OUTSIDE_COST: f64 = 10.0;
/// The group of parameters that are tuned if none is named.
const DEFAULT_GROUP: &str = "Field";

/// The parameters to tune, and the layouts for tuning.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuning<'a> {
    /// The planner.
    pub planner: &'a PlannerInfo,
    /// Initial values; other parameters start from their defaults.
    pub start: &'a Parameters,
    /// Keys of the parameters to tune; every real number of the group "Field" if empty.
    pub keys: &'a [String],
    /// Name of the layouts.
    pub on: &'a str,
    /// Number and first seed of the training layouts.
    pub training: (usize, u64),
    /// Number and first seed of the test layouts, which must not overlap the training layouts.
    pub test: (usize, u64),
    /// Generations of the search.
    pub generations: usize,
    /// Seed of the search.
    pub seed: u64,
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuned {
    /// The best values on the training set, for all tuned parameters.
    pub values: Parameters,
    /// Loss on the training set: of the initial values, and of the best values.
    pub loss: (f64, f64),
    /// Number of sets of values that were tried.
    pub evaluations: usize,
    /// Figures on the test set, for the initial values (`ID/start`) and the best values (`ID/tuned`).
    pub rows: Vec<Row>,
}

/// A search whose input has been checked.
struct Search<'a> {
    tuning: &'a Tuning<'a>,
    group: Group,
    scales: Vec<Scale>,
}

/// The best values so far, as shares of their ranges, and their loss.
struct Best {
    loss: f64,
    shares: Vec<f64>,
}

impl Tuning<'_> {
    /// Searches for better values.
    ///
    /// # Errors
    /// Unknown layouts, sets of layouts that are empty or overlap, a parameter that is unknown or not a real number,
    /// or a planner that fails.
    pub fn search(&self, runner: &Runner<'_>) -> Result<Tuned> {
        let search = self.checked().map_err(StudyError::Refused)?;
        let (before, best, evaluations) = search.best(runner)?;
        let tuned = search.parameters(&best.shares);
        let rows = |name: &str, parameters: &Parameters| {
            let id = format!("{}/{name}", self.planner.id);
            Ok(search.train(runner, self.test, &id, parameters.clone())?.rows())
        };
        let rows = [rows("start", self.start)?, rows("tuned", &tuned)?].concat();
        let values = search.scales.iter().map(|scale| (scale.key.clone(), tuned[&scale.key].clone()));
        Ok(Tuned { values: values.collect(), loss: (before, best.loss), evaluations, rows })
    }

    fn checked(&self) -> Result<Search<'_>, String> {
        let group = Group::named(self.on).ok_or_else(|| {
            let known = "known: wang-d1, wang-d2, wang-d3, and each of these followed by -square";
            format!("unknown layouts `{}`; {known}", self.on)
        })?;
        let numbers =
            [("layouts", self.training.0), ("test-layouts", self.test.0), ("generations", self.generations)];
        if let Some((name, _)) = numbers.iter().find(|(_, number)| *number == 0) {
            return Err(format!("--{name} 0 tunes nothing; give at least 1"));
        }
        self.check_sets()?;
        let keys = if self.keys.is_empty() { default_keys(self.planner) } else { self.keys.to_vec() };
        if keys.is_empty() {
            return Err("no parameter to tune".into());
        }
        let scales = keys.iter().map(|key| Scale::of(self.planner, key)).collect::<Result<_, _>>()?;
        Ok(Search { tuning: self, group, scales })
    }

    fn check_sets(&self) -> Result<(), String> {
        let ((n, first), (m, other)) = (self.training, self.test);
        if first < other.saturating_add(m as u64) && other < first.saturating_add(n as u64) {
            return Err(format!(
                "training seeds {first} to {} and test seeds {other} to {} overlap; figures on training \
                 layouts \
                 prove nothing",
                first + n as u64 - 1,
                other + m as u64 - 1,
            ));
        }
        Ok(())
    }
}

impl Search<'_> {
    /// Returns the loss of the initial values, the best values, and the number of sets of values that were tried.
    fn best(&self, runner: &Runner<'_>) -> Result<(f64, Best, usize)> {
        let Tuning { training, start, planner, .. } = self.tuning;
        let shares: Vec<f64> = self.scales.iter().map(|scale| scale.share(start)).collect();
        let best = RefCell::new(Best { loss: f64::INFINITY, shares: shares.clone() });
        let failure: RefCell<Option<StudyError>> = RefCell::new(None);
        let cost = |at: &DVector<f64>| {
            let outside: f64 = at.iter().map(|x| (x - x.clamp(0.0, 1.0)).abs()).sum();
            let inside: Vec<f64> = at.iter().map(|x| x.clamp(0.0, 1.0)).collect();
            if failure.borrow().is_some() {
                return f64::MAX;
            }
            match self.train(runner, *training, &planner.id, self.parameters(&inside)) {
                Ok(trained) => {
                    let loss = trained.loss();
                    if loss < best.borrow().loss {
                        *best.borrow_mut() = Best { loss, shares: inside };
                    }
                    loss + OUTSIDE_COST * outside
                }
                Err(error) => {
                    *failure.borrow_mut() = Some(error);
                    f64::MAX
                }
            }
        };
        let before = cost(&DVector::from_vec(shares.clone()));
        let options = CMAESOptions::new(shares, FIRST_STEP).seed(self.tuning.seed);
        let search = options.max_generations(self.tuning.generations).build(&cost);
        let mut search = search
            .map_err(|error| StudyError::Refused(format!("the search cannot start: {}", invalid(&error))))?;
        while failure.borrow().is_none() && search.next().is_none() {}
        let evaluations = search.function_evals() + 1;
        drop(search);
        match failure.into_inner() {
            Some(error) => Err(error),
            None => Ok((before, best.into_inner(), evaluations)),
        }
    }

    /// The parameters with values at these shares of their ranges.
    fn parameters(&self, shares: &[f64]) -> Parameters {
        let mut parameters = self.tuning.start.clone();
        for (scale, share) in self.scales.iter().zip(shares) {
            parameters.insert(scale.key.clone(), ParamValue::Float(scale.value(*share)));
        }
        parameters
    }

    fn train(
        &self,
        runner: &Runner<'_>,
        (n, first): (usize, u64),
        id: &str,
        parameters: Parameters,
    ) -> Result<Trained> {
        let seeds: Vec<u64> = (0..n as u64).map(|k| first.wrapping_add(k)).collect();
        let method = Method { parameters, ..Method::new(id, &self.tuning.planner.id, "") };
        Trained::new(runner, &seeds, method, self.group)
    }
}

fn invalid(error: &InvalidOptionsError) -> &'static str {
    match error {
        InvalidOptionsError::Dimensions => "no parameter is to be tuned",
        InvalidOptionsError::PopulationSize => "a generation needs at least 2 parameter sets",
        InvalidOptionsError::InitialStepSize => "the first step must be a positive number",
        InvalidOptionsError::Cm => "the learning rate must be from 0 to 1",
    }
}

fn default_keys(planner: &PlannerInfo) -> Vec<String> {
    let is_real = |kind: &ParamKind| matches!(kind, ParamKind::Float { .. });
    let of_group =
        planner.parameters.iter().filter(|info| info.group == DEFAULT_GROUP && is_real(&info.kind));
    of_group.map(|info| info.key.clone()).collect()
}

impl Tuned {
    /// Formats the result as human-readable text.
    pub fn text(&self, tuning: &Tuning<'_>) -> String {
        let (before, after) = self.loss;
        let values: Vec<String> = self.values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        format!(
            "Loss on {} training layouts (cross-track error in m, missing clearance, 1 if the path does \
             not arrive): {before:.4} at the start, {after:.4} after tuning; {} parameter sets \
             tried.\n\n[planner.parameters]\n{}\n\nOn {} test layouts:\n\n{}",
            tuning.training.0,
            self.evaluations,
            values.join("\n"),
            tuning.test.0,
            table(&self.rows),
        )
    }
}
