//! The port to planners: what the mission asks for, and the answers that enter it.
//!
//! The mission never waits. It hands out [`Ask`]s and goes on; whoever runs the planners gives each [`Answer`] back
//! when it is there, in the same tick or in a later one. Everything in an ask is owned, so it can be kept, sent to
//! another process, or asked again of another planner.
//!
//! Lengths are metres, angles radians, counter-clockwise from the x axis, in the tank frame.

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

/// One instance of a planner in a worker process, numbered by the mission; no number is used twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct WorkerId(pub u16);

/// Names an ask. Asks are counted per worker, so that two planners do not depend on each other's timing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(from = "(WorkerId, u32)", into = "(WorkerId, u32)")]
pub struct AskId {
    /// Who is asked.
    pub worker: WorkerId,
    /// Number of the ask, from 1 for each worker.
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

/// Something that the mission wants of a planner. A worker has at most one open ask, [`What::Close`] apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Ask {
    /// Its name; the answer carries the same.
    pub id: AskId,
    /// What is wanted.
    pub what: What,
}

/// What is wanted of a planner.
#[derive(Debug, Clone, PartialEq)]
pub enum What {
    /// Start a worker process, load the plugin, make the planner, and give it the state of an earlier instance.
    Open {
        /// Which planner, with the parameters that were set by hand.
        choice: PlannerChoice,
        /// The tank as it is known.
        site: Arc<Site>,
        /// The [`What::Snapshot`] whose state the new instance starts from, if it is of the same planner and file.
        restore: Option<AskId>,
    },
    /// Take new values of live parameters; those that are not given stay.
    Reconfigure(Parameters),
    /// Make a plan.
    Plan(Box<PlanAsk>),
    /// Decide on a command.
    Step(Box<StepAsk>),
    /// Save the private state. The state stays with whoever runs the planners; the mission keeps the number of the ask.
    Snapshot,
    /// Give up what is being done and end the process. There is no answer to this one.
    Close,
}

/// What came of an ask.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Which ask.
    pub ask: AskId,
    /// What was asked for, or why not.
    pub result: Result<Given, Fault>,
    /// What the planner drew, reported and said on the way.
    pub said: Said,
}

/// What a planner gave.
#[derive(Debug, Clone, PartialEq)]
pub enum Given {
    /// It is loaded, made and ready.
    Opened(Box<PlannerInfo>),
    /// It took the new values.
    Reconfigured,
    /// A plan.
    Plan(Plan),
    /// A command.
    Command(Command),
    /// Its state was saved under the number of the ask: so many bytes; 0 if it had none to give.
    State {
        /// Length of the state, bytes.
        bytes: u64,
    },
}

/// What a planner drew, reported and said besides its answer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Said {
    /// What it drew.
    pub drawings: Vec<Drawing>,
    /// Named figures: name, value, unit.
    pub scalars: Vec<(String, f64, String)>,
    /// What it said.
    pub logs: Vec<(LogLevel, String)>,
}

/// What the mission would like to have before the tick ends. It can do without any of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Awaits {
    /// Nothing is asked.
    Nothing,
    /// Only the planner in shadow has been asked; nothing depends on the answer.
    Shadow,
    /// Only a planner that does not drive yet has been asked; the robot does not depend on the answer.
    Candidate,
    /// The robot stands until the planner that drives has been opened or has planned.
    Work,
    /// The command of this tick.
    Step,
}
