# SPDX-License-Identifier: MIT
"""Sends what no sensor should: hostile.py SECONDS RATE. Prints how many datagrams of each sort went
out, as NAME=COUNT.

Random bytes, wrong magic, short and unterminated heads, forged fragments, messages with random
contents and hostile counts, and mutated copies of the real traffic (1 to 8 bytes changed, cut,
lengthened), which is listened to.
"""
import random
import select
import socket
import struct
import sys
import time

GROUP, PORT = "239.255.76.67", 7667
seconds, rate = float(sys.argv[1]), float(sys.argv[2])
random.seed(11)

out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
heard = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
heard.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
heard.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
heard.bind((GROUP, PORT))
heard.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                 struct.pack("4s4s", socket.inet_aton(GROUP), socket.inet_aton("0.0.0.0")))
heard.setblocking(False)
real = []
mine = set()


def listen():
    """The last real datagrams of sensors; what this program sent is not real."""
    while select.select([heard], [], [], 0)[0]:
        data = heard.recv(65536)
        if data[:4] == b"LC02" and data[8:12] == b"RHO_" and data not in mine:
            real.append(data)
    del real[:-8]


def noise():
    return random.randbytes(random.randrange(0, 1472))


def short():
    return b"LC02"[:random.randrange(0, 5)] + random.randbytes(random.randrange(0, 4))


def unterminated():
    return b"LC02" + random.randbytes(4) + b"R" * random.randrange(64, 1400)


def fragment():
    """A header of LC03 as liblcm has it, with sizes and offsets that do not fit one another."""
    numbers = [
        random.choice([0, 1, 0xFFFFFFFF, 0x80000000,
                       random.getrandbits(32)]) for _ in range(3)
    ]
    counts = [random.choice([0, 1, 2, 0xFFFF, random.getrandbits(16)]) for _ in range(2)]
    return (b"LC03" + struct.pack(">IIIHH", *numbers, *counts)[:random.choice([4, 8, 12, 16])] +
            random.randbytes(random.randrange(0, 1400)))


def contents():
    """A channel of a sensor, the right fingerprint or not, and random bytes."""
    kind, fingerprint = random.choice([("PLOTS", 0x00ec35bb85bc4cbde),
                                       ("POLAR", 0x0570bdbf57d4a221),
                                       ("BEARINGS", 0x66d140164191753b)])
    if random.random() < .3:
        fingerprint = random.getrandbits(64)
    return (b"LC02" + random.randbytes(4) +
            f"RHO_{kind}_{random.randrange(-40000, 40000)}".encode() + b"\0" +
            struct.pack(">Q", fingerprint) + random.randbytes(random.randrange(0, 1300)))


def mutated():
    """A copy of something real."""
    data = bytearray(random.choice(real))
    for _ in range(random.randrange(1, 9)):
        data[random.randrange(len(data))] = random.getrandbits(8)
    way = random.random()
    if way < .1:
        data = data[:random.randrange(len(data))]
    elif way < .2:
        data += random.randbytes(random.randrange(1, 50))
    return bytes(data)


sorts = [noise, short, unterminated, fragment, contents, mutated]
sent = {sort.__name__: 0 for sort in sorts}
refused = 0  # what every receiver must refuse before it looks at a message: no LC02
start = time.monotonic()
count = 0
while time.monotonic() - start < seconds:
    listen()
    sort = random.choice(sorts)
    if sort is mutated and not real:
        continue
    data = sort()
    mine.add(data)
    out.sendto(data, (GROUP, PORT))
    sent[sort.__name__] += 1
    refused += data[:4] != b"LC02" or len(data) < 8
    count += 1
    pause = start + count / rate - time.monotonic()
    if pause > 0:
        time.sleep(pause)
for name, number in sent.items():
    print(f"{name}={number}")
print(f"refused={refused}")
print(f"total={count}")
