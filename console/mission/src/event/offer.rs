//! Better plans in events: how far an offer has come, why it ended, and how much floor both plans scan.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The stage of the offer of a better plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OfferStage {
    /// The plan is offered; the robot keeps to its current plan unless the operator takes the offer.
    Offered,
    /// The plan was taken, by order or by the scenario; the robot changes over at the place where the plan begins.
    Accepted,
}

/// The reason for dropping a better plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OfferEnd {
    /// The robot passed the place where the plan begins before anyone took the offer.
    Passed,
    /// The plan arrived after the robot had passed the place where the plan begins.
    TooLate,
    /// Too little of the current plan was left.
    TooLittleLeft,
    /// The map changed.
    MapChanged,
    /// A no-go zone was drawn.
    ZoneDrawn,
    /// The operator ordered the robot to drive back.
    DrivingBack,
    /// The operator chose a different planner.
    OtherPlannerChosen,
    /// A different planner became active.
    OtherPlannerActive,
    /// A parameter was changed.
    ParameterChanged,
    /// A different plan was taken, or is being made.
    OtherPlan,
    /// The active planner failed.
    PlannerFailed,
    /// The planner that made the plan failed.
    MakerFailed {
        /// Message of the fault.
        message: String,
    },
    /// The plan had become unsafe when the robot reached the place where it begins.
    Unsafe {
        /// The reason, as a sentence.
        message: String,
    },
}

impl fmt::Display for OfferEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Passed => "robot passed the start of the plan",
            Self::TooLate => "it arrived after the robot had passed its start",
            Self::TooLittleLeft => "too little of the current plan is left",
            Self::MapChanged => "the map has changed",
            Self::ZoneDrawn => "a no-go zone was drawn",
            Self::DrivingBack => "the robot is driving back",
            Self::OtherPlannerChosen => "a different planner was chosen",
            Self::OtherPlannerActive => "a different planner is active",
            Self::ParameterChanged => "a parameter was changed",
            Self::OtherPlan => "the current plan has changed",
            Self::PlannerFailed => "the active planner failed",
            Self::MakerFailed { message } | Self::Unsafe { message } => message,
        })
    }
}

/// The floor that a plan leaves unscanned, and the share that is scanned at its end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlanScan {
    /// Requested floor that is left unscanned at the end of the plan, square metres.
    pub left_m2: f64,
    /// Scanned share of the reachable floor at the end of the plan, 0 to 1.
    pub covered_reachable: f64,
}

/// The floor that two plans scan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PlanScans {
    /// The current plan.
    pub flown: PlanScan,
    /// The better plan.
    pub better: PlanScan,
}
