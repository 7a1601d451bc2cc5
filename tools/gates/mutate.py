#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Mutation test: changes each policy constant of the library (gates, decays, limits) by a factor of
two, and each comparison of a row number `>= 0` to `>= 1`, and lists the changes that no test
notices.

A constant is each `#define NAME number` of a room's table of policy, src/ROOM/policy.h, and each
`#define NAME number` or `static const` number elsewhere in src/ that is policy. There, constants
are left out that are none: magic numbers, bits, units, check sums, the coefficients of src/base,
floating point numbers of 1e12 and more, which only keep arithmetic finite. Those in ALIKE are left
out everywhere, as no test can notice them.

A mutant is noticed where it does not compile, a golden file differs, or a compiled test of `make
test` fails or times out; each twice, as tests may fail on a loaded machine. Where a program is
killed from outside, the run ends without a result. Programs that are the same bytes with the mutant
are not run. Mutants are tried in copies of the sources in BUILD/mutate, one copy for each of the
--jobs.

Usage: mutate.py [--sample N] [--seed S] [--only REGEX] [--jobs N]. Prints each mutant; exit 1 where
fewer than nine in ten are noticed. mutate.py --list [ROOT]: prints the mutants, and tries none.
"""
import argparse
import hashlib
import os
import pathlib
import queue
import random
import re
import shutil
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ["src", "include", "tools", "tests", "lcm_types", "Makefile"]
CONSTANT = re.compile(
    r"^(?:#define\s+(?P<define>\w+)|static const \w+ (?P<const>\w+) =)\s+"
    r"(?P<number>[0-9][0-9.]*(?:e[-+]?\d+)?)"
    r"(?P<suffix>[fuULl]*)(?=\s*(?:;|/\*|$))")
POLICY = re.compile(r"^#define\s+(?P<define>\w+)\s+\(?-?(?P<number>[0-9][0-9.]*(?:e[-+]?\d+)?)"
                    r"(?P<suffix>[fuULl]*)\)?(?=\s*(?:/\*|$))")
NO_POLICY = re.compile(
    r"MAGIC|VERSION|BITS|MASK|SHIFT|EXPONENT|_H$|PI\b|HALF|OFFSET|PRIME|POLYNOM|ROUNDING|EPSILON"
    r"|TURN_(HIGH|MIDDLE|LOW)|^SECOND_US$|^CHECK_(START|FACTOR)$|^NAT_PER_MNAT$|^M2_PER_KM2$")
GUARD_MIN = 1e12
# {room: constants that change only the time or stack of a call, not its result}: cost models that
# choose between two algorithms
ALIKE = {
    "papers": r"SPARSE_(CELLS|POINTS)$|PRUNED_VOTES$|PARTS$|ROWS_LEAST$|BINS_MIN$",
}
NO_POLICY_FILES = {
    "src/base/approx.c", "src/base/angle.c", "src/wire/message_types.c",
    "src/wire/message_names.c"
}
ROW = re.compile(r"\b(?P<name>(?:plot|row|claim|opened|claims\[\w+\])) >= (?P<number>0)\b")
NOTICED_MIN = 0.9
PROGRAMS = ["build/rhotrack", "build/rhotrack-lab"]
TIME_MAX_S = 600


def mutants_of(root):
    """(path, line number, name, match of the number, its new value) of every mutant."""
    for path in sorted(root.glob("src/*/*.[ch]")):
        name = str(path.relative_to(root))
        if name in NO_POLICY_FILES:
            continue
        for number, line in enumerate(path.read_text().splitlines()):
            found = constant_in(path, line)
            if found:
                for value in filter(None, (scaled_number(found, 2), scaled_number(found, 0.5))):
                    yield name, number, name_of(found), found, value
            for found in ROW.finditer(line):
                yield name, number, found["name"], found, "1"


def name_of(found):
    return found.groupdict().get("define") or found["const"]


def constant_in(path, line):
    """The match of a constant of policy in a line; None where there is none."""
    is_table = path.name == "policy.h"
    found = (POLICY if is_table else CONSTANT).match(line)
    if not found or float(found["number"]) == 0 or re.match(
            ALIKE.get(path.parent.name, "$^"), name_of(found)):
        return None
    is_guard = re.search("[.e]", found["number"]) and float(found["number"]) >= GUARD_MIN
    return found if is_table or not (is_guard or NO_POLICY.search(name_of(found))) else None


def scaled_number(found, factor):
    """The number times the factor, in the same type; None where an integer does not change."""
    if re.search("[.e]", found["number"]):
        value = f"{float(found['number']) * factor:.9g}"
        return value if re.search("[.e]", value) else value + ".0"
    value = int(int(found["number"]) * factor)
    return str(value) if value not in (0, int(found["number"])) else None


def told(mutant):
    name, line, constant, found, value = mutant
    return f"{name}:{line + 1}: {constant} {found['number']} -> {value}"


class SourceCopy:
    """A copy of the sources with its own build folder, in which mutants are tried."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        for name in FOLDERS:
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, folder / name, dirs_exist_ok=True,
                                copy_function=self.copy_if_different)
            else:
                self.copy_if_different(ROOT / name, folder / name)
        makefile = (folder / "Makefile").read_text()
        self.left_out = re.search(
            r"^left_out := ((?:.*\\\n)*.*)$", makefile, re.M)[1].replace("\\\n", "").split()
        self.bytes = {}  # hash of each program built from the unchanged sources
        what = self.noticed_by("base", "status")
        if what:
            sys.exit(f"mutate: {what} notices the sources without a change")
        self.bytes = {program: self.hash_of_program(program)
                      for program in PROGRAMS + self.all_test_programs()}

    @staticmethod
    def copy_if_different(source, target):
        """Copies a file only where it differs, so that make compiles no more than necessary."""
        if not pathlib.Path(target).exists() or pathlib.Path(source).read_bytes() != pathlib.Path(
                target).read_bytes():
            shutil.copyfile(source, target)
            shutil.copymode(source, target)

    def succeeds(self, *command):
        environment = os.environ | {
            "BUILD": "build", "RHOTRACK": str(self.folder / "build/rhotrack")
        }
        with subprocess.Popen(command, cwd=self.folder, env=environment, start_new_session=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            try:
                code = process.wait(TIME_MAX_S)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                return False
        if code in (-signal.SIGTERM, -signal.SIGKILL, -signal.SIGINT, -signal.SIGHUP):
            sys.exit(f"mutate: {command[0]} was killed")
        return code == 0

    def fails_twice(self, *command):
        return not self.succeeds(*command) and not self.succeeds(*command)

    def hash_of_program(self, program):
        return hashlib.sha256((self.folder / program).read_bytes()).digest()

    def is_program_changed(self, program):
        return self.hash_of_program(program) != self.bytes.get(program)

    def test_programs(self, *patterns):
        """Paths of the test programs whose sources match tests/PATTERN."""
        folder = self.folder / "tests"
        sources = sorted({path for pattern in patterns for path in folder.glob(pattern)})
        names = [str(path.relative_to(folder).with_suffix("")) for path in sources]
        return [f"build/tests/{self.profile_folder_of_test(name)}{name}" for name in names]

    def profile_folder_of_test(self, name):
        """Build folder of a test program: unit tests of modules that the embedded profile leaves
        out are built with the workstation profile."""
        if not name.startswith("unit/"):
            return ""
        is_left_out = name.removeprefix("unit/") in self.left_out
        return "workstation/" if is_left_out else "embedded/"

    def all_test_programs(self):
        return self.test_programs("unit/*/test_*.c", "tools/*/test_*.c", "scenario/test_*.c")

    def first_failing(self, programs):
        """The first of these programs that fails with the present sources ("the compiler" where one
        does not build); None where none fails."""
        if programs and self.fails_twice("make", "-k", *programs):
            return "the compiler"
        return next((program for program in filter(self.is_program_changed, programs)
                     if self.fails_twice(program)), None)

    def noticed_by(self, room, module):
        """The program that fails with the present sources; None where none does. The likeliest one
        is run first."""
        by = self.first_failing(self.test_programs(f"unit/{room}/test_{module}.c"))
        if by:
            return by
        if self.fails_twice("make", *PROGRAMS):
            return "the compiler"
        if any(map(self.is_program_changed, PROGRAMS)) and self.fails_twice(
                "tests/regression/golden.py", "--first"):
            return "the golden files"
        return (self.first_failing(self.test_programs(f"unit/{room}/test_*.c"))
                or self.first_failing(self.all_test_programs()))

    def try_mutant(self, name, line, found, value):
        """Applies the mutant, and returns the program that fails with it; None where none does."""
        path = self.folder / name
        text = path.read_text()
        lines = text.splitlines(keepends=True)
        first, last = found.span("number")
        lines[line] = lines[line][:first] + value + lines[line][last:]
        try:
            path.write_text("".join(lines))
            return self.noticed_by(path.parent.name, path.stem)
        finally:
            path.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sample", type=int, metavar="N", help="so many mutants, drawn at random")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", metavar="REGEX", help="files and names that match")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="at a time (default 1)")
    parser.add_argument("--list", type=pathlib.Path, nargs="?", const=ROOT, metavar="ROOT",
                        help="print the mutants only")
    options = parser.parse_args()
    mutants = [mutant for mutant in mutants_of(options.list or ROOT)
               if re.search(options.only, f"{mutant[0]} {mutant[2]}")]
    if options.sample and options.sample < len(mutants):
        mutants = sorted(
            random.Random(options.seed).sample(mutants, options.sample),
            key=lambda mutant: mutant[:2])
    if options.list:
        for mutant in mutants:
            print(told(mutant))
        return
    if not mutants:
        sys.exit("mutate: nothing matches")
    folder = ROOT / os.environ.get("BUILD", "build") / "mutate"
    trees = queue.SimpleQueue()

    def test_mutant(mutant):
        name, line, _, found, value = mutant
        tree = trees.get()
        try:
            by = tree.try_mutant(name, line, found, value)
        finally:
            trees.put(tree)
        print(f"{told(mutant)}: {by or 'NOT NOTICED'}", flush=True)
        return by is not None

    with ThreadPoolExecutor(options.jobs) as pool:
        for tree in pool.map(SourceCopy, (folder / str(job) for job in range(options.jobs))):
            trees.put(tree)
        noticed = sum(pool.map(test_mutant, mutants))
    print(f"{noticed} of {len(mutants)} mutants noticed")
    sys.exit(noticed < NOTICED_MIN * len(mutants))


if __name__ == "__main__":
    main()
