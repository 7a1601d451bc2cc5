#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The worst stack of every public function, by the call graph that gcc writes
(-fcallgraph-info=su), at -Os.

A function's stack is its frame plus the largest stack of its callees. Functions of the compiler's
library and of the C library are charged the bytes in CHARGES. Recursion, calls by a pointer and
frames of variable size have no figure; object_restrictions.py forbids them. Exception frames come
on top.

Usage: stack.py [--target m0plus|m4f|m7|r5f|rv32] [--workstation] [--path FUNCTION | --headers
[FOLDER]] --path prints the frames on the worst path of a function. --headers compares the figures
with those that the public headers state, and exits with 1 where a function takes more, or none is
stated. A header states `Stack: N bytes` (or KB), `no stack` or `stack as above` in the comment
above a function, or in its first comment for all functions without a statement of their own.
"""
import argparse
import os
import pathlib
import re
import sys

import cross_compile as cross

# (function, bytes, bytes on SMALL targets) charged to functions of other libraries: upper bounds
# for newlib, picolibc and libgcc of Debian 12. SMALL targets need many calls for 64-bit arithmetic.
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


def charged_bytes(function, is_small=False):
    """Bytes charged to a function of another library; None where the library may not call it."""
    return next((small if is_small else size
                 for name, size, small in CHARGES if re.fullmatch(name, function)), None)


def short_name(function):
    """A function's name without the file that the graph puts before the names of static ones."""
    return function.rsplit(":", 1)[-1]


class CallGraph:
    """Call graph of a build: each function's frame size, place in the source, and callees."""

    def __init__(self, build):
        self.is_small = build.name in SMALL
        self.frames, self.places, self.callees, self.growing = {}, {}, {}, set()
        self.known = {}
        for made in build.objects.values():
            self.add_functions(made.with_suffix(".ci").read_text(encoding="utf-8"))

    def add_functions(self, text):
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
        """The cycles of calls, each once, as lists that begin and end with the same function."""
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
        """The functions that call `callee`, sorted."""
        return sorted(caller for caller, callees in self.callees.items() if callee in callees)

    def worst_stack(self, function):
        """The largest stack of a call in bytes, and the path of calls that needs it."""
        if function not in self.known:
            self.known[function] = None # on the path being searched
            self.known[function] = self.compute_worst_stack(function)
        if self.known[function] is None:
            sys.exit(f"stack: {short_name(function)} calls itself")
        return self.known[function]

    def compute_worst_stack(self, function):
        if function not in self.frames:
            size = charged_bytes(function, self.is_small)
            if size is None:
                sys.exit(
                    f"stack: nothing is known of {function}, called by "
                    f"{short_name(self.callers(function)[0])}"
                )
            return size, [function]
        below = [self.worst_stack(callee) for callee in sorted(self.callees[function])]
        size, path = max(below, key=lambda way: way[0], default=(0, []))
        return self.frames[function] + size, [function, *path]


class PublicFunction:
    """A public function: its header, line, name, and the stack stated in its comment (None: not
    stated)."""

    def __init__(self, header, line, name, stated):
        self.header, self.line, self.name, self.stated = header, line, name, stated


def stated_stack(comment):
    """The stack in bytes that a comment states, the largest of several figures; None where it
    states none."""
    words = re.sub(r"\s*\n\s*\*?\s*", " ", comment)
    if re.search(r"\bno stack\b", words, re.IGNORECASE):
        return 0
    sentence = re.search(r"\bstack:? ((?:[^.]|\.\d)*)", words, re.IGNORECASE)
    figures = re.findall(r"([\d.]+) (bytes|KB)", sentence.group(1)) if sentence else []
    return max((int(float(number) * (1024 if unit == "KB" else 1)) for number, unit in figures),
               default=None)


def public_functions_of(header):
    """The functions that a header declares. A comment holds for the prototypes below it up to the
    next empty line."""
    text = header.read_text(encoding="utf-8")
    for_all = stated_stack(text[:text.index("#ifndef")])
    stated, above = for_all, for_all
    pattern = (r"(?P<comment>/\*.*?\*/)|(?P<empty>\n[ \t]*\n)|"
               r"^(?!#)[\w *]*?\b(?P<name>rho_\w+)\([^;{]*\);")
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
            yield PublicFunction(header,
                           text.count("\n", 0, found.start("name")) + 1, found["name"], stated)


def public_functions(folder=pathlib.Path("include/rhotrack")):
    """The functions that the headers of a folder declare."""
    return [found for header in sorted(folder.rglob("*.h"))
            for found in public_functions_of(header)]


def print_path(graph, function):
    size, path = graph.worst_stack(function)
    print(f"{function}: {size} bytes")
    for name in path:
        frame = graph.frames.get(name)
        size = charged_bytes(name, graph.is_small) if frame is None else frame
        print(f"{size:7}  {short_name(name):36} {graph.places.get(name, 'charged')}")


def print_all(graph):
    print(f"{'bytes':>7} {'stated':>7}  function")
    for found in public_functions():
        size, path = graph.worst_stack(found.name)
        stated = "-" if found.stated is None else found.stated
        print(
            f"{size:7} {stated:>7}  {found.name:36} "
            f"{' > '.join(short_name(name) for name in path[1:])}")


def faults_of_headers(graph, folder):
    """A line for each function whose stated stack is missing or too small."""
    for found in public_functions(folder):
        size, path = graph.worst_stack(found.name)
        place = f"{found.header}:{found.line}: {found.name}"
        if found.stated is None:
            yield f"{place} states no stack; it takes {size} bytes"
        elif size > found.stated:
            yield (f"{place} states {found.stated} bytes of stack; it takes {size}: "
                   f"{' > '.join(map(short_name, path))}")


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
    if cross.missing_compilers([options.target]):
        print(
            f"skipped: stack: no {cross.missing_compilers([options.target])[0]} here "
            "(tools/setup.sh installs it)"
        )
        return
    graph = CallGraph(
        cross.Build(options.target, profile="workstation" if options.workstation else "embedded"))
    if options.path:
        if options.path not in graph.frames:
            sys.exit(f"stack: there is no {options.path}")
        print_path(graph, options.path)
    elif folder:
        wrong = list(faults_of_headers(graph, folder))
        print("\n".join(wrong)
              or f"stack: {len(public_functions())} public functions take what their headers "
              "state, or less")
        sys.exit(1 if wrong else 0)
    else:
        print_all(graph)


if __name__ == "__main__":
    main()
