//! Gives up corners that a robot cannot reach.

use geometry::PathFollower;
use world::Point;

/// Distance, metres, below which a corner is given up if the robot stops getting closer to it.
const NEAR_CORNER_M: f64 = 0.3;
/// Time after which such a corner is given up, seconds: longer than a turn on the spot takes.
const PATIENCE_S: f64 = 6.0;
/// Minimum change that counts as getting closer, metres.
const NEARER_M: f64 = 0.01;

/// How long a robot has not come closer to the corner ahead of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CornerPatience {
    /// The minimum distance so far from the corner, metres.
    least_m: f64,
    /// The time since the robot was that close, seconds.
    waited_s: f64,
}

impl Default for CornerPatience {
    fn default() -> Self {
        Self { least_m: f64::INFINITY, waited_s: 0.0 }
    }
}

impl CornerPatience {
    /// Counts time during which the robot was free to move along a path; gives up the corner ahead if the robot cannot
    /// reach it.
    pub(crate) fn wait(&mut self, follower: &mut PathFollower, position: Point, passed_s: f64) {
        let corner_m = follower.corner_m(position).filter(|corner_m| *corner_m < NEAR_CORNER_M);
        *self = match corner_m {
            None => Self::default(),
            Some(corner_m) if corner_m < self.least_m - NEARER_M => Self { least_m: corner_m, waited_s: 0.0 },
            Some(_) => Self { waited_s: self.waited_s + passed_s, ..*self },
        };
        if self.waited_s > PATIENCE_S {
            follower.give_up_corner();
            *self = Self::default();
        }
    }
}
