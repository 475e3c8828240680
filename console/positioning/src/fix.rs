//! What a position fix is, and why there may be none.

use nalgebra::{Matrix2, Matrix3};
use serde::{Deserialize, Serialize};
use world::{Boundary, Point, Station, StationId};

/// The ranges of one station in one cycle, brought down to one number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ranging {
    /// Which station.
    pub station: StationId,
    /// Range, metres.
    pub range_m: f64,
    /// Standard deviation of `range_m`, metres.
    pub sigma_m: f64,
    /// How many repetitions are behind it.
    pub repetitions: u32,
    /// The shortest repetition, metres.
    pub least_m: f64,
    /// The longest repetition, metres.
    pub most_m: f64,
    /// The part of `sigma_m` that is the same at every distance, metres; the rest is a share of the distance.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub timing_sigma_m: f64,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_zero(number: &f64) -> bool {
    *number <= 0.0
}

impl Ranging {
    /// A range of a single repetition.
    pub fn single(station: StationId, range_m: f64, sigma_m: f64) -> Self {
        let (least_m, most_m) = (range_m, range_m);
        Self { station, range_m, sigma_m, repetitions: 1, least_m, most_m, timing_sigma_m: 0.0 }
    }

    /// The standard deviation that the error has at a distance, metres.
    pub fn sigma_at_m(&self, distance_m: f64) -> f64 {
        if self.timing_sigma_m > 0.0 {
            share_sigma_m(self.sigma_m, self.timing_sigma_m, distance_m / self.range_m)
                .hypot(self.timing_sigma_m)
        } else {
            self.sigma_m * distance_m / self.range_m
        }
    }
}

/// The part of a standard deviation that is a share of the distance, at so many times the distance, metres.
pub(crate) fn share_sigma_m(sigma_m: f64, timing_sigma_m: f64, times: f64) -> f64 {
    (sigma_m * sigma_m - timing_sigma_m * timing_sigma_m).max(0.0).sqrt() * times
}

/// How well a station fits the fix.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Residual {
    /// Which station.
    pub station: StationId,
    /// Measured minus computed range, metres.
    pub residual_m: f64,
    /// Standard deviation expected of it, metres.
    pub sigma_m: f64,
}

/// Why a station was left out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Exclusion {
    /// It was not heard.
    Silent,
    /// Its residual is too large.
    Residual {
        /// Measured minus computed range, metres.
        residual_m: f64,
        /// Largest one accepted, metres.
        gate_m: f64,
    },
    /// The operator excluded it.
    ByOrder,
    /// None of its ranges can be: no place in the tank explains one.
    Impossible {
        /// One of them, metres.
        range_m: f64,
        /// The longest one that can be, metres.
        most_m: f64,
    },
}

/// How far the fix can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrity {
    /// The residuals fit the noise.
    Ok,
    /// They fit badly.
    Suspect,
    /// There is no range to spare: an error could not be seen.
    Untestable,
    /// They contradict each other.
    Alarm,
}

impl Integrity {
    /// The one that is trusted less.
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
    /// One per station used.
    pub residuals: Vec<Residual>,
    /// Stations used, in order.
    pub used: Vec<StationId>,
    /// Stations left out, with the reason.
    pub excluded: Vec<(StationId, Exclusion)>,
    /// Sum of the squared residuals over their variances.
    pub chi2: f64,
    /// Stations used minus two.
    pub degrees_of_freedom: u32,
    /// Geometric dilution of precision: position sigma per range sigma.
    pub gdop: f64,
    /// Condition number of the geometry.
    pub conditioning: f64,
    /// The other position that fits nearly as well, if there is one.
    pub mirror: Option<Point>,
    /// Radius that holds the truth even if any single station used is wrong without showing it, metres; `None` if
    /// the others alone would give no position.
    pub protection_level_m: Option<f64>,
    /// How far to trust it.
    pub integrity: Integrity,
}

impl Fix {
    /// Half axes of the 95 % ellipse, metres, and the direction of the longer one, radians.
    pub fn ellipse_95(&self) -> (f64, f64, f64) {
        ellipse_95(&self.covariance)
    }

    /// Whether the position can lie in the tank.
    ///
    /// # Errors
    /// [`FixError::OutsideTank`] if it is further outside than the longer half axis of its 95 % ellipse.
    pub fn check_inside(&self, boundary: &Boundary) -> Result<(), FixError> {
        let by_m = -boundary.wall_distance_m(self.position);
        if by_m > self.ellipse_95().0 { Err(FixError::OutsideTank { by_m }) } else { Ok(()) }
    }
}

/// Squared distance in standard deviations up to which 95 % of a normal distribution in the plane lie: -2 ln 0.05.
pub const ELLIPSE_95: f64 = 5.991_464_547_107_982;

/// Half axes of the 95 % ellipse of a covariance, metres, and the direction of the longer one, radians.
pub fn ellipse_95(covariance: &Matrix2<f64>) -> (f64, f64, f64) {
    let scale = ELLIPSE_95;
    let (a, b, c) = (covariance[(0, 0)], covariance[(0, 1)], covariance[(1, 1)]);
    let (middle, spread) = (f64::midpoint(a, c), (((a - c) / 2.0).powi(2) + b * b).sqrt());
    let half = |eigenvalue: f64| (scale * eigenvalue.max(0.0)).sqrt();
    (half(middle + spread), half(middle - spread), 0.5 * (2.0 * b).atan2(a - c))
}

/// Half width of the 95 % ellipse of a covariance across a heading, metres.
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

/// The part of the covariance of a pose that is about the position, square metres.
pub fn position_covariance(pose: &Matrix3<f64>) -> Matrix2<f64> {
    pose.fixed_view::<2, 2>(0, 0).into_owned()
}

/// Why there is no fix.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FixError {
    /// Fewer stations answered than the solver needs.
    #[error("a position fix needs {need} stations, {have} answered")]
    TooFewStations {
        /// How many answered.
        have: usize,
        /// How many it takes.
        need: usize,
    },
    /// The stations stand on one line.
    #[error(
        "the stations stand too nearly on one line (condition number {conditioning:.0}, limit {limit:.0})"
    )]
    Collinear {
        /// Condition number of the geometry.
        conditioning: f64,
        /// Largest one accepted.
        limit: f64,
    },
    /// A range, or its sigma, is not a positive number that can be a distance in a tank.
    #[error("the range of station {} is not a positive number of metres", station.0)]
    BadRange {
        /// Which station.
        station: StationId,
    },
    /// Two ranges claim the same station.
    #[error("station {} appears twice", station.0)]
    DuplicateStation {
        /// Which station.
        station: StationId,
    },
    /// A range names a station that the tank does not have, or whose place is not finite.
    #[error("there is no station {}", station.0)]
    UnknownStation {
        /// Which station.
        station: StationId,
    },
    /// The iteration did not settle.
    #[error("the solution did not settle within {iterations} iterations")]
    NotConverged {
        /// How many were tried.
        iterations: usize,
    },
    /// No place in the tank is within the bounds of all ranges: the noise is not what it was said to be.
    #[error(
        "no position is within {:.1} % of all ranges: the bound is too small, or a range is wrong", ratio * 100.0
    )]
    EmptySet {
        /// Largest error that was granted, as a share of the distance.
        ratio: f64,
    },
    /// The solution lies outside the tank by more than its own uncertainty.
    #[error("the solution lies {by_m:.2} m outside the tank")]
    OutsideTank {
        /// By how much, metres.
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

/// A position that is already believed, metres, with its covariance, square metres.
pub type Prior = (Point, Matrix2<f64>);

/// A way from ranges to a fix.
pub trait PositionSolver {
    /// By how much all ranges behind a fix are too long, metres, where the solver finds that out.
    fn excess_m(&self, _fix: &Fix, _ranges: &[Ranging], _stations: &[Station]) -> f64 {
        0.0
    }

    /// Computes the position from the ranges.
    ///
    /// Solvers use the prior to choose between mirror solutions, and with fewer than three stations need it.
    ///
    /// # Errors
    /// See [`FixError`]; never panics and never returns a number that is not finite.
    fn solve(&self, ranges: &[Ranging], stations: &[Station], prior: Option<Prior>) -> Result<Fix, FixError>;
}
