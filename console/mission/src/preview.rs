//! A plan without a flight: what a planner is asked on the drawing.

use crate::{
    ask::{PlanAsk, Site, SiteObstacle, SiteZone, TaskLeft},
    chart::Chart,
    config::MissionConfig,
    task::Task,
};
use nalgebra::Matrix3;
use planner_api::{self as api, PoseEstimate, Reason};
use std::sync::Arc;
use world::{Boundary, CoverageGrid, Floor, Shape, World};

/// What the mission's planner would be asked for at the start, on the drawing: a plan of the whole task.
pub fn preview(config: &MissionConfig, drawing: &World, seed: u64) -> PlanAsk {
    let chart = Chart::new(drawing.clone(), config, seed);
    let task = Task::new(&config.task, config.start.position);
    let (room_m, start) = (config.room_m(), config.start.position);
    let floor = Floor::new(drawing, config.cell_m, room_m, config.swath_m, start);
    let (position_m2, heading_rad2) = (config.start_sigma_m.powi(2), config.start_heading_sigma_rad.powi(2));
    let start = PoseEstimate {
        position: config.start.position,
        heading_rad: config.start.heading_rad,
        covariance: Matrix3::from_diagonal(&nalgebra::Vector3::new(position_m2, position_m2, heading_rad2)),
    };
    let regions = task.regions_left(&CoverageGrid::new(floor), config.lane_m());
    let regions: Vec<&[world::Point]> = regions.iter().map(Vec::as_slice).collect();
    let task = task_left(&task.as_request(&regions, config.tether_limits()));
    let site = Arc::new(chart.with_site(site_of));
    PlanAsk { reason: Reason::Start, start, task, site, previous: Vec::new() }
}

fn task_left(task: &api::Task<'_>) -> TaskLeft {
    match *task {
        api::Task::Goto { goal, tolerance_m } => TaskLeft::Goto { goal, tolerance_m },
        api::Task::Follow { targets, tolerance_m } => {
            TaskLeft::Follow { targets: targets.to_vec(), tolerance_m }
        }
        api::Task::Cover { anchor, regions, tether, tolerance_m } => TaskLeft::Cover {
            anchor,
            regions: regions.iter().map(|region| region.to_vec()).collect(),
            tether,
            tolerance_m,
        },
    }
}

fn site_of(site: &api::Site<'_>) -> Site {
    let obstacle = |obstacle: &api::Obstacle<'_>| SiteObstacle {
        id: obstacle.id,
        discovered: obstacle.discovered,
        velocity_m_per_s: obstacle.velocity_m_per_s,
        shape: shape_of(&obstacle.outline),
    };
    let zone = |zone: &api::Zone<'_>| SiteZone { kind: zone.kind, shape: shape_of(&zone.outline) };
    Site {
        revision: site.revision,
        boundary: match site.boundary {
            api::Boundary::Circle { radius_m } => Boundary::Circle { radius_m },
            api::Boundary::Polygon { vertices } => Boundary::Polygon { vertices: vertices.to_vec() },
        },
        obstacles: site.obstacles.iter().map(obstacle).collect(),
        zones: site.zones.iter().map(zone).collect(),
        limits: site.limits,
        swath_m: site.swath_m,
        clearance_m: site.clearance_m,
        seed: site.seed,
    }
}

fn shape_of(outline: &api::Outline<'_>) -> Shape {
    match *outline {
        api::Outline::Disc { center, radius_m } => Shape::Disc { center, radius_m },
        api::Outline::Polygon { vertices } => Shape::Polygon { vertices: vertices.to_vec() },
        api::Outline::Polyline { points, half_width_m } => {
            Shape::Polyline { points: points.to_vec(), half_width_m }
        }
    }
}
