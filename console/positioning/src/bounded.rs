//! Positions that lie within the bounds of every range.

mod region;

use crate::{
    anchor::{Anchor, anchored},
    fix::{Fix, FixError, PositionSolver, Prior, Ranging},
    linear::conditioning,
    nonlinear::solve_anchors,
    quality::assess,
};
use nalgebra::Matrix2;
use region::{Annulus, Region};
use world::{Point, Station};

/// The least width of a bound, metres.
const THINNEST_M: f64 = 1e-6;

/// Computes the mean of all positions at which the error of every single range is at most `ratio` times the distance.
///
/// Each station allows an annulus around it, from its longest range divided by `1 + ratio` to its shortest range
/// divided by `1 - ratio`; the possible positions are those where all annuli overlap. With uniform noise, the
/// likelihood of a position is proportional to `prod l_i^-n_i`, so the weighted centroid is the exact mean of the
/// posterior. Its error then falls in proportion to the number of repetitions, not to the square root of that number.
///
/// The covariance is that of the same posterior. The 95 % ellipse contains more than 95 % of the posterior, because no
/// position outside the set is possible: no point of a convex set is farther than `sqrt(8)` standard deviations from
/// the mean, which is 1.16 times the longer semi-axis.
///
/// Use this solver only if the bound is known to hold: with any other noise the set soon becomes empty, which
/// [`FixError::EmptySet`] reports.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounded {
    /// Largest error of a single range as a share of the distance; below 1.
    pub ratio: f64,
}

impl PositionSolver for Bounded {
    fn solve(&self, ranges: &[Ranging], stations: &[Station], prior: Option<Prior>) -> Result<Fix, FixError> {
        let anchors = anchored(ranges, stations)?;
        let annuli = anchors.iter().map(|a| self.annulus(a, ranges)).collect::<Option<Vec<_>>>();
        let empty = FixError::EmptySet { ratio: self.reported_ratio() };
        let annuli = annuli.ok_or(empty.clone())?;
        // The middle of each annulus is the best single range; a fit to the middles shows whether there is a mirror
        // image.
        let middles: Vec<Anchor> = anchors
            .iter()
            .zip(&annuli)
            .map(|(anchor, annulus)| {
                let sigma_m = annulus.width_m().max(THINNEST_M) / 12.0_f64.sqrt();
                Anchor::new(anchor.station, anchor.at, annulus.middle_m(), sigma_m, anchor.timing_sigma_m)
            })
            .collect();
        let near = match solve_anchors(&middles, prior) {
            // If the fit does not converge, a mirror image cannot be found, but the set may still exist.
            Err(FixError::NotConverged { .. }) => None,
            fit => Some(fit?),
        };
        let sides = near.as_ref().and_then(|near| Some((near.position, near.mirror?)));
        let region = Region::of(&annuli, sides).ok_or(empty)?;
        let floor = Matrix2::identity() * THINNEST_M.powi(2);
        let mirror = sides.map(|(_, mirror)| mirror);
        let mut fix =
            assess(&middles, region.mean, region.covariance + floor, conditioning(&middles), mirror)?;
        // The residuals are within their bounds by construction and cannot raise an alarm.
        if let Some(near) = near {
            fix.integrity = near.integrity.min_trust(fix.integrity);
        }
        Ok(fix)
    }
}

/// The likelihood of positions, given bounded ranges.
#[derive(Debug, Clone)]
pub(crate) struct Likelihood(Vec<Annulus>);

impl Likelihood {
    /// Returns the likelihood of a position up to a factor; 0 where a range is out of bounds.
    pub(crate) fn at(&self, position: Point) -> f64 {
        region::weight_at(&self.0, position)
    }
}

impl Bounded {
    /// Returns the likelihood function of these ranges.
    pub(crate) fn likelihood(self, ranges: &[Ranging], stations: &[Station]) -> Result<Likelihood, FixError> {
        let anchors = anchored(ranges, stations)?;
        let annuli = anchors.iter().map(|a| self.annulus(a, ranges)).collect::<Option<Vec<_>>>();
        annuli.map(Likelihood).ok_or(FixError::EmptySet { ratio: self.reported_ratio() })
    }

    fn reported_ratio(self) -> f64 {
        if self.ratio.is_finite() { self.ratio } else { 0.0 }
    }

    fn annulus(self, anchor: &Anchor, ranges: &[Ranging]) -> Option<Annulus> {
        let ranging = ranges.iter().find(|r| r.station == anchor.station)?;
        let is_usable = (0.0..1.0).contains(&self.ratio);
        // A range outside its own extremes is inconsistent input, so only the extremes are used.
        let (least_m, most_m) = (ranging.least_m, ranging.most_m);
        let annulus = Annulus {
            at: anchor.at,
            inner_m: most_m / (1.0 + self.ratio),
            outer_m: least_m / (1.0 - self.ratio),
            repetitions: ranging.repetitions.clamp(1, 10_000) as i32,
        };
        let is_sound =
            annulus.inner_m > 0.0 && annulus.outer_m.is_finite() && annulus.outer_m >= annulus.inner_m;
        (is_usable && is_sound).then_some(annulus)
    }
}

#[cfg(test)]
mod tests;
