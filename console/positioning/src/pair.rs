//! Two stations: two circles, two positions, and a prior to choose between them.

use crate::{
    anchor::Anchor,
    fix::{Fix, FixError},
    linear::conditioning,
    quality::assess,
};
use nalgebra::Matrix2;
use world::{Point, Vector};

/// The number of sigmas above which the gap between two circles is a contradiction.
const GAP_SIGMAS: f64 = 3.0;

/// Returns the crossing of two range circles on the side of `near`, or either crossing if there is no `near`. The other
/// crossing is reported as the mirror image.
///
/// Where the circles touch or just miss each other, the position is on the line between the stations. Its uncertainty
/// across that line is the half chord that the range errors can open.
pub(crate) fn solve_pair(first: &Anchor, second: &Anchor, near: Option<Point>) -> Result<Fix, FixError> {
    let baseline = second.at - first.at;
    let d = baseline.norm();
    if d < 1e-6 {
        let anchors = [*first, *second];
        return Err(FixError::Collinear {
            conditioning: conditioning(&anchors),
            limit: crate::linear::MAX_CONDITIONING,
        });
    }
    let (along, across) = (baseline / d, Vector::new(-baseline.y, baseline.x) / d);
    let (r1, r2) = (first.range_m, second.range_m);
    // In the frame of the baseline, the crossings are (x, +-y).
    let x = (d * d + r1 * r1 - r2 * r2) / (2.0 * d);
    let y2 = r1 * r1 - x * x;
    let x_by = Vector::new(r1 / d, -r2 / d);
    let y2_by = Vector::new(2.0 * r1 * (1.0 - x / d), 2.0 * x * r2 / d);
    let sigma = Vector::new(first.sigma_m, second.sigma_m);
    let y2_sigma = y2_by.component_mul(&sigma).norm();
    if y2 < -GAP_SIGMAS * y2_sigma {
        return Err(FixError::Inconsistent {
            chi2: (y2 / y2_sigma).powi(2).min(1e12),
            degrees_of_freedom: 0,
        });
    }
    let y = y2.max(0.0).sqrt();
    let side = if near.is_some_and(|near| across.dot(&(near - first.at)) < 0.0) { -1.0 } else { 1.0 };
    let crossing = |side: f64| first.at + along * x + across * (side * y);
    let y_by = y2_by * (side / (2.0 * y2.max(y2_sigma).max(1e-12).sqrt()));
    let by_ranges = (along * x_by.transpose() + across * y_by.transpose()) * Matrix2::from_diagonal(&sigma);
    let mirror = (y > 0.0).then(|| crossing(-side));
    let anchors = [*first, *second];
    assess(&anchors, crossing(side), by_ranges * by_ranges.transpose(), conditioning(&anchors), mirror)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::Integrity;
    use world::StationId;

    fn anchor(id: u32, x: f64, y: f64, range_m: f64) -> Anchor {
        Anchor::new(StationId(id), Point::new(x, y), range_m, 0.03, 0.0)
    }

    #[test]
    fn the_prior_chooses_the_crossing_and_the_other_is_the_mirror() {
        let (a, b) = (anchor(1, -4.0, 0.0, 5.0), anchor(2, 4.0, 0.0, 5.0));
        let fix = solve_pair(&a, &b, Some(Point::new(0.5, -1.0))).unwrap();
        assert!((fix.position - Point::new(0.0, -3.0)).norm() < 1e-9);
        assert!((fix.mirror.unwrap() - Point::new(0.0, 3.0)).norm() < 1e-9);
        assert_eq!(fix.integrity, Integrity::Untestable);
    }

    #[test]
    fn the_covariance_is_that_of_the_inverse_geometry() {
        let (a, b) = (anchor(1, -4.0, 1.0, 5.0), anchor(2, 3.0, 0.0, 4.0));
        let fix = solve_pair(&a, &b, Some(Point::new(0.0, 5.0))).unwrap();
        let rows = [a, b].map(|s| (fix.position - s.at).normalize());
        let geometry = Matrix2::from_rows(&[rows[0].transpose(), rows[1].transpose()]);
        let expected = (geometry.transpose() * geometry).try_inverse().unwrap() * 0.03_f64.powi(2);
        assert!((fix.covariance - expected).norm() < 1e-9 * expected.norm(), "{} {expected}", fix.covariance);
    }

    #[test]
    fn circles_that_just_miss_give_the_touching_point_with_a_wide_error_across() {
        let fix = solve_pair(&anchor(1, -4.0, 0.0, 3.98), &anchor(2, 4.0, 0.0, 3.98), None).unwrap();
        assert!(fix.position.coords.norm() < 1e-9);
        assert!(fix.mirror.is_none());
        assert!(fix.covariance[(1, 1)] > 20.0 * fix.covariance[(0, 0)]);
        assert!(fix.covariance[(1, 1)].sqrt() < 1.0);
    }

    #[test]
    fn circles_far_apart_contradict_each_other() {
        let answer = solve_pair(&anchor(1, -4.0, 0.0, 1.0), &anchor(2, 4.0, 0.0, 1.0), None);
        assert!(matches!(answer, Err(FixError::Inconsistent { .. })));
    }
}
