//! Everything a potential-field planner can be set to.

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
    /// As in the paper: moves of the law toward targets in lock step.
    Walked,
    /// By flying the known map in thought, with the exact position: what the robot will do.
    Flown,
    /// Walked for a robot without extent, as the paper's, and flown for one with a hull.
    ByHull,
}

/// Which preset point comes after a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Targets {
    /// The next of the list, whatever the move has done.
    LockStep,
    /// The one behind the nearest ahead, and the next of the list at least.
    Ahead,
}

/// How long a move is, up to the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoveLength {
    /// As far as the target.
    ToTarget,
    /// As far as the resultant would pull a spring of the attraction's gain, `F / k_att`.
    ByForce,
}

/// How a law is walked over the known map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walking {
    /// Longest move toward a preset point, metres; the paper's `s`.
    pub step_m: f64,
    /// Which preset point comes after a move.
    pub targets: Targets,
    /// How long a move toward a preset point is.
    pub length: MoveLength,
    /// Length of a move toward a goal, metres.
    pub goto_step_m: f64,
    /// Whether moves may be twice as long while the robot lags behind its preset point.
    pub flexible: bool,
    /// Largest change of heading from one move to the next, radians, if it is limited.
    pub turn_limit_rad: Option<f64>,
    /// A path that falls further behind its preset point than this skips floor, metres.
    pub max_lag_m: f64,
}

/// How the rotating force is used in flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RotationUse {
    /// As in the plan: by the reading and the sense that are set.
    Paper,
    /// About whatever blocks the way, on the side of the smaller detour, with narrow gaps closed; ours.
    Gaps,
}

/// Everything a potential-field planner can be set to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldSettings {
    /// Gains and ranges.
    pub law: Law,
    /// When the rotating force acts.
    pub reading: Reading,
    /// Which way round it acts.
    pub rule: SenseRule,
    /// What counts as a trap.
    pub gate: Gate,
    /// What is done about a trap besides.
    pub escape: Escape,
    /// How a plan is made.
    pub planning: Planning,
    /// How the law is walked to plan.
    pub walking: Walking,
    /// How the rotating force is used in flight.
    pub rotation_use: RotationUse,
    /// How the robot is flown.
    pub flight: Flight,
    /// Whether what moves is evaded in flight and left out of plans; else it stands where it is seen.
    pub evades: bool,
}
