//! The cells under the bar: straight ahead, and while it turns in place.

use super::FloorGrid;
use std::ops::Range;
use world::{Point, Vector};

/// Turns smaller than this leave no gap worth filling, radians.
const SMALL_TURN_RAD: f64 = 2e-3;
/// A turn is drawn in wedges of this angle, radians.
const WEDGE_RAD: f64 = 0.35;
/// Corners of the largest fan of wedges: half a turn, and the middle.
const FAN: usize = 11;
/// Shorter sides have no heading, metres.
const LEAST_SIDE_M: f64 = 1e-9;
/// Rows of a polygon that are worked out together.
const BAND: usize = 32;

/// The end of a closed range as the start of what lies behind it.
const NEXT: f64 = 1e-9;

/// Neighbouring cells of one row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Run {
    first: u32,
    past: u32,
}

impl Run {
    /// Its cells.
    pub fn cells(self) -> Range<usize> {
        self.first as usize..self.past as usize
    }
}

impl From<Range<usize>> for Run {
    fn from(cells: Range<usize>) -> Self {
        Self { first: cells.start as u32, past: cells.end as u32 }
    }
}

/// The first index that is not below a place.
pub(super) fn index_from(place: f64) -> usize {
    // Truncation is quicker than rounding up, and negative places become 0.
    let below = (place as i64).max(0);
    (below + i64::from(place > below as f64)) as usize
}

impl FloorGrid {
    /// Every cell under the bar on its way along a path, in runs of one row each; a cell may come several times.
    pub fn along(&self, path: &[Point], visit: impl FnMut(Range<usize>)) {
        self.along_some(path, 0..path.len(), visit);
    }

    /// The same with no more than some of the sides; turns are those of the whole path.
    pub fn along_some(&self, path: &[Point], sides: Range<usize>, mut visit: impl FnMut(Range<usize>)) {
        let mut before: Option<Vector> = None;
        for (side, pair) in path.windows(2).enumerate() {
            let Some(ahead) = (pair[1] - pair[0]).try_normalize(LEAST_SIDE_M) else { continue };
            if let Some(before) = before {
                self.turn(pair[0], before, ahead, &mut visit);
            }
            if sides.contains(&side) {
                self.side(pair[0], pair[1], ahead, &mut visit);
            }
            before = Some(ahead);
        }
    }

    /// Cells under the bar from one point to the next, and before them those of the turn into this heading.
    pub fn turn_and_side(&self, before: Option<Point>, from: Point, to: Point) -> (Vec<Run>, Vec<Run>) {
        let heading = |a: Point, b: Point| (b - a).try_normalize(LEAST_SIDE_M);
        let (mut turn, mut side) = (Vec::new(), Vec::with_capacity(16));
        if let Some(ahead) = heading(from, to) {
            if let Some(before) = before.and_then(|before| heading(before, from)) {
                self.turn(from, before, ahead, &mut |cells| turn.push(Run::from(cells)));
            }
            self.side(from, to, ahead, &mut |cells| side.push(Run::from(cells)));
        }
        (turn, side)
    }

    fn side(&self, from: Point, to: Point, ahead: Vector, visit: &mut impl FnMut(Range<usize>)) {
        let side = Vector::new(-ahead.y, ahead.x) * self.half_m;
        self.fill(&[from - side, to - side, to + side, from + side], visit);
    }

    fn turn(&self, at: Point, from: Vector, to: Vector, visit: &mut impl FnMut(Range<usize>)) {
        let (across, along) = (from.perp(&to), from.dot(&to));
        if across.abs() < SMALL_TURN_RAD && along > 0.0 {
            return;
        }
        let turn = across.atan2(along);
        let n = (turn.abs() / WEDGE_RAD).ceil();
        let (sin, cos) = (turn / n).sin_cos();
        let mut rim = Vector::new(-from.y, from.x) * self.half_m;
        let mut fans = [[at; FAN]; 2];
        for k in 0..=n as usize {
            (fans[0][k + 1], fans[1][k + 1]) = (at + rim, at - rim);
            rim = Vector::new(rim.x * cos - rim.y * sin, rim.x * sin + rim.y * cos);
        }
        for fan in fans {
            self.fill(&fan[..n as usize + 2], &mut *visit);
        }
    }

    /// Every cell whose centre lies in a convex polygon of at most `FAN` corners, in either sense, row by row.
    pub(super) fn fill(&self, polygon: &[Point], mut visit: impl FnMut(Range<usize>)) {
        let mut turned = [Point::origin(); FAN];
        for (turned, corner) in turned.iter_mut().zip(polygon) {
            *turned = self.along_rows(*corner);
        }
        let polygon = &turned[..polygon.len()];
        let low = polygon.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let high = polygon.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let row_of = |y: f64| (y - self.low.y) / self.cell_m - 0.5;
        let rows = index_from(row_of(low))..index_from(row_of(high) + NEXT).min(self.rows);
        if rows.is_empty() {
            return;
        }
        let mut corner_rows = [0; FAN];
        for (row, corner) in corner_rows.iter_mut().zip(polygon) {
            *row = self.row_from(corner.y, index_from(row_of(corner.y)), &rows);
        }
        // Side by side through a band of rows: that takes fewer decisions than row by row through the sides.
        for start in rows.clone().step_by(BAND) {
            let band = start..rows.end.min(start + BAND);
            let mut spans = [(f64::INFINITY, f64::NEG_INFINITY); BAND];
            let mut k = polygon.len() - 1;
            for next in 0..polygon.len() {
                let (a, b) = (polygon[k], polygon[next]);
                let (from, past) =
                    (corner_rows[k].min(corner_rows[next]), corner_rows[k].max(corner_rows[next]));
                for row in from.max(band.start)..past.min(band.end) {
                    let x = a.x + (b.x - a.x) * ((self.row_y(row) - a.y) / (b.y - a.y));
                    let (from, to) = &mut spans[row - start];
                    (*from, *to) = (if x < *from { x } else { *from }, if x > *to { x } else { *to });
                }
                k = next;
            }
            for (row, (from, to)) in band.zip(spans).filter(|(_, (from, to))| from <= to) {
                let column_of = |x: f64| (x - self.low.x) / self.cell_m - 0.5;
                let (left, past) =
                    (index_from(column_of(from)), index_from(column_of(to) + NEXT).min(self.columns));
                if left < past {
                    visit(row * self.columns + left..row * self.columns + past);
                }
            }
        }
    }

    /// Place of the centres of a row across the rows.
    fn row_y(&self, row: usize) -> f64 {
        self.low.y + (f64::from(row as u32) + 0.5) * self.cell_m
    }

    /// The first of some rows whose centres do not lie below `y`, or the one behind them; rounding may have made the guess
    /// wrong.
    fn row_from(&self, y: f64, guess: usize, rows: &Range<usize>) -> usize {
        let mut row = guess.clamp(rows.start, rows.end);
        while row > rows.start && self.row_y(row - 1) >= y {
            row -= 1;
        }
        while row < rows.end && self.row_y(row) < y {
            row += 1;
        }
        row
    }
}
