#!/bin/bash
# SPDX-License-Identifier: MIT
# node --log onto a disk that is full, or that stalls, and standard error into a full pipe: tracks
# go on, what is not written is counted and said, live too (RHO_WORK), what is written can be read,
# and SIGTERM ends the node within a second; within eleven where a snapshot is not written.
# shellcheck source=tests/integration/loopback.bash
. "$(dirname "$0")/loopback.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

"$program" simulate range-24ghz -o scene --set duration_s=30 >/dev/null
trap 'kill $(jobs -p) 2>/dev/null; rm -rf "$folder"' EXIT

# The newest RHO_WORK of the network in the file work, from now on: num_steps and events_not_logged.
cat >listen.py <<'PYTHON'
import os, re, socket, struct
group, port = re.match(r"udpm://([0-9.]+):(\d+)", os.environ["LCM_DEFAULT_URL"]).groups()
here = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
here.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
here.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
here.bind((group, int(port)))
here.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                socket.inet_aton(group) + socket.inet_aton("127.0.0.1"))
open("listens", "w").close()
while True:
    data = here.recv(65536)
    if data[8:17] == b"RHO_WORK\0":
        numbers = struct.unpack(">Qqii8q", data[17:])
        with open("work.part", "w") as out:
            print(numbers[4], numbers[11], file=out)
        os.rename("work.part", "work")
PYTHON
python3 listen.py &
wait_until 10 test -e listens

# start OPTIONS...: a node that listens when it returns; $node is its process.
start() {
    rm -f work
    "$program" node --config scene/scenario.ini --set hold_ms=500 "$@" 2>node.err </dev/null &
    node=$!
    wait_until 5 test -s work
}

# Tells the node to end, and waits for it: $status, $took_ms.
end_node() {
    local begin_ms
    begin_ms=$(($(date +%s%N) / 1000000))
    kill -TERM "$node"
    status=0
    wait "$node" || status=$?
    took_ms=$(($(date +%s%N) / 1000000 - begin_ms))
}

# Plays the scene, and ends the node: $status, $took_ms, $steps, $left_out; live: $live_steps,
# $live_left_out.
play() {
    run publish scene/plots.csv --config scene/scenario.ini "${speed[@]}"
    sleep 1.2
    read -r live_steps live_left_out <work
    end_node
    steps=$(sed -n 's/.*; \([0-9]*\) steps,.*/\1/p' node.err)
    left_out=$(sed -n 's/.*events not logged: \([0-9]*\)$/\1/p' node.err)
}
speed=(--speed 15)

# What holds of all of them.
goes_on() { # NAME, exit code, seconds until the end at most
    check "$1: SIGTERM ends the node with $2" exits "$2"
    check "$1: within $3 s ($took_ms ms)" test "$took_ms" -lt $(($3 * 1000))
    check "$1: tracks went on ($steps steps, $live_steps seen live)" test "$steps" -ge 590 -a \
        "$live_steps" -ge 560
}

# Whole events and nothing else are in a log; all channels are there.
can_be_read() { # LOG
    "$program" convert "$1" read.csv --kind tracks 2>read.err && [ "$(wc -l <read.csv)" -gt 1 ] \
        || return 1
    ! grep -E 'cut off|skipped' read.err
}

# ---- a disk that is full from the start ----
start --log /dev/full
play
goes_on 'a full disk' 1 1
why='/dev/full: No space left on device; tracking goes on without the log'
check 'it is said once, with the reason' matches "$(grep -c "$why" node.err)" 1
check "all events are counted ($left_out, live $live_left_out)" test "$left_out" -ge 1700 -a \
    "$live_left_out" -ge 1700

# ---- a file that may not grow any more: half an event does not stay at its end ----
rm -f work
bash -c 'ulimit -f 64 && exec "$0" node "$@"' "$program" --config scene/scenario.ini \
    --set hold_ms=500 --log limited.lcm \
    2>node.err </dev/null &
node=$!
wait_until 5 test -s work
play
goes_on 'a file as long as it may be' 1 1
check 'a file as long as it may be: the reason' grep -q \
    'limited.lcm: File too large; tracking goes on without the log' node.err
check 'and the rest is counted' test "$left_out" -ge 1000
check 'what is there can be read' can_be_read limited.lcm
check 'and is no less than an event below the limit' test \
    "$(stat -c %s limited.lcm)" -gt $((65536 - 1500))

# ---- a disk that fills up ----
if unshare -m sh -c 'mkdir disk && mount -t tmpfs -o size=64k none disk' 2>/dev/null; then
    rm -f work
    # shellcheck disable=SC2016 # that shell's
    unshare -m bash -c 'mount -t tmpfs -o size=64k none disk
        "$0" node --config scene/scenario.ini --set hold_ms=500 --log disk/node.lcm \
            2>node.err & echo $! >pid
        wait $!; echo $? >code; cp disk/node.lcm filled.lcm' "$program" </dev/null &
    wait_until 5 test -s work
    holder=$!
    node=$(cat pid)
    run publish scene/plots.csv --config scene/scenario.ini "${speed[@]}"
    sleep 1.2
    read -r live_steps live_left_out <work
    begin_ms=$(($(date +%s%N) / 1000000))
    kill -TERM "$node"
    wait "$holder"
    took_ms=$(($(date +%s%N) / 1000000 - begin_ms))
    status=$(cat code)
    steps=$(sed -n 's/.*; \([0-9]*\) steps,.*/\1/p' node.err)
    goes_on 'a disk that fills up' 1 1
    check 'a disk that fills up: the reason' grep -q 'disk/node.lcm: No space left on device' \
        node.err
    check 'what was written can be read' can_be_read filled.lcm
else
    echo 'skipped: a disk that fills up: no mounts here'
fi

# ---- a disk that stalls: a pipe that is held open and never read ----
# Holds a pipe open, as small as it gets, and never reads; full: filled beforehand. hold.py PIPE
# DONE [full]
cat >hold.py <<'PYTHON'
import fcntl, os, sys, time
pipe = os.open(sys.argv[1], os.O_RDWR)
fcntl.fcntl(pipe, 1031, 4096) # F_SETPIPE_SZ
if "full" in sys.argv:
    os.write(pipe, bytes(4096))
open(sys.argv[2], "w").close()
time.sleep(300)
PYTHON
mkfifo pipe
python3 hold.py pipe held &
wait_until 10 test -e held
start --log pipe
play
goes_on 'a disk that stalls' 0 1
check "what did not come out is counted ($left_out)" test "$left_out" -ge 1000
start --log pipe
speed=(--speed 60 --loop)
timeout -s INT 12 "$program" publish scene/plots.csv --config scene/scenario.ini \
    "${speed[@]}" 2>/dev/null &
player=$!
check 'once the queue is full, events are left out, and RHO_WORK says so' wait_until 12 grep -q \
    ' [1-9]' work
kill -INT "$player" 2>/dev/null
why='pipe: the disk is too slow or full; events are left out, tracking goes on'
check 'it is said once' matches "$(grep -c "$why" node.err)" 1
end_node
check 'a full queue: SIGTERM ends the node with 0' exits 0
check "a full queue: within a second ($took_ms ms)" test "$took_ms" -lt 1000
speed=(--speed 15)

# ---- a log that does not even open: a pipe that nobody has opened to read ----
mkfifo nobody
start --log nobody
play
goes_on 'a log that does not open' 0 1
check 'it is said' grep -q 'nobody: cannot be opened yet; tracking goes on' node.err

# ---- a record waits for its log, until the node is told to end ----
"$program" simulate range-24ghz -o long --set duration_s=400 >/dev/null
"$program" convert long/plots.csv long.lcm 2>/dev/null
"$program" node --lcm 'file://long.lcm?speed=0' --config scene/scenario.ini \
    --log pipe 2>node.err </dev/null &
node=$!
sleep 4
check 'a record waits for its log' kill -0 "$node"
end_node
check 'a record: SIGTERM ends the node with 0' exits 0
check "a record: within a second ($took_ms ms)" test "$took_ms" -lt 1000

run node --lcm 'file://long.lcm?speed=0' --config scene/scenario.ini --log whole.lcm
check 'and is whole where the disk takes it' exits 0
check 'of more than the queue holds' test "$(stat -c %s whole.lcm)" -gt $((4 << 20))
check 'of more than the queue holds: it can be read' can_be_read whole.lcm

# ---- standard error into a full pipe ----
mkfifo errors
python3 hold.py errors filled full &
wait_until 10 test -e filled
rm -f work
"$program" node --config scene/scenario.ini --set hold_ms=500 --log node.lcm 2>errors </dev/null &
node=$!
wait_until 5 test -s work
: >node.err
play
check 'standard error into a full pipe: SIGTERM ends the node with 0' exits 0
check "standard error into a full pipe: within a second ($took_ms ms)" test "$took_ms" -lt 1000
check "standard error into a full pipe: tracks went on ($live_steps steps)" test \
    "$live_steps" -ge 560
# ---- a broker that takes the connection and says nothing ----
cat >silent.py <<'PYTHON'
import os, socket, time
here = socket.create_server(("127.0.0.1", 0))
with open("port.part", "w") as out:
    print(here.getsockname()[1], file=out)
os.rename("port.part", "port")
time.sleep(300)
PYTHON
python3 silent.py &
wait_until 10 test -s port
"$program" node --lcm "tcpq://127.0.0.1:$(cat port)" 2>node.err </dev/null &
node=$!
sleep 1
end_node
check 'a silent broker: SIGTERM ends the node' test "$status" -le 1
check "a silent broker: within a second ($took_ms ms)" test "$took_ms" -lt 1000

# ---- a table that nobody reads ----
mkfifo table
python3 hold.py table table-filled full &
wait_until 10 test -e table-filled
rm -f work
"$program" node --config scene/scenario.ini --set hold_ms=500 --print 2>node.err </dev/null >table &
node=$!
wait_until 5 test -s work
play
check "a table that nobody reads: within a second ($took_ms ms)" test "$took_ms" -lt 1000

# ---- a snapshot onto a disk that does not answer: the program waits for it, but not for long ----
cat >stall.c <<'C'
int pause(void);
int rename(const char *from, const char *to)
{
    (void)from;
    (void)to;
    for (;;) {
        pause();
    }
}
C
if gcc -shared -fPIC -o stall.so stall.c 2>/dev/null; then
    rm -f work
    LD_PRELOAD=./stall.so "$program" node --config scene/scenario.ini --set hold_ms=500 \
        --snapshot saved --log node.lcm 2>node.err </dev/null &
    node=$!
    wait_until 5 test -s work
    play
    goes_on 'a snapshot that cannot end' 1 11
    check 'a snapshot that cannot end: it is said' grep -q \
        'an output does not end in time; it ends without it' node.err
    check 'and the log is whole all the same' can_be_read node.lcm
else
    echo 'skipped: a snapshot that cannot end: no gcc here'
fi
finish
