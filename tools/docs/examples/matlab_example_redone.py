# SPDX-License-Identifier: MIT
"""
For MATLAB users: tracking a manoeuvring target
===============================================

The example *Tracking Maneuvering Targets* of MATLAB's Sensor Fusion and Tracking Toolbox, step by
step. Its filters are written here in numpy from their documentation, as the toolbox itself cannot
be run here: its random numbers are others, and its figures are not compared digit by digit.
"""
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import rhotrack

# %%
# Define a scenario
# -----------------
# A target flies 33 s straight at 200 m/s, turns at 10 degrees a second for 33 s, then accelerates
# at 3 m/s². Its place is measured every 0.1 s, with a noise of 1 m.
DT, STEPS = 0.1, 1001
times = DT * np.arange(STEPS)
heading = np.deg2rad(10) * np.clip(times - 33.3, 0, 33.3)
speed = 200 + 3 * np.clip(times - 66.6, 0, None)
fine = np.linspace(0, times[-1], 100 * (STEPS - 1) + 1)  # the path is integrated, midpoint rule
middle = (fine[1:] + fine[:-1]) / 2
pace = np.interp(middle, times, speed) * np.exp(1j * np.interp(middle, times, heading))
path = np.concatenate([[0], np.cumsum(pace) * (fine[1] - fine[0])])[::100]
truth = np.stack([path.real, path.imag], axis=1)
measured = truth + np.random.default_rng(2018).normal(0, 1, truth.shape)
parts = {"straight": times < 33.3, "turn": (times >= 33.3) & (times < 66.6),
         "acceleration": times >= 66.6}
estimates = {}

# %%
# A constant-velocity filter
# --------------------------
# ``trackingEKF(@constvel, ...)``: the acceleration is white noise of variance 1 or, in the second
# step of the example, 50, constant over a step. ``rhotrack.Kalman`` has the same state, and noise
# of a density in its place: density = variance * DT adds as much to the velocity.


def constvel(variance):
    f, g = np.eye(4), np.array([DT**2 / 2, DT])
    f[0, 1] = f[2, 3] = DT
    q = variance * np.kron(np.eye(2), np.outer(g, g))
    x, p = np.array([measured[0, 0], 0, measured[0, 1], 0]), np.diag([1, 1e4, 1, 1e4])
    for z in measured[1:]:
        x, p = f @ x, f @ p @ f.T + q
        gain = p[:, ::2] @ np.linalg.inv(p[::2, ::2] + np.eye(2))
        x, p = x + gain @ (z - x[::2]), p - gain @ p[::2]
        yield x[::2]


def kalman(variance):
    filter = rhotrack.Kalman()
    for axis in (0, 1):
        filter.open_axis(axis, measured[0, axis], 1, 1e4)
    for z in measured[1:]:
        filter.predict(DT, variance * DT)
        for axis in (0, 1):
            filter.update(axis, z[axis], 1)
        yield filter.state[:2]


for variance in (1, 50):
    estimates[f"constvel, {variance}"] = np.array(list(constvel(variance)))
    estimates[f"rhotrack.Kalman, {variance}"] = np.array(list(kalman(variance)))

# %%
# Several models
# --------------
# ``trackingIMM`` with constant velocity, acceleration and turn; a model stays with probability 0.9.
# All three have one state here, [x vx ax y vy ay omega], in which they are mixed.


def moved(model, s):
    x, vx, ax, y, vy, ay, w = s
    if model == "turn":
        w = np.where(np.abs(w) < 1e-9, 1e-9, w)
        a, sin, cos = w * DT, np.sin(w * DT) / w, (1 - np.cos(w * DT)) / w
        return np.stack([x + sin * vx - cos * vy, vx * np.cos(a) - vy * np.sin(a), 0 * x,
                         y + cos * vx + sin * vy, vx * np.sin(a) + vy * np.cos(a), 0 * x, w])
    ax, ay = (ax, ay) if model == "acceleration" else (0 * x, 0 * x)
    return np.stack([x + vx * DT + ax * DT**2 / 2, vx + ax * DT, ax,
                     y + vy * DT + ay * DT**2 / 2, vy + ay * DT, ay, 0 * x])


def imm():
    models = ("velocity", "acceleration", "turn")
    g = np.zeros((7, 3))
    g[:3, 0] = g[3:6, 1] = DT**2 / 2, DT, 0
    noise = {model: g[:, :2] @ g[:, :2].T + np.diag([0, 0, 1, 0, 0, 1, 1e-4]) for model in models}
    noise["turn"][6, 6] = (np.deg2rad(1) * DT)**2  # 1 degree/s²
    stay = np.full((3, 3), 0.05) + 0.85 * np.eye(3)
    first = np.zeros(7)
    first[[0, 3]] = measured[0]
    x = np.tile(first, (3, 1))
    p = np.tile(np.diag([1, 1e4, 1, 1, 1e4, 1, 1e-2]), (3, 1, 1))
    share = np.full(3, 1 / 3)
    for z in measured[1:]:
        share, mix = stay.T @ share, stay * share[:, None] / (stay.T @ share)
        mean = mix.T @ x
        off = x[:, None] - mean[None]
        p = np.einsum("ij,iab->jab", mix, p) + np.einsum("ij,ija,ijb->jab", mix, off, off)
        x, likelihood = mean.copy(), np.empty(3)
        for i, model in enumerate(models):
            step = 1e-4 * np.eye(7)
            jacobian = (moved(model, (x[i] + step).T) - moved(model, (x[i] - step).T)) / 2e-4
            x[i] = moved(model, x[i][:, None])[:, 0]
            p[i] = jacobian @ p[i] @ jacobian.T + noise[model]
            s, d = p[i][::3, ::3][:2, :2] + np.eye(2), z - x[i, [0, 3]]
            gain = p[i][:, [0, 3]] @ np.linalg.inv(s)
            likelihood[i] = np.exp(-d @ np.linalg.inv(s) @ d / 2) / np.sqrt(np.linalg.det(s))
            x[i], p[i] = x[i] + gain @ d, p[i] - gain @ p[i][[0, 3]]
        share = share * likelihood + 1e-300
        share /= share.sum()
        yield (share @ x)[[0, 3]]


# %%
# ``rhotrack.Imm`` has two models, a steady one and one that manoeuvres with up to accel_max_mps2;
# 200 m/s and 10 degrees a second are 35 m/s². ``rhotrack.Tracker`` starts the track, too.
scans = [np.array([(t, 1, *z, 1.0)], [("t_s", "f8"), ("sensor_id", "i4"), ("x_m", "f4"),
                                      ("y_m", "f4"), ("sigma_m", "f4")])
         for t, z in zip(times, measured)]


def rhotrack_imm():
    start = rhotrack.Kalman()
    for axis in (0, 1):
        start.open_axis(axis, measured[0, axis], 1, 1e4)
    filter = rhotrack.Imm(start, accel_max_mps2=40, v_max_mps=400)
    for scan in scans[1:]:
        filter.predict(DT)
        filter.update(scan)
        yield filter.estimate.state[:2]


estimates["imm of three models"] = np.array(list(imm()))
estimates["rhotrack.Imm"] = np.array(list(rhotrack_imm()))
tracks = rhotrack.Tracker(sigma_m=1, v_max_mps=400, accel_max_mps2=40).run(scans)
found = np.full((STEPS, 2), np.nan)
found[np.searchsorted(times, tracks["t_s"] - DT / 2)] = np.stack([tracks["x_m"], tracks["y_m"]], 1)
estimates["rhotrack.Tracker"] = found[1:]

# %%
# Results
# -------
# Root mean square errors of the place in metres, after the first 3 s of each part. What the example
# finds is found again: a constant-velocity filter is best until the target turns, then it is off;
# more noise keeps it near, at the price of noisier estimates; several models have both.
pd.set_option("display.precision", 2)
begun = {name: is_in & (times > times[is_in][0] + 3) for name, is_in in parts.items()}
error = {name: np.linalg.norm(one - truth[1:], axis=1) for name, one in estimates.items()}
pd.DataFrame({part: {name: np.sqrt(np.nanmean(off[is_in[1:]]**2)) for name, off in error.items()}
              for part, is_in in begun.items()})

# %%
# Errors over time:
figure, ax = plt.subplots(layout="constrained")
for name in ("constvel, 1", "constvel, 50", "imm of three models", "rhotrack.Imm"):
    ax.semilogy(times[1:], np.convolve(error[name], np.ones(10) / 10, "same"), lw=1, label=name)
ax.set(xlabel="time, s", ylabel="error of the place, m, mean over 1 s")
ax.legend()
