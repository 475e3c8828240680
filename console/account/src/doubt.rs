//! Floor whose guarantee was taken back, because a station was found wrong.

use crate::{Fold, scanned::Scanned};
use mission::{Event, EventKind, clock, event::bias_text};
use positioning::Estimated;
use serde::{Deserialize, Serialize};
use world::{CellRun, Point};

/// Floor that lost its guarantee when a biased station was detected.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TakenBack {
    /// Name of the station.
    pub station: String,
    /// Length by which its ranges were too long, metres.
    pub bias_m: f64,
    /// Standard deviation of this length, metres; absent in reports of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bias_sigma_m: Option<f64>,
    /// Mission time at which the bias may have begun, seconds.
    pub since_s: f64,
    /// Mission time at which the bias was detected, seconds.
    pub until_s: f64,
    /// Area that was guaranteed only by passes between the two times, square metres.
    pub area_m2: f64,
    /// The part of this area that no later pass of the run guarantees, square metres. Absent while the run goes on, and
    /// in reports of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_m2: Option<f64>,
}

impl std::fmt::Display for TakenBack {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { station, bias_m, bias_sigma_m, since_s, until_s, area_m2, left_m2 } = self;
        let bias = match bias_sigma_m {
            Some(sigma) => bias_text(&Estimated { value: *bias_m, sigma: *sigma }),
            None => format!("{bias_m:+.2} m"),
        };
        write!(
            f,
            "{area_m2:.1} m² scanned from T+{} to T+{}: the ranges of station {station} were wrong by {bias}",
            clock(*since_s),
            clock(*until_s),
        )?;
        match left_m2 {
            Some(left_m2) if *left_m2 < *area_m2 => write!(
                f,
                "; later passes of this run guarantee {:.1} m² of it, {left_m2:.1} m² stay in doubt",
                area_m2 - left_m2
            ),
            _ => Ok(()),
        }
    }
}

/// Floor in doubt, with its place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InDoubt {
    /// The floor that lost its guarantee, as in the report.
    pub floor: TakenBack,
    /// The place in this floor that is closest to its middle, metres, tank frame; `None` if the floor is empty.
    pub at: Option<Point>,
    /// The cells of this floor; once the run has ended, those that no later pass guarantees.
    #[serde(default)]
    pub cells: Vec<CellRun>,
}

/// Follows the events of a run, and states which floor is in doubt while the run goes on. The figures are those of the
/// report, because both use the same fold.
#[derive(Debug)]
pub struct DoubtWatch {
    fold: Fold,
    listed: Vec<InDoubt>,
}

impl DoubtWatch {
    /// A watch of the run that an event opens; `None` for any other event, and for a mission that looks for no biased
    /// stations, in which no floor can be in doubt.
    pub fn opening(event: &Event) -> Option<Self> {
        let EventKind::RunOpened(run) = &event.kind else { return None };
        run.mission.locating.session?;
        let mut watch = Self { fold: Fold::of_figures(), listed: Vec::new() };
        watch.fold.apply(event);
        Some(watch)
    }

    /// Adds an event; events must come in the order of the journal. Returns the list of the floor in doubt, oldest first, if
    /// the event adds to it, or ends a run that has such floor: then each entry states what stayed in doubt.
    pub fn apply(&mut self, event: &Event) -> Option<&[InDoubt]> {
        self.fold.apply(event);
        match event.kind {
            EventKind::StationBiased { .. } => {
                let floor = self.fold.taken_back().last()?.clone();
                let cells = self.cells(self.fold.taken_back().len());
                self.listed.push(InDoubt { floor, at: self.middle(&cells), cells: runs(&cells) });
            }
            EventKind::Ended { .. } if !self.listed.is_empty() => {
                for (index, floor) in self.fold.still_in_doubt().into_iter().enumerate() {
                    let cells = runs(&self.cells(index + 1));
                    let Some(listed) = self.listed.get_mut(index) else { continue };
                    (listed.floor, listed.cells) = (floor, cells);
                }
            }
            _ => return None,
        }
        Some(&self.listed)
    }

    /// The cells that are in doubt since guarantees were taken back for the `time`-th time, counted from 1.
    fn cells(&self, time: usize) -> Vec<usize> {
        let passes = self.fold.scanned().map(Scanned::passes);
        passes.map_or_else(Vec::new, |passes| passes.left_in_doubt(time).collect())
    }

    /// The centre of the cell that is closest to the mean of all centres.
    fn middle(&self, cells: &[usize]) -> Option<Point> {
        let floor = self.fold.scanned()?.believed().floor();
        let points: Vec<Point> = cells.iter().map(|cell| floor.center(*cell)).collect();
        middle(&points)
    }
}

/// Cells in ascending order as runs.
fn runs(cells: &[usize]) -> Vec<CellRun> {
    let mut runs: Vec<CellRun> = Vec::new();
    for cell in cells.iter().map(|cell| *cell as u32) {
        match runs.last_mut() {
            Some(CellRun(first, count)) if *first + *count == cell => *count += 1,
            _ => runs.push(CellRun(cell, 1)),
        }
    }
    runs
}

/// The point that is closest to the mean of all points.
fn middle(points: &[Point]) -> Option<Point> {
    let sum = points.iter().fold(world::Vector::zeros(), |sum, point| sum + point.coords);
    let mean = Point::from(sum / points.len() as f64);
    let away_m = |point: &&Point| (**point - mean).norm();
    points.iter().min_by(|one, other| away_m(one).total_cmp(&away_m(other))).copied()
}
