//! The stops of a trial: the vehicle drives, and is stopped in one way.

use super::{COMMAND_EVERY, Driver, Early, closed};
use crate::{
    address::Address,
    stream::End,
    trial::{LEASE_SLACK_S, REACH_S, connection::Connection},
};
use rustix::process::Signal;
use std::time::{Duration, Instant};
use vehicle::{
    port::LEASE_S,
    trial::{self, Cause, Limits, Lines, Row, Sample, Verdict, moving_m_per_s, stands},
};

/// Share of the commanded speed that must be reached before a stop.
const REACHED: f64 = 0.9;

/// The samples around a stop.
struct Seen {
    samples: Vec<Sample>,
    cause_s: f64,
    /// Whether the vehicle moved again when a stopped adapter continued.
    again: bool,
}

impl Driver<'_> {
    /// Drives, and stops in one way. Afterwards, `slot` holds a connection with a standing vehicle.
    pub(super) fn stop(
        &mut self,
        slot: &mut Option<Connection>,
        cause: Cause,
        speed: f64,
    ) -> Result<Row, Early> {
        let connection = slot.as_mut().ok_or_else(closed)?;
        let is_socket = !matches!(connection.end, End::Process(_));
        // A second connection to the adapter only listens.
        let mut onlooker = if cause == Cause::Cut && is_socket { self.connect().ok() } else { None };
        let has_log = connection.log.is_some();
        self.reach(connection, speed)?;
        let limits = self.limits(cause, connection, speed);
        let seen = match cause {
            Cause::Stop | Cause::Lease => self.by_command(connection, cause)?,
            Cause::Stopped => self.by_signal(connection, speed)?,
            Cause::Cut | Cause::Killed => {
                let connection = slot.take().ok_or_else(closed)?;
                let (seen, lines) = self.by_end(connection, cause, onlooker.as_mut(), limits);
                self.lines.extend(lines);
                drop(onlooker);
                *slot = Some(self.connect().map_err(|error| Early::Closed(error.to_string()))?);
                seen
            }
        };
        let row = match seen {
            Some(Seen { samples, cause_s, again }) => {
                let row = trial::stop(cause, &samples, cause_s, limits);
                if again { trial::moved_again(row) } else { row }
            }
            None => Row::not_measured(cause.check(), "no stamps arrived before the stop"),
        };
        Ok(self.hinted(row, cause, has_log))
    }

    /// If a stop was not measured, adds how it can be measured.
    fn hinted(&self, row: Row, cause: Cause, has_log: bool) -> Row {
        if row.verdict != Verdict::NotMeasured {
            return row;
        }
        let how = match (cause, has_log) {
            (Cause::Cut, _) if !matches!(self.address, Address::Run(_)) => {
                "have the adapter also send readings to a second connection"
            }
            (_, true) => "have the robot write `time speed turn_rate` lines to the file named in ROBOT_LOG",
            (_, false) => "the log cannot be written to the folder for temporary files",
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
        Ok(cause_s.map(|cause_s| Seen { samples, cause_s, again: false }))
    }

    /// Suspends the adapter process while the vehicle stops; the readings arrive afterwards. A command that is sent
    /// meanwhile must not move the vehicle when the adapter continues.
    fn by_signal(&self, connection: &mut Connection, speed: f64) -> Result<Option<Seen>, Early> {
        self.take(connection, Instant::now() + COMMAND_EVERY)?;
        let cause_s = connection.vehicle_now_s();
        connection.end.signal(Signal::STOP);
        connection.drive(speed, 0.0);
        let time_s = LEASE_S + self.hello.stop_time_s + 2.0 * trial::QUIET_S;
        std::thread::sleep(Duration::from_secs_f64(time_s));
        connection.end.signal(Signal::CONT);
        let until = self.patience(0.0);
        let has_all = |connection: &Connection| {
            let last = connection.heard.samples.last();
            last.is_some_and(|last| cause_s.is_some_and(|cause_s| last.t_s > cause_s + time_s + LEASE_S))
        };
        while !has_all(connection) && Instant::now() < until {
            self.take(connection, Instant::now() + COMMAND_EVERY)?;
        }
        let mut samples = connection.heard.samples.clone();
        if let (Some(log), Some(cause_s)) = (&connection.log, cause_s) {
            samples = merged(samples, &log.samples(), cause_s);
        }
        self.stand(connection)?;
        let is_silent = |sample: &Sample| cause_s.is_none_or(|cause_s| sample.t_s <= cause_s + time_s);
        let again = samples.iter().any(|sample| !is_silent(sample) && sample.moves());
        samples.retain(is_silent);
        Ok(cause_s.map(|cause_s| Seen { samples, cause_s, again }))
    }

    /// Ends the connection or its process, and collects the remaining samples of the robot's motion: from a second
    /// connection, from the rest of the stream, or from the robot's log. Also returns the lines of both connections.
    fn by_end(
        &self,
        mut connection: Connection,
        cause: Cause,
        mut onlooker: Option<&mut Connection>,
        limits: Limits,
    ) -> (Option<Seen>, Lines) {
        let cause_s = connection.vehicle_now_s();
        let mut samples = Vec::new();
        let is_socket = !matches!(connection.end, End::Process(_));
        if cause == Cause::Killed {
            connection.end.signal(Signal::KILL);
        } else {
            connection.close_write();
        }
        let mut lines;
        if is_socket {
            samples.append(&mut connection.heard.samples);
            lines = std::mem::take(&mut connection.heard.lines);
            drop(connection);
            connection_gone(&mut onlooker, &mut samples, self.patience(limits.time_s), cause_s);
            lines.extend(onlooker.map(|onlooker| onlooker.heard.lines.clone()).unwrap_or_default());
        } else {
            samples = until_silent(&mut connection, cause_s, self.patience(limits.time_s));
            lines = std::mem::take(&mut connection.heard.lines);
        }
        (cause_s.map(|cause_s| Seen { samples, cause_s, again: false }), lines)
    }
}

/// Follows the rest of the stream and the log of a robot whose adapter has lost its console or has ended, until the
/// robot stands still. A robot process may end as soon as the robot stands still; its log then ends with a
/// standstill.
fn until_silent(connection: &mut Connection, cause_s: Option<f64>, until: Instant) -> Vec<Sample> {
    let mut grown = (0, Instant::now());
    loop {
        connection.take_until(Instant::now() + COMMAND_EVERY);
        let mut samples = connection.heard.samples.clone();
        if let (Some(log), Some(cause_s)) = (&connection.log, cause_s) {
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
