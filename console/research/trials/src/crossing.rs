//! A cart that crosses the robot's way to its goal.

use crate::{exact_pose, flight};
use geometry::{Limits, Motion, Point, Pose, Vector, wrap_angle_rad};
use planner_api::{Boundary, Obstacle, Outline, Planner, Sensed, Site, testing::Bench};

/// Duration of a tick, seconds, and maximum number of ticks.
const TICK_S: f64 = 0.1;
const TICKS: u64 = 1500;
/// Start and goal of the robot.
const START: Point = Point::new(-6.0, 0.0);
const GOAL: Point = Point::new(6.0, 0.0);
const TOLERANCE_M: f64 = 0.2;
/// Radius of the cart, metres.
const CART_M: f64 = 0.4;

/// The result of a crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Whether the goal was reached.
    pub arrived: bool,
    /// The least distance between hull and cart, metres; negative in a collision.
    pub clearance_m: f64,
}

const SITE: Site<'static> = Site {
    revision: 0,
    boundary: Boundary::Circle { radius_m: 8.0 },
    obstacles: &[],
    zones: &[],
    limits: Limits {
        motion: Motion::Unicycle,
        v_max_m_per_s: 0.4,
        w_max_rad_per_s: 1.0,
        radius_m: 0.25,
        sensing_range_m: 3.0,
        acceleration_m_per_s2: 0.5,
        tick_s: TICK_S,
        amphibious: None,
    },
    swath_m: 0.5,
    clearance_m: 0.05,
    seed: 0,
};

/// Has a planner drive without a plan over an open floor to a goal 12 m to the east, while a cart that starts at
/// `from_y_m` crosses the robot's way at a constant speed.
///
/// # Panics
/// The planner refuses its parameters, or a step fails.
pub fn cross<P: Planner>(values: &[(&str, f64)], from_y_m: f64) -> Crossing {
    let bench = Bench::new();
    let mut planner: P = bench.configure(values, &SITE).expect("accepts its own parameters");
    let limits = SITE.limits;
    let mut pose = Pose { position: START, heading_rad: 0.0 };
    let (mut before, mut was_seen) = (pose, false);
    let velocity = Vector::new(0.0, -0.35 * from_y_m.signum());
    let mut crossing = Crossing { arrived: false, clearance_m: f64::INFINITY };
    for tick in 0..TICKS {
        if (pose.position - GOAL).norm() < TOLERANCE_M {
            crossing.arrived = true;
            break;
        }
        let center = Point::new(-2.0, from_y_m) + velocity * (tick as f64 * TICK_S);
        let outline_m = (center - pose.position).norm() - CART_M;
        crossing.clearance_m = crossing.clearance_m.min(outline_m - limits.radius_m);
        let is_seen = outline_m < limits.sensing_range_m;
        // A velocity is known from the second sighting on.
        let known = if is_seen && was_seen { velocity } else { Vector::zeros() };
        was_seen = is_seen;
        let outline = Outline::Disc { center, radius_m: CART_M };
        let cart = [Obstacle { id: 9, outline, discovered: true, velocity_m_per_s: known }];
        let estimate =
            planner_api::PoseEstimate { heading_rad: pose.heading_rad, ..exact_pose(pose.position) };
        let sensed = Sensed {
            v_m_per_s: (pose.position - before.position).norm() / TICK_S,
            w_rad_per_s: wrap_angle_rad(pose.heading_rad - before.heading_rad) / TICK_S,
            targets_ahead: &[GOAL],
            obstacles: if is_seen { &cart } else { &[] },
            ..Sensed::new(tick, TICK_S, estimate, GOAL)
        };
        let command = planner.step(&sensed, &bench.ctx()).expect("the planner answers");
        bench.clear();
        (before, pose) = (pose, flight::moved(&pose, command.drive, &limits));
    }
    crossing
}
