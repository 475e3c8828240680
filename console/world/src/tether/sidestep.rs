//! A way that cuts through a solid, bent round it.
//!
//! A robot cannot drive through a column, but the estimate of its position can, and so can a plan. The rule: a move
//! through a solid goes round it the shorter way, which for a column is the side on which it passes the centre; a point
//! inside counts as the nearest point outside. An estimate that strays less than hull plus column from the truth
//! therefore winds nothing: on the straight line between the two nothing passes a centre, so both ways have the same
//! side of every column.

use super::solid::Solid;
use crate::{geometry::Point, obstacles::Boxes};

/// Depth to which touching is not entering, metres.
const TOUCH_M: f64 = 1e-9;
/// Bends of one move at most; a cluster of overlapping solids can ask for many.
const MOST_BENDS: usize = 256;
/// Solids that a bend round a solid may lead into, in turn.
const DEEPEST: usize = 6;

/// The solids that a way must not enter.
#[derive(Debug, Clone)]
pub(super) struct Sidestep {
    solids: Vec<Solid>,
    boxes: Boxes,
    /// Whether the ends of a way round are led out to the outline first.
    leads_out: bool,
}

impl Sidestep {
    /// Sidesteps round these solids.
    ///
    /// With `leads_out` a move between two places at a solid keeps off it: right where solids are grown, so that robots
    /// stand in them. Without, such a move is a chord of the solid, as a taut cable drawn with chords is.
    pub(super) fn new(solids: Vec<Solid>, leads_out: bool) -> Self {
        let boxes = Boxes::new(solids.iter().map(Solid::bounds));
        Self { solids, boxes, leads_out }
    }

    /// The nearest point that lies in no solid, as far as a few steps find one.
    pub(super) fn outside(&self, point: Point) -> Point {
        let mut at = point;
        for _ in 0..DEEPEST {
            let pushed = self.near(at, at).filter_map(|(k, solid)| Some((k, solid.pushed_out(at, TOUCH_M)?)));
            match pushed.min_by_key(|(k, _)| *k) {
                Some((_, next)) => at = next,
                None => break,
            }
        }
        at
    }

    /// Whether a point lies in a solid.
    pub(super) fn holds(&self, point: Point) -> bool {
        self.near(point, point).any(|(_, solid)| solid.pushed_out(point, TOUCH_M).is_some())
    }

    /// Whether a segment enters no solid.
    pub(super) fn is_open(&self, from: Point, to: Point) -> bool {
        !self.near(from, to).any(|(_, solid)| solid.is_entered_by(from, to, TOUCH_M))
    }

    /// Whether at most one solid comes near to a disc.
    pub(super) fn is_alone(&self, center: Point, radius_m: f64) -> bool {
        self.boxes.near(center, center, radius_m + TOUCH_M).nth(1).is_none()
    }

    /// The parts of a segment that lie in solids or touch them, as shares of its length.
    pub(super) fn inside(&self, from: Point, to: Point) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.solids.iter().filter_map(move |solid| solid.inside(from, to))
    }

    /// Calls `go` with the ends of the straight pieces that lead from one point to another round every solid.
    pub(super) fn along(&self, from: Point, to: Point, mut go: impl FnMut(Point)) {
        let to = self.outside(to);
        if self.first_entered(from, to).is_none() {
            return go(to);
        }
        let mut way = Vec::new();
        self.bend(from, to, 0, &mut way);
        way.into_iter().for_each(go);
    }

    fn bend(&self, from: Point, to: Point, depth: usize, way: &mut Vec<Point>) {
        let entered = self.first_entered(from, to);
        let Some(solid) = entered.filter(|_| depth < DEEPEST && way.len() < MOST_BENDS) else {
            return way.push(to);
        };
        let mut at = from;
        let round =
            if self.leads_out { solid.way_round_outside(from, to) } else { solid.way_round(from, to) };
        for corner in round {
            let corner = self.outside(corner);
            self.bend(at, corner, depth + 1, way);
            at = corner;
        }
        // What is left of the move lies outside this solid, or touches it.
        if depth + 1 < DEEPEST { self.bend_past(solid, at, to, depth + 1, way) } else { way.push(to) }
    }

    fn bend_past(&self, passed: &Solid, from: Point, to: Point, depth: usize, way: &mut Vec<Point>) {
        if passed.is_entered_by(from, to, TOUCH_M) {
            way.push(to);
        } else {
            self.bend(from, to, depth, way);
        }
    }

    fn first_entered(&self, from: Point, to: Point) -> Option<&Solid> {
        let entered = self.near(from, to).filter(|(_, solid)| solid.is_entered_by(from, to, TOUCH_M));
        let met = entered.map(|(k, solid)| (solid.met_at(from, to), k, solid));
        met.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(_, _, solid)| solid)
    }

    /// Solids that a segment may meet, with their index, in no order.
    fn near(&self, from: Point, to: Point) -> impl Iterator<Item = (usize, &Solid)> {
        self.boxes.near(from, to, TOUCH_M).map(|k| (k, &self.solids[k]))
    }
}
