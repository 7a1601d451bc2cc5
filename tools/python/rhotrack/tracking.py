# SPDX-License-Identifier: MIT
"""The tracker, a track alone, and the node that is fed with messages."""
from __future__ import annotations

from typing import Any

import numpy as np

from . import pictures
from ._core import (FATES, NULL, Error, Shared, array_of, ffi, in_turn, lib, must, plain,
                    pointer_to)
from .scans import BODY, COVARIANCE, TRACK, as_scans, records
from .settings import Settings, settings_of


class Tracks(np.ndarray):
    """The structured array of tracks; a notebook shows it as a picture and a table."""

    def __getitem__(self, key: Any) -> Any:
        found = super().__getitem__(key)  # columns are plain arrays
        is_column = isinstance(found, Tracks) and found.dtype.names is None
        return found.view(np.ndarray) if is_column else found

    def _repr_html_(self) -> str | None:
        if self.dtype.names is None or "track_id" not in self.dtype.names or not self.size:
            return None
        return pictures.html_of(self.view(np.ndarray))


def _array(tracks: Any) -> Tracks:
    return _plain_array(tracks).view(Tracks)


def _plain_array(tracks: Any) -> np.ndarray:
    rows = array_of(tracks.list, tracks.count, TRACK)
    more = []
    if tracks.has_covariances:
        size = len(COVARIANCE)
        flat = array_of(tracks.covariances, tracks.count * size, "f4").reshape(-1, size)
        more += [(name, flat[:, i]) for i, name in enumerate(COVARIANCE)]
    if tracks.has_bodies:
        bodies = array_of(tracks.bodies, tracks.count, BODY)
        more += [(name, bodies[name]) for name in BODY.names if name != "plots"]
    if not more:
        return rows
    wide = np.empty(len(rows), [(name, TRACK[name]) for name in TRACK.names]
                    + [(name, "f4") for name, _ in more])
    for name, column in [*((name, rows[name]) for name in TRACK.names), *more]:
        wide[name] = column
    return wide


class Tracker(Shared):
    """Scans in, tracks out, as `rhotrack track` does it.

    Tracks are structured arrays, a row each track and scan, with the columns of the program's
    tracks file: t_s (float64 s), track_id, status ("tentative", "confirmed", "coasting"), x_m ..
    vz_mps, ax_mps2 .. az_mps2, sigma_m, sigma_mps (float32; metres, m/s, m/s^2), hits, misses,
    sensor_id, plot (row of the plot in its scan, -1: none), update_age_us, score_nat,
    maneuver_probability; with covariance=True also cov_x_x .. cov_vz_vz; where body_max_m is set
    also the body: length_m, width_m, heading_rad, their sigmas, sigma_along_m, sigma_across_m.
    """

    def __init__(self, settings: Settings | None = None, covariance: bool = False,
                 **parameters: Any) -> None:
        self.settings = settings_of(settings, parameters)
        self._pipeline = ffi.gc(must(lib.program_pipeline_new(self.settings.handle, covariance)),
                                lib.program_pipeline_free)

    def step(self, scan: np.ndarray) -> np.ndarray:
        """Takes one scan, or one frame of bearings (see Scans); returns the tracks at its time."""
        return self.run([scan if isinstance(scan, np.ndarray) else records(scan)])

    @in_turn
    def run(self, scans: Any) -> np.ndarray:
        """Takes many scans in one call of C; returns the tracks of all steps, one after the other.

        What the first scans hold decides, as the program's inputs do: bearings alone bring the
        customary parameters of passive tracking.
        """
        scans = as_scans(scans, self.settings)
        must(lib.program_pipeline_run(self._pipeline, scans.handle, True))
        return _array(self._pipeline.tracks)

    @property
    @in_turn
    def fates(self) -> np.ndarray:
        """What the last step did with each plot, in the order of the scan: "claimed", "held",
        ..."""
        report = self._pipeline.report
        count = min(report.num_plots, lib.RHO_MAX_PLOTS)
        return FATES[array_of(report.fates, count, "u1")]

    @property
    @in_turn
    def ended(self) -> np.ndarray:
        """track_id of the confirmed tracks that ended in the last step."""
        report = self._pipeline.report
        return array_of(report.ended, report.num_ended, "u4")

    @property
    @in_turn
    def counters(self) -> dict[str, Any]:
        """Counts since the start; fates by their names."""
        counters = plain(self._pipeline.tracker.counters)
        counters["fates"] = dict(zip(FATES.tolist(), counters["fates"].tolist()))
        return counters

    @property
    @in_turn
    def min_scans(self) -> int:
        """Hits in the window that start a track, M, as the clutter of the newest plots asks for."""
        return self._pipeline.min_scans

    @property
    @in_turn
    def work(self) -> dict[str, int]:
        """Units of work of the last step and the worst one, and what work_max cut."""
        return plain(self._pipeline.tracker.work)

    @property
    @in_turn
    def thresholds_nat(self) -> tuple[float, float]:
        """Scores that start and confirm a track, of the last search for new ones."""
        tracker = self._pipeline.tracker
        return tracker.start_mnat / 1000, tracker.confirm_mnat / 1000

    @property
    @in_turn
    def life(self) -> dict[str, float]:
        """death_rate, hide_rate and appear_rate, at which targets leave, are hidden and are visible
        again in a scan interval; lived_scans: intervals from which the first two are learned."""
        rates = lib.rho_tracker_life(self._pipeline.tracker)
        return {"death_rate": rates.death, "hide_rate": rates.hide,
                "appear_rate": rates.appear, "lived_scans": rates.lived_scans}

    @property
    @in_turn
    def learned_reflectors(self) -> np.ndarray:
        """(n, 4): from x, y to x, y of walls that are learned from what they show, m."""
        wall, found = ffi.new("struct rho_reflector *"), []
        for i in range(lib.RHO_LEARNED_REFLECTORS):
            if lib.rho_reflector_learning_wall(self._pipeline.learning, i, wall):
                found.append((wall.from_x_m, wall.from_y_m, wall.to_x_m, wall.to_y_m))
        return np.array(found, "f4").reshape(-1, 4)

    @property
    @in_turn
    def sensors(self) -> dict[int, dict[str, Any]]:
        """By sensor_id: factors on stated sigmas and the pd by ring of range, as learned."""
        tracker, found = self._pipeline.tracker, {}
        known = ffi.new("struct rho_tracker_known *")
        for i in range(tracker.num_sensors):
            sensor_id = tracker.sensors[i].sensor.sensor_id
            if lib.rho_tracker_known_of(tracker, sensor_id, known) == lib.RHO_OK:
                found[sensor_id] = plain(known[0])
        return found


class Maintainer(Shared):
    """One track alone, from its first plot on, never dropped, as `rhotrack maintain` does it.

    Settings' gate says how it takes its plot: "best" keeps hypotheses, "hough" looks at measured
    velocities, "nearest", or "none": at random, from seed. All but best estimate the target's input
    unless input_estimation=False. tracks=n are n such tracks, each with scans of its own.

    Tracks are rows as Tracker gives them; track_id is 1 .. n.
    """

    def __init__(self, settings: Settings | None = None, input_estimation: bool = True,
                 seed: int = 1, covariance: bool = False, tracks: int = 1,
                 **parameters: Any) -> None:
        self.settings = settings_of(settings, parameters)
        if tracks < 1 or seed < 0:
            raise Error("tracks is 1 at least, seed 0")
        self._all = ffi.gc(
            must(lib.program_maintainers_new(self.settings.handle, tracks, input_estimation, seed,
                                         covariance)), lib.program_maintainers_free)

    @in_turn
    def run(self, scans: Any, log_densities: Any = None) -> np.ndarray:
        """Takes scans in their order of time, each of the first track, the second, ... in turn;
        returns the track after each.

        log_densities, (number of scans,): ln of the clutter's density, plots per m (m^2, m^3) and,
        where velocities are measured, (m/s)^3; if None, best estimates it from its scans.
        """
        scans = as_scans(scans, self.settings)
        told = None if log_densities is None else np.broadcast_to(
            np.asarray(log_densities, "f8"), len(scans)).copy()
        must(lib.program_maintainers_run(
            self._all, scans.handle, NULL if told is None else pointer_to(told, "double *")))
        return _array(self._all.tracks)

    def step(self, scan: np.ndarray) -> np.ndarray:
        """Takes one scan; returns the track at its time, no row before the first plot."""
        return self.run([scan])

    @in_turn
    def predict(self, t_s: float) -> tuple[np.ndarray, np.ndarray]:
        """Moves to t_s; returns (n, 3) places in m where a beam should look, NaN before the first
        plot, and the tracks as predicted. The next scan may be of that time."""
        places = np.empty((self._all.count, 3))
        must(lib.program_maintainers_predict(self._all, t_s, pointer_to(places, "double *")))
        return places, _array(self._all.tracks)

    @property
    @in_turn
    def hypotheses(self) -> np.ndarray:
        """(n,): how many each track has; 1 but for best."""
        return array_of(self._all.hypotheses, self._all.count, "u4")

    @property
    @in_turn
    def refused(self) -> np.ndarray:
        """(n,): updates that the filter refused; the track coasted."""
        return array_of(self._all.refused, self._all.count, "u8")


@ffi.def_extern()
def node_sent(context: Any, channel: Any, data: Any, size: int) -> None:
    ffi.from_handle(context).append((ffi.string(channel).decode(), bytes(ffi.buffer(data, size))))


class Node(Shared):
    """The live tracker without a network: messages of sensors in, messages of tracks out.

    Messages are (channel, bytes), encoded as lcm_types/ has them: LCM's own generator makes their
    Python classes. epoch is the boot number in what is published.
    """

    def __init__(self, settings: Settings | None = None, epoch: int = 1, **parameters: Any) -> None:
        self.settings = settings_of(settings, parameters)
        self._sent: list[tuple[str, bytes]] = []
        self._context = ffi.new_handle(self._sent)
        self._node = ffi.gc(must(lib.program_node_new(self.settings.handle, epoch, lib.node_sent,
                                                  self._context)), lib.program_node_free)
        self._tracks = ffi.gc(ffi.new("struct program_tracks *"), lib.program_tracks_free)

    def take(self, channel: str, data: bytes, now_s: float) -> list[tuple[str, bytes]]:
        """Takes a message received at now_s (s); returns what is published."""
        return self._do(channel.encode(), data, round(now_s * 1e6))

    def tick(self, now_s: float) -> list[tuple[str, bytes]]:
        """Steps what is due at now_s (s) though nothing has come; due_s says when that is."""
        return self._do(ffi.NULL, b"", round(now_s * 1e6))

    def flush(self) -> list[tuple[str, bytes]]:
        """Steps all that waits."""
        return self._do(ffi.NULL, b"", 2**63 - 1)

    @in_turn
    def status(self) -> list[tuple[str, bytes]]:
        """The messages RHO_STATUS, RHO_WORK, RHO_SENSORS, RHO_LEARNED and RHO_LIFE of now."""
        self._sent.clear()
        must(lib.program_node_send_status(self._node))
        return list(self._sent)

    @in_turn
    def _do(self, channel: Any, data: bytes, now_us: int) -> list[tuple[str, bytes]]:
        self._sent.clear()
        must(lib.program_node_take_or_step(self._node, channel, data, len(data), now_us))
        return list(self._sent)

    @property
    @in_turn
    def due_s(self) -> float:
        """When tick has something to do, seconds of the clock of now_s; infinity: never."""
        due_us = lib.program_node_due_us(self._node)
        return float("inf") if due_us == 2**63 - 1 else due_us / 1e6

    @property
    @in_turn
    def tracks(self) -> np.ndarray:
        """The tracks of the last step, as Tracker gives them."""
        must(lib.program_node_get_tracks(self._node, self._tracks))
        return _array(self._tracks)
