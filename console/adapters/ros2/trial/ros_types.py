"""The ROS 2 messages of the trial, as Cyclone DDS sees them: structures with mangled names, fields in their order."""
from dataclasses import dataclass, field

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float32, float64, int32, sequence, uint8, uint32


def ros(name):
    package, kind, message = name.split("/")
    return f"{package}::{kind}::dds_::{message}_"


@dataclass
class Time(IdlStruct, typename=ros("builtin_interfaces/msg/Time")):
    sec: int32 = 0
    nanosec: uint32 = 0


@dataclass
class Header(IdlStruct, typename=ros("std_msgs/msg/Header")):
    stamp: Time
    frame_id: str


@dataclass
class Vector3(IdlStruct, typename=ros("geometry_msgs/msg/Vector3")):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
class Twist(IdlStruct, typename=ros("geometry_msgs/msg/Twist")):
    linear: Vector3 = field(default_factory=Vector3)
    angular: Vector3 = field(default_factory=Vector3)


@dataclass
class TwistStamped(IdlStruct, typename=ros("geometry_msgs/msg/TwistStamped")):
    header: Header
    twist: Twist


@dataclass
class Point(IdlStruct, typename=ros("geometry_msgs/msg/Point")):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
class Quaternion(IdlStruct, typename=ros("geometry_msgs/msg/Quaternion")):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0
    w: float64 = 1.0


@dataclass
class Pose(IdlStruct, typename=ros("geometry_msgs/msg/Pose")):
    position: Point = field(default_factory=Point)
    orientation: Quaternion = field(default_factory=Quaternion)


def no_covariance():
    return [0.0] * 36


@dataclass
class PoseWithCovariance(IdlStruct, typename=ros("geometry_msgs/msg/PoseWithCovariance")):
    pose: Pose
    covariance: array[float64, 36] = field(default_factory=no_covariance)


@dataclass
class TwistWithCovariance(IdlStruct, typename=ros("geometry_msgs/msg/TwistWithCovariance")):
    twist: Twist
    covariance: array[float64, 36] = field(default_factory=no_covariance)


@dataclass
class Odometry(IdlStruct, typename=ros("nav_msgs/msg/Odometry")):
    header: Header
    child_frame_id: str
    pose: PoseWithCovariance
    twist: TwistWithCovariance


@dataclass
class Transform(IdlStruct, typename=ros("geometry_msgs/msg/Transform")):
    translation: Vector3
    rotation: Quaternion


@dataclass
class TransformStamped(IdlStruct, typename=ros("geometry_msgs/msg/TransformStamped")):
    header: Header
    child_frame_id: str
    transform: Transform


@dataclass
class TFMessage(IdlStruct, typename=ros("tf2_msgs/msg/TFMessage")):
    transforms: sequence[TransformStamped]


@dataclass
class LaserScan(IdlStruct, typename=ros("sensor_msgs/msg/LaserScan")):
    header: Header
    angle_min: float32
    angle_max: float32
    angle_increment: float32
    time_increment: float32
    scan_time: float32
    range_min: float32
    range_max: float32
    ranges: sequence[float32]
    intensities: sequence[float32]


@dataclass
class BatteryState(IdlStruct, typename=ros("sensor_msgs/msg/BatteryState")):
    header: Header
    voltage: float32 = 24.0
    temperature: float32 = float("nan")
    current: float32 = float("nan")
    charge: float32 = float("nan")
    capacity: float32 = float("nan")
    design_capacity: float32 = float("nan")
    percentage: float32 = 1.0
    power_supply_status: uint8 = 2
    power_supply_health: uint8 = 1
    power_supply_technology: uint8 = 0
    present: bool = True
    cell_voltage: sequence[float32] = field(default_factory=list)
    cell_temperature: sequence[float32] = field(default_factory=list)
    location: str = ""
    serial_number: str = ""


@dataclass
class MultiArrayDimension(IdlStruct, typename=ros("std_msgs/msg/MultiArrayDimension")):
    label: str
    size: uint32
    stride: uint32


@dataclass
class MultiArrayLayout(IdlStruct, typename=ros("std_msgs/msg/MultiArrayLayout")):
    dim: sequence[MultiArrayDimension]
    data_offset: uint32


@dataclass
class Float64MultiArray(IdlStruct, typename=ros("std_msgs/msg/Float64MultiArray")):
    layout: MultiArrayLayout
    data: sequence[float64]


@dataclass
class Float64(IdlStruct, typename=ros("std_msgs/msg/Float64")):
    data: float64


@dataclass
class Bool(IdlStruct, typename=ros("std_msgs/msg/Bool")):
    data: bool


@dataclass
class TriggerRequest(IdlStruct, typename=ros("std_srvs/srv/Trigger_Request")):
    client: array[uint8, 16]  # the header of rmw_cyclonedds, which is sent back unchanged
    structure_needs_at_least_one_member: uint8


@dataclass
class TriggerResponse(IdlStruct, typename=ros("std_srvs/srv/Trigger_Response")):
    client: array[uint8, 16]
    success: bool
    message: str
