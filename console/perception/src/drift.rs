//! Estimates whether a found obstacle moves, and how fast.

use std::collections::VecDeque;
use world::{Point, Vector};

/// Age, seconds, above which sightings are forgotten.
const MEMORY_S: f64 = 1.5;
/// Minimum number of sightings for an estimate.
const LEAST_PLACES: usize = 4;
/// Speed, metres per second, below which an obstacle counts as standing still: errors of the estimated position can
/// mimic lower speeds.
const MOVING_M_PER_S: f64 = 0.08;
/// Speed, metres per second, down to which an obstacle that already counts as moving continues to do so.
const STILL_MOVING_M_PER_S: f64 = 0.04;
/// Minimum distance, metres, that an obstacle must have moved before it counts as moving.
const LEAST_WAY_M: f64 = 0.12;

/// Recent sightings of one obstacle.
#[derive(Debug, Clone, Default)]
pub struct Drift {
    places: VecDeque<(f64, Point)>,
    velocity: Option<Vector>,
}

impl Drift {
    /// Adds a sighting made at a given time, in seconds.
    pub fn see(&mut self, t_s: f64, at: Point) {
        self.places.push_back((t_s, at));
        while self.places.front().is_some_and(|(seen_s, _)| t_s - seen_s > MEMORY_S) {
            self.places.pop_front();
        }
        let Some(velocity) = self.slope() else {
            return;
        };
        let (speed, span_s) = (velocity.norm(), t_s - self.places[0].0);
        let is_moving = match self.velocity {
            Some(_) => speed > STILL_MOVING_M_PER_S,
            None => speed > MOVING_M_PER_S && speed * span_s > LEAST_WAY_M,
        };
        self.velocity = is_moving.then_some(velocity);
    }

    /// The obstacle's velocity, metres per second, tank frame; `None` if it stands still.
    pub fn velocity(&self) -> Option<Vector> {
        self.velocity
    }

    /// Time of the last sighting, seconds.
    pub fn seen_s(&self) -> f64 {
        self.places.back().map_or(f64::NEG_INFINITY, |(t_s, _)| *t_s)
    }

    /// Slope of the straight line that is fitted to the positions by least squares.
    fn slope(&self) -> Option<Vector> {
        if self.places.len() < LEAST_PLACES {
            return None;
        }
        let n = self.places.len() as f64;
        let mean_s = self.places.iter().map(|(t_s, _)| t_s).sum::<f64>() / n;
        let squares: f64 = self.places.iter().map(|(t_s, _)| (t_s - mean_s).powi(2)).sum();
        let moment: Vector = self.places.iter().map(|(t_s, at)| at.coords * (t_s - mean_s)).sum();
        (squares > 0.0).then(|| moment / squares)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(place: impl Fn(f64) -> Point) -> Drift {
        let mut drift = Drift::default();
        for tick in 0..40 {
            let t_s = f64::from(tick) * 0.1;
            drift.see(t_s, place(t_s));
        }
        drift
    }

    #[test]
    fn a_steady_motion_is_estimated_as_it_is() {
        let velocity = seen(|t_s| Point::new(1.0 + 0.3 * t_s, -0.2 * t_s)).velocity().unwrap();
        assert!((velocity - Vector::new(0.3, -0.2)).norm() < 1e-9);
    }

    #[test]
    fn what_jumps_with_the_estimated_pose_stands_still() {
        let drift = seen(|t_s| Point::new(if (t_s as u32).is_multiple_of(2) { 0.0 } else { 0.05 }, 0.0));
        assert_eq!(drift.velocity(), None);
    }

    #[test]
    fn what_has_come_to_rest_stands_still() {
        assert_eq!(seen(|t_s| Point::new(t_s.min(1.0), 0.0)).velocity(), None);
    }
}
