//! Shares and means with their 95 % intervals.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// 97.5 % quantile of the normal distribution.
const Z: f64 = 1.959_963_984_540_054;

/// A share of successes with its 95 % Wilson interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Share {
    /// Successes.
    pub hits: u64,
    /// Number of cases.
    pub n: u64,
    /// Lower end of the interval, from 0 to 1.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Share {
    /// The share of `hits` in `n` cases; without cases, the interval is 0 to 1.
    pub fn of(hits: u64, n: u64) -> Self {
        if n == 0 {
            return Self { hits, n, low: 0.0, high: 1.0 };
        }
        let (count, z2) = (n as f64, Z * Z);
        let p = hits as f64 / count;
        let middle = (p + z2 / (2.0 * count)) / (1.0 + z2 / count);
        let half = Z / (1.0 + z2 / count) * (p * (1.0 - p) / count + z2 / (4.0 * count * count)).sqrt();
        // At 0 and 1, rounding must not exclude the observed share.
        Self { hits, n, low: (middle - half).clamp(0.0, p), high: (middle + half).clamp(p, 1.0) }
    }

    /// The share itself; `None` without cases.
    pub fn share(&self) -> Option<f64> {
        (self.n > 0).then(|| self.hits as f64 / self.n as f64)
    }

    /// Half width of the interval.
    pub fn half(&self) -> f64 {
        (self.high - self.low) / 2.0
    }
}

/// A mean with its 95 % interval, from Student's distribution.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Mean {
    /// Number of values.
    pub n: u64,
    /// Mean.
    pub mean: f64,
    /// Half width of the interval; absent for a single value.
    pub half: Option<f64>,
}

/// Running sums of values (Welford's method).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sums {
    n: u64,
    mean: f64,
    squares: f64,
}

impl Sums {
    /// Adds a value.
    pub fn take(&mut self, value: f64) {
        self.n += 1;
        let off = value - self.mean;
        self.mean += off / self.n as f64;
        self.squares += off * (value - self.mean);
    }

    /// Mean of the values so far; `None` if there are none.
    pub fn mean(&self) -> Option<Mean> {
        let half = (self.n > 1).then(|| {
            let freedom = (self.n - 1) as f64;
            let t = StudentsT::new(0.0, 1.0, freedom).map_or(Z, |t| t.inverse_cdf(0.975));
            t * (self.squares / freedom / self.n as f64).sqrt()
        });
        (self.n > 0).then_some(Mean { n: self.n, mean: self.mean, half })
    }
}

/// Computes the mean of some values.
pub fn mean(values: impl IntoIterator<Item = f64>) -> Option<Mean> {
    let mut sums = Sums::default();
    values.into_iter().for_each(|value| sums.take(value));
    sums.mean()
}

/// The quantile of sorted values at a given share, interpolated.
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let at = share.clamp(0.0, 1.0) * sorted.len().checked_sub(1)? as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    Some(low + (high - low) * at.fract())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn intervals_are_those_of_the_books() {
        // Newcombe 1998, table I: 81 of 263, and 0 of 20.
        let share = Share::of(81, 263);
        assert!((share.low - 0.2553).abs() < 5e-5 && (share.high - 0.3662).abs() < 5e-5, "{share:?}");
        let none = Share::of(0, 20);
        assert!(none.low == 0.0 && (none.high - 0.1611).abs() < 5e-5, "{none:?}");
        // t(0.975, 3) = 3.1824; the standard deviation of 1, 2, 3, 4 is 1.29099.
        let four = mean([1.0, 2.0, 3.0, 4.0]).expect("four values");
        assert!((four.mean - 2.5).abs() < 1e-12);
        assert!((four.half.expect("more than one") - 3.1824 * 1.29099 / 2.0).abs() < 1e-3, "{four:?}");
        assert_eq!(mean([7.0]), Some(Mean { n: 1, mean: 7.0, half: None }));
        assert_eq!(mean([]), None);
        assert_eq!(quantile(&[1.0, 2.0, 4.0], 0.75), Some(3.0));
    }

    proptest! {
        #[test]
        fn an_interval_holds_its_share_and_narrows(hits in 0_u64..200, misses in 0_u64..200) {
            let n = hits + misses;
            let share = Share::of(hits, n);
            prop_assert!(0.0 <= share.low && share.low <= share.high && share.high <= 1.0);
            if let Some(p) = share.share() {
                prop_assert!(share.low <= p && p <= share.high);
                prop_assert!(Share::of(hits * 4, n * 4).half() < share.half());
            }
        }
    }
}
