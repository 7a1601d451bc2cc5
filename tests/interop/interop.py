#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The messages by the Python package lcm: its event logs, and the bindings that lcm-gen -p makes.

Usage: interop.py BINDINGS IN OUT N

Reads IN/TYPE.log of each type (written by `interop write`): each message is decoded, its numbers
compared with those that follow it by name, and encoded again to the same bytes. Writes OUT/TYPE.log
with N random messages and their numbers.

Floats are any bits: infinities, subnormals, NaN with any payload. Not signalling NaN: Python's
float is a double, and the processor makes such a NaN quiet on the way. `interop write` writes none,
and here they have become quiet before they count.
"""
import importlib
import pathlib
import random
import struct
import sys

import lcm

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "vectors"))
import make_message_table  # noqa: E402 (after the path)

CODES = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f"}


class Numbers:
    """The numbers of some members, sorted by name: to bytes from an object, and from values to an
    object."""

    def __init__(self, members):
        members = sorted(members, key=lambda member: member[1])
        lengths = [int(dimension) if dimension.isdigit() else 0 for _, _, dimension, _ in members]
        self.format = struct.Struct(">" + "".join(f"{length or ''}{CODES[kind]}"
                                                  for (kind, *_), length in zip(members, lengths)))
        reads = ", ".join(
            f"{'*' if length else ''}m.{name}" for (_, name, *_), length in zip(members, lengths))
        writes, index = ["def fill(m, v):"], 0
        for (_, name, *_), length in zip(members, lengths):
            writes.append(
                f" m.{name} = {f'list(v[{index}:{index + length}])' if length else f'v[{index}]'}")
            index += length or 1
        scope = {"pack": self.format.pack}
        exec(f"def read(m): return pack({reads})\n" + "\n".join(writes), scope)
        self.read, self.fill = scope["read"], scope["fill"]

    def draw(self, source):
        """Random bits as values."""
        return self.format.unpack(source.randbytes(self.format.size))


class Type:
    """One message type: its class, and the numbers of its parts."""

    def __init__(self, shape, known):
        self.name = shape.name
        self.most = shape.most
        self.type = getattr(importlib.import_module(f"rhotrack.{shape.name}"), shape.name)
        self.head = Numbers(shape.members + ([shape.counter] if shape.list else []))
        self.list = shape.list[1] if shape.list else None
        self.counter = shape.counter[1] if shape.list else None
        self.element = None
        if shape.list and shape.list[0] not in CODES:
            self.element = Numbers(known[shape.list[0]].members)
            self.element_type = getattr(importlib.import_module(f"rhotrack.{shape.list[0]}"),
                                        shape.list[0])

    def values(self, message):
        """All numbers by name."""
        head = self.head.read(message)
        if not self.list:
            return head
        elements = getattr(message, self.list)
        if self.element:
            return head + b"".join(map(self.element.read, elements))
        return head + struct.pack(f">{len(elements)}f", *elements)

    def draw(self, source):
        """A random message."""
        message = self.type()
        self.head.fill(message, self.head.draw(source))
        if self.list:
            count = source.choice((0, self.most) + 6 * (source.randint(0, self.most),))
            setattr(message, self.counter, count)
            setattr(message, self.list,
                    [self.draw_element(source) for _ in range(count)] if self.element else list(
                        struct.unpack(f">{count}f", source.randbytes(4 * count))))
        return message

    def draw_element(self, source):
        """A random element of the list."""
        element = self.element_type()
        self.element.fill(element, self.element.draw(source))
        return element


def read(kind, path):
    """How many messages there are, and how many of them are as they should be."""
    messages = good = 0
    events = iter(lcm.EventLog(str(path), "r"))
    for event in events:
        values = next(events)
        message = kind.type.decode(event.data)
        messages += 1
        good += (event.channel == kind.name and values.channel == "VALUES" and
                 kind.values(message) == values.data and message.encode() == event.data)
    return messages, good


def write(kind, path, number, source):
    """Random messages."""
    log = lcm.EventLog(str(path), "w", overwrite=True)
    for index in range(number):
        message = kind.draw(source)
        log.write_event(2 * index, kind.name, message.encode())
        log.write_event(2 * index + 1, "VALUES", kind.values(message))
    log.close()


def main():
    bindings, logs_in, logs_out, number = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(
        sys.argv[3]), int(sys.argv[4])
    sys.path.insert(0, bindings)
    shapes = make_message_table.read()
    known = {shape.name: shape for shape in shapes}
    source = random.Random(3)
    failed = 0
    for kind in [Type(shape, known) for shape in shapes]:
        messages, good = read(kind, logs_in / f"{kind.name}.log")
        is_good = messages == good == number
        failed += not is_good
        print(
            f"{'ok  ' if is_good else 'FAIL'} {kind.name}: {good} of {messages} messages of ours "
            f"read by Python's lcm"
        )
        write(kind, logs_out / f"{kind.name}.log", number, source)
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
