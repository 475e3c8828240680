//! What the console passes to a planner.
#![allow(missing_docs, reason = "the header explains the fields")]

use super::{Leg, Pose, Sized32, Str, Vec2};

/// Outline kind: a disc; `points[0]` is its centre, `size_m` its radius.
pub const OUTLINE_DISC: u32 = 0;
/// Outline kind: a polygon; `points` are its corners, counter-clockwise.
pub const OUTLINE_POLYGON: u32 = 1;
/// Outline kind: a line through `points`; `size_m` is half its thickness.
pub const OUTLINE_POLYLINE: u32 = 2;
/// Flag of an obstacle that was found during the mission.
pub const OBSTACLE_DISCOVERED: u32 = 1;

/// The numbers of [`crate::Reason`].
pub const REASON_START: u32 = 0;
pub const REASON_BLOCKED: u32 = 1;
pub const REASON_MAP_CHANGED: u32 = 2;
pub const REASON_OPERATOR: u32 = 3;
pub const REASON_SWAP: u32 = 4;
pub const REASON_RECOVER: u32 = 5;

/// The numbers of [`crate::Task`].
pub const TASK_GOTO: u32 = 0;
pub const TASK_FOLLOW: u32 = 1;
pub const TASK_COVER: u32 = 2;

/// A disc, polygon or polyline.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Outline {
    pub kind: u32,
    pub n_points: u32,
    pub points: *const Vec2,
    pub size_m: f64,
}

/// A solid object. Arrays of obstacles carry a stride, so that the struct can grow.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Obstacle {
    pub id: u32,
    pub flags: u32,
    pub outline: Outline,
    pub velocity: Vec2,
}

/// A special part of the floor; see [`crate::ZoneKind`]. Arrays of zones carry a stride, so that the struct can grow.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Zone {
    pub kind: u32,
    pub reserved: u32,
    pub outline: Outline,
}

/// The tank, the robot and the margins that the mission requires.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Site {
    pub size: u32,
    pub revision: u32,
    pub seed: u64,
    pub boundary: Outline,
    pub obstacles: *const Obstacle,
    pub n_obstacles: u32,
    pub obstacle_stride: u32,
    pub zones: *const Zone,
    pub n_zones: u32,
    pub zone_stride: u32,
    pub motion: u32,
    pub reserved: u32,
    pub v_max: f64,
    pub w_max: f64,
    pub radius: f64,
    pub sensing_range: f64,
    pub swath: f64,
    pub clearance: f64,
    // Since 1.4.
    pub acceleration: f64,
    pub tick: f64,
    pub is_amphibious: u32,
    pub transition_ticks: u32,
    pub land_v_max: f64,
    pub land_w_max: f64,
    pub underwater_v_max: f64,
    pub underwater_w_max: f64,
}

/// A request for a plan.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct PlanIn {
    pub size: u32,
    pub reason: u32,
    pub from: Str,
    pub start: Pose,
    pub covariance: [f64; 6],
    pub task: u32,
    pub n_targets: u32,
    pub targets: *const Vec2,
    pub tolerance: f64,
    pub previous: *const Vec2,
    pub n_previous: u32,
    pub reserved: u32,
    pub site: *const Site,
    // Since 1.1.
    pub regions: *const Outline,
    pub n_regions: u32,
    pub has_tether: u32,
    pub reel: f64,
    pub max_wrap: f64,
    pub max_sum_wrap: f64,
    // Since 1.3.
    pub way: *const Vec2,
    pub way_legs: *const Leg,
    pub n_way: u32,
    pub n_way_legs: u32,
    pub way_cuts: *const Outline,
    pub n_way_cuts: u32,
    pub way_complete: u32,
    // Since 1.5.
    pub pull_per_m: f64,
    pub pull_friction: f64,
    pub reel_pull: f64,
    pub preferred_pull: f64,
}

/// A planner's view of one tick.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct StepIn {
    pub size: u32,
    pub reserved: u32,
    pub tick: u64,
    pub t: f64,
    pub dt: f64,
    pub pose: Pose,
    pub covariance: [f64; 6],
    pub v: f64,
    pub w: f64,
    pub target: Vec2,
    pub targets_ahead: *const Vec2,
    pub n_targets_ahead: u32,
    pub n_path_ahead: u32,
    pub path_ahead: *const Vec2,
    pub obstacles: *const Obstacle,
    pub n_obstacles: u32,
    pub obstacle_stride: u32,
}

// SAFETY: consists of numbers and raw pointers and begins with its size.
unsafe impl Sized32 for Site {}
// SAFETY: as above.
unsafe impl Sized32 for PlanIn {}
// SAFETY: as above.
unsafe impl Sized32 for StepIn {}
