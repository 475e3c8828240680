//! The class of a piece of floor, at any zoom.

use super::Raster;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;
use world::{Cell, FloorClass, Point};

/// The minimum scanned share at which a piece of floor counts as scanned, and as partially scanned.
const WHOLLY_SCANNED: f64 = 0.95;
const PARTLY_SCANNED: f64 = 0.05;
/// A piece of floor counts as scanned again if at least this share of its scanned part was scanned again.
const MOSTLY_AGAIN: f64 = 0.5;

/// The numbers of cells in a block: floor, scanned, scanned again, and floor that the tool cannot test.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Tally {
    pub floor: u32,
    pub scanned: u32,
    pub again: u32,
    #[serde(default)]
    pub untestable: u32,
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.floor += other.floor;
        self.scanned += other.scanned;
        self.again += other.again;
        self.untestable += other.untestable;
    }
}

impl Tally {
    /// Replaces the counts of a part that has changed.
    pub(super) fn replace(&mut self, before: Self, now: Self) {
        self.floor = self.floor - before.floor + now.floor;
        self.scanned = self.scanned - before.scanned + now.scanned;
        self.again = self.again - before.again + now.again;
        self.untestable = self.untestable - before.untestable + now.untestable;
    }

    /// The class of the scanned part; `None` if next to nothing is scanned. A block most of which cannot be tested is
    /// untestable; in other blocks, only the testable part counts.
    fn class(self) -> Option<FloorClass> {
        if self.untestable > 0 && 2 * self.untestable >= self.floor {
            return Some(FloorClass::Untestable);
        }
        let testable = self.floor - self.untestable;
        let share = f64::from(self.scanned) / f64::from(testable.max(1));
        match share {
            share if share < PARTLY_SCANNED => None,
            share if share < WHOLLY_SCANNED => Some(FloorClass::Partial),
            _ if f64::from(self.again) >= MOSTLY_AGAIN * f64::from(self.scanned) => Some(FloorClass::Again),
            _ => Some(FloorClass::Scanned),
        }
    }
}

impl Raster {
    /// The class of the floor in a square around a point, depending on whether the mission has ended; `None` where
    /// there is no floor.
    pub fn class_in(&self, center: Point, edge_m: f64, has_ended: bool) -> Option<FloorClass> {
        let tally = self.tally(center, edge_m);
        if tally.floor == 0 {
            return None;
        }
        let unscanned =
            || self.floor().cell_at(center).map_or(FloorClass::ToDo, |index| self.unscanned(index));
        Some(seen(tally.class().unwrap_or_else(unscanned), has_ended))
    }

    /// The class of the cell under a point, and how often the cell was scanned; `None` where there is no floor.
    pub fn class_at(&self, point: Point, has_ended: bool) -> Option<(FloorClass, u32)> {
        let index = self.floor().cell_at(point).filter(|index| self.floor().is_floor(*index))?;
        let times = self.cell_tally(index).scanned * (1 + u32::from(self.overlap.again(index)));
        Some((seen(FloorClass::of(self.floor().kind(index), times), has_ended), times))
    }

    /// The class of a cell with next to nothing scanned; the floor around it counts as to do if the cell itself is
    /// not floor, as in the middle of a block that contains floor only elsewhere.
    fn unscanned(&self, index: usize) -> FloorClass {
        match FloorClass::of(self.floor().kind(index), 0) {
            FloorClass::Outside => FloorClass::ToDo,
            class => class,
        }
    }

    /// The tally of a single cell.
    pub(super) fn cell_tally(&self, index: usize) -> Tally {
        let floor = u32::from(self.floor().is_floor(index));
        let scanned = floor * u32::from(self.grid.is_covered(index));
        let untestable = u32::from(self.floor().kind(index) == Cell::Untestable);
        Tally { floor, scanned, again: scanned * u32::from(self.overlap.again(index) > 0), untestable }
    }

    /// The tally of the cells in a square around a point.
    pub(super) fn tally(&self, center: Point, edge_m: f64) -> Tally {
        // For a square hardly larger than a cell, the cell under its centre is used.
        if edge_m < 1.5 * self.floor().cell_m {
            return self.block_at(center, 0.0);
        }
        let quarter_m = edge_m / 4.0;
        let mut sum = Tally::default();
        for (right, up) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let at = Point::new(center.x + right * quarter_m, center.y + up * quarter_m);
            sum += self.block_at(at, edge_m / 2.0);
        }
        sum
    }

    /// The block under a point, from the level with the largest blocks that are no wider than `edge_m`.
    fn block_at(&self, point: Point, edge_m: f64) -> Tally {
        let floor = self.floor();
        let Some(index) = floor.cell_at(point) else { return Tally::default() };
        let cells = edge_m / floor.cell_m;
        let shift =
            if cells >= 2.0 { (cells as usize).ilog2().min(self.levels.len() as u32) as usize } else { 0 };
        if shift == 0 {
            return self.cell_tally(index);
        }
        let level = &self.levels[shift - 1];
        level.tallies.at(((index / floor.width) >> shift) * level.width + ((index % floor.width) >> shift))
    }
}

/// Adjusts a class according to whether the mission has ended.
fn seen(class: FloorClass, has_ended: bool) -> FloorClass {
    if has_ended { class.when_over() } else { class }
}
