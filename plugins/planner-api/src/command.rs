//! What a planner commands the robot to do.

use geometry::Drive;
use nalgebra::Vector2;

/// How the planner sees its own task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Status {
    /// On the way.
    Moving,
    /// The task is done.
    Arrived,
    /// No way on from here, as far as this planner sees.
    Stuck,
    /// Standing still on purpose.
    Waiting,
}

/// The answer to one step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Command {
    /// How to move until the next step.
    pub drive: Drive,
    /// How the planner sees its task.
    pub status: Status,
}

impl Command {
    /// Move with this velocity in the tank frame.
    pub fn velocity(velocity: Vector2<f64>) -> Self {
        Self { drive: Drive::Velocity(velocity), status: Status::Moving }
    }

    /// Move with this speed and turn rate.
    pub fn twist(v_m_per_s: f64, w_rad_per_s: f64) -> Self {
        Self { drive: Drive::Twist { v_m_per_s, w_rad_per_s }, status: Status::Moving }
    }

    /// Stand still and say why.
    pub fn still(status: Status) -> Self {
        Self { drive: Drive::STILL, status }
    }
}

/// Whether a planner that was asked to stop needs a few more steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopping {
    /// Stop at once.
    Done,
    /// Keep calling `step`; the planner brings the robot to a stop itself.
    NeedsSteps,
}
