//! What the positioner has to know beforehand.

use crate::{
    aggregate::Aggregation,
    ekf::MotionNoise,
    noise::{RangeNoise, Timing},
    solver_kind::SolverKind,
};
use serde::{Deserialize, Serialize};
use world::{Boundary, Pose, Station};

/// What the positioner has to know beforehand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PositionerConfig {
    /// The surveyed stations.
    pub stations: Vec<Station>,
    /// Where the robot stands at the start.
    pub start: Pose,
    /// Standard deviation of the start's position, metres.
    pub start_sigma_m: f64,
    /// Standard deviation of the start's heading, radians.
    pub heading_sigma_rad: f64,
    /// How single ranges scatter.
    pub noise: RangeNoise,
    /// How their times err besides.
    #[serde(default)]
    pub timing: Timing,
    /// Standard deviation of what all ranges may be too long by as a share, whatever the repetitions.
    #[serde(default)]
    pub scale_sigma_ratio: f64,
    /// How odometry errs.
    pub odometry: MotionNoise,
    /// How repetitions become one range.
    pub aggregation: Aggregation,
    /// How ranges become a fix.
    pub solver: SolverKind,
    /// The wall of the tank: a fix clearly behind it is rejected.
    pub boundary: Option<Boundary>,
    /// Whether the speed of sound is found out under way; needs four stations.
    pub calibrate_sound_speed: bool,
}

impl PositionerConfig {
    /// Usual errors: start surveyed to 5 cm and 0.05 rad, ranges to 3 %, odometry as [`MotionNoise::default`].
    pub fn new(stations: Vec<Station>, start: Pose) -> Self {
        Self {
            stations,
            start,
            start_sigma_m: 0.05,
            heading_sigma_rad: 0.05,
            noise: RangeNoise::Gaussian { sigma_ratio: 0.03 },
            timing: Timing::default(),
            scale_sigma_ratio: 0.0,
            odometry: MotionNoise::default(),
            aggregation: Aggregation::default(),
            solver: SolverKind::default(),
            boundary: None,
            calibrate_sound_speed: false,
        }
    }
}
