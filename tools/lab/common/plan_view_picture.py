# SPDX-License-Identifier: MIT
"""Plan view of one run: truth, plots, tracks, and what is false among them."""
import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

INK, PLOT, TRUTH, TRACK, FALSE = "#333333", "#9aa3ad", "#2a9d5c", "#1f5fbf", "#d1242f"
PLOTS_MAX = 20000  # more would be a grey disc


def lines(by_track):
    """Rows (track, scan, x, y) in one line a track, broken where scans lack."""
    if not by_track:
        return np.empty(0), np.empty(0)
    rows = np.array(sorted(by_track))
    breaks = np.nonzero((np.diff(rows[:, 0]) != 0) | (np.diff(rows[:, 1]) != 1))[0] + 1
    return np.insert(rows[:, 2], breaks, np.nan) / 1e3, np.insert(rows[:, 3], breaks, np.nan) / 1e3


def coverage(axes, sensors):
    for sensor in sensors.values():
        width = (sensor.sector_to_rad - sensor.sector_from_rad) % (2 * np.pi)
        angle = np.linspace(sensor.sector_from_rad, sensor.sector_from_rad + (width or 2 * np.pi),
                            361)
        x = sensor.x_m + sensor.range_max_m * np.cos(angle)
        y = sensor.y_m + sensor.range_max_m * np.sin(angle)
        if width:
            x, y = np.r_[sensor.x_m, x, sensor.x_m], np.r_[sensor.y_m, y, sensor.y_m]
        axes.plot(x / 1e3, y / 1e3, color=INK, linewidth=0.6, linestyle=(0, (4, 4)))
        axes.plot(sensor.x_m / 1e3, sensor.y_m / 1e3, "^", color=INK, markersize=5)


def plan(path, title, sensors, plots, truth, tracks, false_rows):
    figure, axes = plt.subplots(figsize=(10, 10), dpi=110)
    if plots is not None and len(plots.place_m):
        shown = plots.place_m[::max(1, -(-len(plots.place_m) // PLOTS_MAX))] / 1e3
        axes.plot(shown[:, 0], shown[:, 1], ".", color=PLOT, markersize=2.4, alpha=0.5,
                  markeredgewidth=0, rasterized=True, label="plots")
    coverage(axes, sensors)
    for j in range(truth.place_m.shape[1]):
        place = truth.place_m[:, j] / 1e3
        axes.plot(place[:, 0], place[:, 1], color=TRUTH, linewidth=3.2, alpha=0.22,
                  solid_capstyle="round")
        place = np.where(truth.visible[:, j, None], place, np.nan)
        axes.plot(place[:, 0], place[:, 1], color=TRUTH, linewidth=3.2, alpha=0.45,
                  solid_capstyle="round", label="truth (pale: out of coverage)" if j == 0 else None)
    is_false = set(false_rows)
    good, bad = [], []
    for k, (ids, places) in enumerate(zip(tracks.ids, tracks.place_m)):
        for col, track in enumerate(ids.tolist()):
            (bad if (k, col) in is_false else good).append((track, k, *places[col].tolist()))
    axes.plot(*lines(good), color=TRACK, linewidth=0.9, label="tracks")
    axes.plot(*lines(bad), color=FALSE, linewidth=0.9, marker=".", markersize=2.5,
              label="false tracks")
    places = np.array([(s.x_m, s.y_m, s.range_max_m * 1.06) for s in sensors.values()]) / 1e3
    low, high = (places[:, :2] - places[:, 2:]).min(axis=0), (places[:, :2] +
                                                              places[:, 2:]).max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xlabel="x km",
             ylabel="y km")
    axes.set_title(title, parse_math=False)
    axes.legend(loc="upper right", fontsize=8, framealpha=0.9, markerscale=3)
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)
