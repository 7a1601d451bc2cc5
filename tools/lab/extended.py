#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment extended: targets that give several plots a scan.

Scenes trucks (trucks and cars before a traffic radar), ships-250m, bodies-apart and ships-passing
(bodies near each other) are tracked with bodies, and as points; cars-in-clouds and people give
points that are elsewhere in each scan, as radars of 77 and 60 GHz do.
Each confirmed or coasting track belongs to the nearest target of those on whose body it is, or
within a fifth of the length of it. Tracks a target are those at a time that a target is seen;
identities all numbers that it ever had; complete is the share of times with a track. Errors are
root mean squares over length or width, from 5 s on (ships 120 s); NEES are squared errors over the
variances that are reported.
"""
import csv
import dataclasses
import pathlib
import tempfile

import numpy as np

from common import experiment
import real_skies

RUNS = 20
POINTS = "settings.body_max_m=0"
CLOUDS = ("cars-in-clouds", "people")


@dataclasses.dataclass
class Case:
    scene: str
    name: str
    sets: tuple = ()
    settle_s: float = 5.0
    is_judged: bool = False
    is_shown: bool = False


ANEW = "targets.0.body.is_anew=true"
SMALLER = 'targets.0.body={"length_m": 100, "width_m": 16, "scatterers": 10, "seen": 0.5}'
CARS_OF_THREE = tuple(f"targets.{i}.body.seen=0.25" for i in range(10))
PEOPLE_OF_SIX = tuple(f"targets.{i}.body.seen=0.2" for i in range(5))
CASES = (
    Case("trucks", "with bodies", is_judged=True, is_shown=True),
    Case("trucks", "as points", (POINTS,), is_shown=True),
    Case("trucks", "10 Hz", ("radars.0.interval_s=0.1",)),
    Case("trucks", "five times the azimuth noise", ("radars.0.sigma_azimuth_rad=0.05",)),
    Case("ships-250m", "with bodies", settle_s=120.0, is_judged=True, is_shown=True),
    Case("ships-250m", "as points", (POINTS,), settle_s=120.0, is_shown=True),
    Case("ships-250m", "scatterers anew", (ANEW,), settle_s=120.0),
    Case("ships-250m", "100 m, 10 scatterers", (SMALLER, "settings.body_max_m=150"),
         settle_s=120.0),
    Case("bodies-apart", "with bodies", is_judged=True),
    Case("ships-passing", "with bodies", settle_s=120.0, is_judged=True, is_shown=True),
    Case("cars-in-clouds", "six points each", settle_s=2.0, is_judged=True,
         is_shown=True),
    Case("cars-in-clouds", "three points each", CARS_OF_THREE, settle_s=2.0),
    Case("people", "fifteen points each", settle_s=2.0, is_judged=True, is_shown=True),
    Case("people", "six points each", PEOPLE_OF_SIX, settle_s=2.0),
)


def table(path):
    """Columns of a CSV file by name; an empty cell is NaN, a text stays."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    found = {}
    for name, cells in zip(rows[0], zip(*rows[1:])):
        try:
            found[name] = np.array([float(cell or "nan") for cell in cells])
        except ValueError:
            found[name] = np.array(cells)
    return found


def rows_by_time(columns):
    """{time in ms: rows} of a table."""
    found = {}
    for row, t_s in enumerate(columns["t_s"]):
        found.setdefault(round(t_s * 1000), []).append(row)
    return found


def place_on_body(truth, row, dx_m, dy_m):
    """Places in the target's axes, along and across."""
    speed = np.hypot(truth["vx_mps"][row], truth["vy_mps"][row])
    c, s = truth["vx_mps"][row] / speed, truth["vy_mps"][row] / speed
    return c * dx_m + s * dy_m, c * dy_m - s * dx_m


def pairs_of(truth, tracks):
    """(truth row, track row, along, across) of tracks on bodies; and how many are on none."""
    seen, pairs, others = rows_by_time(truth), [], 0
    for time_ms, rows in rows_by_time(tracks).items():
        targets = seen.get(time_ms, [])
        for row in rows:
            if tracks["status"][row] not in ("confirmed", "coasting"):
                continue
            best = None
            for target in targets:
                along, across = place_on_body(truth, target,
                                              tracks["x_m"][row] - truth["x_m"][target],
                                              tracks["y_m"][row] - truth["y_m"][target])
                slack = 0.2 * truth["length_m"][target]
                if (abs(along) <= truth["length_m"][target] / 2 + slack and
                        abs(across) <= truth["width_m"][target] / 2 + slack):
                    distance = np.hypot(along, across)
                    if best is None or distance < best[0]:
                        best = (distance, target, along, across)
            if best is None:
                others += 1
            else:
                pairs.append((best[1], row, best[2], best[3]))
    return pairs, others


def score(truth, tracks, settle_s):
    """Figures of the targets of one run, by length."""
    pairs, others = pairs_of(truth, tracks)
    ids = truth["target_id"].astype(int)
    first_s = {target: truth["t_s"][ids == target].min() for target in np.unique(ids)}
    figures = {"others": others / len(np.unique(truth["t_s"]))}
    for length_m in np.unique(truth["length_m"]):
        group = truth["length_m"] == length_m
        mine = [pair for pair in pairs if group[pair[0]]]
        target = np.array([pair[0] for pair in mine], dtype=int)
        track = np.array([pair[1] for pair in mine], dtype=int)
        off = np.array([pair[2:] for pair in mine]).reshape(-1, 2)
        one = {
            "tracks": len(mine) / len(np.unique(target)) if len(mine) else 0.0,
            "identities": len({(ids[row], tracks["track_id"][col]) for row, col in zip(
                target, track)}) / len(np.unique(ids[group])),
            "complete": len(np.unique(target)) / group.sum(),
        }
        settled = np.array([truth["t_s"][row] - first_s[ids[row]] >= settle_s for row in target],
                           dtype=bool)
        one["centre"] = float(np.sqrt((off[settled]**2).sum(axis=1).mean()) / length_m)
        if "length_m" in tracks:
            add_size_errors(one, truth, tracks, target[settled], track[settled], off[settled])
        figures[f"{length_m:g}"] = one
    return figures


def add_size_errors(one, truth, tracks, target, track, off):
    known = ~np.isnan(tracks["length_m"][track])
    target, track, off = target[known], track[known], off[known]
    for name in ("length", "width"):
        error = tracks[f"{name}_m"][track] - truth[f"{name}_m"][target]
        one[name] = float(np.sqrt(np.mean((error / truth[f"{name}_m"][target])**2)))
        one[f"{name}_mean"] = float(np.mean(error / truth[f"{name}_m"][target]))
        one[f"nees_{name}"] = float(np.mean((error / tracks[f"sigma_{name}_m"][track])**2))
    covariance = np.array([[[tracks["cov_x_x"][row], tracks["cov_y_x"][row]],
                            [tracks["cov_y_x"][row], tracks["cov_y_y"][row]]] for row in track])
    heading = tracks["heading_rad"][track]
    axes = np.stack([np.stack([np.cos(heading), np.sin(heading)], -1),
                     np.stack([-np.sin(heading), np.cos(heading)], -1)], -2)
    variance = np.einsum("nij,njk,nik->ni", axes, covariance, axes)
    variance += np.column_stack([tracks["sigma_along_m"][track]**2,
                                 tracks["sigma_across_m"][track]**2])
    one["nees_centre"] = float(np.mean(off**2 / variance))


def run(job):
    """Figures of one run; of the first one also what a picture needs."""
    number, seed, is_kept = job
    case = CASES[number]
    with tempfile.TemporaryDirectory(prefix="rhotrack-") as name:
        folder = pathlib.Path(name)
        sets = [word for one in case.sets for word in ("--set", one)]
        program = experiment.BUILD / "rhotrack"
        real_skies.run_program(program, ["simulate", case.scene, "--seed", seed, "-o", folder,
                                         *sets])
        real_skies.run_program(program, [
            "track", folder / "plots.csv", "--config", folder / "scenario.ini", "--covariance",
            "-o", folder / "tracks.csv"])
        truth, tracks = table(folder / "truth.csv"), table(folder / "tracks.csv")
        plots = table(folder / "plots.csv") if is_kept else None
    return score(truth, tracks, case.settle_s), (truth, tracks, plots) if is_kept else None


def draw_bodies(axes, columns, rows, heading, **style):
    """Rectangles about places."""
    for row, angle in zip(rows, heading):
        half = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1], [1, 1]]) / 2
        half = half * [columns["length_m"][row], columns["width_m"][row]]
        c, s = np.cos(angle), np.sin(angle)
        axes.plot(columns["x_m"][row] + c * half[:, 0] - s * half[:, 1],
                  columns["y_m"][row] + s * half[:, 0] + c * half[:, 1], **style)


def draw(report, case, shown):
    """The plots of a few seconds, the bodies as they are, and the tracks' at one time."""
    import matplotlib.pyplot as plt
    truth, tracks, plots = shown
    figure, axes = plt.subplots(figsize=(9, 4.5))
    t_s = sorted(set(truth["t_s"]))[int(0.55 * len(set(truth["t_s"])))]
    near = abs(plots["t_s"] - t_s) < (0.5 if case.scene == "trucks" else 2.6)
    axes.plot(plots["range_m"][near] * np.cos(plots["azimuth_rad"][near]),
              plots["range_m"][near] * np.sin(plots["azimuth_rad"][near]), ".", color="#999999",
              markersize=3)
    rows = np.nonzero(np.isclose(truth["t_s"], t_s))[0]
    draw_bodies(axes, truth, rows, np.arctan2(truth["vy_mps"][rows], truth["vx_mps"][rows]),
                color="#2a9d5c", linewidth=4, alpha=0.3)
    rows = np.nonzero(np.isclose(tracks["t_s"], t_s) & (tracks["status"] != "tentative"))[0]
    if "length_m" in tracks:
        draw_bodies(axes, tracks, rows, tracks["heading_rad"][rows], color="C3", linewidth=1.2)
    axes.plot(tracks["x_m"][rows], tracks["y_m"][rows], "+", color="C3")
    axes.set(xlabel="m", ylabel="m")
    if case.scene != "trucks":
        axes.set_aspect("equal")
    report.figure(f"{case.scene}-{case.name}".replace(" ", "-"), figure,
                  f"{case.scene}, {case.name}: plots, bodies as they are (green), tracks (red).")


def tell_width_bound(report):
    """The least sigma of a car's width by all its plots, as it comes nearer: by squares of places,
    each with the variance W^2 / 12 + R^2 sigma^2. And what few scatterers leave open at any range.
    """
    width_m, speed_mps, plots_a_second, sigma_rad, rows, told = 1.8, 24.0, 36.0, 0.01, [], 0.0
    place_m2 = width_m**2 / 12
    for range_m in range(190, 9, -1):
        noise_m2 = (range_m * sigma_rad)**2
        told += plots_a_second / speed_mps / (2 * (place_m2 + noise_m2)**2)
        if range_m in (150, 100, 50, 25, 10):
            rows.append([f"{range_m}", f"{6 * told**-0.5 / width_m:.2f}"])
    report.heading("What can be known of a car's width")
    report.table(["range m", "least sigma m"], rows)
    report.text(f"Three scatterers, each anywhere in its third of the width, leave {3**-1.5:.2f} "
                "of it open at any range. From afar a reported width of 1.8 m is mostly the "
                "prior's, whose error is the same for all cars: its NEES tells how the prior suits "
                "cars.")


def judge(report, case, length, of):
    name = f"{case.scene}, {length} m"
    most = 1.02 if case.scene in CLOUDS else 1.05
    report.at_most(f"{name}: tracks a target", of["tracks"][0], most, of["tracks"][1])
    if case.scene not in CLOUDS:
        report.at_most(f"{name}: identities a target", of["identities"][0], 1.05,
                       of["identities"][1])
    report.at_least(f"{name}: complete", of["complete"][0], 0.97, of["complete"][1])
    if case.scene == "ships-250m":
        report.at_most(f"{name}: centre over length", of["centre"][0], 0.1, of["centre"][1])
        report.at_most(f"{name}: error of length", of["length"][0], 0.2, of["length"][1])
        report.at_most(f"{name}: error of width", of["width"][0], 0.2, of["width"][1])
    for key in ("nees_centre", "nees_length", "nees_width"):
        if case.scene in ("ships-250m", "trucks"):
            report.at_least(f"{name}: {key}", of[key][0], 0.8, of[key][1])
            report.at_most(f"{name}: {key}", of[key][0], 1.25, of[key][1])


def main():
    options = experiment.options_of(__doc__, RUNS)
    report = experiment.Report("Targets that give several plots a scan", options)
    done = report.map(run, [(number, options.seed + k, case.is_shown and k == 0)
                            for number, case in enumerate(CASES) for k in range(options.runs)])
    rows, facts = [], []
    for number, case in enumerate(CASES):
        runs = done[number * options.runs:(number + 1) * options.runs]
        for length in (key for key in runs[0][0] if key != "others"):
            of = {key: experiment.mean_of([one[length][key] for one, _ in runs])
                  for key in runs[0][0][length]}
            rows.append([case.scene, case.name, length] + [
                f"{of[key][0]:.3f}" if key in of else "" for key in (
                    "tracks", "identities", "complete", "centre", "length", "width",
                    "nees_centre", "nees_length", "nees_width")])
            facts.append({"scene": case.scene, "case": case.name, "length_m": float(length),
                          **experiment.values_of(of)})
            if case.is_judged:
                judge(report, case, length, of)
        if runs[0][1]:
            draw(report, case, runs[0][1])
    report.table(["scene", "case", "length m", "tracks a target", "identities a target",
                  "complete", "centre over length", "length", "width", "NEES centre",
                  "NEES length", "NEES width"], rows)
    report.fact("cases", facts)
    tell_width_bound(report)
    report.close()


if __name__ == "__main__":
    main()
