#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment air-traffic: aircraft over 500 x 500 km, beside the same filter with true association.

Parts: grid (aircraft and clutter of scene air-traffic), stress (what else goes wrong), operation
(detection against false tracks), pairs (two aircraft close together: who is who afterwards?),
clutter (false tracks an hour without an aircraft), rivals (Stone Soup on the same plots).

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

import gospa
import lab
import rhotrack
import scene_runs
import stonesoup_tracker

RUNS = 4
PARTS = ("grid", "stress", "operation", "pairs", "clutter", "rivals")
INTERVAL_S, SIGMA_M, PD = 10.0, 50.0, 0.95
CUTOFFS_M = (1000.0, 200.0)
FOUND_SCANS = 12  # of a target's life, in which it may be found
ALARM_SCANS = 500
PAIR_RUNS = 25  # for each of the experiment's
LOST_SCANS = 4  # at the end, without a track: fewer are a target that was missed
RIVAL_RUNS = 2  # at most
LEAST_WANTED = 20  # false tracks: a rate from fewer says little


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
    owner, has_plot = run.plots["target_id"], scene_runs.has_plot(run.plots)
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
    run = scene_runs.simulate(
        "air-traffic", seed, f"targets.0.flights={case.aircraft}",
        f"clutter.0.plots={case.clutter}", f"duration_s={case.num_scans * INTERVAL_S:g}",
        *case.sets)
    rows = scene_runs.with_fields(run.plots, ("t_s", "sensor_id", "x_m", "y_m", "scan"))
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


def mean_figures(results):
    """Over the runs: roots of mean squares of what is in metres, means of the rest."""
    return {key: math.sqrt(np.mean([one[key]**2 for one in results])) if key.endswith("_m") else
            float(np.mean([one[key] for one in results])) for key in results[0]}


def summary_of(case, runs):
    """Figures of a case over its runs."""
    fastest = min(runs, key=lambda run: run["us"])
    made = {"case": case, "runs": runs, "us": fastest["us"], "max_us": fastest["max_us"],
            "min_scans": np.mean([run["min_scans"] for run in runs]),
            "tracks": [mean_figures([run["tracks"][k] for run in runs]) for k in (0, 1)]}
    if "limit" in runs[0]:
        made["limit"] = [mean_figures([run["limit"][k] for run in runs]) for k in (0, 1)]
        made["ratio"] = [lab.root_of(*lab.ratio_of(
            [run["tracks"][k]["gospa_m"]**2 for run in runs],
            [run["limit"][k]["gospa_m"]**2 for run in runs])) for k in (0, 1)]
    return made


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
    settings = scene_runs.simulate("air-traffic", seed, "duration_s=10").settings.copy(
        false_tracks_per_hour=wanted_per_hour)
    box_m = [settings[f"area_{side}_m"] for side in ("x_min", "x_max", "y_min", "y_max")]
    scans = (scan_of(INTERVAL_S * k, clutter_in(box_m, clutter, random))
             for k in range(ALARM_SCANS))
    _, times_us, starts, tracker = step_through(settings, scans)
    return {"scans": ALARM_SCANS, "hours": ALARM_SCANS * INTERVAL_S / 3600, "us": times_us.mean(),
            "confirmed": tracker.counters["tracks_confirmed"], "min_scans": np.mean(starts)}


# --- Stone Soup


def run_rival(job):
    """Figures and ms a scan of one method on the plots of a seed: 50 aircraft, 100 clutter plots."""
    method, seed = job
    run = scene_runs.simulate("air-traffic", seed, "duration_s=1200")
    rows = scene_runs.with_fields(run.plots, ("t_s", "sensor_id", "x_m", "y_m", "scan"))
    scans = np.split(rows, np.flatnonzero(np.diff(rows["scan"])) + 1)
    if method == "rhotrack":
        reports, times_us, _, _ = step_through(run.settings, scans)
        ms = times_us.mean() / 1e3
    else:
        reports, ms = stonesoup_tracker.track(
            [(scan["t_s"][0], np.column_stack([scan["x_m"], scan["y_m"]])[1:]) for scan in scans],
            method)
    return evaluate(run.truth, reports, CUTOFFS_M[0]).result(), ms


# --- what is told


def traffic_row(of):
    case, tracks, limit = of["case"], of["tracks"], of["limit"]
    return [case.name, case.aircraft, case.clutter, f"{tracks[0]['gospa_m']:.0f}",
            f"{tracks[0]['localisation_m']:.0f}", f"{tracks[0]['missed']:.3f}",
            f"{tracks[0]['false']:.3f}", f"{limit[0]['gospa_m']:.0f}", f"{of['ratio'][0][0]:.3f}",
            f"{tracks[1]['gospa_m']:.0f}", f"{limit[1]['gospa_m']:.0f}", f"{of['ratio'][1][0]:.3f}",
            f"{tracks[0]['completeness']:.4f}", f"{limit[0]['completeness']:.4f}",
            f"{tracks[0]['switches']:.1f}", f"{tracks[0]['fragments']:.1f}",
            f"{tracks[0]['delay_scans']:.2f}", f"{of['min_scans']:.1f}", f"{of['us'] / 1e3:.2f}",
            f"{of['max_us'] / 1e3:.1f}"]


TRAFFIC_HEADS = ["case", "aircraft", "clutter", "gospa m", "localisation", "missed", "false",
                 "limit m", "ratio", "at 200 m", "limit", "ratio", "complete", "limit", "switches",
                 "fragments", "delay", "M", "ms a scan", "longest"]


def tell_grid(report, summaries):
    report.heading("Aircraft and clutter")
    report.text("GOSPA (p 2, alpha 2) with a cutoff of 1 km and, further right, 200 m; missed and "
                "false: a scan. Limit: the same filter and the same rules with true association. "
                "Delay: scans of an aircraft before it has a track. M: hits in 7 scans that start a "
                "track. Time: mean of the fastest run.")
    report.table(TRAFFIC_HEADS, map(traffic_row, summaries))
    report.heading("Parts of GOSPA")
    report.text("Beside the limit's. Nees: of places, 2 where the covariance is right.")
    both = (("missed", 3), ("false", 3), ("localisation_m", 0), ("rmse_m", 1), ("nees", 2))
    rows = []
    for of in summaries:
        tracks, limit = of["tracks"][0], of["limit"][0]
        rows.append([of["case"].name, of["case"].aircraft, of["case"].clutter, *(
            f"{one[key]:.{digits}f}" for key, digits in both for one in (tracks, limit)),
            f"{tracks['nees_inside']:.3f}", f"{tracks['velocity_ratio']:.2f}",
            f"{limit['velocity_ratio']:.2f}", f"{tracks['velocity_inside']:.3f}",
            f"{tracks['delay_scans']:.2f}", f"{limit['delay_scans']:.2f}"])
    report.table(["case", "aircraft", "clutter", "missed", "limit", "false", "limit",
                  "localisation m", "limit", "rmse m", "limit", "nees", "limit", "inside",
                  "velocity ratio", "limit", "inside", "delay", "limit"], rows)
    draw_grid(report, summaries)


def draw_grid(report, summaries):
    import matplotlib.pyplot as plt
    figure, panels = plt.subplots(2, 2, figsize=(12, 8))
    for axes, (title, of_tracks, has_limit) in zip(panels.flat, (
            ("GOSPA over the root of the number of aircraft, m",
             lambda case, one: one["gospa_m"] / math.sqrt(case.aircraft), True),
            ("completeness", lambda case, one: one["completeness"], True),
            ("false tracks a scan and aircraft", lambda case, one: one["false"] / case.aircraft,
             True),
            ("ms a scan", None, False))):
        for number, aircraft in enumerate((10, 50, 200, 1000)):
            level = [of for of in summaries if of["case"].aircraft == aircraft]
            clutter = [of["case"].clutter for of in level]
            axes.plot(clutter, [of_tracks(of["case"], of["tracks"][0]) if of_tracks else
                                of["us"] / 1e3 for of in level], "o-", color=f"C{number}",
                      markersize=4, label=f"{aircraft} aircraft")
            if has_limit:
                axes.plot(clutter, [of_tracks(of["case"], of["limit"][0]) for of in level], "--",
                          color=f"C{number}", linewidth=1)
        axes.set_xscale("symlog", linthresh=100)
        axes.set(xlabel="clutter plots a scan", ylabel=title)
    panels[1, 1].set_yscale("log")
    panels[0, 0].legend()
    report.figure("grid", figure, "By aircraft and clutter; dashed: the limit. Runs with 1000 "
                  "aircraft are short, and aircraft have no track in the first scans.")


def tell_stress(report, summaries):
    report.heading("What else goes wrong")
    report.text("50 aircraft, 100 clutter plots a scan, and:")
    report.table(TRAFFIC_HEADS, map(traffic_row, summaries))


def alone_per_hour(of):
    """False tracks an hour in the same clutter without aircraft."""
    return sum(run["alarms"]["confirmed"] for run in of["runs"]) / sum(
        run["alarms"]["hours"] for run in of["runs"])


def found_by(of):
    """Shares of the targets that lived so long, by scans since the first."""
    return sum(run["found"] for run in of["runs"]) / sum(run["alive"] for run in of["runs"])


def tell_operation(report, summaries):
    import matplotlib.pyplot as plt
    report.heading("Detection against false tracks")
    report.text("50 aircraft, 1000 clutter plots a scan, false_tracks_per_hour varied. False tracks "
                "an hour: confirmed ones in the same clutter alone; and with the aircraft, those "
                "that have none in more than half of their scans. Found by scan k of their life.")
    by = (3, 4, 5, 6, 8, 10)
    rows = []
    for of in summaries:
        hours = sum(run["hours"] for run in of["runs"])
        tracks = of["tracks"][0]
        rows.append([of["case"].name, f"{alone_per_hour(of):.2f}",
                     f"{tracks['false_tracks'] * len(of['runs']) / hours:.1f}",
                     f"{tracks['false']:.3f}", f"{of['min_scans']:.1f}",
                     *(f"{found_by(of)[k - 1]:.3f}" for k in by), f"{tracks['completeness']:.4f}",
                     f"{tracks['gospa_m']:.0f}"])
    report.table(["wanted an hour", "in clutter alone", "false tracks an hour", "false a scan", "M",
                  f"found by scan {by[0]}", *map(str, by[1:]), "complete", "gospa m"], rows)
    figure, axes = plt.subplots(figsize=(8, 4.5))
    for k in by:
        axes.plot([alone_per_hour(of) for of in summaries],
                  [found_by(of)[k - 1] for of in summaries], "o-", label=f"by scan {k}")
    axes.set_xscale("symlog", linthresh=1)
    axes.set(xlabel="false tracks an hour in clutter alone", ylabel="aircraft found", ylim=(0, 1.02))
    axes.legend()
    report.figure("operation", figure, "Aircraft found by the scans of their life over false "
                  "tracks.")


def tell_pairs(report, results):
    report.heading("Pairs")
    report.text("0.004 clutter plots a km^2. Parallel for 5 minutes, all the time or after they met "
                "and before they part at 10 degrees. Scans at which those that cross or meet are "
                "within 395 m do not count: who is who is not to be seen there.")
    report.table(["two aircraft", "runs", "no switch", "switches a run",
                  "a track is missing at the last four", "complete"], [
        [pair.name, of["runs"], f"{of['no_switch']:.3f}", f"{of['switches']:.2f}",
         f"{of['lost']:.3f}", f"{of['completeness']:.4f}"] for pair, of in zip(PAIRS, results)])
    report.fact("pairs", [{"case": pair.name, **of} for pair, of in zip(PAIRS, results)])
    for pair, of in zip(PAIRS, results):
        if pair.kept_least:
            report.at_least(f"{pair.name}: runs without a switch", of["no_switch"],
                            pair.kept_least, trials=of["runs"])
        report.at_most(f"{pair.name}: runs that lost one", of["lost"], 0.0, trials=of["runs"])


def tell_clutter(report, results):
    report.heading("Clutter alone")
    report.text("Every confirmed track is false. 100 000 scans of each: `tools/lab/air_traffic.py "
                "--part clutter --runs 200`.")
    rows, facts = [], []
    for (clutter, wanted), of in zip(ALARMS, results):
        low, high = (limit / of["hours"] for limit in lab.poisson_limits(of["confirmed"]))
        rate = of["confirmed"] / of["hours"]
        rows.append([clutter, wanted, of["scans"], f"{of['hours']:.1f}", of["confirmed"],
                     f"{rate:.2f}", f"{low:.2f} .. {high:.2f}", f"{of['min_scans']:.2f}",
                     f"{of['us'] / 1e3:.2f}"])
        facts.append({"clutter_per_scan": clutter, "wanted_per_hour": wanted, "per_hour": rate,
                      **of})
    report.table(["clutter a scan", "wanted an hour", "scans", "hours", "false tracks", "an hour",
                  "95 % limits", "M", "ms a scan"], rows)
    report.fact("clutter", facts)
    for one in facts:
        expected = one["hours"] * one["wanted_per_hour"]
        if expected >= LEAST_WANTED:
            name = f"clutter {one['clutter_per_scan']:g} alone, {one['wanted_per_hour']} wanted: " \
                   f"false tracks over wanted"
            error = math.sqrt(max(1, one["confirmed"])) / expected
            report.at_most(name, one["confirmed"] / expected, 2.0, error)
            report.at_least(name, one["confirmed"] / expected, 0.5, error)


def tell_rivals(report, results):
    """results: {method: ([figures of each run], ms)}."""
    report.heading("Beside Stone Soup")
    report.text("The same plots: 50 aircraft, 100 clutter plots a scan, 120 scans; two runs at most. "
                "Stone Soup as stonesoup_tracker.py sets it up, which is best for such plots."
                if len(results) > 1 else "Left out: the Python package stonesoup is not installed; "
                "`make bench-stonesoup` installs it.")
    own, own_ms = results["rhotrack"]
    rows, facts = [], []
    for method, (figures, ms) in results.items():
        name = method if method == "rhotrack" else f"Stone Soup, {method.upper()}"
        of = mean_figures(figures)
        over = lab.root_of(*lab.ratio_of([one["gospa_m"]**2 for one in own],
                                         [one["gospa_m"]**2 for one in figures]))
        rows.append([name, f"{of['gospa_m']:.0f}", f"{of['localisation_m']:.0f}",
                     f"{of['missed']:.3f}", f"{of['false']:.3f}", f"{of['completeness']:.4f}",
                     f"{of['switches']:.1f}", f"{of['delay_scans']:.2f}", f"{ms:.3f}",
                     f"{over[0]:.3f}", f"{ms / own_ms:.0f}"])
        facts.append({"tracker": name, **of, "scan_ms": ms})
        if method != "rhotrack":
            report.at_most(f"GOSPA over that of {name}", over[0], 0.9, over[1])
            report.at_least(f"time of {name} over rhotrack's", ms / own_ms, 400)
    report.table(["tracker", "gospa m", "localisation", "missed", "false", "complete", "switches",
                  "delay", "ms a scan", "rhotrack's gospa over it", "its time over rhotrack's"],
                 rows)
    report.fact("rivals", facts)


BARS = {(50, 100): (0.95, 1.0, 1.0), (50, 1000): (0.94, 1.5, 10.0), (50, 5000): (0.90, 5.0, 80.0),
        (1000, 5000): (None, None, 150.0)}  # completeness, false tracks a scan, ms a scan


def judge_grid(report, summaries):
    for of in summaries:
        case = of["case"]
        if (case.aircraft, case.clutter) not in BARS:
            continue
        complete, false, ms = BARS[case.aircraft, case.clutter]
        name = f"{case.aircraft} aircraft, clutter {case.clutter}"
        if complete:
            for key, what, judge, bar in (("completeness", "completeness", report.at_least, complete),
                                          ("false", "false tracks a scan", report.at_most, false)):
                value, error = lab.mean_of([run["tracks"][0][key] for run in of["runs"]])
                judge(f"{name}: {what}", value, bar, error)
        report.at_most(f"{name}: ms a scan", of["us"] / 1e3, ms)
        if (case.aircraft, case.clutter) == (50, 100):
            for cutoff_m, (value, error) in zip(CUTOFFS_M, of["ratio"]):
                report.at_most(f"{name}: GOSPA with cutoff {cutoff_m:g} m over the limit's", value,
                               1.05, error)


# --- the parts


def measure_traffic(report, parts):
    """The largest go first."""
    options = report.options
    cases = [case for case in CASES if case.part in parts]
    jobs = [(case, options.seed + run) for case in reversed(cases)
            for run in range(max(1, options.runs // case.share))]
    runs = collections.defaultdict(list)
    for (case, _), result in zip(jobs, report.map(run_traffic, jobs)):
        runs[id(case)].append(result)
    summaries = [summary_of(case, runs[id(case)]) for case in cases]
    for part, tell in (("grid", tell_grid), ("stress", tell_stress),
                       ("operation", tell_operation)):
        if part in parts:
            tell(report, [of for of in summaries if of["case"].part == part])
    report.fact("cases", [
        {"part": of["case"].part, "case": of["case"].name, "targets": of["case"].aircraft,
         "clutter_per_scan": of["case"].clutter, "scan_us": of["us"],
         "min_scans": float(of["min_scans"]), "tracks": of["tracks"][0],
         "tracks_200_m": of["tracks"][1], **({"limit": of["limit"][0],
                                              "limit_200_m": of["limit"][1]}
                                             if "limit" in of else {})} for of in summaries])
    judge_grid(report, [of for of in summaries if of["case"].part == "grid"])


def measure_pairs(report):
    count = PAIR_RUNS * report.options.runs
    done = report.map(run_pair, [(pair, report.options.seed, run)
                                 for pair in PAIRS for run in range(count)])
    return [{"runs": count, **{key: float(np.mean([run[key] for run in done[k:k + count]]))
                               for key in done[0]}} for k in range(0, len(done), count)]


def measure_clutter(report):
    """The densest take longest, and go first."""
    count = report.options.runs
    done = report.map(run_alarm, [(*alarm, report.options.seed + run) for alarm in reversed(ALARMS)
                                  for run in range(count)])
    runs = [done[k:k + count] for k in range(0, len(done), count)][::-1]
    return [{"scans": sum(one["scans"] for one in of), "hours": sum(one["hours"] for one in of),
             "confirmed": sum(one["confirmed"] for one in of),
             "min_scans": float(np.mean([one["min_scans"] for one in of])),
             "us": min(one["us"] for one in of)} for of in runs]


def measure_rivals(report):
    methods = ["rhotrack", *(stonesoup_tracker.METHODS if stonesoup_tracker.is_installed() else ())]
    seeds = [report.options.seed + run for run in range(min(RIVAL_RUNS, report.options.runs))]
    done = report.map(run_rival, [(method, seed) for method in methods for seed in seeds])
    return {method: ([figures for figures, _ in of], min(ms for _, ms in of))
            for k, method in enumerate(methods)
            for of in [done[k * len(seeds):(k + 1) * len(seeds)]]}


def main():
    options = lab.options_of(__doc__, RUNS, lambda parser: parser.add_argument(
        "--part", action="append", choices=PARTS, help="this one alone (repeatable)"))
    parts = options.part or PARTS
    report = lab.Report("Air traffic over 500 x 500 km, a scan every 10 s, sigma 50 m, P_D 0.95",
                        options)
    measure_traffic(report, parts)
    if "pairs" in parts:
        tell_pairs(report, measure_pairs(report))
    if "clutter" in parts:
        tell_clutter(report, measure_clutter(report))
    if "rivals" in parts:
        tell_rivals(report, measure_rivals(report))
    report.close()


if __name__ == "__main__":
    main()
