# SPDX-License-Identifier: MIT
"""Initiation alone: the default method, and those of the papers."""
from __future__ import annotations

import time
from typing import Any, NamedTuple

import numpy as np

from ._core import (NULL, Error, Shared, array_of, dtype_of, ffi, in_turn, lib, must, must_succeed,
                    plain, pointer_to)
from .filters import Ghosts, ghosts
from .scans import Scans, as_scans
from .settings import Settings, settings_of

FOUND = np.dtype([("track_id", "u4"), ("t_s", "f8"), ("x_m", "f4"), ("y_m", "f4"),
                  ("vx_mps", "f4"), ("vy_mps", "f4"), ("rho_m", "f4"), ("theta_rad", "f4"),
                  ("scans", "u2"), ("score", "f4"), ("z_m", "f4"), ("vz_mps", "f4")])
PLOT = dtype_of("rho_plot")
PEAK = dtype_of("rho_accumulator_peak")
LINE = np.dtype([("rho_m", "f4"), ("theta_rad", "f4"), ("votes", "f8")])
PEAKS_MAX = 1 << 20
CELLS_MAX = 1 << 26
METHODS = ("kernel", "ht", "mht", "iht", "nht")


class Accumulator(NamedTuple):
    """votes: (rows of theta, cells of rho); theta_rad, rho_m: the middles of rows and cells."""
    votes: np.ndarray
    theta_rad: np.ndarray
    rho_m: np.ndarray


def heights(track: Any, are_known: bool) -> tuple[float, float]:
    return (track.z_m, track.vz_mps) if are_known else (np.nan, np.nan)


class Initiator(Shared):
    """Tracks of the last scans of plots, as `rhotrack initiate` finds them.

    method: "kernel", the tracker's own, or "ht", "mht", "iht", "nht", the papers'. find returns a
    structured array with the columns of the program's file, best first: track_id, t_s, x_m, y_m,
    vx_mps, vy_mps (at the last scan; NaN: fewer than two scans voted), rho_m, theta_rad, scans,
    score (nats for kernel, else votes), z_m, vz_mps (NaN: heights are not known). work has the
    counts of the last search, as the library's struct names them (rho_initiator_work, or
    rho_hough_result for the papers' methods), and search_us, its processor time.
    """

    def __init__(self, settings: Settings | None = None, method: str = "kernel",
                 **parameters: Any) -> None:
        if method not in METHODS:
            raise Error(f"method {method!r} is none of {', '.join(METHODS)}")
        self.settings, self.method = settings_of(settings, parameters), method
        self.work: dict[str, Any] = {}
        self._memory = ffi.new("struct rho_initiator *" if method == "kernel"
                               else "struct rho_hough *")

    @in_turn
    def find(self, scans: Any) -> np.ndarray:
        """Searches the last `scans` (a parameter) of the scans, as one batch."""
        held = self._held(scans)
        if not held:
            return np.empty(0, FOUND)
        return self._find_kernel(held) if self.method == "kernel" else self._find_hough(held)

    @in_turn
    def lines(self, scans: Any) -> np.ndarray:
        """The peaks of the papers' plane, best first: rho_m, theta_rad, votes. find fits a track to
        each of them, which takes longer than the search."""
        points = self._points(scans)
        hough = self._hough(points)
        peaks = self._peaks(hough, points, PEAKS_MAX)
        found = np.empty(len(peaks), LINE)
        for name, cell in (("rho_m", "rho_cell"), ("theta_rad", "theta_cell")):
            middle = getattr(lib, f"rho_hough_{name}")
            cells, which = np.unique(peaks[cell], return_inverse=True)
            found[name] = np.array([middle(hough, one) for one in cells.tolist()], "f4")[which]
        found["votes"] = peaks["votes"] / lib.RHO_HOUGH_VOTE
        return found

    @in_turn
    def accumulator(self, scans: Any) -> Accumulator:
        """The votes of every cell of the papers' plane; cells are d_rho_m by d_theta_rad."""
        points = self._points(scans)
        hough = self._hough(points, tau=0.0, votes_min=0.0, keeps_all_cells=1)
        shape = hough.theta_cells, hough.rho_cells
        if shape[0] * shape[1] > CELLS_MAX:
            raise Error(f"d_rho_m, d_theta_rad: {shape[0]} x {shape[1]} cells are too many for one "
                        f"array, {CELLS_MAX}")
        peaks = self._peaks(hough, points, shape[0] * shape[1])
        votes = np.zeros(shape, "f4")
        votes[peaks["theta_cell"], peaks["rho_cell"]] = peaks["votes"] / lib.RHO_HOUGH_VOTE
        return Accumulator(
            votes, np.array([lib.rho_hough_theta_rad(hough, i) for i in range(shape[0])], "f4"),
            np.array([lib.rho_hough_rho_m(hough, i) for i in range(shape[1])], "f4"))

    def _held(self, scans: Any) -> list[Any]:
        self._scans = as_scans(scans, self.settings)  # owns what the list points to
        held = [self._scans.handle.list[i] for i in range(len(self._scans))]
        if any(scan.is_frame for scan in held):
            raise Error("bearing_rad: Initiator takes plots, Passive takes bearings")
        return held[-int(self.settings.scans):]

    def _find_kernel(self, held: list[Any]) -> np.ndarray:
        config = ffi.new("struct rho_initiator_config *")
        must(lib.program_initiator_config(self.settings.handle, config))
        initiator = self._memory
        must_succeed(lib.rho_initiator_init(initiator, ffi.sizeof(initiator[0]), config), "init")
        left = ffi.new("uint32_t *")
        for one in held:
            scan = ffi.new("struct rho_scan *", one.scan)
            scan.num_plots = min(scan.num_plots, lib.RHO_MAX_PLOTS)
            fates = ffi.new("uint8_t[]", [lib.RHO_FATE_HELD] * scan.num_plots)
            sensor = ffi.addressof(one.sensor) if one.has_sensor else NULL
            must_succeed(lib.rho_initiator_push(initiator, scan, sensor, fates, left), "a scan")
        start_s = time.thread_time()
        status = lib.rho_initiator_search(initiator, lib.RHO_SEARCH_BATCH)
        self._searched(status, "search", start_s, initiator.work)
        found = np.empty(initiator.num_candidates, FOUND)
        for i in range(len(found)):
            one = initiator.candidates[i]
            line = lib.rho_angle_line(one.x_m, one.y_m, one.vx_mps, one.vy_mps)
            found[i] = (i + 1, held[-1].scan.time_us / 1e6, one.x_m, one.y_m, one.vx_mps,
                        one.vy_mps, line.rho_m, line.theta_rad, one.hits,
                        np.float32(one.score_mnat) / np.float32(1000), *heights(one, one.has_z))
        return found

    def _hough(self, points: _Points, **changes: Any) -> Any:
        config = ffi.new("struct rho_hough_config *")
        must(lib.program_hough_config(self.settings.handle, self.method.encode(), points.range_m,
                                        config))
        for name, value in changes.items():
            setattr(config, name, value)
        hough = self._memory
        must_succeed(lib.rho_hough_init(hough, ffi.sizeof(hough[0]), config), "init")
        return hough

    def _points(self, scans: Any) -> _Points:
        if self.method == "kernel":
            raise Error("method 'kernel' has no accumulator")
        return _Points(self._held(scans))

    def _peaks(self, hough: Any, points: _Points, room: int) -> np.ndarray:
        peaks, result = np.empty(room, PEAK), ffi.new("struct rho_hough_result *")
        memory, start_s = pointer_to(peaks, "struct rho_accumulator_peak *"), time.thread_time()
        status = lib.rho_hough_find(hough, points.struct, memory, room, result)
        self._searched(status, "x_m, y_m or t_s of a plot", start_s, result[0])
        return peaks[:result.num_peaks]

    def _searched(self, status: int, what: str, start_s: float, work: Any) -> None:
        search_us = 1e6 * (time.thread_time() - start_s)
        must_succeed(status, what)
        self.work = {**plain(work), "search_us": search_us}

    def _find_hough(self, held: list[Any]) -> np.ndarray:
        points = _Points(held)
        hough = self._hough(points)
        peaks = self._peaks(hough, points, PEAKS_MAX)
        track = ffi.new("struct rho_hough_track *")
        found = np.full(len(peaks), np.array(
            (0, points.time_us / 1e6, *[np.nan] * 6, 0, 0, np.nan, np.nan), FOUND))
        for i, peak in enumerate(peaks):
            theta, rho = int(peak["theta_cell"]), int(peak["rho_cell"])
            must_succeed(lib.rho_hough_track(hough, points.struct, theta, rho, 0.0, track),
                         "track")
            if track.has_velocity:
                for name in ("x_m", "y_m", "vx_mps", "vy_mps"):
                    found[name][i] = getattr(track, name)
            found["rho_m"][i] = lib.rho_hough_rho_m(hough, rho)
            found["theta_rad"][i] = lib.rho_hough_theta_rad(hough, theta)
            found["scans"][i] = track.scans
        found["track_id"] = np.arange(1, len(found) + 1)
        found["score"] = np.round(1e6 * peaks["votes"].astype("f8") / lib.RHO_HOUGH_VOTE) / 1e6
        return found


class _Points:
    """Plots of a batch in the library's arrays; times count from the last scan."""

    def __init__(self, held: list[Any]) -> None:
        scans = [array_of(one.scan.plots, one.scan.num_plots, PLOT) for one in held]
        first_us, self.time_us = held[0].scan.time_us, held[-1].scan.time_us
        time_s = [((one.scan.time_us - first_us + plots["offset_us"].astype("i8")) * 1e-6)
                  for one, plots in zip(held, scans)]
        self.t_s = np.concatenate(time_s).astype("f4") - np.float32(
            1e-6 * (self.time_us - first_us))
        self.x_m, self.y_m = (np.concatenate([plots[name] for plots in scans])
                              for name in ("x_m", "y_m"))
        self.end = np.cumsum([len(plots) for plots in scans], dtype="u4")
        self.range_m = float(np.hypot(self.x_m.astype("f8"), self.y_m.astype("f8")).max(initial=0))
        self.struct = ffi.new("struct rho_hough_points *", {
            "at": {"x_m": pointer_to(self.x_m, "float *"), "y_m": pointer_to(self.y_m, "float *"),
                   "num_scans": len(scans), "scan_end": pointer_to(self.end, "uint32_t *")},
            "t_s": pointer_to(self.t_s, "float *")})


class Passive(Shared):
    """Tracks of the last frames of bearings, as `rhotrack initiate` finds them.

    method: "passive", the tracker's own, or "passive-paper", the paper's to the letter. Tracks are
    as those of Initiator; the scores of passive-paper are votes. Frames are as Scans has them.
    """

    def __init__(self, settings: Settings | None = None, method: str = "passive",
                 **parameters: Any) -> None:
        if method not in ("passive", "passive-paper"):
            raise Error(f"method {method!r} is neither passive nor passive-paper")
        self.settings, self.method = settings_of(settings, parameters), method
        name = "rho_" + method.replace("-", "_")
        self._call = lambda call, *given: must_succeed(getattr(lib, f"{name}_{call}")(*given), call)
        self.config = ffi.new(f"struct {name}_config *")
        must(getattr(lib, name.replace("rho", "program") + "_config")(self.settings.handle,
                                                                      self.config))
        self._search = ffi.new(f"struct {name} *")

    @in_turn
    def find(self, frames: Any) -> np.ndarray:
        """Searches the last rows of looks, as many as a batch holds."""
        scans = as_scans(frames, self.settings)
        held = [scans.handle.list[i] for i in range(len(scans))]
        if not all(one.is_frame for one in held):
            raise Error("bearing_rad: the field is missing in a frame")
        search = self._search
        self._call("init", search, ffi.sizeof(search[0]), self.config)
        for one in held:
            count = sum(one.frame.scans[i].num_bearings for i in range(one.frame.num_scans))
            fates = ffi.new("uint8_t[]", [lib.RHO_FATE_HELD] * count)
            self._call("push", search, ffi.addressof(one.frame), fates)
        self._call("search", search)
        time_s = held[-1].frame.time_us / 1e6 if held else 0.0
        rows = self._lines() if self.method == "passive-paper" else self._tracks()
        return np.array([(i + 1, time_s, *row) for i, row in enumerate(rows)], FOUND)

    @property
    @in_turn
    def covariances(self) -> np.ndarray:
        """Of the tracks of the last find, method "passive": (tracks, 4, 4), of x, y, vx, vy."""
        found = self._found()
        whole = np.empty((len(found), 4, 4))
        row, column = np.tril_indices(4)
        for one, covariance in zip(found, whole):
            covariance[row, column] = covariance[column, row] = list(one.covariance)[:len(row)]
        return whole

    @property
    @in_turn
    def claims(self) -> np.ndarray:
        """The bearings of the tracks of the last find, method "passive": (tracks, frames, sensors),
        the bearing's number among its sensor's of the frame, from 0; -1: none."""
        found, batch = self._found(), self._search.batch
        claims = np.empty((len(found), batch.num_scans, batch.num_sensors), int)
        for one, claim in zip(found, claims):
            claim[...] = [list(frame)[:batch.num_sensors] for frame in one.claim[0:batch.num_scans]]
        return claims - 1

    def _found(self) -> Any:
        if self.method == "passive-paper":
            raise Error("method 'passive-paper' finds lines: no covariances, no claims")
        return self._search.tracks[0:self._search.num_tracks]

    def _tracks(self) -> list[tuple]:
        rows = []
        for one in self._found():
            line = lib.rho_angle_line(one.x_m, one.y_m, one.vx_mps, one.vy_mps)
            rows.append((one.x_m, one.y_m, one.vx_mps, one.vy_mps, line.rho_m, line.theta_rad,
                         bin(one.scans).count("1"),
                         np.float32(one.score_mnat) / np.float32(1000),
                         *heights(one, not one.is_level)))
        return rows

    def _lines(self) -> list[tuple]:
        rows = []
        for one in self._search.lines[0:self._search.num_lines]:
            state = (one.x_m, one.y_m, one.vx_mps, one.vy_mps)
            rows.append((*(state if one.has_state else [np.nan] * 4), one.rho_m, one.theta_rad,
                         bin(one.scans).count("1"), one.votes, np.nan, np.nan))
        return rows

    def accumulators(self, frames: Any) -> dict[tuple[int, int], Accumulator]:
        """The paper's accumulator of each pair of sensors, by their sensor_id, of all frames given:
        distinct frames whose crossings vote for a cell. rho_m counts from the sensors' centroid."""
        scans = as_scans(frames, self.settings)
        looks = [self.ghosts(scans[i]) for i in range(len(scans))]
        places = {one["sensor_id"]: (one["sensor_x_m"], one["sensor_y_m"])
                  for i in range(len(scans)) for one in scans[i]}
        middle = np.mean(list(places.values()), axis=0, dtype="f4")
        step_m, columns = self.config.rho_cell_m, lib.RHO_PAPER_RHO_CELLS
        num_rows = round(np.pi / self.config.theta_cell_rad)
        theta = (np.arange(num_rows, dtype="f4") + 0.5) * np.pi / num_rows
        found = {}
        for pair in dict.fromkeys(pair for look in looks for pair in look):
            votes = np.zeros((num_rows, columns), "u2")
            for look in (look[pair] for look in looks if pair in look):
                is_there = ~np.isnan(look.x_m)
                rho = (np.outer(np.cos(theta), look.x_m[is_there] - middle[0])
                       + np.outer(np.sin(theta), look.y_m[is_there] - middle[1]))
                cell = np.floor(rho / step_m + columns / 2).astype(int)
                row, point = np.nonzero((cell >= 0) & (cell < columns))
                has_voted = np.zeros(votes.shape, bool)
                has_voted[row, cell[row, point]] = True
                votes += has_voted
            found[pair] = Accumulator(votes, theta,
                                      (np.arange(columns) + 0.5 - columns / 2) * step_m)
        return found

    def ghosts(self, frame: np.ndarray) -> dict[tuple[int, int], Ghosts]:
        """The ghost matrix of each pair of sensors of a frame, by their sensor_id."""
        ids = list(dict.fromkeys(frame["sensor_id"].tolist()))
        looks = [frame[(frame["sensor_id"] == one) & ~np.isnan(frame["bearing_rad"])]
                 for one in ids]
        places = [(float(frame["sensor_x_m"][k]), float(frame["sensor_y_m"][k]))
                  for k in (np.flatnonzero(frame["sensor_id"] == one)[0] for one in ids)]
        rule = self.settings["prune"] if self.method == "passive" else {
            lib.RHO_GHOST_SAFE: "safe", lib.RHO_GHOST_LITERAL: "literal",
            lib.RHO_GHOST_NO_RULE: "none"}[self.config.rule]
        return {(ids[a], ids[b]): ghosts(looks[a]["bearing_rad"], looks[b]["bearing_rad"],
                                         places[a], places[b], self.config.range_max_m, rule)
                for a in range(len(ids)) for b in range(a + 1, len(ids))}
