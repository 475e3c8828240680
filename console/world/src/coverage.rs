//! Which of the floor has been scanned, in square cells.

use crate::{
    geometry::Point,
    obstacles::ObstacleMap,
    polyline::nearest_on_segment,
    tank::Boundary,
};
use serde::{Deserialize, Serialize};

/// What a cell of the floor is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// Not floor: outside the tank or inside an obstacle.
    Outside = 0,
    /// Floor that the tool cannot reach.
    Unreachable = 1,
    /// Floor that the tool can reach.
    Reachable = 2,
}

/// The floor as a grid of square cells, row by row from the south west corner.
///
/// A cell is floor if its centre is; it is reachable if the robot can drive to a place from where the swath covers
/// its centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Floor {
    /// South west corner of cell 0, metres.
    pub origin: Point,
    /// Edge of a cell, metres.
    pub cell_m: f64,
    /// Cells from west to east.
    pub width: usize,
    /// Cells from south to north.
    pub height: usize,
    /// What each cell is, in runs: kind and how many.
    runs: Vec<(Cell, u32)>,
}

/// Some cells in a row of the grid that were scanned together: index of the first and how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellRun(pub u32, pub u32);
