# SPDX-License-Identifier: MIT
"""The targets of Fan et al., "Neutrosophic Hough Transform-Based Track Initiation Method for
Multiple Target Tracking", other paths of a few scans, and plots of them by chance."""
import numpy as np

import rhotrack

SCANS = 7
V_MIN_MPS, V_MAX_MPS = 100.0, 400.0  # of Table 1's targets

# Table 1: x (m), vx (m/s), y (m), vy (m/s) at the first scan; 2 s a scan, 10 m of noise
TABLE_1 = ((300, 280.0, 400, 49.0), (3000, -173.2, 300, -100.0), (2100, -173.2, 1300, -100.0))
TABLE_1_INTERVAL_S = 2.0
TABLE_1_SIGMA_M = 10.0
PROCESS_MPS = 10.0  # of w in equation (33)
TABLE_1_BOX_M = (0, 4000, -1000, 1500)  # x, x, y, y

# Table 3: real plots, x and y (m) by scan and aircraft; 10 s a scan
TABLE_3 = np.array([[[-23793, 24841], [-2548, 21411], [-7021, 14156]],
                    [[-21011, 25246], [-5080, 20251], [-8675, 16448]],
                    [[-18300, 25575], [-7720, 19125], [-10248, 18720]],
                    [[-15547, 25858], [-10322, 17938], [-11849, 21086]],
                    [[-12823, 26185], [-12766, 16739], [-13363, 23508]],
                    [[-10050, 26402], [-15310, 15467], [-14961, 25823]],
                    [[-7248, 26643], [-17794, 14169], [-16459, 28155]]], float)
TABLE_3_INTERVAL_S = 10.0
TABLE_3_SIGMA_M = 60.0  # what a straight line leaves of the slight turns, each axis
TABLE_3_BOX_M = (-25000, -1000, 13000, 29000)

ROW = [("t_s", "f8"), ("sensor_id", "i4"), ("x_m", "f4"), ("y_m", "f4")]


# ---- paths: places (scans, targets, 2), 2 s a scan ----


def straight(starts, scans=SCANS, interval_s=TABLE_1_INTERVAL_S):
    x_m, vx_mps, y_m, vy_mps = np.array(starts, float).T
    t_s = interval_s * np.arange(scans)[:, None]
    return np.stack([x_m + vx_mps * t_s, y_m + vy_mps * t_s], axis=2)


def turning(start, turn_rad, scans=SCANS, interval_s=TABLE_1_INTERVAL_S):
    """Constant speed; the heading changes by turn_rad at each scan."""
    x_m, vx_mps, y_m, vy_mps = start
    velocity_mps = complex(vx_mps, vy_mps) * np.exp(1j * turn_rad * np.arange(1, scans))
    place = np.concatenate([[0], interval_s * np.cumsum(velocity_mps)]) + complex(x_m, y_m)
    return np.stack([place.real, place.imag], axis=1)[:, None]


def accelerating(start, accel_mps2, scans=SCANS, interval_s=TABLE_1_INTERVAL_S):
    """Constant acceleration along the first velocity."""
    x_m, vx_mps, y_m, vy_mps = start
    t_s, heading = interval_s * np.arange(scans), np.array([vx_mps, vy_mps])
    path_s = t_s + accel_mps2 / np.hypot(*heading) * t_s**2 / 2
    return (np.array([x_m, y_m]) + path_s[:, None] * heading)[:, None]


def wandering(starts, change_mps, rng, scans=SCANS, interval_s=TABLE_1_INTERVAL_S):
    """Each interval adds a normal velocity change of this standard deviation, each axis, at a
    constant rate."""
    paths_m = straight(starts, scans, interval_s)
    change = change_mps * rng.standard_normal((scans - 1, len(starts), 2))
    change_by_end, sums = np.cumsum(change, axis=0), np.zeros_like(paths_m)
    sums[1:] = np.cumsum(change_by_end - change / 2, axis=0)
    return paths_m + interval_s * sums


# ---- plots ----


def area_m2(box_m):
    return (box_m[1] - box_m[0]) * (box_m[3] - box_m[2])


def clutter(box_m, mean, rng):
    """Places (n, 2), uniform in the box."""
    return rng.uniform(box_m[::2], box_m[1::2], (rng.poisson(mean), 2))


def observed(paths_m, noise_m, pd, sources, rng):
    """[(places (n, 2), target of each, -1: clutter)] of each scan, in random order. sources: [(box,
    mean number of clutter plots)]."""
    scans = []
    for places in paths_m:
        seen = np.flatnonzero(rng.random(len(places)) < pd)
        hits = places[seen] + noise_m * rng.standard_normal((len(seen), 2))
        other = np.concatenate([clutter(box, mean, rng) for box, mean in sources])
        order = rng.permutation(len(hits) + len(other))
        scans.append((np.concatenate([hits, other])[order],
                      np.concatenate([seen, np.full(len(other), -1)])[order]))
    return scans


def rows_of(t_s, places):
    """Rows of one scan as the package takes them; the first one stands for a scan without plots."""
    rows = np.zeros(len(places) + 1, ROW)
    rows["t_s"], rows["sensor_id"] = t_s, 1
    rows["x_m"][0] = rows["y_m"][0] = np.nan
    rows["x_m"][1:], rows["y_m"][1:] = places.T
    return rows


def scans_of(plots, interval_s, settings):
    return rhotrack.Scans([rows_of(interval_s * k, places) for k, (places, _) in enumerate(plots)],
                          settings)


def area_settings(box_m):
    """The parameters of the area of clutter and births."""
    return dict(zip(("area_x_min_m", "area_x_max_m", "area_y_min_m", "area_y_max_m"), box_m))
