//! The ways of the hull over floor that is known to be free.

use crate::{distances::distances_m, grid::Grid, grown::Solids, survey::Exploration};
use geometry::{Point, Shape};
use std::{cmp::Reverse, collections::BinaryHeap};

/// Additional room, metres, below which a way costs more, and the additional cost per metre without any.
const SPARE_M: f64 = 0.3;
const TIGHT: f64 = 1.0;
/// Maximum distance from a place to the nearest place with room, metres: the position scatters, and a new echo may be
/// close to the hull.
const ASIDE_M: f64 = 0.5;

/// The ways of the hull's centre from one place to all places that it can reach over free floor.
pub struct Ways<'a> {
    pub(crate) of: &'a Exploration,
    /// Room that the hull's centre keeps, metres.
    pub(crate) room_m: f64,
    /// Distance to the nearest cell that is not known to be free, metres.
    spare_m: Vec<f32>,
    /// The cost of the way to each cell, metres.
    cost_m: Vec<f32>,
    /// The cell before each cell on its way.
    before: Vec<u32>,
    from: Point,
}

/// An entry of the queue: the cost in units of 0.1 mm, so that the order is total, and the cell.
type Due = Reverse<(u64, u32)>;

impl Exploration {
    /// The ways from a place for a hull whose centre keeps `room_m` metres from everything that is not known to be free,
    /// and from some shapes.
    ///
    /// Cost: proportional to the number of cells, times its logarithm.
    pub fn ways<'a>(&self, from: Point, room_m: f64, solids: impl Iterator<Item = &'a Shape>) -> Ways<'_> {
        let solids = Solids::new(&self.grid, solids);
        let room_m = room_m + 0.5 * self.grid.cell_m;
        let spare_m = distances_m(&self.grid, |cell| !self.is_free(cell) || solids.contains(cell));
        let mut ways = Ways {
            of: self,
            room_m,
            spare_m,
            cost_m: vec![f32::INFINITY; self.grid.len()],
            before: vec![u32::MAX; self.grid.len()],
            from,
        };
        ways.search();
        ways
    }
}

impl Ways<'_> {
    /// Whether the hull has no room at the beginning, so that no way leads anywhere.
    pub fn is_empty(&self) -> bool {
        self.firsts().is_empty()
    }

    fn has_room(&self, cell: usize) -> bool {
        f64::from(self.spare_m[cell]) >= self.room_m
    }

    /// The cells where the ways begin, each with its distance: those with room that the hull can enter without coming
    /// nearer to anything than it is; without such a cell, the nearest one with room. Several, because the nearest one may be
    /// in a pocket from which no way leads on.
    fn firsts(&self) -> Vec<(usize, f64)> {
        let grid = &self.of.grid;
        let near = geometry::Vector::repeat(ASIDE_M);
        let away_m = |cell: usize| (grid.center(cell) - self.from).norm();
        let roomy = grid.within(self.from - near, self.from + near).filter(|cell| self.has_room(*cell));
        let mut roomy: Vec<(usize, f64)> =
            roomy.map(|cell| (cell, away_m(cell))).filter(|(_, away_m)| *away_m <= ASIDE_M).collect();
        let has_m = self.spare_at_m(self.from) - grid.cell_m;
        let enters = |(cell, _): &(usize, f64)| self.keeps_m(self.from, grid.center(*cell), has_m);
        let entered: Vec<(usize, f64)> = roomy.iter().copied().filter(enters).collect();
        if entered.is_empty() {
            roomy.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            roomy.truncate(1);
            return roomy;
        }
        entered
    }

    fn search(&mut self) {
        let mut queue: BinaryHeap<Due> = BinaryHeap::new();
        for (first, away_m) in self.firsts() {
            let cost_m = (away_m * (1.0 + TIGHT)) as f32;
            self.cost_m[first] = cost_m;
            queue.push(Reverse((units(cost_m), first as u32)));
        }
        while let Some(Reverse((cost, cell))) = queue.pop() {
            let cell = cell as usize;
            if cost > units(self.cost_m[cell]) {
                continue;
            }
            for next in self.of.grid.around(cell, 1).filter(|next| *next != cell) {
                if !self.has_room(next) {
                    continue;
                }
                let cost_m = self.cost_m[cell] + self.step_m(cell, next);
                if cost_m < self.cost_m[next] {
                    (self.cost_m[next], self.before[next]) = (cost_m, cell as u32);
                    queue.push(Reverse((units(cost_m), next as u32)));
                }
            }
        }
    }

    fn step_m(&self, from: usize, to: usize) -> f32 {
        let grid = &self.of.grid;
        let is_straight =
            from % grid.columns == to % grid.columns || from / grid.columns == to / grid.columns;
        let length_m = if is_straight { grid.cell_m } else { grid.cell_m * std::f64::consts::SQRT_2 };
        let lack = (1.0 - (f64::from(self.spare_m[to]) - self.room_m) / SPARE_M).max(0.0);
        (length_m * (1.0 + TIGHT * lack)) as f32
    }

    /// The cost of the way to a cell, metres; infinite if there is none.
    pub(crate) fn cost_m(&self, cell: usize) -> f64 {
        f64::from(self.cost_m[cell])
    }

    /// The way to a place or, if the hull has no room there, to the nearest place with room within half a metre of it;
    /// `None` if no way over known floor leads there.
    pub fn to(&self, goal: Point) -> Option<Vec<Point>> {
        let grid = &self.of.grid;
        let last = self.near(goal)?;
        let mut way = self.to_cell(last);
        if grid.index(goal) == Some(last) {
            way.pop();
            way.push(goal);
        }
        Some(way)
    }

    /// The reached cell nearest to a place, within half a metre of it.
    pub(crate) fn near(&self, place: Point) -> Option<usize> {
        let grid = &self.of.grid;
        let near = geometry::Vector::repeat(ASIDE_M);
        let away_m = |cell: usize| (grid.center(cell) - place).norm();
        let reached = grid.within(place - near, place + near).filter(|cell| self.cost_m[*cell].is_finite());
        let reached = reached.filter(|cell| away_m(*cell) <= ASIDE_M);
        reached.min_by(|a, b| away_m(*a).total_cmp(&away_m(*b)).then(a.cmp(b)))
    }

    /// The way to a cell that has one, as a chain of points, without the detours along the lattice.
    pub(crate) fn to_cell(&self, last: usize) -> Vec<Point> {
        let grid = &self.of.grid;
        let mut cells = vec![last];
        let mut at = last;
        while self.before[at] != u32::MAX {
            at = self.before[at] as usize;
            cells.push(at);
        }
        cells.reverse();
        let points: Vec<Point> = cells.iter().map(|cell| grid.center(*cell)).collect();
        let mut way = vec![self.from];
        let mut at = 0;
        if (points[0] - self.from).norm() > grid.cell_m {
            way.push(points[0]);
        }
        while at + 1 < points.len() {
            let here = way[way.len() - 1];
            let mut next = at + 1;
            // Longer jumps are tried in doubling steps, then the longest one is made longer cell by cell.
            let mut step = 1;
            while at + step < points.len() && self.is_clear(here, points[at + step]) {
                next = at + step;
                step *= 2;
            }
            while next + 1 < points.len() && self.is_clear(here, points[next + 1]) {
                next += 1;
            }
            way.push(points[next]);
            at = next;
        }
        way
    }

    /// Distance from a place to the nearest floor that is not known to be free, metres; 0 off the lattice.
    pub fn spare_at_m(&self, at: Point) -> f64 {
        self.of.grid.index(at).map_or(0.0, |cell| f64::from(self.spare_m[cell]))
    }

    /// Whether the hull has room everywhere on a segment.
    pub fn is_clear(&self, from: Point, to: Point) -> bool {
        self.keeps_m(from, to, self.room_m)
    }

    /// Whether the hull's centre keeps a distance, metres, from everything that is not known to be free on a segment.
    fn keeps_m(&self, from: Point, to: Point, least_m: f64) -> bool {
        let n = ((to - from).norm() / (0.5 * self.of.grid.cell_m)).ceil().max(1.0) as u32;
        (0..=n).all(|k| {
            let at = from + (to - from) * (f64::from(k) / f64::from(n));
            self.of.grid.index(at).is_some_and(|cell| f64::from(self.spare_m[cell]) >= least_m)
        })
    }

    /// Whether no point between two places is on a cell that is not known to be free.
    pub(crate) fn is_in_sight(&self, from: Point, to: Point) -> bool {
        let n = ((to - from).norm() / (0.5 * self.of.grid.cell_m)).ceil().max(1.0) as u32;
        (0..n).all(|k| self.of.is_free_at(from + (to - from) * (f64::from(k) / f64::from(n))))
    }

    /// The lattice of the map.
    pub fn grid(&self) -> &Grid {
        &self.of.grid
    }
}

fn units(cost_m: f32) -> u64 {
    (f64::from(cost_m) * 1e4) as u64
}
