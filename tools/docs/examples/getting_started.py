# SPDX-License-Identifier: MIT
"""
Getting started
===============

Three aircraft among clutter, in memory: scans in, tracks out.
"""
import numpy as np

import rhotrack

# %%
# A scan is a structured array whose fields are named as the columns of a CSV file. A radar that
# turns once in 4 s sees each aircraft nine times in ten, with 30 m of noise, and 60 plots of
# clutter.
random = np.random.default_rng(7)
starts = np.array([(-30e3, 5e3), (20e3, -25e3), (5e3, 30e3)])
speeds = np.array([(220, 40), (-120, 150), (0, -180)])


def scan_at(time_s):
    seen = (starts + time_s * speeds)[random.random(3) < 0.9]
    places = np.concatenate([random.normal(seen, 30), random.uniform(-40e3, 40e3, (60, 2))])
    scan = np.zeros(len(places), [("t_s", "f8"), ("sensor_id", "i4"),
                                  ("x_m", "f4"), ("y_m", "f4")])
    scan["t_s"], scan["sensor_id"] = time_s, 1
    scan["x_m"], scan["y_m"] = places.T
    return scan


scans = [scan_at(4.0 * i) for i in range(40)]

# %%
# The tracker needs the noise of the plots and the speed of the targets; all else has defaults.
tracker = rhotrack.Tracker(sigma_m=30, v_max_mps=300)
tracks = tracker.run(scans)
rhotrack.plot(scans, tracks)
tracks

# %%
# Tracks are an array, too: a row each track and scan. Live, ``step`` takes a scan at a time and
# returns the rows of its time.
print(tracks[tracks["t_s"] == 156][["track_id", "x_m", "y_m", "sigma_m"]])

# %%
# What became of the plots of the last scan:
fates, counts = np.unique(tracker.fates, return_counts=True)
print(dict(zip(fates.tolist(), counts.tolist())))
