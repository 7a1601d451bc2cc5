#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the library must never have, looked for in its objects for the processors that it is made
for.

On each target at -Os: symbols from elsewhere but memcpy, memset, memmove, memcmp and the compiler's
own arithmetic on integers and single precision (CHARGES of stack.py); mutable globals; frames that
grow at run time; calls by a pointer; recursion. The last three also on a graph of -O0, as -Os can
turn a recursion into a loop. tools/gates/poison.sh looks at the sources and at this machine's
objects.

Usage: gates.py [--target m0plus,m4f,m7,r5f,rv32] [ROOT]. Prints FILE:LINE: function: what is wrong; exit 1 where anything
is.
"""
import argparse
import re
import sys

import cross
import stack

LIBM = (
    r"(a?(sin|cos|tan)h?|atan2|sqrt|cbrt|hypot|exp(2|m1)?|log(2|10|1p|b)?|pow|floor|ceil|trunc|l?l?r(ound|int)|"
    r"nearbyint|fmod|remainder|modf|frexp|ldexp|scalbl?n|fabs|fdim|fma|fmax|fmin|copysign|erfc?|[lt]gamma)"
)
KINDS = [
    ("heap", r"\w*alloc|free|strn?dup|_?sbrk"),
    ("stdio",
     r"\w*(printf|scanf|putc|puts|getc|gets)|(put|get)char|f(open|close|read|write|flush)|std(in|out|err)|_impure_ptr"
     ),
    ("errno", r"_*errno(_location)?"),
    ("double arithmetic", r"__aeabi_(c?d\w+|\w+2d)|__\w+df\w*"),
    ("float and 64 bits, which drags in double's arithmetic",
     r"__aeabi_(f2u?lz|u?l2f)|__fix(uns)?sfdi|__float(un)?disf"),
    ("libm, double", LIBM),
    ("libm, float", LIBM + "f"),
]
MUTABLE = "BbCcDdGgSsVv" # types of nm: data, common, small data, weak objects
UNOPTIMISED = "m4f" # looked at at -O0, too


def kind_of(symbol):
    return next((kind for kind, names in KINDS if re.fullmatch(names, symbol)), "not the library's")


def foreign(symbols, graph):
    """Symbols that the library may not take from elsewhere, by the functions that call them, or by
    their files."""
    wanted = {}
    for source, letter, symbol in symbols:
        if letter in "Uw" and not symbol.startswith("rho_") and stack.charge(symbol) is None:
            wanted.setdefault(symbol, []).append(source)
    for symbol, sources in sorted(wanted.items()):
        what = f"{symbol} ({kind_of(symbol)})"
        callers = graph.callers(symbol)
        yield from (f"{graph.places[name]}: {stack.short(name)}: calls {what}" for name in callers)
        yield from (f"{source}: refers to {what}" for source in sources if not callers)


def mutable(symbols):
    for source, letter, symbol in symbols:
        if letter in MUTABLE:
            yield f"{source}: {symbol}: mutable global"


def shape(graph):
    """What the graph of calls may not have."""
    for name in sorted(graph.growing):
        yield f"{graph.places[name]}: {stack.short(name)}: frame grows at run time"
    for name in graph.callers(stack.INDIRECT):
        yield f"{graph.places[name]}: {stack.short(name)}: calls by a pointer"
    for cycle in graph.cycles():
        yield f"{graph.places[cycle[0]]}: {stack.short(cycle[0])}: recursion: {' > '.join(map(stack.short, cycle))}"


def findings(target, root):
    """All of one target, as text and where it was seen."""
    build = cross.Build(target, root)
    graph = stack.Graph(build)
    symbols = list(build.symbols())
    for text in [*foreign(symbols, graph), *mutable(symbols), *shape(graph)]:
        yield text, build.target.title
    if target == UNOPTIMISED:
        for text in shape(stack.Graph(cross.Build(target, root, optimisation="-O0"))):
            yield text, f"{build.target.title} -O0"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    every = [name for name in cross.TARGETS if name != "host"]
    parser.add_argument("--target", default=",".join(every))
    parser.add_argument("root", nargs="?", default=cross.HOME)
    options = parser.parse_args()
    targets = options.target.split(",")
    for compiler in cross.missing(targets):
        print(f"skipped: gates: no {compiler} here (tools/setup.sh installs it)")
    targets = [name for name in targets if cross.TARGETS[name].is_there()]
    found = {}
    for target in targets:
        for text, where in findings(target, options.root):
            found.setdefault(text, []).append(where)
    for text, places in sorted(found.items()):
        print(f"{text} [{', '.join(places)}]")
    if found:
        sys.exit(1)
    if targets:
        print(f"gates: clean on {', '.join(cross.TARGETS[name].title for name in targets)}")


if __name__ == "__main__":
    main()
