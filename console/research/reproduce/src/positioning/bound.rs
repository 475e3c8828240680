//! The Cramér-Rao bound.

use std::f64::consts::{PI, TAU};
use world::{Point, Station};

/// Mean error of the best unbiased estimator for normal noise: the Cramér-Rao bound at a true position, metres.
///
/// A normal error of covariance `C` has the mean length `sqrt(pi / 2)` times the mean over all directions of
/// `sqrt(a cos^2 + b sin^2)`, with `a` and `b` the eigenvalues of `C`.
pub(super) fn cramer_rao_m(
    stations: &[Station],
    truth: Point,
    sigma_ratio: f64,
    repetitions: u32,
) -> Option<f64> {
    let mut information = nalgebra::Matrix2::zeros();
    for station in stations {
        let away = truth - station.position;
        let sigma_m = sigma_ratio * away.norm() / f64::from(repetitions).sqrt();
        let direction = away.try_normalize(1e-9)?;
        information += direction * direction.transpose() / sigma_m.powi(2);
    }
    let eigen = information.try_inverse()?.symmetric_eigenvalues();
    let length = |k: u32| {
        let angle = TAU * f64::from(k) / 64.0;
        (eigen[0] * angle.cos().powi(2) + eigen[1] * angle.sin().powi(2)).max(0.0).sqrt()
    };
    Some((PI / 2.0).sqrt() * (0..64).map(length).sum::<f64>() / 64.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::positioning::setup::Layout;

    #[test]
    fn the_bound_of_a_round_error_is_that_of_rayleigh() {
        // Four stations on a ring locate the middle with the same error in all directions: sigma^2 / 2 each.
        let stations = Layout::Ring(4, 5.0).stations();
        let bound = cramer_rao_m(&stations, Point::origin(), 0.03, 9).expect("a good geometry");
        let sigma = 0.03 * 5.0 / 3.0 / 2.0_f64.sqrt();
        assert!((bound - sigma * (PI / 2.0).sqrt()).abs() < 1e-12, "{bound}");
    }
}
