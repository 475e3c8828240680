//! The effect of a plan on the tether.

use crate::config::{MissionConfig, TetherConfig};
use planner_api::{LegTag, Plan};
use world::{
    Point, World,
    tether::{Cable, Case, Certificate, certify},
};

/// Distance from the anchor within which a task counts as ending at the anchor, metres.
const AT_ANCHOR_M: f64 = 0.3;

/// Evaluates a plan for a whole mission using the drawing, before anything has moved.
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

/// Index of the point in a plan's path at which a return path along the cable ends; 0 if there is no return path. A path
/// that ends away from the anchor does not count, whatever the planner calls it.
pub(crate) fn return_path_ends(plan: &Plan, anchor: Point) -> usize {
    let is_home = |last: usize| plan.path.get(last).is_some_and(|end| (end - anchor).norm() <= AT_ANCHOR_M);
    let first = plan.legs.first().filter(|leg| leg.tag == LegTag::Retract && leg.first == 0);
    first.map(|leg| leg.last).filter(|last| is_home(*last)).unwrap_or(0)
}

/// Whether the task ends at the tether's anchor.
pub(crate) fn ends_at_anchor(tether: &TetherConfig, config: &MissionConfig) -> bool {
    config.task.end().is_some_and(|end| (end - tether.anchor).norm() <= AT_ANCHOR_M)
}

/// Evaluates a path, starting with the current geometry of the cable or, without a cable, with a straight one; `hull_m`
/// is the distance that the hull's centre must keep from obstacles, metres.
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
        pull: config.reel.map(|reel| reel.limits(config.friction)),
        returns,
        cuts,
    };
    if path.is_empty() {
        return Certificate::refused("the planner returned no usable path".into());
    }
    certify(&case).unwrap_or_else(|error| Certificate::refused(error.to_string()))
}
