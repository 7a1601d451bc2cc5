# SPDX-License-Identifier: MIT
"""Skies of passive sensors, and references that are told which bearings are a target's: the fit of
a constant velocity and an extended Kalman filter, in double precision. The package has no part in
them.
"""
import dataclasses
import math

import numpy as np

PLACES_M = np.array([[0, -10e3], [0, 10e3], [10e3, 0], [-10e3, 0]])  # of the sensors
START_FAR_M = 78e3  # from the origin, at most
INTERVAL_S = 10.0
FALSE = -1  # target_id of a false bearing, and of the row that stands for a look
ROW = np.dtype([("t_s", "f8"), ("sensor_id", "i4"), ("sensor_x_m", "f8"), ("sensor_y_m", "f8"),
                ("bearing_rad", "f8"), ("sigma_rad", "f8"), ("frame", "i4"), ("target_id", "i4")])


@dataclasses.dataclass(frozen=True)
class Region:
    """Where targets start, and the least x that they reach."""
    x_m: tuple[float, float]
    y_m: tuple[float, float]
    is_on_both_sides: bool = False  # of the x axis
    end_x_min_m: float = 2e3


REGIONS = {
    "ahead": Region((20e3, 75e3), (-50e3, 50e3)),
    "base's extension": Region((-1.5e3, 1.5e3), (25e3, 60e3), True, -math.inf),
    "near": Region((15e3, 35e3), (-15e3, 15e3)),
}


@dataclasses.dataclass(frozen=True)
class Setting:
    sensors: int
    targets: int
    sigma_deg: float = 0.1
    pd: float = 1.0
    false_mean: float = 0.0  # bearings a look, within 90 degrees of +x
    region: str = "ahead"
    unequal_intervals: bool = False  # 0.3 to 1.7 times the interval
    frames: int = 8
    speed_mps: tuple[float, float] = (150, 350)


class Scene:
    """One draw of a setting.

    times_s: of the frames; start: (targets, 4), x, y, vx, vy in the first frame; rows: what the
    sensors see, by frame and sensor, the bearings of a look in random order behind a row without a
    bearing, which stands for the look. A target's bearing has its target_id.
    """

    def __init__(self, of, random):
        self.of = of
        steps = random.uniform(0.3, 1.7, of.frames - 1) if of.unequal_intervals else np.ones(
            of.frames - 1)
        self.times_s = INTERVAL_S * np.concatenate([[0], np.cumsum(steps)])
        self.start = draw_starts(of, self.times_s[-1], random)
        self.rows = self._look(random)

    def truth(self, t_s):
        """(..., targets, 4) at these times."""
        return moved(self.start, np.asarray(t_s)[..., None, None])

    @property
    def seen(self):
        """The rows with a bearing."""
        return self.rows[~np.isnan(self.rows["bearing_rad"])]

    @property
    def middle_s(self):
        return (self.times_s[0] + self.times_s[-1]) / 2

    def _look(self, random):
        of, truth = self.of, self.truth(self.times_s)
        shape = of.frames, of.sensors, of.targets
        away = truth[:, None, :, :2] - PLACES_M[None, :of.sensors, None]
        bearings = (np.arctan2(away[..., 1], away[..., 0])
                    + math.radians(of.sigma_deg) * random.standard_normal(shape))
        seen = np.argwhere(random.random(shape) < of.pd)
        looks = np.argwhere(np.ones(shape[:2], bool))
        false = np.repeat(looks, random.poisson(of.false_mean, len(looks)), axis=0)
        rows = np.zeros(len(looks) + len(seen) + len(false), ROW)
        sensor = np.concatenate([looks[:, 1], seen[:, 1], false[:, 1]])
        rows["frame"] = np.concatenate([looks[:, 0], seen[:, 0], false[:, 0]])
        rows["target_id"] = FALSE
        rows["target_id"][len(looks):len(looks) + len(seen)] = seen[:, 2]
        rows["bearing_rad"] = np.concatenate([
            np.full(len(looks), np.nan), wrapped(bearings[tuple(seen.T)]),
            random.uniform(-np.pi / 2, np.pi / 2, len(false))])
        rows["t_s"], rows["sensor_id"] = self.times_s[rows["frame"]], sensor + 1
        rows["sensor_x_m"], rows["sensor_y_m"] = PLACES_M[sensor].T
        rows["sigma_rad"] = math.radians(of.sigma_deg)
        order = np.concatenate([np.full(len(looks), -1.0), random.random(len(rows) - len(looks))])
        return rows[np.lexsort([order, sensor, rows["frame"]])]

    def frames(self, sensors=None):
        """The rows frame by frame, of these sensor_ids or of all."""
        rows = self.rows if sensors is None else self.rows[np.isin(self.rows["sensor_id"], sensors)]
        return np.split(rows, np.searchsorted(rows["frame"], np.arange(1, self.of.frames)))

    def looks(self):
        """{(frame, sensor from 0): rows of its bearings}."""
        seen = self.seen
        key = seen["frame"] * self.of.sensors + seen["sensor_id"] - 1
        parts = np.split(seen, np.searchsorted(key, np.arange(1, self.of.frames * self.of.sensors)))
        return {divmod(i, self.of.sensors): part for i, part in enumerate(parts)}


def draw_starts(of, duration_s, random):
    """(targets, 4): within 45 degrees of the way to the origin, drawn anew where a target starts
    too far away or ends too far back."""
    region, found = REGIONS[of.region], np.empty((0, 4))
    while len(found) < of.targets:
        many = 4 * of.targets
        x_m, y_m = random.uniform(*region.x_m, many), random.uniform(*region.y_m, many)
        if region.is_on_both_sides:
            y_m *= random.choice([-1, 1], many)
        heading = np.arctan2(-y_m, -x_m) + random.uniform(-np.pi / 4, np.pi / 4, many)
        speed_mps = random.uniform(*of.speed_mps, many)
        states = np.column_stack([x_m, y_m, speed_mps * np.cos(heading),
                                  speed_mps * np.sin(heading)])
        is_fit = ((np.hypot(x_m, y_m) <= START_FAR_M)
                  & (x_m + duration_s * states[:, 2] >= region.end_x_min_m))
        found = np.concatenate([found, states[is_fit]])
    return found[:of.targets]


def moved(states, dt_s):
    """States x, y, vx, vy so much later."""
    places_m = states[..., :2] + dt_s * states[..., 2:]
    return np.concatenate([places_m, np.broadcast_to(states[..., 2:], places_m.shape)], axis=-1)


def wrapped(angle_rad):
    return angle_rad - 2 * np.pi * np.round(angle_rad / (2 * np.pi))


# ---- References ----

SPEED_SIGMA_MPS = 500.0  # of each axis before any bearing: weak, so that few have an answer, too
FIT_STEPS = 12


def fit(rows, t_s, start):
    """The constant velocity at t_s that these bearings make most likely, by Gauss-Newton from a
    state nearby: state and covariance of x, y, vx, vy."""
    state, dt_s = np.array(start, float), rows["t_s"] - t_s
    weight = 1 / rows["sigma_rad"]**2
    prior = np.diag([0, 0, SPEED_SIGMA_MPS**-2, SPEED_SIGMA_MPS**-2])
    for _ in range(FIT_STEPS):
        off_rad, by_state = innovations(rows, state, dt_s)
        covariance = np.linalg.inv(prior + (weight * by_state) @ by_state.T)
        state = state + covariance @ (by_state @ (weight * off_rad) - prior @ state)
    return state, covariance


def innovations(rows, state, dt_s):
    """Measured less expected bearings, and the expected ones' derivatives (4, rows)."""
    dx_m = state[0] + dt_s * state[2] - rows["sensor_x_m"]
    dy_m = state[1] + dt_s * state[3] - rows["sensor_y_m"]
    by_place = np.array([-dy_m, dx_m]) / (dx_m**2 + dy_m**2)
    return (wrapped(rows["bearing_rad"] - np.arctan2(dy_m, dx_m)),
            np.concatenate([by_place, dt_s * by_place]))


def predict(state, covariance, dt_s, density_m2ps3):
    """A constant velocity with white acceleration of this density."""
    move = np.eye(4)
    move[0, 2] = move[1, 3] = dt_s
    noise = density_m2ps3 * np.array([[dt_s**3 / 3, dt_s**2 / 2], [dt_s**2 / 2, dt_s]])
    return move @ state, move @ covariance @ move.T + np.kron(noise, np.eye(2))


def update(state, covariance, row):
    """A bearing, taken as an extended Kalman filter takes it."""
    (off_rad,), by_state = innovations(row[None], state, np.zeros(1))
    spread = covariance @ by_state[:, 0]
    total = by_state[:, 0] @ spread + row["sigma_rad"]**2
    return state + spread * (off_rad / total), covariance - np.outer(spread, spread) / total


def nees(off, covariances):
    """off' inverse(covariance) off of each: chi-square of as many degrees of freedom as off has,
    where the covariance is right."""
    return np.einsum("...i,...i", off, np.linalg.solve(covariances, off[..., None])[..., 0])
