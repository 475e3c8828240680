//! The interface to planners: the mission's requests and the planners' answers.
//!
//! The mission never waits. It issues [`Ask`]s and continues; the caller that runs the planners passes each [`Answer`]
//! back when it arrives, in the same tick or in a later one. An ask owns all its data, so it can be stored, sent to
//! another process, or sent again to another planner.
//!
//! Lengths are in metres. Angles are in radians, counter-clockwise from the x axis of the tank frame.

mod comparison;

pub use comparison::Comparison;
pub use planner_api::message::{
    Obstacle as SiteObstacle, PlanRequest as PlanAsk, Sensed as StepAsk, Site, Task as TaskLeft,
    Zone as SiteZone,
};

use crate::planner::{Fault, Parameters, PlannerChoice, PlannerInfo};
use planner_api::{Command, Drawing, LogLevel, Plan};
use serde::{Deserialize, Serialize};
use std::{fmt, sync::Arc};

/// One planner instance in a worker process. The mission numbers the instances and never reuses a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct WorkerId(pub u16);

/// The id of an ask. Asks are numbered separately for each worker, so the ids of one planner's asks do not depend on
/// another planner's timing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(from = "(WorkerId, u32)", into = "(WorkerId, u32)")]
pub struct AskId {
    /// The worker that is asked.
    pub worker: WorkerId,
    /// Number of the ask, counted from 1 for each worker.
    pub n: u32,
}

impl From<(WorkerId, u32)> for AskId {
    fn from((worker, n): (WorkerId, u32)) -> Self {
        Self { worker, n }
    }
}

impl From<AskId> for (WorkerId, u32) {
    fn from(id: AskId) -> Self {
        (id.worker, id.n)
    }
}

impl fmt::Display for AskId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.worker.0, self.n)
    }
}

/// A request from the mission to a planner. A worker has at most one open ask, not counting [`What::Close`].
#[derive(Debug, Clone, PartialEq)]
pub struct Ask {
    /// Id of the ask; the answer carries the same id.
    pub id: AskId,
    /// The request.
    pub what: What,
}

/// The kinds of request to a planner.
#[derive(Debug, Clone, PartialEq)]
pub enum What {
    /// Start a worker process, load the plugin, create the planner, and restore the state of an earlier instance.
    Open {
        /// The planner, with its manually set parameters.
        choice: PlannerChoice,
        /// The tank as known so far.
        site: Arc<Site>,
        /// The [`What::Snapshot`] from which the new instance restores its state; used only if planner and plugin file
        /// have not changed.
        restore: Option<AskId>,
    },
    /// Change live parameters; parameters that are not listed keep their values.
    Reconfigure(Parameters),
    /// Make a plan.
    Plan(Box<PlanAsk>),
    /// Compute the command for this tick.
    Step(Box<StepAsk>),
    /// Save the private state. The process that runs the planners keeps the state itself; the mission remembers only the
    /// id of the ask.
    Snapshot,
    /// Abandon the current request and end the process. This request has no answer.
    Close,
}

/// The answer to an ask.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Id of the ask.
    pub ask: AskId,
    /// The result, or the fault that prevented it.
    pub result: Result<Given, Fault>,
    /// Drawings, figures and log messages that came with the answer.
    pub said: Said,
}

/// The result of a successful ask.
#[derive(Debug, Clone, PartialEq)]
pub enum Given {
    /// The planner is loaded, created and ready.
    Opened(Box<PlannerInfo>),
    /// The planner accepted the new values.
    Reconfigured,
    /// A plan.
    Plan(Plan),
    /// A command.
    Command(Command),
    /// The state was saved under the id of the ask; the length is 0 if the planner had no state to save.
    State {
        /// Length of the state, bytes.
        bytes: u64,
    },
}

/// The drawings, figures and log messages that came with a planner's answer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Said {
    /// The drawings.
    pub drawings: Vec<Drawing>,
    /// Named figures: name, value, unit.
    pub scalars: Vec<(String, f64, String)>,
    /// The log messages, with their levels.
    pub logs: Vec<(LogLevel, String)>,
}

/// The answer that the mission would like to have before the tick ends. The mission can continue without it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Awaits {
    /// No ask is open.
    Nothing,
    /// Only the planner in shadow has been asked; nothing depends on its answer.
    Shadow,
    /// Only a planner that is not active yet has been asked; the robot does not depend on its answer.
    Candidate,
    /// The robot stands still until the active planner has been opened or has made a plan.
    Work,
    /// The command for this tick.
    Step,
}
