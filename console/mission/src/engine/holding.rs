//! What the verdicts of rules do: the robot is held, moves again, or the mission ends.

use super::{Mission, rules::Verdict, slot::Prepare};
use crate::{
    event::EventKind,
    phase::{Gait, Hold, HoldReason, Outcome, Phase, Resumes},
};
use planner_api::Reason;

impl Mission {
    pub(super) fn carry_out(&mut self, verdict: Verdict) {
        match verdict {
            Verdict::Hold(hold) => self.hold(hold),
            Verdict::HoldAndReplan(hold) => {
                self.active.want_plan(Reason::Blocked);
                self.hold(hold);
            }
            Verdict::Resume => self.go_on(Gait::Steady),
            Verdict::Replan(reason) => self.active.want_plan(reason),
            Verdict::Done => self.end_done(),
            Verdict::End(outcome, reason) => self.end(outcome, reason),
        }
    }

    /// After a fault, or where the planner sees no way: the fallback takes over, if there is one; with nobody there to help the
    /// mission ends.
    pub(super) fn replace_failed_planner(&mut self) {
        let Phase::Held(Hold { by, resumes }) = &self.known.phase else { return };
        if *resumes == Resumes::ByFallback {
            let active = self.active.choice.id.clone();
            if let Some(choice) = self.rules.fallback.update(&self.known.config, &active) {
                let mut slot = self.active.successor(choice, Reason::Swap { from: active });
                slot.prepare = Prepare::Plan;
                self.drop_better_plan("another planner drives");
                if let Some(candidate) = self.candidate.take() {
                    self.reject(candidate, format!("the fallback planner {} takes over", slot.choice.id));
                }
                self.replace_active(slot);
            }
        } else if resumes.is_never() && !self.known.config.attended && self.active.prepare == Prepare::No {
            let (outcome, message) = match by {
                // A planner that says that no way exists has not failed.
                HoldReason::Stuck { message } => (Outcome::Stuck, message),
                HoldReason::PlannerFault { message }
                | HoldReason::PlanRefused { message }
                | HoldReason::PlannerSilent { message } => (Outcome::Aborted, message),
                _ => return,
            };
            let reason = format!("unattended hold: {message}");
            self.end(outcome, reason);
        }
    }

    /// Holds the robot. If only an order could let it move anyway, or for longer than a step, only an order ends this
    /// hold: the operator's HOLD outlives whatever happens to planners meanwhile.
    pub(super) fn hold(&mut self, Hold { by, resumes }: Hold) {
        let only_by_order = match &self.known.phase {
            Phase::Held(before) => before.resumes.is_never(),
            Phase::Running(gait) => *gait != Gait::Steady,
            Phase::Waiting | Phase::Ended(_) => false,
        };
        let resumes = if only_by_order { Resumes::Never } else { resumes };
        self.happened.push(EventKind::Held { by: by.clone(), resumes });
        self.known.phase = Phase::Held(Hold { by, resumes });
        self.active.outdate_step();
        if let Some(unsent) = self.active.command.take() {
            self.discard(unsent);
        }
    }

    /// Lets the robot move again, for good or for one tick.
    pub(super) fn resume(&mut self, gait: Gait) {
        self.active.prepare = Prepare::No;
        self.go_on(gait);
    }

    pub(super) fn go_on(&mut self, gait: Gait) {
        self.rules.restart();
        self.happened.push(EventKind::Resumed);
        self.known.phase = Phase::Running(gait);
    }

    pub(super) fn end(&mut self, outcome: Outcome, reason: String) {
        self.happened.ending = Some(EventKind::Ended { outcome, reason });
        self.known.phase = Phase::Ended(outcome);
        self.drop_candidate();
        self.drop_shadow();
        self.close_active();
    }
}
