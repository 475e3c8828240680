//! Finds the indications that are a part of a larger one of the other survey.
//!
//! Readings near the threshold join losses in one survey and divide them in the other: several indications of one survey
//! then lie within the extent of a single one of the other. The largest likelihood pairs one of them; the others are
//! neither new nor gone.

use crate::{Indication, Match, Registration, Survey, matching::grows_back};
use nalgebra::Matrix2;
use world::{Point, Vector};

/// The largest squared distance, in standard deviations, of the middle of a part from the extent of the whole: 95 % of
/// the distances are smaller (chi-squared, two degrees of freedom).
const BESIDE: f64 = 5.991;

/// The two surveys, and how the second one lies in the frame of the first one.
#[derive(Clone, Copy)]
pub(crate) struct Both<'a> {
    pub(crate) first: &'a Survey,
    pub(crate) second: &'a Survey,
    pub(crate) registration: &'a Registration,
}

impl Both<'_> {
    /// The index of the indication of the first survey that covers an indication of the second one; `None` if none does.
    pub(crate) fn whole_of_second(&self, part: usize) -> Option<usize> {
        let part = &self.second.indications[part];
        let at = self.registration.apply(part.at);
        let off = |whole: &Indication| at - nearest(whole, at);
        let all = &self.first.indications;
        self.whole(part, all, off, |whole| whole.covariance + self.registration.turned(part))
    }

    /// The index of the indication of the second survey that covers an indication of the first one; `None` if none does.
    pub(crate) fn whole_of_first(&self, part: usize) -> Option<usize> {
        let part = &self.first.indications[part];
        let at = self.registration.back(part.at);
        let off = |whole: &Indication| part.at - self.registration.apply(nearest(whole, at));
        let all = &self.second.indications;
        self.whole(part, all, off, |whole| part.covariance + self.registration.turned(whole))
    }

    /// Matches by extent: an indication that has no partner by place, and covers some of the other survey that have none
    /// either, is the same loss as the deepest of them. Its middle has moved, because losses were joined or divided.
    pub(crate) fn matches(&self, by_place: &[Match]) -> Vec<Match> {
        let is_free = |pairs: &[Match], [first, second]: [usize; 2]| {
            pairs.iter().all(|pair| pair.first != first && pair.second != second)
        };
        let joined =
            (0..self.first.indications.len()).filter_map(|part| Some([part, self.whole_of_first(part)?]));
        let divided =
            (0..self.second.indications.len()).filter_map(|part| Some([self.whole_of_second(part)?, part]));
        let mut all: Vec<[usize; 2]> =
            joined.chain(divided).filter(|pair| is_free(by_place, *pair)).collect();
        let depths_mm = |[first, second]: [usize; 2]| {
            self.first.indications[first].depth_mm + self.second.indications[second].depth_mm
        };
        // The deepest part of each whole comes first.
        all.sort_by(|one, other| depths_mm(*other).total_cmp(&depths_mm(*one)).then(one.cmp(other)));
        let mut found: Vec<Match> = Vec::new();
        for [first, second] in &all {
            let (one, other) = (&self.first.indications[*first], &self.second.indications[*second]);
            if is_free(&found, [*first, *second]) && !grows_back(one, other) {
                let shares = |pair: &&[usize; 2]| (pair[0] == *first) != (pair[1] == *second);
                found.push(Match {
                    first: *first,
                    second: *second,
                    apart_m: (self.registration.apply(other.at) - one.at).norm(),
                    rivals: all.iter().filter(shares).count(),
                    is_cut: one.is_cut || other.is_cut,
                });
            }
        }
        found
    }

    /// The indication nearest to a part, by the distance of the part's middle from its extent, among those that are
    /// larger and near enough. `off` is in the first frame.
    fn whole(
        &self,
        part: &Indication,
        all: &[Indication],
        off: impl Fn(&Indication) -> Vector,
        covariance: impl Fn(&Indication) -> Matrix2<f64>,
    ) -> Option<usize> {
        let distance2 = |whole: &Indication| {
            let (off, covariance) = (off(whole), covariance(whole) + self.registration.covariance());
            Some(off.dot(&(covariance.try_inverse()? * off))).filter(|distance2| *distance2 <= BESIDE)
        };
        let is_larger = |whole: &Indication| whole.size_m() > part.size_m();
        let near = all.iter().enumerate().filter(|(_, whole)| is_larger(whole));
        let near = near.filter_map(|(index, whole)| Some((index, distance2(whole)?, whole.size_m())));
        near.min_by(|a, b| a.1.total_cmp(&b.1).then(b.2.total_cmp(&a.2))).map(|(index, ..)| index)
    }
}

/// The place within the extent of an indication that is nearest to a place, in the frame of its survey.
fn nearest(whole: &Indication, place: Point) -> Point {
    place.sup(&whole.low).inf(&whole.high)
}
