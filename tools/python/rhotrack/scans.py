# SPDX-License-Identifier: MIT
"""Scans: what sensors saw, as structured arrays whose fields are the columns of CSV files."""
from __future__ import annotations

import functools
import os
from collections.abc import Sequence
from typing import Any, Iterable

import numpy as np

from . import pictures
from ._core import Error, array_of, dtype_of, ffi, lib, must, pointer_to
from .settings import Settings, settings_of

ROW = dtype_of("program_row")
TRACK = dtype_of("program_track")
BODY = dtype_of("rho_body")
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
    azimuth_deg, clockwise from north), or bearing_rad; with either elevation_rad; range_rate_mps;
    their sigmas; sector_from_rad, sector_to_rad; sensor_x_m, sensor_y_m, sensor_z_m; snr_db. Noise
    of places is sigma_m, or sigma_range_m, sigma_cross_m and sigma_up_m along the line of sight,
    across it and upwards. Metres, seconds, radians counter-clockwise from east.

    A row without a plot stands for the scan: its t_s is the scan's, and alone it is a scan that saw
    nothing. Else the first row's t_s is. The rows of a frame are the bearings of several sensors,
    those of a sensor together.

    data is a list of such arrays, or one array, data frame, dictionary of columns or list of
    dictionaries with the rows of many scans in the order of time: rows of one sensor_id and t_s (or
    of one field scan) that stand together are a scan, and scans of bearings within
    frame_tolerance_s a frame. counts, one a scan, says instead how many rows of one array each has.
    Other fields are ignored.

    Times are taken as they are, and bearings; of polar rows the range and azimuth biases of the
    settings are subtracted.
    """

    def __init__(self, data: Any, settings: Settings | None = None, counts: Any = None) -> None:
        settings = settings or Settings()
        if isinstance(data, list) and data and isinstance(data[0], dict):
            data = of_dicts(data)
        if counts is None:
            rows, counts, are_frames = _flat(
                data if _is_list(data) else _split(records(data), settings))
        else:
            array = records(data)
            rows, counts = _full(array), _checked_counts(counts, len(array))
            are_frames = np.full(len(counts), "bearing_rad" in array.dtype.names)
        handle = lib.program_scans_from_rows(
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
        lib.program_scan_write_rows(scan, pointer_to(rows, "struct program_row *"))
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

    def _repr_png_(self) -> bytes | None:
        return pictures.png_of(self) if len(self) else None


def as_scans(data: Any, settings: Settings) -> Scans:
    """Scans as they are, all else made into scans."""
    return data if isinstance(data, Scans) else Scans(data, settings)


def read(*paths: str | os.PathLike, settings: Settings | None = None, kind: str | None = None,
         keep_going: bool = False, **parameters: Any) -> Any:
    """Reads what the program reads: CSV files, LCM logs, ASTERIX recordings; several are merged.

    Also MATLAB's .mat (a struct of columns, see write) and the radar_msgs of .mcap, one at a time.
    Plots and bearings give Scans. A file of tracks or truth gives one structured array, a row each
    track or target and time; of other files where kind is "tracks" or "truth". The settings say
    what files leave open: sigmas, places and biases of sensors, scan_interval_s, the origin.
    keep_going skips bad rows. Error names file, line and column.
    """
    if not paths:
        raise Error("read: no file is named")
    given = settings_of(settings, parameters)
    suffixes = {os.path.splitext(path)[1] for path in paths}
    if suffixes & {".mat", ".mcap"}:
        if len(paths) > 1:
            raise Error("of .mat and .mcap files one is read at a time")
        from . import files, mcap
        found = (files.read_mat if ".mat" in suffixes else mcap.read)(paths[0], kind)
        is_table = isinstance(found, np.ndarray) and files.kind_of(found.dtype.names) != "scans"
        return found if is_table else Scans(found, given)
    names = [os.fsencode(path) for path in paths]
    kind = kind or ffi.string(must(lib.program_kind_of_file(names[0]))).decode()
    if kind == "scans":
        texts = [ffi.new("char[]", name) for name in names]
        return Scans._of(must(lib.program_read_scans(texts, len(texts), given.handle, keep_going)))
    if kind not in ("tracks", "truth"):
        raise Error(f"kind {kind!r} is neither 'scans', 'tracks' nor 'truth'")
    tables = [_table(name, kind, given, keep_going) for name in names]
    return tables[0] if len(tables) == 1 else np.sort(np.concatenate(tables), order="t_s")


STATUS = np.array(["", "tentative", "confirmed", "coasting", "deleted"])


def _table(path: bytes, kind: str, settings: Settings, keep_going: bool) -> np.ndarray:
    """Columns that hold anything, with the types that Tracker gives."""
    table = ffi.gc(must(lib.program_read_table(path, kind.encode(), settings.handle, keep_going)),
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
    """A structured array of an array, a dictionary of columns, or a pandas or polars frame."""
    if isinstance(data, (np.ndarray, np.void)):
        if data.dtype.names is None:
            raise Error("an array without named fields: t_s, sensor_id, x_m, y_m, ...")
        if data.ndim > 1:
            raise Error(f"an array of rows has one dimension, not the shape {data.shape}")
        return np.atleast_1d(data)
    if not isinstance(data, dict) and not hasattr(data, "columns"):
        raise Error(f"{type(data).__name__} is neither a structured array nor a data frame")
    names = data if isinstance(data, dict) else data.columns
    columns = {str(name): _column(data[name]) for name in names}
    lengths = {name: len(column) for name, column in columns.items()}
    if len(set(lengths.values())) > 1:
        raise Error(f"columns of other lengths: {lengths}")
    rows = np.empty(max(lengths.values(), default=0),
                    [(name, column.dtype) for name, column in columns.items()])
    for name, column in columns.items():
        rows[name] = column
    return rows


def _column(data: Any) -> np.ndarray:
    """Numbers as they are; those that pandas holds as objects (with missing ones) as floats."""
    column = np.atleast_1d(np.asarray(data))
    if column.dtype.kind == "O":
        try:
            import pandas
            return np.asarray(pandas.to_numeric(data), float)
        except (ImportError, TypeError, ValueError):
            return column.astype(str)
    return column


def to_pandas(data: Any) -> Any:
    """A pandas DataFrame of scans, tracks or any structured array."""
    import pandas
    return pandas.DataFrame(_columns(data))


def to_polars(data: Any) -> Any:
    """A polars DataFrame of scans, tracks or any structured array."""
    import polars
    return polars.DataFrame(_columns(data))


def _columns(data: Any) -> dict[str, np.ndarray]:
    rows = rows_of(data)
    return {name: np.ascontiguousarray(rows[name]) for name in rows.dtype.names}


def field(rows: np.ndarray, name: str) -> np.ndarray:
    """A column, NaN where there is none."""
    return rows[name] if name in rows.dtype.names else np.full(len(rows), np.nan, "f4")


def polar_of(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Range, azimuth and elevation from the sensor, of Cartesian rows too; NaN: no plot, or no
    height. Plots that were made of polar ones, which their noise tells, have been moved outwards by
    the mean of the noise's curvature (rho_measurement_from_polar), and are moved back."""
    x, y, z = (field(rows, f"{axis}_m") - np.nan_to_num(field(rows, f"sensor_{axis}_m"))
               for axis in "xyz")
    ground, cross = np.hypot(x, y), field(rows, "sigma_cross_m")
    was_polar = ~np.isnan(cross) & (cross != field(rows, "sigma_range_m"))
    ground /= np.where(was_polar, _gain(cross / ground), 1)
    range_m = np.hypot(ground, np.nan_to_num(z))
    range_m /= np.where(was_polar & ~np.isnan(z), _gain(field(rows, "sigma_up_m") / range_m), 1)
    made = range_m, np.arctan2(y, x), np.arctan2(z, ground)
    said = (field(rows, name) for name in ("range_m", "azimuth_rad", "elevation_rad"))
    return tuple(np.where(np.isnan(one), other, one) for one, other in zip(said, made))


def _gain(sigma_rad: np.ndarray) -> np.ndarray:
    return np.exp(sigma_rad**2 / 2)


def rows_of(data: Any) -> np.ndarray:
    """All rows of scans, a list of them, or a table; those given as they are."""
    if isinstance(data, (list, tuple)):
        arrays = [records(one) for one in data]
        is_one_kind = len({one.dtype for one in arrays}) == 1
        return np.concatenate(arrays) if is_one_kind else Scans(arrays).rows
    return data.rows if isinstance(data, Scans) else np.asarray(records(data))


def _is_list(data: Any) -> bool:
    return isinstance(data, (list, tuple, Scans))


def _picked(rows: np.ndarray, names: list[str]) -> np.ndarray:
    picked = np.empty(len(rows), [(name, rows.dtype[name]) for name in names])
    for name in names:
        picked[name] = rows[name]
    return picked


@functools.lru_cache(64)
def _copied(dtype: np.dtype) -> list[str]:
    """The fields that a row in C's layout takes as they are; Error: these are no scans."""
    names = dtype.names
    for name in ("t_s", "sensor_id"):
        if name not in names:
            raise Error(f"the field {name} is missing; there is: {', '.join(names)}")
    if "track_id" in names:
        raise Error("track_id: these are tracks, not plots")
    if not {"x_m", "range_m", "bearing_rad"} & set(names):
        raise Error("one of the fields x_m, range_m and bearing_rad is missing")
    for name in set(names) & {*ROW.names, "azimuth_deg", "elevation_deg"}:
        if dtype[name].kind not in "fiub" or dtype[name].shape:
            raise Error(f"{name}: numbers are wanted, not {dtype[name]}"
                        + ("; seconds are (t - t[0]) / np.timedelta64(1, 's')"
                           if dtype[name].kind == "M" else ""))
    return [name for name in names if name in ROW.names]


def _full(array: np.ndarray) -> np.ndarray:
    """Rows with all fields, in the layout of C."""
    if array.dtype == ROW:
        return np.ascontiguousarray(array)
    copied, names = _copied(array.dtype), array.dtype.names
    _check_ids(array["sensor_id"])
    rows = np.empty(len(array), ROW)
    rows.view(_BLANK.dtype).fill(_BLANK)
    for name in copied:
        rows[name] = array[name]
    if "azimuth_deg" in names:
        angle = np.pi / 2 - np.deg2rad(array["azimuth_deg"].astype("f8"))
        rows["azimuth_rad"] = angle - 2 * np.pi * np.round(angle / (2 * np.pi))
    if "elevation_deg" in names:
        rows["elevation_rad"] = np.deg2rad(array["elevation_deg"].astype("f8"))
    return rows


def _check_ids(ids: np.ndarray) -> None:
    if not np.can_cast(ids.dtype, "i4"):
        given = ids.astype("f8")
        is_wrong = ~((given >= -2**31) & (given < 2**31) & (given == np.round(given)))
        if is_wrong.any():
            row = is_wrong.argmax()
            raise Error(f"row {row}: sensor_id {ids[row]} is not a whole number of 32 bits")


def _checked_counts(counts: Any, num_rows: int) -> np.ndarray:
    """How many rows each scan has, in the memory that C reads; together they are all rows."""
    given = np.asarray(counts)
    if given.ndim != 1 or (given.size and given.dtype.kind not in "iu"):
        raise Error(f"counts: a list of whole numbers is wanted, not {given.dtype} of the shape "
                    f"{given.shape}")
    is_wrong = (given < 0) | (given > num_rows)
    if is_wrong.any():
        scan = is_wrong.argmax()
        raise Error(f"counts: scan {scan} cannot have {given[scan]} rows, of {num_rows}")
    made = np.ascontiguousarray(given, "u4")
    if made.sum(dtype="u8") != num_rows:
        raise Error(f"counts of {made.sum(dtype='u8')} rows, and there are {num_rows}")
    return made


def _flat(scans: Iterable[Any]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All rows, how many each scan has, and which are frames."""
    arrays = [records(scan) for scan in scans]
    counts = np.array([len(array) for array in arrays], "u4")
    are_frames = np.array(["bearing_rad" in array.dtype.names for array in arrays], bool)
    if not arrays:
        return np.empty(0, ROW), counts, are_frames
    if all(array.dtype == arrays[0].dtype for array in arrays):
        return _full(arrays[0] if len(arrays) == 1 else np.concatenate(arrays)), counts, are_frames
    rows = np.empty(counts.sum(), ROW)  # np.concatenate alone would leave out C's padding
    return np.concatenate([_full(array) for array in arrays], out=rows), counts, are_frames


def of_dicts(rows: list[dict[str, Any]]) -> dict[str, list[Any]]:
    """Columns of rows."""
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: [row.get(name, np.nan) for row in rows] for name in names}


def _split(rows: np.ndarray, settings: Settings) -> list[np.ndarray]:
    """Rows of many scans, scan by scan or frame by frame."""
    names = rows.dtype.names
    if not {"t_s", "sensor_id"} <= set(names):
        _full(rows)  # says which one is missing
    if "bearing_rad" in names:
        return _split_frames(rows, settings.frame_tolerance_s)
    went_back = rows["t_s"][1:] < rows["t_s"][:-1]
    if "scan" not in names and went_back.any():
        row = went_back.argmax() + 1
        raise Error(f"row {row}: t_s {rows['t_s'][row]} is before {rows['t_s'][row - 1]}: sort the "
                    "rows, or give a list of scans in the order of their arrival")
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
