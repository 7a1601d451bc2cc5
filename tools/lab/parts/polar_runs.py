# SPDX-License-Identifier: MIT
"""One run of a turning radar's scene: a search of seven turns, and tracks over all.

In each case the library is told another share of what the radar measures. Beside the search stands
a fit that is told the target's plots, and the clutter's density; beside each track an extended
Kalman filter in double precision that takes the same plots (polar_references.py). Errors are those
of confirmed tracks, at the time when a turn begins. Experiments polar and doppler.
"""
import dataclasses
import math
import time

import numpy as np

from common import experiment
from parts import polar_references
import rhotrack
from common import simulate_scene

TURN_S, SIGMA_RANGE_RATE_MPS = 4.0, 1.0
WINDOW, MIN_SCANS, PD = 7, 5, 0.99  # turns of a search, hits in them, and what is assumed, and true
PROMPT = 5  # turns in which a track is wanted where it matters
TOLERANCE_M = 500.0  # a candidate within is the target's: a plot's error is up to 180 m across


@dataclasses.dataclass
class Case:
    name: str
    is_isotropic: bool = False  # the larger sigma of each plot, along and across
    has_range_rate: bool = False
    span_mps: float = 0.0  # range rates are known up to multiples of it; 0: all


class Sky:
    """A run of a scene with one turning radar in the origin and straight targets. Turns are scans
    at the time when they begin."""

    def __init__(self, run, clutter):
        self.settings, self.sensor = run.settings, run.sensors[1]
        self.is_plot = simulate_scene.has_plot(run.plots)
        self.rows = run.plots.copy()
        self.rows["t_s"][~self.is_plot] -= TURN_S
        self.plots = self.rows[self.is_plot]
        self.turns = [self.plots[self.plots["scan"] == k + 1]
                      for k in range(int(self.rows["scan"].max()))]
        first_s = run.truth.times_us[0] / 1e6
        self.start_m = run.truth.place_m[0] - first_s * run.truth.velocity_mps[0]
        self.velocity_mps = run.truth.velocity_mps[0]
        self.targets = range(len(self.start_m))
        told = {name: run.settings[name] for name in ("v_min_mps", "v_max_mps")}
        sides = [run.settings[f"area_{side}_m"] for side in ("x_min", "x_max", "y_min", "y_max")]
        self.area_m2 = (sides[1] - sides[0]) * (sides[3] - sides[2])
        self.reckoned = polar_references.Sky(WINDOW, PD, self.area_m2, clutter=clutter, **told)

    def radar(self, case):
        told = {name: getattr(self.sensor, name) for name in (
            "sigma_range_m", "sigma_azimuth_rad", "range_min_m", "range_max_m")}
        return polar_references.Radar(**told, sigma_range_rate_mps=SIGMA_RANGE_RATE_MPS
                                      if case.has_range_rate else math.nan)

    def place_m(self, target, t_s):
        return self.start_m[target] + t_s * self.velocity_mps[target]

    def told(self, case):
        """Rows of plots as a case tells them to the library."""
        more = {}
        if case.is_isotropic:
            radar = self.radar(case)
            outwards = math.exp(radar.sigma_azimuth_rad**2 / 2)  # the mean of cos(azimuth)
            more["x_m"] = outwards * self.rows["range_m"] * np.cos(self.rows["azimuth_rad"])
            more["y_m"] = outwards * self.rows["range_m"] * np.sin(self.rows["azimuth_rad"])
            more["sigma_m"] = np.maximum(radar.sigma_range_m,
                                         self.rows["range_m"] * radar.sigma_azimuth_rad)
        if case.has_range_rate:
            rate_mps = self.rows["range_rate_mps"]
            more["range_rate_mps"] = rate_mps - case.span_mps * np.round(
                rate_mps / case.span_mps) if case.span_mps else rate_mps
        polar = () if case.is_isotropic else ("range_m", "azimuth_rad")
        return simulate_scene.with_fields(
            self.rows, ("t_s", "sensor_id", "scan", *polar), **more)


# --- a search of seven turns


def search(case, sky):
    """Targets found, and by the oracle; candidates that are none; errors of those found; time."""
    settings = sky.settings.copy(scans=WINDOW, min_scans=MIN_SCANS, score_min_nat=0, pd=PD)
    settings.sensor(1, pd=PD, **({"range_rate_span_mps": case.span_mps} if case.span_mps else {}))
    rows = sky.told(case)
    scans = rhotrack.Scans(rows[rows["scan"] <= WINDOW], settings)
    initiator = rhotrack.Initiator(settings)
    start = time.thread_time()
    found = initiator.find(scans)
    search_ms = 1e3 * (time.thread_time() - start)
    errors_m = []
    for target in sky.targets:
        # the mean distance over the window; targets are tens of kilometres apart
        off_m = np.mean([np.hypot(
            found["x_m"] + found["vx_mps"] * (t_s - found["t_s"]) - x_m,
            found["y_m"] + found["vy_mps"] * (t_s - found["t_s"]) - y_m)
            for t_s in TURN_S * np.arange(WINDOW) for x_m, y_m in [sky.place_m(target, t_s)]],
            axis=0)
        if len(off_m) and off_m.min() <= TOLERANCE_M:
            errors_m.append(off_m.min())
    return {"found": len(errors_m), "oracle": sum(oracle_finds(case, sky, target)
                                                  for target in sky.targets),
            "false_candidates": len(found) - len(errors_m), "found_m": sum(errors_m),
            "search_ms": search_ms}


def oracle_finds(case, sky, target):
    """A plot of each turn: a target at the turn's border may be seen twice."""
    own = [turn[turn["target_id"] == target][:1] for turn in sky.turns[:WINDOW]]
    own = np.concatenate(own)
    if len(own) < MIN_SCANS:
        return False
    fit = polar_references.fit(own, sky.radar(case), sky.reckoned)
    speed_mps = math.hypot(*fit.state[2:])
    return fit.score_nat >= 0 and sky.reckoned.v_min_mps <= speed_mps <= sky.reckoned.v_max_mps


# --- tracks over all turns


class Shadow:
    """A track's plots, whose they are, and the reference filter through them."""

    def __init__(self, case, sky):
        self.case, self.sky = case, sky
        self.targets = []  # of the plots since the start
        self.filter, self.is_confirmed = None, False
        accel_mps2 = 0.5 * sky.settings["accel_max_mps2"]  # src/DESIGN.md: kept up for a second
        self.noise_density = accel_mps2**2

    def take(self, turn, plot, hits):
        """plot: row of the turn, -1: none. hits: plots of the start, its newest one included; those
        before are taken to be the same target's."""
        if plot >= 0:
            row = self.sky.turns[turn][plot]
            self.targets.append(int(row["target_id"]))
            rows = [row]
            if self.filter is None and row["target_id"] >= 0:
                earlier = [of[of["target_id"] == row["target_id"]][:1]
                           for of in self.sky.turns[max(0, turn - WINDOW + 1):turn]]
                earlier = [one[0] for one in earlier if len(one)]
                rows = earlier[len(earlier) - hits + 1:] + rows if hits > 1 else rows
            for one in rows:
                self._filter(one)
        elif self.filter:
            self.filter.predict(TURN_S * turn, self.noise_density)

    def _filter(self, row):
        if self.filter is None:
            self.filter = polar_references.Filter(row, self.sky.radar(self.case),
                                                  self.sky.settings["v_max_mps"])
        else:
            self.filter.predict(float(row["t_s"]), self.noise_density)
            self.filter.update(row)

    @property
    def target(self):
        """Of more than half of the plots; -1: none."""
        ids, counts = np.unique(self.targets, return_counts=True)
        return int(ids[counts.argmax()]) if len(ids) and 2 * counts.max() > counts.sum() else -1


def follow(case, sky):
    """Targets tracked after PROMPT turns and at the end, when they were confirmed, false tracks,
    and sums of squared errors by turn: of places, along the line of sight, of the reference's
    places, of velocities."""
    settings = sky.settings.copy()
    if case.span_mps:
        settings.sensor(1, range_rate_span_mps=case.span_mps)
    tracks = rhotrack.Tracker(settings).run(rhotrack.Scans(sky.told(case), settings))
    turn_of = np.rint(tracks["t_s"] / TURN_S).astype(int)
    sums, shadows, confirmed_at = np.zeros((len(sky.turns), 5)), {}, []
    tracked = {}
    for turn in range(len(sky.turns)):
        now = set()
        t_s = TURN_S * turn
        for track in tracks[turn_of == turn]:
            shadow = shadows.setdefault(int(track["track_id"]), Shadow(case, sky))
            shadow.take(turn, int(track["plot"]), int(track["hits"]))
            if track["status"] == "tentative":
                continue
            target = shadow.target
            if not shadow.is_confirmed:
                shadow.is_confirmed = True
                confirmed_at += [turn + 1] if target >= 0 else []
            if target >= 0:
                now.add(target)
                truth_m, sight = sky.place_m(target, t_s), sky.place_m(target, t_s)
                off_m = np.array([track["x_m"], track["y_m"]], float) - truth_m
                off_mps = np.array([track["vx_mps"], track["vy_mps"]],
                                   float) - sky.velocity_mps[target]
                state, _ = shadow.filter.at(t_s, shadow.noise_density)
                sums[turn] += [off_m @ off_m, (off_m @ sight)**2 / (sight @ sight),
                               ((state[:2] - truth_m)**2).sum(), off_mps @ off_mps, 1]
        tracked[turn + 1] = len(now)
    return {"prompt": tracked[PROMPT], "tracked": tracked[len(sky.turns)],
            "false_tracks": sum(one.is_confirmed and one.target < 0 for one in shadows.values()),
            "confirm_at": sum(confirmed_at), "confirmed": len(confirmed_at), "errors": sums}


# --- all runs


def measure(case, sky):
    return {"targets": len(sky.targets), **search(case, sky), **follow(case, sky)}


def figures_of(runs):
    """Over the runs of one case: shares, means, root mean squares; what has an error as (value,
    standard error)."""
    total = {key: sum(run[key] for run in runs) for key in runs[0]}
    sums = np.array([run["errors"].sum(axis=0) for run in runs]).T
    rms = [experiment.root_of(*experiment.ratio_of(one, sums[4])) for one in sums[:4]]
    return {
        "targets": total["targets"], "pd": total["found"] / total["targets"],
        "oracle_pd": total["oracle"] / total["targets"],
        "pd_behind_oracle": experiment.ratio_of([run["oracle"] - run["found"] for run in runs],
                                         [run["targets"] for run in runs]),
        "false_candidates_per_run": experiment.mean_of([run["false_candidates"] for run in runs]),
        "candidate_error_m": total["found_m"] / max(1, total["found"]),
        "search_ms": total["search_ms"] / len(runs),
        "tracked_after_5": total["prompt"] / total["targets"],
        "tracked_at_end": total["tracked"] / total["targets"],
        "confirmed_at_turn": total["confirm_at"] / max(1, total["confirmed"]),
        "false_tracks_per_run": experiment.mean_of([run["false_tracks"] for run in runs]),
        "rmse_m": rms[0], "along_rmse_m": rms[1], "double_filter_rmse_m": rms[2],
        "rmse_mps": rms[3],
        "over_double_filter": experiment.root_of(*experiment.ratio_of(sums[0], sums[2])),
        "errors": total["errors"]}


def facts(figures):
    """For JSON: without the list by turn."""
    return experiment.values_of({key: value for key, value in figures.items() if key != "errors"})
