# SPDX-License-Identifier: MIT
"""The oracle of initiation: the straight-line fit of somebody who is told the plots of a target.

No initiation can, on average, find much more than this fit with the same score and threshold would
accept: it measures what the initiator loses because it does not know.
"""
import math
from typing import NamedTuple

import numpy as np

TARGETS_EXPECTED = 0.5  # in the area, before any plot: as the initiator takes it


class Model(NamedTuple):
    scans: int  # of the window
    interval_s: float
    sigma_m: float
    pd: float
    area_m2: float
    v_min_mps: float
    v_max_mps: float
    process_noise_mps2: float = 0.0


def covariance_m2(model, t_s):
    """Of the places at these times along one axis: plot noise, and an acceleration that is constant
    within each scan interval."""
    since_s = t_s[:, None] - model.interval_s * np.arange(model.scans - 1)
    reach_s = np.where(since_s < model.interval_s - 1e-9, 0.0, since_s - model.interval_s / 2)
    change_mps = model.process_noise_mps2 * model.interval_s
    return change_mps**2 * reach_s @ reach_s.T + model.sigma_m**2 * np.eye(len(t_s))


def fit(model, t_s, places_m, density_per_m2):
    """(velocity (2), score in nats) of generalised least squares through 3 plots or more of one
    target; density_per_m2: of clutter in a scan, where each plot is."""
    covariance = covariance_m2(model, t_s)
    columns = np.stack([np.ones(len(t_s)), t_s], axis=1)
    weighted = np.linalg.solve(covariance, columns)
    normal = columns.T @ weighted
    places_m = places_m - places_m[0]
    line = np.linalg.solve(normal, weighted.T @ places_m)
    residuals = places_m - columns @ line
    chi2 = np.sum(residuals * np.linalg.solve(covariance, residuals))
    births = model.area_m2 * math.pi * (model.v_max_mps**2 - model.v_min_mps**2) / TARGETS_EXPECTED
    score_nat = ((model.scans - len(t_s)) * math.log(1 - model.pd) - math.log(births)
                 + np.sum(np.log(model.pd / density_per_m2))
                 - (len(t_s) - 2) * math.log(2 * math.pi) - np.linalg.slogdet(covariance)[1]
                 - np.linalg.slogdet(normal)[1] - chi2 / 2)
    return line[1], score_nat
