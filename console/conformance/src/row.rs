//! How a planner flew in some tanks, as a row of a table.

use crate::flown::Flown;
use mission::Outcome;
use serde::Serialize;

/// How a planner flew in some tanks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Its id.
    pub planner: String,
    /// How many tanks.
    pub tanks: usize,
    /// In how many of them the mission was completed.
    pub complete: usize,
    /// In how many of them the robot touched something.
    pub collided: usize,
    /// In how many of them it did not get on.
    pub stuck: usize,
    /// How often the planner failed.
    pub faults: u64,
    /// In how many of them it said that it does not fly such missions.
    pub unsupported: usize,
    /// Mission time of completed missions, median, seconds.
    pub time_s: Option<f64>,
    /// Way of completed missions, median, metres.
    pub way_m: Option<f64>,
    /// Least distance to anything solid in completed missions, median, metres.
    pub clearance_m: Option<f64>,
    /// Time for a step that 99 of 100 do not exceed, median, milliseconds by the wall clock.
    pub step_p99_ms: Option<f64>,
    /// Memory of the planner's process at most in any of them, libraries among it, megabytes; absent where the system does
    /// not say.
    pub memory_mb: Option<f64>,
    /// Each tank.
    pub by_tank: Vec<InTank>,
}

/// How a planner flew in one tank.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InTank {
    /// The seed by which the tank was drawn.
    pub seed: u64,
    /// How the mission ended.
    pub outcome: Option<Outcome>,
    /// How often the planner failed.
    pub faults: u64,
    /// Its first failure.
    pub failure: Option<String>,
    /// Mission time, seconds.
    pub time_s: Option<f64>,
    /// Way, metres.
    pub way_m: Option<f64>,
    /// Least distance to anything solid, metres.
    pub clearance_m: Option<f64>,
}

impl InTank {
    fn of(seed: u64, flown: &Flown) -> Self {
        let summary = &flown.summary;
        Self {
            seed,
            outcome: summary.outcome,
            faults: summary.planner_faults,
            failure: flown.misbehaved.as_ref().or(flown.gave_up.as_ref()).cloned(),
            time_s: summary.mission_time_s,
            way_m: summary.path_length_m,
            clearance_m: summary.clearance_min_m,
        }
    }

    /// A line about a tank that was not completed.
    pub(crate) fn line(&self) -> String {
        let ended = self.outcome.map_or("did not end", Outcome::word).replace('_', " ");
        let after = self.time_s.map(|s| format!(" after {s:.1} s")).unwrap_or_default();
        let why = self.failure.as_ref().map(|why| format!(": {why}")).unwrap_or_default();
        format!("not completed: tank of seed {}, {ended}{after}{why}\n", self.seed)
    }
}

impl Row {
    pub(crate) const HEADINGS: &'static str = "planner             complete  collided  stuck  faults  time s   way m  clearance m  step p99 ms  memory MB\n";

    pub(crate) fn of(planner: &str, flown: &[Flown], first_seed: u64) -> Self {
        let ended = |outcome| flown.iter().filter(move |flown| flown.summary.outcome == Some(outcome));
        let of_complete =
            |figure: fn(&Flown) -> Option<f64>| median(ended(Outcome::Complete).filter_map(figure));
        Self {
            planner: planner.to_owned(),
            tanks: flown.len(),
            complete: ended(Outcome::Complete).count(),
            collided: ended(Outcome::Collision).count(),
            stuck: ended(Outcome::Stuck).count(),
            faults: flown.iter().map(|flown| flown.summary.planner_faults).sum(),
            unsupported: flown.iter().filter(|flown| flown.unsupported).count(),
            time_s: of_complete(|flown| flown.summary.mission_time_s),
            way_m: of_complete(|flown| flown.summary.path_length_m),
            clearance_m: of_complete(|flown| flown.summary.clearance_min_m),
            step_p99_ms: median(flown.iter().filter_map(|flown| flown.p99_ms)),
            memory_mb: flown
                .iter()
                .filter_map(|flown| flown.memory_bytes)
                .max()
                .map(|bytes| bytes as f64 / 1e6),
            by_tank: (0..)
                .zip(flown)
                .map(|(n, flown)| InTank::of(first_seed.wrapping_add(n), flown))
                .collect(),
        }
    }

    /// The tanks that were not completed.
    pub(crate) fn lost(&self) -> impl Iterator<Item = &InTank> {
        self.by_tank.iter().filter(|tank| tank.outcome != Some(Outcome::Complete))
    }

    pub(crate) fn line(&self) -> String {
        let figure = |value: Option<f64>, digits| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
        };
        format!(
            "{:<18}  {:>8}  {:>8}  {:>5}  {:>6}  {:>6}  {:>6}  {:>11}  {:>11}  {:>9}\n",
            self.planner,
            format!("{}/{}", self.complete, self.tanks),
            self.collided,
            self.stuck,
            self.faults,
            figure(self.time_s, 1),
            figure(self.way_m, 2),
            figure(self.clearance_m, 2),
            figure(self.step_p99_ms, 2),
            figure(self.memory_mb, 1),
        )
    }
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}
