//! The worst values of a run, each with its time and place.

use serde::{Deserialize, Serialize};
use world::Point;

/// A worst value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// The value, in the unit of its figure.
    pub value: f64,
    /// Mission time, seconds.
    pub t_s: f64,
    /// The robot's estimated position, metres, tank frame; `None` before the first estimate.
    pub at: Option<Point>,
}

/// The worst values of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Peaks {
    /// The largest 95 % error of the position, metres.
    pub error_m: Option<Peak>,
    /// The greatest length of tether out, metres.
    pub tether_m: Option<Peak>,
    /// The largest wrap on one obstacle, degrees.
    pub wrap_deg: Option<Peak>,
}

impl Peak {
    /// Replaces a worst value if the new one is worse.
    pub(super) fn take(worst: &mut Option<Self>, value: f64, t_s: f64, at: Option<Point>) {
        if value.is_finite() && worst.is_none_or(|worst| worst.value < value) {
            *worst = Some(Self { value, t_s, at });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_equal_worst_values_is_kept() {
        let mut worst = None;
        for (t_s, value) in [0.1, 0.3, f64::NAN, 0.3, 0.2].into_iter().enumerate() {
            Peak::take(&mut worst, value, t_s as f64, Some(Point::origin()));
        }
        assert_eq!(worst.map(|worst| (worst.value, worst.t_s)), Some((0.3, 1.0)));
    }
}
