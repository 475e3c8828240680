//! The way back of a held robot, and its cost, as known before the order.

use serde::{Deserialize, Serialize};
use std::fmt;
use world::Point;

/// The place to which a robot drives back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Home {
    /// The anchor of the tether.
    Anchor,
    /// The place where the mission began, for a robot without a tether.
    Start,
}

impl Home {
    /// The word used in sentences.
    pub fn word(self) -> &'static str {
        match self {
            Self::Anchor => "anchor",
            Self::Start => "start",
        }
    }

    /// The place in sentences, with its preposition.
    pub(crate) fn at(self) -> &'static str {
        match self {
            Self::Anchor => "at the anchor",
            Self::Start => "at the start",
        }
    }
}

/// A way back: along the return path of the taut cable, beside a cable that lies on the floor or, without a tether, along
/// the shortest path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WayBack {
    /// Where the way ends.
    pub to: Home,
    /// The path, from the robot on, tank frame.
    pub path: Vec<Point>,
    /// Length of the path, metres.
    pub length_m: f64,
    /// Smallest distance along the path from the hull to anything solid on the chart, metres.
    pub clearance_m: f64,
    /// Tether beyond the taut line that lies on the floor, metres, if the way leads beside it because the reel does not take
    /// it up; otherwise `None`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slack_m: Option<f64>,
}

/// Highest speed beside a tether that lies on the floor, metres per second: its place is known less well than that of a taut
/// one.
const BESIDE_M_PER_S: f64 = 0.1;

impl WayBack {
    /// Returns the highest speed on the way, metres per second, of a robot with a given highest speed.
    ///
    /// ```
    /// # use mission::{Home, WayBack};
    /// let way = WayBack { to: Home::Anchor, path: vec![], length_m: 9.0, clearance_m: 0.1, slack_m: None };
    /// assert_eq!(way.fastest_m_per_s(0.4), 0.4);
    /// assert_eq!(WayBack { slack_m: Some(1.0), ..way }.fastest_m_per_s(0.4), 0.1);
    /// ```
    pub fn fastest_m_per_s(&self, v_max_m_per_s: f64) -> f64 {
        if self.slack_m.is_some() { v_max_m_per_s.min(BESIDE_M_PER_S) } else { v_max_m_per_s }
    }
}

impl fmt::Display for WayBack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { to, length_m, clearance_m, .. } = self;
        write!(f, "driving back to the {}: {length_m:.1} m, clearance {clearance_m:.2} m", to.word())?;
        match self.slack_m {
            Some(slack_m) => write!(f, ", slowly beside the tether on the floor ({slack_m:.1} m slack)"),
            None => Ok(()),
        }
    }
}
