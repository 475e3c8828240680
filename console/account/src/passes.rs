//! The passes of the tool according to the estimated position: accuracy, number of passes, and guaranteed floor.

use crate::{overlap::Overlap, stretch::Stretch};
use nalgebra::Matrix2;
use positioning::fix::{across_95_m, ellipse_95};
use world::{CellRun, CoverageGrid, Floor, Pose, Tool, ToolPart};

/// The error of a cell that was never passed.
const NEVER: u16 = u16::MAX;
/// The time of a cell that is not guaranteed.
const NOT_GUARANTEED: u32 = u32::MAX;

/// The counted passes over a floor.
#[derive(Debug, Clone)]
pub struct Passes {
    tool: Tool,
    /// The time of the first pass that guarantees a cell, milliseconds.
    guaranteed_ms: Vec<u32>,
    /// For each cell, the number of the last time that its guarantee was taken back; 0 if it never was.
    taken_back: Vec<u16>,
    /// How often guarantees were taken back.
    times: u16,
    /// The smallest 95 % error with which each cell was passed, millimetres.
    error_mm: Vec<u16>,
    overlap: Overlap,
    stretch: Stretch,
}

/// What is known about the position of a pass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Margins {
    /// The largest 95 % error since the last fix but one, metres.
    pub error_m: f64,
    /// The distance by which the position may be off for the floor to be guaranteed, metres.
    pub margin_m: f64,
    /// Mission time, seconds.
    pub t_s: f64,
}

/// The cells under parts of a tool, each made another tool; `from` and `to` are poses of the whole tool. A cell may occur
/// under two parts of a tool that turns.
fn runs_under(
    floor: &Floor,
    parts: &[ToolPart],
    (from, to): (Pose, Pose),
    tool: impl Fn(&ToolPart) -> Option<Tool>,
) -> Vec<CellRun> {
    let under = |part: &ToolPart| Some(floor.runs_under(tool(part)?, part.at(from), part.at(to)));
    parts.iter().filter_map(under).flatten().collect()
}

/// An error in whole millimetres, rounded as it is printed, so that a figure per cell and the same figure per run agree.
pub(crate) fn nearest_mm(error_m: f64) -> u16 {
    (1000.0 * error_m).round().clamp(0.0, f64::from(u16::MAX)) as u16
}

/// Milliseconds, within the bounds of the record.
fn milliseconds(t_s: f64) -> u32 {
    (t_s * 1000.0).clamp(0.0, f64::from(NOT_GUARANTEED - 1)) as u32
}

impl Passes {
    /// An empty record.
    pub(crate) fn new(floor: &Floor, tool: Tool) -> Self {
        Self {
            tool,
            guaranteed_ms: vec![NOT_GUARANTEED; floor.len()],
            taken_back: vec![0; floor.len()],
            times: 0,
            error_mm: vec![NEVER; floor.len()],
            overlap: Overlap::new(floor.width, floor.len()),
            stretch: Stretch::default(),
        }
    }

    /// Adds a pass of the tool from one estimated pose to the next; it counts as scanned under the given parts of the tool,
    /// whose channels work.
    ///
    /// Floor that the tool passed for every position within the margin of the estimate is guaranteed. To find it, the tool is
    /// narrowed on each side by the margin, and each stretch is shortened at both ends by as much.
    pub(crate) fn pass(
        &mut self,
        believed: &CoverageGrid,
        parts: &[ToolPart],
        (from, to): (Pose, Pose),
        Margins { error_m, margin_m, t_s }: Margins,
    ) {
        let floor = believed.floor();
        let cells = runs_under(floor, parts, (from, to), |part| Some(part.tool()));
        let way_m = (to.position - from.position).norm();
        if way_m.is_finite() {
            self.overlap.pass(way_m, self.tool.swath_m(), &cells, |cell| {
                believed.is_covered(cell) && believed.floor().is_floor(cell)
            });
        }
        let error_mm = nearest_mm(error_m).min(NEVER - 1);
        for run in cells {
            self.error_mm[run.range()].iter_mut().for_each(|mm| *mm = (*mm).min(error_mm));
        }
        // Whatever its place, a disc that is narrowed by the margin was under the tool.
        let behind_m = if matches!(self.tool, Tool::Disc { .. }) { 0.0 } else { margin_m };
        for poses in self.stretch.sure((from, to), behind_m) {
            for run in runs_under(floor, parts, poses, |part| part.tool().narrowed(margin_m)) {
                let first_ms = self.guaranteed_ms[run.range()].iter_mut();
                first_ms.for_each(|first_ms| *first_ms = (*first_ms).min(milliseconds(t_s)));
            }
        }
    }

    /// The next pass does not continue the last one.
    pub(crate) fn interrupt(&mut self) {
        self.stretch = Stretch::default();
    }

    /// The tool.
    pub(crate) fn tool(&self) -> Tool {
        self.tool
    }

    /// Takes back the guarantee of cells that no pass before `since_s`, seconds, guarantees. Returns their number.
    pub(crate) fn take_back(&mut self, since_s: f64) -> usize {
        self.interrupt();
        let since_ms = milliseconds(since_s);
        self.times = self.times.saturating_add(1);
        let mut count = 0;
        for (first_ms, time) in self.guaranteed_ms.iter_mut().zip(&mut self.taken_back) {
            if (since_ms..NOT_GUARANTEED).contains(first_ms) {
                (*first_ms, *time) = (NOT_GUARANTEED, self.times);
                count += 1;
            }
        }
        count
    }

    /// Of the cells that lost their guarantee the `time`-th time, counted from 1, those that are still in doubt, in
    /// ascending order.
    pub(crate) fn left_in_doubt(&self, time: usize) -> impl Iterator<Item = usize> {
        (0..self.taken_back.len())
            .filter(move |cell| usize::from(self.taken_back[*cell]) == time && self.is_in_doubt(*cell))
    }

    /// The number of cells that lost their guarantee, and the number of them that a later pass guarantees.
    pub fn taken_back(&self) -> (usize, usize) {
        let taken = (0..self.taken_back.len()).filter(|cell| self.taken_back[*cell] > 0);
        taken.fold((0, 0), |(all, again), cell| (all + 1, again + usize::from(self.is_guaranteed(cell))))
    }

    /// The half-width of the 95 % ellipse of a covariance, square metres, in the direction that matters to the tool:
    /// across the heading for a bar, any for a disc; metres.
    pub(crate) fn across_m(&self, covariance: &Matrix2<f64>, heading_rad: f64) -> f64 {
        match self.tool {
            Tool::Bar { .. } => across_95_m(covariance, heading_rad),
            Tool::Disc { .. } => ellipse_95(covariance).0,
        }
    }

    /// Adds the passes of another run on the same floor.
    pub(crate) fn join(&mut self, other: &Self, is_in_both: impl Fn(usize) -> bool) {
        let first_ms = self.guaranteed_ms.iter_mut().zip(&other.guaranteed_ms);
        first_ms.for_each(|(own, other)| *own = (*own).min(*other));
        self.taken_back.iter_mut().zip(&other.taken_back).for_each(|(own, other)| *own = (*own).max(*other));
        self.times = self.times.max(other.times);
        self.error_mm.iter_mut().zip(&other.error_mm).for_each(|(own, other)| *own = (*own).min(*other));
        self.overlap.join(&other.overlap, is_in_both);
    }

    /// Whether a cell was under the tool for every position within the 95 % error.
    pub fn is_guaranteed(&self, cell: usize) -> bool {
        self.guaranteed_ms[cell] != NOT_GUARANTEED
    }

    /// Whether the guarantee of a cell was taken back, and no later pass guarantees the cell.
    pub fn is_in_doubt(&self, cell: usize) -> bool {
        self.taken_back[cell] > 0 && !self.is_guaranteed(cell)
    }

    /// The smallest 95 % error of a pass over a cell, millimetres; `None` if it was never passed.
    pub fn error_mm(&self, cell: usize) -> Option<u16> {
        Some(self.error_mm[cell]).filter(|mm| *mm != NEVER)
    }

    /// The number of times that cells were scanned again.
    pub fn overlap(&self) -> &Overlap {
        &self.overlap
    }
}
