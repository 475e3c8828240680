//! Pockets: floor that cuts seal off.

use super::certificate::Case;
use crate::{Boundary, geometry::Point};
use std::ops::Range;

/// Smallest edge of a cell, metres, and most cells along one side.
const CELL_M: f64 = 0.05;
const MOST_CELLS: f64 = 1000.0;
/// Pockets smaller than this are slivers of the grid, square metres.
const LEAST_M2: f64 = 0.05;

/// The largest sealed pocket and the area of all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sealed {
    pub area_m2: f64,
    pub at: Point,
}

/// Floor that the hull reaches without the cuts and not with them.
///
/// Flood fill from the anchor and from the path: where a path that crosses no cut has been, nothing is sealed. Cuts are
/// no cells but block the step between the middles of two neighbours, so they take no floor away.
///
/// A gate narrower than a cell can look shut: what seems to be sealed is looked at again with finer cells.
pub(super) fn sealed(case: &Case<'_>) -> Option<Sealed> {
    let (low, high) = case.boundary.bounds();
    let cell_m = CELL_M.max((high - low).max() / MOST_CELLS);
    let mut sealed = sealed_in(case, &Grid::new(case, cell_m))?;
    for finer in [2.0, 4.0] {
        sealed = sealed_in(case, &Grid::new(case, cell_m / finer))?;
    }
    Some(sealed)
}

fn sealed_in(case: &Case<'_>, grid: &Grid) -> Option<Sealed> {
    let walls = grid.walls(case.cuts);
    let seeds = std::iter::once(&case.anchor).chain(case.path).filter_map(|point| grid.cell(*point));
    let mut seen = vec![false; grid.free.len()];
    grid.flood(&mut seen, seeds.collect(), &walls);
    let is_shut = |cell: usize, seen: &[bool]| grid.free[cell] && !seen[cell];
    // What is left and lies beside what was reached lies behind a cut, and so does what lies beside that.
    let rim = |cell: &usize| is_shut(*cell, &seen) && grid.beside(*cell).any(|other| seen[other]);
    let mut behind: Vec<usize> = (0..seen.len()).filter(rim).collect();
    behind.reverse();
    let mut all = Sealed { area_m2: 0.0, at: case.anchor };
    let mut largest = 0;
    while let Some(cell) = behind.pop() {
        if seen[cell] {
            continue;
        }
        let pocket = grid.flood(&mut seen, vec![cell], &walls);
        let count: usize = pocket.iter().map(Range::len).sum();
        let area_m2 = count as f64 * grid.cell_m * grid.cell_m;
        let more = pocket.iter().cloned().flatten().flat_map(|cell| grid.beside(cell));
        behind.extend(more.filter(|other| is_shut(*other, &seen)));
        if area_m2 >= LEAST_M2 {
            all.area_m2 += area_m2;
            if count > largest {
                (largest, all.at) = (count, grid.middle(cell));
            }
        }
    }
    (all.area_m2 > 0.0).then_some(all)
}

/// Steps between neighbours that cross a cut.
struct Walls {
    /// To the eastern neighbour, for every cell.
    east: Vec<bool>,
    /// To the northern neighbour.
    north: Vec<bool>,
}

struct Grid {
    low: Point,
    cell_m: f64,
    width: usize,
    height: usize,
    free: Vec<bool>,
}

impl Grid {
    fn new(case: &Case<'_>, cell_m: f64) -> Self {
        let (low, high) = case.boundary.bounds();
        let extent = high - low;
        let count = |size_m: f64| (size_m / cell_m).ceil().max(1.0) as usize;
        let (width, height) = (count(extent.x), count(extent.y));
        let mut grid = Self { low, cell_m, width, height, free: vec![false; width * height] };
        for row in 0..height {
            grid.clear_row(row, case);
        }
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

    /// Marks what the wall leaves free of a row.
    fn clear_row(&mut self, row: usize, case: &Case<'_>) {
        let cells = row * self.width..(row + 1) * self.width;
        let Boundary::Circle { radius_m } = case.boundary else {
            for cell in cells {
                self.free[cell] = case.boundary.wall_distance_m(self.middle(cell)) >= case.room_m;
            }
            return;
        };
        let (reach_m, y) = (radius_m - case.room_m, self.middle(cells.start).y);
        if reach_m > y.abs() {
            let half_m = (reach_m * reach_m - y * y).sqrt();
            let column = |x: f64| ((x - self.low.x) / self.cell_m - 0.5).max(0.0);
            let (first, last) = (column(-half_m).ceil() as usize, column(half_m).floor() as usize);
            self.free[cells.start + first..(cells.start + last + 1).min(cells.end)].fill(true);
        }
    }

    /// The four neighbours of a cell, as far as there are such.
    fn beside(&self, cell: usize) -> impl Iterator<Item = usize> + use<> {
        let (column, width, end) = (cell % self.width, self.width, self.free.len());
        let west = (column > 0).then(|| cell - 1);
        let east = (column + 1 < width).then_some(cell + 1);
        let (south, north) = (cell.checked_sub(width), Some(cell + width).filter(|cell| *cell < end));
        [west, east, south, north].into_iter().flatten()
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

    /// Which steps cross a cut.
    fn walls(&self, cuts: &[Vec<Point>]) -> Walls {
        let mut east = vec![false; self.free.len()];
        let mut north = east.clone();
        for pair in cuts.iter().flat_map(|cut| cut.windows(2)) {
            // In units of cells, with the middles of cells at whole numbers.
            let to_cells = |p: Point| (p - self.low) / self.cell_m - geometry::Vector::new(0.5, 0.5);
            let (a, b) = (to_cells(pair[0]), to_cells(pair[1]));
            for (row, column) in steps_crossed(a.y, b.y, a.x, b.x, self.height) {
                self.block(&mut east, column, row);
            }
            for (column, row) in steps_crossed(a.x, b.x, a.y, b.y, self.width) {
                self.block(&mut north, column, row);
            }
        }
        Walls { east, north }
    }

    fn block(&self, steps: &mut [bool], column: i64, row: i64) {
        if (0..self.width as i64).contains(&column) && (0..self.height as i64).contains(&row) {
            steps[row as usize * self.width + column as usize] = true;
        }
    }

    /// Marks what can be reached from some cells without crossing a cut, and gives what is new, in runs of one row.
    fn flood(&self, seen: &mut [bool], mut todo: Vec<usize>, walls: &Walls) -> Vec<Range<usize>> {
        let mut runs = Vec::new();
        while let Some(cell) = todo.pop() {
            if !self.is_new(seen, cell) {
                continue;
            }
            let row = cell / self.width * self.width..(cell / self.width + 1) * self.width;
            let (mut low, mut high) = (cell, cell + 1);
            while low > row.start && self.is_new(seen, low - 1) && !walls.east[low - 1] {
                low -= 1;
            }
            while high < row.end && self.is_new(seen, high) && !walls.east[high - 1] {
                high += 1;
            }
            seen[low..high].fill(true);
            if row.start > 0 {
                self.step_over(low..high, false, seen, walls, &mut todo);
            }
            if row.end < self.free.len() {
                self.step_over(low..high, true, seen, walls, &mut todo);
            }
            runs.push(low..high);
        }
        runs
    }

    /// The northern or southern neighbours of a run to go on from: the first of each stretch.
    fn step_over(
        &self,
        run: Range<usize>,
        is_north: bool,
        seen: &[bool],
        walls: &Walls,
        todo: &mut Vec<usize>,
    ) {
        let mut is_joined = false;
        for cell in run {
            let other = if is_north { cell + self.width } else { cell - self.width };
            let is_open = !walls.north[cell.min(other)] && self.is_new(seen, other);
            if is_open && (!is_joined || walls.east[other - 1]) {
                todo.push(other);
            }
            is_joined = is_open;
        }
    }

    fn is_new(&self, seen: &[bool], cell: usize) -> bool {
        self.free[cell] && !seen[cell]
    }
}

/// The whole numbers below `count` between `from` and `to`, each with the whole number below the line's other coordinate
/// there.
fn steps_crossed(
    from: f64,
    to: f64,
    other_from: f64,
    other_to: f64,
    count: usize,
) -> impl Iterator<Item = (i64, i64)> {
    // A line may come from very far away.
    let line = |m: f64| m.ceil().clamp(0.0, count as f64) as i64;
    (line(from.min(to))..line(from.max(to))).map(move |line| {
        let share = (line as f64 - from) / (to - from);
        (line, (other_from + (other_to - other_from) * share).floor() as i64)
    })
}
