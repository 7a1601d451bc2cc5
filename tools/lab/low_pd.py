#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment low-pd: tracks of targets that are seldom seen, beside an oracle and bars.

Low P_D that the tracker is told, or told wrong, six missed scans of all targets at once, and a
sector of low P_D. The scenes are in OUTPUT, to be tried: `rhotrack simulate OUTPUT/scene-00.json`.
Exit codes: 0, also where bars are missed; 1: the program failed; 2: bad usage.
"""
from common import experiment  # before numpy, whose threads it limits

import numpy as np

import real_skies
from common import scene_runs

GATE_M = 1000
TURNS = 120
SECONDS = 300  # of the Cartesian scene: at P_D .5 the delay alone takes 3 % of 120 scans
MISSED_TURNS = 6
RADAR = {"turn_s": 4, "range_m": [1000, 80000], "sigma_range_m": 30, "sigma_azimuth_rad": 0.003}
SMALL_RADAR = {"interval_s": 1, "sigma_m": 15}
TOLD = {"told": {"pd": 0.9}}


def polar(radar, plots=10, **others):
    """Ten straight targets about a radar of 4 s a turn."""
    return {
        "version": 1, "duration_s": 4 * TURNS,
        "settings": {"v_min_mps": 30, "v_max_mps": 350, "accel_max_mps2": 20},
        "radars": [{**RADAR, **radar}],
        "targets": [{"count": 10, "range_m": [15000, 60000], "speed_mps": [120, 280],
                     "keep_range_m": [3000, 78400]}],
        "clutter": [{"kind": "uniform", "plots": plots}],
        "oracle": {"process_noise_mps2": 0.1}, **others
    }


def cartesian(radar):
    """Eight slow ones about a radar that gives x and y each second."""
    return {
        "version": 1, "duration_s": SECONDS, "area": [-25000, 25000, -25000, 25000],
        "settings": {"v_max_mps": 80, "accel_max_mps2": 5},
        "radars": [{**SMALL_RADAR, **radar}],
        "targets": [{"count": 8, "range_m": [0, 8000], "speed_mps": [20, 60]}],
        "clutter": [{"kind": "uniform", "plots": 10}],
        "oracle": {"process_noise_mps2": 0.1}
    }


def bursts(seed):
    """Every 60 to 120 s the radar misses all targets for six scans; clutter goes on."""
    times_s = np.cumsum(np.random.default_rng(seed).uniform(60, 120, 8))
    return polar({"pd": 0.9}, 50, events=[
        {"kind": "fades", "from_s": time_s, "until_s": time_s + 4 * MISSED_TURNS}
        for time_s in times_s.tolist() if time_s < 4 * TURNS
    ])


# Scenes, and their bars: least completeness, most switches a run
CASES = {
    "P_D .5": (polar({"pd": 0.5}), 0.92, None),
    "P_D .3": (polar({"pd": 0.3}), 0.85, None),
    "told .9, really .5": (cartesian({"pd": 0.5, **TOLD}), 0.97, None),
    "told .9, really .3": (cartesian({"pd": 0.3, **TOLD}), None, None),
    "six missed scans": (bursts, 0.955, 0.5),
    ".45 in a sector, told .9": (polar({"pd": 0.95, **TOLD}, events=[
        {"kind": "fades", "sector_rad": [-1.2, 1.2], "pd": 0.45}]), 0.945, None),
}


def draw(report, figures):
    """Completeness of each case, and its bar."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(9, 4))
    places = np.arange(len(figures))
    for off, who, colour in ((-0.2, "tracker", "#1f5fbf"), (0.2, "oracle", "#9aa3ad")):
        values = np.array([found[who]["completeness"] for found in figures.values()])
        axes.bar(places + off, values[:, 0], 0.38, yerr=np.nan_to_num(values[:, 1]), color=colour,
                 label=who)
    for place, case in zip(places, figures):
        if CASES[case][1] is not None:
            axes.plot([place - 0.4, place], [CASES[case][1]] * 2, color="#d1242f")
    axes.set_xticks(places, list(figures), rotation=20, ha="right")
    axes.set(ylabel="completeness", ylim=(0, 1))
    axes.legend(loc="lower right")
    report.figure("completeness", figure, "Completeness by case; bars in red.")


def add_options(parser):
    parser.add_argument("--case", action="append", choices=list(CASES),
                        help="this one alone (repeatable)")
    real_skies.add_program_options(parser)


def main():
    options = experiment.options_of(__doc__, 20, add_options)
    cases = {name: CASES[name][0] for name in options.case or CASES}
    report = experiment.Report("Targets that are seldom seen", options)
    runs = scene_runs.run_all(report, cases, GATE_M, options)
    figures = {
        case: {who: scene_runs.means_of(found, who) for who in ("tracker", "oracle")}
        for case, found in runs.items()
    }
    report.table(["scene", "by", *scene_runs.HEADINGS],
                 [["" if who == "oracle" else case, who, *scene_runs.cells_of(found[who])]
                  for case, found in figures.items() for who in found])
    draw(report, figures)
    report.fact("cases", [{"case": case, **{who: experiment.values_of(found[who])
                                            for who in found}} for case, found in figures.items()])
    for case, found in figures.items():
        _, least, most = CASES[case]
        if least is not None:
            value, error = found["tracker"]["completeness"]
            report.at_least(f"{case}: completeness", value, least, error)
        if most is not None:
            value, error = found["tracker"]["switches"]
            report.at_most(f"{case}: switches a run", value, most, error)
    report.close()


if __name__ == "__main__":
    main()
