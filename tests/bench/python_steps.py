#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What Python adds to the library: scans in memory, through Tracker.step and Tracker.run, against
the same loop in C. Prints the least times of several rounds and their ratios; exit 1 where scans of
100 plots take more than 1.3 times as long, or scans of 4 plots by run more than twice."""
import sys
import time

import numpy as np

import rhotrack
from rhotrack._core import lib, must

SETTINGS = rhotrack.Settings(sigma_m=20, v_max_mps=300, accel_max_mps2=10)
BARS = {(100, "step"): 1.3, (100, "run"): 1.3, (4, "run"): 2.0}


def sky(plots, targets, count, seed=1):
    """Scans of straight targets among uniform clutter, 4 s apart."""
    random = np.random.default_rng(seed)
    place = random.uniform(-4e4, 4e4, (targets, 2))
    speed = random.uniform(-150, 150, (targets, 2))
    scans = []
    for i in range(count):
        scan = np.zeros(plots, [("t_s", "f8"), ("sensor_id", "i4"), ("x_m", "f4"), ("y_m", "f4")])
        seen = place + 4 * i * speed + random.normal(0, 20, (targets, 2))
        at = np.concatenate([seen, random.uniform(-5e4, 5e4, (plots - targets, 2))])
        scan["t_s"], scan["sensor_id"], scan["x_m"], scan["y_m"] = 4 * i, 1, at[:, 0], at[:, 1]
        scans.append(scan)
    return scans


def in_c(scans):
    made, tracker = rhotrack.Scans(scans, SETTINGS), rhotrack.Tracker(SETTINGS)
    return lambda: must(lib.program_pipeline_run(tracker._pipeline, made.handle, False))


def by_step(scans):
    tracker = rhotrack.Tracker(SETTINGS)
    return lambda: [tracker.step(scan) for scan in scans]


def by_run(scans):
    tracker = rhotrack.Tracker(SETTINGS)
    return lambda: tracker.run(scans)


def main(rounds=5):
    is_missed = False
    for plots, targets, count in ((100, 30, 300), (4, 3, 3000)):
        scans, best = sky(plots, targets, count), {}
        for _ in range(rounds):
            for name, make in (("C", in_c), ("step", by_step), ("run", by_run)):
                loop = make(scans)
                start = time.perf_counter()
                loop()
                took_us = 1e6 * (time.perf_counter() - start) / count
                best[name] = min(took_us, best.get(name, took_us))
        for name in ("step", "run"):
            ratio, bar = best[name] / best["C"], BARS.get((plots, name))
            is_missed |= bar is not None and ratio > bar
            print(f"{plots:3d} plots, {name:4s}: {best[name]:7.1f} us a scan, C {best['C']:7.1f}, "
                  f"ratio {ratio:.2f}" + (f", at most {bar}" if bar else ""))
    return is_missed


if __name__ == "__main__":
    sys.exit(main())
