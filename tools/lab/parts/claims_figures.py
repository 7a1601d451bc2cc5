# SPDX-License-Identifier: MIT
"""Figures of the register of claims that no experiment has: what follows from a paper's own
numbers, and short runs."""
import itertools
import math

from common import experiment  # noqa: F401  before numpy, whose threads it limits

import numpy as np
from scipy.stats import norm

import maneuver
from common import paper_aircraft as paper
import papers_initiation as papers
import passive
from parts import passive_further_claims
from parts.passive_scenes import Scene as BearingScene
from parts.passive_scenes import Setting
from parts.maneuver_truth import (CLEAN_SCANS, HALF_BEAM_DEG, INTERVAL_S, PRINTED_START,
                                            SCANS, START, Scene)
from parts.maneuver_follow import follow

PAIRS = 100000
RUNS, CASE = 50, 900  # of short runs, as many as the papers'; their random numbers are their own
NOISE_RUNS = 20
NOISES_M, NOISES_DEG = (0.0, 0.3, 0.6, 1.0, 2.0, 5.0, 10.0), (0.005, 0.01, 0.02, 0.05, 0.1)
SEED = 1
END_S, PULLS_S = 34.0, (8.0, 32.0)  # of the weave: long after its last pull; its pulls
RUN_TIMES_MS = {"HT": 4020.9, "MHT": 63.7}  # of the paper, real data
ROWS, SCANS_OF_PAPER = math.pi / papers.THETA_CELL_RAD, paper.SCANS


def pairs():
    """Two plots of each of many pairs, (PAIRS, 2, 2)."""
    x_low, x_high, y_low, y_high = paper.TABLE_1_BOX_M
    return np.random.default_rng(SEED).uniform((x_low, y_low), (x_high, y_high), (PAIRS, 2, 2))


def equation_9():
    """theta and rho as (9) to (12) print them, and |rho| with theta in 0 to pi: which shares of the
    pairs have theta in 0 to pi, and both plots on the line that (6) has for it."""
    of = pairs()
    change = of[:, 1] - of[:, 0]
    alpha = change[:, 0] / change[:, 1]
    printed = np.where(alpha > 0, -np.arctan(alpha), -np.arctan(alpha) + np.pi)
    rho_m = np.abs(of[:, 1, 0] * of[:, 0, 1] - of[:, 0, 0] * of[:, 1, 1]) / np.linalg.norm(
        change, axis=1)

    def share_on(theta_rad):
        normals = np.stack([np.cos(theta_rad), np.sin(theta_rad)], axis=1)
        off_m = np.abs(np.einsum("npi,ni->np", of, normals) - rho_m[:, None])
        return float((off_m < 1e-6 * (1 + rho_m[:, None])).all(axis=1).mean())

    return {"printed_in_range": float(((printed >= 0) & (printed <= np.pi)).mean()),
            "printed_right": share_on(printed), "absolute_right": share_on(printed % np.pi)}


def equation_30():
    """The largest sum of memberships by (27) and (29), of a pair on a kernel that is the line
    between two others, and the smallest, 2 eps from its kernel; P_F .01, lambda_k 1."""
    falsity = 0.01**2
    return {"largest_sum": 1 + 1 + falsity,
            "smallest_sum": math.exp(-(2**2 + 2**2) / 2) + falsity}


def crossings(paths_m):
    """Pairs of the paths (scans, targets, 2) that cross each other."""
    def cross(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    def meet(a, b):
        return any(cross(*p, q[0]) * cross(*p, q[1]) < 0 and cross(*q, p[0]) * cross(*q, p[1]) < 0
                   for p in zip(a, a[1:]) for q in zip(b, b[1:]))

    each = paths_m.transpose(1, 0, 2)
    return sum(meet(a, b) for a, b in itertools.combinations(each, 2))


def tolerances():
    """Noise at which 2 eps are three standard deviations of the angle between two pairs' lines, for
    the slowest and the fastest target."""
    speeds = [math.hypot(vx, vy) for _, vx, _, vy in paper.TABLE_1]
    low, high = (0.008 * speed * paper.TABLE_1_INTERVAL_S / (3 * math.sqrt(6))
                 for speed in (min(speeds), max(speeds)))
    return {"sigma_low_m": low, "sigma_high_m": high}


def run_times():
    """Plots a scan at which HT's votes are as many times MHT's as the paper's times are."""
    ratio = RUN_TIMES_MS["HT"] / RUN_TIMES_MS["MHT"]
    return {"plots": ROWS * SCANS_OF_PAPER / ((SCANS_OF_PAPER - 1) * ratio), "ratio": ratio}


def beam():
    moved_s = (SCANS - 1) * INTERVAL_S

    def radius_m(half_deg):
        return float(np.linalg.norm(START[:3]) * math.sin(math.radians(half_deg)))

    return {"half_m": radius_m(HALF_BEAM_DEG), "whole_m": radius_m(2 * HALF_BEAM_DEG),
            "moved_m": float(np.linalg.norm(START[3:])) * moved_s,
            "printed_moved_m": float(np.linalg.norm(PRINTED_START[3:])) * moved_s}


def fade():
    """Method I in the paper's weave: rms errors of the velocity while the target pulls, and at the
    end; of the place, and the least radius of the beam."""
    scene = Scene(maneuver.PAPER_CASES[4].setting, SEED, CASE, 0, RUNS)
    off = follow(scene, maneuver.METHOD_I, SEED).off
    t_s = np.arange(SCANS) * INTERVAL_S

    def rms(which):
        return float(np.sqrt((off[:, which, 3:]**2).sum(-1).mean()))

    return {"pulls_mps": rms((t_s >= PULLS_S[0]) & (t_s < PULLS_S[1])),
            "end_mps": rms(t_s >= END_S),
            "most_off_m": float(np.abs(off[:, CLEAN_SCANS:, :3]).max()),
            "radius_m": float(scene.radius_m.min())}


def at_noises(situation, stream):
    """Of the four methods in a Situation at other noises: [{noise_m, method, figures}]."""
    methods = ["HT", "MHT", "IHT", "NHT C"]
    ideal_votes = papers.heights_without_chance(methods)
    summaries = [papers.summarised(
        [papers.run((situation._replace(noise_m=noise_m), methods, ideal_votes, SEED, CASE + stream,
                     i, run)) for run in range(NOISE_RUNS)], methods)
                 for i, noise_m in enumerate(NOISES_M)]
    return papers.facts_of(NOISES_M, "noise_m", summaries)


def at_bearing_noises():
    """Two targets, clean: share of the runs in which they stand out of the sum of three pairs'
    planes; in which two and three sensors find both and no ghost, literal pruning."""
    rows = []
    for i, sigma_deg in enumerate(NOISES_DEG):
        row = {"sigma_deg": sigma_deg}
        for sensors in (2, 3):
            scenes = [BearingScene(Setting(sensors, 2, sigma_deg), np.random.default_rng(
                [SEED, CASE, i, sensors, run])) for run in range(RUNS)]
            found = [passive.paper_run((None, 7, ["literal"]), scene)[0] for scene in scenes]
            row[f"exact_{sensors}"] = sum(one == (2, 0) for one in found) / RUNS
        stands = [passive_further_claims.summed_run(None, scene)[:2] for scene in scenes]
        rows.append(row | {"stand_out": sum(own > other for own, other in stands) / RUNS})
    return rows


def confidence():
    return {"t_st": float(norm.ppf(0.975))}


def figures():
    """{name: {figure: value}}, as an experiment's figures.json."""
    return {"equation_9": equation_9(), "equation_30": equation_30(),
            "table_1": {"crossings": crossings(paper.straight(paper.TABLE_1))},
            "table_3": {"crossings": crossings(paper.TABLE_3), "scans": len(paper.TABLE_3),
                        "lasts_s": (len(paper.TABLE_3) - 1) * paper.TABLE_3_INTERVAL_S,
                        "clutter_plots": 10 * paper.area_m2(paper.TABLE_3_BOX_M) / 1e6,
                        "track_box_plots": 10 * float(np.prod(np.ptp(np.reshape(
                            paper.TABLE_3, (-1, 2)), axis=0))) / 1e6},
            "tolerances": tolerances(), "run_times": run_times(), "beam": beam(), "fade": fade(),
            "confidence": confidence(), "noise_II": at_noises(papers.II, 0),
            "noise_IV": at_noises(papers.IV, 1), "bearing_noise": at_bearing_noises()}
