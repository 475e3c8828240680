//! The tables of the settings file.

use serde::Deserialize;

/// The topic of the commands.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Command {
    /// The topic.
    #[serde(default = "cmd_vel")]
    pub(crate) topic: String,
    /// The type of its messages, in the package `geometry_msgs`.
    #[serde(rename = "type")]
    pub(crate) kind: CommandType,
    /// `frame_id` of a stamped command.
    #[serde(default = "base_link")]
    pub(crate) frame: String,
    /// Time after which the command is published again, seconds.
    #[serde(default = "command_period")]
    pub(crate) period_s: f64,
    /// QoS of the publisher.
    #[serde(default = "Qos::of_commands")]
    pub(crate) qos: Qos,
}

fn cmd_vel() -> String {
    "/cmd_vel".to_owned()
}

fn base_link() -> String {
    "base_link".to_owned()
}

fn command_period() -> f64 {
    0.05
}

/// The type of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub(crate) enum CommandType {
    /// `geometry_msgs/Twist`
    Twist,
    /// `geometry_msgs/TwistStamped`
    TwistStamped,
}

/// A topic to which the adapter subscribes.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Source {
    /// The topic.
    pub(crate) topic: String,
    /// QoS of the subscription.
    #[serde(default = "Qos::of_sensors")]
    pub(crate) qos: Qos,
}

/// `nav_msgs/Odometry`
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct OdometrySource {
    /// The topic.
    pub(crate) topic: String,
    /// `frame_id` that its messages must have, if given.
    pub(crate) frame: Option<String>,
    /// `child_frame_id` that its messages must have, if given: the frame of the hull's centre.
    pub(crate) child_frame: Option<String>,
    /// QoS of the subscription.
    #[serde(default = "Qos::of_sensors")]
    pub(crate) qos: Qos,
}

/// `tf2_msgs/TFMessage`
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TfSource {
    /// The topic.
    #[serde(default = "tf")]
    pub(crate) topic: String,
    /// The fixed frame.
    pub(crate) frame: String,
    /// The frame of the hull's centre. Its transform from `frame` must be published directly.
    pub(crate) child_frame: String,
    /// QoS of the subscription.
    #[serde(default = "Qos::of_sensors")]
    pub(crate) qos: Qos,
}

fn tf() -> String {
    "/tf".to_owned()
}

/// `sensor_msgs/LaserScan`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ScanSource {
    /// The topic.
    pub(crate) topic: String,
    /// `frame_id` that its messages must have, if given.
    pub(crate) frame: Option<String>,
    /// Position of the sensor in the robot frame, metres ahead.
    #[serde(default)]
    pub(crate) ahead_m: f64,
    /// Position of the sensor in the robot frame, metres to the left.
    #[serde(default)]
    pub(crate) left_m: f64,
    /// Direction of the sensor's x axis in the robot frame, degrees, counter-clockwise.
    #[serde(default)]
    pub(crate) turned_deg: f64,
    /// Whether the sensor is mounted upside down, so that its angles are clockwise when seen from above.
    #[serde(default)]
    pub(crate) upside_down: bool,
    /// QoS of the subscription.
    #[serde(default = "Qos::of_sensors")]
    pub(crate) qos: Qos,
}

/// Longest distance of a sensor from the centre of the hull, metres.
const MOUNTED_MAX_M: f64 = 10.0;

impl ScanSource {
    pub(super) fn check(&self) -> Result<(), String> {
        let within = |key: &str, value: f64, most: f64| {
            if value.abs() <= most {
                return Ok(());
            }
            Err(format!("scan.{key}: {value} is not between -{most} and {most}"))
        };
        within("ahead_m", self.ahead_m, MOUNTED_MAX_M)?;
        within("left_m", self.left_m, MOUNTED_MAX_M)?;
        within("turned_deg", self.turned_deg, 360.0)
    }
}

/// `std_srvs/Trigger`
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StopService {
    /// Name of the service.
    pub(crate) service: String,
    /// How the middleware of the robot maps services to topics.
    #[serde(default)]
    pub(crate) mapping: Mapping,
}

/// How services are mapped to topics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Mapping {
    /// `rmw_fastrtps_cpp` and `rmw_connextdds`.
    #[default]
    Enhanced,
    /// `rmw_cyclonedds_cpp`.
    Cyclone,
    /// The basic mapping of RPC over DDS.
    Basic,
}

/// Quality of service. Both sides must agree: a reliable subscription does not match a publisher that is best effort,
/// and a subscription that is transient local does not match a publisher that is volatile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Qos {
    /// Whether lost samples are sent again.
    pub(crate) reliability: Reliability,
    /// Whether late subscribers receive old samples.
    #[serde(default)]
    pub(crate) durability: Durability,
    /// Number of samples that are kept.
    #[serde(default = "depth")]
    pub(crate) depth: u16,
}

/// Whether lost samples are sent again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Reliability {
    /// Lost samples are sent again.
    Reliable,
    /// Lost samples are not sent again.
    BestEffort,
}

/// Whether late subscribers receive old samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Durability {
    /// Late subscribers do not receive old samples.
    #[default]
    Volatile,
    /// Late subscribers receive old samples.
    TransientLocal,
}

fn depth() -> u16 {
    10
}

impl Qos {
    /// QoS of the publisher of commands: it matches every subscriber, and it does not keep old commands.
    fn of_commands() -> Self {
        Self { reliability: Reliability::Reliable, durability: Durability::Volatile, depth: 1 }
    }

    /// QoS of a subscription that matches every publisher.
    pub(crate) fn of_sensors() -> Self {
        Self { reliability: Reliability::BestEffort, durability: Durability::Volatile, depth: depth() }
    }

    pub(super) fn check(self, key: &str) -> Result<(), String> {
        if self.depth == 0 {
            return Err(format!("{key}.depth: 0 samples can hold no message; at least 1 is needed"));
        }
        Ok(())
    }
}
