#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Records in ASTERIX as libasterix (EUROCONTROL's specifications by another hand) reads and writes
them: what tests/tools/io/test_asterix_codec.c compares the program's own reader and writer with.

Usage: make_asterix_vectors.py > asterix_vectors.h
       make_asterix_vectors.py --check FILE.ast
In tests/vectors; needs the package libasterix (0.36.3 made the file). --check decodes every record
of a recording of CAT034, CAT048, CAT062.

Records are drawn at random, item by item as the specification has them: which there are, how long
those are whose length is free, and all their bits. libasterix takes them apart and says how long
each item is, and what the items that rhotrack uses mean. Tracks are encoded by libasterix from
numbers.
"""
import random
import sys

from asterix import base, generated

CATEGORIES = {1: (generated.Cat_001_1_2, generated.Cat_001_1_4),
              2: (generated.Cat_002_1_0, generated.Cat_002_1_2),
              34: (generated.Cat_034_1_27, generated.Cat_034_1_29),
              48: (generated.Cat_048_1_27, generated.Cat_048_1_32),
              62: (generated.Cat_062_1_18, generated.Cat_062_1_21)}
RECORDS = 60  # of each category

# What rhotrack reads: item, sub-items by their names.
VALUES = {
    1: [
        "010/SAC", "010/SIC", "141", "020/TYP", "020/SIM", "020/SSRPSR", "020/RAB", "020/TST",
        "040/RHO", "040/THETA", "070/MODE3A", "090/V", "090/G", "090/HGT", "161"
    ],
    2: ["010/SAC", "010/SIC", "000", "020", "030", "041"],
    34: ["000", "020", "030", "041", "120/HGT", "120/LAT", "120/LON"],
    48: [
        "010/SAC", "010/SIC", "140", "020/TYP", "020/SIM", "020/RAB", "020/TST", "020/ERR",
        "040/RHO", "040/THETA", "070/MODE3A", "090/V", "090/G", "090/FL", "110/3DH", "120/CAL/D",
        "120/CAL/CAL", "161/TRN", "220"
    ],
    62: [
        "040", "070", "080/CNF", "080/TSE", "080/TSB", "080/CST", "100/X", "100/Y", "105/LAT",
        "105/LON", "185/VX", "185/VY", "210/AX", "210/AY", "130", "220", "500/APC/X", "500/APC/Y",
        "500/ATV/X", "500/ATV/Y"
    ],
}

HEADER = """/* SPDX-License-Identifier: MIT */
/* Made by tests/vectors/make_asterix_vectors.py with libasterix; do not edit. */
/* clang-format off */
#ifndef RHOTRACK_TESTS_ASTERIX_VECTORS_H
#define RHOTRACK_TESTS_ASTERIX_VECTORS_H

#include <math.h>
#include <stdint.h>
"""


# ---- Random records ----

def bits_of(rng, count):
    return [rng.randrange(2) for _ in range(count)]


def specification(present):
    """Field specification of the places that are there: seven a byte, and whether another byte
    follows."""
    while present and not present[-1]:
        present.pop()
    bits = []
    for start in range(0, len(present), 7):
        part = present[start:start + 7]
        bits += [int(there)
                 for there in part + [False] * (7 - len(part))] + [int(start + 7 < len(present))]
    return bits


def draw_compound(rng, variation):
    parts = variation.cv_items_list
    present = [part is not None and rng.random() < 0.5 for part in parts]
    if not any(present):
        present[next(i for i, part in enumerate(parts) if part is not None)] = True
    kept = list(present)
    bits = specification(present)
    for part, there in zip(parts, kept):
        if there:
            bits += draw_rule(rng, part.cv_rule)
    return bits


def draw_extended(rng, variation):
    groups = variation.cv_items_list
    used = rng.randint(1, len(groups))
    bits = []
    for i in range(used):
        size = sum(1 if item is None else item[1] for item in groups[i])
        bits += bits_of(rng, size - 1) + [int(i + 1 < used)]
    # The last group may have no extension bit in it: then nothing follows it.
    return bits


def draw_repetitive(rng, variation):
    count = rng.randint(1, 3)
    if variation.cv_rep_bytes is None:
        return [
            bit for i in range(count)
            for bit in draw(rng, variation.cv_variation) + [int(i + 1 < count)]
        ]
    head = [int(bit) for bit in format(count, f"0{8 * variation.cv_rep_bytes}b")]
    return head + [bit for _ in range(count) for bit in draw(rng, variation.cv_variation)]


def draw(rng, variation):
    if issubclass(variation, base.Element) or issubclass(variation, base.Group):
        return bits_of(rng, variation.cv_bit_size)
    if issubclass(variation, base.Extended):
        return draw_extended(rng, variation)
    if issubclass(variation, base.Repetitive):
        return draw_repetitive(rng, variation)
    if issubclass(variation, base.Explicit):
        size = rng.randint(2, 9)
        return [int(bit) for bit in format(size, "08b")] + bits_of(rng, 8 * (size - 1))
    return draw_compound(rng, variation)


def draw_rule(rng, rule):
    return draw(rng, rule.cv_variation)


def to_bytes(bits):
    assert len(bits) % 8 == 0
    return bytes(int("".join(map(str, bits[i:i + 8])), 2) for i in range(0, len(bits), 8))


def profile_of(spec, uap):
    """uap: of CAT001, "plot" or "track"; else None."""
    return spec.cv_uap.cv_uaps[uap] if uap else spec.cv_uap.cv_record


def draw_record(rng, spec, uap=None):
    items = [getattr(item, "cv_non_spare", None) for item in profile_of(spec, uap).cv_items_list]
    share = rng.choice((0.2, 0.5, 0.9))
    present = [item is not None and rng.random() < share for item in items]
    present[0] = True
    present[1] |= uap is not None  # its first bit says which profile it is
    kept = list(present)
    bits = specification(present)
    for item, there in zip(items, kept):
        if there:
            drawn = draw_rule(rng, item.cv_rule)
            if uap and item.cv_name == "020":
                drawn[0] = int(uap == "track")
            bits += drawn
    return to_bytes(bits)


# ---- What libasterix says of them ----

def parse(spec, data, uap=None):
    bits = base.Bits.from_bytes(data)
    records = spec.cv_uap.parse(uap, bits) if uap else spec.cv_uap.parse(bits)
    if isinstance(records, ValueError):
        raise records
    return records


def sizes_of(spec, record, uap=None):
    """Bytes of the item at each place of the profile; 0 where there is none."""
    sizes = []
    for place in profile_of(spec, uap).cv_items_list:
        non_spare = getattr(place, "cv_non_spare", None)
        item = record.get_item(non_spare.cv_name) if non_spare else None
        sizes.append(len(item.unparse()) // 8 if item is not None else 0)
    return sizes


def find(record, path):
    """The element at a path of names, or None."""
    names = path.split("/")
    if names[0] not in record.cv_items_dict:
        return None
    node = record.get_item(names[0])
    for name in names[1:]:
        if node is None:
            return None
        node = node.variation.get_item(name)
    return node


def value_of(record, path):
    node = find(record, path)
    if node is None:
        return "NAN"
    content = node.variation.rule.content
    # edition 1.27 was without a sign by its letter; later ones have it
    if path in ("090/FL", "090/HGT"):
        return repr(((node.variation.as_uint() + 8192) % 16384 - 8192) / 4)
    if isinstance(content, base.ContentQuantity):
        return repr(content._as_quantity())
    return str(node.variation.as_uint())


def write_records(category, uap=None):
    specs = CATEGORIES[category]
    rng = random.Random(f"rhotrack {category} {uap}" if uap else f"rhotrack {category}")
    places = len(profile_of(specs[0], uap).cv_items_list)
    paths = VALUES[category]
    name = f"{category}_{uap.upper()}" if uap else str(category)
    print(f"/* values: {', '.join(paths)}; NAN: not there */")
    print(
        f"enum {{ VECTORS_{name}_PLACES = {places}, VECTORS_{name}_VALUES = {len(paths)} }};"
    )
    print(
        f"static const struct {{ const char *hex; uint16_t sizes[{places}]; "
        f"double values[{len(paths)}]; }} vectors_{name.lower()}[] = {{")
    for i in range(RECORDS):
        spec = specs[i % 2]
        data = draw_record(rng, spec, uap)
        records = parse(spec, data, uap)
        assert len(records) == 1
        sizes = ", ".join(map(str, sizes_of(spec, records[0], uap)))
        values = ", ".join(value_of(records[0], path) for path in paths)
        print(f'    {{"{data.hex()}",\n     {{{sizes}}},\n     {{{values}}}}},')
    print("};\n")


# ---- Tracks ----

def status_groups(track):
    first = (("MON", track["mono"]), ("SPI", 0), ("MRH", int("alt" in track)), ("SRC", 0),
             ("CNF", track["tentative"]))
    second = (("SIM", 0), ("TSE", track["last"]), ("TSB", track["first"]), ("FPC", 0), ("AFF", 0),
              ("STP", 0), ("KOS", 0))
    third = (("AMA", 0), ("MD4", 0), ("ME", 0), ("MI", 0), ("MD5", 0))
    fourth = (("CST", track["coasting"]), ("PSR", 0), ("SSR", 0), ("MDS", 0), ("ADS", 0),
              ("SUC", 0), ("AAC", 0))
    groups = [first + (None,)]
    if track["coasting"] or track["last"] or track["first"]:
        groups.append(second + (None,))
    if track["coasting"]:
        groups += [third + (None,), fourth + (None,)]
    return groups


def encode_track(track):
    """Numbers are whole units of the items."""
    items = {
        "010": (("SAC", track["sac"]), ("SIC", track["sic"])), "070": track["time"],
        "100": (("X", track["x"]), ("Y", track["y"])),
        "185": (("VX", track["vx"]), ("VY", track["vy"])),
        "210": (("AX", track["ax"]), ("AY", track["ay"])), "040": track["number"],
        "080": status_groups(track)
    }
    if "lat" in track:
        items["105"] = (("LAT", track["lat"]), ("LON", track["lon"]))
    if "alt" in track:
        items["130"] = track["alt"]
        items["220"] = track["climb"]
    if "sigma" in track:
        x, y, vx, vy = track["sigma"]
        items["500"] = {"APC": (("X", x), ("Y", y)), "ATV": (("X", vx), ("Y", vy))}
    return generated.Cat_062_1_18.cv_uap.cv_record.create(items).unparse().to_bytes()


def draw_track(rng, full):
    def signed(bits):
        return rng.randrange(-2 ** (bits - 1), 2 ** (bits - 1))

    track = {
        "sac": rng.randrange(256), "sic": rng.randrange(256), "time": rng.randrange(
            86400 * 128), "x": signed(24), "y": signed(24), "vx": signed(16), "vy": signed(16),
        "ax": signed(8), "ay": signed(8), "number": rng.randrange(65536), "mono": rng.randrange(2),
        "tentative": rng.randrange(2), "last": rng.randrange(2), "first": rng.randrange(2),
        "coasting": rng.randrange(2)
    }
    if full > 0:
        track.update(lat=rng.randrange(-2 ** 24, 2 ** 24), lon=rng.randrange(-2 ** 25, 2 ** 25))
        track["sigma"] = (rng.randrange(65536), rng.randrange(65536), rng.randrange(256),
                          rng.randrange(256))
    if full > 1:
        track.update(alt=signed(16), climb=signed(16))
    return track


def raw(value, bits):
    return value % 2 ** bits


def write_tracks():
    rng = random.Random("rhotrack tracks")
    names = [
        "sac", "sic", "time", "number", "mono", "tentative", "last", "first", "coasting", "x", "y",
        "vx", "vy", "ax", "ay", "lat", "lon", "alt", "climb"
    ]
    widths = {
        "x": 24, "y": 24, "vx": 16, "vy": 16, "ax": 8, "ay": 8, "lat": 32, "lon": 32, "alt": 16,
        "climb": 16
    }
    print(f"/* {', '.join(names)}, four sigmas, in the items' units; NAN: not there */")
    print("static const struct { const char *hex; double values[23]; } vectors_tracks[] = {")
    for i in range(24):
        track = draw_track(rng, i % 3)
        encoded = {
            name: raw(value, widths[name]) if name in widths else value
            for name, value in track.items()
        }
        data = encode_track(encoded)
        values = [str(track[name]) if name in track else "NAN" for name in names]
        values += [str(sigma) for sigma in track["sigma"]] if "sigma" in track else ["NAN"] * 4
        print(f'    {{"{data.hex()}",\n     {{{", ".join(values)}}}}},')
    print("};\n")


def check(path):
    data = open(path, "rb").read()
    at = records = 0
    while at < len(data):
        size = int.from_bytes(data[at + 1:at + 3], "big")
        category, spec = data[at], CATEGORIES[data[at]][0]
        bits = base.Bits.from_bytes(data[at + 3:at + size])
        uaps = spec.cv_uap.parse_any_uap(bits, 3) if category == 1 else [spec.cv_uap.parse(bits)]
        if isinstance(uaps, ValueError) or not uaps or isinstance(uaps[0], ValueError):
            raise ValueError(f"byte {at}")
        records += len(uaps[0])
        at += size
    print(f"{records} records")


def main():
    if sys.argv[1:2] == ["--check"]:
        check(sys.argv[2])
        return
    print(HEADER)
    for category in (34, 48, 62, 2):
        write_records(category)
    write_records(1, "plot")
    write_records(1, "track")
    write_tracks()
    print("#endif")


if __name__ == "__main__":
    main()
