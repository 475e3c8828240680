//! How far along a path the robot is, and where to go next.

use world::{ObstacleMap, Point, polyline};

/// Distance ahead of the robot at which it aims, metres.
const LOOKAHEAD_M: f64 = 0.5;
/// Length of path that is searched for the nearest point, metres; shorter than one turn of any useful spiral.
const WINDOW_M: f64 = 1.5;

/// Progress along a path that only grows (nearest point, searched forward).
#[derive(Debug, Clone)]
pub struct Follower {
    path: Vec<Point>,
    stations_m: Vec<f64>,
    nearest: usize,
    target: usize,
    /// Last point that the robot can stand on; later ones lie in obstacles.
    last: usize,
}

impl Follower {
    /// A follower at the beginning of a path with at least one point.
    pub fn new(path: Vec<Point>) -> Self {
        let stations_m = polyline::stations_m(&path);
        let last = path.len().saturating_sub(1);
        Self { path, stations_m, nearest: 0, target: 0, last }
    }

    /// Takes the robot's position: moves on along the path and chooses the next target.
    ///
    /// The target is the first point a little ahead where the robot finds room; points without room are skipped, and
    /// so is the way to them.
    pub fn advance(&mut self, position: Point, map: &ObstacleMap, room_m: f64) {
        let free = |index: &usize| map.clearance_m(self.path[*index]) >= room_m;
        let window_end_m = (self.stations_m[self.nearest] + WINDOW_M).max(self.stations_m[self.target]);
        self.nearest = (self.nearest..self.path.len())
            .take_while(|index| self.stations_m[*index] <= window_end_m)
            .min_by(|a, b| (self.path[*a] - position).norm().total_cmp(&(self.path[*b] - position).norm()))
            .unwrap_or(self.nearest);
        self.last = (self.nearest..self.path.len()).rev().find(free).unwrap_or(self.nearest);
        let aim_m = self.stations_m[self.nearest] + LOOKAHEAD_M;
        self.target = (self.nearest..=self.last)
            .find(|index| self.stations_m[*index] >= aim_m && free(index))
            .unwrap_or(self.last);
    }

    /// Where to go next.
    pub fn target(&self) -> Point {
        self.path[self.target]
    }

    /// The path from the target on, at most `length_m` of it.
    pub fn ahead(&self, length_m: f64) -> &[Point] {
        let end_m = self.stations_m[self.target] + length_m;
        let end = self.stations_m.partition_point(|s| *s <= end_m);
        &self.path[self.target..end.max(self.target + 1)]
    }

    /// Everything from the nearest point on.
    pub fn remaining(&self) -> &[Point] {
        &self.path[self.nearest..]
    }

    /// Way along the path up to the nearest point, metres.
    pub fn along_m(&self) -> f64 {
        self.stations_m[self.nearest]
    }

    /// Length of the whole path, metres.
    pub fn length_m(&self) -> f64 {
        self.stations_m.last().copied().unwrap_or(0.0)
    }

    /// Distance from a position to the path near the robot, metres.
    pub fn cross_track_m(&self, position: Point) -> f64 {
        let (first, end) = (self.nearest.saturating_sub(1), (self.nearest + 2).min(self.path.len()));
        polyline::distance_m(&self.path[first..end], position)
    }

    /// Whether the last point that can be reached is within a tolerance and nothing else is left on the way.
    pub fn is_done(&self, position: Point, tolerance_m: f64) -> bool {
        let left_m = self.stations_m[self.last] - self.stations_m[self.nearest];
        left_m <= tolerance_m && (self.path[self.last] - position).norm() <= tolerance_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, Obstacle, ObstacleId, Shape, spiral::Spiral};

    fn map(columns: &[(f64, f64)]) -> ObstacleMap {
        let obstacles: Vec<Obstacle> = columns
            .iter()
            .enumerate()
            .map(|(i, (x, y))| Obstacle {
                id: ObstacleId(i as u32),
                name: String::new(),
                shape: Shape::Disc { center: Point::new(*x, *y), radius_m: 0.3 },
                known: true,
            })
            .collect();
        ObstacleMap::new(&Boundary::Circle { radius_m: 11.0 }, &obstacles)
    }

    #[test]
    fn a_robot_on_the_path_aims_half_a_metre_ahead() {
        let mut follower = Follower::new((0..50).map(|i| Point::new(f64::from(i) * 0.1, 0.0)).collect());
        follower.advance(Point::new(1.0, 0.05), &map(&[]), 0.3);
        assert!((follower.along_m() - 1.0).abs() < 1e-9);
        assert!((follower.target().x - 1.5).abs() < 1e-9);
        assert!((follower.cross_track_m(Point::new(1.0, 0.05)) - 0.05).abs() < 1e-9);
    }

    #[test]
    fn a_target_in_a_column_is_skipped() {
        let mut follower = Follower::new((0..50).map(|i| Point::new(f64::from(i) * 0.1, 0.0)).collect());
        follower.advance(Point::new(1.0, 0.0), &map(&[(1.6, 0.0)]), 0.3);
        assert!(follower.target().x > 2.1);
    }

    #[test]
    fn a_path_that_ends_in_a_column_is_done_at_its_last_free_point() {
        let mut follower = Follower::new((0..=20).map(|i| Point::new(f64::from(i) * 0.1, 0.0)).collect());
        let map = map(&[(2.0, 0.0)]);
        let stop = Point::new(1.35, 0.0);
        for x in [0.0, 0.7, 1.35] {
            follower.advance(Point::new(x, 0.0), &map, 0.3);
        }
        assert!(follower.is_done(stop, 0.2));
    }

    #[test]
    fn a_robot_that_follows_a_spiral_never_jumps_to_the_next_turn() {
        let path = Spiral { outer_radius_m: 5.0, inner_radius_m: 0.3, pitch_m: 0.8, step_rad: 0.02 }.points();
        let mut follower = Follower::new(path.clone());
        for (i, point) in path.iter().enumerate() {
            follower.advance(*point, &map(&[]), 0.3);
            assert!(follower.nearest.abs_diff(i) <= 1, "at {i}: {}", follower.nearest);
        }
        assert!(follower.is_done(path[path.len() - 1], 0.1));
    }
}
