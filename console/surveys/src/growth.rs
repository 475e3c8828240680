//! The growth of a loss between two surveys.

use crate::Indication;
use serde::Serialize;

/// Half width of a 95 % interval, in standard deviations.
pub const SIGMAS_95: f64 = 1.96;

/// The growth of a loss, and its rate.
///
/// With the depths `d1` and `d2` and their standard deviations `s1` and `s2`, the growth is `d2 - d1` and its 95 %
/// interval `± 1.96 √(s1² + s2²)`; the rates are these values divided by the years between the surveys.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Growth {
    /// Growth in depth, millimetres; negative if the second survey shows a shallower loss.
    pub mm: f64,
    /// 95 % interval of the growth, millimetres.
    pub interval_mm: [f64; 2],
    /// Rate, millimetres a year.
    pub rate_mm_per_a: f64,
    /// 95 % interval of the rate, millimetres a year.
    pub rate_interval_mm_per_a: [f64; 2],
}

impl Growth {
    /// The growth from one indication to another over a number of years.
    pub(crate) fn between(first: &Indication, second: &Indication, years: f64) -> Self {
        let sigma_mm = first.depth_sigma_mm.hypot(second.depth_sigma_mm);
        Self::new(second.depth_mm - first.depth_mm, sigma_mm, years)
    }

    pub(crate) fn new(mm: f64, sigma_mm: f64, years: f64) -> Self {
        let interval_mm = [mm - SIGMAS_95 * sigma_mm, mm + SIGMAS_95 * sigma_mm];
        let rate_interval_mm_per_a = interval_mm.map(|mm| mm / years);
        Self { mm, interval_mm, rate_mm_per_a: mm / years, rate_interval_mm_per_a }
    }

    /// Standard deviation of the growth, millimetres.
    pub(crate) fn sigma_mm(&self) -> f64 {
        (self.interval_mm[1] - self.mm) / SIGMAS_95
    }
}
