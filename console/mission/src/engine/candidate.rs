//! What the answers of a planner do that is being prepared to take over.

use super::{
    Mission,
    answers::mismatch,
    planning::Evaluated,
    seat::{AskedPlan, Pending, PendingKind, PlanState, Seat},
};
use crate::{
    ask::{Answer, AskId, Given, Said},
    event::EventKind,
};
use planner_api::Plan;

/// A candidate whose plan begins further from the robot than this plans again, metres.
const NEAR_PLAN_M: f64 = 0.5;

impl Mission {
    /// Takes an answer of the planner that is being prepared; gives it back unless it has taken over or is closed.
    pub(super) fn answer_candidate(
        &mut self,
        mut seat: Seat,
        pending: Pending,
        Answer { ask, result, said }: Answer,
    ) -> Option<Seat> {
        match (pending.kind, result.and_then(|given| self.checked(&seat, given))) {
            (PendingKind::Open, Ok(Given::Opened(info))) => {
                self.pass_on(said, &seat.choice.id);
                (seat.info, seat.is_ready) = (Some((*info).clone()), true);
                self.happened.push(EventKind::PlannerPrepared { ask, choice: seat.choice.clone(), info });
                Some(seat)
            }
            (PendingKind::Plan(asked), Ok(Given::Plan(plan))) => {
                self.candidate_planned(seat, ask, asked, plan, said)
            }
            (_, result) => {
                let fault = result.err().unwrap_or_else(|| mismatch(&seat.choice.id));
                self.pass_on(said, &seat.choice.id);
                let message = fault.message.clone();
                self.note_fault(ask, fault, seat.info.as_ref().map(|info| info.sha256.clone()));
                self.reject(seat, message);
                None
            }
        }
    }

    fn candidate_planned(
        &mut self,
        mut seat: Seat,
        ask: AskId,
        asked: AskedPlan,
        plan: Plan,
        said: Said,
    ) -> Option<Seat> {
        let id = seat.choice.id.clone();
        if (self.locator.position() - asked.here).norm() > NEAR_PLAN_M {
            // The robot went on meanwhile. It plans again from here, and this time the robot waits for it.
            self.pass_on(said, &id);
            self.happened.push(EventKind::Discarded { ask });
            seat.robot_waits = true;
            return Some(seat);
        }
        let Evaluated { plan, events, objection } = self.evaluate(ask, &id, &asked, plan);
        if objection.is_none() {
            self.promote(seat);
            self.pass_on(said, &id);
            self.happened.extend(events);
            self.take_plan(&plan);
            self.plan_is_there();
            return None;
        }
        self.pass_on(said, &id);
        self.happened.extend(events);
        match objection {
            Some(objection) if !(objection.by_tether && self.may_try_from_anchor(&asked)) => {
                self.reject(seat, objection.message);
                None
            }
            _ => {
                seat.plan = PlanState::Due { reason: asked.reason, from_anchor: true };
                Some(seat)
            }
        }
    }

    /// The planner that was being prepared takes over.
    fn promote(&mut self, seat: Seat) {
        let from = seat.before.as_ref().map(|before| before.id.clone());
        let (choice, info) = (seat.choice.clone(), seat.info.clone());
        self.replace_active(seat);
        if let Some(info) = info {
            self.happened.push(EventKind::PlannerChosen { ask: None, choice, info: Box::new(info), from });
        }
    }

    pub(super) fn reject(&mut self, mut seat: Seat, why: String) {
        self.workers.close(seat.leave_worker());
        self.happened.push(EventKind::PlannerRejected { planner: seat.choice.id, why });
    }
}
