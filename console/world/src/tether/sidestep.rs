//! Bends moves that would lead through a solid, so that they lead around it.
//!
//! A robot cannot drive through a column, but the estimate of its position can, and so can a plan. The rule is that a
//! move through a solid takes the shorter detour. At a column, this is on the side on which the move passes the centre.
//! A point inside a solid counts as the nearest point outside. As long as an estimate strays from the truth by less
//! than the sum of the radii of hull and column, no column's centre lies between the two: both pass every column on the
//! same side, and no false wrap arises.

use super::rounded_polygon::RoundedPolygon;
use crate::obstacles::Boxes;
use geometry::Point;

/// The depth up to which a touch does not count as entering, metres.
const TOUCH_M: f64 = 1e-9;
/// The most bends in one move; a cluster of overlapping solids can need many.
const MOST_BENDS: usize = 256;
/// The deepest nesting of detours: the detour around a solid may itself enter other solids.
const DEEPEST: usize = 6;

/// The solids that a path must not enter.
#[derive(Debug, Clone)]
pub(super) struct Sidestep {
    solids: Vec<RoundedPolygon>,
    boxes: Boxes,
    /// Whether the ends of a detour are first led out to the outline.
    leads_out: bool,
}

impl Sidestep {
    /// Creates sidesteps around these solids.
    ///
    /// With `leads_out`, a move between two points on the outline of a solid keeps clear of the solid; this suits grown
    /// solids, because a robot can be inside one. Without it, such a move is a chord of the solid, like the chords with
    /// which a taut cable is drawn.
    pub(super) fn new(solids: Vec<RoundedPolygon>, leads_out: bool) -> Self {
        let boxes = Boxes::new(solids.iter().map(RoundedPolygon::bounds));
        Self { solids, boxes, leads_out }
    }

    /// Returns the nearest point that lies outside all solids, if a few steps can find one.
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

    /// Whether a segment stays outside all solids.
    pub(super) fn is_open(&self, from: Point, to: Point) -> bool {
        !self.near(from, to).any(|(_, solid)| solid.is_entered_by(from, to, TOUCH_M))
    }

    /// Whether at most one solid is near a disc.
    pub(super) fn is_alone(&self, center: Point, radius_m: f64) -> bool {
        self.boxes.near(center, center, radius_m + TOUCH_M).nth(1).is_none()
    }

    /// Returns the parts of a segment that lie in solids or touch them, as the shares where each part begins and
    /// ends, in no particular order.
    pub(super) fn inside(&self, from: Point, to: Point) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.near(from, to).filter_map(move |(_, solid)| solid.inside(from, to))
    }

    /// Calls `go` with the end of each straight move on the way from one point to another around every solid.
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
        // The rest of the move lies outside this solid, or only touches it.
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

    /// Returns the solids that a segment may meet, each with its index, in no particular order.
    fn near(&self, from: Point, to: Point) -> impl Iterator<Item = (usize, &RoundedPolygon)> {
        self.boxes.near(from, to, TOUCH_M).map(|k| (k, &self.solids[k]))
    }
}
