//! Checks several readings of one station in one emission: they may be repetitions, or two emissions recorded under one
//! time.

use crate::{columns::Heard, moments::Moment};
use positioning::{
    RangeNoise, Repetitions, Timing,
    repetitions::{mean_m, variance_m2},
    scatter_limit,
};
use world::StationId;

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

/// The ranges of readings with the number of their repetitions.
pub(crate) fn lengths(heard: &[Heard]) -> Vec<(f64, u32)> {
    heard.iter().map(|one| (one.range_m, one.repetitions)).collect()
}

/// The scatter of the readings of single stations within emissions.
#[derive(Debug, Clone, Copy, Default)]
pub struct Repeats {
    pooled: Repetitions,
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
        variance_m2(&self.noise, self.timing, self.distance_m.unwrap_or(range_m))
    }
}

/// The scatter of one emission.
struct Once {
    pooled: Repetitions,
    worst: Option<(f64, Repeated)>,
}

impl Once {
    fn of(moment: &Moment, scatter: &Scatter) -> Self {
        let mut once = Self { pooled: Repetitions::default(), worst: None };
        for set in &moment.ranges {
            let rows: Vec<Heard> = moment
                .heard
                .iter()
                .filter(|heard| heard.station == set.station && heard.range_m.is_finite())
                .copied()
                .collect();
            let Some(mean_m) = mean_m(&lengths(&rows)).filter(|_| rows.len() > 1) else { continue };
            let mut own = Repetitions::default();
            own.take(&lengths(&rows), scatter.variance_m2(mean_m));
            let ends = rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), heard| {
                (least.min(heard.range_m), most.max(heard.range_m))
            });
            let count = u32::try_from(rows.len()).unwrap_or(u32::MAX);
            let repeated =
                Repeated { station: set.station, count, apart_m: ends.1 - ends.0, t_s: moment.t_s };
            let excess = own.sum() / f64::from(own.degrees());
            if once.worst.is_none_or(|(worst, _)| excess > worst) {
                once.worst = Some((excess, repeated));
            }
            once.pooled.add(own);
        }
        once
    }

    fn is_wide(&self) -> bool {
        self.pooled.degrees() > 0 && self.pooled.sum() > scatter_limit(self.pooled.degrees())
    }
}

impl Repeats {
    pub(crate) fn take(&mut self, moment: &Moment, scatter: &Scatter) {
        let once = Once::of(moment, scatter);
        if once.pooled.degrees() == 0 {
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
        if variances.is_empty() || self.pooled.degrees() == 0 {
            return 0.0;
        }
        let degrees = f64::from(self.pooled.degrees());
        let excess = (self.pooled.sum() / degrees - 1.0 - (2.0 / degrees).sqrt()).max(0.0);
        (excess * variances.iter().sum::<f64>() / variances.len() as f64).sqrt()
    }

    /// Returns the likely error of the readings in an emission, as their scatter suggests, metres; `None` if the
    /// scatter raises no doubt.
    pub(crate) fn doubt_m(&self, moment: &Moment, scatter: &Scatter) -> Option<f64> {
        let once = Once::of(moment, scatter);
        let is_doubtful = once.is_wide() || (once.pooled.degrees() > 0 && self.are_wide());
        let (_, widest) = once.worst.filter(|_| is_doubtful)?;
        Some(widest.apart_m / 2.0)
    }
}
