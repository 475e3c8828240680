//! Convex cells between the hull rings of the columns (Pan 2025).
//!
//! Each cell of a ring lies between an edge of its hull and the preceding ring, bounded by two rays from the middle
//! outward. Columns are on edges or corners of cells, never inside.

use crate::plane::direction;
use crate::tuning::hull_partition::WALL_SIDES;
use crate::workspace::{Workspace, reach_m};
use geometry::convex::Part;
use std::f64::consts::TAU;
use world::{Boundary, Point, Vector, polyline::edges, shape::ring_area_m2};

/// Tolerance for rounding, metres.
pub(super) const EPSILON_M: f64 = 1e-7;

/// A disc around an obstacle.
pub(super) struct Column {
    pub center: Point,
    pub radius_m: f64,
}

impl Column {
    pub(super) fn all(workspace: &Workspace) -> Vec<Self> {
        let column = |part: &Part| Self { center: part.middle(), radius_m: reach_m(part) };
        workspace.parts.iter().map(column).collect()
    }
}

/// A cell: one convex polygon, or several merged ones.
#[derive(Clone)]
pub(super) struct Cell {
    pub polygons: Vec<Vec<Point>>,
}

impl Cell {
    pub(super) fn area_m2(&self) -> f64 {
        self.polygons.iter().map(|p| ring_area_m2(p).abs()).sum()
    }

    pub(super) fn center(&self) -> Point {
        let weighted =
            self.polygons.iter().map(|p| area_and_center(p)).map(|(area, center)| center.coords * area);
        Point::from(weighted.sum::<Vector>() / self.area_m2().max(1e-12))
    }

    pub(super) fn contains(&self, at: Point) -> bool {
        self.polygons.iter().any(|p| contains(p, at))
    }

    pub(super) fn hull(&self) -> Vec<Point> {
        hull(&self.polygons.concat())
    }

    /// The share of its convex hull that the cell fills.
    pub(super) fn convexity(&self) -> f64 {
        self.area_m2() / ring_area_m2(&self.hull()).abs().max(1e-12)
    }
}

/// The cells between the hull rings, ring by ring from the wall inward.
pub(super) fn cells(workspace: &Workspace, columns: &[Column]) -> Vec<Cell> {
    let wall: Vec<Point> = match &workspace.wall {
        Boundary::Circle { radius_m } => {
            let angle_rad = |k: usize| TAU * k as f64 / WALL_SIDES as f64;
            (0..WALL_SIDES).map(|k| Point::origin() + direction(angle_rad(k)) * *radius_m).collect()
        }
        Boundary::Polygon { vertices } => vertices.clone(),
    };
    let middle = area_and_center(&wall).1;
    let (mut outer, mut left) = (wall, columns.iter().map(|column| column.center).collect::<Vec<_>>());
    let mut polygons = Vec::new();
    loop {
        let ring = hull(&left);
        if ring.len() < 3 {
            polygons.extend(innermost(&outer, &left, workspace.anchor));
            return polygons.into_iter().map(|polygon| Cell { polygons: vec![polygon] }).collect();
        }
        // Rays from a point outside the ring would not bound convex cells.
        let from = if contains(&ring, middle) { middle } else { area_and_center(&ring).1 };
        for (u, v) in edges(&ring) {
            let beyond_edge = clipped(&outer, u, u - v);
            let cell = clipped(&clipped(&beyond_edge, u, u - from), v, from - v);
            if cell.len() > 2 && ring_area_m2(&cell) > 1e-6 {
                polygons.push(cell);
            }
        }
        left.retain(|p| !ring.contains(p));
        outer = ring;
    }
}

/// The area inside the last ring: undivided, or divided along the line through the remaining columns.
fn innermost(outer: &[Point], left: &[Point], anchor: Point) -> Vec<Vec<Point>> {
    let Some(first) = left.first() else { return vec![outer.to_vec()] };
    let far = left.iter().max_by(|a, b| (*a - first).norm().total_cmp(&(*b - first).norm())).expect(
        "the ring has at least one \
                                                                                               point",
    );
    let way = if left.len() > 1 { far - first } else { anchor - first };
    let way = way.try_normalize(1e-9).unwrap_or_else(Vector::x);
    let halves = [clipped(outer, *first, way), clipped(outer, *first, -way)];
    halves.into_iter().filter(|half| half.len() > 2).collect()
}

/// The part of a convex polygon to the left of a line.
pub(super) fn clipped(polygon: &[Point], from: Point, ahead: Vector) -> Vec<Point> {
    let side = |p: Point| ahead.perp(&(p - from));
    let mut kept = Vec::new();
    for (a, b) in edges(polygon) {
        let (at_a, at_b) = (side(a), side(b));
        if at_a >= -EPSILON_M {
            kept.push(a);
        }
        if (at_a > EPSILON_M && at_b < -EPSILON_M) || (at_a < -EPSILON_M && at_b > EPSILON_M) {
            kept.push(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
    kept.dedup_by(|a, b| (*a - *b).norm() < EPSILON_M);
    kept
}

/// Graham's convex hull. Points on an edge are left for the next ring. Empty if all points are on one line.
pub(super) fn hull(points: &[Point]) -> Vec<Point> {
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

pub(super) fn is_convex(polygon: &[Point]) -> bool {
    let next = edges(polygon).skip(1).chain(edges(polygon));
    edges(polygon).zip(next).all(|((a, b), (_, c))| (b - a).perp(&(c - b)) >= -1e-9)
}

pub(super) fn contains(polygon: &[Point], at: Point) -> bool {
    edges(polygon).all(|(a, b)| (b - a).perp(&(at - a)) >= -EPSILON_M)
}

/// The area, square metres, and the centroid.
pub(super) fn area_and_center(polygon: &[Point]) -> (f64, Point) {
    let (mut area, mut sum) = (0.0, Vector::zeros());
    for (a, b) in edges(polygon) {
        let cross = a.coords.perp(&b.coords);
        area += cross / 2.0;
        sum += (a.coords + b.coords) * (cross / 6.0);
    }
    (area.abs(), Point::from(sum / area.abs().max(1e-12) * area.signum()))
}
