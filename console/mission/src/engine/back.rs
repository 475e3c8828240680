//! The drive back to the anchor or the start, by order of the operator. The mission itself drives: no planner is asked,
//! so that the robot comes home even if every planner has failed.
//!
//! The way is fixed when the order is accepted, and is searched for again only if something new is in the way. The rules
//! for a running robot apply, but every hold ends only by order. After a hold, the operator may order the drive again, or
//! resume the mission; the planner then makes a new plan from there.

mod dead_ends;
mod escape;
mod way;

pub(super) use dead_ends::DeadEnds;

use super::{Mission, known::Known};
use crate::{
    event::{EventKind, OfferEnd},
    order::Order,
    phase::{Gait, Hold, HoldReason, Outcome, Phase, Resumes},
    task::CornerPatience,
    tether::Tether,
    way_back::{Home, WayBack},
};
use geometry::{Braking, PathFollower};
use planner_api::{Command, Drive, Reason};
use world::Point;

/// Distance from the end of the way within which the robot counts as back, metres.
const THERE_M: f64 = 0.1;
/// Speed at corners and at the end of the way, metres per second.
const SLOW_M_PER_S: f64 = 0.05;

/// A drive back that was ordered.
#[derive(Clone)]
pub(super) struct Back {
    to: Home,
    follower: PathFollower,
    at_corner: CornerPatience,
    /// Whether the way leads beside a tether that lies on the floor.
    is_beside: bool,
    /// Highest speed on the way, metres per second.
    fastest_m_per_s: f64,
}

impl Back {
    fn along(way: &WayBack, v_max_m_per_s: f64) -> Self {
        let follower = PathFollower::exact(&way.path);
        let (is_beside, fastest_m_per_s) = (way.slack_m.is_some(), way.fastest_m_per_s(v_max_m_per_s));
        Self { to: way.to, follower, at_corner: CornerPatience::default(), is_beside, fastest_m_per_s }
    }

    /// The point to drive to.
    pub(super) fn target(&self) -> Point {
        self.follower.target()
    }

    /// Remaining length of the way, metres.
    pub(super) fn left_m(&self, here: Point) -> f64 {
        self.follower.left_m(here)
    }

    /// Whether the robot is back.
    pub(super) fn is_done(&self, here: Point) -> bool {
        self.follower.is_done(here, THERE_M)
    }
}

impl Mission {
    /// The way back from the place where the robot is held, with its length and clearance: the way that
    /// [`Order::DriveBack`] would take now.
    ///
    /// Cost: a few searches for a path on the map, each bounded.
    ///
    /// # Errors
    /// The reason why the order would be refused, as a sentence.
    pub fn way_back(&self) -> Result<WayBack, String> {
        self.standing().allows(&Order::DriveBack).map_err(|why| why.to_string())?;
        self.known.way_back()
    }

    /// Whether a held robot has not come to a stop yet: its way back begins where it will stand.
    pub fn is_braking(&self) -> bool {
        matches!(self.known.phase, Phase::Held(_)) && self.known.speed_m_per_s() != 0.0
    }

    /// Whether the reel of the tether is known to have stopped: it does not take the tether up.
    pub fn has_reel_stopped(&self) -> bool {
        self.known.tether.as_ref().is_some_and(Tether::has_reel_stopped)
    }

    /// Begins to drive back. The planner's plan and any candidate are dropped.
    pub(super) fn drive_back(&mut self) {
        // The order is accepted only if there is a way.
        let Ok(way) = self.known.way_back() else { return };
        self.drop_better_plan(OfferEnd::DrivingBack);
        self.better_plan_due_s = None;
        self.reject_preparing("the robot is driving back");
        self.end_shadow();
        self.driving.course.cuts.clear();
        self.take_way_back(way);
        self.resume(Gait::Back);
    }

    fn take_way_back(&mut self, way: WayBack) {
        if let (Some(tether), Some(_)) = (&mut self.known.tether, way.slack_m) {
            tether.leave_lying();
        }
        self.known.back = Some(Back::along(&way, self.known.config.limits.v_max_m_per_s));
        self.happened.push(EventKind::ReturnBegan { way });
    }

    /// Searches for a different way back if a new obstacle or zone blocks the current one. If none is found, holds the
    /// robot.
    pub(super) fn doubt_way_back(&mut self) {
        if !self.known.phase.is_return() || self.known.is_way_back_free() {
            return;
        }
        match self.known.way_back() {
            Ok(way) => self.take_way_back(way),
            Err(why) => {
                let by = HoldReason::Stuck { message: format!("no way back: {why}") };
                self.hold(Hold { by, resumes: Resumes::Never });
            }
        }
    }

    /// The drive for this tick along the way back.
    pub(super) fn drive_along_way_back(&mut self) -> Drive {
        if !self.known.knows_medium() {
            return Drive::STILL;
        }
        let Some(wanted) = self.known.command_back() else { return Drive::STILL };
        let (sent, limits) = self.known.made_safe(wanted);
        let asked = (sent != wanted).then_some(wanted);
        self.happened.push(EventKind::Commanded { ask: None, command: sent, asked });
        self.happened.extend(limits.into_iter().flatten());
        sent.drive
    }

    /// Ends the mission of a robot that is back.
    pub(super) fn end_back(&mut self) {
        let Some(back) = &self.known.back else { return };
        let place = if back.is_beside { "beside the anchor" } else { back.to.at() };
        let done = format!("ended by operator: robot is back {place}");
        let tether = self.known.tether.as_ref().filter(|_| back.to == Home::Anchor);
        let lies = tether.filter(|_| back.is_beside).map_or_else(String::new, Tether::lies_words);
        let left = tether.and_then(|tether| {
            // A torn cable does not lead to the robot, so it is not hooked around anything.
            let is_whole = tether.torn().is_none();
            let left = is_whole.then(|| tether.left_out(self.known.cable_world())).flatten();
            left.or_else(|| tether.left_by_encoder())
        });
        match left {
            Some(why) => self.end(Outcome::Entangled, format!("{done}, but {why}{lies}")),
            None => self.end(Outcome::Aborted, format!("{done}{lies}")),
        }
    }

    /// Forgets a drive back that was broken off: the planner plans again from here.
    pub(super) fn leave_way_back(&mut self) {
        if self.known.back.take().is_some() {
            self.known.dead_ends.open();
            self.known.tether.iter_mut().for_each(Tether::forget_lying);
            self.driving.course.cuts.clear();
            self.driving.course.want_plan(Reason::Operator);
        }
    }
}

impl Known {
    /// Closes the place where the robot got stuck on its way beside the tether, so that another way is searched for.
    pub(super) fn close_dead_end(&mut self) {
        let Some(back) = self.back.as_ref().filter(|back| back.is_beside) else { return };
        let (here, to, hull_m) = (self.locator.position(), back.target(), self.config.limits.radius_m);
        self.dead_ends.close(here, to, hull_m);
    }

    /// Advances along the way back; the command for this tick, in the form in which the robot receives it.
    fn command_back(&mut self) -> Option<Command> {
        self.keep_trail();
        let (here, passed_s) = (self.position(), self.config.tick_s * self.briskness());
        let (back, map) = (self.back.as_mut()?, self.chart.map());
        back.follower.advance(here, |at| map.clearance_m(at) >= 0.0);
        back.at_corner.wait(&mut back.follower, here, passed_s);
        let onward = back.follower.target() - here;
        let braking = Braking::of(&self.config.limits);
        let before = |way_m: f64| braking.speed_before(way_m, SLOW_M_PER_S);
        let to_corner = back.follower.corner_m(here).map_or(f64::INFINITY, before);
        let fastest = back.fastest_m_per_s;
        let speed = before(back.follower.left_m(here) - THERE_M).min(to_corner).min(fastest);
        let velocity = onward.try_normalize(1e-9).map_or(onward, |direction| direction * speed);
        Some(self.sending().as_sent(Command::velocity(velocity)))
    }
}
