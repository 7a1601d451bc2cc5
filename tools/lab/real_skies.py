#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment real-skies: the shipped scenes through the tracker, beside an oracle and the goals
that the scenes state.

Of each scene with a goal (or those named) and each seed: `rhotrack simulate`, `rhotrack track`,
then tracks are scored against the truth, and so are those of the oracle, which is told which plots
are whose. tools/lab/README.md says what the figures mean. Exit codes: 0, also where goals are
missed; 1: an output that cannot be written, or the program failed; 2: bad usage.
"""
import argparse
import json
import math
import multiprocessing
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

os.environ.setdefault("OMP_NUM_THREADS", "1")  # matrices are small, and runs go side by side
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from common import oracle
from common import scoring
from common import scene_files

HERE = pathlib.Path(__file__).resolve()
ROOT = HERE.parents[2]
NAME = HERE.name

# Columns: key, heading, format, whether a goal of it is a bar, and whether less of it is better
COLUMNS = [
    ("completeness", "completeness", "{:.3f}", True, False),
    ("false_per_scan", "false/scan", "{:.3f}", True, True),
    ("switches", "switches", "{:.2f}", True, True),
    ("rms_m", "rms m", "{:.1f}", False, True),
    ("delay_mean_scans", "delay", "{:.2f}", False, True),
    ("delay_median_scans", "median", "{:.1f}", False, True),
]
# NEES over what it is where covariances are right (above 1: they are too small), and shares inside
# the ellipses of 95 %; the limits within which a scene is consistent
CONSISTENCY = [
    ("nees_place", "nees place", "{:.2f}", (0.8, 1.25)),
    ("inside_place", "inside", "{:.3f}", (0.92, 0.97)),
    ("nees_velocity", "nees velocity", "{:.2f}", (0.8, 1.25)),
    ("inside_velocity", "inside", "{:.3f}", (0.92, 0.97)),
]
GOAL_KEYS = {"delay_mean_scans": "delay_scans"}  # where the scene has another name for it
CALIBRATION_RUNS = 2  # choose the oracle's process noise in a scene that names none
STANDARD_ERRORS = 2  # a goal is met within so many


class Failed(Exception):
    """A command of the program did not end well."""


def run_program(program, arguments):
    done = subprocess.run([program, *map(str, arguments)], stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        raise Failed(
            f"{pathlib.Path(program).name} {' '.join(map(str, arguments))}: "
            f"exit {done.returncode}: {done.stderr.strip()}")


# --- one run

def simulated(job, folder):
    """Simulates, and reads what is known of the run: settings, sensors, plots (None without
    radars), truth."""
    run_program(job["simulator"], ["simulate", job["scene"], "--seed", job["seed"], "-o", folder])
    settings = scene_files.Settings(folder / "scenario.ini")
    sensors = settings.sensors()
    plots = None
    if (folder / "plots.csv").exists():
        plots = scene_files.read_plots(folder / "plots.csv", sensors,
                                       settings.get("scan_interval_s", 0.0))
    return settings, sensors, plots, scene_files.read_truth(
        folder, () if plots is None else plots.scan_times_us)


def calibrate(job):
    """Square errors of the oracle's candidates in one run."""
    with tempfile.TemporaryDirectory(prefix="rhotrack-") as folder:
        settings, sensors, plots, truth = simulated(job, pathlib.Path(folder))
        if plots is None:
            return job["name"], None
        followed = oracle.follow(plots, truth, sensors, oracle.CANDIDATES,
                                 settings.get("v_max_mps", 700.0))
        return job["name"], oracle.square_errors(truth, followed)


def run(job):
    """One run: figures of the tracker and of the oracle."""
    try:
        folder = pathlib.Path(job["keep"] or tempfile.mkdtemp(prefix="rhotrack-"))
        settings, sensors, plots, truth = simulated(job, folder)
        inputs = [
            folder / name for name in ("plots.csv", "bearings.csv") if (folder / name).exists()
        ]
        sets = [part for pair in job["set"] for part in ("--set", pair)]
        run_program(job["program"], [
            "track", *inputs, "--covariance", "--config", folder / "scenario.ini", *sets, "-o",
            folder / "tracks.csv"
        ])
        gate, forgiven = scoring.gate_m(sensors), job["forgiven"]
        tracks = scene_files.read_tracks(folder / "tracks.csv", truth)
        result = {"seed": job["seed"]}
        result["today"], false_rows = scoring.score(truth, tracks, gate, forgiven)
        if job["noise"] is not None and plots is not None:
            followed = oracle.follow(plots, truth, sensors, [job["noise"]],
                                     settings.get("v_max_mps", 700.0))
            result["oracle"], _ = scoring.score(truth, oracle.as_tracks(truth, followed), gate,
                                                forgiven)
        if job["picture"]:
            from common import plan_view_picture as pictures
            pictures.plan(job["picture"], job["name"], sensors, plots, truth, tracks, false_rows)
        return job["name"], result
    finally:
        if not job["keep"]:
            shutil.rmtree(folder, ignore_errors=True)


# --- all runs

def statistics(runs, which):
    """{key: {mean, standard_error}} over runs that have the figure; of delays the median of all
    targets, too."""
    delays = [delay for run in runs for delay in run[which]["delays_scans"]]
    found = {"delay_median_scans": {"mean": float(np.median(delays)), "standard_error": None}
             } if delays else {}
    for key in runs[0][which]:
        if key == "delays_scans":
            continue
        values = np.array([run[which][key] for run in runs if not math.isnan(run[which][key])])
        if len(values):
            error = float(values.std(ddof=1) / math.sqrt(len(values))) if len(values) > 1 else None
            found[key] = {"mean": float(values.mean()), "standard_error": error}
    return found


def judge(figures, goal):
    """{key: whether the goal is met}, of the keys that the goal states."""
    met = {}
    for key, _, _, _, less_is_better in COLUMNS:
        wanted = goal.get(GOAL_KEYS.get(key, key))
        if wanted is None or key not in figures:
            continue
        slack = STANDARD_ERRORS * (figures[key]["standard_error"] or 0.0)
        mean = figures[key]["mean"]
        met[key] = mean <= wanted + slack if less_is_better else mean >= wanted - slack
    return met


def noise_of(scene):
    """The oracle's process noise that a scene states, as a candidate; None: to be searched."""
    stated = scene.get("oracle", {}).get("process_noise_mps2")
    if stated is None:
        return None
    return tuple(stated) if isinstance(stated, list) else (float(stated),)


def measure(options, scenes):
    """Runs all scenes and seeds; [{name, goal, oracle noise, runs}]."""
    jobs = max(1, options.jobs)
    common = {"program": str(options.program), "simulator": str(options.simulator)}
    with multiprocessing.get_context("fork").Pool(jobs) as pool:
        noise = {
            name: None if options.search else noise_of(scene)
            for name, (_, scene) in scenes.items()
        }
        if not options.no_oracle:
            work = [{**common, "name": name, "scene": str(path), "seed": options.seed + i}
                    for name, (path, _) in scenes.items() if noise[name] is None
                    for i in range(min(CALIBRATION_RUNS, options.runs))]
            sums = {}
            for name, errors in pool.imap_unordered(calibrate, work):
                if errors is not None:
                    sums.setdefault(name, []).append(errors)
            for name, errors in sums.items():
                total = np.sum(errors, axis=0)
                if total[0, 1] > 0:
                    noise[name] = oracle.CANDIDATES[int(np.argmin(total[:, 0]))]
        work = []
        for name, (path, scene) in scenes.items():
            for i in range(options.runs):
                is_shown = i == 0 and not options.no_pages
                work.append({
                    **common, "name": name, "scene": str(path), "seed": options.seed + i,
                    "set": options.set, "forgiven": scoring.forgiven_scans(scene),
                    "noise": None if options.no_oracle else noise[name],
                    "keep": str(options.output / name) if is_shown else None,
                    "picture": str(options.output / f"{name}.png") if is_shown else None
                })
        done = {name: [] for name in scenes}
        for name, result in pool.imap_unordered(run, work):
            done[name].append(result)
            if not options.json and not options.lines and sys.stderr.isatty():
                sys.stderr.write(f"\r{sum(map(len, done.values()))} of {len(work)} runs")
            if options.lines and len(done[name]) == options.runs:
                print(scene_line(name, done[name]), flush=True)
        if sys.stderr.isatty():
            sys.stderr.write("\r\x1b[K")
    results = []
    for name, (_, scene) in scenes.items():
        runs = sorted(done[name], key=lambda result: result["seed"])
        figures = statistics(runs, "today")
        met = judge(figures, scene.get("goal") or {})
        results.append({
            "name": name, "about": scene.get(
                "text", ""), "goal": scene.get("goal"), "met": met, "figures": figures,
            "oracle": statistics(runs, "oracle") if "oracle" in runs[0] else None,
            "oracle_process_noise": None if options.no_oracle else noise[name], "runs": runs
        })
    return results


# --- what is told

def scene_line(name, runs):
    """One scene in one line: figures and standard errors."""
    parts = []
    for which in ("today", "oracle"):
        if which in runs[0]:
            figures = statistics(runs, which)
            parts.append("  ".join(
                [f"{heading} {figure_cell(figures, key, form)}"
                 for key, heading, form, _, _ in COLUMNS] + [
                     f"{heading} {figure_cell(figures, key, form, False)}"
                     for key, heading, form, _ in CONSISTENCY
                 ]))
    return f"{name:22} " + "\n".join([parts[0]] + [f"{'  oracle':22} {part}" for part in parts[1:]])


def figure_cell(figures, key, form, with_error=True):
    if not figures or key not in figures:
        return "-"
    mean, error = figures[key]["mean"], figures[key]["standard_error"]
    return form.format(mean) + (
        f"+-{form.format(error).lstrip('0') if error < 1 else form.format(error)}"
        if with_error and error else "")


def goal_cell(result, key, form):
    wanted = (result["goal"] or {}).get(GOAL_KEYS.get(key, key))
    return "-" if wanted is None else form.format(wanted)


def rows_of(result):
    """Rows of the table: label and cells, a cell being (text, met or None)."""
    rows = [("today", [(figure_cell(result["figures"], key, form), result["met"].get(key))
                       for key, _, form, _, _ in COLUMNS])]
    if result["oracle"]:
        rows.append(("oracle", [(figure_cell(result["oracle"], key, form), None)
                                for key, _, form, _, _ in COLUMNS]))
    if result["goal"]:
        rows.append(
            ("goal", [(goal_cell(result, key, form), None) for key, _, form, _, _ in COLUMNS]))
    return rows


def consistency_rows(result):
    """Rows of the table of consistency: label, motion and cells, a cell being (text, whether it is
    within its limits or None)."""
    rows = []
    for label, figures in (("today", result["figures"]), ("oracle", result["oracle"])):
        for motion in ("", *scene_files.MOTIONS) if figures else ():
            end = motion and "_" + motion
            cells = [(figure_cell(figures, key + end, form, False), None) for key, form in
                     (("pairs", "{:.0f}"), ("rms_m", "{:.1f}"), ("rms_mps", "{:.2f}"))]
            for key, _, form, (low, high) in CONSISTENCY:
                known = figures.get(key + end)
                cells.append((figure_cell(figures, key + end, form,
                                   False), low <= known["mean"] <= high if known else None))
            rows.append((label, motion or "all", cells))
    return rows


CONSISTENCY_HEADINGS = ["pairs", "rms m", "rms m/s", *(heading for _, heading, _, _ in CONSISTENCY)]


def bars(results, alarms, longs):
    """[(scene, key, held)] of the columns that are bars, of the rates of false tracks, and of what
    must not drift."""
    is_bar = {key: bar for key, _, _, bar, _ in COLUMNS}
    return [(result["name"], key, held) for result in results
            for key, held in result["met"].items() if is_bar[key]] + \
        [(row["name"], "false_tracks_per_hour", row["held"]) for row in alarms] + \
        [(row["name"], what, held) for row in longs for what, held in row["held"].items()]


def print_table(results, options):
    print(
        f"Real skies: {options.runs} runs a scene from seed {options.seed}; * marks a goal that is "
        f"missed by more than {STANDARD_ERRORS} standard errors")
    print(f"{'scene':22} {'':7}" + "".join(f"{heading:>16}" for _, heading, _, _, _ in COLUMNS))
    for result in results:
        for label, cells in rows_of(result):
            texts = "".join(f"{text + ('*' if met is False else ' '):>16}" for text, met in cells)
            print(f"{result['name'] if label == 'today' else '':22} {label:7}{texts}")


def print_consistency(results):
    low, high = CONSISTENCY[0][3]
    least, most = CONSISTENCY[1][3]
    print(
        f"Consistency: NEES over its ideal, and shares inside the ellipse of 95 %; * marks what is "
        f"not within {low} to {high}, {least} to {most}")
    print(f"{'scene':22} {'':7}{'motion':10}" + "".join(f"{heading:>15}"
                                                        for heading in CONSISTENCY_HEADINGS))
    for result in results:
        for number, (label, motion, cells) in enumerate(consistency_rows(result)):
            texts = "".join(f"{text + ('*' if held is False else ' '):>15}" for text, held in cells)
            print(f"{'' if number else result['name']:22} {label:7}{motion:10}{texts}")


def as_json(results, options, alarms, longs):
    judged = bars(results, alarms, longs)
    return {
        "experiment": "real-skies", "runs": options.runs, "seed": options.seed,
        "settings": options.set, "scenes": results, "endurance": alarms, "long": longs, "bars": [
            {"what": f"{name}: {key}", "held": bool(held)} for name, key, held in judged
        ], "bars_held": sum(held for _, _, held in judged), "bars_missed": sum(
            not held for _, _, held in judged)
    }


def find_scenes(options):
    """{name: (path, scene)}: those named, or all with a goal, in the order of their names."""
    if options.scene:
        paths = [
            pathlib.Path(name) if name.endswith(".json") else scene_files.path_of(
                options.scenes, name) for name in options.scene
        ]
    else:
        paths = sorted(options.scenes.glob("**/*.json"))
    found = {}
    for path in paths:
        try:
            scene = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            usage(f"{path}: {error}")
        if options.scene or scene.get("goal"):
            found[path.stem] = (path, scene)
    if not found:
        usage(f"no scene with a goal in {options.scenes}")
    return found


def usage(message):
    sys.stderr.write(f"{NAME}: {message}\n")
    sys.exit(2)


def add_run_options(parser):
    """Of experiments that track many seeds of a sky."""
    parser.add_argument("--runs", type=int, default=20, metavar="N",
                        help="seeds of each (default 20)")
    parser.add_argument("--seed", type=int, default=1, metavar="S",
                        help="the first one (default 1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N",
                        help="runs side by side (default: processors)")
    parser.add_argument("--json", action="store_true",
                        help="one object on standard output instead of the tables")
    add_program_options(parser)


def add_program_options(parser):
    """Of experiments that run the program."""
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                        help="a parameter of `rhotrack track`")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build" / "rhotrack",
                        metavar="PATH", help="default: build/rhotrack")
    parser.add_argument("--simulator", type=pathlib.Path, metavar="PATH",
                        help="another build that simulates; default: the same")


def parse_options():
    parser = argparse.ArgumentParser(prog=NAME, description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "--scene", action="append", metavar="NAME|FILE.json", help="this one alone (repeatable); "
        "default: all of the folder that have a goal")
    add_run_options(parser)
    parser.add_argument("--scenes", type=pathlib.Path, default=ROOT / "tools" / "scenes",
                        metavar="DIR", help="default: tools/scenes")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="DIR",
                        default=ROOT / "build" / "experiment" / "real-skies",
                        help="default: build/experiment/real-skies")
    parser.add_argument("--lines", action="store_true",
                        help="one line a scene, as soon as it is done; no pages")
    parser.add_argument("--search", action="store_true",
                        help="choose the oracle's process noise anew where scenes state one")
    parser.add_argument("--no-oracle", action="store_true")
    parser.add_argument("--no-pages", action="store_true", help="no pictures, no index.html")
    parser.add_argument(
        "--endurance", action="store_true",
        help="instead of the scenes: false tracks an hour in uniform "
        "clutter, rain and strobes")
    parser.add_argument(
        "--long", action="store_true",
        help="instead of the scenes: births and deaths for hours; figures, time "
        "and memory of each hour, and what drifts")
    parser.add_argument(
        "--hours", type=float, metavar="H",
        help="of endurance, all runs of a scene together (default 20), --runs "
        "of them; of long, each run (default 4)")
    options = parser.parse_args()
    if options.long and options.endurance:
        parser.error("--long or --endurance")
    if options.hours is None:
        options.hours = 4.0 if options.long else 20.0
    if options.runs < 1 or options.jobs < 1 or options.hours <= 0:
        parser.error("--runs, --jobs and --hours are positive")
    if not os.access(options.program, os.X_OK):
        usage(f"no program {options.program}; build it, or name it with --program")
    options.program = options.program.resolve()
    options.simulator = (options.simulator or options.program).resolve()
    options.no_pages |= options.lines
    return options


def main():
    options = parse_options()
    try:
        if not options.no_pages:
            options.output.mkdir(parents=True, exist_ok=True)
        results, alarms, longs = [], [], []
        if options.endurance:
            from parts import false_track_endurance
            alarms = false_track_endurance.measure(options, run_program)
        elif options.long:
            from parts import endurance_hours
            longs = endurance_hours.measure(options, run_program)
        else:
            results = measure(options, find_scenes(options))
        report = as_json(results, options, alarms, longs)
        if not options.no_pages:
            from common import real_skies_page as page
            page.write(options.output / "index.html", results, alarms, longs, options, COLUMNS,
                       rows_of, (CONSISTENCY_HEADINGS, consistency_rows))
    except (Failed, OSError, ValueError) as error:
        sys.stderr.write(f"{NAME}: {error}\n")
        sys.exit(1)
    if options.json:
        print(json.dumps(report, indent=1))
        return
    if options.endurance:
        print(false_track_endurance.table(alarms))
    elif options.long:
        print(endurance_hours.table(longs))
    elif not options.lines:
        print_table(results, options)
        print_consistency(results)
    if not options.no_pages:
        print(f"{options.output / 'index.html'}")
    if not options.lines:
        print(f"{report['bars_held']} bars held, {report['bars_missed']} missed")


if __name__ == "__main__":
    main()
