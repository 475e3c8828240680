//! The robot's trail, in a bounded number of points.

use serde::{Deserialize, Serialize};
use world::Point;

/// The maximum number of points kept.
const MAX_POINTS: usize = 2048;
/// The initial distance between points, metres.
const FIRST_SPACING_M: f64 = 0.02;

/// The robot's trail: evenly spaced points whose spacing grows with the distance driven.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trail {
    points: Vec<Point>,
    spacing_m: f64,
}

impl Default for Trail {
    fn default() -> Self {
        Self { points: Vec::new(), spacing_m: FIRST_SPACING_M }
    }
}

impl Trail {
    /// Adds a point if it is far enough from the last one.
    pub fn add(&mut self, point: Point) {
        let finite = point.x.is_finite() && point.y.is_finite();
        let near = self.points.last().is_some_and(|last| (point - last).norm() < self.spacing_m);
        if !finite || near {
            return;
        }
        if self.points.len() >= MAX_POINTS {
            self.points = self.points.iter().copied().step_by(2).collect();
            self.spacing_m *= 2.0;
        }
        self.points.push(point);
    }

    /// The points, oldest first.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The number of points of a path from which [`Self::thinned`] keeps one.
    pub fn step(points: usize) -> usize {
        points.div_ceil(MAX_POINTS).max(1)
    }

    /// The points of a path. If there are more than a trail may keep, evenly picked points; both ends are kept.
    pub fn thinned(path: &[Point]) -> Vec<Point> {
        let step = Self::step(path.len());
        let mut points: Vec<Point> =
            path.iter().copied().step_by(step).filter(|p| p.x.is_finite() && p.y.is_finite()).collect();
        if let Some(last) = path.last().filter(|_| step > 1 && !(path.len() - 1).is_multiple_of(step)) {
            points.push(*last);
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_way_stays_within_the_bound_and_keeps_its_start_and_shape() {
        let mut trail = Trail::default();
        for i in 0..100_000 {
            trail.add(Point::new(f64::from(i) * 0.05, 0.0));
        }
        assert!(trail.points().len() <= MAX_POINTS);
        assert!(trail.points().len() > MAX_POINTS / 4);
        assert_eq!(trail.points()[0], Point::new(0.0, 0.0));
        assert!(trail.points().windows(2).all(|w| w[1].x > w[0].x));
    }

    #[test]
    fn standing_still_adds_nothing() {
        let mut trail = Trail::default();
        for _ in 0..10 {
            trail.add(Point::new(1.0, 1.0));
        }
        trail.add(Point::new(f64::NAN, 1.0));
        assert_eq!(trail.points().len(), 1);
    }

    #[test]
    fn a_thinned_path_keeps_both_ends() {
        let path: Vec<Point> = (0..5000).map(|i| Point::new(f64::from(i), 0.0)).collect();
        let thin = Trail::thinned(&path);
        assert!(thin.len() <= MAX_POINTS + 1);
        assert_eq!((thin.first(), thin.last()), (path.first(), path.last()));
    }
}
