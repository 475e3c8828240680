//! How single ranges scatter, as far as the estimator knows.

use serde::{Deserialize, Serialize};

/// Degrees of freedom of [`RangeNoise::HeavyTailed`].
pub(crate) const TAIL_FREEDOM: f64 = 3.0;

/// The distribution of the error of a range as a share of the true distance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "model")]
pub enum RangeNoise {
    /// Uniform between `-ratio` and `ratio` (Wang et al. 2023, eq. 13).
    Uniform {
        /// Largest error as a share of the distance.
        ratio: f64,
    },
    /// Triangular between `-ratio` and `ratio`, as the mean of two uniform errors.
    Triangular {
        /// Largest error as a share of the distance.
        ratio: f64,
    },
    /// Normal.
    Gaussian {
        /// Standard deviation as a share of the distance.
        sigma_ratio: f64,
    },
    /// Student's distribution with 3 degrees of freedom.
    HeavyTailed {
        /// Standard deviation as a share of the distance.
        sigma_ratio: f64,
    },
}

impl RangeNoise {
    /// Standard deviation as a share of the distance.
    pub fn sigma_ratio(&self) -> f64 {
        match *self {
            Self::Uniform { ratio } => ratio / 3.0_f64.sqrt(),
            Self::Triangular { ratio } => ratio / 6.0_f64.sqrt(),
            Self::Gaussian { sigma_ratio } | Self::HeavyTailed { sigma_ratio } => sigma_ratio,
        }
    }

    /// Largest error as a share of the distance, if there is one that distances can be bounded with.
    pub fn bound_ratio(&self) -> Option<f64> {
        match *self {
            Self::Uniform { ratio } | Self::Triangular { ratio } => Some(ratio),
            Self::Gaussian { .. } | Self::HeavyTailed { .. } => None,
        }
        .filter(|ratio| (1e-9..1.0).contains(ratio))
    }

    /// Standard deviation of the midrange of `n` errors as a share of the distance.
    pub fn midrange_sigma_ratio(&self, n: f64) -> f64 {
        match *self {
            Self::Uniform { ratio } => ratio * (2.0 / ((n + 1.0) * (n + 2.0))).sqrt(),
            // The extremes of a triangle: (1 - pi/4) / n of the squared bound for many errors.
            Self::Triangular { ratio } => {
                (ratio * (0.2146 / n).sqrt()).min(self.sigma_ratio() / n.min(2.0).sqrt())
            }
            // Half the variance of one extreme of many normal errors.
            Self::Gaussian { sigma_ratio } => {
                sigma_ratio
                    * (1.0 / n.min(2.0).sqrt()).min(std::f64::consts::PI / (24.0 * n.ln().max(0.1)).sqrt())
            }
            // The extremes of heavy tails do not settle.
            Self::HeavyTailed { sigma_ratio } => sigma_ratio,
        }
    }

    /// Density of an error up to a factor, between 0 and 1.
    pub(crate) fn relative_density(&self, error_ratio: f64) -> f64 {
        match *self {
            Self::Uniform { ratio } => f64::from(u8::from(error_ratio.abs() <= ratio)),
            Self::Triangular { ratio } => (1.0 - error_ratio.abs() / ratio).max(0.0),
            Self::Gaussian { sigma_ratio } => (-0.5 * (error_ratio / sigma_ratio).powi(2)).exp(),
            Self::HeavyTailed { sigma_ratio } => {
                // In units of the scale, which is the standard deviation over sqrt(k / (k - 2)).
                let t2 = (error_ratio / sigma_ratio).powi(2) * TAIL_FREEDOM / (TAIL_FREEDOM - 2.0);
                (1.0 + t2 / TAIL_FREEDOM).powf(-f64::midpoint(TAIL_FREEDOM, 1.0))
            }
        }
    }
}
