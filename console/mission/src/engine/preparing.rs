//! Prepares a second planner in the background while another one is active: a candidate, or a planner that makes a better
//! plan.

use super::{
    Mission,
    checking::mismatch,
    driving::Driving,
    planning::Evaluated,
    role::{Better, Preparing, Role},
    worker::{Pending, PendingKind, Worker},
};
use crate::{
    ask::{Answer, Ask, AskId, Given, Said},
    event::{EventKind, OfferEnd},
    planner::Fault,
};

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
            self.drop_better_plan(OfferEnd::TooLittleLeft);
        }
        self.preparing.as_mut()?.worker.ask_for_plan(self.known.tick, plan?)
    }

    /// Processes an answer from the planner being prepared.
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
            Role::Better(better) => {
                self.happened.push(EventKind::PlannerFailed { ask: Some(ask), fault });
                self.close_better_plan(worker, &better, OfferEnd::MakerFailed { message: why });
            }
        }
    }

    /// Promotes the planner that was being prepared, which becomes the active planner, with its plan.
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
