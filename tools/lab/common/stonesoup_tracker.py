# SPDX-License-Identifier: MIT
"""Stone Soup on the plots that rhotrack gets: its multi-measurement initiator, and its global
nearest neighbour (gnn) or its joint probabilistic data association (jpda).

`make bench-stonesoup` installs the package stonesoup in build/stonesoup, for Debian's interpreter.
"""
import datetime
import math
import sys
import time

import numpy as np

from common import experiment

sys.path += map(str, (experiment.BUILD / "stonesoup" / "lib").glob("python3.*/site-packages"))

METHODS = ("gnn", "jpda")
EPOCH = datetime.datetime(2000, 1, 1)
POSITION = [0, 2]  # of the state x, vx, y, vy; a list, as numpy takes a tuple for two dimensions

# Chosen by GOSPA (cutoff 1 km) on scene air-traffic, 50 aircraft and 100 false plots a scan, seed
# 3, 60 scans, one setting at a time; figures are GOSPA in m, completeness, false tracks a scan.
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
PROCESS_NOISE = 200.0  # m^2/s^3: power density of the acceleration, each axis
PD, SIGMA_M = 0.95, 50.0
VELOCITY_SIGMA_MPS = 100.0  # of a track's first state, each axis
GATE = 3.5  # sigmas: plots within belong to a track (gnn), or have its probability (jpda)
MIN_POINTS = 3  # plots that the initiator wants before it releases a track
HOLD_MISSES, MISSES = 1, 3  # in a row, that end a track in the initiator, and later
LOST_SIGMA_M = 1000.0  # a place less certain than this ends a track

TRACK = [("t_s", "f8"), ("track_id", "u4"), ("x_m", "f8"), ("y_m", "f8"), ("vx_mps", "f8"),
         ("vy_mps", "f8"), ("cov_x_x", "f8"), ("cov_y_x", "f8"), ("cov_y_y", "f8"),
         ("cov_vx_vx", "f8"), ("cov_vy_vx", "f8"), ("cov_vy_vy", "f8")]


def is_installed():
    try:
        import stonesoup  # noqa: F401
    except ImportError:
        return False
    return True


def density_of(scans):
    """Plots a scan and square metre; targets are few beside clutter, so all are taken for it."""
    places_m = np.concatenate([plots for _, plots in scans])
    return len(places_m) / len(scans) / max(np.prod(np.ptp(places_m, axis=0)), 1.0)


def make_tracker(method, scans):
    """The tracker, ready to be stepped scan by scan."""
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
    from stonesoup.models.transition.linear import (CombinedLinearGaussianTransitionModel,
                                                    ConstantVelocity)
    from stonesoup.predictor.kalman import KalmanPredictor
    from stonesoup.models.measurement.linear import LinearGaussian
    from stonesoup.tracker.simple import MultiTargetMixtureTracker, MultiTargetTracker
    from stonesoup.types.detection import Detection
    from stonesoup.types.state import GaussianState
    from stonesoup.updater.kalman import KalmanUpdater

    class KdTreeJpda(DetectionKDTreeMixIn, JPDAwithEHM2):
        """Efficient hypothesis management, on the plots that the tree finds near a track."""

    model = LinearGaussian(ndim_state=4, mapping=POSITION,
                           noise_covar=np.eye(2) * SIGMA_M**2)
    predictor = KalmanPredictor(
        CombinedLinearGaussianTransitionModel([ConstantVelocity(PROCESS_NOISE)] * 2))
    updater = KalmanUpdater(model)
    distance = DistanceHypothesiser(predictor, updater, Mahalanobis(),
                                    missed_distance=GATE)
    tree = {"predictor": predictor, "updater": updater, "max_distance": reach_m(scans)}
    gnn = DetectionKDTreeGNN2D(distance, **tree)

    def ends(misses):
        return CompositeDeleter([
            UpdateTimeStepsDeleter(misses),
            CovarianceBasedDeleter(2 * LOST_SIGMA_M**2, mapping=POSITION)
        ], intersect=False)

    prior = GaussianState(np.zeros((4, 1)), np.diag([0, VELOCITY_SIGMA_MPS**2] * 2),
                          timestamp=EPOCH)
    initiator = MultiMeasurementInitiator(prior, UpdateTimeStepsDeleter(
        HOLD_MISSES), gnn, updater, measurement_model=model,
                                          min_points=MIN_POINTS)
    detector = [(moment, {
        Detection(np.array([[x_m], [y_m]]), timestamp=moment, measurement_model=model)
        for x_m, y_m in plots
    }) for moment, plots in ((EPOCH + datetime.timedelta(seconds=float(t_s)), plots)
                             for t_s, plots in scans)]
    if method == "gnn":
        return MultiTargetTracker(initiator, ends(MISSES), detector, gnn, updater)
    probability = PDAHypothesiser(predictor, updater, clutter_spatial_density=density_of(scans),
                                  prob_detect=PD, prob_gate=chi2.cdf(GATE**2, 2))
    return MultiTargetMixtureTracker(initiator, ends(MISSES), detector,
                                     KdTreeJpda(probability, **tree), updater)


def reach_m(scans):
    """How far the tree looks for a track's plots: no gate is wider before its misses end a
    track."""
    times = [t_s for t_s, _ in scans]
    steps = sorted(b - a for a, b in zip(times, times[1:])) or [0.0]
    step = steps[len(steps) // 2]
    of_start_m = VELOCITY_SIGMA_MPS * step * HOLD_MISSES
    of_noise_m = math.sqrt(PROCESS_NOISE * (step * MISSES) ** 3 / 3)
    return GATE * (of_start_m + of_noise_m + 2 * SIGMA_M)


def track(scans, method):
    """Tracks of each scan (t_s, places), rows as the package has them, and the mean of the
    processor's time, ms: association, update and initiation."""
    steps = iter(make_tracker(method, scans))
    numbers, reports, times_ms = {}, [], []
    for t_s, _ in scans:
        start = time.process_time()
        _, tracks = next(steps)
        times_ms.append((time.process_time() - start) * 1e3)
        rows = []
        for one in tracks:
            x_m, vx_mps, y_m, vy_mps = (float(value) for value in one.state_vector.ravel())
            cov = np.asarray(one.covar, float)
            rows.append((t_s, numbers.setdefault(one.id, len(numbers) + 1), x_m, y_m, vx_mps,
                         vy_mps, cov[0, 0], cov[2, 0], cov[2, 2], cov[1, 1], cov[3, 1], cov[3, 3]))
        reports.append(np.array(rows, TRACK))
    return reports, float(np.mean(times_ms))
