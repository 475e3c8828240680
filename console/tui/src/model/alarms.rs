//! What is wrong, and whether the operator has seen it: a life cycle after ISA-18.2.
//!
//! One alarm per cause. It is unacknowledged while its cause persists and nobody has seen it, acknowledged once somebody
//! has, returned if it cleared before that, shelved while the operator has put it aside, and cleared when nothing is left
//! to do. CRIT and WARN are latched until they are acknowledged; what is only to be watched clears with its cause.

mod alarm;
mod cause;
mod list;

pub mod limit;

pub use alarm::{Alarm, Reading, Shelf, State};
pub use cause::Cause;
pub use list::Alarms;

#[cfg(test)]
mod tests;
