//! Which cells are floor, and which of them the tool can reach.

use super::floor::{Cell, Floor, KindRun, kind_runs};
use crate::{
    obstacles::ObstacleMap,
    tank::{World, ZoneKind},
};
use geometry::{Point, Shape, Vector};
use std::{collections::VecDeque, sync::Arc};

/// Difference of distances up to which the wall counts as nearer than an obstacle, metres.
const ROUNDING_M: f64 = 1e-6;
/// Cells along each side of the blocks that are asked for their distance first.
const BLOCK: usize = 8;

/// A floor with all that is needed to update it when an obstacle is found.
#[derive(Clone)]
pub struct FloorMaker {
    floor: Floor,
    /// Distance from the centre of every cell to the nearest solid, metres; exact only where it is from 0 to `room_m`.
    clearance_m: Vec<f32>,
    /// Whether a zone forbids the robot's centre in a cell.
    forbidden: Vec<bool>,
    room_m: f64,
    swath_m: f64,
    start: Point,
}

impl Floor {
    /// The floor of a tank for a robot whose centre keeps `room_m` (hull radius and clearance) from everything solid, with
    /// a tool of some swath, driving from `start`; all in metres and the tank frame.
    ///
    /// Costs one distance query per block of 64 cells, one per cell of the blocks near something solid, and a flood fill.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m, cells of 0.1 m, 0.5 m of room for the hull, a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert_eq!((floor.width, floor.height, floor.origin), (100, 100, Point::new(-5.0, -5.0)));
    /// ```
    pub fn new(world: &World, cell_m: f64, room_m: f64, swath_m: f64, start: Point) -> Self {
        FloorMaker::new(world, cell_m, room_m, swath_m, start).into_floor()
    }
}

impl FloorMaker {
    /// The floor of a tank; see [`Floor::new`].
    ///
    /// ```
    /// use world::{Boundary, FloorMaker, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let maker = FloorMaker::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert_eq!(maker.into_floor().len(), 10_000);
    /// ```
    pub fn new(world: &World, cell_m: f64, room_m: f64, swath_m: f64, start: Point) -> Self {
        let (low, high) = world.boundary.bounds();
        let count = |span_m: f64| (span_m / cell_m).ceil().max(1.0) as usize;
        let (width, height) = (count(high.x - low.x), count(high.y - low.y));
        let cells = Arc::new(vec![Cell::Outside; width * height]);
        Self::of(&Floor { origin: low, cell_m, width, height, cells }, world, room_m, swath_m, start)
    }

    /// The floor of a tank with its cells at the positions of another floor's.
    ///
    /// ```
    /// use world::{Boundary, Floor, FloorMaker, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let wide = FloorMaker::of(&floor, &tank, 1.0, 0.6, Point::origin()).into_floor();
    /// assert!(wide.is_aligned_with(&floor) && wide != floor);
    /// ```
    pub fn of(grid: &Floor, world: &World, room_m: f64, swath_m: f64, start: Point) -> Self {
        let map = ObstacleMap::new(&world.boundary, &world.obstacles);
        let clearance_m = clearances_m(grid, &map, room_m);
        let mut forbidden = vec![false; grid.len()];
        for zone in world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo) {
            forbid(grid, &zone.shape, room_m, &mut forbidden);
        }
        let mut maker = Self { floor: grid.clone(), clearance_m, forbidden, room_m, swath_m, start };
        maker.classify(world);
        maker
    }

    /// The floor as it is now.
    ///
    /// ```
    /// use world::{Boundary, FloorMaker, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let maker = FloorMaker::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert!(maker.into_floor().is_reachable(5050));
    /// ```
    pub fn into_floor(self) -> Floor {
        self.floor
    }

    /// Updates the floor after a no-go zone with this outline was drawn; returns the cells that changed.
    ///
    /// Costs a flood fill.
    ///
    /// ```
    /// use world::{Boundary, FloorMaker, Point, Shape, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let mut maker = FloorMaker::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let outline = Shape::Disc { center: Point::new(2.0, 0.0), radius_m: 0.3 };
    /// assert!(!maker.forbid(&tank, &outline).is_empty());
    /// ```
    pub fn forbid(&mut self, world: &World, outline: &Shape) -> Vec<KindRun> {
        forbid(&self.floor, outline, self.room_m, &mut self.forbidden);
        self.classified(world)
    }

    /// Updates the floor after obstacles with these outlines appeared or moved slightly; returns the cells that changed.
    /// `world` and `map` are the tank as it is now.
    ///
    /// Costs a distance query per cell near the outlines and a flood fill.
    ///
    /// ```
    /// use world::{Boundary, FloorMaker, Obstacle, ObstacleId, ObstacleMap, Point, Shape, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let mut tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let mut maker = FloorMaker::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// let shape = Shape::Disc { center: Point::new(2.0, 0.0), radius_m: 0.3 };
    /// tank.obstacles.push(Obstacle { id: ObstacleId(1), name: "C1".into(), shape: shape.clone(), known: false });
    /// let map = ObstacleMap::new(&tank.boundary, &tank.obstacles);
    /// assert!(!maker.update(&tank, &map, &[shape]).is_empty());
    /// ```
    pub fn update(&mut self, world: &World, map: &ObstacleMap, changed: &[Shape]) -> Vec<KindRun> {
        // Wide enough for the former outline of a moved obstacle too: it moved only slightly.
        let reach_m = self.room_m + self.swath_m;
        for shape in changed {
            for index in around(&self.floor, shape, reach_m) {
                self.clearance_m[index] = map.clearance_m(self.floor.center(index)) as f32;
            }
        }
        self.classified(world)
    }

    /// Classifies the floor anew; the cells that changed.
    fn classified(&mut self, world: &World) -> Vec<KindRun> {
        let before = Arc::clone(&self.floor.cells);
        self.classify(world);
        let changed = |(index, cell): &(usize, Cell)| before[*index] != *cell;
        kind_runs(self.floor.cells.iter().copied().enumerate().filter(changed))
    }

    fn classify(&mut self, world: &World) {
        for (cell, clearance) in Arc::make_mut(&mut self.floor.cells).iter_mut().zip(&self.clearance_m) {
            *cell = if *clearance >= 0.0 { Cell::Beside } else { Cell::Outside };
        }
        let room_m = self.room_m as f32;
        let is_free = |(clearance, forbidden): (&f32, &bool)| *clearance >= room_m && !forbidden;
        let free: Vec<bool> = self.clearance_m.iter().zip(&self.forbidden).map(is_free).collect();
        let drivable = self.drivable(&free);
        self.reach(&drivable, Cell::Reachable);
        let cut_off: Vec<bool> =
            free.iter().zip(&drivable).map(|(free, drivable)| *free && !drivable).collect();
        self.reach(&cut_off, Cell::Unreachable);
        for index in 0..self.floor.len() {
            if self.floor.cells[index] == Cell::Beside {
                let kind = self.why_not(index, world);
                self.floor.set(index, kind);
            }
        }
    }

    /// Why the tool cannot reach a cell that is not merely cut off.
    fn why_not(&self, index: usize, world: &World) -> Cell {
        let center = self.floor.center(index);
        if self.forbidden[index] && f64::from(self.clearance_m[index]) >= self.room_m {
            return Cell::NoGo;
        }
        let wall_m = world.boundary.wall_distance_m(center);
        // Up to this distance from the shell the tool cannot reach in an empty tank; beyond, an obstacle is the cause.
        let margin_m = (self.room_m - self.swath_m / 2.0).max(0.0) + self.floor.cell_m;
        let is_wall_nearest = wall_m <= f64::from(self.clearance_m[index]) + ROUNDING_M;
        if is_wall_nearest && wall_m <= margin_m { Cell::Margin } else { Cell::Beside }
    }

    /// Cells to which the robot's centre can drive from the start: a flood fill over cells with room for it, from the one
    /// nearest to the start. (The start itself may touch the wall, where no cell has its centre.)
    fn drivable(&self, free: &[bool]) -> Vec<bool> {
        let distance_m = |index: &usize| (self.floor.center(*index) - self.start).norm();
        let first =
            (0..free.len()).filter(|i| free[*i]).min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
        let mut queue: VecDeque<usize> = first.into_iter().collect();
        let mut found = vec![false; free.len()];
        while let Some(index) = queue.pop_front() {
            if !std::mem::replace(&mut found[index], true) {
                queue.extend(self.floor.neighbours(index).filter(|next| free[*next] && !found[*next]));
            }
        }
        found
    }

    /// Sets the kind of the floor that the tool reaches from some cells and that has no kind yet.
    fn reach(&mut self, from: &[bool], kind: Cell) {
        // Of these cells the one that is nearest to any other cell has a neighbour that is not one of them.
        let at_edge = |index: &usize| self.floor.neighbours(*index).any(|next| !from[next]);
        let cells: Vec<usize> = (0..from.len()).filter(|index| from[*index]).collect();
        let edge: Vec<usize> = cells.iter().copied().filter(at_edge).collect();
        for index in cells {
            if self.floor.cells[index] == Cell::Beside {
                self.floor.set(index, kind);
            }
        }
        for index in edge {
            let center = self.floor.center(index);
            for near in self.floor.cells_near(center, center, self.swath_m / 2.0) {
                if self.floor.cells[near] == Cell::Beside {
                    self.floor.set(near, kind);
                }
            }
        }
    }
}

/// The distance from the centre of every cell to the nearest solid, metres. Where the distance in the middle of a block shows
/// that all its cells have `room_m`, or that all are solid, they have the bound that shows it.
fn clearances_m(grid: &Floor, map: &ObstacleMap, room_m: f64) -> Vec<f32> {
    let mut clearances_m = vec![0.0; grid.len()];
    for (row, column) in (0..grid.height)
        .step_by(BLOCK)
        .flat_map(|row| (0..grid.width).step_by(BLOCK).map(move |column| (row, column)))
    {
        let (rows, columns) = (row..(row + BLOCK).min(grid.height), column..(column + BLOCK).min(grid.width));
        let index = |row: usize, column: usize| row * grid.width + column;
        let (low, high) =
            (grid.center(index(row, column)), grid.center(index(rows.end - 1, columns.end - 1)));
        let (middle_m, far_m) = (map.clearance_m(nalgebra::center(&low, &high)), (high - low).norm() / 2.0);
        let bound_m = Some(middle_m - far_m)
            .filter(|least_m| *least_m > room_m)
            .or_else(|| Some(middle_m + far_m).filter(|most_m| *most_m < 0.0));
        for row in rows {
            let cells = index(row, columns.start)..index(row, columns.end);
            for (clearance_m, cell) in clearances_m[cells.clone()].iter_mut().zip(cells) {
                *clearance_m = bound_m.unwrap_or_else(|| map.clearance_m(grid.center(cell))) as f32;
            }
        }
    }
    clearances_m
}

/// Marks the cells from which the middle of the robot would be in a zone, or too near to it.
fn forbid(grid: &Floor, outline: &Shape, room_m: f64, forbidden: &mut [bool]) {
    for index in around(grid, outline, room_m) {
        forbidden[index] |= outline.distance_m(grid.center(index)) < room_m;
    }
}

/// The cells of the box around an outline, with some margin.
fn around(floor: &Floor, shape: &Shape, margin_m: f64) -> impl Iterator<Item = usize> + use<> {
    let (low, high) = shape.bounds();
    let margin = Vector::new(margin_m, margin_m);
    floor.cells_in(low - margin, high + margin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boundary, Obstacle, ObstacleId, Zone};

    fn tank(discs: &[(f64, f64, f64)]) -> World {
        let obstacle = |(i, (x, y, r)): (usize, &(f64, f64, f64))| Obstacle {
            id: ObstacleId(i as u32),
            name: String::new(),
            shape: Shape::Disc { center: Point::new(*x, *y), radius_m: *r },
            known: true,
        };
        let obstacles = discs.iter().enumerate().map(obstacle).collect();
        World { boundary: Boundary::Circle { radius_m: 5.0 }, obstacles, stations: vec![], zones: vec![] }
    }

    fn kind(floor: &Floor, x: f64, y: f64) -> Cell {
        floor.kind(floor.cell_at(Point::new(x, y)).expect("in the grid"))
    }

    #[test]
    fn floor_that_the_tool_cannot_reach_says_why() {
        let mut world = tank(&[(2.0, 0.0, 0.3)]);
        let shape = Shape::Disc { center: Point::new(-2.0, 0.0), radius_m: 1.0 };
        world.zones.push(Zone { name: "sump".into(), kind: ZoneKind::NoGo, shape });
        let floor = Floor::new(&world, 0.05, 0.5, 0.6, Point::origin());
        assert_eq!(kind(&floor, 4.9, 0.0), Cell::Margin);
        assert_eq!(kind(&floor, 4.7, 0.0), Cell::Reachable);
        assert_eq!(kind(&floor, 2.0, 0.4), Cell::Beside);
        assert_eq!(kind(&floor, 2.0, 0.0), Cell::Outside);
        assert_eq!(kind(&floor, -2.0, 0.0), Cell::NoGo);
        assert_eq!(kind(&floor, 0.0, 0.0), Cell::Reachable);
    }

    #[test]
    fn a_gap_at_the_shell_that_is_too_narrow_is_beside_the_column_and_no_margin() {
        let floor = Floor::new(&tank(&[(4.1, 0.0, 0.3)]), 0.05, 0.5, 0.6, Point::origin());
        assert_eq!(kind(&floor, 4.72, 0.02), Cell::Beside);
        assert_eq!(kind(&floor, 4.92, 0.02), Cell::Margin);
        assert_eq!(kind(&floor, -4.72, 0.02), Cell::Reachable);
    }

    #[test]
    fn asking_blocks_first_gives_the_same_floor_as_asking_every_cell() {
        let world = tank(&[(2.0, 0.0, 0.3), (2.9, 0.1, 0.2), (-1.0, 3.0, 0.5), (-4.6, 0.0, 0.2)]);
        for (cell_m, room_m) in [(0.05, 0.35), (0.1, 0.2), (0.03, 0.6)] {
            let mut maker = FloorMaker::new(&world, cell_m, room_m, 0.5, Point::origin());
            let map = ObstacleMap::new(&world.boundary, &world.obstacles);
            let clearance_m = |cell| map.clearance_m(maker.floor.center(cell)) as f32;
            let exact: Vec<f32> = (0..maker.floor.len()).map(clearance_m).collect();
            let n_asked =
                exact.iter().zip(&maker.clearance_m).filter(|(a, b)| a.to_bits() == b.to_bits()).count();
            assert!(n_asked < exact.len() / 2, "{n_asked} of {}", exact.len());
            let floor = maker.clone().into_floor();
            maker.clearance_m = exact;
            maker.classify(&world);
            assert_eq!(maker.into_floor(), floor, "cells of {cell_m} m, room of {room_m} m");
        }
    }

    #[test]
    fn blocks_whose_middle_lies_on_the_side_of_a_box_are_asked_cell_by_cell() {
        let corner = |x: f64, y: f64| Point::new(1.4 + 0.6 * x, -1.4 + 0.4 * y);
        let vertices = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let mut world = tank(&[]);
        world.boundary = Boundary::Polygon {
            vertices: [(-4.8, -2.8), (4.8, -2.8), (4.8, 2.8), (-4.8, 2.8)]
                .map(|(x, y)| Point::new(x, y))
                .to_vec(),
        };
        let shape = Shape::Polygon { vertices };
        world.obstacles.push(Obstacle { id: ObstacleId(0), name: String::new(), shape, known: true });
        let floor = Floor::new(&world, 0.05, 0.3, 0.6, Point::origin());
        let solid = (0..floor.len()).filter(|cell| floor.kind(*cell) == Cell::Outside).count();
        assert_eq!(solid, 24 * 16, "cells of a box of 1.2 m by 0.8 m");
    }

    #[test]
    fn a_found_obstacle_gives_the_floor_that_it_would_have_given_from_the_start() {
        let (before, after) = (tank(&[(2.0, 0.0, 0.3)]), tank(&[(2.0, 0.0, 0.3), (-1.0, 2.0, 0.4)]));
        let make = |world: &World| FloorMaker::new(world, 0.05, 0.35, 0.5, Point::origin());
        let mut maker = make(&before);
        let mut updated = Floor::new(&before, 0.05, 0.35, 0.5, Point::origin());
        let map = ObstacleMap::new(&after.boundary, &after.obstacles);
        let changes = maker.update(&after, &map, &[after.obstacles[1].shape.clone()]);
        updated.change(&changes);
        let rebuilt = make(&after).into_floor();
        assert_eq!((&maker.into_floor(), &updated), (&rebuilt, &rebuilt));
        assert!(!changes.is_empty() && changes.len() < 200);
    }
}
