# SPDX-License-Identifier: MIT
"""Tracks against truth by GOSPA (order 2, alpha 2), and what follows from its pairs."""
import collections
import dataclasses
import math

import numpy as np
from scipy.optimize import linear_sum_assignment

from common import scoring


def pair(targets_m, tracks_m, cutoff_m):
    """Rows of targets and of tracks that are pairs, and their distances: the sum of squares, with
    half the cutoff's square for each that has no partner, is least."""
    apart_m = np.linalg.norm(targets_m[:, None] - tracks_m[None], axis=2)
    near = apart_m < cutoff_m
    alone = near & (near.sum(axis=1) == 1)[:, None] & (near.sum(axis=0) == 1)[None]
    rows, cols = np.nonzero(alone)
    near &= ~alone
    open_rows, open_cols = np.flatnonzero(near.any(axis=1)), np.flatnonzero(near.any(axis=0))
    if len(open_rows):
        block = np.ix_(open_rows, open_cols)
        cost = np.where(near[block], apart_m[block]**2 - cutoff_m**2, 0)
        more_rows, more_cols = linear_sum_assignment(cost)
        kept = near[block][more_rows, more_cols]
        rows = np.concatenate([rows, open_rows[more_rows[kept]]])
        cols = np.concatenate([cols, open_cols[more_cols[kept]]])
    return rows, cols, apart_m[rows, cols]


@dataclasses.dataclass
class Life:
    """A target over the times at which it is there."""
    times: int = 0
    paired: int = 0
    delay: int = 0  # times before its first track; where paired > 0
    track: int = None  # its last one
    is_tracked: bool = False
    switches: int = 0
    fragments: int = 0


class Evaluation:
    """Takes times one after the other; result() gives the figures of all."""

    def __init__(self, cutoff_m):
        self.cutoff_m = cutoff_m
        self.lives = collections.defaultdict(Life)
        self.rows = collections.Counter()  # of each track
        self.paired_rows = collections.Counter()
        self.localisation_m2, self.missed, self.false = [], [], []
        self.errors = []  # arrays of (distance^2, NEES of place and velocity over their ideal)

    def add(self, ids, places_m, velocities_mps, tracks):
        """Targets at a time, and the tracks then: rows of the package, with or without
        covariances. Returns how many are pairs."""
        tracks_m = np.column_stack([tracks["x_m"], tracks["y_m"]]).astype(float)
        rows, cols, apart_m = pair(places_m, tracks_m, self.cutoff_m)
        self.localisation_m2.append((apart_m**2).sum())
        self.missed.append(len(ids) - len(rows))
        self.false.append(len(tracks) - len(rows))
        track_ids = tracks["track_id"].tolist()
        self.rows.update(track_ids)
        partner = dict(zip(rows.tolist(), cols.tolist()))
        for number, target in enumerate(ids.tolist()):
            self._follow(self.lives[target], track_ids[partner[number]] if number in partner
                         else None)
        found = tracks[cols]
        self.errors.append(np.column_stack([
            apart_m**2, nees(found, tracks_m[cols] - places_m[rows], "x", "y"),
            nees(found, np.column_stack([found["vx_mps"], found["vy_mps"]])
                 - velocities_mps[rows], "vx", "vy")]))
        return len(rows)

    def _follow(self, life, track):
        life.times += 1
        if track is not None:
            if life.paired == 0:
                life.delay = life.times - 1
            life.switches += life.track not in (None, track)
            life.fragments += life.paired > 0 and not life.is_tracked
            life.paired += 1
            life.track = track
            self.paired_rows[track] += 1
        life.is_tracked = track is not None

    def result(self):
        """gospa_m and its parts: roots of means over the times; missed and false a time;
        completeness: share of (target, time) with a track; fragments: a target has a track again;
        delay: times before the first track, mean of the targets that had one; false_tracks:
        without a partner in more than half of their rows; nees: 2 where covariances are right;
        velocity_ratio: the same of velocities over 2; inside: shares in the ellipse of 95 %."""
        localisation_m2 = np.mean(self.localisation_m2)
        missed, false = np.mean(self.missed), np.mean(self.false)
        lives = self.lives.values()
        times = sum(life.times for life in lives)
        errors = np.concatenate(self.errors)
        found = [life.delay for life in lives if life.paired]
        return {
            "gospa_m": math.sqrt(localisation_m2 + self.cutoff_m**2 / 2 * (missed + false)),
            "localisation_m": math.sqrt(localisation_m2), "missed": missed, "false": false,
            "target_times": times,
            "completeness": sum(life.paired for life in lives) / times if times else math.nan,
            "switches": sum(life.switches for life in lives),
            "fragments": sum(life.fragments for life in lives),
            "delay_scans": np.mean(found) if found else math.nan,
            "false_tracks": sum(2 * self.paired_rows[track] < count
                                for track, count in self.rows.items()),
            "rmse_m": math.sqrt(scoring.mean(errors[:, 0])),
            "nees": 2 * scoring.mean(errors[:, 1]), "nees_inside": inside(errors[:, 1]),
            "velocity_ratio": scoring.mean(errors[:, 2]), "velocity_inside": inside(errors[:, 2])}


def nees(tracks, off, first, second):
    """Over its ideal, 2; NaN without covariances."""
    names = [f"cov_{a}_{b}" for a, b in ((first, first), (second, first), (second, second))]
    if names[0] not in tracks.dtype.names:
        return np.full(len(tracks), np.nan)
    return scoring.ratio(off, np.column_stack([tracks[name] for name in names]).astype(float))


def inside(ratios):
    known = ratios[~np.isnan(ratios)]
    return scoring.mean((2 * known <= scoring.ELLIPSE).astype(float))
