//! What a plan means to the tether.

use crate::slit_domain::SlitDomain;
use crate::workspace::Workspace;
use planner_api::{PlanRequest, Site};
use std::sync::Arc;
use world::tether::{Cable, Case, Certificate, Limits, certify};
use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape, tether};

/// Longest straight way from the anchor to where the robot can be, about: the least cable that can do, metres.
pub(crate) fn least_cable_m(workspace: &Workspace) -> f64 {
    let Workspace { wall, anchor, keep_m, .. } = workspace;
    match wall {
        Boundary::Circle { radius_m } => radius_m - keep_m + anchor.coords.norm(),
        Boundary::Polygon { vertices } => {
            let far_m = vertices.iter().map(|v| (v - anchor).norm()).fold(0.0, f64::max);
            far_m - keep_m * std::f64::consts::SQRT_2
        }
    }
}

/// The cable as it lies after the path flown so far; none at the anchor.
pub(crate) fn laid_cable(workspace: &Workspace, request: &PlanRequest<'_>) -> Option<Cable> {
    if request.previous.is_empty() {
        return None;
    }
    let mut cable = Cable::new(workspace.anchor, &workspace.wall, &shapes(&obstacles(request.site))).ok()?;
    cable.drag_along(request.previous);
    cable.drag_to(request.start.position);
    Some(cable)
}

/// Back along the cable, if the hull has room there.
pub(crate) fn return_path(workspace: &Workspace, site: &Site<'_>, cable: &Cable) -> Option<Vec<Point>> {
    let (obstacles, keep_m) = (obstacles(site), workspace.keep_m);
    let roomy = Arc::new(tether::CableObstacles::grown(&workspace.wall, &shapes(&obstacles), keep_m));
    cable.return_path(&roomy, &ObstacleMap::new(&workspace.wall, &obstacles), keep_m)
}

/// What a path that returns does to the tether, if the cable lies like this at its start.
pub(crate) fn certificate(
    SlitDomain { workspace, cuts, .. }: &SlitDomain<'_>,
    site: &Site<'_>,
    limits: Limits,
    path: &[Point],
    cable: Option<&Cable>,
) -> Certificate {
    let case = Case {
        path,
        anchor: workspace.anchor,
        cable,
        boundary: &workspace.wall,
        obstacles: &obstacles(site),
        room_m: workspace.keep_m,
        limits,
        returns: true,
        cuts,
    };
    certify(&case).unwrap_or_else(|error| Certificate {
        tether_length_max_m: f64::INFINITY,
        eccentricity_m: least_cable_m(workspace),
        wrap_max_rad: f64::INFINITY,
        wrap_total_max_rad: f64::INFINITY,
        ..Certificate::refused(error.to_string())
    })
}

/// The obstacles of a site, no-go zones left out: they stop the robot, not its cable.
fn obstacles(site: &Site<'_>) -> Vec<Obstacle> {
    let obstacle = |o: &planner_api::Obstacle<'_>| Obstacle {
        id: ObstacleId(o.id),
        name: format!("obstacle {}", o.id),
        shape: o.outline.to_owned(),
        known: true,
    };
    site.obstacles.iter().map(obstacle).collect()
}

fn shapes(obstacles: &[Obstacle]) -> Vec<Shape> {
    obstacles.iter().map(|o| o.shape.clone()).collect()
}
