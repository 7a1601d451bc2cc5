# SPDX-License-Identifier: MIT
"""Hour by hour: a scene that goes on for long, so that what drifts shows. Figures of tracks,
identities, time and memory."""
import fcntl
import json
import math
import multiprocessing
import os
import pathlib
import struct
import subprocess
import tempfile
import termios
import time

import numpy as np

from common import scene_files
from common import scoring

SCENES = ["births-and-deaths"]
HOUR_US = 3600 * 10 ** 6
STANDARD_ERRORS = 2
QUIET_S = 0.05  # a program that has read everything and uses no time for so long waits for more

# Columns: key, heading, format, and by how much, or by which share of the first hour, the last one
# may be worse
COLUMNS = [
    ("completeness", "completeness", "{:.4f}", 0.005, 0),
    ("false_per_scan", "false/scan", "{:.4f}", 0.005, 0),
    ("switches", "switches", "{:.2f}", 0.5, 0),
    ("identities", "identities", "{:.0f}", 0, 0.1),
    ("cpu_s", "CPU s", "{:.2f}", 0.05, 0.2),
    ("memory_mb", "MB", "{:.2f}", 0.1, 0.01),
]
BETTER_IF_MORE = {"completeness"}


class Usage:
    """What a running process has used: seconds of CPU, and its memory, in MB."""

    def __init__(self, process):
        self.process = process

    def cpu_s(self):
        stat = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text(
            encoding="ascii").rpartition(")")[2].split()
        return (int(stat[11]) + int(stat[12])) / os.sysconf("SC_CLK_TCK")

    def memory_mb(self):
        lines = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(
            encoding="ascii").splitlines()
        fields = dict(line.split(":", 1) for line in lines)
        return int(fields["VmHWM"].split()[0]) / 1024

    def wait_until_quiet(self):
        """It has read all that was written, and has done with it."""
        pipe, before = self.process.stdin.fileno(), -1.0
        while self.process.poll() is None:
            waiting = struct.unpack("i", fcntl.ioctl(pipe, termios.FIONREAD, b"\0" * 4))[0]
            now = self.cpu_s()
            if waiting == 0 and now == before:
                return
            before = now
            time.sleep(QUIET_S)


def hours_of(times_us, count):
    """The hour of each time; the last one's end, where its last scan stands, is in it."""
    return np.minimum(np.asarray(times_us) // HOUR_US, count - 1)


def by_hour(path, count):
    """The header, and the rows of each hour, of a file of plots."""
    with open(path, encoding="utf-8") as file:
        header, rows = next(file), list(file)
    hours = [[] for _ in range(count)]
    times_us = np.maximum.accumulate(  # the file's order stays
        scene_files.microseconds([row.split(",", 1)[0] for row in rows]))
    for row, hour in zip(rows, hours_of(times_us, count)):
        hours[hour].append(row)
    return header, hours


def tracked(job, folder):
    """Tracks hour after hour in one process; [(CPU seconds of the hour, peak memory so far)]."""
    header, hours = by_hour(folder / "plots.csv", job["hours"])
    sets = [part for pair in job["set"] for part in ("--set", pair)]
    used = []
    with subprocess.Popen([
            job["program"], "track", "-", "--config", folder / "scenario.ini", *sets, "-o",
            folder / "tracks.csv"
    ], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          text=True) as process:
        usage, cpu_s = Usage(process), 0.0
        try:
            process.stdin.write(header)
            for rows in hours:
                process.stdin.writelines(rows)
                process.stdin.flush()
                usage.wait_until_quiet()
                now = usage.cpu_s()
                used.append((now - cpu_s, usage.memory_mb()))
                cpu_s = now
        except (BrokenPipeError, OSError, KeyError):  # it has ended: why, it says below
            pass
        errors = process.communicate()[1]
    if process.returncode != 0 or len(used) != len(hours):
        raise OSError(f"{job['program']}: exit {process.returncode}: {errors.strip()}")
    return used


def newest_identities(path, count):
    """The largest track_id, of any status, until each hour's end."""
    table = scene_files.columns(path, ("t_s", "track_id"))
    newest = np.zeros(count, dtype=np.int64)
    np.maximum.at(newest, hours_of(scene_files.microseconds(table["t_s"]), count),
                  np.array(table["track_id"], dtype=np.int64))
    return np.maximum.accumulate(newest)


def run(job):
    """Figures of each hour of one run."""
    with tempfile.TemporaryDirectory(prefix="rhotrack-") as folder:
        folder = pathlib.Path(folder)
        (folder / "scene.json").write_text(json.dumps(job["scene"]), encoding="utf-8")
        job["run_program"](job["simulator"],
                           ["simulate", folder / "scene.json", "--seed", job["seed"], "-o", folder])
        used = tracked(job, folder)
        settings = scene_files.Settings(folder / "scenario.ini")
        sensors = settings.sensors()
        plots = scene_files.read_plots(folder / "plots.csv", sensors,
                                       settings.get("scan_interval_s", 0.0))
        truth = scene_files.read_truth(folder, plots.scan_times_us)
        tracks = scene_files.read_tracks(folder / "tracks.csv", truth)
        newest = newest_identities(folder / "tracks.csv", len(used))
    walk = scoring.follow(truth, tracks, scoring.gate_m(sensors), job["forgiven"])
    hour = hours_of(truth.times_us, len(used))

    def count(scans):
        return np.bincount(hour[np.array(scans, dtype=int)], minlength=len(used))

    paired = count([k for k, _, _ in walk.paired])
    false, switches = count([k for k, _ in walk.false_rows]), count(walk.switch_scans)
    chances = np.bincount(hour, weights=truth.visible.sum(axis=1), minlength=len(used))
    if not chances.all():
        raise ValueError(
            f"{job['name']}: no target is in sight in hour {np.argmin(chances > 0) + 1}; "
            f"take a scene whose targets are replaced")
    scans = np.bincount(hour, minlength=len(used))
    return job["name"], [{
        "completeness": float(paired[h] / chances[h]), "false_per_scan": float(
            false[h] / scans[h]), "switches": float(
                switches[h]), "identities": float(newest[h] - (newest[h - 1] if h else 0)),
        "cpu_s": used[h][0], "memory_mb": used[h][1]
    } for h in range(len(used))]


def mean_and_error(values):
    values = np.array(values, dtype=float)
    return float(
        values.mean()), float(values.std(ddof=1) / np.sqrt(len(values))) if len(values) > 1 else 0.0


def judged(name, goal, runs):
    """The hours' means; what does not drift: the last hour is not worse than the first by more than
    the column allows and two standard errors; and, where the scene has a goal of it, false tracks a
    scan in all hours."""
    hours = [{key: mean_and_error([run[h][key] for run in runs])[0]
              for key, *_ in COLUMNS} for h in range(len(runs[0]))]
    held = {}
    for key, _, _, allowed, share in COLUMNS:
        worse, error = mean_and_error(
            [(run[0][key] - run[-1][key]) * (1 if key in BETTER_IF_MORE else -1) for run in runs])
        held[f"{key} does not drift"] = worse <= allowed + share * hours[0][
            key] + STANDARD_ERRORS * error
    if goal.get("false_per_scan") is not None:
        mean, error = mean_and_error(
            [np.mean([hour["false_per_scan"] for hour in run]) for run in runs])
        held["false_per_scan"] = mean <= goal["false_per_scan"] + STANDARD_ERRORS * error
    return {
        "name": name, "runs": runs, "hours": hours,
        "held": {what: bool(is_held)
                 for what, is_held in held.items()}
    }


def measure(options, run_program):
    work, goals = [], {}
    for name in options.scene or SCENES:
        scene = json.loads(
            scene_files.path_of(options.scenes, name).read_text(encoding="utf-8"))
        goals[name] = scene.get("goal") or {}
        scene["duration_s"] = 3600 * options.hours
        hours = math.ceil(options.hours)
        work += [{
            "program": str(options.program), "simulator": str(options.simulator),
            "run_program": run_program, "name": name, "scene": scene, "hours": hours,
            "seed": options.seed + i, "set": options.set, "forgiven": scoring.forgiven_scans(scene)
        } for i in range(options.runs)]
    runs = {name: [] for name in goals}
    with multiprocessing.get_context("fork").Pool(options.jobs) as pool:
        for name, hours in pool.imap(run, work):
            runs[name].append(hours)
    return [judged(name, goals[name], of) for name, of in runs.items()]


def table(longs):
    lines = []
    for row in longs:
        lines.append(f"{row['name']:22}{'hour':>5}" + "".join(f"{heading:>14}"
                                                              for _, heading, *_ in COLUMNS))
        lines += [
            f"{'':22}{h + 1:5}" + "".join(f"{form.format(hour[key]):>14}"
                                          for key, _, form, *_ in COLUMNS)
            for h, hour in enumerate(row["hours"])
        ]
        lines += [
            f"{'':22}* not held: {what}" for what, is_held in row["held"].items() if not is_held
        ]
    return "\n".join(lines)
