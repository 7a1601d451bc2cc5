#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""GOSPA against all pairings of small sets, and figures of lives that can be counted by hand."""
import itertools
import math
import unittest

import lab_test_setup

lab_test_setup.need_packages()

import numpy as np

from common import gospa

CUTOFF_M = 100.0
TRACK = [("track_id", "i4"), ("x_m", "f8"), ("y_m", "f8"), ("vx_mps", "f8"), ("vy_mps", "f8"),
         ("cov_x_x", "f8"), ("cov_y_x", "f8"), ("cov_y_y", "f8"), ("cov_vx_vx", "f8"),
         ("cov_vy_vx", "f8"), ("cov_vy_vy", "f8")]


def tracks_of(*tracks):
    """(track, x): sigma 10 m and 2 m/s, a velocity of 1, 0 m/s."""
    return np.array([(number, x_m, 0, 1, 0, 100, 0, 100, 4, 0, 4) for number, x_m in tracks], TRACK)


def add(evaluation, targets, *tracks):
    """targets: (id, x), at rest."""
    places = np.array([[x_m, 0.0] for _, x_m in targets]).reshape(-1, 2)
    ids = np.array([number for number, _ in targets], int)
    return evaluation.add(ids, places, np.zeros_like(places), tracks_of(*tracks))


def least_by_force(targets, tracks):
    """The least sum of squares and halves of the cutoff's, over all pairings."""
    least = math.inf
    columns = [*range(len(tracks)), *[None] * len(targets)]
    for chosen in set(itertools.permutations(columns, len(targets))):
        pairs = [(i, j) for i, j in enumerate(chosen) if j is not None]
        alone = len(targets) + len(tracks) - 2 * len(pairs)
        least = min(least, CUTOFF_M**2 / 2 * alone + sum(
            ((targets[i] - tracks[j])**2).sum() for i, j in pairs))
    return least


class Pairs(unittest.TestCase):
    def test_no_pairing_is_better(self):
        random = np.random.default_rng(5)
        for _ in range(60):
            targets, tracks = (random.uniform(0, 300, (random.integers(0, 5), 2)) for _ in "ab")
            rows, cols, apart_m = gospa.pair(targets, tracks, CUTOFF_M)
            alone = len(targets) + len(tracks) - 2 * len(rows)
            self.assertAlmostEqual((apart_m**2).sum() + CUTOFF_M**2 / 2 * alone,
                                   least_by_force(targets, tracks), delta=1e-6)
            self.assertTrue((apart_m < CUTOFF_M).all())
            self.assertEqual((len(set(rows)), len(set(cols))), (len(rows), len(cols)))

    def test_a_crowd_is_paired_at_once(self):
        x_m = 30.0 * np.arange(40)
        rows, cols, _ = gospa.pair(np.column_stack([x_m, 0 * x_m]),
                                   np.column_stack([x_m[::-1] + 5, 0 * x_m]), CUTOFF_M)
        self.assertTrue((rows + cols == 39).all() and len(rows) == 40)


class Figures(unittest.TestCase):
    def test_parts_of_gospa_and_lives(self):
        of = gospa.Evaluation(CUTOFF_M)
        self.assertEqual(add(of, [(7, 0), (8, 1000)]), 0)
        self.assertEqual(add(of, [(7, 0), (8, 1000)], (1, 30)), 1)
        self.assertEqual(add(of, [(7, 0), (8, 1000)], (1, 500), (2, 40)), 1)  # another track
        self.assertEqual(add(of, [(7, 0)], (1, 500)), 0)
        self.assertEqual(add(of, [(7, 0)], (2, 0)), 1)  # again, and the same
        result = of.result()
        self.assertAlmostEqual(result["localisation_m"], math.sqrt((900 + 1600) / 5))
        self.assertEqual((result["missed"], result["false"]), ((2 + 1 + 1 + 1) / 5, 2 / 5))
        self.assertAlmostEqual(result["gospa_m"], math.sqrt(500 + 5000 * (1 + 0.4)))
        self.assertAlmostEqual(result["completeness"], 3 / 8)
        self.assertEqual([result[key] for key in ("switches", "fragments", "delay_scans")],
                         [1, 1, 1])
        self.assertEqual(result["false_tracks"], 1)  # track 1: once of three times
        self.assertAlmostEqual(result["rmse_m"], math.sqrt(2500 / 3))

    def test_consistency(self):
        of = gospa.Evaluation(CUTOFF_M)
        add(of, [(1, 0)], (1, 20))
        add(of, [(1, 0)], (1, 30))
        result = of.result()
        self.assertAlmostEqual(result["nees"], (4 + 9) / 2)
        self.assertEqual((result["nees_inside"], result["velocity_inside"]), (0.5, 1))
        self.assertAlmostEqual(result["velocity_ratio"], 0.25 / 2)

    def test_without_covariances_and_without_anything(self):
        of = gospa.Evaluation(CUTOFF_M)
        of.add(np.array([1]), np.zeros((1, 2)), np.zeros((1, 2)),
               tracks_of((1, 3))[["track_id", "x_m", "y_m", "vx_mps", "vy_mps"]])
        self.assertTrue(math.isnan(of.result()["nees"]))
        empty = gospa.Evaluation(CUTOFF_M)
        add(empty, [])
        self.assertEqual(empty.result()["gospa_m"], 0)


if __name__ == "__main__":
    lab_test_setup.main()
