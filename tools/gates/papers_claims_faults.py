#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether the tests of the papers' register say what they must: each function in src that a row of
tools/lab/claims/*.ini names is emptied in turn (it returns 0), and a test in C of that row has to
fail. Rows whose tests are in Python alone are left out.

Usage: papers_claims_faults.py [--only REGEX] [--tables FOLDER] [--jobs N]; BUILD (default build)
has the library. Prints a line for each row whose tests do not notice; exit 1 if there is one.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import papers_claims_register as register

ROOT = register.ROOT
BUILD = ROOT / os.environ.get("BUILD", "build")
FLAGS = ["-std=c11", "-D_GNU_SOURCE", "-O1", "-w", "-ffp-contract=off",
         *(f"-I{ROOT / name}" for name in ("include", "tests", "tests/unit", "src"))]
SECONDS_MAX = 120  # an emptied function may keep a loop going


def emptied(text, name):
    """The source with nothing in this function; None where it has no such function."""
    found = re.search(rf"^(?P<kind>[a-z][\w \*\n]*?)\b{name}\([^;{{}}]*\)\n\{{\n(?P<body>.*?)^\}}",
                      text, re.MULTILINE | re.DOTALL)
    if not found:
        return None
    kind = re.sub(r"\b(static|inline|RHO_MUST_CHECK)\b", "", found["kind"]).strip()
    value = "" if kind == "void" else f" ({kind}){{0}}" if kind.startswith("struct") else " 0"
    begin, end = found.span("body")
    return f"{text[:begin]}    return{value};\n{text[end:]}"


def run(*command):
    try:
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False,
                              timeout=SECONDS_MAX)
    except subprocess.TimeoutExpired:
        return None


def compiled(source, target, *flags):
    done = run("gcc", *FLAGS, *flags, "-c", "-o", target, source)
    if done is None or done.returncode:
        sys.exit(f"papers_claims_faults: {source} does not compile: {done and done.stderr}")
    return target


def failed_tests(test, mutant):
    """Names of the tests of an object that fail with another one in the library's place; None: the
    program does not end."""
    program = mutant.with_name(test.stem)
    done = run("gcc", "-o", program, test, mutant, BUILD / "librhotrack.a", "-lcmocka", "-lm")
    if done is None or done.returncode:
        sys.exit(f"papers_claims_faults: {test.stem} does not link: {done and done.stderr}")
    done = run(program)
    return None if done is None else set(
        re.findall(r"\[  FAILED  \] (?:\w+: )?(\w+)", done.stdout + done.stderr))


def tests_in_c(row):
    return [test for test in row.test if test[0].endswith(".c")]


def unnoticed(function, rows, objects):
    """Lines of the rows whose tests pass although the function is empty."""
    file, name = function
    text = emptied((ROOT / file).read_text(encoding="utf-8"), name)
    if text is None:
        return [f"{file}: no function {name}"]
    with tempfile.TemporaryDirectory(prefix="claims-") as folder:
        source = pathlib.Path(folder) / "source.c"
        source.write_text(text, encoding="utf-8")
        mutant = compiled(source, source.with_suffix(".o"), f"-I{(ROOT / file).parent}")
        failed = {of: failed_tests(objects[of], mutant)
                  for of in {of for row in rows for of, _ in tests_in_c(row)}}
    return [f"{row.file}: [{row.name}]: no test of it fails where {name} in {file} is empty"
            for row in rows if not any(failed[of] is None or test in failed[of]
                                       for of, test in tests_in_c(row))]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--only", default="", metavar="REGEX", help="functions of these names")
    parser.add_argument("--tables", type=pathlib.Path, default=register.table.FOLDER)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    by_function = {}
    for paper in register.table.read_all(options.tables):
        for row in filter(tests_in_c, paper.rows):
            for file, name in row.code:
                if file.startswith("src/") and re.search(options.only, name):
                    by_function.setdefault((file, name), []).append(row)
    files = {of for rows in by_function.values() for row in rows for of, _ in tests_in_c(row)}
    with (tempfile.TemporaryDirectory(prefix="claims-") as folder,
          ThreadPoolExecutor(options.jobs) as pool):
        objects = dict(zip(files, pool.map(lambda of: compiled(
            ROOT / of, pathlib.Path(folder) / f"{pathlib.Path(of).stem}.o"), files)))
        found = [line for lines in pool.map(
            lambda item: unnoticed(*item, objects), by_function.items()) for line in lines]
    print("\n".join(found) or f"claims: {len(by_function)} functions emptied, each is noticed")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
