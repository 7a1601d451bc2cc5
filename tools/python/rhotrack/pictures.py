# SPDX-License-Identifier: MIT
"""Scans, tracks and truth from above, with matplotlib."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._core import Error
from .scans import Scans, records


def plot(*data: Any, ax: Any = None) -> Any:
    """Draws scans (dots), tracks and truth (lines) in the plane, km east and north; returns the
    axes.

    Each of data is Scans, an array or a data frame, told apart by its fields: track_id, target_id,
    or x_m and y_m. Tracks that were never confirmed are left out; confirmed ones are solid from
    their first row on. Bearings are drawn as rays of the length of the picture.
    """
    import matplotlib.pyplot as plt

    ax = ax or plt.subplots()[1]
    rows = [row for one in data for row in _arrays(one)]
    for one in rows:
        names = one.dtype.names
        if "track_id" in names:
            _draw_paths(ax, _confirmed(one), "track_id", "-", "track")
        elif "target_id" in names and "sensor_id" not in names:
            _draw_paths(ax, one, "target_id", "k:", "truth")
        elif "x_m" in names:
            ax.plot(one["x_m"] / 1e3, one["y_m"] / 1e3, ".", color="0.7", ms=2, zorder=0,
                    label="plots")
        elif "bearing_rad" not in names:
            raise Error("none of the fields track_id, target_id, x_m and bearing_rad is there")
    for one in rows:
        if "bearing_rad" in one.dtype.names:
            _draw_rays(ax, one)
    ax.set(xlabel="east, km", ylabel="north, km")
    ax.set_aspect("equal", "datalim")
    handles, labels = ax.get_legend_handles_labels()
    first = dict(zip(labels[::-1], handles[::-1]))
    ax.legend(first.values(), first.keys())
    return ax


def _arrays(data: Any) -> list[np.ndarray]:
    if isinstance(data, (Scans, list, tuple)):
        by_fields: dict[tuple, list[np.ndarray]] = {}
        for scan in data:
            by_fields.setdefault(scan.dtype.names, []).append(scan)
        return [np.concatenate(scans) for scans in by_fields.values()]
    return [records(data)]


def _confirmed(tracks: np.ndarray) -> np.ndarray:
    if "status" not in tracks.dtype.names:
        return tracks
    ids = np.unique(tracks["track_id"][tracks["status"] == "confirmed"])
    return tracks[np.isin(tracks["track_id"], ids)]


def _draw_paths(ax: Any, rows: np.ndarray, key: str, style: str, label: str) -> None:
    for one in np.unique(rows[key]):
        path = rows[rows[key] == one]
        ax.plot(path["x_m"] / 1e3, path["y_m"] / 1e3, style, lw=1, label=label)


def _draw_rays(ax: Any, rows: np.ndarray) -> None:
    rows = rows[~np.isnan(rows["bearing_rad"])]
    x_km, y_km = rows["sensor_x_m"] / 1e3, rows["sensor_y_m"] / 1e3
    length = max(np.ptp(ax.get_xlim()), np.ptp(ax.get_ylim()))
    ends = (x_km + length * np.cos(rows["bearing_rad"]),
            y_km + length * np.sin(rows["bearing_rad"]))
    ax.plot([x_km, ends[0]], [y_km, ends[1]], color="0.8", lw=0.3, zorder=0, label="bearings")
    ax.plot(x_km, y_km, "k^", ms=5, label="sensors")
