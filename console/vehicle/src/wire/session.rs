//! The state with which a message must agree: the `hello` of the vehicle, and the earlier messages.

use super::{
    check::{Checked, misfit, stamp},
    message::{Drive, FromVehicle, Hello, Limits, MotionKind, Odometry, Pose, Readings, ToVehicle},
};
use std::f64::consts::{PI, TAU};

/// Largest amount by which a stamp may go back, seconds: messages may be reordered on their way.
const BACK_MAX_S: f64 = 1.0;

/// Factor and amounts by which a measured motion may exceed the limits of the vehicle, to allow for overshoot and
/// noise.
const MEASURED_FACTOR: f64 = 1.5;
const MEASURED_SLACK_M: f64 = 0.05;
const MEASURED_SLACK_RAD: f64 = 0.1;

/// Amount by which a command may exceed a limit, to allow for rounding when it is converted to text and back.
const COMMAND_SLACK: f64 = 1e-9;

/// The messages of a vehicle so far.
#[derive(Debug, Clone, Default)]
pub struct FromSession {
    is_of_datagrams: bool,
    hello: Option<Hello>,
    /// The newest stamp of the readings, which is a time of measurement, and that of the other messages, which is a time
    /// of sending. Readings that waited in the adapter are older than its answer to a ping.
    measured_s: Option<f64>,
    sent_s: Option<f64>,
    pose: Option<(f64, Pose)>,
    /// Number of rays of the first scan.
    rays: Option<usize>,
}

/// The commands to a vehicle so far.
#[derive(Debug, Clone)]
pub struct ToSession {
    hello: Hello,
    newest_s: Option<f64>,
}

impl FromSession {
    /// The messages of a vehicle that uses datagrams; a datagram may arrive more than once.
    pub fn of_datagrams() -> Self {
        Self { is_of_datagrams: true, ..Self::default() }
    }

    /// The introduction of the vehicle.
    pub fn hello(&self) -> Option<&Hello> {
        self.hello.as_ref()
    }

    pub(super) fn check(&mut self, message: &FromVehicle) -> Checked {
        match message {
            FromVehicle::Hello(hello) => {
                hello.check()?;
                if self.is_of_datagrams && hello.session.is_none() {
                    return misfit(
                        "hello.session",
                        "is missing; over datagrams, it must identify each start of the vehicle",
                    );
                }
                // A vehicle that introduces itself again has started again: its clock and its frame are new.
                let is_of_datagrams = self.is_of_datagrams;
                *self = Self { is_of_datagrams, hello: Some(hello.as_ref().clone()), ..Self::default() };
                Ok(())
            }
            FromVehicle::Readings(readings) => {
                let Hello { limits, has, .. } = *self.greeted("readings")?;
                readings.check()?;
                if (has.odometry || has.pose) && readings.odometry.is_none() && readings.pose.is_none() {
                    return misfit(
                        "readings.odometry",
                        "is missing, and so is `pose`; `hello.has` promises one of them",
                    );
                }
                self.moves(&limits, readings)?;
                self.sees(readings)?;
                runs_on("readings.stamp_s", &mut self.measured_s, readings.stamp_s)?;
                self.stands_at(readings);
                Ok(())
            }
            FromVehicle::State(state) => {
                self.greeted("state")?;
                state.check()?;
                runs_on("state.stamp_s", &mut self.sent_s, state.stamp_s)
            }
            FromVehicle::Pong(pong) => {
                self.greeted("pong")?;
                pong.check()?;
                runs_on("pong.stamp_s", &mut self.sent_s, pong.stamp_s)
            }
        }
    }

    /// Whether a message is the introduction again, without a restart.
    pub(super) fn is_repeated(&self, message: &FromVehicle) -> bool {
        let FromVehicle::Hello(hello) = message else { return false };
        self.is_of_datagrams && hello.session.is_some() && self.hello.as_ref() == Some(hello)
    }

    fn greeted(&self, kind: &str) -> Result<&Hello, super::Misfit> {
        match &self.hello {
            Some(hello) => Ok(hello),
            None => misfit("type", format!("{kind} before hello")),
        }
    }

    /// Compares a motion with the limits.
    fn moves(&self, limits: &Limits, readings: &Readings) -> Checked {
        if let Some(odometry) = &readings.odometry {
            moved(limits, odometry)?;
        }
        let (Some(pose), Some((before_s, before))) = (&readings.pose, &self.pose) else { return Ok(()) };
        let over_s = readings.stamp_s - before_s;
        if over_s > 0.0 {
            jumped(limits, over_s, before, pose)?;
        }
        Ok(())
    }

    /// A scan with far fewer rays than the first one would leave a part of the surroundings unseen.
    fn sees(&mut self, readings: &Readings) -> Checked {
        let Some(scan) = &readings.scan else { return Ok(()) };
        let (n, first) = (scan.ranges_m.len(), *self.rays.get_or_insert(scan.ranges_m.len()));
        if 2 * n >= first {
            return Ok(());
        }
        let what = format!("{n} rays, but the first scan had {first}; a ray without an echo is null");
        misfit("readings.scan.ranges_m", what)
    }

    fn stands_at(&mut self, readings: &Readings) {
        let is_newer = self.pose.is_none_or(|(before_s, _)| readings.stamp_s > before_s);
        if let Some(pose) = readings.pose.filter(|_| is_newer) {
            self.pose = Some((readings.stamp_s, pose));
        }
    }
}

impl ToSession {
    /// The state before the first command to the vehicle with this `hello`.
    pub fn of(hello: Hello) -> Self {
        Self { hello, newest_s: None }
    }

    pub(super) fn check(&mut self, message: &ToVehicle) -> Checked {
        match message {
            ToVehicle::Drive(drive) => {
                drive.check()?;
                self.is_possible(drive)?;
                runs_on("drive.stamp_s", &mut self.newest_s, drive.stamp_s)
            }
            ToVehicle::Stop(stop) => {
                stamp("stop.stamp_s", stop.stamp_s)?;
                // A stop counts however late it is.
                self.newest_s = Some(self.newest_s.map_or(stop.stamp_s, |newest| newest.max(stop.stamp_s)));
                Ok(())
            }
            ToVehicle::Ping(ping) => {
                stamp("ping.stamp_s", ping.stamp_s)?;
                runs_on("ping.stamp_s", &mut self.newest_s, ping.stamp_s)
            }
            ToVehicle::Bye(_) => Ok(()),
        }
    }

    fn is_possible(&self, drive: &Drive) -> Checked {
        let Limits { speed_m_per_s, turn_rad_per_s, .. } = self.hello.limits;
        faster("drive.forward_m_per_s", drive.forward_m_per_s, speed_m_per_s, "m/s")?;
        faster("drive.sideways_m_per_s", drive.sideways_m_per_s, speed_m_per_s, "m/s")?;
        faster("drive.turn_rad_per_s", drive.turn_rad_per_s, turn_rad_per_s, "rad/s")?;
        if self.hello.motion == MotionKind::Unicycle && drive.sideways_m_per_s != 0.0 {
            return misfit("drive.sideways_m_per_s", "is not 0, but the vehicle cannot move sideways");
        }
        if drive.lease_s > self.hello.lease_max_s {
            let what =
                format!("{} s, but the vehicle honours {} s at most", drive.lease_s, self.hello.lease_max_s);
            return misfit("drive.lease_s", what);
        }
        Ok(())
    }
}

fn faster(field: &str, value: f64, limit: f64, unit: &str) -> Checked {
    if value.abs() <= limit + COMMAND_SLACK {
        return Ok(());
    }
    misfit(field, format!("{value} {unit} exceeds the vehicle's limit of {limit} {unit}"))
}

fn runs_on(field: &str, newest_s: &mut Option<f64>, stamp_s: f64) -> Checked {
    let newest = newest_s.unwrap_or(stamp_s);
    if newest - stamp_s > BACK_MAX_S {
        return misfit(field, format!("goes back by {:.3} s, from {newest} to {stamp_s}", newest - stamp_s));
    }
    *newest_s = Some(newest.max(stamp_s));
    Ok(())
}

fn moved(limits: &Limits, odometry: &Odometry) -> Checked {
    let over_s = odometry.over_s;
    let most_m = limits.speed_m_per_s * over_s * MEASURED_FACTOR + MEASURED_SLACK_M;
    let most_rad = limits.turn_rad_per_s * over_s * MEASURED_FACTOR + MEASURED_SLACK_RAD;
    let too_far = |field: &str, value: f64, unit: &str, limit: f64| {
        misfit(
            format!("readings.odometry.{field}"),
            format!("{value} {unit} in {over_s} s, but the vehicle's limit is {limit} {unit}/s"),
        )
    };
    if odometry.forward_m.abs() > most_m {
        return too_far("forward_m", odometry.forward_m, "m", limits.speed_m_per_s);
    }
    if odometry.sideways_m.abs() > most_m {
        return too_far("sideways_m", odometry.sideways_m, "m", limits.speed_m_per_s);
    }
    if odometry.turn_rad.abs() > most_rad {
        return too_far("turn_rad", odometry.turn_rad, "rad", limits.turn_rad_per_s);
    }
    Ok(())
}

fn jumped(limits: &Limits, over_s: f64, before: &Pose, pose: &Pose) -> Checked {
    let (x, y) = (pose.x_m - before.x_m, pose.y_m - before.y_m);
    if x.hypot(y) > limits.speed_m_per_s * over_s * MEASURED_FACTOR + MEASURED_SLACK_M {
        let field = if x.abs() >= y.abs() { "readings.pose.x_m" } else { "readings.pose.y_m" };
        let (far, most) = (x.hypot(y), limits.speed_m_per_s);
        return misfit(
            field,
            format!("jumps by {far:.3} m in {over_s:.3} s, but the vehicle's limit is {most} m/s"),
        );
    }
    let turn = (pose.heading_rad - before.heading_rad + PI).rem_euclid(TAU) - PI;
    if turn.abs() > limits.turn_rad_per_s * over_s * MEASURED_FACTOR + MEASURED_SLACK_RAD {
        let most = limits.turn_rad_per_s;
        let what =
            format!("jumps by {turn:.3} rad in {over_s:.3} s, but the vehicle's limit is {most} rad/s");
        return misfit("readings.pose.heading_rad", what);
    }
    Ok(())
}
