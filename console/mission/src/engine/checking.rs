//! What is refused of what planners answer, and which faults count against them.

use super::{Mission, known::Known, worker::Worker, workers};
use crate::{
    ask::{AskId, Given},
    config::TaskConfig,
    event::EventKind,
    plan_extent::check_extent,
    planner::{Cause, During, Fault, PlannerInfo},
};

impl Known {
    /// Refuses a planner that cannot fly this mission.
    pub(super) fn fitting(&self, worker: &Worker, given: Given) -> Result<Given, Fault> {
        let id = worker.id();
        if let Given::Plan(plan) = &given
            && let Err(what) = check_extent(plan, &self.chart.world().boundary, self.config.lane_m())
        {
            let plugin_sha256 = worker.info.as_ref().map(|info| info.sha256.clone());
            let message = format!("planner {id} {what}");
            return Err(Fault { plugin_sha256, ..fault(id, During::Plan, Cause::BadOutput, message) });
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
    /// Refuses a planner that may not or cannot fly this mission, although it could be opened.
    pub(super) fn checked(&self, worker: &Worker, given: Given) -> Result<Given, Fault> {
        if let Given::Opened(info) = &given
            && let Some(message) = self.barred(info)
        {
            return Err(refused(info, During::Load, Cause::Quarantined, message));
        }
        self.known.fitting(worker, given)
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

    /// Reports a fault of a planner, and counts it against its plugin if it is of the kind that counts.
    pub(super) fn note_fault(&mut self, ask: AskId, fault: Fault, of: Option<&PlannerInfo>) {
        let counts =
            !matches!(fault.cause, Cause::Planner(_) | Cause::Refused | Cause::Quarantined | Cause::Starved);
        let sha256 = fault.plugin_sha256.as_ref().or(of.map(|info| &info.sha256));
        if let Some(sha256) = sha256.filter(|_| counts) {
            self.workers.quarantine.note(sha256, self.known.now_s());
        }
        self.happened.push(EventKind::PlannerFailed { ask: Some(ask), fault });
    }
}

/// A planner that was opened and is not let drive.
fn refused(info: &PlannerInfo, during: During, cause: Cause, message: String) -> Fault {
    Fault { plugin_sha256: Some(info.sha256.clone()), ..fault(&info.id, during, cause, message) }
}

/// An answer of another kind than the ask.
pub(super) fn mismatch(planner: &str) -> Fault {
    let message = format!("planner {planner} sent an answer that does not match the request");
    fault(planner, During::Step, Cause::Protocol, message)
}

fn fault(planner: &str, during: During, cause: Cause, message: String) -> Fault {
    Fault { planner: planner.to_owned(), during, cause, message, partial: Vec::new(), plugin_sha256: None }
}
