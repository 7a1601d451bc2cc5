#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The scores of tracks, by scenes that can be counted by hand."""
import unittest

import lab_test_setup

lab_test_setup.need_packages()

import numpy as np

from common import scene_files
from common import scoring

GATE = 1000.0
NAN = float("nan")


def truth_of(*places):
    """Places on the x axis, a list a target, None where it is not alive; a scan a second."""
    x = np.array([[NAN if cell is None else cell for cell in target] for target in places],
                 dtype=float).T
    place = np.stack([x, np.where(np.isnan(x), NAN, 0.0)], axis=-1)
    return scene_files.Truth(
        np.arange(len(x)) * 1000000, np.arange(x.shape[1]), place, ~np.isnan(x))


def tracks_of(scans):
    """A list a scan of (track, x)."""
    return scene_files.Tracks(
        [np.array([track for track, _ in scan], dtype=int) for scan in scans],
        [np.array([[x, 0.0] for _, x in scan]).reshape(-1, 2) for scan in scans])


def score(truth, scans, visible=None):
    if visible is not None:
        truth.visible = np.array(visible, dtype=bool).T
    return scoring.score(truth, tracks_of(scans), GATE)


class Scoring(unittest.TestCase):
    def test_a_track_within_the_gate_is_the_targets_and_one_beyond_is_false(self):
        figures, rows = score(truth_of([0, 0, 0, 0]), [[], [(1, 300)], [(1, 1000)], [(1, 1001)]])
        self.assertEqual(figures["completeness"], 0.5)
        self.assertEqual(figures["false_per_scan"], 0.25)
        self.assertEqual(rows, [(3, 0)])
        self.assertEqual(figures["delay_mean_scans"], 1)
        self.assertAlmostEqual(figures["rms_m"], np.sqrt((300 ** 2 + 1000 ** 2) / 2))

    def test_one_target_has_one_track_and_the_second_is_false(self):
        figures, rows = score(truth_of([0, 0]), [[(1, 100), (2, 50)], [(1, 100), (2, 50)]])
        self.assertEqual((figures["completeness"], figures["false_per_scan"], figures["switches"]),
                         (1, 1, 0))
        self.assertEqual(rows, [(0, 0), (1, 0)])

    def test_a_nearer_track_does_not_take_a_target_from_its_own(self):
        figures, rows = score(truth_of([0, 0, 0]), [[(1, 100)], [(1, 500), (2, 50)], [(2, 50)]])
        self.assertEqual(figures["switches"], 1)
        self.assertEqual(rows, [(1, 1)])

    def test_a_track_that_is_much_nearer_does(self):
        figures, rows = score(truth_of([0, 0]), [[(1, 100)], [(1, 900), (2, 50)]])
        self.assertEqual(figures["switches"], 1)
        self.assertEqual(rows, [(1, 0)])

    def test_as_many_targets_as_can_be_have_a_track(self):
        figures, _ = score(truth_of([0], [900]), [[(1, 800), (2, 1500)]])
        self.assertEqual((figures["completeness"], figures["false_per_scan"]), (1, 0))

    def test_targets_that_exchange_tracks_are_two_switches(self):
        figures, _ = score(truth_of([0, 0], [5000, 5000]), [[(1, 0), (2, 5000)], [(2, 0),
                                                                                  (1, 5000)]])
        self.assertEqual(figures["switches"], 2)

    def test_a_track_after_a_gap_is_a_switch_where_the_target_stayed_in_sight(self):
        scans = [[(1, 0)]] + [[]] * 8 + [[(2, 0)]]
        self.assertEqual(score(truth_of([0] * 10), scans)[0]["switches"], 1)
        seen = [[True] + [False] * 8 + [True]]
        self.assertEqual(score(truth_of([0] * 10), scans, seen)[0]["switches"], 0)
        seen = [[True] * 4 + [False] * 5 + [True]]
        self.assertEqual(score(truth_of([0] * 10), scans, seen)[0]["switches"], 1)

    def test_a_track_is_forgiven_five_scans_after_its_target_died(self):
        figures, rows = score(truth_of([0, 0] + [None] * 8), [[(1, 0)]] * 10)
        self.assertEqual(rows, [(7, 0), (8, 0), (9, 0)])
        self.assertEqual(figures["false_per_scan"], 0.3)
        self.assertEqual(figures["false_tracks"], 1)
        self.assertEqual(figures["completeness"], 1)

    def test_the_same_after_it_left_coverage(self):
        _, rows = score(truth_of([0] * 10), [[(1, 0)]] * 10, [[True] * 2 + [False] * 8])
        self.assertEqual(rows, [(7, 0), (8, 0), (9, 0)])

    def test_a_track_that_started_as_its_target_left_is_forgiven_too(self):
        _, rows = score(truth_of([0] * 10), [[], []] + [[(1, 0)]] * 8, [[True] * 2 + [False] * 8])
        self.assertEqual(rows, [(7, 0), (8, 0), (9, 0)])

    def test_five_turns_of_the_slowest_sensor_are_forgiven(self):
        self.assertEqual(scoring.forgiven_scans({"radars": [{"turn_s": 4}]}), 5)
        self.assertEqual(scoring.forgiven_scans({"radars": [{"interval_s": 0.05}]}), 5)
        self.assertEqual(scoring.forgiven_scans({"radars": [{"turn_s": 4, "sectors": 32}]}), 160)
        self.assertEqual(scoring.forgiven_scans({"radars": [{"turn_s": 4}, {"turn_s": 5}]}), 11)

    def test_delays_count_from_the_first_visibility(self):
        figures, _ = score(truth_of([0] * 6, [5000] * 6,
                                    [90000] * 6), [[], [], [(1, 0)], [], [], [(2, 5000)]],
                           [[True] * 6, [False] + [True] * 5, [True] * 6])
        self.assertEqual(figures["delay_mean_scans"], (2 + 4) / 2)
        self.assertEqual(figures["delays_scans"], [2, 4])
        self.assertEqual(figures["never_tracked"], 1)

    def test_what_is_out_of_sight_does_not_count(self):
        figures, _ = score(truth_of([0] * 4), [[]] * 3 + [[(1, 0)]], [[False] * 2 + [True] * 2])
        self.assertEqual(figures["completeness"], 0.5)


class Consistency(unittest.TestCase):
    def pairs(self, off_m, off_mps, covariance_m2, covariance_m2ps2, motions):
        more = np.full((len(off_m), len(scene_files.MORE)), NAN)
        more[:, 2:5], more[:, 5:8] = covariance_m2, covariance_m2ps2
        return scoring.consistency(np.array(off_m, dtype=float), np.array(off_mps, dtype=float),
                                   more, np.array(motions))

    def test_the_ratio_is_that_of_the_inverse(self):
        random = np.random.default_rng(1)
        error, expected, rows = random.normal(size=(50, 2)), [], []
        for off in error:
            root = random.normal(size=(2, 2))
            p = root @ root.T + 0.1 * np.eye(2)
            rows.append((p[0, 0], p[1, 0], p[1, 1]))
            expected.append(off @ np.linalg.solve(p, off) / 2)
        np.testing.assert_allclose(scoring.ratio(error, np.array(rows)), expected, rtol=1e-9)

    def test_errors_as_stated_have_a_ratio_of_1_and_95_percent_inside(self):
        random = np.random.default_rng(2)
        p, v = np.array([[400, 150], [150, 900]]), np.array([[4, -1], [-1, 2]])
        off_m = random.multivariate_normal((0, 0), p, 20000)
        off_mps = random.multivariate_normal((0, 0), v, 20000)
        figures = self.pairs(off_m, off_mps, (400, 150, 900), (4, -1, 2), [0] * 10000 + [2] * 10000)
        for name in ("", "_straight", "_coasting"):
            for key in ("place", "velocity"):
                self.assertAlmostEqual(figures[f"nees_{key}{name}"], 1, delta=0.04)
                self.assertAlmostEqual(figures[f"inside_{key}{name}"], 0.95, delta=0.01)
        self.assertAlmostEqual(figures["rms_m"], np.sqrt(1300), delta=0.5)
        self.assertAlmostEqual(figures["rms_mps"], np.sqrt(6), delta=0.05)
        # half the sigmas: four times the ratio
        figures = self.pairs(off_m, off_mps, (100, 37.5, 225), (4, -1, 2), [0] * 20000)
        self.assertAlmostEqual(figures["nees_place"], 4, delta=0.15)
        self.assertLess(figures["inside_place"], 0.6)

    def test_what_is_not_known_does_not_count(self):
        figures = self.pairs([(3, 4), (1, 0), (0, 0)], [(NAN, NAN), (2, 0), (0, 0)],
                             [(NAN, NAN, NAN), (1, 0, 1), (1, 1, 1)], [(1, 0, 1), (1, 0, 1),
                                                                       (-1, 0, -1)], [3, 0, 1])
        self.assertEqual((figures["nees_place"], figures["nees_velocity"], figures["pairs"]),
                         (0.5, 2, 3))
        self.assertEqual((figures["pairs_turning"], figures["rms_m_turning"]), (1, 0))
        self.assertTrue(
            np.isnan(figures["nees_place_turning"]) and np.isnan(figures["rms_m_coasting"]))

    def test_motions_are_the_truths_but_for_coasting(self):
        truth = truth_of([0] * 6)
        truth.velocity_mps = np.array([[10, 0], [10, 0], [10, 0.1], [10, 0.2], [NAN, NAN],
                                       [10, 0.2]])[:, None, :]
        self.assertEqual(truth.motions()[:, 0].tolist(), [3, 0, 1, 1, 3, 3])
        more = [np.array([[10, 0, 4, 0, 4, 1, 0, 1, k == 3]], dtype=float) for k in range(6)]
        tracks = scene_files.Tracks([np.array([1])] * 6,
                                    [np.array([[2.0 + k, 0.0]]) for k in range(6)], more)
        figures, _ = scoring.score(truth, tracks, GATE)
        self.assertEqual(
            [figures["pairs_" + name] for name in scene_files.MOTIONS], [1, 1, 1])
        self.assertEqual(
            [figures["rms_m_" + name] for name in scene_files.MOTIONS], [3, 4, 5])
        self.assertAlmostEqual(figures["nees_place_turning"], 16 / 4 / 2)
        self.assertAlmostEqual(figures["nees_velocity_turning"], 0.1 ** 2 / 2)
        self.assertEqual(figures["inside_place"],
                         0.5)  # 4, 9, 16 | 25, 36, 49 over 4: 5.99 lies between

    def test_tracks_without_covariances_have_places_alone(self):
        figures, _ = score(truth_of([0, 0]), [[(1, 3)], [(1, 4)]])
        self.assertAlmostEqual(figures["rms_m"], np.sqrt(12.5))
        self.assertTrue(np.isnan(figures["nees_place"]) and np.isnan(figures["rms_mps"]))


class Files(unittest.TestCase):
    def test_coverage_is_range_and_sector(self):
        # 0.28 rad about -x
        sensor = scene_files.Sensor(1000, 0, 100, 5000, 3.0, -3.0, 30, 0.003)
        x, y = np.array([-3000, -3000, -4001, 901, 0, NAN]), np.array([0, 1000, 0, 0, 0, 0])
        self.assertEqual(sensor.covers(x, y).tolist(), [True, False, False, False, True, False])

    def test_times_meet_within_a_millisecond(self):
        truth = truth_of([0, 0, 0])
        self.assertEqual(
            truth.scan_of(np.array([-2000, -900, 400, 1000900, 1500000, 2001000,
                                    2001001])).tolist(), [-1, 0, 0, 1, -1, 2, -1])


if __name__ == "__main__":
    lab_test_setup.main()
