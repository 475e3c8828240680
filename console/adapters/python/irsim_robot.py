#!/usr/bin/env python3
"""A robot in ir-sim (`pip install ir-sim==2.12.0`) behind adapter.py: `--vehicle "run:python3 irsim_robot.py SCENARIO.toml"`.

The tank, the columns, the robot, the stations and the tether come from the scenario; this program adds the motion
of ir-sim with slip, the noise of encoders, gyro and stations, the lidar, and the taut tether. Environment variables:
IRSIM_TRUTH=FILE writes the true state at each step; IRSIM_SEED=N seeds the noise. `irsim_robot.py --account SCENARIO.toml FILE`
evaluates such a file: it prints coverage, collisions, clearance and tether from the true states, as JSON.

Only round tanks with fixed round obstacles are supported.
"""
import json
import math
import os
import sys
import tempfile
import time
import tomllib

import adapter

PERIOD_S = 0.02
SCAN_EVERY = 5  # periods from scan to scan
RAYS = 180
RANGE_MAX_M = 8.0
SLIP = 0.02  # share of the wheels' motion that is lost
SLIP_SIGMA = 0.01
ENCODER_SIGMA = 0.02  # share of the motion
GYRO_BIAS_RAD_PER_S = 0.0003
CORNERS = 48  # corners of the polygon that replaces a column, for the tether
WATCHDOG_S = 0.25  # time limit of the motors' watchdog, for a robot that is not behind adapter.py


def scenario(path):
    """The parts of a scenario that define its world."""
    with open(path, "rb") as file:
        whole = tomllib.load(file)
    circles = [o for o in whole.get("obstacles", []) if o["kind"] == "circle"]
    if "radius_m" not in whole["tank"] or len(circles) < len(whole.get("obstacles", [])):
        sys.exit(f"{path}: only round tanks with round obstacles can be built in ir-sim")
    robot = {"radius_m": 0.25, "speed_max_m_per_s": 0.4, "turn_rate_max_deg_per_s": 60.0, "acceleration_m_per_s2": 0.5,
             **whole.get("robot", {})}  # the defaults of scenario-format.md
    mission = whole.get("mission", {})
    if "start_m" not in robot:
        sys.exit(f"{path}: robot.start_m is missing")
    start_x, start_y = map(float, robot["start_m"])
    goal_x, goal_y = map(float, mission.get("goal_m", (start_x, start_y)))
    heading = math.radians(robot.get("start_heading_deg", math.degrees(math.atan2(goal_y - start_y, goal_x - start_x))))
    return {
        "tank_m": whole["tank"]["radius_m"],
        "columns": [(*map(float, o["center_m"]), o["radius_m"]) for o in circles],
        "start": [start_x, start_y, heading],
        "radius_m": robot["radius_m"],
        "limits": {
            "speed_m_per_s": robot["speed_max_m_per_s"],
            "turn_rad_per_s": math.radians(robot["turn_rate_max_deg_per_s"]),
            "acceleration_m_per_s2": robot["acceleration_m_per_s2"],
            "radius_m": robot["radius_m"],
        },
        "ae": whole.get("ae"),
        "anchor": whole["tether"].get("anchor_m", robot["start_m"]) if "tether" in whole else None,
        "swath_m": mission.get("swath_m", 0.5) if mission.get("kind") == "cover" else None,
    }


def hello(world):
    has = {"odometry": True, "scan": True, "contact": True, "ae": world["ae"] is not None,
           "tether": world["anchor"] is not None}
    stop_s = world["limits"]["speed_m_per_s"] / world["limits"]["acceleration_m_per_s2"] + 0.1
    return {"type": "hello", "protocol": 1, "name": "ir-sim", "motion": "unicycle", "limits": world["limits"], "has": has,
            "period_s": PERIOD_S, "stop_time_s": stop_s, "lease_max_s": 0.5}


def simulator(world):
    """The world in ir-sim."""
    import irsim
    tank = world["tank_m"]
    wall = [[tank * math.cos(k * math.tau / 180), tank * math.sin(k * math.tau / 180)] for k in range(181)]
    text = {
        "world": {"height": 2 * tank + 2, "width": 2 * tank + 2, "offset": [-tank - 1, -tank - 1],
                  "step_time": PERIOD_S, "sample_time": PERIOD_S, "collision_mode": "unobstructed"},
        "robot": [{"kinematics": {"name": "diff", "noise": True, "alpha": [SLIP_SIGMA**2, 0.0, 0.0, SLIP_SIGMA**2]},
                   "shape": {"name": "circle", "radius": world["radius_m"]}, "state": world["start"],
                   "goal": [1000, 1000, 0], "vel_max": [10, 20], "vel_min": [-10, -20],
                   "sensors": [{"name": "lidar2d", "range_min": 0, "range_max": RANGE_MAX_M, "angle_range": math.tau,
                                "number": RAYS, "noise": True, "std": 0.01}]}],
        "obstacle": [{"shape": {"name": "circle", "radius": r}, "state": [x, y, 0]} for x, y, r in world["columns"]]
        + [{"shape": {"name": "linestring", "vertices": wall}, "state": [0, 0, 0]}],
    }
    with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
        json.dump(text, file)  # JSON is YAML
        file.flush()
        return irsim.make(file.name, display=False, disable_all_plot=True, log_level="ERROR")


class Tether:
    """A taut line from an anchor, among columns. Each move of its end sweeps a triangle; corners in it bend the line."""

    def __init__(self, anchor, columns):
        import numpy
        self.numpy = numpy
        turns = [math.tau * k / CORNERS for k in range(CORNERS)]
        corners = [(x + r * math.cos(a), y + r * math.sin(a)) for x, y, r in columns for a in turns]
        self.corners = numpy.array(corners).reshape(-1, 2)
        self.bends = [(float(anchor[0]), float(anchor[1]), 0)]  # x, y, and the side on which the line bends
        self.end = self.bends[0][:2]

    def move(self, end):
        before, self.end = self.end, end
        while bend := self.first_corner(before, end):
            self.bends.append(bend)
            # Beyond the corner, the line continues to sweep, from the direction in which it met the corner.
            (ax, ay, _), (bx, by, _) = self.bends[-2:]
            left = max(math.dist(before, (ax, ay)) - math.dist((ax, ay), (bx, by)), 0.0)
            away = math.dist((ax, ay), (bx, by))
            before = (bx + (bx - ax) / away * left, by + (by - ay) / away * left)
        while len(self.bends) > 1:
            (ax, ay, _), (bx, by, side) = self.bends[-2:]
            if ((bx - ax) * (end[1] - by) - (by - ay) * (end[0] - bx)) * side >= 0:
                break
            self.bends.pop()

    def first_corner(self, before, end):
        """The corner that the line meets first, in the triangle of the last bend and two successive places of its end."""
        bx, by, _ = self.bends[-1]
        p, q, to = (before[0] - bx, before[1] - by), (end[0] - bx, end[1] - by), self.corners - (bx, by)
        turn = p[0] * q[1] - p[1] * q[0]
        if abs(turn) < 1e-15:
            return None
        side = math.copysign(1.0, turn)
        after_p = side * (p[0] * to[:, 1] - p[1] * to[:, 0])
        before_q = side * (to[:, 0] * q[1] - to[:, 1] * q[0])
        ahead = to @ p > 1e-9
        near = side * ((end[0] - before[0]) * (to[:, 1] - p[1]) - (end[1] - before[1]) * (to[:, 0] - p[0])) > 0
        inside = (after_p > 1e-12) & (before_q > 0) & ahead & near
        if not inside.any():
            return None
        angle = self.numpy.where(inside, after_p / self.numpy.hypot(to[:, 0], to[:, 1]).clip(1e-9), math.inf)
        x, y = self.corners[int(angle.argmin())]
        return (float(x), float(y), side)

    def length(self):
        points = [bend[:2] for bend in self.bends] + [self.end]
        return sum(math.dist(a, b) for a, b in zip(points, points[1:]))


class Robot:
    """Moves in ir-sim, and adds errors to its measurements."""

    def __init__(self, world):
        import numpy
        self.world, self.numpy, self.sim = world, numpy, simulator(world)
        self.chance = numpy.random.default_rng(int(os.environ.get("IRSIM_SEED", "1")))
        self.tether = Tether(world["anchor"], world["columns"]) if world["anchor"] else None
        self.truth = open(os.environ.get("IRSIM_TRUTH", os.devnull), "w", 1)
        self.steps, self.due_s, self.ranged_s = 0, 0.0, 0.0
        # The lidar takes most of the time of a step, so it is moved only when a scan is due.
        self.lidar, self.sim.robot.sensors = self.sim.robot.sensors[0], []
        if self.tether:
            self.tether.move(tuple(self.pose()[:2]))

    def pose(self):
        return [float(value) for value in self.sim.get_robot_state().ravel()[:3]]

    def measure(self, v, w, dt):
        self.due_s += dt
        for _ in range(int(self.due_s / PERIOD_S + 0.5)):
            self.due_s -= PERIOD_S
            self.steps += 1
            self.sim.step(self.numpy.array([[v * (1.0 - SLIP)], [w]]))
            x, y, heading = self.pose()
            if self.tether:
                self.tether.move((x, y))
            row = [self.steps, x, y, heading, v, w, bool(self.sim.robot.collision), self.tether and self.tether.length()]
            print(json.dumps(row), file=self.truth)
        noise = self.chance.normal
        readings = {"odometry": {
            "over_s": dt,
            "forward_m": v * dt * (1.0 + noise(0.0, ENCODER_SIGMA)),
            "turn_rad": (w * (1.0 + noise(0.0, 0.002)) + GYRO_BIAS_RAD_PER_S) * dt,
        }}
        readings["contact"] = bool(self.sim.robot.collision)
        if self.tether:
            readings["tether"] = {"paid_out_m": round(self.tether.length(), 4)}
        if self.steps % SCAN_EVERY == 0:
            readings["scan"] = self.scan()
        if self.world["ae"] and (self.steps * PERIOD_S - self.ranged_s) >= self.world["ae"]["period_s"]:
            self.ranged_s += self.world["ae"]["period_s"]
            readings["ae"] = {"ranges": [self.ranges(station) for station in self.world["ae"]["stations"]]}
        return readings

    def scan(self):
        self.lidar.step(self.sim.robot.state[0:3])
        scan = self.lidar.get_scan()
        ranges = [None if r >= RANGE_MAX_M - 1e-6 else round(max(float(r), 0.0), 3) for r in scan["ranges"]]
        return {"first_rad": scan["angle_min"], "step_rad": scan["angle_increment"], "range_max_m": RANGE_MAX_M,
                "ranges_m": ranges}

    def ranges(self, station):
        """Distances with errors that are uniform within a share of the distance."""
        x, y, _ = self.pose()
        far, share = math.dist((x, y), station["at_m"]), self.world["ae"].get("noise", {}).get("ratio", 0.05)
        factors = 1.0 + self.chance.uniform(-share, share, self.world["ae"].get("repetitions", 1))
        return {"station": station["name"], "ranges_m": [round(max(far * float(f), 0.001), 4) for f in factors]}


class Driven:
    """The robot in the trials of other adapters, with motors of limited acceleration, a watchdog, and a pose by odometry."""

    def __init__(self, world):
        self.limits, self.body = world["limits"], Robot(world)
        self.x = self.y = self.heading = 0.0
        self.v = self.w = self.to_v = self.to_w = self.until = 0.0
        self.log = open(os.environ.get("ROBOT_LOG", os.devnull), "w", 1)

    def command(self, v, w, now):
        """Takes speeds, which apply until the watchdog stops the robot."""
        most_v, most_w = self.limits["speed_m_per_s"], self.limits["turn_rad_per_s"]
        self.to_v, self.to_w, self.until = max(-most_v, min(most_v, v)), max(-most_w, min(most_w, w)), now + WATCHDOG_S

    def step(self, dt, now):
        """Moves for a time; returns the measurements."""
        if now > self.until:
            self.to_v = self.to_w = 0.0
        change = self.limits["acceleration_m_per_s2"] * dt
        self.v += max(-change, min(change, self.to_v - self.v))
        self.w += max(-4 * change, min(4 * change, self.to_w - self.w))
        readings = self.body.measure(self.v, self.w, dt)
        print(now, self.v, self.w, file=self.log)
        odometry = readings["odometry"]
        middle = self.heading + odometry["turn_rad"] / 2
        self.x += odometry["forward_m"] * math.cos(middle)
        self.y += odometry["forward_m"] * math.sin(middle)
        self.heading += odometry["turn_rad"]
        return readings


def each_period(step):
    """Calls `step` once in each period, with the time since the last call and the current time."""
    before = time.monotonic()
    while True:
        time.sleep(max(0.0, before + PERIOD_S - time.monotonic()))
        now = time.monotonic()
        step(now - before, now)
        before = now


def account(world, path):
    """Evaluates a file of true states."""
    rows = [json.loads(line) for line in open(path) if line.endswith("]\n")]
    collisions, least, longest, was = 0, math.inf, 0.0, False
    for _, x, y, _, _, _, collided, length in rows:
        collisions += collided and not was
        was, longest = collided, max(longest, length or 0.0)
        gaps = [math.hypot(x - cx, y - cy) - r for cx, cy, r in world["columns"]] + [world["tank_m"] - math.hypot(x, y)]
        least = min(least, min(gaps) - world["radius_m"])
    # A drive to a point scans no floor.
    covered = round(coverage(world, rows), 4) if world["swath_m"] else None
    return {"coverage": covered, "collisions": int(collisions), "clearance_min_m": round(least, 4),
            "tether_max_m": round(longest, 3), "time_s": round(len(rows) * PERIOD_S, 1)}


def coverage(world, rows):
    """Scanned share of the reachable floor, which is within half a swath of a place where the hull fits."""
    import numpy
    cell, half, tank, hull = 0.05, world["swath_m"] / 2, world["tank_m"], world["radius_m"]
    side = numpy.arange(-tank, tank, cell) + cell / 2
    xs, ys = numpy.meshgrid(side, side)

    def free(margin):
        inside = numpy.hypot(xs, ys) <= tank - margin
        for x, y, r in world["columns"]:
            inside &= numpy.hypot(xs - x, ys - y) >= r + margin
        return inside

    fits, floor = free(hull), free(0.0)
    reachable = numpy.zeros_like(fits)
    n = int(half / cell)
    for i in range(-n, n + 1):
        for k in range(-n, n + 1):
            if math.hypot(i, k) * cell <= half:
                reachable |= numpy.roll(fits, (i, k), (0, 1))
    reachable &= floor
    done = numpy.zeros_like(fits)
    across, before = numpy.arange(-half, half + 1e-9, cell / 2), None
    for _, x, y, heading, *_ in rows:
        if before is None or math.dist(before[:2], (x, y)) > cell / 4 or abs(before[2] - heading) > 0.05:
            before = (x, y, heading)
            i = ((y + across * math.cos(heading) + tank) / cell).astype(int)
            k = ((x - across * math.sin(heading) + tank) / cell).astype(int)
            on = (i >= 0) & (k >= 0) & (i < len(side)) & (k < len(side))
            done[i[on], k[on]] = True
    return float((done & reachable).sum() / reachable.sum())


def main():
    arguments = [word for word in sys.argv[1:] if word not in ("robot", "--account")]
    if not arguments:
        sys.exit(__doc__)
    world = scenario(arguments[0])
    if "--account" in sys.argv:
        print(json.dumps(account(world, arguments[1])))
    elif "robot" in sys.argv:
        # ir-sim writes to standard output, which is reserved for the messages.
        messages = os.dup(1)
        os.dup2(2, 1)
        body = Robot(world)
        os.dup2(messages, 1)
        adapter.robot(hello(world), body)
    else:
        adapter.adapter(hello(world), [sys.executable, os.path.abspath(__file__), arguments[0], "robot"])


if __name__ == "__main__":
    main()
