//! Checks several readings of one station in one emission: they may be repetitions, or two emissions recorded under one
//! time.

use crate::{columns::Heard, moments::Moment};
use positioning::{RangeNoise, Timing, scatter_limit};
use world::StationId;

/// Maximum weight of a squared difference, in variances, so that a few extreme outliers do not make a session suspect.
const MOST_SQUARES: f64 = 16.0;
/// Ratio of the variance of the scatter to that of the noise below which the scatter does no harm.
const HARMLESS: f64 = 1.3;
/// Share of the noise variance below which readings are not independent: they are copies of one reading, or share its
/// error. Such readings count as one.
const NARROW: f64 = 0.25;
/// Number of standard deviations above which the deviation of a sum is significant.
const SIGNIFICANT: f64 = 5.0;

/// The two readings of one station that differ the most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repeated {
    /// The station.
    pub station: StationId,
    /// The number of readings in the emission.
    pub count: u32,
    /// The difference between the two readings, metres.
    pub apart_m: f64,
    /// Time of the emission as in the file, seconds.
    pub t_s: f64,
}

/// The scatter of repeated readings about their means.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pooled {
    /// Sum of the squared differences from the means, each divided by its variance.
    sum: f64,
    degrees: u32,
}

impl Pooled {
    /// Adds repetitions of one reading, each the mean of a number of pings; `variance_m2` is that of one ping, square
    /// metres.
    pub(crate) fn take(&mut self, heard: &[Heard], variance_m2: f64) {
        let Some(mean_m) = mean_m(heard).filter(|_| heard.len() > 1) else { return };
        self.sum += heard.iter().map(|one| squares(one, mean_m, variance_m2)).sum::<f64>();
        self.degrees = self.degrees.saturating_add(heard.len() as u32 - 1);
    }

    fn add(&mut self, other: Self) {
        self.sum += other.sum;
        self.degrees = self.degrees.saturating_add(other.degrees);
    }

    /// Returns the scatter as a multiple of the noise.
    fn factor(self) -> f64 {
        (self.sum / f64::from(self.degrees.max(1))).sqrt()
    }

    /// Whether the readings scatter significantly more than the noise.
    fn are_wide(self) -> bool {
        let degrees = f64::from(self.degrees);
        let limit = (1.0 + SIGNIFICANT * (2.0 / degrees).sqrt()).max(HARMLESS);
        self.degrees > 0 && self.sum > limit * degrees
    }

    /// Whether the readings scatter too little to be independent.
    pub(crate) fn are_narrow(self) -> bool {
        let degrees = f64::from(self.degrees);
        let limit = (1.0 - SIGNIFICANT * (2.0 / degrees).sqrt()).min(NARROW);
        self.degrees > 0 && self.sum < limit * degrees
    }
}

/// Returns the mean of readings, weighted by their repetitions, metres; `None` without any.
pub(crate) fn mean_m(heard: &[Heard]) -> Option<f64> {
    let weight: f64 = heard.iter().map(|one| f64::from(one.repetitions)).sum();
    let sum: f64 = heard.iter().map(|one| one.range_m * f64::from(one.repetitions)).sum();
    (weight > 0.0).then(|| sum / weight)
}

/// The squared difference of a reading from the mean, in variances of a ping, square metres.
fn squares(heard: &Heard, mean_m: f64, variance_m2: f64) -> f64 {
    let off_m = heard.range_m - mean_m;
    (off_m * off_m * f64::from(heard.repetitions) / variance_m2).min(MOST_SQUARES)
}

/// The scatter of the readings of single stations within emissions.
#[derive(Debug, Clone, Copy, Default)]
pub struct Repeats {
    pooled: Pooled,
    /// The number of emissions with several readings of a station.
    pub emissions: u64,
    /// The number of those emissions in which the readings scatter more than the noise explains.
    pub wide: u64,
    /// The readings that differ most in relation to their noise.
    pub worst: Option<Repeated>,
    worst_squares: f64,
}

/// The expected scatter of readings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scatter {
    pub noise: RangeNoise,
    pub timing: Timing,
    /// The distance to assume if the readings do not give one, metres.
    pub distance_m: Option<f64>,
}

impl Scatter {
    /// Returns the variance of a reading about the mean of its station, square metres.
    pub(crate) fn variance_m2(&self, range_m: f64) -> f64 {
        let share_m = self.noise.sigma_ratio() * self.distance_m.unwrap_or(range_m);
        let repeats_m = self.timing.mean_sigma_m(share_m, f64::INFINITY);
        let all_m2 = self.timing.mean_sigma_m(share_m, 1.0).powi(2) - repeats_m.powi(2);
        (share_m * share_m + all_m2).max(1e-12)
    }
}

/// The scatter of one emission.
struct Once {
    pooled: Pooled,
    worst: Option<(f64, Repeated)>,
}

impl Once {
    fn of(moment: &Moment, scatter: &Scatter) -> Self {
        let mut once = Self { pooled: Pooled::default(), worst: None };
        for set in &moment.ranges {
            let rows: Vec<Heard> = moment
                .heard
                .iter()
                .filter(|heard| heard.station == set.station && heard.range_m.is_finite())
                .copied()
                .collect();
            let Some(mean_m) = mean_m(&rows).filter(|_| rows.len() > 1) else { continue };
            let mut own = Pooled::default();
            own.take(&rows, scatter.variance_m2(mean_m));
            let ends = rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), heard| {
                (least.min(heard.range_m), most.max(heard.range_m))
            });
            let count = u32::try_from(rows.len()).unwrap_or(u32::MAX);
            let repeated =
                Repeated { station: set.station, count, apart_m: ends.1 - ends.0, t_s: moment.t_s };
            let excess = own.sum / f64::from(own.degrees);
            if once.worst.is_none_or(|(worst, _)| excess > worst) {
                once.worst = Some((excess, repeated));
            }
            once.pooled.add(own);
        }
        once
    }

    fn is_wide(&self) -> bool {
        self.pooled.degrees > 0 && self.pooled.sum > scatter_limit(self.pooled.degrees)
    }
}

impl Repeats {
    pub(crate) fn take(&mut self, moment: &Moment, scatter: &Scatter) {
        let once = Once::of(moment, scatter);
        if once.pooled.degrees == 0 {
            return;
        }
        self.pooled.add(once.pooled);
        self.emissions += 1;
        self.wide += u64::from(once.is_wide());
        if let Some((excess, repeated)) = once.worst.filter(|(excess, _)| *excess > self.worst_squares) {
            (self.worst_squares, self.worst) = (excess, Some(repeated));
        }
    }

    /// Returns the scatter of the readings over all emissions, as a multiple of the noise.
    pub fn factor(&self) -> f64 {
        self.pooled.factor()
    }

    /// Whether the readings scatter significantly more than the noise.
    pub fn are_wide(&self) -> bool {
        self.pooled.are_wide()
    }

    /// Whether the readings scatter too little to be independent.
    pub fn are_narrow(&self) -> bool {
        self.pooled.are_narrow()
    }

    /// Returns the likely error of a position from an emission with several readings of a station, as a standard
    /// deviation, metres. It applies if the scatter does not prove an error, and is the excess of the scatter over the
    /// noise, less one standard deviation to allow for chance.
    pub(crate) fn likely_m(&self, moment: &Moment, scatter: &Scatter) -> f64 {
        let is_repeated = |set: &&world::RangeSet| {
            moment.heard.iter().filter(|heard| heard.station == set.station).count() > 1
        };
        let mean_m =
            |set: &world::RangeSet| set.ranges_m.iter().sum::<f64>() / set.ranges_m.len().max(1) as f64;
        let repeated = moment.ranges.iter().filter(is_repeated);
        let variances: Vec<f64> = repeated.map(|set| scatter.variance_m2(mean_m(set))).collect();
        if variances.is_empty() || self.pooled.degrees == 0 {
            return 0.0;
        }
        let degrees = f64::from(self.pooled.degrees);
        let excess = (self.pooled.sum / degrees - 1.0 - (2.0 / degrees).sqrt()).max(0.0);
        (excess * variances.iter().sum::<f64>() / variances.len() as f64).sqrt()
    }

    /// Returns the likely error of the readings in an emission, as their scatter suggests, metres; `None` if the
    /// scatter raises no doubt.
    pub(crate) fn doubt_m(&self, moment: &Moment, scatter: &Scatter) -> Option<f64> {
        let once = Once::of(moment, scatter);
        let is_doubtful = once.is_wide() || (once.pooled.degrees > 0 && self.are_wide());
        let (_, widest) = once.worst.filter(|_| is_doubtful)?;
        Some(widest.apart_m / 2.0)
    }
}
