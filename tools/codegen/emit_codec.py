# SPDX-License-Identifier: MIT
"""Makes the C text of the codec: include/rhotrack/message.h, src/wire/message_types.c and
src/wire/message_names.c."""
import textwrap

import parse_lcm_types
from parse_lcm_types import PRIMITIVES, exit_with_error

DATAGRAM_BYTES = 1472  # UDP payload of an Ethernet frame
SHORT_HEADER_BYTES = 8  # magic and sequence number of an LCM datagram
COLUMNS = 100  # longest line of a generated comment
CHANNEL_BYTES = 24  # longest channel name that is used, with its NUL
FLT_MAX = "FLT_MAX"
C_TYPES = {
    "int8_t": "int8_t", "int16_t": "int16_t", "int32_t": "int32_t", "int64_t": "int64_t",
    "float": "float"
}

HEADER_TOP = """\
/* SPDX-License-Identifier: MIT */
/* Made by tools/codegen from lcm_types/. Not to be edited: `make codegen`. */
/* clang-format off */
/*
 * message: encodes structs as LCM messages of rhotrack, and decodes them. No heap, liblcm or state.
 *
 * A message is a fingerprint (8 bytes, different for each struct and version) and the members in
 * their order, big endian, without gaps. Fields have the names, units and ranges of lcm_types/. The
 * capacity of a list is RHO_MESSAGE_<STRUCT>_MAX_<LIST>. The longest message of a struct has
 * RHO_MESSAGE_<STRUCT>_MAX_SIZE bytes, which fit one datagram.
 *
 * For each struct S:
 *   rho_message_S_encode    struct to bytes. Errors: NULL, COUNT (of the list: negative, or beyond
 *                           its MAX), CAPACITY (of the buffer); nothing is written. Values are not
 *                           checked: validate does that.
 *   rho_message_S_decode    bytes to struct, all of them. Errors: NULL, SHORT, TYPE (another
 *                           fingerprint), COUNT, TRAILING; *message is unchanged. Elements beyond
 *                           the list's count are unchanged in any case.
 *   rho_message_S_validate  tests that all values are finite, in their ranges, and one of their
 *                           constants. Errors: NULL, COUNT, VALUE; *place (may be NULL) tells the
 *                           member, and rho_message_S_field its name.
 * and where S ends with a list, to write a message without a copy of the list:
 *   rho_message_S_begin     the members before the count (struct rho_message_S_head) go to the
 *                           buffer. Errors: NULL, CAPACITY; *writer is unchanged, and is not to be
 *                           added to.
 *   rho_message_S_add       adds one element. Errors: NULL, STATE (not begun, or begun as another
 *                           struct), CAPACITY (of the buffer or the list); the message so far stays
 *                           whole.
 *   rho_message_end         returns the message's length, and empties the writer.
 *
 * Any bytes of any length may be decoded. data and buffer need no alignment. Calls are independent
 * of one another.
 * Cost: proportional to the bytes, 2 instructions a byte to encode or decode, 6 to validate
 * (`make instructions`).
 * Stack: 130 bytes.
 */
#ifndef RHOTRACK_MESSAGE_H
#define RHOTRACK_MESSAGE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif
"""

HEADER_END = """
#ifdef __cplusplus
}
#endif

#endif
"""

HEADER_COMMON = """
/* Place of the first member that a validate function refuses. */
struct rho_message_place {
    uint16_t offset; /* offset of the member in its struct, bytes */
    int16_t element; /* index of the list element that has the member; -1: it is before the list */
};

/* A message that is written element by element; the buffer holds a whole message at any time. */
struct rho_message_writer {
    uint8_t *buffer;
    size_t capacity, size; /* bytes of the buffer, and of the message so far */
    uint64_t fingerprint;
    uint16_t count; /* list elements written so far */
};

/* Type of a message by its fingerprint; RHO_NUM_MESSAGE_TYPES: an unknown one. Constant cost. */
enum rho_message_type rho_message_type_of(const uint8_t *data, size_t size);

/* Fingerprint and name ("plot_scan_t") of a message type; 0 and "unknown" for any other value. */
uint64_t rho_message_fingerprint(enum rho_message_type type);
const char *rho_message_type_name(enum rho_message_type type);

/* Ends a message; *size: its length. Errors: NULL, STATE (not begun). Constant cost. */
RHO_MUST_CHECK enum rho_status rho_message_end(struct rho_message_writer *writer, size_t *size);
"""

FUNCTIONS = """\
RHO_MUST_CHECK enum rho_status rho_message_{s}_encode(
    const struct rho_message_{s} *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_{s}_decode(
    const uint8_t *data, size_t size, struct rho_message_{s} *message);
RHO_MUST_CHECK enum rho_status rho_message_{s}_validate(
    const struct rho_message_{s} *message, struct rho_message_place *place);
const char *rho_message_{s}_field(const struct rho_message_place *place);
"""

WRITER_FUNCTIONS = """\
RHO_MUST_CHECK enum rho_status rho_message_{s}_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_{s}_head *head);
RHO_MUST_CHECK enum rho_status rho_message_{s}_add(
    struct rho_message_writer *writer, const {element} *{one});
"""

BODIES = """\
enum rho_status rho_message_{s}_encode(
    const struct rho_message_{s} *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{{
    return rho_message_encode(&{s}_format, message, buffer, capacity, size);
}}

enum rho_status rho_message_{s}_decode(
    const uint8_t *data, size_t size, struct rho_message_{s} *message)
{{
    return rho_message_decode(&{s}_format, data, size, message);
}}

enum rho_status rho_message_{s}_validate(
    const struct rho_message_{s} *message, struct rho_message_place *place)
{{
    return rho_message_validate(&{s}_rules, message, place);
}}
"""

WRITER_BODIES = """
enum rho_status rho_message_{s}_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_{s}_head *head)
{{
    return rho_message_begin(&{s}_format, writer, buffer, capacity, head);
}}

enum rho_status rho_message_{s}_add(
    struct rho_message_writer *writer, const {element} *{one})
{{
    return rho_message_add(&{s}_format, writer, {one});
}}
"""

TYPE_OF = """
enum rho_message_type rho_message_type_of(const uint8_t *data, size_t size)
{
    uint64_t fingerprint = 0;
    int type = 0;

    if (!data || size < MESSAGE_FINGERPRINT_BYTES) {
        return RHO_NUM_MESSAGE_TYPES;
    }
    for (unsigned i = 0; i < MESSAGE_FINGERPRINT_BYTES; i++) {
        fingerprint = fingerprint << 8 | data[i];
    }
    while (type < RHO_NUM_MESSAGE_TYPES &&
           rho_message_fingerprint((enum rho_message_type)type) != fingerprint) {
        type++;
    }
    return (enum rho_message_type)type;
}
"""


def check_sizes(known):
    """Fails where a message does not fit one datagram: receivers refuse fragments, and one lost
    fragment loses the message."""
    for struct in known.values():
        size = parse_lcm_types.max_message_size(struct, known) + SHORT_HEADER_BYTES + CHANNEL_BYTES
        if size > DATAGRAM_BYTES:
            exit_with_error(struct.path, 1,
                            f"{size} bytes with header and channel do not fit a datagram of "
                            f"{DATAGRAM_BYTES}")


def c_type_of(field):
    return C_TYPES.get(field.type) or f"struct rho_message_{field.type.removesuffix('_t')}"


def list_capacity_name(struct):
    return f"RHO_MESSAGE_{struct.short.upper()}_MAX_{struct.list.name.upper()}"


# ---- The header ----

def allowed_values_text(field):
    if field.minimum:
        return f"range {field.minimum} .. {field.maximum}"
    return f"one of {', '.join(field.choices)}" if field.choices else ""


def c_comment(text, indent=""):
    """A C comment: one line, or a wrapped block where the text is longer."""
    one = f"{indent}/* {text} */"
    lines = textwrap.wrap(text, COLUMNS, initial_indent=f"{indent} * ",
                          subsequent_indent=f"{indent} * ", break_long_words=False,
                          break_on_hyphens=False)
    return one if len(one) <= COLUMNS else "\n".join([f"{indent}/*", *lines, f"{indent} */"])


def member_declaration(struct, field):
    length = list_capacity_name(struct) if field.is_list else field.dimension
    dimension = f"[{length}]" if field.dimension else ""
    comment = "; ".join(text for text in (field.comment, allowed_values_text(field)) if text)
    line = f"    {c_type_of(field)} {field.name}{dimension};"
    one = f"{line} /* {comment} */" if comment else line
    return one if len(one) <= COLUMNS else c_comment(comment, "    ") + f"\n{line}"


def constant_macros(struct, known):
    prefix = f"RHO_MESSAGE_{struct.short.upper()}_"
    channel, has_sensor = struct.channel
    lines = []
    if channel:
        lines.append(f'#define {prefix}CHANNEL "{channel}"' +
                     (" /* then the sensor's number */" if has_sensor else ""))
    fingerprint = parse_lcm_types.fingerprint(struct, known)
    lines.append(f"#define {prefix}FINGERPRINT UINT64_C(0x{fingerprint:016x})")
    lines.append(f"#define {prefix}MAX_SIZE {parse_lcm_types.max_message_size(struct, known)}u")
    lines += [f"#define {prefix}{name} {value}" for name, value in struct.constants.items()]
    return lines


def struct_declarations(struct, known):
    comment = " ".join(struct.comment)
    lines = ["", c_comment(f"{struct.name}: {comment[0].lower()}{comment[1:]}")]
    lines += ["", *constant_macros(struct, known), "", f"struct rho_message_{struct.short} {{"]
    lines += [member_declaration(struct, field) for field in struct.fields] + ["};", ""]
    if struct.list:
        lines += [f"struct rho_message_{struct.short}_head {{"]
        lines += [f"    {c_type_of(field)} {field.name};" for field in struct.head] + ["};", ""]
    text = "\n".join(lines) + FUNCTIONS.format(s=struct.short)
    return text + (WRITER_FUNCTIONS.format(**writer_template_values(struct)) if struct.list else "")


def writer_template_values(struct):
    one = struct.list.name.removesuffix(
        "s") if struct.list.type not in PRIMITIVES else struct.list.name
    return {"s": struct.short, "element": c_type_of(struct.list), "one": one}


def header_text(known):
    lines = [HEADER_TOP, "enum rho_message_type {"]
    for index, struct in enumerate(known.values()):
        lines.append(f"    RHO_MESSAGE_TYPE_{struct.short.upper()}" +
                     (" = 0," if index == 0 else ","))
    lines.append("    RHO_NUM_MESSAGE_TYPES /* count of the values above, not a message */\n};")
    structs = "".join(struct_declarations(s, known) for s in known.values())
    return "\n".join(lines) + "\n" + HEADER_COMMON + structs + HEADER_END


# ---- CodecTables ----

class CodecTables:
    """Runs and value rules of a struct, or of its head before the list."""

    def __init__(self, name):
        self.name = name
        self.runs, self.floats, self.ints = [], [], []

    @classmethod
    def from_fields(cls, name, c_struct, fields, constants):
        tables = cls(name)
        tables.wire_bytes = parse_lcm_types.size_of_fields(fields)
        tables.add_runs(c_struct, fields)
        tables.add_floats(c_struct, fields)
        tables.add_ints(c_struct, fields, constants)
        return tables

    @classmethod
    def from_number_list(cls, name, primitive, minimum, maximum):
        """Tables of a list of bare numbers: each element is one member at offset 0."""
        tables = cls(name)
        tables.wire_bytes = PRIMITIVES[primitive]
        tables.runs.append(f"{{0, {PRIMITIVES[primitive]}, 1}}")
        tables.floats.append(f"{{0, 1, {minimum}, {maximum}}}")
        return tables

    def c_text(self):
        return (table_text(f"{self.name}_runs", "message_run", self.runs) +
                table_text(f"{self.name}_ints", "message_int_rule", self.ints) +
                table_text(f"{self.name}_floats", "message_float_rule", self.floats))

    def layout_initializer(self):
        return f"{{{self.name}_runs, {len(self.runs)}, {self.wire_bytes}}}"

    def checks_initializer(self):
        ints, floats = (f"{self.name}_{kind}" if rows else "0"
                        for kind, rows in (("ints", self.ints), ("floats", self.floats)))
        return f"{{{ints}, {floats}, {len(self.ints)}, {len(self.floats)}}}"

    def add_runs(self, c_struct, fields):
        """Adds one run for successive members of one width, which have no gap between them."""
        group = []
        for field in [*fields, None]:
            if group and (field is None or PRIMITIVES[field.type] != PRIMITIVES[group[0].type]):
                count = sum(member.length for member in group)
                self.runs.append(f"{{offsetof({c_struct}, {group[0].name}), "
                                 f"{PRIMITIVES[group[0].type]}, {count}}}")
                group = []
            group.append(field)

    def add_floats(self, c_struct, fields):
        group = []
        for field in [*fields, None]:
            same = field is not None and field.type == "float" and group and float_limits(
                field) == float_limits(group[0])
            if group and not same:
                low, high = float_limits(group[0])
                count = sum(member.length for member in group)
                self.floats.append(
                    f"{{offsetof({c_struct}, {group[0].name}), {count}, {low}, {high}}}")
                group = []
            if field is not None and field.type == "float":
                group.append(field)

    def add_ints(self, c_struct, fields, constants):
        """Rules of members that must be below another member come last, so that validation names
        the other member where that is the wrong one."""
        first, last = [], []
        for row in integer_rule_rows(c_struct, fields, constants):
            (last if "MESSAGE_BELOW" in row else first).append(row)
        self.ints += first + last


def integer_rule_rows(c_struct, fields, constants):
    """Yields a table row for successive integers of one type and rule."""
    group, group_rule = [], None
    for field in [*fields, None]:
        rule = field and integer_rule(c_struct, field, constants)
        if group and (rule != group_rule or field.type != group[0].type or
                      not rule.startswith(("MESSAGE_RANGE", "MESSAGE_COUNT"))):
            count = sum(member.length for member in group)
            yield (f"{{offsetof({c_struct}, {group[0].name}), "
                   f"{PRIMITIVES[group[0].type]}, {count}, {group_rule}}}")
            group = []
        if rule:
            group.append(field)
            group_rule = rule


def float_limits(field):
    """A float's range as C text; all finite values where none is given."""
    if not field.minimum:
        return f"-{FLT_MAX}", FLT_MAX
    return tuple(f"{float(text)!r}f" for text in (field.minimum, field.maximum))


def integer_rule(c_struct, field, constants):
    """C text of an integer's rule: kind, min and max; None where every value is allowed."""
    if field.type == "float" or not (field.minimum or field.choices):
        return None
    if field.choices:
        return "MESSAGE_ONE_OF, 0, " + " | ".join(f"1 << {constants[choice]}"
                                                  for choice in field.choices)
    if field.maximum.endswith(" - 1"):
        above = field.maximum.removesuffix(" - 1")
        return f"MESSAGE_BELOW, {field.minimum}, offsetof({c_struct}, {above})"
    if field.type == "int64_t":
        return "MESSAGE_TIME, 0, 0" if field.minimum.startswith("-") else "MESSAGE_COUNT, 0, 0"
    return f"MESSAGE_RANGE, {field.minimum}, {field.maximum}"


# ---- The source ----

def codec_tables_text(struct, tables):
    """C text of a struct's tables, its format, and its rules."""
    c_struct = f"struct rho_message_{struct.short}"
    head = tables[struct.name] = CodecTables.from_fields(struct.short, c_struct, struct.head,
                                                  struct.constants)
    own, layout, checks = head.c_text(), "{0, 0, 0}", "{0, 0, 0, 0}"
    rest = "0, 0, 0, 0"
    if struct.list:
        element = tables.get(struct.list.type)
        if struct.list.type in PRIMITIVES:
            element = CodecTables.from_number_list(f"{struct.short}_element", struct.list.type,
                                       *float_limits(struct.list))
            own += element.c_text()
        layout, checks = element.layout_initializer(), element.checks_initializer()
        rest = (f"offsetof({c_struct}, {struct.fields[-2].name}),\n"
                f"    offsetof({c_struct}, {struct.list.name}),\n"
                f"    sizeof({c_type_of(struct.list)}), {list_capacity_name(struct)}")
    return (f"{own}static const struct message_format {struct.short}_format = {{\n"
            f"    RHO_MESSAGE_{struct.short.upper()}_FINGERPRINT,\n"
            f"    {head.layout_initializer()}, {layout},\n    {rest}}};\n"
            f"static const struct message_rules {struct.short}_rules = {{\n"
            f"    &{struct.short}_format,\n    {head.checks_initializer()},\n    {checks}}};\n")


def head_layout_assertion(struct):
    """C assertion that head and whole struct have equal offsets, so that one table serves both."""
    last = struct.head[-1].name
    return (f"typedef char {struct.short}_head_fits[\n"
            f"    offsetof(struct rho_message_{struct.short}, {last}) ==\n"
            f"    offsetof(struct rho_message_{struct.short}_head, {last}) ? 1 : -1];\n")


def table_text(name, kind, rows):
    lines = "".join(
        textwrap.fill(f"{row},", 100, initial_indent="    ", subsequent_indent="     ") + "\n"
        for row in rows)
    return f"static const struct {kind} {name}[] = {{\n{lines}}};\n" if rows else ""


def source_text(known):
    tables = {}
    formats = [codec_tables_text(struct, tables) for struct in known.values()]
    parts = [
        "/* SPDX-License-Identifier: MIT */\n"
        "/* Made by tools/codegen from lcm_types/. Not to be edited: `make codegen`. */\n"
        "/* clang-format off */\n"
        "#include \"rhotrack/message.h\"\n\n#include <float.h>\n\n#include \"message_codec.h\"\n",
        *formats,
        "".join(head_layout_assertion(struct) for struct in known.values() if struct.list),
        fingerprint_functions(known)
    ]
    for struct in known.values():
        parts.append(BODIES.format(s=struct.short))
        if struct.list:
            parts[-1] += WRITER_BODIES.format(**writer_template_values(struct))
    return "\n".join(parts)


def fingerprint_functions(known):
    rows = "".join(
        f"        RHO_MESSAGE_{struct.short.upper()}_FINGERPRINT,\n" for struct in known.values())
    return ("uint64_t rho_message_fingerprint(enum rho_message_type type)\n{\n"
            f"    static const uint64_t fingerprints[RHO_NUM_MESSAGE_TYPES] = {{\n{rows}    }};\n\n"
            "    return (unsigned)type < RHO_NUM_MESSAGE_TYPES ? fingerprints[type] : 0;\n}\n" +
            TYPE_OF)


# ---- Names ----

NAMES_TOP = """\
/* SPDX-License-Identifier: MIT */
/* Made by tools/codegen from lcm_types/. Not to be edited: `make codegen`. */
/* clang-format off */
/* message_names: names of messages and members; firmware need not link them. */
#include "rhotrack/message.h"

/* Offset and name of a member; tables have the members in their order. */
struct member_name {
    uint16_t offset;
    char text[{width}];
};

/* Name of the last member that begins at the offset or before; an array is one member. */
static const char *find_member_name(const struct member_name *names, unsigned count,
                                    uint16_t offset)
{
    unsigned i = 0;

    while (i + 1 < count && names[i + 1].offset <= offset) {
        i++;
    }
    return names[i].text;
}
"""


def member_names_table(struct):
    rows = "".join(
        f'    {{offsetof(struct rho_message_{struct.short}, {field.name}), "{field.name}"}},\n'
        for field in struct.fields)
    return f"static const struct member_name {struct.short}_names[] = {{\n{rows}}};\n"


def member_name_function(struct, known):
    """C function that returns the name of the member at a place, also in a list element."""
    short = struct.short
    body = ""
    if struct.list and struct.list.type in known:
        other = known[struct.list.type].short
        body = ("    if (place && place->element >= 0) {\n"
                f"        return find_member_name({other}_names, "
                f"{len(known[struct.list.type].fields)}, place->offset);\n    }}\n")
    elif struct.list:
        body = ("    if (place && place->element >= 0) {\n"
                f"        return \"{struct.list.name}\";\n    }}\n")
    return (f"const char *rho_message_{short}_field(const struct rho_message_place *place)\n"
            f"{{\n{body}"
            f"    return place ? find_member_name({short}_names, {len(struct.fields)}, "
            "place->offset) : \"unknown\";\n}\n")


def names_source_text(known):
    width = max(len(field.name) for struct in known.values() for field in struct.fields) + 1
    type_width = max(len(name) for name in known) + 1
    rows = "".join(f'        "{name}",\n' for name in known)
    return "\n".join([
        NAMES_TOP.replace("{width}", str(width)),
        *[member_names_table(struct) for struct in known.values()],
        "const char *rho_message_type_name(enum rho_message_type type)\n{\n"
        f"    static const char type_names[RHO_NUM_MESSAGE_TYPES][{type_width}] = {{\n"
        f"{rows}    }};\n\n"
        "    return (unsigned)type < RHO_NUM_MESSAGE_TYPES ? type_names[type] : \"unknown\";\n}\n",
        *[member_name_function(struct, known) for struct in known.values()]
    ])
