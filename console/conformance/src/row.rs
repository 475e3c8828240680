//! The results of a planner in a number of tanks, as a row of a table.

use crate::flown::Flown;
use comfy_table::{
    CellAlignment::{Left, Right},
    Table, presets,
};
use mission::Outcome;
use serde::Serialize;

const HEADINGS: [&str; 10] = [
    "planner",
    "complete",
    "collided",
    "stuck",
    "faults",
    "time s",
    "path m",
    "clearance m",
    "step p99 ms",
    "memory MB",
];

/// The results of a planner in a number of tanks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Id of the planner.
    pub planner: String,
    /// The number of tanks.
    pub tanks: usize,
    /// The number of tanks in which the mission was completed.
    pub complete: usize,
    /// The number of tanks in which the robot touched something.
    pub collided: usize,
    /// The number of tanks in which the robot got stuck.
    pub stuck: usize,
    /// The number of faults caused by the planner.
    pub faults: u64,
    /// The number of tanks in which the planner reported that it does not support such missions.
    pub unsupported: usize,
    /// Median mission time of the completed missions, seconds.
    pub time_s: Option<f64>,
    /// Median path length of the completed missions, metres.
    pub way_m: Option<f64>,
    /// Median of the smallest distance to anything solid in the completed missions, metres.
    pub clearance_m: Option<f64>,
    /// Median over the tanks of the 99th percentile of the wall time of a step, milliseconds.
    pub step_p99_ms: Option<f64>,
    /// Peak memory of the planner's process over all tanks, including libraries, megabytes; absent where the system
    /// does not report it.
    pub memory_mb: Option<f64>,
    /// The results in each tank.
    pub by_tank: Vec<InTank>,
}

/// The results of a planner in one tank.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InTank {
    /// The seed from which the tank was drawn.
    pub seed: u64,
    /// How the mission ended.
    pub outcome: Option<Outcome>,
    /// The number of faults caused by the planner.
    pub faults: u64,
    /// The first fault.
    pub failure: Option<String>,
    /// Mission time, seconds.
    pub time_s: Option<f64>,
    /// Path length, metres.
    pub way_m: Option<f64>,
    /// Smallest distance to anything solid, metres.
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

    /// Formats a line about a tank in which the mission was not completed.
    pub(crate) fn line(&self) -> String {
        let ended = self.outcome.map_or("did not end", Outcome::word).replace('_', " ");
        let after = self.time_s.map(|s| format!(" after {s:.1} s")).unwrap_or_default();
        let why = self.failure.as_ref().map(|why| format!(": {why}")).unwrap_or_default();
        format!("tank with seed {}: mission not completed ({ended}{after}){why}\n", self.seed)
    }
}

impl Row {
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

    /// Returns the tanks in which the mission was not completed.
    pub(crate) fn lost(&self) -> impl Iterator<Item = &InTank> {
        self.by_tank.iter().filter(|tank| tank.outcome != Some(Outcome::Complete))
    }

    fn cells(&self) -> [String; 10] {
        let figure = |value: Option<f64>, digits| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
        };
        [
            self.planner.clone(),
            format!("{}/{}", self.complete, self.tanks),
            self.collided.to_string(),
            self.stuck.to_string(),
            self.faults.to_string(),
            figure(self.time_s, 1),
            figure(self.way_m, 2),
            figure(self.clearance_m, 2),
            figure(self.step_p99_ms, 2),
            figure(self.memory_mb, 1),
        ]
    }
}

/// Formats rows as a text table, with one line for each row below the headings.
pub(crate) fn table(rows: &[Row]) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).add_row(HEADINGS).add_rows(rows.iter().map(Row::cells));
    for column in table.column_iter_mut() {
        let is_first = column.index == 0;
        column.set_padding((0, 2)).set_cell_alignment(if is_first { Left } else { Right });
    }
    table.trim_fmt() + "\n"
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stay_aligned_below_a_planner_with_a_long_name() {
        let row = |planner: &str| Row {
            planner: planner.into(),
            tanks: 10,
            complete: 9,
            collided: 0,
            stuck: 1,
            faults: 0,
            unsupported: 0,
            time_s: Some(61.25),
            way_m: Some(7.258),
            clearance_m: None,
            step_p99_ms: Some(0.124),
            memory_mb: Some(12.0),
            by_tank: Vec::new(),
        };
        let text = table(&[row("apf"), row("a-planner-with-a-very-long-name")]);
        let lines: Vec<&str> = text.lines().collect();
        assert!(text.ends_with('\n') && lines.len() == 3, "{text}");
        assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{text}");
        let figures = ["9/10", "0", "1", "0", "61.2", "7.26", "-", "0.12", "12.0"];
        assert!(lines[1].split_whitespace().skip(1).eq(figures), "{text}");
    }

    #[test]
    fn the_median_of_nothing_is_absent() {
        assert_eq!(median(std::iter::empty()), None);
        assert_eq!(median([3.0, 1.0, 2.0].into_iter()), Some(2.0));
    }
}
