//! The floor as a grid, and what each cell of it is.

use super::Tool;
use crate::{
    geometry::{Point, Pose},
    polyline::nearest_on_segment,
    tank::World,
};
use serde::{Deserialize, Serialize};

/// What a cell of the floor is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// Not floor: outside the tank or inside an obstacle.
    Outside,
    /// Floor to which no way leads that is wide enough for the robot.
    Unreachable,
    /// Floor along the shell that the tool cannot reach, because the robot keeps its distance from the wall.
    Margin,
    /// Floor beside obstacles that the tool cannot reach, because the robot keeps its distance from them.
    Beside,
    /// Floor in a zone that the robot must not enter, beyond the reach of the tool.
    NoGo,
    /// Floor that the tool can reach.
    Reachable,
}

/// The floor as a grid of square cells, row by row from the south west corner.
///
/// A cell is floor if its centre is. It is reachable if the tool covers its centre from some place to which the
/// robot's centre can drive from the start. Stored and written as runs of equal cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "FloorRuns", into = "FloorRuns")]
pub struct Floor {
    /// South west corner of cell 0, metres.
    pub origin: Point,
    /// Edge of a cell, metres.
    pub cell_m: f64,
    /// Cells from west to east.
    pub width: usize,
    /// Cells from south to north.
    pub height: usize,
    pub(super) cells: Vec<Cell>,
}

/// Some cells of one row: index of the first and how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellRun(pub u32, pub u32);

/// Some neighbouring cells and what they are: kind, index of the first, how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct KindRun(pub Cell, pub u32, pub u32);

impl Floor {
    /// More cells than this are refused, here and where scenarios are checked.
    pub const MOST_CELLS: usize = 4_000_000;

    /// The floor of a tank for a robot whose centre keeps `room_m` (hull and clearance) from anything solid, with a
    /// tool of some swath, driving from `start`.
    ///
    /// Costs one distance query per cell and a flood fill.
    pub fn new(world: &World, cell_m: f64, room_m: f64, swath_m: f64, start: Point) -> Self {
        super::FloorMaker::new(world, cell_m, room_m, swath_m, start).into_floor()
    }

    /// Whether another floor has its cells in the same places.
    pub fn is_aligned_with(&self, other: &Self) -> bool {
        self.width == other.width
            && self.height == other.height
            && (self.origin, self.cell_m) == (other.origin, other.cell_m)
    }

    /// The cell under a point, if it lies in the grid.
    pub fn cell_at(&self, point: Point) -> Option<usize> {
        let offset = (point - self.origin) / self.cell_m;
        let inside = |at: f64, count: usize| at >= 0.0 && at < count as f64;
        (inside(offset.x, self.width) && inside(offset.y, self.height))
            .then(|| offset.y as usize * self.width + offset.x as usize)
    }

    /// Centre of a cell, metres.
    pub fn center(&self, index: usize) -> Point {
        let (column, row) = (index % self.width, index / self.width);
        self.origin + nalgebra::Vector2::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell_m
    }

    /// What a cell is.
    pub fn kind(&self, index: usize) -> Cell {
        self.cells[index]
    }

    /// Whether a cell is floor.
    pub fn is_floor(&self, index: usize) -> bool {
        self.cells[index] != Cell::Outside
    }

    /// Whether the tool can reach a cell.
    pub fn is_reachable(&self, index: usize) -> bool {
        self.cells[index] == Cell::Reachable
    }

    /// Area of a cell, square metres.
    pub fn cell_m2(&self) -> f64 {
        self.cell_m * self.cell_m
    }

    /// Makes some cells another kind; cells beyond the grid are ignored.
    pub fn change(&mut self, changes: &[KindRun]) {
        for KindRun(kind, first, count) in changes {
            let end = (*first as usize).saturating_add(*count as usize).min(self.cells.len());
            let first = (*first as usize).min(end);
            self.cells[first..end].fill(*kind);
        }
    }

    /// All of it as runs of equal cells: what [`Floor::change`] makes it of any floor with the same cells.
    pub fn kinds(&self) -> Vec<KindRun> {
        let mut runs: Vec<KindRun> = Vec::new();
        for (index, cell) in self.cells.iter().enumerate() {
            match runs.last_mut() {
                Some(KindRun(kind, _, count)) if kind == cell => *count += 1,
                _ => runs.push(KindRun(*cell, index as u32, 1)),
            }
        }
        runs
    }

    /// How many cells the grid has.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether the grid has no cells.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    pub(super) fn neighbours(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        let (column, row, width, height) = (index % self.width, index / self.width, self.width, self.height);
        let west = (column > 0).then(|| index - 1);
        let east = (column + 1 < width).then(|| index + 1);
        let south = (row > 0).then(|| index - width);
        let north = (row + 1 < height).then(|| index + width);
        [west, east, south, north].into_iter().flatten()
    }

    /// Cells whose centre lies within `reach_m` of the segment from `a` to `b`, in order of their index.
    pub fn cells_near(&self, a: Point, b: Point, reach_m: f64) -> Vec<usize> {
        let reach = nalgebra::Vector2::new(reach_m, reach_m);
        self.cells_in(a.inf(&b) - reach, a.sup(&b) + reach)
            .filter(|index| {
                let center = self.center(*index);
                (center - nearest_on_segment(a, b, center)).norm() <= reach_m
            })
            .collect()
    }

    /// Cells whose centre comes under a tool on its way from `a` to `b`, in order of their index.
    pub fn cells_under(&self, tool: Tool, a: Pose, b: Pose) -> Vec<usize> {
        let passage = tool.passage(a, b);
        let (low, high) = passage.bounds();
        self.cells_in(low, high).filter(|index| passage.contains(self.center(*index))).collect()
    }

    /// The cells of a box and perhaps some beside it, in order of their index.
    pub(super) fn cells_in(&self, low: Point, high: Point) -> impl Iterator<Item = usize> + use<> {
        let first = (low - self.origin) / self.cell_m;
        let last = (high - self.origin) / self.cell_m;
        let span = |from: f64, to: f64, count: usize| {
            (from.floor().max(0.0) as usize)..((to.ceil().max(0.0) as usize).min(count))
        };
        let (columns, width) = (span(first.x, last.x, self.width), self.width);
        span(first.y, last.y, self.height)
            .flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
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
        let mut runs: Vec<(Cell, u32)> = Vec::new();
        for cell in floor.cells {
            match runs.last_mut() {
                Some((kind, count)) if *kind == cell => *count += 1,
                _ => runs.push((cell, 1)),
            }
        }
        Self { origin: floor.origin, cell_m: floor.cell_m, width: floor.width, height: floor.height, runs }
    }
}

impl TryFrom<FloorRuns> for Floor {
    type Error = String;

    /// A damaged file must neither take all the memory nor make later look-ups run past the end.
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
        Ok(Self { origin, cell_m, width, height, cells: cells.collect() })
    }
}
