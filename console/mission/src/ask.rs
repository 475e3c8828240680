//! The port to planners: what the mission asks for, and the answers that enter it.
//!
//! The mission never waits. It hands out [`Ask`]s and goes on; whoever runs the planners gives each [`Answer`] back
//! when it is there, in the same tick or in a later one. Everything in an ask is owned, so it can be kept, sent to
//! another process, or asked again of another planner.
//!
//! Lengths are metres, angles radians, counter-clockwise from the x axis, in the tank frame.

mod comparison;
mod site;

pub use comparison::Comparison;
pub use site::{Site, SiteObstacle, SiteZone};

use crate::planner::{Fault, Parameters, PlannerChoice, PlannerInfo};
use planner_api::{self as api, Command, Drawing, LogLevel, Plan, PoseEstimate, Reason, TetherLimits};
use serde::{Deserialize, Serialize};
use std::{fmt, sync::Arc};
use world::Point;

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

/// What is left of a task, with its arrays.
#[derive(Debug, Clone, PartialEq)]
pub enum TaskLeft {
    /// Reach a point.
    Goto {
        /// The point.
        goal: Point,
        /// Distance at which it counts as reached, metres.
        tolerance_m: f64,
    },
    /// Follow targets in order.
    Follow {
        /// The targets that are left.
        targets: Vec<Point>,
        /// Distance at which the last one counts as reached, metres.
        tolerance_m: f64,
    },
    /// Scan floor and come back.
    Cover {
        /// Where the tether comes in, and where the path ends.
        anchor: Point,
        /// The floor to scan, as polygons; empty for all of it.
        regions: Vec<Vec<Point>>,
        /// The tether, if there is one.
        tether: Option<TetherLimits>,
        /// Distance at which the end counts as reached, metres.
        tolerance_m: f64,
    },
}

/// The inputs of a plan; the owned form of [`planner_api::PlanRequest`].
#[derive(Debug, Clone, PartialEq)]
pub struct PlanAsk {
    /// Why a plan is wanted.
    pub reason: Reason,
    /// Where it starts.
    pub start: PoseEstimate,
    /// What is to be achieved.
    pub task: TaskLeft,
    /// The tank as it is known.
    pub site: Arc<Site>,
    /// The path flown so far, and a return path before the plan.
    pub previous: Vec<Point>,
    /// What is left of the plan that it is to keep to, if there is one.
    pub under_way: Option<Plan>,
}

/// The inputs of a command; the owned form of [`planner_api::Sensed`].
#[derive(Debug, Clone, PartialEq)]
pub struct StepAsk {
    /// Number of the tick.
    pub tick: u64,
    /// Mission time, seconds.
    pub t_s: f64,
    /// Length of a tick, seconds.
    pub dt_s: f64,
    /// Where the robot believes to be.
    pub pose: PoseEstimate,
    /// Speed that was commanded last, metres per second.
    pub v_m_per_s: f64,
    /// Turn rate that was commanded last, radians per second.
    pub w_rad_per_s: f64,
    /// Where to go next.
    pub target: Point,
    /// The targets from the next one on.
    pub targets_ahead: Vec<Point>,
    /// The plan from here on.
    pub path_ahead: Vec<Point>,
    /// Obstacles within sensing range.
    pub obstacles: Vec<SiteObstacle>,
}

impl PlanAsk {
    /// Lends the request in the form that planners read.
    pub fn lend<R>(&self, call: impl FnOnce(&api::PlanRequest<'_>) -> R) -> R {
        let regions: Vec<&[Point]> = match &self.task {
            TaskLeft::Cover { regions, .. } => regions.iter().map(Vec::as_slice).collect(),
            TaskLeft::Goto { .. } | TaskLeft::Follow { .. } => Vec::new(),
        };
        let task = match &self.task {
            TaskLeft::Goto { goal, tolerance_m } => {
                api::Task::Goto { goal: *goal, tolerance_m: *tolerance_m }
            }
            TaskLeft::Follow { targets, tolerance_m } => {
                api::Task::Follow { targets, tolerance_m: *tolerance_m }
            }
            TaskLeft::Cover { anchor, tether, tolerance_m, .. } => api::Task::Cover {
                anchor: *anchor,
                regions: &regions,
                tether: *tether,
                tolerance_m: *tolerance_m,
            },
        };
        let Self { reason, start, previous, under_way, .. } = self;
        let (start, under_way) = (*start, under_way.as_ref());
        self.site.lend(|site| call(&api::PlanRequest { reason, start, task, site, previous, under_way }))
    }
}

impl StepAsk {
    /// Lends what is sensed in the form that planners read.
    pub fn lend<R>(&self, call: impl FnOnce(&api::Sensed<'_>) -> R) -> R {
        let obstacles: Vec<api::Obstacle<'_>> = self.obstacles.iter().map(SiteObstacle::lend).collect();
        call(&api::Sensed {
            tick: self.tick,
            t_s: self.t_s,
            dt_s: self.dt_s,
            pose: self.pose,
            v_m_per_s: self.v_m_per_s,
            w_rad_per_s: self.w_rad_per_s,
            target: self.target,
            targets_ahead: &self.targets_ahead,
            path_ahead: &self.path_ahead,
            obstacles: &obstacles,
        })
    }
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
