#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Experiment two-radars with few runs: figures, what the cases tell the tracker, bars."""
import json
import subprocess
import types
import unittest

import lab_test_setup

lab_test_setup.need_packages("rhotrack")

import numpy as np

from common import experiment
from common import simulate_scene
import two_radars


class TwoRadars(unittest.TestCase):
    def test_figures_bars_and_page(self):
        with lab_test_setup.folder() as folder:
            done = subprocess.run([lab_test_setup.ROOT / "tools/lab/two_radars.py", "--runs", "2",
                                   "--json", "-o", folder], capture_output=True, text=True,
                                  check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertEqual({path.name for path in folder.iterdir()},
                             {"index.html", "map.svg", "plots.svg", "biases.svg", "figures.json"})
        told = json.loads(done.stdout)
        self.assertEqual((len(told["cases"]), len(told["bars"])), (6, 10))
        first, second, left, found, known, arrived = told["cases"]
        # 88 m with the biases of register or known, 119 without, 115 and 200 m of one radar
        self.assertLess(found["rmse_m"], 1.1 * known["rmse_m"])
        self.assertLess(found["rmse_m"], 0.95 * left["rmse_m"])
        self.assertLess(found["rmse_m"], min(first["rmse_m"], second["rmse_m"]))
        self.assertTrue(70 < known["rmse_m"] < 110 and 150 < first["rmse_m"] < 260, told["cases"])
        for of in told["cases"]:
            self.assertTrue(0.9 < of["completeness"] <= 1, of)  # .94 to .98
            self.assertLess(of["duplicates_per_target"], 0.02)
            self.assertLess(of["scans_late_share"], 0.01)
        self.assertLess(arrived["completeness"], known["completeness"])  # by .005 +- .001
        self.assertEqual((told["range_bias_m"]["estimates"], told["time_bias_s"]["estimates"]),
                         (4, 2))
        # 4 estimates whose sigma is 3.1 m and .004 degrees: four of it, at most
        self.assertTrue(0 < told["range_bias_m"]["worst"] < 13)
        self.assertTrue(0 < told["azimuth_bias_rad"]["worst"] < np.radians(0.016))

    def test_a_case_tells_what_it_says(self):
        run = simulate_scene.simulate(
            "two-radars", 5, "duration_s=60", also=lambda folder: {
                1: {"range_bias_m": 40.0, "azimuth_bias_rad": 0.001},
                2: {"range_bias_m": None, "azimuth_bias_rad": -0.002, "time_bias_s": 0.25}})
        by_case = [two_radars.scans_of(case, run) for case in two_radars.CASES]
        for case, (_, scans) in zip(two_radars.CASES, by_case):
            times_s = np.array([scan["t_s"][0] for scan in scans])
            self.assertEqual({int(scan["sensor_id"][0]) for scan in scans}, set(case.radars))
            self.assertEqual(bool((np.diff(times_s) < 0).any()), case.is_as_arrived)
            self.assertGreaterEqual(np.diff(two_radars.looks_of(scans)).min(), 0.999)
        left, found = by_case[two_radars.LEFT][1], by_case[two_radars.FOUND][1]
        for one, other in zip(left, found):  # plots of radar 2 were too late, and scans were not
            self.assertEqual(one["t_s"][0], other["t_s"][0])
            np.testing.assert_allclose(one["t_s"][1:] - other["t_s"][1:],
                                       0.25 * (one["sensor_id"][1:] == 2), atol=1e-9)

    def test_errors_of_biases(self):
        found = [{1: {"range_bias_m": 53.0, "range_bias_sigma_m": 3.0, "azimuth_bias_rad": None,
                      "azimuth_bias_sigma_rad": None, "time_bias_s": 0, "time_bias_sigma_s": 0},
                  2: {"range_bias_m": -44.0, "range_bias_sigma_m": 3.0}}]
        figures, variance = two_radars.bias_figures(found)
        self.assertEqual((figures["range_bias_m"]["estimates"], figures["range_bias_m"]["worst"]),
                         (2, 6))
        self.assertAlmostEqual(figures["range_bias_m"]["rms"], np.sqrt((9 + 36) / 2))
        self.assertEqual([figures[kind]["not_known"] for kind, *_ in two_radars.KINDS], [0, 2, 1])
        self.assertAlmostEqual(variance[0], (1 + 4) / 2)

    def test_every_bar_can_be_missed(self):
        def judged(is_good):
            report = experiment.Report("test", types.SimpleNamespace(runs=9, seed=1, json=True))
            biases = {kind: {"worst": 0.0 if is_good else 100.0, "not_known": int(not is_good)}
                      for kind, *_ in two_radars.KINDS}
            alone = {"rmse_m": (100.0, 1.0), "completeness": (1.0, 0.01)}
            both = {"rmse_m": (90.0 if is_good else 200.0, 1.0),
                    "completeness": (1.0 if is_good else 0.5, 0.01),
                    "duplicates_per_target": (float(not is_good), 0.01),
                    "switches_per_target_hour": (float(not is_good), 0.01)}
            two_radars.judge(report, biases, (1.0 if is_good else 2.0, 0.1),
                             [alone, alone, both, both, {**both, **alone}, both])
            return [bar["verdict"] for bar in report.bars]

        self.assertEqual(judged(True), ["ok"] * 10)
        self.assertEqual(judged(False), ["MISSED"] * 10)


if __name__ == "__main__":
    lab_test_setup.main()
