//! Flies a scenario for every caller: the console, `tankops run`, a what-if, or a verification.
//!
//! A [`Flight`] combines simulator and mission, tick by tick. The answers of its planners come from an
//! [`answers::Answers`]. Before a flight the scenario is read ([`scenarios`]) and checked against the installed planners
//! ([`planners`]).

pub mod answers;
pub mod failure;
mod flown;
pub mod hosts;
pub mod plan_watch;
pub mod planners;
pub mod remains;
pub mod scenarios;
pub mod texts;
pub mod unrecorded;

pub use flown::Flight;
