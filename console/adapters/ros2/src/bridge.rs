//! The adapter without its middleware: it receives messages from the console and the robot, and returns messages to
//! both.

use crate::{
    config::Config,
    convert,
    types::{BatteryState, Float64MultiArray, LaserScan, Odometry, Pose, TFMessage, Time},
};
use tankops_adapter::{
    clock::Clock,
    message::{self, FromVehicle, Tether},
    pilot::{Order, Pilot},
    readings::{Assembly, Measured},
};

mod condition;
#[cfg(test)]
mod tests;

use condition::Condition;

/// An input to the adapter.
#[derive(Debug, Clone)]
pub(crate) enum Input {
    /// A line from the console; `None` at the end of the connection.
    Console(Option<String>),
    /// A message from the topic of odometry.
    Odometry(Box<Odometry>),
    /// A message from the topic of transforms.
    Tf(TFMessage),
    /// A message from the topic of scans.
    Scan(Box<LaserScan>),
    /// A message from the topic of ranges.
    Ranges(Float64MultiArray),
    /// Length of tether paid out, metres.
    Tether(f64),
    /// Whether the bumper is pressed.
    Contact(bool),
    /// A message from the topic of the battery.
    Battery(Box<BatteryState>),
    /// Whether the emergency stop is pressed.
    EmergencyStop(bool),
    /// Whether a person is driving the robot.
    Manual(bool),
    /// A command of another publisher.
    OtherCommand,
    /// Other programs on the topic of commands.
    Matched {
        /// Number of subscriptions that receive the commands.
        subscriptions: usize,
        /// Number of publishers besides the adapter.
        publishers: usize,
        /// The type of a subscription that cannot read the commands, if there is one.
        wrong_type: Option<String>,
    },
    /// The answer of the stop service, or why it did not answer.
    StopAnswered(Result<(), String>),
    /// A message that does not have the type of its topic; the text states the topic and the reason.
    Unreadable(String),
    /// Only time has passed.
    Tick,
}

/// Time for which an invalid message, or a command of another program, counts as a fault, seconds.
const FAULT_FOR_S: f64 = 2.0;
/// The adapter's state.
pub(crate) struct Bridge {
    config: Config,
    pilot: Pilot,
    clock: Clock,
    readings: Assembly,
    condition: Condition,
    /// The newest pose and its time, until the pose is sent; before the introduction, no readings are sent.
    pose: Option<(message::Pose, Measured)>,
}

impl Bridge {
    /// Creates an adapter that has not received any message yet.
    pub(crate) fn new(config: Config, now_s: f64) -> Self {
        Self {
            pilot: Pilot::new(&config.vehicle, config.has(), config.command.period_s, now_s),
            clock: Clock::default(),
            readings: Assembly::new(config.vehicle.period_s),
            condition: Condition::default(),
            pose: None,
            config,
        }
    }

    /// The time at which the bridge must be called at the latest.
    pub(crate) fn wakes_s(&self) -> f64 {
        self.pilot.wakes_s()
    }

    /// Processes an input, and returns the messages to send.
    pub(crate) fn take(&mut self, input: Input, now_s: f64) -> Vec<Order> {
        let mut out = Vec::new();
        match input {
            Input::Console(line) => self.pilot.hear(line.as_deref(), now_s, &mut out),
            Input::Odometry(odometry) => self.odometry(&odometry, now_s),
            Input::Tf(tf) => self.tf(&tf, now_s),
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
            Input::Matched { subscriptions, publishers, wrong_type } => {
                self.condition.subscriptions = subscriptions;
                self.condition.publishers = publishers;
                self.condition.wrong_type = wrong_type;
            }
            Input::Unreadable(why) => self.condition.trouble(why, now_s),
            Input::StopAnswered(answer) => self.condition.stop_trouble = answer.err(),
            Input::Tick => {}
        }
        let state = self.condition.state(&self.config, now_s);
        self.pilot.act(state, now_s, &mut out);
        if let Some((pose, time)) = self.pose.take_if(|_| self.pilot.has_greeted()) {
            out.extend(self.readings.pose(pose, time).map(FromVehicle::Readings).map(Order::Say));
        }
        out
    }

    /// The part of a message; `None` if the message is invalid.
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

    fn odometry(&mut self, odometry: &Odometry, now_s: f64) {
        let Some(source) = &self.config.odometry else { return };
        let fits = fits("header.frame_id", &odometry.header.frame_id, source.frame.as_ref())
            .and_then(|()| fits("child_frame_id", &odometry.child_frame_id, source.child_frame.as_ref()));
        if self.right(Some(source.topic.clone()), fits, now_s).is_some() {
            self.pose(&odometry.pose.pose, odometry.header.stamp, now_s);
        }
    }

    fn tf(&mut self, tf: &TFMessage, now_s: f64) {
        let Some(source) = &self.config.tf else { return };
        let is_ours = |frame: &str, child: &str| frame == source.frame && child == source.child_frame;
        let ours = tf.transforms.iter().rfind(|of| is_ours(&of.header.frame_id, &of.child_frame_id));
        if let Some(of) = ours {
            self.pose(&of.transform, of.header.stamp, now_s);
        }
    }

    fn pose(&mut self, pose: &Pose, stamp: Time, now_s: f64) {
        let topic = Some(self.config.pose_topic().to_owned());
        let Some(pose) = self.right(topic, convert::pose(pose), now_s) else { return };
        self.condition.pose_s = Some(now_s);
        let stamp_s = stamp.seconds();
        let at_s = self.clock.measured_s(stamp_s, now_s);
        self.pose = Some((pose, Measured { stamp_s: stamp_s.unwrap_or(at_s), at_s }));
    }

    fn scan(&mut self, scan: &LaserScan, now_s: f64) {
        let Some(source) = &self.config.scan else { return };
        let part = fits("header.frame_id", &scan.header.frame_id, source.frame.as_ref())
            .and_then(|()| convert::scan(scan, source));
        let topic = Some(source.topic.clone());
        let Some(part) = self.right(topic, part, now_s) else { return };
        self.condition.scan(self.readings.scan(part, scan.header.stamp.seconds()), now_s);
    }

    fn tether(&mut self, paid_out_m: f64, now_s: f64) {
        let is_right = (0.0..=1e4).contains(&paid_out_m);
        let part =
            is_right.then_some(Tether { paid_out_m }).ok_or(format!("data: {paid_out_m} is not a length"));
        let topic = self.config.tether.as_ref().map(|of| of.topic.clone());
        self.readings.parts.tether = self.right(topic, part, now_s);
    }
}

/// Whether a message is about the frame that the settings name.
fn fits(field: &str, frame: &str, expected: Option<&String>) -> Result<(), String> {
    match expected {
        Some(expected) if expected != frame => {
            Err(format!("{field}: the messages are in frame `{frame}`, but the settings state `{expected}`"))
        }
        _ => Ok(()),
    }
}
