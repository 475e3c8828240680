//! The mission: a pure function from sensor readings to the motion of the robot, with events that report everything worth
//! knowing.
//!
//! This crate uses no clock, file, thread or terminal: the same inputs produce the same events. The only outputs of the
//! engine are [`Event`]s, asks to planners, and commands to the robot.
//!
//! Suggested reading order: [`engine`] (the tick), [`event`] (its outputs), [`order`] and [`config`] (its inputs),
//! [`phase`] and [`standing`] (what the mission is doing, and which orders it accepts meanwhile), [`ask`] (the interface
//! to planners).

pub mod ask;
mod channels;
mod chart;
mod clock;
pub mod config;
pub mod engine;
pub mod event;
mod governor;
mod instrument;
mod locate;
pub mod order;
pub mod outline;
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
mod way_back;
mod zone_cost;

pub use ask::{Answer, Ask, AskId, Awaits, Given, Said, What, WorkerId};
pub use channels::Channels;
pub use clock::clock;
pub use config::{
    BetterPlan, Guarantee, Locating, MissionConfig, OwnClocks, ScanConfig, TaskConfig, TetherConfig,
};
pub use engine::{Fork, Input, Mission, Sending, Step};
pub use event::{ClockOffset, Event, EventKind, LogLine, RunOpened, Severity};
pub use instrument::{InstrumentConfig, InstrumentKind, Sampling};
pub use locate::Locator;
pub use order::{Check, CheckOutcome, Injection, Note, Noted, Order, Outlook, RangeFault};
pub use passage::Passage;
pub use perception::Sensor;
pub use phase::{Gait, Hold, HoldReason, Outcome, Phase, Resumes, StepTo};
pub use plan_extent::check_extent;
pub use plan_id::{PlanId, PlanSeen};
pub use planner::{
    Cause, During, Fault, ParamInfo, ParamKind, ParamValue, Parameters, PlannerChoice, PlannerInfo,
    RefusedPlugin, Sandbox,
};
pub use preview::preview;
pub use standing::{FoldedStanding, InShadow, PositionTrust, Readiness, Refusal, Standing};
pub use way_back::{Home, WayBack};
pub use zone_cost::ZoneCost;
