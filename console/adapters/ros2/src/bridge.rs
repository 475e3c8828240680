//! The adapter without its middleware: messages of the console and of the robot in, messages to both out.

use crate::{
    config::Config,
    convert,
    types::{BatteryState, Float64MultiArray, LaserScan, Odometry, Pose, TFMessage, Time},
};
use tankops_adapter::{
    clock::Clock,
    commands::{Commands, Heard, Velocity},
    message::{FromVehicle, Mode, Tether},
    readings::Assembly,
    status::Status,
};

mod condition;
#[cfg(test)]
mod tests;

use condition::Condition;

/// What arrives.
#[derive(Debug, Clone)]
pub(crate) enum Input {
    /// A line from the console; `None` at the end of the connection.
    Console(Option<String>),
    /// From the topic of odometry.
    Odometry(Box<Odometry>),
    /// From the topic of transforms.
    Tf(TFMessage),
    /// From the topic of scans.
    Scan(Box<LaserScan>),
    /// From the topic of ranges.
    Ranges(Float64MultiArray),
    /// Length of tether paid out, metres.
    Tether(f64),
    /// Whether the bumper is pressed.
    Contact(bool),
    /// From the topic of the battery.
    Battery(Box<BatteryState>),
    /// Whether the emergency stop is pressed.
    EmergencyStop(bool),
    /// Whether a person drives.
    Manual(bool),
    /// A command of another publisher.
    OtherCommand,
    /// Other programs on the topic of commands.
    Matched {
        /// Subscriptions that get the commands.
        subscriptions: usize,
        /// Publishers beside the adapter.
        publishers: usize,
    },
    /// The answer of the stop service, or why it did not answer.
    StopAnswered(Result<(), String>),
    /// A message that is not of the type of its topic: which, and why.
    Unreadable(String),
    /// Only time has passed.
    Tick,
}

/// What the shell must do.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Output {
    /// To the console.
    Say(FromVehicle),
    /// To the topic of commands.
    Publish(Velocity),
    /// Call the stop service.
    CallStop,
    /// To standard error.
    Note(String),
    /// The adapter has done its work.
    End,
}

/// Longest time to wait for the robot before `hello`, seconds: the console waits for 10.
const GREET_WITHIN_S: f64 = 5.0;
/// How long a message that cannot be right, or a command of another program, is a fault, seconds.
const FAULT_FOR_S: f64 = 2.0;
/// How long zero is published after the console has left, seconds.
const LEAVE_AFTER_S: f64 = 0.5;

/// The adapter's state.
pub(crate) struct Bridge {
    config: Config,
    commands: Commands,
    clock: Clock,
    readings: Assembly,
    status: Status,
    started_s: f64,
    has_greeted: bool,
    leaves_s: Option<f64>,
    publishes_s: f64,
    /// Whether the velocity that was published last had a lease.
    was_driven: bool,
    condition: Condition,
}

impl Bridge {
    /// Nothing has been heard yet.
    pub(crate) fn new(config: Config, now_s: f64) -> Self {
        let vehicle = &config.vehicle;
        Self {
            commands: Commands::new(vehicle.motion, vehicle.limits(), vehicle.lease_max_s),
            clock: Clock::default(),
            readings: Assembly::new(vehicle.period_s),
            status: Status::default(),
            started_s: now_s,
            has_greeted: false,
            leaves_s: None,
            publishes_s: now_s,
            was_driven: false,
            condition: Condition::default(),
            config,
        }
    }

    /// The time at which the bridge must be called at the latest.
    pub(crate) fn wakes_s(&self) -> f64 {
        let lease_s = self.commands.lease_until_s().filter(|_| self.was_driven);
        lease_s.map_or(self.publishes_s, |lease_s| lease_s.min(self.publishes_s))
    }

    /// Takes what has arrived.
    pub(crate) fn take(&mut self, input: Input, now_s: f64) -> Vec<Output> {
        let mut out = Vec::new();
        match input {
            Input::Console(Some(line)) => self.console(&line, now_s, &mut out),
            Input::Console(None) => self.leave(now_s),
            Input::Odometry(odometry) => self.odometry(&odometry, now_s, &mut out),
            Input::Tf(tf) => self.tf(&tf, now_s, &mut out),
            Input::Scan(scan) => self.scan(&scan, now_s),
            Input::Ranges(array) => {
                let topic = self.config.ae.as_ref().map(|of| of.topic.clone());
                self.readings.parts.ae = self.right(topic, convert::ranges(&array), now_s);
            }
            Input::Tether(paid_out_m) => self.tether(paid_out_m, now_s),
            Input::Contact(is_pressed) => {
                let parts = &mut self.readings.parts;
                parts.contact = Some(parts.contact.unwrap_or(false) || is_pressed);
            }
            Input::Battery(battery) => {
                let charge = f64::from(battery.percentage);
                self.condition.battery = (0.0..=1.0).contains(&charge).then_some(charge);
            }
            Input::EmergencyStop(is_pressed) => self.condition.is_stopped = is_pressed,
            Input::Manual(is_manual) => self.condition.is_manual = is_manual,
            Input::OtherCommand => self.condition.other_command_s = Some(now_s),
            Input::Matched { subscriptions, publishers } => {
                (self.condition.subscriptions, self.condition.publishers) = (subscriptions, publishers);
            }
            Input::Unreadable(why) => self.condition.trouble(why, now_s),
            Input::StopAnswered(answer) => self.condition.stop_trouble = answer.err(),
            Input::Tick => {}
        }
        self.act(now_s, &mut out);
        out
    }

    fn console(&mut self, line: &str, now_s: f64, out: &mut Vec<Output>) {
        match self.commands.hear(line, now_s) {
            Heard::Drive | Heard::Stop => self.publishes_s = now_s,
            Heard::Ping { stamp_s } => {
                out.push(Output::Say(FromVehicle::Pong { echo_s: stamp_s, stamp_s: now_s }));
            }
            Heard::Bye => self.leave(now_s),
            Heard::Nothing => {}
            Heard::Bad(why) => {
                self.publishes_s = now_s;
                out.push(Output::Note(format!("stopped by a bad line: {why}")));
            }
        }
    }

    fn leave(&mut self, now_s: f64) {
        self.commands.stand();
        self.publishes_s = now_s;
        self.leaves_s.get_or_insert(now_s + LEAVE_AFTER_S);
    }

    /// The part of a message, or none if the message cannot be right.
    fn right<T>(&mut self, topic: Option<String>, part: Result<T, String>, now_s: f64) -> Option<T> {
        match part {
            Ok(part) => Some(part),
            Err(why) => {
                let topic = topic.unwrap_or_default();
                self.condition.trouble(format!("{topic}: {why}"), now_s);
                None
            }
        }
    }

    fn odometry(&mut self, odometry: &Odometry, now_s: f64, out: &mut Vec<Output>) {
        let Some(source) = &self.config.odometry else { return };
        let fits = fits("header.frame_id", &odometry.header.frame_id, source.frame.as_ref())
            .and_then(|()| fits("child_frame_id", &odometry.child_frame_id, source.child_frame.as_ref()));
        if self.right(Some(source.topic.clone()), fits, now_s).is_some() {
            self.pose(&odometry.pose.pose, odometry.header.stamp, now_s, out);
        }
    }

    fn tf(&mut self, tf: &TFMessage, now_s: f64, out: &mut Vec<Output>) {
        let Some(source) = &self.config.tf else { return };
        let is_ours = |frame: &str, child: &str| frame == source.frame && child == source.child_frame;
        let ours = tf.transforms.iter().rfind(|of| is_ours(&of.header.frame_id, &of.child_frame_id));
        if let Some(of) = ours {
            self.pose(&of.transform, of.header.stamp, now_s, out);
        }
    }

    fn pose(&mut self, pose: &Pose, stamp: Time, now_s: f64, out: &mut Vec<Output>) {
        let topic = Some(self.config.pose_topic().to_owned());
        let Some(pose) = self.right(topic, convert::pose(pose), now_s) else { return };
        self.condition.pose_s = Some(now_s);
        let measured_s = self.clock.measured_s(stamp.seconds(), now_s);
        // Nothing before the introduction.
        if self.has_greeted {
            out.extend(self.readings.pose(pose, measured_s).map(FromVehicle::Readings).map(Output::Say));
        }
    }

    fn scan(&mut self, scan: &LaserScan, now_s: f64) {
        let Some(source) = &self.config.scan else { return };
        let part = fits("header.frame_id", &scan.header.frame_id, source.frame.as_ref())
            .and_then(|()| convert::scan(scan, source));
        let topic = Some(source.topic.clone());
        self.readings.parts.scan = self.right(topic, part, now_s);
    }

    fn tether(&mut self, paid_out_m: f64, now_s: f64) {
        let is_right = (0.0..=1e4).contains(&paid_out_m);
        let part =
            is_right.then_some(Tether { paid_out_m }).ok_or(format!("data: {paid_out_m} is not a length"));
        let topic = self.config.tether.as_ref().map(|of| of.topic.clone());
        self.readings.parts.tether = self.right(topic, part, now_s);
    }

    /// What is due now, after each message and each tick.
    fn act(&mut self, now_s: f64, out: &mut Vec<Output>) {
        let state = self.condition.state(&self.config, now_s);
        self.greet(state.mode, now_s, out);
        let velocity = self.commands.velocity(now_s).filter(|_| state.mode == Mode::Ready);
        let lapsed = self.was_driven && velocity.is_none();
        if lapsed || now_s >= self.publishes_s {
            out.push(Output::Publish(velocity.unwrap_or_default()));
            self.publishes_s = now_s + self.config.command.period_s;
            self.was_driven = velocity.is_some();
        }
        if lapsed && self.config.stop.is_some() {
            out.push(Output::CallStop);
        }
        if self.has_greeted {
            out.extend(self.status.say(state).map(FromVehicle::State).map(Output::Say));
        }
        if self.leaves_s.is_some_and(|leaves_s| now_s >= leaves_s) {
            out.push(Output::End);
        }
    }

    /// The introduction, once the robot can be driven, or later than expected.
    fn greet(&mut self, mode: Mode, now_s: f64, out: &mut Vec<Output>) {
        let is_due = mode != Mode::Fault || now_s - self.started_s >= GREET_WITHIN_S;
        if !self.has_greeted && is_due {
            self.has_greeted = true;
            out.push(Output::Say(FromVehicle::Hello(self.config.vehicle.hello(self.config.has()))));
        }
    }
}

/// Whether a message is about the frame that the settings name.
fn fits(field: &str, frame: &str, expected: Option<&String>) -> Result<(), String> {
    match expected {
        Some(expected) if expected != frame => {
            Err(format!("{field}: the messages are in frame {frame}, but the settings say {expected}"))
        }
        _ => Ok(()),
    }
}
