#!/bin/bash
# SPDX-License-Identifier: MIT
# node with sources_allowed: a radar's datagrams are tracked, those of other addresses are refused,
# counted and said, however many.
# shellcheck source=tests/integration/loopback.bash
. "$(dirname "$0")/loopback.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Sends the datagrams of a log from another address of this machine: send.py ADDRESS LOG
cat >send.py <<'PYTHON'
import os, re, socket, struct, sys, time
group, port = re.match(r"udpm://([0-9.]+):(\d+)", os.environ["LCM_DEFAULT_URL"]).groups()
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
out.bind((sys.argv[1], 0))
data, at, count = open(sys.argv[2], "rb").read(), 0, 0
while at < len(data):
    _, _, _, channel, size = struct.unpack_from(">IqqII", data, at)
    at += 28 + channel + size
    out.sendto(b"LC02" + struct.pack(">I", count) + data[at - channel - size:at - size] + b"\0"
               + data[at - size:at], (group, int(port)))
    count += 1
    time.sleep(0.002)
print(count)
PYTHON

"$program" simulate range-24ghz -o scene --set duration_s=20 >/dev/null
"$program" convert scene/plots.csv scene.lcm 2>/dev/null
open_url=$LCM_DEFAULT_URL

start() { # URL: a node that listens when it returns; $node is its process
    rm -f node.lcm
    "$program" node --lcm "$1" --log node.lcm --config scene/scenario.ini \
        --set hold_ms=500 2>node.err </dev/null &
    node=$!
    wait_until 5 test -s node.lcm
}

stop() { # exit code in $status; $steps
    sleep 1.2
    status=0
    kill -TERM "$node"
    wait "$node" || status=$?
    steps=$(sed -n 's/.*; \([0-9]*\) steps,.*/\1/p' node.err)
}

start "$open_url"
sent=$(python3 send.py 127.0.0.66 scene.lcm) || sent=0
stop
if [ "$sent" -eq 0 ] || [ "$steps" -eq 0 ]; then
    echo "skipped: sources: this system does not send from another address of its own"
    finish
fi
check "without sources_allowed a stranger is tracked ($steps steps)" test "$steps" -ge 390

start "$open_url&sources_allowed=127.0.0.1"
python3 send.py 127.0.0.66 scene.lcm >sent
stop
check 'with it he is not: not one step' test "$steps" -eq 0
check 'and each datagram is counted' grep -q \
    "datagrams of addresses that are not in sources_allowed: $(cat sent)$" node.err
check 'and so while it runs' grep -q \
    'datagrams of addresses that are not in sources_allowed: [0-9]* so far' node.err
check 'the node ends with 0' exits 0

start "$open_url&sources_allowed=127.0.0.77,127.0.0.66"
python3 send.py 127.0.0.66 scene.lcm >sent
stop
check "an address that is allowed is tracked ($steps steps)" test "$steps" -ge 390
check 'what the node itself sends is no fault' test -z "$(grep sources_allowed node.err)"

# ---- both at once: the radar of one address, a stranger with other contents and numbers of another
# ----
awk -F, -v OFS=, 'NR > 1 && $3 != "" { $3 += 3 } { print }' scene/plots.csv >forged.csv
"$program" convert forged.csv forged.lcm 2>/dev/null
run node --lcm 'file://scene.lcm?speed=0' --print --config scene/scenario.ini
cp stdout alone.csv
rm -f node.lcm
"$program" node --lcm "$open_url&sources_allowed=127.0.0.66" --print --log node.lcm \
    --config scene/scenario.ini \
    --set hold_ms=500 >both.csv 2>node.err </dev/null &
node=$!
wait_until 5 test -s node.lcm
python3 send.py 127.0.0.99 forged.lcm >/dev/null &
python3 send.py 127.0.0.66 scene.lcm >/dev/null
wait $!
stop
check "beside a stranger who plays the radar: the tracks of the radar alone ($steps steps)" cmp \
    alone.csv both.csv
finish
