#!/usr/bin/env python3
"""A rover in ir-sim that speaks MAVLink, for trials of tankops-mavlink without an autopilot.

    pip install ir-sim==2.12.0 pymavlink==2.4.50
    rover_peer.py SCENARIO.toml [HOST:PORT]

It calls the adapter at HOST:PORT, 127.0.0.1:14550 by default. The world, its noise and its environment variables
(IRSIM_TRUTH, IRSIM_SEED) are those of irsim_robot.py. The rover is armed and in mode GUIDED; it takes
SET_POSITION_TARGET_LOCAL_NED with velocity and yaw rate in the order of arrival, as ArduRover does, and sends HEARTBEAT,
LOCAL_POSITION_NED and ATTITUDE (by its own odometry), BATTERY_STATUS, OBSTACLE_DISTANCE, a DEBUG_FLOAT_ARRAY `ae` with 11
ranges per station, and NAMED_VALUE_FLOAT `tether` and `bumper`. Its own watchdog stops it when no command has arrived for
0.25 s (ArduRover waits for about 3 s). With ROBOT_LOG=FILE it writes a line with time, speed and turn rate in each period.
"""
import math
import os
import sys
import time
from pathlib import Path

os.environ["MAVLINK20"] = "1"
HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent.parent / "python"), str(HERE.parent.parent)]

import irsim_robot
from pymavlink import mavutil

REPETITIONS = 11
GUIDED = 15
VELOCITY_AND_YAW_RATE = 0x05C7
SECTORS = 72


class Rover:
    """The messages of a rover that moves in ir-sim."""

    def __init__(self, world, address):
        self.robot = irsim_robot.Driven(world)
        self.link = mavutil.mavlink_connection(f"udpout:{address}", source_system=1, source_component=1, dialect="common")
        self.started = time.monotonic()
        self.beat = 0.0

    def hear(self, now):
        while (message := self.link.recv_msg()) is not None:
            if message.get_type() != "SET_POSITION_TARGET_LOCAL_NED" or message.target_system != 1:
                continue
            if message.type_mask == VELOCITY_AND_YAW_RATE and message.coordinate_frame == mavutil.mavlink.MAV_FRAME_BODY_NED:
                self.robot.command(message.vx, -message.yaw_rate, now)

    def step(self, dt, now):
        self.hear(now)
        self.send(self.robot.step(dt, now), now)

    def send(self, readings, now):
        send, ms = self.link.mav, int((now - self.started) * 1000)
        if now - self.beat >= 1.0:
            self.beat = now
            send.heartbeat_send(mavutil.mavlink.MAV_TYPE_GROUND_ROVER, mavutil.mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA,
                                mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED | mavutil.mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
                                GUIDED, mavutil.mavlink.MAV_STATE_ACTIVE)
            send.battery_status_send(0, 0, 0, 32767, [65535] * 10, -1, -1, -1, 90)
        yaw = math.remainder(-self.robot.heading, math.tau)
        send.attitude_send(ms, 0.0, 0.0, yaw, 0.0, 0.0, -self.robot.w)
        send.local_position_ned_send(ms, self.robot.x, -self.robot.y, 0.0, 0.0, 0.0, 0.0)
        send.named_value_float_send(ms, b"bumper", float(readings["contact"]))
        if "tether" in readings:
            send.named_value_float_send(ms, b"tether", readings["tether"]["paid_out_m"])
        if "scan" in readings:
            send.obstacle_distance_send(ms * 1000, mavutil.mavlink.MAV_DISTANCE_SENSOR_LASER, sectors(readings["scan"]),
                                        360 // SECTORS, 10, int(readings["scan"]["range_max_m"] * 100), 0.0, 0.0,
                                        mavutil.mavlink.MAV_FRAME_BODY_FRD)
        if "ae" in readings:
            values = [r for station in readings["ae"]["ranges"] for r in station["ranges_m"][:REPETITIONS]]
            send.debug_float_array_send(ms * 1000, b"ae", 0, values + [0.0] * (58 - len(values)))


def sectors(scan):
    """The nearest echo of each sector, clockwise from ahead, centimetres."""
    nearest = [65535] * SECTORS
    for ray, distance in enumerate(scan["ranges_m"]):
        if distance is not None:
            clockwise = -(scan["first_rad"] + ray * scan["step_rad"])
            sector = round(clockwise / math.tau * SECTORS) % SECTORS
            nearest[sector] = min(nearest[sector], round(distance * 100))
    return nearest


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    rover = Rover(irsim_robot.scenario(sys.argv[1]), sys.argv[2] if len(sys.argv) == 3 else "127.0.0.1:14550")
    print("the rover is on the air", flush=True)
    irsim_robot.each_period(rover.step)


if __name__ == "__main__":
    main()
