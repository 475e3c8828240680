//! The rim of the free floor, curve by curve.

use geometry::{Boundary, Point, Shape, Vector, polyline::edges};
use std::collections::BTreeSet;

/// The largest gap between two curves that still count as touching, metres: rounding can leave a gap between tangents.
const TOUCH_M: f64 = 1e-9;

/// Something solid, as a line with a thickness; for a disc, both ends are at its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Core {
    pub a: Point,
    pub b: Point,
    /// Half its thickness, metres.
    pub radius_m: f64,
}

/// A piece of the rim: points at a given distance from a core, regardless of other cores.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Rim {
    Arc { center: Point, radius_m: f64 },
    Side { a: Point, b: Point },
}

impl Core {
    /// Returns the sides of a wall.
    pub(super) fn of_wall(boundary: &Boundary) -> Vec<Self> {
        match boundary {
            Boundary::Circle { .. } => Vec::new(),
            Boundary::Polygon { vertices } => Self::of_ring(vertices),
        }
    }

    /// Returns the outline of a shape.
    pub(super) fn of_shape(shape: &Shape) -> Vec<Self> {
        match shape {
            Shape::Disc { center, radius_m } => vec![Self { a: *center, b: *center, radius_m: *radius_m }],
            Shape::Polygon { vertices } => Self::of_ring(vertices),
            Shape::Polyline { points, half_width_m } => {
                let radius_m = *half_width_m;
                points.windows(2).map(|pair| Self { a: pair[0], b: pair[1], radius_m }).collect()
            }
        }
    }

    fn of_ring(vertices: &[Point]) -> Vec<Self> {
        edges(vertices).map(|(a, b)| Self { a, b, radius_m: 0.0 }).collect()
    }

    /// Returns the pieces of the rim at `room_m` from some cores.
    pub(super) fn rims(cores: &[Self], room_m: f64) -> Vec<Rim> {
        let mut rims = Vec::new();
        let mut seen = BTreeSet::new();
        for Self { a, b, radius_m } in cores {
            let off_m = radius_m + room_m;
            for end in [a, b] {
                if seen.insert([end.x, end.y, off_m].map(f64::to_bits)) {
                    rims.push(Rim::Arc { center: *end, radius_m: off_m });
                }
            }
            if let Some(along) = (b - a).try_normalize(0.0) {
                for side in [Vector::new(-along.y, along.x), Vector::new(along.y, -along.x)] {
                    rims.push(Rim::Side { a: a + side * off_m, b: b + side * off_m });
                }
            }
        }
        rims
    }
}

impl Rim {
    /// Returns a segment and a radius around it that together contain the whole piece.
    pub(super) fn around(&self) -> (Point, Point, f64) {
        match self {
            Self::Arc { center, radius_m } => (*center, *center, *radius_m),
            Self::Side { a, b } => (*a, *b, 0.0),
        }
    }

    /// Returns the points where the piece crosses or touches another piece.
    pub(super) fn crossings(&self, other: &Self) -> Vec<Point> {
        match (*self, *other) {
            (Self::Arc { center, radius_m }, Self::Arc { center: to, radius_m: to_m }) => {
                of_arcs((center, radius_m), (to, to_m))
            }
            (Self::Arc { center, radius_m }, Self::Side { a, b })
            | (Self::Side { a, b }, Self::Arc { center, radius_m }) => of_arc((center, radius_m), a, b),
            (Self::Side { a, b }, Self::Side { a: c, b: d }) => of_sides((a, b), (c, d)),
        }
    }
}

fn of_arcs((a, a_m): (Point, f64), (b, b_m): (Point, f64)) -> Vec<Point> {
    let apart_m = (b - a).norm();
    let is_apart = apart_m > a_m + b_m + TOUCH_M || apart_m + a_m.min(b_m) < a_m.max(b_m) - TOUCH_M;
    if is_apart || apart_m <= f64::MIN_POSITIVE {
        return Vec::new();
    }
    let along = (b - a) / apart_m;
    let along_m = (apart_m * apart_m + a_m * a_m - b_m * b_m) / (2.0 * apart_m);
    let aside_m = (a_m * a_m - along_m * along_m).max(0.0).sqrt();
    let aside = Vector::new(-along.y, along.x) * aside_m;
    vec![a + along * along_m + aside, a + along * along_m - aside]
}

fn of_arc((center, radius_m): (Point, f64), a: Point, b: Point) -> Vec<Point> {
    let way = b - a;
    let length_m = way.norm();
    let along = way / length_m;
    let to_foot_m = (center - a).dot(&along);
    let off_m = along.perp(&(center - a)).abs();
    if off_m > radius_m + TOUCH_M {
        return Vec::new();
    }
    let half_m = (radius_m * radius_m - off_m * off_m).max(0.0).sqrt();
    let is_on = |at_m: &f64| (-TOUCH_M..=length_m + TOUCH_M).contains(at_m);
    [to_foot_m - half_m, to_foot_m + half_m].into_iter().filter(is_on).map(|at_m| a + along * at_m).collect()
}

fn of_sides((a, b): (Point, Point), (c, d): (Point, Point)) -> Vec<Point> {
    let (one, other) = (b - a, d - c);
    let turn = one.perp(&other);
    if turn.abs() <= f64::EPSILON * one.norm() * other.norm() {
        return Vec::new();
    }
    let (at, on) = ((c - a).perp(&other) / turn, (c - a).perp(&one) / turn);
    let is_on = |share: f64, way: Vector| {
        let slack = TOUCH_M / way.norm();
        (-slack..=1.0 + slack).contains(&share)
    };
    if is_on(at, one) && is_on(on, other) { vec![a + one * at] } else { Vec::new() }
}
