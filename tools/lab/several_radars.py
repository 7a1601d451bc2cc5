#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy and scipy are its packages (tools/setup.sh lab).
"""Experiment several-radars: when all radars of a sky together confirm targets, beside each of them
alone.

Of each sky and seed: `rhotrack simulate`, then `rhotrack track` of all plots, and of each radar's
alone. tools/lab/README.md says what the figures mean. Exit codes: 0, also where the bar is missed;
1: the program failed; 2: bad usage.
"""
import json
import pathlib
import sys
import tempfile

from common import experiment  # before numpy, whose threads it limits

import numpy as np

import real_skies
from common import scene_files
from common import scoring

SCENE = real_skies.ROOT / "tools" / "scenes" / "radars" / "overlapping-radars.json"
SLOWEST_S = 15  # times the slowest turn: what has no track by then counts as found then
STANDARD_ERRORS = 2  # no later than the better one alone, within so many
DUPLICATES_MAX = 1e-4  # of the times at which a target has a track: one has a second
TOGETHER = 0  # the key of all radars, beside their numbers


def radar(turn_s=4, at_x_m=0, start_s=0.0, **others):
    return {
        "turn_s": turn_s, "start_s": start_s, "at_m": [at_x_m, 0], "range_m": [1000, 80000],
        "sigma_range_m": 30, "sigma_azimuth_rad": 0.003, "pd": 0.9, **others
    }


def radars(second, first=None, *others):
    return {"radars": [first or radar(), second, *others]}


def with_second_radar(**differs):
    """Scene overlapping-radars, whose second radar differs."""
    return radars(radar(5, 60000, 1.7, **differs))


TWICE_NOISE = {"sigma_range_m": 60, "sigma_azimuth_rad": 0.006}
USUAL_NOISE = {"sigma_range_m": 30, "sigma_azimuth_rad": 0.003}
LATE = {"late_share": 0.2, "late_s": 5}
EVERYWHERE = {"count": 30, "about_m": [30000, 0], "range_m": [3000, 95000], "speed_mps": [100, 250]}
LONG = {"count": 30, "box_m": [-60000, 170000, -50000, 50000], "speed_mps": [100, 250]}
# What differs from scene overlapping-radars
SKIES = {
    "4 s and 5 s": {},
    "the same, targets everywhere": {"targets": [EVERYWHERE]},
    "4 s and 10 s": radars(radar(10, 60000, 1.7)),
    "4 s, and 12 s, coarse": radars(
        radar(12, 60000, 1.7, sigma_range_m=150, sigma_azimuth_rad=0.008)),
    "4 s twice, .1 turn apart": radars(radar(4, 60000, 0.4)),
    "4 s twice, half a turn apart": radars(radar(4, 60000, 2.0)),
    "4 s twice in one place": radars(radar(4, 0, 1.3)),
    "4, 5 and 6 s": radars(radar(5, 60000, 1.7), None, radar(6, 30000, 0.9)),
    "4 s three times": radars(radar(4, 60000, 1.3), None, radar(4, 30000, 2.6)),
    "part in common": {**radars(radar(5, 110000, 1.7)), "targets": [LONG]},
    "P_D .5": with_second_radar(pd=0.5),
    "P_D .5, stated .9": with_second_radar(pd=0.5, told={"pd": 0.9}),
    "one with range rates": with_second_radar(sigma_range_rate_mps=1),
    "one noisier than stated": with_second_radar(**TWICE_NOISE, told=USUAL_NOISE),
    "one biased by a sigma": with_second_radar(range_bias_m=30, azimuth_bias_rad=0.003),
    "a fifth late by 5 s": radars(radar(5, 60000, 1.7, **LATE), radar(**LATE)),
    "by 16 sectors": radars(radar(5, 60000, 1.7, sectors=16), radar(sectors=16)),
    "300 clutter plots in one": {
        "clutter": [{"kind": "uniform", "plots": 50, "sensors": [1]},
                    {"kind": "uniform", "plots": 300, "sensors": [2]}]
    },
}


def plots_of(path, sensor_id):
    """The file's text with the rows of one radar alone."""
    lines = [
        line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")
    ]
    column = lines[0].split(",").index("sensor_id")
    return "\n".join([lines[0]] +
                     [line
                      for line in lines[1:] if int(line.split(",")[column]) == sensor_id]) + "\n"


def follow(truth, tracks, gate):
    """Of each target seconds from its first visibility to its first track (infinite: never); of all
    (target, scan) how many have a track, and how many tracks there are beside, near a target that
    has one."""
    delays_s = np.full(len(truth.ids), np.inf)
    first_us = truth.times_us[truth.visible.argmax(axis=0)]
    pairs = duplicates = 0
    for k, time_us in enumerate(truth.times_us):
        seen = np.nonzero(truth.visible[k])[0]
        if not len(seen) or not len(tracks.ids[k]):
            continue
        apart = np.linalg.norm(truth.place_m[k, seen][:, None, :] - tracks.place_m[k][None, :, :],
                               axis=2) / gate
        rows, cols = scoring.pair(apart, np.zeros(apart.shape, dtype=bool))
        delays_s[seen[rows]] = np.fmin(delays_s[seen[rows]],
                                       (time_us - first_us[seen[rows]]) * 1e-6)
        pairs += len(rows)
        duplicates += int((np.delete(apart, cols, axis=1) <= 1).any(axis=0).sum())
    return delays_s, pairs, duplicates


def run(job):
    """One run: of all radars together and of each alone the delays; which targets began where all
    radars see."""
    name, seed, options = job
    changes = [
        part for key, value in SKIES[name].items()
        for part in ("--set", f"{key}={json.dumps(value)}")
    ]
    sets = [part for pair in options["set"] for part in ("--set", pair)]
    with tempfile.TemporaryDirectory(prefix="rhotrack-") as kept:
        folder = pathlib.Path(kept)
        real_skies.run_program(options["simulator"],
                               ["simulate", SCENE, "--seed", seed, "-o", folder, *changes])
        sensors = scene_files.Settings(folder / "scenario.ini").sensors()
        truth = scene_files.read_truth(
            folder,
            scene_files.read_plots(folder / "plots.csv", sensors).scan_times_us)
        ever = truth.visible.any(axis=0)
        truth = scene_files.Truth(truth.times_us, truth.ids[ever],
                                              truth.place_m[:, ever], truth.visible[:, ever])
        begins_m = truth.place_m[truth.visible.argmax(axis=0), np.arange(len(truth.ids))]
        result = {
            "common": np.all(
                [one.covers(begins_m[:, 0], begins_m[:, 1]) for one in sensors.values()], axis=0)
        }
        for who in [TOGETHER] + sorted(sensors):
            plots = folder / "plots.csv"
            if who != TOGETHER:
                plots = folder / "alone.csv"
                plots.write_text(plots_of(folder / "plots.csv", who), encoding="utf-8")
            real_skies.run_program(options["program"], [
                "track", plots, "--config", folder / "scenario.ini", *sets, "-o",
                folder / "tracks.csv"
            ])
            result[who] = follow(
                truth, scene_files.read_tracks(folder / "tracks.csv", truth),
                scoring.gate_m(sensors))
    return name, result


def figures_of(name, runs):
    """Means over all targets of all runs."""
    common = np.concatenate([one["common"] for one in runs])
    whos = [who for who in runs[0] if who != "common"]
    most_s = SLOWEST_S * max(one["turn_s"] for one in SKIES[name].get("radars", [radar(5)]))
    delays = {who: np.fmin(np.concatenate([one[who][0] for one in runs]), most_s) for who in whos}
    alone = {who: float(delays[who][common].mean()) for who in whos if who != TOGETHER}
    later = (delays[TOGETHER] - delays[min(alone, key=alone.get)])[common]
    error = float(later.std(ddof=1) / np.sqrt(len(later)))
    first = np.min([delays[who] for who in alone], axis=0)
    duplicates = sum(one[TOGETHER][2] for one in runs) / max(1, sum(one[TOGETHER][1]
                                                                    for one in runs))
    return {
        "sky": name, "targets": len(later), "together_s": float(
            delays[TOGETHER][common].mean()), "alone_s": list(alone.values()), "later_s": float(
                later.mean()), "later_error_s": error,
        "others_s": float(delays[TOGETHER][~common].mean()) if not common.all() else None,
        "others_first_s": float(first[~common].mean()) if not common.all() else None,
        "duplicates": duplicates, "held": bool(later.mean() <= STANDARD_ERRORS * error
                                               and duplicates <= DUPLICATES_MAX)
    }


def told(value, form):
    return "" if value is None else form.format(value)


def row_of(found):
    return [found["sky"], f"{found['together_s']:.1f}",
            " ".join(f"{one:.1f}" for one in found["alone_s"]), f"{found['later_s']:+.2f}",
            f"{found['later_error_s']:.2f}", told(found["others_s"], "{:.1f}"),
            told(found["others_first_s"], "{:.1f}"), f"{found['duplicates']:.5f}"]


def add_options(parser):
    parser.add_argument("--sky", action="append", choices=list(SKIES),
                        help="this one alone (repeatable)")
    real_skies.add_program_options(parser)


def main():
    options = experiment.options_of(__doc__, 20, add_options)
    common = {
        "program": str(options.program), "simulator": str(options.simulator or options.program),
        "set": options.set
    }
    names = options.sky or list(SKIES)
    report = experiment.Report("Several radars together, and each alone", options)
    try:
        results = report.map(run, [(name, options.seed + i, common) for name in names
                                   for i in range(options.runs)])
    except (real_skies.Failed, OSError, ValueError) as error:
        sys.stderr.write(f"{pathlib.Path(__file__).name}: {error}\n")
        sys.exit(1)
    skies = [figures_of(name, [result for of, result in results if of == name]) for name in names]
    report.table(["sky", "together s", "each alone s", "later than the better", "+-", "others s",
                  "earliest s", "duplicates"], map(row_of, skies))
    report.fact("skies", skies)
    for found in skies:
        report.at_most(f"{found['sky']}: later than the better one alone, s", found["later_s"], 0,
                       found["later_error_s"])
        report.at_most(f"{found['sky']}: duplicate tracks a target and scan", found["duplicates"],
                       DUPLICATES_MAX)
    report.close()


if __name__ == "__main__":
    main()
