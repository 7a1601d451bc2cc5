#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Stone Soup on the plots that `rhotrack track` gets: what its multi-target tracker is compared
with.

Usage: air_traffic_stonesoup.py PLOTS_CSV -o TRACKS_CSV --method gnn|jpda [settings]

Plots in the plane (t_s,sensor_id,x_m,y_m; rows of one t_s are a scan, a row without a place is a
scan that saw nothing) go through Stone Soup's multi-measurement initiator and its global nearest
neighbour or its joint probabilistic data association; tracks come out in the format that `rhotrack
evaluate` reads, one row a track and scan. One JSON object with times and settings goes to standard
output. Exit codes: 0; 1: the output cannot be written; 2: bad usage or input; 3: the Python package
stonesoup is not installed.
"""
import argparse
import csv
import datetime
import functools
import json
import math
import os
import sys
import time

NAME = os.path.basename(__file__)
EPOCH = datetime.datetime(2000, 1, 1)
POSITION = [0, 2]  # of the state x, vx, y, vy; a list, as numpy takes a tuple for two dimensions
COLUMNS = "t_s,track_id,status,x_m,y_m,vx_mps,vy_mps,sigma_m,sigma_mps,hits,misses".split(",")


def fail(code, message):
    sys.stderr.write(f"{NAME}: {message}\n")
    sys.exit(code)


# The defaults were chosen by GOSPA (cutoff 1 km) on scenario air-traffic, 50 aircraft and 100 false
# plots a scan, seed 3, 60 scans, one setting at a time; figures are GOSPA in m, completeness, false
# tracks a scan.
#   all at gnn, process_noise 200, velocity_sigma 150, gate 4, min_points 3, hold_misses 2, misses
#   2: 1564 .938 1.10
#   process_noise     50: 1603 .930  .70   100: 1519 .938 .83   400: 1663 .937 1.68
#   velocity_sigma   100: 1512 .938  .78   200: 1569 .936 1.03
#   gate               3: 1493 .938  .67     5: 1656 .936 1.60
#   min_points         2: 4000 .967 29.6     4: 1674 .910  .40
#   hold_misses        1: 1464 .937  .43
#   misses             1: 2330 .798  .35     3: 1572 .946 1.50
#   lost_sigma_m     500: the same
#   squared distances, or the probabilities of JPDA, as GNN's costs (process_noise 100): 1520 .938
#   .83; 1517 .938 .82 Together, with hold_misses 1:
#   process_noise 100, misses 2 or 3: 1463 .937 .43; 1471 .945 .87; process_noise 200, misses 3:
#   1473 .944 .82
#   process_noise 200, velocity_sigma 100, gate 3.5, misses 2 or 3: 1464 .937 .43; 1461 .944 .75,
#   with 9 and 2 switches
#   the same with process_noise 400, misses 3: 1482 .936 .48
#   the same by jpda, misses 2 or 3: 1461 .937 .42; 1459 .944 .73; its pd (.9 to .98) changes
#   nothing With 1000 false plots a scan min_points 4 is better.


def options():
    parser = argparse.ArgumentParser(prog=NAME, description=__doc__.split("\n\n")[2],
                                     formatter_class=argparse.ArgumentDefaultsHelpFormatter)

    def add(name, kind, default, unit, text):
        parser.add_argument(name, type=kind, default=default, metavar=unit, help=text)

    parser.add_argument("plots", metavar="PLOTS_CSV")
    parser.add_argument("-o", "--output", metavar="TRACKS_CSV", required=True,
                        help="appears when it is complete")
    parser.add_argument("--method", choices=("gnn", "jpda"), required=True)
    add("--process-noise", float, 200.0, "M2/S3", "power density of the acceleration, each axis")
    add("--pd", float, 0.95, "P", "assumed probability of detection")
    add("--sigma-m", float, 50.0, "M", "position noise of a plot, each axis")
    add("--clutter-density", float, None, "1/M2",
        "false plots a scan and area; None: all plots over the area")
    add("--area", float, None, "M2", "where plots come from; None: the rectangle around them")
    add("--velocity-sigma", float, 100.0, "M/S", "of a track's first state, each axis")
    add("--gate", float, 3.5, "SIGMAS",
        "plots within it belong to a track (gnn), or have its probability (jpda)")
    add("--scans", int, None, "K", "only the first of the file; None: all")
    add("--min-points", int, 3, "M", "plots that the initiator wants before it releases a track")
    add("--hold-misses", int, 1, "N", "misses in a row that end a track in the initiator")
    add("--misses", int, 3, "N", "misses in a row that end a track")
    add("--lost-sigma-m", float, 1000.0, "M", "a place less certain than this ends a track")
    parser.add_argument(
        "--keep", action="store_true", help=
        "matrices and predictions are kept, which Stone Soup itself does not: the same tracks, sooner"
    )
    return parser.parse_args()


# --- files


def number(path, line, row, column):
    try:
        value = float(row[column])
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        fail(2, f"{path}:{line}: {column} is not a number: '{row[column]}'")
    return value


def numbered_rows(path):
    """Rows by column name, with their line numbers; lines that begin with # are comments."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            lines = [(n, line) for n, line in enumerate(file, 1)
                     if line.strip() and not line.startswith("#")]
    except (OSError, UnicodeDecodeError) as error:
        fail(2, f"{path}: {error}")
    table = csv.DictReader(line for _, line in lines)
    for column in ("t_s", "x_m", "y_m"):
        if column not in (table.fieldnames or []):
            fail(2, f"{path}:1: no column {column}")
    return zip((n for n, _ in lines[1:]), table)


def read_scans(path, most):
    """[(t_s as it was written, [(x_m, y_m)])] in the order of time."""
    scans = []
    for line, row in numbered_rows(path):
        t_s = number(path, line, row, "t_s")
        if scans and t_s < float(scans[-1][0]):
            fail(2, f"{path}:{line}: t_s goes back")
        if not scans or t_s > float(scans[-1][0]):
            if len(scans) == most:
                break
            scans.append((row["t_s"], []))
        if row["x_m"] or row["y_m"]:
            scans[-1][1].append((number(path, line, row, "x_m"), number(path, line, row, "y_m")))
    if not any(plots for _, plots in scans):
        fail(2, f"{path}: no plots")
    return scans


def write_tracks(path, rows):
    beside = f"{path}.part"
    try:
        with open(beside, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            writer.writerows(rows)
        os.replace(beside, path)
    except OSError as error:
        fail(1, f"{path}: {error.strerror}")


def density_of(settings, scans):
    """False plots a scan and square metre; targets are few beside them, so all plots are taken for
    false."""
    if settings.clutter_density is not None:
        return settings.clutter_density
    area_m2 = settings.area
    if area_m2 is None:
        xs, ys = zip(*(plot for _, plots in scans for plot in plots))
        area_m2 = max((max(xs) - min(xs)) * (max(ys) - min(ys)), 1.0)
    return sum(len(plots) for _, plots in scans) / len(scans) / area_m2


# --- Stone Soup


def make_predictor(settings):
    """Stone Soup's own, or one that keeps what it has computed: the same tracks, sooner."""
    from stonesoup.models.transition.linear import CombinedLinearGaussianTransitionModel, ConstantVelocity
    from stonesoup.predictor.kalman import KalmanPredictor

    class KeptModel(CombinedLinearGaussianTransitionModel):
        """The matrices of each time interval are made once."""

        @functools.lru_cache
        def matrix(self, time_interval, **_):
            return super().matrix(time_interval=time_interval)

        @functools.lru_cache
        def covar(self, time_interval, **_):
            return super().covar(time_interval=time_interval)

    class KeptPredictor(KalmanPredictor):
        """Tree and hypothesiser ask for the same predictions; Stone Soup's cache holds those of 128
        tracks."""

        def predict(self, prior, timestamp=None, **_):
            return self.predict_state(getattr(prior, "state", prior), timestamp)

        @functools.lru_cache(maxsize=16384)
        def predict_state(self, prior, timestamp):
            return super().predict(prior, timestamp)

    model, predictor = CombinedLinearGaussianTransitionModel, KalmanPredictor
    if settings.keep:
        model, predictor = KeptModel, KeptPredictor
    return predictor(model([ConstantVelocity(settings.process_noise)] * 2))


def make_tracker(settings, scans, density):
    """The tracker, ready to be stepped scan by scan."""
    import numpy as np
    from scipy.stats import chi2
    from stonesoup.dataassociator.probability import JPDAwithEHM2
    from stonesoup.dataassociator.tree import DetectionKDTreeGNN2D, DetectionKDTreeMixIn
    from stonesoup.deleter.error import CovarianceBasedDeleter
    from stonesoup.deleter.multi import CompositeDeleter
    from stonesoup.deleter.time import UpdateTimeStepsDeleter
    from stonesoup.hypothesiser.distance import DistanceHypothesiser
    from stonesoup.hypothesiser.probability import PDAHypothesiser
    from stonesoup.initiator.simple import MultiMeasurementInitiator
    from stonesoup.measures import Mahalanobis
    from stonesoup.models.measurement.linear import LinearGaussian
    from stonesoup.tracker.simple import MultiTargetMixtureTracker, MultiTargetTracker
    from stonesoup.types.detection import Detection
    from stonesoup.types.state import GaussianState
    from stonesoup.updater.kalman import KalmanUpdater

    class KdTreeJpda(DetectionKDTreeMixIn, JPDAwithEHM2):
        """Efficient hypothesis management, on the plots that the tree finds near a track."""

    model = LinearGaussian(ndim_state=4, mapping=POSITION,
                           noise_covar=np.eye(2) * settings.sigma_m**2)
    predictor = make_predictor(settings)
    updater = KalmanUpdater(model)
    distance = DistanceHypothesiser(predictor, updater, Mahalanobis(),
                                    missed_distance=settings.gate)
    tree = {"predictor": predictor, "updater": updater, "max_distance": reach_m(settings, scans)}
    gnn = DetectionKDTreeGNN2D(distance, **tree)

    def ends(misses):
        return CompositeDeleter([
            UpdateTimeStepsDeleter(misses),
            CovarianceBasedDeleter(2 * settings.lost_sigma_m**2, mapping=POSITION)
        ], intersect=False)

    prior = GaussianState(np.zeros((4, 1)), np.diag([0, settings.velocity_sigma**2] * 2),
                          timestamp=EPOCH)
    initiator = MultiMeasurementInitiator(prior, UpdateTimeStepsDeleter(
        settings.hold_misses), gnn, updater, measurement_model=model,
                                          min_points=settings.min_points)
    detector = [(moment, {
        Detection(np.array([[x_m], [y_m]]), timestamp=moment, measurement_model=model)
        for x_m, y_m in plots
    }) for moment, plots in ((EPOCH + datetime.timedelta(seconds=float(t_s)), plots)
                             for t_s, plots in scans)]
    if settings.method == "gnn":
        return MultiTargetTracker(initiator, ends(settings.misses), detector, gnn, updater)
    probability = PDAHypothesiser(predictor, updater, clutter_spatial_density=density,
                                  prob_detect=settings.pd, prob_gate=chi2.cdf(settings.gate**2, 2))
    return MultiTargetMixtureTracker(initiator, ends(settings.misses), detector,
                                     KdTreeJpda(probability, **tree), updater)


def reach_m(settings, scans):
    """How far the tree looks for a track's plots: no gate is wider before its misses end a
    track."""
    times = [float(t_s) for t_s, _ in scans]
    steps = sorted(b - a for a, b in zip(times, times[1:])) or [0.0]
    step = steps[len(steps) // 2]
    of_start_m = settings.velocity_sigma * step * settings.hold_misses
    of_noise_m = math.sqrt(settings.process_noise * (step * settings.misses) ** 3 / 3)
    return settings.gate * (of_start_m + of_noise_m + 2 * settings.sigma_m)


class Rows:
    """The tracks file: tracks are numbered in the order in which the initiator released them."""

    def __init__(self):
        self.rows, self.numbers, self.counts = [], {}, {}

    def add(self, t_s, tracks, update_type):
        for track in sorted(
                tracks, key=lambda t: (self.numbers.get(t.id, math.inf), *t.state_vector.ravel())):
            known = self.numbers.setdefault(track.id, len(self.numbers) + 1)
            seen = isinstance(track.state, update_type)
            hits, misses = self.counts.get(known, (len(track) - 1, 0))
            self.counts[known] = hits, misses = (hits + seen, misses + (not seen))
            x, vx, y, vy = (float(value) for value in track.state_vector.ravel())
            var = track.covar.diagonal()
            self.rows.append(
                (t_s, known, "confirmed" if seen else "coasting", f"{x:.3f}", f"{y:.3f}",
                 f"{vx:.4f}", f"{vy:.4f}", f"{math.sqrt((var[0] + var[2]) / 2):.3f}",
                 f"{math.sqrt((var[1] + var[3]) / 2):.4f}", hits, misses))


def run(settings, scans, density):
    """Rows of the tracks file, and each scan's time in ms: association, update and initiation,
    without files.

    It is the processor's time, in which other programs on the machine do not count.
    """
    from stonesoup.types.update import Update
    steps = iter(make_tracker(settings, scans, density))
    rows, times_ms = Rows(), []
    for t_s, _ in scans:
        start = time.process_time()
        _, tracks = next(steps)
        times_ms.append((time.process_time() - start) * 1e3)
        rows.add(t_s, tracks, Update)
    return rows, times_ms


def main():
    settings = options()
    scans = read_scans(settings.plots, settings.scans)
    try:
        import stonesoup
    except ImportError as error:
        fail(
            3,
            f"the Python package stonesoup is not installed ({error}); `make bench-stonesoup` installs it"
        )
    density = density_of(settings, scans)
    rows, times_ms = run(settings, scans, density)
    write_tracks(settings.output, rows.rows)
    values = {
        name: value
        for name, value in vars(settings).items() if name not in ("plots", "output", "method")
    }
    json.dump(
        {
            "method": settings.method, "scans": len(scans), "plots": sum(
                len(plots)
                for _, plots in scans), "mean_ms": round(sum(times_ms) / len(times_ms), 3),
            "max_ms": round(max(times_ms), 3), "tracks": len(rows.numbers),
            "stonesoup": stonesoup.__version__, "settings": values | {"clutter_density": density}
        }, sys.stdout)
    print()


if __name__ == "__main__":
    main()
