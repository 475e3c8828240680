//! What each order does. Whether it is accepted is decided by [`Standing::allows`](crate::Standing::allows) alone.

use super::{
    Mission,
    candidate::NEAR_PLAN_M,
    known::Known,
    planning::Objection,
    slot::{LeftPlan, PlannerSlot, Prepare},
};
use crate::{
    event::EventKind,
    order::Order,
    phase::{Gait, Hold, HoldReason, Outcome, Phase, Resumes},
    plan_id::{PlanId, PlanSeen},
    planner::{ParamValue, PlannerChoice},
    standing::Readiness,
};
use planner_api::{Plan, Reason};

impl Mission {
    pub(super) fn obey(&mut self, order: &Order) {
        // The order stands in the journal before its effects.
        let allowed = self.standing().allows(order).map_err(|why| why.to_string());
        if let Err(why) = allowed.and_then(|()| self.known.check_place(order)) {
            self.happened.push(EventKind::OrderRefused { order: order.clone(), why });
            return;
        }
        self.happened.push(EventKind::Ordered { order: order.clone() });
        match order {
            Order::Plan => self.plan_ahead(),
            Order::Start | Order::StartPlan(_) => self.start(),
            Order::NoteChecks(_) | Order::NoteOutlooks(_) | Order::Note(_) => {}
            // The simulator obeys it.
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
            Order::Abort => self.end(Outcome::Aborted, "ended by operator".into()),
            Order::Terminate => self.end(Outcome::Aborted, "ended by a signal to the process".into()),
            Order::ChoosePlanner(choice) => {
                let from = self.active.choice.id.clone();
                if self.takes_live(choice) {
                    self.stay_held();
                    self.drop_candidate();
                    self.active.reconfigure = Some(choice.clone());
                } else {
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
}

impl Known {
    /// Refuses what cannot be where it is ordered.
    fn check_place(&self, order: &Order) -> Result<(), String> {
        let Order::DrawZone(corners) = order else { return Ok(()) };
        self.check_zone(corners)
    }
}

impl Mission {
    /// The planner makes its plan while the mission waits, so that the operator sees it before anything moves.
    fn plan_ahead(&mut self) {
        self.active.want_plan(Reason::Start);
        self.active.prepare = Prepare::Plan;
    }

    /// What a start would begin with.
    pub(super) fn readiness(&self) -> Readiness<'_> {
        let slot = &self.active;
        if !self.known.config.start_names_plan {
            return Readiness::Unseen;
        }
        if slot.is_being_prepared() || slot.prepare > Prepare::No || slot.newest_change().is_some() {
            return Readiness::Preparing;
        }
        match &slot.first_plan {
            None => Readiness::NoPlan,
            Some(Err(why)) => Readiness::Failed(why),
            Some(Ok(plan)) if slot.has_plan() => Readiness::Plan(*plan),
            // It is made again, because something was found in its way.
            Some(Ok(_)) => Readiness::Preparing,
        }
    }

    /// Whether the plan that the operator saw before the start is not the one to be run any more.
    pub(super) fn is_seen_plan_outdated(&self) -> bool {
        let is_seen = matches!(self.active.first_plan, Some(Ok(_)));
        self.known.is_waiting() && is_seen && !self.active.has_plan()
    }

    /// Keeps which plan the operator sees before the start, or why there is none.
    pub(super) fn show_first_plan(&mut self, plan: &Plan, objection: Option<&Objection>) {
        if self.known.phase != Phase::Waiting || !self.known.config.start_names_plan {
            return;
        }
        let Plan { path, legs, cuts, complete, .. } = plan;
        let seen = PlanSeen { path, legs, cuts, complete: *complete };
        let slot = &self.active;
        let id = slot.info.as_ref().map(|info| PlanId::of(&slot.choice, info, seen));
        self.active.first_plan = match objection {
            None => id.map(Ok),
            Some(objection) => Some(Err(objection.message.clone())),
        };
    }

    fn start(&mut self) {
        self.rules.time_limit.start(self.known.now_s());
        self.known.phase = Phase::Running(Gait::Steady);
    }

    /// From now on only an order lets the robot move; a hold of which that is true already keeps its reason.
    fn hold_by_order(&mut self) {
        if self.known.phase.may_move() {
            self.hold(Hold { by: HoldReason::Operator, resumes: Resumes::Never });
        }
    }

    /// A hold that was to end by itself now ends by an order: nobody who changes planners, or which stations are heard,
    /// expects the robot to move.
    pub(super) fn stay_held(&mut self) {
        if let Phase::Held(hold) = &self.known.phase
            && !hold.resumes.is_never()
        {
            self.hold(Hold { by: hold.by.clone(), resumes: Resumes::Never });
        }
    }
}

impl Known {
    pub(super) fn allow_uncertified(&mut self, fly: bool) {
        if let Some(tether) = &mut self.tether {
            tether.allow_uncertified(fly);
        }
    }
}

impl Mission {
    /// Another planner, or the same one with other parameters, is to take over.
    ///
    /// The one before stays until the other has a plan that may be flown, unless it could not drive on anyway: then it is
    /// replaced at once, so that the operator can have a plan of the other flown that is refused for the tether.
    pub(super) fn choose(&mut self, choice: PlannerChoice, reason: Reason) {
        self.stay_held();
        self.cancel_promotion();
        self.drop_better_plan("another planner was chosen");
        let waiting = self.known.is_waiting();
        let reason = if waiting { Reason::Start } else { reason };
        let mut slot = self.active.successor(choice, reason);
        let goes_on = self.takes_live(&slot.choice).then(|| self.known.task.under_way()).flatten();
        slot.keep = goes_on.or_else(|| self.plan_left_here(&slot.choice));
        slot.prepare = if waiting { Prepare::Open } else { Prepare::Plan };
        self.drop_candidate();
        if self.active.is_ready && !waiting && !self.has_active_failed() {
            self.active.snapshot_due = self.can_hand_over_state(&slot);
            self.candidate = Some(slot);
        } else {
            self.replace_active(slot);
        }
    }

    /// Whether a choice is the planner that drives with other live values: these change no plan, so that it goes on with its own.
    /// A value that goes back to its default is not among them: planners are told values only.
    fn takes_live(&self, choice: &PlannerChoice) -> bool {
        let (before, slot) = (&self.active.choice, &self.active);
        let is_live = |key: &String| slot.info.as_ref().is_some_and(|info| info.has_live(key));
        let mut changed =
            choice.parameters.iter().filter(|(key, value)| before.parameters.get(*key) != Some(value));
        let keeps_all = before.parameters.keys().all(|key| choice.parameters.contains_key(key));
        choice.id == before.id
            && *choice != *before
            && slot.is_ready
            && slot.has_plan()
            && slot.newest_change().is_none()
            && keeps_all
            && changed.all(|(key, _)| is_live(key))
    }

    /// Whether the robot is held because the active planner has no plan that it may fly.
    fn has_active_failed(&self) -> bool {
        let is_blamed = matches!(&self.known.phase, Phase::Held(hold) if hold.by.blames_planner());
        is_blamed && !self.active.has_plan()
    }

    /// Whether a successor can go on from what the active planner knows now.
    fn can_hand_over_state(&self, slot: &PlannerSlot) -> bool {
        let snapshots = self.active.info.as_ref().is_some_and(|info| info.snapshots);
        snapshots && self.active.is_ready && slot.choice.id == self.active.choice.id
    }

    /// The plan that a planner flew with the same values when another one took over, if the robot is still there: whoever is
    /// called back goes on with it.
    fn plan_left_here(&self, choice: &PlannerChoice) -> Option<Plan> {
        let left = self.left.as_ref().filter(|left| left.choice == *choice)?;
        let is_here = (left.at - self.known.position()).norm() < NEAR_PLAN_M;
        is_here.then(|| left.plan.clone())
    }

    /// Puts a planner in the place of the active one, whose worker is closed.
    pub(super) fn replace_active(&mut self, slot: PlannerSlot) {
        let at = self.known.position();
        let plan = self.active.has_plan().then(|| self.known.task.under_way()).flatten();
        self.left = plan.map(|plan| LeftPlan { choice: self.active.choice.clone(), plan, at });
        self.close_active();
        self.active = slot;
    }

    /// Closes the worker of the active planner.
    pub(super) fn close_active(&mut self) {
        if let Some(unsent) = self.active.command.take() {
            self.discard(unsent);
        }
        let worker = self.active.leave_worker();
        self.workers.close(worker);
    }

    /// Closes a planner that was being prepared.
    pub(super) fn drop_candidate(&mut self) {
        if let Some(mut slot) = self.candidate.take() {
            self.workers.close(slot.leave_worker());
        }
    }

    fn set_parameter(&mut self, key: &str, value: &ParamValue) {
        self.drop_better_plan("a parameter was changed");
        // A change on top of a change that is under way.
        let newest = self.candidate.as_ref().filter(|slot| slot.choice.id == self.active.choice.id);
        let base = newest.map(|slot| &slot.choice).or_else(|| self.active.newest_change());
        let mut choice = base.unwrap_or(&self.active.choice).clone();
        choice.parameters.insert(key.into(), value.clone());
        // While the mission runs, a planner that is being opened gets the values once it is there, and refuses what it does
        // not know; while it is held, they are given to it from the start.
        let takes_it = match &self.active.info {
            Some(info) => info.has_live(key) && (self.active.is_ready || self.known.is_running()),
            None => self.known.is_running(),
        };
        if takes_it && newest.is_none() {
            self.active.reconfigure = Some(choice);
        } else {
            self.choose(choice, Reason::Operator);
        }
    }
}
