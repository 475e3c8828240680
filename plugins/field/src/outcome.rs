//! Whether a walk achieves its task, and if not, why.

use geometry::{Point, polyline};
use planner_api::{Ctx, LogLevel, Plan};
use std::fmt;

/// Slack for rounding in comparisons of lengths, metres.
const ROUNDING_M: f64 = 1e-6;

/// A walk as it came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Walk {
    /// Its points, the start first.
    pub path: Vec<Point>,
    /// Why it does not achieve the task, if so.
    pub shortfall: Option<Shortfall>,
}

impl Walk {
    /// The plan, with the least distance between hull and anything solid along it and that demanded, metres; what is
    /// wrong with it is logged, the first thing if there are several.
    pub fn into_plan(self, clearance_m: f64, demanded_m: f64, ctx: &Ctx<'_>) -> Plan {
        self.into_plan_or(clearance_m, demanded_m, "", ctx)
    }

    /// The same; where the walk falls short, the log says what to do `instead` in the same line, after a semicolon.
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

/// Why a path does not achieve its task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shortfall {
    /// The law was trapped.
    Trapped {
        /// Where.
        at: Point,
    },
    /// The path ends before its end.
    Short {
        /// Distance that is missing, metres.
        missing_m: f64,
        /// Where it ends.
        at: Point,
    },
    /// It fell so far behind its preset point that it skips floor.
    Lagged {
        /// Furthest distance to the preset point that was due, metres.
        most_m: f64,
        /// The distance allowed, metres.
        allowed_m: f64,
        /// Where.
        at: Point,
    },
    /// It passes something solid too closely.
    Close {
        /// The least distance between hull and anything solid, metres.
        clearance_m: f64,
        /// The distance demanded, metres.
        demanded_m: f64,
    },
}

impl fmt::Display for Shortfall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Trapped { at } => {
                write!(f, "the force field is trapped at ({:.2}, {:.2})", at.x, at.y)
            }
            Self::Short { missing_m, at } => {
                write!(f, "the path ends at ({:.2}, {:.2}), {missing_m:.2} m short of its end", at.x, at.y)
            }
            Self::Lagged { most_m, allowed_m, at } => write!(
                f,
                "at ({:.2}, {:.2}) the path lags {most_m:.2} m behind its preset point and skips floor \
                 ({allowed_m:.2} m allowed)",
                at.x, at.y
            ),
            Self::Close { clearance_m, .. } if *clearance_m < 0.0 => {
                write!(f, "the hull would run {:.2} m into an obstacle or the wall", -clearance_m)
            }
            Self::Close { clearance_m, demanded_m } => write!(
                f,
                "the hull would pass an obstacle or the wall at {clearance_m:.2} m ({demanded_m:.2} m demanded)"
            ),
        }
    }
}
