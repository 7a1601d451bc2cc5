#!/bin/bash
# SPDX-License-Identifier: MIT
# node --print into a pipe that nobody reads: tracks go on, what is not printed is counted, SIGTERM
# ends it at once.
# shellcheck source=tests/integration/loopback.bash
. "$(dirname "$0")/loopback.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

"$program" simulate range-24ghz -o scene --set duration_s=30 >/dev/null
mkfifo pipe
# Holds the pipe open, as small as it gets, and never reads.
python3 -c 'import fcntl, os, time
fcntl.fcntl(os.open("pipe", os.O_RDWR), 1031, 4096)
open("held", "w")
time.sleep(120)' &
holder=$!
trap 'kill "$holder" 2>/dev/null; rm -rf "$folder"' EXIT
wait_until 10 test -e held
"$program" node --print --log node.lcm --config scene/scenario.ini --set hold_ms=500 \
    >pipe 2>node.err </dev/null &
node=$!
wait_until 5 test -s node.lcm # its first status
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
