//! Goal planners on random traps: U, triangle, spiral and double traps among free discs.
//!
//! The reference is the exact shortest path on the whole map. Known map: one plan, whose path is measured. Unknown
//! map: a drive on which discs within the sensing range are discovered; the planner replans on every discovery, and
//! its own commands drive the robot.

mod flight;
mod measured;
mod rows;
mod suite;

use crate::study::Study;

/// The studies.
pub(crate) const STUDIES: &[Study] = &[Study {
    name: "trap-suite",
    about: "goal planners on random U, triangle, spiral and double traps, against the exact shortest path",
    layouts: 50,
    run: suite::run,
}];
