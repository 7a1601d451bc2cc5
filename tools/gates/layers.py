#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks every #include of the library against the table of rooms in src/DESIGN.md, and the objects
for circular dependencies of files.

A room is a folder of src/. A public header (include/rhotrack/, include/rhotrack/detail/) belongs to
the room of the source, or the room itself, whose name is the header's or the longest with which the
header's begins; else to the one room whose sources' names begin with the header's; else to the
first room. A file may include the headers of its own room, those of the rooms that the table lists
for it (`all above`: every earlier row), a public header that declares a function which it defines,
private headers of its own folder, and the system headers below. A function must not contain an #if:
an option is an `if` on a constant, or a file that the build chooses.

Files that need one another, directly or through others, must not form a circle; such files are to
be merged, or their common part moved to a third file. Dependencies are read from the symbols of the
objects in BUILD/embedded/src and BUILD/program/tools/rhotrack. No object of the program may need
one of the lab, BUILD/program/tools/lab.

Usage: layers.py [ROOT [BUILD]]. Prints FILE:LINE: fault; exit 1 where there is any. BUILD: default
$BUILD or build; missing objects are not checked.
"""
import os
import pathlib
import re
import subprocess
import sys

SYSTEM = {"float.h", "stdint.h", "stdbool.h", "stddef.h", "string.h", "math.h"}
UMBRELLA = "rhotrack"  # rhotrack.h includes public headers of every room


def read_room_table(path):
    """{room: rooms it may include} from the table in DESIGN.md, and the table's own faults as
    (path, line, text)."""
    allowed, problems, in_section = {}, [], False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("#"):
            in_section = line.startswith("## Rooms")
        row = re.match(r"\|\s*`?src/(\w+)/?`?\s*\|.*\|([^|]*)\|\s*$", line)
        if not in_section or not row:
            continue
        room, listed = row.group(1), row.group(2).strip()
        if room in allowed:
            problems.append((path, number, f"room {room} has two rows"))
        may = set(allowed) if listed == "all above" else set(re.findall(r"\w+", listed))
        for name in sorted(may - set(allowed)):
            problems.append(
                (path, number, f"{room} may include {name}, which stands in no earlier row"))
        allowed[room] = may
    if not allowed:
        problems.append((path, 1, "no table of rooms under a heading `## Rooms`"))
    return allowed, problems


def list_includes(text):
    """(line, kind, name) of every #include outside comments; kind is <, \" or empty (a macro)."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group())
    code = re.sub(r"/\*.*?\*/", blank, text, flags=re.DOTALL)
    for number, line in enumerate(code.splitlines(), 1):
        found = re.match(r"\s*#\s*include\s*([<\"]?)([^>\"\s]+)", line)
        if found:
            yield number, found.group(1), found.group(2)


def conditionals_in_functions(text):
    """Line numbers of #if, #else and #endif within functions, whose braces are alone in the first
    column."""
    inside = False
    for number, line in enumerate(text.splitlines(), 1):
        inside = (inside or line == "{") and line != "}"
        if inside and re.match(r"\s*#\s*(if|el|endif)", line):
            yield number


def declares_function_of(header, text):
    """True where a header declares a function that the source `text` defines."""
    defined = re.findall(r"^\w[\w *]*?\b(rho_\w+)\([^;{]*\)\n\{", text, re.MULTILINE)
    declared = re.findall(r"\b(rho_\w+)\(", header.read_text(encoding="utf-8"))
    return not set(defined).isdisjoint(declared)


def faults_of_file(path, room, rooms, allowed, include):
    """Faults of one file's includes, as (path, line, text). rooms: {stem of a public header: its
    room}; include: the folder that contains rhotrack/."""
    if room not in allowed:
        yield path, 1, f"room {room} has no row in the table"
        return
    text = path.read_text(encoding="utf-8")
    for number in conditionals_in_functions(text):
        yield path, number, "#if inside a function"
    for number, kind, name in list_includes(text):
        target = pathlib.PurePosixPath(name)
        if kind == "<":
            if name not in SYSTEM:
                yield path, number, f"system header <{name}>"
        elif kind == "":
            if not (path.stem == "config" and name == "RHO_CONFIG_FILE"):
                yield path, number, f"include of a macro, {name}"
        elif target.parts[0] == "rhotrack":
            home = rooms.get(target.stem)
            if home is None or not (include / name).is_file():
                yield path, number, f"there is no header {name}"
            elif home != room and home not in allowed[room] and not (
                    path.suffix == ".c" and declares_function_of(include / name, text)):
                yield path, number, f"{room} may not include {name} of {home}"
        elif "include" in path.parts or not (path.parent / target).is_file():
            yield path, number, f"private header \"{name}\""
        elif len(target.parts) > 1 and (len(target.parts) != 3 or target.parts[0] != ".." or
                                        target.parts[1] not in allowed[room]):
            yield path, number, f"{room} may not include {name}"


class ObjectDependencies:
    """Which object files of some folders need symbols of which others."""

    def __init__(self, root, build, *folders):
        self.defined, self.undefined = {}, {}
        for folder in folders:
            for path in sorted((build / folder).rglob("*.o")):
                source = path.relative_to(build).with_suffix(".c")
                if (root / source).is_file():  # else the object is left over from a moved source
                    self.read_object(path, str(source))
        self.needs = {
            name: sorted({self.defined[symbol]
                          for symbol in symbols if symbol in self.defined} - {name})
            for name, symbols in self.undefined.items()
        }

    def read_object(self, path, name):
        self.undefined[name] = set()
        listed = subprocess.run(["nm", path], capture_output=True, text=True, check=True).stdout
        for words in map(str.split, listed.splitlines()):
            if words[0] == "U":
                self.undefined[name].add(words[1])
            elif words[1] in "TDBRVWC":
                self.defined[words[2]] = name

    def all_needed_by(self, name):
        """Every file that `name` needs, directly or through others."""
        found, waiting = set(), list(self.needs[name])
        while waiting:
            other = waiting.pop()
            if other not in found:
                found.add(other)
                waiting += self.needs[other]
        return found

    def circles(self):
        reached = {name: self.all_needed_by(name) for name in self.needs}
        found = {
            frozenset(other for other in reached[name] if name in reached[other])
            for name in reached
        }
        return sorted(sorted(circle) for circle in found if len(circle) > 1)

    def symbols_needed(self, name, other):
        return sorted(
            symbol for symbol in self.undefined[name] if self.defined.get(symbol) == other)


def faults_between_objects(root, build):
    """A line for each circle of object files, and for each that needs the lab."""
    library = ObjectDependencies(root, build / "embedded", "src")
    program = ObjectDependencies(root, build / "program", "tools/rhotrack", "tools/lab")
    for objects in (library, program):
        for circle in objects.circles():
            if not circle[0].startswith("tools/lab"):
                calls = [f"{name} needs {other} ({objects.symbols_needed(name, other)[0]})"
                         for name in circle for other in objects.needs[name] if other in circle]
                yield f"circle of {len(circle)} files: " + "; ".join(calls)
    for name, needs in program.needs.items():
        for other in needs:
            if name.startswith("tools/rhotrack") and other.startswith("tools/lab"):
                yield f"{name} needs {other} of the lab ({program.symbols_needed(name, other)[0]})"


def room_of_header(stem, sources):
    """Room of the source with the header's name, or with the longest name that the header's begins
    with, or of the sources whose names begin with the header's, where these are of one room."""
    names = [name for name in sources if stem == name or stem.startswith(name + "_")]
    if names:
        return sources[max(names, key=len)]
    rooms = {room for name, room in sources.items() if name.startswith(stem + "_")}
    return rooms.pop() if len(rooms) == 1 else None


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) >
                        1 else pathlib.Path(__file__).parent.parent.parent)
    table = root / "src" / "DESIGN.md"
    if not table.is_file():
        sys.exit(f"layers: {table} with the table of rooms is missing")
    allowed, problems = read_room_table(table)
    first = next(iter(allowed), None)
    sources = {room: room for room in allowed}
    sources |= {path.stem: path.parent.name for path in root.glob("src/*/*.c")}
    headers = sorted(root.glob("include/**/*.h"))
    rooms = {path.stem: room_of_header(path.stem, sources) or first for path in headers}
    files = sorted(root.glob("src/**/*.[ch]"))
    for path in files:
        problems.extend(faults_of_file(path, path.relative_to(root / "src").parts[0], rooms,
                                       allowed, root / "include"))
    for path in headers:
        if path.stem != UMBRELLA:
            problems.extend(
                faults_of_file(path, rooms[path.stem], rooms, allowed, root / "include"))
    for path, number, text in problems:
        print(f"{path.relative_to(root)}:{number}: {text}")
    between = list(
        faults_between_objects(
            root,
            pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else os.environ.get("BUILD", "build"))))
    for text in between:
        print(text)
    if problems or between:
        sys.exit(1)
    print(f"layers: {len(files) + len(headers)} files of {len(allowed)} rooms keep to the table")


if __name__ == "__main__":
    main()
