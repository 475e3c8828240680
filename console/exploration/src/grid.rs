//! The lattice of the map.

use geometry::{Boundary, Point, Vector};
use serde::{Deserialize, Serialize};

/// Edge of a cell on small floors, metres; about twice the scatter of a scanned point.
const CELL_M: f64 = 0.05;
/// Maximum number of cells along a side; larger floors have larger cells.
const MOST_ALONG: f64 = 800.0;
/// Width of the margin around the floor, metres.
const MARGIN_M: f64 = 0.2;

/// A lattice of square cells, row by row from the lower left; tank frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// The lower left corner, metres.
    pub low: Point,
    /// Edge of a cell, metres.
    pub cell_m: f64,
    /// Number of cells along x.
    pub columns: usize,
    /// Number of cells along y.
    pub rows: usize,
}

impl Grid {
    /// Creates a lattice that contains the floor within a wall.
    ///
    /// ```
    /// let grid = exploration::Grid::of(&world::Boundary::Circle { radius_m: 1.0 });
    /// assert_eq!((grid.columns, grid.rows, grid.cell_m), (48, 48, 0.05));
    /// ```
    pub fn of(boundary: &Boundary) -> Self {
        let (low, high) = boundary.bounds();
        let (low, high) = (low - Vector::repeat(MARGIN_M), high + Vector::repeat(MARGIN_M));
        let size = high - low;
        let cell_m = CELL_M.max(size.max() / MOST_ALONG);
        // A side that is a whole number of cells must not get one more by rounding.
        let along = |side_m: f64| (side_m / cell_m - 1e-9).ceil().max(1.0) as usize;
        Self { low, cell_m, columns: along(size.x), rows: along(size.y) }
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Whether the lattice has no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cell (column, row) that contains a point, if the point is on the lattice.
    pub fn place(&self, at: Point) -> Option<(usize, usize)> {
        let at = (at - self.low) / self.cell_m;
        let fits = |v: f64, n: usize| (v >= 0.0 && v < n as f64).then_some(v as usize);
        Some((fits(at.x, self.columns)?, fits(at.y, self.rows)?))
    }

    /// Index of the cell that contains a point, if the point is on the lattice.
    pub fn index(&self, at: Point) -> Option<usize> {
        self.place(at).map(|(column, row)| row * self.columns + column)
    }

    /// Centre of a cell.
    pub fn center(&self, index: usize) -> Point {
        let (column, row) = (index % self.columns, index / self.columns);
        self.low + Vector::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell_m
    }

    /// The cells that share an edge with a cell.
    pub(crate) fn beside(&self, index: usize) -> impl Iterator<Item = usize> + '_ {
        let (column, row) = (index % self.columns, index / self.columns);
        let left = (column > 0).then(|| index - 1);
        let right = (column + 1 < self.columns).then(|| index + 1);
        let below = (row > 0).then(|| index - self.columns);
        let above = (row + 1 < self.rows).then(|| index + self.columns);
        [left, right, below, above].into_iter().flatten()
    }

    /// The cells within `reach` cells of a cell along x and y, the cell itself included.
    pub(crate) fn around(&self, index: usize, reach: usize) -> impl Iterator<Item = usize> + '_ {
        let (column, row) = (index % self.columns, index / self.columns);
        let columns = column.saturating_sub(reach)..(column + reach + 1).min(self.columns);
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(self.rows);
        rows.flat_map(move |row| columns.clone().map(move |column| row * self.columns + column))
    }

    /// The cells whose centres are in a box.
    pub(crate) fn within(&self, low: Point, high: Point) -> impl Iterator<Item = usize> + '_ {
        let clip = |v: f64, n: usize| v.clamp(0.0, n as f64) as usize;
        let (low, high) = ((low - self.low) / self.cell_m, (high - self.low) / self.cell_m);
        let columns = clip((low.x - 0.5).ceil(), self.columns)..clip((high.x + 0.5).floor(), self.columns);
        let rows = clip((low.y - 0.5).ceil(), self.rows)..clip((high.y + 0.5).floor(), self.rows);
        rows.flat_map(move |row| columns.clone().map(move |column| row * self.columns + column))
    }
}
