#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes sections of tools/lab/MEASUREMENTS.md, the page of all measured figures.

Usage: update_measurements_page.py [--program PATH] [--page FILE] [--runs N] NAME...
       COMMAND | update_measurements_page.py --standard-input NAME
A section stands between `<!-- NAME: written by COMMAND -->` and `<!-- end of NAME -->`. The script
runs COMMAND and puts its output into the section, as it is; PATH stands for build/rhotrack-lab, and
--runs N are other runs than an experiment's own number. A section that another script writes
(sizes, load, worst) is taken from standard input.
"""
import argparse
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

HOME = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = HOME / "tools" / "lab" / "MEASUREMENTS.md"
WRITERS = {"make", "tests/firmware/load.sh",
           "tests/firmware/worst.sh"}  # they hand their section over by themselves


def find(page, name):
    """The text between the section's two marks in the page, and the command that the first mark
    names."""
    found = re.search(
        rf"<!-- {re.escape(name)}: written by (.*) -->\n(.*?)<!-- end of {re.escape(name)} -->\n",
        page, re.DOTALL)
    if found is None:
        sys.exit(f"measurements: no place for `{name}`")
    return found.span(2), found.group(1)


def section(page, name):
    """What a section holds."""
    (start, end), _ = find(page, name)
    return page[start:end]


def replaced(page, name, text):
    """The page with another text in the section."""
    (start, end), _ = find(page, name)
    return page[:start] + text + page[end:]


def printed(command, program, options):
    """What the section's command prints, as a block."""
    words = shlex.split(command)
    if words[0] in WRITERS:
        sys.exit(f"measurements: `{command}` writes this section itself")
    with tempfile.TemporaryDirectory() as folder:
        if words[0] == "build/rhotrack-lab":
            words = [
                program, *words[1:], *options,
                *(["-o", folder + "/out"] if words[1] == "experiment" else [])
            ]
        elif words[0].startswith("tools/lab/"):
            words += [*options, "-o", folder + "/out"]
        done = subprocess.run(words, stdout=subprocess.PIPE, text=True, check=False, cwd=HOME)
    if done.returncode not in (0, 1) or not done.stdout:  # 1: a bar is missed, which the tables say
        sys.exit(f"measurements: `{command}` ended with {done.returncode}")
    lines = "\n".join(line.rstrip().replace(folder, "build") for line in done.stdout.splitlines())
    return f"\n```\n{lines}\n```\n\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=HOME / "build" / "rhotrack-lab")
    parser.add_argument("--page", type=pathlib.Path, default=PAGE)
    parser.add_argument("--runs")
    parser.add_argument("--standard-input", action="store_true")
    parser.add_argument("names", nargs="+", metavar="NAME")
    options = parser.parse_args()
    runs = ["--runs", options.runs] if options.runs else []
    for name in options.names:
        _, command = find(options.page.read_text(encoding="utf-8"), name)
        text = sys.stdin.read() if options.standard_input else printed(
            command, options.program, runs)
        page = options.page.read_text(encoding="utf-8")  # again: an experiment takes minutes
        options.page.write_text(replaced(page, name, text), encoding="utf-8")


if __name__ == "__main__":
    main()
