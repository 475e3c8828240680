//! What a path scans, cell by cell: a flat bar across the heading, as wide as the swath, that also sweeps when the
//! robot turns in place.
//!
//! The rows of cells are turned against the tank's axes. A planner that shortens paths as long as no cell is lost would
//! otherwise keep off every straight wall by the half cell that no row of centres represents.

use crate::{ground::Ground, slit::Slit};
use world::{Boundary, Point, Vector, shape};

mod bar;
pub use bar::Run;

/// Direction of the rows, radians from east: along no wall and no lanes that people build or plan.
const ROWS_RAD: f64 = 0.3;

/// A grid over the floor with the number of times that each cell was swept.
#[derive(Debug, Clone)]
pub struct FloorGrid {
    /// Unit vector along the rows.
    ahead: Vector,
    /// Where the first cell of the first row begins, along and across the rows, metres.
    low: Point,
    /// Edge of a cell, metres.
    pub cell_m: f64,
    /// Cells from west to east.
    pub columns: usize,
    /// Cells from south to north.
    pub rows: usize,
    /// Whether the tool can reach a cell.
    pub reachable: Vec<bool>,
    /// How often each cell was swept.
    pub swept: Vec<u16>,
    /// Number of cells that the tool can reach.
    pub n_reachable: usize,
    /// Number of cells that the tool can reach and that were swept.
    n_swept: usize,
    half_m: f64,
    stamp: Vec<u32>,
    epoch: u32,
    /// Number of exchanges so far.
    pub changes: u32,
}

/// Least and most coordinates of a wall along and across a direction, metres.
fn bounds_along(wall: &Boundary, ahead: Vector) -> (Point, Point) {
    match wall {
        Boundary::Circle { .. } => wall.bounds(),
        Boundary::Polygon { vertices } => {
            let turned = vertices.iter().map(|v| Point::new(ahead.dot(&v.coords), ahead.perp(&v.coords)));
            shape::bounds_of(&turned.collect::<Vec<Point>>())
        }
    }
}

impl FloorGrid {
    /// The floor that the tool can reach from the domain.
    pub fn new(ground: &Ground, slit: &Slit, cell_m: f64) -> Self {
        let ahead = crate::ground::direction(ROWS_RAD);
        let (low, high) = bounds_along(&ground.wall, ahead);
        let count = |span_m: f64| (span_m / cell_m).ceil().max(1.0) as usize;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        let mut grid = Self {
            ahead,
            low,
            cell_m,
            columns,
            rows,
            reachable: vec![false; columns * rows],
            swept: Vec::new(),
            n_reachable: 0,
            n_swept: 0,
            half_m: ground.swath_m / 2.0,
            stamp: Vec::new(),
            epoch: 0,
            changes: 0,
        };
        let mut free = vec![false; columns * rows];
        for triangle in slit.triangles() {
            grid.fill(&triangle, |cells| free[cells].fill(true));
        }
        let mut reachable = free.clone();
        // What the tool reaches beyond the middle of the hull lies within half a swath of the last free cells, as it
        // does when the mission counts.
        for cell in (0..free.len()).filter(|cell| free[*cell] && grid.is_at_edge(&free, *cell)) {
            let center = grid.center(cell);
            let mut fresh = Vec::new();
            let is_open = |other: usize| !reachable[other];
            grid.near(center, grid.half_m, is_open, |other, at| {
                fresh.extend(ground.is_floor(at).then_some(other));
            });
            for other in fresh {
                reachable[other] = true;
            }
        }
        grid.n_reachable = reachable.iter().filter(|r| **r).count();
        grid.swept = vec![0; reachable.len()];
        grid.stamp = vec![0; reachable.len()];
        grid.reachable = reachable;
        grid
    }

    /// Whether a cell has a neighbour, north, south, east or west, that is not free.
    fn is_at_edge(&self, free: &[bool], cell: usize) -> bool {
        let column = cell % self.columns;
        let is_free = |other: Option<usize>| other.is_some_and(|other| free.get(other) == Some(&true));
        let west = if column > 0 { Some(cell - 1) } else { None };
        let east = if column + 1 < self.columns { Some(cell + 1) } else { None };
        ![west, east, cell.checked_sub(self.columns), Some(cell + self.columns)].into_iter().all(is_free)
    }

    /// Leaves out what lies outside some polygons; without polygons nothing is left out.
    pub fn keep_within(&mut self, regions: &[&[Point]]) {
        if regions.is_empty() {
            return;
        }
        for cell in 0..self.reachable.len() {
            let at = self.center(cell);
            self.reachable[cell] = self.reachable[cell] && regions.iter().any(|ring| ring_contains(ring, at));
        }
        self.n_reachable = self.reachable.iter().filter(|r| **r).count();
    }

    /// Whether there is floor to scan within half a swath of a place.
    pub fn has_reachable_near(&self, at: Point) -> bool {
        let mut found = false;
        self.near(at, self.half_m, |cell| self.reachable[cell], |_, _| found = true);
        found
    }

    /// Area of the floor that the tool can reach, square metres.
    pub fn area_m2(&self) -> f64 {
        self.n_reachable as f64 * self.cell_m * self.cell_m
    }

    /// Number of whole cells in an area, square metres; at least 1.
    pub fn cells_in(&self, area_m2: f64) -> usize {
        // Rounding must not lose a cell of 0.05 m of four.
        ((area_m2 / (self.cell_m * self.cell_m) + 1e-6) as usize).max(1)
    }

    /// Share of the reachable floor that was swept.
    pub fn coverage(&self) -> f64 {
        self.n_swept as f64 / self.n_reachable.max(1) as f64
    }

    /// Centre of a cell.
    pub fn center(&self, cell: usize) -> Point {
        let (column, row) = (cell % self.columns, cell / self.columns);
        let here = self.low + Vector::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell_m;
        Point::from(self.ahead * here.x + Vector::new(-self.ahead.y, self.ahead.x) * here.y)
    }

    /// A place by its coordinates along and across the rows.
    fn along_rows(&self, at: Point) -> Point {
        Point::new(self.ahead.dot(&at.coords), self.ahead.perp(&at.coords))
    }

    /// The floor alone, without room for sweeps.
    #[must_use]
    pub fn without_sweeps(&self) -> Self {
        Self { swept: Vec::new(), stamp: Vec::new(), reachable: self.reachable.clone(), ..*self }
    }

    /// The same floor with nothing swept.
    #[must_use]
    pub fn unswept(&self) -> Self {
        let cells = self.reachable.len();
        Self {
            swept: vec![0; cells],
            stamp: vec![0; cells],
            reachable: self.reachable.clone(),
            n_swept: 0,
            ..*self
        }
    }

    /// Forgets what was swept.
    pub fn clear(&mut self) {
        self.swept.fill(0);
        self.n_swept = 0;
    }

    /// Sweeps along a path.
    pub fn sweep(&mut self, path: &[Point]) {
        let mut swept = std::mem::take(&mut self.swept);
        self.along(path, |cells| swept[cells].iter_mut().for_each(|n| *n = n.saturating_add(1)));
        self.n_swept = swept.iter().zip(&self.reachable).filter(|(n, r)| **n > 0 && **r).count();
        self.swept = swept;
    }

    /// Cells under the bar on its way along a path; some may come several times.
    pub fn runs(&self, path: &[Point]) -> Vec<Run> {
        let mut runs = Vec::new();
        self.along(path, |cells| runs.push(Run::from(cells)));
        runs
    }

    /// What [`Self::exchange`] would lose: it is made and taken back.
    pub fn lost_by(&mut self, old: &[Run], new: &[Run]) -> i64 {
        let before = self.n_swept;
        let (lost, is_sound) = self.exchanged(old, new);
        if !is_sound {
            // More was taken back than there was: so much for the quick way.
            self.exchanged(new, old);
            return lost;
        }
        for run in old {
            self.swept[run.cells()].iter_mut().for_each(|n| *n = n.saturating_add(1));
        }
        for run in new {
            self.swept[run.cells()].iter_mut().for_each(|n| *n = n.saturating_sub(1));
        }
        self.n_swept = before;
        lost
    }

    /// Takes one sweep back and makes another; the number of reachable cells that are lost, net.
    pub fn exchange(&mut self, old: &[Run], new: &[Run]) -> i64 {
        self.exchanged(old, new).0
    }

    /// The same, and whether every reachable cell was swept whenever that was taken back.
    fn exchanged(&mut self, old: &[Run], new: &[Run]) -> (i64, bool) {
        self.changes += 1;
        let (mut won, mut left, mut unswept) = (0_usize, 0_usize, 0_usize);
        for cells in new.iter().map(|run| run.cells()) {
            let mut fresh = 0_u16;
            for (n, reachable) in self.swept[cells.clone()].iter_mut().zip(&self.reachable[cells]) {
                fresh += u16::from(*n == 0 && *reachable);
                *n = n.saturating_add(1);
            }
            won += usize::from(fresh);
        }
        for cells in old.iter().map(|run| run.cells()) {
            let (mut empty, mut was_empty) = (0_u16, 0_u16);
            for (n, reachable) in self.swept[cells.clone()].iter_mut().zip(&self.reachable[cells]) {
                was_empty += u16::from(*n == 0 && *reachable);
                *n = n.saturating_sub(1);
                empty += u16::from(*n == 0 && *reachable);
            }
            left += usize::from(empty);
            unswept += usize::from(empty - was_empty);
        }
        self.n_swept = self.n_swept + won - unswept;
        (left as i64 - won as i64, left == unswept)
    }

    /// Whether one sweep in place of another certainly loses more than so many reachable cells, net: a quick look that
    /// stops as soon as it is sure. The old one comes side by side.
    pub fn loses_more<'a>(
        &mut self,
        old: impl IntoIterator<Item = &'a [Run]>,
        new: &[Run],
        most: i64,
    ) -> bool {
        self.epoch += 1;
        let epoch = self.epoch;
        let mut lost = 0_i64;
        for run in new {
            for cell in run.cells() {
                lost -= i64::from(self.swept[cell] == 0 && self.stamp[cell] != epoch && self.reachable[cell]);
                self.stamp[cell] = epoch;
            }
        }
        old.into_iter().any(|side| {
            for run in side {
                for cell in run.cells() {
                    let is_alone = self.swept[cell] == 1 && self.stamp[cell] != epoch;
                    lost += i64::from(is_alone && self.reachable[cell]);
                }
            }
            lost > most
        }) || lost > most
    }

    /// Width of the bar, metres.
    pub fn bar_m(&self) -> f64 {
        2.0 * self.half_m
    }

    /// Whether a place is reachable floor that was swept just once.
    pub fn is_alone(&self, at: Point) -> bool {
        let here = (self.along_rows(at) - self.low) / self.cell_m;
        let (x, y) = (here.x, here.y);
        if x < 0.0 || y < 0.0 || x >= self.columns as f64 || y >= self.rows as f64 {
            return false;
        }
        let cell = y as usize * self.columns + x as usize;
        self.swept[cell] == 1 && self.reachable[cell]
    }

    /// Number of reachable cells that nothing but these runs sweeps.
    pub fn alone(&self, runs: &[Run]) -> u32 {
        self.swept_so_often(1, runs)
    }

    /// Number of reachable cells that these runs would sweep for the first time, or more: some may count twice.
    pub fn missed_under(&self, runs: &[Run]) -> u32 {
        self.swept_so_often(0, runs)
    }

    fn swept_so_often(&self, often: u16, runs: &[Run]) -> u32 {
        let count = |cells: std::ops::Range<usize>| {
            let both = self.swept[cells.clone()].iter().zip(&self.reachable[cells]);
            both.map(|(n, reachable)| u16::from(*n == often && *reachable)).sum::<u16>()
        };
        runs.iter().map(|run| u32::from(count(run.cells()))).sum()
    }

    /// Number of reachable cells that a path would sweep for the first time.
    pub fn would_gain(&self, path: &[Point]) -> usize {
        let mut seen = std::collections::BTreeSet::new();
        self.along(path, |cells| {
            seen.extend(cells.filter(|cell| self.swept[*cell] == 0 && self.reachable[*cell]));
        });
        seen.len()
    }

    /// Those of the meant cells whose centres lie within a distance of a place.
    fn near(
        &self,
        place: Point,
        reach_m: f64,
        is_meant: impl Fn(usize) -> bool,
        mut visit: impl FnMut(usize, Point),
    ) {
        let reach = Vector::new(reach_m, reach_m);
        let place_here = self.along_rows(place);
        let (from, to) = (place_here - reach - self.low, place_here + reach - self.low);
        let index = |m: f64, most: usize| (m / self.cell_m).floor().clamp(0.0, most as f64 - 1.0) as usize;
        for row in index(from.y, self.rows)..=index(to.y, self.rows) {
            for column in index(from.x, self.columns)..=index(to.x, self.columns) {
                let cell = row * self.columns + column;
                if is_meant(cell) {
                    let at = self.center(cell);
                    if (at - place).norm() <= reach_m {
                        visit(cell, at);
                    }
                }
            }
        }
    }

    /// Groups of neighbouring cells that the tool could reach and has not swept, largest first.
    pub fn missed(&self) -> Vec<Vec<usize>> {
        let mut open: Vec<bool> =
            self.reachable.iter().zip(&self.swept).map(|(r, s)| *r && *s == 0).collect();
        let mut groups = Vec::new();
        for first in 0..open.len() {
            if !std::mem::replace(&mut open[first], false) {
                continue;
            }
            let mut group = vec![first];
            let mut next = 0;
            while next < group.len() {
                let (column, row) = (group[next] % self.columns, group[next] / self.columns);
                next += 1;
                for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, 1), (-1, 1), (1, -1)] {
                    let (Some(x), Some(y)) = (column.checked_add_signed(dx), row.checked_add_signed(dy))
                    else {
                        continue;
                    };
                    if x < self.columns
                        && y < self.rows
                        && std::mem::replace(&mut open[y * self.columns + x], false)
                    {
                        group.push(y * self.columns + x);
                    }
                }
            }
            groups.push(group);
        }
        groups.sort_by_key(|group| std::cmp::Reverse(group.len()));
        groups
    }
}

/// Whether a point lies inside a simple polygon.
fn ring_contains(ring: &[Point], at: Point) -> bool {
    ring.iter().zip(ring.iter().cycle().skip(1)).fold(false, |inside, (a, b)| {
        let crosses = (a.y > at.y) != (b.y > at.y) && at.x < (b.x - a.x) * (at.y - a.y) / (b.y - a.y) + a.x;
        inside != crosses
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trials::tanks::{Known, Tank};

    fn empty() -> FloorGrid {
        let tank = Tank { columns: Vec::new(), ..Known::E1.tank(0) };
        let ground = Ground::new(&tank.site(&[]), tank.anchor).unwrap();
        let slit = Slit::new(&ground, &[], ground.home()).unwrap();
        FloorGrid::new(&ground, &slit, 0.1)
    }

    fn path() -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64).prop_map(|(x, y)| Point::new(x, y)), 2..6)
    }

    proptest! {
        #[test]
        fn a_straight_way_sweeps_what_lies_within_half_a_swath_beside_it(
            a in (-9.0..9.0_f64, -9.0..9.0_f64),
            b in (-9.0..9.0_f64, -9.0..9.0_f64),
        ) {
            let (a, b) = (Point::new(a.0, a.1), Point::new(b.0, b.1));
            prop_assume!((b - a).norm() > 0.01);
            let mut grid = empty();
            grid.sweep(&[a, b]);
            let ahead = (b - a).normalize();
            for cell in 0..grid.swept.len() {
                let offset = grid.center(cell) - a;
                let (along, beside) = (ahead.dot(&offset), ahead.perp(&offset).abs());
                let depth = along.min((b - a).norm() - along).min(grid.half_m - beside);
                prop_assert!(depth.abs() < 1e-6 || (depth > 0.0) == (grid.swept[cell] == 1));
            }
        }

        #[test]
        fn an_exchange_of_ways_is_counted_as_it_is_made_and_can_be_asked_for_first(
            ways in prop::collection::vec(path(), 1..4),
            new in path(),
        ) {
            let mut grid = empty();
            for way in &ways {
                grid.sweep(way);
            }
            let (old, new) = (grid.runs(&ways[0]), grid.runs(&new));
            let (before, coverage) = (grid.swept.clone(), grid.coverage());
            let asked = grid.lost_by(&old, &new);
            prop_assert!(grid.swept == before && grid.coverage().to_bits() == coverage.to_bits());
            prop_assert_eq!(grid.exchange(&old, &new), asked);
            let lost = (coverage - grid.coverage()) * grid.n_reachable as f64;
            prop_assert!((lost - asked as f64).abs() < 1e-6);
            let count = grid.swept.iter().zip(&grid.reachable).filter(|(n, r)| **n > 0 && **r).count();
            prop_assert_eq!(count, grid.n_swept);
            prop_assert!(!grid.loses_more([&old[..]], &new, i64::MAX - 1));
        }

        #[test]
        fn taking_back_what_was_not_swept_is_noticed(way in path()) {
            let mut grid = empty();
            let runs = grid.runs(&way);
            let (lost, is_sound) = grid.exchanged(&runs, &[]);
            prop_assert_eq!(grid.n_swept, 0);
            prop_assert_eq!(lost == 0, is_sound);
        }
    }
}
