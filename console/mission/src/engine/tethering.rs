//! Updates the tether in each tick, and finds the return paths along it.

use super::{Mission, happened::Happened, known::Known, rules::HOME_M, surveying::Surveying};
use crate::{
    event::{EventKind, TetherAlarm},
    phase::{Gait, Hold, HoldReason, Outcome, Phase, Resumes},
};
use world::{Point, Readings};

/// Room beside the clearance, metres, for the errors with which a way is followed and for the noise of the scanner: the raw
/// scan stops the robot before it comes closer than the clearance needs.
const GUARD_SPARE_M: f64 = 0.05;

impl Known {
    /// Moves the cable along with the robot; returns the limit reached in this tick, or the break of a torn cable.
    pub(super) fn drag_tether(
        &mut self,
        map_changed: bool,
        readings: &Readings,
        happened: &mut Happened,
    ) -> Option<TetherAlarm> {
        self.tether.as_ref()?;
        if map_changed {
            self.lay_cable_again();
        }
        let (tether, ground) = (self.tether.as_mut()?, self.survey.as_ref().map(Surveying::ground));
        let (world, map) = match ground {
            Some(ground) => (ground.world(), ground.map()),
            None => (self.chart.world(), self.chart.map()),
        };
        // If the position is lost, moving the cable would wind it round obstacles that only the estimate has passed.
        let error_m = (!self.locator.is_lost()).then(|| self.locator.error_95_m());
        if error_m.is_some() {
            tether.drag_to(self.locator.position());
        }
        tether.measure(readings, error_m, world, self.config.tick_s);
        self.resting = match self.resting.take() {
            _ if !matches!(self.phase, Phase::Held(_)) => None,
            Some(before) if !map_changed && tether.is_as_before(&before) => Some(before),
            _ => Some(tether.clone()),
        };
        let events = tether.update(world, map, self.config.tick_s);
        let reached = events.iter().find_map(|event| match event {
            EventKind::TetherAlarmRaised { alarm, reached: true } => Some(alarm.clone()),
            _ => None,
        });
        let reached = reached.or_else(|| tether.torn());
        happened.extend(events);
        reached
    }

    /// Lays the cable among the obstacles known now.
    fn lay_cable_again(&mut self) {
        if self.survey.is_some() {
            self.refresh_ground();
        } else if let Some(tether) = &mut self.tether {
            tether.lay_again(self.chart.world());
        }
    }

    /// Cable beyond the taut line, metres, that a stopped reel has left on the floor, if the robot would come near it before it
    /// could stop.
    pub(super) fn cable_left_ahead_m(&self) -> Option<f64> {
        let tether = self.tether.as_ref().filter(|_| !self.locator.is_lost())?;
        tether.is_left_before(self.stops_at(), self.cable_world()).then(|| tether.excess_m())
    }

    /// Sets whether plans are run even if they are refused for the tether.
    pub(super) fn allow_uncertified(&mut self, fly: bool) {
        if let Some(tether) = &mut self.tether {
            tether.allow_uncertified(fly);
        }
    }

    /// Returns the way home along the cable with the most room for the hull; `None` at the anchor, or without a return path.
    pub(super) fn way_to_anchor(&self) -> Option<Vec<Point>> {
        let (here, tether) = (self.locator.position(), self.tether.as_ref()?);
        let is_out = self.task_ends_at_anchor() && (here - tether.anchor()).norm() > HOME_M;
        if is_out { self.widest(|room_m| tether.way_home(self.chart.world(), room_m)) } else { None }
    }

    /// The path that frees a caught cable and reels it in, with the most room, or the path that makes a slack cable taut;
    /// `None` if the cable is neither.
    pub(super) fn way_out(&self) -> Option<Vec<Point>> {
        let tether = self.tether.as_ref().filter(|_| self.plans_ways_home())?;
        if tether.is_snagged() {
            self.widest(|room_m| tether.way_out(self.chart.world(), room_m))
        } else {
            tether.way_to_tauten()
        }
    }

    /// Searches for a path with decreasing amounts of room beside the hull; returns the first path found.
    pub(super) fn widest(&self, way: impl FnMut(f64) -> Option<Vec<Point>>) -> Option<Vec<Point>> {
        let rooms =
            [1.0, 0.5, 0.0].map(|share| share * self.config.clearance_m + self.config.limits.radius_m);
        let is_guarded = self.config.guard_reaction_s.is_some();
        is_guarded.then(|| self.guarded_room_m()).into_iter().chain(rooms).find_map(way)
    }

    /// Room for the hull's centre on a way on which the guard does not stop the robot, metres.
    pub(super) fn guarded_room_m(&self) -> f64 {
        self.config.room_m() + GUARD_SPARE_M
    }
}

impl Mission {
    /// Holds a running robot whose return path is blocked until the path is free again. Meanwhile, no plan that leads back along
    /// the tether can be certified, whichever planner makes it. Returns whether the robot is held for this reason.
    pub(super) fn waits_for_return_path(&mut self) -> bool {
        let is_blocked = self.known.tether.as_ref().is_some_and(|tether| !tether.can_go_home());
        let waits = is_blocked && matches!(self.known.phase, Phase::Running(gait) if gait != Gait::Back);
        if waits {
            let by = HoldReason::Tether { message: TetherAlarm::NoReturnPath.to_string() };
            self.hold(Hold { by, resumes: Resumes::WhenCleared });
        }
        waits
    }

    /// Whether the hull fits through the return path along the tether. Before a robot that waits for this resumes with a new
    /// plan, the return path must have the room that the certificate of the plan demands.
    pub(super) fn can_go_home(&self) -> bool {
        let Some(tether) = &self.known.tether else { return true };
        let by = HoldReason::Tether { message: TetherAlarm::NoReturnPath.to_string() };
        let waits = matches!(&self.known.phase, Phase::Held(hold) if hold.by == by);
        let room_m = self.known.config.limits.radius_m;
        let has_room = || tether.return_path(self.known.chart.world(), room_m).is_some();
        tether.can_go_home() && (!waits || self.driving.course.due.is_none() || has_room())
    }

    /// Ends a task that is done. If the robot is back at the anchor but cable is still out, the outcome is entangled.
    pub(super) fn end_done(&mut self) {
        let back = self.known.task_ends_at_anchor();
        let left =
            self.known.tether.as_ref().filter(|_| back).and_then(|t| t.left_out(self.known.cable_world()));
        match left {
            Some(why) => self.end(Outcome::Entangled, format!("back at the anchor, but {why}")),
            None => self.end(Outcome::Complete, self.known.done_reason(self.driving.course.is_whole())),
        }
    }
}
