//! Rows of square cells over the floor.
//!
//! The rows are rotated relative to the tank's axes. In rows parallel to a straight wall, no centre would lie in the
//! strip along the wall that is half a cell wide. A planner that shortens paths without losing cells would then keep
//! half a cell farther from that wall.

use crate::plane::{direction, extent, left_of};
use std::ops::Range;
use world::{Boundary, Point, Vector, polyline::edges, shape::bounds_of};

/// Direction of the rows, radians from east: unlike the direction of any usual wall or lane.
const ROWS_RAD: f64 = 0.3;
/// A second such direction. A path fitted to cells appears to sweep more of them than it does; other cells show what it
/// really sweeps.
const OTHER_ROWS_RAD: f64 = 0.9;
/// Number of corners of the largest polygon that can be filled: a fan of wedges over half a turn, and its centre.
pub(super) const MOST_CORNERS: usize = 11;
/// Number of rows of a polygon that are filled together.
const BAND: usize = 32;
/// Amount added to the last position of a closed range to find the index after it.
const NEXT: f64 = 1e-9;

/// Size of the cells and direction of their rows.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Grain {
    cell_m: f64,
    rows_rad: f64,
}

impl Grain {
    /// Cells with this edge length, metres.
    pub(crate) fn of(cell_m: f64) -> Self {
        Self { cell_m, rows_rad: ROWS_RAD }
    }

    /// Cells of the same size in rows of the second direction.
    pub(crate) fn other(cell_m: f64) -> Self {
        Self { cell_m, rows_rad: OTHER_ROWS_RAD }
    }
}

/// The grid of cells over a floor, and the bar that sweeps them.
#[derive(Clone, Copy)]
pub(crate) struct Raster {
    /// Unit vector along the rows.
    ahead: Vector,
    /// Start of the first cell of the first row, along and across the rows, metres.
    low: Point,
    /// Edge length of a cell, metres.
    pub cell_m: f64,
    columns: usize,
    rows: usize,
    /// Width of the bar that sweeps the cells, metres.
    pub bar_m: f64,
}

impl Raster {
    /// Creates cells over the area inside a wall.
    pub(super) fn over(wall: &Boundary, Grain { cell_m, rows_rad }: Grain, bar_m: f64) -> Self {
        let ahead = direction(rows_rad);
        let (low, high) = match wall {
            Boundary::Circle { .. } => wall.bounds(),
            Boundary::Polygon { vertices } => {
                let turned = vertices.iter().map(|v| along_and_across(ahead, *v));
                bounds_of(&turned.collect::<Vec<_>>())
            }
        };
        let count = |span_m: f64| (span_m / cell_m).ceil().max(1.0) as usize;
        Self { ahead, low, cell_m, columns: count(high.x - low.x), rows: count(high.y - low.y), bar_m }
    }

    pub(super) fn len(&self) -> usize {
        self.columns * self.rows
    }

    pub(crate) fn cell_m2(&self) -> f64 {
        self.cell_m * self.cell_m
    }

    pub(crate) fn center(&self, cell: usize) -> Point {
        let (column, row) = (cell % self.columns, cell / self.columns);
        let here = self.low + Vector::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell_m;
        Point::from(self.ahead * here.x + left_of(self.ahead) * here.y)
    }

    pub(super) fn cell_at(&self, at: Point) -> Option<usize> {
        let here = (along_and_across(self.ahead, at) - self.low) / self.cell_m;
        let (x, y) = (here.x, here.y);
        let is_inside = x >= 0.0 && y >= 0.0 && x < self.columns as f64 && y < self.rows as f64;
        is_inside.then(|| y as usize * self.columns + x as usize)
    }

    /// The neighbours of a cell, those across its edges first; `None` beyond the raster.
    pub(super) fn neighbours(&self, cell: usize) -> impl Iterator<Item = Option<usize>> {
        const STEPS: [(isize, isize); 8] =
            [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, 1), (-1, 1), (1, -1)];
        let (columns, rows) = (self.columns, self.rows);
        STEPS.into_iter().map(move |(dx, dy)| {
            let column = (cell % columns).checked_add_signed(dx).filter(|column| *column < columns)?;
            let row = (cell / columns).checked_add_signed(dy).filter(|row| *row < rows)?;
            Some(row * columns + column)
        })
    }

    /// The selected cells that have at least one unselected edge neighbour, in order.
    pub(super) fn rim(&self, is_meant: &[bool]) -> Vec<usize> {
        let (columns, last) = (self.columns, self.columns - 1);
        let rows: Vec<&[bool]> = is_meant.chunks_exact(columns).collect();
        let mut rim = Vec::new();
        for (row, cells) in rows.iter().enumerate() {
            let beside = [row.checked_sub(1), Some(row + 1)].map(|row| rows.get(row?));
            for column in (0..columns).filter(|column| cells[*column]) {
                let is_inside = column > 0 && column < last && cells[column - 1] && cells[column + 1];
                if !(is_inside && beside.iter().all(|row| row.is_some_and(|row| row[column]))) {
                    rim.push(row * columns + column);
                }
            }
        }
        rim
    }

    /// Groups of neighbouring selected cells, largest first.
    pub(crate) fn groups(&self, is_meant: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let mut open: Vec<bool> = (0..self.len()).map(is_meant).collect();
        let mut groups = Vec::new();
        for first in 0..open.len() {
            if !std::mem::replace(&mut open[first], false) {
                continue;
            }
            let mut group = vec![first];
            let mut next = 0;
            while let Some(cell) = group.get(next).copied() {
                next += 1;
                let around = self.neighbours(cell).flatten();
                group.extend(around.filter(|other| std::mem::replace(&mut open[*other], false)));
            }
            groups.push(group);
        }
        groups.sort_by_key(|group| std::cmp::Reverse(group.len()));
        groups
    }

    /// The selected cells whose centres are within a distance of a position, with their centres.
    pub(super) fn near(
        &self,
        place: Point,
        reach_m: f64,
        is_meant: impl Fn(usize) -> bool,
    ) -> impl Iterator<Item = (usize, Point)> {
        let reach = Vector::new(reach_m, reach_m);
        let here = along_and_across(self.ahead, place);
        let (from, to) = (here - reach - self.low, here + reach - self.low);
        let index = |m: f64, n: usize| (m / self.cell_m).floor().clamp(0.0, n as f64 - 1.0) as usize;
        let columns = index(from.x, self.columns)..=index(to.x, self.columns);
        let rows = index(from.y, self.rows)..=index(to.y, self.rows);
        let cells = rows.flat_map(move |row| columns.clone().map(move |column| row * self.columns + column));
        let centers = cells.filter(move |cell| is_meant(*cell)).map(|cell| (cell, self.center(cell)));
        centers.filter(move |(_, at)| (at - place).norm() <= reach_m)
    }

    /// Every cell whose centre is inside a convex polygon of at most [`MOST_CORNERS`] corners, in either orientation,
    /// in runs of one row each.
    pub(super) fn fill(&self, polygon: &[Point], mut visit: impl FnMut(Range<usize>)) {
        let mut turned = [Point::origin(); MOST_CORNERS];
        for (turned, corner) in turned.iter_mut().zip(polygon) {
            *turned = along_and_across(self.ahead, *corner);
        }
        let polygon = &turned[..polygon.len()];
        let low = polygon.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let high = polygon.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let row_of = |y: f64| (y - self.low.y) / self.cell_m - 0.5;
        let rows = index_from(row_of(low))..index_from(row_of(high) + NEXT).min(self.rows);
        if rows.is_empty() {
            return;
        }
        let mut corner_rows = [0; MOST_CORNERS];
        for (row, corner) in corner_rows.iter_mut().zip(polygon) {
            *row = self.row_from(corner.y, index_from(row_of(corner.y)), &rows);
        }
        // Filling a band of rows one side of the polygon at a time takes fewer branches than going through all sides
        // for each row.
        for start in rows.clone().step_by(BAND) {
            let band = start..rows.end.min(start + BAND);
            let spans = self.spans(polygon, &corner_rows, &band);
            for (row, (from, to)) in band.zip(spans).filter(|(_, (from, to))| from <= to) {
                self.fill_row(row, from, to, &mut visit);
            }
        }
    }

    /// Visits the cells in a row whose centres lie between two positions along it.
    fn fill_row(&self, row: usize, from: f64, to: f64, visit: &mut impl FnMut(Range<usize>)) {
        let column_of = |x: f64| (x - self.low.x) / self.cell_m - 0.5;
        let (left, past) = (index_from(column_of(from)), index_from(column_of(to) + NEXT).min(self.columns));
        if left < past {
            visit(row * self.columns + left..row * self.columns + past);
        }
    }

    /// Every cell whose centre is inside a closed polygon, convex or not, in runs of one row each.
    pub(super) fn fill_ring(&self, ring: &[Point], mut visit: impl FnMut(Range<usize>)) {
        let turned: Vec<Point> = ring.iter().map(|corner| along_and_across(self.ahead, *corner)).collect();
        let (low, high) = extent(turned.iter().map(|p| p.y));
        let row_of = |y: f64| (y - self.low.y) / self.cell_m - 0.5;
        for row in index_from(row_of(low))..index_from(row_of(high) + NEXT).min(self.rows) {
            let y = self.row_y(row);
            let crossing = |(a, b): (Point, Point)| {
                ((a.y > y) != (b.y > y)).then(|| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)))
            };
            let mut crossings: Vec<f64> = edges(&turned).filter_map(crossing).collect();
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                self.fill_row(row, pair[0], pair[1], &mut visit);
            }
        }
    }

    /// The positions where a convex polygon begins and ends in each row of a band. `corner_rows` contains, for each
    /// corner, the first row that is not below it.
    fn spans(
        &self,
        polygon: &[Point],
        corner_rows: &[usize; MOST_CORNERS],
        band: &Range<usize>,
    ) -> [(f64, f64); BAND] {
        let mut spans = [(f64::INFINITY, f64::NEG_INFINITY); BAND];
        let mut k = polygon.len() - 1;
        for next in 0..polygon.len() {
            let (a, b) = (polygon[k], polygon[next]);
            let (from, past) = (corner_rows[k].min(corner_rows[next]), corner_rows[k].max(corner_rows[next]));
            for row in from.max(band.start)..past.min(band.end) {
                let x = a.x + (b.x - a.x) * ((self.row_y(row) - a.y) / (b.y - a.y));
                let (from, to) = &mut spans[row - band.start];
                (*from, *to) = (if x < *from { x } else { *from }, if x > *to { x } else { *to });
            }
            k = next;
        }
        spans
    }

    /// The position of a row's centres, measured across the rows.
    fn row_y(&self, row: usize) -> f64 {
        self.low.y + (f64::from(row as u32) + 0.5) * self.cell_m
    }

    /// The first row of a range whose centres are not below `y`, or the end of the range. Corrects a first guess for
    /// rounding.
    fn row_from(&self, y: f64, guess: usize, rows: &Range<usize>) -> usize {
        let mut row = guess.clamp(rows.start, rows.end);
        while row > rows.start && self.row_y(row - 1) >= y {
            row -= 1;
        }
        while row < rows.end && self.row_y(row) < y {
            row += 1;
        }
        row
    }
}

/// The coordinates of a point along and across a direction.
fn along_and_across(ahead: Vector, at: Point) -> Point {
    Point::new(ahead.dot(&at.coords), ahead.perp(&at.coords))
}

/// The first index that is not below a position.
fn index_from(place: f64) -> usize {
    // Truncation is quicker than rounding up, and negative positions become 0.
    let below = (place as i64).max(0);
    (below + i64::from(place > below as f64)) as usize
}
