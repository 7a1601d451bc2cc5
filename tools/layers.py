#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks every #include of the library against the module table of src/DESIGN.md.

A module owns include/rhotrack/<module>.h, src/*/<module>.c and, where it has parts, src/*/<module>_<part>.[ch]. It may
include itself, the modules its row lists (`all above`: every earlier row; in its own folder their private headers, too),
from the fourth row on status, config and types, and the system headers below. Modules of the table that have no files yet are fine; files without a module are not.

Usage: layers.py [ROOT]. Prints FILE:LINE: what is wrong; exit 1 where anything is.
"""
import pathlib
import re
import sys

SYSTEM = {"float.h", "stdint.h", "stdbool.h", "stddef.h", "string.h", "math.h"}
COMMON = {"status", "config", "types"}
COMMON_FROM_ROW = 4


def read_table(path):
    """{module: modules it may include}, and what is wrong with the table itself, as (path, line, text)."""
    allowed, problems, in_section = {}, [], False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("#"):
            in_section = line.startswith("## Modules")
        row = re.match(r"\|\s*\d+\s*\|\s*`?(\w+)`?\s*\|.*\|([^|]*)\|\s*$", line)
        if not in_section or not row:
            continue
        module, listed = row.group(1), row.group(2).strip()
        if module in allowed:
            problems.append((path, number, f"module {module} has two rows"))
        if listed == "all above":
            may = set(allowed)
        else:
            may = set(re.findall(r"\w+", listed))
        for name in sorted(may - set(allowed)):
            problems.append((path, number, f"{module} may include {name}, which stands in no earlier row"))
        if len(allowed) + 1 >= COMMON_FROM_ROW:
            may |= COMMON
        allowed[module] = may
    if not allowed:
        problems.append((path, 1, "no module table under a heading `## Modules`"))
    return allowed, problems


def module_of(stem, modules):
    """The module that a file of this stem belongs to: its name, or its name and _part. None: no module's."""
    owners = [m for m in modules if stem == m or stem.startswith(m + "_")]
    return max(owners, key=len, default=None)


def includes_of(text):
    """(line, kind, name) of every #include, comments left out; kind is <, \" or empty (a macro)."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group())
    code = re.sub(r"/\*.*?\*/", blank, text, flags=re.DOTALL)
    for number, line in enumerate(code.splitlines(), 1):
        found = re.match(r"\s*#\s*include\s*([<\"]?)([^>\"\s]+)", line)
        if found:
            yield number, found.group(1), found.group(2)


def is_private_of(path, target, module, allowed):
    """The module's own private header, or that of a module it may include, in the same folder."""
    owner = module_of(target.stem, allowed)
    return owner == module or (owner in allowed[module] and (path.parent / target).is_file())


def check_file(path, root, allowed):
    """What is wrong with one file, as (path, line, text)."""
    module = module_of(path.stem, allowed)
    if module is None:
        yield path, 1, "belongs to no module of the table"
        return
    is_public = root / "include" in path.parents
    if is_public and path.stem != module:
        yield path, 1, f"public headers have a module's own name; a part of {module} belongs into src/"
    for number, kind, name in includes_of(path.read_text(encoding="utf-8")):
        target = pathlib.PurePosixPath(name)
        if kind == "<":
            if name not in SYSTEM:
                yield path, number, f"system header <{name}>"
        elif kind == "":
            if not (module == "config" and name == "RHO_CONFIG_FILE"):
                yield path, number, f"include of a macro, {name}"
        elif str(target.parent) == "rhotrack":
            if target.stem != module and target.stem not in allowed[module]:
                yield path, number, f"{module} may not include {target.stem}"
        elif is_public or not is_private_of(path, target, module, allowed):
            yield path, number, f"private header \"{name}\""


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    table = root / "src" / "DESIGN.md"
    if not table.is_file():
        sys.exit(f"layers: {table} with the module table is missing")
    allowed, problems = read_table(table)
    files = sorted([*root.glob("src/**/*.[ch]"), *root.glob("include/**/*.h")])
    for path in files:
        problems.extend(check_file(path, root, allowed))
    for path, number, text in problems:
        print(f"{path.relative_to(root)}:{number}: {text}")
    if problems:
        sys.exit(1)
    print(f"layers: {len(files)} files of {len(allowed)} modules keep to the table")


if __name__ == "__main__":
    main()
