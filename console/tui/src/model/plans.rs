//! What is known of a mission before it moves: what its plan promises, and a second plan beside it.

use account::Estimate;
use mission::{AskId, PlannerChoice};
use serde::{Deserialize, Serialize};
use world::Point;

/// What is known of a mission before it moves.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Plans {
    /// What the plan of the mission promises, and the ask that the plan answers.
    pub estimate: Option<(Option<AskId>, Estimate)>,
    /// Another planner's plan, for comparison.
    pub ghost: Option<Ghost>,
}

/// Another planner's plan, for comparison; it is never flown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ghost {
    /// The planner, with its parameters.
    pub choice: PlannerChoice,
    /// When its planning began, on the console's own clock, seconds.
    pub since_mono_s: f64,
    /// How far it is: the share done, 0 to 1, and what is being done.
    pub at: Option<(f64, String)>,
    /// The plan, or why there is none, as a sentence; `None` while it is being made.
    pub made: Option<Result<GhostPlan, String>>,
}

/// A plan that is shown and not flown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GhostPlan {
    /// Points of its path.
    pub path: Vec<Point>,
    /// What it promises.
    pub estimate: Estimate,
    /// Whether it is certified for the tether; `None` without one.
    pub certified: Option<bool>,
}
