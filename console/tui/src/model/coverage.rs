//! The scanned floor, kept ready for drawing at any zoom.

mod class;

use account::{Overlap, Shares};
use class::Tally;
use serde::{Deserialize, Serialize};
use world::{Cell, CellRun, CoverageGrid, Floor, KindRun, Pose, Tiles, ToolPart, coverage::Counts};

/// The blocks of cells at one zoom level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Level {
    width: usize,
    tallies: Tiles<Tally>,
}

/// The scanned floor, with copies reduced in scale by 2, 4, 8 and so on.
///
/// An update folds in only the changed cells, and a drawing looks up one block per dot. Neither takes longer as the
/// mission goes on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Raster {
    grid: CoverageGrid,
    /// The first level halves the grid.
    levels: Vec<Level>,
    overlap: Overlap,
    /// Changes with every edit, and differs between floors.
    stamp: u64,
}

impl Raster {
    /// Creates the raster of a completely unscanned floor.
    pub fn new(floor: Floor) -> Self {
        let overlap = Overlap::new(floor.width, floor.len());
        let mut raster = Self { grid: CoverageGrid::new(floor), levels: Vec::new(), overlap, stamp: 0 };
        raster.levels = (1..).map_while(|shift| raster.level(shift)).collect();
        for index in 0..raster.grid.floor().len() {
            raster.note(raster.grid.floor().kind(index) as u64);
            let tally = raster.cell_tally(index);
            if tally.floor > 0 {
                raster.count(index, |block| *block += tally);
            }
        }
        raster
    }

    /// Mixes a change into the stamp (FNV-1a).
    fn note(&mut self, change: u64) {
        self.stamp = (self.stamp ^ change).wrapping_mul(0x0100_0000_01b3);
    }

    /// A stamp that changes with every edit; a drawing remains valid as long as the stamp stays the same.
    pub fn stamp(&self) -> u64 {
        self.stamp
    }

    /// The floor.
    pub fn floor(&self) -> &Floor {
        self.grid.floor()
    }

    /// Changes the kind of some cells, for example when an obstacle is found.
    pub fn change(&mut self, changes: &[KindRun]) {
        let len = self.grid.floor().len();
        let cells = changes.iter().flat_map(|KindRun(_, first, count)| {
            let end = (*first as usize).saturating_add(*count as usize).min(len);
            *first as usize..end
        });
        let mut before: Vec<(usize, Tally)> = cells.map(|index| (index, self.cell_tally(index))).collect();
        before.sort_unstable_by_key(|(index, _)| *index);
        before.dedup_by_key(|(index, _)| *index);
        self.grid.change(changes);
        for (index, before) in before {
            let now = self.cell_tally(index);
            self.count(index, |block| block.replace(before, now));
            self.note(index as u64);
            self.note(self.grid.floor().kind(index) as u64);
        }
    }

    /// Marks cells as scanned.
    pub fn apply(&mut self, runs: &[CellRun]) {
        for run in runs {
            let end = (run.0 as usize).saturating_add(run.1 as usize).min(self.grid.floor().len());
            for index in (run.0 as usize)..end {
                if !self.grid.is_covered(index) && self.grid.floor().is_floor(index) {
                    self.count(index, |block| block.scanned += 1);
                    self.note(index as u64);
                }
            }
            self.grid.apply(std::slice::from_ref(run));
        }
    }

    /// Records that, according to the estimate, the robot moved from `a` to `b` with these parts of its tool, which has the
    /// given swath, on the floor.
    pub fn pass(&mut self, swath_m: f64, parts: &[ToolPart], a: Pose, b: Pose) {
        let way_m = (b.position - a.position).norm();
        if !way_m.is_finite() {
            return;
        }
        let floor = self.grid.floor();
        let under = |part: &ToolPart| floor.runs_under(part.tool(), part.at(a), part.at(b));
        let cells: Vec<CellRun> = parts.iter().flat_map(under).collect();
        let grid = &self.grid;
        let is_scanned = |cell| grid.is_covered(cell) && grid.floor().is_floor(cell);
        for (cell, is_first) in self.overlap.pass(way_m, swath_m, &cells, is_scanned) {
            if is_first {
                self.count(cell, |block| block.again += 1);
                self.note(cell as u64);
            }
        }
    }

    /// The share of the scanned floor that was scanned more than once according to the estimated track, computed as
    /// in the report; `None` before anything is scanned.
    pub fn overlap(&self) -> Option<f64> {
        // The last level is a single block.
        let Tally { scanned, again, .. } = self.levels.last()?.tallies.at(0);
        (scanned > 0).then(|| f64::from(again) / f64::from(scanned))
    }

    /// Whether a cell has been scanned.
    pub fn is_scanned(&self, index: usize) -> bool {
        self.grid.is_covered(index)
    }

    /// The number of cells of each kind.
    pub fn counts(&self) -> Counts {
        self.grid.counts()
    }

    /// The number of reachable cells of each kind among those that are asked for.
    ///
    /// Cost: a look at every cell.
    pub fn counts_of(&self, is_asked: impl Fn(usize) -> bool) -> Counts {
        let mut counts = Counts::default();
        for cell in (0..self.floor().len()).filter(|cell| is_asked(*cell)) {
            let kind = self.floor().kind(cell);
            if kind == Cell::Reachable {
                counts.add(kind, self.is_scanned(cell));
            }
        }
        counts
    }

    /// The scanned area, square metres.
    pub fn scanned_m2(&self) -> f64 {
        self.counts().covered as f64 * self.grid.floor().cell_m.powi(2)
    }

    /// The shares of the whole floor, computed as in the report.
    pub fn whole(&self) -> Shares {
        Shares::of(self.counts(), self.floor().cell_m2())
    }

    /// The shares of the reachable floor, computed as in the report.
    pub fn reachable(&self) -> Shares {
        Shares::of(self.counts().of_reachable(), self.floor().cell_m2())
    }

    fn level(&self, shift: u32) -> Option<Level> {
        let floor = self.grid.floor();
        let half = |count: usize| count.div_ceil(1 << shift);
        let (width, height) = (half(floor.width), half(floor.height));
        // The previous level was already a single block.
        let useful = shift < 20 && floor.width.max(floor.height) > 1 << (shift - 1);
        useful.then(|| Level { width, tallies: Tiles::new(width, width * height, Tally::default()) })
    }

    fn count(&mut self, index: usize, mut add: impl FnMut(&mut Tally)) {
        let width = self.grid.floor().width;
        let (column, row) = (index % width, index / width);
        for (shift, level) in (1..).zip(&mut self.levels) {
            let block = (row >> shift) * level.width + (column >> shift);
            add(level.tallies.at_mut(block));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, FloorClass, Point, Tool, World};

    fn raster() -> Raster {
        let vertices =
            vec![Point::new(0.0, 0.0), Point::new(8.0, 0.0), Point::new(8.0, 8.0), Point::new(0.0, 8.0)];
        let world = World {
            boundary: Boundary::Polygon { vertices },
            obstacles: Vec::new(),
            stations: Vec::new(),
            zones: Vec::new(),
        };
        Raster::new(Floor::new(&world, 0.5, 0.2, 0.4, Point::new(4.0, 4.0)))
    }

    /// Scanned share of the floor in a square.
    fn share(raster: &Raster, center: Point, edge_m: f64) -> Option<f64> {
        let Tally { floor, scanned, .. } = raster.tally(center, edge_m);
        (floor > 0).then(|| f64::from(scanned) / f64::from(floor))
    }

    #[test]
    fn a_scanned_half_shows_at_every_zoom() {
        let mut raster = raster();
        raster.apply(&[CellRun(0, 128)]);
        for edge_m in [0.4, 1.0, 2.0, 4.0] {
            let south = share(&raster, Point::new(4.0, 2.0), edge_m);
            let north = share(&raster, Point::new(4.0, 6.0), edge_m);
            assert_eq!((south, north), (Some(1.0), Some(0.0)), "edge {edge_m} m");
        }
        assert_eq!(share(&raster, Point::new(4.0, 4.0), 8.0), Some(0.5));
    }

    #[test]
    fn the_whole_floor_divides_into_shares_that_sum_to_one() {
        let vertices =
            vec![Point::new(0.0, 0.0), Point::new(8.0, 0.0), Point::new(8.0, 8.0), Point::new(0.0, 8.0)];
        let boundary = Boundary::Polygon { vertices };
        let world = World { boundary, obstacles: Vec::new(), stations: Vec::new(), zones: Vec::new() };
        let mut raster = Raster::new(Floor::new(&world, 0.5, 1.2, 0.4, Point::new(4.0, 4.0)));
        for runs in [vec![], vec![CellRun(0, 40)], vec![CellRun(30, 90)]] {
            raster.apply(&runs);
            let Shares { scanned, missed, margin, unreachable, .. } = raster.whole();
            assert!((scanned + missed + margin + unreachable - 1.0).abs() < 1e-12);
            assert!(margin > 0.1 && unreachable.abs() < 1e-12, "{:?}", raster.whole());
        }
    }

    #[test]
    fn a_cell_scanned_twice_counts_once() {
        let mut raster = raster();
        raster.apply(&[CellRun(0, 3), CellRun(1, 3)]);
        assert_eq!(raster.counts().covered, 4);
        assert!((raster.scanned_m2() - 1.0).abs() < 1e-12);
        assert_eq!(share(&raster, Point::new(1.0, 0.25), 100.0), share(&raster, Point::new(1.0, 0.25), 1e9));
    }

    #[test]
    fn runs_beyond_the_grid_and_places_beyond_the_floor_are_ignored() {
        let mut raster = raster();
        raster.apply(&[CellRun(250, 100), CellRun(u32::MAX, u32::MAX)]);
        assert_eq!(raster.counts().covered, 6);
        assert_eq!(share(&raster, Point::new(-50.0, 4.0), 1.0), None);
        assert_eq!(share(&raster, Point::new(f64::NAN, 4.0), f64::NAN), None);
    }

    #[test]
    fn floor_that_the_tool_comes_back_to_is_overlap_and_every_change_gets_another_stamp() {
        let mut raster = raster();
        let mut stamps = vec![raster.stamp()];
        let class = |raster: &Raster| raster.class_at(Point::new(1.25, 4.25), false);
        assert_eq!(class(&raster), Some((FloorClass::ToDo, 0)));
        assert_eq!(raster.class_at(Point::new(1.25, 4.25), true), Some((FloorClass::Missed, 0)));
        raster.apply(&[CellRun(128, 16)]);
        stamps.push(raster.stamp());
        let at = |step: i32| Pose::new(0.5 + 0.5 * f64::from(step), 4.25, 0.0);
        let parts = [ToolPart::whole(Tool::Bar { swath_m: 0.6 })];
        (0..11).for_each(|step| raster.pass(0.6, &parts, at(step), at(step + 1)));
        assert_eq!((class(&raster), raster.overlap()), (Some((FloorClass::Scanned, 1)), Some(0.0)));
        (0..11).rev().for_each(|step| raster.pass(0.6, &parts, at(step + 1), at(step)));
        stamps.push(raster.stamp());
        assert_eq!(class(&raster), Some((FloorClass::Again, 2)));
        assert!(raster.overlap() > Some(0.5), "{:?}", raster.overlap());
        assert!(stamps[0] != stamps[1] && stamps[1] != stamps[2]);
    }
}
