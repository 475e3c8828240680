//! All settings of a potential-field planner.

use crate::{
    escape::Escape,
    law::Law,
    trap::Gate,
    turning::{Reading, SenseRule},
};
use steering::Flight;

/// How a plan is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Planning {
    /// As in the paper: moves according to the law, towards targets in lock step.
    Walked,
    /// By simulating the flight over the known map with an exactly known position, which predicts what the robot will
    /// do.
    Flown,
    /// Walked for a robot without extent, as in the paper; flown for a robot with a hull.
    ByHull,
}

/// The rule that chooses the next preset point after a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Targets {
    /// The next point in the list, whatever the result of the move.
    LockStep,
    /// The point after the nearest one ahead, but at least the next in the list.
    Ahead,
}

/// The length of a move, up to the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoveLength {
    /// As far as the target.
    ToTarget,
    /// As far as the resultant would stretch a spring with the attraction gain, `F / k_att`.
    ByForce,
}

/// How a law is walked over the known map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walking {
    /// Longest move towards a preset point, metres; the paper's `s`.
    pub step_m: f64,
    /// The rule that chooses the next preset point after a move.
    pub targets: Targets,
    /// The length of a move towards a preset point.
    pub length: MoveLength,
    /// Length of a move towards a goal, metres.
    pub goto_step_m: f64,
    /// Whether moves may be twice as long while the robot lags behind its preset point.
    pub flexible: bool,
    /// Largest change of heading from one move to the next, radians, if it is limited.
    pub turn_limit_rad: Option<f64>,
    /// Lag behind its preset point above which a path skips floor, metres.
    pub max_lag_m: f64,
}

/// How the rotating force is used in flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RotationUse {
    /// As in the plan, with the configured interpretation and direction.
    Paper,
    /// Around whatever blocks the path, on the side of the smaller detour, with narrow gaps closed; our addition.
    Gaps,
}

/// All settings of a potential-field planner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldSettings {
    /// Gains and ranges.
    pub law: Law,
    /// When the rotating force acts.
    pub reading: Reading,
    /// Direction of the rotating force.
    pub rule: SenseRule,
    /// When the robot is considered trapped.
    pub gate: Gate,
    /// The additional response to a trap.
    pub escape: Escape,
    /// How a plan is made.
    pub planning: Planning,
    /// How the law is walked to make a plan.
    pub walking: Walking,
    /// How the rotating force is used in flight.
    pub rotation_use: RotationUse,
    /// How the robot is flown.
    pub flight: Flight,
    /// Whether moving obstacles are evaded in flight and left out of plans; otherwise they are treated as stationary
    /// where they are seen.
    pub evades: bool,
}
