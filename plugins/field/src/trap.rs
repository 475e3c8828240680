//! When a law is considered trapped.

use geometry::Point;
use std::collections::VecDeque;
use steering::Forces;

/// The condition that opens the gate of the rotating force and starts an escape. Wang et al. 2023 do not specify it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gate {
    /// Moves that make almost no headway, as judged by [`TrapDetector`]. The gate stays open for ten moves; an escape
    /// lasts several.
    Detected,
    /// The sum of pull and push points away from the target; checked at every move.
    Backward,
    /// The push exceeds 0.8 of the pull, and its direction is within 26 degrees of the opposite of the pull; checked at
    /// every move.
    Opposed,
}

/// Share of the pull that an opposing push exceeds.
const OPPOSED_SHARE: f64 = 0.8;
/// Cosine of the angle between pull and push, 154 degrees, above which the push does not count as opposing.
const OPPOSED_COS: f64 = -0.898_794;

impl Gate {
    /// Whether pull and push alone open the gate; always false for [`Self::Detected`].
    pub fn is_open(self, forces: &Forces) -> bool {
        let (pull, push) = (forces.attraction, forces.repulsion);
        match self {
            Self::Detected => false,
            Self::Backward => (pull + push).dot(&pull) < 0.0,
            Self::Opposed => {
                let (pull_n, push_n) = (pull.norm(), push.norm());
                push_n > OPPOSED_SHARE * pull_n && pull.dot(&push) < OPPOSED_COS * pull_n * push_n
            }
        }
    }
}

/// Number of moves examined by the detector.
const WINDOW: usize = 6;
/// Net displacement, as a share of the distance that these moves could have covered, below which the robot is in a
/// trap.
const SHARE: f64 = 0.35;

/// Detects a trap from the last six moves. It is a trap if their net displacement is less than 0.35 of the distance
/// they could have covered, the target is more than a step away, and an obstacle acts.
///
/// Wang et al. 2023 do not state when the robot is considered trapped; window and share are our choices.
#[derive(Debug, Clone, Default)]
pub struct TrapDetector {
    recent: VecDeque<Point>,
}

impl TrapDetector {
    /// Records the position reached by a move.
    pub fn record(&mut self, at: Point) {
        self.recent.push_back(at);
        if self.recent.len() > WINDOW + 1 {
            self.recent.pop_front();
        }
    }

    /// Whether the robot is trapped. `expected_m` is the distance that an unobstructed move would cover, and `lag_m`
    /// the distance to the target.
    pub fn is_trapped(&self, expected_m: f64, step_m: f64, lag_m: f64, obstacle_acts: bool) -> bool {
        let (Some(first), Some(last)) = (self.recent.front(), self.recent.back()) else { return false };
        let hardly_moved = (last - first).norm() < SHARE * WINDOW as f64 * expected_m;
        self.recent.len() > WINDOW && hardly_moved && lag_m > step_m && obstacle_acts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Vector;

    #[test]
    fn a_gate_by_force_asks_how_push_and_pull_stand() {
        let open = |gate: Gate, push: (f64, f64)| {
            let (attraction, repulsion) = (Vector::x(), Vector::new(push.0, push.1));
            gate.is_open(&Forces { attraction, repulsion, ..Forces::default() })
        };
        assert!(open(Gate::Backward, (-1.1, 3.0)) && !open(Gate::Backward, (-0.9, 0.0)));
        assert!(open(Gate::Opposed, (-0.9, 0.3)) && !open(Gate::Opposed, (-0.7, 0.0)));
        assert!(!open(Gate::Opposed, (-1.1, 3.0)) && !open(Gate::Detected, (-9.0, 0.0)));
    }

    fn after(places: impl Iterator<Item = f64>) -> TrapDetector {
        let mut detector = TrapDetector::default();
        places.for_each(|x| detector.record(Point::new(x, 0.0)));
        detector
    }

    #[test]
    fn going_to_and_fro_is_a_trap() {
        let detector = after((0..8).map(|i| f64::from(i % 2) * 0.2));
        assert!(detector.is_trapped(0.2, 0.2, 1.0, true));
        assert!(!detector.is_trapped(0.2, 0.2, 1.0, false));
        assert!(!detector.is_trapped(0.2, 0.2, 0.1, true));
    }

    #[test]
    fn moving_on_is_none_and_neither_are_the_first_moves() {
        assert!(!after((0..8).map(|i| f64::from(i) * 0.2)).is_trapped(0.2, 0.2, 1.0, true));
        assert!(!after((0..4).map(|_| 0.0)).is_trapped(0.2, 0.2, 1.0, true));
    }
}
