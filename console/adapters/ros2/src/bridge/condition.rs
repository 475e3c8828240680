//! What the robot and its middleware have told about whether the robot can be driven.

use super::FAULT_FOR_S;
use crate::config::Config;
use tankops_adapter::message::{Commander, Mode, State};

/// Poses older than this are a fault, seconds.
const POSE_MAX_AGE_S: f64 = 1.0;
/// Scans older than this are a fault, seconds, if the robot has any.
const SCAN_MAX_AGE_S: f64 = 1.0;

/// The condition of the robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct Condition {
    /// Arrival of the newest pose.
    pub(crate) pose_s: Option<f64>,
    /// Arrival of the newest scan.
    pub(crate) scan_s: Option<f64>,
    /// Subscriptions of the robot that get the commands.
    pub(crate) subscriptions: usize,
    /// The type of a subscription that cannot read the commands.
    pub(crate) wrong_type: Option<String>,
    /// Publishers of commands beside the adapter.
    pub(crate) publishers: usize,
    /// Arrival of the newest command of another program.
    pub(crate) other_command_s: Option<f64>,
    /// Why the stop service failed.
    pub(crate) stop_trouble: Option<String>,
    /// Whether the emergency stop is pressed.
    pub(crate) is_stopped: bool,
    /// Whether a person drives.
    pub(crate) is_manual: bool,
    /// Charge, 0 to 1.
    pub(crate) battery: Option<f64>,
    /// What is wrong with a message, and until when it counts.
    trouble: Option<(String, f64)>,
}

impl Condition {
    /// A message could not be right.
    pub(crate) fn trouble(&mut self, why: String, now_s: f64) {
        self.trouble = Some((why, now_s + FAULT_FOR_S));
    }

    /// The state to say.
    pub(crate) fn state(&self, config: &Config, now_s: f64) -> State {
        let is_recent = |at_s: f64| now_s - at_s < FAULT_FOR_S;
        let has_other = self.other_command_s.is_some_and(is_recent);
        let (mode, text) = if self.is_stopped {
            (Mode::EmergencyStop, None)
        } else if self.is_manual {
            (Mode::Manual, None)
        } else if let Some(fault) = self.fault(config, has_other, now_s) {
            (Mode::Fault, Some(fault))
        } else {
            (Mode::Ready, self.warning(config))
        };
        let commander = if has_other { Commander::OtherProgram } else { Commander::You };
        State { stamp_s: now_s, mode, text, battery: self.battery, commander }
    }

    fn fault(&self, config: &Config, has_other: bool, now_s: f64) -> Option<String> {
        let topic = &config.command.topic;
        if has_other {
            return Some(format!("another program publishes commands on {topic}"));
        }
        if let Some((why, _)) = self.trouble.as_ref().filter(|(_, until_s)| now_s < *until_s) {
            return Some(why.clone());
        }
        if self.pose_s.is_none_or(|pose_s| now_s - pose_s > POSE_MAX_AGE_S) {
            return Some(format!("no pose arrives on {}: check topic, type and QoS", config.pose_topic()));
        }
        let is_old = self.scan_s.is_none_or(|scan_s| now_s - scan_s > SCAN_MAX_AGE_S);
        if let Some(scan) = config.scan.as_ref().filter(|_| is_old) {
            return Some(format!("no scan arrives on {}: check topic, type and QoS", scan.topic));
        }
        (self.subscriptions == 0).then(|| match &self.wrong_type {
            Some(kind) => format!("the robot listens to {topic} for {kind}: change command.type"),
            None => format!("the robot does not listen to {topic}: check topic, type and QoS"),
        })
    }

    /// What a person should know although the vehicle obeys.
    fn warning(&self, config: &Config) -> Option<String> {
        let topic = &config.command.topic;
        let silent = (self.publishers > 0).then(|| format!("another program could publish on {topic}"));
        silent.or(self.stop_trouble.as_ref().map(|why| format!("the stop service failed: {why}")))
    }
}
