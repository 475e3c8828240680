//! Flying a scenario, whoever flies it: the console, `tankops run`, a what-if or a verification.
//!
//! A [`Flight`] is simulator and mission, tick by tick; where its planners' answers come from is an [`answers::Answers`].
//! What is flown is read ([`scenarios`]) and held against the planners that there are ([`planners`]) first.

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
