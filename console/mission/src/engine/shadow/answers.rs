//! What the answers of a planner in shadow do.

use super::{
    super::{
        Mission,
        answers::mismatch,
        known::Known,
        planning::after,
        requests::AskedPlan,
        slot::{Pending, PendingKind},
    },
    Shadow,
};
use crate::{
    ask::{Answer, AskId, Given, Said},
    event::EventKind,
};
use planner_api::{Command, Plan, Reason};

/// An answer counts in the tick of the ask and in the next one: nobody waits for it, so that it may just miss the first.
const IN_TIME_TICKS: u64 = 1;

impl Mission {
    /// Takes an answer of the planner in shadow; gives it back unless that ends it.
    pub(in crate::engine) fn answer_shadow(
        &mut self,
        mut shadow: Shadow,
        pending: Pending,
        Answer { ask, result, said }: Answer,
    ) -> Option<Shadow> {
        match (pending.kind, result.and_then(|given| self.known.fitting(&shadow.slot, given))) {
            (PendingKind::Open, Ok(Given::Opened(info))) => {
                self.pass_on_of_shadow(&mut shadow, said);
                (shadow.slot.info, shadow.slot.is_ready) = (Some((*info).clone()), true);
                let choice = shadow.slot.choice.clone();
                self.happened.of_shadow.push(EventKind::ShadowBegan { ask, choice, info });
                Some(shadow)
            }
            (PendingKind::Plan(asked), Ok(Given::Plan(plan))) => {
                self.pass_on_of_shadow(&mut shadow, said);
                Some(self.shadow_planned(shadow, ask, &asked, plan))
            }
            (PendingKind::Step { .. }, Ok(Given::Command(command))) => {
                self.shadow_stepped(&mut shadow, (ask, self.known.tick - pending.tick), command, said);
                Some(shadow)
            }
            (_, result) => {
                // It counts against nobody: the plugin may be the one that drives.
                let fault = result.err().unwrap_or_else(|| mismatch(&shadow.slot.choice.id));
                self.pass_on_of_shadow(&mut shadow, said);
                let why = fault.message.clone();
                self.note_shadow(&mut shadow, EventKind::PlannerFailed { ask: Some(ask), fault });
                self.close_shadow(shadow, why);
                None
            }
        }
    }

    fn shadow_stepped(
        &mut self,
        shadow: &mut Shadow,
        (ask, ticks): (AskId, u64),
        command: Command,
        said: Said,
    ) {
        if ticks > IN_TIME_TICKS {
            let missed = EventKind::ShadowMissed { ask, ticks: ticks - IN_TIME_TICKS };
            shadow.tally.apply(&missed);
            return self.happened.of_shadow.push(missed);
        }
        self.pass_on_of_shadow(shadow, said);
        self.note_shadow(shadow, EventKind::Commanded { ask: Some(ask), command, asked: None });
    }

    /// Takes a plan; whether it flies from where the robot is decides who promotes the planner.
    fn shadow_planned(&mut self, mut shadow: Shadow, ask: AskId, asked: &AskedPlan, plan: Plan) -> Shadow {
        let id = shadow.slot.choice.id.clone();
        let plan = after(&asked.return_path, plan);
        let planned = Known::planned(Some(ask), &id, asked, &plan);
        self.note_shadow(&mut shadow, planned);
        shadow.take_plan(plan, self.known.task.clone(), asked);
        // The robot went on meanwhile: perhaps along this plan.
        for flown in &self.known.trail[shadow.n_flown..shadow.now.n_flown] {
            self.advance_shadow(&mut shadow, *flown);
        }
        self.advance_shadow(&mut shadow, self.known.position());
        let room_m = self.known.config.room_m();
        let found = std::mem::take(&mut shadow.slot.found_since);
        if found.iter().any(|shape| shadow.task.is_in_the_way(shape, room_m)) {
            shadow.slot.want_plan(Reason::MapChanged);
        }
        shadow
    }

    /// Reports what the shadow drew, reported and said besides an answer.
    fn pass_on_of_shadow(&mut self, shadow: &mut Shadow, said: Said) {
        let planner = shadow.slot.choice.id.clone();
        for kind in said.into_events(&planner) {
            self.note_shadow(shadow, kind);
        }
    }

    /// Reports what the shadow did, as what moved nothing.
    fn note_shadow(&mut self, shadow: &mut Shadow, kind: EventKind) {
        let event = EventKind::Shadowed { of: Box::new(kind) };
        shadow.tally.apply(&event);
        self.happened.of_shadow.push(event);
    }

    fn close_shadow(&mut self, mut shadow: Shadow, why: String) {
        self.workers.close(shadow.slot.leave_worker());
        self.happened.of_shadow.push(EventKind::ShadowEnded { planner: shadow.slot.choice.id, why });
    }
}
