//! The effect of each order. [`Standing::allows`](crate::Standing::allows) alone decides whether an order is accepted.

use super::{
    Mission,
    driving::{Driving, Prepare},
    role::Candidate,
    shadow::Shadow,
};
use crate::{
    event::{EventKind, OfferEnd},
    order::Order,
    phase::{Gait, Hold, HoldReason, Outcome, Phase, Resumes},
    planner::{ParamValue, PlannerChoice},
    standing::NEAR_PLAN_M,
};
use planner_api::Reason;

impl Mission {
    pub(super) fn obey(&mut self, order: &Order) {
        let order = &order.clone().plain();
        // The order precedes its effects in the journal.
        let allowed = self.standing().allows(order).map_err(|why| why.to_string());
        if let Err(why) = allowed.and_then(|()| self.known.check_place(order)) {
            self.happened.push(EventKind::OrderRefused { order: order.clone(), why: why.clone() });
            if order.is_start() && self.known.is_waiting() && !self.known.config.attended {
                self.end(Outcome::Aborted, format!("the mission cannot start: {why}"));
            }
            return;
        }
        self.happened.push(EventKind::Ordered { order: order.clone() });
        match order {
            Order::Plan => self.plan_ahead(),
            Order::Start | Order::StartPlan(_) => self.start(),
            Order::NoteChecks(_) | Order::NoteOutlooks(_) | Order::Note(_) => {}
            // The simulator carries this order out.
            Order::Inject(_) => self.stay_held(),
            Order::UseStation { station, used, .. } => {
                self.known.locator.use_station(*station, *used);
                self.stay_held();
            }
            Order::DrawZone(corners) => self.draw_zone(corners),
            Order::Hold => self.hold_by_order(),
            Order::Resume => self.resume(Gait::Steady),
            Order::Step => self.resume(Gait::OneTick),
            Order::StepTo(to) => {
                self.stepped_from = Some(self.known.place_on_plan());
                self.resume(Gait::To(*to));
            }
            Order::DriveBack => self.drive_back(),
            Order::Abort => self.end(Outcome::Aborted, "ended by operator".into()),
            Order::Terminate => self.end(Outcome::Aborted, "ended by a signal to the process".into()),
            Order::CheckPlanner => {
                self.driving.snapshot_due = self.driving.worker.is_ready();
                self.shadow.iter_mut().for_each(Shadow::check);
            }
            Order::ChoosePlanner(choice) => {
                if self.driving.takes_live(choice) {
                    self.stay_held();
                    self.drop_preparing();
                    self.driving.reconfigure = Some(choice.clone());
                } else {
                    let from = self.driving.id().to_owned();
                    self.choose(choice.clone(), Reason::Swap { from });
                }
            }
            Order::Shadow(choice) => self.begin_shadow(choice.clone()),
            Order::Promote => self.order_promotion(),
            Order::DropShadow => self.end_shadow(),
            Order::TakePlan => self.order_better_plan(),
            Order::SetParameter { key, value } => self.set_parameter(key, value),
            Order::FlyUncertified => {
                self.known.allow_uncertified(true);
                self.resume(Gait::Steady);
            }
        }
    }

    /// The planner makes its plan before the start, so the operator sees the plan before anything moves.
    fn plan_ahead(&mut self) {
        self.driving.course.want_plan(Reason::Start);
        self.driving.prepare = Prepare::Plan;
    }

    fn start(&mut self) {
        self.rules.time_limit.start(self.known.now_s());
        self.known.phase = Phase::Running(Gait::Steady);
    }

    /// From now on, the robot moves only by order; a hold that already ends only by order keeps its reason.
    fn hold_by_order(&mut self) {
        if self.known.phase.may_move() {
            self.hold(Hold { by: HoldReason::Operator, resumes: Resumes::Never });
        }
    }

    /// A hold that would have ended automatically now ends only by order: someone who changes planners or excludes
    /// stations does not expect the robot to start moving.
    pub(super) fn stay_held(&mut self) {
        if let Phase::Held(hold) = &self.known.phase
            && !hold.resumes.is_never()
        {
            self.hold(Hold { by: hold.by.clone(), resumes: Resumes::Never });
        }
    }

    /// Changes to another planner, or to the same one with other parameters.
    ///
    /// The current planner stays until the new one has a plan that may be run. If the current planner could not continue
    /// anyway, it is replaced immediately; the operator can then run the new planner's plan even if it is refused because
    /// of the tether.
    pub(super) fn choose(&mut self, choice: PlannerChoice, reason: Reason) {
        self.stay_held();
        self.cancel_promotion();
        self.drop_better_plan(OfferEnd::OtherPlannerChosen);
        let waiting = self.known.is_waiting();
        let reason = if waiting { Reason::Start } else { reason };
        let goes_on = self.driving.takes_live(&choice).then(|| self.known.task.under_way()).flatten();
        let left = || self.left.as_ref()?.to_go_on_with(&choice, self.known.position(), NEAR_PLAN_M);
        let keep = goes_on.or_else(left);
        let worker = self.driving.worker.successor(choice);
        self.drop_preparing();
        if self.driving.worker.is_ready() && !waiting && !self.driving.has_failed(&self.known) {
            self.driving.snapshot_due = self.driving.can_hand_over_state(worker.id());
            self.preparing = Some(Candidate::prepare(worker, reason, keep));
        } else {
            let prepare = if waiting { Prepare::Open } else { Prepare::Plan };
            self.replace_driving(Driving::new(worker, reason, prepare));
            self.driving.keep = keep;
        }
    }

    /// Replaces the active planner and closes its worker.
    pub(super) fn replace_driving(&mut self, driving: Driving) {
        self.left = self.driving.left_plan(&self.known);
        self.driving.close(&mut self.workers, &mut self.happened);
        self.driving = driving;
    }

    fn set_parameter(&mut self, key: &str, value: &ParamValue) {
        self.drop_better_plan(OfferEnd::ParameterChanged);
        // This is a change on top of one that is still in progress.
        let prepared = self.preparing.as_ref().map(|preparing| &preparing.worker.choice);
        let newest = prepared.filter(|choice| choice.id == self.driving.id());
        let base = newest.or_else(|| self.driving.newest_change());
        let mut choice = base.unwrap_or(&self.driving.worker.choice).clone();
        choice.parameters.insert(key.into(), value.clone());
        if newest.is_none() && self.driving.takes_value(key, &self.known) {
            self.driving.reconfigure = Some(choice);
        } else {
            self.choose(choice, Reason::Operator);
        }
    }
}
