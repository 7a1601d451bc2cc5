#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Polar plots (CSV) as a radar would send them in ASTERIX: CAT048 plots and CAT034 antenna
messages, or with --old CAT001 and CAT002, as a recording.

Usage: write_asterix.py POLAR.csv OUT.ast [--old plots|tracks] [--sectors N] [--interval S]
                        [--start S] [--sac N] [--sic N] [--place LAT,LON,ALT]
  --old       CAT001, by its profile of plots or of tracks, with times that lack multiples of 512 s
  --sectors   sector crossings a turn (32); 1: north markers alone; 0: no antenna messages
  --interval  of a turn (4 s); the antenna is at north at t_s 0 and turns clockwise
  --start     time of day of t_s 0 (43200 s)
Azimuths of the plots come from the file, their times from where the antenna is then, within the
turn of their t_s.
"""
import argparse
import csv
import math
import struct

NM = 1852.0


def record(items):
    """items: {place in the profile from 1: bytes}"""
    last = max(items)
    spec = bytearray((last + 6) // 7)
    for place in items:
        spec[(place - 1) // 7] |= 0x80 >> ((place - 1) % 7)
    for i in range(len(spec) - 1):
        spec[i] |= 1
    return bytes(spec) + b"".join(items[place] for place in sorted(items))


def block(category, records):
    body = b"".join(records)
    return struct.pack(">BH", category, len(body) + 3) + body


def time_of_day(seconds):
    return (round(seconds * 128) % (86400 * 128)).to_bytes(3, "big")


def plot(args, time_s, range_m, azimuth_turn, doppler_mps, alt_m):
    items = {1: bytes((args.sac, args.sic)), 2: time_of_day(time_s), 3: b"\x20",
             4: struct.pack(">HH", round(range_m / NM * 256), round(azimuth_turn * 65536) % 65536)}
    if alt_m is not None:
        items[6] = (round(alt_m / 0.3048 / 25) & 0x3FFF).to_bytes(2, "big")
    if doppler_mps is not None:
        items[20] = b"\x80" + (round(doppler_mps) & 0x3FF).to_bytes(2, "big")
    return block(48, [record(items)])


def old_plot(args, time_s, range_m, azimuth_turn, alt_m):
    """EUROCONTROL-SPEC-0149 part 2a: 010, 020 (TYP, primary), 040 in 1/128 NM, 141, 090."""
    place = struct.pack(">HH", round(range_m / NM * 128), round(azimuth_turn * 65536) % 65536)
    time = struct.pack(">H", round(time_s * 128) % 65536)
    level = None if alt_m is None else (round(alt_m / 0.3048 / 25) & 0x3FFF).to_bytes(2, "big")
    items = {1: bytes((args.sac, args.sic))}
    if args.old == "plots":
        items.update({2: b"\x10", 3: place, 7: time} | ({5: level} if level else {}))
    else:
        items.update({2: b"\x90", 3: b"\x01\x02", 4: place, 9: time, 13: b"\x81\x40"})
        items.update({8: level} if level else {})
    return block(1, [record(items)])


def old_crossing(args, time_s, sector):
    """Part 2b: 010, 000, 020, 030, 041."""
    items = {1: bytes((args.sac, args.sic)), 2: b"\x01" if sector is None else b"\x02",
             4: time_of_day(time_s), 5: struct.pack(">H", round(args.interval * 128))}
    if sector is not None:
        items[3] = bytes((sector,))
    return block(2, [record(items)])


def crossing(args, time_s, sector):
    """sector: 1/256 turn, None: a north marker"""
    if args.old:
        return old_crossing(args, time_s, sector)
    items = {
        1: bytes((args.sac, args.sic)), 2: b"\x01" if sector is None else b"\x02",
        3: time_of_day(time_s)
    }
    if sector is not None:
        items[4] = bytes((sector,))
    elif args.place:
        lat, lon, alt = (float(v) for v in args.place.split(","))
        items[11] = struct.pack(">h", round(alt)) + b"".join(
            (round(v / 180 * 2 ** 23) & 0xFFFFFF).to_bytes(3, "big") for v in (lat, lon))
    return block(34, [record(items)])


def read_plots(args):
    """(time, block): messages of plots, at the times when the antenna was there"""
    with open(args.polar, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if not row["range_m"]:
                continue
            turn = (0.25 - float(row["azimuth_rad"]) / (2 * math.pi)) % 1
            time_s = (math.floor(float(row["t_s"]) / args.interval + 1e-9) + turn) * args.interval
            doppler = row.get("range_rate_mps")
            alt = row.get("alt_m")
            where = args.start + time_s, float(row["range_m"]), turn
            if args.old:
                yield time_s, old_plot(args, *where, float(alt) if alt else None)
            else:
                yield time_s, plot(args, *where, float(doppler) if doppler else None,
                                   float(alt) if alt else None)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("polar")
    parser.add_argument("out")
    parser.add_argument("--old", choices=("plots", "tracks"))
    parser.add_argument("--sectors", type=int, default=32)
    parser.add_argument("--interval", type=float, default=4.0)
    parser.add_argument("--start", type=float, default=43200.0)
    parser.add_argument("--sac", type=int, default=0)
    parser.add_argument("--sic", type=int, default=1)
    parser.add_argument("--place")
    args = parser.parse_args()
    messages = list(read_plots(args))
    turns = int(max(time for time, _ in messages) // args.interval) + 1
    # Plots come a little after the antenna: some behind the next crossing's message.
    messages = [(time + 0.2, data) for time, data in messages]
    for turn in range(turns + 1):
        if args.sectors > 0:
            messages.append(
                (turn * args.interval, crossing(args, args.start + turn * args.interval, None)))
        for sector in range(args.sectors if args.sectors > 1 and turn < turns else 0):
            time = (turn + sector / args.sectors) * args.interval
            messages.append((time, crossing(args, args.start + time, sector * 256 // args.sectors)))
    messages.sort(key=lambda message: message[0])
    with open(args.out, "wb") as file:
        file.write(b"".join(data for _, data in messages))


if __name__ == "__main__":
    main()
