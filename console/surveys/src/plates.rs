//! The rates of the plates.

use crate::{Growth, Indication, Match, Unmatched};
use serde::Serialize;
use std::collections::BTreeMap;

/// The least standard deviation by which growths are weighted, millimetres.
const LEAST_SIGMA_MM: f64 = 1e-3;

/// The indications of a plate, and how fast they grow.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlateRate {
    /// Name of the plate; empty if the layout is not known.
    pub plate: String,
    /// Number of indications that both surveys show.
    pub matched: usize,
    /// Number of new indications on floor that the first survey tested.
    pub new: usize,
    /// Number of indications that only the first survey shows, on floor that the second survey tested.
    pub gone: usize,
    /// Mean growth of the indications that both surveys show, weighted by the inverse variances, without those that are
    /// cut by untested floor; absent if none is left.
    pub mean: Option<Growth>,
    /// The growth of the one of them with the greatest rate.
    pub greatest: Option<Growth>,
}

/// What was found on a plate.
#[derive(Default)]
struct Found {
    matched: usize,
    /// The growths of the matches that are not cut.
    growths: Vec<Growth>,
    new: usize,
    gone: usize,
}

/// The rates of all plates with indications, by name: first the matches, with the plate of the second survey, then the
/// new and the gone indications.
pub(crate) fn plates(
    [first, second]: [&[Indication]; 2],
    matched: &[(Match, Growth)],
    [new, gone]: [&[Unmatched]; 2],
    years: f64,
) -> Vec<PlateRate> {
    let name = |all: &[Indication], index: usize| all[index].plate.clone().unwrap_or_default();
    let mut on: BTreeMap<String, Found> = BTreeMap::new();
    for (pair, growth) in matched {
        let found = on.entry(name(second, pair.second)).or_default();
        found.matched += 1;
        found.growths.extend((!pair.is_cut).then_some(*growth));
    }
    for one in new.iter().filter(|one| one.is_alone()) {
        on.entry(name(second, one.index)).or_default().new += 1;
    }
    for one in gone.iter().filter(|one| one.is_alone()) {
        on.entry(name(first, one.index)).or_default().gone += 1;
    }
    on.into_iter().map(|(plate, found)| found.rate(plate, years)).collect()
}

impl Found {
    fn rate(self, plate: String, years: f64) -> PlateRate {
        let Self { matched, growths, new, gone } = self;
        PlateRate {
            plate,
            matched,
            new,
            gone,
            mean: mean(&growths, years),
            greatest: growths.into_iter().max_by(|a, b| a.mm.total_cmp(&b.mm)),
        }
    }
}

/// The mean, weighted by the inverse variances.
fn mean(growths: &[Growth], years: f64) -> Option<Growth> {
    let (mut sum, mut weighted) = (0.0, 0.0);
    for growth in growths {
        let weight = growth.sigma_mm().max(LEAST_SIGMA_MM).powi(-2);
        (sum, weighted) = (sum + weight, weighted + weight * growth.mm);
    }
    (sum > 0.0).then(|| Growth::new(weighted / sum, sum.sqrt().recip(), years))
}
