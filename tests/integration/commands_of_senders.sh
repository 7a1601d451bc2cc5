#!/bin/bash
# SPDX-License-Identifier: MIT
# Commands that blind a live node: each is said with its sender and outcome, also after a restart
# from a snapshot, which undoes them without --commands; --commands-from and a rate limit them.
# shellcheck source=tests/integration/loopback.bash
. "$(dirname "$0")/loopback.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Two targets along x, y = 2 and -2 km, a scan each .1 s for a minute.
python3 - >plots.csv <<'PYTHON'
print("t_s,sensor_id,x_m,y_m,sigma_m")
for k in range(600):
    for y_m in (2000, -2000):
        print(f"{k / 10},7,{-3000 + 10 * k},{y_m + k % 3},5")
PYTHON

# Sends the operator's messages of a log from another address of this machine, so many times:
# send.py ADDRESS LOG TIMES
cat >send.py <<'PYTHON'
import os, re, socket, struct, sys, time
group, port = re.match(r"udpm://([0-9.]+):(\d+)", os.environ["LCM_DEFAULT_URL"]).groups()
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
out.bind((sys.argv[1], 0))
data, at, messages = open(sys.argv[2], "rb").read(), 0, []
while at < len(data):
    _, _, _, channel, size = struct.unpack_from(">IqqII", data, at)
    at += 28 + channel + size
    name = data[at - channel - size:at - size]
    if name in (b"RHO_COMMANDS", b"RHO_SETTINGS"):
        messages.append(name + b"\0" + data[at - size:at])
for _ in range(int(sys.argv[3])):
    for message in messages:
        out.sendto(b"LC02" + struct.pack(">I", 0) + message, (group, int(port)))
    time.sleep(0.001)  # no more than a small receive buffer holds
PYTHON

# start NAME OPTIONS...: a node with NAME.csv, NAME.err, NAME.lcm that hears a radar.
start() {
    live=$1
    shift
    "$program" node --print --log "$live.lcm" --set v_max_mps=300 "$@" >"$live.csv" 2>"$live.err" \
        </dev/null &
    node=$!
    wait_until 5 test -s "$live.lcm"
    "$program" publish plots.csv >/dev/null 2>&1 &
    sensor=$!
}
has_both() { [ "$(tail -n 2 "$live.csv" | grep -c confirmed)" -eq 2 ]; }
# Not only tracks of the snapshot, which coast: thirty rows later both are still seen.
sees() { [ "$(wc -l <"$live.csv")" -gt 30 ] && has_both; }
said() { grep -qE "rhotrack: $1" "$live.err"; }
answers() { grep -ac "RHO_${1}_ANSWERS" "$live.lcm"; }

stop() {
    kill "$sensor" 2>/dev/null
    wait "$sensor" 2>/dev/null
    status=0
    kill -INT "$node"
    wait "$node" || status=$?
}

# ---- each message is said ----
start blinded --commands --snapshot blind
wait_until 10 has_both
check 'there are two tracks' has_both
from='from [0-9.]+:[0-9]+'
run command set v_max_mps 250
check 'a setting is said, with its values and sender' said "setting: v_max_mps 300 -> 250, $from\$"
run command set v_max_mps 200
check 'from the value before it' said "setting: v_max_mps 250 -> 200, $from\$"
run command set pd 1.5
check 'one that is refused, with the reason' said \
    "setting: pd 1.5, $from: refused: pd 1.5 is not within 0.01 .. 0.999\$"
run command start x_m=0 y_m=8000 sigma_m=50
check 'a track that is started, with its number' said \
    "command: start x_m=0 y_m=8000 sigma_m=50 vx_mps=0 vy_mps=0 sigma_mps=0, $from: track [0-9]+\$"
run command drop 999
check 'a command that is refused' said "command: drop 999, $from: refused: no such track"
run command freeze "$(tail -n 1 blinded.csv | cut -d, -f2)"
check 'a frozen track' said "command: freeze [0-9]+, $from\$"
run command exclude x_m=-9000 y_m=-9000 x_max_m=9000 y_max_m=9000
check 'an area' said "command: exclude x_m=-9000 y_m=-9000 x_max_m=9000 y_max_m=9000, $from\$"
run command set range_max_m 1
check 'a range that ends all tracking' said "setting: range_max_m 100000 -> 1, $from\$"
run command set work_max 1
check 'a limit of work that does' said "setting: work_max [0-9]+ -> 1, $from\$"
stop
check 'the node ends with 0' exits 0

# ---- a restart says what it has of commands ----
left_by_commands() {
    said 'blind: by an earlier command: exclude x_m=-9000 y_m=-9000 x_max_m=9000 y_max_m=9000$' &&
        said 'blind: by an earlier command: set v_max_mps 200, configured: 300$' &&
        said 'blind: by an earlier command: set range_max_m 1, configured: 100000$' &&
        said 'blind: by an earlier command: set work_max 1, configured: [0-9]+$' &&
        said 'blind: by an earlier command: frozen tracks: 1$'
}
start again --commands --snapshot blind
wait_until 2 has_both
check 'with --commands it is blind as before' test "$(grep -c confirmed again.csv)" -eq 0
stop
check 'says why' left_by_commands
check 'and how to begin without' said \
    'blind: the node goes on with these; a start without --commands leaves them out$'

start seeing --snapshot blind
wait_until 10 sees
check 'without --commands it sees, and no track is frozen any more' sees
stop
check 'says what it leaves out' left_by_commands
check 'and that it does' said 'blind: the node runs without --commands, and leaves these out$'
start later --commands --snapshot blind
wait_until 10 sees
check 'and it is gone for good' sees
stop
check 'so that nothing is said of it' sh -c '! grep -q "earlier command" later.err'

# ---- some addresses alone ----
start one --commands-from 10.9.0.1,127.0.0.77
wait_until 10 has_both
python3 send.py 127.0.0.66 blinded.lcm 1
sleep 0.5
check 'a stranger commands nothing' has_both
check 'which is said' said \
    'setting: range_max_m 1, from 127.0.0.66:[0-9]+: refused: the address is not in --commands-from'
check 'he gets no answer' test "$(answers COMMAND)" -eq 0
python3 send.py 127.0.0.77 blinded.lcm 1
wait_until 5 said 'setting: range_max_m 100000 -> 1, from 127.0.0.77:[0-9]+$'
check 'an address of the list commands' said \
    'setting: range_max_m 100000 -> 1, from 127.0.0.77:[0-9]+$'
stop
check 'refused ones are counted' said \
    'commands of addresses that are not in --commands-from: 9$'

# ---- a flood ----
start flooded --commands
wait_until 10 has_both
python3 send.py 127.0.0.66 blinded.lcm 250
sleep 1
stop
check 'of 2250 commands few are answered' test \
    $(($(answers COMMAND) + $(answers SETTING))) -le 60
check 'few are said' test "$(grep -c 127.0.0.66 flooded.err)" -le 80
check 'and the others are counted' said 'commands beyond the rate that is taken: [0-9]{4}$'

# ---- a node that takes none ----
start shut
python3 send.py 127.0.0.66 blinded.lcm 1
wait_until 5 said 'setting: range_max_m 1,'
check 'without --commands a message is said, too' said \
    'setting: range_max_m 1, from 127.0.0.66:[0-9]+: refused: the node runs without --commands$'
stop

# ---- bad usage ----
refuse() { # what it says, arguments
    run node --commands-from "${@:2}"
    check "says: $1" says 2 "rhotrack: $1"
}
refuse "--commands-from: '10.0.0' is not an IPv4 address" 10.0.0.1,10.0.0
refuse '--commands-from has no address' ,
refuse "--commands-from: more than 64 addresses" "$(printf '10.0.0.%d,' {1..65})"
refuse 'node: --commands-from needs udpm://...: other URLs tell no sender' 10.0.0.1 \
    --lcm tcpq://127.0.0.1:7700
refuse 'node: --commands-from needs udpm://...: other URLs tell no sender' 10.0.0.1 \
    --lcm file://flooded.lcm
finish
