//! Configuration of the simulator.

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};
use world::{Amphibious, ObstacleId, Point, Pose, PressureSensor, Scanner, StationId, World};

/// The random error of ranges.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "model")]
pub enum NoiseModel {
    /// Exact ranges.
    None,
    /// True distance times `1 + u`, `u` uniform in `[-ratio, ratio]` (Wang et al. 2023, eq. 13).
    Uniform {
        /// Maximum error as a share of the distance.
        ratio: f64,
    },
    /// True distance times `1 + g`, `g` normal with standard deviation `sigma_ratio`.
    Gaussian {
        /// Standard deviation as a share of the distance.
        sigma_ratio: f64,
    },
    /// True distance times `1 + t`, `t` triangular about 0 with ends at `-ratio` and `ratio`: the mean of two uniform
    /// errors, as occurs in two-way ranging.
    Triangular {
        /// Maximum error as a share of the distance.
        ratio: f64,
    },
    /// True distance times `1 + t`, `t` from Student's distribution with 3 degrees of freedom, scaled to the standard
    /// deviation `sigma_ratio`. Occasionally, a range is far off.
    HeavyTailed {
        /// Standard deviation as a share of the distance.
        sigma_ratio: f64,
    },
}

/// The sound that a station receives from a robot that is behind something solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BehindColumns {
    /// The direct sound, as if there were no obstacle.
    #[default]
    Heard,
    /// The wave that creeps around the column.
    Creeping,
    /// The direct sound, delayed by a random amount with an exponential distribution of mean
    /// [`Disturbances::excess_range_mean_m`].
    Late,
    /// The shortest echo from the wall.
    WallEcho,
    /// No sound.
    Silent,
}

/// A temporary fault of one station.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StationFault {
    /// Id of the station.
    pub station: StationId,
    /// Start of the fault, mission time, seconds.
    pub from_s: f64,
    /// End of the fault, mission time, seconds.
    pub to_s: f64,
    /// Length by which every range from the station is too long, metres; negative if too short; `None` if the station is silent.
    pub excess_range_m: Option<f64>,
}

/// All disturbances of ranges other than their random error. By default, there are none.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Disturbances {
    /// Probability that a single range of a station is missing, 0 to 1.
    pub ping_dropout_probability: f64,
    /// Probability that the error of a range is [`Self::outlier_factor`] times as large, 0 to 1.
    pub outlier_probability: f64,
    /// Factor by which the errors of outliers are multiplied.
    pub outlier_factor: f64,
    /// Probability that a single range is late, 0 to 1.
    pub late_ping_probability: f64,
    /// Probability that all ranges of a station in a cycle are late, as if it were out of sight, 0 to 1.
    pub nlos_probability: f64,
    /// Mean of the exponentially distributed delay of late ranges, metres.
    pub excess_range_mean_m: f64,
    /// The sound received from a robot that is behind a column.
    pub behind_columns: BehindColumns,
    /// Standard deviation of the error of surveyed station positions, in x and in y, metres; drawn once per run.
    pub survey_sigma_m: f64,
    /// Ratio by which all ranges are too long because sound is slower than assumed.
    pub sound_speed_error_ratio: f64,
    /// Temporary faults of single stations.
    pub faults: Vec<StationFault>,
}

/// Errors of ranges that do not depend on the distance: they are errors of the times from which the ranges are computed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct TimingErrors {
    /// Standard deviation of the normally distributed error of each range, metres.
    pub jitter_m: f64,
    /// Ranges are rounded to whole multiples of this, metres; 0 for no rounding.
    pub resolution_m: f64,
}

impl TimingErrors {
    /// Whether all errors are zero.
    pub fn is_none(&self) -> bool {
        !(self.jitter_m > 0.0 || self.resolution_m > 0.0)
    }
}

/// The time of emission, and the clocks of the stations.
///
/// A range is the time from emission to arrival, times the assumed speed of sound. With an unknown time of emission, all
/// ranges of a cycle are too long by the same random length; a station with a clock of its own adds the offset of this
/// clock, which grows linearly in time.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Clocks {
    /// Whether the time of emission is unknown.
    pub is_emission_unknown: bool,
    /// Standard deviation of the offsets of the stations' clocks, as a length that sound travels, metres; drawn once per
    /// run.
    pub offset_sigma_m: f64,
    /// Standard deviation of the drifts of the stations' clocks, metres per hour; drawn once per run.
    pub drift_sigma_m_per_h: f64,
}

impl Clocks {
    /// Whether the time of emission is known and all stations share one clock.
    pub fn is_common(&self) -> bool {
        *self == Self::default()
    }
}

/// Acoustic-emission ranging.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AeConfig {
    /// Time between ranging cycles, seconds.
    pub period_s: f64,
    /// Number of ranges per station and cycle.
    pub repetitions: u32,
    /// The random error of the ranges.
    pub noise: NoiseModel,
    /// The timing errors of the ranges.
    #[serde(default, skip_serializing_if = "TimingErrors::is_none")]
    pub timing: TimingErrors,
    /// The time of emission, and the clocks of the stations.
    #[serde(default, skip_serializing_if = "Clocks::is_common")]
    pub clocks: Clocks,
    /// How long the robot must stand still before the stations exchange pulses, seconds; they also do at the start.
    /// `None`: they never do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pulse_rest_s: Option<f64>,
    /// Probability that a station is not heard in a cycle, 0 to 1.
    pub dropout_probability: f64,
    /// Intervals of mission time in which there are no ranges, seconds: start, end.
    pub outages_s: Vec<(f64, f64)>,
    /// Other disturbances.
    pub disturbances: Disturbances,
}

/// The robot's body and its errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobotConfig {
    /// True pose at the start.
    pub start: Pose,
    /// Radius of the hull, metres.
    pub radius_m: f64,
    /// Maximum speed, metres per second.
    pub v_max_m_per_s: f64,
    /// Maximum turn rate, radians per second.
    pub w_max_rad_per_s: f64,
    /// Maximum acceleration, metres per second squared.
    pub acceleration_m_per_s2: f64,
    /// Range within which the robot sees obstacles, metres.
    pub sensing_range_m: f64,
    /// Mean share of the commanded distance that is lost to slip.
    pub slip_mean: f64,
    /// Standard deviation of the slip from tick to tick.
    pub slip_sigma: f64,
    /// Standard deviation of the odometry's own error, as a share of the distance.
    pub odometry_sigma_ratio: f64,
    /// Constant bias of the gyro, radians per second.
    pub gyro_bias_rad_per_s: f64,
    /// For a robot that walks and swims: limits that replace the limits above, depending on the zone that the robot is
    /// in.
    #[serde(default)]
    pub amphibious: Option<Amphibious>,
    /// The pressure sensor that detects whether the floor under the robot is flooded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure: Option<PressureSensor>,
    /// The scanner; without one, the robot is told the outlines of obstacles within [`Self::sensing_range_m`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scanner: Option<Scanner>,
}

/// A moving obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mover {
    /// Id of the obstacle.
    pub id: ObstacleId,
    /// Motion of the obstacle.
    pub track: Track,
}

/// The motion of an obstacle. The obstacle does not rotate, and only the wall stops it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Track {
    /// Straight ahead; the direction is reversed at the wall.
    Straight {
        /// Velocity, metres per second, tank frame.
        velocity_m_per_s: Vector2<f64>,
    },
    /// From its initial position through the points and back the same way, repeated indefinitely.
    Waypoints {
        /// The points, metres, tank frame.
        points: Vec<Point>,
        /// Speed, metres per second.
        speed_m_per_s: f64,
    },
}

/// Everything that the simulator needs, except the seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimConfig {
    /// The true tank.
    pub world: World,
    /// The robot.
    pub robot: RobotConfig,
    /// Configuration of ranging; `None` for a tank without stations.
    pub ae: Option<AeConfig>,
    /// Length of a tick, seconds.
    pub tick_s: f64,
    /// The moving obstacles.
    #[serde(default)]
    pub movers: Vec<Mover>,
    /// Where the tether enters the tank, metres, tank frame; `None` for a robot without one.
    #[serde(default)]
    pub tether_anchor: Option<Point>,
    /// Length of tether on the reel, metres; `None` for no limit. A robot at the end of its tether cannot drive any
    /// farther.
    #[serde(default)]
    pub reel_length_m: Option<f64>,
    /// A cable with weight and friction, which may be slack; `None` for a cable that is always taut.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub physical: Option<PhysicalCable>,
    /// The times at which channels of the instrument are dead.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub channel_faults: Vec<ChannelFault>,
}

/// A time at which a channel of the instrument is dead.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ChannelFault {
    /// The channel; channel 0 is on the right.
    pub channel: u16,
    /// Mission time at which it begins, seconds.
    pub from_s: f64,
    /// Mission time at which it ends, seconds.
    pub to_s: f64,
}

/// A cable with weight and friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PhysicalCable {
    /// The properties of cable and reel.
    pub law: cable::Law,
    /// When the reel stops taking up cable, mission time, seconds; `None` if it never does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fails_at_s: Option<f64>,
    /// When the cable tears, mission time, seconds; `None` if it never does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub breaks_at_s: Option<f64>,
    /// The pull beyond which the cable tears, newtons; `None` if it bears any pull.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub breaks_at_n: Option<f64>,
}
