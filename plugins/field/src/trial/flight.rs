//! One flight.

use nalgebra::Matrix3;
use planner_api::{
    Drive, Motion, Obstacle, Outline, Planner, PoseEstimate, Result, Sensed, Site, Status, testing::Bench,
};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Mcg;
use trials::Layout;
use world::{Point, Pose, Vector, geometry::wrap_angle_rad, polyline};

/// Length of a tick, seconds.
const TICK_S: f64 = 0.1;
/// The target lies this far ahead along the path, metres.
const LOOKAHEAD_M: f64 = 0.5;
/// Length of path that is searched for the nearest point, metres.
const WINDOW_M: f64 = 1.5;
/// Distance at which the last point counts as reached, metres.
const TOLERANCE_M: f64 = 0.3;
/// A flight ends when the planner says that it is stuck for this long, seconds.
const BORNE_S: f64 = 30.0;
/// A flight may take this many times as long as the preset path at full speed.
const PATIENCE: f64 = 3.0;

/// The robot and its pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robot {
    /// How it moves.
    pub motion: Motion,
    /// Standard deviation of the pose's x and y, metres.
    pub sigma_m: f64,
}

/// How a flight went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Whether the last free preset point was reached.
    pub completed: bool,
    /// Whether the planner ever said that it was stuck.
    pub said_stuck: bool,
    /// The least true distance between hull and anything solid, metres; negative is a collision.
    pub clearance_m: f64,
    /// Share of the free preset points that came within half a metre of the robot.
    pub passed: f64,
    /// Root of the mean squared distance of the free preset points to the flown path, metres.
    pub cross_track_m: f64,
    /// Where it ended.
    pub end: Point,
    /// The preset point that was due in the end.
    pub due: Point,
    /// Time flown, seconds.
    pub time_s: f64,
}

/// Flies a planner along the preset path of a layout.
///
/// # Errors
/// What the planner refuses.
pub fn fly<P: Planner>(values: &[(&str, f64)], layout: &Layout, robot: Robot, seed: u64) -> Result<Outcome> {
    let obstacles = layout.obstacles();
    let site = layout.site(&obstacles, robot.motion);
    let bench = Bench::new();
    let mut planner: P = bench.configure(values, &site)?;
    let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x00f1_1ed5);
    let noise = Normal::new(0.0, robot.sigma_m).expect("a standard deviation is not negative");
    let mut course = Course::new(layout);
    let outward = layout.path[1] - layout.path[0];
    let mut pose = Pose { position: layout.path[0], heading_rad: outward.y.atan2(outward.x) };
    let mut flown = vec![pose.position];
    let mut outcome = Outcome {
        completed: false,
        said_stuck: false,
        clearance_m: f64::INFINITY,
        passed: 0.0,
        cross_track_m: 0.0,
        end: pose.position,
        due: layout.path[0],
        time_s: 0.0,
    };
    let mut stuck_ticks = 0;
    let limit_s = PATIENCE * polyline::length_m(&layout.path) / site.limits.v_max_m_per_s;
    for tick in 0..(limit_s / TICK_S) as u64 {
        let shake = Vector::new(noise.sample(&mut rng), noise.sample(&mut rng));
        let believed = Pose { position: pose.position + shake, ..pose };
        course.advance(believed.position);
        if course.is_done(believed.position) {
            outcome.completed = true;
            break;
        }
        let near = within_range(&obstacles, believed.position, &site);
        let sensed = sensed_at(tick, &believed, robot, &course, &near);
        let command = planner.step(&sensed, &bench.ctx())?;
        bench.clear();
        stuck_ticks = if command.status == Status::Stuck { stuck_ticks + 1 } else { 0 };
        outcome.said_stuck |= stuck_ticks > 0;
        if f64::from(stuck_ticks) * TICK_S > BORNE_S {
            break;
        }
        pose = moved(&pose, command.drive, &site);
        flown.push(pose.position);
        outcome.clearance_m = outcome.clearance_m.min(layout.hull_clearance_m(pose.position));
        outcome.time_s = tick as f64 * TICK_S;
    }
    outcome.end = pose.position;
    outcome.due = course.points[course.due];
    let off: Vec<f64> = course.free_points().map(|p| polyline::distance_m(&flown, p)).collect();
    let n_free = off.len().max(1) as f64;
    outcome.passed = off.iter().filter(|m| **m < LOOKAHEAD_M).count() as f64 / n_free;
    outcome.cross_track_m = (off.iter().map(|m| m * m).sum::<f64>() / n_free).sqrt();
    Ok(outcome)
}

/// The preset points and which of them is due, by the mission's rule: the first free one half a metre on along the
/// path from the point nearest to the robot, which only moves forward.
struct Course<'a> {
    points: &'a [Point],
    stations_m: Vec<f64>,
    is_free: Vec<bool>,
    nearest: usize,
    due: usize,
    last: usize,
}

impl<'a> Course<'a> {
    fn new(layout: &'a Layout) -> Self {
        let points = &layout.path[..];
        let is_free: Vec<bool> =
            points.iter().map(|p| layout.hull_clearance_m(*p) >= layout.clearance_m).collect();
        let last = is_free.iter().rposition(|free| *free).unwrap_or(0);
        Self { points, stations_m: polyline::stations_m(points), is_free, nearest: 0, due: 0, last }
    }

    fn free_points(&self) -> impl Iterator<Item = Point> + '_ {
        self.points.iter().zip(&self.is_free).filter(|(_, free)| **free).map(|(point, _)| *point)
    }

    fn advance(&mut self, at: Point) {
        let distance_m = |index: usize| (self.points[index] - at).norm();
        let window_m = (self.stations_m[self.nearest] + WINDOW_M).max(self.stations_m[self.due]);
        self.nearest = (self.nearest..self.points.len())
            .take_while(|index| self.stations_m[*index] <= window_m)
            .min_by(|a, b| distance_m(*a).total_cmp(&distance_m(*b)))
            .unwrap_or(self.nearest);
        let aim_m = self.stations_m[self.nearest] + LOOKAHEAD_M;
        self.due = (self.nearest..=self.last)
            .find(|index| self.stations_m[*index] >= aim_m && self.is_free[*index])
            .unwrap_or(self.last);
    }

    fn is_last(&self) -> bool {
        self.due == self.last
    }

    fn is_done(&self, at: Point) -> bool {
        self.is_last() && (self.points[self.due] - at).norm() < TOLERANCE_M
    }
}

fn within_range<'a>(obstacles: &[Obstacle<'a>], at: Point, site: &Site<'_>) -> Vec<Obstacle<'a>> {
    let is_near = |o: &&Obstacle<'_>| match o.outline {
        Outline::Disc { center, radius_m } => (center - at).norm() - radius_m < site.limits.sensing_range_m,
        _ => true,
    };
    obstacles.iter().filter(is_near).copied().collect()
}

fn sensed_at<'a>(
    tick: u64,
    pose: &Pose,
    robot: Robot,
    course: &Course<'a>,
    near: &'a [Obstacle<'a>],
) -> Sensed<'a> {
    let variance = robot.sigma_m * robot.sigma_m;
    let ahead = if course.is_last() { course.due + 1 } else { course.points.len().min(course.due + 30) };
    Sensed {
        tick,
        t_s: tick as f64 * TICK_S,
        dt_s: TICK_S,
        pose: PoseEstimate {
            position: pose.position,
            heading_rad: pose.heading_rad,
            covariance: Matrix3::from_diagonal(&nalgebra::Vector3::new(variance, variance, 1e-4)),
        },
        v_m_per_s: 0.0,
        w_rad_per_s: 0.0,
        target: course.points[course.due],
        targets_ahead: &course.points[course.due..ahead],
        path_ahead: &[],
        obstacles: near,
    }
}

fn moved(pose: &Pose, drive: Drive, site: &Site<'_>) -> Pose {
    match (drive, site.limits.motion) {
        (Drive::Velocity(velocity), Motion::Point) => {
            let heading_rad =
                if velocity.norm() > 1e-9 { velocity.y.atan2(velocity.x) } else { pose.heading_rad };
            Pose { position: pose.position + velocity * TICK_S, heading_rad }
        }
        (Drive::Velocity(velocity), Motion::Unicycle) => {
            let off_rad = wrap_angle_rad(velocity.y.atan2(velocity.x) - pose.heading_rad);
            let w_max = site.limits.w_max_rad_per_s;
            let turn = if velocity.norm() > 1e-9 { (2.0 * off_rad).clamp(-w_max, w_max) } else { 0.0 };
            ahead(pose, velocity.norm() * off_rad.cos().max(0.0), turn)
        }
        (Drive::Twist { v_m_per_s, w_rad_per_s }, _) => ahead(pose, v_m_per_s, w_rad_per_s),
    }
}

fn ahead(pose: &Pose, v_m_per_s: f64, w_rad_per_s: f64) -> Pose {
    let heading_rad = wrap_angle_rad(pose.heading_rad + w_rad_per_s * TICK_S);
    let middle = Pose { heading_rad: pose.heading_rad + w_rad_per_s * TICK_S / 2.0, ..*pose };
    Pose { position: pose.position + middle.direction() * (v_m_per_s * TICK_S), heading_rad }
}
