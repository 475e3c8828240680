//! Closed-loop trials of a planner on random layouts, for tests: a robot with a noisy pose, columns on its way, and
//! the mission's rule for the target.

pub mod flight;
pub mod layout;
pub mod score;

pub use flight::{Outcome, Robot, fly};
pub use layout::Layout;
pub use score::{Score, score};
