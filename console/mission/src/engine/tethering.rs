//! What one tick does to the tether, and what the tether does to the mission.

use super::{Mission, Phase, SAME_PLACE_M};
use crate::{
    event::{EventKind, HoldReason, Outcome, TetherAlarm},
    task::Task,
    tether::{Tether, ends_at_anchor, way_home_ends},
};
use planner_api::{Plan, Reason};
use world::{Point, polyline, tether::crossings};

/// So often a cable is eased by itself that holds the robot in one place while little is scanned.
const MOST_TIMES_CAUGHT: usize = 2;
/// Share of the reachable floor that is worth another try.
const WORTH_IT: f64 = 0.01;

/// A robot without a way home that nobody attends waits this long for one, seconds.
const WAIT_FOR_HOME_S: f64 = 30.0;

/// A robot this near to the anchor needs no way home, metres.
const HOME_M: f64 = 0.3;

/// The cable held the robot.
#[derive(Clone, Copy)]
pub(super) struct Caught {
    at: Point,
    /// Share of the reachable floor scanned when it first did so there.
    scanned: f64,
    times: usize,
}

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
    pub(super) fn drag_tether(&mut self, map_changed: bool, paid_out_m: Option<f64>) {
        let Some(tether) = &mut self.tether else { return };
        let world = self.chart.world();
        if map_changed {
            tether.lay_anew(world);
        }
        // A lost position would wind the cable round whatever the estimate strays past.
        let error_m = (!self.locator.is_lost()).then(|| self.locator.error_95_m());
        if error_m.is_some() {
            tether.drag_to(self.locator.position());
        }
        tether.measure(paid_out_m, error_m, self.config.tick_s);
        let told = tether.tell(world, self.chart.map(), self.config.tick_s);
        self.cable_trouble = told.iter().find_map(|event| match event {
            EventKind::TetherAlarmed { alarm, reached: true } => Some(alarm.clone()),
            _ => None,
        });
        self.happened.extend(told);
        if map_changed {
            self.doubt_plan();
        }
        self.watch_cuts();
    }

    /// What was found may stand beside the rest of the plan and yet in the way of its cable: then it is planned anew.
    fn doubt_plan(&mut self) {
        let Some(tether) = self.tether.as_ref().filter(|tether| !tether.flies_uncertified()) else { return };
        let Some(rest) = self.task.lanes_left().filter(|_| self.planner.plan_due.is_none()) else { return };
        if !tether.bears(rest, self.chart.world(), self.task_ends_at_anchor()) {
            self.planner.plan_due = Some(Reason::MapChanged);
        }
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
        let anchor = self.tether.as_ref().map(Tether::anchor);
        let lines = if anchor.is_some() { plan.cuts.as_slice() } else { &[] };
        let from = anchor.map_or(0, |anchor| way_home_ends(plan, anchor));
        self.cuts = Cuts {
            lines: lines.iter().map(|line| (line.clone(), false)).collect(),
            from: plan.path.get(from).copied(),
            seen_at: self.locator.position(),
        };
    }

    /// The way back along the cable, as wide as possible; `None` at the anchor, or if there is none.
    pub(super) fn way_to_anchor(&self) -> Option<Vec<Point>> {
        let (here, tether) = (self.locator.position(), self.tether.as_ref()?);
        let is_out = self.task_ends_at_anchor() && (here - tether.anchor()).norm() > HOME_M;
        if is_out { self.widest(|room_m| tether.way_home(self.chart.world(), room_m)) } else { None }
    }

    /// The way that frees a caught cable and reels it in, as wide as possible; `None` unless it is caught.
    pub(super) fn way_out(&self) -> Option<Vec<Point>> {
        let tether = self.tether.as_ref().filter(|tether| tether.is_caught())?;
        if self.plans_ways_home() {
            self.widest(|room_m| tether.way_out(self.chart.world(), room_m))
        } else {
            None
        }
    }

    /// The first way there is with less and less room beside the hull.
    fn widest(&self, way: impl Fn(f64) -> Option<Vec<Point>>) -> Option<Vec<Point>> {
        let rooms =
            [1.0, 0.5, 0.0].map(|share| share * self.config.clearance_m + self.config.limits.radius_m);
        rooms.into_iter().find_map(way)
    }

    /// Whether the mission puts ways home along the cable before plans.
    fn plans_ways_home(&self) -> bool {
        matches!(self.task, Task::Cover(_)) && self.task_ends_at_anchor()
    }

    /// The tether's rule for a moving robot: whether it was held or the mission ended.
    pub(super) fn watch_tether(&mut self) -> bool {
        let Some(alarm) = self.cable_trouble.take() else { return false };
        let message = alarm.to_string();
        match alarm {
            TetherAlarm::Reel { .. } => self.hold_by_cable(message, Outcome::Aborted),
            TetherAlarm::Wrap { .. } | TetherAlarm::SumOfWraps { .. } | TetherAlarm::Snag { .. } => {
                self.hold_by_cable(message, Outcome::Entangled);
            }
            // What closed the way may move on.
            TetherAlarm::NoWayHome | TetherAlarm::Strayed => {
                self.waits_for_home_s = Some(0.0);
                self.hold(HoldReason::Tether { message });
            }
        }
        true
    }

    /// A cable at its limits, or caught, holds the robot. Lanes are planned anew from there, after a way that eases the
    /// cable; with nobody there this is tried a few times in one place, and more often while floor is scanned in between; else
    /// the mission ends.
    fn hold_by_cable(&mut self, message: String, outcome: Outcome) {
        let (at, scanned) = (self.locator.position(), self.coverage.fraction_reachable());
        let again = self
            .caught
            .filter(|last| (at - last.at).norm() < SAME_PLACE_M && scanned - last.scanned < WORTH_IT);
        let times = again.map_or(0, |last| last.times);
        self.caught = Some(Caught { times: times + 1, ..again.unwrap_or(Caught { at, scanned, times }) });
        let plans_anew = self.plans_ways_home() && times < MOST_TIMES_CAUGHT;
        if plans_anew {
            self.planner.plan_due.get_or_insert(Reason::Blocked);
        }
        if plans_anew || self.config.attended {
            self.waits_for_home_s = (!self.config.attended).then_some(0.0);
            self.hold(HoldReason::Tether { message });
        } else {
            self.end(outcome, &format!("nobody attended the hold: {message}"));
        }
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
