//! The settings file: names, types, QoS and frames. Everything in it is checked before the first message.

mod parts;
#[cfg(test)]
mod tests;

pub(crate) use parts::{
    Command, CommandType, Durability, Mapping, OdometrySource, Qos, Reliability, ScanSource, Source,
    StopService, TfSource,
};

use serde::Deserialize;
use tankops_adapter::{
    message::Has,
    settings::{Settings, Vehicle, above_zero},
};

/// The largest DDS domain whose port numbers are valid.
const DOMAIN_MAX: u16 = 232;

/// All settings.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Config {
    /// The DDS domain; if it is not given, the domain in `ROS_DOMAIN_ID`, or 0.
    pub(crate) domain: Option<u16>,
    /// Name of the adapter's ROS node.
    #[serde(default = "node")]
    pub(crate) node: String,
    /// The description of the vehicle, for `hello`.
    pub(crate) vehicle: Vehicle,
    /// The topic of the commands.
    pub(crate) command: Command,
    /// The topic of the poses: this or `tf`.
    pub(crate) odometry: Option<OdometrySource>,
    /// The topic of the poses: this or `odometry`.
    pub(crate) tf: Option<TfSource>,
    /// `sensor_msgs/LaserScan`.
    pub(crate) scan: Option<ScanSource>,
    /// `std_msgs/Float64MultiArray`: ranges to stations, metres.
    pub(crate) ae: Option<Source>,
    /// `std_msgs/Float64`: length of tether paid out, metres.
    pub(crate) tether: Option<Source>,
    /// `std_msgs/Bool`: whether the bumper is pressed.
    pub(crate) contact: Option<Source>,
    /// `sensor_msgs/BatteryState`.
    pub(crate) battery: Option<Source>,
    /// `std_msgs/Bool`: whether the emergency stop is pressed.
    pub(crate) emergency_stop: Option<Source>,
    /// `std_msgs/Bool`: whether a person is driving by hand.
    pub(crate) manual: Option<Source>,
    /// A service that is called whenever the vehicle must stand still.
    pub(crate) stop: Option<StopService>,
}

fn node() -> String {
    "tankops_adapter".to_owned()
}

impl Settings for Config {
    fn check(&self) -> Result<(), String> {
        if let Some(domain) = self.domain.filter(|domain| *domain > DOMAIN_MAX) {
            return Err(format!("domain: {domain} is out of range: 0 to {DOMAIN_MAX} is allowed"));
        }
        check_token("node", &self.node)?;
        self.vehicle.check()?;
        check_name("command.topic", &self.command.topic)?;
        above_zero("command.period_s", self.command.period_s, self.vehicle.lease_max_s)?;
        match (&self.odometry, &self.tf) {
            (Some(_), None) | (None, Some(_)) => {}
            (None, None) => {
                return Err("odometry: missing; the console needs [odometry] or [tf]".to_owned());
            }
            (Some(_), Some(_)) => return Err("tf: [odometry] is also given; remove one of them".to_owned()),
        }
        for (key, topic, qos) in self.topics() {
            check_name(&format!("{key}.topic"), topic)?;
            qos.check(&format!("{key}.qos"))?;
        }
        if let Some(scan) = &self.scan {
            scan.check()?;
        }
        self.stop.as_ref().map_or(Ok(()), |stop| check_name("stop.service", &stop.service))
    }
}

impl Config {
    /// Every topic with its key and QoS.
    fn topics(&self) -> Vec<(&'static str, &str, &Qos)> {
        let mut topics = vec![("command", self.command.topic.as_str(), &self.command.qos)];
        topics.extend(self.odometry.as_ref().map(|of| ("odometry", of.topic.as_str(), &of.qos)));
        topics.extend(self.tf.as_ref().map(|of| ("tf", of.topic.as_str(), &of.qos)));
        topics.extend(self.scan.as_ref().map(|of| ("scan", of.topic.as_str(), &of.qos)));
        let plain = [
            ("ae", &self.ae),
            ("tether", &self.tether),
            ("contact", &self.contact),
            ("battery", &self.battery),
            ("emergency_stop", &self.emergency_stop),
            ("manual", &self.manual),
        ];
        for (key, source) in plain {
            topics.extend(source.as_ref().map(|of| (key, of.topic.as_str(), &of.qos)));
        }
        topics
    }

    /// The topic of the poses.
    pub(crate) fn pose_topic(&self) -> &str {
        let odometry = self.odometry.as_ref().map(|of| of.topic.as_str());
        odometry.or(self.tf.as_ref().map(|of| of.topic.as_str())).unwrap_or_default()
    }

    /// The parts of the readings.
    pub(crate) fn has(&self) -> Has {
        Has {
            pose: true,
            scan: self.scan.is_some(),
            contact: self.contact.is_some(),
            tether: self.tether.is_some(),
            ae: self.ae.is_some(),
        }
    }
}

/// Checks an absolute name of a topic or a service.
fn check_name(key: &str, name: &str) -> Result<(), String> {
    let Some(tokens) = name.strip_prefix('/') else {
        return Err(format!("{key}: `{name}` does not start with `/`; write the full name"));
    };
    tokens.split('/').try_for_each(|token| {
        check_token(key, token)
            .map_err(|why| if token == tokens { why } else { format!("{why}, in `{name}`") })
    })
}

fn check_token(key: &str, token: &str) -> Result<(), String> {
    let is_good = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if token.is_empty() {
        return Err(format!("{key}: a part of the name is empty"));
    }
    if token.starts_with(|c: char| c.is_ascii_digit()) {
        return Err(format!("{key}: `{token}` starts with a digit"));
    }
    match token.chars().find(|c| !is_good(*c)) {
        Some(c) => Err(format!("{key}: `{token}` contains `{c}`; letters, digits and `_` are allowed")),
        None if token.contains("__") => Err(format!("{key}: `{token}` contains `__`")),
        None => Ok(()),
    }
}
