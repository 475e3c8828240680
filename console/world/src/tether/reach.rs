//! The floor that a tether of a given length reaches.

use super::{cable_obstacles::CableObstacles, geodesic::Geodesic};
use geometry::{Boundary, Point, Shape};
use std::sync::Arc;

/// The floor that the tether reaches by the shortest path from the anchor.
#[derive(Debug, Clone)]
pub struct Reach {
    anchor: Point,
    paths: Geodesic,
    within_m: f64,
}

impl Reach {
    /// Creates the floor within `within_m` of the anchor among obstacles with these outlines, tank frame.
    ///
    /// ```
    /// use world::{Boundary, Point, tether::Reach};
    /// let reach = Reach::new(Point::origin(), &Boundary::Circle { radius_m: 10.0 }, &[], 5.0);
    /// assert!(!reach.is_beyond(Point::new(3.0, 4.0)) && reach.is_beyond(Point::new(3.0, 4.1)));
    /// ```
    pub fn new(anchor: Point, boundary: &Boundary, shapes: &[Shape], within_m: f64) -> Self {
        let paths = Geodesic::new(anchor, Arc::new(CableObstacles::new(boundary, shapes)));
        Self { anchor, paths, within_m }
    }

    /// Whether the shortest path to a point is longer than the tether. A point that no path reaches does not count as
    /// beyond the tether, because the tether is not what keeps the robot away.
    ///
    /// ```
    /// use world::{Boundary, Point, Shape, tether::Reach};
    /// let column = Shape::Disc { center: Point::new(4.0, 0.0), radius_m: 0.5 };
    /// let reach = Reach::new(Point::origin(), &Boundary::Circle { radius_m: 10.0 }, &[column], 8.0);
    /// assert!(reach.is_beyond(Point::new(8.0, 0.0)), "8.06 m around the column");
    /// ```
    pub fn is_beyond(&self, place: Point) -> bool {
        self.beyond_m(place).is_some()
    }

    /// Returns by how much the shortest path to a point is longer than the tether, metres; `None` if it is not
    /// longer.
    ///
    /// ```
    /// use world::{Boundary, Point, tether::Reach};
    /// let reach = Reach::new(Point::origin(), &Boundary::Circle { radius_m: 10.0 }, &[], 5.0);
    /// assert!((reach.beyond_m(Point::new(6.0, 0.0)).unwrap() - 1.0).abs() < 1e-9);
    /// ```
    pub fn beyond_m(&self, place: Point) -> Option<f64> {
        let straight_m = (place - self.anchor).norm();
        let path_m = self.paths.distance_m(place);
        let longest_m = straight_m.max(path_m);
        (path_m.is_finite() && longest_m > self.within_m).then_some(longest_m - self.within_m)
    }

    /// The longest path that the tether allows, metres.
    ///
    /// ```
    /// use world::{Boundary, Point, tether::Reach};
    /// assert_eq!(Reach::new(Point::origin(), &Boundary::Circle { radius_m: 10.0 }, &[], 5.0).within_m(), 5.0);
    /// ```
    pub fn within_m(&self) -> f64 {
        self.within_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_path_around_an_obstacle_counts_and_a_point_inside_one_is_not_beyond_the_tether() {
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
