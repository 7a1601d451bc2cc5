#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the register of the papers' claims: the tables tools/lab/claims/*.ini are valid, each
file, function and test that they name exists, a row's test in C calls its code in src, and the page
tools/lab/CLAIMS.md has a verdict for each row.

Usage: papers_claims_register.py [TABLES [PAGE]]
Prints a line for each fault; exit 1 if there is one.
"""
import ast
import functools
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "lab"))
sys.dont_write_bytecode = True

from parts import read_claims as table

VERDICT = re.compile(r"\*\*(holds|differs|fails|cannot be known|definition|not measured)\*\*")


@functools.cache
def functions_in_file(file):
    """Names of the functions that a C or Python file defines (classes, too); None: no such file."""
    path = ROOT / file
    if not path.is_file():
        return None
    text = path.read_text(encoding="utf-8")
    if file.endswith(".py"):
        return {node.name for node in ast.walk(ast.parse(text))
                if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    return set(re.findall(r"^(?:[a-z_][\w \*]*?\b)?(\w+)\([^;{}]*\)\n?\s*\{", text, re.MULTILINE))


@functools.cache
def tests_in_file(file):
    """Names of the tests in a C or Python test file; None: no such file."""
    path = ROOT / file
    if not path.is_file():
        return None
    if file.endswith(".py"):
        return {name for name in functions_in_file(file) if name.startswith("test_")}
    return set(re.findall(r"cmocka_unit_test\w*\((\w+)", path.read_text(encoding="utf-8")))


@functools.cache
def words_of_test(file):
    """All words of a C test file and of the headers beside it that it includes."""
    text = (ROOT / file).read_text(encoding="utf-8")
    words = set(re.findall(r"\w+", text))
    for name in re.findall(r'#include "(\w+\.h)"', text):
        for path in (ROOT / "tests" / "unit").rglob(name):
            words |= words_of_test(path.relative_to(ROOT).as_posix())
    return words


@functools.cache
def called_in_src():
    """{function: words of its body} of the library."""
    words = {}
    for path in (ROOT / "src").rglob("*.c"):
        for name, body in re.findall(r"^[a-z][\w \*\n]*?\b(\w+)\([^;{}]*\)\n\{\n(.*?)^\}",
                                     path.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL):
            words.setdefault(name, set()).update(re.findall(r"\w+", body))
    return words


@functools.cache
def reached_by_test(file):
    """Functions of the library that a C test calls, by itself or through others."""
    reached, left = set(), words_of_test(file) & called_in_src().keys()
    while left:
        name = left.pop()
        reached.add(name)
        left |= called_in_src()[name] & called_in_src().keys() - reached
    return reached


def faults_of_row(row):
    for what, pairs, names in (("function", row.code, functions_in_file),
                               ("test", row.test, tests_in_file)):
        for file, name in pairs:
            if names(file) is None:
                yield f"{row.file}: [{row.name}]: no file {file}"
            elif name not in names(file):
                yield f"{row.file}: [{row.name}]: no {what} {name} in {file}"
    for file, name in row.code:
        if row.test and file.startswith("src/") and name in (functions_in_file(file) or ()) and (
                not any(of.endswith(".py") or name in reached_by_test(of)
                        for of, _ in row.test if tests_in_file(of) is not None)):
            yield f"{row.file}: [{row.name}]: no test of it calls {name} in {file}"


def faults_of_page(page, papers):
    """A line for each row of the tables that is not in the page, or has no verdict there. Rows are
    looked up by paper, as two papers have rows of the same name."""
    parts = dict(re.findall(r"^## (.*)\n((?:(?!## ).*\n)*)", page.read_text(encoding="utf-8"),
                            re.MULTILINE))
    name = page.name
    for paper in papers:
        lines = {line.split(" | ")[0][2:]: line for line in parts.get(paper.title, "").splitlines()
                 if line.startswith("| ")}
        for row in paper.rows:
            line = lines.get(row.name)
            if line is None:
                yield f"{name}: no row [{row.name}] of {paper.file}: rhotrack experiment claims"
            elif not VERDICT.search(line):
                yield f"{name}: row [{row.name}] of {paper.file} has no verdict"


def main():
    tables = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else table.FOLDER
    page = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT / "tools" / "lab" / "CLAIMS.md"
    try:
        papers = table.read_all(tables)
    except table.Fault as fault:
        sys.exit(f"claims: {fault}")
    rows = [row for paper in papers for row in paper.rows]
    found = [fault for row in rows for fault in faults_of_row(row)]
    found += faults_of_page(page, papers)
    print("\n".join(found) or f"claims: {len(rows)} rows name what exists, and have verdicts")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
