//! Follows a course according to what is sensed: straight to the next free point of the course, and past obstacles
//! along the tangents of the headings that they block.

use geometry::convex::Part;
use std::f64::consts::TAU;
use steering::{Keep, Side, wall_contacts};
use world::{Boundary, Point, Vector, geometry::wrap_angle_rad};

/// Distance ahead within which the nearest point of the course is searched for, metres.
const WINDOW_M: f64 = 1.5;
/// Distance from the course within which a place is on the course, metres.
const ON_COURSE_M: f64 = 0.01;
/// The margin between a heading and blocked headings, radians.
const MARGIN_RAD: f64 = 1e-6;
/// The number of moves of a way round that are simulated.
const THOUGHT_MOVES: usize = 120;
/// Number of moves without progress along the course after which the follower is stuck.
const PATIENCE_MOVES: usize = 40;
/// Shortfall in clearance that is attributed to rounding, metres.
const ROUNDING_M: f64 = 1e-7;

/// A course with the distances along it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Track<'a> {
    /// The points, at least one.
    pub points: &'a [Point],
    /// Distance along the course to every point, metres.
    pub stations_m: &'a [f64],
}

/// The known surroundings.
#[derive(Debug, Clone)]
pub(crate) struct Around<'a> {
    /// The wall.
    pub wall: &'a Boundary,
    /// Everything sensed, as parts.
    pub parts: Vec<&'a Part>,
    /// The distances to keep from the wall and from the parts.
    pub keep: Keep,
}

/// An interval of blocked headings: within `half_rad` of `middle_rad`.
#[derive(Debug, Clone, Copy)]
struct Interval {
    middle_rad: f64,
    half_rad: f64,
}

/// The position of a follower, and how it passes obstacles.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Follower {
    /// The position.
    pub at: Point,
    /// Index of the nearest point of the course; it only increases.
    pub nearest: usize,
    /// The side on which the follower is passing an obstacle, if it is passing one.
    pub side: Option<Side>,
    best: usize,
    idle: usize,
}

/// The follower is stuck: neither side leads past the obstacles in range and back to the course.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Stuck;

impl Around<'_> {
    /// Returns the free space at a place, metres; negative where the centre of the hull is not allowed.
    pub(crate) fn spare_m(&self, at: Point) -> f64 {
        let wall_m = self.wall.wall_distance_m(at) - self.keep.wall_m + 1e-9;
        self.parts.iter().map(|part| part.distance(at).0 - self.keep.obstacle_m).fold(wall_m, f64::min)
    }

    /// Whether the centre of the hull can move straight from one place to another, as far as is known.
    pub(crate) fn is_free(&self, a: Point, b: Point) -> bool {
        self.wall.wall_distance_m(b) >= self.keep.wall_m - 1e-9
            && self.parts.iter().all(|part| part.segment_distance_m(a, b) >= self.keep.obstacle_m)
    }

    /// Whether the centre of the hull can move straight from one place to another, with a rounding margin that lets the
    /// hull touch obstacles.
    pub(crate) fn is_nearly_free(&self, a: Point, b: Point) -> bool {
        self.wall.wall_distance_m(b) >= self.keep.wall_m - ROUNDING_M
            && self
                .parts
                .iter()
                .all(|part| part.segment_distance_m(a, b) >= self.keep.obstacle_m - ROUNDING_M)
    }

    /// Returns the headings in which a move of this length would come too close to something.
    fn blocked(&self, at: Point, reach_m: f64) -> Vec<Interval> {
        let mut blocked: Vec<Interval> = Vec::new();
        for part in &self.parts {
            let (distance_m, away) = part.distance(at);
            blocked.extend(interval(distance_m - self.keep.obstacle_m, away, reach_m));
        }
        match self.wall {
            Boundary::Circle { radius_m } => {
                blocked.extend(round_wall(radius_m - self.keep.wall_m, at, reach_m));
            }
            Boundary::Polygon { .. } => {
                let contacts = wall_contacts(self.wall, at, self.keep.wall_m, reach_m);
                blocked.extend(contacts.iter().filter_map(|c| interval(c.distance_m, c.away, reach_m)));
            }
        }
        blocked
    }

    /// Returns the first free heading from the desired one on, turning only to this side; `None` if all are blocked.
    pub(crate) fn tangent(&self, at: Point, wanted: Vector, reach_m: f64, side: Side) -> Option<Vector> {
        let blocked = self.blocked(at, reach_m);
        let sign = side.sign();
        let wanted_rad = wanted.y.atan2(wanted.x);
        let mut turned_rad = 0.0;
        while let Some(beyond_rad) =
            blocked.iter().find_map(|i| i.beyond(wanted_rad + sign * turned_rad, sign))
        {
            turned_rad += beyond_rad + MARGIN_RAD;
            if turned_rad > TAU {
                return None;
            }
        }
        let heading_rad = wanted_rad + sign * turned_rad;
        Some(Vector::new(heading_rad.cos(), heading_rad.sin()))
    }
}

impl Interval {
    /// Returns how far to turn to leave the interval, if the heading is inside it.
    fn beyond(&self, heading_rad: f64, sign: f64) -> Option<f64> {
        let off_rad = wrap_angle_rad(heading_rad - self.middle_rad);
        (off_rad.abs() < self.half_rad).then(|| (self.half_rad - sign * off_rad).max(MARGIN_RAD))
    }
}

/// Returns the headings that a convex object blocks. The object is entirely behind the plane through its nearest point.
fn interval(spare_m: f64, away: Vector, reach_m: f64) -> Option<Interval> {
    // A robot that is already too close may move along the object, or away from it.
    let cosine = (spare_m.max(0.0) / reach_m).min(1.0);
    (cosine < 1.0).then(|| Interval { middle_rad: (-away.y).atan2(-away.x), half_rad: cosine.acos() })
}

/// Returns the headings that a round wall blocks. The wall curves towards the robot, so a tangent would leave the tank.
fn round_wall(radius_m: f64, at: Point, reach_m: f64) -> Option<Interval> {
    let r = at.coords.norm();
    if r + reach_m <= radius_m || r < 1e-9 {
        return None;
    }
    let cosine = ((radius_m * radius_m - r * r - reach_m * reach_m) / (2.0 * r * reach_m)).clamp(-1.0, 1.0);
    Some(Interval { middle_rad: at.y.atan2(at.x), half_rad: cosine.acos() })
}

impl Follower {
    /// Creates a follower at a place near a point of its course.
    pub(crate) fn new(at: Point, nearest: usize) -> Self {
        Self { at, nearest, side: None, best: nearest, idle: 0 }
    }

    /// Makes one move of at most this length.
    ///
    /// # Errors
    /// [`Stuck`] when no move makes progress.
    pub(crate) fn advance(
        &mut self,
        track: &Track<'_>,
        around: &Around<'_>,
        step_m: f64,
    ) -> Result<(), Stuck> {
        self.note_progress(track);
        if self.idle > PATIENCE_MOVES {
            return Err(Stuck);
        }
        let aim = self.aim(track, around);
        let length_m = step_m.min((aim - self.at).norm());
        let Some(wanted) = (aim - self.at).try_normalize(1e-12) else {
            self.nearest = (self.nearest + 1).min(track.points.len() - 1);
            return Ok(());
        };
        if around.is_free(self.at, self.at + wanted * length_m) {
            self.at += wanted * length_m;
            return Ok(());
        }
        let side = self.side.or_else(|| self.better_side(track, around, step_m)).ok_or(Stuck)?;
        self.side = Some(side);
        let heading = around.tangent(self.at, wanted, step_m, side).ok_or(Stuck)?;
        self.at += heading * step_m;
        Ok(())
    }

    /// Whether the last point of the course has been reached.
    pub(crate) fn is_done(&self, track: &Track<'_>, tolerance_m: f64) -> bool {
        let last = track.points.len() - 1;
        let left_m = track.stations_m[last] - track.stations_m[self.nearest];
        left_m < tolerance_m && (track.points[last] - self.at).norm() < tolerance_m
    }

    /// Whether the follower is on the course rather than on a way round.
    pub(crate) fn is_on(&self, track: &Track<'_>) -> bool {
        self.off_m(track) < ON_COURSE_M
    }

    fn off_m(&self, track: &Track<'_>) -> f64 {
        let next = (self.nearest + 1).min(track.points.len() - 1);
        let before = self.nearest.saturating_sub(1);
        let to = |a: usize, b: usize| {
            (world::polyline::nearest_on_segment(track.points[a], track.points[b], self.at) - self.at).norm()
        };
        to(self.nearest, next).min(to(before, self.nearest))
    }

    fn note_progress(&mut self, track: &Track<'_>) {
        let end_m = track.stations_m[self.nearest] + WINDOW_M;
        let mut best_m = (track.points[self.nearest] - self.at).norm_squared();
        for index in self.nearest + 1..track.points.len() {
            if track.stations_m[index] > end_m {
                break;
            }
            let off_m = (track.points[index] - self.at).norm_squared();
            if off_m <= best_m {
                (best_m, self.nearest) = (off_m, index);
            } else if best_m < ON_COURSE_M * ON_COURSE_M {
                break;
            }
        }
        let got_on = self.nearest > self.best;
        self.idle = if got_on { 0 } else { self.idle + 1 };
        self.best = self.best.max(self.nearest);
        if got_on && self.side.is_some() && self.is_on(track) {
            self.side = None;
        }
    }

    /// Returns the first free point of the course ahead, as far as is known.
    fn aim(&self, track: &Track<'_>, around: &Around<'_>) -> Point {
        let off_m = self.off_m(track);
        let lead_m = if off_m < ON_COURSE_M { 1e-6 } else { 0.05 + 0.5 * off_m };
        let from_m = track.stations_m[self.nearest] + lead_m;
        let ahead = (self.nearest..track.points.len()).filter(|index| track.stations_m[*index] >= from_m);
        let mut free = ahead.filter(|index| around.spare_m(track.points[*index]) >= 0.0);
        let last = track.points[track.points.len() - 1];
        free.next().map_or(last, |index| track.points[index])
    }

    /// Returns the side on which less floor is missed, as far as is known, by simulating both. `None` if neither leads
    /// back to the course.
    fn better_side(&self, track: &Track<'_>, around: &Around<'_>, step_m: f64) -> Option<Side> {
        let cost = |side: Side| self.cost_of(side, track, around, step_m).map(|cost| (cost, side));
        let (left, right) = (cost(Side::Left), cost(Side::Right));
        let both = left.into_iter().chain(right);
        both.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, side)| side)
    }

    fn cost_of(&self, side: Side, track: &Track<'_>, around: &Around<'_>, step_m: f64) -> Option<f64> {
        let mut thought = Self { side: Some(side), idle: 0, ..*self };
        let mut cost = 0.0;
        for _ in 0..THOUGHT_MOVES {
            let (before, nearest) = (thought.at, thought.nearest);
            thought.advance(track, around, step_m).ok()?;
            if thought.side.is_none() && thought.is_on(track) && nearest > self.nearest {
                return Some(cost);
            }
            cost += (thought.at - before).norm() * thought.off_m(track).powi(2);
        }
        None
    }
}
