//! Which of the floor has been scanned, in square cells.

use crate::{geometry::Point, obstacles::ObstacleMap, polyline::nearest_on_segment, tank::World};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// What a cell of the floor is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// Not floor: outside the tank or inside an obstacle.
    Outside,
    /// Floor that the tool cannot reach.
    Unreachable,
    /// Floor that the tool can reach.
    Reachable,
}

/// The floor as a grid of square cells, row by row from the south west corner.
///
/// A cell is floor if its centre is. It is reachable if the swath covers its centre from some place to which the
/// robot's centre can drive from the start. Stored and written as runs of equal cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "FloorRuns", into = "FloorRuns")]
pub struct Floor {
    /// South west corner of cell 0, metres.
    pub origin: Point,
    /// Edge of a cell, metres.
    pub cell_m: f64,
    /// Cells from west to east.
    pub width: usize,
    /// Cells from south to north.
    pub height: usize,
    cells: Vec<Cell>,
}

/// Some cells of one row: index of the first and how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellRun(pub u32, pub u32);

/// How many cells of each kind there are and how many of them have been scanned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Cells of floor.
    pub floor: usize,
    /// Cells of floor that the tool can reach.
    pub reachable: usize,
    /// Cells of floor that have been scanned.
    pub covered: usize,
    /// Reachable cells that have been scanned.
    pub covered_reachable: usize,
}

impl Floor {
    /// The floor of a tank for a robot of some radius with a tool of some swath, driving from `start`.
    ///
    /// Costs one distance query per cell and a flood fill.
    pub fn new(world: &World, cell_m: f64, robot_radius_m: f64, swath_m: f64, start: Point) -> Self {
        let (low, high) = world.boundary.bounds();
        let count = |span_m: f64| (span_m / cell_m).ceil().max(1.0) as usize;
        let (width, height) = (count(high.x - low.x), count(high.y - low.y));
        let mut floor =
            Self { origin: low, cell_m, width, height, cells: vec![Cell::Outside; width * height] };
        let map = ObstacleMap::new(&world.boundary, &world.obstacles);
        let clearances: Vec<f64> =
            (0..width * height).map(|index| map.clearance_m(floor.center(index))).collect();
        for (cell, clearance) in floor.cells.iter_mut().zip(&clearances) {
            if *clearance >= 0.0 {
                *cell = Cell::Unreachable;
            }
        }
        let drivable = floor.drivable(&clearances, robot_radius_m, start);
        for index in &drivable {
            floor.cells[*index] = Cell::Reachable;
        }
        // The drivable cell that is nearest to any other cell has a neighbour that is not drivable.
        let inside: std::collections::HashSet<usize> = drivable.iter().copied().collect();
        let at_edge = |index: &usize| floor.neighbours(*index).any(|next| !inside.contains(&next));
        let edge: Vec<usize> = drivable.iter().copied().filter(at_edge).collect();
        for index in edge {
            floor.reach_from(index, swath_m);
        }
        floor
    }

    /// The cell under a point, if it lies in the grid.
    pub fn cell_at(&self, point: Point) -> Option<usize> {
        let offset = (point - self.origin) / self.cell_m;
        let inside = |at: f64, count: usize| at >= 0.0 && at < count as f64;
        (inside(offset.x, self.width) && inside(offset.y, self.height))
            .then(|| offset.y as usize * self.width + offset.x as usize)
    }

    /// Centre of a cell, metres.
    pub fn center(&self, index: usize) -> Point {
        let (column, row) = (index % self.width, index / self.width);
        self.origin + nalgebra::Vector2::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell_m
    }

    /// What a cell is.
    pub fn kind(&self, index: usize) -> Cell {
        self.cells[index]
    }

    /// How many cells the grid has.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether the grid has no cells.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Cells to which the robot's centre can drive from the start: a flood fill over cells with room for the hull,
    /// from the one that is nearest to the start. (The start itself may touch the wall, where no cell's centre lies.)
    fn drivable(&self, clearances: &[f64], robot_radius_m: f64, start: Point) -> Vec<usize> {
        let mut open: Vec<bool> = clearances.iter().map(|clearance| *clearance >= robot_radius_m).collect();
        let distance_m = |index: &usize| (self.center(*index) - start).norm();
        let first =
            (0..open.len()).filter(|i| open[*i]).min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
        let mut queue: VecDeque<usize> = first.into_iter().collect();
        let mut found = Vec::new();
        while let Some(index) = queue.pop_front() {
            if std::mem::replace(&mut open[index], false) {
                found.push(index);
                queue.extend(self.neighbours(index).filter(|next| open[*next]));
            }
        }
        found
    }

    fn neighbours(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        let (column, row, width, height) = (index % self.width, index / self.width, self.width, self.height);
        let west = (column > 0).then(|| index - 1);
        let east = (column + 1 < width).then(|| index + 1);
        let south = (row > 0).then(|| index - width);
        let north = (row + 1 < height).then(|| index + width);
        [west, east, south, north].into_iter().flatten()
    }

    fn reach_from(&mut self, index: usize, swath_m: f64) {
        let center = self.center(index);
        for near in self.cells_near(center, center, swath_m / 2.0) {
            if self.cells[near] == Cell::Unreachable {
                self.cells[near] = Cell::Reachable;
            }
        }
    }

    /// Cells whose centre lies within `reach_m` of the segment from `a` to `b`, in order of their index.
    pub fn cells_near(&self, a: Point, b: Point, reach_m: f64) -> Vec<usize> {
        let reach = nalgebra::Vector2::new(reach_m, reach_m);
        let (low, high) = (a.inf(&b) - reach, a.sup(&b) + reach);
        let first = (low - self.origin) / self.cell_m;
        let last = (high - self.origin) / self.cell_m;
        let span = |from: f64, to: f64, count: usize| {
            (from.floor().max(0.0) as usize)..((to.ceil().max(0.0) as usize).min(count))
        };
        let columns = span(first.x, last.x, self.width);
        span(first.y, last.y, self.height)
            .flat_map(|row| columns.clone().map(move |column| row * self.width + column))
            .filter(|index| {
                let center = self.center(*index);
                (center - nearest_on_segment(a, b, center)).norm() <= reach_m
            })
            .collect()
    }
}

/// A floor with the scanned cells marked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoverageGrid {
    floor: Floor,
    covered: Vec<bool>,
    counts: Counts,
}

impl CoverageGrid {
    /// A floor of which nothing has been scanned.
    pub fn new(floor: Floor) -> Self {
        let covered = vec![false; floor.len()];
        let count = |wanted: &[Cell]| floor.cells.iter().filter(|cell| wanted.contains(cell)).count();
        let counts = Counts {
            floor: count(&[Cell::Unreachable, Cell::Reachable]),
            reachable: count(&[Cell::Reachable]),
            ..Counts::default()
        };
        Self { floor, covered, counts }
    }

    /// The floor beneath.
    pub fn floor(&self) -> &Floor {
        &self.floor
    }

    /// Marks what a tool of some swath scans on its way from `a` to `b`; returns the floor cells that are new.
    pub fn mark_swath(&mut self, a: Point, b: Point, swath_m: f64) -> Vec<CellRun> {
        let fresh: Vec<usize> = self
            .floor
            .cells_near(a, b, swath_m / 2.0)
            .into_iter()
            .filter(|index| !self.covered[*index] && self.floor.kind(*index) != Cell::Outside)
            .collect();
        let runs = runs_of(&fresh);
        self.apply(&runs);
        runs
    }

    /// Marks cells as scanned; cells beyond the grid are ignored.
    pub fn apply(&mut self, runs: &[CellRun]) {
        for CellRun(first, count) in runs {
            let end = (*first as usize + *count as usize).min(self.floor.len());
            for index in (*first as usize)..end {
                if !std::mem::replace(&mut self.covered[index], true) {
                    let kind = self.floor.kind(index);
                    self.counts.covered += usize::from(kind != Cell::Outside);
                    self.counts.covered_reachable += usize::from(kind == Cell::Reachable);
                }
            }
        }
    }

    /// Whether a cell has been scanned.
    pub fn is_covered(&self, index: usize) -> bool {
        self.covered[index]
    }

    /// How many cells of each kind.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Scanned share of the floor that the tool can reach, 0 to 1.
    pub fn fraction_reachable(&self) -> f64 {
        share(self.counts.covered_reachable, self.counts.reachable)
    }

    /// Scanned share of the whole floor, 0 to 1.
    pub fn fraction_whole(&self) -> f64 {
        share(self.counts.covered, self.counts.floor)
    }
}

fn share(part: usize, whole: usize) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

fn runs_of(sorted: &[usize]) -> Vec<CellRun> {
    let mut runs: Vec<CellRun> = Vec::new();
    for index in sorted {
        match runs.last_mut() {
            Some(CellRun(first, count)) if *first as usize + *count as usize == *index => *count += 1,
            _ => runs.push(CellRun(*index as u32, 1)),
        }
    }
    runs
}

/// The written form of a [`Floor`].
#[derive(Clone, Serialize, Deserialize)]
struct FloorRuns {
    origin: Point,
    cell_m: f64,
    width: usize,
    height: usize,
    runs: Vec<(Cell, u32)>,
}

impl From<Floor> for FloorRuns {
    fn from(floor: Floor) -> Self {
        let mut runs: Vec<(Cell, u32)> = Vec::new();
        for cell in floor.cells {
            match runs.last_mut() {
                Some((kind, count)) if *kind == cell => *count += 1,
                _ => runs.push((cell, 1)),
            }
        }
        Self { origin: floor.origin, cell_m: floor.cell_m, width: floor.width, height: floor.height, runs }
    }
}

impl From<FloorRuns> for Floor {
    fn from(written: FloorRuns) -> Self {
        let mut cells: Vec<Cell> = written
            .runs
            .iter()
            .flat_map(|(cell, count)| std::iter::repeat_n(*cell, *count as usize))
            .collect();
        // A damaged file must not make later look-ups run past the end.
        cells.resize(written.width * written.height, Cell::Outside);
        Self {
            origin: written.origin,
            cell_m: written.cell_m,
            width: written.width,
            height: written.height,
            cells,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boundary, Obstacle, ObstacleId, Shape};
    use proptest::prelude::*;

    fn tank(obstacles: Vec<Shape>) -> World {
        let obstacles = obstacles
            .into_iter()
            .enumerate()
            .map(|(i, shape)| Obstacle { id: ObstacleId(i as u32), name: String::new(), shape, known: true })
            .collect();
        World { boundary: Boundary::Circle { radius_m: 5.0 }, obstacles, stations: vec![], zones: vec![] }
    }

    fn floor(world: &World) -> Floor {
        Floor::new(world, 0.05, 0.25, 0.6, Point::origin())
    }

    #[test]
    fn the_floor_of_a_round_tank_has_its_area() {
        let floor = floor(&tank(vec![]));
        let area_m2 = CoverageGrid::new(floor.clone()).counts().floor as f64 * floor.cell_m * floor.cell_m;
        assert!((area_m2 - std::f64::consts::PI * 25.0).abs() < 0.3, "{area_m2}");
    }

    #[test]
    fn floor_behind_a_closed_ring_cannot_be_reached() {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let ring = Shape::Polyline {
            points: corners.iter().map(|(x, y)| Point::new(3.0 + x, *y)).collect(),
            half_width_m: 0.1,
        };
        let floor = floor(&tank(vec![ring]));
        let inside = floor.cell_at(Point::new(3.0, 0.0)).expect("in the grid");
        assert_eq!(floor.kind(inside), Cell::Unreachable);
        assert_eq!(floor.kind(floor.cell_at(Point::origin()).expect("in the grid")), Cell::Reachable);
    }

    #[test]
    fn a_start_on_the_wall_reaches_the_floor() {
        let floor = Floor::new(&tank(vec![]), 0.05, 0.0, 0.6, Point::new(5.0, 0.0));
        let counts = CoverageGrid::new(floor).counts();
        assert_eq!(counts.reachable, counts.floor);
    }

    #[test]
    fn a_straight_pass_scans_swath_times_length() {
        let mut grid = CoverageGrid::new(floor(&tank(vec![])));
        let runs = grid.mark_swath(Point::new(-2.0, 0.0), Point::new(2.0, 0.0), 0.6);
        let area_m2 = runs.iter().map(|run| f64::from(run.1)).sum::<f64>() * 0.05 * 0.05;
        let expected = 4.0 * 0.6 + std::f64::consts::PI * 0.09;
        assert!((area_m2 - expected).abs() < 0.05, "{area_m2} of {expected}");
        assert!(grid.mark_swath(Point::new(-2.0, 0.0), Point::new(2.0, 0.0), 0.6).is_empty());
    }

    proptest! {
        #[test]
        fn applying_the_runs_gives_the_same_grid(ends in (-5.0..5.0_f64, -5.0..5.0_f64, -5.0..5.0_f64, -5.0..5.0_f64)) {
            let world = tank(vec![Shape::Disc { center: Point::new(1.0, 1.0), radius_m: 0.4 }]);
            let floor = Floor::new(&world, 0.2, 0.25, 0.6, Point::origin());
            let (mut marked, mut applied) = (CoverageGrid::new(floor.clone()), CoverageGrid::new(floor));
            let runs = marked.mark_swath(Point::new(ends.0, ends.1), Point::new(ends.2, ends.3), 0.5);
            applied.apply(&runs);
            prop_assert_eq!(marked, applied);
        }
    }
}
