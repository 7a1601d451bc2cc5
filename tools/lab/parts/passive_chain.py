# SPDX-License-Identifier: MIT
"""The chain of experiment passive: frames of bearings through the tracker, beside an extended
Kalman filter in double precision that is told which bearings are a target's."""
import math
import time

from common import experiment  # before numpy, whose threads it limits

import numpy as np

import rhotrack
from parts.passive_scenes import Setting, fit, predict, update
from common.experiment import ratio_of, root_of
from parts.passive_runs import facts_of, judge_rate, runs_of, text_of

NEAR_M, NEAR_SIGMAS = 1000, 4  # a track this near to a target is the target's
RMS_RATIO_MAX = 1.08
SETTINGS = {"v_min_mps": 150, "v_max_mps": 250, "accel_max_mps2": 5, "sigma_rad": math.radians(0.1)}
DENSITY_M2PS3 = (0.5 * SETTINGS["accel_max_mps2"])**2  # as the tracker's: half of it for 1 s
FIRST_FRAMES = 8  # that open the filter


def chained(sensors, targets, pd=0.9, false_mean=1, frames=24):
    """Slow enough to stay in front of the sensors all the time."""
    return Setting(sensors, targets, 0.1, pd, false_mean, frames=frames, speed_mps=(150, 250))


CASES = {  # bars: tracked at the end, false tracks a run
    "2 sensors, 2 targets": (chained(2, 2, 1, 0), .99, .02),
    "2 sensors, 4 targets, P_D 0.9, 1 false": (chained(2, 4), .97, .12),
    "3 sensors, 4 targets, P_D 0.9, 1 false": (chained(3, 4), .99, .02),
    "4 sensors, 6 targets, P_D 0.9, 1 false": (chained(4, 6), .99, .02),
    "2 sensors, no target, 4 false": (chained(2, 0, .9, 4, 60), None, .01),
    "3 sensors, no target, 4 false": (chained(3, 0, .9, 4, 60), None, .01),
}


def follow(case, scene):
    """Targets tracked at the last frame and found at all, sum of the frames of confirmation, false
    tracks, pairs of a target and its track once the filter is open, their squared errors, the
    filter's, us a frame."""
    scans, tracker = rhotrack.Scans(scene.frames()), rhotrack.Tracker(**SETTINGS)
    start_s = time.thread_time()
    tracks = tracker.run(scans)
    frame_us = 1e6 * (time.thread_time() - start_s) / scene.of.frames
    tracks = tracks[tracks["status"] != "tentative"]
    truth, filtered = scene.truth(scene.times_s), filter_places(scene)
    confirmed_at = np.zeros(scene.of.targets, int)
    tracked, owners, compared, squares_m2 = 0, [], 0, np.zeros(2)
    for k, time_s in enumerate(scene.times_s):
        now = tracks[np.abs(tracks["t_s"] - time_s) < 1e-3]
        near_m = np.maximum(NEAR_M, NEAR_SIGMAS * now["sigma_m"])
        for target, place_m in enumerate(truth[k, :, :2]):
            off_m = np.hypot(now["x_m"] - place_m[0], now["y_m"] - place_m[1])
            off_m[off_m >= near_m] = np.inf
            if np.isfinite(off_m).any():
                owners.append(now["track_id"][off_m.argmin()])
                confirmed_at[target] = confirmed_at[target] or k + 1
                tracked += k + 1 == scene.of.frames
                if k + 1 >= FIRST_FRAMES:  # the filter is open
                    compared += 1
                    squares_m2 += off_m.min()**2, ((filtered[k, target] - place_m)**2).sum()
    false = sum(2 * owners.count(track_id) < frames
                for track_id, frames in zip(*np.unique(tracks["track_id"], return_counts=True)))
    return (tracked, (confirmed_at > 0).sum(), confirmed_at.sum(), false, compared, *squares_m2,
            frame_us)


def filter_places(scene):
    """(frames, targets, 2), from the frame that opens the filter on; before it NaN."""
    times_s, seen = scene.times_s, scene.seen
    places_m = np.full((len(times_s), scene.of.targets, 2), np.nan)
    for target in range(scene.of.targets):
        own, first = seen[seen["target_id"] == target], FIRST_FRAMES - 1
        state, covariance = fit(own[own["frame"] <= first], times_s[first],
                                scene.truth(times_s[first])[target])
        places_m[first, target] = state[:2]
        for k in range(FIRST_FRAMES, len(times_s)):
            state, covariance = predict(state, covariance, times_s[k] - times_s[k - 1],
                                        DENSITY_M2PS3)
            for row in own[own["frame"] == k]:
                state, covariance = update(state, covariance, row)
            places_m[k, target] = state[:2]
    return places_m


def tell(report):
    runs, rows, facts = runs_of(report, "chain", CASES, follow), [], []
    for name, (setting, tracked_min, false_max) in CASES.items():
        tracked, found, frames, false, pairs, off_m2, filter_m2, frame_us = np.array(runs[name]).T
        count = len(tracked)
        share, _ = ratio_of(tracked, np.full(count, setting.targets))
        at_frame, _ = ratio_of(frames, found)
        ratio, error = root_of(*ratio_of(off_m2, filter_m2))
        rms_m, filter_rms_m = (root_of(*ratio_of(one, pairs))[0] for one in (off_m2, filter_m2))
        judge_rate(report, f"chain, {name}: false tracks a run", false, false_max)
        if setting.targets:
            report.at_least(f"chain, {name}: tracked at the end", share, tracked_min,
                            trials=count * setting.targets)
            report.at_most(f"chain, {name}: rms error over the filter's that knows", ratio,
                           RMS_RATIO_MAX, error)
        rows.append([name, setting.frames, text_of(share, 3), text_of(at_frame, 2),
                     text_of(false.mean(), 3), text_of(rms_m / 1e3, 3),
                     text_of(filter_rms_m / 1e3, 3), text_of(ratio, 3),
                     text_of(frame_us.mean(), 0)])
        facts.append(facts_of(
            name, setting, tracked=share, confirmed_at_frame=at_frame,
            false_tracks_per_run=false.mean(), rms_m=rms_m, filter_rms_m=filter_rms_m,
            frame_us=frame_us.mean()))
    report.heading("Bearings through the tracker")
    report.text(
        f"The whole chain, {count} runs, 10 s a frame, 0.1 degrees, targets of 150 to 250 m/s. "
        "Tracked: share of the targets with a believed track within 1 km, or 4 of its standard "
        "deviations where that is more, at the last frame. False: believed tracks that are so near "
        "to a target in less than half of their frames. Filter: an extended Kalman filter in "
        "double precision with the target's own bearings, opened with a fit to those of the first "
        "8 frames; rms of the place over the same frames. Us: processor time.")
    report.table(["bearings through the tracker", "frames", "tracked at the end",
                  "confirmed at frame", "false tracks a run", "rms km", "filter's", "ratio",
                  "us a frame"], rows)
    report.fact("chain", facts)
    report.fact("chain_runs", count)
