//! What a plan does to the tether.

use crate::config::{MissionConfig, TetherConfig};
use planner_api::{LegTag, Plan};
use world::{
    Point, World,
    tether::{Cable, Case, Certificate, certify},
};

/// Distance from the anchor within which a task ends at it, metres.
const AT_ANCHOR_M: f64 = 0.3;

/// Judges a plan of a whole mission before anything has moved, on the drawing.
pub fn certify_from_start(
    tether: &TetherConfig,
    config: &MissionConfig,
    path: &[Point],
    cuts: &[Vec<Point>],
    drawing: &World,
) -> Certificate {
    let returns = ends_at_anchor(tether, config);
    certified(tether, config.limits.radius_m, None, path, cuts, drawing, returns)
}

/// Index of the point of a plan's path at which a return path along the cable ends; 0 without one. A way that ends away
/// from the anchor is not one, whatever the planner calls it.
pub(crate) fn return_path_ends(plan: &Plan, anchor: Point) -> usize {
    let is_home = |last: usize| plan.path.get(last).is_some_and(|end| (end - anchor).norm() <= AT_ANCHOR_M);
    let first = plan.legs.first().filter(|leg| leg.tag == LegTag::Retract && leg.first == 0);
    first.map(|leg| leg.last).filter(|last| is_home(*last)).unwrap_or(0)
}

/// Whether the task ends where the tether is made fast.
pub(crate) fn ends_at_anchor(tether: &TetherConfig, config: &MissionConfig) -> bool {
    config.task.end().is_some_and(|end| (end - tether.anchor).norm() <= AT_ANCHOR_M)
}

/// Evaluates a path with the cable as it lies, or, without one, straight from the anchor; `hull_m` is the room that the
/// middle of the hull needs, metres.
pub(super) fn certified(
    config: &TetherConfig,
    hull_m: f64,
    cable: Option<&Cable>,
    path: &[Point],
    cuts: &[Vec<Point>],
    world: &World,
    returns: bool,
) -> Certificate {
    let case = Case {
        path,
        anchor: config.anchor,
        cable,
        boundary: &world.boundary,
        obstacles: &world.obstacles,
        room_m: hull_m,
        limits: config.limits,
        returns,
        cuts,
    };
    if path.is_empty() {
        return Certificate::refused("the planner returned no usable path".into());
    }
    certify(&case).unwrap_or_else(|error| Certificate::refused(error.to_string()))
}
