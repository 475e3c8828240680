//! Determines which cells are floor, and which of them the tool can reach.

use super::{
    floor::{Cell, Floor, KindRun, kind_runs},
    room::{Connected, Room, TIE_M},
};
use crate::{
    obstacles::ObstacleMap,
    plates::{DeadBands, untestable},
    tank::{World, ZoneKind},
};
use geometry::{Boundary, Point, Shape, Vector};
use std::sync::Arc;

/// The number of cells along each side of a block; the clearance of each block is queried before that of its cells.
const BLOCK: usize = 8;

/// A floor with all the data needed to update it when an obstacle is found.
#[derive(Clone)]
pub struct FloorMaker {
    floor: Floor,
    /// Distance from the centre of every cell to the nearest solid, metres; exact only between 0 and `room_m`.
    clearance_m: Vec<f32>,
    /// For each cell, whether a zone keeps the robot's centre out.
    forbidden: Vec<bool>,
    /// For each cell, whether the tool cannot test it; empty if it can test all cells.
    untestable: Vec<bool>,
    /// The outlines of the no-go zones.
    zones: Vec<Shape>,
    /// The free floor in an empty tank.
    empty: Room,
    /// The free floor, and which parts of it are connected.
    room: Room,
    connected: Connected,
    room_m: f64,
    swath_m: f64,
    start: Point,
}

impl Floor {
    /// Creates the floor of a tank for a robot whose centre keeps `room_m` (hull radius plus clearance) from
    /// everything solid. The tool has the given swath, and the robot drives from `start`. All values are in metres
    /// and in the tank frame.
    ///
    /// Costs one distance query per block of 64 cells, one per cell in the blocks close to anything solid, a flood
    /// fill, and some queries per cell along the border of the reachable floor.
    ///
    /// ```
    /// use world::{Boundary, Floor, Point, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// # let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// // A round tank of radius 5 m with cells of 0.1 m, 0.5 m of clearance for the hull, and a swath of 0.6 m.
    /// let floor = Floor::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert_eq!((floor.width, floor.height, floor.origin), (100, 100, Point::new(-5.0, -5.0)));
    /// ```
    pub fn new(world: &World, cell_m: f64, room_m: f64, swath_m: f64, start: Point) -> Self {
        FloorMaker::new(world, cell_m, room_m, swath_m, start).into_floor()
    }
}

impl FloorMaker {
    /// Creates the floor of a tank; see [`Floor::new`].
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

    /// Creates the floor of a tank on the same grid as another floor; cells that are untestable there stay untestable.
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
        let zones = world.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
        let zones: Vec<Shape> = zones.map(|zone| zone.shape.clone()).collect();
        let mut forbidden = vec![false; grid.len()];
        for zone in &zones {
            forbid(grid, zone, room_m, &mut forbidden);
        }
        let empty = room_beside(&world.boundary, std::iter::empty(), room_m, swath_m);
        let (room, connected) = (empty.clone(), Connected::nowhere(grid));
        let (floor, untestable) = (grid.clone(), untestable(grid));
        let mut maker = Self {
            floor,
            clearance_m,
            forbidden,
            untestable,
            zones,
            empty,
            room,
            connected,
            room_m,
            swath_m,
            start,
        };
        maker.classify(world);
        maker
    }

    /// Adds the floor that a tool cannot test because of the welds, in a tank with this wall.
    ///
    /// Costs one distance query per block of 64 cells, and one per cell in the blocks close to a weld or the shell.
    ///
    /// ```
    /// use world::{Boundary, Cell, DeadBands, FloorMaker, PlateLayout, Point, RegularPlates, World};
    /// # let boundary = Boundary::Circle { radius_m: 5.0 };
    /// let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let plates = PlateLayout::Regular(RegularPlates { annular_m: 0.0, n_annular: 0, length_m: 6.0, width_m: 2.0 });
    /// let bands = DeadBands { plates, band_m: 0.1, square_m: 0.0 };
    /// let maker = FloorMaker::new(&tank, 0.1, 0.5, 0.6, Point::origin()).with_dead_bands(&bands, &tank.boundary);
    /// assert!(!maker.reaches(Point::new(2.0, 1.05)) && maker.reaches(Point::new(2.0, 1.25)));
    /// ```
    #[must_use]
    pub fn with_dead_bands(mut self, bands: &DeadBands, boundary: &Boundary) -> Self {
        self.untestable = bands.cells(boundary, &self.floor);
        self.exclude_untestable();
        self
    }

    fn exclude_untestable(&mut self) {
        let marks = self.untestable.iter().enumerate().filter(|(_, is_untestable)| **is_untestable);
        for (index, _) in marks {
            if self.floor.is_floor(index) {
                self.floor.set(index, Cell::Untestable);
            }
        }
    }

    /// Whether the tool can reach and test a place on the floor from some position that the robot can drive to. The
    /// result is exact and does not depend on the grid, except that a place is untestable if its cell is.
    ///
    /// ```
    /// use world::{Boundary, FloorMaker, Point, World};
    /// let boundary = Boundary::Circle { radius_m: 5.0 };
    /// let tank = World { boundary, obstacles: vec![], stations: vec![], zones: vec![] };
    /// let maker = FloorMaker::new(&tank, 0.1, 0.5, 0.6, Point::origin());
    /// assert!(maker.reaches(Point::new(4.799, 0.0)) && !maker.reaches(Point::new(4.801, 0.0)));
    /// ```
    pub fn reaches(&self, place: Point) -> bool {
        let is_untestable = |cell: usize| self.floor.kind(cell) == Cell::Untestable;
        if self.floor.cell_at(place).is_some_and(is_untestable) {
            return false;
        }
        let reach_m = self.reach_m();
        let is_home = |cell: usize| {
            self.connected.is_home(cell) && (self.floor.center(cell) - place).norm() <= reach_m + TIE_M
        };
        if let Some(is_reached) = self.floor.are_all_reachable_about(place) {
            return is_reached;
        }
        self.room.places_near(place, reach_m).any(|near| self.leads_to(near))
            || (self.room.has(place) && self.leads_to(place))
            || self.floor.cells_near(place, place, reach_m).into_iter().any(is_home)
    }

    /// Returns the current floor.
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

    /// Updates the floor after a no-go zone with this outline has been drawn; returns the cells that changed.
    ///
    /// Costs one flood fill.
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
        self.zones.push(outline.clone());
        self.classified(world)
    }

    /// Updates the floor after obstacles with these outlines have appeared or moved slightly; returns the cells that
    /// changed. `world` and `map` describe the tank after the change.
    ///
    /// Costs one distance query per cell near the outlines, and one flood fill.
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
        // Obstacles move only slightly, so this margin is wide enough to include their former outlines.
        let reach_m = self.room_m + self.swath_m;
        for shape in changed {
            for index in around(&self.floor, shape, reach_m) {
                self.clearance_m[index] = map.clearance_m(self.floor.center(index)) as f32;
            }
        }
        self.classified(world)
    }

    /// Classifies the floor again; returns the cells that changed.
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
        let room_m = (self.room_m - TIE_M) as f32;
        let has_room = |(clearance, forbidden): (&f32, &bool)| *clearance >= room_m && !forbidden;
        let free: Vec<bool> = self.clearance_m.iter().zip(&self.forbidden).map(has_room).collect();
        let solids = world.obstacles.iter().map(|obstacle| &obstacle.shape);
        self.room = room_beside(&world.boundary, solids.chain(&self.zones), self.room_m, self.swath_m);
        self.connected = Connected::new(&self.room, &self.floor, &free, self.start);
        self.reach_from_cells(&free);
        self.reach_from_corners();
        for (index, is_free) in free.iter().enumerate() {
            if self.floor.cells[index] == Cell::Beside {
                let kind = self.kind_beside(index, *is_free);
                self.floor.set(index, kind);
            }
        }
        self.exclude_untestable();
    }

    /// Marks as reachable the cells that the tool reaches from the centre of a connected cell.
    fn reach_from_cells(&mut self, free: &[bool]) {
        let home: Vec<bool> = (0..free.len()).map(|cell| self.connected.is_home(cell)).collect();
        // The connected cell nearest to any other cell always has a neighbour that is not connected, so only the cells
        // at the edge need to be tested.
        let is_at_edge = |index: usize| self.floor.neighbours(index).any(|next| !home[next]);
        let edge: Vec<usize> = (0..home.len()).filter(|cell| home[*cell] && is_at_edge(*cell)).collect();
        for cell in (0..home.len()).filter(|cell| home[*cell]) {
            self.floor.set(cell, Cell::Reachable);
        }
        for cell in edge {
            self.reach_around(self.floor.center(cell));
        }
    }

    /// Marks as reachable the cells that the tool reaches from a corner of the free floor.
    fn reach_from_corners(&mut self) {
        let corners: Vec<Point> = self.room.corners().filter(|corner| self.leads_to(*corner)).collect();
        for corner in corners {
            self.reach_around(corner);
        }
    }

    fn reach_around(&mut self, place: Point) {
        for near in self.floor.cells_near(place, place, self.reach_m() + TIE_M) {
            if self.floor.cells[near] == Cell::Beside {
                self.floor.set(near, Cell::Reachable);
            }
        }
    }

    /// Classifies a floor cell that the tool reaches neither from a connected cell nor from a corner of the free floor.
    fn kind_beside(&self, index: usize, is_free: bool) -> Cell {
        let center = self.floor.center(index);
        if is_free {
            return Cell::Unreachable;
        }
        let is_near = f64::from(self.clearance_m[index]) >= self.room_m - self.reach_m() - TIE_M;
        let mut is_cut_off = false;
        for place in self.room.places_near(center, self.reach_m()).filter(|_| is_near) {
            if self.leads_to(place) {
                return Cell::Reachable;
            }
            is_cut_off = true;
        }
        if is_cut_off { Cell::Unreachable } else { self.why_not(index) }
    }

    /// Finds the reason why the tool cannot reach a cell that is not merely cut off.
    fn why_not(&self, index: usize) -> Cell {
        let center = self.floor.center(index);
        if self.forbidden[index] && f64::from(self.clearance_m[index]) >= self.room_m {
            return Cell::NoGo;
        }
        let is_reached_in_empty_tank =
            self.empty.has(center) || self.empty.places_near(center, self.reach_m()).next().is_some();
        if is_reached_in_empty_tank { Cell::Beside } else { Cell::Margin }
    }

    fn leads_to(&self, place: Point) -> bool {
        self.connected.leads_to(&self.room, &self.floor, place)
    }

    /// The reach of the tool to each side of the robot's centre, metres.
    fn reach_m(&self) -> f64 {
        self.swath_m / 2.0
    }
}

fn room_beside<'a>(
    boundary: &Boundary,
    solids: impl Iterator<Item = &'a Shape>,
    room_m: f64,
    swath_m: f64,
) -> Room {
    Room::new(boundary, solids, room_m, swath_m / 2.0)
}

/// Returns the distance from the centre of every cell to the nearest solid, metres. If the distance at the centre of a
/// block shows that all its cells have at least `room_m` of clearance, or that all are solid, a bound is stored for
/// them instead of the exact distances.
pub(crate) fn clearances_m(grid: &Floor, map: &ObstacleMap, room_m: f64) -> Vec<f32> {
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

/// Marks the cells at which the robot's centre would be in a zone or too close to it.
fn forbid(grid: &Floor, outline: &Shape, room_m: f64, forbidden: &mut [bool]) {
    for index in around(grid, outline, room_m) {
        forbidden[index] |= outline.distance_m(grid.center(index)) < room_m;
    }
}

/// Returns the cells in the box around an outline, with a margin.
fn around(floor: &Floor, shape: &Shape, margin_m: f64) -> impl Iterator<Item = usize> + use<> {
    let (low, high) = shape.bounds();
    let margin = Vector::new(margin_m, margin_m);
    floor.cells_in(low - margin, high + margin)
}

#[cfg(test)]
mod tests;
