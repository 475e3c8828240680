//! The rule that decides which floor counts as scanned.

use crate::phase::Phase;

/// The status of floor that the tool passes over between two estimates of the robot's pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passage {
    /// Ignored: the mission has not been started.
    Idle,
    /// Does not count: the position is not known well enough.
    Uncertain,
    /// Counts as scanned.
    Counts,
}

impl Passage {
    /// The one rule for the mission and for all readers of its events. Floor counts as scanned from the start of the
    /// mission on, even while a held robot is braking, wherever the 95 % error of the position is within the limit for
    /// scanning (both in metres).
    ///
    /// ```
    /// use mission::{Passage, Phase};
    /// assert_eq!(Passage::of(&Phase::Waiting, 0.1, 0.2), Passage::Idle);
    /// assert_eq!(Passage::of(&Phase::Running(mission::Gait::Steady), 0.3, 0.2), Passage::Uncertain);
    /// ```
    pub fn of(phase: &Phase, error_m: f64, limit_m: f64) -> Self {
        match phase {
            Phase::Waiting => Self::Idle,
            Phase::Running(_) | Phase::Held(_) | Phase::Ended(_) if error_m <= limit_m => Self::Counts,
            Phase::Running(_) | Phase::Held(_) | Phase::Ended(_) => Self::Uncertain,
        }
    }
}
