//! The plan before the start, with its estimate, and a second plan for comparison.

use super::{Lane, PlanShown, planning};
use account::{Estimate, LeftOut};
use mission::{AskId, EventKind, MissionConfig, PlannerChoice, event::RunOpened};
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
    /// The planner of the plan that the estimate is for.
    #[serde(default)]
    pub planner: Option<String>,
    /// The floor that the plan of the start leaves out, and the ask that the plan answers.
    #[serde(default)]
    pub left_out: Option<(Option<AskId>, LeftOut)>,
    /// The floor that stays out with the last plan made on the way, and the ask that the plan answers.
    #[serde(default)]
    pub left_out_now: Option<(Option<AskId>, LeftOut)>,
    /// A different planner's plan, for comparison.
    pub ghost: Option<Ghost>,
}

/// The figures that the plan of the start promised, computed again from the journal of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Promise {
    /// The ask that the plan answers.
    pub ask: Option<AskId>,
    /// The planner of the plan.
    pub planner: String,
    /// The number of lanes of the plan; 0 if it has no lanes.
    pub lanes: usize,
    /// The figures.
    pub estimate: Estimate,
    /// The requested floor that the plan leaves out; `None` if nothing is to be scanned.
    pub left_out: Option<LeftOut>,
}

impl Promise {
    /// The promise of the plan with which a run began.
    pub fn new(run: &RunOpened, plan: &EventKind) -> Option<Self> {
        let EventKind::Planned { ask, planner, path, legs, complete, cuts, .. } = plan else { return None };
        let mission = &run.mission;
        let (_, lanes) = planning::shown(path, legs, PlanShown::least_lane_m(mission));
        Some(Self {
            ask: *ask,
            planner: planner.clone(),
            lanes: lanes.len(),
            estimate: Estimate::new(mission, &run.world.as_drawn(), path, *complete),
            left_out: LeftOut::of(run, path, cuts, *complete),
        })
    }
}

impl Plans {
    /// Takes the promise of the plan of the start.
    pub(crate) fn promised_at_start(&mut self, promise: Promise) {
        let Promise { ask, planner, lanes, estimate, left_out } = promise;
        (self.planner, self.lanes) = (Some(planner), lanes);
        self.estimate = Some((ask, estimate));
        self.left_out = left_out.map(|left_out| (ask, left_out));
    }
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
