//! The way driven, from the anchor on.

use world::Point;

/// Distance between the points of the way driven that are kept, metres.
pub(super) const KEPT_M: f64 = 0.05;
/// Coming this near to the point before the last one undoes the last step, metres: no obstacle stands in so small a loop of
/// the hull.
const UNDONE_M: f64 = 0.08;

/// The way driven, without what was driven there and back.
#[derive(Clone)]
pub(super) struct Driven {
    points: Vec<Point>,
}

impl Driven {
    /// Nothing has been driven yet.
    pub(super) fn new(start: Point) -> Self {
        Self { points: vec![start] }
    }

    /// Its points, [`KEPT_M`] apart.
    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }

    /// Adds a step. One back over the last one undoes it: what is left is the way without its there-and-back.
    pub(super) fn keep(&mut self, here: Point) {
        let far_from =
            |point: Option<&Point>, apart_m: f64| point.is_none_or(|p| (here - p).norm() >= apart_m);
        if far_from(self.points.last(), KEPT_M) {
            let before = self.points.len().checked_sub(2).and_then(|k| self.points.get(k));
            if far_from(before, UNDONE_M) {
                self.points.push(here);
            } else {
                self.points.pop();
            }
        }
    }
}
