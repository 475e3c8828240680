//! The ROS 2 messages that this adapter reads and writes, field by field in the order of their definitions: CDR has no
//! names.

use serde::{Deserialize, Serialize};

/// A message of a topic.
pub(crate) trait Typed: ros2_client::Message {
    /// Package and name of the type.
    const TYPE: (&'static str, &'static str);
}

macro_rules! typed {
    ($($package:literal: $($kind:ident),+;)+) => {
        $($(
            impl ros2_client::Message for $kind {}
            impl Typed for $kind {
                const TYPE: (&'static str, &'static str) = ($package, stringify!($kind));
            }
        )+)+
    };
}

typed! {
    "geometry_msgs": Twist, TwistStamped;
    "nav_msgs": Odometry;
    "sensor_msgs": LaserScan, BatteryState;
    "std_msgs": Float64MultiArray, Float64, Bool;
    "tf2_msgs": TFMessage;
}

/// `builtin_interfaces/Time`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Time {
    pub(crate) sec: i32,
    pub(crate) nanosec: u32,
}

impl Time {
    /// The time in seconds; `None` for a message that was not stamped.
    pub(crate) fn seconds(self) -> Option<f64> {
        (self != Self::default()).then(|| f64::from(self.sec) + 1e-9 * f64::from(self.nanosec))
    }
}

/// `std_msgs/Header`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Header {
    pub(crate) stamp: Time,
    pub(crate) frame_id: String,
}

/// `geometry_msgs/Vector3`, and `geometry_msgs/Point`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Vector3 {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) z: f64,
}

/// `geometry_msgs/Quaternion`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Quaternion {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) z: f64,
    pub(crate) w: f64,
}

/// `geometry_msgs/Twist`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Twist {
    pub(crate) linear: Vector3,
    pub(crate) angular: Vector3,
}

/// `geometry_msgs/TwistStamped`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TwistStamped {
    pub(crate) header: Header,
    pub(crate) twist: Twist,
}

/// A matrix of 6 x 6. `serde` has no arrays that long.
pub(crate) type Covariance = ([f64; 32], [f64; 4]);

/// `geometry_msgs/Pose`, and `geometry_msgs/Transform`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Pose {
    pub(crate) position: Vector3,
    pub(crate) orientation: Quaternion,
}

/// `geometry_msgs/PoseWithCovariance`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct PoseWithCovariance {
    pub(crate) pose: Pose,
    pub(crate) covariance: Covariance,
}

/// `geometry_msgs/TwistWithCovariance`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TwistWithCovariance {
    pub(crate) twist: Twist,
    pub(crate) covariance: Covariance,
}

/// `nav_msgs/Odometry`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Odometry {
    pub(crate) header: Header,
    pub(crate) child_frame_id: String,
    pub(crate) pose: PoseWithCovariance,
    pub(crate) twist: TwistWithCovariance,
}

/// `geometry_msgs/TransformStamped`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TransformStamped {
    pub(crate) header: Header,
    pub(crate) child_frame_id: String,
    pub(crate) transform: Pose,
}

/// `tf2_msgs/TFMessage`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TFMessage {
    pub(crate) transforms: Vec<TransformStamped>,
}

/// `sensor_msgs/LaserScan`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct LaserScan {
    pub(crate) header: Header,
    pub(crate) angle_min: f32,
    pub(crate) angle_max: f32,
    pub(crate) angle_increment: f32,
    pub(crate) time_increment: f32,
    pub(crate) scan_time: f32,
    pub(crate) range_min: f32,
    pub(crate) range_max: f32,
    pub(crate) ranges: Vec<f32>,
    pub(crate) intensities: Vec<f32>,
}

/// `sensor_msgs/BatteryState`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct BatteryState {
    pub(crate) header: Header,
    pub(crate) voltage: f32,
    pub(crate) temperature: f32,
    pub(crate) current: f32,
    pub(crate) charge: f32,
    pub(crate) capacity: f32,
    pub(crate) design_capacity: f32,
    pub(crate) percentage: f32,
    pub(crate) power_supply_status: u8,
    pub(crate) power_supply_health: u8,
    pub(crate) power_supply_technology: u8,
    pub(crate) present: bool,
    pub(crate) cell_voltage: Vec<f32>,
    pub(crate) cell_temperature: Vec<f32>,
    pub(crate) location: String,
    pub(crate) serial_number: String,
}

/// `std_msgs/MultiArrayDimension`
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Dimension {
    pub(crate) label: String,
    pub(crate) size: u32,
    pub(crate) stride: u32,
}

/// `std_msgs/MultiArrayLayout`
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Layout {
    pub(crate) dim: Vec<Dimension>,
    pub(crate) data_offset: u32,
}

/// `std_msgs/Float64MultiArray`
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Float64MultiArray {
    pub(crate) layout: Layout,
    pub(crate) data: Vec<f64>,
}

/// `std_msgs/Float64`
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Float64 {
    pub(crate) data: f64,
}

/// `std_msgs/Bool`
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Bool {
    pub(crate) data: bool,
}

/// The request of `std_srvs/Trigger`: an empty structure has one byte in CDR.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct TriggerRequest {
    pub(crate) structure_needs_at_least_one_member: u8,
}

/// The response of `std_srvs/Trigger`
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct TriggerResponse {
    pub(crate) success: bool,
    pub(crate) message: String,
}

impl ros2_client::Message for TriggerRequest {}
impl ros2_client::Message for TriggerResponse {}
