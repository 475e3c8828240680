//! Determines which free places are connected to each other and to the start.
//!
//! Adjacent free cells are connected. The cells are too coarse where two solids leave a passage about as wide as the
//! robot. There, the line from cell to cell is tested. If no cell lies in the passage, the passage is followed in both
//! directions from its narrowest point.

use super::{Core, Room, TIE_M};
use crate::coverage::floor::Floor;
use geometry::{Boundary, Point, Vector, polyline::nearest_on_segment};
use std::{
    collections::{BTreeMap, VecDeque},
    f64::consts::TAU,
};

/// Excess width of a passage, in cells, above which the cells are fine enough to show the passage.
const WIDE_CELLS: f64 = 3.0;
/// The length of a step along a passage, in cells.
const STEP_CELLS: f64 = 0.5;
/// The number of directions tried for a step, and also the number of times that their range is narrowed.
const DIRECTIONS: u32 = 9;
const NARROWINGS: u32 = 4;
/// The largest turn in one step, to either side, radians.
const TURN_RAD: f64 = 1.2;
/// The largest number of steps along a passage.
const MOST_STEPS: usize = 2_000;
/// Distance from a place within which free cells are searched for, in cells.
const ABOUT_CELLS: i64 = 2;

/// The group of a cell that is not free.
const NONE: u32 = u32::MAX;

/// Free places in groups; the robot can drive between all places of a group.
#[derive(Clone)]
pub(in crate::coverage) struct Connected {
    groups: Groups,
    /// The group of the robot's start.
    home: u32,
}

#[derive(Clone)]
struct Groups {
    of_cell: Vec<u32>,
    /// For every group, a group that contains it, or the group itself.
    parents: Vec<u32>,
    /// Free places on the passages that were followed, each with its group, by cell.
    trails: BTreeMap<(i64, i64), Vec<(Point, u32)>>,
}

/// The narrowest point of a passage, and the direction of the passage there.
struct Neck {
    at: Point,
    through: Vector,
}

impl Connected {
    /// Creates the groups of a floor on which the robot cannot drive anywhere.
    pub(in crate::coverage) fn nowhere(floor: &Floor) -> Self {
        let groups = Groups { of_cell: vec![NONE; floor.len()], parents: vec![], trails: BTreeMap::new() };
        Self { groups, home: NONE }
    }

    /// Groups the free cells, the passages between them, and the corners of the rim.
    pub(in crate::coverage) fn new(room: &Room, floor: &Floor, has_room: &[bool], start: Point) -> Self {
        let necks = room.necks(WIDE_CELLS * floor.cell_m);
        let doubtful = doubtful(floor, room, &necks);
        let mut groups = Groups::of_cells(room, floor, has_room, &doubtful);
        for neck in necks.iter().filter(|neck| room.has(neck.at)) {
            let [one, other] =
                [neck.through, -neck.through].map(|way| groups.follow(room, floor, neck.at, way));
            groups.join(one, other);
        }
        for corner in room.corners() {
            if groups.seen_from(room, floor, corner, None).is_none()
                && let Some(way) = widest_way(room, corner, STEP_CELLS * floor.cell_m)
            {
                groups.follow(room, floor, corner, way);
            }
        }
        let home = groups.home(room, floor, has_room, start);
        Self { groups, home }
    }

    /// Whether a cell is free and the robot can drive to it from the start.
    pub(in crate::coverage) fn is_home(&self, cell: usize) -> bool {
        let group = self.groups.of_cell[cell];
        group != NONE && self.groups.root(group) == self.home
    }

    /// Whether the robot can drive from the start to a free place.
    pub(in crate::coverage) fn leads_to(&self, room: &Room, floor: &Floor, place: Point) -> bool {
        self.groups.seen_from(room, floor, place, None).is_some_and(|group| group == self.home)
    }
}

impl Groups {
    /// Groups adjacent free cells; where the connection is doubtful, only if the line between them is free.
    fn of_cells(room: &Room, floor: &Floor, has_room: &[bool], doubtful: &[bool]) -> Self {
        let mut groups =
            Self { of_cell: vec![NONE; has_room.len()], parents: vec![], trails: BTreeMap::new() };
        let leads = |from: usize, to: usize| {
            !(doubtful[from] || doubtful[to]) || room.is_way(floor.center(from), floor.center(to))
        };
        for first in 0..has_room.len() {
            if !has_room[first] || groups.of_cell[first] != NONE {
                continue;
            }
            let group = groups.add();
            groups.of_cell[first] = group;
            let mut queue = VecDeque::from([first]);
            while let Some(cell) = queue.pop_front() {
                for next in floor.neighbours(cell) {
                    if has_room[next] && groups.of_cell[next] == NONE && leads(cell, next) {
                        groups.of_cell[next] = group;
                        queue.push_back(next);
                    }
                }
            }
        }
        groups
    }

    fn add(&mut self) -> u32 {
        let group = self.parents.len() as u32;
        self.parents.push(group);
        group
    }

    fn root(&self, mut group: u32) -> u32 {
        while self.parents[group as usize] != group {
            group = self.parents[group as usize];
        }
        group
    }

    fn join(&mut self, one: u32, other: u32) {
        let (one, other) = (self.root(one), self.root(other));
        self.parents[one.max(other) as usize] = one.min(other);
    }

    /// Returns the group of the nearest place to which the robot can drive straight from a free place. If `ahead` is
    /// given, only places in that direction count.
    fn seen_from(
        &self,
        room: &Room,
        floor: &Floor,
        place: Point,
        ahead: Option<(Point, Vector)>,
    ) -> Option<u32> {
        let (column, row) = cell_under(floor, place);
        let mut seen: Vec<(Point, u32)> = Vec::new();
        for y in row - ABOUT_CELLS..=row + ABOUT_CELLS {
            for x in column - ABOUT_CELLS..=column + ABOUT_CELLS {
                seen.extend(self.trails.get(&(x, y)).into_iter().flatten());
                let is_cell = (0..floor.width as i64).contains(&x) && (0..floor.height as i64).contains(&y);
                let cell = is_cell.then(|| y as usize * floor.width + x as usize);
                seen.extend(
                    cell.filter(|cell| self.of_cell[*cell] != NONE)
                        .map(|cell| (floor.center(cell), self.of_cell[cell])),
                );
            }
        }
        seen.retain(|(at, _)| ahead.is_none_or(|(from, way)| (at - from).dot(&way) > TIE_M));
        seen.sort_by(|a, b| (a.0 - place).norm().total_cmp(&(b.0 - place).norm()));
        let found = seen.into_iter().find(|(at, _)| room.is_way(place, *at));
        found.map(|(_, group)| self.root(group))
    }

    /// Returns the group to which a passage leads from a place in a given direction, or a new group if the passage ends
    /// before it reaches one.
    fn follow(&mut self, room: &Room, floor: &Floor, from: Point, way: Vector) -> u32 {
        let (mut here, mut ahead) = (from, way);
        let mut trail = vec![from];
        let mut found = None;
        while found.is_none() && trail.len() < MOST_STEPS {
            let Some(next) = step(room, here, ahead, STEP_CELLS * floor.cell_m) else { break };
            ahead = (next - here).normalize();
            here = next;
            trail.push(next);
            let towards = if trail.len() <= 4 { (from, way) } else { (here, ahead) };
            found = self.seen_from(room, floor, here, Some(towards));
        }
        let group = found.unwrap_or_else(|| self.add());
        for place in trail {
            self.trails.entry(cell_under(floor, place)).or_default().push((place, group));
        }
        group
    }

    /// Returns the group of the start or, if the start has none, the group of the nearest free cell.
    fn home(&self, room: &Room, floor: &Floor, has_room: &[bool], start: Point) -> u32 {
        let at_start = room.has(start).then(|| self.seen_from(room, floor, start, None)).flatten();
        let off_m = |cell: &usize| (floor.center(*cell) - start).norm();
        let nearest = || {
            (0..has_room.len()).filter(|cell| has_room[*cell]).min_by(|a, b| off_m(a).total_cmp(&off_m(b)))
        };
        at_start.or_else(|| nearest().map(|cell| self.root(self.of_cell[cell]))).unwrap_or(NONE)
    }
}

/// Returns the column and row of the cell under a place, even outside the grid.
fn cell_under(floor: &Floor, place: Point) -> (i64, i64) {
    let offset = (place - floor.origin) / floor.cell_m;
    (offset.x.floor() as i64, offset.y.floor() as i64)
}

/// Marks the cells around the necks of passages, or all cells if the required clearance is smaller than a cell.
fn doubtful(floor: &Floor, room: &Room, necks: &[Neck]) -> Vec<bool> {
    let mut doubtful = vec![room.keep_m < floor.cell_m; floor.len()];
    for neck in necks {
        for cell in floor.cells_near(neck.at, neck.at, WIDE_CELLS * floor.cell_m) {
            doubtful[cell] = true;
        }
    }
    doubtful
}

/// Returns the next place along a passage: the one ahead with the most clearance; `None` where the passage ends.
fn step(room: &Room, here: Point, ahead: Vector, length_m: f64) -> Option<Point> {
    let lengths = [1.0, 0.5, 0.25, 0.1].map(|share| share * length_m);
    let next = |length_m: f64| {
        let (mut middle_rad, mut half_rad) = (ahead.y.atan2(ahead.x), TURN_RAD);
        for _ in 0..NARROWINGS {
            middle_rad = widest(room, here, length_m, middle_rad, half_rad);
            half_rad *= 2.0 / f64::from(DIRECTIONS - 1);
        }
        let at = place(here, length_m, middle_rad);
        (room.has(at) && room.is_way(here, at)).then_some(at)
    };
    lengths.into_iter().find_map(next)
}

/// Returns the direction with the most clearance from a place where the robot barely fits.
fn widest_way(room: &Room, here: Point, length_m: f64) -> Option<Vector> {
    let angles = (0..16).map(|k| TAU * f64::from(k) / 16.0);
    let room_m = |angle: f64| room.map.clearance_m(place(here, length_m, angle));
    let best = angles.max_by(|a, b| room_m(*a).total_cmp(&room_m(*b)))?;
    Some(geometry::unit_vector(best))
}

fn widest(room: &Room, here: Point, length_m: f64, middle_rad: f64, half_rad: f64) -> f64 {
    let half = (DIRECTIONS - 1) / 2;
    let angles = (0..DIRECTIONS).map(|k| middle_rad + half_rad * (f64::from(k) / f64::from(half) - 1.0));
    let room_m = |angle: f64| room.map.clearance_m(place(here, length_m, angle));
    let best = angles.map(|angle| (angle, room_m(angle))).max_by(|a, b| a.1.total_cmp(&b.1));
    best.map_or(middle_rad, |(angle, _)| angle)
}

fn place(from: Point, length_m: f64, angle_rad: f64) -> Point {
    from + geometry::unit_vector(angle_rad) * length_m
}

impl Room {
    /// Returns the necks of the passages whose width differs by at most `more_m` from the width that the robot needs.
    fn necks(&self, more_m: f64) -> Vec<Neck> {
        let needs_m = 2.0 * self.keep_m;
        let mut necks = Vec::new();
        let mut add = |from: Point, to: Point| {
            let across = to - from;
            let is_narrow = (across.norm() - needs_m).abs() <= more_m;
            if let Some(way) = across.try_normalize(TIE_M).filter(|_| is_narrow) {
                let at = nalgebra::center(&from, &to);
                necks.push(Neck { at, through: Vector::new(-way.y, way.x) });
            }
        };
        for (index, core) in self.cores.iter().enumerate() {
            let near = self.boxes.near(core.a, core.b, needs_m + more_m + core.radius_m);
            for other in near.filter(|other| *other > index).map(|other| &self.cores[other]) {
                let (from, to) = core.nearest_to(other);
                add(from, to);
            }
            if let Boundary::Circle { radius_m } = self.boundary {
                for end in [core.a, core.b] {
                    if let Some(outward) = end.coords.try_normalize(TIE_M) {
                        add(end + outward * core.radius_m, Point::from(outward * radius_m));
                    }
                }
            }
        }
        necks
    }
}

impl Core {
    /// Returns the two points, one on each outline, where two cores are nearest to each other.
    fn nearest_to(&self, other: &Self) -> (Point, Point) {
        let pairs = [
            (self.a, nearest_on_segment(other.a, other.b, self.a)),
            (self.b, nearest_on_segment(other.a, other.b, self.b)),
            (nearest_on_segment(self.a, self.b, other.a), other.a),
            (nearest_on_segment(self.a, self.b, other.b), other.b),
        ];
        let apart_m = |(one, other): &(Point, Point)| (other - one).norm();
        let (one, to) =
            pairs.into_iter().min_by(|a, b| apart_m(a).total_cmp(&apart_m(b))).unwrap_or(pairs[0]);
        let way = (to - one).try_normalize(0.0).unwrap_or_else(Vector::zeros);
        (one + way * self.radius_m, to - way * other.radius_m)
    }
}
