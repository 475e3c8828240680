//! The way home: back along the cable, with room for the hull.
//!
//! The taut cable itself is no way for a hull: it bears on columns. The hull's way is the taut line of the same class
//! in the ground grown by the hull, so it exists wherever the robot has driven. Its class is looked at again at the
//! end: where grown obstacles close a gap, the line may have been bent to the wrong side of one.

use super::{cable::Cable, ground::Ground, word::Word};
use crate::{geometry::Point, obstacles::ObstacleMap, polyline};
use std::sync::Arc;

/// Distance between the places at which a cable within a grown obstacle is led out of it, metres.
const STOP_M: f64 = 0.05;
/// Length of the way at the robot and at the anchor that may be tight, metres: where the robot stands it stands.
const ENDS_M: f64 = 0.1;
/// Room that a way home may lack, metres: chords of arcs.
const SPARE_M: f64 = 0.005;

impl Cable {
    /// The shortest way back to the anchor on which the cable is only reeled in, from the robot to the anchor.
    ///
    /// `roomy` is the same ground grown by `room_m`, the room that the middle of the hull needs, and `map` the obstacles.
    /// Robot and anchor may stand nearer to something: the way then begins and ends with a step away from it. `None` if
    /// the hull does not fit along the cable: there is no way home that unwinds it.
    pub fn return_path(&self, roomy: &Arc<Ground>, map: &ObstacleMap, room_m: f64) -> Option<Vec<Point>> {
        let mut hull = Self::on(roomy.outside(self.anchor()), Arc::clone(roomy)).ok()?;
        for pair in self.taut_line().windows(2) {
            // A place inside a grown obstacle counts as one beside it, and a straight line from there to a far one might
            // pass the next obstacle on its other side.
            hull.drag_along(&roomy.with_stops_inside(pair[0], pair[1], STOP_M));
        }
        let inner = hull.taut_line();
        let fits = has_room(&polyline::without_ends(&inner, ENDS_M), map, room_m - SPARE_M);
        let mut way = vec![self.anchor()];
        way.extend(inner);
        way.push(self.tip());
        way.dedup_by(|a, b| (*a - *b).norm() < 1e-9);
        let unwinds = Word::of(&way, &self.ground().rays) == *self.word();
        way.reverse();
        (fits && unwinds).then_some(way)
    }
}

/// Whether a way keeps off obstacles and wall. Between its bends a taut way is nearest to the wall at its ends.
fn has_room(way: &[Point], map: &ObstacleMap, need_m: f64) -> bool {
    let bends = way.get(1..way.len().saturating_sub(1)).unwrap_or_default();
    way.windows(2).all(|pair| map.obstacle_clearance_m(pair[0], pair[1]) >= need_m)
        && bends.iter().all(|bend| map.boundary().wall_distance_m(*bend) >= need_m)
}

#[cfg(test)]
mod tests;
