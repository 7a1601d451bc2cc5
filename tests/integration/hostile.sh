#!/bin/bash
# SPDX-License-Identifier: MIT
# 2000 hostile datagrams a second beside a radar's: the tracker lives, counts them, and steps every
# scan of the radar.
# shellcheck source=tests/integration/network.bash
. "$(dirname "$0")/network.bash"
here=$(realpath "$(dirname "$0")")
. "$here/checks.bash"
need_bindings

# Five targets and 40 clutter plots, 20 scans a second, for five seconds.
"$python" - <<'PYTHON'
import random
random.seed(5)
targets = [(-20000 + 9000 * i, -15000 + 7000 * i, 150 - 60 * i, 120 + 25 * i) for i in range(5)]
with open("plots.csv", "w") as plots:
    print("t_s,sensor_id,x_m,y_m,sigma_m", file=plots)
    for k in range(100):
        t = k / 20
        rows = [(x + vx * t + random.gauss(0, 5), y + vy * t + random.gauss(0, 5))
                for x, y, vx, vy in targets]
        rows += [(random.uniform(-5e4, 5e4), random.uniform(-5e4, 5e4)) for _ in range(40)]
        for x, y in rows:
            print(f"{t:.6f},1,{x:.3f},{y:.3f},5", file=plots)
PYTHON
run track plots.csv -o expected.csv
check 'the radar alone' exits 0

"$program" node --lcm "$lcm_url" --log node.lcm 2>node.err &
node=$!
sleep 0.5
"$python" "$here/hostile.py" 7 2000 >sent &
hostile=$!
sleep 0.7
run publish plots.csv --lcm "$lcm_url"
check 'the radar is played' exits 0
wait "$hostile"
sleep 0.3
check 'the tracker lives' kill -0 "$node"
kill -TERM "$node"
wait "$node"
status=$?
cp node.err stderr
check 'and ends well' exits 0
cat sent node.err

sent_of() { sed -n "s/^$1=//p" sent; }
read_status node.lcm
check 'the rate was kept' test "$(sent_of total)" -ge 12000
check 'what is no LCM is refused and counted' test "$(status_of fragments_refused)" -ge \
    "$(sent_of refused)"
check 'other contents are counted' test \
    $(($(status_of messages_bad) + $(status_of messages_wrong_type) +
        $(status_of scans_bad) + $(status_of scans_duplicate))) \
    -ge "$(sent_of mutated)"
# every scan of the radar: its time, and as many plots as it has
"$python" - <<'PYTHON' >steps
import lcm, sys
sys.path.insert(0, "bindings")
import rhotrack
seen = {}
for event in lcm.EventLog("node.lcm"):
    if event.channel == "RHO_TRACKS":
        seen[rhotrack.track_list_t.decode(event.data).utime] = True
wanted = {round(float(line.split(",")[0]) * 1e6) for line in open("plots.csv").read().split()[1:]}
print(len(wanted), len(wanted - set(seen)))
PYTHON
check 'no scan of the radar is lost' matches "$(cat steps)" '100 0'
grep -v ,tentative, expected.csv | cut -d, -f1,4-9 >expected
"$program" convert node.lcm got.csv --kind tracks 2>convert.err
grep -v ,tentative, got.csv | cut -d, -f1,4-9 >got
check 'its tracks are those of the radar alone' sh -c \
    'test -s expected && test $(grep -cvxFf got expected) -eq 0'
finish
