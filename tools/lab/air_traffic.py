#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment air-traffic: aircraft over 500 x 500 km, beside the same filter with true association.

Parts: grid (aircraft and clutter of scene air-traffic), stress (what else goes wrong), operation
(detection against false tracks), pairs (two aircraft close together: who is who afterwards?),
clutter (false tracks an hour without an aircraft), rivals (Stone Soup on the same plots). Their
runs, and the limit, are in air_traffic_runs.py.
"""
import collections
import math

import numpy as np

from common import experiment
from common import stonesoup_tracker
from parts.air_traffic_runs import (ALARMS, CASES, CUTOFFS_M, PAIRS, run_alarm, run_pair,
                                              run_rival, run_traffic)

RUNS = 4
PARTS = ("grid", "stress", "operation", "pairs", "clutter", "rivals")
PAIR_RUNS = 25  # for each of the experiment's
RIVAL_RUNS = 2  # at most
LEAST_WANTED = 20  # false tracks: a rate from fewer says little


def mean_figures(results):
    """Over the runs: roots of mean squares of what is in metres, means of the rest."""
    return {key: math.sqrt(np.mean([one[key]**2 for one in results])) if key.endswith("_m") else
            float(np.mean([one[key] for one in results])) for key in results[0]}


def summary_of(case, runs):
    """Figures of a case over its runs."""
    fastest = min(runs, key=lambda run: run["us"])
    made = {"case": case, "runs": runs, "us": fastest["us"], "max_us": fastest["max_us"],
            "min_scans": np.mean([run["min_scans"] for run in runs]),
            "tracks": [mean_figures([run["tracks"][k] for run in runs]) for k in (0, 1)]}
    if "limit" in runs[0]:
        made["limit"] = [mean_figures([run["limit"][k] for run in runs]) for k in (0, 1)]
        made["ratio"] = [experiment.root_of(*experiment.ratio_of(
            [run["tracks"][k]["gospa_m"]**2 for run in runs],
            [run["limit"][k]["gospa_m"]**2 for run in runs])) for k in (0, 1)]
    return made


# --- what is told


def traffic_row(of):
    case, tracks, limit = of["case"], of["tracks"], of["limit"]
    return [case.name, case.aircraft, case.clutter, f"{tracks[0]['gospa_m']:.0f}",
            f"{tracks[0]['localisation_m']:.0f}", f"{tracks[0]['missed']:.3f}",
            f"{tracks[0]['false']:.3f}", f"{limit[0]['gospa_m']:.0f}", f"{of['ratio'][0][0]:.3f}",
            f"{tracks[1]['gospa_m']:.0f}", f"{limit[1]['gospa_m']:.0f}", f"{of['ratio'][1][0]:.3f}",
            f"{tracks[0]['completeness']:.4f}", f"{limit[0]['completeness']:.4f}",
            f"{tracks[0]['switches']:.1f}", f"{tracks[0]['fragments']:.1f}",
            f"{tracks[0]['delay_scans']:.2f}", f"{of['min_scans']:.1f}", f"{of['us'] / 1e3:.2f}",
            f"{of['max_us'] / 1e3:.1f}"]


TRAFFIC_HEADS = ["case", "aircraft", "clutter", "gospa m", "localisation", "missed", "false",
                 "limit m", "ratio", "at 200 m", "limit", "ratio", "complete", "limit", "switches",
                 "fragments", "delay", "M", "ms a scan", "longest"]


def tell_grid(report, summaries):
    report.heading("Aircraft and clutter")
    report.text("GOSPA (p 2, alpha 2) with a cutoff of 1 km and, further right, 200 m; missed and "
                "false: a scan. Limit: the same filter and the same rules with true association. "
                "Delay: scans of an aircraft before it has a track. M: hits in 7 scans that start "
                "a track. Time: mean of the fastest run.")
    report.table(TRAFFIC_HEADS, map(traffic_row, summaries))
    report.heading("Parts of GOSPA")
    report.text("Beside the limit's. Nees: of places, 2 where the covariance is right.")
    both = (("missed", 3), ("false", 3), ("localisation_m", 0), ("rmse_m", 1), ("nees", 2))
    rows = []
    for of in summaries:
        tracks, limit = of["tracks"][0], of["limit"][0]
        rows.append([of["case"].name, of["case"].aircraft, of["case"].clutter, *(
            f"{one[key]:.{digits}f}" for key, digits in both for one in (tracks, limit)),
            f"{tracks['nees_inside']:.3f}", f"{tracks['velocity_ratio']:.2f}",
            f"{limit['velocity_ratio']:.2f}", f"{tracks['velocity_inside']:.3f}",
            f"{tracks['delay_scans']:.2f}", f"{limit['delay_scans']:.2f}"])
    report.table(["case", "aircraft", "clutter", "missed", "limit", "false", "limit",
                  "localisation m", "limit", "rmse m", "limit", "nees", "limit", "inside",
                  "velocity ratio", "limit", "inside", "delay", "limit"], rows)
    draw_grid(report, summaries)


def draw_grid(report, summaries):
    import matplotlib.pyplot as plt
    figure, panels = plt.subplots(2, 2, figsize=(12, 8))
    for axes, (title, of_tracks, has_limit) in zip(panels.flat, (
            ("GOSPA over the root of the number of aircraft, m",
             lambda case, one: one["gospa_m"] / math.sqrt(case.aircraft), True),
            ("completeness", lambda case, one: one["completeness"], True),
            ("false tracks a scan and aircraft", lambda case, one: one["false"] / case.aircraft,
             True),
            ("ms a scan", None, False))):
        for number, aircraft in enumerate((10, 50, 200, 1000)):
            level = [of for of in summaries if of["case"].aircraft == aircraft]
            clutter = [of["case"].clutter for of in level]
            axes.plot(clutter, [of_tracks(of["case"], of["tracks"][0]) if of_tracks else
                                of["us"] / 1e3 for of in level], "o-", color=f"C{number}",
                      markersize=4, label=f"{aircraft} aircraft")
            if has_limit:
                axes.plot(clutter, [of_tracks(of["case"], of["limit"][0]) for of in level], "--",
                          color=f"C{number}", linewidth=1)
        axes.set_xscale("symlog", linthresh=100)
        axes.set(xlabel="clutter plots a scan", ylabel=title)
    panels[1, 1].set_yscale("log")
    panels[0, 0].legend()
    report.figure("grid", figure, "By aircraft and clutter; dashed: the limit. Runs with 1000 "
                  "aircraft are short, and aircraft have no track in the first scans.")


def tell_stress(report, summaries):
    report.heading("What else goes wrong")
    report.text("50 aircraft, 100 clutter plots a scan, and:")
    report.table(TRAFFIC_HEADS, map(traffic_row, summaries))


def false_tracks_without_aircraft(of):
    """False tracks an hour in the same clutter without aircraft."""
    return sum(run["alarms"]["confirmed"] for run in of["runs"]) / sum(
        run["alarms"]["hours"] for run in of["runs"])


def found_shares_by_scan(of):
    """Shares of the targets that lived so long, by scans since the first."""
    return sum(run["found"] for run in of["runs"]) / sum(run["alive"] for run in of["runs"])


def tell_operation(report, summaries):
    import matplotlib.pyplot as plt
    report.heading("Detection against false tracks")
    report.text("50 aircraft, 1000 clutter plots a scan, false_tracks_per_hour varied. False "
                "tracks an hour: confirmed ones in the same clutter alone; and with the aircraft, "
                "those that have none in more than half of their scans. Found by scan k of their "
                "life.")
    by = (3, 4, 5, 6, 8, 10)
    rows = []
    for of in summaries:
        hours = sum(run["hours"] for run in of["runs"])
        tracks = of["tracks"][0]
        rows.append([of["case"].name, f"{false_tracks_without_aircraft(of):.2f}",
                     f"{tracks['false_tracks'] * len(of['runs']) / hours:.1f}",
                     f"{tracks['false']:.3f}", f"{of['min_scans']:.1f}",
                     *(f"{found_shares_by_scan(of)[k - 1]:.3f}" for k in by),
                     f"{tracks['completeness']:.4f}",
                     f"{tracks['gospa_m']:.0f}"])
    report.table(["wanted an hour", "in clutter alone", "false tracks an hour", "false a scan", "M",
                  f"found by scan {by[0]}", *map(str, by[1:]), "complete", "gospa m"], rows)
    figure, axes = plt.subplots(figsize=(8, 4.5))
    for k in by:
        axes.plot([false_tracks_without_aircraft(of) for of in summaries],
                  [found_shares_by_scan(of)[k - 1] for of in summaries], "o-", label=f"by scan {k}")
    axes.set_xscale("symlog", linthresh=1)
    axes.set(xlabel="false tracks an hour in clutter alone", ylabel="aircraft found",
             ylim=(0, 1.02))
    axes.legend()
    report.figure("operation", figure, "Aircraft found by the scans of their life over false "
                  "tracks.")


def tell_pairs(report, results):
    report.heading("Pairs")
    report.text("0.004 clutter plots a km^2. Parallel for 5 minutes, all the time or after they "
                "met and before they part at 10 degrees. Scans at which those that cross or meet "
                "are within 395 m do not count: who is who is not to be seen there.")
    report.table(["two aircraft", "runs", "no switch", "switches a run",
                  "a track is missing at the last four", "complete"], [
        [pair.name, of["runs"], f"{of['no_switch']:.3f}", f"{of['switches']:.2f}",
         f"{of['lost']:.3f}", f"{of['completeness']:.4f}"] for pair, of in zip(PAIRS, results)])
    report.fact("pairs", [{"case": pair.name, **of} for pair, of in zip(PAIRS, results)])
    for pair, of in zip(PAIRS, results):
        if pair.kept_least:
            report.at_least(f"{pair.name}: runs without a switch", of["no_switch"],
                            pair.kept_least, trials=of["runs"])
        report.at_most(f"{pair.name}: runs that lost one", of["lost"], 0.0, trials=of["runs"])


def tell_clutter(report, results):
    report.heading("Clutter alone")
    report.text("Every confirmed track is false. 100 000 scans of each: `tools/lab/air_traffic.py "
                "--part clutter --runs 200`.")
    rows, facts = [], []
    for (clutter, wanted), of in zip(ALARMS, results):
        low, high = (limit / of["hours"] for limit in experiment.poisson_limits(of["confirmed"]))
        rate = of["confirmed"] / of["hours"]
        rows.append([clutter, wanted, of["scans"], f"{of['hours']:.1f}", of["confirmed"],
                     f"{rate:.2f}", f"{low:.2f} .. {high:.2f}", f"{of['min_scans']:.2f}",
                     f"{of['us'] / 1e3:.2f}"])
        facts.append({"clutter_per_scan": clutter, "wanted_per_hour": wanted, "per_hour": rate,
                      **of})
    report.table(["clutter a scan", "wanted an hour", "scans", "hours", "false tracks", "an hour",
                  "95 % limits", "M", "ms a scan"], rows)
    report.fact("clutter", facts)
    for one in facts:
        expected = one["hours"] * one["wanted_per_hour"]
        if expected >= LEAST_WANTED:
            name = f"clutter {one['clutter_per_scan']:g} alone, {one['wanted_per_hour']} wanted: " \
                   f"false tracks over wanted"
            error = math.sqrt(max(1, one["confirmed"])) / expected
            report.at_most(name, one["confirmed"] / expected, 2.0, error)
            report.at_least(name, one["confirmed"] / expected, 0.5, error)


def tell_rivals(report, results):
    """results: {method: ([figures of each run], ms)}."""
    report.heading("Beside Stone Soup")
    report.text("The same plots: 50 aircraft, 100 clutter plots a scan, 120 scans; two runs at "
                "most. Stone Soup as stonesoup_tracker.py sets it up, which is best for such plots."
                if len(results) > 1 else "Left out: the Python package stonesoup is not installed; "
                "`make bench-stonesoup` installs it.")
    own, own_ms = results["rhotrack"]
    rows, facts = [], []
    for method, (figures, ms) in results.items():
        name = method if method == "rhotrack" else f"Stone Soup, {method.upper()}"
        of = mean_figures(figures)
        over = experiment.root_of(*experiment.ratio_of([one["gospa_m"]**2 for one in own],
                                         [one["gospa_m"]**2 for one in figures]))
        rows.append([name, f"{of['gospa_m']:.0f}", f"{of['localisation_m']:.0f}",
                     f"{of['missed']:.3f}", f"{of['false']:.3f}", f"{of['completeness']:.4f}",
                     f"{of['switches']:.1f}", f"{of['delay_scans']:.2f}", f"{ms:.3f}",
                     f"{over[0]:.3f}", f"{ms / own_ms:.0f}"])
        facts.append({"tracker": name, **of, "scan_ms": ms})
        if method != "rhotrack":
            report.at_most(f"GOSPA over that of {name}", over[0], 0.9, over[1])
            report.at_least(f"time of {name} over rhotrack's", ms / own_ms, 400)
    report.table(["tracker", "gospa m", "localisation", "missed", "false", "complete", "switches",
                  "delay", "ms a scan", "rhotrack's gospa over it", "its time over rhotrack's"],
                 rows)
    report.fact("rivals", facts)


BARS = {(50, 100): (0.95, 1.0, 1.0), (50, 1000): (0.94, 1.5, 10.0), (50, 5000): (0.90, 5.0, 80.0),
        (1000, 5000): (None, None, 150.0)}  # completeness, false tracks a scan, ms a scan


def judge_grid(report, summaries):
    for of in summaries:
        case = of["case"]
        if (case.aircraft, case.clutter) not in BARS:
            continue
        complete, false, ms = BARS[case.aircraft, case.clutter]
        name = f"{case.aircraft} aircraft, clutter {case.clutter}"
        if complete:
            for key, what, judge, bar in (
                    ("completeness", "completeness", report.at_least, complete),
                    ("false", "false tracks a scan", report.at_most, false)):
                value, error = experiment.mean_of([run["tracks"][0][key] for run in of["runs"]])
                judge(f"{name}: {what}", value, bar, error)
        report.at_most(f"{name}: ms a scan", of["us"] / 1e3, ms)
        if (case.aircraft, case.clutter) == (50, 100):
            for cutoff_m, (value, error) in zip(CUTOFFS_M, of["ratio"]):
                report.at_most(f"{name}: GOSPA with cutoff {cutoff_m:g} m over the limit's", value,
                               1.05, error)


# --- the parts


def measure_traffic(report, parts):
    """The largest go first."""
    options = report.options
    cases = [case for case in CASES if case.part in parts]
    jobs = [(case, options.seed + run) for case in reversed(cases)
            for run in range(max(1, options.runs // case.share))]
    runs = collections.defaultdict(list)
    for (case, _), result in zip(jobs, report.map(run_traffic, jobs)):
        runs[id(case)].append(result)
    summaries = [summary_of(case, runs[id(case)]) for case in cases]
    for part, tell in (("grid", tell_grid), ("stress", tell_stress),
                       ("operation", tell_operation)):
        if part in parts:
            tell(report, [of for of in summaries if of["case"].part == part])
    report.fact("cases", [
        {"part": of["case"].part, "case": of["case"].name, "targets": of["case"].aircraft,
         "clutter_per_scan": of["case"].clutter, "scan_us": of["us"],
         "min_scans": float(of["min_scans"]), "tracks": of["tracks"][0],
         "tracks_200_m": of["tracks"][1], **({"limit": of["limit"][0],
                                              "limit_200_m": of["limit"][1]}
                                             if "limit" in of else {})} for of in summaries])
    judge_grid(report, [of for of in summaries if of["case"].part == "grid"])


def measure_pairs(report):
    count = PAIR_RUNS * report.options.runs
    done = report.map(run_pair, [(pair, report.options.seed, run)
                                 for pair in PAIRS for run in range(count)])
    return [{"runs": count, **{key: float(np.mean([run[key] for run in done[k:k + count]]))
                               for key in done[0]}} for k in range(0, len(done), count)]


def measure_clutter(report):
    """The densest take longest, and go first."""
    count = report.options.runs
    done = report.map(run_alarm, [(*alarm, report.options.seed + run) for alarm in reversed(ALARMS)
                                  for run in range(count)])
    runs = [done[k:k + count] for k in range(0, len(done), count)][::-1]
    return [{"scans": sum(one["scans"] for one in of), "hours": sum(one["hours"] for one in of),
             "confirmed": sum(one["confirmed"] for one in of),
             "min_scans": float(np.mean([one["min_scans"] for one in of])),
             "us": min(one["us"] for one in of)} for of in runs]


def measure_rivals(report):
    methods = ["rhotrack", *(stonesoup_tracker.METHODS if stonesoup_tracker.is_installed() else ())]
    seeds = [report.options.seed + run for run in range(min(RIVAL_RUNS, report.options.runs))]
    done = report.map(run_rival, [(method, seed) for method in methods for seed in seeds])
    return {method: ([figures for figures, _ in of], min(ms for _, ms in of))
            for k, method in enumerate(methods)
            for of in [done[k * len(seeds):(k + 1) * len(seeds)]]}


def main():
    options = experiment.options_of(__doc__, RUNS, lambda parser: parser.add_argument(
        "--part", action="append", choices=PARTS, help="this one alone (repeatable)"))
    parts = options.part or PARTS
    report = experiment.Report(
        "Air traffic over 500 x 500 km, a scan every 10 s, sigma 50 m, P_D 0.95", options)
    measure_traffic(report, parts)
    if "pairs" in parts:
        tell_pairs(report, measure_pairs(report))
    if "clutter" in parts:
        tell_clutter(report, measure_clutter(report))
    if "rivals" in parts:
        tell_rivals(report, measure_rivals(report))
    report.close()


if __name__ == "__main__":
    main()
