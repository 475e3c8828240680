"""Compares our nonlinear fix with scipy.optimize.least_squares on the same draws.

    cargo run --release -p positioning --example draws > draws.csv
    python3 compare_scipy.py draws.csv

Needs numpy and scipy. Both minimise the same sum of squared relative range errors from the same linear start.
"""

import csv
import sys
import time

import numpy as np
from scipy.optimize import least_squares

STATIONS = np.array([[7.5, 0.0], [-7.5, 0.0], [0.0, 7.5]])


def linear(ranges):
    """The linear solution for three stations (Wang et al. 2023, eq. 6-9)."""
    rows = STATIONS[2] - STATIONS[:2]
    squares = ranges[:2] ** 2 - ranges[2] ** 2 + STATIONS[2] @ STATIONS[2] - (STATIONS[:2] ** 2).sum(1)
    return np.linalg.solve(rows, squares / 2)


def residuals(position, ranges):
    distances = np.maximum(np.linalg.norm(position - STATIONS, axis=1), 1e-3)
    return (ranges - distances) / distances


def main():
    with open(sys.argv[1], newline="") as file:
        draws = np.array([[float(value) for value in row] for row in list(csv.reader(file))[1:]])
    truths, ranges, ours, our_us = draws[:, :2], draws[:, 2:5], draws[:, 5:7], draws[:, 7]
    theirs, their_us = [], []
    for measured in ranges:
        began = time.perf_counter()
        found = least_squares(residuals, linear(measured), args=(measured,), method="lm", xtol=1e-12)
        their_us.append((time.perf_counter() - began) * 1e6)
        theirs.append(found.x)
    theirs = np.array(theirs)

    def cost(positions):
        return np.array([(residuals(p, r) ** 2).sum() for p, r in zip(positions, ranges)])

    def error(positions):
        return np.linalg.norm(positions - truths, axis=1)

    apart = np.linalg.norm(ours - theirs, axis=1)
    better, worse = cost(ours) < cost(theirs) - 1e-12, cost(ours) > cost(theirs) + 1e-12
    print(f"draws                   {len(draws)}")
    print(f"mean error              ours {error(ours).mean():.5f} m, scipy {error(theirs).mean():.5f} m")
    print(f"largest error           ours {error(ours).max():.3f} m, scipy {error(theirs).max():.3f} m")
    print(f"apart by more than 1 um {(apart > 1e-6).sum()} draws")
    print(f"lower minimum           ours {better.sum()} draws, scipy {worse.sum()} draws")
    print(f"median time of a fix    ours {np.median(our_us):.2f} us, scipy {np.median(their_us):.0f} us")


if __name__ == "__main__":
    main()
