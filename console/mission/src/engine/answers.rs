//! What the answers of planners do.

use super::{
    Mission,
    known::Known,
    planning::{Evaluated, Objection},
    requests::AskedPlan,
    slot::{Pending, PendingKind, PlanState, PlannerSlot, Prepare},
    workers,
};
use crate::{
    ask::{Answer, AskId, Given, Said},
    config::TaskConfig,
    event::EventKind,
    phase::{Gait, Hold, HoldReason, Phase, Resumes},
    plan_extent::check_extent,
    planner::{Cause, During, Fault, PlannerInfo},
};
use planner_api::{Code, Plan};

/// A fault with what it belongs to.
struct Failed {
    ask: AskId,
    kind: PendingKind,
    fault: Fault,
    said: Said,
}

impl Mission {
    /// Takes the answer to an ask. Answers that nobody waits for any more are ignored.
    pub fn answer(&mut self, answer: Answer) {
        let is_owed =
            |slot: &PlannerSlot| slot.pending.as_ref().is_some_and(|pending| pending.id == answer.ask);
        if is_owed(&self.active) {
            if let Some(pending) = self.active.pending.take() {
                self.answer_active(pending, answer);
            }
        } else if let Some(mut slot) = self.candidate.take_if(|slot| is_owed(slot)) {
            if let Some(pending) = slot.pending.take() {
                self.candidate = self.answer_candidate(slot, pending, answer);
            }
        } else if let Some(mut shadow) = self.shadow.take_if(|shadow| is_owed(&shadow.slot))
            && let Some(pending) = shadow.slot.pending.take()
        {
            self.shadow = self.answer_shadow(shadow, pending, answer);
        }
    }

    fn answer_active(&mut self, pending: Pending, Answer { ask, result, said }: Answer) {
        let given = match result.and_then(|given| self.checked(&self.active, given)) {
            Ok(given) => given,
            Err(fault) => return self.fail_active(Failed { ask, kind: pending.kind, fault, said }),
        };
        match (pending.kind.clone(), given) {
            (PendingKind::Open, Given::Opened(info)) => self.open_succeeded(ask, *info, said),
            (PendingKind::Reconfigure(choice), Given::Reconfigured) => {
                self.happened.pass_on(said, &choice.id);
                self.active.choice = choice.clone();
                self.active.first_plan = None;
                self.happened.push(EventKind::ParametersChanged { ask: Some(ask), choice });
            }
            (PendingKind::Plan(asked), Given::Plan(plan)) => self.plan_arrived(ask, asked, plan, said),
            (PendingKind::Step { usable }, Given::Command(command)) => {
                let usable = usable && self.known.is_running();
                self.take_command(&pending, usable, command, said);
            }
            (PendingKind::StepInShadow, Given::Command(_)) => {
                self.happened.pass_on(said, &self.active.choice.id.clone());
                self.happened.push(EventKind::Discarded { ask, plan: None });
            }
            (PendingKind::Snapshot, Given::State { bytes }) => {
                self.happened.pass_on(said, &self.active.choice.id.clone());
                if bytes > 0 {
                    self.active.saved = Some(ask);
                }
                self.happened.push(EventKind::Snapshotted { ask, bytes });
            }
            (kind, _) => {
                let fault = mismatch(&self.active.choice.id);
                self.fail_active(Failed { ask, kind, fault, said });
            }
        }
    }

    /// Refuses a planner that may not or cannot fly this mission, although it could be opened.
    pub(super) fn checked(&self, slot: &PlannerSlot, given: Given) -> Result<Given, Fault> {
        if let Given::Opened(info) = &given
            && let Some(message) = self.barred(info)
        {
            return Err(refused(info, During::Load, Cause::Quarantined, message));
        }
        self.known.fitting(slot, given)
    }

    /// Why a planner may not drive again in this mission, if it may not.
    pub(super) fn barred(&self, info: &PlannerInfo) -> Option<String> {
        let (faults, window_s) = (workers::MOST_FAULTS, workers::WINDOW_S);
        let message = || {
            format!(
                "planner {} failed {faults} times within {window_s} s and may not drive again in this mission",
                info.id
            )
        };
        self.workers.quarantine.holds(&info.sha256).then(message)
    }
}

impl Known {
    /// Refuses a planner that cannot fly this mission.
    pub(super) fn fitting(&self, slot: &PlannerSlot, given: Given) -> Result<Given, Fault> {
        let id = &slot.choice.id;
        if let Given::Plan(plan) = &given
            && let Err(what) = check_extent(plan, &self.chart.world().boundary, self.config.lane_m())
        {
            let (message, partial) = (format!("planner {id} {what}"), Vec::new());
            let plugin_sha256 = slot.info.as_ref().map(|info| info.sha256.clone());
            let (during, cause) = (During::Plan, Cause::BadOutput);
            return Err(Fault { planner: id.clone(), during, cause, message, partial, plugin_sha256 });
        }
        if let (Given::Opened(info), TaskConfig::Cover { .. }) = (&given, &self.config.task)
            && let Some(why) = info.why_no_coverage()
        {
            let message = format!("planner {id} {why}: choose one that does");
            return Err(refused(info, During::Configure, Cause::Refused, message));
        }
        Ok(given)
    }
}

impl Mission {
    fn open_succeeded(&mut self, ask: AskId, info: PlannerInfo, said: Said) {
        self.happened.pass_on(said, &self.active.choice.id.clone());
        let slot = &mut self.active;
        let (choice, from) = (slot.choice.clone(), slot.known().map(|before| before.id.clone()));
        slot.info = Some(info.clone());
        slot.is_ready = true;
        if slot.prepare == Prepare::Open {
            slot.prepare = Prepare::No;
        }
        self.happened.push(EventKind::PlannerChosen { ask: Some(ask), choice, info: Box::new(info), from });
    }

    fn plan_arrived(&mut self, ask: AskId, asked: AskedPlan, plan: Plan, said: Said) {
        let id = self.active.choice.id.clone();
        self.happened.pass_on(said, &id);
        let Evaluated { plan, events, objection } = self.known.evaluate(Some(ask), &id, &asked, plan);
        self.happened.extend(events);
        let may_retry =
            objection.as_ref().is_some_and(|why| why.by_tether) && self.known.may_try_from_anchor(&asked);
        if !may_retry {
            self.show_first_plan(&plan, objection.as_ref());
        }
        match objection {
            None => {
                let is_repair = asked.is_repair && self.known.task.keeps_to(&plan);
                self.take_plan(&plan);
                self.plan_is_there();
                if is_repair {
                    self.want_better_plan();
                }
            }
            Some(_) if may_retry => {
                self.active.plan = PlanState::Due { reason: asked.reason, from_anchor: true };
            }
            Some(Objection { by_tether, message }) => {
                self.active.plan = PlanState::due(asked.reason);
                self.active_is_no_use(if by_tether {
                    HoldReason::PlanRefused { message }
                } else {
                    HoldReason::PlannerFault { message }
                });
            }
        }
    }
    /// The active planner has a plan that flies: a hold that it was to end, or that blamed another planner, is over.
    pub(super) fn plan_is_there(&mut self) {
        let was_ordered = std::mem::take(&mut self.active.prepare) == Prepare::Plan;
        let Phase::Held(hold) = &self.known.phase else { return };
        if hold.resumes == Resumes::ByFallback {
            self.go_on(Gait::Steady);
        } else if was_ordered && (hold.by.blames_planner() || matches!(hold.by, HoldReason::Stuck { .. })) {
            // The reason is gone with the planner; now it is the operator who lets the robot go on.
            self.hold(Hold { by: HoldReason::PlannerReplaced, resumes: Resumes::Never });
        }
    }

    fn fail_active(&mut self, Failed { ask, kind, fault, said }: Failed) {
        self.happened.pass_on(said, &self.active.choice.id.clone());
        let (message, cause, is_no_way) = (fault.message.clone(), fault.cause, fault.is_no_way());
        self.note_fault(ask, fault, self.active.info.as_ref().map(|info| info.sha256.clone()));
        let says_no = matches!(cause, Cause::Planner(_) | Cause::Refused);
        match kind {
            // It goes on with the values that it has; as a new instance it may take others.
            PendingKind::Reconfigure(choice) if says_no => {
                let unsupported = cause == Cause::Planner(Code::Unsupported);
                // A planner that was ordered meanwhile stays ordered.
                if unsupported && self.candidate.is_none() && !self.known.is_running() {
                    let prepare = self.active.prepare;
                    self.choose(choice, planner_api::Reason::Operator);
                    // A plan that was ordered before the start stays ordered.
                    self.active.prepare = prepare.max(self.active.prepare);
                }
                return;
            }
            PendingKind::Plan(_)
            | PendingKind::Step { .. }
            | PendingKind::StepInShadow
            | PendingKind::Snapshot
                if says_no => {}
            _ => self.close_active(),
        }
        if self.known.is_waiting() {
            self.active.first_plan = Some(Err(message.clone()));
        }
        if !self.active.has_plan() {
            // The operator agreed to the plan that was refused, not to one of later.
            self.known.allow_uncertified(
                self.known.config.tether.as_ref().is_some_and(|tether| tether.allow_uncertified),
            );
        }
        self.active_is_no_use(if is_no_way {
            HoldReason::Stuck { message }
        } else {
            HoldReason::PlannerFault { message }
        });
    }

    /// The active planner cannot drive the robot on.
    fn active_is_no_use(&mut self, by: HoldReason) {
        self.drop_better_plan("the planner that drives failed");
        self.active.prepare = Prepare::No;
        let is_to_be_held = match &self.known.phase {
            Phase::Running(_) => true,
            Phase::Held(hold) => hold.by.blames_planner(),
            Phase::Waiting | Phase::Ended(_) => false,
        };
        if is_to_be_held {
            let resumes = self.rules.fallback.resumes(&self.known.config, &self.active.choice.id);
            self.hold(Hold { by, resumes });
        }
    }

    /// Reports a fault, and counts it against its plugin if it is of the kind that counts.
    pub(super) fn note_fault(&mut self, ask: AskId, fault: Fault, sha256: Option<String>) {
        let counts =
            !matches!(fault.cause, Cause::Planner(_) | Cause::Refused | Cause::Quarantined | Cause::Starved);
        if let Some(sha256) = fault.plugin_sha256.clone().or(sha256).filter(|_| counts) {
            let now_s = self.known.now_s();
            self.workers.quarantine.note(&sha256, now_s);
        }
        self.happened.push(EventKind::PlannerFailed { ask: Some(ask), fault });
    }
}

/// A planner that was opened and is not let drive.
fn refused(info: &PlannerInfo, during: During, cause: Cause, message: String) -> Fault {
    let (planner, plugin_sha256) = (info.id.clone(), Some(info.sha256.clone()));
    Fault { planner, during, cause, message, partial: Vec::new(), plugin_sha256 }
}

/// An answer of another kind than the ask.
pub(super) fn mismatch(planner: &str) -> Fault {
    Fault {
        planner: planner.to_owned(),
        during: During::Step,
        cause: Cause::Protocol,
        message: format!("planner {planner} sent an answer that does not match the request"),
        partial: Vec::new(),
        plugin_sha256: None,
    }
}
