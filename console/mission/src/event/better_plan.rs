//! Better plans as events: a plan that was made after a repair, and its end.

use super::{Effort, OfferEnd, OfferStage, PlanScans};
use crate::ask::AskId;
use planner_api::Leg;
use serde::{Deserialize, Serialize};
use world::Point;

/// After a repair, a plan for the rest of the task was made in the background. It begins at a place ahead on the
/// current plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanMade {
    /// Id of the ask that this answers.
    pub ask: AskId,
    /// Id of the planner.
    pub planner: String,
    /// The path.
    pub path: Vec<Point>,
    /// Whether the plan achieves the whole task.
    pub complete: bool,
    /// The stretches of the path and their purposes, if the planner states them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub legs: Vec<Leg>,
    /// Lines that the tethered robot never crosses.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cuts: Vec<Vec<Point>>,
    /// The effort of the current plan from that place on.
    pub flown: Effort,
    /// The effort of this plan.
    pub better: Effort,
    /// The floor that both plans scan; absent if this plan saves too little to be offered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scans: Option<PlanScans>,
    /// The reason why the plan is not offered, as a sentence; absent if it is offered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objection: Option<String>,
}

/// The better plan was taken in this tick. The events for the activation of its planner, the plan from here on, and
/// the certificate of that plan follow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanTaken {
    /// Id of the planner.
    pub planner: String,
    /// The effort of the previous plan from here on.
    pub flown: Effort,
    /// The effort of this plan.
    pub better: Effort,
}

/// The better plan was dropped, either while it was being made or after it had been offered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanDropped {
    /// Id of the planner that made the plan.
    pub planner: String,
    /// The reason, as a sentence.
    pub why: String,
    /// The stage of the offer; absent if the plan was still being made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage: Option<OfferStage>,
    /// The reason; absent in older journals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<OfferEnd>,
}
