# SPDX-License-Identifier: MIT
"""False tracks an hour where there is no target: of the clutter of shipped scenes, over many hours,
after some learning."""
import json
import math
import multiprocessing
import pathlib
import tempfile

from scipy.stats import chi2

from common import scene_files

SCENES = ["uniform", "rain", "strobe"]
LEARNING_S = 600.0
WANTED_PER_HOUR = 1.0  # false_tracks_per_hour, the program's default
FACTOR = 3.0  # more or less than the wanted


def without_targets(scene, duration_s):
    """The scene's clutter alone, for so long, all the time; cells stay where they are, or they
    would drift away."""
    alone = {
        key: value
        for key, value in scene.items()
        if key not in ("goal", "oracle", "targets", "clutter", "events")
    }
    alone["duration_s"] = duration_s
    alone["clutter"] = [{
        key: value
        for key, value in source.items()
        if key not in ("from_s",
                       "until_s") and not (source["kind"] == "cell" and key == "velocity_mps")
    } for source in scene.get("clutter", [])]
    return alone


def run(job):
    """Hours after the learning, and confirmed tracks that began in them."""
    with tempfile.TemporaryDirectory(prefix="rhotrack-") as folder:
        folder = pathlib.Path(folder)
        (folder / "scene.json").write_text(json.dumps(job["scene"]), encoding="utf-8")
        job["run_program"](job["simulator"],
                           ["simulate", folder / "scene.json", "--seed", job["seed"], "-o", folder])
        sets = [part for pair in job["set"] for part in ("--set", pair)]
        job["run_program"](job["program"], [
            "track", folder / "plots.csv", "--config", folder / "scenario.ini", *sets, "-o",
            folder / "tracks.csv"
        ])
        begun = scene_files.first_confirmed(folder / "tracks.csv")
        return job["name"], sum(time_us >= LEARNING_S * 1e6 for time_us in begun.values())


def wanted_per_hour(options):
    for pair in options.set:
        key, _, value = pair.partition("=")
        if key == "false_tracks_per_hour":
            return float(value)
    return WANTED_PER_HOUR


def measure(options, run_program):
    hours_each = options.hours / options.runs
    wanted = wanted_per_hour(options)
    names = options.scene or SCENES
    work = []
    for name in names:
        path = scene_files.path_of(options.scenes, name)
        scene = without_targets(json.loads(path.read_text(encoding="utf-8")),
                                LEARNING_S + 3600 * hours_each)
        work += [{
            "program": str(options.program), "simulator": str(
                options.simulator), "run_program": run_program, "name": name, "scene": scene,
            "seed": options.seed + i, "set": options.set
        } for i in range(options.runs)]
    counts = dict.fromkeys(names, 0)
    with multiprocessing.get_context("fork").Pool(options.jobs) as pool:
        for name, count in pool.imap_unordered(run, work):
            counts[name] += count
    return [verdict(name, count, options.hours, wanted) for name, count in counts.items()]


def verdict(name, count, hours, wanted):
    """The rate beside the wanted one, with the 95 % limits of a Poisson count; held within the
    factor where these limits allow it."""
    low = chi2.ppf(0.025, 2 * count) / 2 if count else 0.0
    high = chi2.ppf(0.975, 2 * count + 2) / 2
    expected = wanted * hours
    return {
        "name": name, "hours": hours, "wanted_per_hour": wanted, "tracks": count,
        "per_hour": count / hours, "ratio": count / expected, "ratio_low": float(
            low / expected), "ratio_high": float(high / expected),
        "held": bool(low / expected <= FACTOR and high / expected >= 1 / FACTOR)
        and not math.isnan(count)
    }


def table(alarms):
    lines = [
        f"{'clutter':22}{'hours':>8}{'wanted/h':>10}{'tracks':>8}{'per hour':>10}"
        f"{'of wanted':>11}{'95 %':>16}"
    ]
    for row in alarms:
        limits = f"{row['ratio_low']:.2f} to {row['ratio_high']:.2f}"
        lines.append(
            f"{row['name']:22}{row['hours']:8.1f}{row['wanted_per_hour']:10g}{row['tracks']:8d}"
            f"{row['per_hour']:10.2f}{row['ratio']:10.2f}{' ' if row['held'] else '*'}"
            f"{limits:>16}")
    return "\n".join(lines)
