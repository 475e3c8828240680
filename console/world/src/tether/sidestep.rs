//! Moves that lead through a solid are bent around it.
//!
//! A robot cannot drive through a column, but the estimate of its position can, and so can a plan. The rule: a move
//! through a solid takes the shorter detour, which at a column is on the side on which the move passes the centre; a
//! point inside counts as the nearest point outside. An estimate that strays from the truth by less than hull and column
//! radius together therefore winds nothing: no column's centre lies between the two, so both pass every column on the
//! same side.

use super::rounded_polygon::RoundedPolygon;
use crate::obstacles::Boxes;
use geometry::Point;

/// Depth up to which a touch does not count as entering, metres.
const TOUCH_M: f64 = 1e-9;
/// Most bends of one move; a cluster of overlapping solids can need many.
const MOST_BENDS: usize = 256;
/// Most solids that the detour around a solid may enter in turn.
const DEEPEST: usize = 6;

/// The solids that a path must not enter.
#[derive(Debug, Clone)]
pub(super) struct Sidestep {
    solids: Vec<RoundedPolygon>,
    boxes: Boxes,
    /// Whether the ends of a detour are led out to the outline first.
    leads_out: bool,
}

impl Sidestep {
    /// Sidesteps around these solids.
    ///
    /// With `leads_out` a move between two points at a solid keeps clear of it, as is right for grown solids, within which
    /// robots stand. Without, such a move is a chord of the solid, like those of a taut cable that is drawn with chords.
    pub(super) fn new(solids: Vec<RoundedPolygon>, leads_out: bool) -> Self {
        let boxes = Boxes::new(solids.iter().map(RoundedPolygon::bounds));
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

    /// The parts of a segment that lie in solids or touch them: where each begins and ends, as shares of the segment, in no
    /// order.
    pub(super) fn inside(&self, from: Point, to: Point) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.near(from, to).filter_map(move |(_, solid)| solid.inside(from, to))
    }

    /// Calls `go` with the end of each straight move that leads from one point to another around every solid.
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
        let detour = if self.leads_out { solid.detour_outside(from, to) } else { solid.detour(from, to) };
        for corner in detour {
            let corner = self.outside(corner);
            self.bend(at, corner, depth + 1, way);
            at = corner;
        }
        // The rest of the move lies outside this solid, or touches it.
        if depth + 1 < DEEPEST { self.bend_past(solid, at, to, depth + 1, way) } else { way.push(to) }
    }

    fn bend_past(&self, passed: &RoundedPolygon, from: Point, to: Point, depth: usize, way: &mut Vec<Point>) {
        if passed.is_entered_by(from, to, TOUCH_M) {
            way.push(to);
        } else {
            self.bend(from, to, depth, way);
        }
    }

    fn first_entered(&self, from: Point, to: Point) -> Option<&RoundedPolygon> {
        let entered = self.near(from, to).filter(|(_, solid)| solid.is_entered_by(from, to, TOUCH_M));
        let met = entered.map(|(k, solid)| (solid.met_at(from, to), k, solid));
        met.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(_, _, solid)| solid)
    }

    /// Solids that a segment may meet, each with its index, in no order.
    fn near(&self, from: Point, to: Point) -> impl Iterator<Item = (usize, &RoundedPolygon)> {
        self.boxes.near(from, to, TOUCH_M).map(|k| (k, &self.solids[k]))
    }
}
