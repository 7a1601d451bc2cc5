#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the library's cross-compiled objects for what it must never contain.

Forbidden on each target at -Os: external symbols other than memcpy, memset, memmove, memcmp and the
compiler's arithmetic on integers and single precision (CHARGES of stack.py); mutable globals;
frames of variable size; calls by a pointer; recursion. The last three are also checked at -O0, as
-Os can turn a recursion into a loop. tools/gates/no_heap.sh checks the
sources and this machine's objects.

Usage: object_restrictions.py [--target m0plus,m4f,m7,r5f,rv32] [ROOT]. Prints FILE:LINE: function:
fault; exit 1 where there is any.
"""
import argparse
import re
import sys

import cross_compile as cross
import stack

LIBM = (
    r"(a?(sin|cos|tan)h?|atan2|sqrt|cbrt|hypot|exp(2|m1)?|log(2|10|1p|b)?|pow|floor|ceil|trunc|"
    r"l?l?r(ound|int)|nearbyint|fmod|remainder|modf|frexp|ldexp|scalbl?n|fabs|fdim|fma|fmax|fmin|"
    r"copysign|erfc?|[lt]gamma)"
)
KINDS = [
    ("heap", r"\w*alloc|free|strn?dup|_?sbrk"),
    ("stdio",
     r"\w*(printf|scanf|putc|puts|getc|gets)|(put|get)char|f(open|close|read|write|flush)|"
     r"std(in|out|err)|_impure_ptr"),
    ("errno", r"_*errno(_location)?"),
    ("double arithmetic", r"__aeabi_(c?d\w+|\w+2d)|__\w+df\w*"),
    ("float and 64 bits, which drags in double's arithmetic",
     r"__aeabi_(f2u?lz|u?l2f)|__fix(uns)?sfdi|__float(un)?disf"),
    ("libm, double", LIBM),
    ("libm, float", LIBM + "f"),
]
MUTABLE = "BbCcDdGgSsVv" # types of nm: data, common, small data, weak objects
UNOPTIMISED = "m4f" # target that is checked at -O0, too


def kind_of_symbol(symbol):
    return next((kind for kind, names in KINDS if re.fullmatch(names, symbol)), "not the library's")


def foreign_symbols(symbols, graph):
    """A line for each function (or file) that uses an external symbol which is not allowed."""
    wanted = {}
    for source, letter, symbol in symbols:
        if letter in "Uw" and not symbol.startswith("rho_") and stack.charged_bytes(symbol) is None:
            wanted.setdefault(symbol, []).append(source)
    for symbol, sources in sorted(wanted.items()):
        what = f"{symbol} ({kind_of_symbol(symbol)})"
        callers = graph.callers(symbol)
        yield from (f"{graph.places[name]}: {stack.short_name(name)}: calls {what}"
                    for name in callers)
        yield from (f"{source}: refers to {what}" for source in sources if not callers)


def mutable_globals(symbols):
    for source, letter, symbol in symbols:
        if letter in MUTABLE:
            yield f"{source}: {symbol}: mutable global"


def call_graph_faults(graph):
    """A line for each frame of variable size, call by a pointer, and recursion in the call
    graph."""
    for name in sorted(graph.growing):
        yield f"{graph.places[name]}: {stack.short_name(name)}: frame grows at run time"
    for name in graph.callers(stack.INDIRECT):
        yield f"{graph.places[name]}: {stack.short_name(name)}: calls by a pointer"
    for cycle in graph.cycles():
        names = [stack.short_name(name) for name in cycle]
        yield f"{graph.places[cycle[0]]}: {names[0]}: recursion: {' > '.join(names)}"


def faults_of_target(target, root):
    """(fault, target and optimisation) of everything wrong on one target."""
    build = cross.Build(target, root)
    graph = stack.CallGraph(build)
    symbols = list(build.symbols())
    for text in [*foreign_symbols(symbols, graph), *mutable_globals(symbols),
                 *call_graph_faults(graph)]:
        yield text, build.target.title
    if target == UNOPTIMISED:
        unoptimised = stack.CallGraph(cross.Build(target, root, optimisation="-O0"))
        for text in call_graph_faults(unoptimised):
            yield text, f"{build.target.title} -O0"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    every = [name for name in cross.TARGETS if name != "host"]
    parser.add_argument("--target", default=",".join(every))
    parser.add_argument("root", nargs="?", default=cross.HOME)
    options = parser.parse_args()
    targets = options.target.split(",")
    for compiler in cross.missing_compilers(targets):
        print(f"skipped: gates: no {compiler} here (tools/setup.sh installs it)")
    targets = [name for name in targets if cross.TARGETS[name].is_installed()]
    found = {}
    for target in targets:
        for text, where in faults_of_target(target, options.root):
            found.setdefault(text, []).append(where)
    for text, places in sorted(found.items()):
        print(f"{text} [{', '.join(places)}]")
    if found:
        sys.exit(1)
    if targets:
        print(f"gates: clean on {', '.join(cross.TARGETS[name].title for name in targets)}")


if __name__ == "__main__":
    main()
