//! Readings of thickness from an instrument with its own clock: each is placed on the track of a run by its time.
//!
//! The file is read once, row by row; memory does not grow with its length.

mod clock;
mod columns;
mod faults;
mod order;
mod placing;
#[cfg(test)]
mod tests;

pub use columns::{UNITS, Unit, unit};
pub use faults::{Fault, Faults};
pub use order::Gap;
pub use placing::place;

use crate::problem::Problem;
use account::{Reading, ReadingsSummary, Track};
use mission::Sampling;
use serde::Serialize;
use world::Floor;

/// The run on whose track readings are placed, and its instrument.
#[derive(Debug, Clone, Copy)]
pub struct Scanned<'a> {
    /// The track.
    pub track: &'a Track,
    /// The floor.
    pub floor: &'a Floor,
    /// How the instrument reads.
    pub sampling: Sampling,
    /// Width of the swath, metres.
    pub swath_m: f64,
    /// The time at which mission time was 0, in seconds since 1970, to the whole second; `None` if it is not known.
    pub began_s: Option<f64>,
}

/// How a file is to be read.
#[derive(Debug, Clone, Default)]
pub struct Options<'a> {
    /// The unit of columns that state none.
    pub unit: Option<Unit>,
    /// Seconds to add to the times in the file.
    pub clock_offset_s: Option<f64>,
    /// Moments by both clocks: a time as in the file, and the mission time in seconds.
    pub marks: &'a [(String, f64)],
    /// Standard deviation of a time in the file, seconds.
    pub clock_sigma_s: Option<f64>,
    /// The number of the first channel in the file.
    pub first_channel: u16,
    /// Whether the first channel is on the left.
    pub from_left: bool,
}

/// What a file of readings contained.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Placed {
    /// Number of rows.
    pub rows: u64,
    /// The readings that were placed, and what they show.
    pub readings: ReadingsSummary,
    /// Number of placed readings where floor did not count as scanned; they are not judged.
    pub uncounted: u64,
    /// What was wrong with the file.
    pub faults: Faults,
    /// Number of readings that are missing on the way on which floor counted.
    pub lost: u64,
    /// Parts of the way without readings, the longest first.
    pub gaps: Vec<Gap>,
    /// Number of readings that came after later readings of their channel, and the line of the first one.
    pub out_of_order: u64,
    /// The line of the first reading that is out of order.
    pub first_out_of_order: Option<u64>,
    /// Columns that were not used.
    pub ignored_columns: Vec<String>,
    /// Seconds to add to the times in the file, at its first mark.
    pub clock_offset_s: f64,
    /// Seconds that the clock of the file loses in an hour of the mission; negative if it gains.
    pub clock_drift_s_per_h: f64,
    /// Standard deviation of a mission time, seconds.
    pub clock_sigma_s: f64,
}

/// Receives the readings of a file, and the rows that were refused.
pub trait Sink {
    /// Takes a placed reading.
    ///
    /// # Errors
    /// The reading cannot be kept.
    fn take(&mut self, reading: &Reading) -> anyhow::Result<()>;

    /// Takes a row in which something was refused.
    ///
    /// # Errors
    /// The row cannot be kept.
    fn refuse(&mut self, problem: &Problem, row: &[&str]) -> anyhow::Result<()>;
}
