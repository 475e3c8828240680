//! The amount of turning of the robot.

use std::{collections::VecDeque, f64::consts::TAU};
use world::{Pose, geometry::wrap_angle_rad};

/// Change of heading within [`WITHIN_M`] of path, radians, above which the change counts as a turn (30 degrees).
const TURN_RAD: f64 = std::f64::consts::FRAC_PI_6;
/// Length of path over which a change of heading is measured, metres.
const WITHIN_M: f64 = 0.5;
/// Change of heading within [`WITHIN_M`] of path, radians, below which a turn is over.
const STRAIGHT_RAD: f64 = TURN_RAD / 2.0;

/// The heading changes along the true path.
#[derive(Debug, Default)]
pub(crate) struct Turning {
    /// Distance and unwrapped heading over the last half metre.
    lately: VecDeque<(f64, f64)>,
    last: Option<Pose>,
    way_m: f64,
    heading_rad: f64,
    turned_rad: f64,
    in_turn: bool,
    turns: u64,
}

impl Turning {
    /// Adds a pose of the robot.
    pub(crate) fn pass(&mut self, pose: Pose) {
        let before = self.last.replace(pose).unwrap_or(pose);
        let turned_rad = wrap_angle_rad(pose.heading_rad - before.heading_rad);
        self.turned_rad += turned_rad.abs();
        self.heading_rad += turned_rad;
        self.way_m += (pose.position - before.position).norm();
        self.lately.push_back((self.way_m, self.heading_rad));
        while self.lately.get(1).is_some_and(|(way_m, _)| self.way_m - way_m >= WITHIN_M) {
            self.lately.pop_front();
        }
        let headings = || self.lately.iter().map(|(_, heading_rad)| *heading_rad);
        let span_rad =
            headings().fold(f64::NEG_INFINITY, f64::max) - headings().fold(f64::INFINITY, f64::min);
        if !self.in_turn && span_rad > TURN_RAD {
            self.in_turn = true;
            self.turns += 1;
        } else if self.in_turn && span_rad < STRAIGHT_RAD {
            self.in_turn = false;
        }
    }

    /// Number of changes of heading above 30 degrees within half a metre of path; consecutive changes without a
    /// straight stretch between them count as one.
    pub(crate) fn turns(&self) -> u64 {
        self.turns
    }

    /// Sum of all heading changes in full turns, in either direction.
    pub(crate) fn rotation_turns(&self) -> f64 {
        self.turned_rad / TAU
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn driven(pieces: &[(f64, f64)]) -> Turning {
        let mut turning = Turning::default();
        let mut pose = Pose::new(0.0, 0.0, 3.0);
        for (forward_m, turn_rad) in pieces {
            for _ in 0..100 {
                pose = pose.moved(forward_m / 100.0, 0.0, turn_rad / 100.0);
                turning.pass(pose);
            }
        }
        turning
    }

    #[test]
    fn a_lane_a_turn_on_the_spot_and_the_lane_back_is_one_turn_and_half_a_rotation() {
        let turning = driven(&[(5.0, 0.0), (0.0, PI), (5.0, 0.0)]);
        assert_eq!(turning.turns(), 1);
        assert!((turning.rotation_turns() - 0.5).abs() < 0.01, "{}", turning.rotation_turns());
    }

    #[test]
    fn corners_with_a_straight_piece_between_them_are_two_turns() {
        assert_eq!(
            driven(&[(5.0, 0.0), (0.0, FRAC_PI_2), (2.0, 0.0), (0.0, FRAC_PI_2), (5.0, 0.0)]).turns(),
            2
        );
    }

    #[test]
    fn a_wide_arc_rotates_without_a_turn() {
        let turning = driven(&[(20.0 * PI, 2.0 * TAU)]);
        assert_eq!(turning.turns(), 0);
        assert!((turning.rotation_turns() - 2.0).abs() < 0.03);
    }
}
