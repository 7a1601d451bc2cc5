#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Changes each policy constant of the library (gates, decays, limits) by a factor of two, and the
row from which a claim counts from 0 to 1, and says which change no test notices.

A constant is a `#define NAME number` or a `static const` number in src/. Constants that are no
policy are left out: magic numbers, bits, the coefficients of src/base, numbers of 1e6 and more,
which only keep arithmetic finite, and the cost models of ALIKE, which choose between two ways to
the same result. A mutant is noticed where
it does not compile, or a golden file differs, or a unit test of its room or of another one fails.
Each is tried in a copy of the sources, in BUILD/mutate.

Usage: mutate.py [--sample N] [--seed S] [--only REGEX]. Prints each mutant; exit 1 where fewer than nine in ten are noticed.
"""
import argparse
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ["src", "include", "tools", "tests", "lcm_types", "Makefile"]
CONSTANT = re.compile(
    r"^(?:#define\s+(?P<define>\w+)|static const \w+ (?P<const>\w+) =)\s+(?P<number>[0-9][0-9.]*(?:e[-+]?\d+)?)"
    r"(?P<suffix>[fuULl]*)(?=\s*(?:;|/\*|$))")
NO_POLICY = re.compile(
    r"MAGIC|VERSION|BITS|MASK|SHIFT|EXPONENT|_H$|PI\b|PER_|HALF|OFFSET|PRIME|POLYNOM|ROUND|EPSILON|TURN_(HIGH|MIDDLE|LOW)"
)
GUARD_MIN = 1e6
# file: constants by which only the time of a call changes
ALIKE = {
    "src/papers/accumulator_prune.c": r"WORK_|HALVINGS_MAX|_KEPT",
}
NO_POLICY_FILES = {
    "src/base/approx.c", "src/base/angle.c", "src/wire/message.c", "src/wire/message_names.c"
}
ROW = re.compile(r"\b(?P<name>(?:plot|row|claim|opened|claims\[\w+\])) >= (?P<number>0)\b")
NOTICED_MIN = 0.9


def mutants_of(root):
    """(path, line number, name, match of the number, its new value) of every mutant."""
    for path in sorted(root.glob("src/*/*.[ch]")):
        name = str(path.relative_to(root))
        if name in NO_POLICY_FILES:
            continue
        for number, line in enumerate(path.read_text().splitlines()):
            found = CONSTANT.match(line)
            constant = found and (found["define"] or found["const"])
            if found and is_policy(name, constant, float(found["number"])):
                for value in filter(None, (changed(found, 2), changed(found, 0.5))):
                    yield path, number, constant, found, value
            for found in ROW.finditer(line):
                yield path, number, found["name"], found, "1"


def is_policy(path, constant, number):
    return (number != 0 and number < GUARD_MIN and not NO_POLICY.search(constant)
            and not re.match(ALIKE.get(path, "$^"), constant))


def changed(found, factor):
    """The number times the factor, in the same type; None where an integer does not change."""
    if re.search("[.e]", found["number"]):
        value = f"{float(found['number']) * factor:.9g}"
        return value if re.search("[.e]", value) else value + ".0"
    value = int(int(found["number"]) * factor)
    return str(value) if value not in (0, int(found["number"])) else None


class Tree:
    """A copy of the sources with a build of its own."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        for name in FOLDERS:
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, folder / name, dirs_exist_ok=True,
                                copy_function=self.copy)
            else:
                self.copy(ROOT / name, folder / name)

    @staticmethod
    def copy(source, target):
        """Only what differs, so that make compiles no more than it must."""
        if not pathlib.Path(target).exists() or pathlib.Path(source).read_bytes() != pathlib.Path(
                target).read_bytes():
            shutil.copyfile(source, target)
            shutil.copymode(source, target)

    def run(self, *command):
        environment = os.environ | {
            "BUILD": "build", "RHOTRACK": str(self.folder / "build/rhotrack")
        }
        return subprocess.run(command, cwd=self.folder, env=environment, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, timeout=900).returncode == 0

    def unit_programs(self, room):
        tests = sorted((self.folder / "tests/unit").glob(f"{room}/test_*.c"))
        return [f"build/tests/embedded/unit/{test.parent.name}/{test.stem}" for test in tests]

    def noticed_by(self, room):
        """What notices the sources as they are now; None: nothing."""
        if not self.run("make", "-j2", "build/rhotrack", "build/rhotrack-lab"):
            return "the compiler"
        if not self.run("tests/regression/golden.py", "--first"):
            return "the golden files"
        for programs in (self.unit_programs(room), self.unit_programs("*")):
            if not self.run("make", "-j2", "-k", *programs):
                return "the compiler"
            failed = next((program for program in programs if not self.run(program)), None)
            if failed:
                return failed
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sample", type=int, metavar="N", help="so many mutants, drawn at random")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", metavar="REGEX", help="files and names that match")
    options = parser.parse_args()
    tree = Tree(ROOT / os.environ.get("BUILD", "build") / "mutate")
    mutants = [mutant for mutant in mutants_of(tree.folder)
               if re.search(options.only, f"{mutant[0].relative_to(tree.folder)} {mutant[2]}")]
    if options.sample and options.sample < len(mutants):
        mutants = sorted(
            random.Random(options.seed).sample(mutants, options.sample),
            key=lambda mutant: mutant[:2])
    if not mutants:
        sys.exit("mutate: nothing matches")
    what = tree.noticed_by("base")
    if what:
        sys.exit(f"mutate: {what} notices the sources without a change")
    noticed = 0
    for path, line, name, found, value in mutants:
        text = path.read_text()
        lines = text.splitlines(keepends=True)
        first, last = found.span("number")
        lines[line] = lines[line][:first] + value + lines[line][last:]
        try:
            path.write_text("".join(lines))
            by = tree.noticed_by(path.parent.name)
        finally:
            path.write_text(text)
        noticed += by is not None
        print(
            f"{path.relative_to(tree.folder)}:{line + 1}: {name} {found['number']} -> {value}: {by or 'NOT NOTICED'}",
            flush=True)
    print(f"{noticed} of {len(mutants)} mutants noticed")
    sys.exit(noticed < NOTICED_MIN * len(mutants))


if __name__ == "__main__":
    main()
