#!/bin/bash
# SPDX-License-Identifier: MIT
# track on long files: memory does not grow with them, whatever they hold; and the bar that shows
# how far it is.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# KIND MEGABYTES: scans of clutter, the same few again and again with times that go on; a column to
# be ignored makes the rows long, so that there are not too many to track.
generate() {
    python3 - "$1" "$2" <<'PYTHON'
import random
import sys
kind, size = sys.argv[1], int(float(sys.argv[2]) * 1e6)
random.seed(1)
place = lambda: f"{random.uniform(-5e4, 5e4):.2f},{random.uniform(-5e4, 5e4):.2f}"
polar = lambda: f"{random.uniform(1e3, 5e4):.2f},{random.uniform(-3, 3):.6f}"
note = lambda length: "," + length * "n" + "\n"
header, scan = {
    "plots": ("x_m,y_m,note", lambda: "".join(f"@,1,{place()}{note(400)}" for _ in range(10))),
    "polar": ("range_m,azimuth_rad,note",
              lambda: "".join(f"@,1,{polar()}{note(400)}" for _ in range(5))),
    # rows have times of their own, and come mixed with the scan's before
    "numbered": ("x_m,y_m,scan,note",
                 lambda: "".join(f"@.{i},1,{place()},{'&' if i < 2 else '#'}{note(400)}"
                                 for i in range(10))),
    "bearings": ("sensor_x_m,sensor_y_m,bearing_rad,note",
                 lambda: "".join(f"@,{i},0,{9000 * i},{random.uniform(-3, 3):.6f}{note(2000)}"
                                 for i in (7, 8))),
}[kind]
scans, written, t = [scan() for _ in range(8)], 0, 0
with open(f"{kind}.csv", "w") as file:
    print("t_s,sensor_id," + header, file=file)
    while written < size:
        text = scans[t % 8].replace("@", str(4 * t)).replace("#", str(t)).replace(
            "&", str(max(t - 1, 0)))
        written += file.write(text)
        t += 1
PYTHON
}

# A log of scans of plots.csv and bearings.csv among a camera's pictures, MEGABYTES of these, and
# scans as many.
generate_log() {
    head -n $(($1 * 2000)) plots.csv >some.csv
    "$program" convert some.csv plots.lcm 2>stderr
    head -n $(($1 * 200)) bearings.csv >some.csv
    "$program" convert some.csv bearings.lcm 2>stderr
    python3 - "$1" <<'PYTHON'
import struct
import sys
events = []
for name in ("plots.lcm", "bearings.lcm"):
    data, at = open(name, "rb").read(), 0
    while at < len(data):
        _, number, utime, channel, size = struct.unpack(">IqqII", data[at:at + 28])
        end = at + 28 + channel + size
        events.append((utime, data[at:end]))
        at = end
events.sort()
size = int(float(sys.argv[1]) * 1e6 / len(events))
with open("both.lcm", "wb") as log:
    for utime, event in events:
        log.write(event + struct.pack(">IqqII", 0xEDA1DA01, 0, utime, 6, size)
                  + b"CAMERA" + bytes(size))
PYTHON
}

# Peak resident memory of track with these inputs, kB.
measure() {
    python3 - "$program" "$@" <<'PYTHON'
import resource
import subprocess
import sys
command = [sys.argv[1], "track", *sys.argv[2:], "-o", "tracks.csv"]
subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
PYTHON
}

# Memory of the short files and of the long ones, which are ten times as long: at most 1 MB apart.
grows_not() { # NAME
    echo "$1: ${short[$1]} kB, ten times the length ${long[$1]} kB"
    [ "${short[$1]}" -gt 1000 ] && [ "${long[$1]}" -lt $((short[$1] + 1000)) ]
}
declare -A short long
for kind in plots polar numbered bearings; do
    generate $kind 2
    short[$kind]=$(measure $kind.csv)
done
short[merged]=$(measure plots.csv numbered.csv bearings.csv)
generate_log 2
short[log]=$(measure both.lcm)
for kind in plots polar numbered bearings; do
    generate $kind 20
    long[$kind]=$(measure $kind.csv)
    check "$kind: memory" grows_not $kind
done
long[merged]=$(measure plots.csv numbered.csv bearings.csv)
check 'three inputs, merged: memory' grows_not merged
generate_log 20
long[log]=$(measure both.lcm)
check 'a log of plots and bearings: memory' grows_not log
short[pipe]=${short[plots]}
mkfifo pipe
cat plots.csv >pipe &
long[pipe]=$(measure pipe)
check 'a pipe: memory' grows_not pipe

# ---- rows without end ----
{ printf 't_s,sensor_id,x_m,y_m,note\n0,1,2,3,\n0,1,"2,3,\n'; sed -n 2,3001p plots.csv; } >quote.csv
run track quote.csv
check 'a quotation mark without a second one' says 2 \
    'rhotrack: quote.csv:3: a row of more than 1 MiB: a quoted cell has no end'
run track quote.csv --keep-going -o tracks.csv
check 'with --keep-going its row alone is skipped' matches "$(cat stderr)" \
    'rhotrack: 300 scans, 3001 plots, *, 1 bad rows skipped*; *'
{ printf 't_s,sensor_id,x_m,y_m\n0,1,2,3\n#'; head -c 1100000 /dev/zero | tr '\0' 'c'; } >line.csv
run track line.csv
check 'a line without an end' says 2 'rhotrack: line.csv:3: a line of more than 1 MiB'

# ---- the bar ----
# Standard error on a terminal; the program is held up for more than two seconds.
python3 - "$program" plots.csv >shown <<'PYTHON'
import os
import pty
import signal
import subprocess
import sys
import time
master, terminal = pty.openpty()
track = subprocess.Popen([sys.argv[1], "track", sys.argv[2], "-o", "tracks.csv"], stderr=terminal)
os.close(terminal)
time.sleep(0.2)
track.send_signal(signal.SIGSTOP)
time.sleep(2.2)
track.send_signal(signal.SIGCONT)
try:
    while text := os.read(master, 4096):
        sys.stdout.buffer.write(text)
except OSError:
    pass  # the terminal's other side is closed
PYTHON
bar_is_right() {
    python3 - <<'PYTHON'
import re
shown = open("shown", newline="").read()
lines = shown.split("\r\x1b[K")
bars = [line for line in lines if line.startswith("[")]
assert bars and all(
    re.fullmatch(r"\[[#.]{20}\] +\d+ %  \d+ scans, \d+ a second, \d+ (s|min) left", line)
    for line in bars), lines
assert all(len(line) < 80 and "\n" not in line for line in bars)
assert lines[0] == "" and re.fullmatch(
    r"rhotrack: \d+ scans, .*\r\nrhotrack: no track: .*\r\n", lines[-1]), lines
PYTHON
}
check 'a bar with scans a second and time left, which goes away' bar_is_right
run track plots.csv -o tracks.csv
check 'none where standard error is no terminal' matches "$(wc -l <stderr) $(cat stderr)" \
    '2 rhotrack: * scans, *rhotrack: no track: *'
finish
