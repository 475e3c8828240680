//! The console's commands and their lease, which determine the current velocity.

use crate::message::{Drive, Limits, Motion, ToVehicle};

/// A velocity in the robot frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Velocity {
    /// Metres per second.
    pub forward_m_per_s: f64,
    /// Metres per second, to the left.
    pub sideways_m_per_s: f64,
    /// Radians per second, counter-clockwise.
    pub turn_rad_per_s: f64,
}

impl Velocity {
    /// Standing still.
    pub const ZERO: Self = Self { forward_m_per_s: 0.0, sideways_m_per_s: 0.0, turn_rad_per_s: 0.0 };
}

/// The meaning of a line from the console.
#[derive(Debug, Clone, PartialEq)]
pub enum Heard {
    /// A new velocity applies.
    Drive,
    /// The vehicle must stand still.
    Stop,
    /// A ping to answer at once.
    Ping {
        /// `stamp_s` of the ping.
        stamp_s: f64,
    },
    /// The console leaves; the vehicle stands still.
    Bye,
    /// Nothing to do: a late or outdated command, an empty line or an unknown kind of message.
    Nothing,
    /// Not a valid command: the vehicle stands still. The text states the reason.
    Bad(String),
}

/// The commands of a console, folded line by line.
#[derive(Debug, Clone)]
pub struct Commands {
    motion: Motion,
    limits: Limits,
    lease_max_s: f64,
    /// Least time from a stamp to its arrival: the offset of the console's clock plus the shortest delay, seconds.
    least_s: f64,
    /// Greatest number of a command so far.
    newest: Option<u64>,
    /// The last velocity, and the time at which its lease lapses, seconds.
    lease: Option<(Velocity, f64)>,
}

/// Increase of the least time per message, seconds, so that it follows clocks that drift. It is so small that commands
/// that wait in a queue stay late for as long as the queue lasts.
const DRIFT_S: f64 = 1e-4;
/// Tolerance for limits, because they are converted to decimal numbers and back.
const SLACK: f64 = 1e-9;

impl Commands {
    /// The state before the first command: the vehicle stands still.
    pub fn new(motion: Motion, limits: Limits, lease_max_s: f64) -> Self {
        Self { motion, limits, lease_max_s, least_s: f64::INFINITY, newest: None, lease: None }
    }

    /// Takes a line from the console.
    pub fn hear(&mut self, line: &str, now_s: f64) -> Heard {
        if line.trim().is_empty() {
            return Heard::Nothing;
        }
        let message = serde_json::from_str(line).map_err(|error| error.to_string());
        match message.and_then(|message| self.message(message, now_s)) {
            Ok(heard) => heard,
            Err(why) => {
                self.stand();
                Heard::Bad(why)
            }
        }
    }

    fn message(&mut self, message: ToVehicle, now_s: f64) -> Result<Heard, String> {
        match message {
            ToVehicle::Drive(drive) if self.is_new(drive.seq) => {
                let velocity = self.checked(&drive)?;
                // It waited while the adapter was stopped or busy; the console may be gone by now.
                if self.age_s(drive.stamp_s, now_s) > drive.lease_s {
                    return Ok(Heard::Nothing);
                }
                self.lease = Some((velocity, now_s + drive.lease_s));
                Ok(Heard::Drive)
            }
            ToVehicle::Stop { seq, stamp_s } if self.is_new(seq) => {
                stamp_s.map(|stamp_s| self.age_s(stamp_s, now_s));
                self.stand();
                Ok(Heard::Stop)
            }
            ToVehicle::Ping { stamp_s } => {
                self.age_s(stamp_s, now_s);
                Ok(Heard::Ping { stamp_s })
            }
            ToVehicle::Bye => {
                self.stand();
                Ok(Heard::Bye)
            }
            ToVehicle::Drive(_) | ToVehicle::Stop { .. } | ToVehicle::Unknown => Ok(Heard::Nothing),
        }
    }

    /// Time since a message was sent, beyond the shortest delay, seconds.
    fn age_s(&mut self, stamp_s: f64, now_s: f64) -> f64 {
        let late_s = now_s - stamp_s;
        self.least_s = late_s.min(self.least_s + DRIFT_S);
        late_s - self.least_s
    }

    fn is_new(&mut self, seq: u64) -> bool {
        let is_new = self.newest.is_none_or(|newest| seq > newest);
        if is_new {
            self.newest = Some(seq);
        }
        is_new
    }

    fn checked(&self, drive: &Drive) -> Result<Velocity, String> {
        let within = |key: &str, value: f64, most: f64| {
            if value.abs() <= most + SLACK {
                return Ok(());
            }
            Err(format!("drive.{key}: {value} is beyond the limit of {most}"))
        };
        let sideways_max = if self.motion == Motion::Omni { self.limits.speed_m_per_s } else { 0.0 };
        within("forward_m_per_s", drive.forward_m_per_s, self.limits.speed_m_per_s)?;
        within("sideways_m_per_s", drive.sideways_m_per_s, sideways_max)?;
        within("turn_rad_per_s", drive.turn_rad_per_s, self.limits.turn_rad_per_s)?;
        if !(drive.lease_s > 0.0 && drive.lease_s <= self.lease_max_s) {
            let most = self.lease_max_s;
            return Err(format!(
                "drive.lease_s: {} is out of range: greater than 0 and at most {most} is allowed",
                drive.lease_s
            ));
        }
        Ok(Velocity {
            forward_m_per_s: drive.forward_m_per_s,
            sideways_m_per_s: drive.sideways_m_per_s,
            turn_rad_per_s: drive.turn_rad_per_s,
        })
    }

    /// Ends the lease.
    pub fn stand(&mut self) {
        self.lease = None;
    }

    /// The current velocity; `None` without a lease, because the vehicle must then stand still.
    pub fn velocity(&self, now_s: f64) -> Option<Velocity> {
        self.lease.filter(|(_, until_s)| now_s < *until_s).map(|(velocity, _)| velocity)
    }

    /// The time at which the lease lapses, if there is one.
    pub fn lease_until_s(&self) -> Option<f64> {
        self.lease.map(|(_, until_s)| until_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn commands() -> Commands {
        let limits =
            Limits { speed_m_per_s: 0.4, turn_rad_per_s: 1.0, acceleration_m_per_s2: 0.5, radius_m: 0.2 };
        Commands::new(Motion::Unicycle, limits, 0.5)
    }

    fn drive(seq: u64, forward: f64) -> String {
        format!(
            r#"{{"type": "drive", "seq": {seq}, "stamp_s": 0, "lease_s": 0.25, "forward_m_per_s": {forward}, "turn_rad_per_s": 0.5}}"#
        )
    }

    #[test]
    fn a_drive_holds_until_its_lease_lapses() {
        let mut commands = commands();
        assert_eq!(commands.velocity(10.0), None);
        assert_eq!(commands.hear(&drive(1, 0.3), 10.0), Heard::Drive);
        assert_eq!(commands.velocity(10.2).map(|v| v.forward_m_per_s), Some(0.3));
        assert_eq!(commands.lease_until_s(), Some(10.25));
        assert_eq!(commands.velocity(10.25), None);
    }

    #[test]
    fn a_drive_that_is_older_than_its_lease_is_ignored() {
        let mut commands = commands();
        let stamped = |seq: u64, stamp_s: f64| {
            drive(seq, 0.3).replace("\"stamp_s\": 0", &format!("\"stamp_s\": {stamp_s}"))
        };
        commands.hear(r#"{"type": "ping", "stamp_s": 500}"#, 10.0);
        assert_eq!(commands.hear(&stamped(1, 500.1), 10.3), Heard::Drive, "0.2 s late");
        // The adapter was stopped for 20 s; meanwhile, two commands arrived.
        assert_eq!(commands.hear(&stamped(2, 500.4), 30.0), Heard::Nothing);
        assert_eq!(commands.hear(&stamped(3, 519.7), 30.0), Heard::Nothing);
        assert_eq!(commands.velocity(30.0), None);
        assert_eq!(commands.hear(&stamped(4, 520.0), 30.01), Heard::Drive);
    }

    #[test]
    fn drives_that_wait_in_a_standing_queue_stay_late() {
        let mut commands = commands();
        let stamped = |seq: u32, stamp_s: f64| {
            drive(seq.into(), 0.3).replace("\"stamp_s\": 0", &format!("\"stamp_s\": {stamp_s}"))
        };
        assert_eq!(commands.hear(&stamped(1, 0.0), 500.0), Heard::Drive);
        // For a minute, each line arrives 2 s after it was sent; commands and pings wait in the same queue.
        for n in 2..1200 {
            let sent_s = 0.05 * f64::from(n);
            commands.hear(&format!(r#"{{"type": "ping", "stamp_s": {sent_s}}}"#), 502.0 + sent_s);
            assert_eq!(commands.hear(&stamped(n, sent_s), 502.0 + sent_s), Heard::Nothing, "{sent_s}");
        }
        assert_eq!(commands.hear(&stamped(2000, 100.0), 600.1), Heard::Drive);
    }

    #[test]
    fn a_clock_that_drifts_is_followed() {
        let mut commands = commands();
        for n in 1..10_000_u32 {
            let sent_s = 0.05 * f64::from(n);
            let line = drive(n.into(), 0.3).replace("\"stamp_s\": 0", &format!("\"stamp_s\": {sent_s}"));
            assert_eq!(commands.hear(&line, 1.001 * sent_s), Heard::Drive, "{sent_s}");
        }
    }

    #[test]
    fn a_late_drive_does_not_undo_a_stop() {
        let mut commands = commands();
        commands.hear(&drive(5, 0.3), 0.0);
        assert_eq!(commands.hear(r#"{"type": "stop", "seq": 7}"#, 0.1), Heard::Stop);
        assert_eq!(commands.hear(&drive(6, 0.3), 0.1), Heard::Nothing);
        assert_eq!(commands.velocity(0.1), None);
    }

    #[test]
    fn a_bad_line_stops_the_vehicle_and_names_the_field() {
        let lines = [
            (drive(2, 0.5), "drive.forward_m_per_s: 0.5 is beyond the limit of 0.4"),
            (
                drive(2, 0.3).replace("0.25", "0.6"),
                "drive.lease_s: 0.6 is out of range: greater than 0 and at most 0.5 is allowed",
            ),
            (drive(2, 0.3).replace("0.25", "0"), "drive.lease_s: 0 is out of range"),
            (drive(2, 0.3).replace("\"turn", "\"sideways_m_per_s\": 0.1, \"turn"), "drive.sideways_m_per_s"),
            (drive(2, 0.3).replace("0.3", "NaN"), "expected value"),
            (drive(2, 0.3)[..40].to_owned(), "EOF"),
            (r#"{"type": "drive", "seq": 2, "stamp_s": 0}"#.to_owned(), "missing field `lease_s`"),
            (drive(2, 0.3).replace("\"stamp_s\": 0, ", ""), "missing field `stamp_s`"),
            ("hello".to_owned(), "expected value"),
        ];
        for (line, why) in lines {
            let mut commands = commands();
            commands.hear(&drive(1, 0.3), 0.0);
            let heard = commands.hear(&line, 0.1);
            assert!(matches!(&heard, Heard::Bad(text) if text.contains(why)), "{line}: {heard:?}");
            assert_eq!(commands.velocity(0.1), None, "{line}");
        }
    }

    #[test]
    fn pings_unknown_kinds_and_byes() {
        let mut commands = commands();
        commands.hear(&drive(1, 0.3), 0.0);
        assert_eq!(commands.hear(r#"{"type": "ping", "stamp_s": 4.5}"#, 0.1), Heard::Ping { stamp_s: 4.5 });
        assert_eq!(commands.hear(r#"{"type": "lights", "on": true}"#, 0.1), Heard::Nothing);
        assert_eq!(commands.velocity(0.1).map(|v| v.forward_m_per_s), Some(0.3));
        assert_eq!(commands.hear(r#"{"type": "bye"}"#, 0.1), Heard::Bye);
        assert_eq!(commands.velocity(0.1), None);
    }

    #[test]
    fn an_omni_vehicle_moves_sideways() {
        let mut commands = commands();
        commands.motion = Motion::Omni;
        let line = drive(1, 0.3).replace("\"turn", "\"sideways_m_per_s\": -0.1, \"turn");
        assert_eq!(commands.hear(&line, 0.0), Heard::Drive);
        assert_eq!(commands.velocity(0.1).map(|v| v.sideways_m_per_s), Some(-0.1));
    }
}
