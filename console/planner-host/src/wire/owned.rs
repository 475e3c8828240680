//! What a worker was told, with its arrays; lent to the planner as the borrowed forms of `planner_api`.

use nalgebra::Point2;
use planner_api::{
    Boundary, Limits, Obstacle, Outline, PlanRequest, PoseEstimate, Reason, Sensed, Site, Task, TetherLimits,
    Zone, ZoneKind,
};

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OwnedBoundary {
    Circle { radius_m: f64 },
    Polygon { vertices: Vec<Point2<f64>> },
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OwnedOutline {
    Disc { center: Point2<f64>, radius_m: f64 },
    Polygon { vertices: Vec<Point2<f64>> },
    Polyline { points: Vec<Point2<f64>>, half_width_m: f64 },
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OwnedObstacle {
    pub(crate) id: u32,
    pub(crate) discovered: bool,
    pub(crate) velocity_m_per_s: nalgebra::Vector2<f64>,
    pub(crate) outline: OwnedOutline,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OwnedZone {
    pub(crate) kind: ZoneKind,
    pub(crate) outline: OwnedOutline,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OwnedSite {
    pub(crate) revision: u32,
    pub(crate) seed: u64,
    pub(crate) boundary: OwnedBoundary,
    pub(crate) obstacles: Vec<OwnedObstacle>,
    pub(crate) zones: Vec<OwnedZone>,
    pub(crate) limits: Limits,
    pub(crate) swath_m: f64,
    pub(crate) clearance_m: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OwnedTask {
    Goto {
        goal: Point2<f64>,
        tolerance_m: f64,
    },
    Follow {
        targets: Vec<Point2<f64>>,
        tolerance_m: f64,
    },
    Cover {
        anchor: Point2<f64>,
        regions: Vec<Vec<Point2<f64>>>,
        tether: Option<TetherLimits>,
        tolerance_m: f64,
    },
}

impl OwnedTask {
    fn regions(&self) -> Vec<&[Point2<f64>]> {
        match self {
            Self::Cover { regions, .. } => regions.iter().map(Vec::as_slice).collect(),
            Self::Goto { .. } | Self::Follow { .. } => Vec::new(),
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OwnedRequest {
    pub(crate) reason: Reason,
    pub(crate) start: PoseEstimate,
    pub(crate) task: OwnedTask,
    pub(crate) site: OwnedSite,
    pub(crate) previous: Vec<Point2<f64>>,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OwnedSensed {
    pub(crate) tick: u64,
    pub(crate) t_s: f64,
    pub(crate) dt_s: f64,
    pub(crate) pose: PoseEstimate,
    pub(crate) v_m_per_s: f64,
    pub(crate) w_rad_per_s: f64,
    pub(crate) target: Point2<f64>,
    pub(crate) targets_ahead: Vec<Point2<f64>>,
    pub(crate) path_ahead: Vec<Point2<f64>>,
    pub(crate) obstacles: Vec<OwnedObstacle>,
}

impl OwnedOutline {
    fn lend(&self) -> Outline<'_> {
        match self {
            Self::Disc { center, radius_m } => Outline::Disc { center: *center, radius_m: *radius_m },
            Self::Polygon { vertices } => Outline::Polygon { vertices },
            Self::Polyline { points, half_width_m } => {
                Outline::Polyline { points, half_width_m: *half_width_m }
            }
        }
    }
}

fn lend_obstacles(obstacles: &[OwnedObstacle]) -> Vec<Obstacle<'_>> {
    obstacles
        .iter()
        .map(|o| Obstacle {
            id: o.id,
            outline: o.outline.lend(),
            discovered: o.discovered,
            velocity_m_per_s: o.velocity_m_per_s,
        })
        .collect()
}

impl OwnedSite {
    /// Lends the site for the length of a call.
    pub(crate) fn lend<R>(&self, call: impl FnOnce(&Site<'_>) -> R) -> R {
        let zones: Vec<Zone<'_>> =
            self.zones.iter().map(|zone| Zone { kind: zone.kind, outline: zone.outline.lend() }).collect();
        call(&Site {
            revision: self.revision,
            boundary: match &self.boundary {
                OwnedBoundary::Circle { radius_m } => Boundary::Circle { radius_m: *radius_m },
                OwnedBoundary::Polygon { vertices } => Boundary::Polygon { vertices },
            },
            obstacles: &lend_obstacles(&self.obstacles),
            zones: &zones,
            limits: self.limits,
            swath_m: self.swath_m,
            clearance_m: self.clearance_m,
            seed: self.seed,
        })
    }
}

impl OwnedRequest {
    /// Lends the request for the length of a call.
    pub(crate) fn lend<R>(&self, call: impl FnOnce(&PlanRequest<'_>) -> R) -> R {
        let regions = self.task.regions();
        let task = match &self.task {
            OwnedTask::Goto { goal, tolerance_m } => Task::Goto { goal: *goal, tolerance_m: *tolerance_m },
            OwnedTask::Follow { targets, tolerance_m } => Task::Follow { targets, tolerance_m: *tolerance_m },
            OwnedTask::Cover { anchor, tether, tolerance_m, .. } => {
                Task::Cover { anchor: *anchor, regions: &regions, tether: *tether, tolerance_m: *tolerance_m }
            }
        };
        let (reason, start, previous) = (&self.reason, self.start, self.previous.as_slice());
        self.site.lend(|site| call(&PlanRequest { reason, start, task, site, previous }))
    }
}

impl OwnedSensed {
    /// Lends what is sensed for the length of a call.
    pub(crate) fn lend<R>(&self, call: impl FnOnce(&Sensed<'_>) -> R) -> R {
        call(&Sensed {
            tick: self.tick,
            t_s: self.t_s,
            dt_s: self.dt_s,
            pose: self.pose,
            v_m_per_s: self.v_m_per_s,
            w_rad_per_s: self.w_rad_per_s,
            target: self.target,
            targets_ahead: &self.targets_ahead,
            path_ahead: &self.path_ahead,
            obstacles: &lend_obstacles(&self.obstacles),
        })
    }
}
