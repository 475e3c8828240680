//! Surveys as events: the ways that the robot takes, what it has explored so far, and the map at the end.

use exploration::Column;
use serde::{Deserialize, Serialize};
use world::Point;

/// The purpose of a way that a survey takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurveyGoal {
    /// To a frontier: free floor beside floor that no scan has shown.
    Frontier,
    /// To a place from which the hidden side of an object can be seen.
    View,
    /// Back to the anchor or the start; nothing is left to explore.
    Home,
}

impl SurveyGoal {
    /// The goal in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Frontier => "frontier",
            Self::View => "object",
            Self::Home => "end",
        }
    }

    /// The goal in a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::Frontier => "the nearest frontier",
            Self::View => "the hidden side of an object",
            Self::Home => "the end of the survey",
        }
    }
}

/// A survey takes a way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurveyWay {
    /// The purpose.
    pub to: SurveyGoal,
    /// The path, from the robot on, tank frame.
    pub path: Vec<Point>,
    /// Length of the path, metres.
    pub length_m: f64,
    /// Number of places left out because the tether does not reach them.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub beyond_tether: usize,
}

/// What a survey has explored so far; reported every few seconds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Explored {
    /// Share of the floor within the wall that scans have shown, 0 to 1.
    pub share: f64,
    /// Places before the frontiers that the hull can reach, the nearest first, up to a limit.
    pub frontiers: Vec<Point>,
    /// The columns found so far.
    pub columns: Vec<Column>,
    /// The cells of the map whose state has changed since the report before, as text (see [`exploration::changes`]); before
    /// the first report, no cell has been seen. The lattice is [`exploration::Grid::of`] the wall.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub cells: String,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(n: &usize) -> bool {
    *n == 0
}
