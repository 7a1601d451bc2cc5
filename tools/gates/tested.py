#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that each function of the public headers is named in a unit test of its room.

The functions are the global symbols of BUILD/embedded/src/ROOM that a header of include/rhotrack
declares. A test names a function where its preprocessed text contains the name, in
tests/unit/ROOM/*.c or in a header or macro of tests/ that it uses.

Usage: tested.py [ROOT [BUILD]]. Prints each function without a test; exit 1 where there is one.
BUILD: default $BUILD or build.
"""
import os
import pathlib
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

NAME = re.compile(r"\brho_\w+\b")


def public_functions(root, build):
    """{function: room} of all functions in the objects that a public header declares."""
    declared = set()
    for header in root.glob("include/rhotrack/**/*.h"):
        declared |= set(re.findall(r"\b(rho_\w+)\s*\(", header.read_text(encoding="utf-8")))
    functions = {}
    for folder in sorted((build / "embedded/src").iterdir()):
        objects = [path for path in sorted(folder.glob("*.o"))  # else of a file that was moved
                   if (root / "src" / folder.name / path.name).with_suffix(".c").is_file()]
        symbols = subprocess.run(["nm", "-g", "--defined-only", *objects], check=True,
                                 capture_output=True, text=True).stdout if objects else ""
        functions |= {
            name: folder.name
            for name in re.findall(r" T (rho_\w+)", symbols) if name in declared
        }
    return functions


def names_used_by_test(root, test):
    """The rho_ names in the preprocessed test, without those in the library's headers."""
    text = subprocess.run(
        [os.environ.get("CC", "cc"), "-E", "-D_GNU_SOURCE", "-Iinclude", "-Itests", "-Itests/unit",
         "-Isrc", "-I.", test], cwd=root, check=True, capture_output=True, text=True).stdout
    own, is_own = [], False
    for line in text.splitlines():
        marker = re.match(r'# \d+ "([^"]*)"', line)
        if marker:
            is_own = marker[1].startswith("tests/")
        elif is_own:
            own.append(line)
    return set(NAME.findall("\n".join(own)))


def names_used_by_room(root, room):
    tests = [str(test.relative_to(root)) for test in sorted(root.glob(f"tests/unit/{room}/*.c"))]
    return set().union(*(names_used_by_test(root, test) for test in tests))


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    build = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else os.environ.get("BUILD", "build"))
    functions = public_functions(root, build if build.is_absolute() else root / build)
    if not functions:
        sys.exit(f"tested: no objects in {build}/embedded/src")
    rooms = sorted(set(functions.values()))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        names = dict(zip(rooms, pool.map(lambda room: names_used_by_room(root, room), rooms)))
    missing = [(room, name) for name, room in sorted(functions.items()) if name not in names[room]]
    for room, name in sorted(missing):
        print(f"tests/unit/{room}: no test names {name}")
    print(f"{len(functions) - len(missing)} of {len(functions)} public functions are named in a "
          "test of their room")
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main()
