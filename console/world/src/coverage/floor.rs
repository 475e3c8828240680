//! The floor as a grid, and what each cell of it is.

use super::tool::Tool;
use geometry::{Point, Pose, Vector};
use serde::{Deserialize, Serialize};
use std::{ops::Range, sync::Arc};

/// Centres this far outside a box are still looked at, as a share of a cell: whatever rounding does, none is overlooked.
const BESIDE_CELLS: f64 = 1e-3;

/// What a cell of the floor is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// Not floor: outside the tank or inside an obstacle.
    Outside,
    /// Floor to which no passage leads that is wide enough for the robot.
    Unreachable,
    /// Floor along the shell that the tool cannot reach, because the hull keeps clear of the wall.
    Margin,
    /// Floor beside obstacles that the tool cannot reach, because the hull keeps clear of them.
    Beside,
    /// Floor in a zone that the robot must not enter, beyond the reach of the tool.
    NoGo,
    /// Floor that the tool can reach.
    Reachable,
}

/// The floor as a grid of square cells, row by row from the south-west corner, tank frame.
///
/// A cell is floor if its centre is. It is reachable if the tool covers its centre from some position to which the
/// robot can drive from the start. Written as runs of equal cells.
///
/// ```
/// use world::{Boundary, Floor, Point, World};
/// # let boundary = Boundary::Circle { radius_m: 5.0 };
/// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
/// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
/// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
/// let east = floor.cell_at(Point::new(4.9, 0.0)).unwrap();
/// assert_eq!(floor.kind(east), world::Cell::Margin);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "FloorRuns", into = "FloorRuns")]
pub struct Floor {
    /// South-west corner of cell 0, metres.
    pub origin: Point,
    /// Edge of a cell, metres.
    pub cell_m: f64,
    /// Cells from west to east.
    pub width: usize,
    /// Cells from south to north.
    pub height: usize,
    /// Shared by copies until one of them changes.
    pub(super) cells: Arc<Vec<Cell>>,
}

/// Some cells of one row: index of the first and how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellRun(pub u32, pub u32);

impl CellRun {
    /// The indices of the cells.
    ///
    /// ```
    /// assert_eq!(world::CellRun(3, 2).range(), 3..5);
    /// ```
    #[inline]
    pub fn range(self) -> Range<usize> {
        self.0 as usize..(self.0 as usize).saturating_add(self.1 as usize)
    }

    /// Appends cells behind all that are in the list.
    #[inline]
    pub(super) fn append(runs: &mut Vec<Self>, cells: Range<usize>) {
        match runs.last_mut() {
            Some(last) if last.range().end == cells.start => last.1 += cells.len() as u32,
            _ => runs.push(Self(cells.start as u32, cells.len() as u32)),
        }
    }
}

/// Some neighbouring cells and what they are: kind, index of the first, how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct KindRun(pub Cell, pub u32, pub u32);

impl Floor {
    /// Most cells of a floor; more are refused, here and where scenarios are checked.
    pub const MOST_CELLS: usize = 4_000_000;

    /// Whether another floor has its cells at the same positions.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let coarse = Floor::new(&tank, 0.2, 0.5, 0.6, Point::origin());
    /// assert!(floor.is_aligned_with(&floor.clone()) && !floor.is_aligned_with(&coarse));
    /// ```
    pub fn is_aligned_with(&self, other: &Self) -> bool {
        self.width == other.width
            && self.height == other.height
            && (self.origin, self.cell_m) == (other.origin, other.cell_m)
    }

    /// Index of the cell under a point; `None` outside the grid.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
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

    /// Centre of a cell, metres.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
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

    /// What a cell is.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
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
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
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
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
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
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert!((floor.cell_m2() - 0.01).abs() < 1e-12);
    /// ```
    pub fn cell_m2(&self) -> f64 {
        self.cell_m * self.cell_m
    }

    /// Changes the kind of some cells; cells beyond the grid are ignored.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
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

    /// The whole floor as runs of equal cells; [`Floor::change`] with them turns any aligned floor into this one.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let mut other = Floor::new(&tank, 0.1, 1.0, 0.6, Point::origin());
    /// other.change(&floor.kinds());
    /// assert_eq!(other, floor);
    /// ```
    pub fn kinds(&self) -> Vec<KindRun> {
        kind_runs(self.cells.iter().copied().enumerate())
    }

    /// Number of cells of the grid.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
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
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert!(!floor.is_empty());
    /// ```
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    pub(super) fn neighbours(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        neighbours(index, self.width, self.cells.len())
    }

    /// Whether the cell under a place and those around it that are floor are all reachable; `None` if only some of them are: the
    /// border of what is reachable runs there.
    pub(super) fn are_all_reachable_about(&self, place: Point) -> Option<bool> {
        let cell = self.cell_at(place)?;
        let (column, row) = (cell % self.width, cell / self.width);
        let rows = row.saturating_sub(1)..=(row + 1).min(self.height - 1);
        let columns = column.saturating_sub(1)..=(column + 1).min(self.width - 1);
        let about = rows.flat_map(|row| columns.clone().map(move |column| row * self.width + column));
        let (mut all, mut any) = (true, false);
        for cell in about.filter(|cell| self.is_floor(*cell)) {
            all &= self.is_reachable(cell);
            any |= self.is_reachable(cell);
        }
        (all == any).then_some(any)
    }

    /// Cells whose centre lies within `reach_m` of the segment from `a` to `b`, in order of their index.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let disc = floor.cells_near(Point::origin(), Point::origin(), 1.0);
    /// assert!((disc.len() as f64 * floor.cell_m2() - 3.14).abs() < 0.05);
    /// ```
    pub fn cells_near(&self, a: Point, b: Point, reach_m: f64) -> Vec<usize> {
        let at = |position| Pose { position, heading_rad: 0.0 };
        self.cells_under(Tool::Disc { swath_m: 2.0 * reach_m }, at(a), at(b))
    }

    /// Cells whose centre comes under a tool between two poses that are close together, in order of their index.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// use world::{Pose, Tool};
    /// let (a, b) = (Pose::new(0.0, 0.0, 0.0), Pose::new(1.0, 0.0, 0.0));
    /// let cells = floor.cells_under(Tool::Bar { swath_m: 0.6 }, a, b);
    /// assert!((cells.len() as f64 * floor.cell_m2() - 0.6).abs() < 0.05);
    /// ```
    pub fn cells_under(&self, tool: Tool, a: Pose, b: Pose) -> Vec<usize> {
        self.runs_under(tool, a, b).into_iter().flat_map(CellRun::range).collect()
    }

    /// The same as runs, one in each row; several where the tool turned about a point of it.
    ///
    /// ```
    /// use world::{Boundary, CellRun, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
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
                // One piece: only the cells beside its two ends are looked at.
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

    /// Which of so many rows or columns have their centres between two distances from the origin, perhaps with one beside them.
    fn centers(&self, from_m: f64, to_m: f64, count: usize) -> Range<usize> {
        let first = (from_m / self.cell_m - 0.5 - BESIDE_CELLS).max(0.0);
        let last = to_m / self.cell_m - 0.5 + BESIDE_CELLS;
        // Without calls of the C library, which rounds as slowly as a row is looked at.
        let whole = first as usize;
        let first = whole.saturating_add(usize::from((whole as f64) < first));
        let past = if last >= 0.0 { (last as usize).saturating_add(1) } else { 0 };
        first..past.min(count)
    }

    /// The cells of a box, perhaps with some beside it, in order of their index.
    pub(super) fn cells_in(&self, low: Point, high: Point) -> impl Iterator<Item = usize> + use<> {
        let (columns, rows) = self.spans(low, high);
        let width = self.width;
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// The columns and rows of a box, perhaps with some beside it.
    fn spans(&self, low: Point, high: Point) -> (Range<usize>, Range<usize>) {
        let first = (low - self.origin) / self.cell_m;
        let last = (high - self.origin) / self.cell_m;
        let span = |from: f64, to: f64, count: usize| {
            (from.floor().max(0.0) as usize)..((to.ceil().max(0.0) as usize).min(count))
        };
        (span(first.x, last.x, self.width), span(first.y, last.y, self.height))
    }
}

/// The four neighbours of a cell in a grid of rows `width` cells long, `count` cells in all, as far as they exist.
pub(crate) fn neighbours(index: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let column = index % width;
    let west = (column > 0).then(|| index - 1);
    let east = (column + 1 < width).then_some(index + 1);
    let (south, north) = (index.checked_sub(width), Some(index + width).filter(|north| *north < count));
    [west, east, south, north].into_iter().flatten()
}

/// Cells in order of their index, as runs of neighbours of one kind.
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

/// The written form of a [`Floor`].
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

    /// A damaged file must neither exhaust the memory nor make later look-ups run past the end.
    fn try_from(written: FloorRuns) -> Result<Self, String> {
        let FloorRuns { origin, cell_m, width, height, runs } = written;
        let count = width.checked_mul(height).filter(|count| *count <= Self::MOST_CELLS);
        let most = Self::MOST_CELLS;
        let count = count.ok_or_else(|| format!("a floor of {width} by {height} cells; at most {most}"))?;
        let in_runs: u64 = runs.iter().map(|(_, length)| u64::from(*length)).sum();
        if in_runs != count as u64 {
            return Err(format!("a floor of {width} by {height} cells with {in_runs} in its runs"));
        }
        let cells = runs.iter().flat_map(|(cell, length)| std::iter::repeat_n(*cell, *length as usize));
        Ok(Self { origin, cell_m, width, height, cells: Arc::new(cells.collect()) })
    }
}
