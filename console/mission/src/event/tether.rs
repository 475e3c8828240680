//! What events say of the tether.

use serde::{Deserialize, Serialize};
use std::fmt;
use world::Point;

/// Where the cable bears on an obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TetherContact {
    /// Name of the obstacle.
    pub on: String,
    /// Angle by which the cable turns there, radians, counter-clockwise.
    pub wrap_rad: f64,
    /// Last point of contact, seen from the anchor.
    pub at: Point,
}

/// The taut cable from its anchor over its bends to the robot.
pub fn taut_line(anchor: Point, bends: &[Point], robot: Point) -> Vec<Point> {
    let mut line = Vec::with_capacity(bends.len() + 2);
    line.push(anchor);
    line.extend_from_slice(bends);
    line.push(robot);
    line
}

/// What may be wrong with the cable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TetherAlarm {
    /// The reel runs out.
    Reel {
        /// Cable out, metres.
        out_m: f64,
        /// Cable there is, metres.
        reel_length_m: f64,
    },
    /// The cable wraps one obstacle.
    Wrap {
        /// Its name.
        on: String,
        /// Angle, radians, without sign.
        wrap_rad: f64,
        /// Largest angle allowed, radians.
        limit_rad: f64,
    },
    /// All wraps together.
    WrapTotal {
        /// Their sum, radians.
        sum_rad: f64,
        /// Largest sum allowed, radians.
        limit_rad: f64,
    },
    /// The reel has paid out more than the cable needs among all obstacles on the map.
    Snag {
        /// Cable paid out, metres.
        paid_out_m: f64,
        /// Cable that the map explains, metres.
        explained_m: f64,
    },
    /// The hull does not fit along the cable.
    NoReturnPath,
    /// The robot has left its plan across a line that the plan never crosses: another plan is due.
    Strayed,
}

impl TetherAlarm {
    /// The kind in a word.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Reel { .. } => "reel",
            Self::Wrap { .. } => "wrap",
            Self::WrapTotal { .. } => "total wrap",
            Self::Snag { .. } => "snag",
            Self::NoReturnPath => "return path",
            Self::Strayed => "stray",
        }
    }
}

impl fmt::Display for TetherAlarm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reel { out_m, reel_length_m } => {
                write!(f, "{out_m:.1} m of tether out, reel holds {reel_length_m:.1} m")
            }
            Self::Wrap { on, wrap_rad, limit_rad } => {
                let (wrap, limit) = (wrap_rad.to_degrees(), limit_rad.to_degrees());
                write!(f, "tether wraps {wrap:.0}° around {on}, limit {limit:.0}°")
            }
            Self::WrapTotal { sum_rad, limit_rad } => {
                let (sum, limit) = (sum_rad.to_degrees(), limit_rad.to_degrees());
                write!(f, "total tether wrap {sum:.0}°, limit {limit:.0}°")
            }
            Self::Snag { paid_out_m, explained_m } => write!(
                f,
                "tether snagged on an unmapped object: {paid_out_m:.1} m paid out, {explained_m:.1} m expected"
            ),
            Self::Strayed => f.write_str("robot crossed a cut of its plan; replanning"),
            Self::NoReturnPath => f.write_str("no return path: hull does not fit"),
        }
    }
}
