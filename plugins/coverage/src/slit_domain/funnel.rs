//! The shortest path through a sleeve of triangles (Lee and Preparata 1984).

use crate::plane::left_of;
use world::{Point, Vector};

/// A corner of a path.
pub(super) struct Bend {
    pub at: Point,
    /// 1 if the path bends to the left here, -1 if it bends to the right, 0 at its ends.
    pub side: f64,
}

impl Bend {
    /// The unit vector away from the corner around which the path bends.
    pub(super) fn free_side(&self, before: Point, behind: Point) -> Vector {
        let ahead = |from: Point, to: Point| (to - from).try_normalize(0.0).unwrap_or_else(Vector::zeros);
        let (into, out) = (ahead(before, self.at), ahead(self.at, behind));
        // A path that reverses its direction continues around the corner.
        let along = (into + out).try_normalize(1e-9).unwrap_or_else(|| left_of(into) * self.side);
        left_of(along) * -self.side
    }
}

/// The shortest path from start to goal through a sleeve, given by the left and right ends of the sides that it
/// crosses, in order.
///
/// From its apex, the funnel sees every side up to the current one between two rims. A side that narrows the funnel
/// moves a rim inward. If one rim would pass the other, the path bends at the corner of the other rim. That corner is
/// the next apex, and the walk continues from the side that contains it.
pub(super) fn funnel(start: Point, goal: Point, sleeve: &[(Point, Point)]) -> Vec<Bend> {
    let area = |a: Point, b: Point, c: Point| (b - a).perp(&(c - a));
    let mut path = Vec::with_capacity(8);
    path.push(Bend { at: start, side: 0.0 });
    let (mut apex, mut left, mut right) = (start, start, start);
    let (mut left_at, mut right_at) = (0, 0);
    let mut k = 0;
    while k <= sleeve.len() {
        let (new_left, new_right) = sleeve.get(k).copied().unwrap_or((goal, goal));
        if area(apex, right, new_right) >= 0.0 {
            if apex == right || area(apex, left, new_right) < 0.0 {
                (right, right_at) = (new_right, k);
            } else {
                path.push(Bend { at: left, side: 1.0 });
                (apex, right, right_at, k) = (left, left, left_at, left_at + 1);
                continue;
            }
        }
        if area(apex, left, new_left) <= 0.0 {
            if apex == left || area(apex, right, new_left) > 0.0 {
                (left, left_at) = (new_left, k);
            } else {
                path.push(Bend { at: right, side: -1.0 });
                (apex, left, left_at, k) = (right, right, right_at, right_at + 1);
                continue;
            }
        }
        k += 1;
    }
    path.push(Bend { at: goal, side: 0.0 });
    path.dedup_by(|a, b| (a.at - b.at).norm() < 1e-12);
    if path.len() == 1 {
        path.push(Bend { at: goal, side: 0.0 });
    }
    path
}
