//! The ROS 2 messages that are written, with their definitions in `ros2msg` form.

use world::Pose;

/// The frame of all messages.
pub(super) const FRAME: &str = "tank";

/// A ROS time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp {
    pub sec: i32,
    pub nanosec: u32,
}

impl Stamp {
    /// Converts a mission time, seconds.
    pub(super) fn of(t_s: f64) -> Self {
        let nanoseconds = (t_s.max(0.0) * 1e9).round() as u64;
        Self { sec: (nanoseconds / 1_000_000_000) as i32, nanosec: (nanoseconds % 1_000_000_000) as u32 }
    }

    pub(super) fn nanoseconds(self) -> u64 {
        self.sec as u64 * 1_000_000_000 + u64::from(self.nanosec)
    }
}

/// Position and quaternion: x, y, z and x, y, z, w.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pose3(pub [f64; 7]);

impl Pose3 {
    pub(super) fn of(Pose { position, heading_rad }: Pose) -> Self {
        let (sin, cos) = (heading_rad / 2.0).sin_cos();
        Self([position.x, position.y, 0.0, 0.0, 0.0, sin, cos])
    }
}

/// A message type.
#[derive(Debug, Clone, Copy)]
pub(super) struct Schema {
    /// Package and name.
    pub name: &'static str,
    own: &'static str,
    /// The types that this type uses.
    parts: &'static [&'static (&'static str, &'static str)],
}

impl Schema {
    /// The definition, followed by the definitions of the types that this type uses.
    pub(super) fn text(self) -> String {
        let part = |(name, text): &(&str, &str)| format!("{}\nMSG: {name}\n{text}", "=".repeat(80));
        self.own.to_owned() + &self.parts.iter().map(|named| part(named)).collect::<String>()
    }
}

type Part = (&'static str, &'static str);

const TIME: Part = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
const HEADER: Part = ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n");
const POINT_FIELD: Part =
    ("sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n");
/// The fields of a reading in a point cloud: name, offset in bytes, and type (7: 32-bit float, 4: 16-bit unsigned
/// number, 2: byte). `z` is 0.
pub(super) const POINT_FIELDS: [(&str, u32, u8); 6] =
    [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("thickness_mm", 12, 7), ("channel", 16, 4), ("testable", 18, 2)];
/// Length of a reading in a point cloud, bytes.
pub(super) const POINT_BYTES: u32 = 20;
const POINT: Part = ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n");
const QUATERNION: Part = ("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
const POSE_PART: Part =
    ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n");
const POSE_STAMPED: Part = ("geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n");
const COVARIANCE: Part =
    ("geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n");
const GRID_DATA: Part = (
    "nav_msgs/MapMetaData",
    "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\ngeometry_msgs/Pose origin\n",
);

pub(super) const POSE: Schema = Schema {
    name: "geometry_msgs/msg/PoseStamped",
    own: POSE_STAMPED.1,
    parts: &[&HEADER, &TIME, &POSE_PART, &POINT, &QUATERNION],
};
pub(super) const POSE_WITH_COVARIANCE: Schema = Schema {
    name: "geometry_msgs/msg/PoseWithCovarianceStamped",
    own: "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n",
    parts: &[&HEADER, &TIME, &COVARIANCE, &POSE_PART, &POINT, &QUATERNION],
};
pub(super) const PATH: Schema = Schema {
    name: "nav_msgs/msg/Path",
    own: "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n",
    parts: &[&HEADER, &TIME, &POSE_STAMPED, &POSE_PART, &POINT, &QUATERNION],
};
pub(super) const GRID: Schema = Schema {
    name: "nav_msgs/msg/OccupancyGrid",
    own: "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n",
    parts: &[&HEADER, &TIME, &GRID_DATA, &POSE_PART, &POINT, &QUATERNION],
};
pub(super) const POINTS: Schema = Schema {
    name: "sensor_msgs/msg/PointCloud2",
    own: "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
    parts: &[&HEADER, &TIME, &POINT_FIELD],
};
pub(super) const LOG: Schema = Schema {
    name: "rcl_interfaces/msg/Log",
    own: "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\nuint32 line\n",
    parts: &[&TIME],
};
