//! The types on the wire. Frames: the robot frame has x ahead and y left; a vehicle's own frame is any fixed frame with
//! x, y and counter-clockwise headings (ENU). Stamps are seconds of the sender's own steady clock, from any start.

use serde::{Deserialize, Serialize};

/// A message from the vehicle.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum FromVehicle {
    /// The first message of a connection.
    Hello(Box<Hello>),
    /// The readings of the sensors, at a steady rate.
    Readings(Box<Readings>),
    /// The state of the vehicle: at least once a second, and after each change.
    State(State),
    /// The answer to a ping, at once.
    Pong(Pong),
}

/// A message to the vehicle.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ToVehicle {
    /// Move as stated until the lease lapses or the next command arrives.
    Drive(Drive),
    /// Stop as fast as the vehicle safely can, and stand still until the next drive. This is not an emergency stop.
    Stop(Stop),
    /// Asks for a pong.
    Ping(Ping),
    /// The console leaves; the vehicle stands still.
    Bye(Bye),
}

/// The vehicle introduces itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hello {
    /// Version of the protocol.
    pub protocol: u32,
    /// Name of the vehicle, for people: at most 64 printable characters.
    pub name: String,
    /// How the vehicle moves.
    pub motion: MotionKind,
    /// The limits of its motion.
    pub limits: Limits,
    /// The parts that its readings contain.
    #[serde(default)]
    pub has: Has,
    /// Time between two readings, seconds: greater than 0, at most 1.
    pub period_s: f64,
    /// Measured time from the arrival of a `stop` at full speed until the vehicle stands still, seconds: at most 60.
    pub stop_time_s: f64,
    /// Longest lease that the vehicle honours, seconds: greater than 0, at most 5.
    pub lease_max_s: f64,
    /// Number that differs after each start of the vehicle. Over datagrams, on which an introduction may arrive several
    /// times, it distinguishes a repetition from a restart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub session: Option<u64>,
}

/// How a vehicle moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionKind {
    /// Forward and backward along its heading, and turning.
    Unicycle,
    /// In any direction, and turning.
    Omni,
}

impl MotionKind {
    /// The kind as on the wire.
    pub fn word(self) -> &'static str {
        match self {
            Self::Unicycle => "unicycle",
            Self::Omni => "omni",
        }
    }
}

/// The limits of a vehicle's motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Maximum speed, metres per second: greater than 0, at most 10.
    pub speed_m_per_s: f64,
    /// Maximum turn rate, radians per second: greater than 0, at most 20.
    pub turn_rad_per_s: f64,
    /// Maximum acceleration, metres per second squared: greater than 0, at most 50.
    pub acceleration_m_per_s2: f64,
    /// Radius of the smallest disc about the origin of the robot frame that contains the hull, metres: greater than 0, at
    /// most 10.
    pub radius_m: f64,
}

/// The parts that the readings of a vehicle contain. A part that is not listed is absent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is a sensor of its own")]
pub struct Has {
    /// `odometry`.
    #[serde(default)]
    pub odometry: bool,
    /// `pose`.
    #[serde(default)]
    pub pose: bool,
    /// `scan`.
    #[serde(default)]
    pub scan: bool,
    /// `contact`.
    #[serde(default)]
    pub contact: bool,
    /// `tether`.
    #[serde(default)]
    pub tether: bool,
    /// `ae`.
    #[serde(default)]
    pub ae: bool,
    /// `pressure_pa`.
    #[serde(default)]
    pub pressure: bool,
    /// Whether the ids in `outlines` are those of the obstacles of the scenario, so that the tracker recognizes the drawn
    /// ones. The ids of any other tracker are its own.
    #[serde(default)]
    pub drawn_ids: bool,
}

impl Has {
    /// The parts that are present, in words.
    pub fn parts(self) -> Vec<&'static str> {
        let Self { odometry, pose, scan, contact, tether, ae, pressure, drawn_ids } = self;
        let parts = [
            (odometry, "odometry"),
            (pose, "pose"),
            (scan, "scan"),
            (contact, "contact"),
            (tether, "tether"),
            (ae, "ae"),
            (pressure, "pressure"),
            (drawn_ids, "ids of the drawing"),
        ];
        parts.into_iter().filter(|(has, _)| *has).map(|(_, part)| part).collect()
    }
}

/// The readings of the vehicle's sensors. A part that was not measured is absent.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Readings {
    /// Number of this message: one more than that of the readings before it.
    pub seq: u64,
    /// Time of the measurement, seconds of the vehicle's clock.
    pub stamp_s: f64,
    /// Motion since the readings before these.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub odometry: Option<Odometry>,
    /// Pose in the vehicle's own frame. If it is present, the console takes the motion from it, so that a lost message
    /// does not lose motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
    /// The result of a cycle of acoustic ranging that ended with these readings, with or without ranges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ae: Option<Ae>,
    /// The pulses that the stations exchanged, each as another station heard it, by the names of the scenario's stations:
    /// at most 4032.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pulses: Vec<PulseLengths>,
    /// A scan of the surroundings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scan: Option<Scan>,
    /// Whether the bumper is pressed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<bool>,
    /// The reel of the tether.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tether: Option<Tether>,
    /// Gauge pressure at the hull, pascals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_pa: Option<f64>,
    /// The channels of the instrument that are dead: at most 512 numbers, each at most 511; channel 0 is on the right. An
    /// empty list states that all channels work. Without this part, the state before remains valid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dead_channels: Option<Vec<u16>>,
    /// Outlines of obstacles, for a vehicle with a tracker of its own: at most 1000.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outlines: Vec<Outline>,
    /// Channels of an instrument: at most 64.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub channels: Vec<Channel>,
}

/// Motion from encoders and gyro, in the robot frame at the beginning of the motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Odometry {
    /// Time in which this motion was made, seconds: greater than 0, at most 10.
    pub over_s: f64,
    /// Distance ahead, metres.
    pub forward_m: f64,
    /// Distance to the left, metres.
    #[serde(default)]
    pub sideways_m: f64,
    /// Change of heading, radians, counter-clockwise.
    pub turn_rad: f64,
}

/// A pose in the vehicle's own frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Metres, at most 100,000 from the origin.
    pub x_m: f64,
    /// Metres, at most 100,000 from the origin.
    pub y_m: f64,
    /// Radians, counter-clockwise from the x axis. Any number of turns may be added.
    pub heading_rad: f64,
}

/// The result of a cycle of acoustic ranging, by the names of the scenario's stations: at most 64 entries in each list.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Ae {
    /// Distances.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ranges: Vec<StationRanges>,
    /// Times of arrival.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub arrivals: Vec<Arrival>,
    /// Differences between times of arrival.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub differences: Vec<Difference>,
}

/// The distances to a station.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StationRanges {
    /// Name of the station.
    pub station: String,
    /// One distance per repetition, metres, each greater than 0 and at most 1000: at most 1000 distances.
    pub ranges_m: Vec<f64>,
}

/// The pulses of a station that another one heard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PulseLengths {
    /// Name of the station that sent.
    pub sender: String,
    /// Name of the station that heard.
    pub receiver: String,
    /// For each repetition, the time from sending to arrival, each by the clock of its station, times the assumed speed of
    /// sound, metres: at most 1000 lengths, each from -1000 to 1000, because the clocks may differ.
    pub lengths_m: Vec<f64>,
}

/// A time of arrival at a station.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Arrival {
    /// Name of the station.
    pub station: String,
    /// Time of arrival, seconds of the clock of the stations.
    pub arrival_s: f64,
    /// Time of emission, seconds of the same clock; absent if it is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub emitted_s: Option<f64>,
}

/// The difference between the times of arrival at two stations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Name of the station.
    pub station: String,
    /// Name of the station whose time of arrival is subtracted.
    pub reference: String,
    /// Time of arrival minus that at the reference, seconds: at most 1 in size.
    pub tdoa_s: f64,
}

fn is_origin(place: &[f64; 2]) -> bool {
    *place == [0.0, 0.0]
}

/// A scan of the surroundings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scan {
    /// Direction of the first ray, radians, counter-clockwise from straight ahead: at most 7 in size.
    pub first_rad: f64,
    /// Angle from one ray to the next, radians, negative for a scan that runs clockwise: not 0, at most 7 in size.
    pub step_rad: f64,
    /// Largest distance that the sensor measures, metres: greater than 0, at most 1000.
    pub range_max_m: f64,
    /// Place of the sensor in the robot frame, metres, each at most 10 from 0.
    #[serde(default, skip_serializing_if = "is_origin")]
    pub sensor_m: [f64; 2],
    /// Distances from the sensor, metres, from 0 to `range_max_m`; `null` for a ray without an echo. 1 to 4096 rays.
    pub ranges_m: Vec<Option<f64>>,
}

/// The reel of the tether.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tether {
    /// Length paid out, metres: 0 to 10,000.
    pub paid_out_m: f64,
    /// Pull at the reel, newtons: 0 to 1,000,000.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pull_n: Option<f64>,
}

/// The outline of an obstacle within sensing range, in the robot frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outline {
    /// Number of the obstacle; the tracker gives the same number to the same obstacle.
    pub id: u32,
    /// Points, metres, x ahead and y left, each at most 1000 from 0: one for a disc, two or more for a chain, three or
    /// more for a convex polygon, counter-clockwise. At most 1000 points.
    pub points_m: Vec<[f64; 2]>,
    /// Radius of a disc, or half the thickness of a chain, metres: 0 to 1000.
    #[serde(default)]
    pub radius_m: f64,
    /// Whether the points are a polygon and not a chain.
    #[serde(default)]
    pub closed: bool,
}

/// A value of an instrument.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// Name with its unit, for example `liftoff_mm`.
    pub name: String,
    /// The value.
    pub value: f64,
}

/// The state of the vehicle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time of this message, seconds of the vehicle's clock.
    pub stamp_s: f64,
    /// Whether the vehicle obeys the console.
    pub mode: Mode,
    /// The reason, for people: at most 200 printable characters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
    /// Charge of the battery, 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub battery: Option<f64>,
    /// Who commands the vehicle.
    #[serde(default)]
    pub commander: Commander,
}

/// Whether the vehicle obeys the console. In every mode except `ready`, the console holds the mission.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// It obeys.
    Ready,
    /// A person is driving it by hand.
    Manual,
    /// Its emergency stop is pressed.
    EmergencyStop,
    /// It cannot drive; `text` contains the reason.
    Fault,
}

/// Who commands a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Commander {
    /// The console that receives this message.
    #[default]
    You,
    /// Another console on the same adapter; this console only watches.
    OtherConsole,
    /// Another program sends commands to the same vehicle. The console holds the mission.
    OtherProgram,
}

/// The answer to a ping.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pong {
    /// `stamp_s` of the ping, unchanged.
    pub echo_s: f64,
    /// Time of this answer, seconds of the vehicle's clock.
    pub stamp_s: f64,
}

/// A command to move.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Number of the command: one more than that of the command before it, drive or stop. The vehicle ignores a command
    /// whose number is not greater than the greatest one that it has received in this connection.
    pub seq: u64,
    /// Time of sending, seconds of the console's clock.
    pub stamp_s: f64,
    /// Time after this drive, seconds, after which the vehicle stands still if no other drive has arrived.
    pub lease_s: f64,
    /// Speed ahead, metres per second.
    pub forward_m_per_s: f64,
    /// Speed to the left, metres per second; 0 for a unicycle.
    #[serde(default)]
    pub sideways_m_per_s: f64,
    /// Turn rate, radians per second, counter-clockwise.
    pub turn_rad_per_s: f64,
}

/// A command to stand still.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stop {
    /// Number of the command, counted together with those of the drives.
    pub seq: u64,
    /// Time of sending, seconds of the console's clock.
    pub stamp_s: f64,
}

/// A question for the vehicle's clock.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ping {
    /// Time of sending, seconds of the console's clock.
    pub stamp_s: f64,
}

/// The console leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Bye {}
