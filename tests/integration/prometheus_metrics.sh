#!/bin/bash
# SPDX-License-Identifier: MIT
# node --metrics: the text that Prometheus reads, read by its own parser; all counters are there,
# and agree with the last words; clients of any kind delay no track and leave nothing behind.
here=$(realpath "$(dirname "$0")")
# shellcheck source=tests/integration/loopback.bash
. "$here/loopback.bash"
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"
if [ -z "${RHO_ON_LOOPBACK:-}" ]; then
    port=$((30000 + $$ % 10000))
else
    port=9467
fi

# start OPTIONS...: a node with metrics; $node is its process.
start() {
    "$program" node --config scene/scenario.ini --config names.ini --metrics $port \
        --set hold_ms=300 "$@" 2>node.err </dev/null &
    node=$!
    listens() { python3 -c "import socket; socket.create_connection(('127.0.0.1', $port))"; }
    wait_until 5 listens
}
stop() {
    kill -TERM "$node"
    status=0
    wait "$node" || status=$?
}
# clients WHAT...: their checks count here.
clients() {
    "$python" "$here/prometheus_metrics.py" $port "$node" "$@" >said 2>&1 ||
        echo "FAIL prometheus_metrics.py $*" >>said
    cat said
    passed=$((passed + $(grep -c '^ok' said)))
    failed=$((failed + $(grep -c '^FAIL' said)))
}

"$program" simulate polar --set duration_s=400 -o scene
cat >names.ini <<'INI'
sensors_allowed = 1 2
[sensor 1]
name = north tower
pd = 0.9
[zone 7]
corners_m = -1e5 -1e5, 1e5 -1e5, 1e5 1e5, -1e5 1e5
INI

# ---- the text ----
for python in python3 /usr/bin/python3 ''; do # Debian's has Debian's packages
    [ -n "$python" ] || {
        echo 'skipped: prometheus_metrics.sh: no Python package prometheus_client'
        finish
    }
    ! "$python" -c 'import prometheus_client' 2>/dev/null || break
done
start
run publish scene/plots.csv --speed 130
python3 - <<'PYTHON'
import os, socket, struct, urllib.parse
address = urllib.parse.urlsplit(os.environ["LCM_DEFAULT_URL"])
here = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
here.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
for text in (struct.pack(">II", 0x4C433032, 1) + b"RHO_POLAR_9\0nothing", b"no LCM"):
    here.sendto(text, (address.hostname, address.port))
PYTHON
sleep 0.7
clients text counters requests slow leaks
stop
check 'ends well' exits 0
# shellcheck source=/dev/null
. ./counts
check 'the last words have the same numbers' grep -Eq \
    "rhotrack: $messages_in messages in, [0-9]+ out; $steps steps, $plots plots, "\
"$tracks_confirmed tracks confirmed" node.err

# ---- a limit that an operator changes ----
start --commands
"$program" publish scene/plots.csv --speed 40 2>/dev/null &
publisher=$!
run command set work_max 5000
check 'work_max is set' exits 0
run command exclude x_m=8000 y_m=8000 x_max_m=9000 y_max_m=9000
check 'an area is excluded' exits 0
sleep 0.2 # a page is sent again as it is for 100 ms
python3 -c "
import urllib.request
print(urllib.request.urlopen('http://127.0.0.1:$port/metrics').read().decode())" >text
check 'and the text has it' grep -q '^rhotrack_step_work_max 5000$' text
check 'beside the configured value' grep -q '^rhotrack_setting{name="work_max"} 5000$' text
check 'which stays' grep -Eq '^rhotrack_setting_configured\{name="work_max"\} [0-9]{5,}$' text
check 'and the area' grep -q '^rhotrack_excluded_areas 1$' text
kill "$publisher"
stop

# ---- no descriptor is left ----
ticks() { awk '{ print $14 + $15 }' "/proc/$node/stat"; }
connect='import socket, sys, time
here = [socket.create_connection(("127.0.0.1", int(sys.argv[1]))) for _ in range(14)]
time.sleep(3)'
limit=$(ulimit -Sn)
ulimit -Sn 14
start
ulimit -Sn "$limit"
python3 -c "$connect" $port &
clients=$!
sleep 1
before=$(ticks)
sleep 1.5
check "it does not spin: $(($(ticks) - before)) ticks" test $(($(ticks) - before)) -lt 20
wait "$clients"
answers() {
    python3 -c "import urllib.request; urllib.request.urlopen('http://127.0.0.1:$port/metrics')"
}
check 'and answers again' wait_until 5 answers
stop

# ---- where it listens ----
start
if [ -n "${RHO_ON_LOOPBACK:-}" ]; then
    ip address add 10.9.0.1/32 dev lo
    check 'other addresses of the machine are not served' python3 -c "
import socket, sys
try:
    socket.create_connection(('10.9.0.1', $port), timeout=2)
except ConnectionRefusedError:
    sys.exit(0)
sys.exit('it answers')"
fi
run node --metrics $port --for 1
check 'a port that is taken is told' says 1 \
    "*Z rhotrack: port $port of 127.0.0.1: Address already in use"
stop
for bad in 0 65536 -1 http; do
    run node --metrics "$bad"
    check "--metrics $bad" says 2 "rhotrack: --metrics *$bad* is *"
done

# ---- clients that mean harm: the tracks are the same, and as early ----
# played LOG: what a node makes of the scene; $worst_us: its longest latency.
played() {
    start --log "$1"
    if [ "${2:-}" ]; then
        "$python" "$here/prometheus_metrics.py" $port "$node" attack=4 >attacks &
        attackers=$!
        sleep 0.5
    fi
    run publish scene/plots.csv --speed 130
    [ -z "${2:-}" ] || wait "$attackers"
    sleep 0.6
    worst_us=$(python3 -c "
import re, urllib.request
text = urllib.request.urlopen('http://127.0.0.1:$port/metrics').read().decode()
print(int(1e6 * float(re.search(r'^rhotrack_latency_seconds_max (.*)', text, re.M)[1])))")
    stop
    # times, places and identities: the boot number is the time of day
    "$program" convert "$1" - --kind tracks 2>/dev/null | cut -d, -f1-9 >"$1.csv"
}
played calm.lcm
calm_us=$worst_us
played attacked.lcm attack
check "$(cat attacks) clients: the same tracks" cmp calm.lcm.csv attacked.lcm.csv
check 'there are some' test "$(wc -l <calm.lcm.csv)" -gt 20
check "as early: $worst_us us at most, $calm_us without" test "$worst_us" -lt $((calm_us + 100000))
finish
