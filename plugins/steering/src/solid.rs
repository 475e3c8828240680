//! A convex part of a known obstacle.

use crate::{
    contact::{Contact, Source},
    side::Side,
    tangents::{self, Tangent},
};
use geometry::{Point, Vector, convex::Part, direction_or, polyline::nearest_on_segment};

/// A convex solid that the robot must not touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Id of the obstacle that the solid belongs to.
    pub id: u32,
    /// The outline.
    pub part: Part,
    /// Centre of an enclosing disc.
    pub center: Point,
    /// Radius of the enclosing disc, metres.
    pub radius_m: f64,
    corners: Vec<(Point, f64)>,
}

impl Solid {
    /// Creates a part of an obstacle.
    pub fn new(id: u32, part: Part) -> Self {
        let mut corners = part.corners();
        if corners.iter().all(|corner| *corner == corners[0]) {
            corners.truncate(1);
        }
        let (center, radius_m) = disc_around(&corners);
        Self { id, part, center, radius_m, corners }
    }

    /// Creates a disc.
    pub fn disc(id: u32, center: Point, radius_m: f64) -> Self {
        Self::new(id, Part::disc(center, radius_m))
    }

    /// The discs whose convex hull is the solid.
    pub fn corners(&self) -> &[(Point, f64)] {
        &self.corners
    }

    /// Whether a point is certainly further than `distance_m` from the outline; a very cheap check.
    pub fn is_beyond(&self, at: Point, distance_m: f64) -> bool {
        let reach_m = self.radius_m + distance_m;
        (at - self.center).norm_squared() > reach_m * reach_m
    }

    /// The signed distance from a point to the outline, metres, and the direction away from it.
    pub fn distance(&self, at: Point) -> (f64, Vector) {
        if self.corners.len() > 1 {
            return self.part.distance(at);
        }
        let from = at - self.center;
        (from.norm() - self.radius_m, direction_or(from, Vector::x()))
    }

    /// The contact of a hull with the solid, if the solid is within `reach_m`. Very cheap if it is not.
    pub fn contact(&self, at: Point, hull_m: f64, reach_m: f64) -> Option<Contact> {
        if self.is_beyond(at, reach_m + hull_m) {
            return None;
        }
        let (outline_m, away) = self.distance(at);
        let contact = Contact { source: Source::Obstacle(self.id), distance_m: outline_m - hull_m, away };
        (contact.distance_m < reach_m).then_some(contact)
    }

    /// The distance from a segment to the outline, metres; zero or negative when they touch, and exact only below
    /// `enough_m`.
    pub fn segment_distance_m(&self, a: Point, b: Point, enough_m: f64) -> f64 {
        let nearest = nearest_on_segment(a, b, self.center);
        let around_m = (nearest - self.center).norm() - self.radius_m;
        let is_disc = self.corners.len() == 1;
        if is_disc || around_m > enough_m { around_m } else { self.part.segment_distance_m(a, b) }
    }

    /// The tangent from a point to the outline grown by a margin.
    pub fn tangent(&self, at: Point, margin_m: f64, side: Side) -> Tangent {
        let grown = self.corners.iter().map(|(corner, radius_m)| (*corner, radius_m + margin_m));
        tangents::outermost(at, grown, side).expect("a solid has at least one corner")
    }
}

/// A disc around several discs: the circumscribed circle of their bounding box, as in Xu et al. 2022, eq. 6.
pub fn disc_around(discs: &[(Point, f64)]) -> (Point, f64) {
    if discs.iter().all(|disc| disc == &discs[0]) {
        return discs[0];
    }
    let far = f64::INFINITY;
    let (mut low, mut high) = (Point::new(far, far), Point::new(-far, -far));
    for (center, radius_m) in discs {
        let grow = Vector::new(*radius_m, *radius_m);
        low = low.inf(&(center - grow));
        high = high.sup(&(center + grow));
    }
    (nalgebra::center(&low, &high), (high - low).norm() / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_disc_around_a_box_has_half_its_diagonal() {
        let (center, radius_m) = disc_around(&[(Point::new(0.0, 0.0), 1.0), (Point::new(4.0, 2.0), 1.0)]);
        assert!((center - Point::new(2.0, 1.0)).norm() < 1e-12);
        assert!((radius_m - 13.0_f64.sqrt()).abs() < 1e-12);
    }
}
