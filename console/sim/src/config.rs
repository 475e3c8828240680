//! What is simulated.

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};
use world::{Amphibious, ObstacleId, Point, Pose, StationId, World};

/// How ranges scatter about the true distance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "model")]
pub enum NoiseModel {
    /// Exact ranges.
    None,
    /// True distance times `1 + u`, `u` uniform in `[-ratio, ratio]` (Wang et al. 2023, eq. 13).
    Uniform {
        /// Largest error as a share of the distance.
        ratio: f64,
    },
    /// True distance times `1 + g`, `g` normal with standard deviation `sigma_ratio`.
    Gaussian {
        /// Standard deviation as a share of the distance.
        sigma_ratio: f64,
    },
    /// True distance times `1 + t`, `t` triangular about 0 with ends at `-ratio` and `ratio`: the mean of two uniform
    /// errors, as in two-way ranging.
    Triangular {
        /// Largest error as a share of the distance.
        ratio: f64,
    },
    /// True distance times `1 + t`, `t` with Student's distribution of 3 degrees of freedom, scaled to the standard
    /// deviation `sigma_ratio`: now and then a range is far off.
    HeavyTailed {
        /// Standard deviation as a share of the distance.
        sigma_ratio: f64,
    },
}

/// What a station hears of a robot that stands behind something solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BehindColumns {
    /// The direct sound, as if nothing were there.
    #[default]
    Heard,
    /// The sound that creeps around the column.
    Creeping,
    /// The direct sound, later by an exponential delay of mean [`Disturbances::excess_range_mean_m`].
    Late,
    /// The shortest echo from the wall.
    WallEcho,
    /// Nothing.
    Silent,
}

/// One station misbehaves for a while.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StationFault {
    /// Which station.
    pub station: StationId,
    /// Beginning in mission time, seconds.
    pub from_s: f64,
    /// End in mission time, seconds.
    pub to_s: f64,
    /// Metres that every range is too long by; `None`: the station is silent.
    pub excess_range_m: Option<f64>,
}

/// Everything that goes wrong with ranges besides their scatter. The default is nothing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Disturbances {
    /// Chance that a single range of a station is missing, 0 to 1.
    pub ping_dropout_probability: f64,
    /// Chance that a range scatters [`Self::outlier_factor`] times as far, 0 to 1.
    pub outlier_probability: f64,
    /// How much further outliers scatter.
    pub outlier_factor: f64,
    /// Chance that a single range comes late, 0 to 1.
    pub late_ping_probability: f64,
    /// Chance that all ranges of a station come late in a cycle, because something hides it, 0 to 1.
    pub nlos_probability: f64,
    /// Mean of the exponential delay of what is late, metres.
    pub excess_range_mean_m: f64,
    /// What is heard of a robot behind a column.
    pub behind_columns: BehindColumns,
    /// Standard deviation of the surveyed station places in x and in y, metres; drawn once for a run.
    pub survey_sigma_m: f64,
    /// How much too long all ranges are because the sound is slower than was assumed, as a share.
    pub sound_speed_error_ratio: f64,
    /// Faults of single stations.
    pub faults: Vec<StationFault>,
}

/// Acoustic-emission ranging.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AeConfig {
    /// Time between ranging cycles, seconds.
    pub period_s: f64,
    /// Ranges per station and cycle.
    pub repetitions: u32,
    /// How they scatter.
    pub noise: NoiseModel,
    /// Chance that a station is not heard in a cycle, 0 to 1.
    pub dropout: f64,
    /// Spans of mission time without any answer, seconds: from, to.
    pub outages_s: Vec<(f64, f64)>,
    /// What else goes wrong.
    pub disturbances: Disturbances,
}

/// The robot's body and its errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobotConfig {
    /// True pose at the start.
    pub start: Pose,
    /// Radius of the hull, metres.
    pub radius_m: f64,
    /// Largest speed, metres per second.
    pub v_max_m_per_s: f64,
    /// Largest turn rate, radians per second.
    pub w_max_rad_per_s: f64,
    /// Largest change of speed, metres per second squared.
    pub acceleration_m_per_s2: f64,
    /// How far it sees obstacles, metres.
    pub sensing_range_m: f64,
    /// Share of the commanded way that is lost to slip, on average.
    pub slip_mean: f64,
    /// Standard deviation of the slip from tick to tick.
    pub slip_sigma: f64,
    /// Standard deviation of the odometry's own error as a share of the way.
    pub odometry_sigma_ratio: f64,
    /// Constant error of the gyro, radians per second.
    pub gyro_bias_rad_per_s: f64,
    /// For a robot that walks and swims: limits that take the place of those above, by the zone it is in.
    #[serde(default)]
    pub amphibious: Option<Amphibious>,
}

/// An obstacle that moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mover {
    /// Which one.
    pub id: ObstacleId,
    /// How.
    pub track: Track,
}

/// How an obstacle moves; it does not turn, and nothing stops it but the wall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Track {
    /// Straight on, and back again from the wall.
    Straight {
        /// Metres per second, tank frame.
        velocity_m_per_s: Vector2<f64>,
    },
    /// From where it stands to one place after the other, and back the same way, for ever.
    Waypoints {
        /// The places, metres.
        points: Vec<Point>,
        /// Metres per second.
        speed_m_per_s: f64,
    },
}

/// Everything that the simulator needs besides the seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimConfig {
    /// The tank as it truly is.
    pub world: World,
    /// The robot.
    pub robot: RobotConfig,
    /// The ranging; `None` for a tank without stations.
    pub ae: Option<AeConfig>,
    /// Length of a tick, seconds.
    pub tick_s: f64,
    /// Obstacles that move.
    #[serde(default)]
    pub movers: Vec<Mover>,
    /// Where the tether is made fast, metres; `None` for a robot without one.
    #[serde(default)]
    pub tether_anchor: Option<Point>,
    /// Cable on the reel, metres; `None` for an endless one. A robot at its end pulls in vain.
    #[serde(default)]
    pub reel_length_m: Option<f64>,
}

/// The truth of one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// True pose.
    pub pose: Pose,
    /// Distance from the hull to the nearest solid thing, metres; negative in a collision.
    pub clearance_m: f64,
    /// Whether the hull began to touch something in this tick.
    pub collided: bool,
    /// How the cable lies; `None` without one.
    pub tether: Option<TetherTruth>,
}

/// How the cable truly lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TetherTruth {
    /// Cable between anchor and robot, metres.
    pub length_m: f64,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Sum of all wraps, radians.
    pub wrap_total_rad: f64,
    /// Cable beyond the straight line from the anchor to the robot, metres.
    pub detour_m: f64,
}
