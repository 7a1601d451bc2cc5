# SPDX-License-Identifier: MIT
"""The package writes the bytes that the program writes: every `track`, `maintain` and `initiate` of
the golden cases (tests/regression/golden.py) whose output is CSV, and its tables read back."""
import os
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest

import rhotrack
from rhotrack.files import csv_of

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))
import golden  # noqa: E402

TRACKS = ("t_s,track_id,status,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps,ax_mps2,ay_mps2,az_mps2,sigma_m,"
          "sigma_mps,hits,misses,sensor_id,plot").split(",")
LEFT_OUT = {"--follow", "--clutter-map", "<", "-"}


class Line:
    """A command of a case, as it is typed."""

    def __init__(self, text):
        words = shlex.split(text)
        self.command, self.inputs, self.sets = words[0], [], {}
        self.config, self.output, self.method, self.covariance = [], None, None, False
        self.alone = {}  # of a track alone
        rest = iter(words[1:])
        for word in rest:
            if word == "--config":
                self.config.append(next(rest))
            elif word == "--set":
                name, self.sets[name] = (pair := next(rest)).split("=", 1)[0], pair.split("=", 1)[1]
            elif word == "--gate":
                self.sets["gate"] = next(rest)
            elif word == "--method":
                self.method = next(rest)
            elif word == "-o":
                self.output = next(rest)
            elif word == "--covariance":
                self.covariance = True
            elif word == "--pipeline":
                self.sets = {"method": "nht", "bearings_method": "passive-paper", "gate": "hough",
                             "input_estimation": 1, **self.sets}
                next(rest)
            elif word == "--no-input-estimation":
                self.alone["input_estimation"] = False
            elif word == "--seed":
                self.alone["seed"] = int(next(rest))
            elif not word.startswith("--"):
                self.inputs.append(word)
        if self.command == "track" and self.method:
            is_passive = self.method.startswith("passive")
            self.sets["bearings_method" if is_passive else "method"] = self.method
        self.is_compared = (self.command in ("track", "maintain", "initiate")
                            and not LEFT_OUT & set(words)
                            and (self.output or "").endswith(".csv"))

    def settings(self):
        return rhotrack.Settings(*self.config, **self.sets)

    def tracker(self, settings):
        if self.command == "track":
            return rhotrack.Tracker(settings, covariance=self.covariance)
        return rhotrack.Maintainer(settings, covariance=self.covariance, **self.alone)

    def result(self):
        if self.command != "initiate":
            settings = self.settings()
            scans = rhotrack.read(*self.inputs, settings=settings, keep_going=True)
            rows = self.tracker(settings).run(scans)
            again = self.tracker(settings).run(scans[:])
            for name in rows.dtype.names:
                np.testing.assert_array_equal(rows[name], again[name], err_msg=name)
            more = rhotrack.scans.COVARIANCE if self.covariance else []
            bodies = [name for name in rhotrack.scans.BODY.names if name in rows.dtype.names]
            return csv_of(rows[TRACKS + more + bodies])
        scans = rhotrack.read(*self.inputs, settings=self.settings())
        is_passive = "bearing_rad" in scans[0].dtype.names
        method = self.method or ("passive" if is_passive else "kernel")
        initiator = (rhotrack.Passive if is_passive else rhotrack.Initiator)(
            self.settings(), method=method)
        return csv_of(initiator.find(scans))


LINES = {name: [line for line in (" ".join(one.split()) for one in
                                  steps.replace("\\\n", " ").splitlines()) if line]
         for name, steps in golden.CASES.items()}
COMPARED = [name for name, lines in LINES.items() if any(Line(line).is_compared for line in lines)]


@pytest.mark.parametrize("name", COMPARED)
def test_same_bytes(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scenes").symlink_to(golden.ROOT / "tools/scenes")
    (tmp_path / "vectors").symlink_to(golden.ROOT / "tests/vectors")
    environment = dict(os.environ, LC_ALL="C", TZ="UTC")
    for text in LINES[name]:
        line = Line(text)
        if line.command == "plot":
            continue
        golden.execute(tmp_path, text, environment)
        if line.is_compared:
            assert line.result() == Path(line.output).read_text(), text
