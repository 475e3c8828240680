#!/usr/bin/env python3
"""A robot in ir-sim that speaks ROS 2 over Eclipse Cyclone DDS, for trials of tankops-ros2 without a ROS 2 installation.

    pip install ir-sim==2.12.0 cyclonedds==11.0.1
    irsim_peer.py SCENARIO.toml [--stamped] [--tf] [--no-stop-service]

The world, its noise and its environment variables (IRSIM_TRUTH, IRSIM_SEED) are those of irsim_robot.py. The robot moves
by /cmd_vel (Twist, or TwistStamped with --stamped) and publishes /odom (or /tf with --tf), /scan, /ae/ranges,
/tether/paid_out, /bumper and /battery_state. Its own watchdog stops it when no command has arrived for 0.25 s. With
ROBOT_LOG=FILE it writes a line with time, speed and turn rate in each period.
"""
import math
import os
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent.parent / "python"), str(HERE.parent.parent)]

import irsim_robot
import ros_types as ros
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

RELIABLE = Qos(Policy.Reliability.Reliable(10_000_000), Policy.Durability.Volatile, Policy.History.KeepLast(10))
BEST_EFFORT = Qos(Policy.Reliability.BestEffort, Policy.Durability.Volatile, Policy.History.KeepLast(5))


class Robot:
    """The topics of a robot that moves in ir-sim."""

    def __init__(self, world, stamped, by_tf, has_stop):
        self.robot, self.stamped, self.by_tf = irsim_robot.Driven(world), stamped, by_tf
        self.domain = DomainParticipant(int(os.environ.get("ROS_DOMAIN_ID", "0")))
        self.commands = self.reader("rt/cmd_vel", ros.TwistStamped if stamped else ros.Twist)
        self.odom = self.writer("rt/tf", ros.TFMessage) if by_tf else self.writer("rt/odom", ros.Odometry)
        self.scan = self.writer("rt/scan", ros.LaserScan, BEST_EFFORT)
        self.ranges = self.writer("rt/ae/ranges", ros.Float64MultiArray)
        self.tether = self.writer("rt/tether/paid_out", ros.Float64)
        self.bumper = self.writer("rt/bumper", ros.Bool)
        self.battery = self.writer("rt/battery_state", ros.BatteryState)
        self.stop_asked = self.reader("rq/stopRequest", ros.TriggerRequest) if has_stop else None
        self.stop_done = self.writer("rr/stopReply", ros.TriggerResponse) if has_stop else None

    def reader(self, name, kind, qos=RELIABLE):
        return DataReader(self.domain, Topic(self.domain, name, kind, qos), qos)

    def writer(self, name, kind, qos=RELIABLE):
        return DataWriter(self.domain, Topic(self.domain, name, kind, qos), qos)

    def hear(self, now):
        for sample in self.commands.take(64):
            if isinstance(sample, (ros.Twist, ros.TwistStamped)):
                twist = sample.twist if self.stamped else sample
                self.robot.command(twist.linear.x, twist.angular.z, now)
        if self.stop_asked:
            for request in self.stop_asked.take(8):
                if isinstance(request, ros.TriggerRequest):
                    self.robot.command(0.0, 0.0, now)
                    self.stop_done.write(ros.TriggerResponse(request.client, True, "stopped"))

    def step(self, dt, now):
        # The stamp is the time of the measurement, not of its publication.
        wall = time.time_ns()
        self.hear(now)
        self.publish(self.robot.step(dt, now), ros.Time(wall // 1_000_000_000, wall % 1_000_000_000))

    def publish(self, readings, stamp):
        x, y, heading = self.robot.x, self.robot.y, self.robot.heading
        turned = ros.Quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2))
        odom = ros.Header(stamp, "odom")
        if self.by_tf:
            transform = ros.Transform(ros.Vector3(x, y, 0.0), turned)
            self.odom.write(ros.TFMessage([ros.TransformStamped(odom, "base_link", transform)]))
        else:
            pose = ros.PoseWithCovariance(ros.Pose(ros.Point(x, y, 0.0), turned))
            twist = ros.Twist(ros.Vector3(self.robot.v, 0.0, 0.0), ros.Vector3(0.0, 0.0, self.robot.w))
            self.odom.write(ros.Odometry(odom, "base_link", pose, ros.TwistWithCovariance(twist)))
        self.bumper.write(ros.Bool(readings["contact"]))
        if "tether" in readings:
            self.tether.write(ros.Float64(readings["tether"]["paid_out_m"]))
        if "scan" in readings:
            self.scan.write(laser_scan(readings["scan"], stamp))
        if "ae" in readings:
            self.ranges.write(ranges_array(readings["ae"]["ranges"]))
            self.battery.write(ros.BatteryState(ros.Header(stamp, ""), percentage=0.9))


def laser_scan(scan, stamp):
    ranges = [math.inf if r is None else r for r in scan["ranges_m"]]
    first, step = scan["first_rad"], scan["step_rad"]
    return ros.LaserScan(ros.Header(stamp, "base_link"), first, first + step * (len(ranges) - 1), step, 0.0, 0.1, 0.0,
                         scan["range_max_m"], ranges, [])


def ranges_array(stations):
    dims = [ros.MultiArrayDimension(s["station"], len(s["ranges_m"]), len(s["ranges_m"])) for s in stations]
    return ros.Float64MultiArray(ros.MultiArrayLayout(dims, 0), [r for s in stations for r in s["ranges_m"]])


def main():
    files = [word for word in sys.argv[1:] if not word.startswith("--")]
    if len(files) != 1:
        sys.exit(__doc__)
    world = irsim_robot.scenario(files[0])
    robot = Robot(world, "--stamped" in sys.argv, "--tf" in sys.argv, "--no-stop-service" not in sys.argv)
    print("the robot is on the air", flush=True)
    irsim_robot.each_period(robot.step)


if __name__ == "__main__":
    main()
