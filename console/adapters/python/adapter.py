#!/usr/bin/env python3
"""A one-page adapter with a small simulated robot: `--vehicle "run:python3 adapter.py"`. Replace `Disc` with your robot.
The robot runs in a separate process and keeps the lease, so it stops even if this adapter hangs or dies (vehicle-protocol.md)."""
import contextlib, json, os, random, select, subprocess, sys, time

LIMITS = {"speed_m_per_s": 0.4, "turn_rad_per_s": 1.0, "acceleration_m_per_s2": 0.5, "radius_m": 0.2}
HELLO = {"type": "hello", "protocol": 1, "name": "disc", "motion": "unicycle", "limits": LIMITS, "has": {"odometry": True},
         "period_s": 0.02, "stop_time_s": 0.9, "lease_max_s": 0.5}

class Disc:
    def measure(self, v, w, dt):  # move for dt seconds with these speeds; return the measurements
        forward, turn = (speed * dt * random.gauss(1.0, 0.01) for speed in (v, w))
        return {"odometry": {"over_s": dt, "forward_m": forward, "turn_rad": turn}}

def say(message):
    with contextlib.suppress(BlockingIOError, BrokenPipeError): os.write(1, json.dumps(message, allow_nan=False).encode() + b"\n")

def robot(hello, body):  # lines with speed, turn rate and lease in, readings out
    os.set_blocking(1, False)
    v = w = to_v = to_w = until = 0.0
    seq, has_adapter, before, log = 0, True, time.monotonic(), open(os.environ.get("ROBOT_LOG", os.devnull), "w", 1)
    while has_adapter or v or w:
        if select.select([0] if has_adapter else [], [], [], max(0.0, before + hello["period_s"] - time.monotonic()))[0]:
            lines = os.read(0, 65536).splitlines()
            to_v, to_w, lease = map(float, lines[-1].split()) if lines else (0.0, 0.0, 0.0)
            has_adapter, until = bool(lines), time.monotonic() + lease
        if (now := time.monotonic()) < before + hello["period_s"]: continue
        if now > until: to_v = to_w = 0.0  # the lease has lapsed
        seq, dt, before, change = seq + 1, now - before, now, hello["limits"]["acceleration_m_per_s2"] * (now - before)
        v, w = (speed + max(-most, min(most, to - speed)) for speed, to, most in ((v, to_v, change), (w, to_w, 4 * change)))
        say({"type": "readings", "seq": seq, "stamp_s": now, **body.measure(v, w, dt)})
        print(now, v, w, file=log)
        if seq % 25 == 0: say({"type": "state", "stamp_s": now, "mode": "ready"})

def command(line, hello, heard):  # its line for the robot; an error if it is bad. `heard`: greatest number, least delay of a stamp
    late = time.monotonic() - float(line["stamp_s"] if line["type"] in ("drive", "ping") else line.get("stamp_s", "-inf"))
    if late < -1e300 or late > 1e300 and line["type"] in ("drive", "ping"): raise ValueError("stamp_s is not finite")  # 1e999
    heard[1] = min(heard[1] + 1e-4, late)  # + 1e-4: clocks drift
    if line["type"] == "ping": say({"type": "pong", "echo_s": line["stamp_s"], "stamp_s": time.monotonic()})
    if line["type"] not in ("drive", "stop") or line["seq"] <= heard[0]: return "0 0 0\n" * (line["type"] == "bye")
    heard[0] = int(line["seq"])
    if line["type"] == "stop": return "0 0 0\n"
    v, w, lease = (float(line[key]) for key in ("forward_m_per_s", "turn_rad_per_s", "lease_s"))
    fits = abs(v) <= hello["limits"]["speed_m_per_s"] + 1e-9 and abs(w) <= hello["limits"]["turn_rad_per_s"] + 1e-9
    if not fits or line.get("sideways_m_per_s") or not 0 < lease <= hello["lease_max_s"]: raise ValueError("beyond the limits")
    return f"{v} {w} {lease}\n" if late - heard[1] <= lease else ""  # it waited while this adapter was stopped

def adapter(hello, program):  # between the console (stdin, stdout) and the robot's process
    child, heard, rest = subprocess.Popen(program, stdin=-1, stdout=-1, start_new_session=True), [-1, float("inf")], b""
    say(hello)
    while (ready := select.select([0, child.stdout], [], [])[0]) and (0 not in ready or (data := os.read(0, 65536))):
        if child.stdout in ready: os.write(1, os.read(child.stdout.fileno(), 65536) or sys.exit("the robot process has ended"))
        *lines, rest = (rest + (data if 0 in ready else b"")).split(b"\n") if len(rest) < 65536 else (b"too long", b"")
        for line in filter(None, lines):
            try: order = command(json.loads(line, parse_constant=int), hello, heard)  # NaN is bad
            except Exception as why: order = print("stopped by a bad line:", repr(why)[:200], file=sys.stderr) or "0 0 0\n"
            os.write(child.stdin.fileno(), order.encode())

if __name__ == "__main__":
    robot(HELLO, Disc()) if "robot" in sys.argv else adapter(HELLO, [sys.executable, os.path.abspath(__file__), "robot"])
