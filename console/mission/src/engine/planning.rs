//! Who plans: seating a planner, asking it for a plan, replacing one that failed.

use super::{Mission, Phase};
use crate::{
    config::PlannerChoice,
    event::{EventKind, HoldReason, Outcome},
    follower::Follower,
    planner::{Cause, Fault, PlannerLink, Reply},
};
use planner_api::{Leg, LegTag, Plan, PlanRequest, PoseEstimate, Reason};
use world::{Point, polyline};

/// A plan shorter than this leads nowhere, metres.
const NO_WAY_M: f64 = 0.01;

impl Mission {
    /// Loads and configures a planner; on a fault the one before stays.
    pub(super) fn seat(
        &mut self,
        choice: PlannerChoice,
        planner: &mut dyn PlannerLink,
    ) -> Result<(), String> {
        match self.chart.with_site(|site| planner.choose(&choice.id, &choice.parameters, site)) {
            Ok(info) => {
                let from = self.planner.info.replace(info.clone()).map(|before| before.id);
                self.planner.choice = choice.clone();
                self.planner.fit = true;
                self.happened.push(EventKind::PlannerChosen { choice, info: Box::new(info), from });
                Ok(())
            }
            Err(fault) => Err(self.note_fault(fault)),
        }
    }

    /// Loads and configures a planner that the operator wants. One that is refused has not failed: the refusal of
    /// the order tells all there is.
    pub(super) fn seat_by_order(
        &mut self,
        choice: &PlannerChoice,
        planner: &mut dyn PlannerLink,
    ) -> Result<(), String> {
        let told = self.happened.len();
        let seated = self.seat(choice.clone(), planner);
        let is_refusal = |kind: &EventKind| matches!(kind, EventKind::PlannerFailed { fault } if fault.cause == Cause::Refused);
        if seated.is_err() && self.happened.last().is_some_and(is_refusal) {
            self.happened.truncate(told);
        }
        seated
    }

    /// Makes sure that a planner is there and has planned.
    pub(super) fn make_planner_fit(&mut self, planner: &mut dyn PlannerLink) -> Result<(), String> {
        if !self.planner.fit {
            if self.planner.info.is_some() {
                self.planner.plan_due = Some(Reason::Recover);
            }
            self.seat(self.planner.choice.clone(), planner)?;
        }
        self.plan_if_due(planner)
    }

    /// Asks for a plan if one is due.
    ///
    /// A plan that is refused because of the cable out there is asked for once more from the anchor, after a way back
    /// along the cable: no planner has to know how the cable lies. A cable that is caught is freed first.
    pub(super) fn plan_if_due(&mut self, planner: &mut dyn PlannerLink) -> Result<(), String> {
        let Some(reason) = self.planner.plan_due.clone() else { return Ok(()) };
        self.planner.refused = false;
        if let Some(way_out) = self.way_out() {
            return self.ask_for_plan(&reason, &way_out, planner);
        }
        let from_here = self.ask_for_plan(&reason, &[], planner);
        let way_home = if self.planner.refused { self.way_to_anchor() } else { None };
        way_home.map_or(from_here, |way| self.ask_for_plan(&reason, &way, planner))
    }

    /// Asks for a plan from the end of a way home, or from where the robot stands.
    fn ask_for_plan(
        &mut self,
        reason: &Reason,
        way_home: &[Point],
        planner: &mut dyn PlannerLink,
    ) -> Result<(), String> {
        let here = self.locator.pose_estimate();
        let start = way_home.last().map_or(here, |home| PoseEstimate { position: *home, ..here });
        let regions = self.task.regions_left(&self.coverage, self.config.lane_m());
        let regions: Vec<&[Point]> = regions.iter().map(Vec::as_slice).collect();
        let task = self.task.as_request(&regions, self.config.tether_limits());
        let previous: Vec<Point> = self.trail.iter().chain(way_home).copied().collect();
        let answer = self
            .chart
            .with_site(|site| planner.plan(&PlanRequest { reason, start, task, site, previous: &previous }));
        match answer {
            Ok(reply) => self.accept_plan(reason.clone(), after(way_home, reply)),
            Err(fault) => {
                self.planner.refused = false;
                Err(self.note_fault(fault))
            }
        }
    }

    /// Takes a plan to be flown, unless it cannot be certified for the tether.
    fn accept_plan(&mut self, reason: Reason, reply: Reply<Plan>) -> Result<(), String> {
        let plan = reply.value.clone();
        self.happened.push(EventKind::Planned {
            planner: self.planner.choice.id.clone(),
            reason,
            length_m: polyline::length_m(&plan.path),
            path: plan.path.clone(),
            complete: plan.complete,
            legs: plan.legs.clone(),
            cuts: plan.cuts.clone(),
        });
        let safe = self.judge_plan(&plan);
        self.planner.refused = safe.is_err();
        let judged = safe.and_then(|()| self.judge_way(&plan));
        if judged.is_ok() {
            self.planner.plan_due = None;
            self.task.take_plan(&plan);
            self.plan_is_whole = plan.complete;
            // What is left is counted anew along the new plan.
            self.stuck.reset();
            self.keep_to(&plan);
            self.plan = (!plan.path.is_empty()).then(|| Follower::new(plan.path));
        }
        self.pass_on(reply);
        judged
    }

    /// Refuses a plan that leads nowhere while there is floor to scan and none of it has been scanned: the robot would
    /// be back at the anchor at once, and the mission complete.
    fn judge_way(&self, plan: &Plan) -> Result<(), String> {
        let leads_nowhere = polyline::length_m(&plan.path) < NO_WAY_M;
        let has_scanned = self.coverage.counts().covered > 0;
        let left = self.task.floor_left(&self.coverage).len();
        match left as f64 * self.coverage.floor().cell_m2() {
            left_m2 if leads_nowhere && !has_scanned && left_m2 > 0.0 => Err(format!(
                "the plan of {} scans nothing of the {left_m2:.2} m² to be scanned: no lane reaches them; another planner, less \
                 mission.overlap_m or other mission.boxes_m may",
                self.planner.choice.id
            )),
            _ => Ok(()),
        }
    }

    /// Tells what the planner drew, reported and said besides its answer.
    pub(super) fn pass_on<T>(&mut self, reply: Reply<T>) {
        if !reply.drawings.is_empty() {
            self.happened.push(EventKind::Drawn { drawings: reply.drawings });
        }
        if !reply.scalars.is_empty() {
            self.happened.push(EventKind::Scalars { scalars: reply.scalars });
        }
        for (level, message) in reply.logs {
            let planner = self.planner.choice.id.clone();
            self.happened.push(EventKind::PlannerSaid { planner, level, message });
        }
    }

    /// Tells a fault and returns its sentence. A planner that said no by itself can be asked again.
    pub(super) fn note_fault(&mut self, fault: Fault) -> String {
        let ours = fault.planner == self.planner.choice.id;
        if ours && !matches!(fault.cause, Cause::Planner(_) | Cause::Refused) {
            self.planner.fit = false;
        }
        let message = fault.message.clone();
        self.happened.push(EventKind::PlannerFailed { fault });
        message
    }

    /// After a fault: the fallback takes over, if there is one; with nobody there to help the mission ends.
    pub(super) fn replace_failed_planner(&mut self, message: &str, planner: &mut dyn PlannerLink) {
        let fallback = self.config.fallback.clone().filter(|choice| choice.id != self.planner.choice.id);
        match fallback {
            Some(choice) if !self.planner.fallback_used => {
                self.planner.fallback_used = true;
                let from = self.planner.choice.id.clone();
                self.planner.plan_due = Some(Reason::Swap { from });
                if self.seat(choice, planner).and_then(|()| self.plan_if_due(planner)).is_ok() {
                    self.go_on(Phase::Running);
                }
            }
            _ if !self.config.attended => {
                self.end(Outcome::Aborted, &format!("nobody attended the hold: {message}"));
            }
            _ => {}
        }
    }

    /// Stands still because of the planner.
    pub(super) fn hold_for_planner(&mut self, message: String) {
        self.hold(if self.planner.refused {
            HoldReason::PlanRefused { message }
        } else {
            HoldReason::PlannerFault { message }
        });
    }
}

/// A plan with a way home before it.
fn after(way_home: &[Point], mut reply: Reply<Plan>) -> Reply<Plan> {
    let Some(last) = way_home.len().checked_sub(1) else { return reply };
    let plan = &mut reply.value;
    let shifted = |leg: &Leg| Leg { first: leg.first + last + 1, last: leg.last + last + 1, ..*leg };
    let retract = Leg { tag: LegTag::Retract, first: 0, last };
    plan.legs = std::iter::once(retract).chain(plan.legs.iter().map(shifted)).collect();
    plan.path.splice(0..0, way_home.iter().copied());
    reply
}
