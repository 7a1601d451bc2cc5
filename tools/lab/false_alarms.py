#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""False tracks an hour, and time to confirm: whether the tracker keeps the false-track rate that
it was asked for, and how soon it confirms a target.

Area, noise and speeds of Table 1 of Fan et al. (paper_aircraft.py), a scan
every 2 s, min_scans chosen by the tracker. First clutter alone: every confirmed track is false.
Then three targets from the first scan on, P_D 0.99, 0.9 assumed, one false track an hour wanted.
First possible: the scan at which a fit through the target's own plots reaches the threshold that
was in use.
"""
import time
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import chi2

from common import experiment
from common import paper_aircraft as paper
import rhotrack
from common import oracle_fit

RUNS = 8
INTERVAL_S = paper.TABLE_1_INTERVAL_S
ALARM_SCANS = 10000  # of clutter alone, a run
ALARM_PER_KM2 = [0.1, 1.0, 10.0]
WANTED_PER_HOUR = [1.0, 10.0, 100.0]
CHUNK = 20  # scans in one call; thresholds are noted after each
DELAY_PER_KM2 = [0.0, 0.1, 1.0, 3.0, 10.0, 30.0]
DELAY_SCANS = 12  # a target that is not confirmed by then counts as one scan more
DELAYS_A_RUN = 20  # runs of targets for each of clutter alone: they are short
NEAR_M = 100.0  # a confirmed track within is the target's: ten sigmas
MARGIN_M = 500.0


def tracker_of(box_m, wanted_per_hour=1.0):
    return rhotrack.Tracker(
        sigma_m=paper.TABLE_1_SIGMA_M, v_min_mps=paper.V_MIN_MPS, v_max_mps=paper.V_MAX_MPS,
        accel_max_mps2=5, false_tracks_per_hour=wanted_per_hour, **paper.area_settings(box_m))


# ---- clutter alone ----


class Alarms(NamedTuple):
    scans: int
    started: int  # tracks
    confirmed: int
    min_scans: float  # means over the scans
    confirm_nat: float
    step_us: float


def clutter_alone(job):
    per_km2, wanted_per_hour, num_scans, *seed = job
    rng, tracker = np.random.default_rng(seed), tracker_of(paper.TABLE_1_BOX_M, wanted_per_hour)
    mean = 1e-6 * per_km2 * paper.area_m2(paper.TABLE_1_BOX_M)
    thresholds, time_s = [], 0.0
    for first in range(0, num_scans, CHUNK):
        scans = rhotrack.Scans([
            paper.rows_of(INTERVAL_S * k, paper.clutter(paper.TABLE_1_BOX_M, mean, rng))
            for k in range(first, min(first + CHUNK, num_scans))], tracker.settings)
        start_s = time.thread_time()
        tracker.run(scans)
        time_s += time.thread_time() - start_s
        thresholds.append([tracker.min_scans, tracker.thresholds_nat[1]])
    return Alarms(num_scans, tracker.counters["tracks_started"],
                  tracker.counters["tracks_confirmed"], *np.mean(thresholds, axis=0).tolist(),
                  1e6 * time_s / num_scans)


def alarm_row(per_km2, wanted_per_hour, runs):
    scans, confirmed = sum(run.scans for run in runs), sum(run.confirmed for run in runs)
    hours = scans * INTERVAL_S / 3600
    return {
        "clutter_per_km2": per_km2, "wanted_per_hour": wanted_per_hour, "false_tracks": confirmed,
        "hours": hours, "per_hour": confirmed / hours,
        "per_hour_low": float(chi2.ppf(0.025, 2 * confirmed)) / 2 / hours if confirmed else 0.0,
        "per_hour_high": float(chi2.ppf(0.975, 2 * confirmed + 2)) / 2 / hours,
        "started_per_scan": sum(run.started for run in runs) / scans,
        **{name: float(np.mean([getattr(run, name) for run in runs]))
           for name in ("min_scans", "confirm_nat", "step_us")}}


# ---- targets ----


class Delays(NamedTuple):
    """By target; scans count from 1, DELAY_SCANS + 1: never."""
    confirmed_at: np.ndarray
    plots: np.ndarray  # that the target had had when it was confirmed
    possible_at: np.ndarray


def box_with_paths(paths_m):
    """The area holds the targets' paths."""
    low, high = paths_m.min(axis=(0, 1)), paths_m.max(axis=(0, 1))
    x_min, x_max, y_min, y_max = paper.TABLE_1_BOX_M
    return (x_min if low[0] >= x_min else low[0] - MARGIN_M,
            x_max if high[0] <= x_max else high[0] + MARGIN_M,
            y_min if low[1] >= y_min else low[1] - MARGIN_M,
            y_max if high[1] <= y_max else high[1] + MARGIN_M)


def is_fit_above_threshold(history, per_km2, area_m2, settings, confirm_nat):
    """Whether the fit through all plots (t_s, x_m, y_m) of a target reaches the threshold."""
    if len(history) < 3:
        return False
    history = np.array(history)
    t_s = history[:, 0] - history[0, 0]
    model = oracle_fit.Model(
        round(t_s[-1] / INTERVAL_S) + 1, INTERVAL_S, paper.TABLE_1_SIGMA_M, settings.pd, area_m2,
        paper.V_MIN_MPS, paper.V_MAX_MPS)
    # where there is no clutter: half a plot in the area and window, as the initiator takes it
    density = max(1e-6 * per_km2, 0.5 / (area_m2 * settings.scans))
    score_nat = oracle_fit.fit(model, t_s, history[:, 1:],
                                           np.full(len(t_s), density))[1]
    return score_nat >= confirm_nat


def targets_in_clutter(job):
    per_km2, *seed = job
    paths_m = paper.straight(paper.TABLE_1, DELAY_SCANS)
    box_m, num_targets = box_with_paths(paths_m), paths_m.shape[1]
    area_m2, tracker = paper.area_m2(box_m), tracker_of(box_m)
    observed = paper.observed(paths_m, paper.TABLE_1_SIGMA_M, 0.99,
                              [(box_m, 1e-6 * per_km2 * area_m2)], np.random.default_rng(seed))
    histories = [[] for _ in range(num_targets)]
    found = Delays(*np.full((3, num_targets), DELAY_SCANS + 1))
    for k, (places, targets) in enumerate(observed):
        tracks = tracker.step(paper.rows_of(INTERVAL_S * k, places))
        confirmed = tracks[tracks["status"] != "tentative"]
        for target, history in enumerate(histories):
            seen = places[targets == target]
            if len(seen):
                history.append((INTERVAL_S * k, *seen[0]))
                # only a new plot can make it possible
                if found.possible_at[target] > k + 1 and is_fit_above_threshold(
                        history, per_km2, area_m2, tracker.settings,
                        tracker.thresholds_nat[1]):
                    found.possible_at[target] = k + 1
            off_m = np.hypot(confirmed["x_m"] - paths_m[k, target, 0],
                             confirmed["y_m"] - paths_m[k, target, 1])
            if found.confirmed_at[target] > k + 1 and np.any(off_m <= NEAR_M):
                found.confirmed_at[target], found.plots[target] = k + 1, len(history)
    return found


def delay_row(per_km2, runs):
    confirmed_at, plots, possible_at = (np.concatenate(part) for part in zip(*runs))
    return {
        "clutter_per_km2": per_km2, "targets": len(plots),
        "confirmed_at_scan": float(confirmed_at.mean()),
        "possible_at_scan": float(possible_at.mean()),
        "scans_behind": experiment.mean_of(confirmed_at - possible_at),
        "on_third_plot": float(np.mean(plots <= 3)),
        "at_most_one_scan_late": float(np.mean(confirmed_at <= possible_at + 1)),
        "share_by_scan": [float(np.mean(confirmed_at <= k + 1)) for k in range(DELAY_SCANS)]}


# ---- tables, bars, pictures ----


def judge_bars(report, alarms, delays):
    for row in alarms:
        wanted, count = row["wanted_per_hour"], row["false_tracks"]
        if wanted < 50:  # a hundred an hour is told, without a bar
            what = (f"{row['clutter_per_km2']:g} a km^2, {wanted:g} an hour wanted: measured over "
                    f"it")
            error = np.sqrt(max(count, 1)) / (row["hours"] * wanted)
            report.at_most(what, row["per_hour"] / wanted, 2.0, error)
            report.at_least(what, row["per_hour"] / wanted, 0.5, error)
    for row in delays:
        per_km2, (behind, error) = row["clutter_per_km2"], row["scans_behind"]
        if per_km2 == 0:
            report.at_least("clear sky: targets confirmed on their 3rd plot", row["on_third_plot"],
                            0.98, trials=row["targets"])
        elif per_km2 in (1, 10):
            report.at_most(f"{per_km2:g} a km^2: scans from the first possible one, mean", behind,
                           1.0, error)
            report.at_least(f"{per_km2:g} a km^2: targets at most a scan after the first possible "
                            f"one", row["at_most_one_scan_late"], 0.95, trials=row["targets"])


def picture_of_rates(report, alarms):
    figure, axes = plt.subplots(figsize=(9, 5.6))
    wanted = np.array([0.5, 200])
    axes.loglog(wanted, wanted, color="0.5", label="as wanted")
    axes.loglog(wanted, 2 * wanted, "--", color="0.5", label="factor 2")
    axes.loglog(wanted, wanted / 2, "--", color="0.5")
    for i, per_km2 in enumerate(ALARM_PER_KM2):
        rows = [row for row in alarms if row["clutter_per_km2"] == per_km2]
        rate = np.array([row["per_hour"] for row in rows])
        axes.errorbar([row["wanted_per_hour"] * (0.94 + 0.06 * i) for row in rows], rate, [
            rate - [row["per_hour_low"] for row in rows],
            [row["per_hour_high"] for row in rows] - rate], fmt="so^"[i], capsize=3,
            label=f"{per_km2:g} a km^2")
    axes.set(xlabel="wanted an hour", ylabel="measured an hour, 95 % limits")
    axes.legend()
    report.figure("rates", figure, "Confirmed tracks an hour against false_tracks_per_hour.")


def pictures_of_delays(report, delays):
    figure, axes = plt.subplots(figsize=(9, 4.6))
    for name, style, label in (("confirmed_at_scan", "o-", "rhotrack"),
                               ("possible_at_scan", "o--", "first possible")):
        axes.plot([row[name] for row in delays], style, label=label)
    axes.set_xticks(range(len(delays)), [f"{row['clutter_per_km2']:g}" for row in delays])
    axes.set(xlabel="clutter plots a km^2 and scan", ylabel="confirmed at scan, mean",
             ylim=(0, None))
    axes.legend()
    report.figure("delays", figure, "Scans until a target is confirmed.")
    figure, axes = plt.subplots(figsize=(9, 4.6))
    for row in delays:
        axes.plot(range(1, DELAY_SCANS + 1), row["share_by_scan"], "o-",
                  label=f"{row['clutter_per_km2']:g} a km^2")
    axes.set(xlabel="scan", ylabel="share of the targets confirmed")
    axes.legend()
    report.figure("shares", figure, "Targets confirmed by each scan.")


def main():
    options = experiment.options_of(__doc__, RUNS, lambda parser: parser.add_argument(
        "--scans", type=int, default=ALARM_SCANS,
        help=f"of clutter alone, a run (default {ALARM_SCANS})"))
    report = experiment.Report("False tracks an hour, and time to confirm", options)
    report.text(" ".join(__doc__.split("\n\n", maxsplit=1)[1].split()))
    runs, seed = range(options.runs), options.seed
    # the dense ones take longest, and go first; every rate sees the same clutter
    work = [(i, wanted) for i in reversed(range(len(ALARM_PER_KM2))) for wanted in WANTED_PER_HOUR]
    found = iter(report.map(clutter_alone, [(ALARM_PER_KM2[i], wanted, options.scans, seed, i, run)
                                            for i, wanted in work for run in runs]))
    alarms = sorted((alarm_row(ALARM_PER_KM2[i], wanted, [next(found) for _ in runs])
                     for i, wanted in work), key=lambda row: row["clutter_per_km2"])
    runs = range(DELAYS_A_RUN * options.runs)
    found = iter(report.map(targets_in_clutter, [(per_km2, seed, 100 + i, run) for i, per_km2
                                                 in enumerate(DELAY_PER_KM2) for run in runs]))
    delays = [delay_row(per_km2, [next(found) for _ in runs]) for per_km2 in DELAY_PER_KM2]

    report.heading(f"Clutter alone, {options.scans} scans a run")
    report.table(["clutter a km^2", "wanted an hour", "false tracks", "hours", "an hour",
                  "95 % limits", "tentative a scan", "M", "threshold nat", "us a scan"], [
        [f"{row['clutter_per_km2']:g}", f"{row['wanted_per_hour']:g}", row["false_tracks"],
         f"{row['hours']:.1f}", f"{row['per_hour']:.2f}",
         f"{row['per_hour_low']:.2f} .. {row['per_hour_high']:.2f}",
         f"{row['started_per_scan']:.4f}", f"{row['min_scans']:.2f}", f"{row['confirm_nat']:.2f}",
         f"{row['step_us']:.0f}"] for row in alarms])
    picture_of_rates(report, alarms)
    report.heading("Targets")
    report.table(["clutter a km^2", "targets", "confirmed at scan", "first possible at",
                  "on the 3rd plot", "at most a scan later", f"by scan {DELAY_SCANS}"], [
        [f"{row['clutter_per_km2']:g}", row["targets"], f"{row['confirmed_at_scan']:.2f}",
         f"{row['possible_at_scan']:.2f}", f"{row['on_third_plot']:.3f}",
         f"{row['at_most_one_scan_late']:.3f}", f"{row['share_by_scan'][-1]:.3f}"]
        for row in delays])
    pictures_of_delays(report, delays)
    judge_bars(report, alarms, delays)
    report.fact("clutter_alone", alarms)
    report.fact("targets", [{**row, "scans_behind": row["scans_behind"][0]} for row in delays])
    report.close()


if __name__ == "__main__":
    main()
