#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment two-radars: two radars that do not know of each other see the same aircraft.

Of each run of scene two-radars `rhotrack register` estimates the biases from the plots alone; then
the same plots are tracked in six cases: each radar alone, and both with biases left, found and
known, in the order of time or as the scans arrive, a fifth of them late. Tracks are looked at each
second; errors and duplicates count where both radars see, an error being that of the target's
nearest track within the GOSPA cutoff, a duplicate each further track there.
"""
import dataclasses
import json
import math

import numpy as np

from common import gospa
from common import experiment
import rhotrack
from common import simulate_scene

RUNS = 50
LOOK_S = 1.0
BORDER_M = 2000.0  # so near to the end of a radar's range a target counts for nothing
# the scene's, by sensor_id; radar 1 is the reference of time
BIASES = {1: {"range_bias_m": 50.0, "azimuth_bias_rad": math.radians(0.1), "time_bias_s": 0.0},
          2: {"range_bias_m": -50.0, "azimuth_bias_rad": -math.radians(0.1), "time_bias_s": 0.0}}
KINDS = (("range_bias_m", "range, m", 1.0, 2),
         ("azimuth_bias_rad", "azimuth, deg", math.radians(1), 4),
         ("time_bias_s", "time, ms", 1e-3, 1))


@dataclasses.dataclass
class Case:
    name: str
    radars: tuple = (1, 2)
    biases: str = "known"
    is_as_arrived: bool = False


CASES = (Case("radar 1 alone, biases known", (1,)), Case("radar 2 alone, biases known", (2,)),
         Case("both, biases left", biases="left"), Case("both, biases of register", biases="found"),
         Case("both, biases known"),
         Case("both, known, scans as they arrive", is_as_arrived=True))
FIRST, SECOND, LEFT, FOUND, KNOWN, ARRIVED = range(len(CASES))


def register(folder):
    """{sensor_id: what `rhotrack register --json` says of it}; a bias may be missing or null."""
    told = json.loads(simulate_scene.run_program(
        "register", folder / "plots.csv", "--config", folder / "scenario.ini", "--json"))
    return {radar["sensor_id"]: radar for radar in told["radars"]}


# --- tracks


def scans_of(case, run):
    """Settings that know the case's biases, and its scans; times of plots without their bias."""
    settings = run.settings.copy()
    rows = simulate_scene.with_fields(
        run.plots,
        ("t_s", "sensor_id", "range_m", "azimuth_rad", "sector_from_rad", "sector_to_rad"))
    is_plot = simulate_scene.has_plot(rows)
    for sensor_id in case.radars:
        biases = dict(BIASES[sensor_id]) if case.biases == "known" else {
            kind: (run.also[sensor_id].get(kind) or 0.0) if case.biases == "found" else 0.0
            for kind, *_ in KINDS}
        rows["t_s"][is_plot & (rows["sensor_id"] == sensor_id)] -= biases.pop("time_bias_s")
        settings.sensor(sensor_id, **biases)
    is_new = (np.diff(run.plots["scan"]) != 0) | (np.diff(run.plots["sensor_id"]) != 0)
    scans = [scan for scan in np.split(rows, np.flatnonzero(is_new) + 1)
             if scan["sensor_id"][0] in case.radars]
    if not case.is_as_arrived:
        scans.sort(key=lambda scan: (scan["t_s"][0], scan["sensor_id"][0]))
    return settings, scans


def looks_of(scans):
    """Times of scans at which tracks are looked at."""
    looks, last_s = [], -math.inf
    for scan in scans:
        if scan["t_s"][0] >= last_s + LOOK_S - 1e-3:  # turns are fractions of it, rounded
            last_s = float(scan["t_s"][0])
            looks.append(last_s)
    return np.array(looks)


def seen_by(run, places_m, radars):
    """How many of the radars see places, not near the end of their range."""
    seen = np.zeros(len(places_m), int)
    for sensor_id in radars:
        sensor = run.sensors[sensor_id]
        range_m = np.hypot(places_m[:, 0] - sensor.x_m, places_m[:, 1] - sensor.y_m)
        seen += (range_m >= sensor.range_min_m + BORDER_M) & (
            range_m <= sensor.range_max_m - BORDER_M)
    return seen


def follow(case, run):
    """Sums of one case of one run."""
    settings, scans = scans_of(case, run)
    tracker = rhotrack.Tracker(settings)
    tracks = tracker.run(rhotrack.Scans(scans, settings))
    tracks = tracks[tracks["status"] != "tentative"]
    looks, cutoff_m = looks_of(scans), settings["gospa_cutoff_m"]
    evaluation = gospa.Evaluation(cutoff_m)
    sums = dict.fromkeys(("common_times", "duplicates", "errors", "sum_m2"), 0.0)
    order = np.argsort(tracks["t_s"], kind="stable")
    bounds = np.searchsorted(tracks["t_s"][order], np.add.outer([-1e-4, 1e-4], looks))
    scan_of = run.truth.scan_of(
        simulate_scene.scene_files.microseconds(looks))
    last_s, hours = None, 0.0
    for k, look_s in enumerate(looks):
        places_m, velocities_mps = run.truth.place_m[scan_of[k]], run.truth.velocity_mps[scan_of[k]]
        counts = seen_by(run, places_m, case.radars) > 0
        is_common = seen_by(run, places_m, (1, 2)) == 2
        now = tracks[order[bounds[0, k]:bounds[1, k]]]
        # a late scan reports at the time of the last one again
        now = now[np.sort(np.unique(now["track_id"], return_index=True)[1])]
        off_m = np.hypot(now["x_m"][:, None] - places_m[:, 0], now["y_m"][:, None] - places_m[:, 1])
        # a track of a target that does not count, at a border, counts for nothing either
        at_border = (off_m.min(axis=1) <= cutoff_m) & ~counts[off_m.argmin(axis=1)]
        now, off_m = now[~at_border], np.where(counts, off_m[~at_border], np.inf)
        owner = np.where(off_m.min(axis=1) <= cutoff_m, off_m.argmin(axis=1), -1)
        for target in np.flatnonzero(counts & is_common):
            own_m = off_m[owner == target, target]
            sums["common_times"] += 1
            if len(own_m):
                sums["duplicates"] += len(own_m) - 1
                sums["errors"] += 1
                sums["sum_m2"] += own_m.min()**2
        hours += counts.sum() * (look_s - last_s) / 3600 if last_s is not None else 0.0
        last_s = look_s
        evaluation.add(np.flatnonzero(counts), places_m[counts], velocities_mps[counts], now)
    result = evaluation.result()
    return {**sums, "target_hours": hours, "target_times": result["target_times"],
            "with_track": result["completeness"] * result["target_times"],
            "switches": result["switches"], "false_tracks": result["false_tracks"],
            "scans": len(scans), "late": tracker.counters["scans_late"]}


def measure(seed):
    run = simulate_scene.simulate("two-radars", seed, also=register)
    return run.also, [follow(case, run) for case in CASES]


# --- over all runs


def errors_of(found, kind):
    """Errors and sigmas by run and radar; NaN where the bias is not known. Of times the reference's
    do not count."""
    radars = (2,) if kind == "time_bias_s" else (1, 2)

    def number(radar, key):
        value = radar.get(key)
        return math.nan if value is None else value

    off = np.array([[number(one[i], kind) - BIASES[i][kind] for i in radars] for one in found])
    name, _, unit = kind.rpartition("_")
    sigma = np.array([[number(one[i], f"{name}_sigma_{unit}") for i in radars] for one in found])
    return off, sigma


def bias_figures(found):
    """By kind: counts, root mean square, 95 % within, worst, mean sigma; and the variance of all
    errors over their sigmas, with its standard error."""
    figures, squares = {}, []
    for kind, *_ in KINDS:
        off, sigma = errors_of(found, kind)
        size = np.sort(np.abs(off[~np.isnan(off)]))
        squares.append((off / sigma)**2)
        figures[kind] = {
            "estimates": len(size), "not_known": int(np.isnan(off).sum()),
            "rms": math.sqrt((size**2).mean()), "p95": size[math.ceil(0.95 * len(size)) - 1],
            "worst": size[-1], "mean_sigma": float(sigma[~np.isnan(off)].mean())
        } if len(size) else {"estimates": 0, "not_known": off.size, "rms": math.nan,
                             "p95": math.nan, "worst": math.nan, "mean_sigma": math.nan}
    squares = np.concatenate(squares, axis=1)
    return figures, experiment.ratio_of(np.nansum(squares, axis=1),
                                        (~np.isnan(squares)).sum(axis=1))


def figures_of(runs):
    """Of one case, as (value, standard error)."""
    of = {key: [run[key] for run in runs] for key in runs[0]}
    return {"rmse_m": experiment.root_of(*experiment.ratio_of(of["sum_m2"], of["errors"])),
            "duplicates_per_target": experiment.ratio_of(of["duplicates"], of["common_times"]),
            "switches_per_target_hour": experiment.ratio_of(of["switches"], of["target_hours"]),
            "completeness": experiment.ratio_of(of["with_track"], of["target_times"]),
            "false_tracks_per_run": experiment.mean_of(of["false_tracks"]),
            "scans_late_share": experiment.ratio_of(of["late"], of["scans"])}


def judge(report, biases, variance, figures):
    found, known, arrived = (figures[case] for case in (FOUND, KNOWN, ARRIVED))
    report.at_most("register: range bias, worst error, m", biases["range_bias_m"]["worst"], 10.0)
    report.at_most("register: azimuth bias, worst error, degrees",
                   math.degrees(biases["azimuth_bias_rad"]["worst"]), 0.02)
    report.at_most("register: biases said to be not known",
                   sum(of["not_known"] for of in biases.values()), 0)
    report.at_most("register: variance of errors over sigmas, off 1", abs(variance[0] - 1), 0.25,
                   variance[1])
    report.at_most("biases of register: duplicates a target", found["duplicates_per_target"][0],
                   0.02, found["duplicates_per_target"][1])
    report.at_most("biases of register: switches a target and hour",
                   found["switches_per_target_hour"][0], 0.05,
                   found["switches_per_target_hour"][1])
    alone = min(figures[FIRST]["rmse_m"], figures[SECOND]["rmse_m"])
    value, error = experiment.quotient_of(found["rmse_m"], alone)
    report.at_most("biases of register: rmse over the better radar's alone, biases known", value,
                   1.0, error)
    value, error = experiment.quotient_of(arrived["rmse_m"], known["rmse_m"])
    report.at_most("scans as they arrive: rmse over that in order", value, 1.05, error)
    report.at_most("scans as they arrive: completeness behind that in order",
                   known["completeness"][0] - arrived["completeness"][0], 0.02,
                   math.hypot(known["completeness"][1], arrived["completeness"][1]))
    report.at_most("scans as they arrive: switches a target and hour",
                   arrived["switches_per_target_hour"][0], 0.05,
                   arrived["switches_per_target_hour"][1])


# --- pictures


def draw_run(report):
    """The map, and 80 s of the aircraft that is nearest to a place between the radars and north."""
    import matplotlib.pyplot as plt
    run = simulate_scene.simulate("two-radars", report.options.seed, also=register)
    truth = run.truth
    figure, axes = plt.subplots(figsize=(8, 7))
    axes.plot(*truth.place_m.transpose(2, 0, 1) / 1e3, color="#0072b2")
    angle = np.linspace(0, 2 * np.pi, 91)
    for sensor in run.sensors.values():
        axes.plot((sensor.x_m + sensor.range_max_m * np.cos(angle)) / 1e3,
                  (sensor.y_m + sensor.range_max_m * np.sin(angle)) / 1e3, "--", color="#808080")
        axes.plot(sensor.x_m / 1e3, sensor.y_m / 1e3, "^", color="#d55e00", markersize=10)
    axes.set(xlabel="x east (km)", ylabel="y north (km)", aspect="equal")
    report.figure("map", figure, "A run: the aircraft, and how far the radars see.")
    middle = len(truth.times_us) // 2
    target = np.nanargmin(np.hypot(*(truth.place_m[middle] - [40000, 40000]).T))
    from_s = truth.times_us[middle] / 1e6 - 40
    shown = (truth.times_us / 1e6 >= from_s) & (truth.times_us / 1e6 <= from_s + 80)
    plots = run.plots[(run.plots["target_id"] == truth.ids[target])
                      & (np.abs(run.plots["t_s"] - from_s - 40) < 40)]
    figure, panels = plt.subplots(1, 2, figsize=(12, 5), sharex=True, sharey=True)
    for axes, title in zip(panels, ("as measured", "without the biases that register found")):
        axes.plot(*truth.place_m[shown, target].T / 1e3, "k", label="where it flies")
        for sensor_id, color, marker in ((1, "#d55e00", "o"), (2, "#0072b2", "s")):
            own, sensor = plots[plots["sensor_id"] == sensor_id], run.sensors[sensor_id]
            biases = run.also[sensor_id] if axes is panels[1] else {}
            range_m = own["range_m"] - (biases.get("range_bias_m") or 0)
            azimuth_rad = own["azimuth_rad"] - (biases.get("azimuth_bias_rad") or 0)
            axes.plot((sensor.x_m + range_m * np.cos(azimuth_rad)) / 1e3,
                      (sensor.y_m + range_m * np.sin(azimuth_rad)) / 1e3, marker, color=color,
                      label=f"plots of radar {sensor_id}")
        axes.set(xlabel="x east (km)", title=title)
    panels[0].set(ylabel="y north (km)")
    panels[0].legend()
    report.figure("plots", figure, "An aircraft of it, 80 s, as the radars measure it, and with "
                  "the biases taken off that register found.")


def draw_errors(report, found):
    import matplotlib.pyplot as plt
    figure, panels = plt.subplots(2, 1, figsize=(9, 7), sharex=True)
    for axes, (kind, name, unit, _) in zip(panels, KINDS):
        off, sigma = errors_of(found, kind)
        for radar, color, marker in ((0, "#d55e00", "o"), (1, "#0072b2", "s")):
            axes.errorbar(np.arange(len(off)) + 0.2 * radar, off[:, radar] / unit,
                          sigma[:, radar] / unit, fmt=marker, color=color, markersize=4,
                          label=f"radar {radar + 1}, one sigma")
        axes.axhline(0, color="black", linewidth=0.5)
        axes.set(ylabel=f"error of {name}")
    panels[1].set(xlabel="run")
    panels[0].legend()
    report.figure("biases", figure, "Errors of the biases that register found.")


def main():
    options = experiment.options_of(__doc__, RUNS)
    report = experiment.Report("Two radars that do not know of each other, 20 aircraft, 10 minutes",
                        options)
    done = report.map(measure, range(options.seed, options.seed + options.runs))
    found = [one[0] for one in done]
    biases, variance = bias_figures(found)
    figures = [figures_of([one[1][k] for one in done]) for k in range(len(CASES))]
    report.text("Radar 1 turns in 10 s (70 m, 1.5 mrad, P_D 0.9), radar 2 in 4 s (40 m, 2 mrad, "
                "P_D 0.8), 80 km east of it. Radar 1 measures 50 m and 0.1 degrees too much, radar "
                "2 as much too little. The aircraft are most of the time where both see them.")
    draw_run(report)
    report.heading("Biases")
    report.text("Estimates of both radars (of time: of the second one), from the run's own plots. "
                "Sigma is what register says itself.")
    report.table(["bias", "estimates", "not known", "rms error", "95 % within", "worst",
                  "mean sigma"], [
        [name, biases[kind]["estimates"], biases[kind]["not_known"],
         *(f"{biases[kind][key] / unit:.{digits}f}"
           for key in ("rms", "p95", "worst", "mean_sigma"))]
        for kind, name, unit, digits in KINDS])
    draw_errors(report, found)
    report.heading("Tracks")
    report.text("Scans are stepped in the order of their times, as they are where one waits for "
                "the late ones, but in the last case.")
    report.table(["tracks", "rmse m", "duplicates a target", "switches a target and hour",
                  "completeness", "false tracks a run", "scans refused as late %"], [
        [case.name, f"{of['rmse_m'][0]:.1f}", f"{of['duplicates_per_target'][0]:.4f}",
         f"{of['switches_per_target_hour'][0]:.3f}", f"{of['completeness'][0]:.3f}",
         f"{of['false_tracks_per_run'][0]:.2f}", f"{100 * of['scans_late_share'][0]:.1f}"]
        for case, of in zip(CASES, figures)])
    report.fact("cases", [{"case": case.name, **experiment.values_of(of)}
                          for case, of in zip(CASES, figures)])
    for kind, *_ in KINDS:
        report.fact(kind, biases[kind])
    report.fact("errors_over_sigmas_variance", variance[0])
    judge(report, biases, variance, figures)
    report.close()


if __name__ == "__main__":
    main()
