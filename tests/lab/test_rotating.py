#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Experiment rotating with few runs: scans of each case, figures beside those of many, bars."""
import json
import subprocess
import types
import unittest

import lab_test_setup

lab_test_setup.need_packages("rhotrack")

import numpy as np

from common import experiment
import rotating
from common import simulate_scene


class Rotating(unittest.TestCase):
    def test_figures_bars_and_page(self):
        with lab_test_setup.folder() as folder:
            done = subprocess.run([lab_test_setup.ROOT / "tools/lab/rotating.py", "--runs", "4",
                                   "--seed", "4711", "--json", "-o", folder], capture_output=True,
                                  text=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertTrue((folder / "load.svg").exists() and (folder / "index.html").exists())
        told = json.loads(done.stdout)
        self.assertEqual(len(told["bars"]), 4)
        sectors, turns, at_once = told["cases"]
        for of in told["cases"]:  # 1.00 found and tracked, .02 false ones a run
            self.assertEqual(of["targets"], 12)
            self.assertTrue(of["found"] >= 0.8 and of["tracked_at_end"] >= 0.9, of)
            self.assertLessEqual(of["false_tracks_per_run"], 0.5)
            self.assertGreater(of["step_max_us"], 0)
        # 89, 105 and 89 m, 10.3, 11.3 and 10.3 m/s over many runs; a run spreads by a fifth
        for of, rmse_m, rmse_mps in ((sectors, 89, 10.3), (turns, 105, 11.3), (at_once, 89, 10.3)):
            self.assertAlmostEqual(of["rmse_m"], rmse_m, delta=0.4 * rmse_m)
            self.assertAlmostEqual(of["rmse_mps"], rmse_mps, delta=0.4 * rmse_mps)
        # a plot waits for its sector, or its turn, to end, and for the step
        self.assertTrue(120 < sectors["latency_max_ms"] < 200)
        self.assertGreater(turns["latency_max_ms"], 3900)
        self.assertLess(at_once["latency_max_ms"], 100)

    def test_all_cases_see_the_same_plots(self):
        run = simulate_scene.simulate("rotating", 3)
        sectors, turns, at_once = (rotating.scans_of(case, run, 3) for case in rotating.CASES)
        self.assertEqual((len(sectors), len(turns), len(at_once)), (480, 15, 15))
        count = int(simulate_scene.has_plot(run.plots).sum())
        for scans in (sectors, turns, at_once):
            self.assertEqual(sum(len(scan) for scan in scans), count + len(scans))
            for scan in scans:  # the first row is the scan's own
                self.assertTrue(np.isnan(scan["range_m"][0]))
                self.assertFalse(np.isnan(scan["range_m"][1:]).any())
        self.assertTrue(all(scan["t_s"][0] == 4 * (k + 1) for k, scan in enumerate(turns)))
        self.assertTrue(all((scan["t_s"] == scan["t_s"][0]).all() for scan in at_once))
        # clutter is where it was; targets have moved for as long as they were seen before the end
        same = {(one["range_m"], one["azimuth_rad"]) for scan in turns for one in scan[1:]}
        moved = [one for scan in at_once for one in scan[1:]
                 if (one["range_m"], one["azimuth_rad"]) not in same]
        self.assertEqual(len(moved), (run.plots["target_id"] >= 0).sum())

    def test_every_bar_can_be_missed(self):
        for is_good, verdict in ((True, "ok"), (False, "MISSED")):
            one = {"targets": 3, "found": 3, "tracked": 3}
            lost = {"targets": 3, "found": 3 if is_good else 1, "tracked": 3 if is_good else 1}
            report = experiment.Report("test", types.SimpleNamespace(runs=9, seed=1, json=True))
            figures = [{"rmse_m": (100.0, 1.0)}] * 3 if is_good else [
                {"rmse_m": (200.0, 1.0)}, None, {"rmse_m": (100.0, 1.0)}]
            rotating.judge(report, [[lost] * 9, [one] * 9, [one] * 9], figures,
                           125.5 if is_good else 130)
            self.assertEqual([bar["verdict"] for bar in report.bars], [verdict] * 4)


if __name__ == "__main__":
    lab_test_setup.main()
