#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Experiment air-traffic with few and short runs: are its figures those of the tracks, is the limit
one, can every bar be missed? Figures of many runs stand in tools/lab/MEASUREMENTS.md."""
import json
import subprocess
import types
import unittest

import lab_test_setup

lab_test_setup.need_packages("rhotrack")

import numpy as np

import air_traffic
from parts import air_traffic_runs as runs
from common import experiment
from common import simulate_scene
from common import stonesoup_tracker

SEED = 7


def run_of(aircraft, clutter, num_scans):
    return runs.run_traffic((runs.Case("grid", "test", aircraft, clutter, num_scans), SEED))


class Traffic(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.figures = run_of(20, 100, 60)

    def test_aircraft_are_tracked(self):
        of = self.figures["tracks"][0]
        self.assertTrue(0.9 <= of["completeness"] <= 1, of)
        self.assertTrue(of["false"] <= 1 and 2 <= of["delay_scans"] <= 4, of)
        self.assertTrue(self.figures["max_us"] >= self.figures["us"] > 0)
        self.assertAlmostEqual(self.figures["hours"], 600 / 3600)
        self.assertTrue(1.5 < of["nees"] < 3 and 0.9 < of["nees_inside"] < 1, of)

    def test_shares_found_grow(self):
        alive, found = self.figures["alive"], self.figures["found"]
        self.assertTrue(alive[0] >= 20 and found[1] == 0 and (np.diff(alive) <= 0).all())
        self.assertGreater(found[2], 0.5 * alive[2])
        self.assertGreaterEqual(found[9], 0.95 * alive[9])

    def test_figures_are_the_limits_where_nothing_else_is_to_be_seen(self):
        of = run_of(10, 0, 60)
        for one, limit in zip(of["tracks"], of["limit"]):
            # the limit's tracks coast for a fixed number of misses; the tracker weighs them
            self.assertTrue(0.95 <= one["gospa_m"] / limit["gospa_m"] <= 1.02, (one, limit))

    def test_the_limit_knows_no_clutter(self):
        """The targets' plots are the same at any clutter, and so is what can be made of them."""
        clear, dense = run_of(10, 0, 50), run_of(10, 500, 50)
        self.assertEqual(clear["min_scans"], dense["min_scans"])
        self.assertEqual(clear["limit"], dense["limit"])
        self.assertLessEqual(dense["limit"][0]["gospa_m"], dense["tracks"][0]["gospa_m"] + 1)

    def test_the_limit_starts_at_so_many_hits(self):
        run = simulate_scene.simulate("air-traffic", SEED, "targets.0.flights=20",
                                  "clutter.0.plots=0", "duration_s=400")
        rows = simulate_scene.with_fields(run.plots,
                                                    ("t_s", "sensor_id", "x_m", "y_m", "scan"))
        for min_scans in (3, 4, 5):
            counts = [len(tracks) for tracks in runs.limit_of(run, rows, min_scans)]
            self.assertEqual((len(counts), max(counts[:min_scans - 1])), (40, 0))
            # seen in all of the first scans, .95^M of 20, and flown straight
            self.assertTrue(5 <= counts[min_scans - 1] <= 20 and counts[12] >= 14, counts)


class Others(unittest.TestCase):
    def test_a_formation_meets_flies_side_by_side_and_parts(self):
        place, velocity = runs.path_of(runs.Pair("", "formation", 61, 300))
        off_scans = np.maximum(0, abs(np.arange(61) - 30) - 15)
        spacing_m = 300 + off_scans * 10 * 2 * 250 * np.sin(np.radians(5))
        np.testing.assert_allclose(place[:, 0, 1] - place[:, 1, 1], spacing_m)
        np.testing.assert_allclose(place[:, 0, 0], place[:, 1, 0])
        np.testing.assert_allclose(np.linalg.norm(velocity, axis=2), 250)
        np.testing.assert_allclose(np.linalg.norm(np.diff(place, axis=0), axis=2), 2500)
        for path in ("parallel", "crossing"):
            place, velocity = runs.path_of(runs.Pair("", path, 31, 400))
            np.testing.assert_allclose(np.diff(place, axis=0), 10 * velocity[1:])
        self.assertLess(np.linalg.norm(place[15]), 1e-6)  # those that cross, at half time

    def test_pairs_are_told_apart(self):
        apart = runs.run_pair((runs.Pair("", "parallel", 31, 5000), SEED, 0))
        one = runs.run_pair((runs.Pair("", "parallel", 31, 150, 250, 0), SEED, 0))
        self.assertTrue(apart["no_switch"] and not apart["lost"], apart)
        self.assertGreater(apart["completeness"], 0.85)
        self.assertTrue(one["lost"] and one["completeness"] < 0.6, one)

    def test_clutter_alone_gives_few_tracks(self):
        less, more = (runs.run_alarm((100, wanted, SEED)) for wanted in (1, 10000))
        self.assertAlmostEqual(less["hours"], 500 / 360)
        self.assertTrue(less["confirmed"] <= 6 and more["confirmed"] >= less["confirmed"] + 6)
        self.assertTrue(less["us"] > 0 and less["min_scans"] > 2.9)

    def test_limits_of_a_poisson_mean(self):
        for count, low, high in ((0, 0, 3.689), (10, 4.795, 18.39)):
            np.testing.assert_allclose(experiment.poisson_limits(count), (low, high), atol=0.01)

    @unittest.skipUnless(stonesoup_tracker.is_installed(), "no stonesoup (make bench-stonesoup)")
    def test_stone_soup_follows_straight_targets(self):
        random = np.random.default_rng(3)
        start = np.array([[-8e4, 0], [0, 0], [8e4, 2e4]])
        scans = [(10.0 * k, np.concatenate([
            start + [2000 * k, 500 * k] + random.normal(0, 50, (3, 2)),
            random.uniform(-2e5, 2e5, (10, 2))])) for k in range(12)]
        for method in stonesoup_tracker.METHODS:
            reports, ms = stonesoup_tracker.track(scans, method)
            self.assertGreater(ms, 0)
            for place in start + [2000 * 11, 500 * 11]:
                off_m = np.hypot(reports[-1]["x_m"] - place[0], reports[-1]["y_m"] - place[1])
                self.assertLess(off_m.min(), 200)

    def test_a_part_from_end_to_end(self):
        with lab_test_setup.folder() as folder:
            done = subprocess.run([
                lab_test_setup.ROOT / "tools/lab/air_traffic.py", "--part", "pairs", "--runs", "1",
                "--json", "-o", folder], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("two aircraft", (folder / "index.html").read_text())
        told = json.loads(done.stdout)
        self.assertEqual((len(told["pairs"]), len(told["bars"]), told["cases"]), (6, 8, []))


def summaries_of(is_good):
    """Of the grid, as good as can be or as bad."""
    made = []
    for case in (one for one in air_traffic.CASES if one.part == "grid"):
        figures = {"completeness": float(is_good), "false": 0.0 if is_good else 100.0}
        made.append({"case": case, "us": 1.0 if is_good else 1e6,
                     "ratio": [(1.0 if is_good else 2.0, 0.01)] * 2,
                     "runs": [{"tracks": [figures, figures]}] * 3})
    return made


class Bars(unittest.TestCase):
    def judged(self, is_good):
        report = experiment.Report("test", types.SimpleNamespace(runs=100, seed=1, json=True))
        air_traffic.judge_grid(report, summaries_of(is_good))
        air_traffic.tell_pairs(report, [{"runs": 100, "no_switch": float(is_good), "switches": 0.0,
                                         "lost": float(not is_good), "completeness": 1.0}] * 6)
        air_traffic.tell_clutter(report, [
            {"scans": 1, "hours": 100.0, "us": 1.0, "min_scans": 3.0,
             "confirmed": round((100 if is_good else 300) * wanted)}
            for _, wanted in air_traffic.ALARMS])
        figures = dict.fromkeys(("localisation_m", "missed", "false", "completeness", "switches",
                                 "delay_scans"), 1.0)
        own = [{**figures, "gospa_m": 100.0 if is_good else 1000.0}] * 3
        other = [{**figures, "gospa_m": 200.0}] * 3
        air_traffic.tell_rivals(report, {"rhotrack": (own, 0.001 if is_good else 0.1),
                                         "gnn": (other, 1.0), "jpda": (other, 1.0)})
        return report.bars

    def test_every_bar_can_be_held_and_missed(self):
        good, bad = self.judged(True), self.judged(False)
        count = 12 + 2 + 6 + 2 * len(air_traffic.ALARMS) + 4
        self.assertEqual([bar["verdict"] for bar in good], ["ok"] * count)
        # a rate of false tracks is too high or too low, not both
        self.assertEqual(sum(bar["verdict"] == "MISSED" for bar in bad),
                         count - len(air_traffic.ALARMS))


if __name__ == "__main__":
    lab_test_setup.main()
