//! Whether a walk achieves its task, and if not, why.

use geometry::{Point, polyline};
use planner_api::{Ctx, LogLevel, Plan};
use std::fmt;

/// Tolerance for rounding in comparisons of lengths, metres.
const ROUNDING_M: f64 = 1e-6;

/// The result of a walk.
#[derive(Debug, Clone, PartialEq)]
pub struct Walk {
    /// The points of the walk, starting with the start.
    pub path: Vec<Point>,
    /// The reason why the walk does not achieve its task; `None` if it does.
    pub shortfall: Option<Shortfall>,
}

impl Walk {
    /// Converts the walk to a plan. `clearance_m` is the smallest distance between the hull and any solid along the
    /// walk, and `demanded_m` the required distance, both in metres. If the plan is not complete, the first reason is
    /// logged.
    pub fn into_plan(self, clearance_m: f64, demanded_m: f64, ctx: &Ctx<'_>) -> Plan {
        self.into_plan_or(clearance_m, demanded_m, "", ctx)
    }

    /// Like [`Self::into_plan`], but a logged reason is followed by a semicolon and the advice `instead`.
    pub fn into_plan_or(self, clearance_m: f64, demanded_m: f64, instead: &str, ctx: &Ctx<'_>) -> Plan {
        let is_close = clearance_m < demanded_m - ROUNDING_M;
        let close = is_close.then_some(Shortfall::Close { clearance_m, demanded_m });
        let shortfall = self.shortfall.or(close);
        if let Some(reason) = shortfall {
            let separator = if instead.is_empty() { "" } else { "; " };
            ctx.log(LogLevel::Warn, &format!("the plan is not complete: {reason}{separator}{instead}"));
        }
        Plan {
            cost: polyline::length_m(&self.path),
            path: self.path,
            complete: shortfall.is_none(),
            ..Plan::default()
        }
    }
}

/// The reason why a path does not achieve its task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shortfall {
    /// The law was trapped.
    Trapped {
        /// The position of the trap.
        at: Point,
    },
    /// The path ends before its target.
    Short {
        /// Remaining distance to the target, metres.
        missing_m: f64,
        /// The end of the path.
        at: Point,
    },
    /// The path fell so far behind its preset point that it skips floor.
    Lagged {
        /// Largest distance from the preset point that was due, metres.
        most_m: f64,
        /// The distance allowed, metres.
        allowed_m: f64,
        /// The position of the largest lag.
        at: Point,
    },
    /// The path passes a solid too closely.
    Close {
        /// The smallest distance between the hull and any solid, metres.
        clearance_m: f64,
        /// The required distance, metres.
        demanded_m: f64,
    },
}

impl fmt::Display for Shortfall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Trapped { at } => {
                write!(f, "the path is trapped at ({:.2}, {:.2})", at.x, at.y)
            }
            Self::Short { missing_m, at } => {
                write!(f, "the path ends at ({:.2}, {:.2}), {missing_m:.2} m short of its target", at.x, at.y)
            }
            Self::Lagged { most_m, allowed_m, at } => write!(
                f,
                "at ({:.2}, {:.2}) the path lags {most_m:.2} m behind its preset point ({allowed_m:.2} m \
                 allowed) and skips floor",
                at.x, at.y
            ),
            Self::Close { clearance_m, .. } if *clearance_m < 0.0 => {
                write!(f, "the hull would run {:.2} m into an obstacle or the wall", -clearance_m)
            }
            Self::Close { clearance_m, demanded_m } => write!(
                f,
                "the hull would pass within {clearance_m:.2} m of an obstacle or the wall; {demanded_m:.2} \
                 m is required"
            ),
        }
    }
}
