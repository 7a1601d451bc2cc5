# SPDX-License-Identifier: MIT
"""Scans, tracks and truth from above, with matplotlib."""
from __future__ import annotations

import base64
import html
import io
from typing import Any

import numpy as np

from ._core import Error
from . import scans


def plot(*data: Any, ax: Any = None) -> Any:
    """Draws scans (dots), tracks and truth (lines) in the plane, km east and north; returns the
    axes.

    Each of data is Scans, an array or a data frame, told apart by its fields: track_id, target_id,
    or x_m and y_m. Tracks that were never confirmed are left out; confirmed ones are solid from
    their first row on. Bearings are drawn as rays of the length of the picture.
    """
    if ax is None:
        import matplotlib.pyplot as plt
        ax = plt.subplots()[1]
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
    if first:
        ax.legend(first.values(), first.keys())
    return ax


def _arrays(data: Any) -> list[np.ndarray]:
    if isinstance(data, (scans.Scans, list, tuple)):
        by_fields: dict[tuple, list[np.ndarray]] = {}
        for scan in data:
            by_fields.setdefault(scan.dtype.names, []).append(scan)
        return [np.concatenate(kind) for kind in by_fields.values()]
    return [scans.records(data)]


def _confirmed(tracks: np.ndarray) -> np.ndarray:
    if "status" not in tracks.dtype.names:
        return tracks
    ids = np.unique(tracks["track_id"][tracks["status"] == "confirmed"])
    return tracks[np.isin(tracks["track_id"], ids)]


def _draw_paths(ax: Any, rows: np.ndarray, key: str, style: str, label: str) -> None:
    for one in np.unique(rows[key]):
        path = rows[rows[key] == one]
        ax.plot(path["x_m"] / 1e3, path["y_m"] / 1e3, style, lw=1, marker=".", markevery=[-1],
                label=label)


def _draw_rays(ax: Any, rows: np.ndarray) -> None:
    rows = rows[~np.isnan(rows["bearing_rad"])]
    x_km, y_km = rows["sensor_x_m"] / 1e3, rows["sensor_y_m"] / 1e3
    apart = max(np.ptp(x_km), np.ptp(y_km)) if len(rows) else 0
    length = max(np.ptp(ax.get_xlim()), np.ptp(ax.get_ylim()), 5 * apart)
    ends = (x_km + length * np.cos(rows["bearing_rad"]),
            y_km + length * np.sin(rows["bearing_rad"]))
    ax.plot([x_km, ends[0]], [y_km, ends[1]], color="0.8", lw=0.3, zorder=0, label="bearings")
    ax.plot(x_km, y_km, "k^", ms=5, label="sensors")


SHOWN = ["track_id", "status", "t_s", "x_m", "y_m", "vx_mps", "vy_mps", "sigma_m", "hits", "misses"]
ROWS_MAX = 30


def png_of(*data: Any) -> bytes | None:
    """The picture as a file; None without matplotlib."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        return None
    figure, file = Figure(), io.BytesIO()
    FigureCanvasAgg(figure)
    plot(*data, ax=figure.add_subplot())
    figure.savefig(file, format="png")
    return file.getvalue()


def html_of(tracks: np.ndarray) -> str:
    """The picture of tracks, and the last row of each that was confirmed, newest first."""
    kept = _confirmed(tracks)
    last = kept[[np.flatnonzero(kept["track_id"] == one)[-1] for one in
                 np.unique(kept["track_id"])]] if kept.size else kept
    last = last[::-1][:ROWS_MAX]
    names = [name for name in SHOWN if name in tracks.dtype.names]
    head = "".join(f"<th>{name}</th>" for name in names)
    body = "".join("<tr>" + "".join(f"<td>{_cell(row[name])}</td>" for name in names) + "</tr>"
                   for row in last)
    picture = png_of(tracks) if {"x_m", "y_m"} <= set(tracks.dtype.names) else None
    image = (f'<img alt="tracks from above" src="data:image/png;base64,'
             f'{base64.b64encode(picture).decode()}">' if picture else "")
    return (f"{image}<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
            f"<p>{len(tracks)} rows; {len(np.unique(kept['track_id']))} confirmed tracks, the last "
            f"row of {len(last)}</p>")


def _cell(value: Any) -> str:
    return f"{value:.1f}" if isinstance(value, np.floating) else html.escape(str(value))
