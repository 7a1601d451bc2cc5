#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment notch: radars that are blind at some range rates, or see targets twice.

Scenes notch (aircraft that pass tangentially), traffic-light (cars that stop) and guard-rail (a
rail that shows cars twice) are tracked as they are, by a tracker that is not told the notch or the
rail, and without it. Identities a target are 1 and its changes of track; false are tracks a scan
that are no target's, ghosts those beyond the ones without a rail. A rail of which nobody told is
learned, or, where that is switched off, shows images to the end; late are the scans after 20 s,
when it is learned.
"""
import dataclasses
import json
import pathlib
import tempfile

import numpy as np

from common import experiment
import real_skies
from common import scene_files
from common import scoring

RUNS = 20
NOT_TOLD = 'radars.0.told={"notch_mps": 0}'
NO_NOTCH = "radars.0.notch_mps=0"
NO_RAIL, RAIL_NOT_TOLD = "reflectors=[]", "reflectors.0.is_told=false"
OFTEN = "reflectors.0.probability=0.9"
NOT_LEARNED = ("learn_reflectors=0",)
LATE_US = 20e6


@dataclasses.dataclass
class Case:
    scene: str
    name: str
    sets: tuple = ()
    track_sets: tuple = ()
    bars: tuple = ()  # identities a target at most, completeness at least
    is_shown: bool = False


RATES = "radars.0.sigma_range_rate_mps=1"
BLIND = ("radars.0.notch_mps=8", "radars.0.blind_speed_mps=50")
CASES = (
    Case("notch", "notch of 12 m/s", bars=(1.05, 0.97), is_shown=True),
    Case("notch", "not told", (NOT_TOLD,), is_shown=True),
    Case("notch", "no notch", (NO_NOTCH,)),
    Case("notch", "with range rates", (RATES,), bars=(1.05, 0.97)),
    Case("notch", "with range rates, not told", (RATES, NOT_TOLD)),
    Case("notch", "200 clutter plots a turn", ("clutter.0.plots=200",)),
    Case("notch", "200 clutter plots, not told", ("clutter.0.plots=200", NOT_TOLD)),
    Case("notch", "8 m/s, blind speed 50 m/s", BLIND),
    Case("notch", "8 m/s, blind speed 50 m/s, not told", (*BLIND, NOT_TOLD)),
    Case("traffic-light", "notch of 0.3 m/s", bars=(1.05, 0.93), is_shown=True),
    Case("traffic-light", "not told", (NOT_TOLD,), is_shown=True),
    Case("traffic-light", "no notch", (NO_NOTCH,), bars=(1.0, 0.97)),
    Case("guard-rail", "mirrors 0.3 of the plots", bars=(1.05, 0.97), is_shown=True),
    Case("guard-rail", "not told: learned", (RAIL_NOT_TOLD,), bars=(1.05, 0.97), is_shown=True),
    Case("guard-rail", "not told, not learned", (RAIL_NOT_TOLD,), NOT_LEARNED),
    Case("guard-rail", "mirrors 0.9", (OFTEN,)),
    Case("guard-rail", "mirrors 0.9: learned", (OFTEN, RAIL_NOT_TOLD)),
    Case("guard-rail", "no rail", (NO_RAIL,)),
)


def run(job):
    """Figures of one run; of the first one also what a picture needs."""
    number, seed, is_kept = job
    case = CASES[number]
    path = scene_files.path_of(experiment.ROOT / "tools" / "scenes", case.scene)
    scene = json.loads(path.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory(prefix="rhotrack-") as name:
        folder = pathlib.Path(name)
        sets = [word for one in case.sets for word in ("--set", one)]
        real_skies.run_program(experiment.BUILD / "rhotrack",
                               ["simulate", path, "--seed", seed, "-o", folder, *sets])
        settings = scene_files.Settings(folder / "scenario.ini")
        sensors = settings.sensors()
        plots = scene_files.read_plots(folder / "plots.csv", sensors, 0.0)
        truth = scene_files.read_truth(folder, plots.scan_times_us)
        real_skies.run_program(experiment.BUILD / "rhotrack", [
            "track", folder / "plots.csv", "--config", folder / "scenario.ini", "--covariance",
            "-o", folder / "tracks.csv", *(word for one in case.track_sets
                                           for word in ("--set", one))])
        tracks = scene_files.read_tracks(folder / "tracks.csv", truth)
        figures, _ = scoring.score(truth, tracks, scoring.gate_m(sensors),
                                   scoring.forgiven_scans(scene))
        late, _ = scoring.score(*scans_after(truth, tracks, LATE_US), scoring.gate_m(sensors),
                                scoring.forgiven_scans(scene))
    targets = int(truth.visible.any(axis=0).sum())
    return {
        "identities": 1.0 + figures["switches"] / targets,
        "completeness": figures["completeness"], "false_per_scan": figures["false_per_scan"],
        "late_false": late["false_per_scan"], "rms_m": figures["rms_m"],
        "numbers": float(len({number for ids in tracks.ids for number in ids.tolist()}))
    }, (truth, tracks) if is_kept else None


def scans_after(truth, tracks, time_us):
    """The scans from this time on."""
    first = int(np.searchsorted(truth.times_us, truth.times_us[0] + time_us))
    later = {field.name: getattr(truth, field.name)[first:] for field in dataclasses.fields(truth)
             if field.name != "ids" and getattr(truth, field.name) is not None}
    return dataclasses.replace(truth, **later), scene_files.Tracks(
        tracks.ids[first:], tracks.place_m[first:], tracks.more[first:])


def range_rates(truth, place_m):
    """Of the truth's targets, by differences of places: the radar stands at the origin."""
    seconds = (truth.times_us[1:] - truth.times_us[:-1]) * 1e-6
    range_m = np.linalg.norm(place_m, axis=2)
    return np.diff(range_m, axis=0) / seconds[:, None]


def name_of(case):
    return f"{case.scene}-{case.name}".replace(" ", "-").replace(".", "").replace("/", "")


def draw_map(axes, truth, tracks):
    place_m = np.where(truth.visible[..., None], truth.place_m, np.nan)
    axes.plot(place_m[..., 0], place_m[..., 1], color="#2a9d5c", linewidth=4, alpha=0.25)
    lines = {}
    for ids, places in zip(tracks.ids, tracks.place_m):
        for number, place in zip(ids.tolist(), places):
            lines.setdefault(number, []).append(place[:2])
    for number, points in lines.items():
        axes.plot(*np.array(points).T, color=f"C{number % 10}", linewidth=1.1)
    axes.axhline(14, color="#333333", linestyle=(0, (4, 2)), linewidth=1)
    axes.set(xlabel="m", ylabel="m; the rail at 14 m", ylim=(0, 30))


def draw(report, case, shown):
    """Range over time, beside a rail a map: the truth, red in the notch, and the tracks, a colour
    for each number."""
    import matplotlib.pyplot as plt
    truth, tracks = shown
    figure, axes = plt.subplots(figsize=(9, 4.5))
    if case.scene == "guard-rail":
        draw_map(axes, truth, tracks)
        report.figure(name_of(case), figure, f"{case.scene}, {case.name}: a line a track.")
        return
    t_s = truth.times_us * 1e-6
    width = 12.0 if case.scene == "notch" else 0.3
    range_m = np.where(truth.visible, np.linalg.norm(truth.place_m, axis=2), np.nan)
    is_blind = np.abs(range_rates(truth, truth.place_m)) < width
    for j in range(range_m.shape[1]):
        axes.plot(t_s, range_m[:, j], color="#2a9d5c", linewidth=4, alpha=0.25,
                  label="truth" if j == 0 else None)
        blind = np.where(np.r_[is_blind[:, j], False], range_m[:, j], np.nan)
        axes.plot(t_s, blind, color="#d1242f", linewidth=4, alpha=0.35,
                  label="in the notch" if j == 0 else None)
    lines = {}
    for k, (ids, places) in enumerate(zip(tracks.ids, tracks.place_m)):
        for number, place in zip(ids.tolist(), places):
            lines.setdefault(number, []).append((t_s[k], float(np.hypot(*place[:2]))))
    for number, points in lines.items():
        x, y = np.array(points).T
        step_s = np.median(np.diff(t_s))
        y = np.where(np.r_[False, np.diff(x) > 1.5 * step_s], np.nan, y)
        axes.plot(x, y, color=f"C{number % 10}", linewidth=1.1)
    axes.set(xlabel="s", ylabel="m from the radar")
    axes.legend(loc="upper right")
    report.figure(name_of(case), figure,
                  f"{case.scene}, {case.name}: a line a track, a colour a number.")


def main():
    options = experiment.options_of(__doc__, RUNS)
    report = experiment.Report(
        "Radars that are blind at some range rates, or see targets twice", options)
    done = report.map(run, [(number, options.seed + k, case.is_shown and k == 0)
                            for number, case in enumerate(CASES) for k in range(options.runs)])
    rows, facts = [], []
    for number, case in enumerate(CASES):
        runs = done[number * options.runs:(number + 1) * options.runs]
        of = {key: experiment.mean_of([one[key] for one, _ in runs]) for key in runs[0][0]}
        rows.append([case.scene, case.name, f"{of['identities'][0]:.3f}",
                     f"{of['completeness'][0]:.3f}", f"{of['false_per_scan'][0]:.3f}",
                     f"{of['late_false'][0]:.3f}",
                     f"{of['numbers'][0]:.1f}", f"{of['rms_m'][0]:.1f}"])
        facts.append({"scene": case.scene, "case": case.name, **experiment.values_of(of)})
        if case.bars:
            name = f"{case.scene}, {case.name}"
            report.at_most(f"{name}: identities a target", of["identities"][0], case.bars[0],
                           of["identities"][1])
            report.at_least(f"{name}: completeness", of["completeness"][0], case.bars[1],
                            of["completeness"][1])
        if runs[0][1]:
            draw(report, case, runs[0][1])
    report.table(["scene", "case", "identities a target", "completeness", "false a scan", "late",
                  "numbers in all", "rms m"], rows)
    false = {one["case"]: one["false_per_scan"] for one in facts if one["scene"] == "guard-rail"}
    report.at_most("guard-rail: ghosts a scan", false["mirrors 0.3 of the plots"]
                   - false["no rail"], 0.02)
    late = {one["case"]: one["late_false"] for one in facts if one["scene"] == "guard-rail"}
    report.at_most("guard-rail, learned: ghosts a scan after 20 s",
                   late["not told: learned"] - late["no rail"], 0.02)
    report.fact("cases", facts)
    report.close()


if __name__ == "__main__":
    main()
