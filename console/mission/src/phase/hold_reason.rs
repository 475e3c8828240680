//! Why a robot is held.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Why the robot is held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldReason {
    /// The operator ordered it.
    Operator,
    /// The position is lost.
    PositionLost,
    /// The ranges contradict each other.
    RangesInconsistent,
    /// The planner failed.
    PlannerFault {
        /// Message of the fault.
        message: String,
    },
    /// The planner has not answered for too long.
    PlannerSilent {
        /// A sentence that names the planner.
        message: String,
    },
    /// The robot makes no progress, or the planner reports that there is no path.
    Stuck {
        /// The place or the reason, as a sentence.
        message: String,
    },
    /// The cable has reached a limit.
    Tether {
        /// The limit, as a sentence.
        message: String,
    },
    /// The plan cannot be certified for the tether.
    PlanRefused {
        /// The reason, as a sentence.
        message: String,
    },
    /// The hull is in a no-go zone.
    ZoneBreached {
        /// Name of the zone.
        zone: String,
    },
    /// The vehicle cannot be driven: the link is lost, a person is driving by hand, or the vehicle reports a fault.
    Vehicle {
        /// The reason, as a clause.
        message: String,
    },
    /// The scan of the vehicle shows something in the robot's way, or the scan is missing.
    Guard {
        /// The reason, as a clause.
        message: String,
    },
    /// A single step is complete.
    Stepped,
    /// The planner that caused the hold was replaced; the operator decides when the robot moves again.
    PlannerReplaced,
}

impl HoldReason {
    /// All reasons, in the order of their declaration; for tests.
    #[doc(hidden)]
    pub fn every(message: &str) -> Vec<Self> {
        let message = || message.to_owned();
        let all = vec![
            Self::Operator,
            Self::PositionLost,
            Self::RangesInconsistent,
            Self::PlannerFault { message: message() },
            Self::PlannerSilent { message: message() },
            Self::Stuck { message: message() },
            Self::Tether { message: message() },
            Self::PlanRefused { message: message() },
            Self::ZoneBreached { zone: message() },
            Self::Vehicle { message: message() },
            Self::Guard { message: message() },
            Self::Stepped,
            Self::PlannerReplaced,
        ];
        // A new reason does not compile until it is added to this match; add it to the list above, too.
        for by in &all {
            match by {
                Self::Operator
                | Self::PositionLost
                | Self::RangesInconsistent
                | Self::PlannerFault { .. }
                | Self::PlannerSilent { .. }
                | Self::Stuck { .. }
                | Self::Tether { .. }
                | Self::PlanRefused { .. }
                | Self::ZoneBreached { .. }
                | Self::Vehicle { .. }
                | Self::Guard { .. }
                | Self::Stepped
                | Self::PlannerReplaced => {}
            }
        }
        all
    }

    /// Whether an order of the operator is the cause.
    pub fn is_ordered(&self) -> bool {
        matches!(self, Self::Operator | Self::Stepped | Self::PlannerReplaced)
    }

    /// Whether the planner is the cause, so that a different planner may help.
    pub fn blames_planner(&self) -> bool {
        matches!(self, Self::PlannerFault { .. } | Self::PlannerSilent { .. } | Self::PlanRefused { .. })
    }
}

impl fmt::Display for HoldReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Operator => f.write_str("held by operator"),
            Self::PositionLost => f.write_str("held: position lost"),
            Self::RangesInconsistent => f.write_str("held: ranges contradict each other"),
            Self::PlannerFault { message }
            | Self::PlannerSilent { message }
            | Self::Tether { message }
            | Self::PlanRefused { message }
            | Self::Vehicle { message }
            | Self::Guard { message } => write!(f, "held: {message}"),
            Self::Stuck { message } => write!(f, "held: robot stuck, {message}"),
            Self::ZoneBreached { zone } => write!(f, "held: hull in zone {zone}"),
            Self::Stepped => f.write_str("held after single step"),
            Self::PlannerReplaced => f.write_str("held: planner replaced"),
        }
    }
}
