//! A drive over a known floor, across the plugin boundary, with the figures that the planner reports in every tick.

use crate::study::{Method, Planners, Result, StudyError};
use geometry::{PathFollower, unit_vector};
use mission::Cause;
use nalgebra::Matrix3;
use planner_api::{Drive, PlanRequest, PoseEstimate, Reason, Sensed, Site, Status, Task};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use world::{Point, Pose};

/// Length of the part of its plan, ahead of the robot, that the planner receives, metres.
const SHOWN_M: f64 = 4.0;
/// Time, seconds, for which the planner must report being stuck before the drive ends.
const STUCK_S: f64 = 60.0;

/// A trip.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trip {
    /// The start of the robot.
    pub start: Pose,
    /// The goal, metres.
    pub goal: Point,
    /// Distance at which the goal counts as reached, metres.
    pub tolerance_m: f64,
    /// Time limit of the drive, seconds.
    pub most_s: f64,
}

/// A drive, and the figures that the planner reported.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Flown {
    /// Places of the robot, one per tick.
    pub path: Vec<Point>,
    /// Whether the goal was reached.
    pub arrived: bool,
    /// Figures by name: time in seconds and value.
    pub figures: BTreeMap<String, Vec<(f64, f64)>>,
}

/// Drives a trip: positions are exact, and the robot carries out every command exactly.
///
/// # Errors
/// The planner is missing, refuses its parameters or fails.
pub(super) fn fly(planners: &Planners, method: &Method, site: &Site<'_>, trip: &Trip) -> Result<Flown> {
    let failed = |fault| StudyError::planner(&method.planner, fault);
    let mut host = planners.prepare(method, site).map_err(failed)?;
    let Trip { start, goal, tolerance_m, most_s } = *trip;
    let exact = |pose: Pose| PoseEstimate {
        position: pose.position,
        heading_rad: pose.heading_rad,
        covariance: Matrix3::zeros(),
    };
    let request = PlanRequest::new(&Reason::Start, exact(start), Task::Goto { goal, tolerance_m }, site);
    let mut plan = match host.plan(&request) {
        Ok(reply) => (reply.value.path.len() > 1).then(|| PathFollower::new(reply.value.path)),
        // A planner without a plan may still give useful commands.
        Err(fault) if matches!(fault.cause, Cause::Planner(_)) => None,
        Err(fault) => return Err(failed(fault)),
    };
    let dt_s = site.limits.tick_s;
    let (mut pose, mut twist, mut stuck_s) = (start, (0.0, 0.0), 0.0);
    let mut flown = Flown { path: vec![start.position], arrived: false, figures: BTreeMap::new() };
    for tick in 0..(most_s / dt_s) as u64 {
        flown.arrived = (goal - pose.position).norm() <= tolerance_m;
        if flown.arrived || stuck_s > STUCK_S {
            break;
        }
        if let Some(plan) = &mut plan {
            plan.advance(pose.position, |_| true);
        }
        let t_s = tick as f64 * dt_s;
        let sensed = Sensed {
            v_m_per_s: twist.0,
            w_rad_per_s: twist.1,
            targets_ahead: std::slice::from_ref(&goal),
            path_ahead: plan.as_ref().map_or(&[], |plan| plan.ahead(SHOWN_M)),
            obstacles: site.obstacles,
            ..Sensed::new(tick, dt_s, exact(pose), goal)
        };
        let reply = host.step(&sensed).map_err(failed)?;
        for (name, value, _) in reply.scalars {
            flown.figures.entry(name).or_default().push((t_s, value));
        }
        stuck_s = if reply.value.status == Status::Moving { 0.0 } else { stuck_s + dt_s };
        match reply.value.drive {
            Drive::Velocity(velocity) => pose.position += velocity * dt_s,
            Drive::Twist { v_m_per_s, w_rad_per_s } => {
                twist = (v_m_per_s, w_rad_per_s);
                pose.heading_rad += w_rad_per_s * dt_s;
                pose.position += unit_vector(pose.heading_rad) * (v_m_per_s * dt_s);
            }
        }
        flown.path.push(pose.position);
    }
    Ok(flown)
}
