#!/usr/bin/env python3
"""Passes datagrams on like a bad link: `udp_proxy.py LISTEN_PORT TO_PORT [--loss 0.1] [--delay 0.05] [--jitter 0.2] [--double 0.02]
[--seed 1]`.

A rover that calls LISTEN_PORT reaches the adapter at TO_PORT, and the answers come back the same way. In both directions, each
datagram may be lost or duplicated, and is delayed by `delay` plus a random share of `jitter`, so that datagrams overtake each
other. At the end (SIGTERM), the program prints its figures on standard error.
"""
import argparse
import heapq
import random
import select
import signal
import socket
import sys
import time


def main():
    options = argparse.ArgumentParser()
    options.add_argument("listen", type=int)
    options.add_argument("to", type=int)
    for name, default in (("loss", 0.1), ("delay", 0.05), ("jitter", 0.2), ("double", 0.02)):
        options.add_argument(f"--{name}", type=float, default=default)
    options.add_argument("--seed", type=int, default=1)
    options = options.parse_args()
    chance = random.Random(options.seed)
    near, far = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
    near.bind(("127.0.0.1", options.listen))
    caller, waiting = None, []
    taken = passed = number = 0
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(f"{taken} datagrams taken, {passed} passed on"))
    while True:
        wait = max(0.0, waiting[0][0] - time.monotonic()) if waiting else None
        for one in select.select([near, far], [], [], wait)[0]:
            data, sender = one.recvfrom(65536)
            caller = sender if one is near else caller
            taken += 1
            copies = 0 if chance.random() < options.loss else 1 + (chance.random() < options.double)
            for _ in range(copies):
                number += 1
                due = time.monotonic() + options.delay + chance.random() * options.jitter
                heapq.heappush(waiting, (due, number, data, one is near))
        while waiting and waiting[0][0] <= time.monotonic():
            _, _, data, is_outward = heapq.heappop(waiting)
            passed += 1
            if is_outward:
                far.sendto(data, ("127.0.0.1", options.to))
            elif caller:
                near.sendto(data, caller)


if __name__ == "__main__":
    main()
