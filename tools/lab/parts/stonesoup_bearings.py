# SPDX-License-Identifier: MIT
"""Stone Soup on looks of bearings: its extended Kalman filter, with its joint probabilistic data
association, look by look.

It starts no tracks from bearings. So those that no track took are crossed frame by frame, where
each sensor has one there, and the places go to its multi-measurement initiator.
"""
import datetime
import functools

import numpy as np

from common import scene_files
from common.stonesoup_tracker import EPOCH, POSITION
from parts.passive_scenes import wrapped

GATE = 3.0  # sigmas
# Places that the initiator wants before it releases a track. Completeness and false tracks a scan
# of rows clean .1 deg, clean .5 deg, straight 2 deg, turning .5 deg, four seeds:
#   3: .950 .950 .842 .938, .24 1.06 1.27 .60    6: .873 .819 .873 .832, 0 1.09 .63 .52
MIN_POINTS = 3
HOLD_MISSES, MISSES = 2, 5  # frames in a row that end a track in the initiator, and later
LOST_M = 4000.0  # a place less certain than this ends a track
STRAIGHT_M2PS3 = 1.0  # density of the acceleration, each axis
PARALLEL = 0.05  # sine of the angle below which two bearings do not cross


def crossing(places_m, bearings_rad, sigma_rad):
    """Place and covariance where two bearings cross; None where they do not."""
    normals = np.column_stack([-np.sin(bearings_rad), np.cos(bearings_rad)])
    if abs(np.linalg.det(normals)) < PARALLEL:
        return None
    place_m = np.linalg.solve(normals, (normals * places_m).sum(axis=1))
    range_m = ((place_m - places_m) * np.column_stack(
        [np.cos(bearings_rad), np.sin(bearings_rad)])).sum(axis=1)
    inverse = np.linalg.inv(normals / np.maximum(range_m, 1)[:, None])
    return None if range_m.min() <= 0 else (place_m, sigma_rad**2 * inverse @ inverse.T)


def crossings(looks, sigma_rad, range_max_m):
    """Places and covariances where the first two of these looks (place, bearings) cross and each
    other one has a bearing, which is then part of the place."""
    found = []
    for a in looks[0][1]:
        for b in looks[1][1]:
            crossed = crossing(np.array([looks[0][0], looks[1][0]]), np.array([a, b]), sigma_rad)
            for sensor_m, bearings_rad in looks[2:]:
                crossed = crossed and joined(*crossed, sensor_m, bearings_rad, sigma_rad)
            if crossed and np.hypot(*crossed[0]) < range_max_m:
                found.append(crossed)
    return found


def joined(place_m, covariance, sensor_m, bearings_rad, sigma_rad):
    """The place with the nearest bearing of another sensor; None where none is in the gate."""
    dx_m, dy_m = place_m - sensor_m
    row = np.array([-dy_m, dx_m]) / (dx_m**2 + dy_m**2)
    spread = covariance @ row
    total = row @ spread + sigma_rad**2
    off_rad = wrapped(np.asarray(bearings_rad) - np.arctan2(dy_m, dx_m))
    if not len(off_rad) or np.abs(off_rad).min() > GATE * np.sqrt(total):
        return None
    nearest_rad = off_rad[np.abs(off_rad).argmin()]
    return (place_m + spread * nearest_rad / total,
            covariance - np.outer(spread, spread) / total)


@functools.cache
def model_class():
    """A bearing's model in plain numbers, which has expected bearings beside the measured one:
    measures of Stone Soup cannot subtract its own angles by older versions of numpy."""
    from stonesoup.base import Property
    from stonesoup.models.measurement.nonlinear import NonLinearGaussianMeasurement
    from stonesoup.types.array import StateVector

    class Seen(NonLinearGaussianMeasurement):
        sensor_m: np.ndarray = Property(doc="Place")
        bearing_rad: float = Property(doc="As measured")

        @property
        def ndim_meas(self):
            return 1

        def away(self, state):
            return state.state_vector[POSITION, 0].astype(float) - self.sensor_m

        def function(self, state, noise=False, **kwargs):
            dx_m, dy_m = self.away(state)
            return StateVector([self.bearing_rad + wrapped(
                np.arctan2(dy_m, dx_m) - self.bearing_rad)])

        def jacobian(self, state, **kwargs):
            dx_m, dy_m = self.away(state)
            return np.array([[-dy_m, 0, dx_m, 0]]) / (dx_m**2 + dy_m**2)

    return Seen


@functools.cache
def initiator_class():
    from stonesoup.base import Property
    from stonesoup.initiator.base import Initiator
    from stonesoup.models.measurement.linear import LinearGaussian
    from stonesoup.types.array import StateVector
    from stonesoup.types.detection import Detection

    class Crossed(Initiator):
        """Gathers a frame's bearings, and hands the places where they cross to another one."""
        initiator: Initiator = Property(doc="Of places")
        sky: object = Property(doc="The sensors")
        looks: list = Property(default=None, doc="(place, bearings) since the last frame")

        def initiate(self, detections, timestamp, **kwargs):
            self.looks.append([float(one.state_vector[0, 0]) for one in detections])
            of = self.sky.of
            if len(self.looks) < len(of.places_m):
                return set()
            looks = list(zip(np.array(of.places_m, float), self.looks))
            self.looks = []
            sigma_rad = np.radians(of.sigma_deg)
            return self.initiator.initiate({
                Detection(StateVector(place_m), timestamp=timestamp, measurement_model=(
                    LinearGaussian(4, POSITION, covariance)))
                for place_m, covariance in crossings(looks, sigma_rad,
                                                     of.settings["range_max_m"])}, timestamp)

    return Crossed


def make_tracker(sky):
    """The tracker, ready to be stepped look by look."""
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
    from stonesoup.tracker.simple import MultiTargetMixtureTracker
    from stonesoup.types.state import GaussianState
    from stonesoup.updater.kalman import ExtendedKalmanUpdater

    of, sensors = sky.of, len(sky.of.places_m)
    density_m2ps3 = max(STRAIGHT_M2PS3, of.turn_mps2**2 / 4)
    predictor = KalmanPredictor(CombinedLinearGaussianTransitionModel(
        [ConstantVelocity(density_m2ps3)] * 2))
    updater = ExtendedKalmanUpdater(None)
    nearest = GNNWith2DAssignment(DistanceHypothesiser(
        predictor, updater, Mahalanobis(), missed_distance=GATE))
    prior = GaussianState(np.zeros((4, 1)), np.diag(
        [0, (of.settings["v_max_mps"] / 2)**2] * 2), timestamp=EPOCH)
    begin = initiator_class()(MultiMeasurementInitiator(
        prior, UpdateTimeStepsDeleter(HOLD_MISSES), nearest, updater, min_points=MIN_POINTS),
        sky, [])
    ends = CompositeDeleter([
        UpdateTimeStepsDeleter(MISSES * sensors),
        CovarianceBasedDeleter(2 * LOST_M**2, mapping=POSITION)], intersect=False)
    field_rad = 2 * np.pi if of.is_around else np.pi
    return MultiTargetMixtureTracker(begin, ends, None, JPDAwithEHM2(PDAHypothesiser(
        predictor, updater, clutter_spatial_density=max(of.false_mean, 0.1) / field_rad,
        prob_detect=min(of.pd, 0.99), prob_gate=chi2.cdf(GATE**2, 1))), updater)


def track(sky):
    """The tracks at the frames' times, of sensors that stand and look together."""
    from stonesoup.types.array import StateVector
    from stonesoup.types.detection import Detection

    tracker, numbers, ids, places_m = make_tracker(sky), {}, [], []
    noise = np.array([[np.radians(sky.of.sigma_deg)**2]])
    for k in range(len(sky.times_s)):
        moment = EPOCH + datetime.timedelta(seconds=float(sky.times_s[k]))
        for sensor, place_m in enumerate(sky.of.places_m, 1):
            rows = sky.rows[(sky.rows["frame"] == k) & (sky.rows["sensor_id"] == sensor)
                            & ~np.isnan(sky.rows["bearing_rad"])]
            _, tracks = tracker.update_tracker(moment, {
                Detection(StateVector([value]), timestamp=moment, measurement_model=model_class()(
                    4, POSITION, noise, sensor_m=np.array(place_m, float), bearing_rad=value))
                for value in rows["bearing_rad"].tolist()})
        tracks = sorted(tracks, key=lambda one: numbers.setdefault(one.id, len(numbers) + 1))
        ids.append(np.array([numbers[one.id] for one in tracks], dtype=int))
        places_m.append(np.array([one.state_vector.ravel()[POSITION].astype(float)
                                  for one in tracks]).reshape(-1, 2))
    return scene_files.Tracks(ids, places_m)
