//! Preparations in the background while a planner drives: a candidate, or a better plan.

use super::{
    Mission,
    better_plan::Better,
    candidate::Candidate,
    checking::mismatch,
    driving::Driving,
    planning::Evaluated,
    worker::{Pending, PendingKind, Worker},
};
use crate::{
    ask::{Answer, Ask, AskId, Given, Said},
    event::EventKind,
    planner::Fault,
};

/// A planner that is being prepared while another one drives.
#[derive(Clone)]
pub(super) struct Preparing {
    pub worker: Worker,
    pub role: Role,
}

/// The purpose of the preparation.
#[derive(Clone)]
pub(super) enum Role {
    /// The planner takes over as soon as it has an acceptable plan.
    Candidate(Candidate),
    /// The planner makes a plan for all that is left, to replace the repaired plan in use.
    Better(Better),
}

impl Preparing {
    /// Whether the robot stands still until the planner has planned.
    pub(super) fn robot_waits(&self) -> bool {
        matches!(&self.role, Role::Candidate(candidate) if candidate.robot_waits)
    }
}

impl Mission {
    pub(super) fn ask_preparing(&mut self) -> Option<Ask> {
        let is_saving = self.driving.is_saving();
        let open = self.preparing.as_mut().filter(|preparing| preparing.worker.pending.is_none())?;
        let Preparing { worker, role } = open;
        if !worker.is_ready() {
            if is_saving {
                return None;
            }
            if worker.choice.id == self.driving.id() {
                worker.saved = self.driving.worker.saved;
            }
            return Some(worker.open(&self.known, &mut self.workers));
        }
        let plan = match role {
            Role::Candidate(candidate) => Some(candidate.plan_ask(&self.known)),
            Role::Better(Better::Opening) => {
                let (joint, plan) = self.known.better_plan_ask().unzip();
                *role = Role::Better(joint.map_or(Better::Opening, Better::Planning));
                plan
            }
            Role::Better(_) => return None,
        };
        if plan.is_none() {
            self.drop_better_plan("too little of the current plan is left");
        }
        self.preparing.as_mut()?.worker.ask_for_plan(self.known.tick, plan?)
    }

    /// Processes an answer of the planner being prepared.
    pub(super) fn answer_preparing(&mut self, pending: Pending, Answer { ask, result, said }: Answer) {
        let Some(mut preparing) = self.preparing.take() else { return };
        let given = result.and_then(|given| self.checked(&preparing.worker, given));
        self.preparing = match (pending.kind, given) {
            (PendingKind::Open, Ok(Given::Opened(info))) => {
                let worker = &mut preparing.worker;
                self.happened.pass_on(said, worker.id());
                worker.info = Some((*info).clone());
                self.happened.push(EventKind::PlannerPrepared { ask, choice: worker.choice.clone(), info });
                Some(preparing)
            }
            (PendingKind::Plan(asked), Ok(Given::Plan(plan))) => match preparing.role {
                Role::Candidate(candidate) => {
                    self.candidate_planned(preparing.worker, candidate, (ask, asked), plan, said)
                }
                Role::Better(better) => {
                    self.happened.pass_on(said, preparing.worker.id());
                    self.better_plan_arrived(preparing.worker, &better, ask, plan)
                }
            },
            (_, given) => {
                let fault = given.err().unwrap_or_else(|| mismatch(preparing.worker.id()));
                self.happened.pass_on(said, preparing.worker.id());
                self.preparing_failed(preparing, ask, fault);
                None
            }
        }
    }

    fn preparing_failed(&mut self, Preparing { worker, role }: Preparing, ask: AskId, fault: Fault) {
        let why = fault.message.clone();
        match role {
            Role::Candidate(_) => {
                self.note_fault(ask, fault, worker.info.as_ref());
                self.reject(worker, why);
            }
            // The robot is not affected, so the fault counts against no plugin.
            Role::Better(_) => {
                self.happened.push(EventKind::PlannerFailed { ask: Some(ask), fault });
                self.close_better_plan(worker, why);
            }
        }
    }

    /// Promotes the planner that was being prepared to the active one, with its plan.
    pub(super) fn take_over(
        &mut self,
        driving: Driving,
        said: Said,
        Evaluated { plan, events, .. }: Evaluated,
    ) {
        self.replace_driving(driving);
        let Worker { choice, info, before, .. } = &self.driving.worker;
        if let Some(info) = info.clone() {
            let (choice, from) = (choice.clone(), before.as_ref().map(|before| before.id.clone()));
            self.happened.push(EventKind::PlannerChosen { ask: None, choice, info: Box::new(info), from });
        }
        self.happened.pass_on(said, self.driving.id());
        self.happened.extend(events);
        self.take_plan(&plan);
    }

    /// Closes the planner being prepared, without an event.
    pub(super) fn drop_preparing(&mut self) {
        if let Some(mut preparing) = self.preparing.take() {
            self.workers.close(preparing.worker.leave());
        }
    }
}
