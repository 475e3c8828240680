//! Station-to-station pulses: each station sends, the others hear (Kurz et al. 2005 describe such an automatic
//! calibration for acoustic emission).
//!
//! The places of both stations are surveyed, so a pulse gives the speed of sound and the clocks without a robot: the time
//! from the sender's clock to the receiver's clock is the distance over the speed of sound, plus the offset of the
//! receiver, minus the offset of the sender. Pulses in both directions separate the two. The model is linear, and
//! residuals show a station that is not at its surveyed place.

use crate::{calibration::MOST_SCALE, fix::Integrity, quality::integrity_of, session_calibration::Estimated};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use world::{RangeSet, Station, StationId};

/// The largest number that is accepted as a length, metres.
const LENGTH_LIMIT_M: f64 = 1e6;
/// The largest offset between two clocks that is accepted, as a length that sound travels, metres.
const MOST_OFFSET_M: f64 = 20.0;
/// The least change of the scale between two tests that matters.
const LEAST_CHANGE: f64 = 0.005;
/// Number of standard deviations above which the scale has changed between two tests.
const CHANGED: f64 = 3.0;
/// The same for the clock of a station: every test compares several of them. And the least change that is stated, metres.
const CLOCK_CHANGED: f64 = 5.0;
const LEAST_CLOCK_CHANGE_M: f64 = 0.02;
/// Standard deviation of the scale above which pulses do not determine it.
const UNKNOWN_SCALE: f64 = 0.05;
/// Standard deviation of an offset above which pulses do not determine it, metres.
const UNKNOWN_OFFSET_M: f64 = 1.0;
/// The least number of stations of which a wrong one can be found: the others must still check each other.
const LEAST_TO_SUSPECT: usize = 4;

/// A pulse of one station, as another station heard it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pulse {
    /// The station that sent.
    pub sender: StationId,
    /// The station that heard.
    pub receiver: StationId,
    /// Time from sending to arrival, each by the clock of its station, times the assumed speed of sound, metres.
    pub length_m: f64,
    /// Standard deviation of the length, metres.
    pub sigma_m: f64,
}

/// Returns the longest length of a pulse over a distance that is possible if the stations share a clock, metres: the
/// speed of sound is wrong by at most 30 %, and the clocks of two stations differ by at most 20 m of sound. The length
/// must also be positive.
///
/// ```
/// assert_eq!(positioning::longest_pulse_m(10.0), 33.0);
/// ```
pub fn longest_pulse_m(distance_m: f64) -> f64 {
    distance_m * (1.0 + MOST_SCALE) + MOST_OFFSET_M
}

/// Why pulses give no calibration.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PulseError {
    /// A pulse names a station that was not surveyed.
    #[error("station {} is not surveyed", .station.0)]
    UnknownStation {
        /// The station.
        station: StationId,
    },
    /// A pulse cannot be used: it has the same sender and receiver, or its length or scatter is not a valid number.
    #[error(
        "pulse {} cannot be used: check that another station heard it, and that its length is a number below 1000 km",
        .index + 1
    )]
    BadPulse {
        /// Index of the pulse.
        index: usize,
    },
    /// A length is impossible between stations that share a clock.
    #[error(
        "the pulse from station {} to station {} is {:.2} m long, but only lengths from 0 to {:.2} m are possible; check its \
         unit, and the clocks of both stations",
        .sender.0,
        .receiver.0,
        .length_m,
        .most_m
    )]
    Impossible {
        /// The station that sent.
        sender: StationId,
        /// The station that heard.
        receiver: StationId,
        /// The length, metres.
        length_m: f64,
        /// The longest possible length, metres; see [`longest_pulse_m`].
        most_m: f64,
    },
    /// The stations were to exchange pulses, but none came in time.
    #[error("none came in time; check that the stations send pulses to each other")]
    Missing,
    /// The pulses do not determine the speed of sound beside the clocks.
    #[error(
        "the pulses do not separate the speed of sound from the clocks; let every station send and every other hear"
    )]
    NotDetermined,
    /// All lengths are too long, or too short, by a share that no speed of sound explains.
    #[error(
        "according to the pulses, all ranges are {:.0} % too {}, but a speed of sound is wrong by at most {:.0} %; check the \
         unit of the pulses, the assumed speed of sound, and the survey of the stations",
        100.0 * .scale.abs(),
        if *.scale > 0.0 { "long" } else { "short" },
        100.0 * MOST_SCALE
    )]
    Implausible {
        /// The share by which all lengths are too long.
        scale: f64,
    },
}

/// The result of a pulse test.
///
/// ```
/// use positioning::{Integrity, Pulse, PulseTest};
/// use world::{Point, Station, StationId};
/// let places = [(10.0, 0.0), (0.0, 10.0), (-10.0, 0.0), (1.0, -10.0)];
/// let stations: Vec<Station> = (1..)
///     .zip(places)
///     .map(|(id, (x, y))| Station { id: StationId(id), name: String::new(), position: Point::new(x, y) })
///     .collect();
/// let late_m = [0.3, -0.1, 0.0, -0.2];
/// let mut pulses = Vec::new();
/// for (from, sender) in stations.iter().enumerate() {
///     for (to, receiver) in stations.iter().enumerate().filter(|(to, _)| *to != from) {
///         let length_m = 1.02 * (sender.position - receiver.position).norm() + late_m[to] - late_m[from];
///         pulses.push(Pulse { sender: sender.id, receiver: receiver.id, length_m, sigma_m: 0.01 });
///     }
/// }
/// let test = PulseTest::new(&pulses, &stations).unwrap();
/// assert!((test.scale.value - 0.02).abs() < 1e-9 && test.integrity == Integrity::Ok);
/// assert!(test.offsets_m.iter().zip(late_m).all(|((_, found), late_m)| (found.value - late_m).abs() < 1e-9));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PulseTest {
    /// The share by which all lengths are too long.
    pub scale: Estimated,
    /// The offset of each station that took part, relative to their mean, metres.
    pub offsets_m: Vec<(StationId, Estimated)>,
    /// Whether the pulses agree with the survey.
    pub integrity: Integrity,
    /// If they do not: the station without which the others agree.
    pub suspect: Option<StationId>,
    /// The pulse with the largest residual in standard deviations: sender, receiver, and residual, metres.
    pub worst: (StationId, StationId, f64),
    /// The number of pulses.
    pub pulses: usize,
}

/// A least-squares fit.
struct Fit {
    scale: Estimated,
    offsets_m: Vec<Estimated>,
    chi2: f64,
    degrees_of_freedom: u32,
}

impl PulseTest {
    /// Fits the speed of sound and the clocks to pulses between surveyed stations.
    ///
    /// # Errors
    /// See [`PulseError`].
    pub fn new(pulses: &[Pulse], stations: &[Station]) -> Result<Self, PulseError> {
        check(pulses, stations)?;
        let ids = taking_part(pulses);
        let fit = fit(pulses, &ids, stations).ok_or(PulseError::NotDetermined)?;
        if fit.scale.value.abs() > MOST_SCALE {
            return Err(PulseError::Implausible { scale: fit.scale.value });
        }
        let integrity = integrity_of(fit.chi2, fit.degrees_of_freedom);
        let suspect = (integrity == Integrity::Alarm).then(|| suspect(pulses, &ids, stations)).flatten();
        let residual_m = |pulse: &Pulse| {
            let offset_m =
                |id| ids.iter().position(|own| *own == id).map_or(0.0, |own| fit.offsets_m[own].value);
            let distance_m = distance_m(pulse, stations) * (1.0 + fit.scale.value);
            pulse.length_m - distance_m - offset_m(pulse.receiver) + offset_m(pulse.sender)
        };
        let worst = pulses
            .iter()
            .map(|pulse| (pulse, residual_m(pulse)))
            .max_by(|a, b| (a.1.abs() / a.0.sigma_m).total_cmp(&(b.1.abs() / b.0.sigma_m)))
            .ok_or(PulseError::NotDetermined)?;
        Ok(Self {
            scale: fit.scale,
            offsets_m: ids.iter().copied().zip(fit.offsets_m.iter().copied()).collect(),
            integrity,
            suspect,
            worst: (worst.0.sender, worst.0.receiver, worst.1),
            pulses: pulses.len(),
        })
    }

    /// Whether ranges are corrected by this test: not if its pulses contradict the survey.
    pub fn is_usable(&self) -> bool {
        self.integrity != Integrity::Alarm
    }

    /// Returns by which share ranges have become longer since an earlier test; `None` if chance explains the change, or
    /// if it is below 0.5 %.
    ///
    /// ```
    /// use positioning::{Estimated, Integrity, PulseTest};
    /// use world::StationId;
    /// let test = |value| PulseTest {
    ///     scale: Estimated { value, sigma: 0.001 },
    ///     offsets_m: Vec::new(),
    ///     integrity: Integrity::Ok,
    ///     suspect: None,
    ///     worst: (StationId(1), StationId(2), 0.0),
    ///     pulses: 12,
    /// };
    /// assert_eq!(test(0.018).change_since(&test(0.016)), None);
    /// assert!((test(0.060).change_since(&test(0.018)).unwrap().value - 0.042).abs() < 1e-12);
    /// ```
    pub fn change_since(&self, before: &Self) -> Option<Estimated> {
        let value = self.scale.value - before.scale.value;
        let sigma = self.scale.sigma.hypot(before.scale.sigma);
        (value.abs() > (CHANGED * sigma).max(LEAST_CHANGE)).then_some(Estimated { value, sigma })
    }
}

impl PulseTest {
    /// Returns the stations whose clocks have changed since an earlier test by more than chance explains, each with its change,
    /// metres. Clocks show only relative to each other, so the median of all changes counts as zero.
    pub fn clock_changes_since(&self, before: &Self) -> Vec<(StationId, Estimated)> {
        let change = |(id, now): &(StationId, Estimated)| {
            let (_, then) = before.offsets_m.iter().find(|(station, _)| station == id)?;
            let sigma = now.sigma.hypot(then.sigma);
            Some((*id, Estimated { value: now.value - then.value, sigma }))
        };
        let mut changes: Vec<(StationId, Estimated)> = self.offsets_m.iter().filter_map(change).collect();
        let mut sizes: Vec<f64> = changes.iter().map(|(_, change)| change.value).collect();
        sizes.sort_by(f64::total_cmp);
        let Some(middle) = sizes.get(sizes.len() / 2).copied() else { return Vec::new() };
        for (_, change) in &mut changes {
            change.value -= middle;
        }
        let least_m = |sigma: f64| (CLOCK_CHANGED * sigma).max(LEAST_CLOCK_CHANGE_M);
        changes.retain(|(_, change)| change.value.abs() > least_m(change.sigma));
        changes
    }
}

/// Pulse tests of a session, in the order of their times.
///
/// Between two tests, speed of sound and clocks change linearly; before the first and after the last one, they stay. The
/// offsets of a test are relative to the mean of its stations, so those of all tests are made relative to the mean of the
/// stations that took part in every test. A station that took no part in one of two tests keeps the offset of the other. A
/// station that took part in none has an unknown clock.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PulseSeries {
    /// The tests with their times, seconds.
    pub tests: Vec<(f64, PulseTest)>,
}

impl PulseSeries {
    /// Removes the errors at a time, seconds, from sets of ranges of a robot: `(range - offset) / (1 + scale)`. If the tests
    /// give clocks, the sets of stations without one are removed.
    pub fn correct(&self, t_s: f64, sets: &mut Vec<RangeSet>) {
        let Some((before, after, share)) = self.around(t_s) else { return };
        sets.retain(|set| self.has_clock(set.station));
        let between = |before: f64, after: f64| (1.0 - share) * before + share * after;
        let by = 1.0 / (1.0 + between(before.scale.value, after.scale.value));
        let datums_m = [before, after].map(|test| self.datum_m(test));
        for set in sets {
            let own_m = |test: &PulseTest, datum_m: f64| {
                let (_, offset_m) = test.offsets_m.iter().find(|(id, _)| *id == set.station)?;
                Some(offset_m.value - datum_m)
            };
            let offset_m = match (own_m(before, datums_m[0]), own_m(after, datums_m[1])) {
                (Some(before_m), Some(after_m)) => between(before_m, after_m),
                (before_m, after_m) => before_m.or(after_m).unwrap_or(0.0),
            };
            set.ranges_m.iter_mut().for_each(|range_m| *range_m = (*range_m - offset_m) * by);
        }
    }

    /// Whether the clock of a station is known, or none is.
    fn has_clock(&self, station: StationId) -> bool {
        let offsets_m = || self.tests.iter().flat_map(|(_, test)| &test.offsets_m);
        offsets_m().next().is_none() || offsets_m().any(|(id, _)| *id == station)
    }

    /// The mean offset in a test of the stations that took part in every test, metres.
    fn datum_m(&self, test: &PulseTest) -> f64 {
        let is_in_all = |id: &StationId| {
            self.tests.iter().all(|(_, other)| other.offsets_m.iter().any(|(station, _)| station == id))
        };
        let common: Vec<f64> =
            test.offsets_m.iter().filter(|(id, _)| is_in_all(id)).map(|(_, offset)| offset.value).collect();
        // The offsets of a test are relative to their mean already.
        let is_whole = common.is_empty() || common.len() == test.offsets_m.len();
        if is_whole { 0.0 } else { common.iter().sum::<f64>() / common.len() as f64 }
    }

    /// The errors that corrected ranges probably still have, as standard deviations: the share by which all are too long,
    /// and the length by which those of a station are, metres. `None` without a test.
    pub fn sigmas(&self) -> Option<(f64, f64)> {
        let tests = || self.tests.iter().map(|(_, test)| test);
        let offset_m =
            tests().flat_map(|test| &test.offsets_m).map(|(_, offset_m)| offset_m.sigma).fold(0.0, f64::max);
        let scale = tests().map(|test| test.scale.sigma).reduce(f64::max)?;
        Some((scale, offset_m))
    }

    /// The tests before and after a time, and the share of the way between them.
    fn around(&self, t_s: f64) -> Option<(&PulseTest, &PulseTest, f64)> {
        let next = self.tests.partition_point(|(at_s, _)| *at_s <= t_s);
        let last = self.tests.len().checked_sub(1)?;
        let (from_s, before) = &self.tests[next.saturating_sub(1)];
        let (to_s, after) = &self.tests[next.min(last)];
        let share = if to_s > from_s { ((t_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0) } else { 0.0 };
        Some((before, after, share))
    }
}

fn check(pulses: &[Pulse], stations: &[Station]) -> Result<(), PulseError> {
    for (index, pulse) in pulses.iter().enumerate() {
        let ends = [pulse.sender, pulse.receiver];
        if let Some(station) = ends.into_iter().find(|id| !stations.iter().any(|s| s.id == *id)) {
            return Err(PulseError::UnknownStation { station });
        }
        // The comparisons also refuse NaN.
        let is_usable =
            pulse.length_m.abs() <= LENGTH_LIMIT_M && (1e-9..=LENGTH_LIMIT_M).contains(&pulse.sigma_m);
        if !is_usable || pulse.sender == pulse.receiver {
            return Err(PulseError::BadPulse { index });
        }
    }
    Ok(())
}

fn taking_part(pulses: &[Pulse]) -> Vec<StationId> {
    let mut ids: Vec<StationId> = pulses.iter().flat_map(|pulse| [pulse.sender, pulse.receiver]).collect();
    ids.sort();
    ids.dedup();
    ids
}

/// Surveyed distance between sender and receiver, metres.
fn distance_m(pulse: &Pulse, stations: &[Station]) -> f64 {
    let at = |id| stations.iter().find(|station| station.id == id).map(|station| station.position);
    at(pulse.sender).zip(at(pulse.receiver)).map_or(0.0, |(from, to)| (from - to).norm())
}

/// `None` if the pulses do not determine scale and offsets.
fn fit(pulses: &[Pulse], ids: &[StationId], stations: &[Station]) -> Option<Fit> {
    let n = 1 + ids.len();
    let index = |id| ids.iter().position(|own| *own == id).map(|own| own + 1);
    let (mut information, mut right) = (DMatrix::<f64>::zeros(n, n), DVector::<f64>::zeros(n));
    let mut rows = Vec::with_capacity(pulses.len());
    for pulse in pulses {
        let distance_m = distance_m(pulse, stations);
        let mut by = DVector::<f64>::zeros(n);
        by[0] = distance_m;
        (by[index(pulse.receiver)?], by[index(pulse.sender)?]) = (1.0, -1.0);
        let (error_m, weight) = (pulse.length_m - distance_m, pulse.sigma_m.powi(-2));
        information += &by * by.transpose() * weight;
        right += &by * (error_m * weight);
        rows.push((by, error_m, weight));
    }
    // The mean of the offsets is 0: no pulse shows it.
    let mean_weight = information.diagonal().rows(1, n - 1).mean();
    information.view_mut((1, 1), (n - 1, n - 1)).add_scalar_mut(mean_weight);
    let covariance = information.cholesky()?.inverse();
    let solved = &covariance * right;
    // The pinned mean has a variance of its own, which does not belong to the uncertainty of the offsets.
    let pinned = 1.0 / (mean_weight * ((n - 1) as f64).powi(2));
    let estimated = |k: usize, pinned: f64| Estimated {
        value: solved[k],
        sigma: (covariance[(k, k)] - pinned).max(0.0).sqrt(),
    };
    let scale = estimated(0, 0.0);
    let chi2 = rows.iter().map(|(by, error_m, weight)| (error_m - by.dot(&solved)).powi(2) * weight).sum();
    let unknowns = n - 1;
    let fit = Fit {
        scale,
        offsets_m: (1..n).map(|k| estimated(k, pinned)).collect(),
        chi2,
        degrees_of_freedom: u32::try_from(pulses.len().checked_sub(unknowns)?).ok()?,
    };
    let is_known = fit.scale.sigma <= UNKNOWN_SCALE
        && fit.offsets_m.iter().all(|offset| offset.sigma <= UNKNOWN_OFFSET_M)
        && fit.chi2.is_finite();
    is_known.then_some(fit)
}

/// The station without whose pulses the others agree best; `None` if they never agree.
fn suspect(pulses: &[Pulse], ids: &[StationId], stations: &[Station]) -> Option<StationId> {
    if ids.len() < LEAST_TO_SUSPECT {
        return None;
    }
    let without = |id: StationId| {
        let others: Vec<Pulse> =
            pulses.iter().filter(|pulse| pulse.sender != id && pulse.receiver != id).copied().collect();
        let fit = fit(&others, &taking_part(&others), stations)?;
        (integrity_of(fit.chi2, fit.degrees_of_freedom) != Integrity::Alarm).then_some((id, fit.chi2))
    };
    let agreeing = ids.iter().filter_map(|id| without(*id));
    agreeing.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(id, _)| id)
}

#[cfg(test)]
mod tests;
