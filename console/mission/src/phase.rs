//! The phase of a mission: whether the robot moves, why it stands still, or how the mission ended.

mod hold_reason;

pub use hold_reason::HoldReason;

use serde::{Deserialize, Serialize};

/// The phase of a mission.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Phase {
    /// The mission has not been started.
    #[default]
    Waiting,
    /// The robot moves, or will move as soon as its planner is ready.
    Running(Gait),
    /// The robot is held.
    Held(Hold),
    /// The mission has ended.
    Ended(Outcome),
}

impl Phase {
    /// Whether the robot is driving back by order.
    pub fn is_return(&self) -> bool {
        *self == Self::Running(Gait::Back)
    }

    /// Whether the robot moves or may begin to move without an order.
    pub fn may_move(&self) -> bool {
        match self {
            Self::Running(_) => true,
            Self::Held(hold) => !hold.resumes.is_never(),
            Self::Waiting | Self::Ended(_) => false,
        }
    }
}

/// For how long a running robot moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Gait {
    /// Until something stops it.
    Steady,
    /// For one command.
    OneTick,
    /// Until the awaited event happens.
    To(StepTo),
    /// Back to the anchor or the start; the mission itself drives, and every hold ends only by order.
    Back,
}

/// Why the robot is held, and whether the hold can end without an order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hold {
    /// The reason.
    pub by: HoldReason,
    /// Whether the hold ends automatically.
    pub resumes: Resumes,
}

/// Whether a hold ends automatically. [`Order::Hold`](crate::Order::Hold) changes every hold to one that ends only by
/// order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Resumes {
    /// Only an order lets the robot move again.
    #[default]
    Never,
    /// The robot moves again automatically as soon as the cause is gone.
    WhenCleared,
    /// The robot moves again automatically as soon as the fallback planner has a plan.
    ByFallback,
}

impl Resumes {
    /// Whether only an order ends the hold.
    pub fn is_never(&self) -> bool {
        *self == Self::Never
    }
}

/// The outcome of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The task is done.
    Complete,
    /// No progress, or the planner finds no path.
    Stuck,
    /// The robot touched something.
    Collision,
    /// The time limit was reached.
    TimeLimit,
    /// Back at the anchor with cable still out, or held by the cable in an unattended mission.
    Entangled,
    /// Ended by the operator, or by a hold in an unattended mission.
    Aborted,
}

impl Outcome {
    /// The word used in files and on the screen.
    pub fn word(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Stuck => "stuck",
            Self::Collision => "collision",
            Self::TimeLimit => "time_limit",
            Self::Entangled => "entangled",
            Self::Aborted => "aborted",
        }
    }
}

/// The point at which a step of a held robot ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StepTo {
    /// The end of the current lane or connector; without lanes, one metre ahead.
    LaneEnd,
    /// The next event of severity WATCH or above.
    Event,
}
