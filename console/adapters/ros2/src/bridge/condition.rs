//! The condition of the robot and its middleware, which determines whether the robot can be driven.

use super::FAULT_FOR_S;
use crate::config::Config;
use tankops_adapter::message::{Commander, Mode, State};

/// Age of the newest pose, seconds, above which the vehicle is in the mode `fault`.
const POSE_MAX_AGE_S: f64 = 1.0;
/// Age of the newest scan, seconds, above which a robot that scans is in the mode `fault`.
const SCAN_MAX_AGE_S: f64 = 1.0;

/// The condition of the robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct Condition {
    /// Arrival of the newest pose.
    pub(crate) pose_s: Option<f64>,
    /// Arrival of the newest scan, and why a later one could not be used.
    scan_s: Option<f64>,
    scan_trouble: Option<String>,
    /// Number of subscriptions of the robot that receive the commands.
    pub(crate) subscriptions: usize,
    /// The type of a subscription that cannot read the commands.
    pub(crate) wrong_type: Option<String>,
    /// Number of publishers of commands besides the adapter.
    pub(crate) publishers: usize,
    /// Arrival of the newest command of another program.
    pub(crate) other_command_s: Option<f64>,
    /// The reason why the stop service failed.
    pub(crate) stop_trouble: Option<String>,
    /// Whether the emergency stop is pressed.
    pub(crate) is_stopped: bool,
    /// Whether a person is driving the robot.
    pub(crate) is_manual: bool,
    /// Charge, 0 to 1.
    pub(crate) battery: Option<f64>,
    /// The fault of the last invalid message, and the time until which it counts.
    trouble: Option<(String, f64)>,
}

impl Condition {
    /// Takes the fault of an invalid message.
    pub(crate) fn trouble(&mut self, why: String, now_s: f64) {
        self.trouble = Some((why, now_s + FAULT_FOR_S));
    }

    /// Takes the arrival of a scan, or the reason why it could not be used.
    pub(crate) fn scan(&mut self, taken: Result<(), String>, now_s: f64) {
        if taken.is_ok() {
            self.scan_s = Some(now_s);
        }
        self.scan_trouble = taken.err();
    }

    /// The state to send.
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
            return Some(format!("another program is publishing commands on {topic}"));
        }
        if let Some((why, _)) = self.trouble.as_ref().filter(|(_, until_s)| now_s < *until_s) {
            return Some(why.clone());
        }
        if self.pose_s.is_none_or(|pose_s| now_s - pose_s > POSE_MAX_AGE_S) {
            return Some(format!(
                "no pose is arriving on {}: check topic, type and QoS",
                config.pose_topic()
            ));
        }
        let is_old = self.scan_s.is_none_or(|scan_s| now_s - scan_s > SCAN_MAX_AGE_S);
        if let Some(scan) = config.scan.as_ref().filter(|_| is_old) {
            let topic = &scan.topic;
            let unused = self.scan_trouble.as_ref().map(|why| format!("{topic}: {why}"));
            let missing = || format!("no scan is arriving on {topic}: check topic, type and QoS");
            return Some(unused.unwrap_or_else(missing));
        }
        (self.subscriptions == 0).then(|| match &self.wrong_type {
            Some(kind) => format!("the robot expects {kind} on {topic}: change command.type"),
            None => format!("the robot does not subscribe to {topic}: check topic, type and QoS"),
        })
    }

    /// A text for the operator about a problem that does not keep the vehicle from obeying.
    fn warning(&self, config: &Config) -> Option<String> {
        let topic = &config.command.topic;
        let silent = (self.publishers > 0).then(|| format!("another program could publish on {topic}"));
        silent.or(self.stop_trouble.as_ref().map(|why| format!("the stop service failed: {why}")))
    }
}
