# SPDX-License-Identifier: MIT
"""Skies of experiment bearings: direction finders that look together or not, stand, move or share a
mast, and targets far ahead of them or around them that fly straight or turn; cameras measure
elevations too."""
import dataclasses
import math

import numpy as np

from parts.passive_scenes import FALSE, ROW, wrapped

STEP_S = 0.1  # of the targets' paths
AHEAD_FAR_M, AHEAD_END_M = 78e3, 5e3  # from the origin at the start; x at the end, at least
AROUND_M = np.array([10e3, 6e3])  # centre of the targets that are around the sensors
LOST_M = 40e3  # from there a target is neither seen nor counted
TURN_EVERY_S = 60
FALSE_ELEVATION_RAD = 0.5  # at most; 0 at least
CLIMB = 0.25  # of the way to another height, over the scene
PLACE, VELOCITY = [0, 1, 4], [2, 3, 5]  # in a state x, y, vx, vy, z, vz
CAMERA_ROW = np.dtype([*ROW.descr, ("sensor_z_m", "f8"), ("elevation_rad", "f8"),
                       ("sigma_elevation_rad", "f8")])
COLUMNS = ("t_s", "sensor_id", "sensor_x_m", "sensor_y_m", "bearing_rad", "sigma_rad")
ELEVATIONS = ("sensor_z_m", "elevation_rad", "sigma_elevation_rad")


@dataclasses.dataclass(frozen=True)
class Scene:
    """Targets far ahead, or around; a look is one sensor's in one frame."""
    places_m: tuple
    targets: int
    sigma_deg: float
    frames: int = 40
    interval_s: float = 5
    pd: float = 1
    false_mean: float = 0  # bearings a look
    is_around: bool = False
    turn_mps2: float = 0  # of a turn, at most; half of it at least
    turn_s: tuple = (10, 25)  # each TURN_EVERY_S
    phases_s: tuple = ()  # each sensor's looks are so much later
    velocities_mps: tuple = ()  # of the sensors
    gate_m: float = 3000
    height_m: float = 0  # of the targets, at most
    masts_m: tuple = ()  # heights of the sensors
    has_elevations: bool = False  # as certain as the bearings
    scale: float = 1  # of places, speeds and what is lost, where targets are around
    settings: dict = dataclasses.field(default_factory=dict, hash=False)  # told to the tracker

    @property
    def hours(self):
        return self.frames * self.interval_s / 3600

    @property
    def place(self):
        """The axes of a state's place that are tracked."""
        return PLACE if self.has_elevations else PLACE[:2]


class Sky:
    """One draw of a scene.

    times_s: of the frames, at their last looks; truth: (frames, targets, 6), x, y, vx, vy, z, vz at
    these times; visible: (frames, targets); rows: the sensors' looks by time, the bearings of each
    in random order behind a row without a bearing. A target's bearing has its target_id. Heights
    and elevations are drawn aside, so that bearings are the same without them.
    """

    def __init__(self, of, random):
        self.of = of
        phases_s = np.array(of.phases_s or [0] * len(of.places_m), float)
        self.times_s = np.arange(of.frames) * of.interval_s + phases_s.max()
        aside = np.random.Generator(random.bit_generator.jumped())
        self.paths = np.concatenate([paths_of(of, self.times_s[-1], random),
                                     heights_of(of, self.times_s[-1], aside)], axis=-1)
        self.truth, self.visible = self._at(self.times_s)
        frame, sensor = (grid.ravel() for grid in np.mgrid[:of.frames, :len(phases_s)])
        look_s = frame * of.interval_s + phases_s[sensor]
        order = np.lexsort([sensor, look_s])
        self.rows = self._seen(frame[order], sensor[order], look_s[order], random, aside)

    def _at(self, times_s):
        path_s = np.arange(len(self.paths)) * STEP_S
        states = np.stack([np.stack([np.interp(times_s, path_s, self.paths[:, target, axis])
                                     for axis in range(6)], -1)
                           for target in range(self.of.targets)], 1) if self.of.targets else (
                               np.zeros((len(times_s), 0, 6)))
        off_m = np.linalg.norm(states[..., :2] - self.of.scale * AROUND_M, axis=-1)
        return states, (off_m < self.of.scale * LOST_M) | (not self.of.is_around)

    def _seen(self, frame, sensor, look_s, random, aside):
        of, looks = self.of, len(look_s)
        places_m = np.array(of.places_m, float)[sensor]
        if of.velocities_mps:
            places_m = places_m + look_s[:, None] * np.array(of.velocities_mps, float)[sensor]
        states, visible = self._at(look_s)
        away = states[..., :2] - places_m[:, None]
        bearings = np.arctan2(away[..., 1], away[..., 0]) + math.radians(
            of.sigma_deg) * random.standard_normal(away.shape[:2])
        seen = np.argwhere(visible & (random.random(away.shape[:2]) < of.pd))
        false = np.repeat(np.arange(looks), random.poisson(of.false_mean, looks))
        half_rad = math.pi if of.is_around else math.pi / 2
        look = np.concatenate([np.arange(looks), seen[:, 0], false])
        rows = np.zeros(len(look), CAMERA_ROW)
        rows["t_s"], rows["frame"], rows["sensor_id"] = look_s[look], frame[look], sensor[look] + 1
        rows["sensor_x_m"], rows["sensor_y_m"] = places_m[look].T
        rows["sigma_rad"] = math.radians(of.sigma_deg)
        rows["target_id"] = FALSE
        rows["target_id"][looks:looks + len(seen)] = seen[:, 1]
        rows["bearing_rad"] = np.concatenate([
            np.full(looks, np.nan), wrapped(bearings[tuple(seen.T)]),
            random.uniform(-half_rad, half_rad, len(false))])
        rows["elevation_rad"] = np.nan
        if of.has_elevations:
            masts_m = np.array(of.masts_m or [0] * len(of.places_m), float)[sensor]
            elevations = np.arctan2(states[..., 4] - masts_m[:, None],
                                    np.hypot(away[..., 0], away[..., 1]))
            elevations += math.radians(of.sigma_deg) * aside.standard_normal(elevations.shape)
            rows["sensor_z_m"], rows["sigma_elevation_rad"] = masts_m[look], rows["sigma_rad"]
            rows["elevation_rad"][looks:] = np.concatenate([
                np.arcsin(np.sin(elevations[tuple(seen.T)])),  # none is beyond the zenith
                aside.uniform(0, FALSE_ELEVATION_RAD, len(false))])
        order = np.concatenate([np.full(looks, -1.0), random.random(len(look) - looks)])
        return rows[np.lexsort([order, look])]

    def write(self, path):
        """As `rhotrack track` reads bearings; targets are not told."""
        names = COLUMNS + ELEVATIONS * self.of.has_elevations
        with open(path, "w", encoding="utf-8") as file:
            file.write(",".join(names) + "\n")
            for row in self.rows[list(names)].tolist():
                file.write(",".join("" if value != value else f"{value:.9g}" for value in row)
                           + "\n")


def starts_ahead(count, duration_s, random):
    """(count, 4): on the way to the origin, within 46 degrees, and still ahead at the end."""
    found = []
    while len(found) < count:
        place_m = random.uniform([30e3, -45e3], [75e3, 45e3])
        heading = np.arctan2(*-place_m[::-1]) + random.uniform(-0.8, 0.8)
        speed_mps = random.uniform(150, 300)
        velocity = speed_mps * np.array([np.cos(heading), np.sin(heading)])
        if (np.hypot(*place_m) < AHEAD_FAR_M
                and place_m[0] + duration_s * velocity[0] > AHEAD_END_M):
            found.append([*place_m, *velocity])
    return np.array(found).reshape(-1, 4)


def starts_around(count, random):
    """(count, 4): 3 to 18 km from the centre, in any direction; of scale 1."""
    at, heading = random.uniform(-np.pi, np.pi, (2, count))
    range_m, speed_mps = random.uniform(3e3, 18e3, count), random.uniform(100, 220, count)
    return np.column_stack([
        AROUND_M[0] + range_m * np.cos(at), AROUND_M[1] + range_m * np.sin(at),
        speed_mps * np.cos(heading), speed_mps * np.sin(heading)])


def paths_of(of, duration_s, random):
    """(steps, targets, 4): x, y, vx, vy each STEP_S."""
    start = (of.scale * starts_around(of.targets, random) if of.is_around
             else starts_ahead(of.targets, of.frames * of.interval_s, random))
    steps_s = np.arange(0, duration_s + 2 * STEP_S, STEP_S)
    speed_mps = np.hypot(start[:, 2], start[:, 3])
    rate = np.zeros((len(steps_s), of.targets))
    for begin_s in np.arange(TURN_EVERY_S, duration_s, TURN_EVERY_S):
        end_s = begin_s + random.uniform(*of.turn_s, of.targets)
        turn_mps2 = (random.choice([-1, 1], of.targets) * of.turn_mps2
                     * random.uniform(0.5, 1, of.targets))
        rate += ((steps_s[:, None] >= begin_s) & (steps_s[:, None] < end_s)) * turn_mps2 / speed_mps
    heading = np.arctan2(start[:, 3], start[:, 2]) + STEP_S * (np.cumsum(rate, axis=0) - rate)
    velocity = speed_mps[:, None] * np.stack([np.cos(heading), np.sin(heading)], -1)
    moved = STEP_S * (np.cumsum(velocity, axis=0) - velocity)
    return np.concatenate([start[:, :2] + moved, velocity], axis=-1)


def heights_of(of, duration_s, random):
    """(steps, targets, 2): z and vz each STEP_S, from any height CLIMB of the way to another."""
    steps_s = np.arange(0, duration_s + 2 * STEP_S, STEP_S)
    first_m, other_m = random.uniform(0, of.height_m, (2, of.targets))
    climb_mps = CLIMB * (other_m - first_m) / max(duration_s, STEP_S)
    return np.stack(np.broadcast_arrays(first_m + steps_s[:, None] * climb_mps, climb_mps), -1)
