//! The cheapest way through a strip of offsets beside a course, by dynamic programming.

use field::{Room, room::MOST_SPARE_M};
use world::{Point, Vector};

/// The heading never changes by more than this in one place, radians.
pub const SHARPEST_RAD: f64 = std::f64::consts::PI / 6.0;
/// Weight of a change of offset beside the offset itself; it only decides between equals.
const CHANGE_WEIGHT: f64 = 1e-3;
const NOWHERE: u8 = u8::MAX;

/// A place of the course from which offsets are counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Where the course is.
    pub at: Point,
    /// Unit vector to its left.
    pub left: Vector,
    /// How many preset points it stands for.
    pub weight: f64,
    /// Largest change of heading per metre of path, radians.
    pub turn_per_m: f64,
}

/// How a way begins or ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// On the course and in this direction.
    Along(Vector),
    /// On the course, in any direction.
    On,
    /// At any offset.
    Anywhere,
}

/// Where to look for a way.
#[derive(Debug, Clone, Copy)]
pub struct Strip<'a> {
    /// The stations, at least two.
    pub stations: &'a [Station],
    /// Offset of the strip's middle at every station, metres to the left.
    pub middle_m: &'a [f64],
    /// Distance between neighbouring offsets, metres.
    pub cell_m: f64,
    /// Offsets on either side of the middle.
    pub half: usize,
    /// The offset changes by no more cells than this from station to station, beside what the middle does.
    pub most_change: usize,
    /// Whether the limit of the heading holds.
    pub limits_heading: bool,
    /// How it begins.
    pub enter: End,
    /// How it ends.
    pub leave: End,
}

/// What became of the search.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Offsets at every station, metres to the left.
    Way(Vec<f64>),
    /// No way leads past this station.
    Blocked {
        /// Index of the first station that cannot be reached.
        station: usize,
    },
}

/// A piece of way between two neighbouring stations.
#[derive(Debug, Clone, Copy)]
pub struct Edge {
    /// Unit vector along it.
    pub direction: Vector,
    /// Its length, metres.
    pub length_m: f64,
    /// Whether it keeps clear of everything.
    pub free: bool,
}

/// Ways to the offsets of one station, by offset and by the change of offset that led there.
struct Front {
    cost: Vec<f64>,
    came: Vec<Edge>,
}

const NO_EDGE: Edge = Edge { direction: Vector::new(0.0, 0.0), length_m: 0.0, free: false };

impl Strip<'_> {
    /// The way with the least sum of squared offsets that keeps its distance from everything and turns slowly enough.
    pub fn cheapest(&self, room: &Room) -> Found {
        let mut front = self.first_front(room);
        let mut back: Vec<Vec<u8>> = Vec::with_capacity(self.stations.len());
        for station in 1..self.stations.len() {
            let (next, came_from) = self.next_front(room, station, &front);
            if next.cost.iter().all(|cost| cost.is_infinite()) {
                return Found::Blocked { station };
            }
            back.push(came_from);
            front = next;
        }
        self.best_end(&front).map_or(Found::Blocked { station: self.stations.len() - 1 }, |state| {
            Found::Way(self.traced(state, &back))
        })
    }

    fn width(&self) -> usize {
        2 * self.half + 1
    }

    fn n_changes(&self) -> usize {
        2 * self.most_change + 1
    }

    fn offset_m(&self, station: usize, offset: usize) -> f64 {
        self.middle_m[station] + (offset as f64 - self.half as f64) * self.cell_m
    }

    fn place(&self, station: usize, offset: usize) -> Point {
        let Station { at, left, .. } = self.stations[station];
        at + left * self.offset_m(station, offset)
    }

    /// The offset reached from another one by a change, if it is within the strip.
    fn changed(&self, offset: usize, change: usize) -> Option<usize> {
        (offset + change).checked_sub(self.most_change).filter(|offset| *offset < self.width())
    }

    fn first_front(&self, room: &Room) -> Front {
        let n_states = self.width() * self.n_changes();
        let mut front = Front { cost: vec![f64::INFINITY; n_states], came: vec![NO_EDGE; n_states] };
        let direction = if let End::Along(direction) = self.enter { direction } else { Vector::zeros() };
        let length_m = (self.stations[1].at - self.stations[0].at).norm();
        for offset in 0..self.width() {
            let on_course = offset == self.half;
            let allowed = on_course || self.enter == End::Anywhere;
            if allowed && room.spare_m(self.place(0, offset)) >= 0.0 {
                let state = offset * self.n_changes() + self.most_change;
                front.cost[state] = self.stations[0].weight * self.offset_m(0, offset).powi(2);
                front.came[state] = Edge { direction, length_m, free: true };
            }
        }
        front
    }

    fn next_front(&self, room: &Room, station: usize, front: &Front) -> (Front, Vec<u8>) {
        let (n_changes, n_states) = (self.n_changes(), self.width() * self.n_changes());
        let mut next = Front { cost: vec![f64::INFINITY; n_states], came: vec![NO_EDGE; n_states] };
        let mut came_from = vec![NOWHERE; n_states];
        let free_turn = !self.limits_heading || (station == 1 && !matches!(self.enter, End::Along(_)));
        let turn_per_m = self.stations[station - 1].turn_per_m;
        let weight = self.stations[station].weight;
        for offset in 0..self.width() {
            let states = offset * n_changes..(offset + 1) * n_changes;
            if front.cost[states.clone()].iter().all(|cost| cost.is_infinite()) {
                continue;
            }
            let from = self.place(station - 1, offset);
            let spare_m = room.spare_m(from);
            for change in 0..n_changes {
                let Some(reached) = self.changed(offset, change) else { continue };
                let edge = edge(room, from, spare_m, self.place(station, reached));
                if !edge.free {
                    continue;
                }
                let offset_m = self.offset_m(station, reached);
                let moved_m = offset_m - self.offset_m(station - 1, offset);
                let price = weight * offset_m * offset_m + CHANGE_WEIGHT * moved_m * moved_m;
                let (mut best, mut best_came) = (f64::INFINITY, NOWHERE);
                for state in states.clone() {
                    let cost = front.cost[state];
                    if cost < best && (free_turn || turns_slowly(&front.came[state], &edge, turn_per_m)) {
                        (best, best_came) = (cost, (state - states.start) as u8);
                    }
                }
                let state = reached * n_changes + change;
                next.cost[state] = best + price;
                next.came[state] = edge;
                came_from[state] = best_came;
            }
        }
        (next, came_from)
    }

    fn best_end(&self, front: &Front) -> Option<usize> {
        let turn_per_m = self.stations[self.stations.len() - 1].turn_per_m;
        let fits = |state: usize| {
            let on_course = state / self.n_changes() == self.half;
            match self.leave {
                End::Anywhere => true,
                End::On => on_course,
                End::Along(direction) => {
                    let came = &front.came[state];
                    let onward = Edge { direction, ..*came };
                    on_course && (!self.limits_heading || turns_slowly(came, &onward, turn_per_m))
                }
            }
        };
        let states = (0..front.cost.len()).filter(|state| front.cost[*state].is_finite() && fits(*state));
        states.min_by(|a, b| front.cost[*a].total_cmp(&front.cost[*b]))
    }

    fn traced(&self, end: usize, back: &[Vec<u8>]) -> Vec<f64> {
        let mut state = end;
        let mut offsets_m = vec![self.offset_m(back.len(), state / self.n_changes())];
        for (station, came_from) in back.iter().enumerate().rev() {
            let (reached, change) = (state / self.n_changes(), state % self.n_changes());
            let offset = reached + self.most_change - change;
            offsets_m.push(self.offset_m(station, offset));
            state = offset * self.n_changes() + came_from[state] as usize;
        }
        offsets_m.reverse();
        offsets_m
    }
}

/// The straight way between two places, at the first of which so much room is left.
pub fn edge(room: &Room, from: Point, spare_m: f64, to: Point) -> Edge {
    let along = to - from;
    let length_m = along.norm();
    let surely_free = spare_m > length_m && length_m < MOST_SPARE_M;
    let free = length_m > 1e-9 && spare_m >= 0.0 && (surely_free || room.is_free(from, to));
    Edge { direction: along / length_m.max(1e-9), length_m, free }
}

/// Whether the heading changes by no more than the path's length allows.
pub fn turns_slowly(came: &Edge, next: &Edge, turn_per_m: f64) -> bool {
    let most_rad =
        (turn_per_m * (came.length_m + next.length_m) / 2.0).min(SHARPEST_RAD.max(turn_per_m * 0.2));
    let cosine = 1.0 - most_rad * most_rad / 2.0 * (1.0 - most_rad * most_rad / 12.0);
    came.direction.dot(&next.direction) >= cosine
}
