#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment extended: targets that give several plots a scan.

Scenes trucks (trucks and cars before a traffic radar), ships-250m, bodies-apart and ships-passing
(bodies near each other) are tracked with bodies, and as points; the others give points that are
elsewhere in each scan, as radars of 77 and 60 GHz do. Those in SITUATIONS are beside an oracle: a
Kalman filter of each target, told which points are whose, from their middle.
Each confirmed or coasting track belongs to the nearest target of those on whose body it is, or
within a fifth of the length of it. Tracks a target are those at a time that a target is seen;
identities all numbers that it ever had; switches are times at which none of its tracks has the
number of its last one; complete is the share of times with a track. Errors are root mean squares
over length or width, from 5 s on (ships 120 s); NEES are squared errors over the variances that are
reported.
"""
import csv
import dataclasses
import pathlib
import tempfile

import numpy as np

from common import experiment
from common import oracle
from common import scene_files
from common import scene_runs
import real_skies

RUNS = 20
POINTS = "settings.body_max_m=0"
CLOUDS = ("cars-in-clouds", "people")
ORACLE = "oracle"
ORACLE_NOISE = (0.1, 3.0, 5.0)  # quiet, agile, seconds in each: the best of a few in all four
SITUATIONS = ("people-at-home", "people-passing", "cars-at-a-light", "bus-stop")


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
    *(Case(scene, "with bodies", settle_s=2.0, is_judged=True, is_shown=True)
      for scene in SITUATIONS),
    Case("bus-stop", "of 15 m at most", ("settings.body_max_m=15",), settle_s=2.0),
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


def with_kept_headings(truth):
    """A target that stands is headed as it came: it creeps."""
    last = {}
    for row, target in enumerate(truth["target_id"]):
        velocity = np.array([truth["vx_mps"][row], truth["vy_mps"][row]])
        if np.hypot(*velocity) > 0.1:
            last[target] = velocity / np.hypot(*velocity)
        elif target in last:
            truth["vx_mps"][row], truth["vy_mps"][row] = 1e-3 * last[target]
    return truth


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


def count_switches(truth, tracks, pairs):
    """How often a target has no track of its last one's number, by these pairs."""
    ids, seen = truth["target_id"].astype(int), {}
    for row, col, along, across in pairs:
        seen.setdefault((ids[row], truth["t_s"][row]), []).append(
            (np.hypot(along, across), tracks["track_id"][col]))
    last, count = {}, 0
    for (target, _), found in sorted(seen.items()):
        numbers = [number for _, number in found]
        count += target in last and last[target] not in numbers
        if last.get(target) not in numbers:
            last[target] = min(found)[1]
    return count


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
            "switches": count_switches(truth, tracks, mine) / len(np.unique(ids[group])),
            "targets": len(np.unique(ids[group])),
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


def middles_of(plots, noise_m2):
    """One plot of each target and scan, the middle of all that are its own; and its covariance."""
    own = np.flatnonzero(plots.target >= 0)
    _, first, which, count = np.unique(
        np.stack([plots.scan[own], plots.target[own]]), axis=1, return_index=True,
        return_inverse=True, return_counts=True)
    which = which.ravel()
    middle_m = np.column_stack([np.bincount(which, plots.place_m[own, axis]) / count
                                for axis in (0, 1)])
    rows = own[first]
    middles = dataclasses.replace(
        plots, place_m=middle_m, **{
            name: getattr(plots, name)[rows]
            for name in ("times_us", "scan", "target", "sensor", "range_m", "azimuth_rad")})
    return middles, noise_m2[rows] / count[:, None, None]


def follow_told(folder, columns):
    """The oracle's tracks of a run: Kalman filters, told which points are whose."""
    settings = scene_files.Settings(folder / "scenario.ini")
    sensors = settings.sensors()
    plots = scene_files.read_plots(folder / "plots.csv", sensors)
    truth = scene_runs.at_scans(scene_files.read_truth(folder, plots.scan_times_us),
                                plots.scan_times_us)
    size_m = dict(zip(columns["target_id"], columns["length_m"]))
    spread_m2 = np.array([size_m.get(target, 0.0)**2 / 12 for target in plots.target])
    middles, noise_m2 = middles_of(plots, oracle.measurement_noise(plots, sensors) +
                                   spread_m2[:, None, None] * np.eye(2))
    times_us, ids, _, places_m, _ = oracle.follow(
        middles, truth, sensors, [ORACLE_NOISE], settings.get("v_max_mps", 0.0),
        live_throughout=True, noise=noise_m2)
    return {"t_s": times_us / 1e6, "track_id": ids, "status": np.full(len(ids), "confirmed"),
            "x_m": places_m[0, :, 0], "y_m": places_m[0, :, 1]}


def run(job):
    """Figures of one run, by who tracks; of the first one also what a picture needs."""
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
        truth = with_kept_headings(table(folder / "truth.csv"))
        tracks = table(folder / "tracks.csv")
        plots = table(folder / "plots.csv") if is_kept else None
        figures = {case.name: score(truth, tracks, case.settle_s)}
        if case.scene in SITUATIONS:
            figures[ORACLE] = score(truth, follow_told(folder, truth), case.settle_s)
    return figures, (truth, tracks, plots) if is_kept else None


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


def judge(report, case, length, by_who):
    name, of = f"{case.scene}, {length} m", by_who[case.name]
    is_cloud = case.scene in CLOUDS or case.scene in SITUATIONS
    report.at_most(f"{name}: tracks a target", of["tracks"][0], 1.02 if is_cloud else 1.05,
                   of["tracks"][1])
    if not is_cloud:
        report.at_most(f"{name}: identities a target", of["identities"][0], 1.05,
                       of["identities"][1])
    if case.scene in SITUATIONS:
        value, error = (of["targets"][0] * part for part in of["switches"])
        report.at_most(f"{name}: switches a run", value, 0.5, error)
        report.at_least(f"{name}: complete, less the oracle's",
                        of["complete"][0] - by_who[ORACLE]["complete"][0], -0.01,
                        np.hypot(of["complete"][1], by_who[ORACLE]["complete"][1]))
    else:
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
        for length in (key for key in runs[0][0][case.name] if key != "others"):
            by_who = {
                who: {key: experiment.mean_of([one[who][length][key] for one, _ in runs])
                      for key in runs[0][0][who][length]} for who in runs[0][0]}
            for who, of in by_who.items():
                rows.append([case.scene, who, length] + [
                    f"{of[key][0]:.3f}" if key in of else "" for key in (
                        "tracks", "identities", "switches", "complete", "centre", "length",
                        "width", "nees_centre", "nees_length", "nees_width")])
                facts.append({"scene": case.scene, "case": who, "length_m": float(length),
                              **experiment.values_of(of)})
            if case.is_judged:
                judge(report, case, length, by_who)
        if runs[0][1]:
            draw(report, case, runs[0][1])
    report.table(["scene", "case", "length m", "tracks a target", "identities a target",
                  "switches a target", "complete", "centre over length", "length", "width",
                  "NEES centre", "NEES length", "NEES width"], rows)
    report.fact("cases", facts)
    tell_width_bound(report)
    report.close()


if __name__ == "__main__":
    main()
