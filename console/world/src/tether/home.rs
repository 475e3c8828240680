//! The return path: back along the cable, with clearance for the hull.
//!
//! The taut cable itself is not a path for a hull, because it bears on columns. The hull's path is the taut line of the
//! same homotopy class among obstacles grown by the hull, so it exists wherever the robot has driven. There are two
//! ways to find it. The robot can drag this line along as it drags the cable, which costs little and is always correct
//! where the robot fits. Alternatively, the line can be laid along the taut cable, which needs no memory of the path
//! driven. But the cable bears on obstacles that are now grown, and where they stand close together, the nearest point
//! outside them may be on the wrong side. Signature, clearance and walls are therefore checked at the end.

use super::{cable::Cable, cable_obstacles::CableObstacles, homotopy::HomotopySignature};
use crate::obstacles::ObstacleMap;
use geometry::{Point, polyline};
use std::sync::Arc;

/// Distance between the points at which a cable within a grown obstacle is led out of it, metres.
const STOP_M: f64 = 0.05;
/// The length, metres, over which each end of the path may be too narrow: the robot cannot choose where it starts.
const ENDS_M: f64 = 0.1;
/// The clearance that may be missing on a return path, metres, because its arcs are drawn as chords.
const SPARE_M: f64 = 0.005;

impl Cable {
    /// Returns the shortest path from the robot back to the anchor on which the cable is only reeled in, tank frame.
    ///
    /// `grown` are the same obstacles grown by `room_m`, the clearance of the hull's centre, and `map` holds the
    /// obstacles without growth. If the robot or the anchor is closer to an obstacle than `room_m`, the path begins or
    /// ends with a step away from it. `None` if the hull does not fit along the cable, so that no path home unwinds it.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use world::{Boundary, ObstacleMap, Point, tether::{Cable, CableObstacles}};
    /// let wall = Boundary::Circle { radius_m: 10.0 };
    /// let mut cable = Cable::new(Point::origin(), &wall, &[]).unwrap();
    /// cable.drag_along(&[Point::new(4.0, 2.0), Point::new(8.0, 0.0)]);
    /// let (grown, map) = (Arc::new(CableObstacles::grown(&wall, &[], 0.3)), ObstacleMap::new(&wall, &[]));
    /// let home = cable.return_path(&grown, &map, 0.3);
    /// assert_eq!(home, Some(vec![Point::new(8.0, 0.0), Point::origin()]));
    /// ```
    pub fn return_path(
        &self,
        grown: &Arc<CableObstacles>,
        map: &ObstacleMap,
        room_m: f64,
    ) -> Option<Vec<Point>> {
        self.hulls_along(grown, room_m).find_map(|hull| self.return_path_of(&hull, map, room_m))
    }

    /// Iterates over taut lines for the hull among obstacles grown by the hull's clearance: first along this cable,
    /// then along a line that keeps its distance from all posts that the cable bears on. The second line is for walls
    /// that consist of many pieces.
    pub fn hulls_along<'a>(
        &'a self,
        grown: &'a Arc<CableObstacles>,
        room_m: f64,
    ) -> impl Iterator<Item = Self> + 'a {
        let rooms = [0.0, room_m].into_iter();
        rooms.filter_map(move |beside_m| self.hull_laid(&self.line_beside_posts(beside_m), grown))
    }

    fn hull_laid(&self, line: &[Point], grown: &Arc<CableObstacles>) -> Option<Self> {
        let mut hull = Self::hull_at(self.anchor(), grown)?;
        for pair in line.windows(2) {
            // A point inside a grown obstacle counts as the nearest point outside. From there, a straight line to a
            // distant point might pass the next obstacle on the wrong side.
            hull.drag_along(&grown.with_stops_inside(pair[0], pair[1], STOP_M));
        }
        Some(hull)
    }

    /// Creates a taut line for the hull, of length 0, as close to the anchor as the hull fits, to be dragged along
    /// with the robot; `None` if no such place exists.
    pub fn hull_at(anchor: Point, grown: &Arc<CableObstacles>) -> Option<Self> {
        Self::on(grown.outside(anchor), Arc::clone(grown)).ok()
    }

    /// Returns the path of [`Self::return_path`], given the hull's own taut line: laid by [`Self::hulls_along`], or
    /// dragged by the robot from [`Self::hull_at`]. `None` if this path does not unwind the cable, or the hull does
    /// not fit.
    pub fn return_path_of(&self, hull: &Self, map: &ObstacleMap, room_m: f64) -> Option<Vec<Point>> {
        let inner = hull.taut_line();
        let fits = has_room(&polyline::without_ends(&inner, ENDS_M), map, room_m - SPARE_M);
        let mut way = vec![self.anchor()];
        way.extend(inner);
        way.push(self.tip());
        way.dedup_by(|a, b| (*a - *b).norm() < 1e-9);
        let obstacles = self.obstacles();
        let stays = !way.windows(2).any(|pair| obstacles.leads_through_wall(pair[0], pair[1]));
        let unwinds = HomotopySignature::of(&way, &obstacles.rays) == *self.signature();
        way.reverse();
        (fits && stays && unwinds).then_some(way)
    }
}

/// Whether a taut path keeps clear of obstacles and wall. Each segment of the path comes nearest to the wall at one of
/// the segment's ends.
fn has_room(way: &[Point], map: &ObstacleMap, need_m: f64) -> bool {
    let bends = way.get(1..way.len().saturating_sub(1)).unwrap_or_default();
    way.windows(2).all(|pair| map.obstacle_clearance_m(pair[0], pair[1]) >= need_m)
        && bends.iter().all(|bend| map.boundary().wall_distance_m(*bend) >= need_m)
}

#[cfg(test)]
mod tests;
