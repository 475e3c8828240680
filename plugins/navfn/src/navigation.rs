//! The navigation function of a goal, kept between plans and repaired when the map changes.

use crate::{
    marching::Field,
    problem::{GrownShape, PlanningProblem},
    raster::Raster,
};
use world::{Boundary, Point, Vector, shortest::GrownFloor};

/// Distance from the goal, in cells, within which cells get their exact distance if nothing is in between: a march is
/// least accurate near its source.
const SOURCE_CELLS: usize = 8;
/// Largest number of steps per cell when descending the field.
const STEPS_PER_CELL: usize = 4;
/// Length of a descent step, in cells.
const STEP_CELLS: f64 = 0.7;

/// Distances to a goal over the cells of a floor.
pub(crate) struct Navigation {
    goal: Point,
    boundary: Boundary,
    wall_keep_m: f64,
    cells: usize,
    raster: Raster,
    shapes: Vec<GrownShape>,
    field: Field,
}

impl Navigation {
    /// Creates the navigation function of a problem, with this many cells along the longer side of the floor.
    pub(crate) fn new(problem: &PlanningProblem, floor: &GrownFloor, cells: usize) -> Self {
        let mut raster = Raster::new(&problem.boundary, problem.wall_keep_m, cells);
        for grown in &problem.shapes {
            raster.cover(grown, &mut Vec::new());
        }
        Self {
            goal: problem.goal,
            boundary: problem.boundary.clone(),
            wall_keep_m: problem.wall_keep_m,
            cells,
            field: field_of(&raster, problem.goal, floor),
            raster,
            shapes: problem.shapes.clone(),
        }
    }

    /// The edge length of a cell, metres.
    pub(crate) fn cell_m(&self) -> f64 {
        self.raster.cell_m()
    }

    /// The number of cells settled since the field was created.
    pub(crate) fn n_settled(&self) -> usize {
        self.field.n_settled()
    }

    /// Takes over a changed problem. The field is repaired, or recomputed if the goal or the wall has changed.
    pub(crate) fn update(&mut self, problem: &PlanningProblem, floor: &GrownFloor, cells: usize) {
        let same_wall =
            self.boundary == problem.boundary && (self.wall_keep_m - problem.wall_keep_m).abs() < 1e-12;
        if self.goal != problem.goal || !same_wall || self.cells != cells {
            *self = Self::new(problem, floor, cells);
            return;
        }
        let (mut blocked, mut freed) = (Vec::new(), Vec::new());
        for index in 0..self.shapes.len().max(problem.shapes.len()) {
            let (old, new) = (self.shapes.get(index), problem.shapes.get(index));
            if old != new {
                // Add first, then remove, so that cells that stay covered do not change.
                if let Some(grown) = new {
                    self.raster.cover(grown, &mut blocked);
                }
                if let Some(grown) = old {
                    self.raster.uncover(grown, &mut freed);
                }
            }
        }
        self.shapes.clone_from(&problem.shapes);
        // A cell may be in both lists.
        let is_blocked: Vec<bool> = self.raster.blocked().collect();
        blocked.retain(|cell| is_blocked[*cell]);
        freed.retain(|cell| !is_blocked[*cell]);
        if blocked.iter().chain(&freed).any(|cell| self.field.is_source(*cell)) {
            self.field = field_of(&self.raster, self.goal, floor);
        } else {
            self.field.block(&blocked);
            self.field.free(&freed);
        }
    }

    /// Returns a path down the field from a start to the goal. It may cut corners by less than a cell. Returns `None`
    /// if the cells show no path, which may be due to their coarseness.
    pub(crate) fn way(
        &mut self,
        start: Point,
        floor: &GrownFloor,
        keep_going: &mut dyn FnMut() -> bool,
    ) -> Option<Vec<Point>> {
        let mut near: Vec<(usize, f64)> = self.raster.free_near(start, 2).collect();
        near.sort_by(|a, b| a.1.total_cmp(&b.1));
        let seen = near.iter().find(|(cell, _)| floor.is_free(start, self.raster.center(*cell)));
        let (first, _) = *seen?;
        self.field.march(first, keep_going);
        let mut at = start;
        let mut cell = first;
        let mut way = vec![start, self.raster.center(first)];
        for _ in 0..STEPS_PER_CELL * self.raster.columns().pow(2) {
            if !self.field.distance_m(cell).is_finite() {
                return None;
            }
            if self.field.is_source(cell) {
                way.push(self.goal);
                return Some(way);
            }
            at = self.step_down(if way.len() == 2 { way[1] } else { at }, cell);
            cell = self.raster.cell_at(at);
            way.push(at);
        }
        None
    }

    /// A step along the gradient, or to the lowest neighbour where the gradient does not lead down.
    fn step_down(&self, at: Point, cell: usize) -> Point {
        let here_m = self.field.distance_m(cell);
        let next = at + self.downhill(cell) * (STEP_CELLS * self.raster.cell_m());
        let next_cell = self.raster.cell_at(next);
        // Within the same cell, the path continues straight, so that it leaves the cell.
        if next_cell == cell || self.field.distance_m(next_cell) < here_m {
            return next;
        }
        let lowest = self.around(cell).into_iter().min_by(|a, b| self.order(*a, *b));
        self.raster.center(lowest.unwrap_or(cell))
    }

    fn order(&self, a: usize, b: usize) -> std::cmp::Ordering {
        self.field.distance_m(a).total_cmp(&self.field.distance_m(b))
    }

    fn around(&self, cell: usize) -> [usize; 4] {
        let columns = self.raster.columns();
        // A free cell is never part of the frame.
        [cell - 1, cell + 1, cell - columns, cell + columns]
    }

    /// The unit vector against the upwind gradient.
    fn downhill(&self, cell: usize) -> Vector {
        let here_m = self.field.distance_m(cell);
        let [west, east, south, north] =
            self.around(cell).map(|c| (here_m - self.field.distance_m(c)).max(0.0));
        let along = |back: f32, ahead: f32| f64::from(if ahead >= back { ahead } else { -back });
        Vector::new(along(west, east), along(south, north)).try_normalize(0.0).unwrap_or_else(Vector::zeros)
    }
}

/// Creates the field of a goal, not yet marched.
fn field_of(raster: &Raster, goal: Point, floor: &GrownFloor) -> Field {
    let spare_m = floor.spare_m(goal);
    let sees =
        |cell: usize, distance_m: f64| distance_m <= spare_m || floor.is_free(goal, raster.center(cell));
    let reach = ((spare_m / raster.cell_m()) as usize).clamp(1, SOURCE_CELLS);
    let sources: Vec<(usize, f64)> =
        raster.free_near(goal, reach).filter(|(cell, distance_m)| sees(*cell, *distance_m)).collect();
    Field::new(raster.columns(), raster.cell_m(), raster.blocked().collect(), &sources)
}
