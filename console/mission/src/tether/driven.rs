//! The path driven, from the anchor on.

use world::Point;

/// Spacing of the stored points of the path, metres.
pub(super) const KEPT_M: f64 = 0.05;
/// Distance from the second-last point, metres, within which a step undoes the last step: no obstacle fits into such a
/// small loop of the hull.
const UNDONE_M: f64 = 0.08;

/// The path driven, without the parts that were driven out and back.
#[derive(Clone)]
pub(super) struct Driven {
    points: Vec<Point>,
}

impl Driven {
    /// Creates a path that contains only its start.
    pub(super) fn new(start: Point) -> Self {
        Self { points: vec![start] }
    }

    /// The points of the path, [`KEPT_M`] apart.
    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }

    /// Adds a step. A step that goes back over the last one removes it instead, so that parts driven out and back are
    /// not kept.
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
