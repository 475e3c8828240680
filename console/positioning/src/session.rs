//! Detects errors of the speed of sound and of single stations from the residuals of a whole session.
//!
//! A single fix absorbs most of such an error in its position; the part left in the residuals adds up over many
//! fixes. The possible errors are: all ranges too long by a share, all ranges too long by a length, or the ranges of
//! one station too long by a length. For each of them, the score and its information are summed over the fixes. The
//! position of each fix is free, and so is its emission time if that is unknown (score test; Baarda 1968 for single
//! readings).

use crate::{
    fix::{Fix, Residual},
    quality::inverse_of,
};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2, Vector3};
use world::{Station, StationId};

/// Number of standard deviations above which an error is significant. Fixes allow for smaller errors
/// ([`Wrong::likely`]). In two series of 200 sets with a wrong speed of sound and no emission times, 93.1 and 94.0 % of
/// the true positions lie in the ellipses of the fixes rated ok. With a limit of 4, only 92.2 % would, because chance
/// hides the remaining errors.
const SIGNIFICANT: f64 = 5.0;
/// Squared shift of the fixes, in units of their variance, below which an error does no harm: 93.5 % of the true
/// positions still lie in the 95 % ellipse.
const HARMLESS: f64 = 0.2;
/// Number of standard deviations below which an offset is attributed to chance: most sessions have no offset.
const BEYOND_CHANCE: f64 = 2.0;
/// The least lead of one error over the others, in the sum of squared residuals in units of their variances, from which it is
/// certainly the cause: odds of exp(lead / 2).
const LEAST_LEAD: f64 = 16.0;
/// The least information that shows an error, as a share of the information that known positions would give.
const LEAST_SEEN: f64 = 1e-6;

/// The index of the scale error of all ranges; the errors of the stations come next, and then the common length of all
/// ranges.
const SCALE: usize = 0;

/// The sums over a session.
#[derive(Debug, Clone)]
pub struct Session {
    stations: Vec<Station>,
    /// Whether the time of each emission is unknown, so that all ranges of a fix are too long by one common length.
    is_emission_free: bool,
    score: DVector<f64>,
    information: DMatrix<f64>,
    /// The information if the positions were known.
    whole: DVector<f64>,
    /// Sum over the fixes of the squared shift that an error of 1 causes, in units of the variance of the fix.
    shift: DVector<f64>,
    fixes: u64,
}

/// An error with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrong {
    /// The amount by which ranges are too long: a share, or a length in metres.
    pub value: f64,
    /// Standard deviation of the amount.
    pub sigma: f64,
    /// Whether the error is more than chance, and more than the stated errors of the fixes allow for.
    pub is_proven: bool,
}

/// An error that all ranges share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CommonError {
    /// The ranges are too long by this share.
    Share(f64),
    /// The ranges are too long by this length, metres.
    Length(f64),
}

impl Default for CommonError {
    /// No error.
    fn default() -> Self {
        Self::Length(0.0)
    }
}

impl CommonError {
    /// Returns the size of the error, as a share or in metres.
    pub(crate) fn size(self) -> f64 {
        match self {
            Self::Share(size) | Self::Length(size) => size.abs(),
        }
    }

    /// Returns the length by which the error extends the range over a distance, metres.
    fn longer_m(self, distance_m: f64) -> f64 {
        match self {
            Self::Share(share) => share * distance_m,
            Self::Length(length_m) => length_m,
        }
    }
}

/// The findings about a session.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Verdict {
    /// The number of fixes evaluated.
    pub fixes: u64,
    /// The share by which all ranges are too long; `None` if the data do not show it.
    pub scale: Option<Wrong>,
    /// The length by which all ranges are too long, metres; `None` if it cannot be seen, for example without emission
    /// times.
    pub offset_m: Option<Wrong>,
    /// The length by which the ranges of each station are too long, metres; stations for which the data do not show it
    /// are left out.
    pub stations: Vec<(StationId, Wrong)>,
}

impl Wrong {
    /// Returns the likely size of the error, as a standard deviation: the part of the finding beyond chance. If the
    /// emission times are unknown, it is the whole finding, because chance then hides as much of an error as it adds.
    pub fn likely(&self, is_emission_free: bool) -> f64 {
        let by_chance = if is_emission_free { 0.0 } else { self.sigma };
        (self.value.powi(2) - by_chance.powi(2)).max(0.0).sqrt()
    }
}

impl Verdict {
    /// Whether any error is proven.
    pub fn is_wrong(&self) -> bool {
        let common = [self.scale, self.offset_m];
        common.into_iter().flatten().any(|wrong| wrong.is_proven)
            || self.stations.iter().any(|(_, wrong)| wrong.is_proven)
    }

    /// Returns the findings about ranges that were corrected beforehand, by a share and by a length for each station with
    /// these standard deviations: what these explain proves nothing.
    #[must_use]
    pub fn beside(mut self, (share, length_m): (f64, f64)) -> Self {
        let allow = |wrong: &mut Wrong, known: f64| {
            wrong.sigma = wrong.sigma.hypot(known);
            wrong.is_proven &= wrong.value.abs() > SIGNIFICANT * wrong.sigma;
        };
        self.scale.iter_mut().for_each(|scale| allow(scale, share));
        self.stations.iter_mut().for_each(|(_, wrong)| allow(wrong, length_m));
        self
    }

    /// Whether a length common to all ranges is the only proven error, and explains the residuals clearly better than any
    /// other.
    pub fn is_length_alone(&self) -> bool {
        let Some(length) = self.offset_m.filter(|length| length.is_proven) else { return false };
        let explained = |wrong: &Wrong| (wrong.value / wrong.sigma).powi(2);
        let mut others = self.scale.iter().chain(self.stations.iter().map(|(_, wrong)| wrong));
        others.all(|wrong| !wrong.is_proven && explained(wrong) + LEAST_LEAD <= explained(&length))
    }

    /// Returns the findings about fixes that a session calibration has corrected: the length that all ranges have in
    /// common. The calibration itself finds the other errors, each from its beginning on.
    #[must_use]
    pub fn beside_calibration(self) -> Self {
        Self { scale: None, stations: Vec::new(), ..self }
    }

    /// Returns the unproven but likely errors of all ranges, as standard deviations.
    pub fn likely_errors(&self, is_emission_free: bool) -> [CommonError; 2] {
        let likely = |wrong: Option<Wrong>| {
            let unproven = wrong.filter(|wrong| !wrong.is_proven);
            unproven.map_or(0.0, |wrong| wrong.likely(is_emission_free))
        };
        let beyond_chance = self.offset_m.filter(|wrong| wrong.value.abs() > BEYOND_CHANCE * wrong.sigma);
        [CommonError::Share(likely(self.scale)), CommonError::Length(likely(beyond_chance))]
    }
}

impl Session {
    /// Creates a session without fixes.
    pub fn new(stations: &[Station], is_emission_free: bool) -> Self {
        let n = stations.len() + 2;
        Self {
            stations: stations.to_vec(),
            is_emission_free,
            score: DVector::zeros(n),
            information: DMatrix::zeros(n, n),
            whole: DVector::zeros(n),
            shift: DVector::zeros(n),
            fixes: 0,
        }
    }

    /// Adds a fix with its residuals.
    pub fn take(&mut self, fix: &Fix) {
        let seen = seen(fix, &self.stations, self.is_emission_free);
        let Some(free) = Free::of(&seen, self.is_emission_free) else { return };
        self.fixes += 1;
        let mut pulls = vec![Vector3::zeros(); self.score.len()];
        for s in &seen {
            let longer = self.longer(s);
            for (i, by_i) in longer {
                self.score[i] += s.weight * by_i * s.residual_m;
                self.whole[i] += s.weight * by_i * by_i;
                pulls[i] += s.by * (s.weight * by_i);
                for (j, by_j) in longer {
                    self.information[(i, j)] += s.weight * by_i * by_j;
                }
            }
        }
        let pulls: Vec<(usize, Vector3<f64>)> =
            pulls.into_iter().enumerate().filter(|(_, pull)| *pull != Vector3::zeros()).collect();
        for (i, pull) in &pulls {
            let moved = free.inverse * pull;
            self.shift[*i] += free.squared_shift(&moved);
            for (j, other) in &pulls {
                self.information[(*i, *j)] -= moved.dot(other);
            }
        }
    }

    /// Returns the lengths by which unit errors extend a range, metres: one for each error that affects this range.
    fn longer(&self, range: &Seen) -> [(usize, f64); 3] {
        [(SCALE, range.distance_m), (range.error, 1.0), (self.offset(), 1.0)]
    }

    /// Returns the index of the common length of all ranges: the last one.
    fn offset(&self) -> usize {
        self.stations.len() + 1
    }

    /// Returns the share by which all ranges are too long and its standard deviation, if it can be seen.
    pub fn scale(&self) -> Option<(f64, f64)> {
        self.alone(SCALE)
    }

    fn alone(&self, error: usize) -> Option<(f64, f64)> {
        let information = self.information[(error, error)];
        let is_seen = information > LEAST_SEEN * self.whole[error] && information > 0.0;
        is_seen.then(|| (self.score[error] / information, information.sqrt().recip()))
    }

    /// Estimates one error together with another.
    fn beside(&self, error: usize, other: usize) -> Option<(f64, f64)> {
        let by = self.information[(error, other)] / self.information[(other, other)];
        let information = self.information[(error, error)] - by * self.information[(other, error)];
        let score = self.score[error] - by * self.score[other];
        let is_seen = information > LEAST_SEEN * self.whole[error].max(f64::MIN_POSITIVE);
        is_seen.then(|| (score / information, information.sqrt().recip()))
    }

    fn is_proven(&self, error: usize, (value, sigma): (f64, f64)) -> bool {
        let shift = value * value * self.shift[error] / self.fixes.max(1) as f64;
        value.abs() > SIGNIFICANT * sigma && shift > HARMLESS
    }

    /// Returns the findings: the error that explains most, and others only if they are proven as well.
    pub fn verdict(&self) -> Verdict {
        let explained =
            |error: usize| self.alone(error).map_or(0.0, |(value, sigma)| (value / sigma).powi(2));
        let n = self.score.len() - usize::from(self.is_emission_free);
        let first = (0..n).max_by(|a, b| explained(*a).total_cmp(&explained(*b))).unwrap_or(0);
        let first =
            Some(first).filter(|first| self.alone(*first).is_some_and(|found| self.is_proven(*first, found)));
        let wrong = |error: usize| {
            let alone = self.alone(error)?;
            let is_proven = match first {
                Some(first) if first != error => {
                    self.beside(error, first).is_some_and(|found| self.is_proven(error, found))
                }
                _ => self.is_proven(error, alone),
            };
            let (value, sigma) = alone;
            Some(Wrong { value, sigma, is_proven })
        };
        Verdict {
            fixes: self.fixes,
            scale: wrong(SCALE),
            offset_m: Some(self.offset()).filter(|_| !self.is_emission_free).and_then(wrong),
            stations: self
                .stations
                .iter()
                .zip(1..)
                .filter_map(|(s, error)| Some((s.id, wrong(error)?)))
                .collect(),
        }
    }
}

/// Returns the shift of a fix caused by a common error of all ranges, metres. `None` if the fix has no free position.
pub(crate) fn shift_by(
    error: CommonError,
    fix: &Fix,
    stations: &[Station],
    is_emission_free: bool,
) -> Option<Vector2<f64>> {
    let seen = seen(fix, stations, is_emission_free);
    let pull: Vector3<f64> = seen.iter().map(|s| s.by * (s.weight * error.longer_m(s.distance_m))).sum();
    Some((Free::of(&seen, is_emission_free)?.inverse * pull).xy())
}

/// Returns by how much the position of a fix moves for each metre that the range of a station is longer. `None` if the
/// fix has no free position.
pub(crate) fn position_by_range(
    fix: &Fix,
    stations: &[Station],
    is_emission_free: bool,
) -> Option<Vec<(StationId, Vector2<f64>)>> {
    let seen = seen(fix, stations, is_emission_free);
    let free = Free::of(&seen, is_emission_free)?;
    let by = |seen: &Seen| (stations[seen.error - 1].id, (free.inverse * seen.by * seen.weight).xy());
    Some(seen.iter().map(by).collect())
}

/// Collects the ranges of a fix.
fn seen(fix: &Fix, stations: &[Station], is_emission_free: bool) -> Vec<Seen> {
    let seen = |residual: &Residual| {
        let index = stations.iter().position(|station| station.id == residual.station)?;
        let away = fix.position - stations[index].position;
        let distance_m = away.norm().max(1e-3);
        let excess = f64::from(u8::from(is_emission_free));
        Some(Seen {
            error: index + 1,
            distance_m,
            by: Vector3::new(away.x / distance_m, away.y / distance_m, excess),
            residual_m: residual.residual_m,
            weight: residual.sigma_m.powi(-2),
        })
    };
    fix.residuals.iter().filter_map(seen).collect()
}

/// A range of a fix.
struct Seen {
    error: usize,
    distance_m: f64,
    /// Derivative of the range with respect to position and common length.
    by: Vector3<f64>,
    residual_m: f64,
    weight: f64,
}

/// The quantities that are free in a fix.
struct Free {
    inverse: Matrix3<f64>,
    position_inverse: Matrix2<f64>,
}

impl Free {
    fn of(seen: &[Seen], is_emission_free: bool) -> Option<Self> {
        let mut information: Matrix3<f64> = seen.iter().map(|s| s.by * s.by.transpose() * s.weight).sum();
        if !is_emission_free {
            information[(2, 2)] = 1.0;
        }
        let inverse = information.try_inverse().filter(|inverse| inverse.iter().all(|c| c.is_finite()))?;
        let position_inverse = inverse_of(&inverse.fixed_view::<2, 2>(0, 0).into_owned())?;
        Some(Self { inverse, position_inverse })
    }

    fn squared_shift(&self, moved: &Vector3<f64>) -> f64 {
        let position = moved.xy();
        position.dot(&(self.position_inverse * position))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::{
        Differences, Nls, Ranging,
        draws::{Draws, ring},
        fix::PositionSolver,
    };

    /// The errors of the ranges in a session: a share and a length for all stations, and a length for station 3.
    #[derive(Clone, Copy, Default)]
    struct Errors {
        scale: f64,
        offset_m: f64,
        bias_m: f64,
    }

    /// Simulates a session with `fixes` fixes and returns its verdict.
    fn verdict(fixes: u32, errors: Errors, is_emission_free: bool, seed: u64) -> Verdict {
        let Errors { scale, offset_m, bias_m } = errors;
        let stations = ring(8, 10.0);
        let mut draws = Draws::new(0.0, 1, seed);
        let mut session = Session::new(&stations, is_emission_free);
        for _ in 0..fixes {
            let truth = draws.on_disc() * 0.9;
            let ranges: Vec<Ranging> = stations
                .iter()
                .map(|station| {
                    let distance_m = (truth - station.position).norm();
                    let bias_m = if station.id == StationId(3) { bias_m } else { 0.0 };
                    let excess_m = if is_emission_free { 20.0 } else { 0.0 };
                    let excess_m = excess_m + offset_m + bias_m;
                    let range_m = distance_m * (1.0 + 0.01 * draws.bell()) * (1.0 + scale) + excess_m;
                    Ranging::single(station.id, range_m, 0.01 * range_m)
                })
                .collect();
            let fix = if is_emission_free {
                Differences.solve(&ranges, &stations, None)
            } else {
                Nls.solve(&ranges, &stations, None)
            };
            session.take(&fix.unwrap());
        }
        session.verdict()
    }

    #[test]
    fn a_wrong_speed_of_sound_is_found_with_its_error_with_and_without_the_time_of_emission() {
        for (is_free, scale) in [(false, 0.01), (true, 0.01), (true, -0.02), (true, 0.05)] {
            let verdict = verdict(400, Errors { scale, ..Errors::default() }, is_free, 3);
            let found = verdict.scale.unwrap();
            // If ranges err by a share, stations on all sides keep a fix in place.
            assert!(found.is_proven || !is_free, "{verdict:?}");
            assert!(found.value.abs() > SIGNIFICANT * found.sigma, "{verdict:?}");
            assert!(
                (found.value - scale).abs() < 4.0 * found.sigma + 0.1 * scale.abs(),
                "{scale}: {found:?}"
            );
            assert!(verdict.stations.iter().all(|(_, wrong)| !wrong.is_proven), "{verdict:?}");
        }
    }

    #[test]
    fn ranges_that_are_all_too_long_by_a_length_are_named_as_that() {
        let with_offset = |offset_m| verdict(100, Errors { offset_m, ..Errors::default() }, false, 5);
        let late = with_offset(0.4);
        let offset = late.offset_m.unwrap();
        assert!(offset.is_proven && (offset.value - 0.4).abs() < 0.05, "{late:?}");
        assert!(late.is_wrong() && late.stations.iter().all(|(_, wrong)| !wrong.is_proven), "{late:?}");
        let sound = with_offset(0.0);
        assert!(!sound.is_wrong() && !sound.offset_m.unwrap().is_proven, "{sound:?}");
        // Without emission times, every fix absorbs such a length.
        let free = verdict(100, Errors { offset_m: 0.4, ..Errors::default() }, true, 5);
        assert!(free.offset_m.is_none() && !free.is_wrong(), "{free:?}");
    }

    #[test]
    fn a_station_that_is_always_late_is_named() {
        for is_free in [false, true] {
            let verdict = verdict(400, Errors { bias_m: 0.15, ..Errors::default() }, is_free, 4);
            let proven: Vec<StationId> =
                verdict.stations.iter().filter(|(_, wrong)| wrong.is_proven).map(|(id, _)| *id).collect();
            assert_eq!(proven, [StationId(3)], "{verdict:?}");
            assert!(!verdict.scale.unwrap().is_proven, "{verdict:?}");
        }
    }

    #[test]
    fn sound_sessions_are_not_blamed() {
        let blamed =
            (0..200).filter(|seed| verdict(40, Errors::default(), seed % 2 == 0, *seed).is_wrong()).count();
        assert!(blamed <= 1, "{blamed} of 200");
    }

    #[test]
    fn four_arrivals_in_one_place_do_not_show_the_scale() {
        let stations = ring(4, 10.0);
        let mut session = Session::new(&stations, true);
        let ranges: Vec<Ranging> = stations.iter().map(|s| Ranging::single(s.id, 30.0, 0.3)).collect();
        session.take(&Differences.solve(&ranges, &stations, None).unwrap());
        assert_eq!(session.scale(), None);
    }
}
