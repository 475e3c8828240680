//! Defines position fixes, and the reasons why there may be none.

use nalgebra::{Matrix2, Matrix3};
use serde::{Deserialize, Serialize};
use world::{Boundary, Point, Station, StationId};

/// The ranges of one station in one cycle, combined into one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ranging {
    /// The station.
    pub station: StationId,
    /// Range, metres.
    pub range_m: f64,
    /// Standard deviation of `range_m`, metres.
    pub sigma_m: f64,
    /// The number of repetitions combined.
    pub repetitions: u32,
    /// The shortest repetition, metres.
    pub least_m: f64,
    /// The longest repetition, metres.
    pub most_m: f64,
    /// The part of `sigma_m` that does not depend on the distance, metres; the remaining part is a share of the
    /// distance.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub timing_sigma_m: f64,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde requires")]
fn is_zero(number: &f64) -> bool {
    *number <= 0.0
}

impl Ranging {
    /// Creates a range from a single repetition.
    pub fn single(station: StationId, range_m: f64, sigma_m: f64) -> Self {
        let (least_m, most_m) = (range_m, range_m);
        Self { station, range_m, sigma_m, repetitions: 1, least_m, most_m, timing_sigma_m: 0.0 }
    }

    /// Returns the standard deviation of the error at a given distance, metres.
    pub fn sigma_at_m(&self, distance_m: f64) -> f64 {
        if self.timing_sigma_m > 0.0 {
            share_sigma_m(self.sigma_m, self.timing_sigma_m, distance_m / self.range_m)
                .hypot(self.timing_sigma_m)
        } else {
            self.sigma_m * distance_m / self.range_m
        }
    }
}

/// Returns the part of a standard deviation that is a share of the distance, scaled to `times` the distance, metres.
pub(crate) fn share_sigma_m(sigma_m: f64, timing_sigma_m: f64, times: f64) -> f64 {
    (sigma_m * sigma_m - timing_sigma_m * timing_sigma_m).max(0.0).sqrt() * times
}

/// The deviation of a station's range from the fix.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Residual {
    /// The station.
    pub station: StationId,
    /// Measured minus computed range, metres.
    pub residual_m: f64,
    /// Expected standard deviation of the residual, metres.
    pub sigma_m: f64,
}

/// The residual beyond which a range contradicts a position, standard deviations.
pub(crate) const CUT_SIGMAS: f64 = 3.0;

impl Residual {
    /// Returns the largest residual that does not contradict the fix, metres: three standard deviations, at which the
    /// robust solver leaves a range out.
    pub fn limit_m(&self) -> f64 {
        CUT_SIGMAS * self.sigma_m
    }

    /// Returns whether the residual contradicts the fix although the station is used in it.
    ///
    /// ```
    /// use positioning::Residual;
    /// let residual = |residual_m| Residual { station: world::StationId(1), residual_m, sigma_m: 0.05 };
    /// assert!(residual(-0.16).is_beyond() && !residual(0.14).is_beyond());
    /// ```
    pub fn is_beyond(&self) -> bool {
        self.residual_m.abs() > self.limit_m()
    }
}

/// The reason why a station was left out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Exclusion {
    /// The station was not heard.
    Silent,
    /// The residual is too large.
    Residual {
        /// Measured minus computed range, metres.
        residual_m: f64,
        /// The largest residual accepted, metres.
        gate_m: f64,
    },
    /// The operator excluded the station.
    ByOrder,
    /// All ranges of the station are impossible: no place in the tank explains them.
    Impossible {
        /// One of the ranges, metres.
        range_m: f64,
        /// The longest possible range, metres.
        most_m: f64,
    },
    /// The session calibration found that the ranges of the station are wrong by a constant length.
    Biased {
        /// The length by which the ranges are too long, metres.
        bias_m: f64,
    },
}

/// How far the fix can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrity {
    /// The residuals fit the noise.
    Ok,
    /// The residuals fit the noise badly.
    Suspect,
    /// There is no redundant range, so an error would not be noticed.
    Untestable,
    /// The residuals contradict each other.
    Alarm,
}

impl Integrity {
    /// Returns the less trusted of two ratings.
    #[must_use]
    pub fn min_trust(self, other: Self) -> Self {
        let doubt = |integrity| match integrity {
            Self::Ok => 0,
            Self::Untestable => 1,
            Self::Suspect => 2,
            Self::Alarm => 3,
        };
        if doubt(other) > doubt(self) { other } else { self }
    }
}

/// A position from ranges.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fix {
    /// Most likely position, metres, tank frame.
    pub position: Point,
    /// Covariance of the position, square metres.
    #[serde(with = "geometry::symmetric")]
    pub covariance: Matrix2<f64>,
    /// The residuals of the stations used.
    pub residuals: Vec<Residual>,
    /// The stations used, sorted.
    pub used: Vec<StationId>,
    /// The stations left out, with the reason.
    pub excluded: Vec<(StationId, Exclusion)>,
    /// Sum of the squared residuals over their variances.
    pub chi2: f64,
    /// Stations used minus two.
    pub degrees_of_freedom: u32,
    /// Geometric dilution of precision: position sigma per range sigma.
    pub gdop: f64,
    /// Condition number of the geometry.
    pub conditioning: f64,
    /// The second position that fits nearly as well, if there is one.
    pub mirror: Option<Point>,
    /// Radius around the fix that contains the true position even if any one station has an error that does not show,
    /// metres; `None` if the fix is not protected. With a stated risk it is the level of [`crate::protection`],
    /// otherwise that of four standard deviations.
    pub protection_level_m: Option<f64>,
    /// How far the fix can be trusted.
    pub integrity: Integrity,
}

impl Fix {
    /// Returns the semi-axes of the 95 % ellipse, metres, and the direction of the longer one, radians.
    pub fn ellipse_95(&self) -> (f64, f64, f64) {
        ellipse_95(&self.covariance)
    }

    /// Checks that the position can lie in the tank.
    ///
    /// # Errors
    /// [`FixError::OutsideTank`] if the position is farther outside than the longer semi-axis of its 95 % ellipse.
    pub fn check_inside(&self, boundary: &Boundary) -> Result<(), FixError> {
        let by_m = -boundary.wall_distance_m(self.position);
        if by_m > self.ellipse_95().0 { Err(FixError::OutsideTank { by_m }) } else { Ok(()) }
    }
}

/// The normalised squared distance within which 95 % of a two-dimensional normal distribution lies: -2 ln 0.05.
pub const ELLIPSE_95: f64 = 5.991_464_547_107_982;

/// Returns the semi-axes of the 95 % ellipse of a covariance, metres, and the direction of the longer one, radians.
pub fn ellipse_95(covariance: &Matrix2<f64>) -> (f64, f64, f64) {
    let scale = ELLIPSE_95;
    let (a, b, c) = (covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 1)]);
    let (middle, spread) = (f64::midpoint(a, c), (((a - c) / 2.0).powi(2) + b * b).sqrt());
    let half = |eigenvalue: f64| (scale * eigenvalue.max(0.0)).sqrt();
    (half(middle + spread), half(middle - spread), 0.5 * (2.0 * b).atan2(a - c))
}

/// Returns the half width of the 95 % ellipse of a covariance across a heading, metres.
///
/// ```
/// use positioning::fix::{across_95_m, ellipse_95};
/// let covariance = nalgebra::Matrix2::new(0.04, 0.0, 0.0, 0.01);
/// let (longer_m, shorter_m, _) = ellipse_95(&covariance);
/// assert!((across_95_m(&covariance, 0.0) - shorter_m).abs() < 1e-12);
/// assert!((across_95_m(&covariance, std::f64::consts::FRAC_PI_2) - longer_m).abs() < 1e-12);
/// ```
pub fn across_95_m(covariance: &Matrix2<f64>, heading_rad: f64) -> f64 {
    let (a, b, c) = (covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 1)]);
    let (sin, cos) = heading_rad.sin_cos();
    (ELLIPSE_95 * (a * sin * sin - 2.0 * b * sin * cos + c * cos * cos).max(0.0)).sqrt()
}

/// Returns the position part of the covariance of a pose, square metres.
pub fn position_covariance(pose: &Matrix3<f64>) -> Matrix2<f64> {
    pose.fixed_view::<2, 2>(0, 0).into_owned()
}

/// Why there is no fix.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FixError {
    /// Fewer stations answered than the solver needs.
    #[error("a position fix needs {need} stations; {have} answered")]
    TooFewStations {
        /// The number of stations that answered.
        have: usize,
        /// The number of stations needed.
        need: usize,
    },
    /// The stations are on one line.
    #[error("the stations are too nearly on one line (condition number {conditioning:.0}, limit {limit:.0})")]
    Collinear {
        /// Condition number of the geometry.
        conditioning: f64,
        /// The largest condition number accepted.
        limit: f64,
    },
    /// A range or its sigma is not a valid positive number.
    #[error("the range of station {} is not a positive number of metres", station.0)]
    BadRange {
        /// The station.
        station: StationId,
    },
    /// Two ranges name the same station.
    #[error("station {} appears twice", station.0)]
    DuplicateStation {
        /// The station.
        station: StationId,
    },
    /// A range names a station that the tank does not have, or whose position is not finite.
    #[error("there is no station {}", station.0)]
    UnknownStation {
        /// The station.
        station: StationId,
    },
    /// The iteration did not converge.
    #[error("the solution did not converge within {iterations} iterations")]
    NotConverged {
        /// The number of iterations.
        iterations: usize,
    },
    /// No place in the tank is within the bounds of all ranges: the real noise is larger than declared.
    #[error(
        "no position agrees with all ranges to within {:.1} %: the bound is too small, or a range is wrong", ratio * 100.0
    )]
    EmptySet {
        /// The bound on the error, as a share of the distance.
        ratio: f64,
    },
    /// The solution lies outside the tank by more than its own uncertainty.
    #[error("the solution lies {by_m:.2} m outside the tank")]
    OutsideTank {
        /// The distance from the tank, metres.
        by_m: f64,
    },
    /// The ranges contradict each other.
    #[error(
        "the ranges contradict each other (chi-squared {chi2:.1} with {degrees_of_freedom} degrees of freedom)"
    )]
    Inconsistent {
        /// Sum of the squared residuals over their variances.
        chi2: f64,
        /// Stations used minus two.
        degrees_of_freedom: u32,
    },
}

/// A prior position, metres, with its covariance, square metres.
pub type Prior = (Point, Matrix2<f64>);

/// A method that computes a fix from ranges.
pub trait PositionSolver {
    /// Returns the length by which all ranges of a fix are too long, metres; 0 for solvers that do not estimate it.
    fn excess_m(&self, _fix: &Fix, _ranges: &[Ranging], _stations: &[Station]) -> f64 {
        0.0
    }

    /// Computes the position from the ranges.
    ///
    /// Solvers use the prior to choose between mirror images, and may need it for fewer than three stations.
    ///
    /// # Errors
    /// See [`FixError`]; never panics and never returns a number that is not finite.
    fn solve(&self, ranges: &[Ranging], stations: &[Station], prior: Option<Prior>) -> Result<Fix, FixError>;
}
