//! Flies a scenario on behalf of every caller: the console, `tankops run`, a what-if, or a verification.
//!
//! A [`Flight`] combines a vehicle and the mission, tick by tick. The planners' answers come from an implementation
//! of [`answers::Answers`]. Before a flight, the scenario is read ([`scenarios`]) and checked against the installed
//! planners ([`planners`]).

pub mod answers;
pub mod behind;
pub mod failure;
mod flown;
pub mod hosts;
mod live;
pub mod plan_watch;
pub mod planners;
pub mod recorded;
pub mod remains;
pub mod scenarios;
mod simulated;
pub mod texts;
pub mod unrecorded;

pub use flown::{Flight, Forked};
