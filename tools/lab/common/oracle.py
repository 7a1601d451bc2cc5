# SPDX-License-Identifier: MIT
"""The oracle: a Kalman filter or IMM of each target, told which plots are whose. A reference, not a
bound.

A track starts after START_HITS hits in LOOKS looks and is dropped after DROP_MISSES misses in a
row. A look is a scan of a sensor that covers the target, or any scan while none does. Constant
velocity with white acceleration, constant over the time between two plots: one process noise is a
Kalman filter, (quiet, agile, mean time in each in seconds) an IMM of two of them. Filters of
several process noises run side by side, so that the one that suits a scene can be chosen by its
errors.
"""
import numpy as np

from common.scene_files import MORE, sensor_of, tracks_by_scan

START_HITS, LOOKS, DROP_MISSES = 3, 5, 5

# What a scene that names no process noise is searched with, m/s^2
CANDIDATES = [(0.003,), (0.03,), (0.1,), (0.3,), (1.0,), (3.0,), (10.0,),
              (0.03, 3.0, 60.0), (0.03, 8.0, 60.0), (0.1, 8.0, 20.0), (0.03, 15.0, 60.0)]


def measurement_noise(plots, sensors):
    """Covariances of the plots' places, (plots, 2, 2)."""
    if plots.sigma_m is not None:
        return plots.sigma_m[:, None, None] ** 2 * np.eye(2)
    cosine, sine = np.cos(plots.azimuth_rad), np.sin(plots.azimuth_rad)
    turn = np.stack([np.stack([cosine, -sine], -1), np.stack([sine, cosine], -1)], -2)
    sigma = np.array(
        [[sensor_of(sensors, number).sigma_range_m,
          sensor_of(sensors, number).sigma_azimuth_rad]
         for number in plots.sensor.tolist()]).reshape(-1, 2)
    variance = np.stack([sigma[:, 0] ** 2, (sigma[:, 1] * plots.range_m) ** 2], -1)
    return np.einsum("nij,nj,nkj->nik", turn, variance, turn)


def own_plots(plots, truth):
    """[scan] -> (targets, plots): of several plots of one target the one nearest to it."""
    order = np.argsort(plots.scan, kind="stable")
    bounds = np.searchsorted(plots.scan[order], np.arange(len(plots.scan_times_us) + 1))
    scan_of_truth = truth.scan_of(plots.scan_times_us)
    found = []
    for s in range(len(plots.scan_times_us)):
        rows = order[bounds[s]:bounds[s + 1]]
        rows = rows[plots.target[rows] >= 0]
        targets = np.searchsorted(truth.ids, plots.target[rows])
        off = np.linalg.norm(plots.place_m[rows] - truth.place_m[scan_of_truth[s], targets], axis=1)
        off = np.where(np.isnan(off), np.inf, off)
        nearest = {}
        for index in np.argsort(-off, kind="stable").tolist():
            nearest[int(targets[index])] = int(rows[index])
        found.append((np.array(list(nearest.keys()),
                               dtype=int), np.array(list(nearest.values()), dtype=int)))
    return found


def step_matrices(dt):
    """Transition and noise (for 1 m/s^2) of steps of dt seconds, which may be negative; state x, y,
    vx, vy."""
    n = len(dt)
    transition, noise = np.zeros((n, 4, 4)), np.zeros((n, 4, 4))
    for axis in (0, 1):
        transition[:, axis, axis] = transition[:, axis + 2, axis + 2] = 1
        transition[:, axis, axis + 2] = dt
        noise[:, axis, axis] = dt ** 4 / 4
        noise[:, axis, axis + 2] = noise[:, axis + 2, axis] = dt ** 3 / 2
        noise[:, axis + 2, axis + 2] = dt ** 2
    return transition, noise


class Filters:
    """Filters of all targets: (candidates, models, targets) of states, covariances and weights; all
    candidates have the same number of models, one or two."""

    def __init__(self, candidates, num_targets, sigma_speed_mps):
        self.models = 1 if len(candidates[0]) == 1 else 2
        shape = (len(candidates), self.models, num_targets)
        self.noise = np.array([c[:self.models] for c in candidates])  # (candidates, models)
        self.sojourn_s = np.array([c[2] if self.models == 2 else np.inf for c in candidates])
        self.sigma_speed_mps = sigma_speed_mps
        self.x = np.zeros((*shape, 4))
        self.p = np.zeros((*shape, 4, 4))
        self.weight = np.full(shape, 1 / self.models)
        self.time_s = np.zeros(num_targets)
        self.has_state = np.zeros(num_targets, dtype=bool)

    def start(self, targets, z, r, time_s):
        self.x[:, :, targets] = 0
        self.x[:, :, targets, :2] = z
        self.p[:, :, targets] = 0
        for axis in (2, 3):
            self.p[:, :, targets, axis, axis] = self.sigma_speed_mps ** 2
        self.p[:, :, targets, :2, :2] = r
        self.weight[:, :, targets] = 1 / self.models
        self.time_s[targets] = time_s
        self.has_state[targets] = True

    def mixed(self, targets, dt):
        x, p, weight = self.x[:, :, targets], self.p[:, :, targets], self.weight[:, :, targets]
        if self.models == 1:
            return x, p, weight
        stay = np.exp(-np.abs(dt)[None, :] / self.sojourn_s[:, None])  # (candidates, targets)
        ahead = np.stack([weight[:, 0] * stay + weight[:, 1] * (1 - stay),
                          weight[:, 1] * stay + weight[:, 0] * (1 - stay)], axis=1)
        mixed_x, mixed_p = np.empty_like(x), np.empty_like(p)
        for i in (0, 1):
            share = (weight[:, i] * stay / ahead[:, i])[..., None]
            off = x[:, 1 - i] - x[:, i]
            mixed_x[:, i] = x[:, i] + (1 - share) * off
            share = share[..., None]
            mixed_p[:, i] = share * p[:, i] + (1 - share) * p[:, 1 - i] + \
                share * (1 - share) * off[..., :, None] * off[..., None, :]
        return mixed_x, mixed_p, ahead

    def update(self, targets, z, r, time_s):
        dt = time_s - self.time_s[targets]
        x, p, weight = self.mixed(targets, dt)
        transition, noise = step_matrices(dt)
        x = np.einsum("nij,cmnj->cmni", transition, x)
        p = transition @ p @ transition.swapaxes(-1, -2) + (self.noise**2)[:, :, None, None,
                                                                           None] * noise
        s = p[..., :2, :2] + r
        det = s[..., 0, 0] * s[..., 1, 1] - s[..., 0, 1] ** 2
        inverse = np.stack([np.stack([s[..., 1, 1], -s[..., 0, 1]], -1),
                            np.stack([-s[..., 0, 1], s[..., 0, 0]], -1)], -2) / det[..., None, None]
        residual = z - x[..., :2]
        gain = p[..., :, :2] @ inverse
        self.x[:, :, targets] = x + (gain @ residual[..., None])[..., 0]
        p = p - gain @ p[..., :2, :]
        self.p[:, :, targets] = (p + p.swapaxes(-1, -2)) / 2
        if self.models == 2:
            nis = np.einsum("cmni,cmnij,cmnj->cmn", residual, inverse, residual)
            likelihood = -0.5 * (nis + np.log(det))
            weight = weight * np.exp(likelihood - likelihood.max(axis=1, keepdims=True))
            self.weight[:, :, targets] = np.maximum(weight / weight.sum(axis=1, keepdims=True),
                                                    1e-6)
        self.time_s[targets] = time_s

    def estimates(self, targets, time_s):
        """(candidates, targets, 4) and covariances at that time, of all models together."""
        dt = time_s - self.time_s[targets]
        transition, noise = step_matrices(dt)
        x = np.einsum("nij,cmnj->cmni", transition, self.x[:, :, targets])
        p = transition @ self.p[:, :, targets] @ transition.swapaxes(-1, -2) + \
            (self.noise ** 2)[:, :, None, None, None] * np.where(dt[:, None, None] > 0, noise, 0)
        weight = self.weight[:, :, targets][..., None]
        weight = weight / weight.sum(axis=1, keepdims=True)
        mean = (x * weight).sum(axis=1)
        off = x - mean[:, None]
        return mean, ((p + off[..., :, None] * off[..., None, :]) * weight[..., None]).sum(axis=1)


def as_rows(mean, covariance, coasts):
    """Places, and the columns of MORE."""
    lower = [covariance[..., i, j] for i, j in ((0, 0), (1, 0), (1, 1), (2, 2), (3, 2), (3, 3))]
    return np.concatenate(
        [mean, np.stack([*lower, np.broadcast_to(coasts, mean.shape[:-1])], axis=-1)], axis=-1)


def follow(plots, truth, sensors, candidates, v_max_mps, live_throughout=False, noise=None):
    """Rows of tracks: times in microseconds, track numbers, targets, places for each candidate
    (candidates, rows, 2), and what else is known of tracks (candidates, rows, len(MORE)). Targets
    that live throughout are told as such: three hits in any looks start a track, and it stays.
    noise: covariances of the plots' places, where they are not the sensors'."""
    groups = [[c for c in candidates if len(c) == 1], [c for c in candidates if len(c) > 1]]
    filters = [Filters(group, len(truth.ids), v_max_mps / 2) for group in groups if group]
    places_in = [candidates.index(c) for group in groups for c in group]
    noise = measurement_noise(plots, sensors) if noise is None else noise
    own = own_plots(plots, truth)
    n = len(truth.ids)
    looks = np.zeros((n, len(plots.scan_times_us) if live_throughout else LOOKS), dtype=bool)
    drop_misses = np.inf if live_throughout else DROP_MISSES
    misses = np.zeros(n, dtype=int)
    track = np.full(n, -1)
    next_track = 0
    times, tracks, owners, rows_of = [], [], [], []
    scan_of_truth = truth.scan_of(plots.scan_times_us)
    for s in np.argsort(plots.scan_times_us, kind="stable").tolist():
        place, k = truth.place_m[scan_of_truth[s]], scan_of_truth[s]
        hit, rows = own[s]
        looked = sensor_of(sensors, int(plots.scan_sensor[s])).covers(
            place[:, 0], place[:, 1]) | ~truth.visible[k]
        looked[hit] = True
        is_hit = np.zeros(n, dtype=bool)
        is_hit[hit] = True
        looks[looked] = np.column_stack([looks[looked, 1:], is_hit[looked]])
        misses = np.where(is_hit, 0, misses + looked)
        time_s = plots.times_us[rows] / 1e6
        known = filters[0].has_state[hit]
        for bank in filters:
            if known.any():
                bank.update(hit[known], plots.place_m[rows[known]], noise[rows[known]],
                            time_s[known])
            if (~known).any():
                bank.start(hit[~known], plots.place_m[rows[~known]], noise[rows[~known]],
                           time_s[~known])
        over = np.where(track >= 0, misses >= drop_misses,
                        ~looks.any(axis=1)) & filters[0].has_state
        track[over] = -1
        looks[over] = False
        for bank in filters:
            bank.has_state[over] = False
        for j in np.nonzero((track < 0) & (looks.sum(axis=1) >= START_HITS))[0]:
            track[j] = next_track
            next_track += 1
        active = np.nonzero(track >= 0)[0]
        if len(active):
            times.append(np.full(len(active), plots.scan_times_us[s]))
            tracks.append(track[active].copy())
            owners.append(active)
            rows_of.append(
                np.concatenate([
                    as_rows(*bank.estimates(active, plots.scan_times_us[s] / 1e6), ~is_hit[active])
                    for bank in filters
                ]))
    if not times:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64), np.empty(0, dtype=int), \
            np.empty((len(candidates), 0, 2)), np.empty((len(candidates), 0, len(MORE)))
    ordered = np.empty((len(candidates), sum(map(len, times)), 2 + len(MORE)))
    ordered[places_in] = np.concatenate(rows_of, axis=1)
    return np.concatenate(times), np.concatenate(tracks), np.concatenate(owners), ordered[
        ..., :2], ordered[..., 2:]


def square_errors(truth, followed):
    """(candidates, [sum of squares, count]) of places against the truth, where the target is
    visible."""
    times, _, owners, places, _ = followed
    scan = truth.scan_of(times)
    counts = truth.visible[scan, owners]
    off = places[:, counts] - truth.place_m[scan[counts], owners[counts]]
    return np.column_stack([(off ** 2).sum(axis=(1, 2)), np.full(len(places), counts.sum())])


def as_tracks(truth, followed, candidate=0):
    times, ids, _, places, more = followed
    return tracks_by_scan(truth, times, ids, places[candidate], more[candidate])
