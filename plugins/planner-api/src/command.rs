//! The command that a planner returns for each tick.

use geometry::Drive;
use nalgebra::Vector2;

/// How the planner sees its progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Status {
    /// The robot is on its way.
    Moving,
    /// The task is done.
    Arrived,
    /// The planner sees no way to continue from here.
    Stuck,
    /// The robot stands still on purpose.
    Waiting,
}

/// A planner's answer to one step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Command {
    /// How to move until the next tick.
    pub drive: Drive,
    /// How the planner sees its progress.
    pub status: Status,
}

impl Command {
    /// Moves with this velocity in the tank frame, metres per second.
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

    /// Moves with this forward speed (metres per second) and turn rate (radians per second).
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

    /// Stands still and reports why.
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

/// Whether a planner that is about to be stopped needs a few more steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopping {
    /// Stop it immediately.
    Done,
    /// Keep calling `step`; the planner brings the robot to a standstill itself.
    NeedsSteps,
}
