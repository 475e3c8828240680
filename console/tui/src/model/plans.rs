//! The plan before the start, with its estimate, and a second plan for comparison.

use super::{Lane, PlanShown, planning};
use account::{Estimate, LeftOut};
use mission::{AskId, MissionConfig, PlannerChoice};
use planner_api::Leg;
use serde::{Deserialize, Serialize};
use world::Point;

/// The plans before the start.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Plans {
    /// Whether the first plan was ordered and the mission has not answered yet.
    #[serde(default)]
    pub is_asked: bool,
    /// The estimate for the mission's plan, and the ask that the plan answers.
    pub estimate: Option<(Option<AskId>, Estimate)>,
    /// The number of lanes of the plan that the estimate is for; 0 if it has no lanes.
    #[serde(default)]
    pub lanes: usize,
    /// The floor that the mission's plan leaves out, and the ask that the plan answers.
    #[serde(default)]
    pub left_out: Option<(Option<AskId>, LeftOut)>,
    /// A different planner's plan, for comparison.
    pub ghost: Option<Ghost>,
}

/// A different planner's plan, for comparison; it never runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ghost {
    /// The planner, with its parameters.
    pub choice: PlannerChoice,
    /// When planning began, on the console's own clock, seconds.
    pub since_mono_s: f64,
    /// Progress: the share done, 0 to 1, and the current activity.
    pub at: Option<(f64, String)>,
    /// The plan, or why there is none, as a sentence; `None` while planning.
    pub made: Option<Result<GhostPlan, String>>,
}

/// A plan that is shown but does not run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GhostPlan {
    /// The points of the path, thinned for drawing.
    pub path: Vec<Point>,
    /// The lanes of the path.
    #[serde(default)]
    pub lanes: Vec<Lane>,
    /// The estimate for the plan.
    pub estimate: Estimate,
    /// Whether the plan is certified for the tether; `None` without a tether.
    pub certified: Option<bool>,
}

impl GhostPlan {
    /// The plan of a planner for a mission, from the points and legs of its path.
    pub fn new(
        mission: &MissionConfig,
        path: &[Point],
        legs: &[Leg],
        estimate: Estimate,
        certified: Option<bool>,
    ) -> Self {
        let (path, lanes) = planning::shown(path, legs, PlanShown::least_lane_m(mission));
        Self { path, lanes, estimate, certified }
    }
}
