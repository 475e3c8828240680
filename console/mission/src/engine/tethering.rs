//! What one tick does to the tether, and what the tether does to the mission.

use super::{Mission, Phase};
use crate::{
    event::{EventKind, HoldReason, Outcome, TetherAlarm},
    tether::{Tether, ends_at_anchor, way_home_ends},
};
use planner_api::{Plan, Reason};
use world::{Point, polyline, tether::crossings};

/// A robot without a way home that nobody attends waits this long for one, seconds.
const WAIT_FOR_HOME_S: f64 = 30.0;

/// A robot this near to the anchor needs no way home, metres.
const HOME_M: f64 = 0.3;

/// The lines that the plan never crosses, and whether the robot has.
#[derive(Default)]
pub(super) struct Cuts {
    /// Each with whether the robot is beyond it.
    lines: Vec<(Vec<Point>, bool)>,
    /// Where the plan is bound to them from, after a way home; `None` once the robot has been there.
    from: Option<Point>,
    seen_at: Point,
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
        let before = std::mem::replace(&mut self.cuts.seen_at, here);
        if self.cuts.from.is_some_and(|from| (here - from).norm() > HOME_M) {
            return;
        }
        self.cuts.from = None;
        for (line, is_beyond) in &mut self.cuts.lines {
            *is_beyond ^= crossings(&[before, here], std::slice::from_ref(line)) % 2 == 1;
        }
        let radius_m = self.config.limits.radius_m;
        let has_strayed = |(line, is_beyond): &(Vec<Point>, bool)| {
            *is_beyond && polyline::distance_m(line, here) > radius_m
        };
        if self.planner.plan_due.is_none() && self.cuts.lines.iter().any(has_strayed) {
            self.happened.push(EventKind::TetherAlarmed { alarm: TetherAlarm::Strayed, reached: false });
            self.planner.plan_due = Some(Reason::MapChanged);
            self.cuts.lines.clear();
        }
    }

    /// Keeps the cuts of a plan that flies.
    pub(super) fn keep_to(&mut self, plan: &Plan) {
        let lines = if self.tether.is_some() { plan.cuts.as_slice() } else { &[] };
        self.cuts = Cuts {
            lines: lines.iter().map(|line| (line.clone(), false)).collect(),
            from: plan.path.get(way_home_ends(plan)).copied(),
            seen_at: self.locator.position(),
        };
    }

    /// The way back along the cable, as wide as possible; `None` at the anchor, or if there is none.
    pub(super) fn way_to_anchor(&self) -> Option<Vec<Point>> {
        let (here, tether) = (self.locator.position(), self.tether.as_ref()?);
        let is_out = self.task_ends_at_anchor() && (here - tether.anchor()).norm() > HOME_M;
        let rooms =
            [1.0, 0.5, 0.0].map(|share| share * self.config.clearance_m + self.config.limits.radius_m);
        let world = self.chart.world();
        rooms.iter().filter(|_| is_out).find_map(|room_m| tether.way_home(world, *room_m))
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
    pub(super) fn judge_plan(&mut self, plan: &Plan) -> Result<(), String> {
        let returns = self.task_ends_at_anchor();
        let Some(tether) = &self.tether else { return Ok(()) };
        let certificate = tether.certify(plan, self.chart.world(), returns);
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
