#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Bearings of passive sensors: pruning of ghosts, the passive paper's method, the default beside a
fit that is told the bearings, and the whole chain beside a filter that is told them.

The paper gives no scan interval, noise, cells, threshold, false bearings or misses: these are ours.
References were measured by an independent implementation in double precision, 50 to 400 runs a
case. Cases of the default have --runs runs each, those of pruning three quarters of them, the
others half.
"""
import functools
import math
import time

from common import experiment  # before numpy, whose threads it limits

import numpy as np

from parts import passive_chain
from parts import passive_further_claims
from parts import passive_paper_figures
from parts import passive_variants
import rhotrack
from parts.passive_scenes import PLACES_M, Setting, fit, moved, nees
from common.experiment import ratio_of, root_of
from parts.passive_paper_figures import (RANGE_MAX_M, line_of, line_off, lines_matched,
                                         search_paper, second_lines)
from parts.passive_runs import (RULES, beside, facts_of, found_facts, found_of,
                                                 judge_rate, runs_of, text_of)

RUNS = 400
BEARINGS_MAX = 16  # of a look, which a ghost matrix holds
NEAR_M, NEAR_SIGMAS = 1000, 4  # a track this near to a target is the target's
PAPER_SHARE_TOLERANCE, PAPER_GHOSTS_TOLERANCE, PAPER_GHOSTS_SHARE = 0.07, 0.4, 0.1
RMS_RATIO_MAX, NEES_MIN, NEES_MAX = 1.08, 3.5, 4.7  # NEES of 4 dimensions
FIND_MS_MAX, TIMED_RUNS_MIN = 10, 100


def crowded(sensors, targets, sigma_deg=0.1, false_mean=1, **others):
    return Setting(sensors, targets, sigma_deg, 0.9, false_mean, **others)


# By rule: share of the ghosts removed, share of the targets' crossings lost
PRUNING = {
    "2 targets, clean": (Setting(2, 2), (.395, .790, .757), (0, 0, 0)),
    "2 targets, P_D .9": (crowded(2, 2, .1, 0), (.366, .714, .679), (0, .0525, 0)),
    "2 targets, FA 1": (Setting(2, 2, .1, 1, 1), (.470, .734, .507), (0, .1456, .0002)),
    "2 targets, P_D .9 FA 1": (crowded(2, 2), (.475, .715, .503), (0, .1734, .0005)),
    "2 targets, P_D .9 FA 3": (crowded(2, 2, .1, 3), (.505, .692, .510), (0, .2002, .0003)),
    "4 targets, clean": (Setting(2, 4), (.386, .727, .754), (0, 0, 0)),
    "4 targets, P_D .9 FA 1": (crowded(2, 4), (.441, .681, .467), (0, .0998, .0010)),
    "6 targets, clean": (Setting(2, 6), (.384, .635, .732), (0, 0, 0)),
    "6 targets, P_D .9 FA 1": (crowded(2, 6), (.422, .601, .453), (0, .0619, .0013)),
    "2 on the base's extension, clean": (
        Setting(2, 2, region="base's extension"), (.720, .914, .904), (.0431, .0523, .0456)),
}
# T, and by rule: share of the targets found, ghosts a run, share of the runs that are exact
PAPER = {
    "2s 2t .05 clean": (Setting(2, 2, .05), 7, {
        "none": (.909, 2.46, .09), "literal": (.927, 0.19, .76)}),
    "2s 2t .1 clean": (Setting(2, 2), 7, {
        "none": (.797, 2.35, .07), "literal": (.804, 0.25, .58)}),
    "2s 2t .2 clean": (Setting(2, 2, .2), 6, {
        "none": (.769, 3.37, .04), "literal": (.785, 0.53, .47)}),
    "2s 2t .5 clean": (Setting(2, 2, .5), 5, {
        "none": (.605, 5.44, .01), "literal": (.608, 1.40, .17)}),
    "2s 2t .1 P_D .9 FA 1": (crowded(2, 2), 5, {
        "none": (.865, 5.05, .01), "literal": (.693, 0.66, .30), "safe": (.874, 3.97, .06)}),
    "3s 2t .1 clean": (Setting(3, 2), 7, {
        "none": (.330, 0.20, .09), "literal": (.328, 0.02, .10)}),
    "3s 4t .1 P_D .9 FA 1": (crowded(3, 4), 5, {
        "none": (.549, 8.57, .00), "literal": (.390, 0.81, .02)}),
}
# Reference: found, ghosts a run, exact, rms error of the place in m; bars: found, ghosts a run
DEFAULT = {
    "2s 2t .05 clean": (Setting(2, 2, .05), (1, 0, 1, 77), (.99, .02)),
    "2s 2t .1 clean": (Setting(2, 2), (1, 0, 1, 153), (.99, .02)),
    "2s 2t .2 clean": (Setting(2, 2, .2), (1, 0, 1, 306), (.99, .02)),
    "2s 2t .5 clean": (Setting(2, 2, .5), (.985, .025, .98, 785), ()),
    "3s 2t .1 clean": (Setting(3, 2), (1, 0, 1, 121), ()),
    "3s 2t .5 clean": (Setting(3, 2, .5), (1, 0, 1, 605), ()),
    "2s 2t .1 P_D .9 FA 1": (crowded(2, 2), (.985, .020, .98, 145), ()),
    "2s 4t .1 P_D .9 FA 1": (crowded(2, 4), (.980, .050, .95, 176), (.94, .12)),
    "2s 6t .1 P_D .9 FA 1": (crowded(2, 6), (.950, .220, .84, 146), (.92, None)),
    "3s 2t .1 P_D .9 FA 1": (crowded(3, 2), (.990, .010, .99, 139), ()),
    "3s 4t .1 P_D .9 FA 1": (crowded(3, 4), (1, 0, 1, 133), (.99, .02)),
    "3s 6t .1 P_D .9 FA 1": (crowded(3, 6), (1, 0, 1, 131), ()),
    "4s 2t .1 P_D .9 FA 1": (crowded(4, 2), (1, 0, 1, 119), ()),
    "4s 4t .1 P_D .9 FA 1": (crowded(4, 4), (.998, 0, .99, 119), ()),
    "4s 6t .1 P_D .9 FA 1": (crowded(4, 6), (.997, 0, .98, 135), ()),
    "2s 4t .3 P_D .9 FA 1": (crowded(2, 4, .3), (.967, .117, .93, 574), ()),
    "3s 4t .3 P_D .9 FA 1": (crowded(3, 4, .3), (.996, .017, .98, 442), ()),
    "2s 3t .1 P_D .9 FA 3": (crowded(2, 3, .1, 3), (.989, .033, .98, 144), ()),
    "3s 3t .1 P_D .9 FA 3": (crowded(3, 3, .1, 3), (1, 0, 1, 159), ()),
    "4s 3t .1 P_D .9 FA 3": (crowded(4, 3, .1, 3), (1, 0, 1, 121), ()),
    "2s 4t .1 P_D .9 FA 1, unequal intervals": (
        crowded(2, 4, unequal_intervals=True), (.979, .050, .93, 140), ()),
    "2s 2t .1 clean, base's extension": (
        Setting(2, 2, region="base's extension"), (.985, .020, .97, 2140), ()),
    "3s 2t .1 clean, base's extension": (
        Setting(3, 2, region="base's extension"), (1, 0, 1, 124), ()),
    "4s 2t .1 clean, base's extension": (
        Setting(4, 2, region="base's extension"), (1, 0, 1, 70), ()),
    "2s 3t .1 P_D .9 FA 1, near": (crowded(2, 3, region="near"), (.972, .050, .95, 34), ()),
    "3s 3t .1 P_D .9 FA 1, near": (crowded(3, 3, region="near"), (.994, 0, .98, 26), ()),
    "2s no target FA 4": (crowded(2, 0, .1, 4), (math.nan, 0, math.nan, math.nan), (None, .01)),
    "3s no target FA 4": (crowded(3, 0, .1, 4), (math.nan, 0, math.nan, math.nan), (None, .01)),
}
TIMED = "3s 4t .1 P_D .9 FA 1"


# ---- Pruning ----

def prune(case, scene):
    """(rules, 4): ghosts, targets' crossings, ghosts removed, targets' crossings lost."""
    counts, looks = np.zeros((len(RULES), 4), int), scene.looks()
    for k in range(scene.of.frames):
        a, b = (looks[k, i][:BEARINGS_MAX] for i in range(2))
        is_target = (a["target_id"][:, None] == b["target_id"]) & (b["target_id"] >= 0)
        for i, rule in enumerate(RULES):
            is_gone = rhotrack.ghosts(a["bearing_rad"], b["bearing_rad"], *PLACES_M[:2],
                                      RANGE_MAX_M, rule).reason != "kept"
            counts[i] += [which.sum() for which in (~is_target, is_target, ~is_target & is_gone,
                                                    is_target & is_gone)]
    return counts


def tell_pruning(report):
    runs, rows, facts, shares = runs_of(report, "pruning", PRUNING, prune), [], [], {}
    for name, (setting, *references) in PRUNING.items():
        for i, rule in enumerate(RULES):
            ghosts, targets, removed, lost = np.array(runs[name])[:, i].T
            shares[name, rule] = ratio_of(removed, ghosts), ratio_of(lost, targets), targets.sum()
            facts.append(facts_of(
                name, setting, rule=RULES[rule], ghosts_removed=shares[name, rule][0][0],
                targets_lost=shares[name, rule][1][0], reference_ghosts_removed=references[0][i],
                reference_targets_lost=references[1][i]))
        rows.append([name] + [beside(shares[name, rule][which][0], references[which][i], digits)
                              for which, digits in ((0, 3), (1, 4))
                              for i, rule in enumerate(RULES)])
    report.heading("Pruning alone")
    report.text(
        f"Sensors 1 and 2, 0.1 degrees, {len(ghosts)} runs of 8 scans; measured/reference. Shares "
        "of the ghosts that are removed and of the targets' crossings that are lost. Eliminated: "
        "by side and range, step 1 of the paper. Literal: steps 2 to 2.6, too. Safe: what is "
        "in no complete matching, where as many bearings came from both sensors. P_D: probability "
        "of detection, FA: mean false bearings of a look; 1 and 0 where clean.")
    report.table(["pruning alone", "ghosts: eliminated", "literal", "safe", "targets: eliminated",
                  "literal", "safe"], rows)
    report.fact("pruning", facts)
    report.fact("pruning_runs", len(ghosts))
    clean, noisy = "2 targets, clean", "2 targets, P_D .9 FA 1"
    removed, (lost, _), trials = shares[clean, "literal"]
    report.at_least(f"pruning, {clean}, literal: ghosts removed", removed[0], .74, removed[1])
    report.at_most(f"pruning, {clean}, literal: targets lost", lost, 0, trials=trials)
    _, (lost, _), trials = shares[noisy, "safe"]
    report.at_most(f"pruning, {noisy}, safe: targets lost", lost, .003, trials=trials)


# ---- The paper's method ----

def paper_run(case, scene):
    """By rule of the case: targets found, ghosts' lines, those of them that are a target's."""
    _, votes_min, references = case
    return [(*lines_matched(lines, scene), second_lines(lines, scene, rule))
            for rule in references for lines in [search_paper(scene, rule, votes_min).copy()]]


def tell_paper(report):
    runs, rows, facts = runs_of(report, "paper", PAPER, paper_run), [], []
    for name, (setting, votes_min, references) in PAPER.items():
        for i, (rule, reference) in enumerate(references.items()):
            found, ghosts, second = np.array(runs[name])[:, i].T
            share, a_run, exact = shares = found_of(found, ghosts, setting.targets)
            what = f"paper's method, {name}, {RULES[rule]}"
            report.at_most(f"{what}: Pd off the reference {reference[0]:.3f}",
                           abs(share[0] - reference[0]), PAPER_SHARE_TOLERANCE, share[1])
            report.at_most(f"{what}: ghosts a run off the reference {reference[1]:.2f}",
                           abs(a_run[0] - reference[1]),
                           max(PAPER_GHOSTS_TOLERANCE, PAPER_GHOSTS_SHARE * reference[1]), a_run[1])
            rows.append([name, RULES[rule], f"{votes_min} of {setting.frames}",
                         beside(share[0], reference[0], 3), beside(a_run[0], reference[1], 2),
                         beside(exact[0], reference[2], 2), text_of(second.mean(), 2)])
            facts.append(facts_of(name, setting, rule=RULES[rule], votes_min=votes_min,
                                  second_per_run=float(second.mean()),
                                  **found_facts(shares, reference)))
    passive_paper_figures.tell(report)
    report.heading("The paper's method")
    report.text(
        f"s sensors, t targets, degrees; {len(found)} runs, measured/reference. Pd: share of the "
        "targets with a line within 6 degrees and 3 km. Ghosts: lines with no such target. Exact: "
        "share of the runs with all targets and no ghost. Second: those of the ghosts for which "
        "one target's crossings cast most votes.")
    report.table(["the paper's method", "pruning", "T", "Pd", "ghosts a run", "exact",
                  "second"], rows)
    report.fact("paper", facts)
    report.fact("paper_runs", len(found))


# ---- The default ----

HIT = np.dtype([(name, "f8") for name in (
    "off_m", "fit_off_m", "theta_rad", "rho_m", "fit_theta_rad", "fit_rho_m", "nees", "is_own")])


@functools.cache
def passive():
    return rhotrack.Passive()


def default_run(case, scene):
    """Targets found, ghosts, ms of the search, the hits."""
    frames = rhotrack.Scans(scene.frames())
    start_s = time.thread_time()
    tracks = passive().find(frames)
    find_ms = 1e3 * (time.thread_time() - start_s)
    states = np.array([tracks[name] for name in ("x_m", "y_m", "vx_mps", "vy_mps")], float).T
    hits = hits_of(scene, states, passive().covariances, passive().claims)
    return len(hits), len(tracks) - len(hits), find_ms, hits


def hits_of(scene, states, covariances, claims):
    """The pairs of targets and tracks (states at the last scan): errors at mid-batch of the track's
    place and line and of the fit's; NEES at the last scan; whether no bearing of the track is false
    or another target's.

    A target's track is the nearest over the whole batch, as targets can meet at its middle, of
    those within max(1 km, 4 standard deviations of the fit) at mid-batch that no other has.
    """
    middle_s, last_s = scene.middle_s, scene.times_s[-1]
    seen, looks = scene.seen, scene.looks()
    middle = moved(states, middle_s - last_s)
    is_free, hits = np.ones(len(states), bool), []
    for target, (at_middle, at_last) in enumerate(zip(*scene.truth(np.array([middle_s, last_s])))):
        best, spread = fit(seen[seen["target_id"] == target], middle_s, at_middle)
        near_m = max(NEAR_M, NEAR_SIGMAS * math.sqrt(spread[0, 0] + spread[1, 1]))
        off_m = np.hypot(*(middle - at_middle)[:, :2].T)
        apart_m = np.mean([np.hypot(*moved(middle - at_middle, t_s)[:, :2].T)
                           for t_s in scene.times_s - middle_s], axis=0)
        apart_m[~is_free | (off_m >= near_m)] = np.inf
        if np.isfinite(apart_m).any():
            track = apart_m.argmin()
            is_free[track] = False
            hits.append((off_m[track], math.hypot(*(best - at_middle)[:2]),
                         *line_off(line_of(middle[track]), line_of(at_middle)),
                         *line_off(line_of(best), line_of(at_middle)),
                         nees(states[track] - at_last, covariances[track]),
                         has_own_alone(looks, claims[track], target)))
    return np.array(hits, HIT)


def has_own_alone(looks, claims, target):
    return all(looks[k, i]["target_id"][claims[k, i]] == target
               for k, i in np.argwhere(claims >= 0))


def summarised(runs, targets):
    """Figures of a case's runs; found, ghosts, exact and ratio with their standard errors."""
    found, ghosts, find_ms, by_run = zip(*runs)
    hits = np.concatenate(by_run)
    own = hits[hits["is_own"] > 0]
    squares_m2 = [[(one[name]**2).sum() for one in by_run] for name in ("off_m", "fit_off_m")]
    figures = dict(zip(("found", "ghosts", "exact"), found_of(found, ghosts, targets)))
    figures.update({"ratio": root_of(*ratio_of(*squares_m2)), "find_ms": float(np.median(find_ms)),
                    "hits": len(hits), "own_hits": len(own)})
    for name in ("off_m", "fit_off_m"):
        figures[name] = math.sqrt((hits[name]**2).mean()) if len(hits) else math.nan
    for name in ("theta_rad", "fit_theta_rad", "rho_m", "fit_rho_m"):
        figures[name] = float(np.median(hits[name])) if len(hits) else math.nan
    for name, of in (("nees", hits), ("own_nees", own)):
        figures[name] = float(of["nees"].mean()) if len(of) else math.nan
    figures["mixed"] = 1 - len(own) / len(hits) if len(hits) else math.nan
    return figures


def default_row(name, figures, reference):
    shares = [beside(figures[key][0], reference[i], digits)
              for i, (key, digits) in enumerate((("found", 3), ("ghosts", 3), ("exact", 2)))]
    return [name, *shares, beside(figures["off_m"] / 1e3, reference[3] / 1e3, 3),
            text_of(figures["fit_off_m"] / 1e3, 3), text_of(figures["ratio"][0], 3),
            text_of(math.degrees(figures["theta_rad"]), 2),
            text_of(math.degrees(figures["fit_theta_rad"]), 2), text_of(figures["rho_m"] / 1e3, 3),
            text_of(figures["fit_rho_m"] / 1e3, 3), text_of(figures["nees"], 2),
            text_of(figures["own_nees"], 2), text_of(figures["mixed"], 3),
            text_of(figures["find_ms"], 2)]


def default_facts(name, setting, figures, reference):
    shares = [figures[key] for key in ("found", "ghosts", "exact")]
    return facts_of(
        name, setting, **found_facts(shares, reference), rms_m=figures["off_m"],
        reference_rms_m=reference[3], fit_rms_m=figures["fit_off_m"],
        rms_over_fit=figures["ratio"][0], theta_error_rad=figures["theta_rad"],
        fit_theta_error_rad=figures["fit_theta_rad"], rho_error_m=figures["rho_m"],
        fit_rho_error_m=figures["fit_rho_m"], nees=figures["nees"], tracks=figures["hits"],
        own_nees=figures["own_nees"], own_tracks=figures["own_hits"], find_ms=figures["find_ms"])


def judge_default(report, name, runs, figures):
    setting, _, bars = DEFAULT[name]
    found_min, ghosts_max = bars or (None, None)
    if found_min is not None:
        report.at_least(f"default, {name}: Pd", figures["found"][0], found_min,
                        trials=len(runs) * setting.targets)
    if ghosts_max is not None:
        judge_rate(report, f"default, {name}: ghosts a run", [run[1] for run in runs], ghosts_max)
    if setting.targets:
        report.at_most(f"default, {name}: rms error of the place over the fit's",
                       figures["ratio"][0], RMS_RATIO_MAX, figures["ratio"][1])
    if name == TIMED and len(runs) >= TIMED_RUNS_MIN:
        report.at_most(f"default, {name}: median ms of a search", figures["find_ms"], FIND_MS_MAX)


def judge_nees(report, runs):
    """Pooled over cases: [(mean, tracks)] of clean cases, of all, and of tracks with their own
    bearings alone."""
    every = [hits for name, (setting, *_) in DEFAULT.items()
             if setting.region != "base's extension" for _, _, _, hits in runs[name]]
    clean = [hits for name, (setting, *_) in DEFAULT.items()
             if (setting.region, setting.pd, setting.false_mean) == ("ahead", 1, 0)
             for _, _, _, hits in runs[name]]
    own = [hits[hits["is_own"] > 0] for hits in every]
    told = []
    for what, by_run in (
            ("clean cases ahead: NEES of the found", clean),
            ("all cases but the base's extension: NEES of the found", every),
            ("all cases but the base's extension: NEES of the found with their own bearings alone",
             own)):
        mean, error = ratio_of([hits["nees"].sum() for hits in by_run], [*map(len, by_run)])
        report.at_least(f"default, {what}", mean, NEES_MIN, error)
        report.at_most(f"default, {what}", mean, NEES_MAX, error)
        told.append((mean, sum(map(len, by_run))))
    return told


def tell_default(report):
    runs, rows, facts = runs_of(report, "default", DEFAULT, default_run), [], []
    for name, (setting, reference, _) in DEFAULT.items():
        figures = summarised(runs[name], setting.targets)
        judge_default(report, name, runs[name], figures)
        rows.append(default_row(name, figures, reference))
        facts.append(default_facts(name, setting, figures, reference))
    count = len(runs[TIMED])
    report.heading("The default")
    report.text(
        f"{count} runs, measured/reference. Found: a track within 1 km at mid-batch, or 4 standard "
        "deviations of the fit where that is more; of several the nearest over the batch. Fit: "
        "with the target's own bearings, in double precision. Rms: of the place at mid-batch. "
        "Theta, rho: median errors of the line. NEES: of the state at the newest scan, 4 where its "
        "covariance is right; own's: of tracks with none but their target's bearings; mixed: share "
        "of the others. Ms: median processor time of Passive.find.")
    report.table(["the default", "Pd", "ghosts a run", "exact", "rms km", "fit's", "ratio",
                  "theta deg", "fit's", "rho km", "fit's", "NEES", "own's", "mixed", "ms"], rows)
    clean, every, own = judge_nees(report, runs)
    report.text(
        f"NEES, 4 dimensions, of all cases but the base's extension: {every[0]:.2f} over "
        f"{every[1]} found; {own[0]:.2f} over the {own[1]} with their own bearings alone; "
        f"{clean[0]:.2f} over the {clean[1]} of the clean cases.")
    report.fact("default", facts)
    report.fact("default_runs", count)
    for key, (mean, tracks) in zip(("clean_nees", "nees", "own_nees"), (clean, every, own)):
        report.fact(key, {"mean": mean, "tracks": tracks})


PARTS = {"pruning": tell_pruning, "paper": tell_paper, "default": tell_default,
         "chain": passive_chain.tell, "further": passive_variants.tell,
         "claims": passive_further_claims.tell}


def main():
    options = experiment.options_of(__doc__, RUNS, lambda parser: parser.add_argument(
        "--part", nargs="+", choices=PARTS, default=list(PARTS), help="tables, all unless named"))
    report = experiment.Report("Bearings of passive sensors", options)
    for part in options.part:
        PARTS[part](report)
    report.close()


if __name__ == "__main__":
    main()
