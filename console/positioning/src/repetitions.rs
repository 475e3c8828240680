//! The scatter of repeated readings about their means: whether it agrees with the noise.

use crate::noise::{RangeNoise, Timing};

/// Maximum weight of a squared difference, in variances, so that a few extreme outliers do not make a session suspect.
const MOST_SQUARES: f64 = 16.0;
/// Ratio of the variance of the scatter to that of the noise below which the scatter does no harm.
const HARMLESS: f64 = 1.3;
/// Share of the noise variance below which readings are not independent: they are copies of one reading, or share its
/// error. Such readings count as one.
const NARROW: f64 = 0.25;
/// Number of standard deviations above which the deviation of a sum is significant.
const SIGNIFICANT: f64 = 5.0;

/// The scatter of repeated readings about their means, in variances of a single reading.
///
/// ```
/// let mut copies = positioning::Repetitions::default();
/// (0..30).for_each(|_| copies.take(&[(7.0, 1), (7.0, 1), (7.0, 1), (7.0, 1)], 0.01));
/// assert!(copies.are_narrow() && !copies.are_wide());
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct Repetitions {
    sum: f64,
    degrees: u32,
}

impl Repetitions {
    /// Adds repetitions of one reading: lengths in metres, each the mean of a number of pings. `variance_m2` is that of one
    /// ping, square metres.
    pub fn take(&mut self, lengths: &[(f64, u32)], variance_m2: f64) {
        let Some(mean_m) = mean_m(lengths).filter(|_| lengths.len() > 1) else { return };
        let squares = |(length_m, pings): &(f64, u32)| {
            ((length_m - mean_m).powi(2) * f64::from(*pings) / variance_m2).min(MOST_SQUARES)
        };
        self.sum += lengths.iter().map(squares).sum::<f64>();
        self.degrees = self.degrees.saturating_add(u32::try_from(lengths.len() - 1).unwrap_or(u32::MAX));
    }

    /// Adds other repetitions.
    pub fn add(&mut self, other: Self) {
        self.sum += other.sum;
        self.degrees = self.degrees.saturating_add(other.degrees);
    }

    /// The sum of the squared differences from the means, each divided by its variance.
    pub fn sum(self) -> f64 {
        self.sum
    }

    /// The number of readings beyond the first of each reading.
    pub fn degrees(self) -> u32 {
        self.degrees
    }

    /// The scatter as a multiple of the noise.
    pub fn factor(self) -> f64 {
        (self.sum / f64::from(self.degrees.max(1))).sqrt()
    }

    /// Whether the readings scatter significantly more than the noise.
    pub fn are_wide(self) -> bool {
        let degrees = f64::from(self.degrees);
        let limit = (1.0 + SIGNIFICANT * (2.0 / degrees).sqrt()).max(HARMLESS);
        self.degrees > 0 && self.sum > limit * degrees
    }

    /// Whether the readings scatter too little to be independent.
    pub fn are_narrow(self) -> bool {
        let degrees = f64::from(self.degrees);
        let limit = (1.0 - SIGNIFICANT * (2.0 / degrees).sqrt()).min(NARROW);
        self.degrees > 0 && self.sum < limit * degrees
    }
}

/// The mean of lengths, each weighted by its number of pings, metres; `None` without any.
///
/// ```
/// assert_eq!(positioning::repetitions::mean_m(&[(1.0, 1), (4.0, 2)]), Some(3.0));
/// ```
pub fn mean_m(lengths: &[(f64, u32)]) -> Option<f64> {
    let weight: f64 = lengths.iter().map(|(_, pings)| f64::from(*pings)).sum();
    let sum: f64 = lengths.iter().map(|(length_m, pings)| length_m * f64::from(*pings)).sum();
    (weight > 0.0).then(|| sum / weight)
}

/// The variance of a single reading about the mean of its repetitions, square metres, for a distance in metres: the part
/// of the noise that repetitions show.
///
/// ```
/// use positioning::{RangeNoise, Timing, repetitions::variance_m2};
/// let noise = RangeNoise::Gaussian { sigma_ratio: 0.01 };
/// assert!((variance_m2(&noise, Timing::default(), 10.0) - 0.01).abs() < 1e-12);
/// ```
pub fn variance_m2(noise: &RangeNoise, timing: Timing, distance_m: f64) -> f64 {
    let share_m = noise.sigma_ratio() * distance_m;
    let repeats_m = timing.mean_sigma_m(share_m, f64::INFINITY);
    let all_m2 = timing.mean_sigma_m(share_m, 1.0).powi(2) - repeats_m.powi(2);
    (share_m * share_m + all_m2).max(1e-12)
}
