#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Experiment passive: what its skies hold, its references against closed forms, how tracks and
targets are paired, which bars are missed when, and few runs of the script against the figures of
many. Bounds are four standard deviations of a sample of the many-run figure beside them."""
import argparse
import itertools
import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest
from unittest import mock

import lab_test_setup

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: the matrices are small
lab_test_setup.need_packages("rhotrack")

from parts import passive_scenes as bearings
from common import experiment
import numpy as np
import passive
from parts import passive_chain
from parts import passive_further_claims
from parts import passive_paper_figures
from parts.passive_scenes import Scene, Setting

SCRIPT = lab_test_setup.ROOT / "tools" / "lab" / "passive.py"


def draw(*setting, run=0, **others):
    return Scene(Setting(*setting, **others), np.random.default_rng([4711, run]))


class Skies(unittest.TestCase):
    def assert_uniform(self, values, low, high):
        count, variance = len(values), (high - low)**2 / 12
        self.assertTrue(low <= values.min() and values.max() <= high)
        self.assertAlmostEqual(values.mean(), (low + high) / 2,
                               delta=4 * math.sqrt(variance / count))
        self.assertAlmostEqual(values.var(), variance, delta=8 * variance / math.sqrt(5 * count))

    def test_targets_start_where_the_region_says_and_fly_towards_the_origin(self):
        for name, region in bearings.REGIONS.items():
            scene = draw(2, 1000, region=name)
            x_m, y_m, vx_mps, vy_mps = scene.start.T
            off_rad = bearings.wrapped(np.arctan2(vy_mps, vx_mps) - np.arctan2(-y_m, -x_m))
            self.assertLess(np.abs(off_rad).max(), math.pi / 4 + 1e-9)
            speed_mps = np.hypot(vx_mps, vy_mps)
            self.assertTrue(150 <= speed_mps.min() and speed_mps.max() <= 350)
            self.assertTrue(region.x_m[0] <= x_m.min() and x_m.max() <= region.x_m[1])
            self.assertLess(np.hypot(x_m, y_m).max(), 78e3)
            self.assertGreaterEqual((x_m + 70 * vx_mps).min(), region.end_x_min_m)
            self.assertTrue(430 < (y_m > 0).sum() < 570, name)  # 500, standard deviation 16
        far = x_m, off_rad, speed_mps = [
            one[scene.start[:, 0] > 27e3] for one in (x_m, off_rad, speed_mps)]
        self.assertGreater(len(far[0]), 100)  # near: none of these is drawn anew
        self.assert_uniform(off_rad, -math.pi / 4, math.pi / 4)
        self.assert_uniform(speed_mps, 150, 350)

    def test_intervals_are_ten_seconds_or_spread_about_them(self):
        np.testing.assert_allclose(draw(2, 1).times_s, 10 * np.arange(8))
        self.assertEqual(draw(2, 1).middle_s, 35)
        steps_s = np.concatenate([np.diff(draw(2, 1, unequal_intervals=True, run=run).times_s)
                                  for run in range(300)])
        self.assert_uniform(steps_s, 3, 17)

    def test_bearings_have_noise_misses_and_the_times_of_their_frames(self):
        scene = draw(3, 400, 0.5, 0.9, unequal_intervals=True)
        own = scene.rows[scene.rows["target_id"] >= 0]
        trials = 8 * 3 * 400
        self.assertAlmostEqual(len(own) / trials, 0.9, delta=4 * math.sqrt(0.09 / trials))
        self.assertEqual(len(np.unique(own[["frame", "sensor_id", "target_id"]])), len(own))
        np.testing.assert_array_equal(own["t_s"], scene.times_s[own["frame"]])
        truth = scene.truth(scene.times_s)[own["frame"], own["target_id"]]
        off = bearings.wrapped(own["bearing_rad"] - np.arctan2(
            truth[:, 1] - own["sensor_y_m"], truth[:, 0] - own["sensor_x_m"])) / math.radians(0.5)
        self.assertAlmostEqual(off.mean(), 0, delta=4 / math.sqrt(len(off)))
        self.assertAlmostEqual(off.var(), 1, delta=4 * math.sqrt(2 / len(off)))
        np.testing.assert_allclose(own["sigma_rad"], math.radians(0.5))

    def test_false_bearings_are_poisson_uniform_ahead_and_among_the_others(self):
        scene = draw(2, 1, false_mean=3, frames=1500)
        false = scene.seen[scene.seen["target_id"] < 0]
        counts = np.bincount(2 * false["frame"] + false["sensor_id"] - 1, minlength=3000)
        self.assertAlmostEqual(counts.mean(), 3, delta=4 * math.sqrt(3 / 3000))
        self.assertAlmostEqual(counts.var(), 3, delta=4 * math.sqrt((3 + 2 * 9) / 3000))
        self.assert_uniform(false["bearing_rad"], -math.pi / 2, math.pi / 2)
        place = np.array([np.flatnonzero(look["target_id"] == 0)[0] / (len(look) - 1)
                          for look in scene.looks().values() if len(look) > 1])
        self.assertAlmostEqual(place.mean(), 0.5, delta=4 * 0.5 / math.sqrt(len(place)))

    def test_a_frame_holds_what_the_named_sensors_see(self):
        scene = draw(3, 4, 0.1, 0.9, 1)
        frame = scene.frames((1, 3))[5]
        self.assertEqual(sorted(set(frame["sensor_id"])), [1, 3])
        self.assertEqual(set(frame["t_s"]), {50})
        self.assertEqual(np.isnan(frame["bearing_rad"]).sum(), 2)  # a row for each look
        np.testing.assert_array_equal(scene.looks()[5, 2], frame[
            (frame["sensor_id"] == 3) & ~np.isnan(frame["bearing_rad"])])
        blind = draw(2, 3, pd=0)
        self.assertEqual([len(frame) for frame in blind.frames()], [2] * 8)
        self.assertEqual([len(look) for look in blind.looks().values()], [0] * 16)

    def test_a_seed_gives_the_same_again(self):
        self.assertEqual(draw(2, 4, 0.1, 0.9, 1).rows.tobytes(),
                         draw(2, 4, 0.1, 0.9, 1).rows.tobytes())
        self.assertNotEqual(draw(2, 4, run=1).start[0, 0], draw(2, 4, run=2).start[0, 0])


class References(unittest.TestCase):
    truth = np.array([40e3, 5e3, -220.0, 60.0])  # at 35 s

    def rows(self, random, sigma_rad):
        """A bearing of each of two sensors every 10 s."""
        rows = np.zeros(16, bearings.ROW)
        rows["frame"], sensor = np.divmod(np.arange(16), 2)
        rows["t_s"], rows["sigma_rad"] = 10.0 * rows["frame"], sigma_rad
        rows["sensor_x_m"], rows["sensor_y_m"] = bearings.PLACES_M[sensor].T
        at = bearings.moved(self.truth, (rows["t_s"] - 35)[:, None])
        rows["bearing_rad"] = np.arctan2(
            at[:, 1] - rows["sensor_y_m"],
            at[:, 0] - rows["sensor_x_m"]) + sigma_rad * random.standard_normal(16)
        return rows

    def test_exact_bearings_give_the_truth(self):
        rows = self.rows(np.random.default_rng(1), 1e-9)
        state, _ = bearings.fit(rows, 35, [43e3, 2e3, -100, 0])
        np.testing.assert_allclose(state[:2], self.truth[:2], rtol=0, atol=0.01)
        np.testing.assert_allclose(state[2:], self.truth[2:], rtol=0, atol=1e-3)

    def test_the_fits_covariance_is_that_of_its_errors(self):
        random, sum_nees = np.random.default_rng(2), 0
        for _ in range(500):
            state, covariance = bearings.fit(self.rows(random, 0.002), 35, self.truth)
            sum_nees += bearings.nees(state - self.truth, covariance)
        self.assertAlmostEqual(sum_nees / 500, 4, delta=4 * math.sqrt(8 / 500))

    def test_nees_weighs_by_the_inverse(self):
        covariance = np.array([[4, 2, 0, 0], [2, 2, 0, 0], [0, 0, 9, 0], [0, 0, 0, 25.0]])
        # the inverse of the first two is 0.5, -0.5; -0.5, 1
        self.assertAlmostEqual(bearings.nees(np.array([2, 0, 3, 10.0]), covariance), 2 + 1 + 4)

    def test_without_process_noise_the_filter_is_the_fit(self):
        rows = self.rows(np.random.default_rng(3), 1e-5)
        state, covariance = bearings.fit(rows[:8], 30, bearings.moved(self.truth, -5))
        for k in range(4, 8):
            state, covariance = bearings.predict(state, covariance, 10, 0)
            for row in rows[2 * k:2 * k + 2]:
                state, covariance = bearings.update(state, covariance, row)
        whole, spread = bearings.fit(rows, 70, bearings.moved(self.truth, 35))
        off = (state - whole) / np.sqrt(spread.diagonal())
        self.assertLess(np.abs(off).max(), 0.02)
        np.testing.assert_allclose(covariance.diagonal(), spread.diagonal(), rtol=0.02)

    def test_process_noise_is_white_acceleration(self):
        _, covariance = bearings.predict(np.zeros(4), np.zeros((4, 4)), 3, 2)
        np.testing.assert_allclose(covariance[[0, 0, 2], [0, 2, 2]], [2 * 9, 2 * 4.5, 2 * 3])
        self.assertEqual(covariance[0, 1], 0)

    def test_lines_are_apart_by_the_smaller_angle(self):
        north = passive.line_of([1000, 5, 0, 200])
        right = passive.line_of([1000, 0, math.sin(0.01), math.cos(0.01)])
        left = passive.line_of([1000, 0, -math.sin(0.01), math.cos(0.01)])
        np.testing.assert_allclose(passive.line_off(left, right), (0.02, 0), atol=1e-9)
        np.testing.assert_allclose(passive.line_off(north, left),
                                   (0.01, 1000 * (1 - math.cos(0.01))), atol=1e-9)
        back = passive.line_of([1000, 5, 0, -200])
        np.testing.assert_allclose(passive.line_off(north, back), (0, 0), atol=1e-9)


class Pairing(unittest.TestCase):
    def setUp(self):
        """Two targets that meet at mid-batch."""
        self.scene = draw(2, 2, 0.01)
        self.scene.start[:] = [[40e3, -3.5e3, -200, 100], [40e3, 3.5e3, -200, -100]]
        self.scene.rows = self.scene._look(np.random.default_rng(1))
        self.claims = np.array([[[np.flatnonzero(self.scene.looks()[k, i]["target_id"] == target)[0]
                                  for i in range(2)] for k in range(8)] for target in range(2)])

    def hits(self, states, claims=None):
        return passive.hits_of(self.scene, states, np.array([np.eye(4)] * len(states)),
                               self.claims[:len(states)] if claims is None else claims)

    def test_targets_that_meet_at_mid_batch_have_their_own_tracks(self):
        at_last = self.scene.truth(70.0)
        hits = self.hits(at_last[::-1], self.claims[::-1])
        self.assertEqual(len(hits), 2)
        for name in ("off_m", "theta_rad", "rho_m", "nees"):
            np.testing.assert_allclose(hits[name], 0, atol=1e-9)
        np.testing.assert_array_equal(hits["is_own"], 1)
        self.assertTrue((hits["fit_off_m"] > 0).all())

    def test_errors_are_those_at_mid_batch(self):
        state = self.scene.truth(70.0)[:1] + [[30, 40, 0, 0]]
        (hit,) = self.hits(state)
        self.assertAlmostEqual(hit["off_m"], 50)
        self.assertAlmostEqual(hit["nees"], 2500)

    def test_a_track_is_one_targets_and_not_of_far_ones(self):
        self.assertEqual(len(self.hits(self.scene.truth(70.0)[:1])), 1)
        self.assertEqual(len(self.hits(self.scene.truth(70.0)[:1] + [[2000, 0, 0, 0]])), 0)
        self.assertEqual(len(self.hits(np.empty((0, 4)))), 0)

    def test_a_bearing_of_another_target_mixes_a_track(self):
        claims = self.claims.copy()
        claims[0, 3, 0] = -1
        self.assertEqual(self.hits(self.scene.truth(70.0), claims)["is_own"].tolist(), [1, 1])
        claims[0, 3, 0] = self.claims[1, 3, 0]
        self.assertEqual(self.hits(self.scene.truth(70.0), claims)["is_own"].tolist(), [0, 1])

    def test_the_package_finds_both(self):
        found, ghosts, find_ms, hits = passive.default_run((self.scene.of,), self.scene)
        self.assertEqual((found, ghosts), (2, 0))
        self.assertTrue(0 < find_ms < 1000)
        self.assertTrue((hits["nees"] < 30).all() and (hits["theta_rad"] < math.radians(2)).all())


class Bars(unittest.TestCase):
    """Each part with made-up runs, all of them alike but for one that is worse."""

    def missed(self, part, runs):
        options = argparse.Namespace(runs=400, seed=1, jobs=1, json=True, name="passive",
                                     output=pathlib.Path("."))
        report = experiment.Report("made up", options)
        with mock.patch.object(passive, "runs_of", lambda *_: runs), \
                mock.patch.object(passive_chain, "runs_of", lambda *_: runs), \
                mock.patch.object(passive_paper_figures, "tell"):
            passive.PARTS[part](report)
        return [bar["what"] for bar in report.bars if not bar["held"]]

    def test_pruning(self):
        counts = np.array([[100, 100, 50, 0], [100, 100, 80, 0], [100, 100, 80, 0]])
        runs = {name: [counts] * 400 for name in passive.PRUNING}
        self.assertEqual(self.missed("pruning", runs), [])
        runs["2 targets, clean"] = [counts - [[0, 0, 0, 0], [0, 0, 8, -1], [0, 0, 0, 0]]] * 400
        runs["2 targets, P_D .9 FA 1"] = [counts + [[0] * 4, [0] * 4, [0, 0, 0, 1]]] * 400
        self.assertEqual(len(self.missed("pruning", runs)), 3)

    def test_the_papers_method(self):
        runs = {name: [[(setting.targets * share, ghosts, 0)
                        for share, ghosts, _ in references.values()]] * 400
                for name, (setting, _, references) in passive.PAPER.items()}
        self.assertEqual(self.missed("paper", runs), [])
        self.assertEqual(self.missed("paper", {
            **runs, "2s 2t .1 clean": [[(2 * .72, 2.43, 0), (2 * .81, 0.8, 0)]] * 400}), [
                "paper's method, 2s 2t .1 clean, elimination alone: Pd off the reference 0.797",
                "paper's method, 2s 2t .1 clean, literal: ghosts a run off the reference 0.25"])

    def default_runs(self, name=None, lost=0, ghosts=0, find_ms=1, off_m=100.0, nees=4.0):
        runs = {}
        for one, (setting, *_) in passive.DEFAULT.items():
            found = setting.targets - (lost if one == name else 0)
            is_it = name in (one, None)
            hit = (off_m if is_it else 100, 100, 0, 0, 0, 0, nees, 1)
            runs[one] = [(found, ghosts if is_it else 0, find_ms if is_it else 1,
                          np.array([hit] * found, passive.HIT))] * 400
        return runs

    def test_the_default(self):
        name = passive.TIMED
        self.assertEqual(self.missed("default", self.default_runs()), [])
        for change, what in (({"lost": 1}, "Pd"), ({"ghosts": 1}, "ghosts a run"),
                             ({"find_ms": 11}, "median ms of a search"),
                             ({"off_m": 109}, "rms error of the place over the fit's")):
            self.assertEqual(self.missed("default", self.default_runs(name, **change)),
                             [f"default, {name}: {what}"])
        self.assertEqual(len(self.missed("default", self.default_runs(nees=4.8))), 3)
        self.assertEqual(len(self.missed("default", self.default_runs(nees=3.4))), 3)
        self.assertEqual(len(self.missed("default", self.default_runs(off_m=109))), 26)

    def test_the_chain(self):
        def runs(tracked=1, false=0, off_m2=1):
            return {name: [(tracked * setting.targets, setting.targets, 8 * setting.targets, false,
                            16 * setting.targets, off_m2 * setting.targets, setting.targets, 1)]
                    * 400 for name, (setting, *_) in passive_chain.CASES.items()}
        self.assertEqual(self.missed("chain", runs()), [])
        self.assertEqual(len(self.missed("chain", runs(false=1))), 6)
        self.assertEqual(len(self.missed("chain", runs(tracked=0.9))), 4)
        self.assertEqual(len(self.missed("chain", runs(off_m2=1.2))), 4)


class Script(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.kept.name)

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def run_it(self, *arguments):
        return subprocess.run([str(SCRIPT), "--jobs", "2", "-o", str(self.folder / "out"),
                               *arguments], capture_output=True, text=True, check=False)

    def test_all_tables_bars_and_pictures(self):
        done = self.run_it("--runs", "16", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        report = json.loads(done.stdout)
        self.assertEqual([len(report[key]) for key in ("pruning", "figures", "paper", "default",
                                                       "chain")], [30, 6, 15, 28, 6])
        self.assertEqual([report[f"{key}_runs"] for key in ("pruning", "paper", "default",
                                                            "chain")], [12, 8, 16, 8])
        pruning = {(one["case"], one["rule"]): one for one in report["pruning"]}
        clean = pruning["2 targets, clean", "literal"]
        self.assertEqual(clean["targets_lost"], 0)
        self.assertGreater(clean["ghosts_removed"], 0.3)  # .77 +- .13 of 12 runs
        self.assertEqual(clean["ghosts_removed"],
                         pruning["2 targets, clean", "safe"]["ghosts_removed"])
        self.assertLess(pruning["2 targets, clean", "elimination alone"]["ghosts_removed"],
                        clean["ghosts_removed"])
        paper = {(one["case"], one["rule"]): one for one in report["paper"]}
        self.assertGreater(paper["2s 2t .05 clean", "literal"]["found"], 0.6)  # .94 +- .06
        self.assertLess(paper["2s 2t .05 clean", "literal"]["ghosts_per_run"],
                        paper["2s 2t .05 clean", "elimination alone"]["ghosts_per_run"])
        default = {one["case"]: one for one in report["default"]}
        easy = default["3s 4t .1 P_D .9 FA 1"]
        self.assertGreaterEqual(easy["found"], 0.95)  # .999 +- .004 of 64 targets
        self.assertTrue(0.9 < easy["rms_over_fit"] < 1.2, easy)  # 1.02 +- .02
        self.assertTrue(2.5 < easy["own_nees"] < 5.6, easy)  # 4 +- .38 of 55
        self.assertTrue(3.5 < report["nees"]["mean"] < 4.6, report["nees"])  # 4.1 +- .09
        self.assertIsNone(default["2s no target FA 4"]["found"])
        for one in report["chain"][:4]:
            self.assertGreater(one["tracked"], 0.85)
            self.assertTrue(3 <= one["confirmed_at_frame"] < 6, one)
            self.assertTrue(0.9 < one["rms_m"] / one["filter_rms_m"] < 1.3, one)
        self.assertEqual(len(report["bars"]), 93)
        verdicts = {bar["what"]: bar["verdict"] for bar in report["bars"]}
        self.assertFalse(any(" ms " in what for what in verdicts))  # so few runs tell no time
        self.assertEqual(verdicts["default, 2s no target FA 4: ghosts a run"], "needs 300 runs")
        psi = {one["case"]: one["psi_off_deg"] for one in report["summed"]}
        self.assertLess(psi["3s 2t .05 clean"], 3)  # .9, of cells of 2
        cost = {one["sensors"]: one for one in report["cost"]}
        self.assertLess(cost[3]["hough_by_crossings"] + 1, cost[3]["tuples_by_bearings"])
        self.assertLess(cost[3]["tuples_by_bearings"], cost[4]["tuples_by_bearings"])
        page = (self.folder / "out" / "index.html").read_text()
        for name in ("figures-2-and-3", "figures-4-and-5", "figures-6-to-9",
                     "figures-5-to-9-histograms"):
            self.assertIn(f'src="{name}.svg"', page)
            self.assertGreater((self.folder / "out" / f"{name}.svg").stat().st_size, 15000)

    def test_the_figures_scenes_show_what_the_papers_do(self):
        two, pruned, *pairs, confirmed = passive_paper_figures.figures()
        self.assertEqual((two[:3], pruned), ((16, 8, 2), (16, 0, 2, 0)))
        self.assertGreaterEqual(two[3], 1)
        self.assertTrue(all(pair[0] == 16 and pair[2] == 2 for pair in pairs))
        self.assertGreater(sum(pair[3] for pair in pairs), 0)
        self.assertEqual(confirmed, (48, sum(pair[1] for pair in pairs), 2, 0))

    def test_a_seed_gives_the_same_again_and_parts_are_alone(self):
        def pruning(*options):
            done = self.run_it("--runs", "2", "--part", "pruning", "--json", *options)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            return json.loads(done.stdout)
        first = pruning()
        self.assertNotIn("default", first)
        self.assertEqual(len(first["bars"]), 3)
        self.assertEqual(first, pruning("--jobs", "1"))
        self.assertNotEqual(first["pruning"], pruning("--seed", "2")["pruning"])
        self.assertEqual(self.run_it("--part", "nothing").returncode, 2)


class Assignment(unittest.TestCase):
    def test_the_least_cost_is_that_of_every_choice(self):
        """Two targets, three sensors: all sets of tuples without a common bearing, by brute
        force."""
        scene = bearings.Scene(bearings.Setting(3, 2, 0.1), np.random.default_rng(11))
        looks = [scene.looks()[0, s]["bearing_rad"].astype(float) for s in range(3)]
        costs, members = passive_further_claims.tuples_of(looks, 3, np.radians(0.1))
        self.assertEqual(len(costs), 3**3 - 1 - 3 * 2)
        least = 0.0
        for count in (1, 2, 3):
            for chosen in itertools.combinations(range(len(costs)), count):
                used = [(s, members[i][s]) for i in chosen for s in range(3) if members[i][s] >= 0]
                if len(set(used)) == len(used):
                    least = min(least, costs[list(chosen)].sum())
        chosen = passive_further_claims.assign(costs, members, looks)
        self.assertAlmostEqual(costs[chosen].sum(), least, places=6)

    def test_a_tuple_of_one_target_fits(self):
        scene = bearings.Scene(bearings.Setting(3, 1, 0.001), np.random.default_rng(5))
        looks = [scene.looks()[0, s]["bearing_rad"].astype(float) for s in range(3)]
        near = scene.start[0, :2] + 500
        self.assertLess(
            passive_further_claims.cost_of(np.concatenate(looks), bearings.PLACES_M[:3],
                                                 np.radians(0.001), near), 12)


if __name__ == "__main__":
    lab_test_setup.main()
