# SPDX-License-Identifier: MIT
"""Tracks against truth, scan by scan: which track is which target's, and what follows from it."""
import dataclasses

import numpy as np
from scipy.optimize import linear_sum_assignment

from common import scene_files

GATE_SHARE = 0.0125  # of the largest range: a track so near to a target may be that target's
# of the slowest sensor: for so long a track may stay behind where its target left or died
FORGIVEN_TURNS = 5
KEPT_PAIR = 0.5  # in gates: by so much another pairing must be nearer than that of the last scan
FORBIDDEN = 1e4
ELLIPSE = -2 * np.log(0.05)  # chi-square of two axes that 95 % are below


def gate_m(sensors):
    return GATE_SHARE * max(sensor.range_max_m for sensor in sensors.values())


def forgiven_scans(scene):
    """FORGIVEN_TURNS as scans of all sensors of a scene; of a single radar whose turns are scans
    just as many."""
    sensors = scene.get("radars", []) + scene.get("passive", [])
    turns_s = [sensor.get("turn_s", sensor.get("interval_s")) for sensor in sensors]
    scans_per_s = sum(sensor.get("sectors", 1) / turn_s for sensor, turn_s in zip(sensors, turns_s))
    return round(FORGIVEN_TURNS * max(turns_s) * scans_per_s)


def pair(distance, is_kept):
    """As many pairs as there can be, and of those the nearest ones; distances in gates, beyond 1
    there is no pair. Returns rows and columns."""
    near = distance <= 1
    if not near.any():
        return np.empty(0, dtype=int), np.empty(0, dtype=int)
    if near.sum(axis=0).max() <= 1 and near.sum(axis=1).max() <= 1:
        return np.nonzero(near)
    rows, cols = linear_sum_assignment(np.where(near, distance - KEPT_PAIR * is_kept, FORBIDDEN))
    allowed = near[rows, cols]
    return rows[allowed], cols[allowed]


def ratio(error, covariance):
    """e^T P^-1 e of rows, over the 2 that it is in the mean where P, rows of xx, yx, yy, is right;
    NaN where P is not given or not positive definite."""
    xx, yx, yy = covariance.T
    det = xx * yy - yx ** 2
    with np.errstate(invalid="ignore", divide="ignore"):
        square = (error[:, 0]**2 * yy - 2 * error[:, 0] * error[:, 1] * yx +
                  error[:, 1]**2 * xx) / det
        return np.where((xx > 0) & (det > 0), square, np.nan) / 2


def mean(values):
    known = values[~np.isnan(values)]
    return float(known.mean()) if len(known) else float("nan")


def consistency(off_m, off_mps, more, motions):
    """Of pairs, all and by motion: root mean square errors, NEES over what it is where covariances
    are right, and shares inside the ellipse of 95 %. Keys of a motion end with its name."""
    place, velocity = ratio(off_m, more[:, 2:5]), ratio(off_mps, more[:, 5:8])
    found = {}
    for motion, name in [(None, ""), *enumerate(scene_files.MOTIONS)]:
        rows = np.full(len(off_m), True) if motion is None else motions == motion
        end = name and "_" + name
        found["pairs" + end] = float(rows.sum())
        found["rms_m" + end] = float(np.sqrt(mean((off_m[rows] ** 2).sum(axis=1))))
        found["rms_mps" + end] = float(np.sqrt(mean((off_mps[rows] ** 2).sum(axis=1))))
        for key, values in (("place", place[rows]), ("velocity", velocity[rows])):
            known = values[~np.isnan(values)]
            found[f"nees_{key}{end}"] = mean(known)
            found[f"inside_{key}{end}"] = mean((2 * known <= ELLIPSE).astype(float))
    return found


def pairs_of(truth, tracks, paired):
    """What `consistency` asks of pairs (scan, target, index of the track in the scan)."""
    scan, target, _ = np.array(paired, dtype=int).reshape(-1, 3).T
    places = np.array([tracks.place_m[k][col] for k, _, col in paired]).reshape(-1, 2)
    more = np.full((len(paired), len(scene_files.MORE)), np.nan)
    if tracks.more is not None and paired:
        more = np.array([tracks.more[k][col] for k, _, col in paired])
    velocity = np.full(
        (len(paired), 2), np.nan) if truth.velocity_mps is None else truth.velocity_mps[scan,
                                                                                        target]
    motions = np.where(more[:, -1] == 1, scene_files.COASTING,
                       truth.motions()[scan, target])
    return places - truth.place_m[scan, target], more[:, :2] - velocity, more, motions


@dataclasses.dataclass
class Walk:
    """What `follow` saw; tracks by their index in the scan."""
    paired: list  # (scan, target, track)
    false_rows: list  # (scan, track)
    switch_scans: list
    first_track: np.ndarray  # of each target, the scan; -1: it never had one


def score(truth, tracks, gate, forgiven=FORGIVEN_TURNS):
    """Figures of one run, and the rows of false tracks as (scan, index in the scan).

    completeness   share of (target, scan), target visible, that have a track
    false_per_scan tracks that are no target's; forgiven are those whose last target, or a target
    near them, went out of sight
                   at most `forgiven` scans ago
    switches       a target's track is another one than its last; not after it was out of sight for
    longer than that rms_m          of places, over all pairs; beside it, and by motion, what
    `consistency` has delays_scans   scans from a target's first visibility to its first track, of
    the targets that ever had one delay_mean_scans, never_tracked, false_tracks: their mean, the
    targets without one, and how many tracks were ever false
    """
    walk = follow(truth, tracks, gate, forgiven)
    visible, num_scans = truth.visible, len(truth.visible)
    chances = int(visible.sum())
    first_visible = np.where(visible.any(axis=0), visible.argmax(axis=0), -1)
    delays = [
        int(first - seen) if first >= 0 else None
        for first, seen in zip(walk.first_track, first_visible) if seen >= 0
    ]
    found = [delay for delay in delays if delay is not None]
    return {
        "completeness": len(walk.paired) / chances if chances else float("nan"),
        "false_per_scan": len(walk.false_rows) / num_scans if num_scans else float("nan"),
        "switches": float(len(walk.switch_scans)),
        **consistency(*pairs_of(truth, tracks, walk.paired)),
        "delay_mean_scans": float(np.mean(found)) if found else float("nan"),
        "delays_scans": found,
        "never_tracked": float(len(delays) - len(found)),
        "false_tracks": float(len({tracks.ids[k][col] for k, col in walk.false_rows})),
    }, walk.false_rows


def follow(truth, tracks, gate, forgiven):
    """Scan by scan: whose track is which."""
    visible = truth.visible
    num_scans, num_targets = visible.shape
    last_track = [None] * num_targets  # of each target
    last_paired = np.full(num_targets, -1)
    last_visible = np.full(num_targets, -1)
    visit = np.zeros(num_targets, dtype=int)  # its present one began at this scan
    last_target = {}  # of each track
    first_track = np.full(num_targets, -1)
    paired, false_rows, switch_scans = [], [], []
    for k in range(num_scans):
        seen = np.nonzero(visible[k])[0]
        returned = seen[(last_visible[seen] >= 0) & (k - last_visible[seen] - 1 > forgiven)]
        visit[returned] = k
        last_visible[seen] = k
        ids, places = tracks.ids[k].tolist(), tracks.place_m[k]
        if not ids:
            continue
        apart = np.linalg.norm(truth.place_m[k, seen][:, None, :] - places[None, :, :],
                               axis=2) / gate
        kept = np.array([[last_track[j] == track and last_paired[j] == k - 1
                          for track in ids] for j in seen.tolist()], dtype=bool).reshape(
                              len(seen), len(ids)) if len(seen) and len(ids) else np.zeros(
                                  (len(seen), len(ids)))
        rows, cols = pair(apart, kept) if len(seen) else (np.empty(0, dtype=int),) * 2
        taken = set(cols.tolist())
        for row, col in zip(rows.tolist(), cols.tolist()):
            j, track = int(seen[row]), ids[col]
            paired.append((k, j, col))
            if last_track[j] is not None and last_track[j] != track and last_paired[j] >= visit[j]:
                switch_scans.append(k)
            if first_track[j] < 0:
                first_track[j] = k
            last_track[j], last_paired[j], last_target[track] = track, k, j
        gone = np.nonzero((last_visible >= 0) & (last_visible < k)
                          & (k - last_visible <= forgiven))[0]
        for col, track in enumerate(ids):
            if col in taken or last_target.get(track, -1) in gone:
                continue
            with np.errstate(invalid="ignore"):
                if (np.linalg.norm(truth.place_m[k, gone] - places[col], axis=1) <= gate).any():
                    continue
            false_rows.append((k, col))
    return Walk(paired, false_rows, switch_scans, first_track)
