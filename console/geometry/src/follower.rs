//! Follows a path: how far along it the robot is, and where to go next.

use crate::{Point, polyline, wrap_angle_rad};
use std::collections::VecDeque;

/// Distance between the robot and the point ahead at which it aims, metres.
const LOOKAHEAD_M: f64 = 0.5;
/// Lookahead on a path that is followed exactly, metres.
const EXACT_LOOKAHEAD_M: f64 = 0.25;
/// Spacing of the points of a path that is followed exactly, metres.
const EXACT_SPACING_M: f64 = 0.1;
/// Minimum change of direction at which a point of the path counts as a corner, radians. The robot drives to a corner
/// before it turns.
const CORNER_RAD: f64 = 0.5;
/// Distance at which a corner counts as reached, metres.
const CORNER_M: f64 = 0.05;
/// Distance from a corner within which driving past the corner counts as reaching it, metres.
const BESIDE_CORNER_M: f64 = 0.4;
/// Length of path in which the nearest point is searched for, metres; shorter than one turn of any useful spiral.
const WINDOW_M: f64 = 1.5;
/// Length of path in which the nearest point is searched for if the path is followed exactly, metres; shorter than a
/// lap of the smallest ring worth scanning.
const EXACT_WINDOW_M: f64 = 0.6;

/// Progress along a path. It never decreases, because the search for the nearest point starts from the previous one and
/// goes forward.
///
/// ```
/// use geometry::{PathFollower, Point};
/// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
/// follower.advance(Point::new(0.5, 0.1), |_| true);
/// assert!((follower.along_m() - 0.5).abs() < 1e-9);
/// ```
#[derive(Debug, Clone)]
pub struct PathFollower {
    path: Vec<Point>,
    stations_m: Vec<f64>,
    nearest: usize,
    target: usize,
    /// The last point that has room for the robot; all later ones are blocked by obstacles.
    last: usize,
    lookahead_m: f64,
    window_m: f64,
    /// Corners that must be reached before the path beyond them is considered, the next one first; empty if corners may
    /// be cut.
    corners: VecDeque<usize>,
}

impl PathFollower {
    /// Creates a follower at the start of a path with at least one point. With its lookahead of 0.5 m, it cuts corners.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::new(vec![Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(2.0, 0.0)]);
    /// follower.advance(Point::new(0.2, 0.0), |_| true);
    /// assert_eq!(follower.target(), Point::new(1.0, 0.0));
    /// ```
    pub fn new(path: Vec<Point>) -> Self {
        let stations_m = polyline::stations_m(&path);
        let last = path.len().saturating_sub(1);
        let corners = VecDeque::new();
        let (lookahead_m, window_m) = (LOOKAHEAD_M, WINDOW_M);
        Self { path, stations_m, nearest: 0, target: 0, last, lookahead_m, window_m, corners }
    }

    /// Creates a follower that reaches every corner of a path before it turns, so that no lane is cut short or mistaken
    /// for the next lane. The path must have at least one point.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// (0..40).for_each(|k| follower.advance(Point::new(0.1 * f64::from(k), 0.0), |_| true));
    /// assert!((follower.target() - Point::new(4.0, 0.0)).norm() < 1e-9);
    /// ```
    pub fn exact(path: &[Point]) -> Self {
        let mut path = path.to_vec();
        path.dedup_by(|next, before| (*next - *before).norm() < 1e-6);
        let follower = Self::new(polyline::resampled(&path, EXACT_SPACING_M));
        let corners = corners(&follower.path);
        Self { lookahead_m: EXACT_LOOKAHEAD_M, window_m: EXACT_WINDOW_M, corners, ..follower }
    }

    /// Advances to the robot's position, in the tank frame, and chooses the next target.
    ///
    /// The target is the first point that has room and is at least the lookahead distance ahead; points for which
    /// `has_room` is false are skipped.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::new((0..9).map(|k| Point::new(0.5 * f64::from(k), 0.0)).collect());
    /// // A column stands about (1, 0).
    /// follower.advance(Point::new(0.5, 0.0), |at| (at.x - 1.0).abs() > 0.7);
    /// assert_eq!(follower.target(), Point::new(2.0, 0.0));
    /// ```
    pub fn advance(&mut self, position: Point, has_room: impl Fn(Point) -> bool) {
        let free = |index: &usize| has_room(self.path[*index]);
        let window_end_m = (self.stations_m[self.nearest] + self.window_m).max(self.stations_m[self.target]);
        let ahead = self.nearest..=self.next_corner();
        let n_in_window = self.stations_m[ahead.clone()].partition_point(|at_m| *at_m <= window_end_m);
        let away_m = |index: usize| ((self.path[index] - position).norm(), index);
        self.nearest = (ahead.map(away_m).take(n_in_window))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(self.nearest, |(_, index)| index);
        if self.corners.front().is_some_and(|corner| self.has_reached(*corner, position)) {
            self.nearest = self.corners.pop_front().unwrap_or(self.nearest);
        }
        self.last = (self.nearest..self.path.len()).rev().find(free).unwrap_or(self.nearest);
        let aim_m = self.stations_m[self.nearest] + self.lookahead_m;
        self.target = (self.nearest..=self.last)
            .find(|index| self.stations_m[*index] >= aim_m && free(index))
            .unwrap_or(self.last)
            .min(self.next_corner());
    }

    /// Distance to the next corner, metres; `None` if no corner is left.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// let corner_m = follower.corner_m(Point::new(1.0, 0.0));
    /// assert!(corner_m.is_some_and(|m| (m - 3.0).abs() < 1e-9));
    /// ```
    pub fn corner_m(&self, position: Point) -> Option<f64> {
        self.corners.front().map(|corner| (self.path[*corner] - position).norm())
    }

    /// Counts the next corner as reached, for a robot that cannot get closer to it.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// follower.give_up_corner();
    /// assert_eq!(follower.corner_m(Point::origin()), None);
    /// ```
    pub fn give_up_corner(&mut self) {
        self.nearest = self.corners.pop_front().unwrap_or(self.nearest);
    }

    /// The next corner, or the end of the path.
    fn next_corner(&self) -> usize {
        self.corners.front().copied().unwrap_or(self.path.len() - 1)
    }

    /// Whether a position is at a corner, or has passed the corner and is close to it. Passing a corner on an earlier
    /// lane does not count if the corner is farther along the path.
    fn has_reached(&self, corner: usize, position: Point) -> bool {
        if self.stations_m[corner] - self.stations_m[self.nearest] > self.window_m {
            return false;
        }
        let off = position - self.path[corner];
        let into = self.path[corner] - self.path[corner - 1];
        off.norm() <= CORNER_M || (off.norm() <= BESIDE_CORNER_M && off.dot(&into) >= 0.0)
    }

    /// The point to drive to, tank frame.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// assert!((follower.target() - Point::new(0.8, 0.0)).norm() < 1e-9);
    /// ```
    pub fn target(&self) -> Point {
        self.path[self.target]
    }

    /// Distance along the path from its start to the point to drive to, metres.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// assert!((follower.target_m() - 0.8).abs() < 1e-9);
    /// ```
    pub fn target_m(&self) -> f64 {
        self.stations_m[self.target]
    }

    /// The points of the path from the target on, within `length_m` along the path; the target is always included.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// assert_eq!(follower.ahead(0.5)[0], follower.target());
    /// ```
    pub fn ahead(&self, length_m: f64) -> &[Point] {
        let end_m = self.stations_m[self.target] + length_m;
        let end = self.stations_m.partition_point(|s| *s <= end_m);
        &self.path[self.target..end.max(self.target + 1)]
    }

    /// The points of the path from the nearest one on.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// assert!((follower.remaining()[0] - Point::new(0.5, 0.0)).norm() < 1e-9);
    /// ```
    pub fn remaining(&self) -> &[Point] {
        &self.path[self.nearest..]
    }

    /// Distance along the path from its start to the nearest point, metres.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// assert!((follower.along_m() - 0.5).abs() < 1e-9);
    /// ```
    pub fn along_m(&self) -> f64 {
        self.stations_m[self.nearest]
    }

    /// Distance from a position to the target and on to the end of the path, metres.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let follower = PathFollower::new(vec![Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// assert_eq!(follower.left_m(Point::new(-1.0, 0.0)), 8.0);
    /// ```
    pub fn left_m(&self, position: Point) -> f64 {
        (self.target() - position).norm() + self.length_m() - self.stations_m[self.target]
    }

    /// Length of the whole path, metres.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// assert!((follower.length_m() - 7.0).abs() < 1e-9);
    /// ```
    pub fn length_m(&self) -> f64 {
        self.stations_m.last().copied().unwrap_or(0.0)
    }

    /// Distance from a position to the part of the path near the nearest point, metres.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// assert!((follower.cross_track_m(Point::new(0.5, 0.1)) - 0.1).abs() < 1e-9);
    /// ```
    pub fn cross_track_m(&self, position: Point) -> f64 {
        let (first, end) = (self.nearest.saturating_sub(1), (self.nearest + 2).min(self.path.len()));
        polyline::distance_m(&self.path[first..end], position)
    }

    /// Whether the last point that has room is within a tolerance, metres, both in a straight line and along the path.
    ///
    /// ```
    /// use geometry::{PathFollower, Point};
    /// let mut follower = PathFollower::exact(&[Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)]);
    /// follower.advance(Point::new(0.5, 0.1), |_| true);
    /// assert!(!follower.is_done(Point::new(1.0, 0.1), 0.2));
    /// ```
    pub fn is_done(&self, position: Point, tolerance_m: f64) -> bool {
        let left_m = self.stations_m[self.last] - self.stations_m[self.nearest];
        left_m <= tolerance_m && (self.path[self.last] - position).norm() <= tolerance_m
    }
}

/// Indices of the points at which a path turns sharply; never the first or the last.
fn corners(path: &[Point]) -> VecDeque<usize> {
    let bearing = |from: Point, to: Point| (to.y - from.y).atan2(to.x - from.x);
    let turns = |trio: &[Point]| {
        wrap_angle_rad(bearing(trio[1], trio[2]) - bearing(trio[0], trio[1])).abs() > CORNER_RAD
    };
    path.windows(3).enumerate().filter(|(_, trio)| turns(trio)).map(|(index, _)| index + 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn anywhere(_: Point) -> bool {
        true
    }

    /// A column of radius 0.3 m at (x, 0), and 0.3 m of room for the robot.
    fn past_column(x: f64) -> impl Fn(Point) -> bool {
        move |at| (at - Point::new(x, 0.0)).norm() >= 0.6
    }

    #[test]
    fn a_robot_on_the_path_aims_half_a_metre_ahead() {
        let mut follower = PathFollower::new((0..50).map(|i| Point::new(f64::from(i) * 0.1, 0.0)).collect());
        follower.advance(Point::new(1.0, 0.05), anywhere);
        assert!((follower.along_m() - 1.0).abs() < 1e-9);
        assert!((follower.target().x - 1.5).abs() < 1e-9);
        assert!((follower.cross_track_m(Point::new(1.0, 0.05)) - 0.05).abs() < 1e-9);
    }

    #[test]
    fn an_exact_follower_goes_to_the_end_of_a_lane_before_it_turns_into_the_next() {
        let lanes: Vec<Point> =
            [(0.0, 0.0), (5.0, 0.0), (5.0, 0.4), (0.0, 0.4)].map(|(x, y)| Point::new(x, y)).to_vec();
        let mut follower = PathFollower::exact(&lanes);
        // The robot is nearer to the second lane, but is still driving along the first.
        for step in 0..=24 {
            follower.advance(Point::new(0.2 * f64::from(step), 0.25), anywhere);
            assert!(follower.target().y < 0.01, "{}", follower.target());
        }
        follower.advance(Point::new(5.02, 0.1), anywhere);
        assert!((follower.along_m() - 5.0).abs() < 1e-9 && follower.target().x > 4.99);
        follower.advance(Point::new(5.0, 0.39), anywhere);
        assert!(follower.target().x < 4.9, "{}", follower.target());
        assert!(!follower.is_done(Point::new(0.0, 0.4), 0.2));
    }

    #[test]
    fn an_exact_follower_goes_all_the_way_round_a_small_ring() {
        let ring = |k: i32| {
            let angle = std::f64::consts::TAU * f64::from(k) / 40.0;
            Point::new(0.25 * angle.cos(), 0.25 * angle.sin())
        };
        let path: Vec<Point> = (0..=40).map(ring).chain([Point::new(1.0, 0.0)]).collect();
        let mut follower = PathFollower::exact(&path);
        // The position is wrong by up to 10 cm.
        for k in 0..=36 {
            let off = crate::Vector::new(0.1, 0.0) * f64::from(k % 3 - 1);
            follower.advance(ring(k) + off, anywhere);
            let along_m = 0.25 * std::f64::consts::TAU * f64::from(k) / 40.0;
            assert!((follower.along_m() - along_m).abs() < 0.35, "{k}: {} of {along_m}", follower.along_m());
        }
    }

    proptest! {
        #[test]
        fn progress_only_grows(positions in prop::collection::vec((-1.0..6.0_f64, -1.0..2.0_f64), 1..40)) {
            let lanes = [(0.0, 0.0), (5.0, 0.0), (5.0, 0.4), (0.0, 0.4)].map(|(x, y)| Point::new(x, y));
            for mut follower in [PathFollower::new(lanes.to_vec()), PathFollower::exact(&lanes)] {
                for (x, y) in &positions {
                    let before_m = follower.along_m();
                    follower.advance(Point::new(*x, *y), anywhere);
                    prop_assert!(before_m <= follower.along_m() && follower.along_m() <= follower.length_m());
                }
            }
        }
    }

    #[test]
    fn a_target_in_a_column_is_skipped() {
        let mut follower = PathFollower::new((0..50).map(|i| Point::new(f64::from(i) * 0.1, 0.0)).collect());
        follower.advance(Point::new(1.0, 0.0), past_column(1.6));
        assert!(follower.target().x > 2.1);
    }

    #[test]
    fn a_path_that_ends_in_a_column_is_done_at_its_last_free_point() {
        let mut follower = PathFollower::new((0..=20).map(|i| Point::new(f64::from(i) * 0.1, 0.0)).collect());
        let stop = Point::new(1.35, 0.0);
        for x in [0.0, 0.7, 1.35] {
            follower.advance(Point::new(x, 0.0), past_column(2.0));
        }
        assert!(follower.is_done(stop, 0.2));
    }

    #[test]
    fn a_robot_that_follows_a_spiral_never_jumps_to_the_next_turn() {
        let at = |k: i32| {
            let angle = 0.02 * f64::from(k);
            let radius_m = 5.0 - 0.8 * angle / std::f64::consts::TAU;
            Point::new(radius_m * angle.cos(), radius_m * angle.sin())
        };
        let path: Vec<Point> = (0..1800).map(at).collect();
        let mut follower = PathFollower::new(path.clone());
        for (i, point) in path.iter().enumerate() {
            follower.advance(*point, anywhere);
            assert!(follower.nearest.abs_diff(i) <= 1, "at {i}: {}", follower.nearest);
        }
        assert!(follower.is_done(path[path.len() - 1], 0.1));
    }
}
