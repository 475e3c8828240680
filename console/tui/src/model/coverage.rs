//! What has been scanned, kept ready for drawing at any zoom.

use serde::{Deserialize, Serialize};
use world::{Cell, CellRun, CoverageGrid, Floor, KindRun, Point, coverage::Counts};

/// Blocks of cells at one zoom: how many of their cells are floor, and how many of these have been scanned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Level {
    width: usize,
    floor: Vec<u32>,
    scanned: Vec<u32>,
}

/// The scanned floor with its own reductions by 2, 4, 8 and so on.
///
/// Only cells that change are folded in, and drawing looks up one block per dot: neither costs more as the mission
/// grows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Raster {
    grid: CoverageGrid,
    /// The first one halves the grid.
    levels: Vec<Level>,
    /// Cells along the shell that are out of reach and have not been scanned.
    n_margin: usize,
}

/// How the whole floor divides. Shares, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Division {
    /// Scanned.
    pub scanned: f64,
    /// In reach and not scanned: to do, or missed when the mission has ended.
    pub to_do: f64,
    /// Out of reach along the shell.
    pub margin: f64,
    /// Out of reach elsewhere.
    pub unreachable: f64,
}

impl Raster {
    /// A floor of which nothing has been scanned.
    pub fn new(floor: Floor) -> Self {
        Self::of(CoverageGrid::new(floor))
    }

    fn of(grid: CoverageGrid) -> Self {
        let is_margin = |index: &usize| grid.floor().kind(*index) == Cell::Margin && !grid.is_covered(*index);
        let n_margin = (0..grid.floor().len()).filter(is_margin).count();
        let mut raster = Self { grid, levels: Vec::new(), n_margin };
        raster.levels = (1..).map_while(|shift| raster.level(shift)).collect();
        for index in 0..raster.grid.floor().len() {
            if raster.grid.floor().is_floor(index) {
                let scanned = u32::from(raster.grid.is_covered(index));
                raster.count(index, |level, block| {
                    level.floor[block] += 1;
                    level.scanned[block] += scanned;
                });
            }
        }
        raster
    }

    /// Makes some cells another kind of floor; costs one look at every cell, and happens when an obstacle is found.
    pub fn change(&mut self, changes: &[KindRun]) {
        let mut grid = self.grid.clone();
        grid.change(changes);
        *self = Self::of(grid);
    }

    /// Marks cells as scanned.
    pub fn apply(&mut self, runs: &[CellRun]) {
        for run in runs {
            let end = (run.0 as usize).saturating_add(run.1 as usize).min(self.grid.floor().len());
            for index in (run.0 as usize)..end {
                if !self.grid.is_covered(index) && self.grid.floor().is_floor(index) {
                    self.n_margin -= usize::from(self.grid.floor().kind(index) == Cell::Margin);
                    self.count(index, |level, block| level.scanned[block] += 1);
                }
            }
            self.grid.apply(std::slice::from_ref(run));
        }
    }

    /// Scanned share of the floor in a square of some edge about a point; `None` where there is no floor.
    pub fn scanned_share(&self, center: Point, edge_m: f64) -> Option<f64> {
        // A square that is hardly larger than a cell takes the cell under its centre.
        if edge_m < 1.5 * self.grid.floor().cell_m {
            let (floor, scanned) = self.block_at(center, 0.0);
            return (floor > 0).then(|| f64::from(scanned));
        }
        let quarter_m = edge_m / 4.0;
        let mut sums = (0, 0);
        for (right, up) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let at = Point::new(center.x + right * quarter_m, center.y + up * quarter_m);
            let (floor, scanned) = self.block_at(at, edge_m / 2.0);
            sums = (sums.0 + floor, sums.1 + scanned);
        }
        (sums.0 > 0).then(|| f64::from(sums.1) / f64::from(sums.0))
    }

    /// How many cells of each kind.
    pub fn counts(&self) -> Counts {
        self.grid.counts()
    }

    /// Scanned area, square metres.
    pub fn scanned_m2(&self) -> f64 {
        self.counts().covered as f64 * self.grid.floor().cell_m.powi(2)
    }

    /// How the whole floor divides; the shares sum to 1.
    pub fn division(&self) -> Division {
        let counts = self.counts();
        let share = |cells: usize| if counts.floor == 0 { 0.0 } else { cells as f64 / counts.floor as f64 };
        let out_of_reach = counts.floor - counts.reachable - (counts.covered - counts.covered_reachable);
        Division {
            scanned: share(counts.covered),
            to_do: share(counts.reachable - counts.covered_reachable),
            margin: share(self.n_margin.min(out_of_reach)),
            unreachable: share(out_of_reach.saturating_sub(self.n_margin)),
        }
    }

    fn level(&self, shift: u32) -> Option<Level> {
        let floor = self.grid.floor();
        let half = |count: usize| count.div_ceil(1 << shift);
        let (width, height) = (half(floor.width), half(floor.height));
        // The level before this one already was a single block.
        let useful = shift < 20 && floor.width.max(floor.height) > 1 << (shift - 1);
        useful.then(|| Level { width, floor: vec![0; width * height], scanned: vec![0; width * height] })
    }

    fn count(&mut self, index: usize, mut add: impl FnMut(&mut Level, usize)) {
        let width = self.grid.floor().width;
        let (column, row) = (index % width, index / width);
        for (shift, level) in (1..).zip(&mut self.levels) {
            let block = (row >> shift) * level.width + (column >> shift);
            add(level, block);
        }
    }

    /// Floor cells and scanned cells of the block under a point, of the largest blocks no wider than `edge_m`.
    fn block_at(&self, point: Point, edge_m: f64) -> (u32, u32) {
        let floor = self.grid.floor();
        let Some(index) = floor.cell_at(point) else { return (0, 0) };
        let cells = edge_m / floor.cell_m;
        let shift =
            if cells >= 2.0 { (cells as usize).ilog2().min(self.levels.len() as u32) as usize } else { 0 };
        if shift == 0 {
            let is_floor = floor.is_floor(index);
            return (u32::from(is_floor), u32::from(is_floor && self.grid.is_covered(index)));
        }
        let level = &self.levels[shift - 1];
        let block = ((index / floor.width) >> shift) * level.width + ((index % floor.width) >> shift);
        (level.floor[block], level.scanned[block])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::{Boundary, World};

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

    #[test]
    fn a_scanned_half_shows_at_every_zoom() {
        let mut raster = raster();
        raster.apply(&[CellRun(0, 128)]);
        for edge_m in [0.4, 1.0, 2.0, 4.0] {
            let south = raster.scanned_share(Point::new(4.0, 2.0), edge_m);
            let north = raster.scanned_share(Point::new(4.0, 6.0), edge_m);
            assert_eq!((south, north), (Some(1.0), Some(0.0)), "edge {edge_m} m");
        }
        assert_eq!(raster.scanned_share(Point::new(4.0, 4.0), 8.0), Some(0.5));
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
            let Division { scanned, to_do, margin, unreachable } = raster.division();
            assert!((scanned + to_do + margin + unreachable - 1.0).abs() < 1e-12);
            assert!(margin > 0.1 && unreachable.abs() < 1e-12, "{:?}", raster.division());
        }
    }

    #[test]
    fn a_cell_scanned_twice_counts_once() {
        let mut raster = raster();
        raster.apply(&[CellRun(0, 3), CellRun(1, 3)]);
        assert_eq!(raster.counts().covered, 4);
        assert!((raster.scanned_m2() - 1.0).abs() < 1e-12);
        assert_eq!(
            raster.scanned_share(Point::new(1.0, 0.25), 100.0),
            raster.scanned_share(Point::new(1.0, 0.25), 1e9)
        );
    }

    #[test]
    fn runs_beyond_the_grid_and_places_beyond_the_floor_are_ignored() {
        let mut raster = raster();
        raster.apply(&[CellRun(250, 100), CellRun(u32::MAX, u32::MAX)]);
        assert_eq!(raster.counts().covered, 6);
        assert_eq!(raster.scanned_share(Point::new(-50.0, 4.0), 1.0), None);
        assert_eq!(raster.scanned_share(Point::new(f64::NAN, 4.0), f64::NAN), None);
    }
}
