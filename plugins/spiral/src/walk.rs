//! Simulates a walk along a course. Obstacles that come into range are sensed and remembered; those remembered are used
//! to find the way out of pockets.

use crate::{
    course::{self, Course},
    tangent::{Around, Follower, Track},
    way_out::{self, WayOut},
};
use geometry::convex::Part;
use planner_api::{Ctx, Result};
use steering::Room;
use world::{Point, polyline};

/// Distance after which the surroundings are sensed again, metres.
const LOOK_M: f64 = 0.2;
/// The maximum number of moves, as a multiple of those that the course takes.
const DETOUR: f64 = 4.0;
/// Number of moves between two checks of whether the console has requested a stop.
const ASK_EVERY: usize = 32;

/// A walk along a course by a robot that senses only what is within its range.
pub(crate) struct Walk<'a> {
    course: &'a Course,
    room: &'a Room,
    /// Free space at the last point, metres.
    end_spare_m: f64,
    /// All obstacles as parts, each with a circle around it.
    parts: Vec<(&'a Part, Point, f64)>,
    /// Which parts have been sensed so far.
    seen: Vec<bool>,
    around: Around<'a>,
    looked: Option<Point>,
    range_m: f64,
    step_m: f64,
    follower: Follower,
    path: Vec<Point>,
}

/// The result of leaving a pocket.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Left {
    /// The walk is back on the course.
    OnCourse,
    /// The last point is inside an obstacle, and no place is closer to it.
    AtEnd,
    /// The sensed parts close off the rest of the course.
    Enclosed,
}

impl<'a> Walk<'a> {
    /// Creates a walk among these parts, from the beginning of a course.
    pub(crate) fn new(
        course: &'a Course,
        room: &'a Room,
        parts: &'a [Part],
        (range_m, step_m): (f64, f64),
    ) -> Self {
        let follower = Follower::new(course::nearest_free(course, room), 0);
        let around = Around { wall: room.wall(), parts: Vec::new(), keep: room.keep() };
        let (seen, path) = (vec![false; parts.len()], vec![follower.at]);
        let parts = parts.iter().map(with_circle).collect();
        let last = course.points[course.last()];
        let end_spare_m = room.spare_m(last);
        Self { course, room, parts, end_spare_m, seen, around, looked: None, range_m, step_m, follower, path }
    }

    /// Returns the path walked, and the station at which it got stuck if it did not reach the end.
    ///
    /// # Errors
    /// The console asked to stop.
    pub(crate) fn walked(mut self, ctx: &Ctx<'_>) -> Result<(Vec<Point>, std::result::Result<(), usize>)> {
        let track = Track { points: &self.course.points, stations_m: &self.course.stations_m };
        let most = (DETOUR * track.stations_m[self.course.last()] / self.step_m) as usize + 4000;
        for turn in 0..most + track.points.len() {
            if turn.is_multiple_of(ASK_EVERY) {
                ctx.check()?;
            }
            self.look();
            if self.follower.is_done(&track, 1e-9) || self.ends_here() {
                return Ok((self.path, Ok(())));
            }
            let advanced = self.follower.advance(&track, &self.around, self.step_m);
            self.note();
            if advanced.is_ok() {
                continue;
            }
            match self.left_pocket(&track, ctx)? {
                Left::OnCourse => {}
                Left::AtEnd => return Ok((self.path, Ok(()))),
                Left::Enclosed => break,
            }
        }
        Ok((self.path, Err(self.follower.nearest)))
    }

    /// Senses the surroundings if the follower has moved far enough since the last time. Returns whether something new
    /// came into range.
    fn look(&mut self) -> bool {
        let at = self.follower.at;
        if self.looked.is_some_and(|from| (at - from).norm() <= LOOK_M) {
            return false;
        }
        self.looked = Some(at);
        self.around.parts.clear();
        let mut is_new = false;
        for ((part, middle, radius_m), seen) in self.parts.iter().zip(&mut self.seen) {
            let reach_m = self.range_m + radius_m;
            if (at - middle).norm_squared() < reach_m * reach_m && part.distance(at).0 < self.range_m {
                self.around.parts.push(part);
                is_new |= !*seen;
                *seen = true;
            }
        }
        is_new
    }

    fn note(&mut self) {
        if (self.follower.at - self.path[self.path.len() - 1]).norm() > 1e-9 {
            self.path.push(self.follower.at);
        }
    }

    /// Whether the last point is inside an obstacle and the follower is as close to it as possible.
    fn ends_here(&self) -> bool {
        let last = self.course.points[self.course.last()];
        self.end_spare_m < 0.0 && (last - self.follower.at).norm() < self.step_m - self.end_spare_m
    }

    /// Moves back to the course along a path that avoids everything sensed so far; replans whenever something new is in
    /// the way.
    fn left_pocket(&mut self, track: &Track<'_>, ctx: &Ctx<'_>) -> Result<Left> {
        loop {
            let seen = self.parts.iter().zip(&self.seen).filter(|(_, seen)| **seen).map(|(part, _)| part.0);
            let floor = way_out::floor(self.room, seen);
            let found = way_out::onward(track, &self.follower, &floor, &mut || ctx.check().is_ok());
            ctx.check()?;
            let Some(WayOut { way, nearest, is_end }) = found else { return Ok(Left::Enclosed) };
            let mut is_new = false;
            let mut is_free = true;
            for place in polyline::resampled(&way, self.step_m).into_iter().skip(1) {
                is_new |= self.look();
                is_free = self.around.is_nearly_free(self.follower.at, place);
                if !is_free {
                    break;
                }
                self.follower.at = place;
                self.note();
            }
            if is_free {
                self.follower = Follower::new(self.follower.at, nearest);
                return Ok(if is_end { Left::AtEnd } else { Left::OnCourse });
            }
            if !is_new {
                return Ok(Left::Enclosed);
            }
        }
    }
}

/// Pairs a part with a circle around it.
fn with_circle(part: &Part) -> (&Part, Point, f64) {
    let middle = part.middle();
    let corners = part.corners().into_iter();
    let radius_m = corners.map(|(at, radius_m)| (at - middle).norm() + radius_m).fold(0.0, f64::max);
    (part, middle, radius_m)
}
