//! Decides when the robot is considered trapped. The paper says "oscillates" and gives no rule; this rule is ours.

use geometry::Point;
use std::collections::VecDeque;

/// Net displacement, as a share of the distance covered, below which the robot oscillates.
const SHARE: f64 = 0.15;
/// Number of windows without a new best distance to the goal after which the robot is considered trapped, unless more
/// are allowed.
const PATIENCE_WINDOWS: usize = 20;

/// Examines a sliding window of steps.
#[derive(Debug, Clone)]
pub struct Oscillation {
    n_steps: usize,
    least_m: f64,
    recent: VecDeque<Point>,
    best_m: f64,
    without_gain: usize,
    patience: usize,
}

impl Oscillation {
    /// Creates a window of a given length for steps of a given length, metres.
    pub fn new(window_m: f64, step_m: f64) -> Self {
        let n_steps = (window_m / step_m).ceil().max(8.0) as usize;
        Self {
            n_steps,
            least_m: SHARE * n_steps as f64 * step_m,
            recent: VecDeque::with_capacity(n_steps + 1),
            best_m: f64::INFINITY,
            without_gain: 0,
            patience: PATIENCE_WINDOWS * n_steps,
        }
    }

    /// Records a position and its distance to the goal. Returns true if the recent steps make no headway.
    pub fn record(&mut self, at: Point, missing_m: f64) -> bool {
        if missing_m < self.best_m {
            (self.best_m, self.without_gain) = (missing_m, 0);
        } else {
            self.without_gain += 1;
        }
        self.recent.push_back(at);
        if self.recent.len() <= self.n_steps {
            return false;
        }
        let first = self.recent.pop_front().expect("the window is full");
        (at - first).norm_squared() < self.least_m * self.least_m || self.without_gain > self.patience
    }

    /// Starts over.
    pub fn forget(&mut self) {
        self.recent.clear();
        (self.best_m, self.without_gain) = (f64::INFINITY, 0);
        self.patience = PATIENCE_WINDOWS * self.n_steps;
    }

    /// Starts over and allows this many steps without a new best distance, if that is more than usual.
    pub fn forget_for(&mut self, steps: usize) {
        self.forget();
        self.patience = self.patience.max(steps);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fires(path: impl Fn(f64) -> Point) -> bool {
        let mut oscillation = Oscillation::new(2.0, 0.05);
        (0..2000).any(|k| {
            let at = path(f64::from(k) * 0.05);
            oscillation.record(at, (Point::new(1e3, 0.0) - at).norm())
        })
    }

    #[test]
    fn going_to_and_fro_and_going_in_circles_lead_nowhere() {
        assert!(fires(|way| Point::new((way * 20.0).sin() * 0.05, 0.0)));
        assert!(fires(|way| Point::new(3.0 * (way / 3.0).cos(), 3.0 * (way / 3.0).sin())));
    }

    #[test]
    fn going_on_does_not() {
        assert!(!fires(|way| Point::new(way, (way * 2.0).sin() * 0.2)));
    }
}
