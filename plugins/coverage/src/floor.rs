//! What a path scans, cell by cell: a flat bar across the heading, as wide as the swath, that also sweeps when the
//! robot turns in place.

use crate::{ground::Ground, slit::Slit};
use std::ops::Range;
use world::{Point, Vector};

/// Turns smaller than this leave no gap worth filling, radians.
const SMALL_TURN_RAD: f64 = 2e-3;
/// A turn is drawn in wedges of this angle, radians.
const WEDGE_RAD: f64 = 0.35;
/// Corners of the largest fan of wedges: half a turn, and the middle.
const FAN: usize = 11;

/// The end of a closed range as the start of what lies behind it.
const NEXT: f64 = 1e-9;

/// The first index that is not below a place.
fn index_from(place: f64) -> usize {
    // Truncation is quicker than rounding up, and negative places become 0.
    let below = place as usize;
    below + usize::from(place > below as f64)
}

/// A grid over the floor with the number of times that each cell was swept.
#[derive(Debug, Clone)]
pub struct FloorGrid {
    /// South west corner, metres.
    pub low: Point,
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
    half_m: f64,
    stamp: Vec<u32>,
    epoch: u32,
}

impl FloorGrid {
    /// The floor that the tool can reach from the domain.
    pub fn new(ground: &Ground, slit: &Slit, cell_m: f64) -> Self {
        let (low, high) = ground.wall.bounds();
        let count = |span_m: f64| (span_m / cell_m).ceil().max(1.0) as usize;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        let mut grid = Self {
            low,
            cell_m,
            columns,
            rows,
            reachable: vec![false; columns * rows],
            swept: Vec::new(),
            n_reachable: 0,
            half_m: ground.swath_m / 2.0,
            stamp: Vec::new(),
            epoch: 0,
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
            grid.near(center, center, grid.half_m, |other, at| {
                if !reachable[other] && ground.is_floor(at) {
                    reachable[other] = true;
                }
            });
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
        self.near(at, at, self.half_m, |cell, _| found |= self.reachable[cell]);
        found
    }

    /// Area of the floor that the tool can reach, square metres.
    pub fn area_m2(&self) -> f64 {
        self.n_reachable as f64 * self.cell_m * self.cell_m
    }

    /// Share of the reachable floor that was swept.
    pub fn coverage(&self) -> f64 {
        let swept = self.swept.iter().zip(&self.reachable).filter(|(s, r)| **s > 0 && **r).count();
        swept as f64 / self.n_reachable.max(1) as f64
    }

    /// Centre of a cell.
    pub fn center(&self, cell: usize) -> Point {
        let (column, row) = (cell % self.columns, cell / self.columns);
        self.low + Vector::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell_m
    }

    /// Sweeps along a path.
    pub fn sweep(&mut self, path: &[Point]) {
        let mut swept = std::mem::take(&mut self.swept);
        self.along(path, |cells| swept[cells].iter_mut().for_each(|n| *n = n.saturating_add(1)));
        self.swept = swept;
    }

    /// Takes one path back and sweeps another; the number of reachable cells that are lost, net.
    pub fn exchange(&mut self, old: &[Point], new: &[Point]) -> i64 {
        let mut swept = std::mem::take(&mut self.swept);
        let mut lost = 0_i64;
        let reachable = &self.reachable;
        self.along(new, |cells| {
            let mut won = 0_u16;
            for (n, reachable) in swept[cells.clone()].iter_mut().zip(&reachable[cells]) {
                won += u16::from(*n == 0 && *reachable);
                *n = n.saturating_add(1);
            }
            lost -= i64::from(won);
        });
        self.along(old, |cells| {
            let mut left = 0_u16;
            for (n, reachable) in swept[cells.clone()].iter_mut().zip(&reachable[cells]) {
                *n = n.saturating_sub(1);
                left += u16::from(*n == 0 && *reachable);
            }
            lost += i64::from(left);
        });
        self.swept = swept;
        lost
    }

    /// Whether one path in place of another certainly loses more than so many reachable cells, net: a quick look that
    /// stops as soon as it is sure.
    pub fn loses_more(&mut self, old: &[Point], new: &[Point], most: i64) -> bool {
        self.epoch += 1;
        let mut stamp = std::mem::take(&mut self.stamp);
        let epoch = self.epoch;
        let mut lost = 0_i64;
        self.along(new, |cells| {
            for cell in cells {
                lost -= i64::from(self.swept[cell] == 0 && stamp[cell] != epoch && self.reachable[cell]);
                stamp[cell] = epoch;
            }
        });
        let sides = old.len() - 1;
        // From the middle outward: there the two paths differ most.
        for k in 0..sides {
            let side = if k % 2 == 0 { sides / 2 + k / 2 } else { sides / 2 - k.div_ceil(2) };
            if side < sides {
                self.along(&old[side..=side + 1], |cells| {
                    for cell in cells {
                        lost +=
                            i64::from(self.swept[cell] == 1 && stamp[cell] != epoch && self.reachable[cell]);
                    }
                });
            }
            if lost > most {
                break;
            }
        }
        self.stamp = stamp;
        lost > most
    }

    /// Width of the bar, metres.
    pub fn bar_m(&self) -> f64 {
        2.0 * self.half_m
    }

    /// Whether a place is reachable floor that was swept just once.
    pub fn is_alone(&self, at: Point) -> bool {
        let (x, y) = ((at.x - self.low.x) / self.cell_m, (at.y - self.low.y) / self.cell_m);
        if x < 0.0 || y < 0.0 || x >= self.columns as f64 || y >= self.rows as f64 {
            return false;
        }
        let cell = y as usize * self.columns + x as usize;
        self.swept[cell] == 1 && self.reachable[cell]
    }

    /// Number of reachable cells that nothing but this part of the path sweeps.
    pub fn alone(&self, path: &[Point]) -> u32 {
        let mut count = 0;
        self.along(path, |cells| {
            let both = self.swept[cells.clone()].iter().zip(&self.reachable[cells]);
            count += both.map(|(n, reachable)| u32::from(*n == 1 && *reachable)).sum::<u32>();
        });
        count
    }

    /// Number of reachable cells that a path would sweep for the first time, or more: some may count twice.
    pub fn missed_under(&self, path: &[Point]) -> u32 {
        let mut count = 0;
        self.along(path, |cells| {
            let both = self.swept[cells.clone()].iter().zip(&self.reachable[cells]);
            count += both.map(|(n, reachable)| u32::from(*n == 0 && *reachable)).sum::<u32>();
        });
        count
    }

    /// Number of reachable cells that a path would sweep for the first time.
    pub fn would_gain(&self, path: &[Point]) -> usize {
        let mut seen = std::collections::BTreeSet::new();
        self.along(path, |cells| {
            seen.extend(cells.filter(|cell| self.swept[*cell] == 0 && self.reachable[*cell]));
        });
        seen.len()
    }

    /// Every cell under the bar on its way along a path, in runs of one row each; a cell may come several times.
    pub fn along(&self, path: &[Point], mut visit: impl FnMut(Range<usize>)) {
        let mut before: Option<Vector> = None;
        for pair in path.windows(2) {
            let Some(ahead) = (pair[1] - pair[0]).try_normalize(1e-9) else { continue };
            if let Some(before) = before {
                self.turn(pair[0], before, ahead, &mut visit);
            }
            let side = Vector::new(-ahead.y, ahead.x) * self.half_m;
            self.fill(&[pair[0] - side, pair[1] - side, pair[1] + side, pair[0] + side], &mut visit);
            before = Some(ahead);
        }
    }

    fn turn(&self, at: Point, from: Vector, to: Vector, visit: &mut impl FnMut(Range<usize>)) {
        let (across, along) = (from.perp(&to), from.dot(&to));
        if across.abs() < SMALL_TURN_RAD && along > 0.0 {
            return;
        }
        let turn = across.atan2(along);
        let n = (turn.abs() / WEDGE_RAD).ceil();
        let (sin, cos) = (turn / n).sin_cos();
        let mut rim = Vector::new(-from.y, from.x) * self.half_m;
        let mut fans = [[at; FAN]; 2];
        for k in 0..=n as usize {
            (fans[0][k + 1], fans[1][k + 1]) = (at + rim, at - rim);
            rim = Vector::new(rim.x * cos - rim.y * sin, rim.x * sin + rim.y * cos);
        }
        for fan in fans {
            self.fill(&fan[..n as usize + 2], &mut *visit);
        }
    }

    /// Every cell whose centre lies in a convex polygon, in either sense, row by row.
    fn fill(&self, polygon: &[Point], mut visit: impl FnMut(Range<usize>)) {
        let low = polygon.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let high = polygon.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let row_of = |y: f64| (y - self.low.y) / self.cell_m - 0.5;
        let column_of = |x: f64| (x - self.low.x) / self.cell_m - 0.5;
        let (first, past) = (index_from(row_of(low)), index_from(row_of(high) + NEXT).min(self.rows));
        for row in first..past {
            let y = self.low.y + (row as f64 + 0.5) * self.cell_m;
            let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
            let mut a = polygon[polygon.len() - 1];
            for b in polygon {
                if (a.y <= y) != (b.y <= y) {
                    let x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
                    (from, to) = (from.min(x), to.max(x));
                }
                a = *b;
            }
            let (left, past) =
                (index_from(column_of(from)), index_from(column_of(to) + NEXT).min(self.columns));
            if left < past {
                visit(row * self.columns + left..row * self.columns + past);
            }
        }
    }

    /// Every cell whose centre lies within a distance of a segment.
    pub fn near(&self, a: Point, b: Point, reach_m: f64, mut visit: impl FnMut(usize, Point)) {
        let reach = Vector::new(reach_m, reach_m);
        let (from, to) = (a.inf(&b) - reach - self.low, a.sup(&b) + reach - self.low);
        let index = |m: f64, most: usize| (m / self.cell_m).floor().clamp(0.0, most as f64 - 1.0) as usize;
        for row in index(from.y, self.rows)..=index(to.y, self.rows) {
            for column in index(from.x, self.columns)..=index(to.x, self.columns) {
                let cell = row * self.columns + column;
                let at = self.center(cell);
                if (at - world::polyline::nearest_on_segment(a, b, at)).norm() <= reach_m {
                    visit(cell, at);
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
