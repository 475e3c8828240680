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
    ///
    /// ```
    /// use planner_api::{Command, Drive, Status, Vector2};
    ///
    /// let command = Command::velocity(Vector2::new(0.3, 0.4));
    /// assert!(matches!(command.drive, Drive::Velocity(v) if v.norm() == 0.5));
    /// assert_eq!(command.status, Status::Moving);
    /// ```
    pub fn velocity(velocity: Vector2<f64>) -> Self {
        Self { drive: Drive::Velocity(velocity), status: Status::Moving }
    }

    /// Move with this speed and turn rate.
    ///
    /// ```
    /// use planner_api::{Command, Drive, Status};
    ///
    /// let backward = Command::twist(-0.1, 0.0);
    /// assert_eq!(backward.status, Status::Moving);
    /// assert_eq!(Command::twist(0.0, 0.0).drive, Drive::STILL);
    /// ```
    pub fn twist(v_m_per_s: f64, w_rad_per_s: f64) -> Self {
        Self { drive: Drive::Twist { v_m_per_s, w_rad_per_s }, status: Status::Moving }
    }

    /// Stand still and say why.
    ///
    /// ```
    /// use planner_api::{Command, Drive, Status};
    ///
    /// let arrived = Command::still(Status::Arrived);
    /// assert_eq!((arrived.drive, arrived.status), (Drive::STILL, Status::Arrived));
    /// ```
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
