//! The effect of a plan on the tether.

use crate::slit_domain::SlitDomain;
use crate::workspace::Workspace;
use planner_api::{PlanRequest, Site};
use std::sync::Arc;
use world::tether::{Cable, Case, Certificate, Ground, Limits, PullLimits, Strain, certify_on, strain};
use world::{Boundary, Obstacle, ObstacleId, ObstacleMap, Point, Shape, tether};

/// Length outside the anchor up to which a cable counts as reeled in, metres.
const IN_M: f64 = 1e-3;

/// The minimum cable length, metres: approximately the longest straight line from the anchor to a position that the
/// robot can reach.
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

/// The cable as it lies after the path driven so far; `None` at the anchor.
pub(crate) fn laid_cable(workspace: &Workspace, request: &PlanRequest<'_>) -> Option<Cable> {
    if request.previous.is_empty() {
        return None;
    }
    let mut cable = Cable::new(workspace.anchor, &workspace.wall, &shapes(&obstacles(request.site))).ok()?;
    cable.drag_along(request.previous);
    cable.drag_to(request.start.position);
    Some(cable)
}

/// The return path along the cable, if the hull fits.
pub(crate) fn return_path(workspace: &Workspace, site: &Site<'_>, cable: &Cable) -> Option<Vec<Point>> {
    let (obstacles, keep_m) = (obstacles(site), workspace.keep_m);
    let roomy = Arc::new(tether::CableObstacles::grown(&workspace.wall, &shapes(&obstacles), keep_m));
    cable.return_path(&roomy, &ObstacleMap::new(&workspace.wall, &obstacles), keep_m)
}

/// Whether the cable is reeled in once the robot has driven home through a domain. A cable that lies across a cut
/// remains wound around an obstacle.
pub(crate) fn comes_in(domain: &SlitDomain<'_>, cable: &Cable) -> bool {
    let Workspace { home, anchor, .. } = *domain.workspace;
    let start = domain.beside(cable.tip());
    let Some(way) = start.and_then(|start| domain.path(start, home)) else { return true };
    let mut left = cable.clone();
    left.drag_along(&way);
    left.drag_to(anchor);
    left.length_m() < IN_M
}

/// What the mission requires of the tether; the second part is `None` if the pull is not limited.
pub(crate) type Demands = (Limits, Option<PullLimits>);

/// A path that returns to the anchor, and the position of the cable at its start.
#[derive(Clone, Copy)]
pub(crate) struct Tethered<'a> {
    pub domain: &'a SlitDomain<'a>,
    pub path: &'a [Point],
    pub cable: Option<&'a Cable>,
}

impl Tethered<'_> {
    /// The certificate of the path.
    pub(crate) fn certificate(&self, site: &Site<'_>, limits: Demands) -> Certificate {
        let obstacles = obstacles(site);
        let certificate = certify_on(self.ground(&obstacles), &self.case(&obstacles, limits));
        certificate.unwrap_or_else(|error| Certificate {
            tether_length_max_m: f64::INFINITY,
            eccentricity_m: least_cable_m(self.domain.workspace),
            wrap_max_rad: f64::INFINITY,
            wrap_total_max_rad: f64::INFINITY,
            ..Certificate::refused(error.to_string())
        })
    }

    /// The strain that the path puts on the cable; `None` where no cable can lie.
    pub(crate) fn strain(&self, site: &Site<'_>, limits: Demands) -> Option<Strain> {
        let obstacles = obstacles(site);
        strain(self.ground(&obstacles), &self.case(&obstacles, limits)).ok()
    }

    fn ground(&self, obstacles: &[Obstacle]) -> &Ground {
        let Workspace { wall, anchor, ground, .. } = self.domain.workspace;
        ground.get_or_init(|| Ground::new(*anchor, wall, obstacles))
    }

    fn case<'b>(&'b self, obstacles: &'b [Obstacle], (limits, pull): Demands) -> Case<'b> {
        let SlitDomain { workspace, cuts, .. } = self.domain;
        Case {
            path: self.path,
            anchor: workspace.anchor,
            cable: self.cable,
            boundary: &workspace.wall,
            obstacles,
            room_m: workspace.keep_m,
            limits,
            pull,
            returns: true,
            cuts,
        }
    }
}

/// The obstacles of a site, without no-go zones, which stop the robot but not its cable.
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
