//! How closely the true path follows a preset path.

use crate::{sampled::sampled, summary::Tracking};
use std::collections::BTreeMap;
use world::{
    Point,
    polyline::{nearest_on_segment, stations_m},
};

/// Distance between two samples of the true path, metres.
const SAMPLE_M: f64 = 0.05;

/// Distance ahead along the preset path within which a pair is searched for, metres.
const AHEAD_M: f64 = 1.0;

/// Distance between preset points above which more points are inserted between them, metres.
const SPACING_M: f64 = 0.25;

/// A preset path, and how closely the true path has followed it so far.
#[derive(Debug)]
pub(crate) struct Tracker {
    path: Vec<Point>,
    stations_m: Vec<f64>,
    /// Preset points that the robot has not come near yet, by grid square.
    unvisited: BTreeMap<(i64, i64), Vec<usize>>,
    visited: usize,
    /// Progress along the path as reported by the mission, metres.
    claimed_m: f64,
    last: Option<Sample>,
    samples: usize,
    near: usize,
    cross_track_m2: f64,
    /// Number of preset points that the pairing has passed.
    passed: usize,
    off_point_m2: f64,
}

/// A point of the true path, and the position of its pair along the preset path.
#[derive(Debug, Clone, Copy)]
struct Sample {
    at: Point,
    along_m: f64,
}

impl Tracker {
    /// State before the robot moves.
    pub(crate) fn new(path: &[Point]) -> Self {
        let path = sampled(path, SPACING_M);
        let mut unvisited: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
        for (i, point) in path.iter().enumerate() {
            unvisited.entry(square(*point)).or_default().push(i);
        }
        Self {
            stations_m: stations_m(&path),
            path,
            unvisited,
            visited: 0,
            claimed_m: 0.0,
            last: None,
            samples: 0,
            near: 0,
            cross_track_m2: 0.0,
            passed: 0,
            off_point_m2: 0.0,
        }
    }

    /// Sets the progress along the path as reported by the mission, metres.
    pub(crate) fn progress(&mut self, along_m: f64) {
        self.claimed_m = self.claimed_m.max(along_m);
    }

    /// Adds the robot's true movement from `a` to `b`.
    pub(crate) fn pass(&mut self, a: Point, b: Point) {
        self.visit(a, b);
        if self.last.is_none() {
            self.sample(a);
        }
        if self.last.is_none_or(|last| (b - last.at).norm() >= SAMPLE_M) {
            self.sample(b);
        }
    }

    /// The figures so far; `None` before the first true position, and for an empty path.
    pub(crate) fn tracking(&self) -> Option<Tracking> {
        (self.samples > 0 && !self.path.is_empty()).then(|| Tracking {
            precision: self.near as f64 / self.samples as f64,
            recall: self.visited as f64 / self.path.len() as f64,
            rmse_m: (self.passed > 0).then(|| (self.off_point_m2 / self.passed as f64).sqrt()),
            cross_track_rmse_m: (self.cross_track_m2 / self.samples as f64).sqrt(),
        })
    }

    fn visit(&mut self, a: Point, b: Point) {
        let reach = world::Vector::new(Tracking::NEAR_M, Tracking::NEAR_M);
        let (low, high) = (square(a.inf(&b) - reach), square(a.sup(&b) + reach));
        let path = &self.path;
        let columns = self.unvisited.range_mut((low.0, low.1)..=(high.0, high.1));
        for (_, points) in columns.filter(|((_, y), _)| (low.1..=high.1).contains(y)) {
            let before = points.len();
            points.retain(|i| (path[*i] - nearest_on_segment(a, b, path[*i])).norm() > Tracking::NEAR_M);
            self.visited += before - points.len();
        }
    }

    fn sample(&mut self, at: Point) {
        let from_m = self.last.map_or(0.0, |last| last.along_m);
        let Some((along_m, off_m)) = self.pair(at, from_m) else { return };
        self.samples += 1;
        self.near += usize::from(off_m <= Tracking::NEAR_M);
        self.cross_track_m2 += off_m * off_m;
        let before = self.last.replace(Sample { at, along_m }).map_or(at, |last| last.at);
        while self.stations_m.get(self.passed).is_some_and(|station_m| *station_m <= along_m) {
            let point = self.path[self.passed];
            self.off_point_m2 += (point - nearest_on_segment(before, at, point)).norm_squared();
            self.passed += 1;
        }
    }

    /// The nearest point of the preset path within the search distance from `from_m` on: its position along the path,
    /// and the distance from it.
    fn pair(&self, at: Point, from_m: f64) -> Option<(f64, f64)> {
        let until_m = from_m.max(self.claimed_m) + AHEAD_M;
        let first = self.stations_m.partition_point(|station_m| *station_m <= from_m).saturating_sub(1);
        let pieces = self.path[first..].windows(2).zip(&self.stations_m[first..]);
        let mut best = Some((from_m, (at - self.point_at(first, from_m)?).norm()));
        for (piece, start_m) in pieces.take_while(|(_, start_m)| **start_m <= until_m) {
            let nearest = nearest_on_segment(piece[0], piece[1], at);
            let along_m = start_m + (nearest - piece[0]).norm();
            let off_m = (at - nearest).norm();
            if along_m >= from_m && best.is_none_or(|(_, least_m)| off_m < least_m) {
                best = Some((along_m, off_m));
            }
        }
        best
    }

    /// The point at distance `along_m` along the preset path, on the piece that starts at point `first`.
    fn point_at(&self, first: usize, along_m: f64) -> Option<Point> {
        let (start, start_m) = (*self.path.get(first)?, *self.stations_m.get(first)?);
        let Some(end) = self.path.get(first + 1) else { return Some(start) };
        let direction = (end - start).try_normalize(0.0).unwrap_or_default();
        Some(start + direction * (along_m - start_m))
    }
}

/// The grid square of a point.
fn square(point: Point) -> (i64, i64) {
    ((point.x / Tracking::NEAR_M).floor() as i64, (point.y / Tracking::NEAR_M).floor() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn east(length_m: f64) -> Vec<Point> {
        sampled(&[Point::new(0.0, 0.0), Point::new(length_m, 0.0)], 0.1)
    }

    fn fly(tracker: &mut Tracker, path: &[Point]) {
        let fine = sampled(path, 0.02);
        for pair in fine.windows(2) {
            tracker.pass(pair[0], pair[1]);
        }
    }

    #[test]
    fn a_path_flown_exactly_has_no_error() {
        let mut tracker = Tracker::new(&east(5.0));
        fly(&mut tracker, &east(5.0));
        let tracking = tracker.tracking().expect("the robot moved");
        assert!((tracking.precision, tracking.recall) == (1.0, 1.0), "{tracking:?}");
        assert!(tracking.cross_track_rmse_m < 1e-9 && tracking.rmse_m.expect("passed") < 1e-9);
    }

    #[test]
    fn a_parallel_path_is_off_by_its_distance() {
        let mut tracker = Tracker::new(&east(5.0));
        fly(&mut tracker, &[Point::new(0.0, 0.3), Point::new(5.0, 0.3)]);
        let tracking = tracker.tracking().expect("the robot moved");
        assert!((tracking.precision, tracking.recall) == (0.0, 0.0), "{tracking:?}");
        assert!((tracking.cross_track_rmse_m - 0.3).abs() < 1e-9);
        assert!((tracking.rmse_m.expect("passed") - 0.3).abs() < 1e-9);
    }

    #[test]
    fn half_a_path_flown_exactly_is_half_recalled() {
        let mut tracker = Tracker::new(&east(10.0));
        fly(&mut tracker, &east(5.05));
        let tracking = tracker.tracking().expect("the robot moved");
        assert!((tracking.precision - 1.0).abs() < 1e-12);
        // The points from 0.0 m to 5.2 m in steps of 0.1 m: 53 of 101 points.
        assert!((tracking.recall - 53.0 / 101.0).abs() < 1e-9, "{tracking:?}");
        assert!(tracking.rmse_m.expect("passed") < 1e-9);
    }

    #[test]
    fn an_arc_cut_short_counts_in_rmse_and_recall_but_not_in_precision() {
        // A hairpin: 2 m east, 1 m north, 2 m back west. The robot does not drive its far end.
        let preset = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let flown = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let mut tracker = Tracker::new(&preset);
        fly(&mut tracker, &flown[..2]);
        tracker.progress(4.0);
        fly(&mut tracker, &flown[1..]);
        let tracking = tracker.tracking().expect("the robot moved");
        assert!(tracking.precision > 0.75, "{tracking:?}");
        assert!((0.4..0.7).contains(&tracking.recall), "{tracking:?}");
        assert!(tracking.rmse_m.expect("passed") > 0.4, "{tracking:?}");
    }

    #[test]
    fn standing_still_counts_nothing() {
        let mut tracker = Tracker::new(&east(1.0));
        for _ in 0..100 {
            tracker.pass(Point::new(0.0, 0.5), Point::new(0.0, 0.5));
        }
        fly(&mut tracker, &east(1.0));
        let tracking = tracker.tracking().expect("the robot moved");
        // A single sample is off the path; about twenty are on it.
        assert!(tracking.precision > 0.9, "{tracking:?}");
    }

    #[test]
    fn the_neighbouring_turn_is_no_pair() {
        let preset = sampled(
            &[Point::new(0.0, 0.0), Point::new(5.0, 0.0), Point::new(5.0, 0.5), Point::new(0.0, 0.5)],
            0.1,
        );
        let mut tracker = Tracker::new(&preset);
        fly(&mut tracker, &[Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(1.0, 0.5)]);
        let cross_track_m = tracker.tracking().expect("the robot moved").cross_track_rmse_m;
        assert!(cross_track_m > 0.1, "{cross_track_m}");
    }
}
