#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Figures of the sources' shape (size, widths, names, repeated knowledge), each with its goal.

A figure that is not yet at its goal has a bound, its value when the gate was written: it may fall,
and may not grow. A figure that has reached its goal needs no bound. What each figure counts stands
in the first lines of its function.

Usage: house.py [--check | --show] [--only FIGURE] [ROOT]. Prints a table: figure, now, goal, ok or
beyond.
"""
import argparse
import functools
import pathlib
import re
import sys

GENERATED = {
    "src/wire/message_types.c", "src/wire/message_names.c", "include/rhotrack/message.h"
}
NAME_LETTERS_MAX = 30
STEM_WORDS = 4
SHARING_MAX = 2  # constants below one comment
FIGURES = []

COMMENT_OR_STRING = re.compile(
    r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'", re.DOTALL)
# The brace of a function is alone in the first column (.clang-format).
DEFINITION = re.compile(r"^(?!#)(\w[^;{}#]*?)\b(\w+)\(([^;{}]*)\)\n\{\n(.*?)^\}", re.M | re.DOTALL)
NUMERIC_DEFINE = re.compile(r"^#define +(\w+) +[-(]*\.?[0-9]", re.M)
# A reason, and then `Half:` and `Twice:`, also with a remark in parentheses, or `Half or twice:`.
FULL_REASON = re.compile(
    r"(?!Half(?: \([^)]*\))?: |Half or twice\b)\w(?:.* Half or twice\b[^.:]*: "
    r"|(?=.* Half(?: \([^)]*\))?: )(?=.* Twice(?: \([^)]*\))?: ))")
LATE = re.compile(r"(?:\b|_)late_(?!ones\b)|_late(?:\b|_)|retrodict|out_of_sequence")


def figure(title, goal, bound=0):
    """Makes a figure of a function that returns what it counts, or (its value, lines to show)."""
    def register(count):
        FIGURES.append((count.__name__, title, goal, max(goal, bound), count))
        return count
    return register


class Sources:
    """The C files of a tree, read once."""

    def __init__(self, root):
        self.root = root
        self.functions = functools.cache(self.functions)
        self.code = functools.cache(self.code)

    def files(self, pattern, *, with_generated=False):
        """Paths of the matching C files, relative to the root."""
        paths = (path.relative_to(self.root).as_posix() for path in self.root.glob(pattern)
                 if path.suffix in (".c", ".h"))
        return sorted(path for path in paths if with_generated or path not in GENERATED)

    def text(self, path):
        return (self.root / path).read_text(encoding="utf-8")

    def code(self, path, *, with_strings=False):
        """The text without comments, and without strings where they are not asked for."""
        def blank(found):
            is_comment = found[0].startswith("/")
            return found[0] if with_strings and not is_comment else " "
        return COMMENT_OR_STRING.sub(blank, self.text(path))

    def functions(self, path):
        """(head, name, parameters, body) of each function that a file defines."""
        return DEFINITION.findall(self.code(path))

    def body_in(self, pattern, begin):
        """What stands in the braces behind the first match of a pattern."""
        for path in self.files(pattern):
            found = re.search(begin + r"[^;{}]*\{(.*?)^\}", self.code(path), re.M | re.DOTALL)
            if found:
                return found[1]
        sys.exit(f"house: nothing matches {begin} in {pattern}")


def calls(name, code):
    return re.findall(rf"\b{name}\s*\(", code)


@figure("prototypes in the widest private header of src", 40)
def prototypes(tree):
    """Declarations of functions at file level in one src/ROOM/NAME.h; inline functions are none."""
    widest = (0, [])
    for path in tree.files("src/*/*.h"):
        code = re.sub(r"^#(?:.*\\\n)*.*", "", tree.code(path), flags=re.M)
        code, replaced = re.subn(r"\{[^{}]*\}", " ", code)
        while replaced:
            code, replaced = re.subn(r"\{[^{}]*\}", " ", code)
        found = re.findall(r"\b(\w+)\([^;]*\)\s*;", code)
        names = [f"{path} {name}" for name in found if name != "_Static_assert"]
        widest = max(widest, (len(names), names))
    return widest[1]


@figure("functions that may change struct step", 45)
def step_changers(tree):
    """Functions defined in src with a parameter `struct step *` that is not const."""
    return [f"{path} {name}" for path in tree.files("src/**/*") for _, name, parameters, _ in
            tree.functions(path) if re.search(r"(?<!const )\bstruct step \*(?!const)", parameters)]


@figure("`if (` in rho_tracker_step", 3)
def step_conditions(tree):
    """`if (` in the body of rho_tracker_step, those behind an else too."""
    bodies = [body for path in tree.files("src/**/*.c")
              for _, name, _, body in tree.functions(path) if name == "rho_tracker_step"]
    if len(bodies) != 1:
        sys.exit("house: no function rho_tracker_step in src")
    return re.findall(r"\bif \(.*", bodies[0])


@figure("arrays [RHO_MAX_SENSORS] in struct rho_tracker", 1)
def sensor_tables(tree):
    """Members with `[RHO_MAX_SENSORS]` between the braces of struct rho_tracker."""
    body = tree.body_in("include/rhotrack/**/*.h", r"^struct rho_tracker\b")
    return re.findall(r"[^;]*\[RHO_MAX_SENSORS\][^;]*", body)


@figure("files of tracker, step, bodies, walls that know late scans", 6)
def late_files(tree):
    """C files with is_late, late_, _late, retrodict or out_of_sequence in a name of the code; a
    wall's late_ones are witnesses."""
    return [path for room in ("tracker", "step", "bodies", "walls")
            for path in tree.files(f"src/{room}/*") if LATE.search(tree.code(path))]


def long_names(tree, pattern):
    return sorted({f"{path} {name}" for path in tree.files(pattern, with_generated=True)
                   for _, name, _, _ in tree.functions(path) if len(name) > NAME_LETTERS_MAX})


@figure("names over 30 letters, functions of src", 120)
def long_names_src(tree):
    """Functions defined in src whose names have more than 30 letters, generated ones too."""
    return long_names(tree, "src/**/*")


@figure("names over 30 letters, functions of tools", 80)
def long_names_tools(tree):
    """Functions defined in tools/rhotrack whose names have more than 30 letters."""
    return long_names(tree, "tools/rhotrack/**/*")


def long_stems(tree, pattern):
    return sorted({pathlib.PurePath(path).stem
                   for path in tree.files(pattern, with_generated=True)
                   if len(pathlib.PurePath(path).stem.split("_")) >= STEM_WORDS})


@figure("file names of four words and more, src", 10)
def long_stems_src(tree):
    """Names of C files, each once and without its ending, with three or more `_`."""
    return long_stems(tree, "src/**/*")


@figure("file names of four words and more, tools/rhotrack", 12)
def long_stems_tools(tree):
    """Names of C files, each once and without its ending, with three or more `_`."""
    return long_stems(tree, "tools/rhotrack/**/*")


@figure("static functions of src called once, %", 48)
def statics_called_once(tree):
    """Static functions of src's .c files that their file calls once, in % of all; rounded."""
    statics, once = 0, []
    for path in tree.files("src/**/*.c"):
        code = tree.code(path)
        for head, name, _, _ in tree.functions(path):
            if re.search(r"\bstatic\b", head):
                statics += 1
                declared = re.findall(rf"^static\b[^;{{}}()]*\b{name}\([^;{{}}]*\);", code, re.M)
                if len(calls(name, code)) - len(declared) - 1 == 1:
                    once.append(f"{path} {name}")
    return round(100 * len(once) / max(statics, 1)), once


@figure("program files that know the column azimuth_deg", 1)
def azimuth_files(tree):
    """C files of tools/rhotrack with the string \"azimuth_deg\"."""
    return [path for path in tree.files("tools/rhotrack/**/*")
            if '"azimuth_deg"' in tree.code(path, with_strings=True)]


@figure("calls of walls' and zones' steps outside src", 0)
def outer_steps(tree):
    """Calls in C of tools of functions NAME_step that reflectors.h or zones.h declares;
    tools/instructions measures them and is left out."""
    names = {name for header in ("reflectors", "zones")
             for name in re.findall(r"\b(rho_\w+_step)\(",
                                    tree.code(f"include/rhotrack/{header}.h"))
             if not name.startswith("rho_tracker_")}
    return [f"{path} {name}" for path in tree.files("tools/**/*")
            if not path.startswith("tools/instructions/")
            for name in sorted(names) for _ in calls(name, tree.code(path))]


@figure("numeric defines in src", 350)
def numeric_defines(tree):
    """Lines `#define NAME number` of src; the number may begin with signs and parentheses."""
    return [f"{path} {name}" for path in tree.files("src/**/*")
            for name in NUMERIC_DEFINE.findall(tree.text(path))]


@figure("lines of src and include", 44000, 44600)
def lines(tree):
    """Lines of all C files of src and include, the generated ones apart."""
    counts = sorted((tree.text(path).count("\n"), path)
                    for pattern in ("src/**/*", "include/**/*") for path in tree.files(pattern))
    return sum(count for count, _ in counts), [f"{count:6} {path}" for count, path in counts]


@figure("objects that a user of the node owns and initialises", 1)
def node_objects(tree):
    """The node, and each pointer to a struct that is not const in the settings (third parameter)
    of rho_node_init."""
    found = re.search(r"\brho_node_init\([^;]*?(?:struct (\w+) \*\w+)\);",
                      tree.code("include/rhotrack/node.h"))
    if not found:
        sys.exit("house: no rho_node_init with settings in include/rhotrack/node.h")
    body = tree.body_in("include/rhotrack/**/*.h", rf"^struct {found[1]}\b")
    return ["struct rho_node", *re.findall(r"(?<!const )\bstruct \w+ \*+\w+", body)]


@figure("banners and odd comments in headers", 0)
def odd_comments(tree):
    """Comments of headers of include and src that begin with a row of signs, as in `/* ---- name`
    and `/**`, or with `//`."""
    odd = []
    for pattern in ("include/**/*.h", "src/**/*.h"):
        for path in tree.files(pattern, with_generated=True):
            found = (match[0] for match in COMMENT_OR_STRING.finditer(tree.text(path)))
            odd += [f"{path} {comment.splitlines()[0]}" for comment in found
                    if re.match(r"//|/\*[*!]|/\* *[-=*#+]{2}", comment)]
    return odd


@figure("constants of policy without reason, half and twice", 0)
def bare_policy(tree):
    """`#define NAME number` of src/ROOM/policy.h without a comment right above it that gives the
    reason, and then `Half:` and `Twice:`; a value and its bound below it may share one."""
    bare = []
    for path in tree.files("src/*/policy.h"):
        before, sharing = "", 0  # the text since the last define; those that had its comment
        for line in tree.text(path).splitlines():
            found = NUMERIC_DEFINE.match(line)
            if found and before:
                said = re.search(r"/\*((?:(?!\*/).)*)\*/\n$", before, re.DOTALL)
                words = " ".join(word for word in said[1].split() if word != "*") if said else ""
                sharing = SHARING_MAX if FULL_REASON.match(words) else 0
            if found and sharing == 0:
                bare.append(f"{path} {found[1]}")
            sharing = max(sharing - 1, 0)
            before = "" if line.startswith("#") else before + line + "\n"
    return bare


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    mode = parser.add_mutually_exclusive_group()
    mode.add_argument("--check", action="store_true",
                        help="print the figures above goal and bound; exit 1 where there is any")
    mode.add_argument("--show", action="store_true", help="print all that is counted")
    parser.add_argument("--only", metavar="FIGURE", choices=[each[0] for each in FIGURES],
                        help="one of " + ", ".join(each[0] for each in FIGURES))
    parser.add_argument("root", nargs="?", metavar="ROOT",
                        default=pathlib.Path(__file__).resolve().parent.parent.parent)
    options = parser.parse_args()
    tree = Sources(pathlib.Path(options.root))
    grown = []
    for name, title, goal, bound, count in FIGURES:
        if options.only not in (None, name):
            continue
        counted = count(tree)
        now, found = counted if isinstance(counted, tuple) else (len(counted), counted)
        if options.show:
            print(*found, sep="\n")
        elif options.check:
            grown += [f"{name}: {title}: {now}, at most {bound}"] if now > bound else []
        else:
            print(f"{title:58} {now:6} {goal:6} {'ok' if now <= goal else 'beyond'}")
    if options.check:
        print(*grown or ["house: no figure has grown"], sep="\n")
        sys.exit(bool(grown))


if __name__ == "__main__":
    main()
