//! The floor in square cells, and which of them the hull centre cannot enter.

use crate::problem::GrownShape;
use geometry::polyline::edges;
use world::{Boundary, Point, Shape, Vector};

/// The cells of a floor, surrounded by a frame of blocked cells. Each cell counts the solids that cover its centre.
#[derive(Debug, Clone)]
pub(crate) struct Raster {
    low: Point,
    cell_m: f64,
    columns: usize,
    covers: Vec<u16>,
}

impl Raster {
    /// Creates the floor within a wall, keeping `keep_m` from it, with this many cells along the longer side.
    pub(crate) fn new(boundary: &Boundary, keep_m: f64, cells: usize) -> Self {
        let (low, high) = boundary.bounds();
        let extent = high - low;
        let cell_m = (extent.max() / cells as f64).max(1e-6);
        let columns = (extent.x / cell_m).ceil() as usize + 2;
        let rows = (extent.y / cell_m).ceil() as usize + 2;
        let low = low - Vector::new(cell_m, cell_m);
        let mut raster = Self { low, cell_m, columns, covers: vec![1; columns * rows] };
        raster.open(boundary, keep_m);
        raster
    }

    /// The edge length of a cell, metres.
    pub(crate) fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// The number of cells along x, including the frame.
    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    /// Which cells are blocked.
    pub(crate) fn blocked(&self) -> impl Iterator<Item = bool> + '_ {
        self.covers.iter().map(|covers| *covers > 0)
    }

    /// The centre of a cell.
    pub(crate) fn center(&self, cell: usize) -> Point {
        let (column, row) = (cell % self.columns, cell / self.columns);
        self.low + Vector::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell_m
    }

    /// The cell that contains a point. A point outside the floor maps to a cell at the edge.
    pub(crate) fn cell_at(&self, at: Point) -> usize {
        let (column, row) = (self.column(at.x), self.row(at.y));
        row * self.columns + column
    }

    /// The free cells within this many cells of a point, with their distances, metres.
    pub(crate) fn free_near(&self, at: Point, reach: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (column, row) = (self.column(at.x), self.row(at.y));
        let n_rows = self.covers.len() / self.columns;
        let rows = row.saturating_sub(reach)..=(row + reach).min(n_rows - 1);
        let cells = rows.flat_map(move |row| {
            let columns = column.saturating_sub(reach)..=(column + reach).min(self.columns - 1);
            columns.map(move |column| row * self.columns + column)
        });
        let free = cells.filter(|cell| self.covers[*cell] == 0);
        free.map(move |cell| (cell, (self.center(cell) - at).norm()))
    }

    /// Adds a solid to the floor, and collects the cells that it alone blocks.
    pub(crate) fn cover(&mut self, grown: &GrownShape, blocked: &mut Vec<usize>) {
        self.visit(grown, |cell, covers| {
            *covers += 1;
            if *covers == 1 {
                blocked.push(cell);
            }
        });
    }

    /// Removes a solid from the floor, and collects the cells that become free.
    pub(crate) fn uncover(&mut self, grown: &GrownShape, freed: &mut Vec<usize>) {
        self.visit(grown, |cell, covers| {
            *covers -= 1;
            if *covers == 0 {
                freed.push(cell);
            }
        });
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.low.x) / self.cell_m) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.low.y) / self.cell_m) as usize).min(self.covers.len() / self.columns - 1)
    }

    /// Frees the cells inside the wall.
    fn open(&mut self, boundary: &Boundary, keep_m: f64) {
        for row in 1..self.covers.len() / self.columns - 1 {
            let y = self.center(row * self.columns).y;
            let inside = match boundary {
                Boundary::Circle { radius_m } => {
                    chord(Point::origin(), radius_m - keep_m, y).into_iter().collect()
                }
                Boundary::Polygon { vertices } => crossings(vertices, y),
            };
            for (from, to) in inside {
                for cell in self.cells(row, from, to) {
                    self.covers[cell] = 0;
                }
            }
        }
        if let Boundary::Polygon { vertices } = boundary {
            for (a, b) in edges(vertices) {
                let shape = Shape::Polyline { points: vec![a, b], half_width_m: 0.0 };
                self.cover(&GrownShape { shape, keep_m }, &mut Vec::new());
            }
        }
    }

    /// The cells of a row whose centres lie between two positions.
    fn cells(&self, row: usize, from: f64, to: f64) -> std::ops::Range<usize> {
        let column = |x: f64| ((x - self.low.x) / self.cell_m - 0.5).ceil().max(0.0) as usize;
        let last = self.columns - 1;
        row * self.columns + column(from).clamp(1, last)..row * self.columns + column(to).clamp(1, last)
    }

    /// Calls `change` for every cell whose centre is covered by a solid.
    ///
    /// Walls are treated as at least one cell thick. Otherwise a path along the cells could cross a wall.
    fn visit(&mut self, grown: &GrownShape, mut change: impl FnMut(usize, &mut u16)) {
        let thick_m = |half_width_m: f64| (half_width_m + grown.keep_m).max(0.5001 * self.cell_m);
        let parts: Vec<(Point, Point, f64)> = match &grown.shape {
            Shape::Disc { center, radius_m } => vec![(*center, *center, radius_m + grown.keep_m)],
            Shape::Polyline { points, half_width_m } if points.len() == 1 => {
                vec![(points[0], points[0], half_width_m + grown.keep_m)]
            }
            Shape::Polyline { points, half_width_m } => {
                points.windows(2).map(|w| (w[0], w[1], thick_m(*half_width_m))).collect()
            }
            Shape::Polygon { vertices } => edges(vertices).map(|(a, b)| (a, b, thick_m(0.0))).collect(),
        };
        let is_filled = matches!(grown.shape, Shape::Polygon { .. });
        let low_y = parts.iter().map(|(a, b, r)| a.y.min(b.y) - r).fold(f64::INFINITY, f64::min);
        let high_y = parts.iter().map(|(a, b, r)| a.y.max(b.y) + r).fold(f64::NEG_INFINITY, f64::max);
        for row in self.row(low_y)..=self.row(high_y) {
            let y = self.center(row * self.columns).y;
            let mut spans: Vec<(f64, f64)> =
                parts.iter().filter_map(|(a, b, r)| bar_chord(*a, *b, *r, y)).collect();
            if is_filled {
                let whole = spans.iter().copied().reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
                spans = whole.into_iter().collect();
            }
            spans.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut done = 0;
            for (from, to) in spans {
                let cells = self.cells(row, from, to);
                for cell in cells.start.max(done)..cells.end {
                    change(cell, &mut self.covers[cell]);
                }
                done = done.max(cells.end);
            }
        }
    }
}

/// The part of a horizontal line inside a disc.
fn chord(center: Point, radius_m: f64, y: f64) -> Option<(f64, f64)> {
    let half_squared = radius_m * radius_m - (y - center.y) * (y - center.y);
    (radius_m > 0.0 && half_squared >= 0.0)
        .then(|| (center.x - half_squared.sqrt(), center.x + half_squared.sqrt()))
}

/// The part of a horizontal line within a radius of a segment.
fn bar_chord(a: Point, b: Point, radius_m: f64, y: f64) -> Option<(f64, f64)> {
    let ends = [chord(a, radius_m, y), chord(b, radius_m, y)];
    let sides = (b - a).try_normalize(0.0).map(|along| {
        let aside = Vector::new(-along.y, along.x) * radius_m;
        let corners = [a + aside, b + aside, b - aside, a - aside];
        crossings(&corners, y)
    });
    let all = ends.into_iter().flatten().chain(sides.into_iter().flatten());
    all.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// The parts of a horizontal line inside a simple polygon.
fn crossings(vertices: &[Point], y: f64) -> Vec<(f64, f64)> {
    let crossed = edges(vertices).filter(|(a, b)| (a.y > y) != (b.y > y));
    let mut xs: Vec<f64> = crossed.map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)).collect();
    xs.sort_by(f64::total_cmp);
    xs.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn shape() -> impl Strategy<Value = Shape> {
        let at = || (-4.0..4.0_f64, -4.0..4.0_f64).prop_map(|(x, y)| Point::new(x, y));
        prop_oneof![
            (at(), 0.0..2.0_f64).prop_map(|(center, radius_m)| Shape::Disc { center, radius_m }),
            (at(), at(), at(), 0.0..0.5_f64)
                .prop_map(|(a, b, c, half_width_m)| Shape::Polyline { points: vec![a, b, c], half_width_m }),
            (at(), 0.3..1.5_f64, 0.0..6.0_f64).prop_map(|(center, size, turn)| {
                let corner = |k: u32| {
                    let bearing = turn + f64::from(k) * std::f64::consts::FRAC_PI_2;
                    center + Vector::new(bearing.cos(), bearing.sin()) * size
                };
                Shape::Polygon { vertices: (0..4).map(corner).collect() }
            }),
        ]
    }

    proptest! {
        #[test]
        fn a_cell_is_blocked_exactly_if_its_middle_is_too_near(shape in shape(), keep_m in 0.1..0.6_f64) {
            let mut raster = Raster::new(&Boundary::Circle { radius_m: 5.0 }, keep_m, 60);
            let grown = GrownShape { shape, keep_m };
            let mut changed = Vec::new();
            let before: Vec<bool> = raster.blocked().collect();
            raster.cover(&grown, &mut changed);
            for (cell, blocked) in raster.blocked().enumerate() {
                let at = raster.center(cell);
                let spare_m = (5.0 - at.coords.norm()).min(grown.shape.distance_m(at)) - keep_m;
                prop_assert!(spare_m.abs() < 1e-9 || blocked == (spare_m < 0.0), "{at} {spare_m}");
            }
            let mut freed = Vec::new();
            raster.uncover(&grown, &mut freed);
            prop_assert_eq!(changed, freed);
            prop_assert_eq!(before, raster.blocked().collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_frame_and_the_outside_of_a_straight_wall_are_blocked() {
        let corner = |x: f64, y: f64| Point::new(x, y);
        let vertices = vec![corner(0.0, 0.0), corner(4.0, 0.0), corner(4.0, 2.0), corner(0.0, 2.0)];
        let raster = Raster::new(&Boundary::Polygon { vertices }, 0.5, 40);
        let free = raster.blocked().filter(|blocked| !blocked).count();
        assert_eq!((raster.columns(), free), (42, 30 * 10));
    }
}
