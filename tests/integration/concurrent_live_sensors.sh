#!/bin/bash
# SPDX-License-Identifier: MIT
# Three sensor processes at once, each with its own clock of sending: the tracks are those of the
# files merged by time.
# shellcheck source=tests/integration/network.bash
. "$(dirname "$0")/network.bash"
here=$(realpath "$(dirname "$0")")
. "$here/checks.bash"

# play OPTIONS FILE...: a node with the options, and a publish process a file, all at the same time;
# live.csv, live.err
play() {
    local options=() players=() node
    while [ "$1" != -- ]; do
        options+=("$1")
        shift
    done
    shift
    "$program" node --lcm "$lcm_url" --print "${options[@]}" >live.csv 2>live.err &
    node=$!
    sleep 0.5
    for file in "$@"; do
        "$program" publish "$file" --lcm "$lcm_url" --speed 10 2>"$file.err" &
        players+=($!)
    done
    status=0
    for player in "${players[@]}"; do
        wait "$player" || status=$?
    done
    sleep 0.7
    kill -INT "$node"
    wait "$node" || status=$?
    cp live.err stderr
}

# The newest RHO_SENSORS of a log: number and is_doubted, a line each. After fingerprint and head
# (30 bytes, then the count), 38 bytes each: lcm_types/sensor_t.lcm.
read_sensors() { # log
    python3 - "$1" <<'PYTHON'
import struct, sys
log = open(sys.argv[1], "rb").read()
at = log.rindex(b"RHO_SENSORS") + len("RHO_SENSORS")
(count,) = struct.unpack_from(">h", log, at + 30)
for i in range(count):
    sensor_id, _, _, _, is_doubted = struct.unpack_from(">hbbbb", log, at + 32 + 38 * i)
    print(sensor_id, is_doubted)
PYTHON
}

same_from() { # seconds: the files' tracks and the live ones, from then on
    awk -F, -v t="$1" 'NR > 1 && $1 >= t' expected.csv >a
    awk -F, -v t="$1" 'NR > 1 && $1 >= t' live.csv >b
    test -s a && cmp a b
}

# ---- three radars: 1 s, a third of a second apart; four targets in clutter ----
# They see nothing for some scans: at the first nobody knows that there are others to wait for.
python3 - <<'PYTHON'
import random
random.seed(8)
targets = [(-20000 + 9000 * i, -15000 + 7000 * i, 150 - 60 * i, 120 + 25 * i) for i in range(4)]
for sensor in (1, 2, 3):
    with open(f"radar{sensor}.csv", "w") as plots:
        print("t_s,sensor_id,x_m,y_m,sigma_m", file=plots)
        for k in range(29):
            t = round(k + (sensor - 1) / 3, 6)
            rows = [(x + vx * t + random.gauss(0, 20), y + vy * t + random.gauss(0, 20))
                    for x, y, vx, vy in targets if random.random() < .95]
            rows += [(random.uniform(-5e4, 5e4), random.uniform(-5e4, 5e4)) for _ in range(30)]
            if k < 4:
                print(f"{t:.6f},{sensor},,,", file=plots)
                continue
            for x, y in rows:
                print(f"{t:.6f},{sensor},{x:.3f},{y:.3f},20", file=plots)
PYTHON
run track radar1.csv radar2.csv radar3.csv -o expected.csv
play --set hold_ms=90 -- radar1.csv radar2.csv radar3.csv
check 'three radars: all ends well' exits 0
check 'three radars: every scan is stepped' grep -q ' 87 steps' live.err
check 'three radars: nothing is lost, stale or double' test -z \
    "$(grep -E 'lost|stale|double|bad' live.err)"
check 'three radars: four tracks' awk -F, \
    '$1 == "28.000000" && $3 == "confirmed" { n++ } END { exit n != 4 }' live.csv
check 'three radars: the tracks are those of the files' same_from 0

# ---- three radars over eight targets, the third of which is 170 m off from 120 s on; then all is
# well again ----
python3 - <<'PYTHON'
import math, random
random.seed(5)
with open("biased.csv", "w") as plots:
    print("t_s,sensor_id,x_m,y_m,sigma_m", file=plots)
    for k in range(90):
        for sensor in (1, 2, 3):
            t, off = 4 * k + sensor, 120 if sensor == 3 and 30 <= k < 60 else 0
            for i in range(8):
                if random.random() < .9:
                    x = (90000 * (i % 4) - 135000 + (150 + 10 * i) * math.cos(.7 * i) * t
                         + random.gauss(0, 30) + off)
                    y = (90000 * (i // 4) + (150 + 10 * i) * math.sin(.7 * i) * t
                         + random.gauss(0, 30) + off)
                    print(f"{t},{sensor},{x:.3f},{y:.3f},30", file=plots)
PYTHON
limits=(--set v_max_mps=400 --set accel_max_mps2=10)
"$program" convert biased.csv biased.lcm
run node --lcm 'file://biased.lcm?speed=0' "${limits[@]}"
check 'a biased sensor: what was said' matches "$(grep 'sensor [0-9]' stderr)" \
    '1970-01-01T00:0[0-9]:* rhotrack: sensor 3 is suspect: its innovations are ?.? times '\
'what its sigmas say
1970-01-01T00:0[0-9]:* rhotrack: sensor 3 is trusted again'
awk -F, 'NR == 1 || $1 < 240' biased.csv >begun.csv
"$program" convert begun.csv begun.lcm
run node --lcm 'file://begun.lcm?speed=0' --log said.lcm "${limits[@]}"
check 'a biased sensor: the last words' matches "$(tail -n 1 stderr)" \
    '* rhotrack: sensor 3 contradicts the others'
check 'a biased sensor: on RHO_SENSORS' matches "$(read_sensors said.lcm)" '1 0
2 0
3 1'

# ---- three passive sensors ----
run simulate passive-three --seed 4 --set duration_s=160 -o passive
for sensor in 1 2 3; do
    awk -F, -v s="$sensor" 'NR == 1 || $2 == s' passive/bearings.csv >"passive$sensor.csv"
done
run track passive1.csv passive2.csv passive3.csv --config passive/scenario.ini -o expected.csv
play --config passive/scenario.ini --set hold_ms=90 -- passive1.csv passive2.csv passive3.csv
check 'three passive sensors: all ends well' exits 0
check 'three passive sensors: no scan is lost' test -z "$(grep -E 'refused|lost|late' live.err)"
# A node prints each look, a file has a row a time. Sums are in the order in which sensors were
# heard first, so that last digits may differ, and the sensor that a track starts with (column 17).
tac live.csv | awk -F, '!seen[$1, $2]++' | tac >last.csv
same_but_for_last_digits() {
    test "$(wc -l <last.csv)" -gt 20 && test "$(wc -l <last.csv)" -eq "$(wc -l <expected.csv)" &&
        paste -d, expected.csv last.csv | awk -F, 'NR > 1 {
            for (i = 1; i <= NF / 2; i++) {
                d = $i - $(i + NF / 2)
                if (i != 17 && d * d > (1e-4 * $i) ^ 2 + 1e-6) exit 1
            }
        }'
}
check 'three passive sensors: the tracks are those of the files' same_but_for_last_digits
finish
