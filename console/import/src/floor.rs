//! Converts a map into a wall and convex obstacles.

use crate::{OccupancyMap, contour::Component, pieces::pieces, simplify::Simplified};
use world::{Boundary, Point};

/// The floor of a map, in the tank frame.
#[derive(Debug, Clone, PartialEq)]
pub struct MapFloor {
    /// The rectangle around the free floor, which may be rotated.
    pub wall: Boundary,
    /// Everything solid inside the wall, as convex counter-clockwise polygons.
    pub pieces: Vec<Vec<Point>>,
    /// The number of connected free cells.
    pub n_free: usize,
    /// The number of free cells in the whole map.
    pub n_free_in_map: usize,
    /// The number of outlines: the outer outline, and one for each solid inside.
    pub n_outlines: usize,
    /// The number of corners of the outlines: first along the cells, then after simplification.
    pub n_corners: [usize; 2],
    /// The largest distance in metres between floor that became solid and the nearest solid cell.
    pub error_m: f64,
    /// Whether each cell of the map belongs to the floor.
    is_joined: Vec<bool>,
}

impl MapFloor {
    /// The floor that is reachable from a start; if none is given, or the start is not free, the largest floor. `None`
    /// if no cell is free.
    ///
    /// Removes corners of the outlines, provided that no floor that becomes solid is farther than `tolerance_m` from a
    /// solid cell; by default, the tolerance is half a cell. Solid cells never become floor.
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

    /// Whether a point is free in the map but not connected to the floor by free cells.
    pub fn is_cut_off(&self, map: &OccupancyMap, place: Point) -> bool {
        let is_joined = map.cell_at(place).is_some_and(|(x, y)| self.is_joined[y * map.columns + x]);
        map.is_free_at(place) && !is_joined
    }
}

#[cfg(test)]
mod tests;
