#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A recording in ASTERIX as the network carried it: a block a UDP datagram, as pcap or pcapng.

Usage: write_capture.py IN.ast OUT (.pcapng, or pcap) [--link ethernet|cooked|raw] [--vlan] [--ipv6]
                        [--noise]
  --noise   each tenth packet is followed by a TCP segment, a datagram of other content, a fragment
            and a packet that is cut short
"""
import argparse
import struct


def blocks(data):
    at = 0
    while at < len(data):
        size = int.from_bytes(data[at + 1:at + 3], "big")
        yield data[at:at + size]
        at += size


def udp(content, size=None):
    return struct.pack(">HHHH", 8600, 8600, 8 + len(content) if size is None else size, 0) + content


def ipv4(payload, protocol=17, fragment=0):
    return struct.pack(">BBHHHBBH4s4s", 0x45, 0, 20 + len(payload), 1, fragment, 64, protocol, 0,
                       b"\x0a\0\0\1", b"\xef\1\1\1") + payload


def ipv6(payload):
    return struct.pack(">IHBB16s16s", 6 << 28, len(payload), 17, 64, b"\1" * 16,
                       b"\2" * 16) + payload


def frame(args, packet):
    kind = packet[0] >> 4
    ethertype = struct.pack(">H", 0x86dd if kind == 6 else 0x0800)
    if args.vlan:
        ethertype = b"\x81\x00\x00\x07" + ethertype
    if args.link == "raw":
        return packet
    if args.link == "cooked":
        return b"\0\0\0\1\0\6" + b"\1" * 8 + ethertype + packet
    return (b"\1" * 12 + ethertype + packet).ljust(60, b"\0")  # as long as a frame is at least


def packets(args, data):
    for i, content in enumerate(blocks(data)):
        packet = frame(args, ipv6(udp(content)) if args.ipv6 else ipv4(udp(content)))
        yield packet, len(packet)
        if args.noise and i % 10 == 0:
            yield frame(args, ipv4(b"\0" * 40, protocol=6)), 94
            yield frame(args, ipv4(udp(b"\x30\x00\x08no" + content))), 200
            yield frame(args, ipv4(udp(content), fragment=0x2000)), 200
            yield frame(args, ipv4(udp(content)))[:40], 90


def capture(args, data):
    """The recording's bytes."""
    link = {"ethernet": 1, "cooked": 113, "raw": 101}[args.link]
    if not args.output.endswith(".pcapng"):
        return struct.pack(">IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, link) + b"".join(
            struct.pack(">IIII", 0, 0, len(packet), size) + packet
            for packet, size in packets(args, data))
    out = [struct.pack("<IIIHHqI", 0x0A0D0D0A, 28, 0x1A2B3C4D, 1, 0, -1, 28),
           struct.pack("<IIHHII", 1, 20, link, 0, 65535, 20)]
    for packet, size in packets(args, data):
        padded = packet + b"\0" * (-len(packet) % 4)
        total = struct.pack("<I", 32 + len(padded))
        out.append(struct.pack("<I", 6) + total +
                   struct.pack("<IIIII", 0, 0, 0, len(packet), size) + padded + total)
    return b"".join(out)


def arguments(given=None):
    parser = argparse.ArgumentParser()
    parser.add_argument("source")
    parser.add_argument("output")
    parser.add_argument("--link", choices=("ethernet", "cooked", "raw"), default="ethernet")
    for name in ("--vlan", "--ipv6", "--noise"):
        parser.add_argument(name, action="store_true")
    return parser.parse_args(given)


def main():
    args = arguments()
    with open(args.source, "rb") as source, open(args.output, "wb") as out:
        out.write(capture(args, source.read()))


if __name__ == "__main__":
    main()
