//! The floor that a re-scan and the runs before it have scanned together.

use super::Raster;
use account::Account;
use serde::{Deserialize, Serialize};
use world::{CellRun, KindRun, Point};

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
    /// The kinds of the cells of this floor: obstacles found and zones drawn in any of the runs are applied.
    #[serde(default)]
    pub kinds: Vec<KindRun>,
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
    /// Adds what the earlier runs found and scanned to the floor of the re-scan.
    pub fn new(Combination { earlier, floor, kinds, scanned }: Combination, own: Option<&Raster>) -> Self {
        let raster = own.map(|own| joined(own, &kinds, &scanned));
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

/// The floor of a re-scan with the kinds of the joined floor and all scanned cells.
fn joined(own: &Raster, kinds: &[KindRun], scanned: &[CellRun]) -> Raster {
    let mut raster = own.clone();
    raster.change(kinds);
    raster.apply(scanned);
    raster
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, Floor, World};

    #[test]
    fn floor_that_only_an_earlier_run_closed_is_closed_on_the_map() {
        let boundary = Boundary::Circle { radius_m: 3.0 };
        let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
        let own = Floor::new(&tank, 0.1, 0.3, 0.6, Point::origin());
        let closed = Floor::new(&tank, 0.1, 1.0, 0.6, Point::origin());
        assert_ne!(own, closed);
        let scanned = [CellRun(0, own.len() as u32)];
        let raster = joined(&Raster::new(own), &closed.kinds(), &scanned);
        assert_eq!(raster.floor(), &closed);
        let mut expected = Raster::new(closed);
        expected.apply(&scanned);
        assert_eq!(raster.reachable(), expected.reachable());
    }
}
