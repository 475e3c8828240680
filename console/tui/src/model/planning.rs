//! The planner as shown on the screen.

use mission::event::{Effort, PlanScans};
use mission::{AskId, PlannerChoice, PlannerInfo, WorkerId, planner::Fault};
use planner_api::{Command, Drawing};
use serde::{Deserialize, Serialize};
use world::{Point, coverage::percent_text};

/// A plan, thinned for drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanShown {
    /// The ask that the plan answers.
    #[serde(default)]
    pub ask: Option<AskId>,
    /// The points of the path.
    pub path: Vec<Point>,
    /// The length of the whole path, metres.
    pub length_m: f64,
    /// Whether the plan achieves the whole task.
    pub complete: bool,
    /// Mission time at which the plan was made, seconds.
    pub t_s: f64,
}

/// A plan that is better than the rest of the current one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Offer {
    /// The effort for the rest of the current plan.
    pub flown: Effort,
    /// The effort for the better plan.
    pub better: Effort,
    /// The floor that both plans scan; `None` if that is not known.
    #[serde(default)]
    pub scans: Option<PlanScans>,
    /// The point at which the better plan begins.
    pub begins: Option<Point>,
    /// Whether the mission will switch to the better plan at the point where that plan begins, because the operator or
    /// the scenario says so.
    pub is_taken: bool,
}

impl Offer {
    /// What the better plan saves, as a sentence without a full stop.
    pub fn sentence(&self) -> String {
        format!("Better plan: {}", self.better.saving(&self.flown))
    }

    /// The floor that the better plan scans, as a sentence; `None` if that is not known.
    pub fn scanned(&self) -> Option<String> {
        let scans = self.scans?;
        let [better, flown] = [scans.better, scans.flown].map(|scan| percent_text(scan.covered_reachable, 1));
        Some(format!("It scans {better} % (now {flown} %)."))
    }
}

/// The planner and its latest output.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Planning {
    /// The active planner, with the parameters set by hand.
    pub choice: Option<PlannerChoice>,
    /// The description of the planner.
    pub info: Option<PlannerInfo>,
    /// The current plan.
    pub plan: Option<PlanShown>,
    /// The last command, with its mission time, seconds.
    pub command: Option<(f64, Command)>,
    /// The last drawings.
    pub drawings: Vec<Drawing>,
    /// The tick of the last drawings.
    pub drawings_tick: u64,
    /// The last figures: name, value, unit.
    pub scalars: Vec<(String, f64, String)>,
    /// The last fault; cleared when the planner is active again.
    pub fault: Option<Fault>,
    /// The worker of a candidate; its plans do not run yet.
    #[serde(default)]
    pub candidate: Option<WorkerId>,
    /// Whether the candidate made the last plan; if so, the next certificate is not about the plan that is running.
    #[serde(default)]
    pub proposed: bool,
    /// A better plan that is on offer, or that was taken and will run from the point at which it begins.
    #[serde(default)]
    pub offer: Option<Offer>,
}
