#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The experiments of Fan et al., "Neutrosophic Hough Transform-Based Track Initiation Method for
Multiple Target Tracking", section V, with its methods and the default.

Table 1's three targets and Table 3's real plots, 7 scans, P_D 0.99; cells of 5 m and 1 mrad, eps 20
m and 4 mrad, 100 to 400 m/s, P_F 0.01, tau 0.5 (the paper gives none), rho signed. Where NHT's
votes go, the paper leaves open: reading A, to the pair's own cell; reading C, to all cells within 2
eps. The default is told 10 m (real data: 60 m) throughout, and takes five plots of seven.

Detected: a peak is within 40 m and 8 mrad of the line through the target's true positions. Met: a
peak's line is within 30 m (real data: 100 m) of them in the mean. Other peaks are false; at most
4096 peaks are counted. Discrimination: the highest cell near a target's line over the highest false
peak, or over tau of the highest cell, below which nothing is listed. Top 3: share of the targets
that one of the three highest peaks detects. rho, theta: mean absolute errors of peaks that detect.
Decline: what the targets' highest cells lack of their height without noise, clutter and misses.
"""
import time
from typing import NamedTuple

import numpy as np

from common import experiment
from common import paper_aircraft as paper
from parts import papers_initiation_values as known
from parts import papers_initiation_pictures as pictures
from parts import papers_initiation_filtered as tracks
import rhotrack

RUNS = 200
METHODS = {"HT": ("ht", {}), "MHT": ("mht", {}), "IHT": ("iht", {}),
           "NHT A": ("nht", {"nht_reading": "a"}), "NHT C": ("nht", {"nht_reading": "c"}),
           "default": ("kernel", {})}
COLOURS = {method: f"C{i}" for i, method in enumerate(METHODS)}
SWEPT_FIGURES = ("detected", "met", "false peaks", "discrimination", "top 3")
SWEPT = ["IHT", "NHT A", "NHT C", "default"]
RHO_CELL_M, THETA_CELL_RAD, TAU = 5.0, 0.001, 0.5
WINDOW_RHO_M, WINDOW_THETA_RAD, PEAKS_MAX, TOP = 40.0, 0.008, 4096, 3
NEAR_CELLS = 8  # the window's
NOISES_M = [0.0, 0.3, 0.6, 1.0, 2.0, 5.0, 10.0]
DENSITIES = [0.1, 1.0, 3.0, 10.0, 30.0]  # clutter plots a square kilometre
DENSEST_RUNS_MIN = 50  # from so many runs on, the last of them is timed, too


class Situation(NamedTuple):
    name: str
    figure: str  # of the paper
    text: str
    noise_m: float = 0.0
    per_km2: float = 0.0
    per_scan: float = 0.0
    is_real: bool = False
    pd: float = 0.99
    process_mps: float = 0.0  # of w in equation (33)
    flown_m: np.ndarray | None = None  # paths of a run with process noise

    @property
    def paths_m(self):
        if self.flown_m is not None:
            return self.flown_m
        return paper.TABLE_3 if self.is_real else paper.straight(paper.TABLE_1)

    @property
    def box_m(self):
        return paper.TABLE_3_BOX_M if self.is_real else paper.TABLE_1_BOX_M

    @property
    def interval_s(self):
        return paper.TABLE_3_INTERVAL_S if self.is_real else paper.TABLE_1_INTERVAL_S


SITUATIONS = [
    Situation("I", "Fig. 7", "Situation I: no noise, no clutter"),
    Situation("II", "Fig. 8", "Situation II: 10 m of noise, no clutter", 10),
    Situation("III", "Fig. 9", "Situation III: no noise, 10 clutter plots a square kilometre and "
              "scan", 0, 10),
    Situation("IV", "Fig. 10", "Situation IV: 10 m of noise, 10 clutter plots a square kilometre "
              "and scan", 10, 10),
    Situation("IV thin", "", "Situation IV with 10 clutter plots a scan", 10, 0, 10),
    Situation("real 10", "Fig. 15", "Real data with 10 clutter plots a scan", 0, 0, 10, True),
    Situation("real 100", "Fig. 15", "Real data with 100 clutter plots a scan", 0, 0, 100, True),
]
I, II, III, IV, THIN, REAL, REAL_DENSE = SITUATIONS


# ---- one run of one method ----


def initiator_of(method, situation):
    name, more = METHODS[method]
    sigma_m = paper.TABLE_3_SIGMA_M if situation.is_real else paper.TABLE_1_SIGMA_M
    return rhotrack.Initiator(
        method=name, v_min_mps=paper.V_MIN_MPS, v_max_mps=paper.V_MAX_MPS, d_rho_m=RHO_CELL_M,
        d_theta_rad=THETA_CELL_RAD, tau=TAU, sigma_m=sigma_m, pd=min(situation.pd, 0.99),
        min_scans=5, score_min_nat=-3, **paper.area_settings(situation.box_m), **more)


def plots_of(situation, rng):
    mean = situation.per_scan + 1e-6 * situation.per_km2 * paper.area_m2(situation.box_m)
    return paper.observed(situation.paths_m, situation.noise_m, situation.pd,
                          [(situation.box_m, mean)], rng)


def fly_situation(situation, rng):
    """The situation as it was flown, with process noise if it has any, and its plots."""
    if situation.process_mps:
        situation = situation._replace(flown_m=paper.wandering(paper.TABLE_1, situation.process_mps,
                                                               rng))
    return situation, plots_of(situation, rng)


def true_lines(paths_m):
    """(rho, theta) of total least squares through each target's true positions. None is near the
    end of theta, where rho changes its sign."""
    middle = paths_m.mean(axis=0)
    normal = np.linalg.svd((paths_m - middle).transpose(1, 0, 2))[2][:, 1]
    normal *= np.where(normal[:, 1:] < 0, -1, 1)  # theta in [0, pi)
    return np.sum(middle * normal, axis=1), np.arctan2(normal[:, 1], normal[:, 0])


def highest_votes_near(method, situation, plots):
    """The most votes of a cell within 40 m and 8 mrad of each target's line."""
    rho_m, theta_rad = true_lines(situation.paths_m)
    row, column = (theta_rad / THETA_CELL_RAD).astype(int), np.floor(rho_m / RHO_CELL_M).astype(int)
    rows = row[:, None] + np.arange(-NEAR_CELLS, NEAR_CELLS + 1)
    if method == "HT":  # every plot votes in every row
        angles = (rows + 0.5) * THETA_CELL_RAD
        places = np.concatenate([places for places, _ in plots])
        normals = np.stack([np.cos(angles), np.sin(angles)], axis=2)
        cells = np.floor(normals @ places.T / RHO_CELL_M) - column[:, None, None] + NEAR_CELLS
        return [max(np.bincount(of[(of >= 0) & (of <= 2 * NEAR_CELLS)].astype(int)).max(initial=0)
                    for of in target) for target in cells]
    # Lines that matter to these cells: NEAR_CELLS away, a reach farther pairs that vote there, and
    # another one their kernels; and a cell for what is cut off. Plots without such a line are left
    # out, so that the search is short.
    reach = 3 * NEAR_CELLS + 2
    chosen = [(places[np.any(
        np.abs(places @ [np.cos(theta_rad), np.sin(theta_rad)] - rho_m)
        <= reach * RHO_CELL_M + np.linalg.norm(places, axis=1, keepdims=True)
        * np.tan(reach * THETA_CELL_RAD), axis=1)], None) for places, _ in plots]
    initiator = initiator_of(method, situation)
    plane = initiator.accumulator(paper.scans_of(chosen, situation.interval_s, initiator.settings))
    columns = column + plane.votes.shape[1] // 2
    return [plane.votes[of[0]:of[-1] + 1, max(at - NEAR_CELLS, 0):at + NEAR_CELLS + 1].max(
        initial=0) for of, at in zip(rows, columns)]


class Judged(NamedTuple):
    """Of the peaks (rho_m, theta_rad), best first."""
    detected: np.ndarray  # by target
    met: np.ndarray
    top3: np.ndarray
    rho_m: np.ndarray  # absolute error of the best peak that detects; NaN: none does
    theta_mrad: np.ndarray
    is_false: np.ndarray  # by peak


def judge_peaks(situation, peaks):
    peaks = peaks[:PEAKS_MAX]
    rho_m, theta_rad = true_lines(situation.paths_m)
    off_rho_m = np.abs(peaks["rho_m"][:, None] - rho_m)
    off_theta_rad = np.abs(peaks["theta_rad"][:, None] - theta_rad)
    detects = (off_rho_m <= WINDOW_RHO_M) & (off_theta_rad <= WINDOW_THETA_RAD)
    normals = np.stack([np.cos(peaks["theta_rad"]), np.sin(peaks["theta_rad"])])
    distance_m = np.abs(situation.paths_m @ normals - peaks["rho_m"]).mean(axis=0).T
    meets = distance_m <= (100 if situation.is_real else 30)
    detected = detects.any(axis=0)
    if not len(peaks):
        return Judged(detected, detected, detected, *np.full((2, len(rho_m)), np.nan), detected[:0])
    best, target = detects.argmax(axis=0), np.arange(len(rho_m))
    return Judged(detected, meets.any(axis=0), detected & (best < TOP),
                  np.where(detected, off_rho_m[best, target], np.nan),
                  np.where(detected, 1e3 * off_theta_rad[best, target], np.nan),
                  ~(detects | meets).any(axis=1))


def run_method(method, situation, plots, ideal_votes):
    """The figures of one method; lists for those of each target that was detected."""
    initiator = initiator_of(method, situation)
    scans = paper.scans_of(plots, situation.interval_s, initiator.settings)
    peaks = (initiator.find if method == "default" else initiator.lines)(scans)
    of = judge_peaks(situation, peaks)
    figures = {"detected": of.detected.mean(), "met": of.met.mean(),
               "false peaks": of.is_false.sum(), "top 3": of.top3.mean(),
               "error of rho": of.rho_m, "error of theta": of.theta_mrad,
               "ms": initiator.work["search_us"] / 1e3}
    if method != "default":
        height = np.mean(highest_votes_near(method, situation, plots))
        false_votes = peaks["votes"][:len(of.is_false)][of.is_false]
        listed = TAU * initiator.work["votes_max"] / 65536
        most = max(false_votes.max(initial=0), listed)
        figures |= {"discrimination": height / most if most else 0.0,
                    "votes": initiator.work["votes"], "height": height,
                    "decline": 1 - height / ideal_votes.get(method, np.nan)}
    return figures


def run(job):
    situation, methods, ideal_votes, *seed = job
    situation, plots = fly_situation(situation, np.random.default_rng(seed))
    return {method: run_method(method, situation, plots, ideal_votes) for method in methods}


def summarised(results, methods):
    """{method: {figure: (mean, standard error)}}; of ms the median."""
    return {method: {
        name: experiment.mean_of(
            np.concatenate([np.atleast_1d(one[method][name]) for one in results]))
        if name != "ms" else (float(np.median([one[method]["ms"] for one in results])), np.nan)
        for name in results[0][method]} for method in methods}


def measure_methods(report, situations, methods, ideal_votes, runs, stream):
    jobs = [(situation, methods, ideal_votes, report.options.seed, stream + i, index)
            for i, situation in enumerate(situations) for index in range(runs)]
    results = report.map(run, jobs)
    return [summarised(results[i * runs:(i + 1) * runs], methods) for i in range(len(situations))]


# ---- run times, one search at a time ----


def whole_plane(places, rho_max_m):
    """HT's votes of a plane that is wholly there: rows of theta, cells of rho."""
    rows, columns = int(np.ceil(np.pi / THETA_CELL_RAD)), 2 * int(np.ceil(rho_max_m / RHO_CELL_M))
    votes = np.empty((rows, columns), "u2")
    theta_rad = (np.arange(rows) + 0.5) * THETA_CELL_RAD
    normals = np.stack([np.cos(theta_rad), np.sin(theta_rad)], axis=1) / RHO_CELL_M
    cells = normals.astype("f4") @ places.T.astype("f4") + np.float32(columns // 2)
    for row, of in zip(votes, cells.astype(np.intp)):  # cells are positive: cut off is rounded down
        row[:] = np.bincount(of, minlength=columns)
    return votes


def search_whole_plane(places, rho_max_m):
    """The cells above the threshold, of which peaks are then chosen."""
    votes = whole_plane(places, rho_max_m)
    return np.flatnonzero(votes >= max(np.ceil(TAU * votes.max()), 1))


def time_methods(situation, methods, runs, *seed):
    """{method: (median ms, mean votes)}, and of HT on a whole plane."""
    results, whole_ms = [], []
    for index in range(runs):
        plots = plots_of(situation, np.random.default_rng([*seed, index]))
        places = np.concatenate([places for places, _ in plots])
        start_s = time.thread_time()
        search_whole_plane(places, 5000.0)
        whole_ms.append(1e3 * (time.thread_time() - start_s))
        results.append({})
        for method in methods:
            initiator = initiator_of(method, situation)
            scans = paper.scans_of(plots, situation.interval_s, initiator.settings)
            (initiator.find if method == "default" else initiator.lines)(scans)
            results[-1][method] = (initiator.work["search_us"] / 1e3,
                                   initiator.work.get("votes", np.nan))
    return {"whole plane": (float(np.median(whole_ms)), np.nan)} | {
        method: (float(np.median([one[method][0] for one in results])),
                 float(np.mean([one[method][1] for one in results]))) for method in methods}


# ---- tables ----


def text_of(figure, value):
    if np.isnan(value):
        return "-"
    if figure == "votes":
        return (f"{value / 1e6:.2f}M" if value >= 1e6 else f"{value / 1e3:.1f}k" if value >= 1e3
                else f"{value:.0f}")
    digits = {"false peaks": 1 if value < 9.95 else 0, "error of rho": 2 if value < 0.995 else 1,
              "error of theta": 2 if value < 0.995 else 1}.get(figure, 2)
    return f"{value:.{digits}f}".replace("0.", ".", 1) if abs(value) < 1 else f"{value:.{digits}f}"


def situations_table(report, summaries):
    figures = ["detected", "met", "false peaks", "discrimination", "top 3", "error of rho",
               "error of theta", "votes"]
    rows = []
    for situation, of in zip(SITUATIONS, summaries):
        for method, summary in of.items():
            cells = [text_of(figure, summary.get(figure, (np.nan, 0))[0]) for figure in figures]
            texts = [known.text_of(situation.name, method, figure).replace("..", "-", 1)
                     for figure in figures]
            rows.append([situation.name, method, *(f"{cell}/{text}" if text else cell
                                                   for cell, text in zip(cells, texts)),
                         f"{summary['ms'][0]:.3g}"])
    report.table(["case", "method", "detected", "met", "false", "discrim.", "top 3", "rho m",
                  "theta mrad", "votes", "ms"], rows)


def words_table(report, summaries):
    rows = []
    for situation, of in zip(SITUATIONS[:4], summaries):
        for method in (method for method in of if method != "default"):
            cell = {figure: text_of(figure, of[method][figure][0]) for figure in of[method]}
            words = known.words(situation.name, method)
            is_high = of[method]["discrimination"][0] > 1
            rows.append([situation.name, method, cell["discrimination"], words[0],
                         "yes" if is_high == (words[0] == "high") else "no", cell["error of rho"],
                         cell["error of theta"], words[1], cell["decline"], words[2]])
    report.table(["case", "method", "discrimination", "paper", "holds", "divergence m", "mrad",
                  "paper", "decline", "paper"], rows)


def sweep_table(report, sweep):
    report.table(["noise m", "method", "detected", "met", "false", "discrim.", "top 3"], [
        [f"{noise_m:g}", method, *(text_of(figure, summary.get(figure, (np.nan, 0))[0])
                                   for figure in SWEPT_FIGURES)]
        for noise_m, of in zip(NOISES_M, sweep) for method, summary in of.items()])


def times_table(report, times, methods):
    def ratio(of, method):
        return f"{of[method][0] / of['whole plane'][0]:.3f}" if method in of else "-"

    report.table(["clutter/km^2", "whole plane ms", *(f"{method} ms" for method in methods),
                  "NHT C / whole plane", "HT / whole plane"], [
        [f"{per_km2:g}", *(f"{of[method][0]:.3g}" for method in ["whole plane", *methods]),
         ratio(of, "NHT C"), ratio(of, "HT")] for per_km2, of in zip(DENSITIES, times)])


# ---- what must hold ----


def agreement_bars(report, summaries):
    """Each figure against that of an independent implementation."""
    off = []
    for situation, of in zip(SITUATIONS, summaries):
        for method, summary in of.items():
            ratios = []
            for figure, (value, error) in summary.items():
                expected = known.expected(situation.name, method, figure)
                if expected is None or np.isnan(value):
                    continue
                tolerance = known.tolerance(figure, value, error, report.options.runs, expected)
                ratios.append(abs(value - expected[0]) / tolerance)
                if ratios[-1] > 1 + 1e-9:
                    off.append([f"{situation.name} {method}: {figure}", f"{value:.4g}",
                                f"{expected[0]:.4g}", f"{tolerance:.2g}"])
            if ratios:
                report.at_most(f"{situation.name} {method}: a figure's distance from the reference "
                               f"over its tolerance, the largest of {len(ratios)}", max(ratios), 1)
    if off:
        report.heading("Figures that do not agree with the reference")
        report.table(["figure", "measured", "must be", "+-"], off)


def judge_bars(report, summaries, sweep, times, alone_votes):
    agreement_bars(report, summaries)
    of_iv = summaries[SITUATIONS.index(IV)]
    for method, votes in known.WORK_IV.items():
        if method in of_iv:
            value, error = of_iv[method]["votes"]
            report.at_most(f"work, IV {method}: votes within 3 % and the error of the mean",
                           abs(value / votes - 1), 0.03 + 4 * np.nan_to_num(error) / votes)
    if "NHT C" in of_iv:
        at_iv = times[DENSITIES.index(IV.per_km2)]
        report.at_most("work, IV NHT C: time over that of HT on a whole plane",
                       at_iv["NHT C"][0] / at_iv["whole plane"][0], 0.5)
    for noise_m, of in zip(NOISES_M, sweep):
        what = f"IV at {noise_m:g} m, NHT C"
        if "NHT C" in of and noise_m <= 0.6:
            report.at_least(f"{what}: detected", of["NHT C"]["detected"][0], 0.8,
                            of["NHT C"]["detected"][1])
        if "NHT C" in of and "IHT" in of and 0 < noise_m <= 0.6:
            (value, error), iht = of["NHT C"]["false peaks"], of["IHT"]["false peaks"][0]
            report.at_most(f"{what}: false over IHT's", value / iht, 0.5, error / iht)
        if "NHT C" in of and noise_m >= 10:
            report.at_most(f"{what}: detected", of["NHT C"]["detected"][0], 0.3,
                           of["NHT C"]["detected"][1])
    if alone_votes is not None:
        report.at_most("Table 3 alone, NHT A: votes", alone_votes, 1)
        report.at_least("Table 3 alone, NHT A: votes", alone_votes, 1)
    for situation, of in zip(SITUATIONS, summaries):
        if "default" in of:
            (met, met_error), (false, error) = (of["default"][figure]
                                                for figure in ("met", "false peaks"))
            report.at_least(f"{situation.name} default: met", met, 0.95, met_error)
            report.at_most(f"{situation.name} default: false peaks", false, 0.1, error)


# ---- the whole ----


def planes(situation, methods, *seed):
    """{method: votes of every cell}, of one run."""
    plots = plots_of(situation, np.random.default_rng(seed))
    of = {}
    for method in methods:
        initiator = initiator_of(method, situation)
        scans = paper.scans_of(plots, situation.interval_s, initiator.settings)
        of[method] = initiator.accumulator(scans).votes
    return of


def votes_of_table_3(seed):
    """Reading A on Table 3 as printed: no clutter, nothing missed."""
    alone = REAL._replace(per_scan=0.0, pd=1.0)
    initiator = initiator_of("NHT A", alone)
    plots = plots_of(alone, np.random.default_rng(seed))
    initiator.lines(paper.scans_of(plots, alone.interval_s, initiator.settings))
    return initiator.work["votes"]


def heights_without_chance(methods):
    """In Situation I with nothing missed, in the mean over the targets."""
    ideal = I._replace(pd=1.0)
    plots = plots_of(ideal, np.random.default_rng(1))
    return {method: float(np.mean(highest_votes_near(method, ideal, plots)))
            for method in methods if method != "default"}


def tell_claims(report, methods, ideal_votes):
    """What the paper claims or shows besides."""
    process = [situation._replace(name=f"{situation.name} w", process_mps=paper.PROCESS_MPS)
               for situation in SITUATIONS[:4]]
    summaries = measure_methods(report, process, methods, ideal_votes,
                                max(report.options.runs // 2, min(report.options.runs, 2)), 5000)
    report.heading("The Situations with process noise, equation (33)")
    report.text("The state takes w, 10 m/s in each axis, at every scan, and the place T/2 w: paths "
                "leave the straight line. The true line is the best one through the true places.")
    report.table(["case", "method", "detected", "met", "false", "discrim.", "top 3"], [
        [situation.name, method, *(text_of(figure, summary.get(figure, (np.nan, 0))[0])
                                   for figure in SWEPT_FIGURES)]
        for situation, of in zip(process, summaries) for method, summary in of.items()])
    report.fact("process_noise", facts_of([of.name for of in process], "case", summaries))
    report.fact("initialised", tracks.tell(report, initiator_of, plots_of, {
        "simulated": IV, "simulated, 0.5 m": IV._replace(noise_m=0.5), "real": REAL_DENSE}))


def facts_of(keys, name, summaries):
    return [{name: key, "method": method,
             **{figure: None if np.isnan(value) else value
                for figure, (value, _) in summary.items()}}
            for key, of in zip(keys, summaries) for method, summary in of.items()]


def add_options(parser):
    parser.add_argument("--method", choices=sorted({name for name, _ in METHODS.values()}),
                        help="one alone; the default is kernel")


def main():
    options = experiment.options_of(__doc__, RUNS, add_options)
    methods = [method for method, (name, _) in METHODS.items() if options.method in (None, name)]
    papers = [method for method in methods if method != "default"]
    report = experiment.Report("The papers' initiation: Hough transforms of plots", options)
    for paragraph in __doc__.split("\n\n")[1:]:
        report.text(" ".join(paragraph.split()))
    ideal_votes = heights_without_chance(methods)
    summaries = measure_methods(report, SITUATIONS, methods, ideal_votes, options.runs, 1000)
    swept = [method for method in SWEPT if method in methods]
    sweep = measure_methods(report, [IV._replace(noise_m=noise_m) for noise_m in NOISES_M], swept,
                            ideal_votes, max(options.runs // 4, min(options.runs, 2)), 2000)
    is_long = options.runs >= DENSEST_RUNS_MIN
    times = [time_methods(IV._replace(per_km2=per_km2), methods,
                   7 if is_long and per_km2 < DENSITIES[-1] else 3, options.seed, 3000 + i)
             for i, per_km2 in enumerate(DENSITIES[:None if is_long else -1])]
    alone_votes = votes_of_table_3(options.seed) if "NHT A" in methods else None

    report.heading("All Situations")
    report.text(f"Measured/reference. The reference is an independent implementation in double "
                f"precision on a plane that is wholly there, {known.RUNS} runs. Each figure must "
                f"agree with it within four standard errors of the difference and the rounding of "
                f"what is printed. Times are medians of processor time.")
    situations_table(report, summaries)
    if papers:
        report.heading("The paper's Table 2")
        report.text("The paper's words beside what was measured. Discrimination counts as high "
                    "above 1: targets above every false peak, in the mean. Decline is negative "
                    "where clutter adds to the height. Heights without chance, in votes: "
                    + ", ".join(f"{method} {ideal_votes[method]:.1f}" for method in papers) + ".")
        words_table(report, summaries)
        for number, situation in enumerate(SITUATIONS):
            if situation.figure:
                votes_of = planes(situation, papers, options.seed, 4000, number)
                pictures.planes(report, situation, true_lines(situation.paths_m), RHO_CELL_M,
                                votes_of)
                pictures.histograms(report, situation, RHO_CELL_M, votes_of)
    if swept:
        report.heading("Situation IV at other noises")
        report.text("Up to about 0.6 m the paper's order holds: NHT C detects most, with far fewer "
                    "false peaks than IHT (without noise IHT does as well). Beyond, two plots 400 "
                    "to 570 m apart no longer give an angle to 8 mrad: 2 eps are three standard "
                    "deviations at 0.43 to 0.62 m, and the paper's own noise is 16 to 23 times as "
                    "much.")
        sweep_table(report, sweep)
        pictures.sweep(report, NOISES_M, sweep, COLOURS)
    report.heading("Times of one search in Situation IV, one at a time, Fig. 11")
    report.text("Medians of processor time. The whole plane is numpy's: it fills a plane of 16-bit "
                "counts and lists the cells above the threshold.")
    times_table(report, times, methods)
    pictures.times(report, DENSITIES, times, COLOURS)
    if methods == list(METHODS):
        tell_claims(report, methods, ideal_votes)
        known.findings(report, dict(zip((of.name for of in SITUATIONS), summaries)),
                       dict(zip(DENSITIES, times)), alone_votes)
    judge_bars(report, summaries, sweep, times, alone_votes)
    report.fact("cases", facts_of([of.name for of in SITUATIONS], "case", summaries))
    report.fact("noise", facts_of(NOISES_M, "noise_m", sweep))
    report.fact("times", [{"per_km2": per_km2, "method": method, "ms": ms,
                           "votes": None if np.isnan(votes) else votes}
                          for per_km2, of in zip(DENSITIES, times)
                          for method, (ms, votes) in of.items()])
    report.fact("table3_nht_a_votes", alone_votes)
    report.close()


if __name__ == "__main__":
    main()
