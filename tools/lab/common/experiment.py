# SPDX-License-Identifier: MIT
"""What the experiments share: options, runs side by side, tables, bars, and the page.

An experiment is one script: it makes a Report, runs its cases with Report.map, and says what it
found with heading, text, table, figure, at_least and at_most, in the order of the reading. Report
prints this as text, or as one JSON object (--json), and writes it with all pictures as
OUTPUT/index.html, beside the object as OUTPUT/figures.json.
"""
import argparse
import html
import json
import math
import multiprocessing
import os
import pathlib
import sys
import textwrap
import urllib.parse

os.environ.setdefault("OMP_NUM_THREADS", "1")  # matrices are small, and runs go side by side
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = ROOT / os.environ.get("BUILD", "build")  # relative: of the repository
sys.path.append(str(BUILD / "python" / "site"))  # the package rhotrack: make python

STANDARD_ERRORS = 2  # a value this near its bar is told as undecided
TRIALS_MIN = 3  # expected events that a bar on a share allows; fewer trials do not test it
STYLE = """body{font:16px/1.5 system-ui,Helvetica,Arial,sans-serif;color:#222;max-width:72rem;
margin:2rem auto;padding:0 1rem}h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2.2rem;
border-bottom:1px solid #ccc}.wide{overflow-x:auto}table{border-collapse:collapse;margin:1rem 0}
th,td{padding:.25rem .8rem;text-align:right;border-bottom:1px solid #eee}
th{border-bottom:2px solid #888}td:first-child,th:first-child{text-align:left}
.missed{color:#b00020;font-weight:600}.ok{color:#1a7f37}
figure{margin:1.5rem 0}img{max-width:100%;height:auto}figcaption{color:#555}"""


def mean_of(values):
    """(mean, its standard error) over runs; the error of a single run is not known (NaN)."""
    values = np.asarray(values, float)
    values = values[~np.isnan(values)]
    if not len(values):
        return math.nan, math.nan
    return float(values.mean()), float(
        values.std(ddof=1) / math.sqrt(len(values))) if len(values) > 1 else math.nan


def ratio_of(tops, bottoms):
    """(sum of tops / sum of bottoms, its standard error) over runs, each with one of both."""
    tops, bottoms = np.asarray(tops, float), np.asarray(bottoms, float)
    count, total = len(tops), bottoms.sum()
    if total == 0:
        return math.nan, math.nan
    ratio = tops.sum() / total
    error = math.sqrt(((tops - ratio * bottoms)**2).sum() * count / (count - 1)
                      ) / abs(total) if count > 1 else math.nan
    return float(ratio), error


def root_of(ratio, error):
    """The square root of a value, and its standard error."""
    return math.sqrt(ratio), error / (2 * math.sqrt(ratio)) if ratio > 0 else math.nan


def quotient_of(top, bottom):
    """(quotient, standard error) of two (value, standard error), as if these were independent; of
    the same runs they rarely are, and the error is rather less."""
    quotient = top[0] / bottom[0]
    return quotient, abs(quotient) * math.hypot(top[1] / top[0], bottom[1] / bottom[0])


def poisson_limits(count):
    """The 95 % limits of the mean of a Poisson count."""
    from scipy.stats import chi2
    return (chi2.ppf(0.025, 2 * count) / 2 if count else 0.0), chi2.ppf(0.975, 2 * count + 2) / 2


def values_of(figures):
    """Figures without their standard errors, for fact()."""
    return {key: value[0] if isinstance(value, tuple) else value for key, value in figures.items()}


def share_error(share, trials):
    """The standard error of a share; at 0 and 1 that of half an event more or less."""
    smoothed = (share * trials + 0.5) / (trials + 1)
    return math.sqrt(smoothed * (1 - smoothed) / trials)


def options_of(about, runs, add=None):
    """The options of every experiment; add(parser) adds its own."""
    name = pathlib.Path(sys.argv[0]).stem
    parser = argparse.ArgumentParser(description=about.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--runs", type=int, default=runs, help=f"of each case (default {runs})")
    parser.add_argument("--seed", type=int, default=1, help="of the first run (default 1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="side by side")
    parser.add_argument("--json", action="store_true", help="one object instead of tables")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FOLDER",
                        default=BUILD / "experiment" / name.replace("_", "-"),
                        help="of index.html and pictures")
    if add:
        add(parser)
    options = parser.parse_args()
    if options.runs < 1 or options.jobs < 1 or options.seed < 0:
        parser.error("--runs and --jobs are 1 at least, --seed 0")
    options.name = name.replace("_", "-")
    return options


class Report:
    """The experiment as it is told; close() ends it."""

    def __init__(self, title, options):
        self.title, self.options = title, options
        self.page, self.bars, self.facts = [], [], {}
        self.say(f"{title}: {options.runs} runs a case from seed {options.seed}")

    def say(self, text):
        if not self.options.json:
            print(text, flush=True)

    def map(self, function, jobs):
        """[function(job)] in the order of the jobs, as many at a time as --jobs says. Everything
        random in a job follows from its seed, so that the order of execution changes nothing."""
        jobs, done = list(jobs), []
        if self.options.jobs == 1:
            return [function(job) for job in jobs]
        with multiprocessing.get_context("fork").Pool(self.options.jobs) as pool:
            for result in pool.imap(function, jobs):
                done.append(result)
                if sys.stderr.isatty():
                    sys.stderr.write(f"\r{len(done)} of {len(jobs)} runs")
        if sys.stderr.isatty():
            sys.stderr.write("\r\x1b[K")
        return done

    def heading(self, text):
        self.say(f"\n{text}")
        self.page.append(f"<h2>{html.escape(text)}</h2>")

    def text(self, text):
        self.say(textwrap.fill(text, 100))
        self.page.append(f"<p>{html.escape(text)}</p>")

    def table(self, headings, rows):
        """Cells are texts; the first column is aligned left. JSON has figures by fact()."""
        rows = [[str(cell) for cell in row] for row in rows]
        widths = [max(map(len, column)) for column in zip(headings, *rows)]

        def line(cells):
            return "  ".join([cells[0].ljust(widths[0])]
                             + [cell.rjust(width) for cell, width in zip(cells[1:], widths[1:])])

        self.say("\n".join(["", line(list(headings)), line(["-" * width for width in widths]),
                            *(line(row).rstrip() for row in rows)]))
        heads = "".join(f"<th>{html.escape(heading)}</th>" for heading in headings)
        body = "".join("<tr>" + "".join(
            f'<td class="{cell if cell == "ok" else cell.lower() if cell == "MISSED" else ""}">'
            f"{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
        self.page.append(f'<div class="wide"><table><tr>{heads}</tr>{body}</table></div>')

    def figure(self, name, figure, caption):
        """A matplotlib figure, as OUTPUT/NAME.svg; closed afterwards."""
        import matplotlib.pyplot as plt
        self.options.output.mkdir(parents=True, exist_ok=True)
        figure.savefig(self.options.output / f"{name}.svg", bbox_inches="tight")
        plt.close(figure)
        caption = html.escape(caption)
        self.page.append(f'<figure><img src="{urllib.parse.quote(name)}.svg" alt="{caption}">'
                         f"<figcaption>{caption}</figcaption></figure>")

    def fact(self, name, value):
        """A figure, or a list of objects, under its name in the JSON object."""
        self.facts[name] = value

    def at_least(self, what, value, bar, error=math.nan, trials=None):
        """A bar: value, of a standard error, must reach it. trials: value is a share of so many."""
        self._bar(what, value, bar, error, trials, False)

    def at_most(self, what, value, bar, error=math.nan, trials=None):
        """A bar: value must not exceed it."""
        self._bar(what, value, bar, error, trials, True)

    def _bar(self, what, value, bar, error, trials, is_most):
        value, bar = float(value), float(bar)
        if trials:
            error = share_error(value, trials)
        held = value <= bar + 1e-9 if is_most else value >= bar - 1e-9  # rounding of sums of counts
        verdict = "ok" if held else "MISSED"
        rare = min(bar, 1 - bar) if trials else 0
        if trials and rare > 0 and trials * rare < TRIALS_MIN:
            verdict = f"needs {math.ceil(self.options.runs * TRIALS_MIN / (rare * trials))} runs"
        elif not held and abs(value - bar) <= STANDARD_ERRORS * error:
            factor = (STANDARD_ERRORS * error / abs(value - bar))**2
            verdict = f"within its error: {math.ceil(self.options.runs * factor)} runs decide"
        self.bars.append({
            "what": what, "value": value, "standard_error": None if math.isnan(error) else error,
            "at_most" if is_most else "at_least": bar, "held": held, "verdict": verdict
        })

    def close(self):
        """Prints the bars and writes the page; exit code 0, also where bars are missed."""
        held = sum(bar["held"] for bar in self.bars)
        undecided = sum(bar["verdict"] not in ("ok", "MISSED") for bar in self.bars)
        missed = sum(bar["verdict"] == "MISSED" for bar in self.bars)
        if self.bars:
            self.heading("What must hold")
            self.table(["what must hold", "measured", "+-", "bar", "verdict"], [
                [bar["what"], f"{bar['value']:.4g}",
                 "" if bar["standard_error"] is None else f"{bar['standard_error']:.2g}",
                 f"<= {bar['at_most']:.4g}" if "at_most" in bar else f">= {bar['at_least']:.4g}",
                 bar["verdict"]] for bar in self.bars])
            self.text(f"{held} bars held, {missed} missed, {undecided} undecided by so few runs")
        figures = json.dumps({
            "experiment": self.options.name, "runs": self.options.runs, "seed": self.options.seed,
            **self.facts, "bars": self.bars, "bars_held": held, "bars_missed": missed,
            "bars_undecided": undecided}, indent=1)
        if self.options.json:
            print(figures)
        self.options.output.mkdir(parents=True, exist_ok=True)
        (self.options.output / "figures.json").write_text(figures + "\n", encoding="utf-8")
        path = self.options.output / "index.html"
        part = path.with_suffix(".html.part")
        part.write_text(
            f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width">'
            f"<title>rhotrack: {html.escape(self.title)}</title>\n<style>{STYLE}</style></head>"
            f"<body>\n<h1>{html.escape(self.title)}</h1>\n" + "\n".join(self.page)
            + "\n</body></html>\n", encoding="utf-8")
        os.replace(part, path)
        self.say(f"\n{path}")
