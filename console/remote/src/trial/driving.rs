//! The part of a trial that moves the vehicle.

mod stops;

use super::{AHEAD_M, AHEAD_M_PER_S, Early, TURN_RAD, TURN_RAD_PER_S, TrialOptions, connection::Connection};
use crate::{address::Address, stream::End};
use std::{
    f64::consts::{PI, TAU},
    time::{Duration, Instant},
};
use vehicle::{
    trial::{self, Cause, Lines, Moved, Row, Verdict, stands},
    wire::message::{Hello, Pose},
};

/// Time between two commands.
const COMMAND_EVERY: Duration = Duration::from_millis(50);
/// Longest wait for a vehicle to stand beyond the time that it may take, seconds.
const PATIENCE_S: f64 = 3.0;

/// The speed from which stops are measured, metres per second.
pub(super) fn speed_m_per_s(hello: &Hello, options: &TrialOptions) -> f64 {
    options.speed_m_per_s.unwrap_or(f64::INFINITY).min(hello.limits.speed_m_per_s)
}

/// Drives a vehicle in a trial.
pub(super) struct Driver<'a> {
    pub address: &'a Address,
    pub options: &'a TrialOptions,
    pub hello: &'a Hello,
    pub is_stopped: &'a dyn Fn() -> bool,
    /// The lines of the connections that have ended.
    pub lines: Lines,
}

/// A check that moves the vehicle.
#[derive(Clone, Copy)]
enum Stage {
    Ahead,
    Turn,
    Stop(Cause),
}

impl Stage {
    const ALL: [Self; 7] = [
        Self::Ahead,
        Self::Turn,
        Self::Stop(Cause::Stop),
        Self::Stop(Cause::Lease),
        Self::Stop(Cause::Stopped),
        Self::Stop(Cause::Cut),
        Self::Stop(Cause::Killed),
    ];

    fn check(self) -> &'static str {
        match self {
            Self::Ahead => "frames: ahead",
            Self::Turn => "frames: turn",
            Self::Stop(cause) => cause.check(),
        }
    }
}

/// Rows for all checks that move the vehicle, if it was not moved.
pub(super) fn not_driven(why: &'static str) -> impl Iterator<Item = Row> {
    Stage::ALL.into_iter().map(move |stage| Row::not_measured(stage.check(), why))
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
        if let Some(mut connection) = connection {
            self.lines.extend(std::mem::take(&mut connection.heard.lines));
            connection.leave();
        }
        done.err()
    }

    /// Runs the checks up to the first failure: each one relies on the results of the earlier ones. A vehicle that does
    /// not stop on command, for example, must not be driven again.
    fn checks(
        &mut self,
        slot: &mut Option<Connection>,
        rows: &mut Vec<Row>,
        tell: &dyn Fn(&str),
    ) -> Result<(), Early> {
        let mut speed = speed_m_per_s(self.hello, self.options);
        let listened = rows.len();
        for stage in Stage::ALL {
            let connection = slot.as_mut().ok_or_else(closed)?;
            let is_malformed = self.lines.malformed + connection.heard.lines.malformed > 0;
            let is_process = matches!(connection.end, End::Process(_));
            if is_malformed || rows[listened..].iter().any(|row| row.verdict == Verdict::Fail) {
                let why = "the vehicle was not moved again, because of the failure above";
                rows.push(Row::not_measured(stage.check(), why));
                continue;
            }
            match stage {
                Stage::Ahead => {
                    tell(&format!("driving {AHEAD_M} m ahead"));
                    rows.extend(self.frames(connection, true)?);
                }
                Stage::Turn => {
                    tell(&format!("turning left by {:.0} degrees", TURN_RAD.to_degrees()));
                    rows.extend(self.frames(connection, false)?);
                }
                Stage::Stop(Cause::Stopped | Cause::Killed) if !is_process => {
                    let why =
                        "only a process that the check has started (run:COMMAND) can be stopped and killed";
                    rows.push(Row::not_measured(stage.check(), why));
                }
                Stage::Stop(cause) => {
                    let way = if speed > 0.0 { "ahead" } else { "back" };
                    tell(&format!("driving {way}, then {}", words(cause)));
                    rows.push(self.stop(slot, cause, speed)?);
                    speed = -speed;
                }
            }
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

    fn connect(&self) -> Result<Connection, crate::ConnectError> {
        let mut connection = Connection::open(self.address, self.options.network)?;
        connection.await_readings(self.is_stopped);
        Ok(connection)
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
