#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Experiments low-pd and fusion with few runs, and what they are made of. Program in $RHOTRACK."""
import json
import os
import subprocess
import tempfile
import unittest

import lab_test_setup

lab_test_setup.need_packages()

import numpy as np

from common import scene_files
from common import scene_runs
import fusion
import low_pd

PROGRAM = os.environ.get("RHOTRACK", str(lab_test_setup.ROOT / "build" / "rhotrack"))


def run_it(name, *arguments):
    """The figures of an experiment of two runs a case, and the names of the files that it wrote."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([
            str(lab_test_setup.ROOT / "tools" / "lab" / name), "--program", PROGRAM, "--jobs", "2",
            "--runs", "2", "--json", "-o", folder, *arguments
        ], capture_output=True, text=True, check=False)
        if (done.returncode, done.stderr) != (0, ""):
            raise AssertionError(f"exit {done.returncode}: {done.stderr}")
        return json.loads(done.stdout), sorted(os.listdir(folder))


class Parts(unittest.TestCase):
    def test_bursts_last_six_turns_and_differ_by_seed(self):
        events = low_pd.bursts(3)["events"]
        starts = np.array([event["from_s"] for event in events])
        self.assertTrue(((np.diff(starts) >= 60) & (np.diff(starts) <= 120)).all())
        self.assertEqual({round(event["until_s"] - event["from_s"], 9) for event in events}, {24.0})
        self.assertNotEqual(low_pd.bursts(4)["events"], events)
        self.assertEqual(low_pd.bursts(3)["events"], events)

    def test_a_camera_is_told_or_not(self):
        told, not_told = (fusion.with_camera(5, 0.01, 0.3, 2, is_told)["passive"][0]
                          for is_told in (True, False))
        self.assertNotIn("told", told)
        self.assertEqual((not_told["pd"], not_told["told"]), (0.3, {"pd": 0.9}))

    def test_differences_are_of_the_same_seeds(self):
        def run_of(completeness, rms_m):
            return {"tracker": {"completeness": completeness, "false_per_scan": 0.0,
                                "switches": 0.0, "rms_m": rms_m}}
        found = fusion.beside([run_of(0.8, 3.0), run_of(0.9, 5.0)],
                              [run_of(0.9, 2.0), run_of(1.0, 2.0)])
        self.assertAlmostEqual(found["completeness"][0], -0.1)
        self.assertAlmostEqual(found["completeness"][1], 0.0)
        self.assertAlmostEqual(found["rms_m"][0], 2.0)
        self.assertAlmostEqual(found["rms_m"][1], 0.5)

    def test_scores_are_at_the_radars_scans(self):
        truth = scene_files.Truth(np.arange(6) * 500000, np.arange(1), np.zeros((6, 1, 2)),
                                  np.ones((6, 1), dtype=bool), np.zeros((6, 1, 2)))
        kept = scene_runs.at_scans(truth, np.array([0, 1000000, 2000000]))
        self.assertEqual(kept.times_us.tolist(), [0, 1000000, 2000000])
        self.assertEqual(kept.visible.shape, (3, 1))


class EndToEnd(unittest.TestCase):
    def test_low_pd(self):
        """Of ten runs the oracle has .923 (P_D .3), .980 (bursts) and .983 (x and y, P_D .5)."""
        cases = ("P_D .3", "six missed scans", "told .9, really .5")
        report, files = run_it("low_pd.py", *(word for case in cases for word in ("--case", case)))
        oracles = {found["case"]: found["oracle"] for found in report["cases"]}
        self.assertEqual(list(oracles), list(cases))
        for case, least, most in zip(cases, (0.85, 0.96, 0.97), (0.97, 0.99, 0.995)):
            self.assertTrue(least < oracles[case]["completeness"] < most, oracles[case])
            self.assertEqual(oracles[case]["switches"], 0)
        for found in report["cases"]:
            self.assertTrue(0 <= found["tracker"]["completeness"] <= 1)
        self.assertEqual([bar["what"] for bar in report["bars"]], [
            "P_D .3: completeness", "six missed scans: completeness",
            "six missed scans: switches a run", "told .9, really .5: completeness"
        ])
        self.assertEqual([bar.get("at_least", bar.get("at_most")) for bar in report["bars"]],
                         [0.85, 0.955, 0.5, 0.97])
        self.assertEqual(files, ["completeness.svg", "figures.json", "index.html", "scene-00.json",
                                 "scene-01.json", "scene-02.json"])

    def test_fusion(self):
        """Of ten runs the radar alone has .97 and 3 m, whatever the camera."""
        report, files = run_it("fusion.py", "--rate", "0.5", "--sigma", "0.01", "--pd", "0.95",
                               "--false", "0")
        self.assertEqual([found["case"] for found in report["cases"]], [
            fusion.ALONE, "0.5 Hz, 0.01 rad, told, P_D 0.95, 0 false",
            "0.5 Hz, 0.01 rad, told P_D .9, P_D 0.95, 0 false", *fusion.swaying_cameras(0.5)
        ])
        self.assertGreater(report["oracle"]["completeness"], 0.95)
        self.assertLess(report["oracle"]["rms_m"], 4.0)
        alone, with_it = (found["completeness"] for found in report["cases"][:2])
        bars = {bar["what"]: bar for bar in report["bars"]}
        self.assertEqual(len(bars), 9)
        bar = bars["0.5 Hz, 0.01 rad, told: completeness less the radar's"]
        self.assertEqual(bar["at_least"], -0.005)
        self.assertAlmostEqual(bar["value"], with_it - alone)
        self.assertIn("completeness.svg", files)

    def test_a_program_that_fails_is_named(self):
        done = subprocess.run([
            str(lab_test_setup.ROOT / "tools" / "lab" / "low_pd.py"), "--program", PROGRAM,
            "--runs", "1", "--case", "P_D .5", "--set", "pd=7"
        ], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^low_pd.py: rhotrack track .*: exit 2: .*pd")


if __name__ == "__main__":
    lab_test_setup.main()
