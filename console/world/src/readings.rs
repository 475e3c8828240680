//! The sensor readings of a robot in one tick. They never include the truth.

use crate::{
    scan::Scan,
    tank::{ObstacleId, StationId},
};
use geometry::Shape;
use serde::{Deserialize, Serialize};

/// The repeated ranges between one station and the robot in one ranging cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RangeSet {
    /// The station that was heard.
    pub station: StationId,
    /// One range per repetition, metres, each greater than zero.
    pub ranges_m: Vec<f64>,
}

/// The repeated pulses of one station, as another one heard them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PulseSet {
    /// The station that sent.
    pub sender: StationId,
    /// The station that heard.
    pub receiver: StationId,
    /// For each pulse, the time from sending to arrival, each by the clock of its station, times the assumed speed of
    /// sound, metres.
    pub lengths_m: Vec<f64>,
}

/// Motion since the last tick from track encoders and gyro, robot frame.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Odometry {
    /// Distance along the robot's x axis, metres.
    pub forward_m: f64,
    /// Distance along the robot's y axis, metres; zero for a robot that cannot move sideways.
    pub sideways_m: f64,
    /// Change of heading, radians.
    pub turn_rad: f64,
}

/// An obstacle within sensing range, seen for the first time or again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sighting {
    /// The id of the obstacle; the sensor's tracker always assigns the same id to the same obstacle.
    pub id: ObstacleId,
    /// The outline in the robot frame: x ahead, y left, metres.
    pub shape_in_robot: Shape,
}

/// All sensor readings of one tick.
///
/// ```
/// let readings = world::Readings::default();
/// assert_eq!((readings.ranges.len(), readings.odometry.forward_m), (0, 0.0));
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Readings {
    /// Ranges of a cycle that ended in this tick; empty between cycles.
    pub ranges: Vec<RangeSet>,
    /// Whether a ranging cycle ended in this tick, with or without ranges.
    pub ranging_cycle: bool,
    /// Pulses that the stations exchanged since the last tick.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pulses: Vec<PulseSet>,
    /// Motion since the last tick.
    pub odometry: Odometry,
    /// Time for which the motion is unknown because odometry is missing, seconds; 0 in a simulation.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub unmeasured_s: f64,
    /// Obstacles within sensing range.
    pub sightings: Vec<Sighting>,
    /// Whether the bumper is pressed.
    pub contact: bool,
    /// Length of tether that the reel has paid out, measured by its encoder, metres; `None` without a tether or an
    /// encoder.
    #[serde(default)]
    pub paid_out_m: Option<f64>,
    /// Pull of the tether at the reel, newtons; `None` without a sensor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reel_pull_n: Option<f64>,
    /// Pull of the tether at the robot, newtons; `None` without a sensor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot_pull_n: Option<f64>,
    /// Gauge pressure at the hull, pascals; `None` without a pressure sensor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_pa: Option<f64>,
    /// The channels of the instrument that are dead, in ascending order; `None` if nothing was reported since the last
    /// readings. Channel 0 is on the right.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dead_channels: Option<Vec<u16>>,
    /// The last scan of the surroundings; `None` without a scanner, and in ticks without a scan.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scan: Option<Scan>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
