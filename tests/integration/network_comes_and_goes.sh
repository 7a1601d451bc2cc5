#!/bin/bash
# SPDX-License-Identifier: MIT
# node and publish on a network that changes while they run: an interface that is made anew, one
# that loses its address and gets it again, a route that comes after the start. The node hears again
# within 2 s and says on which interface, also where the system allows no rtnetlink.
# shellcheck source=tests/integration/network.bash
. "$(dirname "$0")/network.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

add_host radar 1
add_host tracker 2

# The radar's host sends ten datagrams a second, and writes down which messages it hears from the
# tracker's.
cat >radar.py <<'PYTHON'
import select
import socket
import struct
group, port = "239.255.76.67", 7667
here = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
here.bind((group, port))
here.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                socket.inet_aton(group) + socket.inet_aton("10.9.0.1"))
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
number = 0
with open("heard", "w") as heard:
    while True:
        number += 1
        out.sendto(struct.pack(">II", 0x4C433032, number) + b"RHO_NEWS\0nothing", (group, port))
        while select.select([here], [], [], 0.1)[0]:
            datagram, (address, _) = here.recvfrom(65536)
            if address != "10.9.0.1":
                print(datagram[8:].split(b"\0")[0].decode(), file=heard, flush=True)
PYTHON
ip netns exec radar python3 radar.py &
radar=$!
trap 'kill "$radar"; rm -rf "$folder"' EXIT

# Runs a program that may open no netlink socket, as under RestrictAddressFamilies of systemd.
cat >without_netlink.py <<'PYTHON'
import ctypes
import os
import platform
import struct
import sys
call_of_socket = {"x86_64": 41, "aarch64": 198}[platform.machine()]
program = b"".join(struct.pack("HBBI", *step) for step in (
    (0x20, 0, 0, 0), (0x15, 0, 3, call_of_socket),  # other calls go on
    (0x20, 0, 0, 16), (0x15, 0, 1, 16),             # so do other families than AF_NETLINK
    (0x06, 0, 0, 0x50000 + 97),                     # EAFNOSUPPORT
    (0x06, 0, 0, 0x7FFF0000)))
steps = ctypes.create_string_buffer(program, len(program))
rules = ctypes.create_string_buffer(struct.pack("HxxxxxxP", len(program) // 8,
                                                ctypes.addressof(steps)))
libc = ctypes.CDLL(None)
none = ctypes.c_ulong(0)
if libc.prctl(38, ctypes.c_ulong(1), none, none, none) or \
        libc.prctl(22, ctypes.c_ulong(2), rules, none, none):
    sys.exit("no seccomp")
os.execv(sys.argv[1], sys.argv[1:])
PYTHON

# begin NAME [COMMAND...]: a node with NAME.lcm and NAME.err, started by the command.
begin() {
    node_name=$1
    shift
    ip netns exec tracker "$@" "$program" node --lcm "$lcm_url" --log "$node_name.lcm" \
        2>"$node_name.err" </dev/null &
    node=$!
}

stop() {
    status=0
    kill -INT "$node"
    wait "$node" || status=$?
    cp "$node_name.err" stderr
}

within_2_s() { wait_until 2 "$@"; }

heard() { grep -aoF RHO_NEWS "$node_name.lcm" 2>/dev/null | wc -l; }
is_heard_since() { [ "$(heard)" -gt "$1" ]; }
hears_within_2_s() { within_2_s is_heard_since "$(heard)"; }

is_deaf() {
    local before
    sleep 0.5
    before=$(heard)
    sleep 0.5
    [ "$(heard)" -eq "$before" ]
}

sent() { grep -c "$1" heard; } # channel
is_sent_since() { [ "$(sent "$1")" -gt "$2" ]; }
sends_within_2_s() { within_2_s is_sent_since "$1" "$(sent "$1")"; }

# So many lines say that the node listens there.
says_place() { # place, number of lines
    within_2_s test_lines "$2" "Z rhotrack: listens to 239.255.76.67:7667 on $1\$" "$node_name.err"
}
test_lines() { [ "$(grep -c "$2" "$3")" -eq "$1" ]; }
alone='lo (127.0.0.1), the programs of this machine alone: no route to the group'

# ---- silence: no message on this port in the first 12 s ----
ip netns exec tracker "$program" node --lcm "${lcm_url/7667/7668}" 2>silent.err </dev/null &
silent=$!

# ---- an interface that goes ----
begin usual
check 'it says on which interface it listens' says_place 'eth0 (10.9.0.2)' 1
check 'and hears' hears_within_2_s
ip -n tracker link delete eth0
check 'an interface goes: it says so' says_place "$alone" 1
check 'and hears nothing' is_deaf
connect_host tracker 2
check 'it is made anew: it hears again within 2 s' hears_within_2_s
check 'says so' says_place 'eth0 (10.9.0.2)' 2
check 'and sends there' sends_within_2_s RHO_STATUS
ip -n tracker address flush dev eth0
address_host tracker 2
check 'an address taken away and given again at once: it hears again' hears_within_2_s
ip -n tracker address flush dev eth0
check 'an address taken away for longer' is_deaf
address_host tracker 3
check 'and another given: it hears again' hears_within_2_s
check 'and names the other' says_place 'eth0 (10.9.0.3)' 1
ip -n tracker link set eth0 down
check 'an interface that is down' is_deaf
ip -n tracker link set eth0 up
ip -n tracker route add 224.0.0.0/4 dev eth0
check 'and up: it hears again' hears_within_2_s
check 'and sends' sends_within_2_s RHO_STATUS
stop
check 'it ends with 0' exits 0
ip -n tracker address flush dev eth0

# ---- a network that comes after the start ----
begin early
sleep 0.7
check 'without an interface it listens on the loopback' says_place "$alone" 1
ip -n tracker address add 10.9.0.2/24 dev eth0
check 'an address is no route' is_deaf
ip -n tracker route add 224.0.0.0/4 dev eth0
check 'a route that comes after the start: it hears within 2 s' hears_within_2_s
check 'and says so, once' says_place 'eth0 (10.9.0.2)' 1
check 'nothing else is told' test_lines 3 rhotrack early.err
stop

# ---- a machine whose loopback is down as well ----
ip -n tracker address flush dev eth0
ip -n tracker link set lo down
begin mute
check 'messages that no interface takes are counted' within_2_s grep -q \
    'Z rhotrack: messages not sent: [0-9]* so far$' mute.err
address_host tracker 2
check 'with an interface they are sent' sends_within_2_s RHO_STATUS
check 'and others heard' hears_within_2_s
stop
check 'it ends with 0' exits 0
ip -n tracker link set lo up

# ---- a group that cannot be joined ----
memberships() { ip netns exec tracker sysctl -q "net.ipv4.igmp_max_memberships=$1"; }
if memberships 0 2>/dev/null; then
    begin refused
    check 'a group that cannot be joined: the node says why' within_2_s test_lines 1 \
        'Z rhotrack: cannot listen to 239.255.76.67:7667 on eth0 (10.9.0.2): No buffer space' \
        refused.err
    memberships 20
    check 'and tries again until it hears' hears_within_2_s
    check 'and says so' says_place 'eth0 (10.9.0.2)' 1
    stop
else
    echo 'skipped: network_comes_and_goes.sh: igmp_max_memberships cannot be set here'
fi

# ---- without rtnetlink ----
if ip netns exec tracker python3 without_netlink.py /bin/true 2>/dev/null; then
    begin blind python3 without_netlink.py
    check 'without rtnetlink it names the address' says_place 'an interface (10.9.0.2)' 1
    check 'and hears' hears_within_2_s
    ip -n tracker address flush dev eth0
    address_host tracker 2
    check 'an address given again: it hears again' hears_within_2_s
    ip -n tracker link delete eth0
    check 'an interface goes' says_place "$alone" 1
    connect_host tracker 2
    check 'and is made anew: it hears again' hears_within_2_s
    check 'and says so' says_place 'an interface (10.9.0.2)' 2
    stop
else
    echo 'skipped: network_comes_and_goes.sh: without rtnetlink: no seccomp here'
fi

# ---- publish ----
{
    echo t_s,sensor_id,x_m,y_m
    for t in {0..99}; do echo "$t,2,1000,1000"; done
} >plots.csv
ip -n tracker route delete 224.0.0.0/4 dev eth0
ip netns exec tracker "$program" publish plots.csv --lcm "$lcm_url" --speed 10 2>publish.err &
publish=$!
sleep 0.7
check 'publish without a route sends to its own machine alone' test_lines 0 RHO_PLOTS_2 heard
ip -n tracker route add 224.0.0.0/4 dev eth0
check 'with one it sends there' sends_within_2_s RHO_PLOTS_2
check 'and says so' test_lines 1 \
    '^rhotrack: sends to 239.255.76.67:7667 on eth0 (10.9.0.2)$' publish.err
kill -INT "$publish"
wait "$publish"

# ---- the silent one ----
while [ "$SECONDS" -lt 11 ]; do sleep 0.1; done # of this script, which began before the node
sleep 2
check 'nothing is heard 12 s long: it says so, and where it listens, once' test_lines 1 \
    'Z rhotrack: no message was heard in the 12 s since the start; listens to .*:7668 on eth0' \
    silent.err
ip netns exec tracker "$program" publish plots.csv --lcm "${lcm_url/7667/7668}" --speed 0 \
    2>publish.err
check 'and when that ends' within_2_s test_lines 1 \
    'Z rhotrack: the first message is heard, [0-9]* s after the start$' silent.err
kill -INT "$silent"
wait "$silent"
finish
