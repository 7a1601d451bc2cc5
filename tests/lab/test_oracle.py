#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The oracle on plots that are made here: its starts and ends, and its errors against those of the
least squares."""
import math
import pathlib
import tempfile
import unittest

import lab_test_setup

lab_test_setup.need_packages()

import numpy as np

from common import oracle
from common import scene_files
from common import scoring

INI = """# a radar
scan_interval_s = 4
v_max_mps = 350
[sensor 1]
range_max_m = 100000
sigma_range_m = 30
sigma_azimuth_rad = 0.003
"""


def scene(folder, path, misses, scans=40, noise=0.0, seed=1, second=None, dead_from=None):
    """A target on path(t_s) -> (x, y), unseen in the scans of `misses`, as files; `second`: plots
    that far off, too."""
    random = np.random.default_rng(seed)
    plots = ["t_s,sensor_id,range_m,azimuth_rad,target_id"]
    truth = ["t_s,target_id,x_m,y_m,vx_mps,vy_mps,is_covered"]
    for k in range(scans):
        t = 4.0 * k
        plots.append(f"{t:.6f},1,,,-1")
        plots.append(f"{t:.6f},1,{random.uniform(1e3, 1e5):.2f},{random.uniform(-3, 0):.7f},-1")
        x, y = path(t)
        if dead_from is not None and k >= dead_from:
            continue
        later = path(t + 0.01)
        truth.append(
            f"{t:.6f},7,{x:.3f},{y:.3f},{(later[0] - x) / 0.01:.4f},{(later[1] - y) / 0.01:.4f},1")
        if k not in misses:
            t += 2.0
            x, y = path(t)
            range_m, azimuth = math.hypot(x, y), math.atan2(y, x)
            if second:
                plots.append(f"{t:.6f},1,{range_m + second:.4f},{azimuth:.9f},7")
            plots.append(f"{t:.6f},1,{range_m + noise * 30 * random.normal():.4f},"
                         f"{azimuth + noise * 0.003 * random.normal():.9f},7")
    folder = pathlib.Path(folder)
    (folder / "scenario.ini").write_text(INI)
    (folder / "plots.csv").write_text("\n".join(plots) + "\n")
    (folder / "paths.csv").write_text("\n".join(truth) + "\n")
    settings = scene_files.Settings(folder / "scenario.ini")
    sensors = settings.sensors()
    read = scene_files.read_plots(folder / "plots.csv", sensors, settings.get(
        "scan_interval_s", 0.0))
    return sensors, read, scene_files.read_truth(folder, read.scan_times_us)


def straight(t):
    return 20000 + 100 * t, 30000 - 50 * t


class Oracle(unittest.TestCase):
    def follow(self, path, misses=(), candidates=((0.1,),), **more):
        with tempfile.TemporaryDirectory() as folder:
            sensors, plots, truth = scene(folder, path, misses, **more)
        followed = oracle.follow(plots, truth, sensors, list(candidates), 350.0)
        return followed, truth, scoring.score(truth, oracle.as_tracks(truth, followed),
                                              scoring.gate_m(sensors))[0]

    def scans_of(self, **more):
        followed, truth, _ = self.follow(straight, **more)
        return truth.scan_of(followed[0]).tolist(), followed[1].tolist()

    def test_it_starts_with_the_third_hit_of_five(self):
        self.assertEqual(self.scans_of()[0][0], 2)
        self.assertEqual(self.scans_of(misses={1, 3})[0][0], 4)
        self.assertEqual(self.scans_of(misses={1, 3, 4})[0][0], 6)

    def test_it_ends_with_the_fifth_miss(self):
        scans, tracks = self.scans_of(misses=set(range(10, 15)))
        self.assertEqual(scans, [*range(2, 14), *range(17, 40)])
        self.assertEqual(len(set(tracks)), 2)
        self.assertEqual(len(set(self.scans_of(misses=set(range(10, 14)))[1])), 1)

    def test_it_ends_after_its_target(self):
        self.assertEqual(self.scans_of(dead_from=20)[0], list(range(2, 24)))

    def test_scans_are_read_as_the_program_reads_them(self):
        with tempfile.TemporaryDirectory() as folder:
            _, plots, truth = scene(folder, straight, ())
        self.assertEqual(plots.scan_times_us.tolist(), [4000000 * k for k in range(40)])
        self.assertEqual(len(truth.times_us), 40)

    def test_exact_plots_give_the_exact_place(self):
        _, _, figures = self.follow(straight)
        self.assertLess(figures["rms_m"], 2)
        self.assertEqual((figures["false_per_scan"], figures["switches"]), (0, 0))
        self.assertEqual(figures["completeness"], 38 / 40)

    def test_of_two_plots_the_own_one_counts(self):
        self.assertLess(self.follow(straight, second=500.0)[2]["rms_m"], 2)

    def test_a_straight_target_as_a_fit_through_all_its_plots_would(self):
        squares, expected = [], []
        for seed in range(40):
            followed, truth, _ = self.follow(straight, noise=1.0, seed=seed, candidates=[(1e-4,)])
            last = followed[3][0, -1] - truth.place_m[-1, 0]
            squares.append(last @ last)
        # the variance of a line's end, fitted to n points: (4 n - 2) / (n (n + 1)) of a point's,
        # extrapolated by half a scan backwards; across, sigma is 3 mrad times 32 to 44 km
        n, across = 40, 0.003 * np.mean([math.hypot(*straight(4.0 * k)) for k in range(40)])
        centre, spread = (n - 1) / 2, (n * n - 1) / 12
        expected = (30 ** 2 + across ** 2) / n * (1 + (n - 1.5 - centre) ** 2 / spread)
        self.assertLess(abs(np.mean(squares) / expected - 1),
                        0.5)  # 40 runs: .16 to a standard error

    def test_it_says_how_far_it_may_be_off(self):
        """Where targets do as the model says, errors are as its covariances state, of a Kalman
        filter and of an IMM of two equal ones."""
        for candidate in ((1e-4,), (1e-4, 1e-4, 60.0)):
            with self.subTest(candidate=candidate):
                figures = [
                    self.follow(straight, misses={20, 21, 30}, noise=1.0, seed=seed,
                                candidates=[candidate])[2] for seed in range(60)
                ]
                mean = {
                    key: np.mean([run[key] for run in figures])
                    for key in figures[0] if key.startswith(("nees", "inside"))
                }
                for key in ("place", "velocity"):
                    # 60 independent runs of two axes: .09 to a standard error; coasting has three
                    # scans a run of the 38
                    self.assertTrue(0.75 < mean["nees_" + key] < 1.25, mean)
                    self.assertTrue(0.9 < mean["inside_" + key] < 0.99, mean)
                self.assertTrue(0.7 < mean["nees_place_coasting"] < 1.3, mean)

    def test_noise_that_suits_is_best(self):
        def turning(t):
            return 30000 + 4000 * math.cos(t / 20), 4000 * math.sin(t / 20)  # 10 m/s^2

        def best(path):
            sums = 0
            for seed in range(4):
                followed, truth, _ = self.follow(path, noise=1.0, seed=seed,
                                                 candidates=oracle.CANDIDATES)
                sums = sums + oracle.square_errors(truth, followed)
            return oracle.CANDIDATES[int(np.argmin(sums[:, 0]))]

        self.assertLess(best(straight)[0], 0.2)
        self.assertGreater(max(best(turning)[:2]), 2)

    def test_the_imm_is_quiet_on_the_line_and_follows_the_turn(self):
        def bent(t):
            if t < 100:
                return 25000 + 200 * t, 10000.0
            angle = (t - 100) / 20
            return 45000 + 4000 * math.sin(angle), 10000 + 4000 * (1 - math.cos(angle))

        rms = {}
        for candidate in ((0.03,), (10.0,), (0.03, 10.0, 60.0)):
            sums = 0
            for seed in range(10):
                followed, truth, _ = self.follow(bent, noise=1.0, seed=seed, candidates=[candidate])
                sums = sums + oracle.square_errors(truth, followed)[0]
            rms[candidate] = math.sqrt(sums[0] / sums[1])
        self.assertLess(rms[(0.03, 10.0, 60.0)], min(rms[(0.03,)], rms[(10.0,)]))


if __name__ == "__main__":
    lab_test_setup.main()
