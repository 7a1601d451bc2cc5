# SPDX-License-Identifier: MIT
"""
Tuning for your radar
=====================

Six presets to begin with, and what it costs to state a wrong noise.
"""
import numpy as np
import pandas as pd

import rhotrack

# %%
# A preset is a kind of radar; rhotrack/settings.h says where its figures come from.
kinds = ["en_route", "approach", "marine", "coastal_harbour", "drone_defence", "traffic"]
shown = ["v_min_mps", "v_max_mps", "accel_max_mps2", "pd", "sigma_range_m", "sigma_azimuth_rad",
         "range_max_m", "false_tracks_per_hour", "coast_scans_max"]
pd.DataFrame({kind: {name: f"{rhotrack.Settings.preset(kind)[name]:g}" for name in shown}
              for kind in kinds})

# %%
# A ship's radar among sea clutter: boats at up to 20 m/s, a turn in 2.5 s, the noise of the preset.
random = np.random.default_rng(3)
sigma_range_m, sigma_azimuth_rad = 15, 0.009
starts, headings = random.uniform(-8e3, 8e3, (8, 2)), random.uniform(-np.pi, np.pi, 8)
speeds = random.uniform(5, 20, (8, 1)) * np.stack([np.cos(headings), np.sin(headings)], axis=1)


def scan_at(time_s):
    places = (starts + time_s * speeds)[random.random(8) < 0.8]
    range_m = np.concatenate([np.hypot(*places.T) + random.normal(0, sigma_range_m, len(places)),
                              random.uniform(100, 12e3, 60)])
    azimuth = np.concatenate([
        np.arctan2(*places.T[::-1]) + random.normal(0, sigma_azimuth_rad, len(places)),
        random.uniform(-np.pi, np.pi, 60)])
    return {"t_s": np.full(len(range_m), time_s), "sensor_id": np.ones(len(range_m), int),
            "range_m": range_m, "azimuth_rad": (azimuth + np.pi) % (2 * np.pi) - np.pi}


scans = [pd.DataFrame(scan_at(2.5 * i)) for i in range(160)]
settings = rhotrack.Settings.preset("marine", range_max_m=14000)
tracks = rhotrack.Tracker(settings).run(scans)
rhotrack.plot(rhotrack.Scans(scans, settings), tracks)

# %%
# With a noise that is stated too small tracks begin later, break, and are less exact than they
# claim; stated too large it costs little, as the tracker learns a sensor's noise from its tracks,
# but the claim is too large. In metres: the root mean square error of the place, and the sigma_m
# that the tracks state.


def score(tracks):
    rows = tracks[tracks["status"] != "tentative"]
    truth = starts + rows["t_s"][:, None, None] * speeds
    away = np.hypot(truth[..., 0] - rows["x_m"][:, None], truth[..., 1] - rows["y_m"][:, None])
    boat, error = away.argmin(axis=1), away.min(axis=1)
    return {"error": np.sqrt(np.mean(error**2)), "sigma_m": np.sqrt(np.mean(rows["sigma_m"]**2)),
            "first track, s": np.mean([rows["t_s"][boat == one].min() for one in np.unique(boat)]),
            "tracks": len(np.unique(rows["track_id"]))}


pd.set_option("display.precision", 1)
pd.DataFrame({f"{factor:g} x noise": score(rhotrack.Tracker(settings.copy(
    sigma_range_m=factor * sigma_range_m, sigma_azimuth_rad=factor * sigma_azimuth_rad)).run(scans))
    for factor in (0.25, 0.5, 1, 2, 4)}).T

# %%
# A recording of some minutes is better than a guess: ``rhotrack calibrate plots.csv -o radar.ini``
# measures noise, detection probability, clutter and turn time, and
# ``rhotrack.Settings("radar.ini")`` reads them.
