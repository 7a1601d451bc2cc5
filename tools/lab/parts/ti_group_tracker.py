# SPDX-License-Identifier: MIT
"""Group tracking, as Texas Instruments publishes it for radars that see many points of a body
("Tracking radar targets with multiple reflection points", 2021): written anew from the description.

A group has a state (place, velocity, acceleration) and a spread, the covariance of its plots about
their centroid in range, azimuth and range rate. In each scan groups are predicted; each plot goes
to the group that bids least for it, log |C| + d^2, of those in whose gate it is; plots that are
left make new groups, where enough stand together at one speed; and an extended Kalman filter takes
each group's centroid, which is the less certain, the fewer of the group's plots are seen.

The description asks for the strength of a new group's plots, too. These plots have none.
"""
import dataclasses
import time

import numpy as np

TRACK = [("t_s", "f8"), ("track_id", "i8"), ("x_m", "f8"), ("y_m", "f8")]


@dataclasses.dataclass(frozen=True)
class Settings:
    sigmas: tuple  # of a plot: range in m, azimuth in rad[, range rate in m/s]
    gate: float  # squared distance up to which a plot can be a group's
    distance_m: float  # of the plots of a new group from its centroid
    rate_mps: float  # and of their range rates from its mean
    min_points: int  # plots of a new group
    spread_m: float  # of a new group's plots about their centroid, one sigma
    spread_mps: float  # and of their range rates
    speed_mps: float  # of a new group, one sigma
    accel_mps2: float  # by how much the acceleration changes from scan to scan, one sigma
    smoothing: float  # weight of a scan's own spread that shows all plots of the group
    hits: int = 3  # scans with plots before a group is reported
    lost_new: int = 2  # scans without plots that end it before,
    lost: int = 20  # and later


@dataclasses.dataclass
class Group:
    number: int
    state: np.ndarray  # x, y, vx, vy, ax, ay
    covariance: np.ndarray
    spread: np.ndarray
    points: float  # plots of a full view of the group
    hits: int = 1
    misses: int = 0
    is_active: bool = False


def seen_from(state, num_axes):
    """Range, azimuth and range rate of a state, and their derivatives."""
    x, y, vx, vy = state[:4]
    r = np.hypot(x, y)
    rate = (x * vx + y * vy) / r
    derivatives = np.zeros((3, 6))
    derivatives[0, :2] = x / r, y / r
    derivatives[1, :2] = -y / r**2, x / r**2
    derivatives[2, :4] = (vx - rate * x / r) / r, (vy - rate * y / r) / r, x / r, y / r
    return np.array([r, np.arctan2(y, x), rate])[:num_axes], derivatives[:num_axes]


def difference(plots, centre):
    off = plots - centre
    off[..., 1] = (off[..., 1] + np.pi) % (2 * np.pi) - np.pi
    return off


def motion(dt_s):
    """Constant acceleration of both axes, and what an increment of it adds."""
    one = np.array([[1, dt_s, dt_s**2 / 2], [0, 1, dt_s], [0, 0, 1]])
    noise = np.array([dt_s**2 / 2, dt_s, 1])
    return np.kron(one, np.eye(2)), np.kron(np.outer(noise, noise), np.eye(2))


class GroupTracker:
    def __init__(self, settings):
        self.settings = settings
        self.noise = np.diag(np.square(settings.sigmas))
        self.groups, self.count, self.t_s = [], 0, None

    def step(self, t_s, plots, times_s):
        """Active groups after a scan. plots: range, azimuth[, range rate] of each, seen at
        times_s, of which none is after the scan's t_s."""
        if self.t_s is not None:
            self.predict(t_s - self.t_s)
        self.t_s = t_s
        owner = self.associate(plots, times_s - t_s)
        for number, group in enumerate(self.groups):
            mine = owner == number
            if mine.any():
                self.update(group, plots[mine], np.mean(times_s[mine]) - t_s)
            self.maintain(group, mine.any())
        self.groups = [group for group in self.groups if group.misses < (
            self.settings.lost if group.is_active else self.settings.lost_new)]
        self.allocate(plots[owner < 0])
        return [group for group in self.groups if group.is_active]

    def predict(self, dt_s):
        transition, noise = motion(dt_s)
        for group in self.groups:
            group.state = transition @ group.state
            group.covariance = (transition @ group.covariance @ transition.T
                                + self.settings.accel_mps2**2 * noise)

    def associate(self, plots, back_s):
        """The group of each plot, or -1."""
        owner, least = np.full(len(plots), -1), np.full(len(plots), np.inf)
        if not len(plots):
            return owner
        for number, group in enumerate(self.groups):
            seen, derivatives = seen_from(group.state, len(self.noise))
            off = difference(plots, seen)
            off -= back_s[:, None] * (derivatives[:, :2] @ group.state[2:4])
            around = derivatives @ group.covariance @ derivatives.T + group.spread + self.noise
            squared = np.einsum("ni,ij,nj->n", off, np.linalg.inv(around), off)
            bid = np.log(np.linalg.det(around)) + squared
            takes = (squared < self.settings.gate) & (bid < least)
            owner[takes], least[takes] = number, bid[takes]
        return owner

    def update(self, group, plots, back_s):
        count = len(plots)
        group.points = count if count > group.points else 0.99 * group.points + 0.01 * count
        then = group.state.copy()  # when its plots were seen
        then[:2] += back_s * then[2:4]
        seen, derivatives = seen_from(then, len(self.noise))
        off = difference(plots, seen)
        centroid = off.mean(axis=0)
        if count > 1:
            weight = self.settings.smoothing * count / max(group.points, count)
            around = (off - centroid).T @ (off - centroid) / (count - 1)
            group.spread = (1 - weight) * group.spread + weight * around
        unseen = (group.points - count) / max(group.points - 1, 1) if count > 1 else 1.0
        noise = (self.noise + unseen * group.spread) / count
        gain = group.covariance @ derivatives.T @ np.linalg.inv(
            derivatives @ group.covariance @ derivatives.T + noise)
        group.state = group.state + gain @ centroid
        kept = np.eye(6) - gain @ derivatives
        group.covariance = kept @ group.covariance @ kept.T + gain @ noise @ gain.T

    def maintain(self, group, is_hit):
        group.hits += is_hit
        group.misses = 0 if is_hit else group.misses + 1
        group.is_active |= group.hits >= self.settings.hits

    def allocate(self, plots):
        """New groups of plots that are nobody's: those about a first one, as its centroid moves."""
        left = list(range(len(plots)))
        places = plots[:, :1] * np.column_stack([np.cos(plots[:, 1]), np.sin(plots[:, 1])])
        while len(left) >= self.settings.min_points:
            members = [left.pop(0)]
            for other in left:
                near = np.hypot(*(places[other] - places[members].mean(axis=0)))
                rate = np.ptp([plots[other, -1], plots[members, -1].mean()])
                if near < self.settings.distance_m and (
                        plots.shape[1] < 3 or rate < self.settings.rate_mps):
                    members.append(other)
            if len(members) >= self.settings.min_points:
                left = [other for other in left if other not in members]
                self.groups.append(self.begin(plots[members], places[members].mean(axis=0)))

    def begin(self, plots, place_m):
        """A group at the place; its range rate is known where it is measured, else its speed is
        not."""
        settings, range_m, has_rate = self.settings, np.hypot(*place_m), plots.shape[1] > 2
        outwards = place_m / range_m
        axes = np.column_stack([outwards, [-outwards[1], outwards[0]]])
        variance_m2 = settings.spread_m**2 + np.diag(self.noise)[:2] * [1, range_m**2]
        along_mps = settings.spread_mps if has_rate else settings.speed_mps
        covariance = settings.accel_mps2**2 * np.eye(6)
        covariance[:2, :2] = axes @ np.diag(variance_m2) @ axes.T
        covariance[2:4, 2:4] = axes @ np.diag([along_mps**2, settings.speed_mps**2]) @ axes.T
        rate_mps = plots[:, 2].mean() if has_rate else 0.0
        spreads = [settings.spread_m, settings.spread_m / range_m, settings.spread_mps]
        self.count += 1
        return Group(self.count, np.concatenate([place_m, rate_mps * outwards, [0, 0]]), covariance,
                     np.diag(np.square(spreads[:len(self.noise)])), float(len(plots)))


def track(scans, settings):
    """Rows of reported groups at each scan (t_s, plots, their times), and the mean of the
    processor's time, ms."""
    tracker, rows, times_ms = GroupTracker(settings), [], []
    for t_s, plots, times_s in scans:
        start = time.process_time()
        groups = tracker.step(t_s, plots, times_s)
        times_ms.append((time.process_time() - start) * 1e3)
        rows += [(t_s, group.number, *group.state[:2]) for group in groups]
    return np.array(rows, TRACK), float(np.mean(times_ms))
