//! One drive of a planner in a closed loop: a robot with a noisy pose on a layout, and the mission's rule for the
//! target.

use crate::Layout;
use geometry::{
    Drive, Limits, Motion, PathFollower, Point, Pose, Vector,
    motion::{TURN_FIRST_RAD, drive_for},
    polyline,
};
use nalgebra::Matrix3;
use planner_api::{Obstacle, Outline, Planner, PoseEstimate, Result, Sensed, Site, Status, testing::Bench};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Mcg;

/// Duration of a tick, seconds.
const TICK_S: f64 = 0.1;
/// Distance within which a preset point counts as passed, metres.
const PASSED_M: f64 = 0.5;
/// Length of the part of the preset path, beyond the target, that the planner receives, metres.
const AHEAD_M: f64 = 4.0;
/// Distance at which the last point counts as reached, metres.
const TOLERANCE_M: f64 = 0.3;
/// Time, seconds, for which the planner must report being stuck before a drive ends.
const BORNE_S: f64 = 30.0;
/// Time limit of a drive, as a multiple of the time for the preset path at full speed.
const PATIENCE: f64 = 3.0;

/// The robot and the error of its pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robot {
    /// Motion of the robot.
    pub motion: Motion,
    /// Standard deviation of the pose's x and y, metres.
    pub sigma_m: f64,
}

/// The result of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Whether the last free preset point was reached.
    pub completed: bool,
    /// Whether the planner ever reported being stuck.
    pub said_stuck: bool,
    /// The least true distance between hull and anything solid, metres; negative in a collision.
    pub clearance_m: f64,
    /// Share of the free preset points that came within half a metre of the robot.
    pub passed: f64,
    /// Root of the mean squared distance from the free preset points to the driven path, metres.
    pub cross_track_m: f64,
    /// The last place of the robot.
    pub end: Point,
    /// The preset point that was the target at the end.
    pub due: Point,
    /// Time driven, seconds.
    pub time_s: f64,
}

/// Has a planner drive along the preset path of a layout.
///
/// # Errors
/// The planner refuses its parameters, or a call fails.
pub fn fly<P: Planner>(values: &[(&str, f64)], layout: &Layout, robot: Robot, seed: u64) -> Result<Outcome> {
    let obstacles = layout.obstacles();
    let site = layout.site(&obstacles, robot.motion);
    let bench = Bench::new();
    let mut planner: P = bench.configure(values, &site)?;
    let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x00f1_1ed5);
    let noise = Normal::new(0.0, robot.sigma_m).expect("a standard deviation must not be negative");
    let has_room = |at: Point| layout.hull_clearance_m(at) >= layout.clearance_m;
    let mut follower = PathFollower::new(layout.path.clone());
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
        follower.advance(believed.position, has_room);
        if follower.is_done(believed.position, TOLERANCE_M) {
            outcome.completed = true;
            break;
        }
        let near = within_range(&obstacles, believed.position, &site);
        let sensed = sensed_at(tick, &believed, robot, &follower, &near);
        let command = planner.step(&sensed, &bench.ctx())?;
        bench.clear();
        stuck_ticks = if command.status == Status::Stuck { stuck_ticks + 1 } else { 0 };
        outcome.said_stuck |= stuck_ticks > 0;
        if f64::from(stuck_ticks) * TICK_S > BORNE_S {
            break;
        }
        pose = moved(&pose, command.drive, &site.limits);
        flown.push(pose.position);
        outcome.clearance_m = outcome.clearance_m.min(layout.hull_clearance_m(pose.position));
        outcome.time_s = tick as f64 * TICK_S;
    }
    outcome.end = pose.position;
    outcome.due = follower.target();
    let free = layout.path.iter().filter(|p| has_room(**p));
    let off: Vec<f64> = free.map(|p| polyline::distance_m(&flown, *p)).collect();
    let n_free = off.len().max(1) as f64;
    outcome.passed = off.iter().filter(|m| **m < PASSED_M).count() as f64 / n_free;
    outcome.cross_track_m = (off.iter().map(|m| m * m).sum::<f64>() / n_free).sqrt();
    Ok(outcome)
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
    follower: &'a PathFollower,
    near: &'a [Obstacle<'a>],
) -> Sensed<'a> {
    let variance = robot.sigma_m * robot.sigma_m;
    let estimate = PoseEstimate {
        position: pose.position,
        heading_rad: pose.heading_rad,
        covariance: Matrix3::from_diagonal(&nalgebra::Vector3::new(variance, variance, 1e-4)),
    };
    Sensed {
        targets_ahead: follower.ahead(AHEAD_M),
        obstacles: near,
        ..Sensed::new(tick, TICK_S, estimate, follower.target())
    }
}

pub(super) fn moved(pose: &Pose, drive: Drive, limits: &Limits) -> Pose {
    match drive_for(drive, pose.heading_rad, limits, TURN_FIRST_RAD) {
        Drive::Velocity(velocity) => {
            let heading_rad =
                if velocity.norm() > 1e-9 { velocity.y.atan2(velocity.x) } else { pose.heading_rad };
            Pose { position: pose.position + velocity * TICK_S, heading_rad }
        }
        Drive::Twist { v_m_per_s, w_rad_per_s } => pose.moved(v_m_per_s * TICK_S, 0.0, w_rad_per_s * TICK_S),
    }
}
