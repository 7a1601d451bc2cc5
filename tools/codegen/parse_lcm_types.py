# SPDX-License-Identifier: MIT
"""Reads the .lcm files of rhotrack: structs, constants, fields with the ranges in their comments,
and fingerprints.

It understands the part of the LCM type language that lcm_types/ uses: one struct a file, primitive
numbers, constants, fixed arrays of primitives, and at most one list, which ends the struct and
stands right behind the int16_t that counts it. A field's trailing comment may end with the field's
range, [min .. max], or with the constants that it may have, {A, B}.
"""
import dataclasses
import pathlib
import re
import sys

PRIMITIVES = {"int8_t": 1, "int16_t": 2, "int32_t": 4, "int64_t": 8, "float": 4}
NAME = r"[A-Za-z_]\w*"
MASK = (1 << 64) - 1
ARRAY_MAX = 255  # longest array: a run of the codec's tables has a count of one byte


@dataclasses.dataclass
class Field:
    """One member of a struct. dimension: "" for a scalar, a number for an array, the name of the
    counting member for the list."""
    type: str
    name: str
    dimension: str
    comment: str
    minimum: str = ""
    maximum: str = ""
    choices: tuple = ()
    line: int = 1  # line of the member in its .lcm file

    @property
    def is_list(self):
        return bool(self.dimension) and not self.dimension.isdigit()

    @property
    def length(self):
        return int(self.dimension) if self.dimension.isdigit() else 1


@dataclasses.dataclass
class Struct:
    path: pathlib.Path
    comment: list
    package: str
    name: str
    constants: dict
    fields: list

    @property
    def short(self):
        return self.name.removesuffix("_t")

    @property
    def list(self):
        """The list that ends the struct, or None."""
        return self.fields[-1] if self.fields and self.fields[-1].is_list else None

    @property
    def head(self):
        """The fields before the list and its count; all fields where there is no list."""
        return self.fields[:-2] if self.list else self.fields

    @property
    def list_max(self):
        return self.constants["MAX_" + self.list.name.upper()]

    @property
    def channel(self):
        """The channel that the struct's comment names, without a sensor's number, and whether the
        number follows in the channel's name."""
        found = re.search(r"Channel (RHO_\w+?)(<sensor_id>)?\.", " ".join(self.comment))
        return (found.group(1), bool(found.group(2))) if found else (None, False)


def exit_with_error(path, line, text):
    sys.exit(f"{path}:{line}: {text}")


def take_range_from_comment(field):
    """Takes the range or the choices off the end of a field's comment. False where something in the
    comment looks like one, but is none, or is not at its end."""
    ranged = re.search(r"\[(\S+) \.\. ([^\]]+)\]$", field.comment)
    chosen = re.search(r"\{([^}]+)\}$", field.comment)
    if ranged:
        field.minimum, field.maximum = ranged.groups()
    if chosen:
        field.choices = tuple(name.strip() for name in chosen.group(1).split(","))
    for found in (ranged, chosen):
        if found:
            field.comment = field.comment[:found.start()].strip().rstrip(",;")
    return not re.search(r"[]}]$|\[\S+ \.\. |\{\w", field.comment)


def parse_field(path, number, code, comment):
    found = re.fullmatch(rf"({NAME})\s+({NAME})\s*(?:\[\s*(\w+)\s*\])?", code)
    if not found:
        exit_with_error(path, number, f"no member that is understood: {code}")
    field = Field(found.group(1), found.group(2), found.group(3) or "", comment, line=number)
    if not take_range_from_comment(field):
        exit_with_error(path, number,
                        f"{field.name}: no range [min .. max] and no {{A, B}}: {comment}")
    if "*/" in comment or "/*" in comment:
        exit_with_error(path, number,
                        f"{field.name}: the comment would end the one in C: {comment}")
    return field


def parse_constants(path, number, code):
    constants = {}
    found = re.fullmatch(r"const\s+int(8|16)_t\s+(.*)", code)
    for item in found.group(2).split(",") if found else [""]:
        pair = re.fullmatch(rf"\s*({NAME})\s*=\s*(-?\d+)\s*", item)
        if not pair:
            exit_with_error(path, number, f"no constant that is understood: {code}")
        constants[pair.group(1)] = int(pair.group(2))
        most = 1 << int(found.group(1)) - 1
        if not -most <= constants[pair.group(1)] < most:
            exit_with_error(path, number, f"a constant beyond its type: {code}")
    return constants


def lines_of_code_and_comment(path):
    """Lines of a file as (number, code, comment). A line of comment below a member goes on with its
    comment where it begins in the same column; elsewhere it is about what follows."""
    lines, column = [], -1
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        code, slashes, comment = (part.strip() for part in line.partition("//"))
        if slashes and not code and line.index("//") == column:
            lines[-1][2] += f" {comment}"
            continue
        lines.append([number, code, comment])
        column = line.index("//") if slashes and code else -1
    return lines


def parse_file(path):
    """Reads and checks the struct of one .lcm file."""
    struct = Struct(path, [], "", "", {}, [])
    for number, code, comment in lines_of_code_and_comment(path):
        if not code:
            if comment and not struct.package and not comment.startswith("SPDX"):
                struct.comment.append(comment)
            continue
        if code in "{}":
            continue
        if code.split()[0] == "struct":
            found = re.fullmatch(rf"struct\s+({NAME})\s*{{?", code)
            if not found or struct.name:
                exit_with_error(path, number,
                                f"one struct a file, its members on lines of their own: {code}")
            struct.name = found.group(1)
            continue
        if not code.endswith(";"):
            exit_with_error(path, number, f"no ; at the end: {code}")
        code = code[:-1].strip()
        if code.split()[0] == "package":
            struct.package = code.removeprefix("package").strip()
        elif code.split()[0] == "const":
            struct.constants.update(parse_constants(path, number, code))
        else:
            struct.fields.append(parse_field(path, number, code, comment))
    check_struct(struct)
    return struct


def check_struct(struct):
    """Checks a struct against the rules that keep encoders and decoders simple, and other LCM tools
    working."""
    if struct.path.stem != struct.name or not struct.name.endswith("_t"):
        exit_with_error(struct.path, 1,
                        f"struct {struct.name} belongs into {struct.name}.lcm, and ends with _t")
    if struct.package != "rhotrack":
        exit_with_error(struct.path, 1, "package rhotrack is missing")
    check_struct_comment(struct)
    names = [field.name for field in struct.fields]
    for field in struct.fields:
        if names.count(field.name) > 1:
            exit_with_error(struct.path, field.line, f"{field.name} is there twice")
    if not struct.head:
        exit_with_error(struct.path, 1, f"{struct.name} has no members, or only a list")
    for field in struct.fields:
        check_field_type(struct, field)
        check_field_range(struct, field)
    if struct.list:
        check_list(struct)


def check_struct_comment(struct):
    """Checks the comment before the package, which goes into the C header and names the channel."""
    text = " ".join(struct.comment)
    if not struct.comment:
        exit_with_error(struct.path, 1,
                        "a comment before the package is missing: what the struct is")
    if "*/" in text or "/*" in text:
        exit_with_error(struct.path, 1, "the comment before the package would end the one in C")
    if "Channel " in text and not struct.channel[0]:
        exit_with_error(
            struct.path, 1, "no channel that is understood: Channel RHO_NAME. or Channel "
            "RHO_NAME_<sensor_id>.")


def check_field_type(struct, field):
    """Checks a field's type: a number or an array of numbers, or the list at the end."""
    if field.is_list and field is not struct.fields[-1]:
        exit_with_error(struct.path, field.line, f"{field.name}: a list must be the last member")
    if field.type not in PRIMITIVES and not field.is_list:
        exit_with_error(struct.path, field.line,
                        f"{field.name}: only a list may have members of its own, and no "
                        f"{field.type}")
    if field.is_list and field.type in PRIMITIVES and field.type != "float":
        exit_with_error(struct.path, field.line,
                        f"{field.name}: a list of bare numbers must be of float")
    if field.dimension and field.length == 0:
        exit_with_error(struct.path, field.line, f"{field.name}: an array of nothing")
    if field.length > ARRAY_MAX:
        exit_with_error(struct.path, field.line, f"{field.name}: an array of more than {ARRAY_MAX}")


def check_field_range(struct, field):
    """Checks that the codec's tables can hold the range or the choices of a field."""
    def refuse(text):
        exit_with_error(struct.path, field.line, f"{field.name}: {text}")

    for choice in field.choices:
        if choice not in struct.constants:
            refuse(f"{choice} is no constant of {struct.name}")
        if not 0 <= struct.constants[choice] <= 30:
            refuse(f"{choice} is not within 0 .. 30")
    if (field.minimum or field.choices) and field.dimension and field.type != "float":
        refuse("an array of integers has no range")
    if field.choices and field.type == "float":
        refuse("a float has no constants to choose from")
    if not field.minimum or field.type not in PRIMITIVES:
        return
    if field.maximum.endswith(" - 1") and field.type != "float":
        other = field.maximum.removesuffix(" - 1")
        if not re.fullmatch(r"-?\d+", field.minimum) or other not in [
                member.name
                for member in struct.head if member.type == "int16_t" and not member.dimension
        ]:
            refuse(f"no range, as there is no int16_t {other}, or {field.minimum} is no number")
        return
    try:
        low, high = (float(text) if field.type == "float" else int(text)
                     for text in (field.minimum, field.maximum))
    except ValueError:
        refuse(f"no range of {field.type}: {field.minimum} .. {field.maximum}")
    most = 3.4e38 if field.type == "float" else (1 << 8 * PRIMITIVES[field.type] - 1) - 1
    if not -most - 1 <= low <= high <= most:
        refuse(f"no range of {field.type}: {field.minimum} .. {field.maximum}")
    if field.type == "int64_t" and (high != 4 * 10**18
                                    or low != -high) and (low, high) != (0, most):
        refuse(f"a time is within 4000000000000000000 either way, and a count within 0 .. {most}")


def check_list(struct):
    """Checks that a list has its count before it and a constant for its capacity."""
    counter = struct.fields[-2]
    if counter.name != struct.list.dimension or counter.type != "int16_t":
        exit_with_error(struct.path, struct.list.line,
                        f"{struct.list.name}: its int16_t count must stand right before it")
    most = "MAX_" + struct.list.name.upper()
    if most not in struct.constants:
        exit_with_error(struct.path, struct.list.line, f"const int16_t {most} is missing")
    if not 1 <= struct.constants[most] <= 32767:
        exit_with_error(struct.path, struct.list.line, f"{most} is not within 1 .. 32767")


def read_structs(folder):
    """Reads a folder's structs: by name, those without lists first, in alphabetic order."""
    structs = [parse_file(path) for path in sorted(folder.glob("*.lcm"))]
    structs.sort(key=lambda struct: (struct.list is not None, struct.name))
    known = {}
    for struct in structs:
        for field in struct.fields:
            if field.type not in PRIMITIVES and (field.type not in known or known[field.type].list):
                exit_with_error(struct.path, field.line,
                                f"{field.name}: there is no struct {field.type} without a list")
        known[struct.name] = struct
    return known


# ---- Sizes on the wire ----

def size_of_fields(fields):
    return sum(PRIMITIVES[field.type] * field.length for field in fields)


def size_of_list_element(struct, known):
    """Encoded bytes of one element of a struct's list."""
    kind = struct.list.type
    return PRIMITIVES[kind] if kind in PRIMITIVES else size_of_fields(known[kind].fields)


def max_message_size(struct, known):
    """Bytes of a struct's longest message, fingerprint included."""
    if not struct.list:
        return 8 + size_of_fields(struct.fields)
    return (8 + size_of_fields(struct.head) + 2 +
            struct.list_max * size_of_list_element(struct, known))


# ---- Fingerprints, as lcm-gen makes them ----

def hash_byte(value, char):
    """Adds one byte to a fingerprint: the byte is signed, and the right shift is arithmetic."""
    signed = value - (1 << 64) if value >> 63 else value
    char = char - 256 if char > 127 else char
    return (((value << 8) ^ (signed >> 55)) + char) & MASK


def hash_text(value, text):
    data = text.encode()
    value = hash_byte(value, len(data))
    for char in data:
        value = hash_byte(value, char)
    return value


def fingerprint(struct, known):
    """Hash of the members' names and types; not of the struct's name, constants or comments."""
    value = 0x12345678
    for field in struct.fields:
        value = hash_text(value, field.name)
        if field.type in PRIMITIVES:
            value = hash_text(value, field.type)
        value = hash_byte(value, 1 if field.dimension else 0)
        if field.dimension:
            value = hash_byte(value, 1 if field.is_list else 0)
            value = hash_text(value, field.dimension)
    for field in struct.fields:
        if field.type not in PRIMITIVES:
            value = (value + fingerprint(known[field.type], known)) & MASK
    return ((value << 1) | (value >> 63)) & MASK
