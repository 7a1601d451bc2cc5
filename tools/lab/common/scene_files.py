# SPDX-License-Identifier: MIT
"""What `rhotrack simulate` and `rhotrack track` write, as arrays: sensors, truth, tracks, and plots
with their target."""
import configparser
import csv
import dataclasses
import math

import numpy as np

RANGE_MAX_M = 100000.0  # of a sensor that states none: the program's default
TIME_TOLERANCE_US = 1000  # tracks stand at the truth's times, as `evaluate` has it
# a target whose velocity changes by more a second turns, as `evaluate` has it (turning_mps2)
TURNING_MPS2 = 0.02
MOTIONS = ("straight", "turning", "coasting")
STRAIGHT, TURNING, COASTING, NO_MOTION = range(4)
# what a track may have beside its place; the columns of a tracks file, and whether the track coasts
MORE = ("vx_mps", "vy_mps", "cov_x_x", "cov_y_x", "cov_y_y", "cov_vx_vx", "cov_vy_vx", "cov_vy_vy",
        "is_coasting")


def path_of(folder, name):
    """The file of a shipped scene: they lie in folders by what they are about."""
    return next(folder.glob(f"**/{name}.json"), folder / f"{name}.json")


@dataclasses.dataclass
class Sensor:
    """A sensor as the tracker is told of it: its place, its coverage and its errors."""
    x_m: float
    y_m: float
    range_min_m: float
    range_max_m: float
    sector_from_rad: float
    sector_to_rad: float
    sigma_range_m: float
    sigma_azimuth_rad: float

    def covers(self, x_m, y_m):
        """Whether places, arrays of one shape, are in its coverage; NaN is not."""
        east, north = x_m - self.x_m, y_m - self.y_m
        range_m = np.hypot(east, north)
        inside = (range_m >= self.range_min_m) & (range_m <= self.range_max_m)
        width = (self.sector_to_rad - self.sector_from_rad) % (2 * math.pi)
        if width > 0:
            inside &= (np.arctan2(north, east) - self.sector_from_rad) % (2 * math.pi) <= width
        return inside


class Settings:
    """scenario.ini: keys without a section or under [rhotrack], and sensors' own under [sensor
    N]."""

    def __init__(self, path):
        self.parser = configparser.ConfigParser(strict=False, interpolation=None,
                                                comment_prefixes=("#", ";"),
                                                inline_comment_prefixes=("#", ";"))
        with open(path, encoding="utf-8") as file:
            self.parser.read_string("[rhotrack]\n" + file.read())

    def get(self, key, default, sensor_id=None):
        for section in ([] if sensor_id is None else [f"sensor {sensor_id}"]) + ["rhotrack"]:
            if self.parser.has_option(section, key):
                return float(self.parser.get(section, key))
        return default

    def sensors(self):
        """{sensor_id: Sensor}; a file without sensors describes a single one, whatever its number
        is (key None)."""
        numbers = [
            int(section.split()[1]) for section in self.parser.sections()
            if section.startswith("sensor ")
        ]
        return {number: self.sensor(number) for number in numbers or [None]}

    def sensor(self, number=None):
        """As the values without a section describe it, or its own before these."""
        return Sensor(
            x_m=self.get("x_m", 0.0, number), y_m=self.get("y_m", 0.0, number),
            range_min_m=self.get("range_min_m", 0.0, number),
            range_max_m=self.get("range_max_m", RANGE_MAX_M, number),
            sector_from_rad=self.get("sector_from_rad", 0.0, number),
            sector_to_rad=self.get("sector_to_rad", 0.0, number),
            sigma_range_m=self.get("sigma_range_m", 15.0, number),
            sigma_azimuth_rad=self.get("sigma_azimuth_rad", 0.003, number))


def sensor_of(sensors, sensor_id):
    return sensors[sensor_id] if sensor_id in sensors else sensors[None]


def columns(path, names, optional=()):
    """The columns of a CSV file as lists of text, rows in the file's order; a column that is not
    there is None."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.reader(line for line in file if not line.startswith("#"))
        header = next(rows)
        rows = [row for row in rows if row]
    missing = [name for name in names if name not in header]
    if missing:
        raise ValueError(f"{path}: no column {missing[0]}")
    places = {name: header.index(name) for name in (*names, *optional) if name in header}
    return {
        name: [row[places[name]] for row in rows] if name in places else None
        for name in (*names, *optional)
    }


def microseconds(texts):
    return np.array([round(float(text) * 1e6) for text in texts], dtype=np.int64)


@dataclasses.dataclass
class Truth:
    """Where targets are at the scans' times: places of scan k and target j, NaN where it is not
    alive."""
    times_us: np.ndarray  # of the scans, ascending
    ids: np.ndarray
    place_m: np.ndarray  # (scans, targets, 2)
    visible: np.ndarray  # (scans, targets): alive, and a sensor covers it
    velocity_mps: np.ndarray = None  # as place_m; None: not known

    def scan_of(self, times_us):
        """The scans with these times; -1 where there is none."""
        if not len(self.times_us):
            return np.full(len(times_us), -1)
        after = np.clip(np.searchsorted(self.times_us, times_us), 0, len(self.times_us) - 1)
        before = np.maximum(after - 1, 0)
        nearer = np.abs(self.times_us[before] - times_us) < np.abs(self.times_us[after] - times_us)
        nearest = np.where(nearer, before, after)
        return np.where(np.abs(self.times_us[nearest] - times_us) <= TIME_TOLERANCE_US, nearest, -1)


    def motions(self):
        """(scans, targets): index into MOTIONS of what a target has done since its scan before,
        NO_MOTION where that is not known: as `evaluate` has it. COASTING is a track's, and none of
        these."""
        found = np.full(self.visible.shape, NO_MOTION)
        if self.velocity_mps is not None and len(self.times_us) > 1:
            passed_s = np.diff(self.times_us)[:, None] / 1e6
            accel_mps2 = np.linalg.norm(np.diff(self.velocity_mps, axis=0), axis=2) / passed_s
            found[1:] = np.where(np.isnan(accel_mps2), NO_MOTION,
                                 np.where(accel_mps2 > TURNING_MPS2, TURNING, STRAIGHT))
        return found


def read_truth(folder, scan_times_us=()):
    """paths.csv of a folder that `simulate` wrote; scans at which nothing is alive have no rows in
    it, so that the scans' own times are added."""
    table = columns(folder / "paths.csv", ("t_s", "target_id", "x_m", "y_m", "is_covered"),
                    ("vx_mps", "vy_mps"))
    rows_us = microseconds(table["t_s"])
    row_ids = np.array(table["target_id"], dtype=np.int64)
    ids = np.unique(row_ids)
    times_us = np.unique(rows_us)
    scan_times_us = np.asarray(scan_times_us, dtype=np.int64)
    without = Truth(times_us, ids, np.empty(0), np.empty(0)).scan_of(scan_times_us) < 0
    times_us = np.union1d(times_us, scan_times_us[without])
    place = np.full((len(times_us), len(ids), 2), np.nan)
    velocity = np.full((len(times_us), len(ids), 2), np.nan)
    visible = np.zeros((len(times_us), len(ids)), dtype=bool)
    scan, target = np.searchsorted(times_us, rows_us), np.searchsorted(ids, row_ids)
    place[scan, target, 0] = np.array(table["x_m"], dtype=float)
    place[scan, target, 1] = np.array(table["y_m"], dtype=float)
    for axis, name in enumerate(("vx_mps", "vy_mps")):
        if table[name]:
            velocity[scan, target, axis] = np.array(table[name], dtype=float)
    visible[scan, target] = np.array(table["is_covered"]) == "1"
    return Truth(times_us, ids, place, visible, velocity)


@dataclasses.dataclass
class Tracks:
    """Tracks scan by scan: numbers and places, of those that are confirmed or coasting."""
    ids: list  # of arrays, one a scan
    place_m: list
    more: list = None  # of arrays (tracks, len(MORE)), NaN where not known; None: nothing of it is


def tracks_by_scan(truth, times_us, ids, place_m, more=None):
    """Rows as Tracks. The last row of a track and scan counts: more than one sensor may look at one
    time."""
    scan = truth.scan_of(times_us)
    by_scan_ids = [np.empty(0, dtype=np.int64)] * len(truth.times_us)
    by_scan_place = [np.empty((0, place_m.shape[-1]))] * len(truth.times_us)
    by_scan_more = [np.empty((0, len(MORE)))] * len(truth.times_us)
    order = np.argsort(scan, kind="stable")
    bounds = np.searchsorted(scan[order], np.arange(len(truth.times_us) + 1))
    for k in range(len(truth.times_us)):
        rows = order[bounds[k]:bounds[k + 1]]
        if len(rows):
            last = {track: row for track, row in zip(ids[rows].tolist(), rows.tolist())}
            chosen = list(last.values())
            by_scan_ids[k], by_scan_place[k] = ids[chosen], place_m[chosen]
            if more is not None:
                by_scan_more[k] = more[chosen]
    return Tracks(by_scan_ids, by_scan_place, by_scan_more if more is not None else None)


def read_tracks(path, truth, axes=("x_m", "y_m")):
    table = columns(path, ("t_s", "track_id", "status", *axes), MORE[:-1])
    counts = np.array([status in ("confirmed", "coasting") for status in table["status"]],
                      dtype=bool)
    place = np.column_stack([np.array(table[axis], dtype=float) for axis in axes])
    ids = np.array(table["track_id"], dtype=np.int64)
    more = np.column_stack([
        np.full(len(ids), np.nan) if table[name] is
        None else np.array([cell or "nan" for cell in table[name]], dtype=float)
        for name in MORE[:-1]
    ] + [np.array([status == "coasting" for status in table["status"]], dtype=float)])
    return tracks_by_scan(truth,
                          microseconds(table["t_s"])[counts], ids[counts], place[counts],
                          more[counts])


def first_confirmed(path):
    """{track_id: microseconds} of a file's tracks that were ever confirmed."""
    table = columns(path, ("t_s", "track_id", "status"))
    found = {}
    for time_us, track, status in zip(
            microseconds(table["t_s"]).tolist(), table["track_id"], table["status"]):
        if status == "confirmed":
            found.setdefault(track, time_us)
    return found


@dataclasses.dataclass
class Plots:
    """Plots and the scans that they belong to; of a scan that saw nothing there are none."""
    times_us: np.ndarray
    scan: np.ndarray  # into scan_times_us
    target: np.ndarray  # truth's id; -1: clutter
    sensor: np.ndarray  # sensor_id
    range_m: np.ndarray
    azimuth_rad: np.ndarray
    place_m: np.ndarray  # (plots, 2)
    scan_times_us: np.ndarray
    scan_sensor: np.ndarray
    sigma_m: np.ndarray = None  # of Cartesian plots, on each axis


def read_plots(path, sensors, scan_interval_s=0.0):
    """Rows of a sensor are one scan by the column `scan`, or within scan_interval_s of the first,
    as `track` reads them; its time is that of the row that saw nothing, or else of the first
    one."""
    table = columns(path, ("t_s", "sensor_id"), ("scan", "target_id", "range_m", "azimuth_rad",
                                                 "x_m", "y_m", "sigma_m"))
    axes = ("range_m", "azimuth_rad") if table["range_m"] else ("x_m", "y_m")
    if table[axes[0]] is None or table[axes[1]] is None:
        raise ValueError(f"{path}: no places of plots")
    times_us = microseconds(table["t_s"])
    interval_us = max(1, round(scan_interval_s * 1e6) - 1)
    scan_of_row = np.empty(len(times_us), dtype=np.int64)
    scan_times, scan_sensor, open_scan = [], [], {}
    for row, (time_us, sensor_id, first) in enumerate(
            zip(times_us.tolist(), table["sensor_id"], table[axes[0]])):
        sensor_id = int(sensor_id)
        number = table["scan"][row] if table["scan"] else None
        last = open_scan.get(sensor_id)
        same = last is not None and (number == last[1] if number else time_us -
                                     last[2] < interval_us and not (last[3] and first == ""))
        if not same:
            last = open_scan[sensor_id] = [len(scan_times), number, time_us, False]
            scan_times.append(time_us)
            scan_sensor.append(sensor_id)
        if first == "":
            scan_times[last[0]] = time_us
            last[3] = True
        scan_of_row[row] = last[0]
    rows = np.array([cell != "" for cell in table[axes[0]]], dtype=bool)

    def numbers(name, kind=float):
        return np.array([cell for cell, counts in zip(table[name], rows) if counts], dtype=kind)

    first, second = numbers(axes[0]), numbers(axes[1])
    sensor = numbers("sensor_id", np.int64)
    origin = np.array([[sensor_of(sensors, number).x_m, sensor_of(sensors, number).y_m]
                       for number in sensor.tolist()]).reshape(-1, 2)
    if table["range_m"]:
        place = origin + np.column_stack([first * np.cos(second), first * np.sin(second)])
        range_m, azimuth, sigma_m = first, second, None
    else:
        place, sigma_m = np.column_stack([first, second]), numbers("sigma_m")
        range_m = np.hypot(*(place - origin).T)
        azimuth = np.arctan2(*(place - origin).T[::-1])
    target = numbers("target_id", np.int64) if table["target_id"] else np.full(len(first), -1)
    return Plots(times_us[rows], scan_of_row[rows], target, sensor, range_m, azimuth, place,
                 np.array(scan_times, dtype=np.int64), np.array(scan_sensor, dtype=np.int64),
                 sigma_m)
