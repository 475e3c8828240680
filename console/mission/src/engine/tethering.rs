//! What one tick does to the tether, and what the tether does to the mission.

use super::{Mission, Phase};
use crate::{
    event::{EventKind, HoldReason, Outcome, TetherAlarm},
    tether::{Tether, ends_at_anchor},
};
use planner_api::Reason;
use world::{Point, polyline, tether::crossings};

/// A robot without a way home that nobody attends waits this long for one, seconds.
const WAIT_FOR_HOME_S: f64 = 30.0;

/// The lines that the plan never crosses, and whether the robot has.
pub(super) struct Cuts {
    pub lines: Vec<Vec<Point>>,
    pub beyond: bool,
    pub seen_at: Point,
}

impl Mission {
    /// Drags the cable along, and holds the robot when it may go no further.
    pub(super) fn drag_tether(&mut self, map_changed: bool) {
        let Some(tether) = &mut self.tether else { return };
        let world = self.chart.world();
        if map_changed {
            tether.lay_anew(world);
        }
        // A lost position would wind the cable round whatever the estimate strays past.
        if !self.locator.is_lost() {
            tether.drag_to(self.locator.position());
        }
        let told = tether.tell(world, self.chart.map(), self.config.tick_s);
        self.cable_trouble = told.iter().find_map(|event| match event {
            EventKind::TetherAlarmed { alarm, reached: true } => Some(alarm.clone()),
            _ => None,
        });
        self.happened.extend(told);
        self.watch_cuts();
    }

    /// A robot that has come off its plan across a cut would wind the cable on its way back to it: it is planned anew,
    /// from the cable as it lies. On the line itself the estimate may scatter from side to side.
    fn watch_cuts(&mut self) {
        if self.locator.is_lost() {
            return;
        }
        let here = self.locator.position();
        let crossed = crossings(&[self.cuts.seen_at, here], &self.cuts.lines);
        self.cuts.seen_at = here;
        self.cuts.beyond ^= crossed % 2 == 1;
        let clear_m =
            self.cuts.lines.iter().map(|cut| polyline::distance_m(cut, here)).fold(f64::INFINITY, f64::min);
        if self.cuts.beyond && clear_m > self.config.limits.radius_m && self.planner.plan_due.is_none() {
            self.happened.push(EventKind::TetherAlarmed { alarm: TetherAlarm::Strayed, reached: false });
            self.planner.plan_due = Some(Reason::MapChanged);
            self.cuts.lines.clear();
            self.cuts.beyond = false;
        }
    }

    /// Keeps the cuts of a plan that flies.
    pub(super) fn keep_to(&mut self, cuts: Vec<Vec<Point>>) {
        self.cuts = Cuts { lines: cuts, beyond: false, seen_at: self.locator.position() };
        if self.tether.is_none() {
            self.cuts.lines.clear();
        }
    }

    /// The tether's rule for a moving robot: whether it was held or the mission ended.
    pub(super) fn watch_tether(&mut self) -> bool {
        let Some(alarm) = self.cable_trouble.take() else { return false };
        let message = alarm.to_string();
        let outcome = match alarm {
            TetherAlarm::Reel { .. } => Outcome::Aborted,
            TetherAlarm::Wrap { .. } | TetherAlarm::SumOfWraps { .. } => Outcome::Entangled,
            // What closed the way may move on.
            TetherAlarm::NoWayHome | TetherAlarm::Strayed => {
                self.waits_for_home_s = Some(0.0);
                self.hold(HoldReason::Tether { message });
                return true;
            }
        };
        if self.config.attended {
            self.hold(HoldReason::Tether { message });
        } else {
            self.end(outcome, &format!("nobody attended the hold: {message}"));
        }
        true
    }

    /// A robot that is held because it had no way home goes on when there is one; with nobody there to help the mission
    /// ends after a while.
    pub(super) fn watch_way_home(&mut self) {
        let Some(waited_s) = self.waits_for_home_s else { return };
        if self.tether.as_ref().is_none_or(Tether::can_go_home) {
            self.go_on(Phase::Running);
        } else if !self.config.attended && waited_s >= WAIT_FOR_HOME_S {
            let message = TetherAlarm::NoWayHome.to_string();
            self.end(Outcome::Entangled, &format!("nobody attended the hold: {message}"));
        } else {
            self.waits_for_home_s = Some(waited_s + self.config.tick_s);
        }
    }

    /// How a task that is done ends: with the robot back at the anchor and cable left out it is entangled.
    pub(super) fn end_done(&mut self) {
        let back = self.task_ends_at_anchor();
        let left = self.tether.as_ref().filter(|_| back).and_then(|t| t.left_out(self.chart.world()));
        match left {
            Some(why) => self.end(Outcome::Entangled, &format!("back at the anchor, but {why}")),
            None => self.end(Outcome::Complete, &self.done_reason()),
        }
    }

    /// Judges a plan; tells the judgement, and why the plan does not fly if it does not.
    pub(super) fn judge_plan(&mut self, path: &[Point], cuts: &[Vec<Point>]) -> Result<(), String> {
        let returns = self.task_ends_at_anchor();
        let Some(tether) = &self.tether else { return Ok(()) };
        let certificate = tether.certify(path, cuts, self.chart.world(), returns);
        let refused = !certificate.certified && !tether.flies_uncertified();
        let why = certificate.reasons.join("; ");
        let planner = self.planner.choice.id.clone();
        self.happened.push(EventKind::Certified { planner: planner.clone(), refused, certificate });
        if refused { Err(format!("the plan of {planner} is not safe for the tether: {why}")) } else { Ok(()) }
    }

    fn task_ends_at_anchor(&self) -> bool {
        self.config.tether.as_ref().is_some_and(|tether| ends_at_anchor(tether, &self.config))
    }
}
