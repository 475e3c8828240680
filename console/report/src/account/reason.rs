//! Why floor was not scanned, or cannot be.

use serde::{Deserialize, Serialize};
use std::fmt;
use world::Cell;

/// Why floor in reach of the tool was not scanned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MissReason {
    /// The tool passed, but the position error was above the limit.
    PositionUncertain,
    /// Beside an obstacle that was found on the way.
    FoundObstacle,
    /// Outside the areas that the mission was to scan.
    NotAsked,
    /// No plan led there.
    NotPlanned,
    /// No plan led there, because the cable does not.
    BeyondReel,
    /// A plan led there, but the mission ended before.
    NotReached,
    /// A plan led there, but the robot passed beside it.
    PassedBeside,
}

/// Why floor is out of reach of the tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutOfReach {
    /// The robot keeps its distance from the shell.
    ShellMargin,
    /// The robot keeps its distance from an obstacle.
    BesideObstacle,
    /// In a zone that the robot must not enter.
    NoGo,
    /// No way leads there that is wide enough for the robot.
    ClosedOff,
}

impl OutOfReach {
    /// Why cells of a kind are out of reach, if they are.
    pub(crate) fn of(kind: Cell) -> Option<Self> {
        match kind {
            Cell::Outside | Cell::Reachable => None,
            Cell::Unreachable => Some(OutOfReach::ClosedOff),
            Cell::Margin => Some(OutOfReach::ShellMargin),
            Cell::Beside => Some(OutOfReach::BesideObstacle),
            Cell::NoGo => Some(OutOfReach::NoGo),
        }
    }
}

impl fmt::Display for MissReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::PositionUncertain => "passed, but the position error was above the limit",
            Self::FoundObstacle => "beside an obstacle found during the run",
            Self::NotAsked => "not requested",
            Self::NotPlanned => "not planned",
            Self::BeyondReel => "not planned, beyond the reel",
            Self::NotReached => "planned, but the mission ended first",
            Self::PassedBeside => "planned, but the robot passed to one side",
        })
    }
}

impl fmt::Display for OutOfReach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ShellMargin => "clearance to the shell",
            Self::BesideObstacle => "clearance to an obstacle",
            Self::NoGo => "in a no-go zone",
            Self::ClosedOff => "no passage wide enough",
        })
    }
}
