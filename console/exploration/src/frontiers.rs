//! Frontiers: free floor beside floor that no scan has shown.

use crate::{distances::distances_m, ways::Ways};
use geometry::Point;

/// Minimum length of a frontier, metres: the hull could not pass through a shorter one, and noise leaves short ones.
const LEAST_M: f64 = 0.2;
/// Number of cells around a solid cell whose unseen cells do not count as a frontier: they are part of the object, or
/// hidden by its edge.
const EDGE: f64 = 2.5;
/// Number of cells by which the hull may stay short of the room that it keeps from a frontier.
const SHORT: f64 = 2.0;

/// A frontier that the hull can drive to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frontier {
    /// Where the hull's centre can go to see beyond the frontier.
    pub at: Point,
    /// Cost of the way to that place, metres: its length, and more where there is little room.
    pub cost_m: f64,
    /// Length of the frontier, metres.
    pub length_m: f64,
}

impl Ways<'_> {
    /// The frontiers that the hull can drive to, the nearest first. Each one is driven to at the place with the cheapest way
    /// that `is_worth` accepts: a frontier may be long, and one of its places may have been reached in vain.
    pub fn frontiers(&self, is_worth: impl Fn(Point) -> bool) -> Vec<Frontier> {
        let grid = self.grid();
        let edge_m = (EDGE * grid.cell_m) as f32;
        let solid_m = distances_m(grid, |cell| self.of.is_solid(cell));
        let is_open_floor = |cell: usize| self.of.is_unseen(cell) && solid_m[cell] > edge_m;
        let beside = |cell: usize| grid.around(cell, 1).any(is_open_floor);
        let mut is_open: Vec<bool> =
            (0..grid.len()).map(|cell| self.of.is_free(cell) && beside(cell)).collect();
        let mut frontiers = Vec::new();
        for first in 0..grid.len() {
            if !is_open[first] {
                continue;
            }
            is_open[first] = false;
            let mut cells = vec![first];
            let mut at = 0;
            while at < cells.len() {
                for next in grid.around(cells[at], 1) {
                    if std::mem::replace(&mut is_open[next], false) {
                        cells.push(next);
                    }
                }
                at += 1;
            }
            let length_m = cells.len() as f64 * grid.cell_m;
            if length_m < LEAST_M {
                continue;
            }
            let places = cells.iter().filter_map(|cell| self.place_before(*cell));
            let nearest = places.filter(|(cell, _)| is_worth(grid.center(*cell)));
            let nearest = nearest.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            frontiers.extend(nearest.map(|(cell, cost_m)| Frontier {
                at: grid.center(cell),
                cost_m,
                length_m,
            }));
        }
        frontiers.sort_by(|a, b| a.cost_m.total_cmp(&b.cost_m));
        frontiers
    }

    /// The cell with the cheapest way from which the hull sees a cell of a frontier from near.
    fn place_before(&self, open: usize) -> Option<(usize, f64)> {
        let grid = self.grid();
        let near_m = self.room_m + SHORT * grid.cell_m;
        let at = grid.center(open);
        let reach = (near_m / grid.cell_m).ceil() as usize;
        let reached = grid.around(open, reach).filter(|cell| self.cost_m(*cell).is_finite());
        let near = reached.filter(|cell| (grid.center(*cell) - at).norm() <= near_m);
        let mut near: Vec<(usize, f64)> = near.map(|cell| (cell, self.cost_m(cell))).collect();
        near.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        near.into_iter().find(|(cell, _)| self.is_in_sight(grid.center(*cell), at))
    }
}
