//! Pockets: floor that cuts seal off.

use super::certificate::Case;
use crate::geometry::Point;

/// Smallest edge of a cell, metres, and most cells along one side.
const CELL_M: f64 = 0.05;
const MOST_CELLS: f64 = 1000.0;
/// Pockets smaller than this are slivers of the grid, square metres.
const LEAST_M2: f64 = 0.05;

/// The largest sealed pocket and the area of all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sealed {
    pub area_m2: f64,
    pub at: Point,
}

/// Floor that the hull reaches without the cuts and not with them.
///
/// Flood fill from the anchor and from the path: where a path that crosses no cut has been, nothing is sealed. Cuts are
/// no cells but block the step between the middles of two neighbours, so they take no floor away.
pub fn sealed(case: &Case<'_>) -> Option<Sealed> {
    let grid = Grid::new(case);
    let seeds: Vec<usize> =
        std::iter::once(&case.anchor).chain(case.path).filter_map(|point| grid.cell(*point)).collect();
    let open = grid.flood(&seeds, |_, _| false);
    let (east, north) = grid.walls(case.cuts);
    let blocked = |cell: usize, is_east: bool| if is_east { east[cell] } else { north[cell] };
    let mut seen = grid.flood(&seeds, blocked);
    let mut all = Sealed { area_m2: 0.0, at: case.anchor };
    let mut largest = 0;
    for cell in 0..open.len() {
        if open[cell] && !seen[cell] {
            let pocket = grid.flood_into(&mut seen, &[cell], blocked);
            let area_m2 = pocket as f64 * grid.cell_m * grid.cell_m;
            if area_m2 >= LEAST_M2 {
                all.area_m2 += area_m2;
                (largest, all.at) =
                    if pocket > largest { (pocket, grid.middle(cell)) } else { (largest, all.at) };
            }
        }
    }
    (all.area_m2 > 0.0).then_some(all)
}

struct Grid {
    low: Point,
    cell_m: f64,
    width: usize,
    height: usize,
    free: Vec<bool>,
}

impl Grid {
    fn new(case: &Case<'_>) -> Self {
        let (low, high) = case.boundary.bounds();
        let extent = high - low;
        let cell_m = CELL_M.max(extent.max() / MOST_CELLS);
        let count = |size_m: f64| (size_m / cell_m).ceil().max(1.0) as usize;
        let (width, height) = (count(extent.x), count(extent.y));
        let mut grid = Self { low, cell_m, width, height, free: Vec::new() };
        grid.free = (0..width * height)
            .map(|c| case.boundary.wall_distance_m(grid.middle(c)) >= case.room_m)
            .collect();
        for obstacle in case.obstacles {
            let (from, to) = obstacle.shape.bounds();
            let (i, j) = grid.place(from.map(|v| v - case.room_m));
            let (k, l) = grid.place(to.map(|v| v + case.room_m));
            for cell in (j..=l).flat_map(|row| (i..=k).map(move |column| row * width + column)) {
                grid.free[cell] &= obstacle.shape.distance_m(grid.middle(cell)) >= case.room_m;
            }
        }
        grid
    }

    fn middle(&self, cell: usize) -> Point {
        let (column, row) = ((cell % self.width) as f64, (cell / self.width) as f64);
        Point::new(self.low.x + (column + 0.5) * self.cell_m, self.low.y + (row + 0.5) * self.cell_m)
    }

    /// Column and row of the cell that holds a point, or of the nearest one.
    fn place(&self, point: Point) -> (usize, usize) {
        let at = (point - self.low) / self.cell_m;
        ((at.x.max(0.0) as usize).min(self.width - 1), (at.y.max(0.0) as usize).min(self.height - 1))
    }

    fn cell(&self, point: Point) -> Option<usize> {
        let (column, row) = self.place(point);
        Some(row * self.width + column).filter(|cell| self.free[*cell])
    }

    /// Which steps to the eastern and to the northern neighbour cross a cut.
    fn walls(&self, cuts: &[Vec<Point>]) -> (Vec<bool>, Vec<bool>) {
        let mut east = vec![false; self.free.len()];
        let mut north = east.clone();
        for pair in cuts.iter().flat_map(|cut| cut.windows(2)) {
            // In units of cells, with the middles of cells at whole numbers.
            let to_cells = |p: Point| (p - self.low) / self.cell_m - crate::geometry::Vector::new(0.5, 0.5);
            let (a, b) = (to_cells(pair[0]), to_cells(pair[1]));
            for (column, row) in steps_crossed(a.y, b.y, a.x, b.x).map(|(row, column)| (column, row)) {
                self.block(&mut east, column, row);
            }
            for (column, row) in steps_crossed(a.x, b.x, a.y, b.y) {
                self.block(&mut north, column, row);
            }
        }
        (east, north)
    }

    fn block(&self, steps: &mut [bool], column: i64, row: i64) {
        if (0..self.width as i64).contains(&column) && (0..self.height as i64).contains(&row) {
            steps[row as usize * self.width + column as usize] = true;
        }
    }

    fn flood(&self, seeds: &[usize], blocked: impl Fn(usize, bool) -> bool) -> Vec<bool> {
        let mut seen = vec![false; self.free.len()];
        self.flood_into(&mut seen, seeds, blocked);
        seen
    }

    /// Marks what can be reached from some cells; tells how many cells are new.
    fn flood_into(&self, seen: &mut [bool], seeds: &[usize], blocked: impl Fn(usize, bool) -> bool) -> usize {
        let mut todo: Vec<usize> = Vec::new();
        let mut count = 0;
        let mut visit = |cell: usize, todo: &mut Vec<usize>, seen: &mut [bool]| {
            if self.free[cell] && !seen[cell] {
                seen[cell] = true;
                count += 1;
                todo.push(cell);
            }
        };
        for seed in seeds {
            visit(*seed, &mut todo, seen);
        }
        while let Some(cell) = todo.pop() {
            let (column, row) = (cell % self.width, cell / self.width);
            if column + 1 < self.width && !blocked(cell, true) {
                visit(cell + 1, &mut todo, seen);
            }
            if column > 0 && !blocked(cell - 1, true) {
                visit(cell - 1, &mut todo, seen);
            }
            if row + 1 < self.height && !blocked(cell, false) {
                visit(cell + self.width, &mut todo, seen);
            }
            if row > 0 && !blocked(cell - self.width, false) {
                visit(cell - self.width, &mut todo, seen);
            }
        }
        count
    }
}

/// The whole numbers between `from` and `to`, each with the whole number below the line's other coordinate there.
fn steps_crossed(from: f64, to: f64, other_from: f64, other_to: f64) -> impl Iterator<Item = (i64, i64)> {
    let (low, high) = (from.min(to).ceil() as i64, from.max(to).ceil() as i64);
    (low..high).map(move |line| {
        let share = (line as f64 - from) / (to - from);
        (line, (other_from + (other_to - other_from) * share).floor() as i64)
    })
}
