//! The worst value of a figure so far, with its time and place.

use serde::{Deserialize, Serialize};
use world::Point;

/// The direction in which the values of a figure get worse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Worst {
    /// Larger values are worse.
    Most,
    /// Smaller values are worse.
    Least,
}

/// A value with its time and place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Extreme {
    /// The value, in the unit of its figure.
    pub value: f64,
    /// Mission time, seconds.
    pub t_s: f64,
    /// Position of the robot, metres, tank frame: the true one for a figure that only the simulator knows, otherwise the
    /// estimated one.
    pub at: Point,
}

impl Worst {
    /// The worse of two values; the earlier one if they are equal.
    pub(crate) fn of(self, so_far: Option<Extreme>, now: Extreme) -> Option<Extreme> {
        let is_worse = |before: Extreme| match self {
            Self::Most => now.value > before.value,
            Self::Least => now.value < before.value,
        };
        match so_far {
            Some(before) if !is_worse(before) => so_far,
            _ if now.value.is_finite() => Some(now),
            _ => so_far,
        }
    }
}
