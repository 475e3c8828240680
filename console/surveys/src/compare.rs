//! The comparison of two surveys.

use crate::{
    Growth, Match, PlateRate, Refusal, Registration, Survey, matching::matches, parts::Both, plates::plates,
};
use serde::Serialize;
use world::Point;

/// Difference between two nominal thicknesses that counts, millimetres.
const THICKNESS_MM: f64 = 0.01;

/// Two surveys compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Years from the first survey to the second one.
    pub years: f64,
    /// How the second survey lies in the frame of the first one.
    pub registration: Registration,
    /// The losses that both surveys show, in the order of the first survey, and their growth.
    pub matched: Vec<(Match, Growth)>,
    /// The indications that only the second survey shows.
    pub new: Vec<Unmatched>,
    /// The indications that only the first survey shows.
    pub gone: Vec<Unmatched>,
    /// The plates with indications.
    pub plates: Vec<PlateRate>,
}

/// An indication that only one survey shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Unmatched {
    /// Its index among the indications of its survey.
    pub index: usize,
    /// Whether the other survey tested its place.
    pub is_tested: bool,
    /// The larger indication of the other survey of which it is a part, as an index among those of that survey. If there
    /// is one, this indication is neither new nor gone.
    pub part_of: Option<usize>,
}

impl Unmatched {
    /// Whether the other survey tested its place and shows no loss there: the indication is new, or gone.
    pub fn is_alone(&self) -> bool {
        self.is_tested && self.part_of.is_none()
    }
}

/// Compares two surveys of one floor. `is_tested` tells whether the first and whether the second survey tested a place,
/// each in its own frame.
///
/// # Errors
/// The second survey is not later, the tanks differ, or the indications are too close together to be told apart.
pub fn compare(
    [first, second]: [&Survey; 2],
    years: f64,
    is_tested: [&dyn Fn(Point) -> bool; 2],
) -> Result<Comparison, Refusal> {
    if years.is_nan() || years <= 0.0 {
        return Err(Refusal::NotLater);
    }
    if (first.thickness_mm - second.thickness_mm).abs() > THICKNESS_MM {
        return Err(Refusal::Thickness { first_mm: first.thickness_mm, second_mm: second.thickness_mm });
    }
    let registration = Registration::of(&first.tank, &second.tank)?;
    let both = Both { first, second, registration: &registration };
    let mut pairs = matches(first, second, &registration)?;
    pairs.extend(both.matches(&pairs));
    pairs.sort_by_key(|pair| pair.first);
    let grown = |pair: Match| {
        (pair, Growth::between(&first.indications[pair.first], &second.indications[pair.second], years))
    };
    let is_new = |index: &usize| pairs.iter().all(|pair| pair.second != *index);
    let is_gone = |index: &usize| pairs.iter().all(|pair| pair.first != *index);
    let new = (0..second.indications.len()).filter(is_new).map(|index| {
        let place = registration.apply(second.indications[index].at);
        Unmatched { index, is_tested: is_tested[0](place), part_of: both.whole_of_second(index) }
    });
    let gone = (0..first.indications.len()).filter(is_gone).map(|index| {
        let place = registration.back(first.indications[index].at);
        Unmatched { index, is_tested: is_tested[1](place), part_of: both.whole_of_first(index) }
    });
    let (new, gone): (Vec<_>, Vec<_>) = (new.collect(), gone.collect());
    let matched: Vec<(Match, Growth)> = pairs.iter().copied().map(grown).collect();
    let plates = plates([&first.indications, &second.indications], &matched, [&new, &gone], years);
    Ok(Comparison { years, registration, matched, new, gone, plates })
}
