# SPDX-License-Identifier: MIT
"""Stone Soup on targets that give several plots a scan: its trackers of points, behind DBSCAN.

Stone Soup 1.9.1 has no tracker of extended targets and no feeder that clusters plots. Its PMHT
tracker alone grants a target several plots, but wants the targets' number and first states told. So
plots are clustered here, and clusters' centroids go to its Kalman filter of constant velocity, its
initiator, and its global nearest neighbours (gnn) or joint probabilistic data association (jpda).
"""
import dataclasses
import datetime
import functools
import time

import numpy as np

from common import stonesoup_tracker
from parts.ti_group_tracker import TRACK

EPOCH, METHODS = stonesoup_tracker.EPOCH, stonesoup_tracker.METHODS
POSITION = [0, 2]  # of the state x, vx, y, vy
PD = 0.95  # of a cluster, for JPDA


@dataclasses.dataclass(frozen=True)
class Settings:
    sigmas: tuple  # of a plot: range in m, azimuth in rad[, range rate in m/s]
    reach_m: float  # of DBSCAN
    reach_mps: float  # range rates that differ by so much are as far apart as places by reach_m
    min_points: int  # of a cluster
    centre_m: float  # of a cluster's centroid about the target's, one sigma
    centre_mps: float
    process_noise: float  # m^2/s^3
    speed_mps: float  # of a track's first state, one sigma
    gate: float  # sigmas
    clutter: float  # clusters of no target a scan and m^2 [m^3/s], for JPDA
    hits: int = 3  # clusters before a track is reported
    lost_new: int = 2  # scans without a cluster that end it before,
    lost: int = 20  # and later
    lost_m: float = 10.0  # a place less certain than this ends a track


def dbscan(points, reach, min_points):
    """The cluster of each point, -1 for noise. Points with min_points within reach, themselves
    counted, join clusters; others within reach of one belong to the nearest such point's."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial.distance import cdist
    if not len(points):
        return np.zeros(0, int)
    apart = cdist(points, points)
    is_core = (apart <= reach).sum(axis=1) >= min_points
    joined = (apart <= reach) & is_core & is_core[:, None]
    labels = connected_components(coo_matrix(joined), directed=False)[1]
    to_core = np.where(is_core, apart, np.inf)
    labels = np.where(to_core.min(axis=1) <= reach, labels[to_core.argmin(axis=1)], -1)
    return np.unique(labels, return_inverse=True)[1] - int((labels < 0).any())


def clusters(plots, times_s, settings):
    """(x, y[, range rate]), time and number of plots of each cluster."""
    places = plots[:, :1] * np.column_stack([np.cos(plots[:, 1]), np.sin(plots[:, 1])])
    points = places / settings.reach_m
    if plots.shape[1] > 2:
        points = np.column_stack([points, plots[:, 2] / settings.reach_mps])
    labels = dbscan(points, 1.0, settings.min_points)
    return [(np.array([*places[mine].mean(axis=0), *plots[mine, 2:].mean(axis=0)]),
             times_s[mine].mean(), mine.sum())
            for mine in (labels == label for label in range(labels.max(initial=-1) + 1))]


@functools.cache
def model_class():
    """A linear model that has the range rate, too, along the direction in which a cluster is."""
    from stonesoup.base import Property
    from stonesoup.models.measurement.linear import LinearGaussian

    class Seen(LinearGaussian):
        outwards: np.ndarray = Property(doc="Unit vector to the cluster")

        @property
        def ndim_meas(self):
            return len(self.noise_covar)

        def matrix(self, **kwargs):
            rows = np.zeros((3, 4))
            rows[0, 0] = rows[1, 2] = 1
            rows[2, 1::2] = self.outwards
            return rows[:self.ndim_meas]

    return Seen


def model_of(seen, count, settings):
    """The measurement's model of a cluster: its noise is of the plots and of the body."""
    range_m = np.hypot(*seen[:2])
    c, s = outwards = seen[:2] / range_m
    axes = np.array([[c, -s], [s, c]])
    sigmas = np.array(settings.sigmas) * [1, range_m, 1][:len(seen)]
    variance = sigmas**2 / count + np.square(
        [settings.centre_m, settings.centre_m, settings.centre_mps][:len(seen)])
    noise = np.diag(variance)
    noise[:2, :2] = axes @ noise[:2, :2] @ axes.T
    return model_class()(4, POSITION, noise, outwards=outwards)


def moment_of(t_s):
    return EPOCH + datetime.timedelta(seconds=float(t_s))


class Chain:
    """The tracker of a method, which is stepped scan by scan."""

    def __init__(self, method, settings):
        from scipy.stats import chi2
        from stonesoup.dataassociator.neighbour import GNNWith2DAssignment
        from stonesoup.dataassociator.probability import JPDAwithEHM2
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
        from stonesoup.tracker.simple import MultiTargetMixtureTracker, MultiTargetTracker
        from stonesoup.types.state import GaussianState
        from stonesoup.updater.kalman import KalmanUpdater

        self.settings, self.numbers = settings, {}
        self.predictor, updater = KalmanPredictor(CombinedLinearGaussianTransitionModel(
            [ConstantVelocity(settings.process_noise)] * 2)), KalmanUpdater(None)
        gnn = GNNWith2DAssignment(DistanceHypothesiser(
            self.predictor, updater, Mahalanobis(), missed_distance=settings.gate))
        prior = GaussianState(np.zeros((4, 1)), np.diag([0, settings.speed_mps**2] * 2),
                              timestamp=EPOCH)
        begin = MultiMeasurementInitiator(prior, UpdateTimeStepsDeleter(settings.lost_new), gnn,
                                          updater, min_points=settings.hits)
        ends = CompositeDeleter([
            UpdateTimeStepsDeleter(settings.lost),
            CovarianceBasedDeleter(2 * settings.lost_m**2, mapping=POSITION)], intersect=False)
        if method == "gnn":
            self.tracker = MultiTargetTracker(begin, ends, None, gnn, updater)
        else:
            self.tracker = MultiTargetMixtureTracker(
                begin, ends, None, JPDAwithEHM2(PDAHypothesiser(
                    self.predictor, updater, clutter_spatial_density=settings.clutter,
                    prob_detect=PD, prob_gate=chi2.cdf(settings.gate**2, len(settings.sigmas)))),
                updater)

    def step(self, t_s, plots, times_s):
        """(number, x, y) of the tracks after a scan."""
        from stonesoup.types.array import StateVector
        from stonesoup.types.detection import Detection
        moment = moment_of(t_s)
        _, tracks = self.tracker.update_tracker(moment, {
            Detection(StateVector(seen), timestamp=moment_of(seen_s),
                      measurement_model=model_of(seen, count, self.settings))
            for seen, seen_s, count in clusters(plots, times_s, self.settings)})
        rows = []
        for one in tracks:
            x_m, _, y_m, _ = self.predictor.predict(
                one.state, timestamp=moment).state_vector.ravel().astype(float)
            rows.append((self.numbers.setdefault(one.id, len(self.numbers) + 1), x_m, y_m))
        return rows


def track(scans, settings, method):
    """Rows of tracks at each scan (t_s, plots, their times), and the mean of the processor's time,
    ms: clusters, association, update and initiation."""
    chain, rows, times_ms = Chain(method, settings), [], []
    for t_s, plots, times_s in scans:
        start = time.process_time()
        found = chain.step(t_s, plots, times_s)
        times_ms.append((time.process_time() - start) * 1e3)
        rows += [(t_s, *one) for one in found]
    return np.array(rows, TRACK), float(np.mean(times_ms))
