//! How much of the floor was scanned, as believed and by truth, and how much of it again.

use crate::summary::{Coverage, CoverageByTruth};
use world::{CellRun, CoverageGrid, Floor, KindRun, Pose, Tool};

/// Coming back to a cell counts as scanning it again after this many swaths of way.
const AGAIN_SWATHS: f64 = 2.0;

/// The floor with what was scanned so far.
#[derive(Debug, Clone)]
pub(crate) struct Scanned {
    believed: CoverageGrid,
    truth: CoverageGrid,
    tool: Tool,
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
    pub(crate) fn new(floor: Floor, tool: Tool) -> Self {
        let last_m = vec![-1.0; floor.len()];
        let believed = CoverageGrid::new(floor);
        let truth = believed.clone();
        Self { believed, truth, tool, way_m: 0.0, last_m, cells: 0, cells_again: 0, has_truth: false }
    }

    /// The floor with what the mission believes to have scanned.
    pub(crate) fn believed(&self) -> &CoverageGrid {
        &self.believed
    }

    /// The mission says that it scanned these cells.
    pub(crate) fn believe(&mut self, runs: &[CellRun]) {
        self.believed.apply(runs);
    }

    /// An obstacle that was found changed the floor.
    pub(crate) fn change(&mut self, changes: &[KindRun]) {
        self.believed.change(changes);
        self.truth.change(changes);
    }

    /// Takes in what another run scanned of the same floor.
    pub(crate) fn join(&mut self, other: &Self) {
        let is_in_both = |index: &usize| self.truth.is_covered(*index) && other.truth.is_covered(*index);
        let in_both = (0..self.truth.floor().len().min(other.truth.floor().len())).filter(is_in_both).count();
        // What both scanned, one of them scanned again.
        self.cells = (self.cells + other.cells).saturating_sub(in_both);
        self.cells_again += other.cells_again + in_both;
        self.believed.join(&other.believed);
        self.truth.join(&other.truth);
        self.has_truth &= other.has_truth;
    }

    /// The robot truly went from `a` to `b`.
    pub(crate) fn pass(&mut self, a: Pose, b: Pose) {
        self.has_truth = true;
        let before_m = self.way_m;
        self.way_m += (b.position - a.position).norm();
        self.truth.mark(self.tool, a, b);
        for cell in self.truth.floor().cells_under(self.tool, a, b) {
            let last_m = std::mem::replace(&mut self.last_m[cell], self.way_m);
            if !self.truth.is_covered(cell) {
                continue;
            }
            if last_m < 0.0 {
                self.cells += 1;
            } else if before_m - last_m > AGAIN_SWATHS * self.tool.swath_m() {
                self.cells_again += 1;
            }
        }
    }

    /// The figures so far.
    pub(crate) fn coverage(&self) -> Coverage {
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
