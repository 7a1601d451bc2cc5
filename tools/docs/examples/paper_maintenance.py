# SPDX-License-Identifier: MIT
"""
Paper: input estimation and the Hough gate
==========================================

Liu's track maintenance: a filter that estimates the target's acceleration, and a choice among the
plots in the gate by their velocity.
"""
import matplotlib.pyplot as plt
import numpy as np

import rhotrack

# %%
# A target at 200 m/s brakes with 10 m/s² for 15 s; its place (20 m) and speed (2 m/s) are measured
# once a second.
random = np.random.default_rng(2)
times = np.arange(60)
accel = np.where((times >= 20) & (times < 35), -10.0, 0.0)
speed = 200 + np.cumsum(accel)
place = np.cumsum(speed) - accel / 2
measured = np.stack([random.normal(place, 20), random.normal(speed, 2)], axis=1)


def started():
    filter = rhotrack.Kalman()
    filter.open_axis(0, measured[0, 0], 400, 1e4)
    return filter


# %%
# A plain Kalman filter that believes in straight flight, and the same with input estimation: the
# input is found by a chi-square test of the innovations, and corrects the estimate.
plain, estimation = started(), rhotrack.InputEstimation(
    started(), model="physical", noise_m=1, noise_mps=1, sigma_mps2=10)
errors, inputs = [], []
for z in measured[1:]:
    plain.predict(1.0, 0.01)
    estimation.predict(1.0)
    for element, value, variance in ((0, z[0], 400), (3, z[1], 4)):
        plain.update(element, value, variance)
        estimation.update(element, value, variance)
    estimation.decide()
    errors.append((plain.state[0], estimation.estimate.state[0]))
    inputs.append(estimation.input_mps2[0] if estimation.is_present[0] else 0)

figure, (top, bottom) = plt.subplots(2, sharex=True, layout="constrained")
top.plot(times[1:], np.array(errors) - place[1:, None], label=["Kalman", "input estimation"])
top.set_ylabel("error of the place, m")
top.legend()
bottom.step(times, accel, "k:", where="post", label="true")
bottom.plot(times[1:], inputs, "C1", label="estimated input")
bottom.set(xlabel="time, s", ylabel="acceleration, m/s²")
bottom.legend()

# %%
# The Hough gate: of the plots near the prediction it takes that whose velocity best continues the
# line through the last two estimates in velocity space; it does not ask how far a plot is.
before, newest = (200, 0, 0), (190, 2, 0)
velocities = np.array([(181, 4, 0), (190, 40, 0), (150, 10, 0), (200, -30, 0)])
residuals = rhotrack.HoughGate(before, newest, planes="xy").residuals_mps(velocities)
figure, ax = plt.subplots(layout="constrained")
ax.plot(*np.array([before, newest])[:, :2].T, "ko-", label="last two estimates")
ax.scatter(*velocities[:, :2].T, c="C1", label="plots, with residual in m/s")
for velocity, residual in zip(velocities, residuals):
    ax.annotate(f" {residual:.2f}", velocity[:2])
ax.plot(*velocities[residuals.argmin(), :2], "o", ms=14, mfc="none", mec="C2", label="taken")
ax.set(xlabel="vx, m/s", ylabel="vy, m/s")
ax.legend()
