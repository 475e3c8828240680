//! Places where the robot got stuck on a way beside the tether: no later search leads through them.

use geometry::direction_or;
use world::{Obstacle, ObstacleId, Point, Shape, Vector, polyline};

/// Radius of the disc that closes a place, metres.
const RADIUS_M: f64 = 0.1;
/// Distance between this disc and the hull that got stuck, metres: the robot must be able to leave.
const GAP_M: f64 = 0.05;

/// The closed places.
#[derive(Clone, Debug, Default)]
pub(in crate::engine) struct DeadEnds(Vec<Point>);

impl DeadEnds {
    /// Closes the place before a hull of a given radius, metres, that got stuck `here` on its way to a point.
    pub(super) fn close(&mut self, here: Point, to: Point, hull_m: f64) {
        self.0.push(here + direction_or(to - here, Vector::x()) * (hull_m + GAP_M + RADIUS_M));
    }

    /// Whether a way leads a hull of a given radius, metres, over a closed place.
    pub(super) fn are_on(&self, way: &[Point], hull_m: f64) -> bool {
        self.0.iter().any(|at| polyline::distance_m(way, *at) < hull_m + RADIUS_M)
    }

    /// The closed places as obstacles.
    pub(super) fn obstacles(&self) -> impl Iterator<Item = Obstacle> {
        self.0.iter().map(|center| Obstacle {
            id: ObstacleId(u32::MAX),
            name: "place where the robot got stuck".into(),
            shape: Shape::Disc { center: *center, radius_m: RADIUS_M },
            known: true,
        })
    }

    /// Opens all places.
    pub(super) fn open(&mut self) {
        self.0.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_place_lies_before_the_hull_and_not_under_it() {
        let mut dead_ends = DeadEnds::default();
        let (here, hull_m) = (Point::new(1.0, 2.0), 0.2);
        dead_ends.close(here, Point::new(5.0, 2.0), hull_m);
        let shapes: Vec<Shape> = dead_ends.obstacles().map(|closed| closed.shape).collect();
        assert_eq!(shapes.len(), 1);
        let free_m = shapes[0].distance_m(here) - hull_m;
        assert!((free_m - GAP_M).abs() < 1e-9, "{free_m}");
        assert!(dead_ends.are_on(&[here, Point::new(5.0, 2.0)], hull_m));
        assert!(!dead_ends.are_on(&[here, Point::new(1.0, 5.0)], hull_m));
        dead_ends.open();
        assert_eq!(dead_ends.obstacles().count(), 0);
    }
}
