#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment rotating: a turning antenna sector by sector, and what its latency is.

The flights and the clutter of scene rotating are tracked three times: by sectors, a step each; by
whole turns, a step at the end of each; and as if the antenna had looked everywhere at the turn's
end, which sees the targets anew. Errors are those of confirmed tracks at the reports that have
their plots.
"""
import time

import numpy as np

from common import experiment
import rhotrack
from common import simulate_scene

RUNS = 200
CASES = ("sectors", "whole turns", "all at once")
SECTORS, TURN_S = 32, 4.0
WINDOW = 7  # turns in which a target is to be found
TOLERANCE_M = 700.0  # a track within is the target's: a plot's error is up to 180 m across
TIMED_RUNS, ROUNDS = 4, 3
LOSS_MAX, RMSE_MAX = 0.02, 1.1  # of targets, and of errors, beside all at once
STEP_MAX_MS = 1.0  # beside the sector's own time


def scans_of(case, run, seed):
    """Rows of each scan; a scan's own row is its first."""
    if case == "sectors":
        rows = simulate_scene.with_fields(
            run.plots, ("t_s", "sensor_id", "range_m", "azimuth_rad", "sector_from_rad",
                        "sector_to_rad", "scan"))
        return np.split(rows, np.flatnonzero(np.diff(rows["scan"])) + 1)
    is_plot = simulate_scene.has_plot(run.plots)
    rows = simulate_scene.with_fields(
        run.plots, ("t_s", "sensor_id", "range_m", "azimuth_rad"))
    turn = ((run.plots["scan"] - 1) // SECTORS).astype(int)
    end_s = TURN_S * (turn + 1)
    if case == "all at once":
        random = np.random.default_rng([seed, 0x726f74])
        own = run.plots["target_id"] >= 0
        place = run.truth.place_m[SECTORS * turn[own] + SECTORS - 1, run.plots["target_id"][own]]
        rows["t_s"] = end_s
        sensor = run.sensors[1]
        rows["range_m"][own] = np.hypot(*place.T) + random.normal(0, sensor.sigma_range_m,
                                                                  own.sum())
        azimuth_rad = np.arctan2(place[:, 1], place[:, 0]) + random.normal(
            0, sensor.sigma_azimuth_rad, own.sum())
        rows["azimuth_rad"][own] = np.arctan2(np.sin(azimuth_rad), np.cos(azimuth_rad))
    # the last sector's own row is the turn's
    is_last = run.plots["scan"] % SECTORS == 0
    order = np.lexsort([is_plot, turn])
    kept = order[is_plot[order] | is_last[order]]
    return np.split(rows[kept], np.flatnonzero(np.diff(turn[kept])) + 1)


def follow(case, run, seed):
    """Targets tracked, false tracks, and squares of errors: of places, of velocities."""
    tracks = rhotrack.Tracker(run.settings).run(rhotrack.Scans(scans_of(case, run, seed),
                                                               run.settings))
    tracks = tracks[tracks["status"] != "tentative"]
    scan = run.truth.scan_of(
        simulate_scene.scene_files.microseconds(tracks["t_s"]))
    off_m = np.column_stack([tracks["x_m"], tracks["y_m"]])[:, None] - run.truth.place_m[scan]
    distance_m = np.linalg.norm(off_m, axis=2)
    target = distance_m.argmin(axis=1)
    is_near = distance_m.min(axis=1) < TOLERANCE_M
    off_mps = np.column_stack([tracks["vx_mps"], tracks["vy_mps"]]) - run.truth.velocity_mps[
        scan, target]
    has_plot = is_near & (tracks["plot"] >= 0)

    def tracked_at(t_s):
        return len(set(target[is_near & (np.abs(tracks["t_s"] - t_s) < 1e-3)]))

    return {"targets": len(run.truth.ids), "found": tracked_at(WINDOW * TURN_S),
            "tracked": tracked_at(run.truth.times_us[-1] / 1e6),
            "false_tracks": len(set(tracks["track_id"]) - set(tracks["track_id"][is_near])),
            "m2": (distance_m.min(axis=1)[has_plot]**2).sum(),
            "m2ps2": (off_mps[has_plot]**2).sum(), "count": has_plot.sum()}


def measure(seed):
    run = simulate_scene.simulate("rotating", seed)
    return [follow(case, run, seed) for case in CASES]


def time_steps(case, seeds):
    """The longest step and latency of a plot, in microseconds, and the steps of the first run, by
    the end of the scan. Of each step the least of some rounds, of the processor's time."""
    longest_us, latency_us, shown = 0.0, 0.0, None
    for seed in seeds:
        run = simulate_scene.simulate("rotating", seed)
        scans = scans_of(case, run, seed)
        ready = [rhotrack.Scans([scan], run.settings) for scan in scans]
        step_us = np.full(len(scans), np.inf)
        for _ in range(ROUNDS):
            tracker = rhotrack.Tracker(run.settings)
            for k, scan in enumerate(ready):
                start = time.thread_time_ns()
                tracker.run(scan)
                step_us[k] = min(step_us[k], (time.thread_time_ns() - start) / 1e3)
        waits_us = np.array([1e6 * np.max(scan["t_s"][0] - scan["t_s"]) for scan in scans])
        longest_us = max(longest_us, step_us.max())
        latency_us = max(latency_us, (step_us + waits_us).max())
        shown = shown or ([scan["t_s"][0] for scan in scans], step_us / 1e3)
    return longest_us, latency_us, shown


def figures_of(runs):
    """Over the runs of one case; errors as (value, standard error)."""
    total = {key: sum(run[key] for run in runs) for key in runs[0]}

    def rms(key):
        return experiment.root_of(*experiment.ratio_of([run[key] for run in runs],
                                         [run["count"] for run in runs]))

    return {"targets": total["targets"], "found": total["found"] / total["targets"],
            "tracked_at_end": total["tracked"] / total["targets"],
            "false_tracks_per_run": total["false_tracks"] / len(runs),
            "rmse_m": rms("m2"), "rmse_mps": rms("m2ps2")}


def share_behind(runs, key):
    """By how much of the targets sectors are behind all at once, and its standard error."""
    sectors, at_once = runs[0], runs[CASES.index("all at once")]
    return experiment.ratio_of([one[key] - other[key] for one, other in zip(at_once, sectors)],
                        [one["targets"] for one in sectors])


def judge(report, runs, figures, latency_ms):
    for key, what in (("found", "found after 7 turns"), ("tracked", "tracked at the end")):
        value, error = share_behind(runs, key)
        report.at_most(f"by sectors: {what}, behind all at once", value, LOSS_MAX, error)
    value, error = experiment.quotient_of(figures[0]["rmse_m"],
                                   figures[CASES.index("all at once")]["rmse_m"])
    report.at_most("by sectors: rmse over that of all at once", value, RMSE_MAX, error)
    report.at_most("by sectors: ms from a plot's time to its report, at most", latency_ms,
                   1e3 * TURN_S / SECTORS + STEP_MAX_MS)


def draw(report, steps):
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(9, 4))
    for case, (_, _, (end_s, step_ms)) in zip(CASES, steps):
        axes.semilogy(end_s, step_ms, "-" if case == "sectors" else "o-", linewidth=1,
                      markersize=4, label=case)
    axes.set(xlabel="since the start (s)", ylabel="a step (ms)")
    axes.legend()
    report.figure("load", figure, "How long each step of the first run takes: the load spreads "
                  "over the turn.")


def main():
    options = experiment.options_of(__doc__, RUNS)
    report = experiment.Report("A turning antenna, 15 m and 3 mrad, 4 s and 32 sectors a turn",
                               options)
    seeds = [options.seed + run for run in range(options.runs)]
    runs = list(zip(*report.map(measure, seeds)))
    figures = [figures_of(of) for of in runs]
    steps = [time_steps(case, seeds[:TIMED_RUNS]) for case in CASES]
    report.text("Scene rotating: three targets at 20 to 60 km, one of which turns, and 100 clutter "
                "plots a turn. Times are the processor's, of each step the least of three rounds.")
    report.table(["steps", "found after 7 turns", "tracked at the end", "false a run", "rmse m",
                  "rmse m/s", "longest step us", "latency ms"], [
        [case, f"{of['found']:.3f}", f"{of['tracked_at_end']:.3f}",
         f"{of['false_tracks_per_run']:.3f}", f"{of['rmse_m'][0]:.1f}", f"{of['rmse_mps'][0]:.2f}",
         f"{longest_us:.0f}", f"{latency_us / 1e3:.2f}"]
        for case, of, (longest_us, latency_us, _) in zip(CASES, figures, steps)])
    draw(report, steps)
    report.fact("cases", [{"case": case, **experiment.values_of(of), "step_max_us": step[0],
                           "latency_max_ms": step[1] / 1e3}
                          for case, of, step in zip(CASES, figures, steps)])
    judge(report, runs, figures, steps[0][1] / 1e3)
    report.close()


if __name__ == "__main__":
    main()
