//! Simplifies outlines on the safe side: floor may be lost, but none is gained.
//!
//! A chord between two corners of an outline replaces the chain between them if the whole chain is on its solid side.
//! The floor between chord and chain, the *pocket*, becomes solid; no part of the pocket may be farther from a solid
//! cell than the tolerance. No cell belongs to two pockets, so outlines never cross, and the cell of a point determines
//! its pocket.

use crate::contour::{Component, Node};
use std::collections::HashMap;

/// The largest number of outline corners that one chord may replace, and the largest number of cell edges along them.
const LONGEST_CHAIN: usize = 32;
const MOST_EDGES: i32 = 64;
/// The number of failed chords after which a corner is kept.
const MOST_FAILED: usize = 6;
/// Slack for sums of areas and distances, in cells.
const ROUNDING: f64 = 1e-9;

/// A straight edge of an outline, with the solid side to the right.
pub(crate) type Chord = [Node; 2];

/// Outlines after simplification, in lattice coordinates.
pub(crate) struct Simplified {
    /// Closed chains of corners, with the floor to the left.
    pub rings: Vec<Vec<Node>>,
    /// The chord that cuts each partly solid free cell.
    pub chords: HashMap<Node, Chord>,
    /// The largest distance in cells between floor that became solid and the nearest solid cell.
    pub error_cells: f64,
}

impl Simplified {
    /// Simplifies the outlines of a component by at most `tolerance` cells.
    pub(crate) fn new(component: &Component, tolerance: f64) -> Self {
        let mut simplified = Self { rings: Vec::new(), chords: HashMap::new(), error_cells: 0.0 };
        for ring in component.rings() {
            let short = simplified.shorten(component, ring, tolerance);
            simplified.rings.push(without_collinear(&short));
        }
        simplified
    }

    /// Whether a point in a cell is free; for a point on a chord, the answer can be either.
    pub(crate) fn is_free(&self, component: &Component, x: f64, y: f64) -> bool {
        let cell = [x.floor() as i32, y.floor() as i32];
        component.is_free(cell) && self.chords.get(&cell).is_none_or(|chord| side(*chord, [x, y]) > 0.0)
    }

    fn shorten(&mut self, component: &Component, mut ring: Vec<Node>, tolerance: f64) -> Vec<Node> {
        let n = ring.len();
        // Chords begin at solid corners; an outline without solid corners cannot be simplified.
        let turn = |k: usize| cross(ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]);
        let Some(first) = (0..n).find(|k| turn(*k) < 0) else { return ring };
        ring.rotate_left(first);
        ring.push(ring[0]);
        let mut kept = Vec::new();
        let mut at = 0;
        while at < n {
            kept.push(ring[at]);
            // Always keep two corners of the outline.
            let last = (at + LONGEST_CHAIN).min(n).min(at + n.saturating_sub(2));
            let (mut best, mut n_failed) = (None, 0);
            for to in at + 2..=last {
                match Pocket::new(component, &ring[at..=to], tolerance, &self.chords) {
                    Some(pocket) => (best, n_failed) = (Some((to, pocket)), 0),
                    None => n_failed += 1,
                }
                if n_failed > MOST_FAILED {
                    break;
                }
            }
            at = match best {
                None => at + 1,
                Some((to, pocket)) => {
                    let chord = [ring[at], ring[to]];
                    self.chords.extend(pocket.cells.into_iter().map(|cell| (cell, chord)));
                    self.error_cells = self.error_cells.max(pocket.error);
                    to
                }
            };
        }
        kept
    }
}

/// The floor between a chord and the chain that it replaces.
struct Pocket {
    cells: Vec<Node>,
    error: f64,
}

impl Pocket {
    /// The pocket of a chain, if its chord is safe and within the tolerance.
    fn new(
        component: &Component,
        chain: &[Node],
        tolerance: f64,
        taken: &HashMap<Node, Chord>,
    ) -> Option<Self> {
        let (first, last) = (chain[0], chain[chain.len() - 1]);
        let chord = [first, last];
        let is_solid_side = |node: &Node| cross(first, last, *node) <= 0;
        if first == last || !chain.iter().all(is_solid_side) {
            return None;
        }
        let mut cells = cells_along(chain)?;
        cells.sort_unstable();
        cells.dedup();
        let (mut area, mut error) = (0.0, 0.0_f64);
        let mut n_whole = 0;
        let mut within = Vec::new();
        for cell in cells {
            let region = clipped(cell, chord);
            let region_area = area_of(&region);
            if region_area < ROUNDING {
                continue;
            }
            if taken.contains_key(&cell) {
                return None;
            }
            let sides = Sides::of(component, cell);
            // Do not fill a slot that the robot might be able to enter, however narrow its cells are.
            n_whole += usize::from(sides.is_slot());
            error = error.max(sides.farthest(cell, &region));
            area += region_area;
            within.push(cell);
        }
        // A cell without a solid neighbour would be missing from the sum.
        let is_whole = (area - enclosed(chain)).abs() < 1e-6;
        let is_near = error <= tolerance + ROUNDING && (n_whole == 0 || within.len() == 1);
        (is_whole && is_near).then_some(Self { cells: within, error })
    }
}

/// The free cells to the left of every unit edge of a chain; `None` if the chain is too long.
fn cells_along(chain: &[Node]) -> Option<Vec<Node>> {
    let length = |pair: &[Node]| (pair[1][0] - pair[0][0]).abs() + (pair[1][1] - pair[0][1]).abs();
    if chain.windows(2).map(length).sum::<i32>() > MOST_EDGES {
        return None;
    }
    let cells = chain.windows(2).flat_map(|pair| {
        let [from, to] = [pair[0], pair[1]];
        let step = [(to[0] - from[0]).signum(), (to[1] - from[1]).signum()];
        // The lower left corner of the cell to the left of an edge that leaves a point.
        let offset = match step {
            [1, _] => [0, 0],
            [-1, _] => [-1, -1],
            [_, 1] => [-1, 0],
            _ => [0, -1],
        };
        (0..length(pair)).map(move |k| [from[0] + k * step[0] + offset[0], from[1] + k * step[1] + offset[1]])
    });
    Some(cells.collect())
}

/// Whether the neighbours of a cell are solid: west, east, south, north.
struct Sides([bool; 4]);

impl Sides {
    fn of(component: &Component, [x, y]: Node) -> Self {
        Self([[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]].map(|beside| !component.is_free(beside)))
    }

    fn is_slot(&self) -> bool {
        let [west, east, south, north] = self.0;
        (west && east) || (south && north)
    }

    /// An upper bound, in cells, on the distance from any point of a convex region in the cell to the solid sides.
    fn farthest(&self, cell: Node, region: &[[f64; 2]]) -> f64 {
        if self.is_slot() {
            return 0.5;
        }
        // Mirror the cell so that its solid sides are in the west and the south; distances are then x and y.
        let [west, east, south, north] = self.0;
        let turned = |p: &[f64; 2]| {
            let (x, y) = (p[0] - f64::from(cell[0]), p[1] - f64::from(cell[1]));
            let x = if east { 1.0 - x } else { x };
            let y = if north { 1.0 - y } else { y };
            [if west || east { x } else { f64::INFINITY }, if south || north { y } else { f64::INFINITY }]
        };
        let points: Vec<[f64; 2]> = region.iter().map(turned).collect();
        let edges = points.iter().zip(points.iter().cycle().skip(1));
        // The smaller of the two distances increases towards the points where both are equal.
        let equal = edges.filter_map(|(p, q)| {
            let (before, after) = (p[0] - p[1], q[0] - q[1]);
            let crosses = before.is_finite() && before * after < 0.0;
            crosses.then(|| p[0] + (q[0] - p[0]) * before / (before - after))
        });
        points.iter().map(|p| p[0].min(p[1])).chain(equal).fold(0.0, f64::max)
    }
}

/// The part of a cell on the solid side of a chord.
fn clipped([x, y]: Node, chord: Chord) -> Vec<[f64; 2]> {
    let corners = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]].map(|node| node.map(f64::from));
    let mut region = Vec::with_capacity(6);
    for (k, p) in corners.iter().enumerate() {
        let q = corners[(k + 1) % 4];
        let (here, next) = (side(chord, *p), side(chord, q));
        if here <= 0.0 {
            region.push(*p);
        }
        if here * next < 0.0 {
            let share = here / (here - next);
            region.push([p[0] + (q[0] - p[0]) * share, p[1] + (q[1] - p[1]) * share]);
        }
    }
    region
}

fn area_of(ring: &[[f64; 2]]) -> f64 {
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    edges.map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum::<f64>() / 2.0
}

/// The area in cells that a chain and its chord enclose.
fn enclosed(chain: &[Node]) -> f64 {
    let ring: Vec<[f64; 2]> = chain.iter().map(|node| node.map(f64::from)).collect();
    area_of(&ring)
}

/// Positive to the left of a chord, and negative on its solid side.
fn side([a, b]: Chord, [x, y]: [f64; 2]) -> f64 {
    let [ax, ay, bx, by] = [a[0], a[1], b[0], b[1]].map(f64::from);
    (bx - ax) * (y - ay) - (by - ay) * (x - ax)
}

/// Twice the area of a triangle; positive if counter-clockwise.
pub(crate) fn cross(a: Node, b: Node, c: Node) -> i64 {
    let wide = |v: i32| i64::from(v);
    (wide(b[0]) - wide(a[0])) * (wide(c[1]) - wide(a[1]))
        - (wide(b[1]) - wide(a[1])) * (wide(c[0]) - wide(a[0]))
}

/// A closed chain without the corners at which it does not turn.
pub(crate) fn without_collinear(ring: &[Node]) -> Vec<Node> {
    let n = ring.len();
    let turns = |k: &usize| cross(ring[(k + n - 1) % n], ring[*k], ring[(k + 1) % n]) != 0;
    (0..n).filter(turns).map(|k| ring[k]).collect()
}
