//! The plan under way, and how far the robot has come.

use crate::scan::Piece;
use world::{Point, polyline};

/// What lies nearer to the path is on it, metres.
const ON_PATH_M: f64 = 1e-6;

/// A straight bit of a path.
#[derive(Clone, Copy)]
pub(crate) struct Side {
    pub from: Point,
    pub to: Point,
    pub is_lane: bool,
}

impl Side {
    /// The same in bits no longer than this, metres.
    pub(super) fn divided(self, most_m: f64) -> impl Iterator<Item = Self> {
        let way = self.to - self.from;
        let n = (way.norm() / most_m).ceil().max(1.0);
        let at = move |k: f64| self.from + way * (k / n);
        (0..n as usize).map(move |k| Self { from: at(k as f64), to: at(k as f64 + 1.0), ..self })
    }
}

/// A plan under way.
pub(crate) struct CurrentPlan {
    pub cuts: Vec<Vec<Point>>,
    /// Whether its tether was as short and straight as is preferred.
    pub is_preferred: bool,
    sides: Vec<Side>,
    /// The side that the mission aims at, and how far along it, metres.
    at: (usize, f64),
}

impl CurrentPlan {
    /// A plan of some pieces at its start.
    pub(crate) fn new(pieces: &[Piece], cuts: &[Vec<Point>], is_preferred: bool) -> Self {
        let side = |w: &[Point], is_lane| Side { from: w[0], to: w[1], is_lane };
        let sides = pieces.iter().flat_map(|piece| piece.points.windows(2).map(|w| side(w, piece.is_lane)));
        Self { cuts: cuts.to_vec(), is_preferred, sides: sides.collect(), at: (0, 0.0) }
    }

    /// Takes the place of the path that the mission aims at; places off the path mean nothing.
    pub(crate) fn aim(&mut self, target: Point) {
        let along = |(k, side): (usize, &Side)| {
            let nearest = polyline::nearest_on_segment(side.from, side.to, target);
            let along_m = (nearest - side.from).norm();
            let is_on = (nearest - target).norm() < ON_PATH_M && (k > self.at.0 || along_m >= self.at.1);
            is_on.then_some((k, along_m))
        };
        if let Some(at) = self.sides.iter().enumerate().skip(self.at.0).find_map(along) {
            self.at = at;
        }
    }

    /// The path from the place that the mission aims at.
    pub(super) fn rest(&self) -> Vec<Side> {
        let (first, along_m) = self.at;
        let mut rest = self.sides[first..].to_vec();
        if let Some(side) = rest.first_mut() {
            let way = side.to - side.from;
            side.from += way * (along_m / way.norm().max(1e-9)).min(1.0);
        }
        rest
    }

    /// The path from there on.
    pub(crate) fn path_left(&self) -> Vec<Point> {
        super::points(&self.rest())
    }

    /// Length of the path from there on, metres.
    pub(crate) fn left_m(&self) -> f64 {
        polyline::length_m(&self.path_left())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_aim_goes_on_where_the_path_comes_by_again() {
        let points = [(0.0, 0.0), (4.0, 0.0), (0.0, 0.0), (0.0, 2.0)].map(|(x, y)| Point::new(x, y)).to_vec();
        let mut current = CurrentPlan::new(&[Piece { points, is_lane: true }], &[], true);
        let mut left_m = |x: f64, y: f64| {
            current.aim(Point::new(x, y));
            current.left_m()
        };
        assert!((left_m(1.0, 0.0) - 9.0).abs() < 1e-9);
        assert!((left_m(1.0, 0.5) - 9.0).abs() < 1e-9, "off the path");
        assert!((left_m(4.0, 0.0) - 6.0).abs() < 1e-9);
        assert!((left_m(1.0, 0.0) - 3.0).abs() < 1e-9, "on the way back");
        assert!(left_m(0.0, 2.0).abs() < 1e-9);
    }
}
