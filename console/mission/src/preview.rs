//! A plan without a flight: what a planner would do on the drawing.

use crate::{
    chart::Chart,
    config::MissionConfig,
    planner::{Fault, PlannerInfo, PlannerLink, Reply},
    task::Task,
};
use nalgebra::Matrix3;
use planner_api::{Plan, PlanRequest, PoseEstimate, Reason};
use world::{CoverageGrid, Floor, World};

/// Seats the mission's planner and asks it for a plan of the whole task, from the start, on the drawing.
///
/// # Errors
/// The planner could not be loaded, or found no plan.
pub fn preview(
    config: &MissionConfig,
    drawing: &World,
    seed: u64,
    planner: &mut dyn PlannerLink,
) -> Result<(PlannerInfo, Reply<Plan>), Fault> {
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
    chart.with_site(|site| {
        let info = planner.choose(&config.planner.id, &config.planner.parameters, site)?;
        let regions = task.regions_left(&CoverageGrid::new(floor), config.lane_m());
        let regions: Vec<&[world::Point]> = regions.iter().map(Vec::as_slice).collect();
        let task = task.as_request(&regions, config.tether_limits());
        let request = PlanRequest { reason: &Reason::Start, start, task, site, previous: &[] };
        Ok((info, planner.plan(&request)?))
    })
}
