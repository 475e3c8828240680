#!/usr/bin/env python3
"""Cuts the link to a moving vehicle at random times, and measures when the vehicle stands still: `cuts.py TANKOPS SCENARIO [N] [SEED]`.

The robot of adapter.py runs in a separate process and keeps the lease. This program is between the console and the adapter,
and cuts the link in one of four ways: the socket is closed, the adapter is killed, the adapter is stopped (SIGSTOP), or bytes are
dropped both ways. Each run must hold the vehicle within the lease and its own braking, must report the lost link within 1 s, must
not move the vehicle again, and must keep a journal that `tankops verify` proves. Prints a JSON line for each cut and one with the
summary; ends with 1 if a rule is broken.
Environment: TANKOPS_OPTIONS, global options of tankops, separated by spaces; SET, more options of `run`; JOBS, number of runs at a
time (1).
"""
import json, os, random, select, signal, socket, subprocess, sys, tempfile, time
from concurrent.futures import ThreadPoolExecutor

import adapter

WAYS = ["closed", "killed", "stopped", "dropped"]
STILL = 1e-9  # metres or radians per second
WATCH_S = 2.5  # after the cut
LEASE_S = 0.3  # lease and one period, as the rules demand
TOLD_S = 1.0
LIMIT_S = 120  # for one command of tankops
OPTIONS = os.environ.get("TANKOPS_OPTIONS", "").split()


def relay(listener, way, after_s, program, env):
    """Serves one console; returns the times of the first drive and of the cut."""
    console, _ = listener.accept()
    child = subprocess.Popen(program, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=env)
    out, drove, cut = child.stdout.fileno(), None, None
    try:
        while cut is None or time.monotonic() < cut + WATCH_S:
            now = time.monotonic()
            if drove and not cut and now >= drove + after_s:
                cut = now
                if way == "closed":
                    console.close()
                    child.stdin.close()
                elif way in ("killed", "stopped"):
                    child.send_signal(signal.SIGKILL if way == "killed" else signal.SIGSTOP)
            if cut and way == "closed":
                time.sleep(0.01)
                continue
            if cut and way == "killed":
                console.close()
                way = "closed"
                continue
            for ready in select.select([console, out], [], [], 0.005)[0]:
                data = console.recv(65536) if ready is console else os.read(out, 65536)
                if not data:
                    return drove, cut
                if cut and way == "dropped":
                    continue
                if ready is console:
                    if drove is None and moves(data):
                        drove = time.monotonic()
                    os.write(child.stdin.fileno(), data)
                else:
                    console.sendall(data)
    except (BrokenPipeError, ConnectionResetError):
        pass  # the console has ended the run
    finally:
        time.sleep(max(0.0, (cut or 0.0) + WATCH_S - time.monotonic()))
        console.close()
        child.kill()
        child.wait()
    return drove, cut


def moves(data):
    lines = [json.loads(line) for line in data.splitlines() if line.startswith(b"{") and line.endswith(b"}")]
    return any(line["type"] == "drive" and abs(line["forward_m_per_s"]) > 0.05 for line in lines)


def stands(log, cut):
    """Time from the cut until the robot stands still for good, highest speed after the cut, whether it stands at the end."""
    rows = [tuple(map(float, line.split())) for line in log if len(line.split()) == 3]
    moving = [at for at, v, w in rows if at > cut and (abs(v) > STILL or abs(w) > STILL)]
    # Until its lease lapses, it may still accelerate.
    speed = max((abs(v) for at, v, w in rows if at > cut - 0.05), default=0.0)
    is_still = bool(rows) and abs(rows[-1][1]) <= STILL
    return (max(moving) - cut if moving else 0.0), speed, is_still


def told(events):
    """Time from the last reading to the report of the lost link, by the clock of the mission."""
    lost = next((e["t_s"] for e in events if e["event"] == "link" and e["state"] in ("lost", "closed")), None)
    heard = [e["t_s"] for e in events if e["event"] == "sensed" and (lost is None or e["t_s"] <= lost)]
    return None if lost is None else round(lost - max(heard), 3)


def read(tankops, *command):
    return subprocess.run([tankops, *OPTIONS, *command], capture_output=True, timeout=LIMIT_S)


def one(tankops, scenario, number, seed, folder):
    chance = random.Random(f"{seed} {number}")
    way, after_s = WAYS[number % len(WAYS)], chance.uniform(0.2, 3.0)
    at, log = os.path.join(folder, f"s{number}"), os.path.join(folder, f"robot{number}")
    logs = os.path.join(folder, f"runs{number}")
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(at)
        listener.listen(1)
        command = [tankops, *OPTIONS, "run", scenario, "--vehicle", f"unix:{at}", "--logs", logs,
                   *os.environ.get("SET", "").split()]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        program = [sys.executable, os.path.abspath(adapter.__file__)]
        drove, cut = relay(listener, way, after_s, program, {**os.environ, "ROBOT_LOG": log})
        said = run.communicate(timeout=LIMIT_S)[0].decode()
    if cut is None:
        return {"cut": number, "way": way, "wrong": [f"the run ended before the cut: {said}"]}
    kept = sorted(os.listdir(logs))
    proved = read(tankops, "verify", os.path.join(logs, kept[-1]))
    listed = read(tankops, "events", os.path.join(logs, kept[-1]))
    listed.check_returncode()
    events = [json.loads(line) for line in listed.stdout.splitlines()]
    with open(log) as lines:
        stand_s, speed, is_still = stands(lines, cut)
    braking_s = speed / adapter.LIMITS["acceleration_m_per_s2"]
    link_s = told(events)
    first = next((n for n, e in enumerate(events) if e["event"] == "held"), len(events))
    again = any(e["event"] == "sent" and e.get("drive") for e in events[first:])
    row = {"cut": number, "way": way, "after_s": round(after_s, 3), "speed_m_per_s": round(speed, 3),
           "stand_s": round(stand_s, 3), "beyond_braking_s": round(stand_s - braking_s, 3), "told_s": link_s}
    wrong = [why for is_wrong, why in [
        (stand_s > LEASE_S + braking_s, "it stopped too late"), (not is_still, "it was moving at the end"),
        (link_s is None or link_s > TOLD_S, "the lost link was not reported within 1 s"),
        (again, "a motion was sent after the hold"), (events[-1]["event"] != "ended", f"the run was not kept: {said}"),
        (proved.returncode != 0, f"the run was not verified: {proved.stdout.decode()}{proved.stderr.decode()}"),
    ] if is_wrong]
    return {**row, **({"wrong": wrong} if wrong else {})}


def main(tankops, scenario, n=100, seed=1):
    rows = []
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(int(os.environ.get("JOBS", "1"))) as jobs:
        for row in jobs.map(lambda number: one(tankops, scenario, number, seed, folder), range(int(n))):
            rows.append(row)
            print(json.dumps(row), flush=True)
    measured = [row for row in rows if "stand_s" in row]
    summary = {"cuts": len(rows), "wrong": sum("wrong" in row for row in rows)}
    for key in ("stand_s", "beyond_braking_s", "told_s"):
        values = sorted(row[key] for row in measured if row[key] is not None)
        summary[key] = {name: values[-(-share * len(values) // 100) - 1]
                        for name, share in (("median", 50), ("p95", 95), ("p99", 99), ("max", 100)) if values}
    print(json.dumps(summary))
    return 1 if summary["wrong"] else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
