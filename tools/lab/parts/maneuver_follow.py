# SPDX-License-Identifier: MIT
"""One scene of the maneuver experiment followed by one method, and what came of it in figures."""
import math
from dataclasses import dataclass

import numpy as np

from common import experiment
from common import reference_filters
import rhotrack
from parts.maneuver_truth import (CLEAN_SCANS, G_MPS2, INTERVAL_S, SCANS, START_SIGMA_MPS,
                                            STATE)

FIRST_RUNS = 50  # the paper's number
JUDGED_SCAN = 8  # errors count from here on, losses from the end of the clean scans
FAST_MPS = 2000.0  # speed that targets do not exceed which pull 30 g for four seconds
PAPER_VARIANCE = 500.0  # P(0|0) and V(0)
START_SIGMA_MPS2 = 200.0  # of accelerations, which are not measured
STEADY_MPS2, STAY = 2.0, 0.97  # of the IMM that knows the plots
SINGER_KEEP, SINGER_SHARE = 0.98, 0.34  # its manoeuvres; a step's share of what it is told


@dataclass(frozen=True)
class Method:
    name: str
    gate: str = "best"  # of the library; or a reference: imm, clairvoyant
    estimates: bool = True  # the target's input
    physical: bool = False  # an input moves places too
    gamma: float = 1.0  # the share of the estimated input that a scan keeps
    noise: float = 1.0  # the filter's: root of the paper's Q
    pd: float | None = None  # that is told; None: the true one, .995 at most


class Trace:
    """(runs, SCANS, ...): estimate less truth, the place of the plot that was taken (NaN: none),
    whether it was clutter, the NIS of the target's plot over its dimensions (NaN: not seen)."""

    def __init__(self, scene):
        self.scene, shape = scene, scene.truth.shape[:2]
        self.off, self.used_m = np.zeros((*shape, 6)), np.full((*shape, 3), np.nan)
        self.is_wrong, self.nis = np.zeros(shape, bool), np.full(shape, np.nan)
        self.hypotheses, self.refused = np.ones(shape), np.zeros(shape[0])

    def note(self, scan, state, place_m):
        self.off[:, scan] = state - self.scene.truth[:, scan]
        self.off[:, scan, self.scene.setting.axes:3] = 0
        self.off[:, scan, self.scene.setting.axes + 3:] = 0
        self.used_m[:, scan] = place_m


def follow(scene, method, seed):
    if method.gate == "imm":
        return follow_by_imm(scene)
    return follow_clairvoyantly(scene) if method.gate == "clairvoyant" else follow_by_library(
        scene, method, seed)


# ---- the library ----


def settings_of(setting, method):
    return rhotrack.Settings(
        gate=method.gate, sigma_m=setting.sigma_m,
        v_max_mps=START_SIGMA_MPS if setting.pull_g <= 10 else FAST_MPS,
        accel_max_mps2=setting.told_g * G_MPS2, gamma=method.gamma,
        input_model="physical" if method.physical else "literal", filter_noise_m=method.noise,
        filter_noise_mps=method.noise, input_sigma_mps2=math.sqrt(PAPER_VARIANCE),
        pd=min(setting.pd, 0.995) if method.pd is None else method.pd)


def states_of(rows):
    return np.stack([rows[name] for name in STATE], axis=1).astype(float)


def nis_of(rows, measured, noise):
    """Of what was measured, from predicted tracks with their covariances."""
    spread = np.zeros((len(rows), 6, 6))
    for name, i, j in zip(rhotrack.scans.COVARIANCE, *np.tril_indices(6)):
        spread[:, i, j] = spread[:, j, i] = rows[name]
    nis = reference_filters.update(states_of(rows), spread, measured, noise)[2]
    return nis / noise.shape[-1]


def follow_by_library(scene, method, seed):
    """The package's Maintainer, through one of its gates, where the beam looks."""
    trace, setting, noise = Trace(scene), scene.setting, scene.covariance()
    runs, is_led = np.arange(len(scene.truth)), setting.beam != "truth"
    tracker = rhotrack.Maintainer(settings_of(setting, method), method.estimates, seed=seed,
                                  covariance=True, tracks=len(runs))
    has_velocity = setting.sensor == "velocities" or method.gate == "hough"
    previous = scene.truth[:, 0, :3]
    for scan in range(SCANS):
        centre = scene.truth[:, scan, :3]
        if is_led and scan > 0:
            centre, predicted = tracker.predict(scan * INTERVAL_S)
        if (scan, has_velocity) not in scene.same:
            plots, target = scene.look(scan, centre, previous, has_velocity)
            look = plots, target, scene.scans(scan, plots, has_velocity)
            if not is_led:
                scene.same[scan, has_velocity] = look
        else:
            look = scene.same[scan, has_velocity]
        plots, target, scans = look
        if is_led and scan > 0 and method.gate == "best":
            nis = nis_of(predicted, scene.measured[:, scan, :noise.shape[-1]], noise[:, scan])
            trace.nis[:, scan] = np.where(target >= 0, nis, np.nan)
        rows = tracker.run(scans, scene.log_density(scan))
        state, taken = states_of(rows), rows["plot"]
        trace.note(scan, state, np.where((taken >= 0)[:, None], plots[runs, taken, :3], np.nan))
        trace.is_wrong[:, scan] = (taken >= 0) & (taken != target)
        trace.hypotheses[:, scan] = tracker.hypotheses
        previous = state[:, :3] if is_led else centre
    trace.refused = tracker.refused
    return trace


# ---- the references ----


def reference_start(scene, noise):
    m, runs = noise.shape[-1], len(scene.truth)
    mean, covariance = np.zeros((runs, 9)), np.zeros((runs, 9, 9))
    mean[:, :m] = scene.measured[:, 0, :m]
    covariance[:] = np.diag([0] * 3 + [START_SIGMA_MPS**2] * 3 + [START_SIGMA_MPS2**2] * 3)
    covariance[:, :m, :m] = PAPER_VARIANCE * np.eye(m) if scene.setting.literal else noise[:, 0]
    return mean, covariance


def follow_by_reference(scene, noise, predict, update):
    """predict(scan) gives mean and covariance; update(measured, its covariance, which runs see it)
    the mean."""
    trace, m = Trace(scene), noise.shape[-1]
    trace.note(0, reference_start(scene, noise)[0][:, :6], scene.measured[:, 0, :3])
    for scan in range(1, SCANS):
        measured = scene.measured[:, scan]
        mean, covariance = predict(scan)
        is_fed = scene.is_seen[:, scan] & scene.is_in_beam(scan, mean[:, :3])
        nis = reference_filters.update(mean, covariance, measured[:, :m], noise[:, scan])[2]
        trace.nis[:, scan] = np.where(is_fed, nis / m, np.nan)
        mean = update(measured[:, :m], noise[:, scan], is_fed)
        trace.note(scan, mean[:, :6], np.where(is_fed[:, None], measured[:, :3], np.nan))
    return trace


def follow_by_imm(scene):
    """Knows which plot is the target's."""
    setting, noise = scene.setting, scene.covariance()
    imm = reference_filters.Imm(
        [reference_filters.steady(INTERVAL_S, setting.effect, STEADY_MPS2),
         reference_filters.singer(INTERVAL_S, SINGER_KEEP,
                                         SINGER_SHARE * setting.told_g * G_MPS2)],
        STAY, *reference_start(scene, noise))

    def predict(_):
        imm.predict()
        return imm.estimate()

    def update(*seen):
        imm.update(*seen)
        return imm.estimate()[0]

    return follow_by_reference(scene, noise, predict, update)


def follow_clairvoyantly(scene):
    """Knows the target's plots, its input, and how it moves."""
    setting, noise = scene.setting, scene.covariance()
    model = (reference_filters.noisy(INTERVAL_S, setting.noise) if setting.literal
             else reference_filters.steady(INTERVAL_S, setting.effect, setting.noise))
    one = reference_filters.Imm([model], 1.0, *reference_start(scene, noise))

    def predict(scan):
        one.predict()
        one.mean[:, :, :6] += np.outer(setting.effect, scene.inputs[scan - 1]).ravel()
        return one.mean[0], one.covariance[0]

    def update(*seen):
        one.update(*seen)
        return one.mean[0]

    return follow_by_reference(scene, noise, predict, update)


# ---- in figures ----


def outcome_of(trace):
    """Figures of each run, (runs,)."""
    off_m, off_mps = trace.off[..., :3], trace.off[..., 3:]
    late_m, radius = off_m[:, CLEAN_SCANS:], trace.scene.radius_m[:, CLEAN_SCANS:]
    nis = trace.nis[:, JUDGED_SCAN:]
    return {
        "is_inside": (np.abs(late_m) <= radius[..., None]).all((1, 2)),
        "is_lost": ~((late_m**2).sum(-1) <= radius**2).all(1),
        "most_off_m": np.nan_to_num(np.abs(late_m)).max((1, 2)),
        "least_mps": off_mps[:, CLEAN_SCANS:].min((1, 2)),
        "most_mps": off_mps[:, CLEAN_SCANS:].max((1, 2)),
        "square_m2": (off_m[:, JUDGED_SCAN:]**2).sum(-1).mean(1),
        "square_mps2": (off_mps[:, JUDGED_SCAN:]**2).sum(-1).mean(1),
        "nis_sum": np.nansum(nis, 1), "nis_count": (~np.isnan(nis)).sum(1),
        "wrong": trace.is_wrong[:, CLEAN_SCANS:].mean(1),
        "hypotheses": trace.hypotheses[:, JUDGED_SCAN:].mean(1), "refused": trace.refused}


def summary_of(outcome, imm=None):
    """{name: (figure, standard error)} of one method's runs; kept ones are not lost. imm: outcomes
    of the IMM that knows the plots in the same runs."""
    kept = ~outcome["is_lost"]
    ones, few = np.ones(len(kept)), outcome["is_inside"][:FIRST_RUNS]
    summary = {"inside": experiment.mean_of(outcome["is_inside"]),
               "first_inside": experiment.mean_of(few),
               "lost": experiment.mean_of(outcome["is_lost"]),
               "wrong": experiment.mean_of(outcome["wrong"]),
               "hypotheses": experiment.mean_of(outcome["hypotheses"]),
               "most_off_m": (float(outcome["most_off_m"].max()), math.nan),
               "refused": (float(outcome["refused"].sum()), math.nan),
               "nis_per_dimension": experiment.ratio_of(outcome["nis_sum"][kept],
                                                 outcome["nis_count"][kept])}
    for name in ("least_mps", "most_mps"):  # a median's error is sqrt(pi / 2) times a mean's
        summary[name] = (float(np.median(outcome[name])),
                         math.sqrt(math.pi / 2) * experiment.mean_of(outcome[name])[1])
    for name, key in (("rms_m", "square_m2"), ("rms_mps", "square_mps2")):
        summary[name] = experiment.root_of(*experiment.ratio_of(outcome[key], ones))
        summary[f"kept_{name}"] = experiment.root_of(
            *experiment.ratio_of(outcome[key][kept], ones[kept]))
        summary[f"{name}_over_imm"] = (math.nan, math.nan) if imm is None else experiment.root_of(
            *experiment.ratio_of(outcome[key][kept], imm[key][kept]))
    return summary
