//! Fits a circle to weighted points.

use geometry::{Point, Vector};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// Number of steps of the fit; it converges in about four.
const STEPS: usize = 12;

/// A circle fitted to points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Circle {
    pub center: Point,
    pub radius_m: f64,
    /// Root mean square distance of the points from the circle, metres.
    pub rms_m: f64,
    /// Largest angle at the centre without points, radians.
    pub gap_rad: f64,
    /// Bearing of the middle of that gap from the centre, radians.
    pub gap_at_rad: f64,
    /// Standard deviations of the centre (along the worse axis) and of the radius, metres.
    pub sigma_m: [f64; 2],
}

/// Fits a circle to points with weights: first the algebraic fit of Kåsa (1976), then a geometric one by Gauss-Newton
/// steps. `None` if the points do not determine a circle.
pub(crate) fn fit(points: &[(Point, f64)], noise_m: f64) -> Option<Circle> {
    let weight: f64 = points.iter().map(|(_, weight)| weight).sum();
    let mean = points.iter().map(|(at, weight)| at.coords * *weight).sum::<Vector>() / weight;
    let mut at = kasa(points, mean)?;
    let mut information = Matrix3::zeros();
    for _ in 0..STEPS {
        information = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for (point, weight) in points {
            let from = point.coords - mean - Vector::new(at.x, at.y);
            let far_m = from.norm().max(1e-9);
            let slope = Vector3::new(-from.x / far_m, -from.y / far_m, -1.0);
            information += slope * slope.transpose() * *weight;
            right -= slope * (far_m - at.z) * *weight;
        }
        at += information.cholesky()?.solve(&right);
    }
    let center = Point::from(mean + Vector::new(at.x, at.y));
    if !(at.iter().all(|v| v.is_finite()) && at.z > 0.0) {
        return None;
    }
    let square = |(point, weight): &(Point, f64)| weight * ((point - center).norm() - at.z).powi(2);
    let rms_m = (points.iter().map(square).sum::<f64>() / weight).sqrt();
    // The errors of the echoes from one surface are not independent, because those of the poses are not: the cells count,
    // not the echoes.
    let per_cell = weight / points.len() as f64;
    let covariance = (information / per_cell).try_inverse()? * rms_m.max(noise_m).powi(2);
    let place = covariance.fixed_view::<2, 2>(0, 0).into_owned().symmetric_eigenvalues().max();
    let (gap_rad, gap_at_rad) = gap(points, center);
    let sigma_m = [place.max(0.0).sqrt(), covariance[(2, 2)].max(0.0).sqrt()];
    Some(Circle { center, radius_m: at.z, rms_m, gap_rad, gap_at_rad, sigma_m })
}

fn kasa(points: &[(Point, f64)], mean: Vector) -> Option<Vector3<f64>> {
    let (mut left, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (point, weight) in points {
        let from = point.coords - mean;
        let row = Vector3::new(2.0 * from.x, 2.0 * from.y, 1.0);
        left += row * row.transpose() * *weight;
        right += row * from.norm_squared() * *weight;
    }
    let found = left.cholesky()?.solve(&right);
    let square = found.z + found.x * found.x + found.y * found.y;
    (square > 0.0).then(|| Vector3::new(found.x, found.y, square.sqrt()))
}

/// The largest angle at a centre without points, and the bearing of its middle, radians.
fn gap(points: &[(Point, f64)], center: Point) -> (f64, f64) {
    let mut bearings: Vec<f64> =
        points.iter().map(|(at, _)| (at.y - center.y).atan2(at.x - center.x)).collect();
    bearings.sort_by(f64::total_cmp);
    let Some((first, last)) = bearings.first().zip(bearings.last()) else { return (TAU, 0.0) };
    let around = (*last, first + TAU);
    let gaps = bearings.windows(2).map(|pair| (pair[0], pair[1])).chain([around]);
    let (from, to) =
        gaps.fold(around, |widest, gap| if gap.1 - gap.0 > widest.1 - widest.0 { gap } else { widest });
    (to - from, 0.5 * (from + to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::unit_vector;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn points_on_an_arc_give_their_circle(
            (x, y, radius_m) in (-5.0..5.0_f64, -5.0..5.0_f64, 0.05..2.0_f64),
            (from_rad, sweep_rad) in (0.0..TAU, 1.5..6.0_f64),
        ) {
            let center = Point::new(x, y);
            let at = |k: u32| center + unit_vector(from_rad + sweep_rad * f64::from(k) / 20.0) * radius_m;
            let points: Vec<_> = (0..=20).map(|k| (at(k), 1.0 + f64::from(k % 3))).collect();
            let found = fit(&points, 1e-6).unwrap();
            prop_assert!((found.center - center).norm() < 1e-6 && (found.radius_m - radius_m).abs() < 1e-6);
            prop_assert!((found.gap_rad - (TAU - sweep_rad).max(sweep_rad / 20.0)).abs() < 1e-6);
        }
    }

    #[test]
    fn points_on_a_line_give_no_small_circle() {
        let points: Vec<_> = (0..20).map(|k| (Point::new(0.05 * f64::from(k), 0.0), 1.0)).collect();
        assert!(fit(&points, 0.01).is_none_or(|found| found.radius_m > 10.0));
    }
}
