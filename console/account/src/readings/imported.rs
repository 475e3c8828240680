//! Readings of a real instrument, taken from a file.

use super::{Judge, Reading, ReadingsSummary, judge};
use mission::Sampling;
use world::{Cell, Floor};

/// Readings of a real instrument on a floor, and what they show. They are judged like simulated ones.
#[derive(Debug, Clone)]
pub struct Imported {
    sampling: Sampling,
    judge: Judge,
    count: u64,
    untestable: u64,
}

impl Imported {
    /// No readings yet.
    pub fn new(sampling: Sampling, floor: &Floor) -> Self {
        Self { sampling, judge: Judge::new(sampling, floor.len()), count: 0, untestable: 0 }
    }

    /// Adds a reading. It is judged if it is marked as testable and lies on floor that the instrument can test; returns
    /// the reading with this mark.
    pub fn add(&mut self, floor: &Floor, reading: Reading) -> Reading {
        let cell = floor.cell_at(reading.at).filter(|cell| floor.kind(*cell) != Cell::Untestable);
        let cell = cell.filter(|cell| reading.is_testable && floor.is_floor(*cell));
        let reading = Reading { is_testable: cell.is_some(), ..reading };
        self.count += 1;
        match cell {
            Some(cell) => self.judge.add(cell, &reading),
            None => self.untestable += 1,
        }
        reading
    }

    /// The readings of each piece of floor.
    pub fn judge(&self) -> &Judge {
        &self.judge
    }

    /// How the instrument reads.
    pub fn sampling(&self) -> Sampling {
        self.sampling
    }

    /// The number of readings, and what they show on a floor.
    pub fn summary(&self, floor: &Floor) -> ReadingsSummary {
        judge::summary(self.judge.findings(floor), self.count, self.untestable)
    }
}
