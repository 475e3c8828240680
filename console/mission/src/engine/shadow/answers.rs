//! Processes the answers from a planner in shadow.

use super::{
    super::{
        checking::mismatch,
        happened::Happened,
        known::Known,
        planning::{after, planned},
        requests::AskedPlan,
        worker::{Pending, PendingKind},
    },
    Shadow,
};
use crate::{
    ask::{Answer, AskId, Given, Said},
    event::EventKind,
};
use planner_api::{Command, Plan};

/// An answer is used if it arrives in the tick of the ask or in the next tick. The mission does not wait for the
/// answer, so it may arrive just after the first of these ticks.
const IN_TIME_TICKS: u64 = 1;

impl Shadow {
    /// Processes an answer.
    ///
    /// # Errors
    /// Why the planner can no longer run in shadow, as a sentence. The failure counts against no plugin: the active
    /// planner may come from the same plugin.
    pub(in crate::engine) fn answer(
        &mut self,
        pending: Pending,
        Answer { ask, result, said }: Answer,
        known: &Known,
        happened: &mut Happened,
    ) -> Result<(), String> {
        match (pending.kind, result.and_then(|given| known.fitting(&self.worker, given))) {
            (PendingKind::Open, Ok(Given::Opened(info))) => {
                self.pass_on(said, happened);
                self.worker.info = Some((*info).clone());
                let choice = self.worker.choice.clone();
                happened.of_shadow.push(EventKind::ShadowBegan { ask, choice, info });
            }
            (PendingKind::Plan(asked), Ok(Given::Plan(plan))) => {
                self.pass_on(said, happened);
                let plan = after(&asked.return_path, plan);
                self.note(planned(Some(ask), self.worker.id(), &asked, &plan), happened);
                self.take_plan(plan, &asked, known);
            }
            (PendingKind::Step { .. }, Ok(Given::Command(command))) => {
                self.take_command((ask, known.tick - pending.tick), command, said, happened);
            }
            (PendingKind::Snapshot, Ok(Given::State { bytes })) => {
                self.pass_on(said, happened);
                self.note(EventKind::Snapshotted { ask, bytes }, happened);
            }
            (_, result) => {
                let fault = result.err().unwrap_or_else(|| mismatch(self.worker.id()));
                self.pass_on(said, happened);
                let why = fault.message.clone();
                self.note(EventKind::PlannerFailed { ask: Some(ask), fault }, happened);
                return Err(why);
            }
        }
        Ok(())
    }

    fn take_command(
        &mut self,
        (ask, ticks): (AskId, u64),
        command: Command,
        said: Said,
        happened: &mut Happened,
    ) {
        if ticks > IN_TIME_TICKS {
            let missed = EventKind::ShadowMissed { ask, ticks: ticks - IN_TIME_TICKS };
            self.tally.apply(&missed);
            return happened.of_shadow.push(missed);
        }
        self.pass_on(said, happened);
        self.note(EventKind::Commanded { ask: Some(ask), command, asked: None }, happened);
    }

    /// Takes a plan for the remaining task. Whether the plan can be run from the robot's position is checked at
    /// promotion.
    fn take_plan(&mut self, plan: Plan, asked: &AskedPlan, known: &Known) {
        self.task = known.task.clone();
        self.task.take_plan(&plan);
        self.course.take(&plan);
        self.from_anchor = asked.from_anchor;
        (self.plan, self.has_planned) = (plan, true);
        // The robot has moved on in the meantime, perhaps along this plan.
        for flown in &known.trail[self.n_flown..self.now.n_flown] {
            self.advance(*flown, known);
        }
        self.advance(known.position(), known);
        self.course.doubt_fresh_plan(&self.task, known.config.room_m());
    }

    /// Passes on the drawings, figures and log messages that came with an answer.
    fn pass_on(&mut self, said: Said, happened: &mut Happened) {
        for kind in said.into_events(&self.worker.choice.id.clone()) {
            self.note(kind, happened);
        }
    }

    /// Reports an event of the planner in shadow, which has no effect on the robot.
    fn note(&mut self, kind: EventKind, happened: &mut Happened) {
        let event = EventKind::Shadowed { of: Box::new(kind) };
        self.tally.apply(&event);
        happened.of_shadow.push(event);
    }
}
