//! The t-test of Table 3.

use crate::study::Sample;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Probability of a sample mean at least this far from 0 if the true mean is 0: one sample, two sides, n - 1 degrees
/// of freedom.
pub(super) fn p_value(sample: &Sample) -> Option<f64> {
    let n = sample.len() as f64;
    let t = sample.mean()? / (sample.standard_deviation()? / n.sqrt());
    Some(2.0 * StudentsT::new(0.0, 1.0, n - 1.0).ok()?.sf(t.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thirty values whose t against 0 is given.
    fn with_t(t: f64) -> Sample {
        let spread: Vec<f64> = (0..30).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let deviation =
            spread.iter().copied().collect::<Sample>().standard_deviation().expect("thirty values");
        let mean = t * deviation / 30.0_f64.sqrt();
        spread.iter().map(|x| x + mean).collect()
    }

    #[test]
    fn the_tails_are_those_of_the_tables() {
        for (t, table) in [(2.045_229_642, 0.05), (3.396_240_288, 0.002)] {
            let p = p_value(&with_t(t)).expect("a p-value");
            assert!((p / table - 1.0).abs() < 1e-4, "{t}: {p} for {table}");
        }
    }

    #[test]
    fn the_smallest_tails_are_not_lost_in_rounding() {
        let p = p_value(&with_t(57.0)).expect("a p-value");
        assert!((1e-32..1e-30).contains(&p), "{p:e}");
    }
}
