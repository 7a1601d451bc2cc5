# SPDX-License-Identifier: MIT
"""
Paper: passive sensors, ghosts and lines
========================================

Two and three sensors measure bearings alone: their crossings are targets and ghosts, and the
crossings of many frames lie on lines where targets fly.
"""
import matplotlib.pyplot as plt
import numpy as np

import rhotrack

# %%
# Three sensors see three targets every 10 s, with a noise of 0.1 degrees.
random = np.random.default_rng(4)
sensors = np.array([(0.0, -10e3), (0.0, 10e3), (10e3, 0.0)])
starts = np.array([(60e3, 30e3), (50e3, -30e3), (65e3, 0.0)])
speeds = np.array([(-200, -100), (-150, 200), (-250, 20)])
FRAME = [("t_s", "f8"), ("sensor_id", "i4"), ("sensor_x_m", "f4"), ("sensor_y_m", "f4"),
         ("bearing_rad", "f4"), ("sigma_rad", "f4")]


def frame_at(time_s):
    away = (starts + time_s * speeds)[None] - sensors[:, None]
    bearings = random.normal(np.arctan2(away[..., 1], away[..., 0]), 0.00175)
    return np.array([(time_s, i + 1, *sensors[i], bearing, 0.00175)
                     for i in range(3) for bearing in bearings[i]], FRAME)


frames = [frame_at(10.0 * i) for i in range(8)]

# %%
# The ghost matrix of the first two sensors: each of their bearings with each. Crossings beside or
# behind a sensor, or too far, are ghosts at once; the rules of rows and columns prune others.
search = rhotrack.Passive(method="passive-paper", v_max_mps=450)
ghosts = search.ghosts(frames[0])[1, 2]
print(ghosts.reason)
figure, ax = plt.subplots(layout="constrained")
rhotrack.plot(frames[:1], ax=ax)
ax.plot(ghosts.x_m / 1e3, ghosts.y_m / 1e3, "rx", label="crossings of sensors 1 and 2")
ax.plot(*starts.T / 1e3, "ko", mfc="none", ms=9, label="targets")
ax.set(xlim=(-5, 80), ylim=(-40, 40))
handles = dict(zip(*ax.get_legend_handles_labels()[::-1]))
ax.legend(handles.values(), handles.keys())

# %%
# The accumulator of each pair of sensors counts the frames whose crossings lie on a line (rho,
# theta). Lines where all pairs have enough votes are the paper's tracks (crosses).
planes, lines = search.accumulators(frames), search.find(frames)
middle = sensors.mean(axis=0)
figure, axes = plt.subplots(1, 3, figsize=(10, 3.6), sharey=True, layout="constrained")
for (pair, plane), ax in zip(planes.items(), axes):
    image = ax.pcolormesh(plane.rho_m / 1e3, plane.theta_rad, plane.votes, cmap="Blues")
    ax.plot((lines["rho_m"] - np.cos(lines["theta_rad"]) * middle[0]
             - np.sin(lines["theta_rad"]) * middle[1]) / 1e3, lines["theta_rad"], "r+", ms=12)
    ax.set(title=f"sensors {pair[0]} and {pair[1]}", xlabel="rho, km", xlim=(-80, 80))
axes[0].set_ylabel("theta, rad")
figure.colorbar(image, label="frames")

# %%
# The default does not need a pair to have all votes: it fits straight flight to the bearings of all
# sensors and tests the fit, and Tracker goes on from there.
rhotrack.Tracker(v_max_mps=450).run(frames)
