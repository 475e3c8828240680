//! Records which part of the floor has been scanned, in square cells.

mod floor;
mod floor_class;
mod floor_maker;
mod parts;
mod percents;
pub mod regions;
mod room;
mod shell;
mod span;
mod swept_area;
mod tool;

pub(crate) use floor::neighbours;
pub use floor::{Cell, CellRun, Floor, KindRun};
pub use floor_class::FloorClass;
pub use floor_maker::FloorMaker;
pub(crate) use floor_maker::clearances_m;
pub use parts::ToolPart;
pub use percents::{percent, percent_text, percents};
pub use shell::{ShellFigures, ShellStretch, ShellZone};
pub use swept_area::SweptArea;
pub use tool::Tool;

use crate::tiles::Tiles;
use geometry::{Point, Pose};
use serde::{Deserialize, Serialize};

/// The number of cells of each kind, and how many of them have been scanned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Cells of floor.
    pub floor: usize,
    /// Cells of floor that the tool can reach.
    pub reachable: usize,
    /// Cells of floor that have been scanned.
    pub covered: usize,
    /// Reachable cells that have been scanned.
    pub covered_reachable: usize,
    /// Cells of the shell margin that have not been scanned.
    #[serde(default)]
    pub margin: usize,
    /// Cells of floor that the tool cannot test.
    #[serde(default, skip_serializing_if = "is_none")]
    pub untestable: usize,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "signature required by serde")]
fn is_none(count: &usize) -> bool {
    *count == 0
}

impl Counts {
    /// Counts a cell.
    ///
    /// ```
    /// use world::{Cell, Counts};
    /// let mut counts = Counts::default();
    /// [(Cell::Reachable, true), (Cell::Margin, false), (Cell::Outside, false)].map(|(kind, covered)| counts.add(kind, covered));
    /// assert_eq!((counts.floor, counts.covered_reachable, counts.margin), (2, 1, 1));
    /// ```
    pub fn add(&mut self, kind: Cell, covered: bool) {
        let (floor, reachable) = (kind != Cell::Outside, kind == Cell::Reachable);
        self.floor += usize::from(floor);
        self.reachable += usize::from(reachable);
        self.covered += usize::from(kind.is_testable() && covered);
        self.covered_reachable += usize::from(reachable && covered);
        self.margin += usize::from(kind == Cell::Margin && !covered);
        self.untestable += usize::from(kind == Cell::Untestable);
    }

    /// Returns the counts for the reachable floor alone.
    ///
    /// ```
    /// use world::Counts;
    /// let counts = Counts { floor: 9, reachable: 7, covered: 6, covered_reachable: 5, margin: 1, untestable: 0 };
    /// assert_eq!(counts.of_reachable().floor, 7);
    /// ```
    #[must_use]
    pub fn of_reachable(self) -> Self {
        let Self { reachable, covered_reachable, .. } = self;
        let (margin, untestable) = (0, 0);
        Self {
            floor: reachable,
            reachable,
            covered: covered_reachable,
            covered_reachable,
            margin,
            untestable,
        }
    }
}

/// A floor with its scanned cells marked.
///
/// ```
/// use world::{Boundary, CoverageGrid, Floor, Point, Pose, Tool, World};
/// # let boundary = Boundary::Circle { radius_m: 5.0 };
/// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
/// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
/// let mut grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
/// grid.mark(Tool::Bar { swath_m: 0.6 }, Pose::new(0.0, 0.0, 0.0), Pose::new(2.0, 0.0, 0.0));
/// assert!((grid.counts().covered as f64 * grid.floor().cell_m2() - 1.2).abs() < 0.1);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoverageGrid {
    floor: Floor,
    covered: Tiles<bool>,
    counts: Counts,
}

impl CoverageGrid {
    /// Creates a floor on which nothing has been scanned yet.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// assert_eq!(grid.counts().covered, 0);
    /// ```
    pub fn new(floor: Floor) -> Self {
        let covered = Tiles::new(floor.width, floor.len(), false);
        let mut grid = Self { floor, covered, counts: Counts::default() };
        grid.count();
        grid
    }

    fn count(&mut self) {
        self.counts = Counts::default();
        for (index, covered) in self.covered.iter().enumerate() {
            self.counts.add(self.floor.kind(index), covered);
        }
    }

    /// Changes the kinds of some cells; scanned cells stay scanned.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let mut grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// let before = grid.counts().reachable;
    /// grid.change(&[world::KindRun(world::Cell::Outside, 5050, 4)]);
    /// assert_eq!(grid.counts().reachable, before - 4);
    /// ```
    pub fn change(&mut self, changes: &[KindRun]) {
        self.floor.change(changes);
        self.count();
    }

    /// The floor itself.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// assert_eq!(grid.floor().width, 100);
    /// ```
    pub fn floor(&self) -> &Floor {
        &self.floor
    }

    /// Marks the cells that a disc with a diameter of `swath_m` scans from `a` to `b`; returns the floor cells that
    /// were not scanned before.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let mut grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// let (a, b) = (Point::new(-2.0, 0.0), Point::new(2.0, 0.0));
    /// assert!(!grid.mark_swath(a, b, 0.6).is_empty());
    /// assert!(grid.mark_swath(a, b, 0.6).is_empty());
    /// ```
    pub fn mark_swath(&mut self, a: Point, b: Point, swath_m: f64) -> Vec<CellRun> {
        let at = |position| Pose { position, heading_rad: 0.0 };
        let runs = self.not_covered_under(Tool::Disc { swath_m }, at(a), at(b));
        self.apply(&runs);
        runs
    }

    /// Marks the cells that a tool scans between two poses that are close together.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, Pose, Tool, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let mut grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// grid.mark(Tool::Bar { swath_m: 0.6 }, Pose::new(0.0, 0.0, 0.0), Pose::new(2.0, 0.0, 0.0));
    /// assert!(grid.is_covered(grid.floor().cell_at(Point::new(1.0, 0.2)).unwrap()));
    /// ```
    pub fn mark(&mut self, tool: Tool, a: Pose, b: Pose) {
        let runs = self.not_covered_under(tool, a, b);
        self.apply(&runs);
    }

    /// Returns the testable floor cells, not yet scanned, that a tool would scan between two poses that are close together.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, Pose, Tool, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// let (a, b) = (Pose::new(0.0, 0.0, 0.0), Pose::new(2.0, 0.0, 0.0));
    /// let new = grid.not_covered_under(Tool::Bar { swath_m: 0.6 }, a, b);
    /// assert_eq!(new.len(), 6, "one run in each row");
    /// ```
    pub fn not_covered_under(&self, tool: Tool, a: Pose, b: Pose) -> Vec<CellRun> {
        let mut new = Vec::new();
        for cells in self.floor.runs_under(tool, a, b).into_iter().map(CellRun::range) {
            for (first, covered) in self.covered.slices(cells) {
                let is_new =
                    |index: &usize| !covered[*index - first] && self.floor.kind(*index).is_testable();
                let cells = (first..first + covered.len()).filter(is_new);
                cells.for_each(|cell| CellRun::append(&mut new, cell..cell + 1));
            }
        }
        new
    }

    /// Returns the cells of [`Self::not_covered_under`] for the parts of a tool whose other parts do not test the floor.
    /// `a` and `b` are poses of the whole tool.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, Pose, Tool, ToolPart, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// let (a, b) = (Pose::new(0.0, 0.0, 0.0), Pose::new(2.0, 0.0, 0.0));
    /// let left = ToolPart::between(Tool::Bar { swath_m: 0.6 }, [0.0, 0.3]);
    /// assert_eq!(grid.not_covered_under_parts(&[left], a, b).len(), 3, "one run in each row");
    /// ```
    pub fn not_covered_under_parts(&self, parts: &[ToolPart], a: Pose, b: Pose) -> Vec<CellRun> {
        let under = |part: &ToolPart| self.not_covered_under(part.tool(), part.at(a), part.at(b));
        if let [only] = parts {
            return under(only);
        }
        let mut cells: Vec<usize> = parts.iter().flat_map(under).flat_map(CellRun::range).collect();
        cells.sort_unstable();
        cells.dedup();
        let mut runs = Vec::new();
        for cell in cells {
            CellRun::append(&mut runs, cell..cell + 1);
        }
        runs
    }

    /// Marks cells as scanned; cells beyond the grid and untestable cells are ignored.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let mut grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// grid.apply(&[world::CellRun(5050, 4)]);
    /// assert_eq!(grid.counts().covered_reachable, 4);
    /// ```
    pub fn apply(&mut self, runs: &[CellRun]) {
        for CellRun(first, count) in runs {
            let end = (*first as usize + *count as usize).min(self.floor.len());
            for index in (*first as usize)..end {
                if !self.covered.at(index) && self.floor.kind(index) != Cell::Untestable {
                    *self.covered.at_mut(index) = true;
                    self.counts.covered += usize::from(self.floor.is_floor(index));
                    self.counts.covered_reachable += usize::from(self.floor.is_reachable(index));
                    self.counts.margin -= usize::from(self.floor.kind(index) == Cell::Margin);
                }
            }
        }
    }

    /// Marks every cell that has been scanned on another grid with the same cells.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let mut grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// let mut other = grid.clone();
    /// other.apply(&[world::CellRun(5050, 4)]);
    /// grid.join(&other);
    /// assert_eq!(grid.counts().covered, 4);
    /// ```
    pub fn join(&mut self, other: &Self) {
        let covered = other.covered.iter().enumerate().filter(|(_, covered)| *covered);
        self.apply(&runs_of(covered.map(|(index, _)| index)));
    }

    /// Whether a cell has been scanned.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let mut grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// grid.apply(&[world::CellRun(5050, 4)]);
    /// assert!(grid.is_covered(5053) && !grid.is_covered(5054));
    /// ```
    pub fn is_covered(&self, index: usize) -> bool {
        self.covered.at(index)
    }

    /// Returns the number of cells of each kind.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// assert!(grid.counts().reachable < grid.counts().floor);
    /// ```
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Returns the scanned share of the floor that the tool can reach, 0 to 1.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let mut grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// grid.apply(&[world::CellRun(0, 10_000)]);
    /// assert_eq!(grid.fraction_reachable(), 1.0);
    /// ```
    pub fn fraction_reachable(&self) -> f64 {
        share(self.counts.covered_reachable, self.counts.reachable)
    }

    /// Returns the scanned share of the whole floor, 0 to 1.
    ///
    /// ```
    /// use world::{Boundary, CoverageGrid, Floor, Point, Pose, Tool, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let mut grid = CoverageGrid::new(Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin()));
    /// grid.mark(Tool::Bar { swath_m: 0.6 }, Pose::new(0.0, 0.0, 0.0), Pose::new(2.0, 0.0, 0.0));
    /// assert!((grid.fraction_whole() - 1.2 / 78.54).abs() < 0.002);
    /// ```
    pub fn fraction_whole(&self) -> f64 {
        share(self.counts.covered, self.counts.floor)
    }
}

fn share(part: usize, whole: usize) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

/// Combines cells, in ascending order of their index, into runs.
///
/// ```
/// use world::{CellRun, coverage::runs_of};
/// assert_eq!(runs_of([3, 4, 5, 9]), [CellRun(3, 3), CellRun(9, 1)]);
/// ```
pub fn runs_of(sorted: impl IntoIterator<Item = usize>) -> Vec<CellRun> {
    let mut runs = Vec::new();
    sorted.into_iter().for_each(|index| CellRun::append(&mut runs, index..index + 1));
    runs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boundary, Obstacle, ObstacleId, Shape, World};
    use proptest::prelude::*;

    fn tank(obstacles: Vec<Shape>) -> World {
        let obstacles = obstacles
            .into_iter()
            .enumerate()
            .map(|(i, shape)| Obstacle { id: ObstacleId(i as u32), name: String::new(), shape, known: true })
            .collect();
        World { boundary: Boundary::Circle { radius_m: 5.0 }, obstacles, stations: vec![], zones: vec![] }
    }

    fn floor(world: &World) -> Floor {
        Floor::new(world, 0.05, 0.25, 0.6, Point::origin())
    }

    #[test]
    fn the_floor_of_a_round_tank_has_its_area() {
        let floor = floor(&tank(vec![]));
        let area_m2 = CoverageGrid::new(floor.clone()).counts().floor as f64 * floor.cell_m * floor.cell_m;
        assert!((area_m2 - std::f64::consts::PI * 25.0).abs() < 0.3, "{area_m2}");
    }

    #[test]
    fn floor_behind_a_closed_ring_cannot_be_reached() {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let ring = Shape::Polyline {
            points: corners.iter().map(|(x, y)| Point::new(3.0 + x, *y)).collect(),
            half_width_m: 0.1,
        };
        let floor = floor(&tank(vec![ring]));
        let inside = floor.cell_at(Point::new(3.0, 0.0)).expect("in the grid");
        assert_eq!(floor.kind(inside), Cell::Unreachable);
        assert_eq!(floor.kind(floor.cell_at(Point::origin()).expect("in the grid")), Cell::Reachable);
    }

    #[test]
    fn a_start_on_the_wall_reaches_the_floor() {
        let floor = Floor::new(&tank(vec![]), 0.05, 0.0, 0.6, Point::new(5.0, 0.0));
        let counts = CoverageGrid::new(floor).counts();
        assert_eq!(counts.reachable, counts.floor);
    }

    #[test]
    fn a_straight_pass_scans_swath_times_length() {
        let mut grid = CoverageGrid::new(floor(&tank(vec![])));
        let runs = grid.mark_swath(Point::new(-2.0, 0.0), Point::new(2.0, 0.0), 0.6);
        let area_m2 = runs.iter().map(|run| f64::from(run.1)).sum::<f64>() * 0.05 * 0.05;
        let expected = 4.0 * 0.6 + std::f64::consts::PI * 0.09;
        assert!((area_m2 - expected).abs() < 0.05, "{area_m2} of {expected}");
        assert!(grid.mark_swath(Point::new(-2.0, 0.0), Point::new(2.0, 0.0), 0.6).is_empty());
    }

    proptest! {
        #[test]
        fn applying_the_runs_gives_the_same_grid(ends in (-5.0..5.0_f64, -5.0..5.0_f64, -5.0..5.0_f64, -5.0..5.0_f64)) {
            let world = tank(vec![Shape::Disc { center: Point::new(1.0, 1.0), radius_m: 0.4 }]);
            let floor = Floor::new(&world, 0.2, 0.25, 0.6, Point::origin());
            let (mut marked, mut applied) = (CoverageGrid::new(floor.clone()), CoverageGrid::new(floor));
            let runs = marked.mark_swath(Point::new(ends.0, ends.1), Point::new(ends.2, ends.3), 0.5);
            applied.apply(&runs);
            prop_assert_eq!(marked, applied);
        }
    }
}
