#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Track initiation from plots in clutter: what the default finds in a batch of seven scans, in
densities, geometries, clutter alone and manoeuvres, beside a fit that is told the plots.

A target is found when a track is, in the mean over the scans, within the case's tolerance of it,
one to one. The oracle is the straight-line fit through the target's own plots, held against the
same threshold. P_D is assumed as it is, at most 0.99.
"""
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np

from common import experiment
from common import paper_aircraft as paper
import rhotrack
from common import oracle_fit

RUNS = 300  # fewer do not decide a bar of .99 of the runs
TURN_RAD = np.radians(2)  # a scan
ACCEL_MPS2 = 10.0
WANDER_MPS = 10.0  # a scan
SQUARE_M = (-2500, 2500, -2500, 2500)
SPOT_M = (2000, 3000, -700, 300)
WORK_MAX = {"seeds": 60000, "look-ups": 110000, "distances": 50000}  # a window, mean


class Case(NamedTuple):
    bar: str  # its group
    name: str
    paths: object  # rng -> places
    box_m: tuple
    per_km2: float = 0.0
    per_scan: float = 0.0
    spot_per_km2: float = 0.0  # in SPOT_M, beyond the clutter around
    pd: float = 0.99
    min_scans: int = 5
    score_min_nat: float = -3.0
    process_noise_mps2: float = 0.0
    tolerance_m: float = 30.0
    counts_all: bool = False  # found_min is of the runs in which all were found
    found_min: float = np.nan
    false_max: float = np.nan
    behind_max: float = np.nan  # found may be so far below the oracle

    @property
    def is_table_3(self):
        return self.box_m == paper.TABLE_3_BOX_M

    @property
    def sources(self):
        mean = self.per_scan + 1e-6 * self.per_km2 * paper.area_m2(self.box_m)
        return [(self.box_m, mean), (SPOT_M, 1e-6 * self.spot_per_km2 * paper.area_m2(SPOT_M))]


def table_1(_):
    return paper.straight(paper.TABLE_1)


def straight(*starts):
    return lambda _: paper.straight(starts)


def crossing(per_km2, pd, min_scans, found, wrong):
    return Case("B1", f"Table 1, {per_km2}/km^2, P_D {pd}", table_1, paper.TABLE_1_BOX_M, per_km2,
                pd=pd, min_scans=min_scans, found_min=found, false_max=wrong, behind_max=0.02)


def table_3_case(per_scan):
    return Case("B2", f"Table 3, {per_scan} clutter plots a scan", lambda _: paper.TABLE_3,
                paper.TABLE_3_BOX_M, per_scan=per_scan, pd=1.0, tolerance_m=120.0,
                counts_all=True, found_min=0.99, false_max=0.05)


def square(name, *starts, found=0.97):
    return Case("B3", name, straight(*starts), SQUARE_M, 1, counts_all=True, found_min=found,
                false_max=0.05)


def clutter_alone_case(score_min_nat, wrong):
    return Case("B4", f"clutter only, 10/km^2, score_min {score_min_nat} nat",
                lambda _: np.empty((paper.SCANS, 0, 2)), paper.TABLE_1_BOX_M, 10,
                score_min_nat=score_min_nat, false_max=wrong)


def manoeuvre(name, paths, box_m, per_km2, noise):
    return Case("-", f"{name}, {per_km2}/km^2, process noise {noise} m/s^2", paths, box_m, per_km2,
                process_noise_mps2=noise, tolerance_m=60.0)


def turn(per_km2, noise):
    return manoeuvre("turn of 2 deg a scan", lambda _: paper.turning((-1500, 250, 0, 0), TURN_RAD),
                     SQUARE_M, per_km2, noise)


def accelerate(per_km2, noise):
    return manoeuvre("10 m/s^2 along the path",
                     lambda _: paper.accelerating((-1500, 250, 0, 0), ACCEL_MPS2), SQUARE_M,
                     per_km2, noise)


def wander(per_km2, noise):
    return manoeuvre("Table 1 wandering 10 m/s a scan",
                     lambda rng: paper.wandering(paper.TABLE_1, WANDER_MPS, rng),
                     paper.TABLE_1_BOX_M, per_km2, noise)


CASES = [
    crossing(0, 1, 5, 0.995, 0.01),
    crossing(0, 0.99, 5, 0.995, 0.01),
    crossing(1, 1, 5, 0.995, 0.01),
    crossing(1, 0.99, 5, 0.995, 0.01),
    crossing(10, 0.99, 5, 0.98, 0.06),
    crossing(10, 0.9, 5, 0.82, 0.13),
    crossing(30, 0.99, 6, 0.80, 0.18),
    table_3_case(0), table_3_case(10), table_3_case(100),
    square("parallel, 20 m", (-1500, 250, 0, 0), (-1500, 250, 20, 0)),
    square("parallel, 30 m", (-1500, 250, 0, 0), (-1500, 250, 30, 0)),
    square("parallel, 50 m", (-1500, 250, 0, 0), (-1500, 250, 50, 0), found=0.92),
    square("parallel, 100 m", (-1500, 250, 0, 0), (-1500, 250, 100, 0)),
    square("crossing at 10 deg", (-1500, 250, -130, 21.9), (-1500, 250, 130, -21.9)),
    square("crossing at 90 deg", (-1500, 250, 0, 0), (0, 0, -1500, 250)),
    square("same line, opposite", (-1500, 250, 300, 0), (1500, -250, 300, 0)),
    square("same line, 300 m ahead", (-1500, 250, 300, 0), (-1200, 250, 300, 0)),
    square("same line, 500 m ahead", (-1700, 250, 300, 0), (-1200, 250, 300, 0)),
    square("same line, overtaking", (-1600, 300, 300, 0), (-1000, 180, 300, 0)),
    square("through the origin", (-1200, 173.2, -693, 100)),
    square("vertical, x = 500 m", (500, 0, -1500, 250)),
    square("vertical, x = -500 m", (-500, 0, -1500, 250)),
    square("vertical, x = 0", (0, 0, -1500, 250)),
    square("horizontal, y = -500 m", (-1500, 250, -500, 0)),
    square("mirror lines, y = +-500 m", (-1500, 250, 500, 0), (-1500, 250, -500, 0)),
    square("slow, 105 m/s", (-600, 105, 200, 0)),
    square("fast, 395 m/s", (-2300, 395, 200, 0)),
    clutter_alone_case(-3, 0.12), clutter_alone_case(0, 0.005),
    Case("-", "Table 1, 5/km^2 with a hot spot of 50/km^2", table_1, paper.TABLE_1_BOX_M, 5,
         spot_per_km2=45, found_min=0.98, false_max=0.10),
    turn(1, 0), turn(1, 2.5), turn(10, 5),
    accelerate(1, 0), accelerate(1, 10),
    wander(1, 0), wander(1, 2.5), wander(1, 5),
]
DENSE = next(i for i, case in enumerate(CASES) if case.name == "Table 1, 10/km^2, P_D 0.99")


# ---- one run ----


class Run(NamedTuple):
    targets: int
    found: int
    oracle: int  # how many it accepts
    false: int
    errors_m: list  # of the found
    search_us: float
    work: tuple  # seeds, look-ups, distances, fits


def plots_of(case, rng):
    noise_m = 0.0 if case.is_table_3 else paper.TABLE_1_SIGMA_M  # real plots have their own
    paths_m = case.paths(rng)
    return paths_m, paper.observed(paths_m, noise_m, case.pd, case.sources, rng)


def model_of(case):
    return oracle_fit.Model(
        paper.SCANS, paper.TABLE_3_INTERVAL_S if case.is_table_3 else paper.TABLE_1_INTERVAL_S,
        paper.TABLE_3_SIGMA_M if case.is_table_3 else paper.TABLE_1_SIGMA_M,
        0.9 if "clutter only" in case.name else min(case.pd, 0.99), paper.area_m2(case.box_m),
        paper.V_MIN_MPS, paper.V_MAX_MPS, case.process_noise_mps2)


def tracks_of(case, model, plots):
    initiator = rhotrack.Initiator(
        scans=paper.SCANS, min_scans=case.min_scans, v_min_mps=model.v_min_mps,
        v_max_mps=model.v_max_mps, pd=model.pd, score_min_nat=case.score_min_nat,
        process_noise_mps2=case.process_noise_mps2, sigma_m=model.sigma_m,
        **paper.area_settings(case.box_m))
    return initiator.find(paper.scans_of(plots, model.interval_s, initiator.settings)), initiator


def matched_errors(paths_m, tracks, interval_s, tolerance_m):
    """The mean errors (m) of targets and tracks that are paired one to one, the closest first."""
    since_s = interval_s * (np.arange(len(paths_m)) - (len(paths_m) - 1))
    on_track_m = np.stack([tracks["x_m"] + since_s[:, None] * tracks["vx_mps"],
                           tracks["y_m"] + since_s[:, None] * tracks["vy_mps"]], axis=2)
    off_m = np.linalg.norm(paths_m[:, :, None] - on_track_m[:, None], axis=3).mean(axis=0)
    errors_m = []
    while off_m.size and off_m.min() <= tolerance_m:
        target, track = np.unravel_index(off_m.argmin(), off_m.shape)
        errors_m.append(float(off_m[target, track]))
        off_m[target], off_m[:, track] = np.inf, np.inf
    return errors_m


def density_per_m2(case, plots, places_m):
    """Where it is uneven, as it is; else the window's mean, as the initiator estimates it."""
    if not case.spot_per_km2:
        mean = np.mean([len(places) for places, _ in plots])
        return np.full(len(places_m), max(mean, 1) / paper.area_m2(case.box_m))
    x_min, x_max, y_min, y_max = SPOT_M
    x_m, y_m = places_m.T
    is_inside = (x_m >= x_min) & (x_m <= x_max) & (y_m >= y_min) & (y_m <= y_max)
    return 1e-6 * (case.per_km2 + np.where(is_inside, case.spot_per_km2, 0))


def is_own_fit_accepted(case, model, plots, target):
    """Whether the fit through the target's own plots reaches the threshold."""
    places_m = np.concatenate([places[which == target] for places, which in plots])
    scan = np.repeat(np.arange(len(plots)), [np.sum(which == target) for _, which in plots])
    if len(scan) < case.min_scans:
        return False
    velocity, score_nat = oracle_fit.fit(model, model.interval_s * scan, places_m,
                                           density_per_m2(case, plots, places_m))
    return (score_nat >= case.score_min_nat
            and model.v_min_mps <= np.hypot(*velocity) <= model.v_max_mps)


def run(job):
    number, seed, index = job
    case, rng = CASES[number], np.random.default_rng([seed, number, index])
    model, (paths_m, plots) = model_of(case), plots_of(case, rng)
    tracks, initiator = tracks_of(case, model, plots)
    errors_m = matched_errors(paths_m, tracks, model.interval_s, case.tolerance_m)
    work = initiator.work
    return Run(paths_m.shape[1], len(errors_m),
               sum(is_own_fit_accepted(case, model, plots, i) for i in range(paths_m.shape[1])),
               len(tracks) - len(errors_m), errors_m, work["search_us"],
               (work["seeds"], work["window"]["lookups"], work["window"]["distances"],
                work["fits"]))


# ---- figures ----


def summarised(case, runs):
    """Means over the runs; NaN without targets."""
    targets = sum(run.targets for run in runs)
    share = (lambda count: count / targets) if targets else (lambda count: np.nan)
    false, false_error = experiment.mean_of([run.false for run in runs])
    errors_m = [error for run in runs for error in run.errors_m]
    return {
        "bar": case.bar, "case": case.name, "targets": targets,
        "pd": share(sum(run.found for run in runs)),
        "all_found": float(np.mean([run.found == run.targets for run in runs])) if targets
        else np.nan,
        "oracle_pd": share(sum(run.oracle for run in runs)),
        "behind": experiment.mean_of([(run.oracle - run.found) / run.targets for run in runs])
        if targets else (np.nan, np.nan),
        "false_per_run": false, "false_error": false_error,
        "error_m": float(np.mean(errors_m)) if errors_m else np.nan,
        "time_us": float(np.median([run.search_us for run in runs]))}


def number_text(value, digits=3):
    return "" if np.isnan(value) else f"{value:.{digits}f}"


def table(report, rows):
    report.table(["case", "bar", "Pd", "all found", "must be", "oracle's Pd", "false a run",
                  "at most", "error m", "ms"], [
        [row["case"], row["bar"], number_text(row["pd"]), number_text(row["all_found"]),
         "" if np.isnan(case.found_min) else f"{'all' if case.counts_all else 'Pd'} >= "
         f"{case.found_min:g}", number_text(row["oracle_pd"]), number_text(row["false_per_run"]),
         "" if np.isnan(case.false_max) else f"{case.false_max:g}", number_text(row["error_m"], 1),
         f"{row['time_us'] / 1e3:.2f}"] for case, row in zip(CASES, rows)])


def judge_bars(report, rows, runs):
    for case, row in zip(CASES, rows):
        if not np.isnan(case.found_min):
            report.at_least(f"{case.name}: {'all ' if case.counts_all else ''}found",
                            row["all_found" if case.counts_all else "pd"], case.found_min,
                            trials=runs if case.counts_all else row["targets"])
        if not np.isnan(case.false_max):
            report.at_most(f"{case.name}: false a run", row["false_per_run"], case.false_max,
                           row["false_error"])
        if not np.isnan(case.behind_max):
            report.at_most(f"{case.name}: Pd behind the oracle's", row["oracle_pd"] - row["pd"],
                           case.behind_max, row["behind"][1])


def work_table(report, runs):
    """Of 100 clutter plots a scan in 10 km^2."""
    work = np.array([run.work for run in runs], float)
    report.heading("Work a window, 100 clutter plots a scan")
    report.table(["work", "mean", "most", "mean at most"], [
        [name, f"{of.mean():.0f}", f"{of.max():.0f}", most or ""]
        for name, of, most in zip([*WORK_MAX, "least-squares fits"], work.T,
                                  [*WORK_MAX.values(), None])])
    for (name, most), of in zip(WORK_MAX.items(), work.T):
        report.at_most(f"work, 100 clutter plots a scan: {name}", of.mean(), most,
                       experiment.mean_of(of)[1])
    report.fact("work", dict(zip([*WORK_MAX, "fits"], work.mean(axis=0).tolist())))


# ---- pictures ----


def picture_of_a_run(report):
    case = CASES[DENSE]
    model, (_, plots) = model_of(case), plots_of(case, np.random.default_rng(
        [report.options.seed, DENSE, 0]))
    tracks, _ = tracks_of(case, model, plots)
    places, target = (np.concatenate(part) for part in zip(*plots))
    span_s = model.interval_s * (paper.SCANS - 1)
    figure, axes = plt.subplots(figsize=(10, 6.4))
    axes.plot(*places[target < 0].T / 1e3, ".", ms=2, color="0.7", label="clutter plots")
    axes.plot(*places[target >= 0].T / 1e3, "o", mfc="none", color="k", label="target plots")
    for i, track in enumerate(tracks):
        axes.plot([(track["x_m"] - track["vx_mps"] * span_s) / 1e3, track["x_m"] / 1e3],
                  [(track["y_m"] - track["vy_mps"] * span_s) / 1e3, track["y_m"] / 1e3],
                  color="C0", lw=2.5, label="" if i else "tracks found")
    axes.set(xlabel="x east (km)", ylabel="y north (km)", aspect="equal")
    axes.legend(loc="upper right")
    report.figure("example", figure, "One run: Table 1's three targets among 100 clutter plots a "
                  "scan, 7 scans, and the tracks found.")


def picture_of_cases(report, name, rows, series, label, caption):
    """A row each case, first on top; series: (values, marker, colour, name)."""
    names = [row["case"] for row in rows]
    figure, axes = plt.subplots(figsize=(10, 0.24 * len(names) + 1))
    for values, marker, colour, title in series:
        axes.plot(values, np.arange(len(names)), marker, color=colour, mfc="none", label=title)
    axes.set_yticks(np.arange(len(names)), names, fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel(label)
    axes.grid(alpha=0.3)
    axes.legend()
    report.figure(name, figure, caption)


def pictures(report, rows):
    picture_of_a_run(report)
    pairs = [(case, row) for case, row in zip(CASES, rows) if not np.isnan(row["pd"])]
    picture_of_cases(report, "found", [row for _, row in pairs], [
        ([case.found_min for case, _ in pairs], "x", "0.5", "bar"),
        ([np.nan if case.counts_all else row["oracle_pd"] for case, row in pairs], "o", "C1",
         "oracle"),
        ([row["all_found" if case.counts_all else "pd"] for case, row in pairs], ".", "C0",
         "rhotrack")],
        "share found", "Share of the targets found, or of the runs in which all were found where "
        "the bar is about these, beside what the oracle accepts.")
    picture_of_cases(report, "false", rows, [
        ([case.false_max for case in CASES], "x", "0.5", "bar"),
        ([row["false_per_run"] for row in rows], ".", "C0", "rhotrack")], "false tracks a run",
        "Tracks that are no target's, in the mean over the runs.")


def main():
    options = experiment.options_of(__doc__, RUNS)
    report = experiment.Report("Track initiation from plots in clutter", options)
    jobs = [(number, options.seed, index) for number in range(len(CASES))
            for index in range(options.runs)]
    results = report.map(run, jobs)
    of_case = [results[i * options.runs:(i + 1) * options.runs] for i in range(len(CASES))]
    rows = [summarised(case, runs) for case, runs in zip(CASES, of_case)]
    report.text(" ".join(__doc__.split("\n\n", maxsplit=1)[1].split()))
    table(report, rows)
    pictures(report, rows)
    judge_bars(report, rows, options.runs)
    work_table(report, of_case[DENSE])
    report.fact("cases", [{key: None if isinstance(value, float) and np.isnan(value) else value
                           for key, value in row.items() if key not in ("behind", "targets")}
                          for row in rows])
    report.close()


if __name__ == "__main__":
    main()
