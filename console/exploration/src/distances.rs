//! Distances on a lattice.

use crate::grid::Grid;

/// The distance from each cell's centre to the nearest blocked cell's centre, metres (exact; Felzenszwalb and
/// Huttenlocher 2012). Cells off the lattice count as free.
pub(crate) fn distances_m(grid: &Grid, is_blocked: impl Fn(usize) -> bool) -> Vec<f32> {
    let far = ((grid.columns + grid.rows) as f64).powi(2);
    let mut squares: Vec<f64> =
        (0..grid.len()).map(|cell| if is_blocked(cell) { 0.0 } else { far }).collect();
    let mut line = Line::new(grid.columns.max(grid.rows));
    for column in 0..grid.columns {
        line.pass(&mut squares, column, grid.columns, grid.rows);
    }
    for row in 0..grid.rows {
        line.pass(&mut squares, row * grid.columns, 1, grid.columns);
    }
    squares.iter().map(|square| (square.sqrt() * grid.cell_m) as f32).collect()
}

/// Buffers for the lower envelope of the parabolas of one line.
struct Line {
    heights: Vec<f64>,
    apexes: Vec<usize>,
    starts: Vec<f64>,
}

impl Line {
    fn new(len: usize) -> Self {
        Self { heights: vec![0.0; len], apexes: vec![0; len], starts: vec![0.0; len + 1] }
    }

    fn pass(&mut self, squares: &mut [f64], first: usize, step: usize, len: usize) {
        let Self { heights, apexes, starts } = self;
        for k in 0..len {
            heights[k] = squares[first + k * step];
        }
        let mut last = 0;
        (apexes[0], starts[0], starts[1]) = (0, f64::NEG_INFINITY, f64::INFINITY);
        for q in 1..len {
            let meets = |apex: usize| {
                let (x, p) = (q as f64, apex as f64);
                ((heights[q] + x * x) - (heights[apex] + p * p)) / (2.0 * (x - p))
            };
            while last > 0 && meets(apexes[last]) <= starts[last] {
                last -= 1;
            }
            let start = meets(apexes[last]);
            last += 1;
            (apexes[last], starts[last], starts[last + 1]) = (q, start, f64::INFINITY);
        }
        let mut at = 0;
        for q in 0..len {
            while starts[at + 1] < q as f64 {
                at += 1;
            }
            let apex = apexes[at];
            squares[first + q * step] = (q as f64 - apex as f64).powi(2) + heights[apex];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Point;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn distances_are_exact(blocked in prop::collection::vec(any::<bool>(), 12 * 9)) {
            let grid = Grid { low: Point::origin(), cell_m: 0.5, columns: 12, rows: 9 };
            let found = distances_m(&grid, |cell| blocked[cell]);
            for (cell, found_m) in found.iter().enumerate() {
                let to = |other: usize| (grid.center(other) - grid.center(cell)).norm();
                let nearest_m = (0..grid.len()).filter(|other| blocked[*other]).map(to).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest_m.is_infinite() || (f64::from(*found_m) - nearest_m).abs() < 1e-5);
            }
        }
    }
}
