#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment bearings: direction finders that need not look together or stand, beside an oracle,
the papers' pipeline and Stone Soup, and the goals.

Sensors 0 to 3 s apart, of .1 to 2 degrees, two to eight of them, some that move or share a mast; 2
to 30 targets, straight and turning, P_D 1 to .7, and hours without a target; elevations, beside the
same sky without them. A row that the program refuses says so. Exit codes: 0, also where goals are
missed; 1: the program failed; 2: bad usage.
"""
import dataclasses
import math
import pathlib
import sys

from common import experiment  # before numpy, whose threads it limits

import numpy as np

import real_skies
from common import stonesoup_tracker
from parts import bearings_runs
from parts.bearings_runs import ORACLE, PAPER, RHOTRACK, STONE_SOUP
from parts.bearings_scenes import Scene

AHEAD_3 = ((0, -10e3), (0, 10e3), (10e3, 0))
AHEAD_4 = (*AHEAD_3, (-10e3, 0))
AROUND_3 = ((0, 0), (20e3, 0), (10e3, 17e3))
STRAIGHT = {"v_max_mps": 400, "accel_max_mps2": 5, "range_max_m": 100e3}
FINDERS = {"v_max_mps": 300, "accel_max_mps2": 20, "range_max_m": 60e3}
SURE_PD = 0.99  # told for P_D 1


@dataclasses.dataclass(frozen=True)
class Goal:
    """None: no goal of it. first: frames before a target's first track; wrong: share of the runs
    that are wrong at the end; rms, height: over the oracle's; below, above: completeness so much
    below, and false tracks above, those of the row `beside` at most."""
    completeness: float = None
    false: float = None
    first: float = None
    rms: float = None
    wrong: float = None
    starts: float = None  # an hour
    height: float = None
    below: float = None
    above: float = None
    beside: str = None

    def text(self):
        words = [f"{form}{getattr(self, name):g}" for name, form in (
            ("completeness", ""), ("false", "false "), ("first", "first "), ("rms", "rms "),
            ("wrong", "wrong "), ("height", "height "), ("starts", ""))
                 if getattr(self, name) is not None]
        return ", ".join(words + [f"as {self.beside}"] * (self.beside is not None))


def ahead(sigma_deg, targets=4, places_m=AHEAD_3, pd=1, **others):
    """Straight targets that come from afar, 40 frames of 5 s."""
    return Scene(places_m, targets, sigma_deg, pd=pd, gate_m=5000,
                 settings={**STRAIGHT, "pd": min(pd, SURE_PD)}, **others)


def around(sigma_deg, turn_mps2=20, places_m=AROUND_3, pd=0.9, settings=FINDERS, **others):
    """Five targets about direction finders that look each 2 s and give false bearings."""
    return Scene(places_m, **{"targets": 5, "frames": 150, "interval_s": 2, "false_mean": 0.3,
                              **others}, sigma_deg=sigma_deg, pd=pd, is_around=True,
                 turn_mps2=turn_mps2, settings={**settings, "pd": pd})


def ring(count, scale=1):
    """Sensors about the centre of the targets."""
    angle = np.arange(count) * 2 * np.pi / count
    return tuple(zip((scale * (10e3 + 11.5e3 * np.cos(angle))).tolist(),
                     (scale * (6e3 + 11.5e3 * np.sin(angle))).tolist()))


def apart(gap_s):
    """As the row `clean .1 deg`, each sensor so much later than the one before, within the
    interval."""
    return ahead(0.1, phases_s=tuple(i * gap_s % 5 for i in range(3)))


def nothing(false_mean):
    """An hour without a target."""
    return Scene(AHEAD_3, 0, 0.1, frames=720, false_mean=false_mean,
                 settings={**STRAIGHT, "pd": 0.9})


def cameras(name, scene):
    """A row of cameras beside the same sky without elevations."""
    bare = f"{name} bearings"
    return {bare: (scene, Goal()), name: (dataclasses.replace(scene, has_elevations=True),
                                          Goal(height=1.3, below=0, above=0, beside=bare))}


DRONES = around(0.3, 3, ring(4, 0.11), targets=8, frames=240, interval_s=0.5, scale=0.11,
                gate_m=300, height_m=800, masts_m=(5, 10, 15, 20),  # 11 to 24 m/s, within 2 km
                settings={"v_max_mps": 40, "accel_max_mps2": 4, "range_max_m": 10e3})
APART, CROWD = Goal(rms=1.3, below=0.01, beside="clean .1 deg"), {"pd": 0.9, "false_mean": 0.3}
ROWS = {
    "clean .1 deg": (ahead(0.1), Goal(wrong=0.005)),
    "clean .5 deg": (ahead(0.5), Goal(wrong=0.02)),
    "clean 1 deg": (ahead(1), Goal(wrong=0.05)),
    ".5 s apart": (apart(0.5), APART),
    "1 s apart": (apart(1), APART),
    "3 s apart": (apart(3), APART),
    "2 targets 2 sensors .1 deg": (ahead(0.1, 2, AHEAD_3[:2]), Goal()),
    "6 targets 3 sensors .5 deg": (ahead(0.5, 6), Goal(wrong=0.01, false=0.05)),
    "6 targets 4 sensors .5 deg": (ahead(0.5, 6, AHEAD_4), Goal(wrong=0.01, false=0.02)),
    "turning 2 deg": (around(2), Goal(0.945, 0.1, 3)),
    "straight 2 deg": (around(2, 0), Goal(0.97, 0.04, 3, 1.25)),
    "turning .5 deg": (around(0.5), Goal(0.982, 0.01, 3)),
    "turning .5 deg P_D .7": (around(0.5, pd=0.7), Goal(0.97, 0.02, 4)),
    "turning .1 deg": (around(0.1), Goal(0.982, 0.01, 3, 1.25)),
    "turning 1 deg": (around(1), Goal()),
    "straight .5 deg P_D .7": (around(0.5, 0, pd=0.7), Goal()),
    "turning .5 deg .7 s apart": (around(0.5, phases_s=(0, 0.7, 1.4)),
                                  Goal(rms=1.3, below=0.01, beside="turning .5 deg")),
    "turning .3 g 10 s a frame": (
        around(0.1, 3, frames=60, interval_s=10, turn_s=(30, 60)), Goal(0.5)),
    "3 moving .5 deg": (
        around(0.5, velocities_mps=((20, 0), (0, 20), (-20, 0))), Goal(0.97)),
    "2 moving .1 deg": (
        around(0.1, 0, AROUND_3[:2], targets=2, velocities_mps=((0, 60), (0, -60))), Goal(0.97)),
    "two on a mast .1 deg": (around(0.1, places_m=(AROUND_3[0], *AROUND_3)), Goal(0.98)),
    "one mast alone .1 deg": (ahead(0.1, 2, (AHEAD_3[0], AHEAD_3[0])), Goal(starts=0)),
    "5 sensors .5 deg": (around(0.5, places_m=ring(5)), Goal(0.98)),
    "6 sensors .5 deg": (around(0.5, places_m=ring(6)), Goal(0.98)),
    "7 sensors .5 deg P_D .7": (around(0.5, places_m=ring(7), pd=0.7), Goal()),
    "8 sensors .5 deg": (around(0.5, places_m=ring(8)), Goal(0.98)),
    "8 targets 4 sensors 1 s": (
        around(0.5, 5, ring(4), targets=8, frames=120, interval_s=1), Goal()),
    "12 targets .1 deg": (ahead(0.1, 12, **CROWD), Goal()),
    "16 targets .1 deg": (ahead(0.1, 16, **CROWD), Goal()),
    "20 targets .1 deg": (ahead(0.1, 20, **CROWD), Goal(false=0.2)),
    "20 targets 4 sensors": (ahead(0.1, 20, AHEAD_4, **CROWD), Goal(false=0.2)),
    "30 targets .1 deg": (ahead(0.1, 30, **CROWD), Goal(false=0.2)),
    **cameras("2 cameras .2 deg", ahead(0.2, places_m=AHEAD_3[:2], height_m=15e3, masts_m=(20, 60),
                                        **CROWD)),
    **cameras("3 cameras 1 deg 6 targets",
              around(1, 0, targets=6, height_m=7e3, settings=STRAIGHT)),
    **cameras("4 cameras .3 deg 8 drones", DRONES),
    "no target 1 false": (nothing(1), Goal(starts=1)),
    "no target 2 false": (nothing(2), Goal(starts=1)),
    "no target 4 false": (nothing(4), Goal(starts=1)),
}
WITH_STONE_SOUP = ("clean .1 deg", "clean .5 deg", "straight 2 deg", "turning .5 deg")
COLUMNS = {"completeness": "{:.3f}", "false": "{:.3f}", "first": "{:.1f}", "rms_m": "{:.0f}",
           "height_m": "{:.0f}", "wrong": "{:.3f}"}
HEADINGS = ("row", "by", "completeness", "false/scan", "first", "rms m", "height m", "wrong",
            "goal")


def run_all(report, names, options):
    """{row: {by: scores of each run, or the message where the program refuses one}}."""
    has_stone_soup = stonesoup_tracker.is_installed()
    jobs = [(ROWS[name][0], options.seed + run,
             [ORACLE] * (ROWS[name][1].starts is None)
             + [STONE_SOUP] * (has_stone_soup and name in WITH_STONE_SOUP), options)
            for name in names for run in range(options.runs)]
    try:
        done = iter(report.map(bearings_runs.run, jobs))
    except (ChildProcessError, OSError, ValueError) as error:
        sys.stderr.write(f"{pathlib.Path(sys.argv[0]).name}: {error}\n")
        sys.exit(1)
    found = {}
    for name in names:
        runs = [next(done) for _ in range(options.runs)]
        found[name] = {
            who: next((one[who] for one in runs if isinstance(one[who], str)),
                      [one[who] for one in runs]) for who in runs[0]}
        if ORACLE in found[name]:
            found[name][ORACLE] = bearings_runs.best_oracle(found[name][ORACLE])
    return found


def tell(report, figures):
    """A table of the rows with targets to be tracked, one of those with starts to be counted, and
    the refusals."""
    rows, starts, refusals = [], [], []
    for name, by_who in figures.items():
        goal = ROWS[name][1]
        for who, found in by_who.items():
            label, wanted = (name, goal.text()) if who == RHOTRACK else ("", "")
            if isinstance(found, str):
                refusals.append(found)
                cells = ["refused"] + [""] * (len(COLUMNS) - 1)
            else:
                cells = [form.format(found[key][0]).replace("nan", "-")
                         for key, form in COLUMNS.items()]
            if goal.starts is None:
                rows.append([label, who, *cells, wanted])
            else:
                starts.append([label, who, "refused" if isinstance(found, str)
                               else f"{found['starts'][0]:.2f}", wanted])
    if rows:
        report.table(HEADINGS, rows)
    if starts:
        report.table(("row", "by", "starts an hour", "goal"), starts)
    for refusal in dict.fromkeys(refusals):
        report.text(f"Refused: {refusal}")


def judge(report, name, figures, runs):
    """The bars of a row that the program takes."""
    found, goal = figures[name], ROWS[name][1]
    own = found[RHOTRACK]
    if goal.completeness is not None:
        value, error = own["completeness"]
        report.at_least(f"{name}: completeness", value, goal.completeness, error)
    for key, what in (("false", "false tracks a scan"), ("first", "frames before the first track"),
                      ("starts", "starts an hour")):
        if getattr(goal, key) is not None:
            value, error = own[key]
            report.at_most(f"{name}: {what}", value, getattr(goal, key), error)
    if goal.wrong is not None:
        report.at_most(f"{name}: wrong at the end", own["wrong"][0], goal.wrong, trials=runs)
    for key, figure, what in (("rms", "rms_m", "rms"), ("height", "height_m", "rms of height")):
        if getattr(goal, key) is not None and not math.isnan(own[figure][0]):
            ratio, error = experiment.quotient_of(own[figure], found[ORACLE][figure])
            report.at_most(f"{name}: {what} over the oracle's", ratio, getattr(goal, key), error)
    beside = figures.get(goal.beside, {}).get(RHOTRACK)
    def less(figure):
        (value, error), (other, other_error) = own[figure], beside[figure]
        return value - other, math.hypot(error, other_error)
    if isinstance(beside, dict) and goal.below is not None:
        value, error = less("completeness")
        report.at_least(f"{name}: completeness less that of {goal.beside}", value, -goal.below,
                        error)
    if isinstance(beside, dict) and goal.above is not None:
        value, error = less("false")
        report.at_most(f"{name}: false tracks a scan less those of {goal.beside}", value,
                       goal.above, error)


def draw(report, figures):
    """Completeness and rms of each row."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    names = [name for name in figures if ROWS[name][1].starts is None]
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 1 + 0.3 * len(names)), sharey=True)
    places = np.arange(len(names))
    for who, colour, marker in ((ORACLE, "#9aa3ad", "|"), (STONE_SOUP, "#2e8b57", "s"),
                                (PAPER, "#e0812b", "x"), (RHOTRACK, "#1f5fbf", "o")):
        rows = [figures[name].get(who) for name in names]
        if not any(rows):
            continue  # not installed, or of none of these rows
        for axes, key in ((left, "completeness"), (right, "rms_m")):
            axes.plot([row[key][0] if isinstance(row, dict) else np.nan for row in rows], places,
                      marker, color=colour, label=who, ls="")
    left.plot([np.nan if ROWS[name][1].completeness is None else ROWS[name][1].completeness
               for name in names], places, marker="|", ms=14, color="#d1242f", label="goal", ls="")
    left.set_yticks(places, names)
    left.invert_yaxis()
    left.set(xlabel="completeness", xlim=(0, 1.02))
    right.set(xlabel=f"rms m after frame {bearings_runs.SETTLED_FRAMES}", xscale="log")
    figure.legend(*left.get_legend_handles_labels(), loc="lower center", ncols=5,
                  bbox_to_anchor=(0.5, 0.9))
    for axes in (left, right):
        axes.grid(axis="x", alpha=0.3)
    report.figure("rows", figure, "Each row by each tracker; goals of completeness in red.")


def draw_sky(report, name, options):
    """The targets of the first seed, and the sensors."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    sky = bearings_runs.Sky(ROWS[name][0], np.random.default_rng(options.seed))
    figure, axes = plt.subplots(figsize=(6, 5))
    for target in range(sky.of.targets):
        there = sky.visible[:, target]
        axes.plot(*sky.truth[there, target, :2].T / 1e3, color="#1f5fbf")
        axes.plot(*sky.truth[there, target, :2][:1].T / 1e3, "o", ms=3, color="#1f5fbf")
    looks = sky.rows[np.isnan(sky.rows["bearing_rad"])]
    axes.plot(looks["sensor_x_m"] / 1e3, looks["sensor_y_m"] / 1e3, ".", color="#d1242f")
    axes.set(xlabel="km east", ylabel="km north", aspect="equal", title=name)
    report.figure(f"sky-{list(ROWS).index(name):02}", figure,
                  f"{name}: targets of the first run from their dots on, sensors in red.")


def add_options(parser):
    parser.add_argument("--rows", type=lambda text: text.split(","), metavar="NAME,...",
                        help="these alone; of no row's name: all rows whose names hold it")
    real_skies.add_program_options(parser)


def chosen(words):
    """The rows of these names, or whose names hold a word that is no row's name, and the rows
    beside which their goals are."""
    for word in words:
        if not any(word in name for name in ROWS):
            sys.stderr.write(f"bearings.py: no row {word}; there are: {', '.join(ROWS)}\n")
            sys.exit(2)
    named = [name for name in ROWS if name in words or any(
        word not in ROWS and word in name for word in words)]
    beside = {ROWS[name][1].beside for name in named}
    return [name for name in ROWS if name in named or name in beside]


def facts_of(found):
    """For JSON, which has no NaN."""
    return found if isinstance(found, str) else {
        key: None if math.isnan(value) else value
        for key, value in experiment.values_of(found).items()}


def main():
    options = experiment.options_of(__doc__, 40, add_options)
    names = chosen(options.rows or ROWS)
    report = experiment.Report("Bearings of direction finders", options)
    figures = {
        name: {who: found if isinstance(found, str) else bearings_runs.figures_of(found)
               for who, found in by_who.items()}
        for name, by_who in run_all(report, names, options).items()}
    report.text(
        "First: frames before a target's first track. Rms: of places after frame "
        f"{bearings_runs.SETTLED_FRAMES}; its goal is over the oracle's. Wrong: share of the runs "
        f"that end with a target without a track within {bearings_runs.LOST_M / 1e3:g} km, or a "
        f"track {bearings_runs.STRAY_M / 1e3:g} km from all targets. Oracle: an extended Kalman "
        "filter told which bearings are whose, opened by a fit to its first "
        f"{bearings_runs.FIRST_FRAMES} frames.")
    if not stonesoup_tracker.is_installed():
        report.text("Left out: the Python package stonesoup is not installed; "
                    "`make bench-stonesoup` installs it.")
    tell(report, figures)
    if any(ROWS[name][1].starts is None for name in names):
        draw(report, figures)
    for name in names:
        if name in ("clean .1 deg", "turning .5 deg", "3 moving .5 deg"):
            draw_sky(report, name, options)
    report.fact("rows", [{"row": name, **{who: facts_of(found) for who, found in by_who.items()}}
                         for name, by_who in figures.items()])
    for name in names:
        if isinstance(figures[name][RHOTRACK], dict):
            judge(report, name, figures, options.runs)
    report.close()


if __name__ == "__main__":
    main()
