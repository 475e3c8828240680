//! How much events ask of the operator.

use crate::{
    phase::HoldReason,
    planner::{Cause, Fault},
};
use serde::{Deserialize, Serialize};
use world::tether::Certificate;

/// How much an event asks of the operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
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
    /// How much it asks of the operator: what came too late may be the machine's doing, what was refused has not driven the
    /// robot, and that no way exists is an answer.
    pub fn severity(&self) -> Severity {
        match self.cause {
            _ if self.is_no_way() => Severity::Warn,
            Cause::Late | Cause::Starved | Cause::Refused => Severity::Warn,
            _ => Severity::Crit,
        }
    }
}

/// How much a hold asks of the operator.
pub(super) fn of_hold(by: &HoldReason) -> Severity {
    match by {
        HoldReason::Operator | HoldReason::Stepped | HoldReason::PlannerReplaced => Severity::Info,
        HoldReason::PositionLost
        | HoldReason::RangesInconsistent
        | HoldReason::PlannerFault { .. }
        | HoldReason::PlannerSilent { .. }
        | HoldReason::PlanRefused { .. }
        | HoldReason::Tether { .. }
        | HoldReason::Stuck { .. } => Severity::Warn,
    }
}

/// How much the certificate of a plan asks of the operator. One that is refused is not flown, and what follows has an event of
/// its own: a plan from the anchor, a hold, or nothing, if another planner drives.
pub(super) fn of_certificate(certificate: &Certificate) -> Severity {
    if certificate.certified { Severity::Info } else { Severity::Warn }
}
