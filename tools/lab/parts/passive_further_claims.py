# SPDX-License-Identifier: MIT
"""What the passive paper claims besides: the summed accumulators of three sensors (Fig. 5), the
heading psi of a line, and a cost that grows almost linearly with the crossings, beside the S-D
assignment that it avoids.

The S-D assignment is the static one of the literature: of one look of S sensors, the set of tuples
(a bearing or none of each sensor) of the least cost, in which each bearing is at most once. A tuple
costs its squared residuals over 2 sigma^2 from the place that its bearings fit best, less what a
target gains over false bearings; tuples that cost more than nothing are left out by none. It is
solved exactly, as an integer program (HiGHS).
"""
import itertools
import math
import time

from common import experiment  # before numpy, whose threads it limits

import numpy as np
from scipy.optimize import LinearConstraint, milp
from scipy.sparse import coo_array

import rhotrack
from parts.passive_scenes import PLACES_M, Scene, Setting, wrapped
from parts.passive_paper_figures import (ROWS, THREE, TWO, crossings_left, line_of, line_off,
                                         paper_of, scene_of)
from parts.passive_runs import RULES, runs_of

NEAR_CELLS = 2  # of a line's cell, that count as the line's
SUMMED = {"3s 2t .05 clean": (Setting(3, 2, 0.05),), "3s 2t .1 clean": (Setting(3, 2, 0.1),),
          "3s 4t .1 P_D .9 FA 1": (Setting(3, 4, 0.1, 0.9, 1),)}
PD, FALSE_MEAN = 0.9, 1.0  # that a tuple's cost is told
TARGETS, SENSORS_OF = (2, 4, 6, 8, 10, 12), {3: 12, 4: 6}  # of S sensors at most so many targets
REPEATS, STEPS = 5, 4
ALMOST_LINEAR = 1.2  # largest exponent of that name


# ---- Fig. 5 and psi ----

def summed(scene):
    """Votes of all pairs of sensors together, theta and rho of the cells from the origin's line."""
    planes = list(paper_of("literal", 6).accumulators(scene.frames()).values())
    votes = np.sum([plane.votes.astype(int) for plane in planes], axis=0)
    return votes, planes[0].theta_rad, planes[0].rho_m


def lines_in_plane(scene):
    """The targets' lines as the planes have them: from the sensors' centroid."""
    states = scene.start.copy()
    states[:, :2] -= PLACES_M[:scene.of.sensors].mean(axis=0)
    return line_of(states)


def summed_run(_, scene):
    """Of the summed planes: the least of the targets' highest cells, the highest other one; of the
    lines that are a target's: how far psi = theta + pi / 2 is off its heading."""
    votes, theta_rad, rho_m = summed(scene)
    of_theta, of_rho = lines_in_plane(scene)
    off = line_off((theta_rad[:, None, None], rho_m[None, :, None]), (of_theta, of_rho))
    cell = math.pi / len(theta_rad), rho_m[1] - rho_m[0]
    is_near = (off[0] <= NEAR_CELLS * cell[0]) & (off[1] <= NEAR_CELLS * cell[1])
    own = [int(votes[is_near[..., i]].max(initial=0)) for i in range(scene.of.targets)]
    found = paper_of("literal", 6).find(scene.frames())
    heading = np.arctan2(scene.start[:, 3], scene.start[:, 2])
    off = line_off((found["theta_rad"][:, None], found["rho_m"][:, None]), line_of(scene.start))
    line, target = np.nonzero((off[0] < math.radians(6)) & (off[1] < 3000))
    psi = found["theta_rad"][line] + math.pi / 2
    return min(own), int(votes[~is_near.any(axis=-1)].max(initial=0)), [
        abs((a + math.pi / 2) % math.pi - math.pi / 2) for a in psi - heading[target]]


# ---- S-D assignment ----

def cost_of(bearings_rad, places_m, sigma_rad, start_m):
    """Of a tuple: its bearings, from where they fit best."""
    place = np.array(start_m)
    for _ in range(STEPS):
        away = place - places_m
        off = wrapped(bearings_rad - np.arctan2(away[:, 1], away[:, 0]))
        rows = np.stack([-away[:, 1], away[:, 0]], 1) / (away**2).sum(1)[:, None]
        place = place + np.linalg.lstsq(rows, off, rcond=None)[0]
    return float(off @ off) / (2 * sigma_rad**2)


def tuples_of(looks, sensors, sigma_rad):
    """Costs, and indices of the bearings (-1: none), of all tuples of two bearings or more."""
    gain = math.log(PD * math.pi / (FALSE_MEAN * math.sqrt(2 * math.pi) * sigma_rad))
    costs, members = [], []
    for choice in itertools.product(*[range(-1, len(look)) for look in looks]):
        seen = [s for s in range(sensors) if choice[s] >= 0]
        if len(seen) < 2:
            continue
        bearings = np.array([looks[s][choice[s]] for s in seen])
        a, b = seen[:2]
        crossing = np.linalg.lstsq(np.stack([-np.sin(bearings), np.cos(bearings)], 1)[:2],
                                   [-math.sin(bearings[0]) * PLACES_M[a][0]
                                    + math.cos(bearings[0]) * PLACES_M[a][1],
                                    -math.sin(bearings[1]) * PLACES_M[b][0]
                                    + math.cos(bearings[1]) * PLACES_M[b][1]], rcond=None)[0]
        cost = cost_of(bearings, PLACES_M[seen], sigma_rad, crossing)
        costs.append(cost - len(seen) * gain - (sensors - len(seen)) * math.log(1 - PD))
        members.append(choice)
    return np.array(costs), np.array(members)


def assign(costs, members, looks):
    """The tuples that are chosen: indices; of the least cost."""
    rows, columns, row = [], [], 0
    for s, look in enumerate(looks):
        for bearing in range(len(look)):
            at = np.flatnonzero(members[:, s] == bearing)
            rows += [row] * len(at)
            columns += at.tolist()
            row += 1
    once = coo_array((np.ones(len(rows)), (rows, columns)), shape=(row, len(costs)))
    found = milp(costs, constraints=LinearConstraint(once, -np.inf, 1), integrality=1,
                 bounds=(0, 1))
    return np.flatnonzero(found.x > 0.5)


def assignment_run(sensors, targets, seed):
    """ms, tuples, and the share of the tuples chosen that are one target's whole."""
    scene = Scene(Setting(sensors, targets, 0.1),
                  np.random.default_rng([seed, 7, sensors, targets]))
    of_look = [scene.looks()[0, s] for s in range(sensors)]
    looks = [look["bearing_rad"].astype(float) for look in of_look]
    start_s = time.thread_time()
    costs, members = tuples_of(looks, sensors, math.radians(scene.of.sigma_deg))
    tupled_s = time.thread_time()
    chosen = assign(costs, members, looks)
    end_s = time.thread_time()
    right = [len({int(of_look[s]["target_id"][members[i, s]]) for s in range(sensors)}) == 1
             for i in chosen if (members[i] >= 0).all()]
    return (1e3 * (end_s - start_s), 1e3 * (end_s - tupled_s), len(costs),
            sum(right) / targets)


def hough_run(sensors, targets, seed):
    """ms of a look's share of the search, crossings of a look."""
    scene = Scene(Setting(sensors, targets, 0.1),
                  np.random.default_rng([seed, 7, sensors, targets]))
    frames, times_s = rhotrack.Scans(scene.frames()), []
    for _ in range(REPEATS):
        start_s = time.thread_time()
        paper_of("none", 6).find(frames)
        times_s.append(time.thread_time() - start_s)
    crossings = len(crossings_left(scene, range(1, sensors + 1), "none"))
    return 1e3 * min(times_s) / scene.of.frames, crossings / scene.of.frames


def slope(x, y):
    """The exponent of the power of x that y grows with, over the upper half."""
    x, y = (np.log(one[len(one) // 2 - 1:]) for one in (x, y))
    return float(np.polyfit(x, y, 1)[0])


# ---- tables ----

def tell(report):
    runs, rows, facts = runs_of(report, "claims", SUMMED, summed_run), [], []
    for name, of in runs.items():
        own, other, psi = (np.array([run[0] for run in of]), np.array([run[1] for run in of]),
                           np.array(sum((run[2] for run in of), [])))
        share, error = experiment.mean_of(own > other)
        psi_deg = math.degrees(np.median(psi)) if len(psi) else math.nan
        facts.append({"case": name, "stand_out": share, "target_votes": float(own.mean()),
                      "other_votes": float(other.mean()),
                      "psi_off_deg": None if math.isnan(psi_deg) else psi_deg})
        rows.append([name, f"{share:.2f} +- {error:.2f}", f"{own.mean():.1f}",
                     f"{other.mean():.1f}", f"{psi_deg:.2f}"])
    report.heading("Three sensors' summed parameter space, Fig. 5, and the heading psi")
    report.text(
        f"{len(of)} runs, literal pruning. Stand out: share of the runs in which every target's "
        f"highest cell of the sum of the three planes, within {NEAR_CELLS} cells of its line, is "
        "above all other cells. Votes: of the lowest target's cell, of the highest other one, in "
        "the mean. Psi: theta + pi / 2 of the lines found, off the target's heading (either "
        "sense), median.")
    report.table(["summed planes", "stand out", "target's votes", "other's", "psi off deg"], rows)
    report.fact("summed", facts)
    draw(report)
    tell_cost(report)


def draw(report):
    """Figs. 5 to 9 as the paper draws them: votes over rho and theta, and Fig. 5 from above."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    panels = []
    for number, (_, _, sensors, rule, votes_min), least in (
            (6, ROWS[0], 1), (7, ROWS[0], ROWS[0][4]), (8, ROWS[1], 1), (9, ROWS[1], ROWS[1][4])):
        plane = paper_of(rule, votes_min).accumulators(scene_of(TWO).frames())[sensors]
        votes = np.where(plane.votes >= least, plane.votes, 0).astype(int)
        panels.append((f"Fig. {number}: {RULES[rule]}" + (f", T = {least}" if least > 1 else ""),
                       votes, plane.theta_rad, plane.rho_m))
    panels.insert(0, ("Fig. 5: the sum of three pairs", *summed(scene_of(THREE))))
    figure = plt.figure(figsize=(15, 9))
    figure.subplots_adjust(0.01, 0.06, 0.96, 0.95, 0.16, 0.1)
    for place, (title, votes, theta_rad, rho_m) in enumerate(panels, 1):
        axes = figure.add_subplot(2, 3, place, projection="3d")
        row, column = np.nonzero(votes)
        height = votes[row, column]
        axes.bar3d(rho_m[column] / 1e3, np.degrees(theta_rad[row]), 0, (rho_m[1] - rho_m[0]) / 1e3,
                   np.degrees(theta_rad[1] - theta_rad[0]), height, rasterized=True,
                   color=plt.get_cmap("turbo")(height / votes.max()))
        axes.set(title=title, xlabel="rho (km)", ylabel="theta (degrees)", xlim=(-100, 100),
                 ylim=(0, 180), zlim=(0, max(8, votes.max())))
        axes.view_init(28, -55)
        axes.set_box_aspect((4, 4, 2.6))
    axes = figure.add_subplot(2, 3, 6)
    _, votes, theta_rad, rho_m = panels[0]
    image = axes.pcolormesh(rho_m / 1e3, np.degrees(theta_rad), np.where(votes, votes, np.nan),
                            cmap="turbo", rasterized=True)
    of_theta, of_rho = lines_in_plane(scene_of(THREE))
    axes.plot(of_rho / 1e3, np.degrees(of_theta), "o", mfc="none", mec="black", ms=14,
              label="true lines")
    axes.set(title="Fig. 5 from above", xlabel="rho (km)", ylabel="theta (degrees)",
             xlim=(-100, 100), ylim=(0, 180))
    axes.legend(loc="lower left")
    figure.colorbar(image, ax=axes, label="scans that voted, all pairs")
    report.figure("figures-5-to-9-histograms", figure,
                  "Figs. 5 to 9 as histograms: the three pairs' summed votes, and two sensors' "
                  "before and after pruning, whole and above the threshold. Votes; a scan votes "
                  "once for a cell.")


def tell_cost(report):
    rows, of, exponents = [], {}, {}
    for sensors, most in SENSORS_OF.items():
        targets = [n for n in TARGETS if n <= most]
        of[sensors] = [(n, *hough_run(sensors, n, report.options.seed),
                        *assignment_run(sensors, n, report.options.seed)) for n in targets]
        rows += [[str(sensors), str(n), f"{crossings:.0f}", f"{hough_ms:.3g}", str(tuples),
                  f"{ms:.3g}", f"{solve_ms:.3g}", f"{right:.2f}"]
                 for n, hough_ms, crossings, ms, solve_ms, tuples, right in of[sensors]]
        n, hough_ms, crossings, ms, _, tuples, _ = np.array(of[sensors]).T
        exponents[sensors] = {"hough_by_crossings": slope(crossings, hough_ms),
                              "hough_by_bearings": slope(n, hough_ms),
                              "assignment_by_bearings": slope(n, ms),
                              "tuples_by_bearings": slope(n, tuples),
                              "crossings_by_bearings": slope(n, crossings)}
    report.heading("Cost beside an S-D assignment")
    report.text(
        "One look, clean, 0.1 degrees, processor time. The paper's search: a look's share of a "
        "batch of eight, no pruning. S-D: one look of S sensors, all tuples weighed and the least "
        "cost found by an integer program in Python; of it, the program alone; right: share of "
        "the targets whose tuple is theirs alone. Exponents, over the upper half: the search grows "
        + "; ".join(f"at {s} sensors like crossings^{e['hough_by_crossings']:.2f}, S-D like "
                    f"bearings^{e['assignment_by_bearings']:.2f} with "
                    f"bearings^{e['tuples_by_bearings']:.2f} tuples"
                    for s, e in exponents.items()) + ".")
    report.table(["sensors", "targets", "crossings", "Hough ms", "tuples", "S-D ms", "program ms",
                  "right"], rows)
    report.fact("cost", [{"sensors": s, **e} for s, e in exponents.items()])
    report.at_most("the paper's search, 3 sensors: exponent of its time by crossings",
                   exponents[3]["hough_by_crossings"], ALMOST_LINEAR)
