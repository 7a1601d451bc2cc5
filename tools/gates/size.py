#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the library costs: code, objects and worst stack of each room at -Os, beside what was
committed and what must fit.

Prints the tables of section `sizes` of tools/lab/MEASUREMENTS.md, how they differ from what is
committed, and the bars. Exit 1 where they differ or a bar is missed. With other compilers than
those that the page names it says so, and does not compare. Without arm-none-eabi-gcc the tables are
of this machine. SIZE_FLAGS are added to every compilation.

Usage: size.sh [--bars | --update] [--page FILE]
--bars prints the bars alone; --update writes the section; FILE is another page than that of this
repository.
"""
import argparse
import difflib
import fnmatch
import os
import pathlib
import re
import sys
import textwrap

import cross
import layers
import stack

sys.path.insert(0, str(cross.HOME / "tools" / "lab"))
import measurements  # noqa: E402 (found by the line above)

# The rows of the first table: title, files (patterns of room/file; -pattern: without these),
# object.
IMAGES = "*_soundness settings/snapshot"
ROWS = [
    ("initiation: kernels, fits, false-track rate, clutter map",
     "initiation/* window/* -*_soundness", "initiator"),
    ("tracks: estimation, association, tracker",
     "estimation/* association/* tracker/* bodies/* step/* settings/* "
     "-*_soundness -settings/snapshot -step/bearing_* -step/paper_starts", "tracker"),
    ("of these kalman, input and gate, by themselves; RAM of one track",
     "estimation/kalman* estimation/input* association/gate", "input"),
    ("walls that are learned, linked only where they are called", "walls/*", ""),
    ("base and measurement", "base/* measurement/* -measurement/crossing", ""),
    ("passive sensors: crossing, bearings, tracker's part, linked only where they are called",
     "measurement/crossing bearings/* step/bearing_* -*_soundness -bearings/frames", "passive"),
    ("frames of bearing scans as they arrive, likewise", "bearings/frames", "frames"),
    ("papers: accumulator, likewise", "papers/accumulator*", "accumulator"),
    ("papers: HT, MHT, IHT, NHT, likewise", "papers/hough* papers/plane step/paper_starts", "hough"),
    ("papers: passive Hough transform, likewise", "papers/passive_paper*", "passive_paper"),
    ("papers: Hough gate, likewise", "papers/gate_hough", ""),
    ("snapshot, and the validation of images, likewise", IMAGES, ""),
    ("wire: message, publish, udpm", "wire/message* wire/publish* wire/udpm -wire/message_names",
     ""),
    ("node: messages in, steps, messages out, likewise", "wire/node", "node"),
    ("names of messages and their fields, likewise", "wire/message_names", ""),
    ("scan assembly from messages, two scans open at a time, likewise", "wire/scan_*",
     "scan_assembler"),
    ("what a step thought, as messages (show), likewise", "wire/show*", "show"),
    ("report of a step", "", "report"),
]

# Aims of the design on a Cortex-M4F: title, files, bytes of text, objects and their bytes, bytes of
# stack. Not red.
AIMS = [
    ("a radar node: all but passive sensors, papers, images and names",
     "base/* measurement/* estimation/* association/* window/* initiation/* tracker/* bodies/* "
     "step/* settings/* wire/* -measurement/crossing -step/bearing_* -step/paper_starts "
     "-*_soundness -settings/snapshot -wire/message_names -wire/show*",
     96 * 1024, "initiator tracker scan_assembler report", 176 * 1024, 4096),
]

# What must fit: object, what of it, bytes at most, flags.
BARS = [
    ("passive", "embedded, 2 sensors, 8 scans, 8 bearings", 48 * 1024,
     "-DRHO_MAX_PASSIVE_SENSORS=2 -DRHO_MAX_PASSIVE_SCANS=8 -DRHO_MAX_BEARINGS=8"),
    ("passive", "workstation, 4 sensors, 16 scans, 16 bearings", 90 * 1024,
     "-DRHO_MAX_PASSIVE_SENSORS=4 -DRHO_MAX_PASSIVE_SCANS=16 -DRHO_MAX_BEARINGS=16 -DRHO_PROFILE_WORKSTATION"
     ),
    ("kalman", "state and covariance", 108, ""),
    ("track", "in any of its modes", 512, ""),
    ("hypothesis", "two models and its plots", 512, ""),
    ("scan_assembler", "two open scans of 256 plots", 32 * 1024,
     "-DRHO_MAX_OPEN_SCANS=2 -DRHO_MAX_PLOTS=256"),
    ("hypotheses", "a pool of 96 for 32 tracks", 48 * 1024,
     "-DRHO_MAX_HYPOTHESES=96 -DRHO_MAX_TRACKS=32"),
]

# The object of each module, and what else is counted.
OBJECTS = {
    "ghost": "ghost_matrix", **{
        name: name
        for name in ("accumulator window hough initiator frames batch passive passive_paper kalman input gate imm hypotheses track "
                     "assignment tracker scan_assembler node show").split()
    }
}
OTHERS = {
    "rho_hypothesis": "sizeof(struct rho_hypothesis)",
    "rho_report": "sizeof(struct rho_report)",
    "rho_plot": "sizeof(struct rho_plot)",
    "rho_hough, a window of plots with their times, 128 peaks": "sizeof(struct rho_hough) + 12 * RHO_MAX_SCANS * RHO_MAX_PLOTS + 128 * sizeof(struct rho_accumulator_peak)",
}

PART_TARGETS = ["m4f", "m0plus", "m7", "rv32"]


def number(value):
    """Bytes as they are read: 64 848."""
    return f"{value:,}".replace(",", " ") if value >= 10000 else str(value)


def table(head, rows):
    """A table of markdown, its columns aligned."""
    lines = [head, ["---"] * len(head), *rows]
    widths = [max(len(line[column]) for line in lines) for column in range(len(head))]
    lines[1] = ["-" * width for width in widths]
    align = lambda column, cell: cell.ljust(widths[column]) if column == 0 else cell.rjust(widths[
        column])
    return "".join(
        f"| {' | '.join(align(*cell) for cell in enumerate(line))} |\n" for line in lines)


class Measured:
    """Everything that the tables are made of."""

    def __init__(self):
        there = [
            name for name in cross.TARGETS if name != "host" and cross.TARGETS[name].is_there()
        ]
        self.is_complete = len(there) == len(cross.TARGETS) - 1
        self.targets = there if "m4f" in there else ["host"]
        self.main = "m4f" if "m4f" in there else "host"
        builds = {target: cross.Build(target) for target in self.targets}
        self.texts = {target: build.texts() for target, build in builds.items()}
        self.graphs = {target: stack.Graph(build) for target, build in builds.items()}
        self.graphs["workstation"] = stack.Graph(cross.Build(self.main, profile="workstation"))
        self.public = [found.name for found in stack.public()]
        self.objects = [self.sizes(flags) for flags in ([], ["-DRHO_PROFILE_WORKSTATION"])]
        self.rooms, _ = layers.read_table(pathlib.Path("src/DESIGN.md"))
        self.places = {
            path.stem: f"{path.parent.name}/{path.stem}"
            for path in pathlib.Path("src").glob("*/*.c")
        }

    def sizes(self, flags):
        names = {f"o{at}": expression for at, expression in enumerate(OTHERS.values())}
        names |= {name: f"sizeof(struct rho_{name})" for name in OBJECTS.values()}
        found = cross.sizes_of(self.main, names, flags)
        return found | {name: found[f"o{at}"]
                        for at, name in enumerate(OTHERS)} | {"report": found["o1"]}

    def files(self, selection):
        """The stems that a row's selection names."""
        words = selection.split()
        for word in words:
            if not fnmatch.filter(self.places.values(), word.lstrip("-")):
                sys.exit(f"size: no file of src/ is named {word}")
        named = lambda stem, patterns: any(
            fnmatch.fnmatch(self.places[stem], pattern) for pattern in patterns)
        return {stem for stem in self.texts[self.main]
                if named(stem, [word for word in words if word[0] != "-"])
                and not named(stem, [word[1:] for word in words if word[0] == "-"])}

    def text(self, target, selection):
        return sum(self.texts[target][stem] for stem in self.files(selection))

    def stack(self, graph, selection):
        """The worst stack of the public functions in these files, and whose it is."""
        graph, files = self.graphs[graph], self.files(selection)
        within = [
            name for name in self.public
            if name in graph.places and pathlib.Path(graph.places[name]).stem in files
        ]
        return max(((graph.worst(name)[0], name) for name in within), default=(0, ""))

    def versions(self):
        prefixes = sorted({cross.TARGETS[name].prefix: name for name in self.targets}.items())
        return ", ".join(
            f"{prefix}gcc {cross.TARGETS[name].version()}" for prefix, name in prefixes)


def titles(targets):
    return [cross.TARGETS[name].title for name in targets]


def parts_table(measured):
    """Code, RAM and stack by what a program links."""
    targets = [name for name in PART_TARGETS if name in measured.targets] or measured.targets
    rows = []
    for title, selection, name in ROWS:
        texts = [
            number(measured.text(target, selection)) if selection else "" for target in targets
        ]
        size, function = measured.stack(measured.main, selection)
        ram = number(measured.objects[0][name]) if name else "0"
        rows.append([title, *texts, ram, f"{size} ({function})" if selection else ""])
    rows.append(["data, bss", *["0"] * len(targets), "", ""])
    return table(["", *titles(targets), "RAM", f"stack, {titles([measured.main])[0]}"], rows)


def room_tables(measured):
    texts = [[room, *[number(measured.text(target, f"{room}/*")) for target in measured.targets]]
             for room in measured.rooms]
    texts.append(
        ["all", *[number(sum(measured.texts[target].values())) for target in measured.targets]])
    yield "Text", "Code and constants; data and bss are 0.", table(
        ["room", *titles(measured.targets)], texts)
    graphs = [*measured.targets, "workstation"]
    stacks = []
    for room in measured.rooms:
        found = [measured.stack(graph, f"{room}/*")[0] for graph in graphs]
        stacks.append([room, *map(number, found), measured.stack(measured.main, f"{room}/*")[1]])
    main = titles([measured.main])[0]
    yield (
        "Stack",
        "Worst stack of a public function of the room with all that it calls, by the call graph. Functions of "
        "the C library and the compiler are charged 64 bytes, their 64-bit arithmetic on M0+ and RISC-V 160. "
        "Exception frames come on top. `tools/gates/stack.py` prints every function, `tools/gates/stack.py --path "
        "FUNCTION` the frames of one.",
        table(["room", *titles(measured.targets), f"{main}, workstation", f"function, {main}"],
              stacks))
    rows = [[f"rho_{name}", *(number(sizes[name]) for sizes in measured.objects)]
            for name in OBJECTS.values()]
    rows += [[name, *(number(sizes[name]) for sizes in measured.objects)] for name in OTHERS]
    yield ("RAM", f"Objects in both profiles, {main}; the caller owns them.",
           table(["struct", "embedded", "workstation"], sorted(rows)))


def verdict(pairs):
    """The figures of a row that are beyond what was aimed at."""
    missed = [name for name, value, most in pairs if value > most]
    return "missed: " + ", ".join(missed) if missed else "held"


def aims_table(measured):
    rows = []
    for title, selection, text_most, names, ram_most, stack_most in AIMS:
        text = measured.text(measured.main, selection)
        ram = sum(measured.objects[0][name] for name in names.split())
        depth, _ = measured.stack(measured.main, selection)
        said = verdict([("text", text, text_most), ("RAM", ram, ram_most),
                        ("stack", depth, stack_most)])
        rows.append(
            [title, *map(number, [text, text_most, ram, ram_most, depth, stack_most]), said])
    return table(["", "text", "aim", "RAM", "aim", "stack", "aim", ""], rows)


def section(measured):
    """The section `sizes`."""
    parts = [(
        "By part",
        "Code with constants, RAM, and the worst stack of a public function by the call graph; embedded "
        "profile (7 scans of 256 plots, 32 tracks). Code that nothing calls is not linked.",
        parts_table(measured)), *room_tables(measured)]
    if measured.main == "m4f":
        parts.append((
            "Aims",
            "Aims of the design on a Cortex-M4F, embedded profile; a missed aim fails no check. Text counts "
            "whole files, with what a linker can leave out.", aims_table(measured)))
    lines = [f"\nBytes at `-Os`, {measured.versions()}.\n"]
    lines += [
        f"\n### {heading}\n\n{textwrap.fill(words, 100)}\n\n{rows}"
        for heading, words, rows in parts
    ]
    return "".join(lines) + "\n"


def compare(measured, path):
    """Prints how the page differs; whether it agrees, or is another compiler's."""
    says, should = measurements.section(path.read_text(encoding="utf-8"),
                                        "sizes"), section(measured)
    stated = re.search(r"arm-none-eabi-gcc \d[\d.]*\d, riscv64-unknown-elf-gcc \d[\d.]*\d", says)
    if not measured.is_complete or (stated and stated.group() != measured.versions()):
        print(f"skipped: {path.name} is of {stated.group() if stated else 'another compiler'}, "
              f"here is {measured.versions()}: not compared")
        return True
    differences = list(
        difflib.unified_diff(says.splitlines(), should.splitlines(), str(path), "measured",
                             lineterm="", n=0))
    print("\n".join(differences) or f"{path.name} says what was measured")
    return not differences


def update(measured, path):
    if not measured.is_complete:
        sys.exit("size: a compiler is missing (tools/setup.sh installs it)")
    text = section(measured)
    path.write_text(measurements.replaced(path.read_text(encoding="utf-8"), "sizes", text),
                    encoding="utf-8")


def bars():
    """Prints what must fit; whether it does."""
    target = "m4f" if cross.TARGETS["m4f"].is_there() else "host"
    fits = True
    print(f"{'what must fit':66} {'bytes':>9} {'at most':>9}")
    for name, text, most, flags in BARS:
        size = cross.sizes_of(target, {"it": f"sizeof(struct rho_{name})"}, flags.split())["it"]
        fits = fits and size <= most
        print(
            f"{f'struct rho_{name}, {text}':66} {size:9} {most:9}  {'ok' if size <= most else 'MISSED'}"
        )
    return fits


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bars", action="store_true")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--page", type=pathlib.Path, default=measurements.PAGE)
    options = parser.parse_args()
    path = options.page.absolute()
    os.chdir(cross.HOME)
    wrong = []
    if not options.bars:
        measured = Measured()
        if options.update:
            update(measured, path)
            return
        print(section(measured))
        if not compare(measured, path):
            wrong.append(
                "size: the page says something else: make size-update, and look at the difference")
        print()
    if not bars():
        wrong.append("size: an object is larger than it may be")
    sys.exit("\n".join(wrong) or 0)


if __name__ == "__main__":
    main()
