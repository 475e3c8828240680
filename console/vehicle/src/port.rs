//! The port between a flight and a vehicle, which can be simulated, recorded or real.
//!
//! A flight calls [`Vehicle::sense`] once at the start of each tick and [`Vehicle::act`] once at its end. Neither call
//! waits: for a vehicle in another process, `sense` returns the readings that have arrived since the last tick.

mod notice;

pub use notice::Notice;

use geometry::Drive;
use serde::{Deserialize, Serialize};
use std::fmt;
use world::{Readings, StationId, Truth};

/// Time for which a vehicle may carry out a `drive` without a further message, seconds; then it must stand still.
pub const LEASE_S: f64 = 0.25;

/// A vehicle: it delivers the readings of its sensors and takes commands.
pub trait Vehicle: Send {
    /// The readings since the last tick. Never waits.
    fn sense(&mut self) -> Sensed;

    /// The command until the next tick. Never waits.
    fn act(&mut self, command: Command);

    /// The true state at the start of this tick; `None` outside a simulation.
    fn truth(&self) -> Option<Truth>;

    /// Begins a fault of a station with the next tick.
    ///
    /// # Errors
    /// The vehicle is not a simulation, or does not offer faults.
    fn inject(&mut self, fault: StationFault) -> Result<(), CannotInject>;

    /// Whether readings have shown that the vehicle stands still, or that it does not. Until then, a start of a vehicle in
    /// another process is not decided.
    fn is_standstill_known(&self) -> bool {
        true
    }

    /// The link at the end of a mission, after the command to stand still. If `waits`, also whether the vehicle stands
    /// still: the call then takes at most as long as the vehicle may take to stop. `None` if this is not known.
    fn settle(&mut self, _waits: bool) -> Option<Live> {
        None
    }

    /// A handle that stops the vehicle at once, from any thread, without waiting for the next tick; `None` for vehicles
    /// whose time passes with the ticks.
    fn brake(&self) -> Option<Brake> {
        None
    }
}

/// The report of a vehicle since the last tick.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sensed {
    /// The readings; if several messages arrived in one tick, their odometry is added up.
    pub readings: Readings,
    /// Facts about the link; `None` for a simulation inside the console.
    pub live: Option<Live>,
}

/// Facts that only a vehicle in another process has.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Live {
    /// The stamps of the last reading that arrived; `None` if none arrived in this tick.
    pub stamps: Option<Stamps>,
    /// The state of the link, if it changed or is due.
    pub link: Option<LinkSeen>,
    /// Whether a commanded stop is confirmed, if that was decided in this tick.
    pub stood: Option<Stood>,
    /// New facts about the vehicle.
    pub notices: Vec<Notice>,
}

/// The result of a commanded stop, from readings that were taken after it was sent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stood {
    /// Whether the readings show that the vehicle stands still; if not, it still moves or is silent although it should
    /// stand.
    pub confirmed: bool,
    /// Time since the command, seconds; until the first of the readings without motion if the stop is confirmed.
    pub after_s: f64,
    /// Whether the vehicle has moved again after a confirmed stop, without an order.
    pub moved: bool,
}

impl Stood {
    /// The reason why a mission must not start with this vehicle, as a clause; `None` if the vehicle stands still.
    pub fn trouble(&self) -> Option<&'static str> {
        if self.confirmed {
            return None;
        }
        Some(if self.moved {
            "it is moving without an order; stop it by hand, then plan again from its new position"
        } else {
            "odometry does not show that it stands still; stop it by hand, and wait until it stands"
        })
    }
}

/// The times at which a reading was taken and arrived.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stamps {
    /// The vehicle's own clock when it took the reading, seconds.
    pub source_t_s: f64,
    /// The console's clock when the reading arrived, seconds since the vehicle was connected.
    pub arrival_t_s: f64,
}

/// The state of the link and of the vehicle, as far as a mission depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LinkState {
    /// Readings arrive, and the vehicle can be driven.
    #[default]
    Up,
    /// No readings have arrived for too long.
    Lost,
    /// The adapter has closed the link, or its process has ended. Only a new run can connect again.
    Closed,
    /// Several messages in a row were faulty.
    Faulty,
    /// The vehicle has started again; its earlier clock, frame and commands do not count any more.
    Restarted,
    /// A person is driving the vehicle by hand.
    Manual,
    /// The emergency stop of the vehicle is pressed.
    EmergencyStop,
    /// The vehicle reports a fault, or that it is not ready.
    VehicleFault,
    /// The vehicle obeys another console or program.
    OtherCommander,
    /// A vehicle with a different description answers on the same connection.
    OtherVehicle,
    /// The console itself was stopped, so it sent no commands.
    ConsoleStopped,
}

impl LinkState {
    /// Whether messages of the vehicle arrive.
    pub fn is_heard(self) -> bool {
        !matches!(self, Self::Lost | Self::Closed)
    }

    /// The state as a short word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Lost => "lost",
            Self::Closed => "closed",
            Self::Faulty => "faulty",
            Self::Restarted => "restarted",
            Self::Manual => "manual",
            Self::EmergencyStop => "emergency stop",
            Self::VehicleFault => "fault",
            Self::OtherCommander => "other commander",
            Self::OtherVehicle => "other vehicle",
            Self::ConsoleStopped => "console stopped",
        }
    }
}

/// The state of the link at one moment, with its figures since the vehicle was connected.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LinkSeen {
    /// The state.
    pub state: LinkState,
    /// The reason for a state other than [`LinkState::Up`], as a clause; empty otherwise.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub why: String,
    /// Age of the last reading, seconds; absent before the first one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub age_s: Option<f64>,
    /// The vehicle's clock minus the console's, seconds; absent until it has been measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset_s: Option<f64>,
    /// Bound on the error of `offset_s`, half the least round trip, seconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset_bound_s: Option<f64>,
    /// Age that 99 % of the readings do not exceed on arrival, seconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub age_p99_s: Option<f64>,
    /// Number of readings that arrived.
    pub heard: u64,
    /// Number of readings that are missing according to the sequence numbers.
    pub missed: u64,
    /// Number of faulty messages.
    pub faulty: u64,
    /// Time for which the motion is unknown because odometry is missing, seconds.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub unmeasured_s: f64,
    /// Time for which the console itself was stopped, seconds.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub console_stopped_s: f64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl LinkSeen {
    /// The reason why the vehicle must not be driven, as a clause; `None` if it may be driven.
    pub fn trouble(&self) -> Option<String> {
        let what = match self.state {
            LinkState::Up => return None,
            LinkState::Lost => "the link to the vehicle is lost",
            LinkState::Closed => "the link to the vehicle is closed",
            LinkState::Faulty => "the vehicle sends faulty messages",
            LinkState::Restarted => "the vehicle has restarted",
            LinkState::Manual => "a person is driving the vehicle by hand",
            LinkState::EmergencyStop => "the emergency stop of the vehicle is pressed",
            LinkState::VehicleFault => "the vehicle reports a fault",
            LinkState::OtherCommander => "the vehicle obeys another commander",
            LinkState::OtherVehicle => {
                "another vehicle answers on the same connection, which this run does not drive"
            }
            LinkState::ConsoleStopped => "the console itself was stopped",
        };
        let why = if self.why.is_empty() { String::new() } else { format!(": {}", self.why) };
        let unknown = if self.state.is_heard() {
            ""
        } else {
            "; the vehicle stops when its lease lapses, but the console cannot confirm this"
        };
        Some(format!("{what}{why}{unknown}"))
    }
}

/// A vehicle as it introduced itself; part of the first event of a live run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct VehicleInfo {
    /// Name of the vehicle.
    pub name: String,
    /// The address of its adapter, as written by the user: `unix:PATH`, `tcp:HOST:PORT`, `run:COMMAND`.
    pub at: String,
    /// Version of the protocol.
    pub protocol: u32,
    /// Lease that the vehicle honours, seconds.
    pub lease_s: f64,
    /// Stop time that the vehicle states, seconds.
    pub stop_s: f64,
    /// Largest speed, metres per second.
    pub speed_max_m_per_s: f64,
    /// Largest turn rate, radians per second.
    pub turn_max_rad_per_s: f64,
    /// The sensors that it has: `odometry`, `ranges`, `scan`, `contact`, `reel`, `pressure`.
    pub has: Vec<String>,
}

/// The command of one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command {
    /// The motion; `None` to stand still until the next motion.
    pub drive: Option<Drive>,
    /// The estimated heading of the robot, radians, with which a velocity in the tank frame is turned into the robot's
    /// frame.
    pub heading_rad: f64,
    /// Number of orders carried out by the mission in this tick that had pulled the [`Brake`] before. Carrying out such
    /// an order releases its pull.
    pub braking_orders: u32,
}

/// A fault of a station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StationFault {
    /// The station.
    pub station: StationId,
    /// Duration, seconds of mission time.
    pub for_s: f64,
    /// Length by which its ranges are too long, metres; `None` if the station is silent.
    pub excess_range_m: Option<f64>,
}

/// The error of a vehicle that does not offer faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CannotInject;

impl fmt::Display for CannotInject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("faults can be injected only into a simulation")
    }
}

/// Stops a vehicle at once, from any thread. Each pull belongs to an order, and is released when the mission has
/// carried out that order ([`Command::braking_orders`]) or the order is dropped. Until all pulls are released, no
/// motion is sent.
#[derive(Clone)]
pub struct Brake {
    pull: std::sync::Arc<dyn Fn() + Send + Sync>,
    release: std::sync::Arc<dyn Fn() + Send + Sync>,
}

impl Brake {
    /// Creates a brake from its effects.
    pub fn new(pull: impl Fn() + Send + Sync + 'static, release: impl Fn() + Send + Sync + 'static) -> Self {
        Self { pull: std::sync::Arc::new(pull), release: std::sync::Arc::new(release) }
    }

    /// Sends `stop`.
    pub fn pull(&self) {
        (self.pull)();
    }

    /// Releases one pull whose order was dropped, because the robot was already held.
    pub fn release(&self) {
        (self.release)();
    }
}

impl fmt::Debug for Brake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Brake")
    }
}
