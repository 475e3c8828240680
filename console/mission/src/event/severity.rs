//! How severe events are for the operator.

use crate::{
    phase::HoldReason,
    planner::{Cause, Fault},
};
use serde::{Deserialize, Serialize};
use world::tether::Certificate;

/// The severity of an event for the operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// For the developers of planners; hidden unless asked for.
    Debug,
    /// Worth knowing.
    Info,
    /// Worth watching.
    Watch,
    /// Needs attention.
    Warn,
    /// Needs action now.
    Crit,
}

impl Fault {
    /// The severity of a fault. A late answer may be due to the machine, a refused planner was never active, a planner
    /// that refuses new values continues with its old ones, and "no path exists" is an answer rather than a fault.
    pub fn severity(&self) -> Severity {
        match self.cause {
            _ if self.is_no_way() || self.refuses_change() => Severity::Warn,
            Cause::Late | Cause::Starved | Cause::Refused => Severity::Warn,
            _ => Severity::Crit,
        }
    }
}

/// The severity of a hold.
pub(super) fn of_hold(by: &HoldReason) -> Severity {
    match by {
        HoldReason::Operator | HoldReason::Stepped | HoldReason::PlannerReplaced => Severity::Info,
        HoldReason::ZoneBreached { .. } | HoldReason::Vehicle { .. } | HoldReason::Guard { .. } => {
            Severity::Crit
        }
        HoldReason::PositionLost
        | HoldReason::RangesInconsistent
        | HoldReason::PlannerFault { .. }
        | HoldReason::PlannerSilent { .. }
        | HoldReason::PlanRefused { .. }
        | HoldReason::Tether { .. }
        | HoldReason::Stuck { .. } => Severity::Warn,
    }
}

/// The severity of a plan's certificate; a certified plan with a warning is worth a look. A refused plan is not run; whatever follows has its own event: a plan from the
/// anchor, or a hold. If a different planner is active, nothing follows.
pub(super) fn of_certificate(certificate: &Certificate) -> Severity {
    if certificate.certified && certificate.warnings.is_empty() { Severity::Info } else { Severity::Warn }
}
