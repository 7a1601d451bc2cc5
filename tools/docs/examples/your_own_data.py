# SPDX-License-Identifier: MIT
"""
Your own data
=============

A recording of a harbour radar as a file, as a data frame, and in the formats of others.
"""
import tempfile
from pathlib import Path

import pandas as pd

import rhotrack

# %%
# ``read`` takes the files that the program takes. The settings say what the file leaves open, here
# the noise of the plots, and what moves in the picture.
settings = rhotrack.Settings(sigma_m=5, v_max_mps=12, accel_max_mps2=0.5)
scans = rhotrack.read("../../scenes/harbour/2/plots.csv", settings=settings)
tracks = rhotrack.Tracker(settings).run(scans)
tracks

# %%
# Plots and tracks in one picture:
rhotrack.plot(scans, tracks).set(xlim=(-0.9, 0.3), ylim=(-0.6, 0.4))

# %%
# A data frame does as well: rows of one sensor and time that stand together are a scan.
frame = pd.read_csv("../../scenes/harbour/2/plots.csv")
print(frame.head(3))
again = rhotrack.Tracker(settings).run(frame)
print((again["x_m"] == tracks["x_m"]).all())

# %%
# What is wrong is named, with its place:
for change in ({"y_m": None}, {"sensor_id": 1.5}, {"x_m": 1e9}):
    try:
        rhotrack.Tracker(settings).run(frame.assign(**change))
    except rhotrack.Error as error:
        print(error)

# %%
# MATLAB reads the structs ``plots`` and ``tracks`` of a .mat file, and struct2table makes tables of
# them; ``rhotrack.read`` reads structs that are named alike. An .mcap file is for ROS 2
# (radar_msgs) and Foxglove (a scene of plots and tracks); it needs ``pip install rhotrack[mcap]``.
with tempfile.TemporaryDirectory() as folder:
    rhotrack.write(Path(folder) / "harbour.mat", scans, tracks)
    print(rhotrack.read(Path(folder) / "harbour.mat", settings=settings))
