//! The tether in events.

use serde::{Deserialize, Serialize};
use std::fmt;
use world::{Point, beside_limit};

/// A contact of the cable with an obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TetherContact {
    /// Name of the obstacle.
    pub on: String,
    /// Angle by which the cable bends round the obstacle, radians, counter-clockwise.
    pub wrap_rad: f64,
    /// Last point of contact, in the direction from the anchor to the robot.
    pub at: Point,
}

/// The line of the taut cable, from its anchor along its bends to the robot.
pub fn taut_line(anchor: Point, bends: &[Point], robot: Point) -> Vec<Point> {
    let mut line = Vec::with_capacity(bends.len() + 2);
    line.push(anchor);
    line.extend_from_slice(bends);
    line.push(robot);
    line
}

/// Cable that may be slack, metres. It is less than the hull of a robot is long, so that the robot can stop before it
/// drives over its own cable, and more than the position estimate moves by itself in that time.
pub const SLACK_M: f64 = 0.2;

/// The measured pull on the cable, and the slack that follows from it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MeasuredPull {
    /// Pull at the robot or, without a sensor there, at the reel, newtons.
    pub pull_n: f64,
    /// Cable that has become slack since it last pulled, metres; 0 while it pulls.
    pub slack_m: f64,
}

/// The alarms of the cable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TetherAlarm {
    /// The reel is running out.
    Reel {
        /// Length of cable paid out, metres.
        out_m: f64,
        /// Total length of the cable, metres.
        reel_length_m: f64,
    },
    /// The cable wraps one obstacle.
    Wrap {
        /// Name of the obstacle.
        on: String,
        /// Wrap angle, radians, without sign.
        wrap_rad: f64,
        /// Maximum angle allowed, radians.
        limit_rad: f64,
    },
    /// The total wrap is too large.
    WrapTotal {
        /// The total wrap, radians.
        sum_rad: f64,
        /// Maximum total wrap, radians.
        limit_rad: f64,
    },
    /// The reel has paid out more than expected from all the obstacles on the map.
    Snag {
        /// Cable paid out, metres.
        paid_out_m: f64,
        /// Expected cable length, metres.
        explained_m: f64,
        /// Whether the cable may also be slack, because a vehicle has no sensor of the pull.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        or_slack: bool,
    },
    /// The cable is torn: the reel has taken up cable that must be out, and nothing pulls at one of its ends.
    Broken {
        /// Length off the reel, metres.
        paid_out_m: f64,
        /// Length that must be out if the cable leads to the robot, metres.
        needed_m: f64,
        /// Whether only the encoder shows this, because a vehicle has no sensor of the pull; the length that must be out is
        /// then that of the straight line to the anchor.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        by_encoder_alone: bool,
    },
    /// The hull does not fit through the return path along the cable.
    NoReturnPath,
    /// The robot has left its plan by crossing a cut, so a new plan is needed.
    Strayed,
    /// The cable does not pull, and the reel has not taken up what the robot has driven back.
    Slack {
        /// Cable that has become slack, metres.
        slack_m: f64,
        /// Pull of the cable at the robot or, if that is not measured, at the reel, newtons.
        pull_n: f64,
    },
}

impl TetherAlarm {
    /// Share of a limit at which the operator is warned.
    pub const NEAR: f64 = 0.8;

    /// The kind of alarm in one or two words.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Reel { .. } => "reel",
            Self::Wrap { .. } => "wrap",
            Self::WrapTotal { .. } => "total wrap",
            Self::Snag { .. } => "snag",
            Self::NoReturnPath => "return path",
            Self::Strayed => "stray",
            Self::Slack { .. } => "slack",
            Self::Broken { .. } => "broken",
        }
    }
}

impl fmt::Display for TetherAlarm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reel { out_m, reel_length_m } => {
                let [out, reel] = beside_limit(*out_m, *reel_length_m, 1);
                write!(f, "{out} m of tether out, reel holds {reel} m")
            }
            Self::Wrap { on, wrap_rad, limit_rad } => {
                let [wrap, limit] = beside_limit(wrap_rad.to_degrees(), limit_rad.to_degrees(), 0);
                write!(f, "tether wraps {wrap}° around {on}, limit {limit}°")
            }
            Self::WrapTotal { sum_rad, limit_rad } => {
                let [sum, limit] = beside_limit(sum_rad.to_degrees(), limit_rad.to_degrees(), 0);
                write!(f, "total tether wrap {sum}°, limit {limit}°")
            }
            Self::Snag { paid_out_m, explained_m, or_slack } => {
                let what = if *or_slack {
                    "tether snagged or slack"
                } else {
                    "tether snagged on an unmapped object"
                };
                write!(f, "{what}: {paid_out_m:.1} m paid out, {explained_m:.1} m expected")
            }
            Self::Slack { slack_m, pull_n } => write!(
                f,
                "reel does not take the tether up: {slack_m:.1} m slack behind the robot, pull {pull_n:.1} N"
            ),
            Self::Broken { paid_out_m, needed_m, by_encoder_alone: true } => write!(
                f,
                "tether broken, or the encoder of the reel is wrong: {paid_out_m:.1} m are off the reel, but the anchor is \
                 {needed_m:.1} m away"
            ),
            Self::Broken { paid_out_m, needed_m, .. } => write!(
                f,
                "tether broken: {paid_out_m:.1} m are off the reel, but the robot is {needed_m:.1} m of tether away, and \
                 nothing pulls"
            ),
            Self::Strayed => f.write_str("robot crossed a cut of its plan; replanning"),
            Self::NoReturnPath => f.write_str("no return path: hull does not fit"),
        }
    }
}
