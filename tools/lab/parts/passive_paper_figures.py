# SPDX-License-Identifier: MIT
"""The passive paper's figures: fixed scenes, what is left of their crossings, the lines found in
them, and feature and parameter space as pictures; with what the experiment needs of lines."""
import functools
import itertools

import numpy as np

import rhotrack
from parts.passive_scenes import PLACES_M, Scene, Setting
from parts.passive_runs import RULES

RANGE_MAX_M, CELL_M = 100e3, 1000
NEAR_RAD, NEAR_M = np.radians(6), 3000  # a line this near to a target's is the target's
TWO, THREE = Setting(2, 2, 0.05), Setting(3, 2, 0.05)  # lines fill few cells
# Sought among many, so that they show what the paper's figures do. Of two sensors: ghosts lie in
# view and on lines, and pruning removes them all. Of three: it does not, and pairs of sensors find
# ghosts' lines that the others do not confirm.
SEED, TWO_RUN, THREE_RUN = 1, 4, 93
ROWS = [  # the paper's figures, scene, sensors, rule, T
    ("2, 6, 7", TWO, (1, 2), "none", 7), ("3, 8, 9", TWO, (1, 2), "literal", 7),
    ("4, 5", THREE, (1, 2), "literal", 6), ("4, 5", THREE, (1, 3), "literal", 6),
    ("4, 5", THREE, (2, 3), "literal", 6), ("4, 5", THREE, (1, 2, 3), "literal", 6)]
VIEW_KM, RHO_KM = ((-20, 80), (-60, 60)), 100
COLOURS = ("#0072b2", "#d55e00", "#cc79a7")


# ---- Lines ----

def line_of(states):
    """theta (0 to pi) and rho of the path of states x, y, vx, vy: x cos + y sin = rho."""
    x_m, y_m, vx_mps, vy_mps = np.moveaxis(np.asarray(states, float), -1, 0)
    theta_rad = np.arctan2(vx_mps, -vy_mps) % np.pi
    return theta_rad, x_m * np.cos(theta_rad) + y_m * np.sin(theta_rad)


def line_off(a, b):
    """How far lines (theta, rho) are apart: theta, and rho with the sign that goes with it."""
    theta_rad = np.abs(a[0] - b[0])
    is_turned = theta_rad > np.pi / 2
    return (np.where(is_turned, np.pi - theta_rad, theta_rad),
            np.where(is_turned, np.abs(a[1] + b[1]), np.abs(a[1] - b[1])))


@functools.cache
def paper_of(rule, votes_min):
    return rhotrack.Passive(method="passive-paper", prune=rule, votes_min=votes_min)


def search_paper(scene, rule, votes_min, sensors=None):
    return paper_of(rule, votes_min).find(scene.frames(sensors))


def near_targets(lines, scene):
    """(lines, targets): whether the line is near the target's."""
    theta_rad, rho_m = line_off((lines["theta_rad"][:, None], lines["rho_m"][:, None]),
                                line_of(scene.start))
    return (theta_rad < NEAR_RAD) & (rho_m < NEAR_M)


def lines_matched(lines, scene):
    """Targets with a line near theirs, and lines near no target's."""
    is_near = near_targets(lines, scene)
    return int(is_near.any(axis=0).sum()), int((~is_near.any(axis=1)).sum())


def second_lines(lines, scene, rule):
    """Of the lines near no target's: those for which one target's crossings cast most votes."""
    strange = lines[~near_targets(lines, scene).any(axis=1)]
    if not len(strange):
        return 0
    left = crossings_left(scene, range(1, scene.of.sensors + 1), rule)
    theta_rad, rho_m = strange["theta_rad"][:, None], strange["rho_m"][:, None]
    off_m = np.abs(left[:, 1] * np.cos(theta_rad) + left[:, 2] * np.sin(theta_rad) - rho_m)
    return sum(int(2 * np.bincount(of.astype(int), minlength=2)[1:].max() > len(of))
               for of in (left[is_in, 3] for is_in in off_m <= CELL_M / 2))


# ---- Scenes ----

@functools.cache
def scene_of(setting):
    return Scene(setting, np.random.default_rng([SEED, TWO_RUN if setting == TWO else THREE_RUN]))


def crossings_left(scene, sensors, rule):
    """Rows of frame, x_m, y_m, number of the target from 1, 0 of a ghost; of all pairs of
    sensors."""
    looks, left = scene.looks(), []
    for k in range(scene.of.frames):
        for a, b in itertools.combinations(sensors, 2):
            of_a, of_b = looks[k, a - 1], looks[k, b - 1]
            found = rhotrack.ghosts(of_a["bearing_rad"], of_b["bearing_rad"], PLACES_M[a - 1],
                                    PLACES_M[b - 1], RANGE_MAX_M, rule)
            for i, j in np.argwhere(found.reason == "kept"):
                target = of_a["target_id"][i]
                left.append((k, found.x_m[i, j], found.y_m[i, j],
                             target + 1 if target == of_b["target_id"][j] else 0))
    return np.array(left, float).reshape(-1, 4)


def figures():
    """Of each row of ROWS: crossings of targets, ghosts, lines of targets, lines of ghosts."""
    found = []
    for _, setting, sensors, rule, votes_min in ROWS:
        scene = scene_of(setting)
        is_target = crossings_left(scene, sensors, rule)[:, 3] > 0
        found.append((int(is_target.sum()), int((~is_target).sum()),
                      *lines_matched(search_paper(scene, rule, votes_min, sensors), scene)))
    return found


def tell(report):
    report.heading("The paper's figures")
    report.text(
        "Scenes with the paper's sensors at (10 km, -90 degrees) and (10 km, 90 degrees), the "
        "third at (10 km, 0): two targets, eight scans, 0.05 degrees, nothing missed, nothing "
        "false; cells of 2 degrees and 1 km, votes of distinct scans. They are fixed (runs "
        f"{TWO_RUN} and {THREE_RUN} of seed {SEED}), and were sought so that they show what the "
        "paper's figures do; the tables say how often it is so.")
    found = figures()
    report.table(["figures", "sensors", "pruning", "target crossings", "ghosts", "T",
                  "targets' lines", "ghosts' lines"], [
        [of, sensors_text(sensors), RULES[rule], crossings, ghosts,
         f"{votes_min} of {setting.frames}", lines, ghost_lines]
        for (of, setting, sensors, rule, votes_min), (crossings, ghosts, lines, ghost_lines)
        in zip(ROWS, found)])
    report.fact("figures", [
        {"figures": of, "sensors": sensors_text(sensors), "rule": RULES[rule],
         "target_crossings": crossings, "ghosts": ghosts, "votes_min": votes_min,
         "target_lines": lines, "ghost_lines": ghost_lines}
        for (of, _, sensors, rule, votes_min), (crossings, ghosts, lines, ghost_lines)
        in zip(ROWS, found)])
    draw(report)


def sensors_text(sensors):
    return "all three" if len(sensors) == 3 else f"{sensors[0]} and {sensors[1]}"


# ---- Pictures ----

def draw(report):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    scene, (before, after) = scene_of(TWO), ROWS[:2]
    figure, axes = plt.subplots(1, 2, figsize=(12, 6.6), sharey=True, layout="constrained")
    for axis, number, (_, _, sensors, rule, _) in zip(axes, (2, 3), (before, after)):
        left = crossings_left(scene, sensors, rule)
        for which, colour, name in ((1, COLOURS[0], "crossings of targets"),
                                    (0, COLOURS[1], "ghosts")):
            x_m, y_m = left[(left[:, 3] > 0) == which, 1:3].T
            axis.plot(x_m / 1e3, y_m / 1e3, "x", color=colour, label=name, ms=7, mew=1.6)
        draw_map(axis, scene)
        axis.set_title(f"Fig. {number}: feature space, {RULES[rule]}")
    axes[0].legend(loc="upper left")
    report.figure("figures-2-and-3", figure, "Figs. 2 and 3, feature space: two real trajectories "
                  "and the ghosts in view, before and after pruning.")

    figure, axes = plt.subplots(2, 2, figsize=(12, 8), sharex=True, sharey=True,
                                layout="constrained")
    for row, numbers, (_, _, sensors, rule, votes_min) in zip(axes, ((6, 7), (8, 9)),
                                                             (before, after)):
        plane = paper_of(rule, votes_min).accumulators(scene.frames())[sensors]
        for axis, number, least in zip(row, numbers, (1, votes_min)):
            shown = np.where(plane.votes >= least, plane.votes, np.nan)
            image = axis.pcolormesh(plane.rho_m / 1e3, np.degrees(plane.theta_rad), shown,
                                    cmap=plt.get_cmap("YlOrRd", 8), vmin=0.5, vmax=8.5,
                                    rasterized=True)
            draw_true_lines(axis, scene)
            axis.set_title(f"Fig. {number}: {RULES[rule]}, T = {least}")
    figure.colorbar(image, ax=axes, ticks=range(1, 9), label="scans that voted")
    axes[0, 0].legend(loc="lower left")
    report.figure("figures-6-to-9", figure, "Figs. 6 to 9, parameter space: what the crossings of "
                  "Figs. 2 and 3 vote for, and the cells with T votes.")

    scene = scene_of(THREE)
    figure, (space, lines) = plt.subplots(1, 2, figsize=(13, 6.6), layout="constrained")
    for (_, _, sensors, rule, votes_min), colour, marker in zip(ROWS[2:5], COLOURS, "x+1"):
        name = f"sensors {sensors_text(sensors)}"
        x_m, y_m = crossings_left(scene, sensors, rule)[:, 1:3].T
        space.plot(x_m / 1e3, y_m / 1e3, marker, color=colour, label=name, ms=8, mew=1.6)
        found = search_paper(scene, rule, votes_min, sensors)
        lines.plot(found["rho_m"] / 1e3, np.degrees(found["theta_rad"]), marker, color=colour,
                   label=name, ms=11, mew=2)
    found = search_paper(scene, *ROWS[5][3:], ROWS[5][2])
    lines.plot(found["rho_m"] / 1e3, np.degrees(found["theta_rad"]), "s", mfc="none", mec="#7f7f7f",
               ms=20, mew=2, label="confirmed by all")
    draw_map(space, scene)
    draw_true_lines(lines, scene)
    space.set_title("Fig. 4: feature space, three sensors")
    lines.set_title("Fig. 5: lines of each pair")
    for axis in (space, lines):
        axis.legend(loc="upper left")
    report.figure("figures-4-and-5", figure, "Figs. 4 and 5, three sensors observe two "
                  "trajectories: crossings of each pair that pruning leaves, the lines of each "
                  "pair, and those that all pairs confirm.")


def draw_map(axis, scene):
    places = scene.truth(scene.times_s)[..., :2].reshape(-1, 2) / 1e3
    axis.plot(*places.T, "o", mfc="none", mec="black", ms=10, label="true positions")
    sensors = PLACES_M[:scene.of.sensors] / 1e3
    axis.plot(*sensors.T, "^", color="#009e73", ms=9, label="sensors")
    for i, place in enumerate(sensors):
        axis.annotate(str(i + 1), place, (-14, -4), textcoords="offset points")
    axis.set(xlim=VIEW_KM[0], ylim=VIEW_KM[1], xlabel="x (km)", ylabel="y (km)",
             aspect="equal")


def draw_true_lines(axis, scene):
    theta_rad, rho_m = line_of(scene.start)
    axis.plot(rho_m / 1e3, np.degrees(theta_rad), "o", mfc="none", mec="black", ms=14,
              label="true lines")
    axis.set(xlim=(-RHO_KM, RHO_KM), ylim=(0, 180), xlabel="rho (km)", ylabel="theta (degrees)")
