//! Events of a walk that the operator should see.

use planner_api::{Ctx, LogLevel};
use std::fmt;
use steering::Side;
use world::Point;

/// An event during a walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum News {
    /// The field oscillates in a trap, and the robot retreats.
    Retreats {
        /// The robot's position.
        at: Point,
    },
    /// The mouth of a trap was sealed.
    Sealed {
        /// Number of virtual circles.
        circles: usize,
    },
    /// The robot starts a detour.
    Escapes {
        /// The robot's position.
        at: Point,
        /// The side of the detour.
        side: Side,
    },
    /// The wall holds the robot, which now follows the outlines.
    Follows {
        /// The robot's position.
        at: Point,
    },
    /// The path to the goal is clear of the bypassed obstacle.
    Resumes {
        /// The robot's position.
        at: Point,
    },
    /// The planner gives up after the maximum number of escapes.
    GivesUp {
        /// The robot's position.
        at: Point,
        /// Number of escapes.
        escapes: u32,
    },
}

impl News {
    /// Writes the event to the log.
    pub fn report(&self, ctx: &Ctx<'_>) {
        let level = if matches!(self, Self::GivesUp { .. }) { LogLevel::Warn } else { LogLevel::Info };
        ctx.log(level, &self.to_string());
    }
}

impl fmt::Display for News {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = |side: &Side| if *side == Side::Left { "left" } else { "right" };
        match self {
            Self::Retreats { at } => write!(f, "trapped at ({:.2}, {:.2}): retreating", at.x, at.y),
            Self::Sealed { circles } => write!(f, "sealing the trap with {circles} virtual circles"),
            Self::Escapes { at, side } => {
                write!(f, "going around on the {} from ({:.2}, {:.2})", word(side), at.x, at.y)
            }
            Self::Follows { at } => {
                write!(f, "trapped by the wall at ({:.2}, {:.2}): following the outlines", at.x, at.y)
            }
            Self::Resumes { at } => write!(f, "clear of the obstacle at ({:.2}, {:.2})", at.x, at.y),
            Self::GivesUp { at, escapes } => {
                write!(f, "giving up at ({:.2}, {:.2}); number of escapes: {escapes}", at.x, at.y)
            }
        }
    }
}
