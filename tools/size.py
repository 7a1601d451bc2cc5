#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the library costs: code, objects and worst stack of each module at -Os, beside what was committed and what must fit.

Prints the tables of src/SIZES.md, how they and the table of README.md differ from what is committed, and the bars. Exit 1
where they differ or a bar is missed. With other compilers than those that the documents name it says so, and does not
compare. Without arm-none-eabi-gcc the tables are of this machine. SIZE_FLAGS are added to every compilation.

Usage: size.sh [--bars | --update] [--documents FOLDER]
--bars prints the bars alone; --update writes both documents; FOLDER has README.md and src/SIZES.md (default: this
repository).
"""
import argparse
import difflib
import os
import pathlib
import re
import sys

import cross
import layers
import stack

# The rows of README.md: title, modules (-part: without that file, +part: that file), object.
ROWS = [
    ("initiation: window, initiator", "window initiator -window_sound -initiator_sound", "initiator"),
    ("maintenance: kalman, gate, input, imm, hypotheses, clutter_map, track, assignment, tracker",
     "kalman gate input imm hypotheses clutter_map track assignment tracker -tracker_frame -tracker_passive -hypotheses_sound -tracker_sound -clutter_map_sound", "tracker"),
    ("of these kalman, input and gate, by themselves; RAM of one track", "kalman input gate", "input"),
    ("base: approx, angle, linalg, measurement, types, status", "approx angle linalg measurement types status", ""),
    ("accumulator, linked only where it is called", "accumulator", "accumulator"),
    ("classic, the literature's methods, likewise", "classic", "classic"),
    ("passive sensors: crossing, ghost, batch, passive, tracker's part, likewise",
     "crossing ghost batch passive +tracker_frame +tracker_passive -batch_sound -passive_sound", "passive"),
    ("snapshot, and what looks images through, likewise",
     "snapshot +window_sound +initiator_sound +hypotheses_sound +tracker_sound +clutter_map_sound +batch_sound +passive_sound", ""),
    ("frames of scans as they arrive, likewise", "frames", "frames"),
    ("passive_paper, the literature's method for them, likewise", "passive_paper", "passive_paper"),
    ("wire: message, publish, udpm", "message publish udpm -message_names", ""),
    ("names of messages and their fields, likewise", "+message_names", ""),
    ("feed: whole scans of messages, two open at a time, likewise", "feed", "feed"),
    ("report of a step", "", "report"),
]

# Aims of the design on a Cortex-M4F: title, modules, bytes of text, objects and their bytes, bytes of stack. Not red.
AIMS = [
    ("kalman, measurement, gate (nearest), track", "kalman measurement gate -gate_hough track", 8192, "track", 512, 400),
    ("imm, hypotheses", "imm hypotheses -hypotheses_sound", 8192, "hypotheses", 48 * 1024, 600),
    ("initiator", "initiator -initiator_sound", 8192, "initiator", 64 * 1024, 512),
    ("passive", "passive -passive_sound", 10 * 1024, "passive", 48 * 1024, 1024),
    ("message, udpm", "message udpm -message_names", 8192, "", 0, 256),
    ("the same with the names of fields", "message udpm", 8192, "", 0, 256),
    ("a radar node: all but passive sensors, classic, accumulator",
     "status types approx angle linalg measurement window initiator kalman input gate imm hypotheses clutter_map track assignment "
     "tracker -tracker_frame -tracker_passive -window_sound -initiator_sound -hypotheses_sound -tracker_sound -clutter_map_sound "
     "message udpm feed publish",
     96 * 1024, "initiator tracker feed report", 176 * 1024, 4096),
]

# What must fit: object, what of it, bytes at most, flags.
BARS = [
    ("passive", "embedded, 2 sensors, 8 scans, 8 bearings", 48 * 1024,
     "-DRHO_MAX_PASSIVE_SENSORS=2 -DRHO_MAX_PASSIVE_SCANS=8 -DRHO_MAX_BEARINGS=8"),
    ("passive", "workstation, 4 sensors, 16 scans, 16 bearings", 90 * 1024,
     "-DRHO_MAX_PASSIVE_SENSORS=4 -DRHO_MAX_PASSIVE_SCANS=16 -DRHO_MAX_BEARINGS=16 -DRHO_PROFILE_WORKSTATION"),
    ("kalman", "state and covariance", 108, ""),
    ("track", "in any of its modes", 512, ""),
    ("hypothesis", "two models and its plots", 512, ""),
    ("feed", "two open scans of 256 plots", 32 * 1024, "-DRHO_MAX_OPEN_SCANS=2 -DRHO_MAX_PLOTS=256"),
    ("hypotheses", "a pool of 96 for 32 tracks", 48 * 1024, "-DRHO_MAX_HYPOTHESES=96 -DRHO_MAX_TRACKS=32"),
]

# The object of each module, and what else is counted.
OBJECTS = {"ghost": "ghost_matrix", **{name: name for name in (
    "accumulator window classic initiator frames batch passive passive_paper kalman input gate imm hypotheses track "
    "assignment tracker feed").split()}}
OTHERS = {
    "rho_hypothesis": "sizeof(struct rho_hypothesis)",
    "rho_report": "sizeof(struct rho_report)",
    "rho_plot": "sizeof(struct rho_plot)",
    "rho_classic, a window of plots with their times, 128 peaks":
        "sizeof(struct rho_classic) + 12 * RHO_MAX_SCANS * RHO_MAX_PLOTS + 128 * sizeof(struct rho_accumulator_peak)",
}

README = ("<!-- sizes: written by make size-update -->\n", "<!-- end of sizes -->\n")
README_TARGETS = ["m4f", "m0plus", "m7", "rv32"]


def number(value):
    """Bytes as they are read: 64 848."""
    return f"{value:,}".replace(",", " ") if value >= 10000 else str(value)


def table(head, rows):
    """A table of markdown, its columns aligned."""
    lines = [head, ["---"] * len(head), *rows]
    widths = [max(len(line[column]) for line in lines) for column in range(len(head))]
    lines[1] = ["-" * width for width in widths]
    align = lambda column, cell: cell.ljust(widths[column]) if column == 0 else cell.rjust(widths[column])
    return "".join(f"| {' | '.join(align(*cell) for cell in enumerate(line))} |\n" for line in lines)


class Measured:
    """Everything that the tables are made of."""

    def __init__(self):
        there = [name for name in cross.TARGETS if name != "host" and cross.TARGETS[name].is_there()]
        self.is_complete = len(there) == len(cross.TARGETS) - 1
        self.targets = there if "m4f" in there else ["host"]
        self.main = "m4f" if "m4f" in there else "host"
        builds = {target: cross.Build(target) for target in self.targets}
        self.texts = {target: build.texts() for target, build in builds.items()}
        self.graphs = {target: stack.Graph(build) for target, build in builds.items()}
        self.graphs["workstation"] = stack.Graph(cross.Build(self.main, profile="workstation"))
        self.public = [found.name for found in stack.public()]
        self.objects = [self.sizes(flags) for flags in ([], ["-DRHO_PROFILE_WORKSTATION"])]
        table_of_modules, _ = layers.read_table(pathlib.Path("src/DESIGN.md"))
        self.stems = {}
        for stem in self.texts[self.main]:
            self.stems.setdefault(layers.module_of(stem, table_of_modules), []).append(stem)
        self.modules = [module for module in table_of_modules if module in self.stems]

    def sizes(self, flags):
        names = {f"o{at}": expression for at, expression in enumerate(OTHERS.values())}
        names |= {name: f"sizeof(struct rho_{name})" for name in OBJECTS.values()}
        found = cross.sizes_of(self.main, names, flags)
        return found | {name: found[f"o{at}"] for at, name in enumerate(OTHERS)} | {"report": found["o1"]}

    def files(self, selection):
        """The stems that a row's selection names."""
        words = selection.split()
        stems = {stem for word in words if word[0] not in "+-" for stem in self.stems[word]}
        return (stems | {word[1:] for word in words if word[0] == "+"}) - {word[1:] for word in words if word[0] == "-"}

    def text(self, target, selection):
        return sum(self.texts[target][stem] for stem in self.files(selection))

    def stack(self, graph, selection):
        """The worst stack of the public functions in these files, and whose it is."""
        graph, files = self.graphs[graph], self.files(selection)
        within = [name for name in self.public if name in graph.places and pathlib.Path(graph.places[name]).stem in files]
        return max(((graph.worst(name)[0], name) for name in within), default=(0, ""))

    def versions(self):
        prefixes = sorted({cross.TARGETS[name].prefix: name for name in self.targets}.items())
        return ", ".join(f"{prefix}gcc {cross.TARGETS[name].version()}" for prefix, name in prefixes)


def titles(targets):
    return [cross.TARGETS[name].title for name in targets]


def readme_table(measured):
    """What stands between the markers of README.md."""
    targets = [name for name in README_TARGETS if name in measured.targets] or measured.targets
    rows = []
    for title, selection, name in ROWS:
        texts = [number(measured.text(target, selection)) if selection else "" for target in targets]
        size, function = measured.stack(measured.main, selection)
        ram = number(measured.objects[0][name]) if name else "0"
        rows.append([title, *texts, ram, f"{size} ({function})" if selection else ""])
    rows.append(["data, bss", *["0"] * len(targets), "", ""])
    return ("\nBytes of code with constants, RAM, and the worst stack of a public function, by the call graph; embedded profile "
            f"(7 scans of 256\nplots, 32 tracks), `-Os`, {measured.versions()}:\n\n"
            + table(["", *titles(targets), "RAM", f"stack, {titles([measured.main])[0]}"], rows) + "\n")


def module_tables(measured):
    texts = [[module, *[number(measured.text(target, module)) for target in measured.targets]]
             for module in measured.modules]
    texts.append(["all", *[number(sum(measured.texts[target].values())) for target in measured.targets]])
    yield "Text", "Code and constants; data and bss are 0.", table(["module", *titles(measured.targets)], texts)
    graphs = [*measured.targets, "workstation"]
    stacks = []
    for module in measured.modules:
        found = [measured.stack(graph, module)[0] for graph in graphs]
        stacks.append([module, *map(number, found), measured.stack(measured.main, module)[1]])
    main = titles([measured.main])[0]
    yield ("Stack", "The most that a public function of the module takes with all that it calls, by the call graph; "
           "functions of the C library and the\ncompiler's are charged 64 bytes, their 64-bit arithmetic on M0+ and RISC-V 160. "
           "Exception frames come on top. `tools/stack.py` prints\nevery function, `tools/stack.py --path FUNCTION` "
           "who takes the bytes.",
           table(["module", *titles(measured.targets), f"{main}, workstation", f"function, {main}"], stacks))
    rows = [[f"rho_{name}", *(number(sizes[name]) for sizes in measured.objects)] for name in OBJECTS.values()]
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
        said = verdict([("text", text, text_most), ("RAM", ram, ram_most), ("stack", depth, stack_most)])
        rows.append([title, *map(number, [text, text_most, ram, ram_most, depth, stack_most]), said])
    return table(["", "text", "aim", "RAM", "aim", "stack", "aim", ""], rows)


def page(measured):
    """src/SIZES.md."""
    lines = [f"# What each module costs\n\nBytes at `-Os`, {measured.versions()}. `make size` compares this page with what it "
             "measures,\n`make size-update` writes it.\n"]
    for heading, words, rows in module_tables(measured):
        lines.append(f"\n## {heading}\n\n{words}\n\n{rows}")
    if measured.main == "m4f":
        lines.append("\n## Aims\n\nWhat the modules were meant to cost on a Cortex-M4F, embedded profile. Nothing fails where "
                     "an aim is missed. RAM of track is one\ntrack's. Text is that of whole files, with what a linker can leave out.\n\n"
                     + aims_table(measured))
    return "".join(lines)


def documents(measured, folder):
    """{file: (what it says, what it should say)}."""
    readme, sizes = folder / "README.md", folder / "src" / "SIZES.md"
    text = readme.read_text(encoding="utf-8")
    if text.count(README[0]) != 1 or text.count(README[1]) != 1:
        sys.exit(f"size: {readme} has no place for the sizes: {README[0]}")
    before, after = text.split(README[0])[0], text.split(README[1])[1]
    return {readme: (text, before + README[0] + readme_table(measured) + README[1] + after),
            sizes: (sizes.read_text(encoding="utf-8") if sizes.is_file() else "", page(measured))}


def compare(measured, folder):
    """Prints how the documents differ; whether they agree, or are another compiler's."""
    agree = True
    for path, (says, should) in documents(measured, folder).items():
        stated = re.search(r"arm-none-eabi-gcc \d[\d.]*\d, riscv64-unknown-elf-gcc \d[\d.]*\d", says)
        if not measured.is_complete or (stated and stated.group() != measured.versions()):
            print(f"skipped: {path.name} is of {stated.group() if stated else 'another compiler'}, "
                  f"here is {measured.versions()}: not compared")
            continue
        differences = list(difflib.unified_diff(says.splitlines(), should.splitlines(), str(path), "measured",
                                                lineterm="", n=0))
        print("\n".join(differences) or f"{path.name} says what was measured")
        agree = agree and not differences
    return agree


def update(measured, folder):
    if not measured.is_complete:
        sys.exit("size: a compiler is missing (tools/setup.sh installs it)")
    for path, (_, should) in documents(measured, folder).items():
        path.write_text(should, encoding="utf-8")


def bars():
    """Prints what must fit; whether it does."""
    target = "m4f" if cross.TARGETS["m4f"].is_there() else "host"
    fits = True
    print(f"{'what must fit':66} {'bytes':>9} {'at most':>9}")
    for name, text, most, flags in BARS:
        size = cross.sizes_of(target, {"it": f"sizeof(struct rho_{name})"}, flags.split())["it"]
        fits = fits and size <= most
        print(f"{f'struct rho_{name}, {text}':66} {size:9} {most:9}  {'ok' if size <= most else 'MISSED'}")
    return fits


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bars", action="store_true")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--documents", default=cross.HOME)
    options = parser.parse_args()
    folder = pathlib.Path(options.documents).absolute()
    os.chdir(cross.HOME)
    wrong = []
    if not options.bars:
        measured = Measured()
        if options.update:
            update(measured, folder)
            return
        print(page(measured))
        if not compare(measured, folder):
            wrong.append("size: the documents say something else: make size-update, and look at the difference")
        print()
    if not bars():
        wrong.append("size: an object is larger than it may be")
    sys.exit("\n".join(wrong) or 0)


if __name__ == "__main__":
    main()
