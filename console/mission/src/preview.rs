//! A plan without a run: the inputs that a planner would receive at the start, using only the drawing.

use crate::{ask::PlanAsk, chart::Chart, config::MissionConfig, task::Task};
use nalgebra::Matrix3;
use planner_api::{PoseEstimate, Reason};
use std::sync::Arc;
use world::{CoverageGrid, World};

/// The inputs of a plan for the whole task from the start, using only the drawing; they include the tank in the form that
/// the planner receives.
pub fn preview(config: &MissionConfig, drawing: &World, seed: u64) -> PlanAsk {
    let chart = Chart::new(drawing.clone(), config, seed);
    let task = Task::new(&config.task, config.start.position);
    let floor = config.floor(drawing);
    let (position_m2, heading_rad2) = (config.start_sigma_m.powi(2), config.start_heading_sigma_rad.powi(2));
    let start = PoseEstimate {
        position: config.start.position,
        heading_rad: config.start.heading_rad,
        covariance: Matrix3::from_diagonal(&nalgebra::Vector3::new(position_m2, position_m2, heading_rad2)),
    };
    let task = task.left(&CoverageGrid::new(floor), config.lane_m(), config.tether_limits());
    PlanAsk {
        reason: Reason::Start,
        start,
        task,
        site: Arc::new(chart.site()),
        previous: Vec::new(),
        under_way: None,
    }
}
