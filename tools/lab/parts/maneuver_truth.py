# SPDX-License-Identifier: MIT
"""Scenes of the maneuver experiment: targets that pull up to 30 g, a radar that looks at one of
them in clutter every quarter of a second for 40 s; all runs of a case side by side.

Arrays have the runs first: truth (runs, SCANS, 6) are places and velocities.
"""
import math
from dataclasses import dataclass

import numpy as np

from common import experiment  # noqa: F401  puts the package on the path
import rhotrack

SCANS, INTERVAL_S = 161, 0.25
CLEAN_SCANS = 3  # the target alone, and always seen
G_MPS2 = 9.80665
HALF_BEAM_DEG = 0.6  # of the paper's 1.2, to either side
START = np.array([50e3, 35e3, 300.0, -600.0, -500.0, 0.0])
PRINTED_START = np.array([5e3, 53e3, 300.0, -6.0, -5.0, 0.0])  # the digits in the paper's order
START_SIGMA = math.sqrt(500.0)  # of the paper's P(0|0) = 500 I, which its first plot tells
CLUTTER_MIN = 0.1  # plots that a scan without clutter counts as having
PLACE_MAX_M, SPEED_MAX_MPS = 2e6, 2e4  # of plots; tracks that are lost go there
START_SIGMA_MPS = 1000.0  # of velocities that are not measured
SIGMA_NOTHING_MPS = 1e5  # a filter learns nothing from such a velocity

STATE = ["x_m", "y_m", "z_m", "vx_mps", "vy_mps", "vz_mps"]
SIGMAS = ["sigma_range_m", "sigma_cross_m", "sigma_up_m", "sigma_mps"]
FIELDS = [("t_s", "f8"), ("sensor_id", "i4"), *[(name, "f4") for name in STATE + SIGMAS]]

# From and to in s, and the side: 1 up or to the left, -1 down or to the right.
PROFILES = {
    "straight": [],
    "pop-up": [(10, 14, 1), (18, 26, -1), (30, 34, 1)],  # it ends at its old height
    "weave": [(8, 12, 1), (12, 20, -1), (20, 28, 1), (28, 32, -1)],  # across its first heading
    "turn": [(8, 14, 1), (16, 28, -1), (30, 36, 1)]}  # across its heading, which turns


@dataclass(frozen=True)
class Setting:
    """literal: the truth moves as in the paper, an input changes the velocity alone, and noise is a
    variance of each element; else the input lasts the interval, and noise is the standard deviation
    of an acceleration, m/s^2. sensor: places, velocities (and places), polar, polar 3-D. beam:
    where it looks; at prediction, a target outside is not seen."""
    profile: str = "weave"
    pull_g: float = 10.0
    literal: bool = False
    noise: float = 2.0
    sensor: str = "places"
    sigma_m: float = 10.0
    sigma_mps: float = 0.0
    sigma_rad: float = 0.0
    clutter: int = 10  # plots in the beam
    pd: float = 0.9
    beam: str = "prediction"  # truth, prediction, all round
    told_g: float = 12.0  # what the tracker is told of the targets' accelerations
    beam_deg: float = HALF_BEAM_DEG  # its radius is the range by the sine
    is_printed: bool = False  # starts at PRINTED_START

    @property
    def axes(self):
        return 2 if self.sensor == "polar" else 3

    @property
    def is_polar(self):
        return self.sensor.startswith("polar")

    @property
    def effect(self):
        """What an acceleration does to place and velocity in an interval."""
        return np.array([0.0 if self.literal else INTERVAL_S**2 / 2, INTERVAL_S])


def side_of(profile, t_s):
    return next((side for start, end, side in PROFILES[profile] if start <= t_s < end), 0)


def planned_inputs(profile, pull_mps2):
    """(SCANS, 3), m/s^2, from each scan to the next."""
    inputs, velocity = np.zeros((SCANS, 3)), START[3:5].copy()
    for scan in range(SCANS):
        pull = side_of(profile, scan * INTERVAL_S) * pull_mps2
        x, y = (velocity if profile == "turn" else START[3:5]) / np.hypot(*velocity)
        inputs[scan] = (0, 0, pull) if profile == "pop-up" else (-pull * y, pull * x, 0)
        if profile == "turn":  # at a constant speed
            angle = pull * INTERVAL_S / np.hypot(*velocity)
            cos, sin = math.cos(angle), math.sin(angle)
            velocity = np.array([[cos, -sin], [sin, cos]]) @ velocity
    return inputs


class Scene:
    """Runs first .. first + count - 1 of a case; what chance draws, whatever the tracker does."""

    def __init__(self, setting, seed, case, first, count):
        self.setting, self.same = setting, {}  # looks that all trackers have in common
        axes, clutter = setting.axes, setting.clutter
        shape = (count, SCANS)
        process, noise = np.empty((*shape, 2, 3)), np.empty((*shape, 2, 3))
        self.is_seen, self.row = np.empty(shape, bool), np.empty(shape, int)
        self.offsets = np.zeros((*shape, clutter, 3))  # of the clutter from the beam's centre
        for i in range(count):
            rng = np.random.default_rng([seed, case, first + i])
            process[i], noise[i] = rng.normal(size=(2, SCANS, 2, 3))
            self.is_seen[i] = rng.random(SCANS) < setting.pd
            self.row[i] = rng.integers(0, clutter, SCANS, endpoint=True)
            ball = rng.normal(size=(SCANS, clutter, axes))
            ball *= (rng.random((SCANS, clutter)) ** (1 / axes)
                     / np.linalg.norm(ball, axis=-1))[..., None]
            self.offsets[i, ..., :axes] = ball
        self.is_seen[:, :CLEAN_SCANS] = True
        self.inputs = planned_inputs(setting.profile, setting.pull_g * G_MPS2)
        self.inputs[:, axes:] = 0
        self.truth = self._fly(process)
        self.range_m = np.linalg.norm(self.truth[..., :3], axis=-1)
        self.radius_m = self.range_m * math.sin(math.radians(setting.beam_deg))
        self.offsets *= self.radius_m[:, :, None, None]
        self.measured = self._measure(noise)

    def _fly(self, process):
        setting, truth = self.setting, np.empty((*process.shape[:2], 6))
        if setting.literal:
            steps = math.sqrt(setting.noise) * process
        else:
            steps = setting.noise * process[:, :, :1] * setting.effect[:, None]
            steps[..., setting.axes:] = 0
        steps = (steps + setting.effect[:, None] * self.inputs[:, None]).reshape(*truth.shape)
        truth[:, 0] = PRINTED_START if setting.is_printed else START
        truth[:, 0, setting.axes:3] = 0
        for scan in range(1, SCANS):
            truth[:, scan] = truth[:, scan - 1] + steps[:, scan - 1]
            truth[:, scan, :3] += INTERVAL_S * truth[:, scan - 1, 3:]
        return truth

    def _measure(self, noise):
        setting, truth = self.setting, self.truth
        if not setting.is_polar:
            sigmas = np.array([setting.sigma_m, setting.sigma_mps])[:, None]
            return truth + (sigmas * noise).reshape(truth.shape)
        # noisy angles shorten places by cos's mean in the mean, exp(-sigma^2 / 2) an angle
        longer = math.exp(setting.sigma_rad**2 / 2)
        range_m = self.range_m + setting.sigma_m * noise[:, :, 0, 0]
        azimuth, elevation = (angle + setting.sigma_rad * noise[:, :, 0, i]
                              for i, angle in enumerate(self._angles(), 1))
        ground, height = range_m * longer, np.zeros_like(range_m)
        if setting.axes == 3:
            height, ground = ground * np.sin(elevation), ground * longer * np.cos(elevation)
        return np.stack([ground * np.cos(azimuth), ground * np.sin(azimuth), height,
                         *np.zeros((3, *height.shape))], axis=-1)

    def _angles(self):
        x, y, z = np.moveaxis(self.truth[..., :3], -1, 0)
        return np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))

    def covariance(self):
        """(runs, SCANS, m, m): the true one of what is measured: place, or place and velocity."""
        setting, axes = self.setting, self.setting.axes
        if not setting.is_polar:
            sigmas = [setting.sigma_m] * 3 + [setting.sigma_mps] * 3 * (setting.sensor != "places")
            return np.broadcast_to(np.diag(sigmas)**2, (*self.range_m.shape, *[len(sigmas)] * 2))
        a, e = self._angles()
        zero = np.zeros_like(a)
        frame = np.array([[np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)],
                          [-np.sin(a), np.cos(a), zero],
                          [-np.sin(e) * np.cos(a), -np.sin(e) * np.sin(a), np.cos(e)]])
        across = self.range_m * setting.sigma_rad
        scaled = frame * np.array([zero + setting.sigma_m, across, across])[:, None]
        return np.einsum("kirs,kjrs->rsij", scaled[:axes, :axes], scaled[:axes, :axes])

    def is_in_beam(self, scan, centre_m):
        """Which targets a beam to these places (runs, 3) would see, but for misses."""
        off = (self.truth[:, scan, :3] - centre_m)[:, :self.setting.axes]
        return ((np.linalg.norm(off, axis=-1) <= self.radius_m[:, scan])
                | (scan < CLEAN_SCANS) | (self.setting.beam != "prediction"))

    def log_density(self, scan):
        """(runs,): ln of the clutter's density in all that is measured."""
        radius, ball = self.radius_m[:, scan], 4 / 3 * math.pi
        space = ball * radius**3 if self.setting.axes == 3 else math.pi * radius**2
        if self.setting.sensor == "velocities":
            space = space * ball * (radius / INTERVAL_S)**3
        return np.log(max(self.setting.clutter, CLUTTER_MIN) / space)

    def look(self, scan, centre_m, previous_m, has_velocity):
        """Places and velocities of all plots (runs, plots, 6), and the target's row, -1: not seen.

        Clutter fills the beam around centre_m. It has the velocity that would have brought it from
        previous_m, and so has the target where velocities are not measured. The target is at a
        random row. Rows without a plot are NaN, and behind: of a target that is not seen, or of
        places and velocities, where they are told, beyond what plots may have.
        """
        runs = np.arange(len(self.truth))
        is_seen = self.is_seen[:, scan] & self.is_in_beam(scan, centre_m)
        clutter = 0 if scan < CLEAN_SCANS else self.setting.clutter
        plots = np.full((len(runs), clutter + 1, 6), np.nan)
        plots[:, :clutter, :3] = centre_m[:, None] + self.offsets[:, scan, :clutter]
        row = np.where(is_seen, self.row[:, scan] if clutter else 0, clutter)
        plots[runs, -1] = plots[runs, row]
        plots[is_seen, row[is_seen], :3] = self.measured[is_seen, scan, :3]
        plots[..., 3:] = (plots[..., :3] - previous_m[:, None]) / INTERVAL_S
        if self.setting.sensor == "velocities":
            plots[is_seen, row[is_seen], 3:] = self.measured[is_seen, scan, 3:]
        limits = [PLACE_MAX_M] * 3 + [SPEED_MAX_MPS if has_velocity else np.inf] * 3
        if (np.abs(plots) > limits).any():
            is_blank = ~(np.abs(plots) <= limits).all(-1)
            plots[is_blank] = np.nan
            order = np.argsort(is_blank, axis=1, kind="stable")
            plots = np.take_along_axis(plots, order[..., None], axis=1)
            row = (order == row[:, None]).argmax(1)
        return plots, np.where(is_seen, row, -1)

    def scans(self, scan, plots, has_velocity):
        """One of the package's scans a run; has_velocity: the gate of velocities gets those of
        look, though places alone are measured."""
        setting, measures = self.setting, self.setting.sensor == "velocities"
        rows = np.zeros(plots.shape[:2], FIELDS)
        rows["t_s"] = scan * INTERVAL_S
        told = 6 if has_velocity else setting.axes
        for i, name in enumerate(STATE):
            rows[name] = plots[..., i] if i < told else np.nan
        rows["sigma_range_m"], across = setting.sigma_m, setting.sigma_m
        if setting.is_polar:
            across = np.linalg.norm(plots[..., :3], axis=-1) * setting.sigma_rad
        rows["sigma_cross_m"] = rows["sigma_up_m"] = across
        rows["sigma_mps"] = setting.sigma_mps if measures else SIGMA_NOTHING_MPS
        if scan == 0 and setting.literal:
            for name in SIGMAS:
                rows[name] = START_SIGMA
        elif scan == 0 and not measures and has_velocity:  # as if nothing were said
            rows["vx_mps"] = rows["vy_mps"] = rows["vz_mps"] = 0
            rows["sigma_mps"] = START_SIGMA_MPS
        return rhotrack.Scans(rows.ravel(), counts=[rows.shape[1]] * len(rows))


