#!/bin/bash
# SPDX-License-Identifier: MIT
# Two nodes with --standby on two machines: one publishes, the other one keeps the same tracks, and
# publishes within three seconds after the first was killed, stopped or cut off; no two lists are
# ever of one epoch and step. Runs beside others.
# shellcheck source=tests/integration/network.bash
. "$(dirname "$0")/network.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# ---- a wrong use ----
for url in file://input.lcm 'file://input.lcm?speed=0' memq:// tcpq://127.0.0.1:7700; do
    run node --standby --lcm "$url"
    check "--standby needs senders: $url" says 2 \
        'rhotrack: node: --standby needs udpm://...: other URLs tell no sender'
done

# ---- a radar of .2 s, three targets, clutter ----
add_host radar 1
add_host one 2
add_host two 3
python3 - >plots.csv <<'PYTHON'
import random
random.seed(45)
print("t_s,sensor_id,x_m,y_m,sigma_m")
for k in range(900):
    t_s = k / 5
    for n in range(3):
        if random.random() < 0.95:
            print(f"{t_s},7,{-8000 + 60 * t_s + random.gauss(0, 5):.2f},"
                  f"{2000 * n + random.gauss(0, 5):.2f},5")
    for _ in range(3):
        print(f"{t_s},7,{random.uniform(-9000, 9000):.2f},{random.uniform(-3000, 7000):.2f},5")
PYTHON

# Lists as they come: time, address, epoch, step, part, number of tracks.
cat >listen.py <<'PYTHON'
import socket
import struct
import time
group = "239.255.76.67"
here = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
here.bind((group, 7667))
here.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                socket.inet_aton(group) + socket.inet_aton("10.9.0.1"))
with open("lists", "w") as lists:
    while True:
        datagram, (address, _) = here.recvfrom(65536)
        channel, _, message = datagram[8:].partition(b"\0")
        if channel == b"RHO_TRACKS":
            _, _, step, epoch, tracks, part = struct.unpack_from(">qqiihh", message)
            print(f"{time.monotonic():.3f} {address} {epoch} {step} {part} {tracks}", file=lists,
                  flush=True)
PYTHON
ip netns exec radar python3 listen.py &
listener=$!

declare -A process
# begin HOST OPTIONS...: a node there, with HOST.csv and HOST.err
begin() {
    local host=$1
    shift
    ip netns exec "$host" "$program" node --lcm "$lcm_url" --print --set v_max_mps=300 "$@" \
        >"$host.csv" 2>"$host.err" </dev/null &
    process[$host]=$!
}
kill_all() {
    kill -KILL "${process[@]}" "$listener" "${player:-$listener}" 2>/dev/null
    rm -rf "$folder"
}
trap kill_all EXIT

said() { grep -q "Z rhotrack: standby: $2\$" "$1.err"; }
count() { grep -c " $1 " lists; }                    # lists of an address
publishes() { [ "$(tail -n 1 lists | cut -d ' ' -f 2)" = "$1" ]; }
# In half a second that address alone publishes, and all three targets have tracks.
alone() { # address
    local before
    before=$(wc -l <lists)
    sleep 0.5
    tail -n +$((before + 1)) lists >new
    [ -s new ] && ! grep -qv " $1 " new && awk '$6 < 3 {exit 1}' new
}
longest_gap() { # most seconds, from that row of lists on
    tail -n +"$2" lists | awk -v most="$1" 'NR > 1 && $1 - last > most {
        print "no list for " $1 - last " s"; bad = 1 } {last = $1} END {exit bad}'
}
each_once() { ! cut -d ' ' -f 3-5 lists | sort | uniq -d | grep .; }
first=10.9.0.2 second=10.9.0.3

begin one --standby --metrics 9467
check 'alone it publishes after two seconds' wait_until 3 said one \
    'no other node publishes; this one does'
begin two --standby --metrics 9467
check 'a second one hears it, and is silent' wait_until 3 said two "$first:[0-9]* publishes; .*"
ip netns exec radar "$program" publish plots.csv --lcm "$lcm_url" 2>publish.err &
player=$!
check 'tracks are published' wait_until 6 alone "$first"
sleep 2
check 'by the first one alone' test "$(count "$second")" -eq 0
metric() { # host
    ip netns exec "$1" python3 -c 'import urllib.request
print(urllib.request.urlopen("http://127.0.0.1:9467/metrics").read().decode())' |
        sed -n 's/^rhotrack_publishing //p'
}
check 'which the metrics say' matches "$(metric one) $(metric two)" '1 0'
rows=$(wc -l <two.csv)
has_rows() { [ "$(wc -l <"$1")" -ge "$2" ]; } # file, rows
wait_until 2 has_rows one.csv "$rows"
check 'the second one has the same tracks, byte by byte' cmp <(head -n $((rows - 1)) one.csv) \
    <(head -n $((rows - 1)) two.csv)
check 'and they are many' test "$rows" -gt 40

at=$(wc -l <lists)
kill -KILL "${process[one]}"
check 'the first one is killed: the second publishes' wait_until 4 publishes "$second"
check 'and says so' said two "$first:[0-9]* is silent; this node publishes"
check 'all three tracks' alone "$second"
check 'after three seconds at most' longest_gap 3 "$at"
numbers() { tail -n 30 "$1" | grep confirmed | cut -d , -f 2 | sort -u; }
check 'with the numbers they had' cmp <(numbers one.csv) <(numbers two.csv)
check 'of three tracks' test "$(numbers two.csv | wc -l)" -eq 3

begin one --standby
check 'the first one is started again: it is silent' wait_until 3 said one \
    "$second:[0-9]* publishes; .*"
sleep 4
check 'and stays so' alone "$second"

at=$(wc -l <lists)
kill -STOP "${process[two]}"
check 'the second one is stopped: the first publishes' wait_until 4 publishes "$first"
check 'after three seconds at most' longest_gap 3 "$at"
sleep 1
stopped=$(count "$second")
kill -CONT "${process[two]}"
check 'it goes on, and is silent' wait_until 3 said two \
    "$first:[0-9]* publishes; this node is silent"
check 'the first one goes on' alone "$first"
check 'the second one published nothing more' test "$(count "$second")" -eq "$stopped"

at=$(wc -l <lists)
ip -n one link set eth0 down
check 'the cable of the first one is cut: the second publishes' wait_until 4 publishes "$second"
check 'after three seconds at most' longest_gap 3 "$at"
sleep 2
ip -n one link set eth0 up
ip -n one route add 224.0.0.0/4 dev eth0
is_back() { tail -n 3 one.err | grep -q "$second:[0-9]* publishes; this node is silent"; }
check 'it is back, and falls silent' wait_until 4 is_back
sleep 1
check 'the second one goes on' alone "$second"
check 'without a gap' longest_gap 1 "$((at + 40))"

kill -KILL "${process[one]}"
begin one
check 'a node without --standby publishes: the second one falls silent' wait_until 6 alone "$first"
check 'no two lists are of one epoch and step' each_once
status=0
kill -INT "${process[two]}"
wait "${process[two]}" || status=$?
check 'it ends with 0' exits 0
finish
