//! Out of a pocket: the shortest way among all that was sensed so far to the course beyond.

use crate::{
    course::places_about,
    tangent::{Follower, Track},
};
use geometry::convex::Part;
use steering::Room;
use world::{Point, Shape, shortest::GrownFloor};

/// A detour up to this long is taken to the next piece of course, metres; before a longer one the pieces further on are
/// asked for.
const SHORT_M: f64 = 6.0;

/// A way back to the course.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WayOut {
    /// Its points, from where the robot is.
    pub way: Vec<Point>,
    /// Index of the point of the course that it leads to.
    pub nearest: usize,
    /// Whether it leads to the place nearest to a last point that is blocked.
    pub is_end: bool,
}

/// The floor among what was sensed.
pub(crate) fn floor<'a>(room: &Room, seen: impl Iterator<Item = &'a Part>) -> GrownFloor {
    let shapes: Vec<Shape> = seen.map(Part::to_shape).collect();
    let keep = room.keep();
    GrownFloor::new(room.wall(), keep.wall_m, shapes.iter().map(|shape| (shape, keep.obstacle_m)))
}

/// The way to the first free piece of the course ahead that can be reached without much of a detour, else to the one
/// with the shortest way; `None` if all of them are proved to be closed off.
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

/// Where every free piece of the course ahead begins; if there is none, the free place nearest to its end.
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
