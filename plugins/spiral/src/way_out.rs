//! Finds the way out of a pocket: the shortest path to the course beyond it, among everything sensed so far.

use crate::{
    course::places_about,
    tangent::{Follower, Track},
};
use geometry::convex::Part;
use steering::Room;
use world::{Point, Shape, shortest::GrownFloor};

/// Length up to which a detour to the next section of the course is accepted, metres. If the detour would be longer,
/// the later sections are tried, too.
const SHORT_M: f64 = 6.0;

/// A way back to the course.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WayOut {
    /// The points, beginning at the position of the follower.
    pub way: Vec<Point>,
    /// Index of the point of the course where the way ends.
    pub nearest: usize,
    /// Whether the way ends at the free place nearest to a blocked last point.
    pub is_end: bool,
}

/// Returns the floor between the sensed parts.
pub(crate) fn floor<'a>(room: &Room, seen: impl Iterator<Item = &'a Part>) -> GrownFloor {
    let shapes: Vec<Shape> = seen.map(Part::to_shape).collect();
    let keep = room.keep();
    GrownFloor::new(room.wall(), keep.wall_m, shapes.iter().map(|shape| (shape, keep.obstacle_m)))
}

/// Finds the path to the first free section of the course ahead that can be reached by a short detour, or else to the
/// section with the shortest path. Returns `None` if all sections are proved to be closed off.
pub(crate) fn onward(
    track: &Track<'_>,
    follower: &Follower,
    floor: &GrownFloor,
    keep_going: &mut dyn FnMut() -> bool,
) -> Option<WayOut> {
    let mut best: Option<(f64, WayOut)> = None;
    for (goal, nearest, is_end) in goals(track, follower, floor) {
        let Ok(way) = floor.shortest(follower.at, goal, keep_going) else { continue };
        if best.as_ref().is_none_or(|(length_m, _)| way.length_m < *length_m) {
            best = Some((way.length_m, WayOut { way: way.points(), nearest, is_end }));
        }
        if way.length_m < SHORT_M {
            break;
        }
    }
    best.map(|(_, way_out)| way_out)
}

/// Returns the start of every free section of the course ahead; if there is none, the free place nearest to the end.
fn goals(track: &Track<'_>, follower: &Follower, floor: &GrownFloor) -> Vec<(Point, usize, bool)> {
    let last = track.points.len() - 1;
    let mut goals = Vec::new();
    let mut before: Option<Point> = None;
    for index in follower.nearest + 1..=last {
        let at = track.points[index];
        let is_free = floor.spare_m(at) >= 0.0;
        if is_free && before.is_none_or(|from| !floor.is_free(from, at)) {
            goals.push((at, index, false));
        }
        before = is_free.then_some(at);
    }
    if goals.is_empty() {
        let free = places_about(track.points[last], 1..81).find(|place| floor.spare_m(*place) >= 0.0);
        goals.extend(free.map(|at| (at, last, true)));
    }
    goals
}
