//! The floor as a grid, with the kind of each cell.

use super::tool::Tool;
use geometry::{Point, Pose, Vector};
use serde::{Deserialize, Serialize};
use std::{ops::Range, sync::Arc};

/// Margin around a box within which the centres of cells are still tested, as a share of a cell, so that rounding
/// excludes no cell.
const BESIDE_CELLS: f64 = 1e-3;

/// The kind of a floor cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// Not floor: outside the tank or inside an obstacle.
    Outside,
    /// Floor that the robot cannot get to, because no passage is wide enough.
    Unreachable,
    /// Floor that the tool cannot reach because the hull keeps clear of the wall.
    Margin,
    /// Floor that the tool cannot reach because the hull keeps clear of obstacles.
    Beside,
    /// Floor in a no-go zone, beyond the reach of the tool.
    NoGo,
    /// Floor that the tool can reach.
    Reachable,
    /// Floor that the tool cannot test, in the dead band of a weld or the dead square of a plate's corner, whether the
    /// tool can reach it or not.
    Untestable,
}

impl Cell {
    /// Whether a cell of this kind counts as scanned after the tool has passed over it.
    ///
    /// ```
    /// use world::Cell;
    /// assert!(Cell::Margin.is_testable() && !Cell::Untestable.is_testable() && !Cell::Outside.is_testable());
    /// ```
    #[inline]
    pub fn is_testable(self) -> bool {
        !matches!(self, Self::Outside | Self::Untestable)
    }
}

/// The floor as a grid of square cells in the tank frame, row by row from the south-west corner.
///
/// A cell is floor if its centre lies on the floor. It is reachable if, from the start, the robot can drive to a
/// position where the tool covers the centre of the cell. Serialised as runs of equal cells.
///
/// ```
/// use world::{Boundary, Floor, Point, World};
/// # let boundary = Boundary::Circle { radius_m: 5.0 };
/// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
/// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
/// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
/// let east = floor.cell_at(Point::new(4.9, 0.0)).unwrap();
/// assert_eq!(floor.kind(east), world::Cell::Margin);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "FloorRuns", into = "FloorRuns")]
pub struct Floor {
    /// South-west corner of cell 0, metres.
    pub origin: Point,
    /// Edge length of a cell, metres.
    pub cell_m: f64,
    /// Number of cells from west to east.
    pub width: usize,
    /// Number of cells from south to north.
    pub height: usize,
    /// Copies share the cells until one of the copies changes.
    pub(super) cells: Arc<Vec<Cell>>,
}

/// A run of cells in one row: the index of the first cell, and the number of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellRun(pub u32, pub u32);

impl CellRun {
    /// Returns the indices of the cells.
    ///
    /// ```
    /// assert_eq!(world::CellRun(3, 2).range(), 3..5);
    /// ```
    #[inline]
    pub fn range(self) -> Range<usize> {
        self.0 as usize..(self.0 as usize).saturating_add(self.1 as usize)
    }

    /// Appends cells that come after all cells already in the list.
    #[inline]
    pub(super) fn append(runs: &mut Vec<Self>, cells: Range<usize>) {
        match runs.last_mut() {
            Some(last) if last.range().end == cells.start => last.1 += cells.len() as u32,
            _ => runs.push(Self(cells.start as u32, cells.len() as u32)),
        }
    }
}

/// A run of adjacent cells of the same kind: the kind, the index of the first cell, and the number of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct KindRun(pub Cell, pub u32, pub u32);

impl Floor {
    /// The largest number of cells that a floor may have; larger floors are refused, here and when scenarios are
    /// checked.
    pub const MOST_CELLS: usize = 4_000_000;

    /// Whether another floor has its cells at the same positions.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let coarse = Floor::new(&tank, 0.2, 0.5, 0.6, Point::origin());
    /// assert!(floor.is_aligned_with(&floor.clone()) && !floor.is_aligned_with(&coarse));
    /// ```
    pub fn is_aligned_with(&self, other: &Self) -> bool {
        self.width == other.width
            && self.height == other.height
            && (self.origin, self.cell_m) == (other.origin, other.cell_m)
    }

    /// Returns the index of the cell under a point; `None` outside the grid.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert_eq!(floor.cell_at(Point::origin()), Some(50 * 100 + 50));
    /// assert_eq!(floor.cell_at(Point::new(6.0, 0.0)), None);
    /// ```
    pub fn cell_at(&self, point: Point) -> Option<usize> {
        let offset = (point - self.origin) / self.cell_m;
        let inside = |at: f64, count: usize| at >= 0.0 && at < count as f64;
        (inside(offset.x, self.width) && inside(offset.y, self.height))
            .then(|| offset.y as usize * self.width + offset.x as usize)
    }

    /// Returns the centre of a cell, metres.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert!((floor.center(0) - Point::new(-4.95, -4.95)).norm() < 1e-9);
    /// ```
    pub fn center(&self, index: usize) -> Point {
        self.center_of(index % self.width, index / self.width)
    }

    #[inline]
    fn center_of(&self, column: usize, row: usize) -> Point {
        self.origin + Vector::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell_m
    }

    /// Returns the kind of a cell.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert_eq!(floor.kind(0), world::Cell::Outside);
    /// ```
    #[inline]
    pub fn kind(&self, index: usize) -> Cell {
        self.cells[index]
    }

    /// Whether a cell is floor of any kind.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let n_floor = (0..floor.len()).filter(|cell| floor.is_floor(*cell)).count();
    /// assert!((n_floor as f64 * floor.cell_m2() - 78.54).abs() < 0.5);
    /// ```
    #[inline]
    pub fn is_floor(&self, index: usize) -> bool {
        self.cells[index] != Cell::Outside
    }

    /// Whether the tool can reach a cell.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let is_reachable = |x| floor.is_reachable(floor.cell_at(Point::new(x, 0.0)).unwrap());
    /// assert!(is_reachable(4.5) && !is_reachable(4.9));
    /// ```
    #[inline]
    pub fn is_reachable(&self, index: usize) -> bool {
        self.cells[index] == Cell::Reachable
    }

    /// Area of a cell, square metres.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert!((floor.cell_m2() - 0.01).abs() < 1e-12);
    /// ```
    pub fn cell_m2(&self) -> f64 {
        self.cell_m * self.cell_m
    }

    /// Changes the kinds of some cells; cells beyond the grid are ignored.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let mut floor = floor;
    /// floor.change(&[world::KindRun(world::Cell::NoGo, 5000, 3)]);
    /// assert_eq!(floor.kind(5002), world::Cell::NoGo);
    /// ```
    pub fn change(&mut self, changes: &[KindRun]) {
        for KindRun(kind, first, count) in changes {
            let end = (*first as usize).saturating_add(*count as usize).min(self.cells.len());
            let first = (*first as usize).min(end);
            Arc::make_mut(&mut self.cells)[first..end].fill(*kind);
        }
    }

    pub(super) fn set(&mut self, index: usize, kind: Cell) {
        Arc::make_mut(&mut self.cells)[index] = kind;
    }

    /// Returns the whole floor as runs of equal cells. Passing these runs to [`Floor::change`] turns any floor with the
    /// same cells into this one.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let mut other = Floor::new(&tank, 0.1, 1.0, 0.6, Point::origin());
    /// other.change(&floor.kinds());
    /// assert_eq!(other, floor);
    /// ```
    pub fn kinds(&self) -> Vec<KindRun> {
        kind_runs(self.cells.iter().copied().enumerate())
    }

    /// The number of cells in the grid.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert_eq!(floor.len(), floor.width * floor.height);
    /// ```
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether the grid has no cells.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert!(!floor.is_empty());
    /// ```
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    pub(super) fn neighbours(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        neighbours(index, self.width, self.cells.len())
    }

    /// Whether the cell under a place and all adjacent floor cells are reachable; `None` if only some of them are,
    /// which means that the border of the reachable floor runs between them.
    pub(super) fn are_all_reachable_about(&self, place: Point) -> Option<bool> {
        let cell = self.cell_at(place)?;
        let (column, row) = (cell % self.width, cell / self.width);
        let rows = row.saturating_sub(1)..=(row + 1).min(self.height - 1);
        let columns = column.saturating_sub(1)..=(column + 1).min(self.width - 1);
        let about = rows.flat_map(|row| columns.clone().map(move |column| row * self.width + column));
        let (mut all, mut any) = (true, false);
        for cell in about.filter(|cell| self.cells[*cell].is_testable()) {
            all &= self.is_reachable(cell);
            any |= self.is_reachable(cell);
        }
        (all == any).then_some(any)
    }

    /// Returns the cells whose centres lie within `reach_m` of the segment from `a` to `b`, in order of their index.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let disc = floor.cells_near(Point::origin(), Point::origin(), 1.0);
    /// assert!((disc.len() as f64 * floor.cell_m2() - 3.14).abs() < 0.05);
    /// ```
    pub fn cells_near(&self, a: Point, b: Point, reach_m: f64) -> Vec<usize> {
        let at = |position| Pose { position, heading_rad: 0.0 };
        self.cells_under(Tool::Disc { swath_m: 2.0 * reach_m }, at(a), at(b))
    }

    /// Returns the cells whose centres a tool passes over between two poses that are close together, in order of their
    /// index.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// use world::{Pose, Tool};
    /// let (a, b) = (Pose::new(0.0, 0.0, 0.0), Pose::new(1.0, 0.0, 0.0));
    /// let cells = floor.cells_under(Tool::Bar { swath_m: 0.6 }, a, b);
    /// assert!((cells.len() as f64 * floor.cell_m2() - 0.6).abs() < 0.05);
    /// ```
    pub fn cells_under(&self, tool: Tool, a: Pose, b: Pose) -> Vec<usize> {
        self.runs_under(tool, a, b).into_iter().flat_map(CellRun::range).collect()
    }

    /// Returns the largest distance of a point in a cell from the centre of the cell, metres: half its diagonal.
    ///
    /// ```
    /// # use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert!((floor.rim_m() - 0.0707).abs() < 1e-4);
    /// ```
    pub fn rim_m(&self) -> f64 {
        self.cell_m * std::f64::consts::FRAC_1_SQRT_2
    }

    /// Returns the cells of [`Self::cells_under`] as runs: one in each row, or more if the tool turned about one of its
    /// own points.
    ///
    /// ```
    /// use world::{Boundary, CellRun, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// use world::{Pose, Tool};
    /// let (a, b) = (Pose::new(0.0, 0.0, 0.0), Pose::new(1.0, 0.0, 0.0));
    /// let runs = floor.runs_under(Tool::Bar { swath_m: 0.6 }, a, b);
    /// assert_eq!((runs.len(), runs[0]), (6, CellRun(47 * 100 + 50, 10)));
    /// ```
    pub fn runs_under(&self, tool: Tool, a: Pose, b: Pose) -> Vec<CellRun> {
        let passage = tool.passage(a, b);
        let (low, high) = passage.bounds();
        let rows = self.centers(low.y - self.origin.y, high.y - self.origin.y, self.height);
        let mut runs = Vec::with_capacity(rows.len());
        for row in rows {
            let (west, east) = passage.ends_at(self.center_of(0, row).y);
            let (west, east) = (low.x.max(west) - self.origin.x, high.x.min(east) - self.origin.x);
            let mut columns = self.centers(west, east, self.width);
            let is_under = |column: &usize| passage.contains(self.center_of(*column, row));
            let index = |column: usize| row * self.width + column;
            if passage.is_convex() {
                // The run is contiguous, so only the cells near its two ends are tested.
                let first = columns.clone().find(is_under);
                if let Some((first, last)) = first.zip(columns.rfind(is_under)) {
                    CellRun::append(&mut runs, index(first)..index(last) + 1);
                }
            } else {
                columns
                    .filter(is_under)
                    .map(index)
                    .for_each(|cell| CellRun::append(&mut runs, cell..cell + 1));
            }
        }
        runs
    }

    /// Returns which of `count` rows or columns have their centres between two distances from the origin. One extra row
    /// or column at either end may be included.
    fn centers(&self, from_m: f64, to_m: f64, count: usize) -> Range<usize> {
        let first = (from_m / self.cell_m - 0.5 - BESIDE_CELLS).max(0.0);
        let last = to_m / self.cell_m - 0.5 + BESIDE_CELLS;
        // Avoids the rounding functions of the C library, which take as long as all other work on a row.
        let whole = first as usize;
        let first = whole.saturating_add(usize::from((whole as f64) < first));
        let past = if last >= 0.0 { (last as usize).saturating_add(1) } else { 0 };
        first..past.min(count)
    }

    /// Returns the cells in a box in order of their index; a few adjacent cells may be included.
    pub(super) fn cells_in(&self, low: Point, high: Point) -> impl Iterator<Item = usize> + use<> {
        let (columns, rows) = self.spans(low, high);
        let width = self.width;
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// Returns the columns and rows in a box; a few adjacent ones may be included.
    fn spans(&self, low: Point, high: Point) -> (Range<usize>, Range<usize>) {
        let first = (low - self.origin) / self.cell_m;
        let last = (high - self.origin) / self.cell_m;
        let span = |from: f64, to: f64, count: usize| {
            (from.floor().max(0.0) as usize)..((to.ceil().max(0.0) as usize).min(count))
        };
        (span(first.x, last.x, self.width), span(first.y, last.y, self.height))
    }
}

/// Returns the neighbours of a cell, four at most, in a grid of `count` cells with `width` cells in each row.
pub(crate) fn neighbours(index: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let column = index % width;
    let west = (column > 0).then(|| index - 1);
    let east = (column + 1 < width).then_some(index + 1);
    let (south, north) = (index.checked_sub(width), Some(index + width).filter(|north| *north < count));
    [west, east, south, north].into_iter().flatten()
}

/// Combines cells, in order of their index, into runs of the same kind.
pub(super) fn kind_runs(cells: impl Iterator<Item = (usize, Cell)>) -> Vec<KindRun> {
    let mut runs: Vec<KindRun> = Vec::new();
    for (index, cell) in cells {
        match runs.last_mut() {
            Some(KindRun(kind, first, count)) if *kind == cell && (*first + *count) as usize == index => {
                *count += 1;
            }
            _ => runs.push(KindRun(cell, index as u32, 1)),
        }
    }
    runs
}

/// The serialised form of a [`Floor`].
#[derive(Clone, Serialize, Deserialize)]
struct FloorRuns {
    origin: Point,
    cell_m: f64,
    width: usize,
    height: usize,
    runs: Vec<(Cell, u32)>,
}

impl From<Floor> for FloorRuns {
    fn from(floor: Floor) -> Self {
        let runs = floor.kinds().into_iter().map(|KindRun(kind, _, count)| (kind, count)).collect();
        Self { origin: floor.origin, cell_m: floor.cell_m, width: floor.width, height: floor.height, runs }
    }
}

impl TryFrom<FloorRuns> for Floor {
    type Error = String;

    /// A damaged file must neither exhaust the memory nor let later look-ups run past the end.
    fn try_from(written: FloorRuns) -> Result<Self, String> {
        let FloorRuns { origin, cell_m, width, height, runs } = written;
        let count = width.checked_mul(height).filter(|count| *count <= Self::MOST_CELLS);
        let most = Self::MOST_CELLS;
        let count =
            count.ok_or_else(|| format!("the floor has {width} by {height} cells; the limit is {most}"))?;
        let in_runs: u64 = runs.iter().map(|(_, length)| u64::from(*length)).sum();
        if in_runs != count as u64 {
            return Err(format!(
                "the floor has {width} by {height} cells, but its runs contain {in_runs} cells"
            ));
        }
        let cells = runs.iter().flat_map(|(cell, length)| std::iter::repeat_n(*cell, *length as usize));
        Ok(Self { origin, cell_m, width, height, cells: Arc::new(cells.collect()) })
    }
}
