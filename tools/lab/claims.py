#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The register of claims: each equation, step, figure, table and number of the three papers beside
the code, the test, the figures of ours, and whether it holds.

Reads the tables tools/lab/claims/*.ini (read_claims.py says what stands in them),
runs the experiments papers-initiation, passive and maneuver and the tests that rows without figures
name, and writes OUTPUT/CLAIMS.md; with --update tools/lab/CLAIMS.md, the page that is kept.
"""
import importlib.util
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import textwrap
import unittest

from parts import read_claims as table
from common import experiment

RUNS = 50  # the paper's own number; passive has as many of its shares
EXPERIMENTS = {"papers-initiation": [], "maneuver": [],
               "passive": ["--part", "pruning", "paper", "claims"]}
PAGE = experiment.ROOT / "tools" / "lab" / "CLAIMS.md"
VERDICTS = ("holds", "differs", "fails", "cannot be known", "definition", "not measured")
GROUPS = (("Equations", "equation"), ("Steps", "step"), ("Figures", "figure"), ("Tables", "table"),
          ("Numbers and what else is said", ""))
HEAD = """\
# The papers' claims

Every equation, step, figure, table and number of the three papers that rhotrack grew from, and what
became of it. Written by `{command}` from the tables `tools/lab/claims/*.ini`; no verdict and no
figure of ours is entered by hand.

| verdict | meaning |
|---|---|
| holds | its figures meet its condition; without figures: it is computed so, and its tests passed |
| differs | the library computes something else, or nothing: what |
| fails | they do not: why, and at which noise it holds, if at any |
| cannot be known | the copy of the paper has lost what decides; behind it: what is taken instead |
| definition | nothing is computed from it |

To follow a row: its code and test are linked; `run` runs them (programs of tests: `make
test-programs`), or measures its figures; `see` is how to see it at work, in the list under the
paper's title. Figures are of {sources}. "Paper" is the paper's own value where it has one.

Live: `rhotrack node --pipeline paper --show ghosts,votes,hypotheses` runs the three papers' methods
on what `rhotrack publish FILE` plays in another terminal, a folder's plots.csv or bearings.csv of
the list; `make spy-run` shows what they think.

"""


# ---- figures ----


def experiment_folder(options, name):
    return (options.figures or options.output) / name


def run_experiment(options, name):
    words = [str(experiment.ROOT / "tools" / "lab" / f"{name.replace('-', '_')}.py"),
             *EXPERIMENTS[name], "--runs", str(options.runs), "--seed", str(options.seed), "--jobs",
             str(options.jobs), "--json", "-o", str(experiment_folder(options, name))]
    print(f"experiment {name}", file=sys.stderr, flush=True)
    done = subprocess.run([sys.executable, *words], stdout=subprocess.DEVNULL, check=False)
    if done.returncode:
        sys.exit(f"claims: {shlex.join(words)} ended with {done.returncode}")


def figures_of(options, papers):
    """{experiment: its figures.json} of all that the rows name."""
    from parts import claims_figures
    used = {of[1] for paper in papers for row in paper.rows for of in row.measured}
    used |= {row.at[1] for paper in papers for row in paper.rows if row.at}
    figures = {"own": claims_figures.figures()} if "own" in used else {}
    for name in EXPERIMENTS:
        if name in used:
            path = experiment_folder(options, name) / "figures.json"
            if not options.figures:
                run_experiment(options, name)
            elif not path.exists():
                sys.exit(f"claims: no {path} (rhotrack experiment {name})")
            figures[name] = json.loads(path.read_text(encoding="utf-8"))
    return figures


# ---- tests ----


def program_of(file):
    """The test program of tests/ROOM/test_X.c."""
    name = pathlib.PurePath(file).relative_to("tests").with_suffix("")
    return experiment.BUILD / "tests" / "embedded" / name


def results_in_c(files):
    """{(file, test): passed} of CMocka programs."""
    programs = {file: program_of(file) for file in files}
    if programs:
        build, *wanted = (os.path.relpath(path, experiment.ROOT)
                          for path in (experiment.BUILD, *programs.values()))
        subprocess.run(["make", "-s", "-C", experiment.ROOT, f"BUILD={build}", *wanted], check=True,
                       stdout=subprocess.DEVNULL)
    results = {}
    for file, program in programs.items():
        done = subprocess.run([program], capture_output=True, text=True, check=False,
                              cwd=experiment.ROOT)
        for verdict, test in re.findall(r"^\[  (     OK|FAILED ) \] (\w+)",
                                        done.stdout + done.stderr, re.MULTILINE):
            results[file, test] = verdict.strip() == "OK"
    return results


def results_in_python(tests):
    """The same of unittest files, of which only the named tests run."""
    sys.path.insert(0, str(experiment.ROOT / "tests" / "lab"))
    results = {}
    for file in sorted({file for file, _ in tests}):
        spec = importlib.util.spec_from_file_location(pathlib.PurePath(file).stem,
                                                      experiment.ROOT / file)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        wanted = {test for of, test in tests if of == file}
        suite = unittest.TestSuite(
            case for group in unittest.defaultTestLoader.loadTestsFromModule(module)
            for case in group if case.id().rsplit(".", 1)[1] in wanted)
        names = {case: case.id().rsplit(".", 1)[1] for case in suite}
        found = suite.run(unittest.TestResult())
        bad = {case.id() for case, _ in found.failures + found.errors}
        results |= {(file, name): case.id() not in bad and not any(
            one.startswith("setUpClass") for one in bad) for case, name in names.items()}
    return results


def results_of(papers):
    tests = {test for paper in papers for row in paper.rows
             if not row.measured for test in row.test}
    print(f"{len(tests)} tests", file=sys.stderr, flush=True)
    in_c = {test for test in tests if test[0].endswith(".c")}
    return results_in_c(sorted({file for file, _ in in_c})) | results_in_python(tests - in_c)


# ---- verdicts ----


def judged_row(row, figures, results):
    """(verdict, our figures as text, reason)."""
    values = {name: table.figure(row, figures, of, path) for name, of, path in row.measured}
    unknown = [name for name, value in values.items() if value is None]
    ours, why = row.texts.get("shown", ""), row.texts.get("why", "")
    if "definition" in row.texts:
        return "definition", "", row.texts["definition"]
    if unknown:
        return "not measured", "", f"no run had a figure for {', '.join(unknown)}"
    ours = ours.format(**values)
    if "lost" in row.texts:
        ours = ours or tests_passed_text(row, results)
        return "cannot be known", ours, f"lost: {row.texts['lost']}"
    if row.measured:
        held = table.is_true(row.texts["holds"], values)
        where = table.where_else(row, figures) if row.at else ""
        return "holds" if held else "fails", ours, "; ".join(part for part in (why, where) if part)
    failed = [test for test in row.test if not results.get(test)]
    if "differs" in row.texts and not failed:
        return "differs", tests_passed_text(row, results), row.texts["differs"]
    if failed:
        return "fails", "", f"its test {failed[0][1]} does not pass"
    return "holds", tests_passed_text(row, results), why


def tests_passed_text(row, results):
    passed = sum(bool(results.get(test)) for test in row.test)
    return f"{passed} of {len(row.test)} tests pass" if row.test else ""


# ---- the page ----


def escaped_cell(text):
    return " ".join(text.split()).replace("|", "\\|")


def linked(pairs):
    return "<br>".join(f"[{name}](../../{file})" for file, name in pairs)


def command_of(row):
    """What runs it."""
    if row.measured:
        names = dict.fromkeys("claims" if of == "own" else of for _, of, _ in row.measured)
        return "<br>".join(f"`rhotrack experiment {name}`" for name in names)
    files = dict.fromkeys(file for file, _ in row.test)
    return "<br>".join(
        f"`tests/run.sh build/{program_of(file).relative_to(experiment.BUILD)}`"
        if file.endswith(".c")
        else f"`{file} -k {next(test for of, test in row.test if of == file)}`" for file in files)


def shown_of_row(paper, row):
    return ", ".join(name for name, _, _, begins in paper.see
                     if any(file.startswith(tuple(begins)) for file, _ in row.code))


def group_of_row(row):
    word = row.name.split()[0].rstrip("s:")
    return next(i for i, (_, begins) in enumerate(GROUPS) if word == begins or not begins)


def table_line(paper, row, verdict, ours, reason):
    cells = [row.name, row.says, linked(row.code), linked(row.test), command_of(row),
             shown_of_row(paper, row), row.texts.get("paper", ""), ours,
             f"**{verdict}**" + (f": {reason}" if reason else "")]
    return "| " + " | ".join(escaped_cell(text) for text in cells) + " |"


def sources_of(options, figures):
    names = [f"`rhotrack experiment {name}` ({of['runs']} runs from seed {of['seed']})"
             for name, of in figures.items() if name != "own"]
    how = ("as they were last run, which [the measurements](MEASUREMENTS.md) show, too"
           if options.figures else "which this command ran")
    return f"{', '.join(names)}, {how}; `claims` itself has those of " \
           "`tools/lab/parts/claims_figures.py`"


def wrapped_paragraphs(text, **values):
    """The text's paragraphs in lines of the page's width, but for tables."""
    return "\n\n".join(part if part.startswith("|") else textwrap.fill(
        part.format(**values), 100, break_long_words=False, break_on_hyphens=False)
        for part in text.strip().split("\n\n")) + "\n\n"


def page_of(options, papers, figures, results):
    """The page, and {verdict: count}."""
    judgements = [[(row, *judged_row(row, figures, results)) for row in paper.rows]
                  for paper in papers]
    counts = [{verdict: sum(of[1] == verdict for of in rows) for verdict in VERDICTS}
              for rows in judgements]
    total = {verdict: sum(count[verdict] for count in counts) for verdict in VERDICTS}
    shown = [verdict for verdict in VERDICTS if total[verdict] or verdict != "not measured"]
    lines = [wrapped_paragraphs(HEAD, command=" ".join(["rhotrack experiment claims", *(
        ["--figures", os.path.relpath(options.figures, experiment.ROOT)]
        if options.figures else []),
        "--update"]),
                         sources=sources_of(options, figures)),
             f"| paper | rows | {' | '.join(shown)} |\n|---|{'---|' * (len(shown) + 1)}\n"]
    lines += [f"| {name} | {sum(count.values())} | "
              f"{' | '.join(str(count[verdict]) for verdict in shown)} |\n"
              for name, count in [*zip((paper.title for paper in papers), counts),
                                  ("all", total)]]
    for paper, rows in zip(papers, judgements):
        lines.append(f"\n## {paper.title}\n\n{wrapped_paragraphs(paper.by)}")
        lines.append("| | see it | command |\n|---|---|---|\n")
        lines += [f"| {name} | {escaped_cell(what)} | `{escaped_cell(command)}` |\n"
                  for name, what, command, _ in paper.see]
        for number, (heading, _) in enumerate(GROUPS):
            of_group = [of for of in rows if group_of_row(of[0]) == number]
            if of_group:
                lines.append(f"\n### {heading}\n\n| | it says | code | test | run | see | paper | "
                             f"ours | verdict |\n|{'---|' * 9}\n")
                lines += [table_line(paper, *of) + "\n" for of in of_group]
    return "".join(lines), total


def add_options(parser):
    parser.add_argument("--tables", type=pathlib.Path, metavar="FOLDER", default=table.FOLDER,
                        help="of the tables (default tools/lab/claims)")
    parser.add_argument("--figures", type=pathlib.Path, metavar="FOLDER",
                        help="take FOLDER/EXPERIMENT/figures.json of former runs, as in "
                        "build/experiment, instead of running the experiments")
    parser.add_argument("--update", action="store_true", help="write tools/lab/CLAIMS.md")


def main():
    options = experiment.options_of(__doc__, RUNS, add_options)
    try:
        papers = table.read_all(options.tables)
        figures = figures_of(options, papers)
        page, total = page_of(options, papers, figures, results_of(papers))
    except table.Fault as fault:
        sys.exit(f"claims: {fault}")
    path = PAGE if options.update else options.output / "CLAIMS.md"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(page, encoding="utf-8")
    if options.json:
        print(json.dumps({"experiment": options.name, "runs": options.runs, "seed": options.seed,
                          **total}, indent=1))
    else:
        print(", ".join(f"{count} {verdict}" for verdict, count in total.items()) + f"\n{path}")


if __name__ == "__main__":
    main()
