#!/bin/bash
# SPDX-License-Identifier: MIT
# node --print into a pipe that nobody reads: tracks go on, what is not printed is counted, SIGTERM ends it at once.
if [ -z "${NODE_TEST_INSIDE:-}" ] && command -v ip >/dev/null && unshare -Urn true 2>/dev/null; then
    NODE_TEST_INSIDE=1 exec unshare -Urn bash "$0"
fi
if [ -n "${NODE_TEST_INSIDE:-}" ]; then
    ip link set lo up && ip route add 224.0.0.0/4 dev lo
fi
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
export LCM_DEFAULT_URL="udpm://239.255.76.67:$((20000 + $$ % 10000))?ttl=0"

"$program" simulate range-24ghz -o scene --set duration_s=30 >/dev/null
mkfifo pipe
# Holds the pipe open, as small as it gets, and never reads.
python3 -c 'import fcntl, os, time; fcntl.fcntl(os.open("pipe", os.O_RDWR), 1031, 4096); open("held", "w"); time.sleep(120)' &
holder=$!
trap 'kill "$holder" 2>/dev/null; rm -rf "$folder"' EXIT
until [ -e held ]; do sleep 0.05; done
"$program" node --print --log node.lcm --config scene/scenario.ini --set hold_ms=500 >pipe 2>node.err </dev/null &
node=$!
for _ in $(seq 100); do
    [ -s node.lcm ] && break
    sleep 0.05
done
run publish scene/plots.csv --config scene/scenario.ini --speed 6
check 'publish' exits 0
sleep 1
begin_ms=$(($(date +%s%N) / 1000000))
kill -TERM "$node"
status=0
wait "$node" || status=$?
took_ms=$(($(date +%s%N) / 1000000 - begin_ms))
check 'SIGTERM ends the node' test "$status" = 0
check "within a second ($took_ms ms)" test "$took_ms" -lt 1000
check 'it says that the pipe is full' grep -q 'standard output is full' node.err
check '... and how many reports it left out' grep -Eq 'reports not printed: [1-9][0-9]+' node.err
steps=$(sed -n 's/.*; \([0-9]*\) steps,.*/\1/p' node.err)
check "tracks went on ($steps steps)" test "$steps" -ge 590
finish
