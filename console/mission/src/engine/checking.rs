//! Which answers from planners are refused, and which faults count against a plugin.

use super::{Mission, known::Known, worker::Worker, workers};
use crate::{
    ask::{AskId, Given},
    config::TaskConfig,
    event::EventKind,
    plan_extent::check_extent,
    planner::{Cause, During, Fault, PlannerInfo},
};

impl Known {
    /// Refuses a planner that cannot run this mission.
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
    /// Refuses a planner that was opened but is quarantined or cannot run this mission.
    pub(super) fn checked(&self, worker: &Worker, given: Given) -> Result<Given, Fault> {
        if let Given::Opened(info) = &given
            && let Some(message) = self.barred(info)
        {
            return Err(refused(info, During::Load, Cause::Quarantined, message));
        }
        self.known.fitting(worker, given)
    }

    /// Why a planner cannot be used again in this mission; `None` if it can.
    pub(super) fn barred(&self, info: &PlannerInfo) -> Option<String> {
        let (faults, window_s) = (workers::MOST_FAULTS, workers::WINDOW_S);
        let message = || {
            format!(
                "planner {} failed {faults} times within {window_s} s and cannot be used again in this \
                 mission",
                info.id
            )
        };
        self.workers.quarantine.holds(&info.sha256).then(message)
    }

    /// Reports a fault of a planner. The fault counts against the plugin unless its cause is one of those excluded
    /// below.
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

/// The fault for a planner that was opened but cannot be used.
fn refused(info: &PlannerInfo, during: During, cause: Cause, message: String) -> Fault {
    Fault { plugin_sha256: Some(info.sha256.clone()), ..fault(&info.id, during, cause, message) }
}

/// The fault for an answer that does not match the kind of the ask.
pub(super) fn mismatch(planner: &str) -> Fault {
    let message = format!("planner {planner} sent an answer that does not match the request");
    fault(planner, During::Step, Cause::Protocol, message)
}

fn fault(planner: &str, during: During, cause: Cause, message: String) -> Fault {
    Fault { planner: planner.to_owned(), during, cause, message, partial: Vec::new(), plugin_sha256: None }
}
