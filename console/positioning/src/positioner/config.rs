//! The configuration of the positioner.

use crate::{
    aggregate::Aggregation,
    ekf::MotionNoise,
    noise::{RangeNoise, Timing},
    protection::Risk,
    solver_kind::SolverKind,
    station_clocks::ClockConfig,
};
use serde::{Deserialize, Serialize};
use world::{Boundary, Pose, Station};

/// The configuration of the positioner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PositionerConfig {
    /// The surveyed stations.
    pub stations: Vec<Station>,
    /// The start pose of the robot.
    pub start: Pose,
    /// Standard deviation of the start's position, metres.
    pub start_sigma_m: f64,
    /// Standard deviation of the start's heading, radians.
    pub heading_sigma_rad: f64,
    /// The scatter of single ranges.
    pub noise: RangeNoise,
    /// The timing errors of ranges.
    #[serde(default)]
    pub timing: Timing,
    /// Standard deviation of the scale error of all ranges, as a share; repetitions do not reduce it.
    #[serde(default)]
    pub scale_sigma_ratio: f64,
    /// The errors of odometry.
    pub odometry: MotionNoise,
    /// The method that combines repetitions into one range.
    pub aggregation: Aggregation,
    /// The solver that turns ranges into a fix.
    pub solver: SolverKind,
    /// The wall of the tank: a fix clearly behind it is rejected.
    pub boundary: Option<Boundary>,
    /// Whether the speed of sound is estimated during the mission; needs four stations.
    pub calibrate_sound_speed: bool,
    /// The risk for which fixes state a protection level; `None` for the level of four standard deviations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub risk: Option<Risk>,
    /// What is known about the clocks of the stations; `None` if they share one clock. Needs
    /// [`SolverKind::Differences`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clocks: Option<ClockConfig>,
}

impl PositionerConfig {
    /// Returns a configuration with typical errors: 5 cm and 0.05 rad for the start, 3 % for ranges, and odometry as in
    /// [`MotionNoise::default`].
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
            risk: None,
            clocks: None,
        }
    }
}
