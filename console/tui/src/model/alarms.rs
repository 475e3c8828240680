//! The alarms and whether the operator has acknowledged them: a life cycle modelled on ISA-18.2.
//!
//! Each cause has one alarm. The alarm is unacknowledged until the operator acknowledges it, and acknowledged
//! afterwards. If the cause disappears before the acknowledgement, the alarm is *returned*. An alarm is *shelved*
//! while the operator has put it aside, and *cleared* when nothing is left to do. CRIT and WARN alarms are latched
//! until they are acknowledged; a watch alarm clears with its cause. How severe an alarm is and how long its cause
//! must persist depends on what the mission does (`rule`).

mod alarm;
mod cause;
mod delayed;
mod list;

pub mod limit;
pub mod rule;

pub use alarm::{Acknowledged, Alarm, Reading, Shelf, State};
pub use cause::Cause;
pub use list::Alarms;

#[cfg(test)]
mod tests;
