#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment fusion: a radar with a camera that sees little or much that is false, beside the radar
alone.

Tracks are scored at the radar's scans, so that both are judged at the same times. The bars hold the
worst camera of each kind against the radar alone, by differences of the same seeds. The scenes are
in OUTPUT, to be tried: `rhotrack simulate OUTPUT/scene-00.json`. Exit codes: 0, also where bars are
missed; 1: the program failed; 2: bad usage.
"""
import itertools

from common import experiment  # before numpy, whose threads it limits

import numpy as np

import real_skies
from common import scene_runs

GATE_M = 40  # targets are 150 to 350 m away, plots of the radar 5 m off
TURN_S, TURNS = 1.68, 120
ALONE = "radar alone"
RATES_HZ, SIGMAS_RAD = (5, 0.5), (0.01, 0.06)
DETECTED, FALSE = (0.95, 0.7, 0.3, 0.1), (0, 2, 15)
COLUMNS = 5  # of the picture
SWAYS_S = (0, 60, 20)  # 0: a bias
SWAY_RAD, SWAYING_RAD = 0.04, (0.003, 0.01)
# Bars of a camera: completeness and switches less the radar's, rms over the radar's
LESS_COMPLETE, MORE_SWITCHES, RMS_RATIO = -0.005, 0.5, 1.03

SCENE = {
    "version": 1, "duration_s": TURN_S * TURNS, "area": [-400, 400, -400, 400],
    "settings": {"v_max_mps": 12, "accel_max_mps2": 0.5},
    "radars": [{"interval_s": TURN_S, "sigma_m": 5, "pd": 0.9}],
    "targets": [{"count": 4, "range_m": [150, 350], "speed_mps": [1, 4],
                 "keep_box_m": [-400, 400, -400, 400]}],
    "clutter": [{"kind": "uniform", "plots": 3}],
    "oracle": {"process_noise_mps2": 0.03}
}


def with_camera(rate_hz, sigma_rad, pd, false_bearings, is_told):
    camera = {
        "at_m": [0, 0], "interval_s": 1 / rate_hz, "range_m": [0, 600], "sigma_rad": sigma_rad,
        "pd": pd, "false_bearings": false_bearings, "is_geometric": True
    }
    return {**SCENE, "passive": [camera if is_told else {**camera, "told": {"pd": 0.9}}]}


def swaying_cameras(rate_hz):
    """{name: scene} of cameras whose errors last: in each target's bearings, or a bias."""
    camera = with_camera(rate_hz, SWAYING_RAD[0], 0.9, 2, True)["passive"][0]
    bias = {"azimuth_bias_rad": SWAY_RAD, "told": {"azimuth_bias_rad": 0}}
    errors = {
        "a bias" if sway_s == 0 else f"period {sway_s} s":
            bias if sway_s == 0 else {"sway_rad": SWAY_RAD, "sway_s": sway_s} for sway_s in SWAYS_S
    }
    return {
        f"{rate_hz:g} Hz, lasting errors, {sigma_rad:g} rad, {name}":
            {**SCENE, "passive": [{**camera, "sigma_rad": sigma_rad, **error}]}
        for sigma_rad, (name, error) in itertools.product(SWAYING_RAD, errors.items())
    }


def name_of(kind, pd, false_bearings):
    return f"{kind}, P_D {pd:g}, {false_bearings} false"


def kind_of(rate_hz, sigma_rad, is_told):
    return f"{rate_hz:g} Hz, {sigma_rad:g} rad, {'told' if is_told else 'told P_D .9'}"


def cameras(options):
    """{kind: {name: scene}} of the cameras that are asked for."""
    return {
        kind_of(rate_hz, sigma_rad, is_told): {
            name_of(kind_of(rate_hz, sigma_rad, is_told), pd, false):
                with_camera(rate_hz, sigma_rad, pd, false, is_told)
            for pd, false in itertools.product(options.pd or DETECTED, options.false or FALSE)
        }
        for rate_hz, sigma_rad, is_told in itertools.product(
            options.rate or RATES_HZ, options.sigma or SIGMAS_RAD, (True, False))
    } | {
        f"{rate_hz:g} Hz, lasting errors": swaying_cameras(rate_hz)
        for rate_hz in options.rate or RATES_HZ
    }


def beside(runs, alone):
    """{figure: (mean difference from the radar alone of the same seeds, standard error)}; of rms
    the ratio, whose error is that of the difference."""
    found = {}
    for key in scene_runs.FIGURES:
        with_it = np.array([run["tracker"][key] for run in runs])
        without = np.array([run["tracker"][key] for run in alone])
        difference, error = experiment.mean_of(with_it - without)
        if key == "rms_m":
            mean, _ = experiment.mean_of(without)
            difference, error = 1 + difference / mean, error / mean
        found[key] = difference, error
    return found


def judge(report, kind, by_name):
    """The bars of one kind of camera: its worst ones hold them."""
    for key, what, bar, is_most in (
            ("completeness", "completeness less the radar's", LESS_COMPLETE, False),
            ("switches", "switches a run more than the radar's", MORE_SWITCHES, True),
            ("rms_m", "rms over the radar's", RMS_RATIO, True)):
        values = [found[key] for found in by_name.values() if not np.isnan(found[key][0])]
        if not values:
            continue
        value, error = (max if is_most else min)(values, key=lambda one: one[0])
        (report.at_most if is_most else report.at_least)(f"{kind}: {what}", value, bar, error)


def draw(report, differences):
    """Completeness less the radar's of each camera, red below the bar."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    num_rows = -(-len(differences) // COLUMNS)
    figure, places = plt.subplots(num_rows, COLUMNS, figsize=(16, 3.6 * num_rows), squeeze=False,
                                  layout="constrained")
    for axes in places.flat[len(differences):]:
        axes.remove()
    for axes, (kind, by_name) in zip(places.flat, differences.items()):
        values = np.array([found["completeness"][0] for found in by_name.values()])
        axes.barh(range(len(values)), values, color=["#d1242f" if value < LESS_COMPLETE
                                                     else "#1f5fbf" for value in values])
        axes.set_yticks(range(len(values)), [name[len(kind) + 2:] for name in by_name], fontsize=7)
        axes.axvline(LESS_COMPLETE, color="#333333", linewidth=0.8)
        axes.set_title(kind, fontsize=8)
        axes.invert_yaxis()
    report.figure("completeness", figure, "Completeness with the camera less the radar's alone.")


def add_options(parser):
    parser.add_argument("--rate", action="append", type=float, choices=RATES_HZ,
                        help="of the camera, Hz: this one alone (repeatable)")
    parser.add_argument("--sigma", action="append", type=float, choices=SIGMAS_RAD,
                        help="of bearings, rad")
    parser.add_argument("--pd", action="append", type=float, choices=DETECTED,
                        help="of the camera")
    parser.add_argument("--false", action="append", type=int, choices=FALSE,
                        help="false bearings a scan")
    real_skies.add_program_options(parser)


def main():
    options = experiment.options_of(__doc__, 10, add_options)
    report = experiment.Report("A radar with a camera, beside the radar alone", options)
    kinds = cameras(options)
    cases = {ALONE: SCENE}
    for by_name in kinds.values():
        cases.update(by_name)
    runs = scene_runs.run_all(report, cases, GATE_M, options)
    figures = {case: scene_runs.means_of(found, "tracker") for case, found in runs.items()}
    oracle = scene_runs.means_of(runs[ALONE], "oracle")
    report.table(["sensors", *scene_runs.HEADINGS],
                 [["oracle of the radar", *scene_runs.cells_of(oracle)]] +
                 [[case, *scene_runs.cells_of(found)] for case, found in figures.items()])
    differences = {
        kind: {name: beside(runs[name], runs[ALONE]) for name in by_name}
        for kind, by_name in kinds.items()
    }
    draw(report, differences)
    report.fact("oracle", experiment.values_of(oracle))
    report.fact("cases", [{"case": case, **experiment.values_of(found)}
                          for case, found in figures.items()])
    for kind, by_name in differences.items():
        judge(report, kind, by_name)
    report.close()


if __name__ == "__main__":
    main()
