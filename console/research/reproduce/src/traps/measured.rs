//! The figures of one attempt to leave a trap.

use crate::study::{Result, StudyError};
use serde::{Deserialize, Serialize};
use trials::Trap;
use world::{Point, polyline};

/// Distance, metres, at which the goal counts as reached.
pub(super) const TOLERANCE_M: f64 = 0.1;
/// Tolerance for rounding of clearances, metres.
const ROUNDING_M: f64 = 1e-6;

/// The result of a method on a trap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Measured {
    /// Whether the goal is reached without a collision.
    pub arrives: bool,
    /// Whether the hull touches a disc or the wall on the way.
    pub collides: bool,
    /// Length of the path divided by that of the exact shortest path; only for paths that arrive.
    pub ratio: Option<f64>,
    /// Time of the first plan, milliseconds.
    pub plan_time_ms: Option<f64>,
    /// Times of the later plans, milliseconds.
    pub replan_times_ms: Vec<f64>,
}

/// The path that was planned or driven.
pub(super) struct Attempt {
    /// The points of the path.
    pub path: Vec<Point>,
    /// Times of the plans in order, milliseconds.
    pub plan_times_ms: Vec<f64>,
}

impl Attempt {
    /// The figures of the attempt.
    ///
    /// # Errors
    /// There is no way out of the trap.
    pub(super) fn measured(self, trap: &Trap, seed: u64) -> Result<Measured> {
        let end = self.path.last().copied().unwrap_or(trap.start);
        let missing_m = (trap.goal - end).norm();
        let collides = trap.clearance_m(&self.path) < -ROUNDING_M;
        let arrives = missing_m <= TOLERANCE_M + ROUNDING_M && !collides;
        let shortest = trap.shortest_path();
        let shortest_m = shortest
            .map_err(|no| StudyError::Refused(format!("{} seed {seed}: {no}", trap.kind.id())))?
            .length_m;
        let length_m = polyline::length_m(&self.path) + missing_m;
        Ok(Measured {
            arrives,
            collides,
            ratio: arrives.then_some(length_m / shortest_m),
            plan_time_ms: self.plan_times_ms.first().copied(),
            replan_times_ms: self.plan_times_ms.into_iter().skip(1).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::traps::Kind;

    fn measured(path: Vec<Point>) -> Measured {
        let attempt = Attempt { path, plan_times_ms: vec![1.0, 2.0, 3.0] };
        attempt.measured(&Trap::random(Kind::U, 3), 3).unwrap()
    }

    #[test]
    fn the_straight_path_through_the_wall_is_a_collision_and_no_arrival() {
        let trap = Trap::random(Kind::U, 3);
        let measured = measured(vec![trap.start, trap.goal]);
        assert!(measured.collides && !measured.arrives && measured.ratio.is_none());
        assert_eq!(measured.replan_times_ms, [2.0, 3.0]);
    }

    #[test]
    fn the_shortest_path_has_the_ratio_one() {
        let trap = Trap::random(Kind::U, 3);
        let shortest = measured(trap.shortest_path().unwrap().points());
        assert!(shortest.arrives && (shortest.ratio.unwrap() - 1.0).abs() < 1e-5);
        assert!(!measured(vec![trap.start]).arrives);
    }
}
