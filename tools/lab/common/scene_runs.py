# SPDX-License-Identifier: MIT
"""Runs of scenes that an experiment makes: `rhotrack simulate`, `rhotrack track`, and scores at the
radar's scans, beside the oracle, which is told the target of each plot and that targets live
throughout, and has no bearings."""
import json
import pathlib
import sys
import tempfile

import numpy as np

from common import experiment
from common import oracle
from common import scene_files
from common import scoring
import real_skies

FIGURES = ("completeness", "false_per_scan", "switches", "rms_m")
HEADINGS = ("completeness", "false/scan", "switches", "rms m")
FORMATS = ("{:.3f}", "{:.3f}", "{:.2f}", "{:.1f}")


def at_scans(truth, times_us):
    """The truth at these of its times."""
    rows = np.unique(truth.scan_of(times_us))
    return scene_files.Truth(truth.times_us[rows], truth.ids, truth.place_m[rows],
                             truth.visible[rows], truth.velocity_mps[rows])


def run(job):
    """(case, {who: figures}) of one scene and seed, who being tracker and oracle."""
    case, scene, gate_m, seed, options = job
    sets = [word for pair in options.set for word in ("--set", pair)]
    with tempfile.TemporaryDirectory(prefix="rhotrack-") as name:
        folder = pathlib.Path(name)
        (folder / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
        real_skies.run_program(options.simulator or options.program, [
            "simulate", folder / "scene.json", "--seed", seed, "-o", folder])
        inputs = [folder / "plots.csv"] + [folder / "bearings.csv"] * ("passive" in scene)
        real_skies.run_program(options.program, [
            "track", *inputs, "--config", folder / "scenario.ini", *sets, "-o",
            folder / "tracks.csv"])
        settings = scene_files.Settings(folder / "scenario.ini")
        sensors = {**settings.sensors(), None: settings.sensor()}
        plots = scene_files.read_plots(folder / "plots.csv", sensors)
        truth = at_scans(scene_files.read_truth(folder, plots.scan_times_us), plots.scan_times_us)
        followed = oracle.follow(plots, truth, sensors,
                                 [(scene["oracle"]["process_noise_mps2"],)],
                                 settings.get("v_max_mps", 700.0), live_throughout=True)
        by_who = {
            "tracker": scene_files.read_tracks(folder / "tracks.csv", truth),
            "oracle": oracle.as_tracks(truth, followed)
        }
    scores = {who: scoring.score(truth, tracks, gate_m)[0] for who, tracks in by_who.items()}
    return case, {who: {key: found[key] for key in FIGURES} for who, found in scores.items()}


def run_all(report, cases, gate_m, options):
    """{case: [figures of each seed]}; cases: {name: scene, or a function of the seed}. Writes the
    scenes of the first seed to OUTPUT; ends the program where a command fails."""
    jobs = []
    options.output.mkdir(parents=True, exist_ok=True)
    for number, (case, scene) in enumerate(cases.items()):
        for seed in range(options.seed, options.seed + options.runs):
            made = scene(seed) if callable(scene) else scene
            if seed == options.seed:
                (options.output / f"scene-{number:02}.json").write_text(
                    json.dumps({**made, "text": case}, indent=1) + "\n", encoding="utf-8")
            jobs.append((case, made, gate_m, seed, options))
    found = {case: [] for case in cases}
    try:
        for case, figures in report.map(run, jobs):
            found[case].append(figures)
    except (real_skies.Failed, OSError, ValueError) as error:
        sys.stderr.write(f"{pathlib.Path(sys.argv[0]).name}: {error}\n")
        sys.exit(1)
    return found


def means_of(runs, who):
    """{figure: (mean, standard error)} over seeds."""
    return {key: experiment.mean_of([run[who][key] for run in runs]) for key in FIGURES}


def cells_of(figures):
    return [form.format(figures[key][0]) for key, form in zip(FIGURES, FORMATS)]
