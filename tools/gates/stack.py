#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The worst stack of every public function, by the call graph that gcc writes
(-fcallgraph-info=su), at -Os.

A function's bytes are its frame and the largest bytes of its callees. Functions of the compiler's
library and of the C library are charged as CHARGES says. Recursion, calls by a pointer and frames
that grow have no figure; gates.py forbids them. Exception frames come on top.

Usage: stack.py [--target m0plus|m4f|m7|r5f|rv32] [--workstation] [--path FUNCTION | --headers [FOLDER]]
--path shows who takes the bytes. --headers holds what the public headers state against the figures,
and exits with 1 where a function takes more, or where none is stated: `Stack: N bytes` (or KB) in
the comment above it, `no stack`, `stack as above`, or in the header's first comment for all
functions that have none of their own.
"""
import argparse
import os
import pathlib
import re
import sys

import cross

# Bytes charged to functions of other libraries, upper bounds for newlib, picolibc and libgcc of
# Debian 12: on most processors, and on those whose 64-bit arithmetic takes many calls.
CHARGES = [
    (r"mem(cpy|set|move|cmp)", 64, 64),
    (r"__aeabi_(f(add|sub|rsub|mul|div|2iz|2uiz|cmp\w+)|u?i2f|u?idiv(mod)?|lmul)", 64, 64),
    (r"__aeabi_u?ldivmod", 64, 160),
    (r"__aeabi_(llsl|llsr|lasr)|__(ashl|lshr|ashr)di3", 16, 16),
    (r"__(u?divdi3|u?moddi3)", 64, 160),
    (r"__(clz|ctz|popcount)[sd]i2|__gnu_thumb1_case_\w+", 16, 16),
]
SMALL = {"m0plus", "rv32"}
INDIRECT = "__indirect_call"


def charge(function, is_small=False):
    """Bytes charged to a function that is not the library's; None where it is none that may be
    called."""
    return next((small if is_small else size
                 for name, size, small in CHARGES if re.fullmatch(name, function)), None)


def short(function):
    """A function's name: static ones stand behind their file in the graph."""
    return function.rsplit(":", 1)[-1]


class Graph:
    """The functions of a build: bytes of their frames, where they stand, whom they call."""

    def __init__(self, build):
        self.is_small = build.name in SMALL
        self.frames, self.places, self.callees, self.growing = {}, {}, {}, set()
        self.known = {}
        for made in build.objects.values():
            self.read(made.with_suffix(".ci").read_text(encoding="utf-8"))

    def read(self, text):
        for title, label in re.findall(r'^node: \{ title: "([^"]+)" label: "([^"]*)"', text,
                                       re.MULTILINE):
            frame = re.search(r"\\n(\d+) bytes \((\w+)", label)
            if frame:
                self.frames[title] = int(frame.group(1))
                self.places[title] = label.split("\\n")[1].rsplit(":", 1)[0]
                self.callees.setdefault(title, set())
                if frame.group(2) == "dynamic":
                    self.growing.add(title)
        for caller, callee in re.findall(r'^edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"',
                                         text, re.MULTILINE):
            self.callees.setdefault(caller, set()).add(callee)

    def cycles(self):
        """The ways from a function back to itself, each once."""
        found, done = [], set()

        def visit(function, path):
            if function in path:
                found.append(path[path.index(function):] + [function])
            elif function not in done:
                for callee in sorted(self.callees.get(function, ())):
                    visit(callee, path + [function])
                done.add(function)

        for function in sorted(self.frames):
            visit(function, [])
        return found

    def callers(self, callee):
        """The functions that call one, in order."""
        return sorted(caller for caller, callees in self.callees.items() if callee in callees)

    def worst(self, function):
        """Bytes that a call takes at most, and the path on which it does."""
        if function not in self.known:
            self.known[function] = None # being looked at
            self.known[function] = self.worst_anew(function)
        if self.known[function] is None:
            sys.exit(f"stack: {short(function)} calls itself")
        return self.known[function]

    def worst_anew(self, function):
        if function not in self.frames:
            size = charge(function, self.is_small)
            if size is None:
                sys.exit(
                    f"stack: nothing is known of {function}, called by {short(self.callers(function)[0])}"
                )
            return size, [function]
        below = [self.worst(callee) for callee in sorted(self.callees[function])]
        size, path = max(below, key=lambda way: way[0], default=(0, []))
        return self.frames[function] + size, [function, *path]


class Declared:
    """A public function: its header, line, and the stack that its comment states (None:
    nothing)."""

    def __init__(self, header, line, name, stated):
        self.header, self.line, self.name, self.stated = header, line, name, stated


def stated_stack(comment):
    """Bytes of a comment's sentence on the stack, the largest of several; None where there is
    none."""
    words = re.sub(r"\s*\n\s*\*?\s*", " ", comment)
    if re.search(r"\bno stack\b", words, re.IGNORECASE):
        return 0
    sentence = re.search(r"\bstack:? ((?:[^.]|\.\d)*)", words, re.IGNORECASE)
    figures = re.findall(r"([\d.]+) (bytes|KB)", sentence.group(1)) if sentence else []
    return max((int(float(number) * (1024 if unit == "KB" else 1)) for number, unit in figures),
               default=None)


def declarations(header):
    """The functions of a header. A comment speaks for the prototypes below it up to the next empty
    line."""
    text = header.read_text(encoding="utf-8")
    for_all = stated_stack(text[:text.index("#ifndef")])
    stated, above = for_all, for_all
    pattern = r"(?P<comment>/\*.*?\*/)|(?P<empty>\n[ \t]*\n)|^(?!#)[\w *]*?\b(?P<name>rho_\w+)\([^;{]*\);"
    for found in re.finditer(pattern, text, re.DOTALL | re.MULTILINE):
        if found["comment"]:
            stated = stated_stack(found["comment"])
            if stated is None:
                stated = above if re.search(r"stack as above", found["comment"],
                                            re.IGNORECASE) else for_all
        elif found["empty"]:
            stated = for_all
        else:
            above = stated
            yield Declared(header,
                           text.count("\n", 0, found.start("name")) + 1, found["name"], stated)


def public(folder=pathlib.Path("include/rhotrack")):
    """Every function that the headers of a folder declare."""
    return [found for header in sorted(folder.rglob("*.h")) for found in declarations(header)]


def show_path(graph, function):
    size, path = graph.worst(function)
    print(f"{function}: {size} bytes")
    for name in path:
        frame = graph.frames.get(name)
        size = charge(name, graph.is_small) if frame is None else frame
        print(f"{size:7}  {short(name):36} {graph.places.get(name, 'charged')}")


def show_all(graph):
    print(f"{'bytes':>7} {'stated':>7}  function")
    for found in public():
        size, path = graph.worst(found.name)
        stated = "-" if found.stated is None else found.stated
        print(
            f"{size:7} {stated:>7}  {found.name:36} {' > '.join(short(name) for name in path[1:])}")


def check_headers(graph, folder):
    """What is wrong with the stated figures, a line each."""
    for found in public(folder):
        size, path = graph.worst(found.name)
        place = f"{found.header}:{found.line}: {found.name}"
        if found.stated is None:
            yield f"{place} states no stack; it takes {size} bytes"
        elif size > found.stated:
            yield f"{place} states {found.stated} bytes of stack; it takes {size}: {' > '.join(map(short, path))}"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--target", choices=cross.TARGETS, default="m4f")
    parser.add_argument("--workstation", action="store_true")
    parser.add_argument("--path")
    parser.add_argument("--headers", nargs="?", const="include/rhotrack")
    options = parser.parse_args()
    folder = pathlib.Path(options.headers).absolute() if options.headers else None
    os.chdir(cross.HOME)
    if cross.missing([options.target]):
        print(
            f"skipped: stack: no {cross.missing([options.target])[0]} here (tools/setup.sh installs it)"
        )
        return
    graph = Graph(
        cross.Build(options.target, profile="workstation" if options.workstation else "embedded"))
    if options.path:
        if options.path not in graph.frames:
            sys.exit(f"stack: there is no {options.path}")
        show_path(graph, options.path)
    elif folder:
        wrong = list(check_headers(graph, folder))
        print("\n".join(wrong)
              or f"stack: {len(public())} public functions take what their headers state, or less")
        sys.exit(1 if wrong else 0)
    else:
        show_all(graph)


if __name__ == "__main__":
    main()
