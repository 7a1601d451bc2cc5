#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures the library's cost at -Os: code, objects and worst stack of each room (folder of src/),
compares it with the committed figures, and checks upper limits (bars) of object sizes.

Prints the tables of section `sizes` of tools/lab/MEASUREMENTS.md, their differences from the
committed page, and the bars. Exit 1 where they differ or a bar is exceeded. Where the compilers are
not those that the page names, it says so and does not compare. Without arm-none-eabi-gcc the tables
are of this machine. SIZE_FLAGS are added to every compilation.

Usage: library_size.sh [--bars | --update] [--page FILE]
--bars only checks the bars; --update writes the section into the page; --page names another page
than this repository's.
"""
import argparse
import difflib
import fnmatch
import os
import pathlib
import re
import sys
import textwrap

import cross_compile as cross
import layers
import stack

sys.path.insert(0, str(cross.HOME / "tools" / "lab"))
import update_measurements_page  # noqa: E402 (found by the line above)

# Rows of the table of parts: title, files (patterns of room/file; -pattern excludes), object.
IMAGES = "*_soundness settings/snapshot"
ROWS = [
    ("initiation: kernels, fits, false-track rate, clutter map",
     "initiation/* window/* -*_soundness", "initiator"),
    ("tracks: estimation, association, tracker",
     "estimation/* association/* tracker/* bodies/* step/* settings/* "
     "-*_soundness -settings/snapshot -step/bearing_* -step/paper_starts", "tracker"),
    ("of these kalman, input and gate, by themselves; RAM of one track",
     "estimation/kalman* estimation/input_estimation* association/gate", "input"),
    ("walls that are learned, linked only where they are called", "walls/*", ""),
    ("base and measurement", "base/* measurement/* -measurement/bearing_crossing", ""),
    ("passive sensors: crossing, bearings, tracker's part, linked only where they are called",
     "measurement/bearing_crossing bearings/* step/bearing_* -*_soundness", "passive"),
    ("papers: accumulator, likewise", "papers/accumulator*", "accumulator"),
    ("papers: HT, MHT, IHT, NHT, likewise",
     "papers/hough* papers/votes_picture step/paper_starts", "hough"),
    ("papers: passive Hough transform, likewise", "papers/passive_paper*", "passive_paper"),
    ("papers: Hough gate, likewise", "papers/velocity_gate", ""),
    ("snapshot, and the validation of images, likewise", IMAGES, ""),
    ("wire: message, publish, udpm",
     "wire/message* wire/publish* wire/udpm* -wire/message_names", ""),
    ("node: messages in, steps, messages out, likewise", "node/*", "node"),
    ("names of messages and their fields, likewise", "wire/message_names", ""),
    ("scan assembly from messages, two scans open at a time, likewise", "wire/scan_*",
     "scan_assembler"),
    ("what a step thought, as messages (show), likewise", "wire/show*", "show"),
    ("report of a step", "", "report"),
]

# Aims of the design on a Cortex-M4F: title, files, bytes of code, objects and their bytes, bytes of
# stack. A missed aim fails no check.
AIMS = [
    ("a radar node: all but passive sensors, papers, images and names",
     "base/* measurement/* estimation/* association/* window/* initiation/* tracker/* bodies/* "
     "step/* settings/* wire/* node/* -node/node_snapshot -measurement/bearing_crossing "
     "-step/bearing_* -step/paper_starts "
     "-*_soundness -settings/snapshot -wire/message_names -wire/show*",
     96 * 1024, "initiator tracker scan_assembler report", 176 * 1024, 4096),
]

# Upper limits of objects: struct, configuration, bytes at most, compiler flags.
BARS = [
    ("passive", "embedded, 2 sensors, 8 scans, 8 bearings", 48 * 1024,
     "-DRHO_MAX_PASSIVE_SENSORS=2 -DRHO_MAX_PASSIVE_SCANS=8 -DRHO_MAX_BEARINGS=8"),
    ("passive", "embedded, 4 sensors, 8 scans, 16 bearings", 96 * 1024,
     "-DRHO_MAX_PASSIVE_SENSORS=4 -DRHO_MAX_PASSIVE_SCANS=8 -DRHO_MAX_BEARINGS=16"),
    ("passive", "workstation, 4 sensors, 16 scans, 16 bearings and tracks", 128 * 1024,
     "-DRHO_MAX_PASSIVE_SENSORS=4 -DRHO_MAX_PASSIVE_SCANS=16 -DRHO_MAX_BEARINGS=16 "
     "-DRHO_MAX_PASSIVE_TRACKS=16 -DRHO_MAX_PASSIVE_POINTS=1024 -DRHO_PASSIVE_BINS=256 "
     "-DRHO_PROFILE_WORKSTATION"),
    ("kalman", "state and covariance", 108, ""),
    ("track", "in any of its modes", 560, ""),
    ("hypothesis", "two models and its plots", 512, ""),
    ("scan_assembler", "two open scans of 256 plots", 32 * 1024,
     "-DRHO_MAX_OPEN_SCANS=2 -DRHO_MAX_PLOTS=256"),
    ("hypotheses", "a pool of 96 for 32 tracks", 48 * 1024,
     "-DRHO_MAX_HYPOTHESES=96 -DRHO_MAX_TRACKS=32"),
]

# The struct of each module, and other expressions whose sizes are listed.
OBJECTS = {
    "ghost": "ghost_matrix", **{
        name: name
        for name in ("accumulator window hough initiator batch passive passive_paper kalman "
                     "input gate imm hypotheses track assignment tracker scan_assembler node "
                     "show").split()
    }
}
OTHERS = {
    "rho_hypothesis": "sizeof(struct rho_hypothesis)",
    "rho_report": "sizeof(struct rho_report)",
    "rho_plot": "sizeof(struct rho_plot)",
    "rho_hough, a window of plots with their times, 128 peaks":
        "sizeof(struct rho_hough) + 12 * RHO_MAX_SCANS * RHO_MAX_PLOTS + "
        "128 * sizeof(struct rho_accumulator_peak)",
}

PART_TARGETS = ["m4f", "m0plus", "m7", "rv32"]


def group_digits(value):
    """The number with digits in groups of three from 10000 on: 64 848."""
    return f"{value:,}".replace(",", " ") if value >= 10000 else str(value)


def markdown_table(head, rows):
    """A Markdown table with aligned columns."""
    lines = [head, ["---"] * len(head), *rows]
    widths = [max(len(line[column]) for line in lines) for column in range(len(head))]
    lines[1] = ["-" * width for width in widths]
    align = lambda column, cell: cell.ljust(widths[column]) if column == 0 else cell.rjust(widths[
        column])
    return "".join(
        f"| {' | '.join(align(*cell) for cell in enumerate(line))} |\n" for line in lines)


class Measurements:
    """All measured sizes and stacks that the tables show."""

    def __init__(self):
        there = [
            name for name in cross.TARGETS if name != "host" and cross.TARGETS[name].is_installed()
        ]
        self.is_complete = len(there) == len(cross.TARGETS) - 1
        self.targets = there if "m4f" in there else ["host"]
        self.main = "m4f" if "m4f" in there else "host"
        builds = {target: cross.Build(target) for target in self.targets}
        self.texts = {target: build.text_sizes() for target, build in builds.items()}
        self.graphs = {target: stack.CallGraph(build) for target, build in builds.items()}
        self.graphs["workstation"] = stack.CallGraph(cross.Build(self.main, profile="workstation"))
        self.public = [found.name for found in stack.public_functions()]
        self.objects = [self.object_sizes(flags) for flags in ([], ["-DRHO_PROFILE_WORKSTATION"])]
        self.rooms, _ = layers.read_room_table(pathlib.Path("src/DESIGN.md"))
        self.places = {
            path.stem: f"{path.parent.name}/{path.stem}"
            for path in pathlib.Path("src").glob("*/*.c")
        }

    def object_sizes(self, flags):
        names = {f"o{at}": expression for at, expression in enumerate(OTHERS.values())}
        names |= {name: f"sizeof(struct rho_{name})" for name in OBJECTS.values()}
        found = cross.sizes_of_expressions(self.main, names, flags)
        return found | {name: found[f"o{at}"]
                        for at, name in enumerate(OTHERS)} | {"report": found["o1"]}

    def stems_of_selection(self, selection):
        """The stems of the source files that a row's patterns select."""
        words = selection.split()
        for word in words:
            if not fnmatch.filter(self.places.values(), word.lstrip("-")):
                sys.exit(f"size: no file of src/ is named {word}")
        named = lambda stem, patterns: any(
            fnmatch.fnmatch(self.places[stem], pattern) for pattern in patterns)
        return {stem for stem in self.texts[self.main]
                if named(stem, [word for word in words if word[0] != "-"])
                and not named(stem, [word[1:] for word in words if word[0] == "-"])}

    def text_size(self, target, selection):
        return sum(self.texts[target][stem] for stem in self.stems_of_selection(selection))

    def worst_stack(self, graph, selection):
        """The worst stack of the public functions in the selected files, and the function's
        name."""
        graph, files = self.graphs[graph], self.stems_of_selection(selection)
        within = [
            name for name in self.public
            if name in graph.places and pathlib.Path(graph.places[name]).stem in files
        ]
        return max(((graph.worst_stack(name)[0], name) for name in within), default=(0, ""))

    def compiler_versions(self):
        prefixes = sorted({cross.TARGETS[name].prefix: name for name in self.targets}.items())
        return ", ".join(
            f"{prefix}gcc {cross.TARGETS[name].version()}" for prefix, name in prefixes)


def target_titles(targets):
    return [cross.TARGETS[name].title for name in targets]


def parts_table(measured):
    """Table of code, RAM and stack by part of the library that a program links."""
    targets = [name for name in PART_TARGETS if name in measured.targets] or measured.targets
    rows = []
    for title, selection, name in ROWS:
        texts = [
            group_digits(measured.text_size(target, selection)) if selection else ""
            for target in targets
        ]
        size, function = measured.worst_stack(measured.main, selection)
        ram = group_digits(measured.objects[0][name]) if name else "0"
        rows.append([title, *texts, ram, f"{size} ({function})" if selection else ""])
    rows.append(["data, bss", *["0"] * len(targets), "", ""])
    return markdown_table(
        ["", *target_titles(targets), "RAM", f"stack, {target_titles([measured.main])[0]}"], rows)


def room_tables(measured):
    texts = [[room, *[group_digits(measured.text_size(target, f"{room}/*"))
                      for target in measured.targets]] for room in measured.rooms]
    texts.append(
        ["all", *[group_digits(sum(measured.texts[target].values()))
                  for target in measured.targets]])
    yield "Text", "Code and constants; data and bss are 0.", markdown_table(
        ["room", *target_titles(measured.targets)], texts)
    graphs = [*measured.targets, "workstation"]
    stacks = []
    for room in measured.rooms:
        found = [measured.worst_stack(graph, f"{room}/*")[0] for graph in graphs]
        stacks.append([room, *map(group_digits, found),
                       measured.worst_stack(measured.main, f"{room}/*")[1]])
    main = target_titles([measured.main])[0]
    yield (
        "Stack",
        "Worst stack of a public function of the room with all that it calls, by the call graph. "
        "Functions of the C library and the compiler are charged 64 bytes, their 64-bit arithmetic "
        "on M0+ and RISC-V 160. Exception frames come on top. `tools/gates/stack.py` prints every "
        "function, `tools/gates/stack.py --path FUNCTION` the frames of one.",
        markdown_table(["room", *target_titles(measured.targets), f"{main}, workstation",
                        f"function, {main}"], stacks))
    rows = [[f"rho_{name}", *(group_digits(sizes[name]) for sizes in measured.objects)]
            for name in OBJECTS.values()]
    rows += [[name, *(group_digits(sizes[name]) for sizes in measured.objects)] for name in OTHERS]
    yield ("RAM", f"Objects in both profiles, {main}; the caller owns them.",
           markdown_table(["struct", "embedded", "workstation"], sorted(rows)))


def verdict_on_aims(pairs):
    """The names of the figures that exceed their aims, or "held"."""
    missed = [name for name, value, most in pairs if value > most]
    return "missed: " + ", ".join(missed) if missed else "held"


def aims_table(measured):
    rows = []
    for title, selection, text_most, names, ram_most, stack_most in AIMS:
        text = measured.text_size(measured.main, selection)
        ram = sum(measured.objects[0][name] for name in names.split())
        depth, _ = measured.worst_stack(measured.main, selection)
        said = verdict_on_aims([("text", text, text_most), ("RAM", ram, ram_most),
                        ("stack", depth, stack_most)])
        rows.append(
            [title, *map(group_digits, [text, text_most, ram, ram_most, depth, stack_most]), said])
    return markdown_table(["", "text", "aim", "RAM", "aim", "stack", "aim", ""], rows)


def sizes_section(measured):
    """The text of section `sizes` of the page."""
    parts = [(
        "By part",
        "Code with constants, RAM, and the worst stack of a public function by the call graph; "
        "embedded profile (7 scans of 256 plots, 32 tracks). Code that nothing calls is not "
        "linked.",
        parts_table(measured)), *room_tables(measured)]
    if measured.main == "m4f":
        parts.append((
            "Aims",
            "Aims of the design on a Cortex-M4F, embedded profile; a missed aim fails no check. "
            "Text counts whole files, with what a linker can leave out.", aims_table(measured)))
    lines = [f"\nBytes at `-Os`, {measured.compiler_versions()}.\n"]
    lines += [
        f"\n### {heading}\n\n{textwrap.fill(words, 100)}\n\n{rows}"
        for heading, words, rows in parts
    ]
    return "".join(lines) + "\n"


def compare_with_page(measured, path):
    """Prints how the page differs; True where it agrees, or was measured with another compiler."""
    says, should = update_measurements_page.section(path.read_text(encoding="utf-8"),
                                        "sizes"), sizes_section(measured)
    stated = re.search(r"arm-none-eabi-gcc \d[\d.]*\d, riscv64-unknown-elf-gcc \d[\d.]*\d", says)
    if not measured.is_complete or (stated and stated.group() != measured.compiler_versions()):
        print(f"skipped: {path.name} is of {stated.group() if stated else 'another compiler'}, "
              f"here is {measured.compiler_versions()}: not compared")
        return True
    differences = list(
        difflib.unified_diff(says.splitlines(), should.splitlines(), str(path), "measured",
                             lineterm="", n=0))
    print("\n".join(differences) or f"{path.name} says what was measured")
    return not differences


def update_page(measured, path):
    if not measured.is_complete:
        sys.exit("size: a compiler is missing (tools/setup.sh installs it)")
    text = sizes_section(measured)
    path.write_text(
        update_measurements_page.replaced(path.read_text(encoding="utf-8"), "sizes", text),
        encoding="utf-8")


def check_bars():
    """Prints the sizes of objects beside their limits; True where all are within."""
    target = "m4f" if cross.TARGETS["m4f"].is_installed() else "host"
    fits = True
    print(f"{'what must fit':66} {'bytes':>9} {'at most':>9}")
    for name, text, most, flags in BARS:
        size = cross.sizes_of_expressions(target, {"it": f"sizeof(struct rho_{name})"},
                                          flags.split())["it"]
        fits = fits and size <= most
        print(
            f"{f'struct rho_{name}, {text}':66} {size:9} {most:9}  "
            f"{'ok' if size <= most else 'MISSED'}"
        )
    return fits


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bars", action="store_true")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--page", type=pathlib.Path, default=update_measurements_page.PAGE)
    options = parser.parse_args()
    path = options.page.absolute()
    os.chdir(cross.HOME)
    wrong = []
    if not options.bars:
        measured = Measurements()
        if options.update:
            update_page(measured, path)
            return
        print(sizes_section(measured))
        if not compare_with_page(measured, path):
            wrong.append(
                "size: the page says something else: make size-update, and look at the difference")
        print()
    if not check_bars():
        wrong.append("size: an object is larger than it may be")
    sys.exit("\n".join(wrong) or 0)


if __name__ == "__main__":
    main()
