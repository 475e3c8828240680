//! The scanned share of the floor according to the estimated and the true position, and the share scanned more than
//! once.

use crate::{
    passes::{Margins, Passes},
    silence::kept,
    summary::{Coverage, CoverageByTruth, Regained},
    true_errors::TrueErrors,
};
use nalgebra::Matrix2;
use world::{CellRun, Counts, CoverageGrid, Floor, FloorClass, KindRun, Pose, Tool, ToolPart};

/// A floor with the cells that were scanned so far.
#[derive(Debug, Clone)]
pub struct Scanned {
    believed: CoverageGrid,
    /// Cells that the tool truly passed.
    truth: Vec<bool>,
    true_errors: TrueErrors,
    passes: Box<Passes>,
    /// The parts of the tool whose channels work.
    live: Vec<ToolPart>,
    last: Pose,
    has_truth: bool,
}

impl Scanned {
    /// A floor on which nothing has been scanned yet.
    pub fn new(floor: Floor, tool: Tool, start: Pose) -> Self {
        let passes = Box::new(Passes::new(&floor, tool));
        let truth = vec![false; floor.len()];
        let true_errors = TrueErrors::new(floor.len());
        let believed = CoverageGrid::new(floor);
        let live = vec![ToolPart::whole(tool)];
        Self { believed, truth, true_errors, passes, live, last: start, has_truth: false }
    }

    /// From now on, only these parts of the tool test the floor.
    pub(crate) fn test_with(&mut self, live: Vec<ToolPart>) {
        self.live = live;
    }

    /// Forgets all passes, so that they can be made again; returns the floor with the cells scanned so far.
    pub(crate) fn begin_again(&mut self, start: Pose) -> CoverageGrid {
        let floor = self.believed.floor().clone();
        *self.passes = Passes::new(&floor, self.passes.tool());
        (self.live, self.last) = (vec![ToolPart::whole(self.passes.tool())], start);
        std::mem::replace(&mut self.believed, CoverageGrid::new(floor))
    }

    /// Marks the floor under the working channels between two poses as scanned.
    pub(crate) fn scan(&mut self, from: Pose, to: Pose) {
        let runs = self.believed.not_covered_under_parts(&self.live, from, to);
        self.believed.apply(&runs);
    }

    /// Keeps the cells that were scanned before, if they were scanned again or are to be kept.
    pub(crate) fn keep_where(&mut self, before: &CoverageGrid, is_kept: impl Fn(usize) -> bool) {
        self.believed = kept(before, &self.believed, is_kept);
    }

    /// The floor with the cells scanned according to the mission's estimate.
    pub fn believed(&self) -> &CoverageGrid {
        &self.believed
    }

    /// The passes of the tool according to the estimated position.
    pub fn passes(&self) -> &Passes {
        &self.passes
    }

    /// Adds cells that the mission reports as scanned.
    pub(crate) fn believe(&mut self, runs: &[CellRun]) {
        self.believed.apply(runs);
    }

    /// Updates the floor after an obstacle was found.
    pub fn change(&mut self, changes: &[KindRun]) {
        self.believed.change(changes);
    }

    /// Adds the cells that another run on the same floor scanned.
    pub fn join(&mut self, other: &Self) {
        let is_in_both = |cell| self.believed.is_covered(cell) && other.believed.is_covered(cell);
        self.passes.join(&other.passes, is_in_both);
        self.believed.join(&other.believed);
        self.truth.iter_mut().zip(&other.truth).for_each(|(own, other)| *own |= other);
        self.true_errors.join(&other.true_errors);
        self.has_truth &= other.has_truth;
    }

    /// Adds the estimated pose, with its margins if the pass counts.
    pub(crate) fn visit(&mut self, here: Pose, margins: Option<Margins>) {
        let before = std::mem::replace(&mut self.last, here);
        match margins {
            Some(margins) => self.passes.pass(&self.believed, &self.live, (before, here), margins),
            None if before.position == here.position => {}
            None => self.passes.interrupt(),
        }
    }

    /// Takes back the guarantee of floor that no pass before `since_s`, seconds, guarantees; returns its area, square
    /// metres.
    pub(crate) fn take_back(&mut self, since_s: f64) -> f64 {
        self.passes.take_back(since_s) as f64 * self.believed.floor().cell_m2()
    }

    /// Of the floor that lost its guarantee the `time`-th time, counted from 1, the area that is still in doubt, square
    /// metres.
    pub(crate) fn left_in_doubt_m2(&self, time: usize) -> f64 {
        self.passes.left_in_doubt(time).count() as f64 * self.believed.floor().cell_m2()
    }

    /// The half-width of the 95 % ellipse of a covariance, square metres, that matters to the tool at a pose, metres.
    pub(crate) fn across_m(&self, here: Pose, covariance: &Matrix2<f64>) -> f64 {
        self.passes.across_m(covariance, here.heading_rad)
    }

    /// Adds the robot's true movement from `a` to `b`.
    pub(crate) fn pass(&mut self, a: Pose, b: Pose) {
        self.has_truth = true;
        let floor = self.believed.floor();
        let under = |part: &ToolPart| floor.runs_under(part.tool(), part.at(a), part.at(b));
        let cells: Vec<CellRun> = self.live.iter().flat_map(under).collect();
        for run in &cells {
            self.truth[run.range()].fill(true);
        }
        self.true_errors.pass(cells);
    }

    /// Adds the position error on the robot's latest true movement, metres.
    pub(crate) fn note_error(&mut self, error_m: f64) {
        self.true_errors.note(error_m);
    }

    /// The largest true position error with which the tool passed a cell, millimetres; `None` if it is not known, or not
    /// for all runs.
    pub(crate) fn true_error_mm(&self, cell: usize) -> Option<u16> {
        self.true_errors.mm(cell).filter(|_| self.has_truth)
    }

    /// The class of a cell during the mission.
    pub fn class(&self, cell: usize) -> FloorClass {
        let again = u32::from(self.passes.overlap().again(cell));
        let times = if self.believed.is_covered(cell) { 1 + again } else { 0 };
        FloorClass::of(self.believed.floor().kind(cell), times)
    }

    /// The figures so far; they include missed floor only if the floor had to be scanned (`to_scan`).
    pub fn coverage(&self, to_scan: bool) -> Coverage {
        let counts = self.believed.counts();
        let again =
            (0..self.truth.len()).filter(|cell| self.class(*cell) == FloorClass::Again).count() as f64;
        let missed = (counts.reachable - counts.covered_reachable) as f64 * self.believed.floor().cell_m2();
        Coverage {
            reachable: self.believed.fraction_reachable(),
            whole: self.believed.fraction_whole(),
            overlap: (counts.covered > 0).then(|| again / counts.covered as f64),
            missed_area_m2: to_scan.then_some(missed),
            by_truth: self.has_truth.then(|| self.by_truth()),
            taken_back: self.regained(),
        }
    }

    /// The floor whose guarantee was taken back; `None` if no floor lost its guarantee.
    fn regained(&self) -> Option<Regained> {
        let (all, again) = self.passes.taken_back();
        let area_m2 = |cells: usize| cells as f64 * self.believed.floor().cell_m2();
        (all > 0).then(|| Regained { area_m2: area_m2(all), again_m2: area_m2(again) })
    }

    fn by_truth(&self) -> CoverageByTruth {
        let (mut counts, mut scanned, mut sure) = (Counts::default(), Claim::default(), Claim::default());
        for (cell, truly) in self.truth.iter().enumerate() {
            counts.add(self.believed.floor().kind(cell), *truly);
            if self.believed.floor().is_floor(cell) && self.believed.is_covered(cell) {
                scanned.count(*truly);
                if self.passes.is_guaranteed(cell) {
                    sure.count(*truly);
                }
            }
        }
        let share = |part: usize, of: usize| if of == 0 { 0.0 } else { part as f64 / of as f64 };
        CoverageByTruth {
            reachable: share(counts.covered_reachable, counts.reachable),
            whole: share(counts.covered, counts.floor),
            scanned_truly: scanned.true_share(),
            guaranteed_truly: sure.true_share(),
        }
    }
}

/// Number of cells claimed as scanned, and number of those that truly were.
#[derive(Default)]
struct Claim {
    cells: usize,
    truly: usize,
}

impl Claim {
    fn count(&mut self, truly: bool) {
        self.cells += 1;
        self.truly += usize::from(truly);
    }

    fn true_share(&self) -> Option<f64> {
        (self.cells > 0).then(|| self.truly as f64 / self.cells as f64)
    }
}
