# SPDX-License-Identifier: MIT
"""
Paper: Hough transforms that start tracks
=========================================

HT, MHT, IHT and NHT of Fan et al., *Neutrosophic Hough Transform-Based Track Initiation Method for
Multiple Target Tracking*, beside rhotrack's own method, on the same seven scans.
"""
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import rhotrack

# %%
# Five targets fly straight through a square of 50 km among 40 plots of clutter a scan, 5 s apart.
random = np.random.default_rng(5)
starts = np.array([(5e3, 10e3), (8e3, 20e3), (40e3, 45e3), (30e3, 5e3), (45e3, 30e3)])
speeds = np.array([(250, 50), (220, 0), (-200, -150), (0, 260), (-240, 60)])


def scan_at(time_s):
    places = np.concatenate([random.normal(starts + time_s * speeds, 10),
                             random.uniform(0, 50e3, (40, 2))])
    return {"t_s": np.full(45, time_s), "sensor_id": np.ones(45, int), "x_m": places[:, 0],
            "y_m": places[:, 1]}


scans = [pd.DataFrame(scan_at(5.0 * i)) for i in range(7)]

# %%
# The votes. Where all plots vote (HT), clutter covers the plane; MHT has pairs of successive scans
# vote, IHT those of a possible speed, and NHT those that other pairs confirm. Shown are cells with
# a quarter of the most votes; circles are the targets. Cells are 200 m and 20 mrad, as the noise of
# such short pairs wants them.
coarse = {"sigma_m": 10, "v_min_mps": 150, "v_max_mps": 350, "d_rho_m": 200,
          "d_theta_rad": 0.02, "eps_rho_m": 400, "eps_theta_rad": 0.03}
theta = (np.arctan2(speeds[:, 1], speeds[:, 0]) + np.pi / 2) % np.pi
rho_km = (starts[:, 0] * np.cos(theta) + starts[:, 1] * np.sin(theta)) / 1e3
figure, axes = plt.subplots(2, 2, figsize=(9, 7), sharex=True, sharey=True,
                            layout="constrained")
for method, ax in zip(("ht", "mht", "iht", "nht"), axes.flat):
    plane = rhotrack.Initiator(method=method, **coarse).accumulator(scans)
    row, cell = np.nonzero(plane.votes >= plane.votes.max() / 4)
    image = ax.scatter(plane.rho_m[cell] / 1e3, plane.theta_rad[row], s=3, c=plane.votes[row, cell],
                       cmap="viridis_r")
    ax.plot(rho_km, theta, "ro", mfc="none", ms=9)
    ax.set(title=method.upper(), xlim=(-50, 75), ylim=(0, np.pi))
    figure.colorbar(image, ax=ax, label="votes")
figure.supxlabel("rho, km")
figure.supylabel("theta, rad")

# %%
# The lines of each method with half of the most votes: how many targets are among them (within
# 400 m and 0.05 rad), and how many others there are. The default, ``kernel``, tests each line
# against the rate of false tracks that the settings allow.


def score(method):
    found = rhotrack.Initiator(method=method, **coarse).find(scans)
    off = np.abs(found["theta_rad"][:, None] - theta)
    turn = np.minimum(off, np.pi - off)
    sign = np.where(off > np.pi / 2, -1, 1)
    is_target = (turn < 0.05) & (np.abs(sign * found["rho_m"][:, None] / 1e3 - rho_km) < 0.4)
    return {"targets found": is_target.any(axis=0).sum(), "other lines": (~is_target.any(1)).sum()}


pd.DataFrame({method: score(method) for method in ("ht", "mht", "iht", "nht", "kernel")}).T
