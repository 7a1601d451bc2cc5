# SPDX-License-Identifier: MIT
"""Files of others: MATLAB, MCAP; and CSV as the program writes it."""
from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from . import mcap, scans
from ._core import Error
from .settings import Settings


def convert(source: str | os.PathLike, target: str | os.PathLike,
            settings: Settings | None = None, kind: str | None = None, **parameters: Any) -> None:
    """Reads a file as `read` does, and writes it as `write` does."""
    write(target, scans.read(source, settings=settings, kind=kind, **parameters))


def write(path: str | os.PathLike, *data: Any) -> None:
    """Writes scans, tracks and truth, arrays or data frames, told apart by their fields.

    NAME.csv: one of them, with the columns that the program reads. NAME.mat: the structs plots,
    tracks and truth, a column vector a field; struct2table makes tables of them in MATLAB.
    NAME.mcap: scans of plots and tracks, for ROS 2 and Foxglove: radar_msgs/RadarScan on
    /radar_N/scan, in the frame radar_N of a sensor N, radar_msgs/RadarTracks on /tracks and
    foxglove.SceneUpdate on /scene, in the frame map. These messages have no sigmas of plots, no
    velocities of plots other than the range rate, and one time a scan.
    """
    tables = {kind: rows for one in data for kind, rows in [_kind_and_rows(one)]}
    suffix = Path(path).suffix
    if suffix == ".mat":
        _write_mat(path, {"plots" if kind == "scans" else kind: rows
                          for kind, rows in tables.items()})
    elif suffix == ".mcap":
        mcap.write(path, [one for one in data if _kind_and_rows(one)[0] == "scans"],
                   tables.get("tracks"))
    elif suffix == ".csv" and len(tables) == 1:
        Path(path).write_text(csv_of(_as_files_have(*tables.values())))
    else:
        raise Error(f"{os.fspath(path)}: one table to .csv, or several to .mat or .mcap")


def _kind_and_rows(data: Any) -> tuple[str, np.ndarray]:
    rows = scans.rows_of(data)
    return kind_of(rows.dtype.names), rows


def kind_of(names: Any) -> str:
    """ "tracks", "truth" or "scans", by the names of the fields."""
    return ("tracks" if "track_id" in names else
            "truth" if "target_id" in names and "sensor_id" not in names else "scans")


# ---- CSV ----

def _as_files_have(rows: np.ndarray) -> np.ndarray:
    """Noise across the line of sight is an azimuth's in files, and the plot is polar; where it is
    that along the line it is sigma_m."""
    names = rows.dtype.names
    if "sigma_cross_m" not in names or "x_m" not in names:
        return rows
    table = {name: rows[name] for name in names if name not in (
        "x_m", "y_m", "z_m", "sigma_range_m", "sigma_cross_m", "sigma_up_m")}
    sigmas = [rows[name] for name in ("sigma_range_m", "sigma_cross_m", "sigma_up_m")
              if name in names]
    if all(np.array_equal(sigmas[0], one, equal_nan=True) for one in sigmas):
        return scans.records({**table, **{name: rows[name] for name in ("x_m", "y_m", "z_m")
                                          if name in names}, "sigma_m": sigmas[0]})
    range_m, azimuth, elevation = scans.polar_of(rows)
    table |= {"range_m": range_m, "azimuth_rad": azimuth, "sigma_range_m": sigmas[0],
              "sigma_azimuth_rad": sigmas[1] / (range_m * np.cos(np.nan_to_num(elevation)))}
    if "z_m" in names:
        table |= {"elevation_rad": elevation, "sigma_elevation_rad": sigmas[2] / range_m}
    return scans.records(table)


def csv_of(rows: np.ndarray) -> str:
    """Rows as the program writes them: times to the microsecond, floats with as few digits, 6 at
    least, as keep them; NaN is an empty cell."""
    columns = [[f"{time:.6f}" for time in rows[name]] if name == "t_s"
               else [_number(one) for one in rows[name]] if rows.dtype[name].kind == "f"
               else [str(one) for one in rows[name]] for name in rows.dtype.names]
    return "".join(",".join(line) + "\n" for line in [rows.dtype.names, *zip(*columns)])


def _number(value: Any) -> str:
    value = np.float32(value) + np.float32(0)  # no -0
    if np.isnan(value):
        return ""
    return next(text for digits in range(6, 10)
                if np.float32(text := f"{float(value):.{digits}g}") == value or digits == 9)


# ---- MATLAB ----

def read_mat(path: str | os.PathLike, kind: str | None) -> np.ndarray:
    """Rows of a struct of columns, an array of structs, or columns as variables of their own."""
    from scipy.io import loadmat
    try:
        found = loadmat(path, simplify_cells=True)
    except NotImplementedError:
        raise Error(
            f"{os.fspath(path)}: HDF5; save(..., '-v7') writes a file that is read") from None
    tables = [scans.of_dicts(list(one)) if isinstance(one, (list, np.ndarray)) else one
              for one in [found, *found.values()]
              if isinstance(one, dict) or (isinstance(one, (list, np.ndarray)) and len(one)
                                           and isinstance(one[0], dict))]
    tables = [{name: column for name, column in one.items() if not name.startswith("__")
               and not isinstance(column, dict)} for one in tables if "t_s" in one]
    for one in tables:
        if kind in (None, kind_of(one)):
            return scans.records(one)
    raise Error(f"{os.fspath(path)}: no struct with the field t_s"
                + (f" that holds {kind}" if kind else ""))


def _write_mat(path: str | os.PathLike, tables: dict[str, np.ndarray]) -> None:
    from scipy.io import savemat
    savemat(path, {kind: {name: rows[name].astype(object) if rows.dtype[name].kind == "U"
                          else rows[name] for name in rows.dtype.names}
                   for kind, rows in tables.items()},
            oned_as="column", long_field_names=True, do_compression=True)
