# SPDX-License-Identifier: MIT
"""One run of each part of experiment air-traffic (air_traffic.py), and the limit beside it.

The limit: a tracker of its own follows each target, and gets this target's plots alone. Gates,
filter, and the rules by which tracks end are the library's; the start is fixed to the hits that
started a track in the run beside it, at any score. So association alone differs.
"""
import collections
import dataclasses
import json
import math
import time

import numpy as np

from common import gospa
import rhotrack
from common import simulate_scene
from common import stonesoup_tracker

INTERVAL_S, SIGMA_M, PD = 10.0, 50.0, 0.95
CUTOFFS_M = (1000.0, 200.0)
FOUND_SCANS = 12  # of a target's life, in which it may be found
ALARM_SCANS = 500
LOST_SCANS = 4  # at the end, without a track: fewer are a target that was missed


@dataclasses.dataclass
class Case:
    part: str
    name: str
    aircraft: int
    clutter: float
    num_scans: int = 120
    share: int = 1  # one run of so many of the experiment's
    sets: tuple = ()  # fields of the scene


def hot_spot(x_m, y_m):
    return {"kind": "cell", "shape": "disc", "radius_m": 20e3, "plots": 20, "at_m": [x_m, y_m]}


HOT_SPOTS = [{"kind": "uniform", "plots": 100}, hot_spot(-170e3, 40e3), hot_spot(-60e3, -200e3),
             hot_spot(20e3, 110e3), hot_spot(130e3, -70e3), hot_spot(210e3, 180e3)]
STRESSES = {
    "fades: 4 an hour, 3 scans": ('events=[{"kind":"fades","per_hour":4,"for_s":[5,55]}]',),
    "5 hot spots, 20 plots each": (f"clutter={json.dumps(HOT_SPOTS)}",),
    "50 persistent sources": ('clutter.1={"kind":"standing","count":50,"pd":0.9}',),
    "merged plots within 1 km, half cross": ("radars.0.resolution_m=1000",
                                             "targets.0.crossing_share=0.5"),
    "sigma assumed 0.7 of the true one": ('radars.0.told={"sigma_m":35}',),
    "sigma assumed 1.5 of the true one": ('radars.0.told={"sigma_m":75}',),
    "P_D 0.8, 0.95 assumed": ("radars.0.pd=0.8", 'radars.0.told={"pd":0.95}'),
    "P_D 0.95, 0.8 assumed": ('radars.0.told={"pd":0.8}',)}
SHARES = {(10, 5000): 2, (50, 5000): 2, (200, 5000): 4}
CASES = [Case("grid", "as assumed", aircraft, clutter, 40 if aircraft == 1000 else 120,
              SHARES.get((aircraft, clutter), {200: 2, 1000: 4}.get(aircraft, 1)))
         for aircraft in (10, 50, 200, 1000) for clutter in (0, 100, 1000, 5000)]
CASES += [Case("stress", name, 50, 100, sets=sets) for name, sets in STRESSES.items()]
CASES += [Case("operation", wanted, 50, 1000, sets=(f"settings.false_tracks_per_hour={wanted}",))
          for wanted in ("0.01", "0.1", "1", "10", "100", "1000", "10000")]


@dataclasses.dataclass
class Pair:
    name: str
    path: str
    num_scans: int
    spacing_m: float = 0.0
    merge_m: float = 0.0  # nearer than this they give one plot
    apart_m: float = 395.0  # times at which they are closer do not count: who is who?
    kept_least: float = None  # bar on runs without a switch


PAIRS = (Pair("crossing at 10 degrees", "crossing", 41, kept_least=0.95),
         Pair("parallel at 8 sigma", "parallel", 31, 400, kept_least=0.95),
         Pair("parallel at 3 sigma", "parallel", 31, 150, apart_m=0),
         Pair("meet, 8 sigma, part", "formation", 61, 400),
         Pair("meet, 3 sigma, part", "formation", 61, 150),
         Pair("meet, 3 sigma, merged within 5, part", "formation", 61, 150, 250))
ALARMS = ((100, 1), (100, 20), (1000, 1), (1000, 20), (5000, 20))  # clutter a scan, wanted an hour


# --- traffic


def step_through(settings, scans):
    """Tracks of each scan, with covariances; times of the processor in us; M of each scan; the
    tracker."""
    tracker = rhotrack.Tracker(settings, covariance=True)
    reports, times_us, starts = [], [], []
    for scan in scans:
        ready = rhotrack.Scans([scan], settings)
        start = time.thread_time_ns()
        tracks = tracker.run(ready)
        times_us.append((time.thread_time_ns() - start) / 1e3)
        reports.append(tracks[tracks["status"] != "tentative"])
        starts.append(tracker.min_scans)
    return reports, np.array(times_us), starts, tracker


def limit_of(run, rows, min_scans):
    """Tracks of each scan with true association; numbers of a target's begin at its own times
    1000."""
    settings = run.settings.copy(min_scans=min_scans, score_min_nat=-100)
    owner, has_plot = run.plots["target_id"], simulate_scene.has_plot(run.plots)
    found = []
    for target in np.unique(owner[owner >= 0]):
        own = owner == target
        first = run.plots["scan"][own].min()
        alone = rows[(own | ~has_plot) & (run.plots["scan"] >= first)]
        tracks = rhotrack.Tracker(settings, covariance=True).run(rhotrack.Scans(alone, settings))
        tracks = tracks[tracks["status"] != "tentative"]
        tracks["track_id"] += 1000 * target
        found.append(tracks)
    found = np.concatenate(found)
    scan = np.rint(found["t_s"] / INTERVAL_S).astype(int)
    order = np.argsort(scan, kind="stable")
    return np.split(found[order], np.searchsorted(scan[order], np.arange(1, len(run.scans))))


def evaluate(truth, reports, cutoff_m):
    evaluation = gospa.Evaluation(cutoff_m)
    for k, tracks in enumerate(reports):
        alive = np.flatnonzero(truth.visible[k])
        evaluation.add(alive, truth.place_m[k, alive], truth.velocity_mps[k, alive], tracks)
    return evaluation


def run_traffic(job):
    """Figures of tracks and limit by cutoff, times, and shares found, of one case and seed."""
    case, seed = job
    run = simulate_scene.simulate(
        "air-traffic", seed, f"targets.0.flights={case.aircraft}",
        f"clutter.0.plots={case.clutter}", f"duration_s={case.num_scans * INTERVAL_S:g}",
        *case.sets)
    rows = simulate_scene.with_fields(run.plots,
                                                ("t_s", "sensor_id", "x_m", "y_m", "scan"))
    scans = np.split(rows, np.flatnonzero(np.diff(rows["scan"])) + 1)
    reports, times_us, starts, _ = step_through(run.settings, scans)
    counts = collections.Counter(start for start in starts if start >= 3)
    min_scans = max(sorted(counts), key=counts.get)
    evaluations = [evaluate(run.truth, reports, cutoff_m) for cutoff_m in CUTOFFS_M]
    found = {"tracks": [one.result() for one in evaluations], "us": times_us.mean(),
             "max_us": times_us.max(), "min_scans": min_scans,
             "hours": case.num_scans * INTERVAL_S / 3600}
    lives = evaluations[0].lives.values()
    found["alive"] = np.array([sum(life.times > k for life in lives) for k in range(FOUND_SCANS)])
    found["found"] = np.array([sum(life.times > k and life.paired > 0 and life.delay <= k
                                   for life in lives) for k in range(FOUND_SCANS)])
    if case.part != "operation":
        limit = limit_of(run, rows, min_scans)
        found["limit"] = [evaluate(run.truth, limit, cutoff_m).result() for cutoff_m in CUTOFFS_M]
    else:
        found["alarms"] = run_alarm((case.clutter, run.settings["false_tracks_per_hour"], seed))
    return found


# --- pairs


def path_of(pair):
    """Places and velocities of both at each scan, (scans, 2, 2)."""
    t_s = INTERVAL_S * np.arange(pair.num_scans)[:, None]
    speed_mps, half_rad, side = 250.0, math.radians(5), np.array([1.0, -1.0])
    along_mps, away_mps = speed_mps * math.cos(half_rad), speed_mps * math.sin(half_rad)
    if pair.path == "parallel":
        velocity = np.broadcast_to([speed_mps, 0.0], (pair.num_scans, 2, 2))
        place = np.stack([np.repeat(-1500 + speed_mps * t_s, 2, axis=1),
                          np.broadcast_to([0.0, pair.spacing_m], (pair.num_scans, 2))], axis=-1)
    elif pair.path == "crossing":  # both are in the origin at half time
        velocity = np.stack(np.broadcast_arrays(along_mps, away_mps * side + 0 * t_s), axis=-1)
        place = velocity * (t_s - t_s[-1] / 2)[..., None]
    else:  # together from a quarter of the time to three quarters
        join_s, part_s = 0.25 * t_s[-1], 0.75 * t_s[-1]
        before_s, after_s = np.maximum(0, join_s - t_s), np.maximum(0, t_s - part_s)
        x_m = speed_mps * (np.clip(t_s, join_s, part_s) - join_s) + along_mps * (after_s - before_s)
        y_m = side * (pair.spacing_m / 2 + away_mps * (before_s + after_s))
        away = np.where(t_s < join_s, -1, np.where(t_s > part_s, 1, 0))
        velocity = np.stack([np.repeat(np.where(away, along_mps, speed_mps), 2, axis=1),
                             away * away_mps * side], axis=-1)
        place = np.stack([np.repeat(x_m, 2, axis=1), y_m], axis=-1)
    return place, velocity


PAIR_BOX_M = (-50e3, 120e3, -50e3, 50e3)
PAIR_CLUTTER = 68  # as dense as 1000 plots on the area of air-traffic


def scan_of(t_s, places_m):
    """Rows of a scan: its own one, and the plots."""
    rows = np.empty(len(places_m) + 1, [("t_s", "f8"), ("sensor_id", "i4"), ("x_m", "f8"),
                                        ("y_m", "f8")])
    rows["t_s"], rows["sensor_id"] = t_s, 1
    rows["x_m"], rows["y_m"] = np.concatenate([[[np.nan, np.nan]], places_m]).T
    return rows


def clutter_in(box_m, mean, random):
    count = random.poisson(mean)
    return np.column_stack([random.uniform(*box_m[:2], count), random.uniform(*box_m[2:], count)])


def run_pair(job):
    pair, seed, number = job
    random = np.random.default_rng([seed, 0x70616972, number])
    places_m, velocities_mps = path_of(pair)
    settings = rhotrack.Settings(
        sigma_m=SIGMA_M, pd=PD, v_min_mps=50, v_max_mps=300, accel_max_mps2=6, steady_s=300,
        **dict(zip(("area_x_min_m", "area_x_max_m", "area_y_min_m", "area_y_max_m"), PAIR_BOX_M)))
    apart_m = np.linalg.norm(places_m[:, 0] - places_m[:, 1], axis=1)
    scans = []
    for k, place_m in enumerate(places_m):
        if apart_m[k] < pair.merge_m:  # one plot between them where either is seen
            place_m, pd = place_m.mean(axis=0, keepdims=True), 1 - (1 - PD)**2
        else:
            pd = PD
        seen = place_m[random.random(len(place_m)) < pd]
        plots = np.concatenate([seen + random.normal(0, SIGMA_M, seen.shape),
                                clutter_in(PAIR_BOX_M, PAIR_CLUTTER, random)])
        scans.append(scan_of(INTERVAL_S * k, random.permutation(plots)))
    tracks = rhotrack.Tracker(settings).run(rhotrack.Scans(scans, settings))
    tracks = tracks[tracks["status"] != "tentative"]
    scan = np.rint(tracks["t_s"] / INTERVAL_S).astype(int)
    evaluation, without = gospa.Evaluation(CUTOFFS_M[0]), 0
    for k in range(pair.num_scans):
        without += 1
        if apart_m[k] >= pair.apart_m and evaluation.add(
                np.arange(2), places_m[k], velocities_mps[k], tracks[scan == k]) == 2:
            without = 0
    result = evaluation.result()
    return {"no_switch": result["switches"] == 0, "switches": result["switches"],
            "lost": without >= LOST_SCANS, "completeness": result["completeness"]}


# --- clutter alone


def run_alarm(job):
    """False tracks of ALARM_SCANS scans."""
    clutter, wanted_per_hour, seed = job
    random = np.random.default_rng([seed, int(clutter)])
    settings = simulate_scene.simulate(
        "air-traffic", seed, "duration_s=10").settings.copy(false_tracks_per_hour=wanted_per_hour)
    box_m = [settings[f"area_{side}_m"] for side in ("x_min", "x_max", "y_min", "y_max")]
    scans = (scan_of(INTERVAL_S * k, clutter_in(box_m, clutter, random))
             for k in range(ALARM_SCANS))
    _, times_us, starts, tracker = step_through(settings, scans)
    return {"scans": ALARM_SCANS, "hours": ALARM_SCANS * INTERVAL_S / 3600, "us": times_us.mean(),
            "confirmed": tracker.counters["tracks_confirmed"], "min_scans": np.mean(starts)}


# --- Stone Soup


def run_rival(job):
    """Figures and ms a scan of one method on the plots of a seed: 50 aircraft, clutter of 100."""
    method, seed = job
    run = simulate_scene.simulate("air-traffic", seed, "duration_s=1200")
    rows = simulate_scene.with_fields(run.plots,
                                                ("t_s", "sensor_id", "x_m", "y_m", "scan"))
    scans = np.split(rows, np.flatnonzero(np.diff(rows["scan"])) + 1)
    if method == "rhotrack":
        reports, times_us, _, _ = step_through(run.settings, scans)
        ms = times_us.mean() / 1e3
    else:
        reports, ms = stonesoup_tracker.track(
            [(scan["t_s"][0], np.column_stack([scan["x_m"], scan["y_m"]])[1:]) for scan in scans],
            method)
    return evaluate(run.truth, reports, CUTOFFS_M[0]).result(), ms
