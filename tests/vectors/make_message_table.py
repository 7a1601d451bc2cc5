#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes message_table.h beside itself: the messages of lcm_types/*.lcm as tables for the tests of
the codec.

Usage: make_message_table.py [--check]
--check writes nothing: exit 1 where the file is not what would be written.

It reads the .lcm files by itself and shares nothing with tools/codegen, whose work the tests check.
"""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
TYPES = HERE.parent.parent / "lcm_types"
WIDTH = {"int8_t": 1, "int16_t": 2, "int32_t": 4, "int64_t": 8, "float": 4}

TOP = """\
/* SPDX-License-Identifier: MIT */
/* Made by make_message_table.py from lcm_types/. */
/*
 * Included once for each family of structs: MESSAGE_TABLE(name) names a table, MESSAGE_STRUCT(s)
 * the C type of struct s, MESSAGE_HEAD(s, m) is the offset of a member in the struct of the members
 * before the list, MESSAGE_LIST_IS_POINTER whether the struct holds a pointer to its list. The
 * tables' own types stand in tests/unit/wire/message_shape.h.
 */
"""


def comments_on_one_line(text):
    """The text with each comment on one line: lines of comment in its column belong to it."""
    lines = []
    for line in text.splitlines():
        at = line.find("//")
        if at >= 0 and not line[:at].strip() and lines and lines[-1].find("//") == at:
            lines[-1] += line[at + 2:]
        else:
            lines.append(line)
    return "\n".join(lines)


class Struct:
    """A struct: members as (type, name, dimension, rule), constants, channel."""

    def __init__(self, path):
        text = comments_on_one_line(path.read_text(encoding="utf-8"))
        self.name = re.search(r"^struct (\w+)", text, re.M).group(1)
        self.short = self.name.removesuffix("_t")
        self.constants = {
            name: int(value)
            for line in re.findall(r"^\s*const \w+ (.*);", text, re.M)
            for name, value in re.findall(r"(\w+) = (-?\d+)", line)
        }
        channel = re.search(r"Channel (RHO_[A-Z_]+)", text)
        self.channel = channel.group(1) if channel else None
        self.members = []
        for kind, name, dimension, comment in re.findall(
                r"^\s*(\w+)\s+(\w+)(?:\[(\w+)\])?;(?:[ ]*//(.*))?$", text.split("{", 1)[1], re.M):
            self.members.append((kind, name, dimension, comment.strip()))
        self.list = self.members.pop(
        ) if self.members[-1][2] and not self.members[-1][2].isdigit() else None
        self.counter = self.members.pop() if self.list else None
        self.most = self.constants["MAX_" + self.list[1].upper()] if self.list else 0


def read(folder=TYPES):
    """All structs; those without a list first, which is the order of enum rho_message_type."""
    return sorted((Struct(path) for path in folder.glob("*.lcm")), key=lambda s:
                  (s.list is not None, s.name))


def rule(struct, kind, comment):
    """What a comment allows, as designated initialisers."""
    ranged = re.search(r"\[(\S+) \.\. (\S+?)( - 1)?\]$", comment)
    chosen = re.search(r"\{(.*)\}$", comment)
    if chosen:
        values = [str(struct.constants[name]) for name in chosen.group(1).split(", ")]
        return (f".rule = MEMBER_ONE_OF, .choices = {{{', '.join(values)}}}, "
                f".num_choices = {len(values)}")
    if ranged and ranged.group(3):
        return (".rule = MEMBER_BELOW, "
                f".other = offsetof(MESSAGE_STRUCT({struct.short}), {ranged.group(2)})")
    if kind == "float":
        low, high = ranged.group(1, 2) if ranged else ("-FLT_MAX", "FLT_MAX")
        return f".is_float = true, .low = (float)({low}), .high = (float)({high})"
    if not ranged:
        return ".rule = MEMBER_ANY"
    return (f".rule = MEMBER_RANGE, .min = INT64_C({ranged.group(1)}), "
            f".max = INT64_C({ranged.group(2)})")


def row(struct, member, offset=None):
    """One line of a table of members."""
    kind, name, dimension, comment = member
    head = f"MESSAGE_HEAD({struct.short}, {name})" if struct.list and offset is None else "0"
    offset = offset or f"offsetof(MESSAGE_STRUCT({struct.short}), {name})"
    count = dimension if dimension.isdigit() else "1"
    return (f'    {{"{name}", {offset}, {head}, {WIDTH[kind]}, {count}, '
            f"{rule(struct, kind, comment)}}},\n")


def tables(struct):
    """The members of the struct, and of its list's elements where these are bare numbers."""
    text = f"static const struct message_member MESSAGE_TABLE({struct.short})[] = {{\n"
    text += "".join(row(struct, member) for member in struct.members) + "};\n"
    if struct.list and struct.list[0] in WIDTH:
        text += (
            f"static const struct message_member MESSAGE_TABLE({struct.short}_element)[] = {{\n"
            f"{row(struct, struct.list, '0')}}};\n")
    return text


def shape(struct, known):
    """The struct's line in the table of messages."""
    text = f'    {{"{struct.name}", MESSAGE_TABLE({struct.short}), {len(struct.members)}, ' \
           f"sizeof(MESSAGE_STRUCT({struct.short}))"
    if not struct.list:
        return text + ", .element_members = NULL},\n"
    kind, name = struct.list[:2]
    element, size, number, wire = f"{struct.short}_element", f"sizeof({kind})", 1, WIDTH.get(kind)
    if kind in known:
        members = known[kind].members
        element, size, number = known[
            kind].short, f"sizeof(MESSAGE_STRUCT({known[kind].short}))", len(members)
        wire = sum(WIDTH[member[0]] * int(member[2] or 1) for member in members)
    c_struct = f"MESSAGE_STRUCT({struct.short})"
    counter = struct.counter[1]
    return (f'{text},\n     {{"{counter}", offsetof({c_struct}, {counter}), 0, 2, 1, '
            f".rule = MEMBER_ANY}},\n     offsetof({c_struct}, {name}), MESSAGE_TABLE({element}), "
            f"{number}, {size}, {wire}, {struct.most}, MESSAGE_LIST_IS_POINTER}},\n")


def header(structs):
    """The whole file."""
    known = {struct.name: struct for struct in structs}
    each = "".join(
        f" X({struct.short}, {struct.short.upper()})" for struct in structs if not struct.list)
    lists = "".join(f" X({s.short}, {s.short.upper()}, \"{s.channel}\")" for s in structs if s.list)
    return (
        TOP + "#ifndef RHOTRACK_TEST_MESSAGE_TABLE\n#define RHOTRACK_TEST_MESSAGE_TABLE\n"
        f"#define MESSAGES_WITHOUT_LIST(X){each}\n#define MESSAGES_WITH_LIST(X){lists}\n#endif\n\n"
        + "\n".join(tables(struct) for struct in structs) +
        "\nstatic const struct message_shape MESSAGE_TABLE(shapes)[] = {\n" +
        "".join(shape(struct, known) for struct in structs) + "};\n")


def main():
    path = HERE / "message_table.h"
    text = header(read())
    if sys.argv[1:] == ["--check"]:
        sys.exit(0 if path.read_text(
            encoding="utf-8") == text else f"{path}: not what lcm_types/ says; run {__file__}")
    path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
