# SPDX-License-Identifier: MIT
"""Scans: what sensors saw, as structured arrays whose fields are the columns of CSV files."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Iterable

import numpy as np

from ._core import Error, array_of, dtype_of, ffi, lib, must, pointer_to
from .settings import Settings, settings_of

ROW = dtype_of("program_row")
TRACK = dtype_of("program_track")
COVARIANCE = [f"cov_{a}_{b}" for i, a in enumerate(["x", "y", "z", "vx", "vy", "vz"])
              for b in ["x", "y", "z", "vx", "vy", "vz"][:i + 1]]
_BLANK = np.zeros((), ROW)
for _name in ROW.names:
    if ROW[_name].kind == "f":
        _BLANK[_name] = np.nan
_BLANK = _BLANK.reshape(1).view(f"V{ROW.itemsize}")[0]  # as bytes: filled ten times as fast


class Scans(Sequence):
    """Scans and frames in the order of time; scans[i] is a structured array of one.

    Fields of a row (float32 but t_s, float64, and sensor_id, int32; NaN or no field: not said):
    t_s, sensor_id; x_m, y_m[, z_m][, vx_mps, vy_mps, vz_mps], or range_m, azimuth_rad (or
    azimuth_deg, clockwise from north)[, elevation_rad], or bearing_rad; range_rate_mps; their
    sigma_...; sector_from_rad, sector_to_rad; sensor_x_m, sensor_y_m, sensor_z_m; snr_db. Noise of
    places is sigma_m, or sigma_range_m, sigma_cross_m and sigma_up_m along the line of sight,
    across it and upwards. Metres, seconds, radians counter-clockwise from east.

    A row without a plot stands for the scan: its t_s is the scan's, and alone it is a scan that saw
    nothing. Else the first row's t_s is. The rows of a frame are the bearings of several sensors,
    those of a sensor together.

    data is a list of such arrays, or one array or data frame of many scans: rows of one sensor_id
    and t_s (or of one field scan) that stand together are a scan, and scans of bearings within
    frame_tolerance_s a frame. counts, one a scan, says instead how many rows of one array each has.

    Times are taken as they are, and bearings; of polar rows the range and azimuth biases of the
    settings are subtracted.
    """

    def __init__(self, data: Any, settings: Settings | None = None, counts: Any = None) -> None:
        settings = settings or Settings()
        if counts is None:
            rows, counts, are_frames = _flat(
                data if _is_list(data) else _split(records(data), settings))
        else:
            array, counts = records(data), np.asarray(counts, "u4")
            rows, are_frames = _full(array), np.full(len(counts), "bearing_rad" in array.dtype.names)
            if counts.sum() != len(rows):
                raise Error(f"counts of {counts.sum()} rows, and there are {len(rows)}")
        handle = lib.program_scans(
            pointer_to(rows, "struct program_row *"), pointer_to(counts, "uint32_t *"),
            pointer_to(are_frames, "bool *"), len(counts), settings.handle)
        self._own(must(handle))

    @classmethod
    def _of(cls, handle: Any) -> Scans:
        scans = cls.__new__(cls)
        scans._own(handle)
        return scans

    def _own(self, handle: Any) -> None:
        self.handle = ffi.gc(handle, lib.program_scans_free)
        self._columns: dict[bool, list[str]] = {}

    def __len__(self) -> int:
        return self.handle.count

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        index = range(len(self))[index]
        rows = self._rows(index)
        is_frame = self.handle.list[index].is_frame
        if is_frame not in self._columns:
            self._columns[is_frame] = self._find_columns(is_frame)
        return _picked(rows, self._columns[is_frame])

    def _rows(self, index: int) -> np.ndarray:
        scan = ffi.addressof(self.handle.list[index])
        rows = np.empty(lib.program_scan_num_rows(scan), ROW)
        lib.program_scan_rows(scan, pointer_to(rows, "struct program_row *"))
        return rows

    def _find_columns(self, is_frame: bool) -> list[str]:
        """Fields that any row has, so that all scans of a kind have the same."""
        held = dict.fromkeys(ROW.names, False)
        for i in range(len(self)):
            if self.handle.list[i].is_frame == is_frame:
                rows = self._rows(i)
                for name in ROW.names:
                    held[name] = held[name] or not np.isnan(rows[name]).all()
        return [name for name in ROW.names if held[name]]

    @property
    def rows(self) -> np.ndarray:
        """The rows of all scans in one array."""
        if len({self.handle.list[i].is_frame for i in range(len(self))}) > 1:
            raise Error("plots and bearings have other fields: take them scan by scan")
        return np.concatenate(self[:]) if len(self) else np.empty(0, ROW)

    def __repr__(self) -> str:
        return f"<{len(self)} scans>"


def as_scans(data: Any, settings: Settings) -> Scans:
    """Scans as they are, all else made into scans."""
    return data if isinstance(data, Scans) else Scans(data, settings)


def read(*paths: str | os.PathLike, settings: Settings | None = None, kind: str | None = None,
         keep_going: bool = False, **parameters: Any) -> Any:
    """Reads what the program reads: CSV files, LCM logs, ASTERIX recordings; several are merged.

    Plots and bearings give Scans. A file of tracks or truth gives one structured array, a row each
    track or target and time; of an LCM log where kind is "tracks" or "truth". The settings say what
    files leave open: sigmas, places and biases of sensors, scan_interval_s, the origin. keep_going
    skips bad rows. Error names file, line and column.
    """
    if not paths:
        raise Error("read: no file is named")
    given = settings_of(settings, parameters)
    names = [os.fsencode(path) for path in paths]
    kind = kind or ffi.string(must(lib.program_kind(names[0]))).decode()
    if kind == "scans":
        texts = [ffi.new("char[]", name) for name in names]
        return Scans._of(must(lib.program_read(texts, len(texts), given.handle, keep_going)))
    if kind not in ("tracks", "truth"):
        raise Error(f"kind {kind!r} is neither 'scans', 'tracks' nor 'truth'")
    tables = [_table(name, kind, given, keep_going) for name in names]
    return tables[0] if len(tables) == 1 else np.sort(np.concatenate(tables), order="t_s")


STATUS = np.array(["", "tentative", "confirmed", "coasting", "deleted"])


def _table(path: bytes, kind: str, settings: Settings, keep_going: bool) -> np.ndarray:
    """Columns that hold anything, with the types that Tracker gives."""
    table = ffi.gc(must(lib.program_table(path, kind.encode(), settings.handle, keep_going)),
                   lib.program_table_free)
    count, width = table.num_rows, table.num_columns
    cells = array_of(table.cells, count * width, "f8").reshape(count, width)
    names = [ffi.string(table.names[i]).decode() for i in range(width)]
    kept = [i for i in range(width) if not np.isnan(cells[:, i]).all()]
    rows = np.empty(count, [("t_s", "f8")] + [(names[i], _format(names[i])) for i in kept])
    rows["t_s"] = array_of(table.t_s, count, "f8")
    for i in kept:
        rows[names[i]] = STATUS[cells[:, i].astype(int)] if names[i] == "status" else cells[:, i]
    return rows


def _format(name: str) -> Any:
    if name == "target_id":
        return "i4"
    return TRACK[name] if name in TRACK.names else "f4"


def records(data: Any) -> np.ndarray:
    """A structured array of an array, or a pandas or polars frame."""
    if isinstance(data, np.ndarray):
        if data.dtype.names is None:
            raise Error("an array without named fields: t_s, sensor_id, x_m, y_m, ...")
        return np.atleast_1d(data)
    if not hasattr(data, "columns"):
        raise Error(f"{type(data).__name__} is neither a structured array nor a data frame")
    columns = {str(name): np.asarray(data[name]) for name in data.columns}
    numbers = {name: column for name, column in columns.items() if column.dtype.kind in "fiub"}
    rows = np.empty(len(data), [(name, column.dtype) for name, column in numbers.items()])
    for name, column in numbers.items():
        rows[name] = column
    return rows


def to_pandas(data: Any) -> Any:
    """A pandas DataFrame of scans, tracks or any structured array."""
    import pandas
    return pandas.DataFrame(_columns(data))


def to_polars(data: Any) -> Any:
    """A polars DataFrame of scans, tracks or any structured array."""
    import polars
    return polars.DataFrame(_columns(data))


def _columns(data: Any) -> dict[str, np.ndarray]:
    rows = data.rows if isinstance(data, Scans) else data
    return {name: np.ascontiguousarray(rows[name]) for name in rows.dtype.names}


def _is_list(data: Any) -> bool:
    return isinstance(data, (list, tuple, Scans))


def _picked(rows: np.ndarray, names: list[str]) -> np.ndarray:
    picked = np.empty(len(rows), [(name, rows.dtype[name]) for name in names])
    for name in names:
        picked[name] = rows[name]
    return picked


def _full(array: np.ndarray) -> np.ndarray:
    """Rows with all fields, in the layout of C."""
    if array.dtype == ROW:
        return array
    names = array.dtype.names
    for name in ("t_s", "sensor_id"):
        if name not in names:
            raise Error(f"the field {name} is missing")
    if not {"x_m", "range_m", "bearing_rad"} & set(names):
        raise Error("one of the fields x_m, range_m and bearing_rad is missing")
    rows = np.full(len(array), _BLANK).view(ROW)
    for name in names:
        if name in ROW.names:
            rows[name] = array[name]
    if "azimuth_deg" in names:
        angle = np.pi / 2 - np.deg2rad(array["azimuth_deg"].astype("f8"))
        rows["azimuth_rad"] = angle - 2 * np.pi * np.round(angle / (2 * np.pi))
    if "elevation_deg" in names:
        rows["elevation_rad"] = np.deg2rad(array["elevation_deg"].astype("f8"))
    return rows


def _flat(scans: Iterable[Any]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All rows, how many each scan has, and which are frames."""
    arrays = [scan if isinstance(scan, np.ndarray) and scan.dtype.names else records(scan)
              for scan in scans]
    counts = np.array([len(array) for array in arrays], "u4")
    are_frames = np.array(["bearing_rad" in array.dtype.names for array in arrays], bool)
    if not arrays:
        return np.empty(0, ROW), counts, are_frames
    if all(array.dtype == arrays[0].dtype for array in arrays):
        return _full(np.concatenate(arrays)), counts, are_frames
    rows = np.empty(counts.sum(), ROW)  # np.concatenate alone would leave out C's padding
    return np.concatenate([_full(array) for array in arrays], out=rows), counts, are_frames


def _split(rows: np.ndarray, settings: Settings) -> list[np.ndarray]:
    """Rows of many scans, scan by scan or frame by frame."""
    names = rows.dtype.names
    if not {"t_s", "sensor_id"} <= set(names):
        _full(rows)  # says which one is missing
    if "bearing_rad" in names:
        return _split_frames(rows, settings.frame_tolerance_s)
    keys = ["sensor_id", *([name for name in ("epoch", "scan") if name in names]
                           if "scan" in names else ["t_s"])]
    is_new = np.zeros(len(rows), bool)
    for key in keys:
        is_new[1:] |= rows[key][1:] != rows[key][:-1]
    return np.split(rows, np.flatnonzero(is_new)) if len(rows) else []


def _split_frames(rows: np.ndarray, tolerance_s: Any) -> list[np.ndarray]:
    frames: list[list[int]] = []
    start_s, last, seen = -np.inf, None, set()
    for i, (time_s, sensor) in enumerate(zip(rows["t_s"].tolist(), rows["sensor_id"].tolist())):
        is_next_look = (sensor, time_s) != last
        if time_s - start_s > tolerance_s or (is_next_look and sensor in seen):
            frames.append([])
            start_s, seen = time_s, set()
        frames[-1].append(i)
        seen.add(sensor)
        last = sensor, time_s
    return [rows[frame][np.argsort(rows["sensor_id"][frame], kind="stable")] for frame in frames]
