//! Processes the answers from planners.

use super::{
    Mission,
    checking::mismatch,
    course::Due,
    driving::Prepare,
    planning::{Evaluated, Objection},
    requests::AskedPlan,
    worker::{Pending, PendingKind},
};
use crate::{
    ask::{Answer, AskId, Given, Said},
    event::{EventKind, OfferEnd},
    phase::{Gait, Hold, HoldReason, Phase, Resumes},
    planner::{Cause, Fault, PlannerInfo},
};
use planner_api::{Code, Plan, Reason};

impl Mission {
    /// Processes the answer to an ask. An answer that is no longer expected is ignored.
    pub fn answer(&mut self, answer: Answer) {
        if let Some(pending) = self.driving.worker.answered(answer.ask) {
            return self.answer_driving(pending, answer);
        }
        if let Some(pending) = self.preparing.as_mut().and_then(|p| p.worker.answered(answer.ask)) {
            return self.answer_preparing(pending, answer);
        }
        if let Some(shadow) = &mut self.shadow
            && let Some(pending) = shadow.worker.answered(answer.ask)
            && let Err(why) = shadow.answer(pending, answer, &self.known, &mut self.happened)
        {
            self.close_shadow(why);
        }
    }

    fn answer_driving(&mut self, pending: Pending, Answer { ask, result, said }: Answer) {
        let given = match result.and_then(|given| self.checked(&self.driving.worker, given)) {
            Ok(given) => given,
            Err(fault) => return self.driving_failed(ask, pending.kind, fault, said),
        };
        if let (PendingKind::Step { usable }, Given::Command(command)) = (&pending.kind, &given) {
            let command = (*command, said);
            return self.driving.take_command((&pending, *usable), command, &self.known, &mut self.happened);
        }
        match (pending.kind, given) {
            (PendingKind::Open, Given::Opened(info)) => self.driving_opened(ask, *info, said),
            (PendingKind::Reconfigure(choice), Given::Reconfigured) => {
                self.happened.pass_on(said, &choice.id);
                self.driving.worker.choice = choice.clone();
                self.driving.first_plan = None;
                self.happened.push(EventKind::ParametersChanged { ask: Some(ask), choice });
            }
            (PendingKind::Plan(asked), Given::Plan(plan)) => self.plan_arrived(ask, asked, plan, said),
            (PendingKind::StepInShadow, Given::Command(_)) => {
                self.happened.pass_on(said, self.driving.id());
                self.happened.push(EventKind::Discarded { ask, plan: None });
            }
            (PendingKind::Snapshot, Given::State { bytes }) => {
                self.happened.pass_on(said, self.driving.id());
                self.driving.worker.saved = if bytes > 0 { Some(ask) } else { self.driving.worker.saved };
                self.happened.push(EventKind::Snapshotted { ask, bytes });
            }
            (kind, _) => self.driving_failed(ask, kind, mismatch(self.driving.id()), said),
        }
    }

    fn driving_opened(&mut self, ask: AskId, info: PlannerInfo, said: Said) {
        let driving = &mut self.driving;
        self.happened.pass_on(said, driving.id());
        let (choice, seen) = (driving.worker.choice.clone(), driving.worker.seen());
        let from = seen.map(|before| before.id.clone());
        driving.worker.info = Some(info.clone());
        if driving.prepare == Prepare::Open {
            driving.prepare = Prepare::No;
        }
        self.happened.push(EventKind::PlannerChosen { ask: Some(ask), choice, info: Box::new(info), from });
    }

    fn plan_arrived(&mut self, ask: AskId, asked: AskedPlan, plan: Plan, said: Said) {
        self.happened.pass_on(said, self.driving.id());
        let Evaluated { plan, events, objection } =
            self.known.evaluate(Some(ask), self.driving.id(), &asked, plan);
        self.happened.extend(events);
        if objection.as_ref().is_some_and(|why| why.by_tether) && self.known.may_try_from_anchor(&asked) {
            self.driving.course.due = Some(Due::from_anchor(asked.reason));
            return;
        }
        self.driving.show_first_plan(&plan, objection.as_ref(), &self.known);
        let Some(Objection { by_tether, message }) = objection else {
            let is_repair = asked.is_repair && self.known.task.keeps_to(&plan);
            self.take_plan(&plan);
            if is_repair {
                self.want_better_plan();
            }
            return;
        };
        self.driving.course.due = Some(Due::from_here(asked.reason));
        if by_tether && self.waits_for_return_path() {
            return;
        }
        self.driving_is_no_use(if by_tether {
            HoldReason::PlanRefused { message }
        } else {
            HoldReason::PlannerFault { message }
        });
    }

    /// Switches to a plan. This ends a hold that was waiting for the plan, or one that was caused by another planner.
    pub(super) fn take_plan(&mut self, plan: &Plan) {
        self.drop_better_plan(OfferEnd::OtherPlan);
        self.better_plan_due_s = None;
        self.known.task.take_plan(plan);
        // From here on, progress is measured along the new plan.
        self.rules.stuck.restart();
        self.driving.take_plan(plan, &self.known);
        let was_ordered = std::mem::take(&mut self.driving.prepare) == Prepare::Plan;
        let Phase::Held(hold) = &self.known.phase else { return };
        if hold.resumes == Resumes::ByFallback {
            self.go_on(Gait::Steady);
        } else if was_ordered && (hold.by.blames_planner() || matches!(hold.by, HoldReason::Stuck { .. })) {
            // The cause of the hold is gone together with the planner; now the operator decides when the robot moves
            // again.
            self.hold(Hold { by: HoldReason::PlannerReplaced, resumes: Resumes::Never });
        }
    }

    fn driving_failed(&mut self, ask: AskId, kind: PendingKind, fault: Fault, said: Said) {
        self.happened.pass_on(said, self.driving.id());
        let (message, cause, is_no_way) = (fault.message.clone(), fault.cause, fault.is_no_way());
        let info = self.driving.worker.info.clone();
        self.note_fault(ask, fault, info.as_ref());
        let says_no = matches!(cause, Cause::Planner(_) | Cause::Refused);
        match kind {
            // The planner keeps its current values, but a new instance of it may accept the new ones.
            PendingKind::Reconfigure(choice) if says_no => {
                let unsupported = cause == Cause::Planner(Code::Unsupported);
                // If another planner has been ordered in the meantime, that order stands.
                if unsupported && self.preparing.is_none() && !self.known.is_running() {
                    let prepare = self.driving.prepare;
                    self.choose(choice, Reason::Operator);
                    // If a plan was ordered before the start, that order stands.
                    self.driving.prepare = prepare.max(self.driving.prepare);
                }
                return;
            }
            PendingKind::Plan(_)
            | PendingKind::Step { .. }
            | PendingKind::StepInShadow
            | PendingKind::Snapshot
                if says_no => {}
            _ => self.driving.close(&mut self.workers, &mut self.happened),
        }
        if self.known.is_waiting() {
            self.driving.first_plan = Some(Err(message.clone()));
        }
        if !self.driving.course.has_plan() {
            // The operator agreed to the refused plan, not to a later one.
            let tether = self.known.config.tether.as_ref();
            self.known.allow_uncertified(tether.is_some_and(|tether| tether.allow_uncertified));
        }
        self.driving_is_no_use(if is_no_way {
            HoldReason::Stuck { message }
        } else {
            HoldReason::PlannerFault { message }
        });
    }

    /// Handles an active planner that cannot continue.
    fn driving_is_no_use(&mut self, by: HoldReason) {
        self.drop_better_plan(OfferEnd::PlannerFailed);
        self.driving.prepare = Prepare::No;
        let is_to_be_held = match &self.known.phase {
            Phase::Running(gait) => *gait != Gait::Back,
            Phase::Held(hold) => hold.by.blames_planner(),
            Phase::Waiting | Phase::Ended(_) => false,
        };
        if is_to_be_held {
            let resumes = self.rules.fallback.resumes(&self.known.config, self.driving.id());
            self.hold(Hold { by, resumes });
        }
    }
}
