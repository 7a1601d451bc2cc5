#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes seeds of fuzz targets that are made of vectors in the tree. Usage: seeds.py FOLDER"""
import pathlib
import re
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent


def main():
    folder = pathlib.Path(sys.argv[1]) / "fuzz_message"
    folder.mkdir(parents=True, exist_ok=True)
    text = (HERE.parent / "vectors" / "message_vectors.h").read_text(encoding="utf-8")
    for name, golden, lines in re.findall(r'\{"(\w+)", GOLDEN_(\w+),\s*((?:"[0-9a-f]+"\s*)+)', text):
        data = bytes.fromhex("".join(re.findall(r'"([0-9a-f]+)"', lines)))
        (folder / f"{name}-{golden.lower()}").write_bytes(data)
    write_logs(pathlib.Path(sys.argv[1]) / "fuzz_log")
    write_frames(pathlib.Path(sys.argv[1]) / "fuzz_frame")
    write_asterix(pathlib.Path(sys.argv[1]))


def write_asterix(folder):
    """Records of libasterix, one a block; and two turns of a radar, as datagrams and as recordings for the tables' readers."""
    def block(category, body):
        return struct.pack(">BH", category, len(body) + 3) + body

    def plot(turn, azimuth):
        time = int(128 * (100 + 4 * (turn + azimuth / 65536))).to_bytes(3, "big")
        return block(48, b"\xfd\x02" + b"\x00\x01" + time + b"\x20" + struct.pack(">HH", 9000, azimuth) +
                     b"\x00\x50" + b"\x80\x00\x64" if azimuth % 2 else
                     b"\xf0\x00\x01" + time + b"\x20" + struct.pack(">HH", 9000, azimuth))

    def crossing(turn, sector):
        time = int(128 * (100 + 4 * (turn + sector / 256))).to_bytes(3, "big")
        return block(34, b"\xf0\x00\x01" + (b"\x02" if sector else b"\x01") + time + bytes((sector,)))

    (folder / "fuzz_asterix").mkdir(parents=True, exist_ok=True)
    (folder / "fuzz_tables").mkdir(parents=True, exist_ok=True)
    text = (HERE.parent / "vectors" / "asterix_vectors.h").read_text(encoding="utf-8")
    for category, vectors in re.findall(r" vectors_(\d+)\[\] = \{(.*?)\n\};", text, re.S):
        for i, record in enumerate(re.findall(r'"([0-9a-f]+)"', vectors)):
            data = block(int(category), bytes.fromhex(record))
            (folder / "fuzz_asterix" / f"{category}-{i}").write_bytes(bytes((i % 8,)) + data)
    for sectors in (0, 1, 8):
        radar = b"".join(crossing(turn, 256 // sectors * i) + plot(turn, 8192 * i + 77) + plot(turn, 8192 * i + 900)
                         if i < sectors else plot(turn, 8192 * i + 77) for turn in range(4) for i in range(8))
        for rules in range(8):
            (folder / "fuzz_asterix" / f"radar-{sectors}-{rules}").write_bytes(bytes((rules,)) + radar)
            (folder / "fuzz_tables" / f"asterix-{sectors}-{rules}").write_bytes(bytes((rules,)) + radar)


def write_logs(folder):
    """Logs of short events: whole, damaged in between, cut, and one whose length takes in the next."""
    folder.mkdir(parents=True, exist_ok=True)

    def event(number, channel, data, size=None):
        return struct.pack(">IqqII", 0xEDA1DA01, number, number * 1000, len(channel),
                           len(data) if size is None else size) + channel + data

    events = [event(0, b"RHO_PLOTS_1", b"abc"), event(1, b"X", b""), event(2, b"RHO_TRACKS", b"12345678")]
    (folder / "whole").write_bytes(b"".join(events))
    (folder / "damaged").write_bytes(events[0] + b"\xed\xa1garbage" + events[1] + events[2])
    (folder / "cut").write_bytes((events[0] + events[2])[:-3])
    (folder / "lies").write_bytes(event(0, b"X", b"ab", 40) + events[1] + events[2])


def write_frames(folder):
    """An Ethernet frame of liblcm: with its checksum, and without."""
    folder.mkdir(parents=True, exist_ok=True)
    text = (HERE.parent / "firmware" / "test_udp_frame.c").read_text(encoding="utf-8")
    numbers = re.search(r"of_liblcm\[\] = \{(.*?)\}", text, re.DOTALL).group(1)
    frame = bytes(int(number, 16) for number in re.findall(r"0x\w\w", numbers))
    (folder / "liblcm").write_bytes(frame)
    (folder / "unchecked").write_bytes(frame[:40] + bytes(2) + frame[42:])


if __name__ == "__main__":
    main()
