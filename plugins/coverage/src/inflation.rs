//! Wall and obstacles, grown by the distance that the hull centre keeps from them, as polygons.

use crate::plane::direction;
use geometry::convex::Part;
use std::f64::consts::{PI, TAU};
use world::{Boundary, Point, polyline::edges};

/// Margin by which the planned distance exceeds the distance that the mission requires, metres.
pub(crate) const SLACK_M: f64 = 2e-3;
/// Largest angle between neighbouring tangents of an outline, radians. With larger angles, the corners of outlines
/// would keep the tool a centimetre farther from columns, which adds up where many columns are close together.
const FACET_RAD: f64 = TAU / 24.0;
/// Largest distance of a facet of a round wall from the circle, metres.
const WALL_SAGITTA_M: f64 = 2e-3;

/// The boundary of the floor for the hull centre: one ring inside a round wall, or a ring around every edge of a
/// straight wall.
pub(crate) fn wall_rings(wall: &Boundary, keep_m: f64) -> Vec<Vec<Point>> {
    match wall {
        Boundary::Circle { radius_m } => {
            let outer_m = (radius_m - keep_m).max(1e-6);
            let n = (PI / (2.0 * WALL_SAGITTA_M / outer_m).sqrt()).ceil().max(24.0);
            let at = |k: usize| Point::origin() + direction(TAU * k as f64 / n) * outer_m;
            vec![(0..n as usize).map(at).collect()]
        }
        Boundary::Polygon { vertices } => {
            edges(vertices).map(|(a, b)| around(&[a, b], keep_m + SLACK_M / 2.0)).collect()
        }
    }
}

/// A convex outline of a part, grown by the distance to keep. It encloses the exact outline.
pub(crate) fn outline(part: &Part, keep_m: f64) -> Vec<Point> {
    let corners = part.corners();
    let radius_m = corners.first().map_or(0.0, |c| c.1) + keep_m + SLACK_M / 2.0;
    let mut points: Vec<Point> = corners.iter().map(|c| c.0).collect();
    points.dedup();
    around(&points, radius_m)
}

/// A polygon around everything within `radius_m` of a convex polygon, a segment or a point. It never cuts inside the
/// exact outline.
fn around(corners: &[Point], radius_m: f64) -> Vec<Point> {
    let n = corners.len();
    if n == 1 {
        return arc(corners[0], 0.0, TAU, radius_m);
    }
    let normal = |k: usize| {
        let along = corners[(k + 1) % n] - corners[k % n];
        (-along.x).atan2(along.y)
    };
    let mut ring = Vec::new();
    for (k, corner) in corners.iter().enumerate() {
        let before = normal(k + n - 1);
        let turn = (normal(k) - before).rem_euclid(TAU);
        ring.extend(arc(*corner, before, turn, radius_m));
    }
    ring
}

/// Corners of a polygon that encloses an arc: its sides are tangents to the arc, spread evenly from its start to its
/// end.
fn arc(center: Point, from_rad: f64, turn_rad: f64, radius_m: f64) -> Vec<Point> {
    let n = (turn_rad / FACET_RAD).ceil().max(1.0);
    let step = turn_rad / n;
    let reach_m = radius_m / (step / 2.0).cos();
    (0..n as usize).map(|k| center + direction(from_rad + (k as f64 + 0.5) * step) * reach_m).collect()
}
