#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes seeds and dictionaries of fuzz targets that are made of what is in the tree. Usage:
seeds.py FOLDER"""
import json
import pathlib
import re
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import write_capture  # pylint: disable=wrong-import-position


def main():
    folder = pathlib.Path(sys.argv[1]) / "fuzz_message"
    folder.mkdir(parents=True, exist_ok=True)
    text = (HERE.parent / "vectors" / "message_vectors.h").read_text(encoding="utf-8")
    for name, golden, lines in re.findall(r'\{"(\w+)", GOLDEN_(\w+),\s*((?:"[0-9a-f]+"\s*)+)',
                                          text):
        data = bytes.fromhex("".join(re.findall(r'"([0-9a-f]+)"', lines)))
        (folder / f"{name}-{golden.lower()}").write_bytes(data)
    write_logs(pathlib.Path(sys.argv[1]) / "fuzz_log")
    write_frames(pathlib.Path(sys.argv[1]) / "fuzz_ethernet_frame")
    write_asterix(pathlib.Path(sys.argv[1]))
    write_configs(pathlib.Path(sys.argv[1]))
    write_scenes(pathlib.Path(sys.argv[1]))
    write_scripts(pathlib.Path(sys.argv[1]))


def write_dictionary(path, words):
    """Of libFuzzer: what it puts in beside bytes of its own."""
    path.write_text("".join(f'"{word}"\n' for word in sorted(set(words))), encoding="utf-8")


def write_configs(folder):
    """INI files with every parameter at its default, its least and its most, with each alone at its
    most (all together contradict each other), and of two sensors; the words of all of them."""
    text = (HERE.parents[1] / "tools" / "rhotrack" / "settings" / "parameters.h").read_text(
        encoding="utf-8")
    text = re.sub(r"\\\n *", " ", text)
    every, sensors = text.split("#define SENSOR_PARAMETERS")[:2]
    rows = re.findall(r'X\(\w+, "(\w+)", "[^"]*", ([^,]+), ([^,]+), ([^,]+), \d, (\d),', every)
    own = re.findall(r'X\(\w+, "(\w+)", "[^"]*", ([^,]+), ([^,]+),', sensors)
    seeds = folder / "fuzz_config"
    seeds.mkdir(parents=True, exist_ok=True)
    words = {
        "nht_reading": "c", "vote": "counts", "prune": "literal", "initiators": "sensor",
        "gate": "hough", "input_model": "physical", "asterix_scans": "turn", "planes": "xy+xz",
        "method": "mht", "bearings_method": "passive-paper"
    }
    files = {
        "words": "".join(f"{name} = {word}\n"
                         for name, word in words.items()) + "sensors_allowed = 1, 2 -3\n"
    }
    numbers = [row for row in rows if row[4] == "1" and row[0] not in words]
    for i, name in enumerate(("default", "least", "most")):
        files[name] = "; a comment\n[rhotrack]\n" + "".join(
            f"{row[0]} = {row[1 + i]}\n" for row in numbers if not row[1 + i].startswith("RHO"))
    for name, _, _, most, _ in numbers:
        files[f"most-{name}"] = f"{name} = {most}\n"
    for i, name in enumerate(("sensor-least", "sensor-most")):
        files[name] = "range_max_m=9e4\n[sensor 3]\n" + "".join(
            f"{row[0]} = {row[1 + i]}\n"
            for row in own if not row[0].endswith("_deg") and row[0] != "alt_m" and row[0] !=
            ("range_min_m", "range_max_m")[1 - i])
    files["earth"] = (
        "origin_lat_deg = 50\norigin_lon_deg=10\n[sensor 7]\nlat_deg=50.5\nlon_deg=9.5\nalt_m=300\n"
        "\x01sensor.7.pd=0.8\x01v_max_mps=300")
    for name, lines in files.items():
        (seeds / name).write_bytes(b"\1" + lines.encode())
    write_dictionary(
        folder / "fuzz_config.dict",
        [row[0] + "="
         for row in rows + own] + ["[sensor ", "[rhotrack]", "sensors_allowed=", "\\x01sensor.1."])


def write_scenes(folder):
    """The shipped scenes, without blanks, as far as a fuzzer's inputs go; the words that their
    reader knows."""
    root = HERE.parents[1] / "tools"
    seeds = folder / "fuzz_scene"
    seeds.mkdir(parents=True, exist_ok=True)
    for path in sorted((root / "scenes").glob("*/*.json")):
        text = json.dumps(json.loads(path.read_text(encoding="utf-8")), separators=(",", ":"))
        if len(text) < 4000:
            (seeds / path.stem).write_text(text, encoding="utf-8")
            (seeds / f"{path.stem}-set").write_text(f"{text}\1duration_s=20\1radars[0].turn_s=3",
                                                    encoding="utf-8")
    words = []
    for path in (root / "rhotrack" / "scene").glob("scene_*.c"):
        words += re.findall(r'"([a-z][a-z0-9_-]+)"', path.read_text(encoding="utf-8"))
    write_dictionary(folder / "fuzz_scene.dict",
                     [f'\\"{word}\\":' for word in words] + [f'\\"{word}\\"' for word in words])


def write_scripts(folder):
    """Scripts of fuzz_tracker: scans, frames, sectors, piles, bodies, walls, images, by each
    gate."""
    def world(targets=3, turns=0, gate=0, start=8, passive=1):
        return bytes((targets, turns, 7, gate, start, start, start, passive, passive))

    def scan(how=0, after=3, clutter=None):
        return bytes((0, how | (32 if clutter else 0), after, *(clutter or ())))

    def frame(how=3, after=19):
        return bytes((128, how, after))

    describe, forget, image, push, search, passive, by_hand = 182, 184, 185, 186, 189, 191, 232
    radar = scan(clutter=(0, 6)) * 24
    scripts = {f"radar-{gate}": world(gate=gate) + radar for gate in (0, 1, 2, 5, 6, 14)}
    scripts |= {f"measures-{how}": world(targets=8 * how + 2, start=0) + radar for how in range(4)}
    scripts["two"] = world(targets=64 + 3) + (scan(0, 1) + scan(1, 1)) * 20
    scripts["own-initiators"] = world() + (scan(0, 1) + scan(8 + 1, 1)) * 20
    scripts["late"] = world() + scan() * 8 + (scan(1, 213) + scan()) * 8
    scripts["sectors"] = world(turns=1) + scan(0, 1) * 60
    scripts["bearings"] = world() + frame() * 16
    scripts["mixed"] = world() + (scan() + frame(2, 3)) * 14
    scripts["images"] = world() + (scan() * 5 + frame() * 2 + bytes((image, 1))) * 4 + bytes(
        (image, 0)) + radar
    scripts["piles"] = world(start=3) + (scan() + scan(clutter=(8, 15)) + scan(clutter=(15, 9))) * 8
    scripts["full"] = world() + scan(clutter=(6, 4)) * 3 + scan(clutter=(7, 4)) * 3 + radar
    scripts["sensors"] = world() + b"".join(bytes((describe, i))
                                            for i in range(16)) + scan() * 8 + bytes(
                                                (forget, 0)) + radar
    scripts["odd-sensors"] = world() + b"".join(
        bytes((describe, 16 + i % 3, i, number)) + scan() for i in range(13)
        for number in (4, 24, 27))
    scripts["spans"] = world(targets=8 + 2) + bytes((describe, 64, 40)) + radar
    scripts |= {
        f"bodies-{how}": world(targets=128 + 8 * how + 2, turns=turns, start=0) + radar
        for how, turns in ((0, 0), (1, 128))
    }
    scripts["walls"] = world(turns=128) + bytes((by_hand, 12, 1, 101)) + radar
    scripts["by-hand"] = world(targets=128 + 3) + scan() * 8 + b"".join(
        bytes((by_hand, what, 0, 1, 0)) + scan() for what in range(16))
    scripts["lone"] = world() + (bytes((push, 32, 3, 0, 6)) * 5 + bytes((search, 1, search, 4))) * 3
    scripts["lone-passive"] = world() + (bytes((passive, 3, 19)) * 5 + bytes(
        (passive, 128, passive, 129))) * 3
    scripts["challenged"] = world() + bytes((passive, 3, 19)) * 5 + bytes(
        (passive, 128, passive, 129, passive, 130, 3, passive, 3, 19, passive, 130, 131))
    first, last = bytes((232, 0x80, *bytes(7))), bytes((232, 0x7f, *(255,) * 7))
    scripts["ends-of-time"] = world() + b"".join(
        bytes((passive, 3)) + time for time in (first, b"\xd4", b"\3", last))
    scripts["ends-of-scans"] = world() + scan() + b"".join(
        bytes((0, 0)) + time + scan() for time in (first, last, b"\xdf", b"\xde", b"\xe8", b"\xe4"))
    for target in ("fuzz_tracker", "fuzz_tracker_small"):
        (folder / target).mkdir(parents=True, exist_ok=True)
        for name, script in scripts.items():
            (folder / target / name).write_bytes(script)


def write_asterix(folder):
    """Records of libasterix, one a block; and two turns of a radar, as datagrams and as recordings
    for the tables' readers."""
    def block(category, body):
        return struct.pack(">BH", category, len(body) + 3) + body

    def plot(turn, azimuth):
        time = int(128 * (100 + 4 * (turn + azimuth / 65536))).to_bytes(3, "big")
        return block(
            48, b"\xfd\x02" + b"\x00\x01" + time + b"\x20" + struct.pack(">HH", 9000, azimuth) +
            b"\x00\x50" + b"\x80\x00\x64" if azimuth % 2 else b"\xf0\x00\x01" + time + b"\x20" +
            struct.pack(">HH", 9000, azimuth))

    def crossing(turn, sector):
        time = int(128 * (100 + 4 * (turn + sector / 256))).to_bytes(3, "big")
        return block(34, b"\xf0\x00\x01" + (b"\x02" if sector else b"\x01") + time + bytes(
            (sector, )))

    def old(turn, azimuth):
        time = int(128 * (100 + 4 * (turn + azimuth / 65536)))
        return block(1, b"\xf2\x00\x01\x10" + struct.pack(">HHH", 4500, azimuth, time)) + (
            block(2, b"\xd0\x00\x01\x01" + time.to_bytes(3, "big")) if azimuth < 8192 else b"")

    (folder / "fuzz_asterix").mkdir(parents=True, exist_ok=True)
    (folder / "fuzz_tables").mkdir(parents=True, exist_ok=True)
    text = (HERE.parent / "vectors" / "asterix_vectors.h").read_text(encoding="utf-8")
    for category, kind, vectors in re.findall(
            r" vectors_(\d+)(_plot|_track)?\[\] = \{(.*?)\n\};", text, re.S):
        for i, record in enumerate(re.findall(r'"([0-9a-f]+)"', vectors)):
            data = block(int(category), bytes.fromhex(record))
            (folder / "fuzz_asterix" / f"{category}{kind}-{i}").write_bytes(bytes((i % 8,)) + data)
            if category == "62":
                (folder / "fuzz_tables" / f"tracks-{i}").write_bytes(bytes((i % 8,)) + data)
    for rules in range(8):
        radar = b"".join(old(turn, 8192 * i + 77) for turn in range(4) for i in range(8))
        (folder / "fuzz_asterix" / f"old-{rules}").write_bytes(bytes((rules,)) + radar)
        (folder / "fuzz_tables" / f"asterix-old-{rules}").write_bytes(bytes((rules,)) + radar)
    for sectors in (0, 1, 8):
        radar = b"".join(
            crossing(turn, 256 // sectors * i) + plot(turn, 8192 * i + 77) +
            plot(turn, 8192 * i + 900) if i < sectors else plot(turn, 8192 * i + 77)
            for turn in range(4) for i in range(8))
        for rules in range(8):
            (folder / "fuzz_asterix" /
             f"radar-{sectors}-{rules}").write_bytes(bytes((rules, )) + radar)
            (folder / "fuzz_tables" /
             f"asterix-{sectors}-{rules}").write_bytes(bytes((rules, )) + radar)
        for i, form in enumerate((".pcap --noise", ".pcapng --vlan", ".pcap --link cooked --ipv6",
                                  ".pcapng --link raw --noise")):
            args = write_capture.arguments(["", *form.split()])
            (folder / "fuzz_tables" / f"capture-{sectors}-{i}").write_bytes(
                b"\1" + write_capture.capture(args, radar))


def write_logs(folder):
    """Logs of short events: whole, damaged in between, cut, and one whose length takes in the
    next."""
    folder.mkdir(parents=True, exist_ok=True)

    def event(number, channel, data, size=None):
        return struct.pack(">IqqII", 0xEDA1DA01, number, number * 1000, len(channel),
                           len(data) if size is None else size) + channel + data

    events = [
        event(0, b"RHO_PLOTS_1", b"abc"),
        event(1, b"X", b""),
        event(2, b"RHO_TRACKS", b"12345678")
    ]
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
