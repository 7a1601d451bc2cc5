#!/bin/bash
# SPDX-License-Identifier: MIT
# Several hosts on one bridge: two radars, the tracker, a stock logger. 0, 1 and 10 % of the
# datagrams to the tracker are lost: tracks go on, losses are counted.
# shellcheck source=tests/integration/network.bash
. "$(dirname "$0")/network.bash"
. "$(dirname "$0")/checks.bash"
need_bindings

scans=80
# Five targets, two radars half a second apart, 50 clutter plots each: two messages a scan.
"$python" - "$scans" <<'PYTHON'
import random
import sys
random.seed(5)
scans = int(sys.argv[1])
targets = [(-20000 + 9000 * i, -15000 + 7000 * i, 150 - 60 * i, 120 + 25 * i) for i in range(5)]
with open("truth.csv", "w") as truth:
    print("t_s,target_id,x_m,y_m", file=truth)
    for step in range(2 * scans):
        t = step / 2
        for i, (x, y, vx, vy) in enumerate(targets):
            print(f"{t:.6f},{i},{x + vx * t:.3f},{y + vy * t:.3f}", file=truth)
for sensor in (1, 2):
    with open(f"radar{sensor}.csv", "w") as plots:
        print("t_s,sensor_id,x_m,y_m,sigma_m", file=plots)
        for k in range(scans):
            t = k + (sensor - 1) / 2
            rows = [(x + vx * t + random.gauss(0, 20), y + vy * t + random.gauss(0, 20))
                    for x, y, vx, vy in targets if random.random() < .95]
            rows += [(random.uniform(-5e4, 5e4), random.uniform(-5e4, 5e4)) for _ in range(50)]
            for x, y in rows:
                print(f"{t:.6f},{sensor},{x:.3f},{y:.3f},20", file=plots)
PYTHON

add_host radar1 1
add_host radar2 2
add_host tracker 3
add_host logger 4

# at_once LOSS: all of it with so many of a thousand lost
at_once() {
    local per_mille=$1 node logger first second
    lose tracker "$per_mille"
    ip netns exec logger /usr/bin/lcm-logger --lcm-url="$lcm_url" -f stock.lcm >/dev/null 2>&1 &
    logger=$!
    ip netns exec tracker "$program" node --lcm "$lcm_url" --log node.lcm 2>node.err &
    node=$!
    sleep 0.7
    ip netns exec radar1 "$program" publish radar1.csv --lcm "$lcm_url" --speed 20 2>first.err &
    first=$!
    ip netns exec radar2 "$program" publish radar2.csv --lcm "$lcm_url" --speed 20 2>second.err &
    second=$!
    wait "$first" && wait "$second" || echo "publish: $(cat first.err second.err)"
    sleep 0.5
    kill -INT "$node"
    wait "$node"
    status=$?
    kill -INT "$logger"
    wait "$logger"
    cp node.err stderr
}

within() { [ "$1" -ge "$2" ] && [ "$1" -le "$3" ] || { echo \
    "$1 is not within $2 .. $3"; return 1; }; }

# Each scan was taken, or is missing between others, or was lost at the very start or end.
accounted() {
    within $(($(status_of scans_accepted) + $(status_of scans_lost))) $((2 * scans - 3)) \
        $((2 * scans))
}

# The confirmed tracks of the stock log beside the truth, from the tenth second on: most targets
# have theirs, always.
tracks_go_on() { # least completeness
    "$program" convert stock.lcm tracks.csv --kind tracks 2>convert.err \
        || { cat convert.err; return 1; }
    awk -F, 'NR == 1 || $1 >= 10' tracks.csv >late.csv
    awk -F, 'NR == 1 || $1 >= 10' truth.csv >late-truth.csv
    "$program" evaluate late-truth.csv late.csv --json >figures || return 1
    json figures "o['completeness'] >= $1 and o['false_per_scan'] <= .2 and o['switches'] <= 2"
}

# Lists of tracks that are whole, in a log.
lists_of() {
    "$python" - "$1" <<'PYTHON'
import collections
import sys
import lcm
sys.path.insert(0, "bindings")
import rhotrack
parts, wanted = collections.Counter(), {}
for event in lcm.EventLog(sys.argv[1]):
    if event.channel == "RHO_TRACKS":
        tracks = rhotrack.track_list_t.decode(event.data)
        parts[tracks.epoch, tracks.scan] += 1
        wanted[tracks.epoch, tracks.scan] = tracks.num_parts
print(sum(parts[step] == wanted[step] for step in parts))
PYTHON
}

for per_mille in 0 10 100; do
    name="$((per_mille / 10)) % lost"
    at_once "$per_mille"
    check "$name: the tracker ends well" exits 0
    read_status node.lcm
    dropped=$(lost tracker)
    check "$name: every scan is accounted for" accounted
    if [ "$per_mille" -eq 0 ]; then
        check "$name: nothing is lost" test "$(status_of scans_lost)" -eq 0 -a \
            "$(status_of scans_incomplete)" -eq 0
        # nobody knows at the first scan that the other radar is there, too
        check "$name: all scans are stepped, in order but for the first" test \
            "$(status_of scan)" -eq $((2 * scans)) -a "$(status_of scans_late)" -le 1
        check "$name: tracks go on" tracks_go_on .97
    else
        # A lost message makes its scan incomplete; two of one scan lose it. A part that comes
        # after its scan had to go counts as double, and the scan as incomplete.
        check "$name: losses are counted ($dropped datagrams)" within \
            $(($(status_of scans_incomplete) + 2 * $(status_of scans_lost))) \
            $((dropped * 7 / 10 - 2)) $((dropped + $(status_of scans_duplicate)))
        check "$name: tracks go on" tracks_go_on \
            "$([ "$per_mille" -eq 10 ] && echo .95 || echo .85)"
    fi
    check "$name: the stock log, read by the Python package, has one list of tracks a step" test \
        "$(lists_of stock.lcm)" -eq "$(status_of scan)"
done
finish
