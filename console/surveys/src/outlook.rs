//! When the floor reaches a given thickness, if losses keep growing at the rates of the comparison.

use crate::{Comparison, Growth, SIGMAS_95, Survey};
use serde::Serialize;

/// The premises of the calculation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Premises {
    /// Nominal thickness `t`, millimetres.
    pub thickness_mm: f64,
    /// The least thickness `t_min` that the inspector accepts, millimetres.
    pub minimum_mm: f64,
    /// Years between the surveys.
    pub years: f64,
}

/// The rate of an indication.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Basis {
    /// Both surveys show it: the upper end of the 95 % interval of its rate.
    Matched,
    /// Only the second survey shows it, on floor that the first one tested, or it is cut by untested floor: its depth and
    /// the 95 % error of its depth, divided by the years between the surveys, as if the whole depth had grown since the
    /// first survey.
    WholeDepth,
}

/// The indication that reaches the least thickness first, and when:
/// `years = max(0, (t - d - e - t_min) / r)` after the second survey. If several have reached it, the deepest one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Outlook {
    /// The premises.
    pub premises: Premises,
    /// Index of the indication in the second survey.
    pub second: usize,
    /// How its rate was found.
    pub basis: Basis,
    /// Its depth `d` in the second survey, millimetres.
    pub depth_mm: f64,
    /// The 95 % error `e` of the depth, millimetres.
    pub depth_error_mm: f64,
    /// Its rate `r`, millimetres a year.
    pub rate_mm_per_a: f64,
    /// Years after the second survey.
    pub years: f64,
    /// Number of indications that have reached the least thickness by the second survey: `t - d - e <= t_min`.
    pub reached: usize,
}

impl Outlook {
    /// The outlook of the indication that reaches the least thickness first; `None` if no indication grows.
    ///
    /// Indications on floor that the first survey did not test have no rate; they count only if they are already at the
    /// least thickness.
    pub fn of(comparison: &Comparison, second: &Survey, minimum_mm: f64) -> Option<Self> {
        let premises = Premises { thickness_mm: second.thickness_mm, minimum_mm, years: comparison.years };
        let matched = comparison
            .matched
            .iter()
            .map(|(pair, growth)| (pair.second, Some(growth).filter(|_| !pair.is_cut), true));
        let new = comparison.new.iter().map(|one| (one.index, None, one.is_tested));
        let outlook = |(index, growth, has_rate)| {
            Self::one(premises, second, index, growth).filter(|outlook| has_rate || outlook.years <= 0.0)
        };
        let all: Vec<Self> = matched.chain(new).filter_map(outlook).collect();
        let reached = all.iter().filter(|one| one.spare_mm() <= 0.0).count();
        let soonest =
            |a: &&Self, b: &&Self| a.years.total_cmp(&b.years).then(a.spare_mm().total_cmp(&b.spare_mm()));
        all.iter().min_by(soonest).map(|first| Self { reached, ..*first })
    }

    /// Thickness left above the least thickness, millimetres; negative if less is left.
    fn spare_mm(&self) -> f64 {
        self.premises.thickness_mm - self.depth_mm - self.depth_error_mm - self.premises.minimum_mm
    }

    fn one(premises: Premises, survey: &Survey, second: usize, growth: Option<&Growth>) -> Option<Self> {
        let depth_mm = survey.indications[second].depth_mm;
        let depth_error_mm = SIGMAS_95 * survey.indications[second].depth_sigma_mm;
        let (basis, rate_mm_per_a) = match growth {
            Some(growth) => (Basis::Matched, growth.rate_interval_mm_per_a[1]),
            None => (Basis::WholeDepth, (depth_mm + depth_error_mm) / premises.years),
        };
        let outlook =
            Self { premises, second, basis, depth_mm, depth_error_mm, rate_mm_per_a, years: 0.0, reached: 0 };
        let spare_mm = outlook.spare_mm();
        if spare_mm <= 0.0 {
            return Some(outlook);
        }
        // A loss that does not grow reaches nothing.
        (rate_mm_per_a > 0.0).then(|| Self { years: spare_mm / rate_mm_per_a, ..outlook })
    }
}
