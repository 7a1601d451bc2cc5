#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the LCM codec of rhotrack from lcm_types/*.lcm: message.h, message_types.c,
message_names.c, and the table in lcm_types/README.md.

Usage: generate_lcm_codec.py [--check] [ROOT]
--check writes nothing, and names each file that differs from what would be written; exit 1 where
there is one.
"""
import pathlib
import sys
import textwrap

import emit_codec
import parse_lcm_types

BEGIN, END = "<!-- made by tools/codegen -->", "<!-- end -->"


def message_table(known):
    """Markdown table of the messages' channels, sizes and fingerprints."""
    rows = [
        "| struct | channel | at most | list | bytes at most | fingerprint |",
        "|---|---|---|---|---|---|"
    ]
    for struct in known.values():
        channel, has_sensor = struct.channel
        channel = f"`{channel}{'<sensor_id>' if has_sensor else ''}`" if channel else "-"
        most = struct.list_max if struct.list else "-"
        name = f"`{struct.list.name}`" if struct.list else "-"
        size = parse_lcm_types.max_message_size(struct, known)
        fingerprint = parse_lcm_types.fingerprint(struct, known)
        rows.append(f"| [{struct.name}]({struct.name}.lcm) | {channel} | {most} | {name} | "
                    f"{size} | `{fingerprint:016x}` |")
    return "\n".join(rows)


def readme_with_new_table(path, known):
    """Text of the README with the table between its two marks made anew."""
    text = path.read_text(encoding="utf-8")
    if BEGIN not in text or END not in text:
        sys.exit(f"{path}: no lines {BEGIN} and {END}")
    head, rest = text.split(BEGIN, 1)
    return f"{head}{BEGIN}\n{message_table(known)}\n{END}{rest.split(END, 1)[1]}"


def main():
    arguments = sys.argv[1:]
    is_check = "--check" in arguments
    arguments = [argument for argument in arguments if argument != "--check"]
    if len(arguments) > 1 or any(argument.startswith("-") for argument in arguments):
        sys.exit(textwrap.dedent(__doc__).strip())
    root = pathlib.Path(
        arguments[0]) if arguments else pathlib.Path(__file__).resolve().parent.parent.parent
    known = parse_lcm_types.read_structs(root / "lcm_types")
    if not known:
        sys.exit(f"{root / 'lcm_types'}: no .lcm files")
    emit_codec.check_sizes(known)
    files = {
        root / "include/rhotrack/message.h": emit_codec.header_text(known),
        root / "src/wire/message_types.c": emit_codec.source_text(known),
        root / "src/wire/message_names.c": emit_codec.names_source_text(known),
        root / "lcm_types/README.md": readme_with_new_table(root / "lcm_types/README.md", known),
    }
    stale = [path for path, text in files.items()
             if not path.is_file() or path.read_text(encoding="utf-8") != text]
    for path in stale:
        if is_check:
            print(f"{path.relative_to(root)}: not what lcm_types/ says; run make codegen")
        else:
            path.write_text(files[path], encoding="utf-8")
            print(f"codegen: {path.relative_to(root)}")
    sys.exit(1 if is_check and stale else 0)


if __name__ == "__main__":
    main()
