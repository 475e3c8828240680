//! The scanning tool: a flat bar across the heading, as wide as the swath, that also sweeps when the robot turns on the
//! spot.

use crate::floor::raster::{MOST_CORNERS, Raster};
use crate::plane::left_of;
use std::ops::Range;
use world::{Point, Vector};

/// Smallest turn that leaves a gap worth filling, radians.
const SMALL_TURN_RAD: f64 = 2e-3;
/// Angle of the wedges that fill a turn, radians.
const WEDGE_RAD: f64 = 0.35;

/// Neighbouring cells of one row.
#[derive(Clone, Copy)]
pub(crate) struct Run {
    first: u32,
    past: u32,
}

impl Run {
    pub(crate) fn cells(self) -> Range<usize> {
        self.first as usize..self.past as usize
    }
}

impl From<Range<usize>> for Run {
    fn from(cells: Range<usize>) -> Self {
        Self { first: cells.start as u32, past: cells.end as u32 }
    }
}

impl Raster {
    /// Calls `visit` for all cells under the bar along a path, in runs of one row each. A cell may appear several
    /// times.
    pub(super) fn along(&self, path: &[Point], visit: impl FnMut(Range<usize>)) {
        self.along_some(path, 0..path.len(), visit);
    }

    /// Calls `visit` as [`Self::along`] does, but for only some sides of the path. Turns are included for the whole
    /// path.
    pub(crate) fn along_some(
        &self,
        path: &[Point],
        sides: Range<usize>,
        mut visit: impl FnMut(Range<usize>),
    ) {
        let mut before: Option<Vector> = None;
        for (side, pair) in path.windows(2).enumerate() {
            let Some(ahead) = heading(pair[0], pair[1]) else { continue };
            if let Some(before) = before {
                self.turn(pair[0], before, ahead, &mut visit);
            }
            if sides.contains(&side) {
                self.side(pair[0], pair[1], ahead, &mut visit);
            }
            before = Some(ahead);
        }
    }

    /// The cells under the bar during the turn into a side, and those along the side. The preceding side starts at
    /// `before`.
    pub(crate) fn turn_and_side(
        &self,
        before: Option<Point>,
        from: Point,
        to: Point,
    ) -> (Vec<Run>, Vec<Run>) {
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
        let side = left_of(ahead) * (self.bar_m / 2.0);
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
        let mut rim = left_of(from) * (self.bar_m / 2.0);
        // Each half of the bar sweeps a fan.
        let mut fans = [[at; MOST_CORNERS]; 2];
        for k in 0..=n as usize {
            (fans[0][k + 1], fans[1][k + 1]) = (at + rim, at - rim);
            rim = Vector::new(rim.x * cos - rim.y * sin, rim.x * sin + rim.y * cos);
        }
        for fan in fans {
            self.fill(&fan[..n as usize + 2], &mut *visit);
        }
    }
}

fn heading(from: Point, to: Point) -> Option<Vector> {
    (to - from).try_normalize(1e-9)
}
