#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Targets that manoeuvre in clutter: Methods I to III of the maintenance paper, and the default.

The paper: "A novel tracking algorithm by integrating the Kalman filter, input estimation, and
clutter elimination algorithm to track maneuvering targets in cluttered environments". It gives
neither scenarios nor sizes of manoeuvres: the profiles and 10 g are ours
(maneuver_truth.py), so that the paper's velocity errors come out. Values behind a stroke
were measured by an independent implementation in double precision, 500 runs a case (200 at 100
clutter plots).

The methods are the gates of `rhotrack maintain`, one track alone that is never dropped; references
(reference_filters.py) know which plot is the target's, the clairvoyant one its input as
well.
"""
import math
from dataclasses import dataclass, replace

import numpy as np

from common import experiment
from parts.maneuver_truth import CLEAN_SCANS, INTERVAL_S, SCANS, Scene, Setting
from parts.maneuver_follow import FIRST_RUNS, Method, follow, outcome_of, summary_of

NAN = math.nan
CHUNK = 25  # runs side by side

# ---- cases ----


@dataclass(frozen=True)
class Case:
    name: str
    setting: Setting
    methods: tuple
    lost_max: float = NAN  # bars of the default; NaN, False: none
    ratio_max: float = NAN  # rms error over that of the IMM that knows the plots
    has_nis: bool = True


DEFAULT, CLAIRVOYANT = Method("default"), Method("clairvoyant", "clairvoyant")
IMM = Method("IMM, true plots", "imm")
METHOD_I, METHOD_II = Method("I", "hough"), Method("II", "hough", estimates=False)
FORGETS = Method("I, gamma .5", "hough", gamma=0.5)

PAPER = Setting("pop-up", literal=True, noise=1.0, sensor="velocities", sigma_m=1, sigma_mps=1,
                clutter=4, pd=1.0, beam="truth")
PAPER_METHODS = (METHOD_I, FORGETS, METHOD_II, Method("III", "none"),
                 Method("nearest", "nearest", gamma=0.5), CLAIRVOYANT, DEFAULT)
PAPER_CASES = [Case(f"{profile}, N {clutter}", replace(PAPER, profile=profile, clutter=clutter),
                    PAPER_METHODS)
               for profile in ("pop-up", "weave") for clutter in (4, 10, 30, 100)]

# For each Q four filters.
NOISES = (1.0, 0.01, 1e-4)
NOISE_CASE = Case("pop-up, N 4, true Q 1e-4 I", replace(PAPER, noise=1e-4), tuple(
    replace(method, noise=math.sqrt(q)) for q in NOISES
    for method in (METHOD_II, METHOD_I, Method("I, gamma .7", "hough", gamma=0.7), FORGETS)))

# Where places alone are measured, an input that moves no place is not seen.
CLOSED_METHODS = (DEFAULT, IMM, CLAIRVOYANT, Method("paper", "hough", physical=True),
                  Method("nearest", "nearest", physical=True))
VELOCITY_METHODS = tuple(replace(one, physical=False) for one in CLOSED_METHODS)
FIELD = Setting()
VELOCITY = replace(FIELD, sensor="velocities", sigma_mps=10)
POLAR = replace(FIELD, sensor="polar", sigma_m=15, sigma_rad=3e-3, clutter=0, beam="all round")


def closed(name, lost_max=NAN, ratio_max=NAN, has_nis=True, methods=CLOSED_METHODS, of=FIELD,
           **setting):
    return Case(name, replace(of, **setting), methods, lost_max, ratio_max, has_nis)


def velocity(name, *bars, **setting):
    return closed(f"velocity, {name}", *bars, methods=VELOCITY_METHODS, of=VELOCITY, **setting)


def polar(name, *bars, **setting):
    return closed(f"polar {name}, .9", *bars, methods=CLOSED_METHODS[:3], of=POLAR, **setting)


CLOSED_CASES = [  # g, sigma in metres, clutter plots, P_D
    closed("10, 10, 10, 1", NAN, 1.15, pd=1.0),
    closed("10, 10, 30, 1", 0.002, clutter=30, pd=1.0),
    closed("10, 10, 4, .9", NAN, 1.15, clutter=4),
    closed("10, 10, 10, .9", 0.02, 1.15),
    closed("10, 10, 30, .9", 0.035, clutter=30),
    closed("10, 10, 100, .9", 0.2, clutter=100),
    closed("1, 10, 10, .9", 0.01, 1.15, pull_g=1),
    closed("2, 10, 10, .9", 0.01, 1.15, pull_g=2),
    closed("3, 10, 10, .9", 0.01, 1.15, pull_g=3),
    closed("30, 10, 10, .9", NAN, NAN, False, pull_g=30),
    closed("30, 10, 10, .9, told 30 g", 0.15, 1.15, False, pull_g=30, told_g=30),
    closed("10, 1, 10, .9", NAN, 1.15, sigma_m=1),
    closed("30, 1, 10, .9", NAN, NAN, False, pull_g=30, sigma_m=1),
    closed("30, 1, 10, .9, told 30 g", 0.02, 1.15, False, pull_g=30, sigma_m=1, told_g=30),
    closed("10, 50, 4, 1", sigma_m=50, clutter=4, pd=1.0),
    closed("3, 50, 10, .9", pull_g=3, sigma_m=50),
    closed("pop-up, 10, 10, 10, .9", 0.01, 1.15, profile="pop-up"),
    closed("turn, 10, 10, 10, .9", 0.01, 1.15, profile="turn"),
    velocity("10, 10, 10, .9", NAN, 1.15),
    velocity("10, 10, 100, .9", 0.005, clutter=100),
    velocity("30, 10, 30, .9", NAN, NAN, False, pull_g=30, clutter=30),
    velocity("10, 50, 30, .9", sigma_m=50, sigma_mps=50, clutter=30),
    polar("2-D, 10 g, no clutter", NAN, 1.1),
    polar("3-D, 10 g, no clutter", NAN, 1.1, sensor="polar 3-D"),
    polar("3-D, 10 g, N 4", NAN, NAN, False, sensor="polar 3-D", clutter=4)]

PD_CASE = Case("10, 10, 10, .9", FIELD,
               tuple(Method(f"{pd:g}", pd=pd) for pd in (0.7, 0.8, 0.9, 0.97, 0.99)))

# What the paper leaves open, or prints otherwise than it is read here.
WEAVE_CASE = Case("weave, N 4, true Q 1e-4 I", replace(NOISE_CASE.setting, profile="weave"),
                  NOISE_CASE.methods)
READ_CASES = [
    Case("the full beam, R sin(1.2 degrees)", replace(PAPER, beam_deg=1.2), PAPER_METHODS[:4]),
    Case("start values in the printed order of digits", replace(PAPER, is_printed=True),
         PAPER_METHODS[:4]),
    *[Case(f"{profile}: methods as they may be meant", replace(PAPER, profile=profile), (
        METHOD_I, METHOD_II, Method("input estimation, plot at random", "none"),
        Method("none of both, plot at random", "none", estimates=False)))
      for profile in ("pop-up", "weave")]]
CASES = [*PAPER_CASES, NOISE_CASE, *CLOSED_CASES, PD_CASE, WEAVE_CASE, *READ_CASES]
PICTURED = {0: ("I", "II", "III", "default"), 4: ("I", "II", "III", "default"),
            len(PAPER_CASES): ("II", "I, gamma .5"),  # of several Q the last
            len(CASES) - len(READ_CASES) - 1: ("II", "I, gamma .5")}

# Measured elsewhere: inside, wrong, most m, rms m, by case and method.
ELSEWHERE = {
    ("pop-up, N 4", "I"): (1, 4e-5, 188, 1.89), ("pop-up, N 4", "I, gamma .5"): (1, 1e-5, 71, 1.42),
    ("pop-up, N 4", "III"): (0.29, 0.8, 734, 296), ("pop-up, N 4", "nearest"): (1, 0, 4, 1.38),
    ("pop-up, N 10", "I"): (1, 1.4e-4, 163, 2.27), ("pop-up, N 30", "I"): (1, 2.4e-4, 222, 2.76),
    ("pop-up, N 100", "I"): (0.995, 3.5e-3, 469, 19.3),
    ("pop-up, N 100", "I, gamma .5"): (1, 4.1e-4, 252, 3.28),
    ("pop-up, N 100", "nearest"): (1, 3e-5, 4, 1.38),
    ("weave, N 4", "I"): (1, 0, 4, 1.46), ("weave, N 4", "I, gamma .5"): (1, 0, 4, 1.41),
    ("weave, N 4", "III"): (0.31, 0.8, 734, 296), ("weave, N 4", "nearest"): (1, 0, 4, 1.41),
    ("weave, N 10", "I"): (1, 4e-5, 190, 1.91), ("weave, N 30", "I"): (1, 1e-4, 253, 2.68),
    ("weave, N 100", "I"): (1, 2.8e-4, 175, 2.72),
    ("weave, N 100", "I, gamma .5"): (1, 2.5e-4, 143, 2.19),
    ("weave, N 100", "nearest"): (1, 2.8e-4, 11, 1.42),
    **{(case.name, "clairvoyant"): (NAN, NAN, NAN, 1.365) for case in PAPER_CASES}}
NOISE_ELSEWHERE = [(1, 1.27), (1, 1.26), (1, 1.18), (1, 1.19), (1, 75), (1, 69), (1, 6.6), (1, 13),
                   (0, 614), (0, 486), (0.994, 34), (0.996, 21)]  # inside, rms m
LOST_ELSEWHERE = [  # by the default, by the paper's method
    (0, 0.75), (0, 0.99), (0, 1), (0.006, 1), (0.014, 1), (0.12, 1), (0, 0.43), (NAN, NAN),
    (0, 0.84), (0.63, 1), (0.112, NAN), (0, 0.996), (0.99, 1), (0.002, NAN), (0.13, 1),
    (0.62, 0.98), (0, 0.99), (0.002, 1), (0, 0.99), (0, 1), (0.77, 1), (0.006, 1), (NAN, NAN),
    (NAN, NAN), (NAN, NAN)]
PD_LOST_ELSEWHERE = [0, 0, 0, 0.005, 0.005]

# ---- the runs ----


def run_chunk(job):
    """Outcomes of each method, and errors and places for the pictures."""
    index, first, count, seed = job
    case, pictures = CASES[index], {}
    scene, outcomes = Scene(case.setting, seed, index, first, count), []
    for method in case.methods:
        trace = follow(scene, method, seed + first)
        outcomes.append(outcome_of(trace))
        if first == 0 and method.name in PICTURED.get(index, ()):
            pictures[method.name] = (trace.off[:FIRST_RUNS].astype("f4"), trace.used_m[0],
                                     scene.radius_m[0])
    return outcomes, pictures


def run_all(report):
    """For each case its methods' summaries, and {case: pictures}."""
    runs, seed = report.options.runs, report.options.seed
    jobs = [(index, first, min(CHUNK, runs - first), seed)
            for index in range(len(CASES)) for first in range(0, runs, CHUNK)]
    done = report.map(run_chunk, jobs)
    summaries, pictures = [], {}
    for index, case in enumerate(CASES):
        chunks = [result for job, result in zip(jobs, done) if job[0] == index]
        pictures[index] = chunks[0][1]
        outcomes = [{key: np.concatenate([chunk[0][i][key] for chunk in chunks])
                     for key in chunks[0][0][i]} for i in range(len(case.methods))]
        imm = outcomes[case.methods.index(IMM)] if IMM in case.methods else None
        summaries.append([summary_of(outcome, imm) for outcome in outcomes])
    return summaries, pictures


# ---- tables ----


def told(value, digits, elsewhere=NAN, factor=1.0):
    """measured/elsewhere"""
    text = "-" if math.isnan(value) else f"{factor * value:.{digits}f}"
    return text if math.isnan(elsewhere) else f"{text}/{factor * elsewhere:.{digits}f}"


def paper_row(first, method, summary, elsewhere):
    value = {name: figure for name, (figure, _) in summary.items()}
    return [first, method.name, told(value["inside"], 1, elsewhere[0], 100),
            told(value["wrong"], 3, elsewhere[1], 100),
            told(value["most_off_m"], 0, elsewhere[2]), told(value["rms_m"], 2, elsewhere[3]),
            told(value["rms_mps"], 2), f"{value['least_mps']:.0f}..{value['most_mps']:.0f}"]


PAPER_HEADINGS = ["method", "inside %", "wrong %", "most m", "rms m", "rms m/s", "extreme m/s"]


def tell_paper(report, summaries):
    report.heading("Clutter around the truth, 10 g, places and velocities, Q = R = I")
    report.text(
        "Pop-up or weave. N clutter plots lie uniformly within half the beam's width, "
        "R sin(0.6 degrees), of the target, 639 to 314 m, with the velocities that would have "
        "brought them from where it was; the first three scans are clean. Measured/reference.")
    report.text(
        "Method I: Hough gate and input estimation as printed; with gamma .5 the estimated input "
        "is forgotten by half a scan. II: no input estimation. III: a plot at random. Nearest: the "
        "nearest plot, gamma .5. Clairvoyant: knows the target's plots and its input, double "
        "precision. Default: believes in physical motion, so that the paper's noise of 1 m and 1 "
        "m/s a scan in a target's path is a surprise to it. Inside: share of the runs with every "
        "axis within the beam's radius. Wrong: share of scans in which clutter was taken. Most: of "
        "all runs. Rms: 3-D, of all runs, after 2 s. Extreme: medians of the runs' extreme "
        "velocity errors.")
    report.table(["clutter", *PAPER_HEADINGS], [
        paper_row(case.name if i == 0 else "", method, summary,
                  ELSEWHERE.get((case.name, method.name), [NAN] * 4))
        for case, row in zip(PAPER_CASES, summaries)
        for i, (method, summary) in enumerate(zip(case.methods, row))])


def tell_noise(report, summaries):
    report.heading("The same, pop-up, 4 clutter plots, true process noise 1e-4 I")
    report.text(
        "With the paper's Q = R = I Method II passes: velocities are measured, and the gain is "
        "0.6. Only filters that believe in a Q about as small as the true one lose the target "
        "without input estimation, and with it, unless it forgets.")
    each = len(NOISE_CASE.methods) // len(NOISES)
    report.table(["filter's Q", *PAPER_HEADINGS], [
        paper_row(f"{NOISES[i // each]:g} I" if i % each == 0 else "", method, summary,
                  (inside, NAN, NAN, rms_m))
        for i, (method, summary, (inside, rms_m)) in enumerate(
            zip(NOISE_CASE.methods, summaries, NOISE_ELSEWHERE))])


def tell_read(report, weave, summaries):
    report.heading("The paper's contrast in the weave, and what its text leaves open")
    report.text(
        "Scenario 2 with a true process noise of 1e-4 I: as in the pop-up. Then the paper's pop-up "
        "with Q = R = I and 4 clutter plots within the whole width of the beam, as (33) is "
        "printed; from x 5 km, y 53 km, -6 and -5 m/s, as the digits are printed (here they are "
        "read backwards: 50 and 35 km, -600 and -500 m/s); and with what Methods II and III may "
        "be, as the page that says it is lost.")
    each = len(WEAVE_CASE.methods) // len(NOISES)
    report.table(["filter's Q, case", *PAPER_HEADINGS], [
        *(paper_row(f"{NOISES[i // each]:g} I" if i % each == 0 else "", method, summary, [NAN] * 4)
          for i, (method, summary) in enumerate(zip(WEAVE_CASE.methods, weave))),
        *(paper_row(case.name if i == 0 else "", method, summary, [NAN] * 4)
          for case, row in zip(READ_CASES, summaries)
          for i, (method, summary) in enumerate(zip(case.methods, row)))])


def tell_closed(report, summaries):
    report.heading("The beam follows the prediction: % lost")
    report.text(
        "Places of 10 m, or as said, and no velocities but where it says so; weave, or as said; "
        "missed detections. A target outside the beam is not seen; a run is lost when the error "
        "exceeds the beam's radius. Paper: Method I with an input that moves places too, and "
        "velocities of plots from their distance to the last estimate. Nearest: the same with the "
        "nearest plot. IMM and clairvoyant: double precision, know the plots. Hypotheses: the "
        "default's, mean. Polar: 15 m, 3 mrad, from 61 km on; a radar that looks all round.")
    name, lost, errors = "g, sigma m, clutter, P_D", [], []
    for case, row, (by_default, by_paper) in zip(CLOSED_CASES, summaries, LOST_ELSEWHERE):
        share = {method.name: summary["lost"][0] for method, summary in zip(case.methods, row)}
        default, imm, best = ({key: one[0] for key, one in summary.items()} for summary in row[:3])
        lost.append([
            case.name, told(share["default"], 1, by_default, 100),
            *[told(share[name], 1, factor=100) for name in ("IMM, true plots", "clairvoyant")],
            told(share.get("paper", NAN), 1, by_paper, 100),
            told(share.get("nearest", NAN), 1, factor=100), told(default["hypotheses"], 1)])
        errors.append([
            case.name, *[told(default[f"kept_{name}"], 2) for name in ("rms_m", "rms_mps")],
            *[told(default[f"{name}_over_imm"], 3) for name in ("rms_m", "rms_mps")],
            *[told(best[f"kept_{name}"], 2) for name in ("rms_m", "rms_mps")],
            *[told(one["nis_per_dimension"], 3) for one in (default, imm)]])
    report.table([name, "default", "IMM, true plots", "clairvoyant", "paper", "nearest",
                  "hypotheses"], lost)
    report.heading("The same, errors of the kept tracks")
    report.text("After 2 s: of the default, over those of the IMM in the same runs, and of the "
                "clairvoyant. NIS: of the target's plot, 1 a dimension where the covariance is "
                "right.")
    report.table([name, "default rms m", "m/s", "over the IMM", "m/s", "clairvoyant rms m", "m/s",
                  "NIS a dimension", "the IMM's"], errors)


def tell_pd(report, summaries):
    report.heading("The default with 10 g, 10 m, 10 clutter plots, P_D .9, told another P_D")
    report.table(["assumed P_D", "lost %", "rms m", "rms m/s", "NIS a dimension"], [
        [method.name, told(summary["lost"][0], 1, elsewhere, 100),
         told(summary["kept_rms_m"][0], 2), told(summary["kept_rms_mps"][0], 2),
         told(summary["nis_per_dimension"][0], 3)]
        for method, summary, elsewhere in zip(PD_CASE.methods, summaries, PD_LOST_ELSEWHERE)])


# ---- what must hold ----


def judge_paper(report, case, row):
    """Of four clutter plots, as in the paper."""
    printed, forgets, random = row[0], row[1], row[3]

    def at_most(name, bar, summary, *keys):
        value, error = max((abs(summary[key][0]), summary[key][1]) for key in keys)
        report.at_most(name, value, bar, error)

    runs, name = report.options.runs, f"Method I, {case.name}"
    report.at_least(f"{name}: inside the beam, first {FIRST_RUNS} runs", printed["first_inside"][0],
                    1.0, trials=min(runs, FIRST_RUNS))
    report.at_least(f"{name}: inside the beam", printed["inside"][0], 0.995, trials=runs)
    at_most(f"{name}: rms error, m", 2.2, printed, "rms_m")
    report.at_most(f"{name}: wrong picks", printed["wrong"][0], 0.0002,
                   trials=runs * (SCANS - CLEAN_SCANS))
    extreme = "median extreme velocity error, m/s"
    at_most(f"{name}: {extreme}", 25, printed, "least_mps", "most_mps")
    name = f"Method I with gamma .5, {case.name}"
    at_most(f"{name}: rms error, m", 1.6, forgets, "rms_m")
    at_most(f"{name}: {extreme}", 10, forgets, "least_mps", "most_mps")
    report.at_most(f"Method III, {case.name}: inside the beam", random["inside"][0], 0.4,
                   trials=runs)


def judge_default(report, case, summary):
    name = f"default, {case.name}"
    if not math.isnan(case.lost_max):
        report.at_most(f"{name}: lost", summary["lost"][0], case.lost_max,
                       trials=report.options.runs)
    if not math.isnan(case.ratio_max):
        value, error = summary["rms_m_over_imm"]
        report.at_most(f"{name}: rms error over that of the IMM with true plots", value,
                       case.ratio_max, error)
    if case.has_nis:
        value, error = summary["nis_per_dimension"]
        report.at_least(f"{name}: NIS a dimension", value, 0.8, error)
        report.at_most(f"{name}: NIS a dimension", value, 1.05, error)


# ---- pictures: the paper's Figs. 2 to 15, and the default beside them ----

AXES = ("x, downrange", "y, offrange", "z, altitude")
COLOURS = ("#0072b2", "#d55e00", "#009e73")


def draw_errors(report, name, pictures, caption):
    import matplotlib.pyplot as plt
    time_s = np.arange(SCANS) * INTERVAL_S
    figure, grid = plt.subplots(2, len(pictures), figsize=(4 * len(pictures), 6), sharex=True,
                                squeeze=False)
    for column, (method, (off, _, radius)) in enumerate(pictures.items()):
        for row, unit in enumerate(("position (m)", "velocity (m/s)")):
            axes, part = grid[row, column], off[..., 3 * row:3 * row + 3]
            axes.fill_between(time_s, part.min((0, 2)), part.max((0, 2)), color="#d9d9d9",
                              label=f"all of {len(off)} runs")
            for i in range(3):
                axes.plot(time_s, part[0, :, i], color=COLOURS[i], lw=1, label=AXES[i])
            if row == 0:
                axes.plot(time_s, np.outer(radius, (1, -1)), "k--", lw=1, label=["beam", None])
                axes.set_title("default" if method == "default" else f"Method {method}")
            if column == 0:
                axes.set_ylabel(f"errors in {unit}")
            if row == 1:
                axes.set_xlabel("time (s)")
    figure.legend(*grid[0, 0].get_legend_handles_labels(), ncols=5, loc="lower center",
                  bbox_to_anchor=(0.5, -0.04))
    figure.tight_layout()
    report.figure(name, figure, caption)


def draw_taken(report, pictures):
    import matplotlib.pyplot as plt
    figure, grid = plt.subplots(1, 2, figsize=(10, 4), sharey=True)
    for axes, method in zip(grid, ("I", "III")):
        for i in range(3):
            axes.plot(np.arange(SCANS) * INTERVAL_S, pictures[method][1][:, i] / 1e3,
                      color=COLOURS[i], lw=1, label=AXES[i])
        axes.set(title=f"Method {method}", xlabel="time (s)")
    grid[0].set_ylabel("position of the plot taken (km)")
    grid[0].legend()
    report.figure("taken", figure, "Figs. 2 and 3: positions that Methods I and III take, pop-up.")


def draw(report, pictures):
    report.heading("The paper's figures")
    report.text(f"Four clutter plots. Coloured: run 0; grey: what the errors of up to {FIRST_RUNS} "
                "runs lie between, all axes.")
    draw_taken(report, pictures[0])
    draw_errors(report, "pop-up", pictures[0],
                "Figs. 4 to 9: errors of Methods I to III and of the default, pop-up.")
    draw_errors(report, "weave", pictures[4],
                "Figs. 10 to 15: the same, weave (the paper's scenario 2).")
    draw_errors(report, "narrow", pictures[len(PAPER_CASES)],
                "The paper's contrast: Method II, and Method I with gamma .5, pop-up, with "
                "Q = 1e-4 I.")
    draw_errors(report, "narrow-weave", pictures[CASES.index(WEAVE_CASE)],
                "The same, weave.")


def facts_of(cases, summaries):
    return [{"case": case.name, **case.setting.__dict__, "methods": [
        {"method": method.name, "gamma": method.gamma, "filter_noise": method.noise,
         **{name: None if math.isnan(value) else value for name, (value, _) in summary.items()}}
        for method, summary in zip(case.methods, row)]} for case, row in zip(cases, summaries)]


def main():
    options = experiment.options_of(__doc__, runs=500)
    report = experiment.Report("Targets that manoeuvre in clutter", options)
    summaries, pictures = run_all(report)
    paper, closed_from = len(PAPER_CASES), len(PAPER_CASES) + 1
    pd_at = closed_from + len(CLOSED_CASES)
    tell_paper(report, summaries[:paper])
    tell_noise(report, summaries[paper])
    tell_read(report, summaries[pd_at + 1], summaries[pd_at + 2:])
    tell_closed(report, summaries[closed_from:pd_at])
    tell_pd(report, summaries[pd_at])
    for name, part in (("paper", slice(paper)), ("process_noise", slice(paper, closed_from)),
                       ("closed_loop", slice(closed_from, pd_at)),
                       ("assumed_pd", slice(pd_at, pd_at + 1)),
                       ("as_read", slice(pd_at + 1, None))):
        report.fact(name, facts_of(CASES[part], summaries[part]))
    for case, row in zip(PAPER_CASES, summaries):
        if case.setting.clutter == 4:
            judge_paper(report, case, row)
    for case, row in zip(CLOSED_CASES, summaries[closed_from:]):
        judge_default(report, case, row[0])
    draw(report, pictures)
    report.close()


if __name__ == "__main__":
    main()
