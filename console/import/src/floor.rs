//! What becomes of a map: a wall and convex obstacles.

use crate::{OccupancyMap, contour::Component, pieces::pieces, simplify::Simplified};
use world::{Boundary, Point};

/// A floor made of a map, tank frame.
#[derive(Debug, Clone, PartialEq)]
pub struct MapFloor {
    /// The rectangle around the free floor, which may be turned.
    pub wall: Boundary,
    /// Everything solid within the wall as convex polygons, counter-clockwise.
    pub pieces: Vec<Vec<Point>>,
    /// Free cells that belong together.
    pub n_free: usize,
    /// Free cells of the whole map.
    pub n_free_in_map: usize,
    /// Outlines of the floor: the outer one and one for each solid within.
    pub n_outlines: usize,
    /// Corners of the outlines: of the cells, and after simplification.
    pub n_corners: [usize; 2],
    /// Farthest that any floor that became solid is from a solid cell, metres.
    pub error_m: f64,
    /// Which cells of the map belong together.
    is_joined: Vec<bool>,
}

impl MapFloor {
    /// The floor that can be reached from a start; without one, or if it is not free, the largest one. None if no cell is
    /// free.
    ///
    /// Outlines lose corners where no floor that becomes solid is farther than `tolerance_m` from a solid cell; by default
    /// half a cell. No solid becomes floor.
    pub fn new(map: &OccupancyMap, start: Option<Point>, tolerance_m: Option<f64>) -> Option<Self> {
        let component = Component::new(map, start.and_then(|place| map.cell_at(place)))?;
        let tolerance = tolerance_m.map_or(0.5, |tolerance_m| tolerance_m / map.cell_m);
        let outlines = Simplified::new(&component, tolerance);
        let to_tank = |node: &[i32; 2]| map.to_tank(f64::from(node[0]), f64::from(node[1]));
        let ([west, south], [east, north]) = (component.low, component.high);
        let corners = [[west, south], [east, south], [east, north], [west, north]];
        let pieces = pieces(&component, &outlines);
        Some(Self {
            wall: Boundary::Polygon { vertices: corners.iter().map(to_tank).collect() },
            pieces: pieces.iter().map(|piece| piece.iter().map(to_tank).collect()).collect(),
            n_free: component.n_cells,
            n_free_in_map: map.is_free.iter().filter(|free| **free).count(),
            n_outlines: outlines.rings.len(),
            n_corners: [component.rings(), outlines.rings].map(|rings| rings.iter().map(Vec::len).sum()),
            error_m: outlines.error_cells * map.cell_m,
            is_joined: component.into_cells(),
        })
    }

    /// Whether a place is free in the map, but no way over free cells leads there.
    pub fn is_cut_off(&self, map: &OccupancyMap, place: Point) -> bool {
        let is_joined = map.cell_at(place).is_some_and(|(x, y)| self.is_joined[y * map.columns + x]);
        map.is_free_at(place) && !is_joined
    }
}

#[cfg(test)]
mod tests;
