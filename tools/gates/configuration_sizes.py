#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints flash and RAM of a configuration (`make budget`): links two small programs with the
library, without unused code, and reads the linker's map.

  stepped   tools/firmware/budget/size_tracker.c: the caller makes the scans
  LCM node  tools/firmware/budget/size_node.c: LCM datagrams in, tracks out

Start-up, drivers and C library are not counted. Objects that neither program uses (passive sensors
without messages, the papers' methods) cost nothing until a program defines them.

Usage: configuration_sizes.py [--config FILE] [--cc COMPILER] [--flags FLAGS]
FILE is RHO_CONFIG_FILE, the capacities (default: the embedded profile). Exit 2 where it is missing,
or has a macro that is unknown or out of range.
"""
import argparse
import difflib
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import cross_compile as cross
import stack

FIRMWARE = pathlib.Path("tools/firmware")
PROGRAMS = {"stepped": [FIRMWARE / "budget/size_tracker.c"],
            "LCM node": [FIRMWARE / "budget/size_node.c",
                         FIRMWARE / "lcm_datagram_node.c"]}
MEMORY = FIRMWARE / "board/memory.c"
FLASH = re.compile(r"\.(text|rodata|data|sdata|srodata|literal|ARM\.ex)")
RAM = re.compile(r"\.(data|sdata|bss|sbss|COMMON)")

# {object: its large members, each with the macros that determine its size}
PARTS = {
    "tracker": ("hypotheses RHO_MAX_HYPOTHESES", "tracks RHO_MAX_TRACKS",
                "clutter_map RHO_MAX_ECHOES", "assignment RHO_MAX_TRACKS",
                "sensors RHO_MAX_SENSORS", "strips RHO_PLOT_STRIPS", "bodies RHO_BODIES"),
    "initiator": ("window RHO_MAX_SCANS RHO_MAX_PLOTS", "candidates RHO_MAX_CANDIDATES",
                  "density RHO_MAX_DENSITY_CELLS", "memory RHO_MAX_CLUTTER_CELLS"),
    "report": ("tracks RHO_MAX_TRACKS", "fates RHO_MAX_PLOTS"),
    "scan_assembler": ("slots RHO_MAX_OPEN_SCANS RHO_MAX_PLOTS", "known RHO_MAX_SENSORS"),
}
WHOLE = {"passive": "RHO_SCAN_KINDS", "frames": "RHO_SCAN_KINDS", "plots": "RHO_MAX_PLOTS",
         "zones": "RHO_MAX_ZONES"}
# {variable in the programs: its struct, where the names differ}
CALLED = {"assembler": "scan_assembler"}
# {folder of src/: macros that make its code smaller}
ROOMS = {
    "src/initiation": "RHO_SEARCHES RHO_MAX_ECHOES", "src/association": "RHO_FILTERS",
    "src/estimation": "RHO_FILTERS", "src/base": "RHO_FAST_UPDATES",
    "src/tracker": "RHO_SECTORS RHO_MAX_ECHOES",
    "src/step": "RHO_SECTORS RHO_SHARES_PLOTS", "src/bearings": "RHO_SCAN_KINDS",
    "src/wire": "RHO_SCAN_KINDS", "src/window": "RHO_SEARCHES",
    "src/node": "RHO_SCAN_KINDS RHO_MAX_ZONES", "src/measurement": "RHO_DOPPLER_NOTCH",
    "src/papers": "RHO_FILTERS",
}
# {part of a node that is listed as an object of its own: its size}
NODE = {
    "tracker": "sizeof(struct rho_tracker)",
    "initiator": "(RHO_SEARCHES) * sizeof(struct rho_initiator)",
    "report": "sizeof(struct rho_report)",
    "scan_assembler": "sizeof(struct rho_scan_assembler)",
    "passive": "RHO_NODE_HAS_PASSIVE * sizeof(struct rho_passive)",
    "zones": "(RHO_MAX_ZONES > 0) * sizeof(struct rho_zones)",
}
LEAST = 512 # bytes from which a part is listed


def exit_with_error(message):
    print(f"budget: {message}", file=sys.stderr)
    sys.exit(2)


class Compiler(cross.Target):
    """The user's compiler, which must accept gcc's options and link with GNU ld."""

    def __init__(self, command, flags):
        super().__init__("own", "", flags)
        self.command = shlex.split(command)
        if not self.command or not shutil.which(self.command[0]):
            exit_with_error(
                f"no {command or 'compiler'} here; CROSS=PREFIX- or CC=COMPILER names another "
                "one (tools/setup.sh firmware installs arm-none-eabi-gcc)")
        self.graph = cross.GRAPH if self.accepts_flags(cross.GRAPH) else ""

    def run(self, arguments, **options):
        return subprocess.run([*self.command, *arguments], capture_output=True, text=True,
                              errors="replace", check=False, **options)

    def accepts_flags(self, flags):
        made = str(cross.cross_folder() / "taken.o")
        return self.run([*flags.split(), "-Werror", "-x", "c", "-c", "-o", made, "-"],
                        input="int i;").returncode == 0

    def tool(self, name):
        if name == "gcc":
            return self.command[0]
        return self.run([f"-print-prog-name={name}"]).stdout.strip()

    def version(self):
        return self.run(["--version"]).stdout.splitlines()[0]


def known_macros():
    """Names of the macros that a configuration may set, from config.h."""
    text = pathlib.Path("include/rhotrack/config.h").read_text(encoding="utf-8")
    return {*re.findall(r"^#ifndef (RHO_\w+)", text, re.MULTILINE), "RHO_PROFILE_WORKSTATION"}


def macro_definitions(config):
    """(line, name, value) of the macros that the file defines outside comments."""
    pattern = re.compile(r"\s*#\s*define\s+(\w+)\b\s*(.*?)\s*(//.*)?$")
    text = re.sub(r"/\*.*?\*/", lambda found: "\n" * found[0].count("\n") or " ",
                  config.read_text(encoding="utf-8", errors="replace"), flags=re.S)
    for number, line in enumerate(text.split("\n"), 1):
        found = pattern.match(line)
        if found:
            yield number, found[1], found[2]


def check_macro_names(config, said):
    """Exits with an error where the file defines an RHO_ macro that config.h does not know."""
    known = known_macros()
    for number, name, value in macro_definitions(config):
        if name.startswith("RHO_") and value and name not in known:
            near = difflib.get_close_matches(name, known, 1)
            exit_with_error(f"{said}:{number}: config.h has no {name}" +
                   (f"; the nearest is {near[0]}" if near else ""))


def check_macro_ranges(compiler, flags, config, said):
    """Compiles config.h, and returns all macros with their values; exits with an error, naming the
    line of the file, where a macro is out of its range."""
    reading = [*flags, "-Iinclude", "-x", "c", "-"]
    done = compiler.run(["-fsyntax-only", *reading], input='#include "rhotrack/config.h"\n')
    if done.returncode == 0:
        return compiler.run(["-E", "-dM", *reading], input='#include "rhotrack/config.h"\n').stdout
    # the text appears in gcc's message and in the source line that it shows: keep one
    wrong = dict.fromkeys(
        re.findall(r'#error "?((RHO_\w+) must be [^"\n]*)', done.stderr) +
        [(f"{name} must be {least} .. {most}", name) for name, least, most in re.findall(
            r"(RHO_\w+)_must_be_(\d+)_to_(\d+)", done.stderr)])
    places = {name: f"{said}:{number}: {name} is {value}"
              for number, name, value in (macro_definitions(config) if config else ())}
    for text, name in wrong:
        print(f"budget: {places.get(name, 'flags')}: {text}", file=sys.stderr)
    if not wrong:
        print(done.stderr, end="", file=sys.stderr)
    sys.exit(2)


def linked_sections(text):
    """(section, bytes, object file) of each entry that the linker kept, from its map."""
    kept = text.split("Linker script and memory map", 1)[-1]
    for section, size, made in re.findall(
            r"^ (\.\S+|COMMON)\s+0x[0-9a-f]+\s+0x([0-9a-f]+) (\S.*)$", kept, re.MULTILINE):
        yield section if section != "COMMON" else ".COMMON", int(size, 16), made


class LinkedProgram:
    """A linked program with its flash by room (folder of src/) and its RAM by object."""

    def __init__(self, name, build, flags):
        folder = build.folder / name.replace(" ", "_")
        folder.mkdir(exist_ok=True)
        made = [str(path) for path in build.objects.values()]
        for source in [*PROGRAMS[name], MEMORY]:
            made.append(str(folder / f"{source.parent.name}_{source.stem}.o"))
            more = ["-fno-builtin"] if source == MEMORY else []
            cross.run_or_exit([*build.target.command, *flags, *more, "-std=c99", "-Iinclude",
                          f"-I{FIRMWARE}", "-c", "-o", made[-1], str(source)])
        chart = folder / "map"
        cross.run_or_exit([*build.target.command, *flags, "-nostdlib", "-nostartfiles", "-static",
                      "-Wl,--gc-sections", f"-Wl,-Map={chart}", f"-T{FIRMWARE / 'budget/link.ld'}",
                      "-o", str(folder / "program"), *made, "-lgcc"])
        self.flash, self.ram = {}, {}
        for section, size, at in linked_sections(chart.read_text(encoding="utf-8")):
            if FLASH.match(section):
                self.add_bytes(self.flash, self.room_of_object(at, build), size)
            if RAM.match(section):
                name = section.split(".")[-1]
                name = CALLED.get(name, name)
                if name == "node":
                    size = self.add_parts_of_node(size)
                known = name in PARTS or name in WHOLE
                self.add_bytes(self.ram, name if known else "buffers, counters", size)
        if not self.flash:
            exit_with_error(f"{build.target.command[0]} wrote no map in the form of GNU's ld")

    def add_parts_of_node(self, size):
        """Adds the parts of a node as objects; returns what is left of its size."""
        for name, part in cross.sizes_of_expressions("own", NODE).items():
            self.add_bytes(self.ram, name, part)
            size -= part
        return size

    @staticmethod
    def add_bytes(table, name, size):
        table[name] = table.get(name, 0) + size

    @staticmethod
    def room_of_object(made, build):
        path = pathlib.Path(made)
        if path.parent == build.folder:
            return f"src/{next(s.parent.name for s in build.sources if s.stem == path.stem)}"
        return "the program, memcpy" if path.parent.parent == build.folder else "compiler's library"


def names_by_size(tables):
    """The names in all tables, those with the largest size in any table first."""
    names = {name for table in tables for name in table}
    return sorted(names, key=lambda name: (-max(table.get(name, 0) for table in tables), name))


def group_digits(value):
    return f"{value:,}".replace(",", " ")


def print_row(title, values):
    print(f"  {title:<60}" + "".join(f"{group_digits(value):>12}" for value in values))


def measure_parts():
    """{name: bytes} of the objects' parts, and {macro: value} of the macros in ROOMS and PARTS."""
    words = " ".join([*ROOMS.values(), *(" ".join(parts) for parts in PARTS.values())]).split()
    names = {word: word for word in words if word.startswith("RHO_")}
    for name, parts in PARTS.items():
        for part in (words.split()[0] for words in parts):
            names[f"{name}_{part}"] = f"sizeof(((struct rho_{name} *)0)->{part})"
    return cross.sizes_of_expressions("own", names)


class PartSizes:
    """Sizes of the objects' parts, and the macros that determine them."""

    def __init__(self):
        self.found = measure_parts()

    def macros_with_values(self, words):
        """The macros with their values as text; 0 for those not found, as an array of 0 has no
        symbol."""
        return ", ".join(f"{macro} {self.found.get(macro, 0)}" for macro in words.split())

    def parts_of_object(self, name):
        """(part, its macros, bytes) of an object, the largest first."""
        rows = []
        for part, *macros in map(str.split, PARTS.get(name, ())):
            size = self.found[f"{name}_{part}"]
            rows.append((f"{part} of the {name}", self.macros_with_values(" ".join(macros)), size))
        return sorted(rows, key=lambda row: -row[2])

    def largest_part(self, ram):
        """The largest part of a program's objects; an object without listed parts is one part."""
        rows = [row for name in ram for row in self.parts_of_object(name)]
        rows += [(name, self.macros_with_values(WHOLE[name]), ram[name])
                 for name in ram if name in WHOLE]
        return max(rows, key=lambda row: row[2])


def print_tables(programs, sizes):
    flash, ram = ([getattr(one, kind) for one in programs.values()] for kind in ("flash", "ram"))
    print(f"{'flash, bytes':<62}" + "".join(f"{name:>12}" for name in programs))
    for room in names_by_size(flash):
        print_row(f"{room} ({sizes.macros_with_values(ROOMS[room])})" if room in ROOMS else room,
             [table.get(room, 0) for table in flash])
    print_row("together", [sum(table.values()) for table in flash])
    print("RAM, bytes, without stack")
    for name in names_by_size(ram):
        print_row(f"{name} ({sizes.macros_with_values(WHOLE[name])})" if name in WHOLE else name,
             [table.get(name, 0) for table in ram])
        for part, macros, size in sizes.parts_of_object(name):
            if size >= LEAST:
                print(f"    {group_digits(size):>7}  {part} ({macros})")
    print_row("together", [sum(table.values()) for table in ram])
    for name, one in programs.items():
        room = next(room for room in names_by_size([one.flash]) if room in ROOMS)
        part, macros, size = sizes.largest_part(one.ram)
        print(f"largest, {name}: in flash {room}, {group_digits(one.flash[room])} bytes; "
              f"in RAM {part}, {group_digits(size)} bytes ({macros})")


def print_step_stack(build):
    """Prints the worst stack of a step, where the compiler writes a call graph."""
    if build.target.graph:
        size, _ = stack.CallGraph(build).worst_stack("rho_tracker_step")
        print(f"worst stack of rho_tracker_step: {size} bytes")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--config", default="")
    parser.add_argument("--cc", default="arm-none-eabi-gcc")
    parser.add_argument("--flags", default="-Os")
    options = parser.parse_args()
    config = pathlib.Path(options.config).absolute() if options.config else None
    if config and not config.is_file():
        exit_with_error(f"RHO_CONFIG_FILE={options.config}: there is no such file")
    os.chdir(cross.HOME)
    compiler = Compiler(options.cc, "")
    flags = [*compiler.command[1:], *options.flags.split(), f"-I{FIRMWARE.absolute()}",
             "-ffunction-sections", "-fdata-sections"]
    if config:
        check_macro_names(config, options.config)
        flags.append(f'-DRHO_CONFIG_FILE="{config}"')
    compiler.command, compiler.flags = compiler.command[:1], flags
    macros = check_macro_ranges(compiler, flags, config, options.config)
    cross.TARGETS["own"] = compiler
    build = cross.Build("own", also=macros)
    print(f"{options.config or 'embedded profile'}; {compiler.version()}; {options.flags}\n")
    print_tables({name: LinkedProgram(name, build, flags) for name in PROGRAMS}, PartSizes())
    print_step_stack(build)


if __name__ == "__main__":
    main()
