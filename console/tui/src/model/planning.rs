//! The planner as the screen knows it.

use mission::{AskId, PlannerChoice, PlannerInfo, WorkerId, event::Effort, planner::Fault};
use planner_api::{Command, Drawing};
use serde::{Deserialize, Serialize};
use world::Point;

/// A plan, thinned out for drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanShown {
    /// The ask that it answers.
    #[serde(default)]
    pub ask: Option<AskId>,
    /// Points of the path.
    pub path: Vec<Point>,
    /// Length of the whole path, metres.
    pub length_m: f64,
    /// Whether it achieves the whole task.
    pub complete: bool,
    /// Mission time at which it was made, seconds.
    pub t_s: f64,
}

/// A plan that is better than the rest of the one that is flown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Offer {
    /// What the rest takes.
    pub flown: Effort,
    /// What the better plan takes.
    pub better: Effort,
    /// Where it begins.
    pub begins: Option<Point>,
    /// Whether it is taken where it begins: the operator has ordered it, or the scenario says so.
    pub is_taken: bool,
}

/// The planner and what it last did.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Planning {
    /// The active planner, with the parameters set by hand.
    pub choice: Option<PlannerChoice>,
    /// Who it is.
    pub info: Option<PlannerInfo>,
    /// Its plan.
    pub plan: Option<PlanShown>,
    /// Its last command, with the mission time of it, seconds.
    pub command: Option<(f64, Command)>,
    /// Its last drawings.
    pub drawings: Vec<Drawing>,
    /// The tick of these.
    pub drawings_tick: u64,
    /// Its last figures: name, value, unit.
    pub scalars: Vec<(String, f64, String)>,
    /// Its last failure, until it is active again.
    pub fault: Option<Fault>,
    /// The worker of a planner that is being prepared; its plans are not flown yet.
    #[serde(default)]
    pub candidate: Option<WorkerId>,
    /// Whether the last plan was of that planner: the certificate that follows says nothing of the plan that is flown.
    #[serde(default)]
    pub proposed: bool,
    /// A better plan that is offered, or was taken and is flown from where it begins.
    #[serde(default)]
    pub offer: Option<Offer>,
}
