//! The console's side of the inputs: lends safe values to a planner as structs of the C ABI.
//!
//! Every struct made here points into the values that it was made from, and is valid only while those values stay in
//! place.

use super::{Leg, Obstacle, Outline, PlanIn, Pose, Site, StepIn, Str, Vec2, Zone, input};
use crate::{PoseEstimate, Reason, Task, TetherLimits, site};
use geometry::Pace;
use nalgebra::{Matrix3, Point2};

fn points(points: &[Point2<f64>]) -> (*const Vec2, u32) {
    (points.as_ptr().cast(), points.len() as u32)
}

fn outline(from: &site::Outline<'_>) -> Outline {
    let (kind, (points, n_points), size_m) = match from {
        site::Outline::Disc { center, radius_m } => {
            (input::OUTLINE_DISC, points(std::slice::from_ref(center)), *radius_m)
        }
        site::Outline::Polygon { vertices } => (input::OUTLINE_POLYGON, points(vertices), 0.0),
        site::Outline::Polyline { points: corners, half_width_m } => {
            (input::OUTLINE_POLYLINE, points(corners), *half_width_m)
        }
    };
    Outline { kind, n_points, points, size_m }
}

/// The centre of a round tank.
static ORIGIN: Vec2 = Vec2 { x: 0.0, y: 0.0 };

fn boundary(from: &site::Boundary<'_>) -> Outline {
    match from {
        site::Boundary::Circle { radius_m } => {
            Outline { kind: input::OUTLINE_DISC, n_points: 1, points: &raw const ORIGIN, size_m: *radius_m }
        }
        site::Boundary::Polygon { vertices } => outline(&site::Outline::Polygon { vertices }),
    }
}

/// Converts obstacles to the C ABI.
pub fn obstacles(from: &[site::Obstacle<'_>]) -> Vec<Obstacle> {
    let flags = |discovered| if discovered { input::OBSTACLE_DISCOVERED } else { 0 };
    from.iter()
        .map(|o| Obstacle {
            id: o.id,
            flags: flags(o.discovered),
            outline: outline(&o.outline),
            velocity: o.velocity_m_per_s.into(),
        })
        .collect()
}

/// Converts zones to the C ABI.
pub fn zones(from: &[site::Zone<'_>]) -> Vec<Zone> {
    from.iter().map(|z| Zone { kind: z.kind as u32, reserved: 0, outline: outline(&z.outline) }).collect()
}

/// Converts a site to the C ABI; `obstacles` and `zones` are those of `from`, already converted.
pub fn site(from: &site::Site<'_>, obstacles: &[Obstacle], zones: &[Zone]) -> Site {
    let pace =
        Pace { v_max_m_per_s: from.limits.v_max_m_per_s, w_max_rad_per_s: from.limits.w_max_rad_per_s };
    let (land, underwater) = from.limits.amphibious.map_or((pace, pace), |both| (both.land, both.underwater));
    Site {
        size: size_of::<Site>() as u32,
        revision: from.revision,
        seed: from.seed,
        boundary: boundary(&from.boundary),
        obstacles: obstacles.as_ptr(),
        n_obstacles: obstacles.len() as u32,
        obstacle_stride: size_of::<Obstacle>() as u32,
        zones: zones.as_ptr(),
        n_zones: zones.len() as u32,
        zone_stride: size_of::<Zone>() as u32,
        motion: from.limits.motion as u32,
        reserved: 0,
        v_max: from.limits.v_max_m_per_s,
        w_max: from.limits.w_max_rad_per_s,
        radius: from.limits.radius_m,
        sensing_range: from.limits.sensing_range_m,
        swath: from.swath_m,
        clearance: from.clearance_m,
        acceleration: from.limits.acceleration_m_per_s2,
        tick: from.limits.tick_s,
        is_amphibious: u32::from(from.limits.amphibious.is_some()),
        transition_ticks: from.limits.amphibious.map_or(0, |both| both.transition_steps),
        land_v_max: land.v_max_m_per_s,
        land_w_max: land.w_max_rad_per_s,
        underwater_v_max: underwater.v_max_m_per_s,
        underwater_w_max: underwater.w_max_rad_per_s,
    }
}

fn pose(from: &PoseEstimate) -> Pose {
    Pose { x: from.position.x, y: from.position.y, heading: from.heading_rad }
}

/// Returns the upper triangle of a covariance, row by row.
pub fn covariance(from: &Matrix3<f64>) -> [f64; 6] {
    [from[(0, 0)], from[(0, 1)], from[(0, 2)], from[(1, 1)], from[(1, 2)], from[(2, 2)]]
}

/// Converts the regions of a coverage task to the C ABI; other tasks have none.
fn regions(task: &Task<'_>) -> Vec<Outline> {
    let Task::Cover { regions, .. } = task else { return Vec::new() };
    regions.iter().map(|vertices| outline(&site::Outline::Polygon { vertices })).collect()
}

/// Everything that a request borrows besides its site, as structs of the C ABI.
pub struct PlanParts {
    regions: Vec<Outline>,
    way_legs: Vec<Leg>,
    way_cuts: Vec<Outline>,
}

impl PlanParts {
    /// Converts the parts of a request.
    pub fn of(from: &crate::PlanRequest<'_>) -> Self {
        let legs = from.under_way.map_or(&[][..], |way| &way.legs);
        let cuts = from.under_way.map_or(&[][..], |way| &way.cuts);
        let cut = |points: &Vec<Point2<f64>>| outline(&site::Outline::Polyline { points, half_width_m: 0.0 });
        Self {
            regions: regions(&from.task),
            way_legs: legs.iter().map(Leg::from).collect(),
            way_cuts: cuts.iter().map(cut).collect(),
        }
    }
}

/// Converts a request to the C ABI; `site` and `parts` are those of `from`, already converted.
pub fn plan(from: &crate::PlanRequest<'_>, site: &Site, parts: &PlanParts) -> PlanIn {
    let (reason, swap_from) = match from.reason {
        Reason::Start => (input::REASON_START, ""),
        Reason::Blocked => (input::REASON_BLOCKED, ""),
        Reason::MapChanged => (input::REASON_MAP_CHANGED, ""),
        Reason::Operator => (input::REASON_OPERATOR, ""),
        Reason::Swap { from } => (input::REASON_SWAP, from.as_str()),
        Reason::Recover => (input::REASON_RECOVER, ""),
    };
    let (task, (targets, n_targets), tolerance) = match &from.task {
        Task::Goto { goal, tolerance_m } => {
            (input::TASK_GOTO, points(std::slice::from_ref(goal)), *tolerance_m)
        }
        Task::Follow { targets, tolerance_m } => (input::TASK_FOLLOW, points(targets), *tolerance_m),
        Task::Cover { anchor, tolerance_m, .. } => {
            (input::TASK_COVER, points(std::slice::from_ref(anchor)), *tolerance_m)
        }
    };
    let tether = match from.task {
        Task::Cover { tether, .. } => tether,
        Task::Goto { .. } | Task::Follow { .. } => None,
    };
    let free = TetherLimits {
        reel_length_m: f64::INFINITY,
        wrap_max_rad: f64::INFINITY,
        wrap_total_max_rad: f64::INFINITY,
        pull: None,
    };
    let TetherLimits { reel_length_m, wrap_max_rad, wrap_total_max_rad, pull } = tether.unwrap_or(free);
    let (previous, n_previous) = points(from.previous);
    let (way, n_way) = points(from.under_way.map_or(&[], |way| &way.path));
    let PlanParts { regions, way_legs, way_cuts } = parts;
    PlanIn {
        size: size_of::<PlanIn>() as u32,
        reason,
        from: Str::of(swap_from),
        start: pose(&from.start),
        covariance: covariance(&from.start.covariance),
        task,
        n_targets,
        targets,
        tolerance,
        previous,
        n_previous,
        reserved: 0,
        site,
        regions: regions.as_ptr(),
        n_regions: regions.len() as u32,
        has_tether: u32::from(tether.is_some()),
        reel: reel_length_m,
        max_wrap: wrap_max_rad,
        max_sum_wrap: wrap_total_max_rad,
        way,
        way_legs: way_legs.as_ptr(),
        n_way,
        n_way_legs: way_legs.len() as u32,
        way_cuts: way_cuts.as_ptr(),
        n_way_cuts: way_cuts.len() as u32,
        way_complete: u32::from(from.under_way.is_some_and(|way| way.complete)),
        pull_per_m: pull.map_or(0.0, |pull| pull.floor_n_per_m),
        pull_friction: pull.map_or(0.0, |pull| pull.friction),
        reel_pull: pull.map_or(0.0, |pull| pull.reel_n),
        preferred_pull: pull.map_or(0.0, |pull| pull.preferred_n),
    }
}

/// Converts a planner's view of one tick to the C ABI; `obstacles` are those of `from`, already converted.
pub fn step(from: &crate::Sensed<'_>, obstacles: &[Obstacle]) -> StepIn {
    let (targets_ahead, n_targets_ahead) = points(from.targets_ahead);
    let (path_ahead, n_path_ahead) = points(from.path_ahead);
    StepIn {
        size: size_of::<StepIn>() as u32,
        reserved: 0,
        tick: from.tick,
        t: from.t_s,
        dt: from.dt_s,
        pose: pose(&from.pose),
        covariance: covariance(&from.pose.covariance),
        v: from.v_m_per_s,
        w: from.w_rad_per_s,
        target: from.target.into(),
        targets_ahead,
        n_targets_ahead,
        n_path_ahead,
        path_ahead,
        obstacles: obstacles.as_ptr(),
        n_obstacles: obstacles.len() as u32,
        obstacle_stride: size_of::<Obstacle>() as u32,
    }
}
