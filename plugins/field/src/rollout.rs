//! Plans by simulating a flight over the known map.

use crate::{
    outcome::{Shortfall, Walk},
    pilot::ForcePilot,
    scene::Scene,
    settings::FieldSettings,
};
use geometry::{Point, polyline};
use planner_api::{Ctx, Limits, Motion, PlanRequest, PoseEstimate, Result, Site, Status, Task};
use steering::Tick;

/// Distance covered in a tick at full speed, metres.
const MOVE_M: f64 = 0.05;
/// Distance from the robot within which a preset point counts as passed, metres. The mission looks ahead just as far.
const LOOKAHEAD_M: f64 = 0.5;
/// Distance from the robot beyond which obstacles do not affect the pilot, metres.
const RANGE_M: f64 = 4.5;
/// Maximum number of ticks: a multiple of the number needed for the straight path, plus a constant for short paths.
const DETOUR: f64 = 4.0;
const SPARE_TICKS: usize = 4000;

/// Returns the path of a simulated robot that moves as the pilot decides. The robot can move in any direction, and the
/// pilot knows its exact position.
///
/// # Errors
/// The console requests a stop.
pub fn fly(
    scene: &Scene,
    settings: &FieldSettings,
    request: &PlanRequest<'_>,
    ctx: &Ctx<'_>,
) -> Result<Walk> {
    let limits = Limits { motion: Motion::Point, ..request.site.limits };
    let mut pilot = ForcePilot::new(settings, &Site { limits, ..*request.site });
    let mut targets = Targets::new(scene, request);
    let v_max = limits.v_max_m_per_s.max(1e-6);
    let tick_s = MOVE_M / v_max;
    let mut at = request.start.position;
    let mut heading_rad = request.start.heading_rad;
    let mut path = vec![at];
    for tick in 0..targets.most_ticks(at) {
        ctx.check()?;
        targets.advance(at);
        if targets.is_done(at) {
            return Ok(Walk { path, shortfall: None });
        }
        let bodies = scene.bodies_within(at, RANGE_M + limits.radius_m);
        let pose = PoseEstimate { position: at, heading_rad, covariance: nalgebra::Matrix3::zeros() };
        let t_s = tick as f64 * tick_s;
        let tick = Tick { t_s, pose, target: targets.target(), is_last: targets.is_last(), bodies: &bodies };
        let decision = pilot.decide(settings, &tick).decision;
        if decision.status == Status::Stuck {
            return Ok(Walk { path, shortfall: Some(Shortfall::Trapped { at }) });
        }
        if decision.velocity.norm() > 1e-9 {
            heading_rad = decision.velocity.y.atan2(decision.velocity.x);
        }
        at += decision.velocity * tick_s;
        path.push(at);
    }
    let missing_m = (targets.target() - at).norm();
    Ok(Walk { path, shortfall: Some(Shortfall::Short { missing_m, at }) })
}

/// Targets in order, without those that the robot cannot occupy.
struct Targets {
    points: Vec<Point>,
    due: usize,
    tolerance_m: f64,
}

impl Targets {
    fn new(scene: &Scene, request: &PlanRequest<'_>) -> Self {
        let demanded_m = request.site.clearance_m;
        let is_free = |p: &&Point| scene.hull_clearance_m(**p).min(scene.wall_clearance_m(**p)) >= demanded_m;
        let (points, tolerance_m) = match request.task {
            // Coverage tasks are refused before this point, so only their return path can get here.
            Task::Goto { goal, tolerance_m } | Task::Cover { anchor: goal, tolerance_m, .. } => {
                (vec![goal], tolerance_m)
            }
            Task::Follow { targets, tolerance_m } => {
                let free: Vec<Point> = targets.iter().filter(is_free).copied().collect();
                (if free.is_empty() { targets.to_vec() } else { free }, tolerance_m)
            }
        };
        Self { points, due: 0, tolerance_m }
    }

    fn target(&self) -> Point {
        self.points[self.due]
    }

    fn is_last(&self) -> bool {
        self.due + 1 == self.points.len()
    }

    fn advance(&mut self, at: Point) {
        while !self.is_last() && (self.target() - at).norm() < LOOKAHEAD_M {
            self.due += 1;
        }
    }

    fn is_done(&self, at: Point) -> bool {
        self.is_last() && (self.target() - at).norm() <= self.tolerance_m
    }

    fn most_ticks(&self, start: Point) -> usize {
        let way_m = (self.target() - start).norm() + polyline::length_m(&self.points);
        (DETOUR * way_m / MOVE_M) as usize + SPARE_TICKS
    }
}
