//! The part of a trial that moves the vehicle.

use super::{
    AHEAD_M, AHEAD_M_PER_S, Early, LEASE_SLACK_S, REACH_S, TURN_RAD, TURN_RAD_PER_S, TrialOptions,
    connection::Connection, log::RobotLog,
};
use crate::{address::Address, stream::End};
use rustix::process::Signal;
use std::{
    f64::consts::{PI, TAU},
    time::{Duration, Instant},
};
use vehicle::{
    port::LEASE_S,
    trial::{self, Cause, Limits, Moved, Row, Sample, moving_m_per_s, stands},
    wire::message::{Hello, Pose},
};

/// The checks that move the vehicle.
pub(super) const CHECKS: [&str; 7] = [
    "frames: ahead",
    "frames: turn",
    "stop: message stop",
    "stop: commands end",
    "stop: adapter stopped",
    "stop: link cut",
    "stop: adapter killed",
];

/// Time between two commands.
const COMMAND_EVERY: Duration = Duration::from_millis(50);
/// Longest wait for a vehicle to stand beyond the time that it may take, seconds.
const PATIENCE_S: f64 = 3.0;
/// Share of the commanded speed that must be reached before a stop.
const REACHED: f64 = 0.9;

/// The speed from which stops are measured, metres per second.
pub(super) fn speed_m_per_s(hello: &Hello, options: &TrialOptions) -> f64 {
    options.speed_m_per_s.unwrap_or(f64::INFINITY).min(hello.limits.speed_m_per_s)
}

/// Drives a vehicle in a trial.
pub(super) struct Driver<'a> {
    pub address: &'a Address,
    pub options: &'a TrialOptions,
    pub hello: &'a Hello,
    pub log: Option<&'a RobotLog>,
    pub is_stopped: &'a dyn Fn() -> bool,
}

/// The samples around a stop.
struct Seen {
    samples: Vec<Sample>,
    cause_s: f64,
}

impl Driver<'_> {
    /// Runs all checks; returns the reason if they ended early.
    pub(super) fn drive(
        &mut self,
        connection: Connection,
        rows: &mut Vec<Row>,
        tell: &dyn Fn(&str),
    ) -> Option<Early> {
        let mut connection = Some(connection);
        let done = self.checks(&mut connection, rows, tell);
        if let Some(connection) = connection {
            connection.leave();
        }
        done.err()
    }

    fn checks(
        &self,
        slot: &mut Option<Connection>,
        rows: &mut Vec<Row>,
        tell: &dyn Fn(&str),
    ) -> Result<(), Early> {
        let connection = slot.as_mut().ok_or_else(closed)?;
        tell(&format!("driving {AHEAD_M} m ahead"));
        rows.extend(self.frames(connection, true)?);
        tell(&format!("turning left by {:.0} degrees", TURN_RAD.to_degrees()));
        rows.extend(self.frames(connection, false)?);
        let is_process = matches!(connection.end, End::Process(_));
        let mut speed = speed_m_per_s(self.hello, self.options);
        for cause in [Cause::Stop, Cause::Lease, Cause::Stopped, Cause::Cut, Cause::Killed] {
            if !is_process && matches!(cause, Cause::Stopped | Cause::Killed) {
                let why = "only a process that the check has started (run:COMMAND) can be stopped and killed";
                rows.push(Row::not_measured(cause.check(), why));
                continue;
            }
            tell(&format!("driving {}, then {}", if speed > 0.0 { "ahead" } else { "back" }, words(cause)));
            rows.push(self.stop(slot, cause, speed)?);
            speed = -speed;
        }
        Ok(())
    }

    /// Drives ahead or turns, and compares odometry and pose with the command.
    fn frames(&self, connection: &mut Connection, is_ahead: bool) -> Result<Vec<Row>, Early> {
        let limits = &self.hello.limits;
        let (v, w) = if is_ahead {
            (AHEAD_M_PER_S.min(0.5 * limits.speed_m_per_s), 0.0)
        } else {
            (0.0, TURN_RAD_PER_S.min(0.5 * limits.turn_rad_per_s))
        };
        let time_s = if is_ahead { AHEAD_M / v } else { TURN_RAD / w };
        connection.forget();
        let began = Instant::now();
        while began.elapsed().as_secs_f64() < time_s {
            connection.drive(v, w);
            let until = (Instant::now() + COMMAND_EVERY).min(began + Duration::from_secs_f64(time_s));
            self.take(connection, until)?;
        }
        let commanded = if is_ahead { v } else { w } * began.elapsed().as_secs_f64();
        self.stand(connection)?;
        let row = |check, moved| {
            if is_ahead {
                trial::ahead(check, commanded, moved)
            } else {
                trial::turned(check, commanded, moved)
            }
        };
        let mut rows = Vec::new();
        if self.hello.has.odometry {
            let check = if is_ahead { "frames: ahead by odometry" } else { "frames: turn by odometry" };
            rows.push(row(check, by_odometry(connection)));
        }
        if self.hello.has.pose {
            let check = if is_ahead { "frames: ahead by pose" } else { "frames: turn by pose" };
            rows.push(match by_pose(&connection.poses) {
                Some(moved) => row(check, moved),
                None => Row::fail(check, Vec::new(), "no pose arrived, although `hello.has` promises one"),
            });
        }
        Ok(rows)
    }

    /// Stops the vehicle and waits until it stands still.
    fn stand(&self, connection: &mut Connection) -> Result<(), Early> {
        let until = self.patience(self.hello.stop_time_s);
        connection.stop();
        self.take(connection, Instant::now() + COMMAND_EVERY)?;
        while !stands(&connection.heard.samples) && Instant::now() < until {
            connection.stop();
            self.take(connection, Instant::now() + COMMAND_EVERY)?;
        }
        Ok(())
    }

    fn patience(&self, time_s: f64) -> Instant {
        Instant::now()
            + Duration::from_secs_f64(time_s.max(self.options.stop_max_s.unwrap_or(0.0)) + PATIENCE_S)
    }

    fn take(&self, connection: &mut Connection, until: Instant) -> Result<(), Early> {
        if (self.is_stopped)() {
            return Err(Early::Interrupted);
        }
        connection.take_until(until);
        match connection.closed() {
            Some(why) => Err(Early::Closed(why.to_owned())),
            None => Ok(()),
        }
    }

    /// Drives, and stops in one way. Afterwards, `slot` holds a connection with a standing vehicle.
    fn stop(&self, slot: &mut Option<Connection>, cause: Cause, speed: f64) -> Result<Row, Early> {
        let connection = slot.as_mut().ok_or_else(closed)?;
        let is_socket = !matches!(connection.end, End::Process(_));
        // A second connection to the adapter only listens.
        let mut onlooker = if cause == Cause::Cut && is_socket { self.connect().ok() } else { None };
        self.reach(connection, speed)?;
        let limits = self.limits(cause, connection, speed);
        let seen = match cause {
            Cause::Stop | Cause::Lease => self.by_command(connection, cause)?,
            Cause::Stopped => self.by_signal(connection)?,
            Cause::Cut | Cause::Killed => {
                let connection = slot.take().ok_or_else(closed)?;
                let seen = self.by_end(connection, cause, onlooker.as_mut(), limits);
                drop(onlooker);
                *slot = Some(self.connect().map_err(|error| Early::Closed(error.to_string()))?);
                seen
            }
        };
        let row = match seen {
            Some(Seen { samples, cause_s }) => trial::stop(cause, &samples, cause_s, limits),
            None => Row::not_measured(cause.check(), "no stamps arrived before the stop"),
        };
        Ok(self.hinted(row, cause))
    }

    /// If a stop was not measured, adds how it can be measured.
    fn hinted(&self, row: Row, cause: Cause) -> Row {
        if row.verdict != trial::Verdict::NotMeasured {
            return row;
        }
        let how = match (cause, self.log) {
            (Cause::Cut, _) if !matches!(self.address, Address::Run(_)) => {
                "have the adapter also send readings to a second connection"
            }
            (_, Some(_)) => {
                "have the robot write `time speed turn_rate` lines to the file named in ROBOT_LOG"
            }
            (_, None) => "the log cannot be written to the folder for temporary files",
        };
        Row { says: format!("{}; {how}", row.says), ..row }
    }

    fn limits(&self, cause: Cause, connection: &Connection, speed: f64) -> Limits {
        let lease_s = if cause == Cause::Stop { 0.0 } else { LEASE_S.min(self.hello.lease_max_s) };
        let stated_s = lease_s + LEASE_SLACK_S + self.hello.stop_time_s;
        // The time of a stop is known to within one period plus the error of the clock.
        let resolution_s = self.hello.period_s + connection.clock_error_s();
        Limits {
            commanded_m_per_s: speed.abs(),
            time_s: self.options.stop_max_s.unwrap_or(stated_s + resolution_s),
        }
    }

    /// Drives until the speed is reached.
    fn reach(&self, connection: &mut Connection, speed: f64) -> Result<(), Early> {
        connection.forget();
        if let Some(log) = self.log {
            log.clear();
        }
        let ramp_s = speed.abs() / self.hello.limits.acceleration_m_per_s2;
        let until = Instant::now() + Duration::from_secs_f64(ramp_s + REACH_S);
        let is_reached = |connection: &Connection| {
            let samples = &connection.heard.samples;
            let now = samples.last().and_then(|last| moving_m_per_s(samples, last.t_s));
            now.is_some_and(|now| now >= REACHED * speed.abs())
        };
        while !is_reached(connection) && Instant::now() < until {
            connection.drive(speed, 0.0);
            self.take(connection, Instant::now() + COMMAND_EVERY)?;
        }
        connection.drive(speed, 0.0);
        Ok(())
    }

    fn by_command(&self, connection: &mut Connection, cause: Cause) -> Result<Option<Seen>, Early> {
        let cause_s = connection.vehicle_now_s();
        if cause == Cause::Stop {
            connection.stop();
        }
        let until = self.patience(LEASE_S + self.hello.stop_time_s);
        let moves = |connection: &Connection| {
            let last = connection.heard.samples.last();
            !stands(&connection.heard.samples) || last.is_some_and(|last| Some(last.t_s) <= cause_s)
        };
        while moves(connection) && Instant::now() < until {
            self.take(connection, Instant::now() + COMMAND_EVERY)?;
        }
        let samples = connection.heard.samples.clone();
        self.stand(connection)?;
        Ok(cause_s.map(|cause_s| Seen { samples, cause_s }))
    }

    /// Suspends the adapter process while the vehicle stops; the readings arrive afterwards. The adapter first gets
    /// time to pass on the last command; otherwise, it would do so when it continues.
    fn by_signal(&self, connection: &mut Connection) -> Result<Option<Seen>, Early> {
        self.take(connection, Instant::now() + COMMAND_EVERY)?;
        let cause_s = connection.vehicle_now_s();
        connection.end.signal(Signal::STOP);
        let time_s = LEASE_S + self.hello.stop_time_s + 2.0 * trial::QUIET_S;
        std::thread::sleep(Duration::from_secs_f64(time_s));
        connection.end.signal(Signal::CONT);
        let until = self.patience(0.0);
        let has_all = |connection: &Connection| {
            let last = connection.heard.samples.last();
            last.is_some_and(|last| cause_s.is_some_and(|cause_s| last.t_s > cause_s + time_s))
        };
        while !has_all(connection) && Instant::now() < until {
            self.take(connection, Instant::now() + COMMAND_EVERY)?;
        }
        let mut samples = connection.heard.samples.clone();
        if let (Some(log), Some(cause_s)) = (self.log, cause_s) {
            samples = merged(samples, &log.samples(), cause_s);
        }
        self.stand(connection)?;
        let is_silent = |sample: &Sample| cause_s.is_none_or(|cause_s| sample.t_s <= cause_s + time_s);
        samples.retain(is_silent);
        Ok(cause_s.map(|cause_s| Seen { samples, cause_s }))
    }

    /// Ends the connection or its process, and collects the remaining samples of the robot's motion: from a second
    /// connection, from the rest of the stream, or from the robot's log.
    fn by_end(
        &self,
        mut connection: Connection,
        cause: Cause,
        mut onlooker: Option<&mut Connection>,
        limits: Limits,
    ) -> Option<Seen> {
        let cause_s = connection.vehicle_now_s();
        let mut samples = Vec::new();
        let is_socket = !matches!(connection.end, End::Process(_));
        if cause == Cause::Killed {
            connection.end.signal(Signal::KILL);
        } else {
            connection.close_write();
        }
        if is_socket {
            samples.append(&mut connection.heard.samples);
            drop(connection);
            connection_gone(&mut onlooker, &mut samples, self.patience(limits.time_s), cause_s);
        } else {
            samples = self.until_silent(&mut connection, cause_s, self.patience(limits.time_s));
        }
        cause_s.map(|cause_s| Seen { samples, cause_s })
    }

    /// Follows the rest of the stream and the log of a robot whose adapter has lost its console or has ended, until the
    /// robot stands still. A robot process may end as soon as the robot stands still; its log then ends with a
    /// standstill.
    fn until_silent(&self, connection: &mut Connection, cause_s: Option<f64>, until: Instant) -> Vec<Sample> {
        let mut grown = (0, Instant::now());
        loop {
            connection.take_until(Instant::now() + COMMAND_EVERY);
            let mut samples = connection.heard.samples.clone();
            if let (Some(log), Some(cause_s)) = (self.log, cause_s) {
                samples = merged(samples, &log.samples(), cause_s);
            }
            let last = samples.last().copied().filter(|last| Some(last.t_s) > cause_s);
            if (last.is_some() && stands(&samples)) || Instant::now() >= until {
                return samples;
            }
            if samples.len() != grown.0 {
                grown = (samples.len(), Instant::now());
            }
            let is_ended =
                connection.closed().is_some() && grown.1.elapsed().as_secs_f64() > 2.0 * trial::QUIET_S;
            if let Some(last) = last.filter(|last| is_ended && !last.moves()) {
                let (over_s, way_m, turn_rad) = (trial::QUIET_S, 0.0, 0.0);
                samples.push(Sample { t_s: last.t_s + over_s, over_s, way_m, turn_rad });
                return samples;
            }
        }
    }

    fn connect(&self) -> Result<Connection, crate::ConnectError> {
        let mut connection = Connection::open(self.address, self.options.network, self.log)?;
        connection.await_readings(self.is_stopped);
        Ok(connection)
    }
}

/// Listens with a second connection after the first one was cut. Both connections use the vehicle's clock.
fn connection_gone(
    onlooker: &mut Option<&mut Connection>,
    samples: &mut Vec<Sample>,
    until: Instant,
    cause_s: Option<f64>,
) {
    let Some(onlooker) = onlooker else { return };
    let is_seen = |samples: &[Sample]| stands(samples) && samples.last().map(|last| last.t_s) > cause_s;
    while !is_seen(&onlooker.heard.samples) && Instant::now() < until && onlooker.closed().is_none() {
        onlooker.take_until(Instant::now() + COMMAND_EVERY);
    }
    let known_s = samples.last().map_or(f64::NEG_INFINITY, |last| last.t_s);
    samples.extend(onlooker.heard.samples.iter().filter(|sample| sample.t_s > known_s));
}

/// The samples of the log if it reaches back to before the cause and has more samples after it than the wire; otherwise
/// the samples from the wire.
fn merged(wire: Vec<Sample>, log: &[Sample], cause_s: f64) -> Vec<Sample> {
    let after = |samples: &[Sample]| samples.iter().filter(|sample| sample.t_s > cause_s).count();
    if after(log) > after(&wire) && log.iter().any(|sample| sample.t_s <= cause_s) {
        log.to_vec()
    } else {
        wire
    }
}

fn closed() -> Early {
    Early::Closed("the connection has ended".into())
}

fn words(cause: Cause) -> &'static str {
    match cause {
        Cause::Stop => "sending `stop`",
        Cause::Lease => "sending nothing more, so that the lease lapses",
        Cause::Cut => "cutting the connection",
        Cause::Stopped => "stopping the adapter process (SIGSTOP)",
        Cause::Killed => "killing the adapter process",
    }
}

/// The sum of the odometry since the start of the motion.
fn by_odometry(connection: &Connection) -> Moved {
    let mut moved = Moved::default();
    for odometry in &connection.odometry {
        let (sin, cos) = moved.turn_rad.sin_cos();
        moved.forward_m += odometry.forward_m * cos - odometry.sideways_m * sin;
        moved.sideways_m += odometry.forward_m * sin + odometry.sideways_m * cos;
        moved.turn_rad += odometry.turn_rad;
    }
    moved
}

/// The motion from the first pose to the last one.
fn by_pose(poses: &[Pose]) -> Option<Moved> {
    let (first, last) = (poses.first()?, poses.last()?);
    let (x, y) = (last.x_m - first.x_m, last.y_m - first.y_m);
    let (sin, cos) = first.heading_rad.sin_cos();
    let turns = poses.windows(2).map(|pair| {
        let turn_rad = pair[1].heading_rad - pair[0].heading_rad;
        (turn_rad + PI).rem_euclid(TAU) - PI
    });
    Some(Moved { forward_m: x * cos + y * sin, sideways_m: y * cos - x * sin, turn_rad: turns.sum() })
}
