//! Shapes on a lattice.

use crate::grid::Grid;
use geometry::{Shape, Vector};

/// The cells that shapes cover, with a margin of half a cell.
pub(crate) struct Solids(Vec<bool>);

impl Solids {
    pub(crate) fn new<'a>(grid: &Grid, shapes: impl Iterator<Item = &'a Shape>) -> Self {
        let mut covered = vec![false; grid.len()];
        let margin_m = 0.5 * grid.cell_m;
        for shape in shapes {
            let (low, high) = shape.bounds();
            let margin = Vector::repeat(margin_m);
            for cell in grid.within(low - margin, high + margin) {
                covered[cell] |= shape.distance_m(grid.center(cell)) <= margin_m;
            }
        }
        Self(covered)
    }

    pub(crate) fn contains(&self, cell: usize) -> bool {
        self.0[cell]
    }
}
