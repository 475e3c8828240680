//! Points along the curves of a drawing.

use std::f64::consts::TAU;
use world::{Point, Vector};

/// The largest angle between two points of a curve, in radians.
const STEP_RAD: f64 = 0.05;
/// The number of points for each stretch of a spline between two knots.
const SPLINE_POINTS: usize = 12;
/// The largest number of points of a spline.
const SPLINE_MOST: usize = 20_000;

/// Points of an arc, counter-clockwise; angles in degrees.
pub(super) fn arc(center: Point, radius: f64, [from_deg, to_deg]: [f64; 2]) -> Vec<Point> {
    let from = from_deg.to_radians();
    let sweep = (to_deg - from_deg).rem_euclid(360.0).to_radians();
    let sweep = if sweep < 1e-9 { TAU } else { sweep };
    along_arc(center, radius, from, sweep)
}

pub(super) fn along_arc(center: Point, radius: f64, from: f64, sweep: f64) -> Vec<Point> {
    let n = (sweep.abs() / STEP_RAD).ceil().max(1.0) as usize;
    let point = |k: usize| {
        let angle = from + sweep * k as f64 / n as f64;
        center + Vector::new(angle.cos(), angle.sin()) * radius
    };
    (0..=n).map(point).collect()
}

/// Points of a polyline. A bulge is the tangent of a quarter of the angle of the arc to the next vertex.
pub(super) fn chain(vertices: &[(Point, f64)], is_closed: bool) -> Vec<Point> {
    let n = vertices.len();
    let mut points = Vec::new();
    for (k, (here, bulge)) in vertices.iter().enumerate() {
        points.push(*here);
        let is_last = k + 1 == n;
        if bulge.abs() < 1e-9 || (is_last && !is_closed) {
            continue;
        }
        let next = vertices[(k + 1) % n].0;
        let (chord, sweep) = (next - here, 4.0 * bulge.atan());
        let apothem = chord.norm() / 2.0 / (sweep / 2.0).tan();
        let across = Vector::new(-chord.y, chord.x).try_normalize(1e-12).unwrap_or_else(Vector::zeros);
        let center = nalgebra::center(here, &next) + across * apothem;
        let off = here - center;
        let arc = along_arc(center, off.norm(), off.y.atan2(off.x), sweep);
        points.extend(&arc[1..arc.len() - 1]);
    }
    points
}

/// Points of an elliptic arc, given by its centre, long semi-axis, ratio of the semi-axes, and parameters in radians.
/// Also returns whether this is a complete ellipse; if so, the first point is left out.
pub(super) fn ellipse(center: Point, long: Vector, share: f64, [from, to]: [f64; 2]) -> (Vec<Point>, bool) {
    let short = Vector::new(-long.y, long.x) * share;
    let sweep = if to > from { (to - from).min(TAU) } else { (to - from).rem_euclid(TAU) };
    let is_closed = sweep > TAU - 1e-6;
    let on_unit = along_arc(Point::origin(), 1.0, from, sweep);
    let points = on_unit.iter().skip(usize::from(is_closed)).map(|p| center + long * p.x + short * p.y);
    (points.collect(), is_closed)
}

/// A B-spline.
pub(super) struct Spline {
    pub degree: usize,
    pub knots: Vec<f64>,
    pub controls: Vec<Point>,
    /// One weight per control point, or empty if all are 1.
    pub weights: Vec<f64>,
}

/// Points of a B-spline (de Boor's algorithm); empty if its numbers are inconsistent.
pub(super) fn spline(spline: &Spline) -> Option<Vec<Point>> {
    let Spline { degree, knots, controls, weights } = spline;
    let (degree, n) = (*degree, controls.len());
    let is_whole = (1..=16).contains(&degree)
        && n > degree
        && knots.len() == n + degree + 1
        && knots.is_sorted()
        && (weights.is_empty() || (weights.len() == n && weights.iter().all(|weight| *weight > 0.0)));
    if !is_whole || n * SPLINE_POINTS > SPLINE_MOST {
        return None;
    }
    let weight = |k: usize| weights.get(k).copied().unwrap_or(1.0);
    let at = |span: usize, u: f64| {
        let mut local: Vec<[f64; 3]> = (span - degree..=span)
            .map(|k| [controls[k].x * weight(k), controls[k].y * weight(k), weight(k)])
            .collect();
        for level in 1..=degree {
            for k in (level..=degree).rev() {
                let (low, high) = (knots[span - degree + k], knots[span + 1 + k - level]);
                let share = if high > low { (u - low) / (high - low) } else { 0.0 };
                local[k] = std::array::from_fn(|c| local[k - 1][c] * (1.0 - share) + local[k][c] * share);
            }
        }
        let [x, y, w] = local[degree];
        Point::new(x / w, y / w)
    };
    let mut points = Vec::new();
    for span in (degree..n).filter(|span| knots[span + 1] > knots[*span]) {
        let (from, to) = (knots[span], knots[span + 1]);
        let share = |k: usize| k as f64 / SPLINE_POINTS as f64;
        points.extend((0..SPLINE_POINTS).map(|k| at(span, from + (to - from) * share(k))));
        if span + 1 == n || knots[span + 1] >= knots[n] {
            points.push(at(span, to));
        }
    }
    (points.len() > 1 && points.iter().all(|p| p.x.is_finite() && p.y.is_finite())).then_some(points)
}

/// Points of a smooth curve through given points (Catmull–Rom). If a drawing states only these points, the program that
/// displays the drawing determines the curve.
pub(super) fn through(points: &[Point]) -> Vec<Point> {
    let n = points.len();
    if n < 3 || n * SPLINE_POINTS > SPLINE_MOST {
        return points.to_vec();
    }
    let slope = |k: usize| (points[(k + 1).min(n - 1)] - points[k.saturating_sub(1)]) / 2.0;
    let mut curve: Vec<Point> = Vec::new();
    for k in 0..n - 1 {
        let (from, to, leaving, arriving) = (points[k], points[k + 1], slope(k), slope(k + 1));
        curve.extend((0..SPLINE_POINTS).map(|step| {
            let u = step as f64 / SPLINE_POINTS as f64;
            let (u2, u3) = (u * u, u * u * u);
            from + (to - from) * (3.0 * u2 - 2.0 * u3) + leaving * (u3 - 2.0 * u2 + u) + arriving * (u3 - u2)
        }));
    }
    curve.push(points[n - 1]);
    curve
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rational_spline_draws_a_circle() {
        // Nine controls on a square around it, those at its corners with the weight of half of a right angle.
        let square = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
        let circle = Spline {
            degree: 2,
            knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0],
            controls: square.map(|(x, y)| Point::new(f64::from(x), f64::from(y))).to_vec(),
            weights: (0..9).map(|k| if k % 2 == 1 { 0.5_f64.sqrt() } else { 1.0 }).collect(),
        };
        let points = spline(&circle).unwrap();
        assert_eq!(points.len(), 4 * SPLINE_POINTS + 1);
        assert!(points.iter().all(|p| (p.coords.norm() - 1.0).abs() < 1e-12), "{points:?}");
        assert!((points[0] - points[points.len() - 1]).norm() < 1e-12);
        assert!(spline(&Spline { knots: vec![0.0; 5], ..circle }).is_none());
    }

    #[test]
    fn a_curve_through_points_passes_through_them_without_a_kink() {
        let points = [(0.0, 0.0), (3.0, 1.0), (6.0, 0.5), (8.0, 2.0)].map(|(x, y)| Point::new(x, y));
        let curve = through(&points);
        assert!(points.iter().all(|p| curve.iter().any(|at| (at - p).norm() < 1e-12)));
        let turn = |w: &[Point]| (w[1] - w[0]).angle(&(w[2] - w[1]));
        assert!(curve.windows(3).all(|w| turn(w) < 0.25), "{curve:?}");
    }
}
