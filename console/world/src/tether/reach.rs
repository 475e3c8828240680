//! What floor a cable of some length leads to.

use super::{geodesic::Geodesic, ground::Ground};
use crate::{Boundary, geometry::Point, shape::Shape};
use std::sync::Arc;

/// The floor to which the shortest way from an anchor is no longer than the cable.
#[derive(Debug, Clone)]
pub struct Reach {
    anchor: Point,
    ways: Geodesic,
    within_m: f64,
}

impl Reach {
    /// The floor within `within_m` of the anchor among obstacles of these outlines.
    pub fn new(anchor: Point, boundary: &Boundary, shapes: &[Shape], within_m: f64) -> Self {
        let ways = Geodesic::new(anchor, Arc::new(Ground::new(boundary, shapes)));
        Self { anchor, ways, within_m }
    }

    /// Whether the shortest way to a place is longer than the cable; a place without any way is no matter of the cable.
    pub fn is_beyond(&self, place: Point) -> bool {
        let straight_m = (place - self.anchor).norm();
        let way_m = self.ways.distance_m(place);
        way_m.is_finite() && (straight_m > self.within_m || way_m > self.within_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_round_an_obstacle_counts_and_a_place_inside_one_is_no_matter_of_the_cable() {
        let wall = Boundary::Circle { radius_m: 10.0 };
        let column = Shape::Disc { center: Point::origin(), radius_m: 2.0 };
        let anchor = Point::new(-6.0, 0.0);
        let behind = Point::new(6.0, 0.0);
        // Tangents of 4 sqrt(2) m on both sides, and an arc of 2 * (pi - 2 acos(1/3)) m between them.
        let way_m = 2.0 * 32.0_f64.sqrt() + 2.0 * (std::f64::consts::PI - 2.0 * (1.0_f64 / 3.0).acos());
        let reach = |reach_m: f64| Reach::new(anchor, &wall, std::slice::from_ref(&column), reach_m);
        assert!(
            way_m > 12.4 && reach(way_m - 0.01).is_beyond(behind) && !reach(way_m + 0.01).is_beyond(behind)
        );
        assert!(!reach(1.0).is_beyond(Point::new(0.5, 0.0)), "inside the column");
        assert!(reach(3.0).is_beyond(Point::new(-6.0, 3.1)) && !reach(3.0).is_beyond(Point::new(-6.0, 2.9)));
    }
}
