#!/bin/bash
# SPDX-License-Identifier: MIT
# node beside a service manager, a script that takes its datagrams: ready once, a word to the
# watchdog twice in its time, the end. Without a manager, or with a deaf one, the node goes on.
# shellcheck source=tests/integration/loopback.bash
. "$(dirname "$0")/loopback.bash"
unit=$(realpath "$(dirname "$0")/../../tools/install/rhotrack-node.service.in")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# manager.py SOCKET SECONDS PROGRAM...: runs a program with a manager, which takes nothing in the
# first seconds; each datagram is a line of the file `heard`, with | between its own lines.
cat >manager.py <<'PYTHON'
import os
import socket
import subprocess
import sys
import time
name, seconds, program = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
manager.bind("\0" + name[1:] if name[0] == "@" else name)
manager.settimeout(0.05)
process = subprocess.Popen(program, env={**os.environ, "NOTIFY_SOCKET": name})
with open("heard", "w") as heard:
    time.sleep(seconds)
    is_over = False
    while not is_over:
        is_over = process.poll() is not None
        try:
            while True:
                print(manager.recv(4096).decode().replace("\n", "|"), file=heard)
        except TimeoutError:
            pass
sys.exit(process.returncode)
PYTHON

# with_manager SOCKET SECONDS OPTIONS...: exit code in $status
with_manager() {
    status=0
    python3 manager.py "$1" "$2" "$program" node "${@:3}" 2>stderr || status=$?
}

count() { grep -c "$1" heard; }
within() { [ "$1" -ge "$2" ] && [ "$1" -le "$3" ] || { echo \
    "$1 is not within $2 .. $3"; return 1; }; }

# Half of 0.4 s is a turn of 0.2 s: 10 words in 2 s, fewer on a machine that is busy.
for name in "$folder/socket" "@rhotrack-$$"; do
    WATCHDOG_USEC=400000 with_manager "$name" 0 --for 2
    check "${name%%[a-z]*}: the node ends with 0" exits 0
    check 'it is ready at once, and listens' matches "$(head -n 1 heard)" \
        'READY=1|WATCHDOG=1|STATUS=listens to 239.255.76.67:* on * (*); 0 messages in, 0 steps'
    check 'it is ready once' test "$(count READY=1)" = 1
    check 'the watchdog hears it twice in its time' within "$(count WATCHDOG=1)" 5 11
    check 'and each time its status' test "$(count 'WATCHDOG=1|STATUS=')" = "$(count WATCHDOG=1)"
    check 'the end is told' test "$(tail -n 1 heard)" = STOPPING=1
done

WATCHDOG_USEC=400000 WATCHDOG_PID=1 with_manager ./other 0 --for 1
check 'a path that is not absolute' exits 2
check 'is told' matches "$(cat stderr)" '*rhotrack: NOTIFY_SOCKET ./other: not a path, or @ *'

WATCHDOG_USEC=400000 WATCHDOG_PID=1 with_manager @other-$$ 0 --for 1
check "another process's watchdog gets no word" test "$(count WATCHDOG)" = 0
check 'but the manager does' test "$(count READY=1)" = 1

# A replay waits for the reader of its tracks, here for 2 s: a loop that stands has no word.
"$program" simulate traffic --seed 3 --set targets.0.count=6 --set duration_s=3000 \
    --set clutter.0.plots=5 -o scene >/dev/null
"$program" convert scene/plots.csv scene.lcm 2>/dev/null
WATCHDOG_USEC=200000 with_manager @stands-$$ 0 --lcm 'file://scene.lcm?speed=0' --print \
    --config scene/scenario.ini | { sleep 2; wc -c >bytes; }
check 'a loop that stands for 2 s' test "$(cat bytes)" -gt 100000
check 'gives the watchdog no word meanwhile' within "$(count WATCHDOG=1)" 1 6

# The node waits for no manager: its queue is full after ten datagrams.
WATCHDOG_USEC=2000 with_manager @late-$$ 1.5 --for 1
check 'a manager that takes nothing: the node ends with 0' exits 0
check 'and in time' test "$(count WATCHDOG)" -le 600
check 'without a word' test -z "$(grep NOTIFY_SOCKET stderr)"

NOTIFY_SOCKET=$folder/nobody run node --for 1.2
check 'a manager that is not there: the node ends with 0' exits 0
check 'and says so once' test "$(grep -c 'rhotrack: NOTIFY_SOCKET: .*; the service manager hears '\
'nothing$' stderr)" = 1
run node --for 0.2
check 'no manager: nothing is said of one' test -z "$(grep -i -e manager -e NOTIFY stderr)"

# ---- the unit ----
for line in Type=notify 'WatchdogSec=[1-9]' 'Restart=on-failure' \
    'RestrictAddressFamilies=.*AF_NETLINK.*AF_UNIX'; do
    check "the unit has $line" grep -q "^$line" "$unit"
done
finish
