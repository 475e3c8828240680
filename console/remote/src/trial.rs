//! A trial of a vehicle: listens to it and, if it may be moved, drives and stops it. The evaluation is in
//! [`vehicle::trial`].

mod connection;
mod driving;
mod log;

use crate::{address::Address, remote::ConnectError};
use connection::Connection;
use driving::Driver;
use std::time::Duration;
use vehicle::{
    port::LEASE_S,
    trial::{self, Lines, Row, Verdict},
    wire::message::Hello,
};

/// Time for which the trial listens to the vehicle before anything moves. The rate of its clock needs 10 s.
const LISTEN: Duration = Duration::from_secs(11);
/// Time, seconds, that is added to the lease of the last command and the vehicle's own stop time; after the sum, the
/// vehicle must stand still.
const LEASE_SLACK_S: f64 = 0.05;
/// Distance and angle of the frame checks, and the speeds with which they are driven.
const AHEAD_M: f64 = 0.2;
const TURN_RAD: f64 = 20.0 * std::f64::consts::PI / 180.0;
const AHEAD_M_PER_S: f64 = 0.2;
const TURN_RAD_PER_S: f64 = 0.4;
/// Longest time until a vehicle has reached a commanded speed, beyond what its acceleration needs, seconds.
const REACH_S: f64 = 3.0;

/// The permissions and the limits of a trial.
#[derive(Debug, Clone, Copy)]
pub struct TrialOptions {
    /// Whether the adapter may be on another machine.
    pub network: bool,
    /// Whether the vehicle may be moved.
    pub drive: bool,
    /// Speed before each stop, metres per second; `None` for the vehicle's limit.
    pub speed_m_per_s: Option<f64>,
    /// Longest time of each stop, seconds; `None` for the time that the vehicle states, plus its lease.
    pub stop_max_s: Option<f64>,
}

/// The result of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The introduction of the vehicle.
    pub hello: Hello,
    /// The checks.
    pub rows: Vec<Row>,
    /// Whether a signal ended the trial early.
    pub interrupted: bool,
}

impl Trial {
    /// Whether no check failed and the trial was not interrupted.
    pub fn is_passed(&self) -> bool {
        !self.interrupted && self.rows.iter().all(|row| row.verdict != Verdict::Fail)
    }
}

/// The reason why a trial ended early.
#[derive(Debug)]
enum Early {
    /// A signal requested it.
    Interrupted,
    /// The connection ended.
    Closed(String),
}

/// Tries a vehicle. `tell` receives what is about to happen, before anything moves; `is_stopped` ends the trial early.
///
/// # Errors
/// The adapter cannot be reached, or does not introduce a vehicle.
pub fn try_vehicle(
    address: &Address,
    options: &TrialOptions,
    tell: &dyn Fn(&str),
    is_stopped: &dyn Fn() -> bool,
) -> Result<Trial, ConnectError> {
    if matches!(address, Address::Run(_)) && std::env::var_os("ROBOT_LOG").is_some() {
        tell(
            "the check names its own logs to the robot; the file in the environment variable ROBOT_LOG stays as it is",
        );
    }
    let mut connection = Connection::open(address, options.network)?;
    let hello = connection.hello().clone();
    let mut rows = vec![trial::introduction(&hello)];
    tell(&format!("listening to {} for {} s; nothing moves", foreign::plain(&hello.name), LISTEN.as_secs()));
    connection.await_readings(is_stopped);
    let listened = connection.listen(LISTEN, is_stopped);
    let messages = rows.len();
    rows.extend([trial::messages(&listened.lines), trial::state(&listened)]);
    rows.extend(trial::readings(&hello, &listened));
    rows.extend(trial::scanner(&hello, &listened));
    rows.extend([trial::clock(&listened), trial::clock_rate(&listened), trial::standstill(&listened)]);
    // Uneven readings change how exactly a stop is measured, but not how safely the vehicle stops.
    let is_ready = rows.iter().all(|row| row.verdict != Verdict::Fail || row.check == "readings: jitter");
    let mut interrupted = is_stopped();
    if !options.drive {
        let why = "the vehicle was not moved; `--drive` allows the check to move it";
        rows.extend(driving::not_driven(why));
    } else if !is_ready {
        let why = "the vehicle was not moved, because of the failures above";
        rows.extend(driving::not_driven(why));
    } else if !interrupted {
        tell(&warning(&hello, options));
        let lines = Lines::default();
        let mut driver = Driver { address, options, hello: &hello, is_stopped, lines };
        let early = driver.drive(connection, &mut rows, tell);
        rows[messages] = trial::messages(&driver.lines);
        interrupted = matches!(early, Some(Early::Interrupted));
        if let Some(Early::Closed(why)) = early {
            rows.push(Row::fail("connection", Vec::new(), format!("it ended during the trial: {why}")));
        }
    }
    Ok(Trial { hello, rows, interrupted })
}

/// The warning before the vehicle moves.
fn warning(hello: &Hello, options: &TrialOptions) -> String {
    let speed = driving::speed_m_per_s(hello, options);
    let limits = &hello.limits;
    let reach_m = speed * speed / limits.acceleration_m_per_s2 + speed * (1.0 + LEASE_S + hello.stop_time_s);
    format!(
        "the vehicle now MOVES: {AHEAD_M} m ahead, {:.0} degrees to the left, then several stops from {speed} m/s, ahead \
         and back in turn. Keep {:.1} m free ahead and {:.1} m behind, and keep a hand on the emergency stop. Ctrl-C \
         stops the vehicle.",
        TURN_RAD.to_degrees(),
        AHEAD_M + 2.0 * reach_m,
        2.0 * reach_m,
    )
}
