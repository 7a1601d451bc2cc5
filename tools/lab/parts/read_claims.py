# SPDX-License-Identifier: MIT
"""The tables of the register of claims, tools/lab/claims/*.ini: a file a paper, a section a row.

Section [paper] has title, by, and rows: what the paper numbers, as in `equation 1-34, figure 1-15`;
each must have a row. Sections [see NAME] have a command that shows the code of some files (code:
beginnings of their paths) at work, and what it shows. All others are rows:

  says         the claim in short words
  code         lines of FILE FUNCTION where it is computed
  test         lines of FILE TEST
  measured     lines of NAME[, NAME...]: EXPERIMENT PATH, figures of ours. PATH walks an
               experiment's figures.json, as in cases[case=IV;method=HT].votes: members, and of a
               list the object with such members, or that of an index. HT|MHT in it is one name
               each. EXPERIMENT `own` is claims_figures.py
  paper        the paper's value; default: says
  shown        text of the figures, {NAME:.2f}
  holds        expression of the names: whether the claim is true
  why          the reason where it does not hold, or a remark where it does
  at, at_measured, at_holds
               where else it holds: TEXT with {}: EXPERIMENT PATH by MEMBER[^2] of a list; the
               figures of its objects with the same MEMBER, and the expression
  lost         what the paper's text does not say, and what is taken instead
  definition   why nothing is computed
  differs      what is computed instead

A row has `holds` with `measured`; or `lost`; or `definition`; or `differs`; or code and test alone,
which is held where its tests pass. differs has code and test, too, or neither: nothing computes it.
"""
import ast
import configparser
import pathlib
import re
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parents[3]
FOLDER = ROOT / "tools" / "lab" / "claims"
KEYS = {"says", "code", "test", "measured", "paper", "shown", "holds", "why", "at", "at_measured",
        "at_holds", "lost", "definition", "differs"}
FUNCTIONS = {"min": min, "max": max, "abs": abs}
STEP = re.compile(r"\.?([\w -]+)|\[(\d+)\]|\[([^\]]+)\]")


class Fault(Exception):
    """A fault of a table; the message begins with its file and row."""


@dataclass
class Row:
    file: str
    name: str
    says: str
    code: list  # (file, function)
    test: list  # (file, test)
    measured: list  # (name, experiment, path)
    texts: dict
    at: tuple | None = None  # (text, experiment, path, member, power)
    at_measured: list = field(default_factory=list)  # (name, path)

    def fault(self, text):
        return Fault(f"{self.file}: [{self.name}]: {text}")


@dataclass
class Paper:
    file: str
    title: str
    by: str
    see: list  # (name, what, command, beginnings of files)
    rows: list


def lines_of(text):
    return [line.strip() for line in (text or "").splitlines() if line.strip()]


def pairs_of(row, key, text):
    pairs = []
    for line in lines_of(text):
        file, _, name = line.partition(" ")
        if not name or " " in name:
            raise row.fault(f"{key} is FILE NAME, not `{line}`")
        pairs.append((file, name))
    return pairs


def spread(path, count):
    """count paths: of A|B in [...] each has one."""
    found = re.search(r"=([^;\]=]*\|[^;\]]*)", path) or re.search(r"\.([\w ]+\|[\w |]+)$", path)
    if not found:
        return [path] * count
    return [path[:found.start(1)] + one + path[found.end(1):] for one in found[1].split("|")]


def figures_of(row, key, text):
    figures = []
    for line in lines_of(text):
        found = re.fullmatch(r"([\w, ]+): ([\w-]+) (.+)", line)
        if not found:
            raise row.fault(f"{key} is NAME: EXPERIMENT PATH, not `{line}`")
        names = [name.strip() for name in found[1].split(",")]
        paths = spread(found[3], len(names))
        if len(paths) != len(names) or not all(name.isidentifier() for name in names):
            raise row.fault(f"{key}: {len(names)} names of {len(paths)} figures in `{line}`")
        figures += [(name, found[2], path) for name, path in zip(names, paths)]
    return figures


def check_expression(row, key, text, names):
    try:
        tree = ast.parse(text, mode="eval")
    except SyntaxError as error:
        raise row.fault(f"{key} is no expression: {error.msg}") from error
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and node.id not in names and node.id not in FUNCTIONS:
            raise row.fault(f"{key}: no figure {node.id}")


def check_shown(row, names):
    for name in re.findall(r"\{(\w+)", row.texts["shown"]):
        if name not in names:
            raise row.fault(f"shown: no figure {name}")


def row_of(file, name, section):
    row = Row(file, name, section.get("says", ""), [], [], [], dict(section))
    if unknown := set(section) - KEYS:
        raise row.fault(f"no key {', '.join(sorted(unknown))}")
    if "|" in name:
        raise row.fault("a name has no |")
    if not row.says:
        raise row.fault("says nothing")
    row.code = pairs_of(row, "code", section.get("code"))
    row.test = pairs_of(row, "test", section.get("test"))
    row.measured = figures_of(row, "measured", section.get("measured"))
    names = {figure[0] for figure in row.measured}
    kinds = [key for key in ("holds", "lost", "definition", "differs") if key in section]
    if len(kinds) > 1:
        raise row.fault(f"has {' and '.join(kinds)}")
    if row.measured and not ("holds" in section or "lost" in section):
        raise row.fault("is measured, and does not say when it holds")
    if "holds" in section:
        if not row.measured:
            raise row.fault("holds, and nothing is measured")
        check_expression(row, "holds", section["holds"], names)
    if "differs" in section and bool(row.code) != bool(row.test):
        raise row.fault("differs, and has code or test alone")
    if not kinds and not (row.code and row.test):
        raise row.fault("has neither figures nor code and test")
    if row.measured and "shown" not in section:
        raise row.fault("is measured, and shows nothing")
    if "shown" in section:
        check_shown(row, names)
    if "at" in section:
        found = re.fullmatch(r"(.*\{\}.*): ([\w-]+) (.+) by (\w+)(\^2)?", section["at"])
        if not found:
            raise row.fault("at is TEXT {}: EXPERIMENT PATH by MEMBER")
        row.at = (*found.groups()[:4], 2 if found[5] else 1)
        row.at_measured = [(of, path) for of, _, path in figures_of(
            row, "at_measured", re.sub(": ", ": at ", section.get("at_measured", "")))]
        check_expression(row, "at_holds", section.get("at_holds", ""),
                         {of for of, _ in row.at_measured})
    return row


def numbered(text):
    """The rows' names: `equation 1-3, step 1` are equation 1, 2, 3 and step 1."""
    names = []
    for part in text.split(","):
        kind, _, numbers = part.strip().partition(" ")
        first, _, last = numbers.partition("-")
        names += [f"{kind} {n}" for n in range(int(first), int(last) + 1)] if last else [
            part.strip()]
    return names


def read(path):
    """The Paper of a table."""
    try:
        file = path.relative_to(ROOT).as_posix()
    except ValueError:
        file = str(path)
    parser = configparser.ConfigParser(interpolation=None, delimiters=("=",),
                                       comment_prefixes=(";",))
    parser.optionxform = str
    try:
        parser.read_string(path.read_text(encoding="utf-8"), file)
    except configparser.Error as error:
        raise Fault(f"{file}: {' '.join(str(error).split())}") from error
    for key in ("title", "by", "rows"):
        if not parser.has_option("paper", key):
            raise Fault(f"{file}: [paper]: no {key}")
    see = []
    for name in parser.sections():
        if name.startswith("see "):
            of = parser[name]
            if set(of) != {"what", "command", "code"}:
                raise Fault(f"{file}: [{name}]: has what, command and code")
            see.append((name[4:], of["what"], of["command"], of["code"].split()))
    rows = [row_of(file, name, parser[name]) for name in parser.sections()
            if name != "paper" and not name.startswith("see ")]
    missing = set(numbered(parser["paper"]["rows"])) - {row.name for row in rows}
    if missing:
        raise Fault(f"{file}: no row {', '.join(sorted(missing))}")
    return Paper(file, parser["paper"]["title"], parser["paper"]["by"], see, rows)


def read_all(folder=FOLDER):
    paths = sorted(folder.glob("*.ini"))
    if not paths:
        raise Fault(f"{folder}: no table")
    return [read(path) for path in paths]


# ---- figures ----


def is_it(value, wanted):
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        try:
            return abs(value - float(wanted)) <= 1e-9 * max(1, abs(value))
        except ValueError:
            return False
    return str(value) == wanted


def matches(item, selector):
    pairs = [part.split("=", 1) for part in selector.split(";")]
    return all(len(pair) == 2 and pair[0] in item and is_it(item[pair[0]], pair[1])
               for pair in pairs)


def walk(value, path):
    """The figure at the path; KeyError where there is none."""
    end = 0
    while end < len(path):
        found = STEP.match(path, end)
        if not found:
            raise KeyError(path)
        member, index, selector = found.groups()
        if member is not None:
            value = value[member]
        elif index is not None:
            value = value[int(index)]
        else:
            items = [item for item in value if matches(item, selector)]
            if len(items) != 1:
                raise KeyError(f"{len(items)} of [{selector}]")
            value = items[0]
        end = found.end()
    return value


def figure(row, figures, experiment, path):
    """A figure of an experiment; None where it could not be measured."""
    try:
        value = walk(figures[experiment], path)
    except (KeyError, IndexError, TypeError) as error:
        raise row.fault(f"no figure {experiment} {path} ({error})") from error
    if value is not None and not isinstance(value, (int, float)):
        raise row.fault(f"{experiment} {path} is no number")
    return value


def is_true(expression, values):
    return bool(eval(expression, {"__builtins__": {}}, {**FUNCTIONS, **values}))


def where_else(row, figures):
    """At which levels of `at` the claim holds, as text."""
    text, experiment, path, member, power = row.at
    try:
        items = walk(figures[experiment], path)
        levels = list(dict.fromkeys(item[member] for item in items))
    except (KeyError, IndexError, TypeError) as error:
        raise row.fault(f"no list {experiment} {path} ({error})") from error
    held = []
    for level in levels:
        of = {"at": [item for item in items if item[member] == level]}
        values = {name: figure(row, of, "at", inner) for name, inner in row.at_measured}
        if None not in values.values() and is_true(row.texts["at_holds"], values):
            held.append(level)

    def listed(some):
        return text.format(", ".join(f"{level**power:.3g}" for level in some))

    return f"holds at {listed(held)}" if held else f"does not at {listed(levels)} either"
