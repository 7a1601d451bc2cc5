# SPDX-License-Identifier: MIT
"""A run of a shipped scene in memory: `rhotrack simulate`, and its plots as the package takes
them."""
import dataclasses
import pathlib
import subprocess
import tempfile

import numpy as np

from common import experiment
import rhotrack
from common import scene_files

PROGRAM = experiment.BUILD / "rhotrack"


@dataclasses.dataclass
class Run:
    settings: rhotrack.Settings  # what the scene tells a tracker
    sensors: dict  # the same of its sensors: scene_files.Sensor by sensor_id
    plots: np.ndarray  # columns of plots.csv; a scan's first row is its own, without a plot
    truth: scene_files.Truth
    also: object = None  # what `also` of simulate gave

    @property
    def scans(self):
        """The rows of each scan."""
        return np.split(self.plots, np.flatnonzero(np.diff(self.plots["scan"])) + 1)


def run_program(*words):
    """What the program prints."""
    return subprocess.run([PROGRAM, *map(str, words)], check=True, stdout=subprocess.PIPE).stdout


def columns_of(path):
    """A CSV file of numbers as a structured array; empty cells are NaN."""
    heads, body = path.read_text(encoding="utf-8").split("\n", 1)
    names = heads.split(",")
    body = body.replace("\n", ",")
    for _ in range(2):
        body = body.replace(",,", ",nan,")
    cells = np.fromstring(body, sep=",").reshape(-1, len(names))
    rows = np.empty(len(cells), [(name, "f8") for name in names])
    for name, cell in zip(names, cells.T):
        rows[name] = cell
    return rows


def simulate(scene, seed, *sets, also=None):
    """The run of a seed; sets are fields of the scene, as `simulate --set` takes them. also(folder)
    sees the files before they go."""
    with tempfile.TemporaryDirectory(prefix="rhotrack-") as name:
        folder = pathlib.Path(name)
        chosen = [word for one in sets for word in ("--set", one)]
        run_program("simulate", scene, "--seed", seed, "-o", folder, *chosen)
        rows = columns_of(folder / "plots.csv")
        plots = np.empty(len(rows), [(one, {"sensor_id": "i4", "target_id": "i4"}.get(one, "f8"))
                                     for one in rows.dtype.names])
        for one in rows.dtype.names:
            plots[one] = np.nan_to_num(rows[one], nan=-1) if one == "target_id" else rows[one]
        told = folder / "scenario.ini"
        return Run(rhotrack.Settings(told), scene_files.Settings(told).sensors(), plots,
                   scene_files.read_truth(folder), also(folder) if also else None)


def has_plot(rows):
    """Which rows are plots, and not a scan's own."""
    return ~np.isnan(rows["range_m" if "range_m" in rows.dtype.names else "x_m"])


def with_fields(rows, names, **fields):
    """Some columns of rows, and others beside them, as scans of the package have them."""
    made = np.empty(len(rows), [(name, rows.dtype[name]) for name in names]
                    + [(name, "f8") for name in fields])
    for name in names:
        made[name] = rows[name]
    for name, values in fields.items():
        made[name] = values
    return made
