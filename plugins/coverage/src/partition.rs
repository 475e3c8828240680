//! Convex cells between the hull rings of the columns (Pan 2025), and the gates between them.
//!
//! Cells of a ring lie between a hull edge and the ring before, bounded by two rays away from the middle; every column
//! stands on a cell's edge or corner, none inside.

use crate::ground::{Ground, direction};
use std::f64::consts::TAU;
use world::{Boundary, Point, Vector};

/// Sides of the polygon that stands for a round wall.
const WALL_SIDES: usize = 96;
/// Gates narrower than this are none, metres.
const LEAST_GATE_M: f64 = 0.1;
/// How convex a merged cell has to be.
const CONVEX_ENOUGH: f64 = 0.95;
/// Rounding, metres.
const EPSILON_M: f64 = 1e-7;

/// A cell: one convex polygon, or several that were merged.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Convex polygons, counter-clockwise.
    pub polygons: Vec<Vec<Point>>,
}

impl Cell {
    /// Area, square metres.
    pub fn area_m2(&self) -> f64 {
        self.polygons.iter().map(|p| world::shape::ring_area_m2(p).abs()).sum()
    }

    /// Centre of area.
    pub fn center(&self) -> Point {
        let weighted = self.polygons.iter().map(|p| {
            let (area, center) = area_center(p);
            center.coords * area
        });
        Point::from(weighted.sum::<Vector>() / self.area_m2().max(1e-12))
    }

    /// Whether a place lies in the cell.
    pub fn contains(&self, at: Point) -> bool {
        self.polygons.iter().any(|p| is_within(p, at))
    }

    /// Hull of the cell.
    pub fn hull(&self) -> Vec<Point> {
        hull(&self.polygons.concat())
    }
}

/// A piece of the boundary between two cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Border {
    /// The cells on either side.
    pub cells: (usize, usize),
    /// Its ends.
    pub ends: (Point, Point),
    /// Whether no disc with the distance to keep covers it.
    pub is_open: bool,
    /// Whether it is open and wide enough to pass.
    pub is_gate: bool,
}

impl Border {
    /// Its middle.
    pub fn middle(&self) -> Point {
        self.ends.0 + (self.ends.1 - self.ends.0) / 2.0
    }
}

/// The cells of a ground: hull rings, with small cells merged.
pub fn cells(ground: &Ground, columns: &[(Point, f64)]) -> Vec<Cell> {
    merged(unmerged(ground, columns), ground, columns)
}

/// The cells of a ground as they are between the rings.
pub fn unmerged(ground: &Ground, columns: &[(Point, f64)]) -> Vec<Cell> {
    let polygons = rings(&wall(&ground.wall), columns, ground.anchor);
    polygons.into_iter().map(|p| Cell { polygons: vec![p] }).collect()
}

fn wall(boundary: &Boundary) -> Vec<Point> {
    match boundary {
        Boundary::Circle { radius_m } => (0..WALL_SIDES)
            .map(|k| Point::origin() + direction(TAU * k as f64 / WALL_SIDES as f64) * *radius_m)
            .collect(),
        Boundary::Polygon { vertices } => vertices.clone(),
    }
}

fn rings(wall: &[Point], columns: &[(Point, f64)], anchor: Point) -> Vec<Vec<Point>> {
    let mut left: Vec<Point> = columns.iter().map(|c| c.0).collect();
    let mut outer = wall.to_vec();
    let mut cells = Vec::new();
    let middle = area_center(wall).1;
    loop {
        let ring = hull(&left);
        if ring.len() < 3 {
            cells.extend(last(&outer, &left, anchor));
            return cells;
        }
        let from = if is_within(&ring, middle) { middle } else { area_center(&ring).1 };
        for (k, u) in ring.iter().enumerate() {
            let v = ring[(k + 1) % ring.len()];
            let cell = clipped(&outer, *u, *u - v);
            let cell = clipped(&cell, *u, u - from);
            let cell = clipped(&cell, v, from - v);
            if cell.len() > 2 && world::shape::ring_area_m2(&cell) > 1e-6 {
                cells.push(cell);
            }
        }
        left.retain(|p| !ring.contains(p));
        outer = ring;
    }
}

/// What is inside the last ring: whole, or cut along the line of the columns that are left.
fn last(outer: &[Point], left: &[Point], anchor: Point) -> Vec<Vec<Point>> {
    let Some(first) = left.first() else { return vec![outer.to_vec()] };
    let far =
        left.iter().max_by(|a, b| (*a - first).norm().total_cmp(&(*b - first).norm())).expect("not empty");
    let way = if left.len() > 1 { far - first } else { anchor - first };
    let way = way.try_normalize(1e-9).unwrap_or_else(Vector::x);
    let halves = [clipped(outer, *first, way), clipped(outer, *first, -way)];
    halves.into_iter().filter(|half| half.len() > 2).collect()
}

/// The part of a convex polygon on the left of a line.
fn clipped(polygon: &[Point], from: Point, ahead: Vector) -> Vec<Point> {
    let side = |p: &Point| ahead.perp(&(p - from));
    let mut kept = Vec::new();
    for (k, a) in polygon.iter().enumerate() {
        let b = &polygon[(k + 1) % polygon.len()];
        let (at_a, at_b) = (side(a), side(b));
        if at_a >= -EPSILON_M {
            kept.push(*a);
        }
        if (at_a > EPSILON_M && at_b < -EPSILON_M) || (at_a < -EPSILON_M && at_b > EPSILON_M) {
            kept.push(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
    kept.dedup_by(|a, b| (*a - *b).norm() < EPSILON_M);
    kept
}

/// Graham's hull, counter-clockwise; points on an edge are left for the next ring. Empty for points on one line.
pub fn hull(points: &[Point]) -> Vec<Point> {
    let lowest = |a: &&Point, b: &&Point| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x));
    let Some(pivot) = points.iter().min_by(lowest).copied() else { return Vec::new() };
    let mut others: Vec<Point> = points.iter().copied().filter(|p| (p - pivot).norm() > EPSILON_M).collect();
    let angle = |p: &Point| (p.y - pivot.y).atan2(p.x - pivot.x);
    // On a tie the farther point comes last and stays.
    others.sort_by(|a, b| {
        angle(a).total_cmp(&angle(b)).then((a - pivot).norm().total_cmp(&(b - pivot).norm()))
    });
    let mut stack = vec![pivot];
    for p in others {
        while let [.., a, b] = stack[..] {
            if (b - a).perp(&(p - a)) > EPSILON_M {
                break;
            }
            stack.pop();
        }
        stack.push(p);
    }
    if stack.len() < 3 { Vec::new() } else { stack }
}

fn is_within(polygon: &[Point], at: Point) -> bool {
    (0..polygon.len()).all(|k| {
        let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        (b - a).perp(&(at - a)) >= -EPSILON_M
    })
}

fn area_center(polygon: &[Point]) -> (f64, Point) {
    let (mut area, mut sum) = (0.0, Vector::zeros());
    for (k, a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let cross = a.coords.perp(&b.coords);
        area += cross / 2.0;
        sum += (a.coords + b.coords) * (cross / 6.0);
    }
    (area.abs(), Point::from(sum / area.abs().max(1e-12) * area.signum()))
}

/// Everything two cells share, in pieces that can be passed and pieces that cannot.
pub fn borders(cells: &[Cell], ground: &Ground, columns: &[(Point, f64)]) -> Vec<Border> {
    let mut borders = Vec::new();
    for a in 0..cells.len() {
        for b in 0..a {
            for p in &cells[a].polygons {
                for q in &cells[b].polygons {
                    for ends in shared(p, q) {
                        borders.extend(pieces(ends, ground, columns).into_iter().map(|(ends, is_open)| {
                            Border {
                                cells: (b, a),
                                ends,
                                is_open,
                                is_gate: is_open && (ends.1 - ends.0).norm() > LEAST_GATE_M,
                            }
                        }));
                    }
                }
            }
        }
    }
    borders
}

/// Segments on the edge of both polygons.
fn shared(p: &[Point], q: &[Point]) -> Vec<(Point, Point)> {
    let mut found = Vec::new();
    for k in 0..p.len() {
        let (a, b) = (p[k], p[(k + 1) % p.len()]);
        let length_m = (b - a).norm();
        if length_m < EPSILON_M {
            continue;
        }
        let along = (b - a) / length_m;
        for j in 0..q.len() {
            let (c, d) = (q[j], q[(j + 1) % q.len()]);
            let is_on_line = |x: Point| along.perp(&(x - a)).abs() < 1e-5;
            if !(is_on_line(c) && is_on_line(d)) {
                continue;
            }
            let (s, t) = ((c - a).dot(&along), (d - a).dot(&along));
            let (from, to) = (s.min(t).max(0.0), s.max(t).min(length_m));
            if to - from > 1e-3 {
                found.push((a + along * from, a + along * to));
            }
        }
    }
    found
}

/// A border in pieces, with whether each is open.
fn pieces(ends: (Point, Point), ground: &Ground, columns: &[(Point, f64)]) -> Vec<((Point, Point), bool)> {
    let length_m = (ends.1 - ends.0).norm();
    let along = (ends.1 - ends.0) / length_m;
    let mut marks = vec![0.0, length_m];
    for (center, radius_m) in columns {
        let reach_m = radius_m + ground.keep_m;
        let (middle, aside) = ((center - ends.0).dot(&along), along.perp(&(center - ends.0)));
        if aside.abs() >= reach_m {
            continue;
        }
        let half = (reach_m * reach_m - aside * aside).sqrt();
        marks.extend([middle - half, middle + half].into_iter().filter(|m| *m > 0.0 && *m < length_m));
    }
    marks.sort_by(f64::total_cmp);
    let piece = |w: &[f64]| {
        let middle = ends.0 + along * f64::midpoint(w[0], w[1]);
        ((ends.0 + along * w[0], ends.0 + along * w[1]), ground.is_free(middle))
    };
    marks.windows(2).filter(|w| w[1] - w[0] > EPSILON_M).map(piece).collect()
}

/// Merges cells that are too small with the neighbour that makes the most convex whole.
fn merged(mut cells: Vec<Cell>, ground: &Ground, columns: &[(Point, f64)]) -> Vec<Cell> {
    let least_m2 = (4.0 * ground.swath_m).powi(2);
    let mut given_up: Vec<Point> = Vec::new();
    loop {
        let is_small = |c: &Cell| c.area_m2() < least_m2 && !given_up.contains(&c.center());
        let Some(small) = (0..cells.len()).find(|k| is_small(&cells[*k])) else { return cells };
        let all = borders(&cells, ground, columns);
        let others = (0..cells.len()).filter(|k| *k != small && joins(&all, small, *k));
        let whole =
            |k: usize| Cell { polygons: [&cells[small].polygons[..], &cells[k].polygons[..]].concat() };
        let convexity =
            |cell: &Cell| cell.area_m2() / world::shape::ring_area_m2(&cell.hull()).abs().max(1e-12);
        let best = others
            .map(|k| (convexity(&whole(k)), k))
            .filter(|(share, k)| *share >= CONVEX_ENOUGH && is_sound(&all, &whole(*k), (small, *k), columns))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, with)) = best else {
            given_up.push(cells[small].center());
            continue;
        };
        let cell = whole(with);
        cells.remove(small.max(with));
        cells[small.min(with)] = cell;
    }
}

fn joins(borders: &[Border], a: usize, b: usize) -> bool {
    borders.iter().any(|border| border.is_gate && border.cells == (a.min(b), a.max(b)))
}

/// A merged cell has no column inside, and no third cell with gates to both of its parts: a column would stand between.
fn is_sound(borders: &[Border], whole: &Cell, (a, b): (usize, usize), columns: &[(Point, f64)]) -> bool {
    let ring = whole.hull();
    let is_deep = |at: Point| {
        (0..ring.len()).all(|k| {
            let (p, q) = (ring[k], ring[(k + 1) % ring.len()]);
            (q - p).perp(&(at - p)) / (q - p).norm() > 0.05
        })
    };
    let third = |k: usize| {
        let pairs = borders.iter().filter(move |border| border.is_gate).map(|border| border.cells);
        pairs.filter_map(move |(p, q)| {
            if p == k {
                Some(q)
            } else if q == k {
                Some(p)
            } else {
                None
            }
        })
    };
    let shares = third(a).any(|other| other != b && third(b).any(|twin| twin == other));
    !shares && !columns.iter().any(|(center, _)| is_deep(*center))
}
