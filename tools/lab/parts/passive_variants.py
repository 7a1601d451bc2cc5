# SPDX-License-Identifier: MIT
"""Further in the passive paper's spirit: its method with ghosts pruned by complete matchings or by
all pairs of sensors together, and with votes that are shared among cells by the crossing's
covariance, still integers. In numpy, each at the threshold at which it errs least."""
import itertools
import math

from common import experiment  # before numpy, whose threads it limits

import numpy as np

import rhotrack
from parts.passive_scenes import PLACES_M, Setting
from parts.passive_paper_figures import RANGE_MAX_M, lines_matched
from parts.passive_runs import runs_of

THETA_CELLS, RHO_CELLS, RHO_CELL_M = 90, 256, 1000  # of the paper's accumulator
THETA_RAD = (np.arange(THETA_CELLS) + 0.5) * np.pi / THETA_CELLS
DIRECTIONS = np.stack([np.cos(THETA_RAD), np.sin(THETA_RAD)])
NEAR_THETA, NEAR_RHO = 4, 3  # cells, in which there is no second line
JOINT_SIGMAS = 3
SHARES = 16  # votes of a crossing, where they are shared
LINE = np.dtype([("theta_rad", "f8"), ("rho_m", "f8")])
THRESHOLDS = np.arange(0.35, 1.01, 0.05)  # of the frames
CASES = {
    "2s 2t .1 clean": (Setting(2, 2, 0.1),), "2s 4t .1 clean": (Setting(2, 4, 0.1),),
    "2s 2t .5 clean": (Setting(2, 2, 0.5),),
    "2s 2t .1 P_D .9 FA 1": (Setting(2, 2, 0.1, 0.9, 1),),
    "3s 2t .1 clean": (Setting(3, 2, 0.1),), "3s 4t .1 clean": (Setting(3, 4, 0.1),),
    "3s 2t .5 clean": (Setting(3, 2, 0.5),),
    "3s 4t .1 P_D .9 FA 1": (Setting(3, 4, 0.1, 0.9, 1),)}
WAYS = {  # pruning, whether all pairs decide, whether votes are shared
    "literal": ("literal", False, False), "matchings": ("safe", False, False),
    "all pairs": ("none", True, False), "matchings, all pairs": ("safe", True, False),
    "literal, shared": ("literal", False, True), "matchings, shared": ("safe", False, True),
    "matchings, all pairs, shared": ("safe", True, True)}


def covariance_of(places_m, a, b, sigma_rad):
    """(crossings, 2, 2): of where the bearings of sensors a and b cross."""
    to_a, to_b = places_m - PLACES_M[a], places_m - PLACES_M[b]
    rows = np.stack([np.stack([-to[:, 1], to[:, 0]], -1) / (to**2).sum(-1)[:, None]
                     for to in (to_a, to_b)], 1)  # of the bearings by the place
    inverse = np.linalg.inv(rows)
    return sigma_rad**2 * inverse @ np.swapaxes(inverse, 1, 2)


def seen_by_all(places_m, covariances, looks, k, others, sigma_rad):
    """Every other sensor, if it has it in range, has a bearing there."""
    is_seen = np.ones(len(places_m), bool)
    for c in others:
        to = places_m - PLACES_M[c]
        row = np.stack([-to[:, 1], to[:, 0]], -1) / (to**2).sum(-1)[:, None]
        sigma = np.sqrt(sigma_rad**2 + np.einsum("ni,nij,nj->n", row, covariances, row))
        off = (np.arctan2(to[:, 1], to[:, 0])[:, None] - looks[k, c]["bearing_rad"] + np.pi) % (
            2 * np.pi) - np.pi
        is_near = (np.abs(off) < JOINT_SIGMAS * sigma[:, None]).any(axis=1)
        is_seen &= is_near | (np.hypot(*to.T) > RANGE_MAX_M)
    return is_seen


def crossings_of(scene, looks, pair, rule, is_joint):
    """By frame: places and covariances of what is left."""
    a, b = pair
    sigma_rad = math.radians(scene.of.sigma_deg)
    for k in range(scene.of.frames):
        found = rhotrack.ghosts(looks[k, a]["bearing_rad"][:16], looks[k, b]["bearing_rad"][:16],
                                PLACES_M[a], PLACES_M[b], RANGE_MAX_M, rule)
        is_kept = found.reason == "kept"
        places_m = np.stack([found.x_m[is_kept], found.y_m[is_kept]], -1).astype(float)
        covariances = covariance_of(places_m, a, b, sigma_rad)
        if is_joint:
            others = [c for c in range(scene.of.sensors) if c not in pair]
            seen = seen_by_all(places_m, covariances, looks, k, others, sigma_rad)
            places_m, covariances = places_m[seen], covariances[seen]
        yield places_m, covariances


def normal_below(z):
    return 0.5 * (1 + np.vectorize(math.erf, otypes=[float])(z / math.sqrt(2)))


def plane_of(frames, is_shared):
    """Votes of distinct scans: one in a crossing's cell; or of SHARES in all, as many in each cell
    as of its rho lies there. Of more crossings of a scan in one cell that of the most."""
    plane = np.zeros((THETA_CELLS, RHO_CELLS), int)
    rows = np.arange(THETA_CELLS)
    for places_m, covariances in frames:
        votes = np.zeros_like(plane)
        for place_m, covariance in zip(places_m, covariances):
            cell = place_m @ DIRECTIONS / RHO_CELL_M + RHO_CELLS / 2
            column = np.clip(np.floor(cell).astype(int), 0, RHO_CELLS - 1)
            if not is_shared:
                votes[rows, column] = SHARES
                continue
            sigma = np.sqrt(np.einsum("it,ij,jt->t", DIRECTIONS, covariance, DIRECTIONS))
            sigma = np.maximum(sigma / RHO_CELL_M, 1e-3)
            for offset in range(-3, 4):
                at = column + offset
                share = normal_below((at + 1 - cell) / sigma) - normal_below((at - cell) / sigma)
                of = np.clip(at, 0, RHO_CELLS - 1)
                votes[rows, of] = np.maximum(votes[rows, of], np.rint(SHARES * share))
        plane += votes
    return plane


def most_near(plane):
    """The most votes of each cell and its neighbours; behind the last row theta goes on with the
    other sign of rho."""
    around = np.pad(np.concatenate([plane[-1:, ::-1], plane, plane[:1, ::-1]]), ((0, 0), (1, 1)))
    return np.max([around[i:i + THETA_CELLS, j:j + RHO_CELLS]
                   for i in range(3) for j in range(3)], axis=0)


def lines_in(total, is_accepted, frames):
    """As the paper chooses: the most votes, then cells off its ridge, the curve of the mean place
    of the crossings of its cell, or beside it, in the last pair's frames."""
    left, lines = np.where(is_accepted, total, 0), []
    places_m = np.concatenate([places_m for places_m, _ in frames])
    cells = np.floor(places_m @ DIRECTIONS / RHO_CELL_M + RHO_CELLS / 2)
    rows, columns = np.arange(THETA_CELLS)[:, None], np.arange(RHO_CELLS)[None]
    while left.max() > 0 and len(lines) < 24:
        best = np.argwhere(left == left.max())
        row, column = best[len(best) // 2]
        lines.append((THETA_RAD[row], (column + 0.5 - RHO_CELLS / 2) * RHO_CELL_M))
        off = np.abs(cells[:, row] - column)
        middle_m = places_m[off <= max(0, off.min())].mean(axis=0)
        ridge = np.floor(middle_m @ DIRECTIONS / RHO_CELL_M + RHO_CELLS / 2)[:, None]
        turned = np.abs(rows - row)
        left[(np.minimum(turned, THETA_CELLS - turned) <= NEAR_THETA) & (
            np.abs(columns - ridge) <= NEAR_RHO)] = 0
        left[row, column] = 0
    return np.array(lines, LINE)


def further_run(case, scene):
    """(ways, thresholds, 2): targets found, lines of ghosts."""
    looks = scene.looks()
    pairs = list(itertools.combinations(range(scene.of.sensors), 2))
    found = np.zeros((len(WAYS), len(THRESHOLDS), 2), int)
    for i, (rule, is_joint, is_shared) in enumerate(WAYS.values()):
        crossings = [list(crossings_of(scene, looks, pair, rule, is_joint)) for pair in pairs]
        planes = [plane_of(frames, is_shared) for frames in crossings]
        near = planes if len(pairs) == 1 else [most_near(plane) for plane in planes]
        for j, threshold in enumerate(THRESHOLDS):
            votes_min = math.ceil(SHARES * threshold * scene.of.frames - 1e-9)
            is_accepted = np.min(near, axis=0) >= votes_min
            found[i, j] = lines_matched(
                lines_in(np.sum(planes, axis=0), is_accepted, crossings[-1]), scene)
    return found


def tell(report):
    runs, rows, facts = runs_of(report, "further", CASES, further_run), [], []
    for name, (setting,) in CASES.items():
        found = np.array(runs[name])
        errors = setting.targets - found[..., 0] + found[..., 1]
        for i, way in enumerate(WAYS):
            if WAYS[way][1] and setting.sensors == 2:
                continue
            best = errors[:, i].mean(axis=0).argmin()
            share, ghosts = (found[:, i, best].mean(axis=0) / (setting.targets, 1)).tolist()
            mean, error = experiment.mean_of(errors[:, i, best])
            rows.append([name, way, f"{THRESHOLDS[best]:.2f}", f"{share:.3f}", f"{ghosts:.2f}",
                         f"{mean:.2f} +- {error:.2f}"])
            facts.append({"case": name, "way": way, "threshold": THRESHOLDS[best].item(),
                          "found": share, "ghosts_per_run": ghosts, "errors_per_run": mean})
    report.heading("Further in the paper's spirit")
    report.text(
        f"The paper's method in numpy, {len(found)} runs, each way at the threshold (a share of "
        "the frames) at which it errs least: targets without a line, and lines of ghosts. Literal: "
        "the paper's pruning. Matchings: the safe rule. All pairs: a crossing stays where each "
        f"other sensor has a bearing within {JOINT_SIGMAS} standard deviations. Shared: a crossing "
        f"has {SHARES} votes, shared among cells of rho by its covariance.")
    report.table(["further", "way", "threshold", "Pd", "ghosts a run", "errors a run"], rows)
    report.fact("further", facts)
