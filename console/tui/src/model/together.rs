//! The floor that a re-scan and the runs before it have scanned together.

use super::Raster;
use account::Account;
use serde::{Deserialize, Serialize};
use world::{CellRun, Point};

/// The runs that a re-scan continues.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Continued {
    /// The names of the runs, oldest first.
    pub runs: Vec<String>,
    /// The last estimated position of the robot in the last of them, metres, tank frame; `None` if it is not known.
    pub left_at: Option<Point>,
}

/// The combined scan of several runs, as it is read from their journals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Combination {
    /// The names of the runs before the re-scan, oldest first.
    pub earlier: Vec<String>,
    /// The account of the floor over all runs.
    pub floor: Account,
    /// The cells that any of the runs scanned.
    pub scanned: Vec<CellRun>,
}

/// The combined scan of several runs, ready for drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Together {
    /// The names of the runs before the re-scan, oldest first.
    pub earlier: Vec<String>,
    /// The account of the floor over all runs.
    pub floor: Account,
    /// The floor that any of the runs scanned; `None` if the re-scan scans no floor.
    pub raster: Option<Raster>,
}

impl Together {
    /// Adds what the earlier runs scanned to the floor of the re-scan.
    pub fn new(Combination { earlier, floor, scanned }: Combination, own: Option<&Raster>) -> Self {
        let raster = own.cloned().map(|mut raster| {
            raster.apply(&scanned);
            raster
        });
        Self { earlier, floor, raster }
    }

    /// The runs before the re-scan, in words: `the run before it`.
    pub fn before(&self) -> String {
        match self.earlier.len() {
            1 => "the run before it".to_owned(),
            n => format!("the {n} runs before it"),
        }
    }
}
