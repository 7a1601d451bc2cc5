# SPDX-License-Identifier: MIT
"""What the parts of experiment passive share: their runs, and figures as texts and facts."""
import math

from common import experiment  # before numpy, whose threads it limits

import numpy as np

from parts.passive_scenes import Scene

SHARE = {"pruning": 3 / 4, "paper": 1 / 2, "default": 1, "chain": 1 / 2, "further": 1 / 8,
         "claims": 1 / 4}  # of --runs
RULES = {"none": "elimination alone", "literal": "literal", "safe": "safe"}  # of pruning


def runs_of(report, part, cases, function):
    """{case: [function(case, scene) of each run]}; a case is a tuple with its setting first. Every
    case and run has random numbers of its own."""
    count = math.ceil(report.options.runs * SHARE[part])
    jobs = [(function, cases[name], (report.options.seed, list(SHARE).index(part), i, run))
            for i, name in enumerate(cases) for run in range(count)]
    done = iter(report.map(run_job, jobs))
    return {name: [next(done) for _ in range(count)] for name in cases}


def run_job(job):
    function, case, seeds = job
    return function(case, Scene(case[0], np.random.default_rng(seeds)))


def found_of(found, ghosts, targets):
    """Share of the targets found, ghosts a run, share of the exact runs; each with its error."""
    found, ghosts = np.array(found), np.array(ghosts)
    return (experiment.ratio_of(found, np.full(len(found), targets)), experiment.mean_of(ghosts),
            experiment.mean_of((found == targets) & (ghosts == 0)))


def judge_rate(report, what, counts, bar):
    """Few events a run: a share of the runs, where they are less than one a run."""
    rate, error = experiment.mean_of(counts)
    report.at_most(what, rate, bar, error, trials=len(counts) if rate <= 1 else None)


def text_of(value, digits):
    return "-" if math.isnan(value) else f"{value:.{digits}f}"


def beside(value, reference, digits):
    """measured/reference."""
    return text_of(value, digits) + ("" if math.isnan(reference) else f"/{reference:.{digits}f}")


def facts_of(name, setting, **figures):
    """The case and its figures for JSON, which has no NaN."""
    return {"case": name, "sensors": setting.sensors, "targets": setting.targets,
            "sigma_deg": setting.sigma_deg, "pd": setting.pd, "false_alarms": setting.false_mean,
            "region": setting.region, "unequal_intervals": setting.unequal_intervals,
            "frames": setting.frames,
            **{key: None if isinstance(value, float) and math.isnan(value) else value
               for key, value in figures.items()}}


def found_facts(shares, reference):
    return {f"{prefix}{key}": value
            for prefix, values in (("", [one[0] for one in shares]), ("reference_", reference))
            for key, value in zip(("found", "ghosts_per_run", "exact"), values)}
