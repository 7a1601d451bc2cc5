#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Experiment dense-windows: what a limit of a step's work costs in the densest windows of the
literature.

Scene crossing (Table 1 of Fan et al.: three targets, seven scans, P_D .99) in more and more
clutter, one batch (`rhotrack initiate`): once with the work_max of the shipped full node, once
without a limit. A target is found where a track is within 30 m of it at the last scan. `not tried`
is the share of the plots of which not all pairs were tried. Thresholds are those of experiment
initiation. The node's scans hold 256 plots, so that the densest window is beyond it anyhow.
"""
import csv
import json
import math
import pathlib
import subprocess
import tempfile

from common import experiment

CLUTTER_PER_KM2 = {5: 5, 10: 5, 15: 5, 20: 5, 24: 6, 30: 6}  # and the hits that are asked
AREA_KM2 = 10
FULL_NODE_WORK = 500000  # RHO_WORK_MAX of the embedded profile
NEAR_M = 30.0
SETTINGS = {"pd": 0.99, "score_min_nat": -3}


def rows(path):
    with path.open(encoding="utf-8", newline="") as file:
        return [{key: float(value) for key, value in row.items() if value}
                for row in csv.DictReader(file)]


def distance_m(track, target):
    return math.hypot(track["x_m"] - target["x_m"], track["y_m"] - target["y_m"])


def search_figures(program, folder, min_scans, work_max):
    """How many targets are found, how many tracks are of none, and the share not tried."""
    settings = {**SETTINGS, "min_scans": min_scans, "work_max": work_max}
    options = [f"--set={key}={value}" for key, value in settings.items()]
    said = subprocess.run(
        [program, "initiate", folder / "plots.csv", "--config", folder / "scenario.ini",
         "-o", folder / "tracks.csv", "--json", *options],
        capture_output=True, text=True, check=True)
    figures = json.loads(said.stdout)
    truth = rows(folder / "truth.csv")
    last_s = max(row["t_s"] for row in truth)
    targets = [row for row in truth if row["t_s"] == last_s]
    tracks = rows(folder / "tracks.csv")
    found = sum(any(distance_m(track, target) <= NEAR_M for track in tracks) for target in targets)
    false = sum(all(distance_m(track, target) > NEAR_M for target in targets) for track in tracks)
    return found / len(targets), false, figures["plots_not_tried"] / figures["plots"]


def mean_figures(program, folder, per_km2, min_scans, runs, seed):
    """Of each limit: found, false tracks a run, not tried."""
    subprocess.run(
        [program, "simulate", "crossing", "--runs", str(runs), "--seed", str(seed),
         f"--set=clutter.0.plots_per_km2={per_km2}", "-o", folder],
        check=True)
    some = sorted(folder.glob("run-*")) or [folder]
    return [[sum(column) / runs for column in zip(*(
        search_figures(program, run, min_scans, limit) for run in some))]
            for limit in (FULL_NODE_WORK, 0)]


def density_case(job):
    """One density: plots a scan, and both limits' means."""
    program, per_km2, min_scans, runs, seed = job
    with tempfile.TemporaryDirectory() as folder:
        return per_km2 * AREA_KM2, *mean_figures(program, pathlib.Path(folder) / "runs", per_km2,
                                                 min_scans, runs, seed)


def add_options(parser):
    parser.add_argument("--program", default=experiment.ROOT / "build" / "rhotrack")


def main():
    options = experiment.options_of(__doc__, 100, add_options)
    report = experiment.Report(f"Scene crossing, seven scans in one batch, work_max "
                               f"{FULL_NODE_WORK} and none", options)
    windows = report.map(density_case, [
        (options.program, per_km2, min_scans, options.runs, options.seed)
        for per_km2, min_scans in CLUTTER_PER_KM2.items()])
    report.table(
        ["plots a scan", "found", "without", "loss", "false", "without", "not tried"],
        [[plots, *(f"{figure:.3f}" for figure in (
            limited[0], free[0], free[0] - limited[0], limited[1], free[1], limited[2]))]
         for plots, limited, free in windows])
    report.fact("windows", [{
        "plots": plots, "found": limited[0], "found_without_limit": free[0], "false": limited[1],
        "false_without_limit": free[1], "not_tried": limited[2]}
        for plots, limited, free in windows])
    report.close()


if __name__ == "__main__":
    main()
