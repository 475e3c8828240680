//! What the operator wants to know of a walk.

use planner_api::{Ctx, LogLevel};
use std::fmt;
use steering::Side;
use world::Point;

/// Something that happened on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum News {
    /// The field oscillates in a trap: it goes back.
    Retreats {
        /// Where.
        at: Point,
    },
    /// The mouth was closed.
    Sealed {
        /// With so many virtual circles.
        circles: usize,
    },
    /// It goes round.
    Escapes {
        /// Where from.
        at: Point,
        /// On this side.
        side: Side,
    },
    /// The tank's outline holds it: it follows whatever stands in the way.
    Follows {
        /// Where from.
        at: Point,
    },
    /// The way to the goal is clear of what was gone round.
    Resumes {
        /// Where.
        at: Point,
    },
    /// It has tried often enough.
    GivesUp {
        /// Where.
        at: Point,
        /// After so many escapes.
        escapes: u32,
    },
}

impl News {
    /// Puts it into the log.
    pub fn report(&self, ctx: &Ctx<'_>) {
        let level = if matches!(self, Self::GivesUp { .. }) { LogLevel::Warn } else { LogLevel::Info };
        ctx.log(level, &self.to_string());
    }
}

impl fmt::Display for News {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = |side: &Side| if *side == Side::Left { "left" } else { "right" };
        match self {
            Self::Retreats { at } => write!(f, "trapped at ({:.2}, {:.2}): retreats", at.x, at.y),
            Self::Sealed { circles } => write!(f, "seals the trap with {circles} virtual circles"),
            Self::Escapes { at, side } => {
                write!(f, "goes round on the {} from ({:.2}, {:.2})", word(side), at.x, at.y)
            }
            Self::Follows { at } => {
                write!(f, "trapped by the wall at ({:.2}, {:.2}): follows the outlines", at.x, at.y)
            }
            Self::Resumes { at } => write!(f, "clear of the obstacle at ({:.2}, {:.2})", at.x, at.y),
            Self::GivesUp { at, escapes } => {
                write!(f, "gives up at ({:.2}, {:.2}) after {escapes} escapes", at.x, at.y)
            }
        }
    }
}
