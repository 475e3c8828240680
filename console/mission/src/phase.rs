//! What a mission is doing: whether the robot moves, why it stands, how the mission ended.

mod hold_reason;

pub use hold_reason::HoldReason;

use crate::order::StepTo;
use serde::{Deserialize, Serialize};

/// What the mission is doing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Phase {
    /// Nothing has been started.
    #[default]
    Waiting,
    /// The robot moves, or will as soon as its planner is ready.
    Running(Gait),
    /// The robot stands still.
    Held(Hold),
    /// It is over.
    Ended(Outcome),
}

impl Phase {
    /// Whether the robot moves, or may begin to move without an order.
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
    /// Until one command was sent.
    OneTick,
    /// Until something happens.
    To(StepTo),
}

/// Why the robot stands still, and whether that may end without an order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hold {
    /// Why.
    pub by: HoldReason,
    /// Whether it ends by itself.
    pub resumes: Resumes,
}

/// Whether a hold ends by itself. Whatever it says, [`Order::Hold`](crate::Order::Hold) makes it end by an order only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Resumes {
    /// Only an order lets the robot move again.
    #[default]
    Never,
    /// The robot moves again as soon as the cause is gone.
    WhenCleared,
    /// The robot moves again as soon as the fallback planner has a plan.
    ByFallback,
}

impl Resumes {
    /// Whether only an order ends the hold.
    pub fn is_never(&self) -> bool {
        *self == Self::Never
    }
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The task is done.
    Complete,
    /// No progress, or the planner sees no way on.
    Stuck,
    /// The robot touched something.
    Collision,
    /// Time is up.
    TimeLimit,
    /// Back at the anchor with cable left out, or held by the cable with nobody there to help.
    Entangled,
    /// Ended by the operator, or because nobody was there to help.
    Aborted,
}

impl Outcome {
    /// The word that scripts and people read.
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
