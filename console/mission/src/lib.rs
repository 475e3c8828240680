//! The mission: one pure step from what is sensed to what the robot does, and everything worth knowing on the way.
//!
//! No clock, no file, no thread, no terminal: the same inputs give the same events. Whoever wants to know about a
//! run reads [`Event`]s; nothing else leaves the engine but the commands to the robot.
//!
//! Read in this order: [`engine`] (the tick), [`event`] (what leaves it), [`order`] and [`config`] (what enters),
//! [`phase`] and [`standing`] (what the mission is doing, and which orders it accepts then), [`ask`] (the port to
//! planners).

pub mod ask;
mod chart;
pub mod config;
mod drift;
pub mod engine;
pub mod event;
mod governor;
mod locate;
pub mod order;
mod passage;
pub mod phase;
mod plan_extent;
mod plan_id;
pub mod planner;
mod preview;
pub mod spelling;
pub mod standing;
mod task;
pub mod tether;

pub use ask::{Answer, Ask, AskId, Awaits, Given, Said, What, WorkerId};
pub use config::{BetterPlan, Locating, MissionConfig, ScanConfig, TaskConfig, TetherConfig};
pub use engine::{Fork, Input, Mission, Sending, Step};
pub use event::{Event, EventKind, LogLine, RunOpened, Severity};
pub use locate::Locator;
pub use order::{Check, CheckOutcome, Injection, Note, Noted, Order, Outlook, RangeFault, StepTo};
pub use passage::Passage;
pub use phase::{Gait, Hold, HoldReason, Outcome, Phase, Resumes};
pub use plan_extent::check_extent;
pub use plan_id::{PlanId, PlanSeen};
pub use planner::{
    Cause, During, Fault, ParamInfo, ParamKind, ParamValue, Parameters, PlannerChoice, PlannerInfo,
    RefusedPlugin, Sandbox,
};
pub use preview::preview;
pub use standing::{FoldedStanding, PositionTrust, Readiness, Refusal, Standing};
