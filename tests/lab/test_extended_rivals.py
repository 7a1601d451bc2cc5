#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Experiment extended-rivals with few and short runs: do the other trackers follow bodies, are its
figures those of the tracks, can every bar be missed?"""
import json
import subprocess
import types
import unittest

import lab_test_setup

lab_test_setup.need_packages("rhotrack")

import numpy as np

import extended
import extended_rivals as rivals
from common import experiment
from common import stonesoup_tracker
from parts import stonesoup_clusters
from parts import ti_group_tracker

STEP_S, VELOCITY_MPS = 0.05, np.array([-20.0, 0.0])


def scans_of(starts_m, count, gone=0):
    """Scans of vehicles with four scatterers in 6 m of length each, the last `gone` without them,
    and one plot of clutter in each."""
    random, scans = np.random.default_rng(3), []
    for k in range(count + gone):
        t_s, plots = k * STEP_S, []
        for start_m in starts_m if k < count else ():
            for along_m in (-3.0, -1.0, 1.0, 3.0):
                x_m, y_m = start_m + VELOCITY_MPS * t_s + [along_m, 0]
                range_m = np.hypot(x_m, y_m)
                plots.append([range_m, np.arctan2(y_m, x_m), VELOCITY_MPS @ [x_m, y_m] / range_m])
        plots = np.array(plots).reshape(-1, 3) + random.normal(size=(len(plots), 3)) * rivals.ROAD
        clutter = random.uniform([5, -1.2, -20], [200, 1.2, 20])
        plots = np.concatenate([plots, clutter[None]])
        scans.append((t_s, plots, np.full(len(plots), t_s)))
    return scans


class Followed:
    """One vehicle is one track, two are two, and tracks end."""

    def assert_tracks(self, rows, starts_m, count):
        last_s = (count - 1) * STEP_S
        for start_m in starts_m:
            off_m = np.hypot(*(np.array([rows["x_m"], rows["y_m"]]).T - start_m
                               - rows["t_s"][:, None] * VELOCITY_MPS).T)
            self.assertEqual(len(set(rows["track_id"][off_m < 6])), 1, start_m)
            at_last = off_m[np.isclose(rows["t_s"], last_s)]
            self.assertEqual((at_last < 6).sum(), 1, start_m)
            self.assertLess(at_last.min(), 1.5)
        self.assertEqual(len(rows[np.isclose(rows["t_s"], last_s)]), len(starts_m))

    def test_one_vehicle_is_one_track(self):
        self.assert_tracks(self.track(scans_of([(120.0, 5.0)], 40)), [(120.0, 5.0)], 40)

    def test_two_far_apart_are_two(self):
        starts_m = [(120.0, 5.0), (160.0, 5.0)]
        self.assert_tracks(self.track(scans_of(starts_m, 40)), starts_m, 40)

    def test_a_track_ends_when_nothing_is_seen(self):
        rows = self.track(scans_of([(120.0, 5.0)], 40, gone=30))
        self.assertGreater((rows["t_s"] > 39.5 * STEP_S).sum(), 0)
        self.assertEqual((rows["t_s"] > 60.5 * STEP_S).sum(), 0)


class Groups(Followed, unittest.TestCase):
    def track(self, scans):
        return ti_group_tracker.track(scans, rivals.ROAD_GROUPS)[0]

    def test_derivatives_are_those_of_what_is_seen(self):
        state = np.array([80.0, -30.0, -12.0, 5.0, 0.5, 0.1])
        _, derivatives = ti_group_tracker.seen_from(state, 3)
        for i in range(6):
            step = 1e-4 * np.eye(6)[i]
            up, down = (
                ti_group_tracker.seen_from(state + sign * step, 3)[0]
                for sign in (1, -1))
            np.testing.assert_allclose((up - down) / 2e-4, derivatives[:, i], atol=1e-6)

    def test_plots_belong_to_their_own_times(self):
        """Plots of half a scan's time ago move a group as if it had been seen then."""
        tracker = ti_group_tracker.GroupTracker(rivals.SHIP_GROUPS)
        for k in range(40):
            x_m = 5000 + 10.0 * (2.5 * k - 1.25)
            plots = np.array([[x_m - 50, 0.0], [x_m, 0.0], [x_m + 50, 0.0]])
            groups = tracker.step(2.5 * k, plots, np.full(3, 2.5 * k - 1.25))
        self.assertEqual(len(groups), 1)
        self.assertAlmostEqual(groups[0].state[0], 5000 + 10 * 2.5 * 39, delta=3)
        self.assertAlmostEqual(groups[0].state[2], 10, delta=0.5)
        groups[0].state[2] = 400.0
        then = np.array([[groups[0].state[0] - 400, 0.0]])
        self.assertEqual(tracker.associate(then, np.array([-1.0])), [0])
        self.assertEqual(tracker.associate(then, np.array([0.0])), [-1])

    def test_one_plot_alone_begins_nothing(self):
        tracker = ti_group_tracker.GroupTracker(rivals.ROAD_GROUPS)
        tracker.step(0.0, np.array([[100.0, 0.0, -20.0]]), np.zeros(1))
        self.assertEqual(tracker.groups, [])
        pair = np.array([[100.0, 0.0, -20.0], [102.0, 0.0, -20.1]])
        tracker.step(0.05, pair + [0, 0, 15] * np.array([[0], [1]]), np.full(2, 0.05))
        self.assertEqual(tracker.groups, [])  # two range rates are no body's
        tracker.step(0.1, pair, np.full(2, 0.1))
        self.assertEqual(len(tracker.groups), 1)


class Clusters(unittest.TestCase):
    def test_dbscan(self):
        points = np.array([[0.0], [0.8], [1.6], [5.0], [5.9], [9.0]])
        for least, wanted in ((1, [0, 0, 0, 1, 1, 2]), (2, [0, 0, 0, 1, 1, -1]),
                              (3, [0, 0, 0, -1, -1, -1]), (4, [-1] * 6)):
            np.testing.assert_array_equal(
                stonesoup_clusters.dbscan(points, 1.0, least), wanted)
        self.assertEqual(len(stonesoup_clusters.dbscan(points[:0], 1.0, 1)), 0)

    def test_a_cluster_is_of_one_range_rate(self):
        plots = np.array([[100.0, 0.0, -20.0], [101.0, 0.0, -20.2], [100.5, 0.0, 10.0]])
        found = stonesoup_clusters.clusters(plots, np.array([1.0, 2.0, 4.0]),
                                                      rivals.ROAD_GNN)
        self.assertEqual([count for _, _, count in found], [2, 1])
        np.testing.assert_allclose(found[0][0], [100.5, 0, -20.1])
        self.assertEqual(found[0][1], 1.5)


NO_STONE_SOUP = "no stonesoup (make bench-stonesoup)"


@unittest.skipUnless(stonesoup_tracker.is_installed(), NO_STONE_SOUP)
class Gnn(Followed, unittest.TestCase):
    def track(self, scans):
        return stonesoup_clusters.track(scans, rivals.ROAD_GNN, "gnn")[0]


@unittest.skipUnless(stonesoup_tracker.is_installed(), NO_STONE_SOUP)
class Jpda(Followed, unittest.TestCase):
    def track(self, scans):
        return stonesoup_clusters.track(scans, rivals.ROAD_JPDA, "jpda")[0]


class Figures(unittest.TestCase):
    def test_switches_identities_and_others(self):
        """A car of 4 m at 10 m/s, whose third scan has another track, and the fourth both."""
        t_s = np.array([0.0, 1, 2, 3, 4])
        truth = {"t_s": t_s, "target_id": np.zeros(5), "x_m": 10 * t_s, "y_m": 0 * t_s,
                 "vx_mps": np.full(5, 10.0), "vy_mps": np.zeros(5), "length_m": np.full(5, 4.0),
                 "width_m": np.full(5, 2.0)}
        tracks = {"t_s": np.array([0.0, 1, 2, 3, 3, 4]), "track_id": np.array([1, 1, 2, 1, 2, 7]),
                  "x_m": np.array([0.0, 10, 20, 30, 31, 60]), "y_m": np.array([1.0, 1, 1, 1, 1, 1])}
        of = rivals.score(truth, tracks, 0.0, 0.5)[4.0]
        self.assertEqual((of["switches"], of["identities"], of["scan_ms"]), (1, 2, 0.5))
        self.assertAlmostEqual(of["complete"], 0.8)
        self.assertAlmostEqual(of["others"], 0.2)
        self.assertAlmostEqual(of["tracks"], 1.25)
        self.assertAlmostEqual(of["centre"], np.sqrt((5 + 1) / 5) / 4)

    def test_a_target_that_stands_is_headed_as_it_came(self):
        truth = extended.with_kept_headings({
            "target_id": np.array([0, 1, 0, 1]), "vx_mps": np.array([0.0, 5, 0, 0]),
            "vy_mps": np.array([-3.0, 0, 0, 0])})
        np.testing.assert_allclose(truth["vx_mps"], [0, 5, 0, 1e-3])
        np.testing.assert_allclose(truth["vy_mps"], [-3, 0, -1e-3, 0])

    def test_a_scene_from_end_to_end(self):
        with lab_test_setup.folder() as folder:
            done = subprocess.run([
                lab_test_setup.ROOT / "tools/lab/extended_rivals.py", "--scene", "bodies-apart",
                "--runs", "1", "--json", "-o", folder], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            is_told = "make bench-stonesoup" in (folder / "index.html").read_text()
        told = json.loads(done.stdout)
        is_there = stonesoup_tracker.is_installed()
        self.assertEqual(is_told, not is_there)
        self.assertEqual((len(told["cases"]), len(told["bars"])), (8 if is_there else 4, 6))
        for one in told["cases"]:
            if one["tracker"] in (rivals.OWN, rivals.GROUPS):
                self.assertGreater(one["complete"], 0.97, one)
                most = 1.5 if one["tracker"] == rivals.OWN else 2.5
                self.assertLess(one["identities"], most, one)
            self.assertGreater(one["scan_ms"], 0)

    def test_every_bar_can_be_held_and_missed(self):
        def judged(own, other):
            report = experiment.Report("test", types.SimpleNamespace(runs=100, seed=1, json=True))
            worst, best = ({"identities": (value, 0.01), "centre": (value, 0.01),
                            "complete": (1 / value, 0.01)} for value in (2.0, 1.0))
            of = {"best": best, "worst": worst}
            rivals.judge(report, {("trucks", 12.0): {
                rivals.OWN: of[own], rivals.GROUPS: of[other], "a worse one": worst}})
            return [bar["verdict"] for bar in report.bars]

        self.assertEqual(judged("best", "worst"), ["ok"] * 3)
        self.assertEqual(judged("best", "best"), ["ok"] * 3)
        self.assertEqual(judged("worst", "best"), ["MISSED"] * 3)


if __name__ == "__main__":
    lab_test_setup.main()
