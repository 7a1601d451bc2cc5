#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""tools/lab/initiation.py with few runs: main cases, the oracle against closed forms, paths and
plots, and the experiment from end to end. The bounds stand four standard errors of so few runs away
from the figures of many (the comments)."""
import json
import math
import re
import subprocess
import unittest

import lab_test_setup

lab_test_setup.need_packages("rhotrack")

import initiation
import numpy as np
from common import paper_aircraft as paper
from common import oracle_fit

RUNS, SEED = 40, 4711
SCRIPT = lab_test_setup.ROOT / "tools" / "lab" / "initiation.py"
MODEL = oracle_fit.Model(7, 2.0, 10.0, 0.9, 1e7, 100.0, 400.0)


def figures_of(name, runs=RUNS):
    number = next(i for i, case in enumerate(initiation.CASES) if case.name == name)
    return initiation.summarised(initiation.CASES[number], [
        initiation.run((number, SEED, index)) for index in range(runs)])


class Cases(unittest.TestCase):
    def expect(self, name, found_min, false_max, runs=RUNS):
        of = figures_of(name, runs)
        self.assertLessEqual(of["false_per_run"], false_max, name)
        if found_min is not None:
            self.assertGreaterEqual(of["pd"], found_min, name)
            self.assertGreaterEqual(of["pd"], of["oracle_pd"] - 0.06, name)
            self.assertTrue(3 < of["error_m"] < 70, of)

    def test_targets_in_thin_clutter_are_found(self):
        self.expect("Table 1, 0/km^2, P_D 0.99", 0.97, 0)  # 1.000, 0
        self.expect("Table 1, 1/km^2, P_D 0.99", 0.97, 0.05)  # .999, 0

    def test_targets_in_dense_clutter_are_found(self):
        self.expect("Table 1, 10/km^2, P_D 0.99", 0.91, 0.12)  # .976, .01
        self.expect("Table 1, 10/km^2, P_D 0.9", 0.70, 0.22)  # .84, .047
        self.expect("Table 1, 30/km^2, P_D 0.99", 0.57, 0.5, 20)  # .80, .10

    def test_the_real_aircraft_are_found(self):
        self.expect("Table 3, 100 clutter plots a scan", 0.97, 0.15)  # 1.000, .02

    def test_neighbours_are_told_apart(self):
        for name in ("parallel, 20 m", "parallel, 50 m", "crossing at 10 deg",
                     "same line, overtaking", "vertical, x = 0"):
            self.expect(name, 0.93, 0.15)  # .99 or more, .01

    def test_clutter_alone_starts_few_tracks(self):
        self.expect("clutter only, 10/km^2, score_min -3 nat", None, 0.2)  # .04
        self.expect("clutter only, 10/km^2, score_min 0 nat", None, 0.05)  # .001
        self.expect("Table 1, 5/km^2 with a hot spot of 50/km^2", 0.93, 0.12)  # .99, .01

    def test_manoeuvres_need_process_noise(self):
        straight = figures_of("10 m/s^2 along the path, 1/km^2, process noise 0 m/s^2")
        manoeuvring = figures_of("10 m/s^2 along the path, 1/km^2, process noise 10 m/s^2")
        self.assertLess(straight["pd"], 0.1)  # 0
        self.assertGreater(manoeuvring["pd"], 0.45)  # .75


class Oracle(unittest.TestCase):
    def test_a_straight_target_has_the_score_of_its_densities(self):
        """Without residuals: all determinants by hand, for three plots 2 s apart."""
        model = MODEL._replace(scans=3)
        velocity, score_nat = oracle_fit.fit(
            model, np.array([0.0, 2.0, 4.0]), np.array([[0.0, 0], [400, 300], [800, 600]]),
            np.full(3, 1e-6))
        np.testing.assert_allclose(velocity, [200, 150])
        # covariance 100 I; normal equations [[3, 6], [6, 20]] / 100
        by_hand = (3 * math.log(0.9 / 1e-6) - math.log(1e7 * math.pi * (400**2 - 100**2) / 0.5)
                   - math.log(2 * math.pi) - 3 * math.log(100) - math.log((60 - 36) / 100**2))
        self.assertAlmostEqual(score_nat, by_hand, 9)

    def test_a_plot_beside_the_line_and_a_missed_scan_cost(self):
        t_s, places = 2.0 * np.arange(7), np.outer(2.0 * np.arange(7), [200.0, 0.0])
        density = np.full(7, 1e-6)
        score_nat = oracle_fit.fit(MODEL, t_s, places, density)[1]
        off = places.copy()
        off[3, 1] = 20.0  # in the middle of seven: 6/7 of its square remain
        self.assertAlmostEqual(oracle_fit.fit(MODEL, t_s, off, density)[1],
                               score_nat - 0.5 * (20 / 10)**2 * 6 / 7, 9)
        longer = MODEL._replace(scans=8)
        self.assertAlmostEqual(oracle_fit.fit(longer, t_s, places, density)[1],
                               score_nat + math.log(1 - 0.9), 9)

    def test_process_noise_is_that_of_wandering_targets(self):
        """Covariance of places by the sum over many paths."""
        rng, model = np.random.default_rng(1), MODEL._replace(process_noise_mps2=5.0)
        paths = np.concatenate([paper.wandering([(0, 200, 0, 0)] * 500, 10.0, rng)
                                for _ in range(20)], axis=1)
        x_m = paths[:, :, 0] - 200 * 2.0 * np.arange(7)[:, None]
        expected = oracle_fit.covariance_m2(model, 2.0 * np.arange(7)) - 100 * np.eye(7)
        np.testing.assert_allclose(np.cov(x_m), expected, rtol=0.06, atol=30)

    def test_chi_square_of_its_own_plots_is_that_of_the_model(self):
        """Scores of noise alone are the noise-free score less half of a chi-square of 10."""
        rng, t_s = np.random.default_rng(2), 2.0 * np.arange(7)
        places, density = np.outer(t_s, [200.0, 0.0]), np.full(7, 1e-6)
        best = oracle_fit.fit(MODEL, t_s, places, density)[1]
        chi2 = [2 * (best - oracle_fit.fit(
            MODEL, t_s, places + rng.normal(0, 10, (7, 2)), density)[1]) for _ in range(400)]
        self.assertTrue(abs(np.mean(chi2) - 10) < 4 * math.sqrt(20 / 400), np.mean(chi2))


class Paths(unittest.TestCase):
    def test_places_after_six_scans(self):
        np.testing.assert_allclose(paper.straight(paper.TABLE_1)[6],
                                   [[3660, 988], [921.6, -900], [21.6, 100]])
        np.testing.assert_allclose(paper.accelerating((0, 240, 0, 70), 10)[6, 0],
                                   np.array([240, 70]) / 250 * (250 * 12 + 5 * 144))
        turned = paper.turning((0, 250, 0, 0), math.pi / 2)[:, 0]
        np.testing.assert_allclose(turned[:3], [[0, 0], [0, 500], [-500, 500]], atol=1e-9)
        np.testing.assert_allclose(turned[4:], turned[:3], atol=1e-9)  # and round again

    def test_plots_are_as_many_as_said(self):
        rng, paths = np.random.default_rng(3), paper.straight(paper.TABLE_1)
        scans = [scan for _ in range(100) for scan in paper.observed(
            paths, 10.0, 0.9, [(paper.TABLE_1_BOX_M, 20.0)], rng)]
        seen = np.mean([np.sum(target >= 0) for _, target in scans])
        clutter = np.mean([np.sum(target < 0) for _, target in scans])
        self.assertTrue(abs(seen - 2.7) < 4 * math.sqrt(0.27 / 700), seen)
        self.assertTrue(abs(clutter - 20) < 4 * math.sqrt(20 / 700), clutter)
        off = np.concatenate([places[target == 0] - paths[k % 7, 0]
                              for k, (places, target) in enumerate(scans)])
        self.assertTrue(abs(off.std() / 10 - 1) < 4 / math.sqrt(2 * off.size), off.std())


class Matching(unittest.TestCase):
    def test_one_track_is_one_targets(self):
        paths = paper.straight([(0, 100, 0, 0), (0, 100, 30, 0)])
        tracks = np.array([(1200, 10, 100, 0), (1200, 5, 100, 0), (1200, 500, 100, 0)],
                          [(name, "f4") for name in ("x_m", "y_m", "vx_mps", "vy_mps")])
        np.testing.assert_allclose(initiation.matched_errors(paths, tracks, 2.0, 30.0), [5, 20])
        np.testing.assert_allclose(initiation.matched_errors(paths, tracks[2:], 2.0, 30.0), [])


class EndToEnd(unittest.TestCase):
    def test_tables_pictures_and_json(self):
        with lab_test_setup.folder() as folder:
            def run(*arguments):
                done = subprocess.run([str(SCRIPT), "--runs", "1", "-o", folder, *arguments],
                                      capture_output=True, text=True, check=False)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                return done.stdout

            report = json.loads(run("--json"))
            self.assertEqual(len(report["cases"]), len(initiation.CASES))
            self.assertEqual(len(report["bars"]), 70)
            self.assertEqual(report["bars_held"],
                             sum(bar["held"] for bar in report["bars"]))
            text = run("--jobs", "1")
            self.assertRegex(text, r"(?m)^Table 3, 100 clutter plots a scan +B2 +1\.000")
            page = (folder / "index.html").read_text()
            for name in ("example", "found", "false"):
                self.assertIn(f'src="{name}.svg"', page)
                self.assertGreater((folder / f"{name}.svg").stat().st_size, 10000)
            of = {case["case"]: case["pd"] for case in report["cases"]}
            for case in initiation.CASES[:3]:
                name = re.escape(case.name)
                self.assertRegex(text, rf"(?m)^{name} .* {of[case.name]:.3f} ")


if __name__ == "__main__":
    lab_test_setup.main()
