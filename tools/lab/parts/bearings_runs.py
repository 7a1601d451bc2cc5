# SPDX-License-Identifier: MIT
"""Runs of experiment bearings: a sky through the program, and the score; and the oracle, an
extended Kalman filter of each target that is told which bearings are the target's and which process
noise is best, opened by a fit to those of its first three frames."""
import math
import pathlib
import re
import subprocess
import tempfile

from common import experiment  # before numpy, whose threads it limits

import numpy as np

from common import scene_files
from common import scoring
from parts import stonesoup_bearings
from parts.bearings_scenes import PLACE, VELOCITY, Sky
from parts.passive_scenes import wrapped

FIRST_FRAMES = 3  # that open the oracle
FIT_STEPS = 12
SETTLED_FRAMES = 8  # before them no place counts for rms
DENSITIES_M2PS3 = (0.02, 2.0, 20.0, 200.0)  # of the white acceleration that the oracle assumes
LOST_M, STRAY_M = 2500, 5000  # a target without a track this near, a track so far from all targets
REFUSED = 2  # exit code of the program
ANGLES = (("bearing_rad", "sigma_rad"), ("elevation_rad", "sigma_elevation_rad"))
RHOTRACK, PAPER, ORACLE, STONE_SOUP = "rhotrack", "paper's pipeline", "oracle", "Stone Soup"


# ---- Oracle ----

def oracle(sky, density_m2ps3):
    """(frames, targets, 2, or 3 with elevations): places, NaN before the filter is open.
    density_m2ps3: one, or several (then the first axis)."""
    return filtered(sky, density_m2ps3)[0][..., sky.of.place]


def filtered(sky, density_m2ps3):
    """States x, y, vx, vy, z, vz, and covariances."""
    density = np.atleast_1d(np.asarray(density_m2ps3, float))
    targets, rows = sky.of.targets, sky.rows
    states = np.full((len(density), targets, 6), np.nan)
    covariances = np.zeros((len(density), targets, 6, 6))
    found = np.full((len(density), len(sky.times_s), targets, 6), np.nan)
    spread = np.full((*found.shape, 6), np.nan)
    own = [rows[rows["target_id"] == target] for target in range(targets)]
    opened = [np.unique(one["frame"])[FIRST_FRAMES - 1:FIRST_FRAMES].tolist() for one in own]
    is_look = np.isnan(rows["bearing_rad"])
    looks, seen_at = rows[is_look], np.cumsum(is_look) - 1
    seen = rows["target_id"] >= 0
    angles = np.full((len(looks), targets, len(ANGLES)), np.nan)
    angles[seen_at[seen], rows["target_id"][seen]] = angles_of(rows[seen])
    by_frame = [np.flatnonzero(looks["frame"] == k) for k in range(len(sky.times_s))]
    now_s = sky.times_s[0]
    for k, frame_s in enumerate(sky.times_s):
        for i in by_frame[k]:
            states, covariances = predicted(states, covariances, looks["t_s"][i] - now_s, density)
            now_s = looks["t_s"][i]
            states, covariances = updated(states, covariances, looks[i], angles[i])
        states, covariances = predicted(states, covariances, frame_s - now_s, density)
        now_s = frame_s
        for target in range(targets):
            if opened[target] == [k]:
                first = own[target][own[target]["frame"] <= k]
                state, covariance = fit(first, frame_s, sky.truth[k, target], sky.of.settings)
                states[:, target] = state
                covariances[:, target] = covariance + sky.of.interval_s * density[
                    :, None, None] * np.diag([0, 0, 1, 1, 0, 1])
        found[:, k], spread[:, k] = states, covariances
    return (found, spread) if np.ndim(density_m2ps3) else (found[0], spread[0])


def angles_of(rows):
    return np.stack([rows[name] for name, _ in ANGLES], -1)


def expected(away_m):
    """Bearings and elevations (..., 2) of places (..., 3) as seen from the sensor, and their
    derivatives (..., 2, 3) by the place."""
    x_m, y_m, z_m = np.moveaxis(away_m, -1, 0)
    flat_m, zero = np.hypot(x_m, y_m), np.zeros_like(x_m)
    by_bearing = np.stack([-y_m, x_m, zero], -1) / flat_m[..., None]**2
    by_elevation = np.stack([-z_m * x_m / flat_m, -z_m * y_m / flat_m, flat_m], -1) / (
        flat_m**2 + z_m**2)[..., None]
    return (np.stack([np.arctan2(y_m, x_m), np.arctan2(z_m, flat_m)], -1),
            np.stack([by_bearing, by_elevation], -2))


def sensor_of(rows):
    return np.stack([rows[name] for name in ("sensor_x_m", "sensor_y_m", "sensor_z_m")], -1)


def fit(rows, t_s, start, settings):
    """The constant velocity at t_s that these angles make most likely, and its covariance, by
    Gauss-Newton from the truth; before them half the range and the speed are standard deviations,
    so that there is an answer where sensors and target are in line."""
    state, dt_s, measured = np.array(start, float), rows["t_s"] - t_s, angles_of(rows)
    is_known = ~np.isnan(measured)
    sigmas = np.stack([rows[name] for _, name in ANGLES], -1)[is_known]
    prior = np.zeros((6, 6))
    for axes, sigma in (PLACE, settings["range_max_m"] / 2), (VELOCITY, settings["v_max_mps"] / 2):
        prior[axes, axes] = sigma**-2.0
    for _ in range(FIT_STEPS):
        angles, by_place = expected(
            state[PLACE] + dt_s[:, None] * state[VELOCITY] - sensor_of(rows))
        by_state = np.zeros((*measured.shape, 6))
        by_state[..., PLACE], by_state[..., VELOCITY] = by_place, dt_s[:, None, None] * by_place
        off, by_state = (wrapped(measured - angles)[is_known] / sigmas,
                         by_state[is_known] / sigmas[:, None])
        covariance = np.linalg.inv(prior + by_state.T @ by_state)
        state = state + covariance @ (by_state.T @ off - prior @ state)
    return state, covariance


def predicted(states, covariances, dt_s, density):
    """A constant velocity with white acceleration of each density."""
    move, noise = np.eye(6), np.zeros((6, 6))
    move[PLACE, VELOCITY] = dt_s
    noise[PLACE, PLACE], noise[VELOCITY, VELOCITY] = dt_s**3 / 3, dt_s
    noise[PLACE, VELOCITY] = noise[VELOCITY, PLACE] = dt_s**2 / 2
    return states @ move.T, move @ covariances @ move.T + density[:, None, None, None] * noise


def updated(states, covariances, look, measured):
    """By one look's angles of each target, NaN where it has none: one after the other."""
    for i, (_, sigma) in enumerate(ANGLES):
        angles, by_place = expected(states[..., PLACE] - sensor_of(look))
        row = np.zeros_like(states)
        row[..., PLACE] = by_place[..., i, :]
        spread = np.einsum("cnij,cnj->cni", covariances, row)
        total = np.einsum("cni,cni->cn", row, spread) + look[sigma]**2
        off_rad = wrapped(measured[:, i] - angles[..., i])
        is_known = ~np.isnan(off_rad)
        gain = np.where(is_known, 1 / np.where(is_known, total, 1), 0)[..., None] * spread
        states = states + gain * np.where(is_known, off_rad, 0)[..., None]
        covariances = covariances - gain[..., None] * spread[..., None, :]
    return states, covariances


# ---- Score ----

def truth_of(sky):
    return scene_files.Truth(
        np.rint(sky.times_s * 1e6).astype(np.int64), np.arange(sky.of.targets),
        sky.truth[..., sky.of.place], sky.visible)


def as_tracks(sky, places_m):
    """Each target's place as its track, where there is one and the target counts."""
    is_there = sky.visible & np.isfinite(places_m).all(axis=-1)
    return scene_files.Tracks([np.flatnonzero(row) for row in is_there],
                              [place[row] for place, row in zip(places_m, is_there)])


def score(sky, tracks):
    """Sums over a run, of which `figures_of` makes shares and means."""
    truth, visible = truth_of(sky), sky.visible
    walk = scoring.follow(truth, tracks, sky.of.gate_m, 0)
    off_m2 = np.array([(truth.place_m[k, target] - tracks.place_m[k][col])**2
                       for k, target, col in walk.paired
                       if k >= SETTLED_FRAMES]).reshape(-1, len(sky.of.place))
    waits = [(first if first >= 0 else len(visible)) - seen.argmax()
             for first, seen in zip(walk.first_track, visible.T) if seen.any()]
    return {
        "paired": len(walk.paired), "chances": int(visible.sum()), "frames": len(visible),
        "false": len(walk.false_rows), "waits": int(sum(waits)), "targets": len(waits),
        "off_m2": float(off_m2[:, :2].sum()), "settled": len(off_m2), "hours": sky.of.hours,
        "height_off_m2": float(off_m2[:, 2].sum()) if sky.of.has_elevations else math.nan,
        "wrong": is_wrong(truth.place_m[-1][visible[-1]] / sky.of.scale,
                          tracks.place_m[-1] / sky.of.scale),
        "starts": len(np.unique(np.concatenate(tracks.ids)))
    }


def is_wrong(targets_m, tracks_m):
    """Whether a target has no track near it, or a track is far from all targets."""
    apart_m = np.linalg.norm(targets_m[:, None] - np.asarray(tracks_m).reshape(
        1, -1, targets_m.shape[1]), axis=-1)
    return bool((apart_m.min(axis=1, initial=np.inf) > LOST_M).any()
                or (apart_m.min(axis=0, initial=np.inf) > STRAY_M).any())


def figures_of(scores):
    """{figure: (value, standard error)} over runs; NaN where there is nothing to divide by."""
    def sums(name):
        return np.array([one[name] for one in scores], float)
    def rms_of(name):
        value = experiment.ratio_of(sums(name), sums("settled"))
        return (math.nan, math.nan) if math.isnan(value[0]) else experiment.root_of(*value)
    return {
        "completeness": experiment.ratio_of(sums("paired"), sums("chances")),
        "false": experiment.ratio_of(sums("false"), sums("frames")),
        "first": experiment.ratio_of(sums("waits"), sums("targets")),
        "rms_m": rms_of("off_m2"), "height_m": rms_of("height_off_m2"),
        "wrong": experiment.mean_of(sums("wrong")),
        "starts": experiment.ratio_of(sums("starts"), sums("hours"))
    }


# ---- Runs ----

class Refused(Exception):
    """The program does not take the input."""


def tracked(program, sky, words):
    """The program's tracks at the frames' times."""
    with tempfile.TemporaryDirectory(prefix="rhotrack-") as name:
        path, tracks = pathlib.Path(name) / "bearings.csv", pathlib.Path(name) / "tracks.csv"
        sky.write(path)
        sets = [word for key, value in sky.of.settings.items()
                for word in ("--set", f"{key}={value:.9g}")]
        done = subprocess.run([program, "track", path, *sets, *words, "-o", tracks],
                              capture_output=True, text=True, check=False)
        said = (done.stderr.strip().splitlines() or [""])[0]
        said = re.sub(r"^rhotrack: (\S+\.csv:\d+: )?", "", said)
        if done.returncode == REFUSED:
            raise Refused(said)
        if done.returncode:
            raise ChildProcessError(f"rhotrack track: exit {done.returncode}: {said}")
        axes = ("x_m", "y_m", "z_m")[:len(sky.of.place)]
        return scene_files.read_tracks(tracks, truth_of(sky), axes)


def run(job):
    """{who: score, or the message where the program refuses the sky; of the oracle one score for
    each of its densities, and its loss} of one seed."""
    scene, seed, others, options = job
    sky, found = Sky(scene, np.random.default_rng(seed)), {}
    own = [word for pair in options.set for word in ("--set", pair)]
    for who, words in ((RHOTRACK, own), (PAPER, [*own, "--pipeline", "paper"])):
        try:
            found[who] = score(sky, tracked(options.program, sky, words))
        except Refused as refusal:
            found[who] = str(refusal)
    if STONE_SOUP in others:
        found[STONE_SOUP] = score(sky, stonesoup_bearings.track(sky))
    if ORACLE in others:
        places_m = oracle(sky, DENSITIES_M2PS3)
        found[ORACLE] = [(loss_m2(sky, one), score(sky, as_tracks(sky, one))) for one in places_m]
    return found


def loss_m2(sky, places_m):
    """Square errors up to the gate, once the filters have settled."""
    off_m = np.linalg.norm(places_m - truth_of(sky).place_m, axis=-1)
    off_m = np.minimum(np.nan_to_num(off_m, nan=np.inf), sky.of.gate_m)
    return float((off_m**2)[SETTLED_FRAMES:][sky.visible[SETTLED_FRAMES:]].sum())


def best_oracle(runs):
    """The scores of the density that errs least over all runs."""
    losses = np.sum([[loss for loss, _ in one] for one in runs], axis=0)
    return [one[losses.argmin()][1] for one in runs]
