//! Sealed regions: floor that cuts separate from the rest.

use super::case::Case;
use crate::coverage::neighbours;
use geometry::{Boundary, Point, Vector};
use std::ops::Range;

/// The smallest edge length of a cell, metres.
const CELL_M: f64 = 0.05;
/// The largest number of cells along one side.
const MOST_CELLS: f64 = 1000.0;
/// Area below which a region is an artefact of the grid, square metres.
const LEAST_M2: f64 = 0.05;

/// All sealed regions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SealedRegions {
    /// The total area of the regions, square metres.
    pub area_m2: f64,
    /// A point in the largest region.
    pub at: Point,
}

/// Finds floor that the hull can reach without the cuts, but not with them.
///
/// The flood fill starts from the anchor and from the path, so the floor along a path that crosses no cut is never
/// sealed. Cuts are not cells. They block the step between the centres of two neighbours, so they do not reduce the
/// floor.
///
/// A passage narrower than a cell can look closed, so apparently sealed floor is checked again with finer cells.
pub(super) fn sealed_regions(case: &Case<'_>) -> Option<SealedRegions> {
    let (low, high) = case.boundary.bounds();
    let cell_m = CELL_M.max((high - low).max() / MOST_CELLS);
    let mut sealed = sealed_in(case, &Grid::new(case, cell_m))?;
    for finer in [2.0, 4.0] {
        sealed = sealed_in(case, &Grid::new(case, cell_m / finer))?;
    }
    Some(sealed)
}

fn sealed_in(case: &Case<'_>, grid: &Grid) -> Option<SealedRegions> {
    let walls = grid.walls(case.cuts);
    let seeds = std::iter::once(&case.anchor).chain(case.path).filter_map(|point| grid.cell(*point));
    let mut seen = vec![false; grid.free.len()];
    grid.flood(&mut seen, seeds.collect(), &walls);
    // Cells that were not reached but lie next to reached cells are behind a cut, and so are their own neighbours.
    let rim = |cell: &usize| grid.is_new(&seen, *cell) && grid.neighbours(*cell).any(|other| seen[other]);
    let mut behind: Vec<usize> = (0..seen.len()).filter(rim).collect();
    behind.reverse();
    let mut all = SealedRegions { area_m2: 0.0, at: case.anchor };
    let mut largest = 0;
    while let Some(cell) = behind.pop() {
        if seen[cell] {
            continue;
        }
        let region = grid.flood(&mut seen, vec![cell], &walls);
        let count: usize = region.iter().map(Range::len).sum();
        let area_m2 = count as f64 * grid.cell_m * grid.cell_m;
        let more = region.iter().cloned().flatten().flat_map(|cell| grid.neighbours(cell));
        behind.extend(more.filter(|other| grid.is_new(&seen, *other)));
        if area_m2 >= LEAST_M2 {
            all.area_m2 += area_m2;
            if count > largest {
                (largest, all.at) = (count, grid.center(cell));
            }
        }
    }
    (all.area_m2 > 0.0).then_some(all)
}

/// The steps between neighbouring cells that cross a cut.
struct Walls {
    /// For every cell, whether the step to the eastern neighbour crosses a cut.
    east: Vec<bool>,
    /// For every cell, whether the step to the northern neighbour crosses a cut.
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
                grid.free[cell] &= obstacle.shape.distance_m(grid.center(cell)) >= case.room_m;
            }
        }
        grid
    }

    /// Marks the cells in a row that are far enough from the wall.
    fn clear_row(&mut self, row: usize, case: &Case<'_>) {
        let cells = row * self.width..(row + 1) * self.width;
        let Boundary::Circle { radius_m } = case.boundary else {
            for cell in cells {
                self.free[cell] = case.boundary.wall_distance_m(self.center(cell)) >= case.room_m;
            }
            return;
        };
        let (reach_m, y) = (radius_m - case.room_m, self.center(cells.start).y);
        if reach_m > y.abs() {
            let half_m = (reach_m * reach_m - y * y).sqrt();
            let column = |x: f64| ((x - self.low.x) / self.cell_m - 0.5).max(0.0);
            let (first, last) = (column(-half_m).ceil() as usize, column(half_m).floor() as usize);
            self.free[cells.start + first..(cells.start + last + 1).min(cells.end)].fill(true);
        }
    }

    fn neighbours(&self, cell: usize) -> impl Iterator<Item = usize> + use<> {
        neighbours(cell, self.width, self.free.len())
    }

    fn center(&self, cell: usize) -> Point {
        let (column, row) = ((cell % self.width) as f64, (cell / self.width) as f64);
        Point::new(self.low.x + (column + 0.5) * self.cell_m, self.low.y + (row + 0.5) * self.cell_m)
    }

    /// Returns the column and row of the cell that contains a point, or of the nearest cell.
    fn place(&self, point: Point) -> (usize, usize) {
        let at = (point - self.low) / self.cell_m;
        ((at.x.max(0.0) as usize).min(self.width - 1), (at.y.max(0.0) as usize).min(self.height - 1))
    }

    fn cell(&self, point: Point) -> Option<usize> {
        let (column, row) = self.place(point);
        Some(row * self.width + column).filter(|cell| self.free[*cell])
    }

    /// Finds the steps between neighbouring cells that cross a cut.
    fn walls(&self, cuts: &[Vec<Point>]) -> Walls {
        let mut east = vec![false; self.free.len()];
        let mut north = east.clone();
        for pair in cuts.iter().flat_map(|cut| cut.windows(2)) {
            // In units of cells, so that the centres of cells lie at whole numbers.
            let to_cells = |p: Point| (p - self.low) / self.cell_m - Vector::new(0.5, 0.5);
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

    /// Marks the cells that can be reached from some cells without crossing a cut; returns the newly marked cells, in
    /// runs within a row.
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

    /// Adds the northern or southern neighbours of a run from which the filling continues: the first cell of each
    /// stretch.
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

/// Returns the grid lines that a segment crosses: each whole number below `count` between `from` and `to`, with the
/// other coordinate of the segment there, rounded down.
fn steps_crossed(
    from: f64,
    to: f64,
    other_from: f64,
    other_to: f64,
    count: usize,
) -> impl Iterator<Item = (i64, i64)> {
    // A line may start very far away.
    let line = |m: f64| m.ceil().clamp(0.0, count as f64) as i64;
    (line(from.min(to))..line(from.max(to))).map(move |line| {
        let share = (line as f64 - from) / (to - from);
        (line, (other_from + (other_to - other_from) * share).floor() as i64)
    })
}
