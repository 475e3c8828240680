//! The types on the wire, as far as adapters in Rust use them. Frames: the robot frame has x ahead and y left; a pose is
//! in any fixed frame with counter-clockwise headings.

use serde::{Deserialize, Serialize};

/// A message to the console.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum FromVehicle {
    /// The first message of a connection.
    Hello(Hello),
    /// The measurements of one period.
    Readings(Readings),
    /// The state of the vehicle, sent at least once a second and after each change.
    State(State),
    /// The answer to a ping.
    Pong {
        /// `stamp_s` of the ping.
        echo_s: f64,
        /// Time of the answer, seconds of the adapter's clock.
        stamp_s: f64,
    },
}

/// A message from the console. Unknown keys are ignored.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ToVehicle {
    /// Move as stated until the lease lapses.
    Drive(Drive),
    /// Stand still until the next drive.
    Stop {
        /// Number of the command.
        seq: u64,
        /// Time of sending, seconds of the console's clock; a stop without it stops the vehicle, too.
        stamp_s: Option<f64>,
    },
    /// Asks for a pong.
    Ping {
        /// Time of sending, seconds of the console's clock.
        stamp_s: f64,
    },
    /// The console leaves.
    Bye,
    /// A message of a kind that this adapter does not know.
    #[serde(other)]
    Unknown,
}

/// A command to move.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct Drive {
    /// Number of the command; drives and stops are counted together.
    pub seq: u64,
    /// Time of sending, seconds of the console's clock.
    pub stamp_s: f64,
    /// The vehicle stands still if no other drive arrives within this time, seconds.
    pub lease_s: f64,
    /// Speed ahead, metres per second.
    pub forward_m_per_s: f64,
    /// Speed to the left, metres per second.
    #[serde(default)]
    pub sideways_m_per_s: f64,
    /// Turn rate, radians per second, counter-clockwise.
    pub turn_rad_per_s: f64,
}

/// The vehicle introduces itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hello {
    /// Version of the protocol.
    pub protocol: u32,
    /// Human-readable name.
    pub name: String,
    /// How the vehicle moves.
    pub motion: Motion,
    /// The limits of its motion.
    pub limits: Limits,
    /// The parts that its readings contain.
    pub has: Has,
    /// Time between two readings, seconds.
    pub period_s: f64,
    /// Time from the arrival of a `stop` at full speed until the vehicle stands still, seconds.
    pub stop_time_s: f64,
    /// Longest lease that the vehicle honours, seconds.
    pub lease_max_s: f64,
}

/// How a vehicle moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Forward and backward along its heading, and turning.
    Unicycle,
    /// In any direction, and turning.
    Omni,
}

/// The limits of a vehicle's motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Limits {
    /// Maximum speed, metres per second.
    pub speed_m_per_s: f64,
    /// Maximum turn rate, radians per second.
    pub turn_rad_per_s: f64,
    /// Maximum acceleration, metres per second squared.
    pub acceleration_m_per_s2: f64,
    /// Radius of a disc about the origin of the robot frame that contains the hull, metres.
    pub radius_m: f64,
}

/// The parts that a vehicle's readings contain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is a sensor of its own")]
pub struct Has {
    /// A pose in a frame of the vehicle's own.
    pub pose: bool,
    /// Scans.
    pub scan: bool,
    /// A bumper.
    pub contact: bool,
    /// The reel of the tether.
    pub tether: bool,
    /// Ranges to stations.
    pub ae: bool,
}

/// The measurements of one period. A part that was not measured is absent.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Readings {
    /// Number of these readings.
    pub seq: u64,
    /// Time of measurement, seconds of the adapter's clock.
    pub stamp_s: f64,
    /// The pose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
    /// The result of a cycle of ranging.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ae: Option<Ae>,
    /// A scan of the surroundings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scan: Option<Scan>,
    /// Whether the bumper is pressed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<bool>,
    /// The reel of the tether.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tether: Option<Tether>,
}

/// A pose in a fixed frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Pose {
    /// Metres.
    pub x_m: f64,
    /// Metres.
    pub y_m: f64,
    /// Radians, counter-clockwise from the x axis.
    pub heading_rad: f64,
}

/// The result of a cycle of ranging.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ae {
    /// One entry per station that was heard.
    pub ranges: Vec<StationRanges>,
}

/// Distances to a station.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StationRanges {
    /// Name of the station in the scenario.
    pub station: String,
    /// One distance per repetition, metres.
    pub ranges_m: Vec<f64>,
}

/// A scan of the surroundings.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scan {
    /// Direction of the first ray, radians from straight ahead.
    pub first_rad: f64,
    /// Angle from ray to ray, radians.
    pub step_rad: f64,
    /// Largest distance that the sensor measures, metres.
    pub range_max_m: f64,
    /// Place of the sensor in the robot frame, metres ahead and to the left.
    pub sensor_m: [f64; 2],
    /// Distances from the sensor, metres: `None` for a ray without an echo, 0 for something too near to be measured.
    pub ranges_m: Vec<Option<f64>>,
}

/// The reel of the tether.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Tether {
    /// Length paid out, metres.
    pub paid_out_m: f64,
}

/// The state of the vehicle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct State {
    /// Time of this message, seconds of the adapter's clock.
    pub stamp_s: f64,
    /// Whether the vehicle obeys.
    pub mode: Mode,
    /// The reason, for people: at most 200 characters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// Charge, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub battery: Option<f64>,
    /// Who commands the vehicle.
    pub commander: Commander,
}

/// Whether the vehicle obeys the console.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// It obeys.
    Ready,
    /// A person is driving it.
    Manual,
    /// Its emergency stop is pressed.
    EmergencyStop,
    /// It cannot drive.
    Fault,
}

/// Who commands the vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Commander {
    /// The console.
    You,
    /// Another program is commanding it, too.
    OtherProgram,
}
