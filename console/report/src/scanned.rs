//! How much of the floor was scanned, as believed and by truth, and how much of it again.

use crate::summary::{Coverage, CoverageByTruth};
use world::{CellRun, CoverageGrid, Floor, Point};

/// Coming back to a cell counts as scanning it again after this many swaths of way.
const AGAIN_SWATHS: f64 = 2.0;

/// The floor with what was scanned so far.
#[derive(Debug)]
pub struct Scanned {
    believed: CoverageGrid,
    truth: CoverageGrid,
    swath_m: f64,
    /// Way gone so far, metres.
    way_m: f64,
    /// Way gone when each cell was last under the tool, metres; negative before the first time.
    last_m: Vec<f64>,
    cells: usize,
    cells_again: usize,
    has_truth: bool,
}

impl Scanned {
    /// Nothing is scanned yet.
    pub fn new(floor: Floor, swath_m: f64) -> Self {
        let last_m = vec![-1.0; floor.len()];
        let believed = CoverageGrid::new(floor);
        let truth = believed.clone();
        Self { believed, truth, swath_m, way_m: 0.0, last_m, cells: 0, cells_again: 0, has_truth: false }
    }

    /// The mission says that it scanned these cells.
    pub fn believe(&mut self, runs: &[CellRun]) {
        self.believed.apply(runs);
    }

    /// The robot truly went from `a` to `b`.
    pub fn pass(&mut self, a: Point, b: Point) {
        self.has_truth = true;
        let before_m = self.way_m;
        self.way_m += (b - a).norm();
        self.truth.mark_swath(a, b, self.swath_m);
        for cell in self.truth.floor().cells_near(a, b, self.swath_m / 2.0) {
            let last_m = std::mem::replace(&mut self.last_m[cell], self.way_m);
            if !self.truth.is_covered(cell) {
                continue;
            }
            if last_m < 0.0 {
                self.cells += 1;
            } else if before_m - last_m > AGAIN_SWATHS * self.swath_m {
                self.cells_again += 1;
            }
        }
    }

    /// The figures so far.
    pub fn coverage(&self) -> Coverage {
        let counts = self.believed.counts();
        let cell_m2 = self.believed.floor().cell_m.powi(2);
        let by_truth = CoverageByTruth {
            reachable: self.truth.fraction_reachable(),
            whole: self.truth.fraction_whole(),
        };
        Coverage {
            reachable: self.believed.fraction_reachable(),
            whole: self.believed.fraction_whole(),
            overlap: (self.cells > 0).then(|| self.cells_again as f64 / self.cells as f64),
            missed_area_m2: (counts.reachable - counts.covered_reachable) as f64 * cell_m2,
            by_truth: self.has_truth.then_some(by_truth),
        }
    }
}
