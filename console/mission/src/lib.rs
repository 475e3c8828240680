//! The mission: one pure step from what is sensed to what the robot does, and everything worth knowing on the way.
//!
//! No clock, no file, no thread, no terminal: the same inputs give the same events. Whoever wants to know about a
//! run reads [`Event`]s; nothing else leaves the engine but the commands to the robot.

pub mod config;
pub mod event;
pub mod link;
pub mod order;

pub use config::{MissionConfig, PlannerChoice, TaskConfig};
pub use event::{Event, EventKind, Outcome, Severity};
pub use link::{Cause, During, Fault, ParamInfo, ParamKind, ParamValue, Parameters, PlannerInfo, PlannerLink, Reply};
pub use order::Order;
