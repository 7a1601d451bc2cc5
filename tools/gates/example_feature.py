#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the worked example of src/DESIGN.md, section "Where does my feature go?": its code blocks
are applied to a copy of the tree, the library is built from it, and the example's test program is
run, which must fail without the feature and pass with it.

A block ```c begins with a comment that names its file: `/* src/ROOM/NAME.c */` is a new file of the
library or the new text of one, `/* tests/NAME.c */` the test program. A block ```diff has the lines
--- a/FILE and +++ b/FILE, and hunks whose `@@` need no numbers: context and removed lines must
stand in the file once. The example has at most FILES_MAX files and ADDED_MAX added lines, its test
apart, and keeps to the table of rooms (layers.py). The test program is compiled and run as an
example of README.md is (extract_example.sh).

Usage: example_feature.py [DOCUMENT [FOLDER]]
FOLDER holds the copy and its objects, for a next run (default: a temporary one). Exit 1 where the
example does not hold; 2 where the document has no such section.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
HEADING = "Where does my feature go?"
COPIED = ["Makefile", "include", "src", "tools/gates", "tools/firmware/firmware.mk"]
FILES_MAX = 2
ADDED_MAX = 40


def fail(text):
    print(f"example of a feature: {text}")
    sys.exit(1)


def section_of(text):
    """The section's lines, at their places in the document: all others are empty."""
    lines, level = [], 0
    in_code = False
    for line in text.splitlines():
        in_code ^= line.startswith("```")
        heading = not in_code and re.match(r"(#+) +(.*)", line)
        if heading and heading[2].strip() == HEADING:
            level = len(heading[1])
        elif heading and len(heading[1]) <= level:
            level = 0
        lines.append(line if level else "")
    return lines if any(lines) else None


def blocks_of(lines):
    """(language, number of the first line, lines) of each code block."""
    begin = None
    for number, line in enumerate(lines):
        if line.startswith("```"):
            if begin is None:
                begin = number
            else:
                yield lines[begin][3:].strip(), begin + 1, lines[begin + 1:number]
                begin = None


def named_file(kind, number, block):
    """The file that a block is about."""
    pattern = r"/\* ((?:src|include|tests)/[\w/]+\.[ch]) \*/" if kind == "c" else r"--- a/(\S+)"
    found = block and re.match(pattern, block[0])
    if not found:
        fail(f"the block at line {number} names no file in its first line")
    if kind == "diff" and (len(block) < 2 or block[1] != f"+++ b/{found[1]}"):
        fail(f"the block at line {number} has no line +++ b/{found[1]}")
    return found[1]


def hunks_of(number, block):
    """(lines before, lines after) of each hunk of a diff."""
    hunks = []
    for line in block[2:]:
        if line.startswith("@@"):
            hunks.append(([], []))
        elif not hunks or line[:1] not in ("", " ", "-", "+"):
            fail(f"the block at line {number} is no diff: {line}")
        else:
            if line[:1] != "+":
                hunks[-1][0].append(line[1:])
            if line[:1] != "-":
                hunks[-1][1].append(line[1:])
    return hunks


def with_hunks(name, lines, hunks):
    """The file's lines with the hunks applied."""
    for before, after in hunks:
        places = [place for place in range(len(lines) - len(before) + 1)
                  if lines[place:place + len(before)] == before]
        if len(places) != 1:
            fail(f"{name} has {len(places)} places with the lines of a hunk: {before}")
        lines = lines[:places[0]] + after + lines[places[0] + len(before):]
    return lines


class Copy:
    """A copy of the tree's library."""

    def __init__(self, folder):
        self.folder = folder

    def write(self, name, text):
        """Only where it differs, so that make compiles no more than necessary."""
        path = self.folder / name
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")

    def restore(self):
        """Makes the copy equal to the tree."""
        names = set()
        for part in COPIED:
            paths = [ROOT / part] if (ROOT / part).is_file() else (ROOT / part).rglob("*.*")
            for path in paths:
                if path.is_file() and path.suffix != ".pyc":
                    names.add(path.relative_to(ROOT).as_posix())
        for name in names:
            self.write(name, (ROOT / name).read_text(encoding="utf-8"))
            (self.folder / name).chmod((ROOT / name).stat().st_mode)
        for part in ("include", "src"):
            for path in (self.folder / part).rglob("*.[ch]"):
                if path.relative_to(self.folder).as_posix() not in names:
                    path.unlink()

    def run(self, *command):
        """A command in the copy, as if no make had called this script."""
        kept = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")}
        return subprocess.run(command, cwd=self.folder, env=kept | {"BUILD": "build"},
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              check=False)

    def build(self):
        made = self.run("make", f"-j{os.cpu_count()}", "BUILD=build", "OPT=-O0", "lib")
        if made.returncode != 0:
            fail("the library does not build:\n" + made.stdout[-3000:])


def main():
    document = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "src/DESIGN.md")
    lines = section_of(document.read_text(encoding="utf-8"))
    if lines is None:
        print(f"example of a feature: {document.name} has no section \"{HEADING}\"")
        sys.exit(2)
    files, tests, added = {}, [""] * len(lines), 0
    for kind, number, block in blocks_of(lines):
        if kind not in ("c", "diff"):
            continue
        name = named_file(kind, number, block)
        if kind == "c" and name.startswith("tests/"):
            tests[number - 1:number + len(block) + 1] = lines[number - 1:number + len(block) + 1]
        else:
            files.setdefault(name, []).append((kind, number, block))
            added += sum(line.startswith("+") for line in block[2:]) if kind == "diff" else len(
                block) - 1
    if not any(tests):
        fail("no block is a test program, /* tests/NAME.c */")
    if not 1 <= len(files) <= FILES_MAX:
        fail(f"{len(files)} files, 1 to {FILES_MAX} are allowed: {', '.join(sorted(files))}")
    if added > ADDED_MAX:
        fail(f"{added} added lines, at most {ADDED_MAX}")

    with tempfile.TemporaryDirectory() as temporary:
        copy = Copy(pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else temporary).resolve())
        copy.restore()
        copy.write("DESIGN.md", "\n".join(tests) + "\n")
        test = ("tools/gates/extract_example.sh", "DESIGN.md", "build/librhotrack.a")
        copy.build()
        if copy.run(*test).returncode == 0:
            fail("its test passes without the feature")
        for name, parts in files.items():
            for kind, number, block in parts:
                if kind == "c":
                    copy.write(name, "\n".join(block[1:]) + "\n")
                else:
                    old = (copy.folder / name).read_text(encoding="utf-8").splitlines()
                    copy.write(name, "\n".join(with_hunks(name, old, hunks_of(number, block)))
                               + "\n")
        copy.build()
        checked = copy.run("tools/gates/layers.py", ".", "build")
        if checked.returncode != 0:
            fail("it breaks the table of rooms:\n" + checked.stdout)
        ran = copy.run(*test)
        if ran.returncode != 0:
            fail("its test fails with the feature:\n" + ran.stdout[-3000:])
    print(f"example of a feature: {len(files)} files, {added} added lines; its test passes with it "
          "and fails without")


if __name__ == "__main__":
    main()
