#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Experiment extended: is the oracle told whose points are whose, and no more; can every bar of a
situation be missed?"""
import types
import unittest

import lab_test_setup

lab_test_setup.need_packages()

import numpy as np

import extended
from common import experiment
from common import scene_files


class Oracle(unittest.TestCase):
    def test_a_plot_is_the_middle_of_a_targets_points(self):
        place_m = np.array([[1.0, 0], [9, 9], [3, 2], [5, 6], [7, 7]])
        plots = scene_files.Plots(
            times_us=np.arange(5), scan=np.array([0, 0, 0, 0, 1]),
            target=np.array([4, -1, 4, 2, 4]), sensor=np.ones(5, dtype=int), range_m=np.ones(5),
            azimuth_rad=np.zeros(5), place_m=place_m, scan_times_us=np.array([0, 4]),
            scan_sensor=np.ones(2, dtype=int))
        middles, noise_m2 = extended.middles_of(plots, np.full((5, 2, 2), 6.0))
        found = sorted(zip(middles.scan, middles.target, middles.place_m.tolist(),
                           noise_m2[:, 0, 0]))
        self.assertEqual(found, [(0, 2, [5, 6], 6), (0, 4, [2, 1], 3), (1, 4, [7, 7], 6)])

    def test_it_follows_who_pass_meet_and_stop(self):
        self.addCleanup(setattr, extended, "CASES", extended.CASES)
        extended.CASES = tuple(
            extended.Case(scene, "with bodies", (f"duration_s={duration_s}",), settle_s=2.0)
            for scene, duration_s in (("people-passing", 9), ("cars-at-a-light", 16)))
        for number, length in ((0, "0.42"), (1, "4.4")):
            figures, _ = extended.run((number, 1, False))
            told = figures[extended.ORACLE][length]
            self.assertGreater(told["complete"], 0.97)
            self.assertEqual((told["switches"], round(told["tracks"], 2)), (0, 1))
            self.assertGreater(figures["with bodies"][length]["complete"], 0.6)


class Bars(unittest.TestCase):
    def test_bars_of_a_situation_can_be_held_and_missed(self):
        def judged(tracks, switches, complete):
            report = experiment.Report("test", types.SimpleNamespace(runs=100, seed=1, json=True))
            told = {"complete": (0.99, 0.001)}
            of = {"tracks": (tracks, 0.001), "switches": (switches, 0.001), "targets": (5.0, 0.0),
                  "complete": (complete, 0.001)}
            extended.judge(report, extended.Case("people-at-home", "with bodies"), "0.42",
                           {"with bodies": of, extended.ORACLE: told})
            return [bar["verdict"] for bar in report.bars]

        self.assertEqual(judged(1.01, 0.09, 0.985), ["ok"] * 3)
        self.assertEqual(judged(1.03, 0.12, 0.97), ["MISSED"] * 3)


if __name__ == "__main__":
    lab_test_setup.main()
