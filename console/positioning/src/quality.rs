//! Rates the quality of a position: residuals, dilution, the chi-squared test.

use crate::{
    anchor::{Anchor, View, on_near_circle},
    fix::{Fix, FixError, Integrity, Residual},
};
use nalgebra::Matrix2;
use world::Point;

/// Standard normal quantile beyond which residuals are suspect. The residuals of one correct fix in 100 lie beyond it.
const SUSPECT_Z: f64 = 2.326_347_874;
/// Standard normal quantile beyond which residuals raise an alarm. The residuals of one correct fix in 1000 lie beyond
/// it.
pub(crate) const ALARM_Z: f64 = 3.090_232_306;

/// Standard normal quantile beyond which the scatter of readings exceeds their noise. One correct set in 10,000 lies
/// beyond it.
const SCATTER_Z: f64 = 3.719_016_485;

/// The number of standard deviations that a protection level allows for chance. One position in 3000 is farther off.
const PROTECTION_SIGMAS: f64 = 4.0;
/// A distance, in standard deviations: if a place this far away cannot be ruled out, the errors do not form an ellipse.
const BENT_SIGMAS: f64 = 5.0;
/// The share of a range's variance that must remain in its residual for the other ranges to check it.
pub(crate) const LEAST_SPARED: f64 = 1e-6;

/// Stands for an infinite dilution, so that every number stays finite.
pub(crate) const NO_GEOMETRY: f64 = 1e9;

/// Assembles a fix from ranges of known length, with its protection level.
pub(crate) fn assess(
    anchors: &[Anchor],
    position: Point,
    covariance: Matrix2<f64>,
    conditioning: f64,
    mirror: Option<Point>,
) -> Result<Fix, FixError> {
    let seen = Seen::from(anchors, position);
    let fix = seen.rated(covariance, conditioning, mirror)?;
    Ok(Fix { protection_level_m: seen.protection_level_m(&covariance), ..fix })
}

/// Assembles a fix from ranges that are all too long by one unknown length, found before; without a protection level.
///
/// Leaving out a station also frees the length, so the protection level for known ranges does not apply.
pub(crate) fn assess_excess(
    anchors: &[Anchor],
    position: Point,
    covariance: Matrix2<f64>,
    conditioning: f64,
) -> Result<Fix, FixError> {
    let mut fix = Seen::from(anchors, position).rated(covariance, conditioning, None)?;
    fix.degrees_of_freedom -= 1;
    fix.integrity = integrity_of(fix.chi2, fix.degrees_of_freedom);
    Ok(fix)
}

/// The stations of a fix as seen from its position.
struct Seen<'a> {
    anchors: &'a [Anchor],
    position: Point,
    views: Vec<View>,
}

impl<'a> Seen<'a> {
    fn from(anchors: &'a [Anchor], position: Point) -> Self {
        Self { anchors, position, views: anchors.iter().map(|a| a.view_from(position)).collect() }
    }

    /// Rates the integrity of the fix according to its residuals.
    fn rated(
        &self,
        covariance: Matrix2<f64>,
        conditioning: f64,
        mirror: Option<Point>,
    ) -> Result<Fix, FixError> {
        let chi2: f64 = self.views.iter().map(View::squared_error).sum();
        let degrees_of_freedom = u32::try_from(self.anchors.len().saturating_sub(2)).unwrap_or(u32::MAX);
        let is_finite =
            self.position.iter().chain(covariance.iter()).chain([&chi2]).all(|number| number.is_finite());
        if !is_finite {
            return Err(FixError::NotConverged { iterations: 0 });
        }
        let bent = || has_rival_on_circle(self.anchors, self.position, &covariance, chi2);
        let integrity = match integrity_of(chi2, degrees_of_freedom) {
            Integrity::Ok if bent() => Integrity::Suspect,
            rated => rated,
        };
        let residual = |(a, v): (&Anchor, &View)| Residual {
            station: a.station,
            residual_m: v.residual_m,
            sigma_m: v.sigma_m,
        };
        Ok(Fix {
            position: self.position,
            covariance,
            residuals: self.anchors.iter().zip(&self.views).map(residual).collect(),
            used: self.anchors.iter().map(|a| a.station).collect(),
            excluded: Vec::new(),
            chi2,
            degrees_of_freedom,
            gdop: self.gdop(),
            conditioning,
            mirror,
            protection_level_m: None,
            integrity,
        })
    }

    /// Returns the radius that contains the true position even if any one range is wrong: for each station, the
    /// distance to the position computed without that station, plus the uncertainty of that position (solution
    /// separation); the largest sum counts. `None` if any station is indispensable. With a stated risk, [`crate::protection`] replaces this
    /// level.
    fn protection_level_m(&self, covariance: &Matrix2<f64>) -> Option<f64> {
        let reach_m = |covariance: &Matrix2<f64>| PROTECTION_SIGMAS * largest_sigma_m(covariance);
        if self.anchors.len() < 3 {
            return None;
        }
        let mut level_m = reach_m(covariance);
        for view in &self.views {
            // Removes one range from a least squares fit (Sherman and Morrison).
            let pull = covariance * view.direction;
            let spared = view.sigma_m.powi(2) - view.direction.dot(&pull);
            let without = covariance + pull * pull.transpose() / spared;
            let shift_m = (pull * (view.residual_m / spared)).norm();
            let needed_m = shift_m + reach_m(&without);
            if spared <= view.sigma_m.powi(2) * LEAST_SPARED || !needed_m.is_finite() {
                return None;
            }
            level_m = level_m.max(needed_m);
        }
        Some(level_m)
    }

    /// Returns position sigma per range sigma, as if all ranges were equally good.
    fn gdop(&self) -> f64 {
        let information: Matrix2<f64> =
            self.views.iter().map(|v| v.direction * v.direction.transpose()).sum();
        inverse_of(&information)
            .map_or(NO_GEOMETRY, |inverse| inverse.trace().max(0.0).sqrt().min(NO_GEOMETRY))
    }
}

/// Whether a place on the range circle of a station close by fits nearly as well and lies beyond the error ellipse.
/// There, errors are curved like the circle.
fn has_rival_on_circle(anchors: &[Anchor], position: Point, covariance: &Matrix2<f64>, chi2: f64) -> bool {
    let reach_m = BENT_SIGMAS * largest_sigma_m(covariance);
    let cost = |at: Point| anchors.iter().map(|a| a.view_from(at).squared_error()).sum::<f64>();
    on_near_circle(anchors)
        .any(|at| (at - position).norm() > reach_m && cost(at) < chi2 + PROTECTION_SIGMAS.powi(2))
}

/// Returns the standard deviation along the longest axis of a covariance, metres.
pub(crate) fn largest_sigma_m(covariance: &Matrix2<f64>) -> f64 {
    largest_variance(covariance).sqrt()
}

/// Returns the variance along the longest axis of a covariance, square metres.
pub(crate) fn largest_variance(covariance: &Matrix2<f64>) -> f64 {
    let (a, b, c) = (covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 1)]);
    (f64::midpoint(a, c) + ((a - c) / 2.0).hypot(b)).max(0.0)
}

/// Returns the integrity for a sum of squared normalised residuals.
pub(crate) fn integrity_of(chi2: f64, degrees_of_freedom: u32) -> Integrity {
    if degrees_of_freedom == 0 {
        Integrity::Untestable
    } else if chi2 > alarm_limit(degrees_of_freedom) {
        Integrity::Alarm
    } else if chi2 > chi_squared_quantile(SUSPECT_Z, degrees_of_freedom) {
        Integrity::Suspect
    } else {
        Integrity::Ok
    }
}

/// Returns the sum of squared normalised differences beyond which the scatter of readings exceeds their noise. One
/// correct sum in 10,000 lies beyond it.
pub fn scatter_limit(degrees_of_freedom: u32) -> f64 {
    chi_squared_quantile(SCATTER_Z, degrees_of_freedom)
}

/// Returns the sum of squared normalised residuals beyond which ranges contradict each other.
pub fn alarm_limit(degrees_of_freedom: u32) -> f64 {
    chi_squared_quantile(ALARM_Z, degrees_of_freedom)
}

/// Returns the residual beyond which one station of a fix counts as wrong, metres.
pub(crate) fn residual_gate_m(sigma_m: f64) -> f64 {
    ALARM_Z * sigma_m
}

/// Returns a quantile of the chi-squared distribution, by the cube formula of Wilson and Hilferty, which is accurate to
/// 3 % for the tails used here.
pub(crate) fn chi_squared_quantile(z: f64, degrees_of_freedom: u32) -> f64 {
    let k = f64::from(degrees_of_freedom);
    let spread = 2.0 / (9.0 * k);
    k * (1.0 - spread + z * spread.sqrt()).powi(3)
}

/// Returns the inverse of a symmetric matrix without negative eigenvalues; `None` if it is nearly singular.
pub(crate) fn inverse_of(information: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    let (a, b, c) = (information[(0, 0)], information[(0, 1)], information[(1, 1)]);
    let determinant = a * c - b * b;
    let is_sound = determinant > 1e-14 * (a + c).powi(2) && determinant.is_finite();
    is_sound.then(|| Matrix2::new(c, -b, -b, a) / determinant)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quantiles_are_those_of_the_tables() {
        for (z, k, table) in [
            (SUSPECT_Z, 1, 6.635),
            (SUSPECT_Z, 2, 9.210),
            (SUSPECT_Z, 6, 16.812),
            (ALARM_Z, 1, 10.828),
            (ALARM_Z, 2, 13.816),
            (ALARM_Z, 6, 22.458),
        ] {
            let ours = chi_squared_quantile(z, k);
            assert!((ours / table - 1.0).abs() < 0.032, "{k} degrees: {ours} for {table}");
        }
    }

    #[test]
    fn more_residual_is_never_trusted_more() {
        assert_eq!(integrity_of(1.0, 1), Integrity::Ok);
        assert_eq!(integrity_of(8.0, 1), Integrity::Suspect);
        assert_eq!(integrity_of(20.0, 1), Integrity::Alarm);
        assert_eq!(integrity_of(0.0, 0), Integrity::Untestable);
    }
}
