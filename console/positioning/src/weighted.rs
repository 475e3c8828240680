//! Weighted linear least squares on squared ranges.

use crate::{
    anchor::{Anchor, anchored},
    fix::{Fix, FixError, PositionSolver, Prior, Ranging},
    linear::{MAX_CONDITIONING, conditioning},
    quality::{assess, inverse_of},
};
use nalgebra::Matrix2;
use world::{Point, Station, Vector};

/// The linear method with Gauss-Markov weights, for more than three stations.
///
/// Differences of squared ranges share the reference station, so their errors are correlated. Fitting `r_i^2 - |s_i|^2
/// = c - 2 s_i . p` with weights `1 / (2 r_i sigma_i)^2` and a free `c` is equivalent, but needs no reference. With
/// three stations, nothing can be weighted, and the answer is the same as that of [`crate::LinearLs`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WeightedLinear;

impl PositionSolver for WeightedLinear {
    fn solve(
        &self,
        ranges: &[Ranging],
        stations: &[Station],
        _prior: Option<Prior>,
    ) -> Result<Fix, FixError> {
        let anchors = anchored(ranges, stations)?;
        if anchors.len() < 3 {
            return Err(FixError::TooFewStations { have: anchors.len(), need: 3 });
        }
        let conditioning = conditioning(&anchors);
        let collinear = FixError::Collinear { conditioning, limit: MAX_CONDITIONING };
        if conditioning > MAX_CONDITIONING {
            return Err(collinear);
        }
        let (position, covariance) = solve_weighted(&anchors).ok_or(collinear)?;
        assess(&anchors, position, covariance, conditioning, None)
    }
}

fn solve_weighted(anchors: &[Anchor]) -> Option<(Point, Matrix2<f64>)> {
    // Weights are relative to the largest weight, and places to the first station, to keep the numbers well scaled.
    let origin = anchors.first()?.at;
    let spread = |a: &Anchor| 2.0 * a.range_m * a.sigma_m;
    let least = anchors.iter().map(spread).fold(f64::INFINITY, f64::min);
    let rows = || {
        anchors.iter().map(|a| {
            let s = a.at - origin;
            ((least / spread(a)).powi(2), s, (s.norm_squared() - a.range_m.powi(2)) / 2.0)
        })
    };
    let mass: f64 = rows().map(|(w, _, _)| w).sum();
    let middle = rows().map(|(w, s, _)| s * w).sum::<Vector>() / mass;
    let middle_square = rows().map(|(w, _, b)| b * w).sum::<f64>() / mass;
    let mut normal = Matrix2::zeros();
    let mut right = Vector::zeros();
    for (w, s, b) in rows() {
        let away = s - middle;
        normal += away * away.transpose() * w;
        right += away * (w * (b - middle_square));
    }
    let inverse = inverse_of(&normal)?;
    Some((origin + inverse * right, inverse * (least / 2.0).powi(2)))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::{
        Aggregation, LinearLs,
        draws::{Draws, exact, ring, skew_stations, stations},
    };
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn exact_ranges_give_the_exact_point(x in -9.0..9.0_f64, y in -9.0..9.0_f64) {
            let (stations, truth) = (ring(5, 7.5), Point::new(x, y));
            prop_assume!(stations.iter().all(|s| (s.position - truth).norm() > 0.05));
            let fix = WeightedLinear.solve(&exact(&stations, truth), &stations, None).unwrap();
            prop_assert!((fix.position - truth).norm() < 1e-9);
        }
    }

    #[test]
    fn three_stations_leave_nothing_to_weigh() {
        let (stations, mut draws) = (skew_stations(), Draws::new(0.05, 20, 3));
        for _ in 0..100 {
            let truth = draws.on_disc();
            let ranges = draws.rangings(&stations, truth, Aggregation::Mean);
            let weighted = WeightedLinear.solve(&ranges, &stations, None).unwrap();
            let plain = LinearLs.solve(&ranges, &stations, None).unwrap();
            assert!((weighted.position - plain.position).norm() < 1e-8);
            assert!((weighted.covariance - plain.covariance).norm() < 1e-8 * plain.covariance.norm());
        }
    }

    #[test]
    fn with_eight_stations_the_weights_halve_the_error() {
        let (stations, mut draws) = (ring(8, 7.5), Draws::new(0.05, 20, 4));
        let (mut plain, mut weighted) = (0.0, 0.0);
        for _ in 0..2_000 {
            let truth = draws.on_disc();
            let ranges = draws.rangings(&stations, truth, Aggregation::Mean);
            plain += (LinearLs.solve(&ranges, &stations, None).unwrap().position - truth).norm();
            weighted += (WeightedLinear.solve(&ranges, &stations, None).unwrap().position - truth).norm();
        }
        assert!(weighted < 0.6 * plain, "{weighted} {plain}");
    }

    #[test]
    fn stations_on_a_line_are_refused() {
        let stations = stations(&[(-5.0, 1.0), (0.0, 1.0), (5.0, 1.0)]);
        let answer = WeightedLinear.solve(&exact(&stations, Point::new(1.0, 3.0)), &stations, None);
        assert!(matches!(answer, Err(FixError::Collinear { .. })));
    }
}
