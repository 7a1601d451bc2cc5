# SPDX-License-Identifier: MIT
"""References of a radar in the origin, told which plots are a target's, in double precision: the
straight-line fit with the score that an initiator gives it, and an extended Kalman filter.

Rows of plots are structured: t_s, range_m, azimuth_rad, and range_rate_mps where it counts.
"""
import dataclasses
import math

import numpy as np

TARGETS_EXPECTED = 0.5  # in the area, before any plot: as the initiator takes it


@dataclasses.dataclass
class Radar:
    sigma_range_m: float
    sigma_azimuth_rad: float
    sigma_range_rate_mps: float = math.nan  # NaN: range rates do not count
    range_min_m: float = 0.0
    range_max_m: float = 0.0

    @property
    def has_range_rate(self):
        return not math.isnan(self.sigma_range_rate_mps)


@dataclasses.dataclass
class Sky:
    """What an initiator may reckon with."""
    num_scans: int
    pd: float
    area_m2: float
    v_min_mps: float
    v_max_mps: float
    clutter: float  # plots a turn, uniform in range and azimuth


@dataclasses.dataclass
class Fit:
    state: np.ndarray  # x, y, vx, vy at the middle of the plots' times
    chi2: float
    score_nat: float


def seen(state):
    """Range, azimuth and range rate of a state x, y, vx, vy, and their derivatives by it."""
    x_m, y_m, vx_mps, vy_mps = state
    range_m = math.hypot(x_m, y_m)
    ux, uy = x_m / range_m, y_m / range_m
    rate_mps = ux * vx_mps + uy * vy_mps
    return (range_m, math.atan2(y_m, x_m), rate_mps), np.array([
        [ux, uy, 0, 0], [-uy / range_m, ux / range_m, 0, 0],
        [(vx_mps - rate_mps * ux) / range_m, (vy_mps - rate_mps * uy) / range_m, ux, uy]])


def solve(rows, values, variances):
    """Weighted least squares: unknowns, chi-square, ln of the normal equations' determinant."""
    weighted = rows / np.sqrt(variances)[:, None]
    normal = weighted.T @ weighted
    unknowns = np.linalg.solve(normal, weighted.T @ (values / np.sqrt(variances)))
    return (unknowns, float(((values - rows @ unknowns)**2 / variances).sum()),
            np.linalg.slogdet(normal)[1])


def fit(plots, radar, sky):
    """The straight line through three plots or more, each at its own time, and its score with the
    clutter's true density. Range rates are linearised where the places alone put the track."""
    t_s = plots["t_s"] - (plots["t_s"][0] + plots["t_s"][-1]) / 2
    cosine, sine = np.cos(plots["azimuth_rad"]), np.sin(plots["azimuth_rad"])
    rows = np.concatenate([np.column_stack([cosine, sine, t_s * cosine, t_s * sine]),
                           np.column_stack([-sine, cosine, -t_s * sine, t_s * cosine])])
    values = np.concatenate([plots["range_m"], np.zeros(len(plots))])
    variances = np.concatenate([np.full(len(plots), radar.sigma_range_m**2),
                                (plots["range_m"] * radar.sigma_azimuth_rad)**2])
    unknowns, chi2, log_det = solve(rows, values, variances)
    density = sky.clutter / (2 * math.pi * plots["range_m"]
                             * (radar.range_max_m - radar.range_min_m))
    prior = np.log(sky.pd / density)
    if radar.has_range_rate:
        for time_s, rate_mps in zip(t_s, plots["range_rate_mps"]):
            move = np.array([[1, 0, time_s, 0], [0, 1, 0, time_s], [0, 0, 1, 0], [0, 0, 0, 1]])
            expected, derivatives = seen(move @ unknowns)
            row = derivatives[2] @ move
            rows = np.vstack([rows, row])
            values = np.append(values, rate_mps - expected[2] + row @ unknowns)
        variances = np.append(variances, np.full(len(plots), radar.sigma_range_rate_mps**2))
        unknowns, chi2, log_det = solve(rows, values, variances)
        prior += math.log(2 * sky.v_max_mps)
    speeds_m2ps2 = math.pi * (sky.v_max_mps**2 - sky.v_min_mps**2)
    return Fit(unknowns, chi2, float(
        prior.sum() + (sky.num_scans - len(plots)) * math.log(1 - sky.pd)
        - math.log(sky.area_m2 * speeds_m2ps2) + math.log(TARGETS_EXPECTED)
        - ((len(rows) - 4) * math.log(2 * math.pi) + np.log(variances).sum() + log_det + chi2) / 2))


class Filter:
    """An extended Kalman filter that takes range, azimuth and range rate one after the other; opens
    at a plot, with a velocity of zero and this standard deviation of each axis."""

    def __init__(self, plot, radar, sigma_speed_mps):
        self.radar, self.t_s = radar, float(plot["t_s"])
        cosine, sine = math.cos(plot["azimuth_rad"]), math.sin(plot["azimuth_rad"])
        turn = np.array([[cosine, -sine], [sine, cosine]])
        variances = [radar.sigma_range_m**2, (plot["range_m"] * radar.sigma_azimuth_rad)**2]
        self.state = np.array([plot["range_m"] * cosine, plot["range_m"] * sine, 0.0, 0.0])
        self.covariance = np.diag([0, 0, sigma_speed_mps**2, sigma_speed_mps**2]).astype(float)
        self.covariance[:2, :2] = turn @ np.diag(variances) @ turn.T
        if radar.has_range_rate:
            self._take(2, plot["range_rate_mps"], radar.sigma_range_rate_mps)

    def at(self, t_s, noise_density):
        """State and covariance at another time, with white acceleration of this density, m^2/s^3;
        backwards without."""
        dt_s = t_s - self.t_s
        move = np.eye(4)
        move[0, 2] = move[1, 3] = dt_s
        covariance = move @ self.covariance @ move.T
        q, dt_s = noise_density * max(dt_s, 0.0), max(dt_s, 0.0)
        for axis in (0, 1):
            covariance[axis, axis] += q * dt_s**2 / 3
            covariance[axis, axis + 2] += q * dt_s / 2
            covariance[axis + 2, axis] += q * dt_s / 2
            covariance[axis + 2, axis + 2] += q
        return move @ self.state, covariance

    def predict(self, t_s, noise_density):
        self.state, self.covariance = self.at(t_s, noise_density)
        self.t_s = t_s

    def update(self, plot):
        self._take(0, plot["range_m"], self.radar.sigma_range_m)
        self._take(1, plot["azimuth_rad"], self.radar.sigma_azimuth_rad)
        if self.radar.has_range_rate:
            self._take(2, plot["range_rate_mps"], self.radar.sigma_range_rate_mps)

    def _take(self, which, measured, sigma):
        expected, derivatives = seen(self.state)
        row, off = derivatives[which], measured - expected[which]
        off = math.remainder(off, 2 * math.pi) if which == 1 else off
        spread = self.covariance @ row
        total = row @ spread + sigma**2
        self.state = self.state + spread * (off / total)
        self.covariance = self.covariance - np.outer(spread, spread) / total
