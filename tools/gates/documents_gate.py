#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the Markdown documents: number of words, width of lines, links, and that the files and
functions that they name exist; and the width of the code's lines, in all its languages.

Usage: documents_gate.py [FOLDER]
FOLDER has documents and code (default: this repository); the files that documents name are always
those of this repository. Prints a line for each fault; exit 1 if there is one.
"""
import pathlib
import re
import sys

HOME = pathlib.Path(__file__).resolve().parent.parent.parent
# Documents that are not checked: CHANGELOG names former files; measurements and the register of
# claims are generated, and tools/gates/papers_claims_register.py checks the latter.
NOT_WRITTEN = {"CHANGELOG.md", "tools/lab/CLAIMS.md", "tools/lab/MEASUREMENTS.md"}
# Most words of README.md (outside code and tables), of DESIGN.md, of all documents; most columns.
README_MOST, DESIGN_MOST, ALL_MOST, COLUMNS = 1200, 14000, 26000, 100
CODE = re.compile(r"\.(c|cpp|h|py|sh|bash|java|js|css|html|lcm|mk|cmake)$|^\.ci/run$"
                  r"|(^|/)(Makefile|CMakeLists\.txt)$")
# what is built, data, others' code
NO_CODE = re.compile(r"build[^/]*/|\.git/|tests/vectors/.*\.h|.*\.min\.js$")
FOREIGN = {
    "stdio.h", "stdbool.h", "stdlib.h", "stdint.h", "stddef.h", "string.h", "math.h", "errno.h",
    "limits.h", "float.h"
}
PLACEHOLDER = re.compile(r"[A-Z]{3,}")


def repository_files():
    """All files of the repository except build folders and .git."""
    return [path.relative_to(HOME).as_posix() for path in HOME.rglob("*")
            if path.is_file() and not re.match(r"build|\.git/", path.relative_to(HOME).as_posix())]


def prose_lines(text):
    """(number, line) of the lines outside code blocks and tables."""
    in_code = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            in_code = not in_code
        elif not in_code and not line.startswith("|"):
            yield number, line


def heading_anchors(text):
    """The anchors of the headings, as GitHub's links name them."""
    return {re.sub(r"[^\w\- ]", "", line.lstrip("# ").lower()).replace(" ", "-")
            for _, line in prose_lines(text) if line.startswith("#")}


def broken_links(folder, name, text):
    for number, line in prose_lines(text):
        for target in re.findall(r"\]\(([^)\s]+)\)", line):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            places = [
                root / pathlib.PurePath(name).parent / path if path else root / name
                for root in (folder, HOME)
            ]
            found = next((place for place in places if place.exists()), None)
            if found is None:
                yield f"{name}:{number}: no file {target}"
            elif anchor and anchor not in heading_anchors(found.read_text(encoding="utf-8")):
                yield f"{name}:{number}: no heading {target}"


def example_files(text):
    """Files that code blocks of the document contain, by the comments with which they begin."""
    return re.findall(r"^```c\n/\* (\S+) \*/$", text, re.MULTILINE)


def unknown_files(name, text, files):
    """A line for each source file that is named but does not exist; `_cases.c` may be the end of a
    name, FILE.c is a placeholder."""
    files = files + example_files(text)
    for number, line in enumerate(text.splitlines(), 1):
        line = re.sub(r"^(---|\+\+\+) [ab]/", r"\1 ", line)  # of a diff
        for found in re.findall(r"(?<![\w./*-])[\w./-]*\w\.(?:c|h|py|sh|bash)\b(?![\w/(])", line):
            end = found.lstrip("./") if found.startswith((".", "_")) else "/" + found
            if not PLACEHOLDER.search(found) and found not in FOREIGN and not any(
                    f"/{path}".endswith(end) for path in files):
                yield f"{name}:{number}: no file {found}"


def unknown_functions(name, text, names):
    if example_files(text):
        names = names | set(re.findall(r"^[+]?\w.*\b(rho_\w+)\(", text, re.MULTILINE))
    for number, line in enumerate(text.splitlines(), 1):
        for found in re.findall(r"\brho_\w*[a-z0-9]\b(?!_)", line):
            if found not in names:
                yield f"{name}:{number}: no function or type {found}"


def wide_lines_of_code(folder):
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if CODE.search(name) and not NO_CODE.match(name) and path.is_file():
            lines = path.read_text(encoding="utf-8").splitlines()
            yield from (f"{name}:{number}: {len(line)} columns"
                        for number, line in enumerate(lines, 1) if len(line) > COLUMNS)


def faults_of_documents(folder):
    files = repository_files()
    sources = [
        path for path in files
        if re.match(r"(include|src|tools|tests)/.*\.[ch]$|lcm_types/.*\.lcm$", path)
    ]
    names = {
        word
        for path in sources
        for word in re.findall(r"\brho_\w+", (HOME / path).read_text(encoding="utf-8"))
    }
    words = 0
    for path in sorted(folder.rglob("*.md")):
        name = path.relative_to(folder).as_posix()
        if re.match(r"build|\.git/", name) or name in NOT_WRITTEN:
            continue
        text = path.read_text(encoding="utf-8")
        length = len(text.split())
        words += length
        yield from broken_links(folder, name, text)
        yield from unknown_files(name, text, files)
        yield from unknown_functions(name, text, names)
        yield from (f"{name}:{number}: {len(line)} columns" for number, line in prose_lines(text)
                    if len(line) > COLUMNS)
        if name == "README.md":
            length = sum(len(line.split()) for _, line in prose_lines(text))
        most = {"README.md": README_MOST, "src/DESIGN.md": DESIGN_MOST}.get(name, ALL_MOST)
        if length > most:
            yield f"{name}: {length} words, at most {most}"
    if words > ALL_MOST:
        yield f"all documents: {words} words, at most {ALL_MOST}"


def main():
    folder = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else HOME
    found = [*faults_of_documents(folder), *wide_lines_of_code(folder)]
    print("\n".join(found) or "documents: lengths, links and names hold, and lines of code")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
