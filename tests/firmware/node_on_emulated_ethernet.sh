#!/bin/bash
# SPDX-License-Identifier: MIT
# The radar node in QEMU, with its emulated Ethernet on a bridge: liblcm plays scans to it
# (lcm-logplayer), and what it sends is recorded by lcm-logger and decoded by the Python package
# lcm, live and from the log. Cortex-M4F and M7.
# shellcheck source=tests/firmware/record_and_replay_logs.bash
. "$(dirname "$0")/record_and_replay_logs.bash"
# shellcheck source=tests/integration/network.bash
. "$(dirname "$0")/../integration/network.bash"
. "$(dirname "$0")/../integration/checks.bash"
need_bindings

if ! { ip tuntap add dev node mode tap && add_host radar 1 && add_host logger 2; } 2>error; then
    echo "skipped: $(basename "$0"): no tap device here: $(cat error)"
    [ "${CI:-}" != true ] || check 'a tap device' false # where all of it has to run
    finish
fi
ip link set node master bridge up

check 'a record is made' record popup popup plots --set radars.0.sigma_mps=1
scans=161
stack_most=4096
speed=16
replay_all_tracks() { "$images/replay-radar" popup.lcm expected.lcm radars=1; }
check 'the replay gives the tracks expected' replay_all_tracks

# Takes messages with the Python package until it is told to end: how many of each channel, and the
# last list's scan.
cat >listen.py <<'PYTHON'
import collections
import signal
import sys
import lcm
sys.path.insert(0, "bindings")
import rhotrack
types = {"RHO_TRACKS": rhotrack.track_list_t, "RHO_PEAKS": rhotrack.peak_list_t,
         "RHO_STATUS": rhotrack.status_t, "RHO_WORK": rhotrack.work_t,
         "RHO_LEARNED": rhotrack.learned_t, "RHO_LIFE": rhotrack.life_t}
counts, last, ended = collections.Counter(), None, []
def take(channel, data):
    global last
    message = types[channel].decode(data)
    counts[channel] += 1
    last = message if channel == "RHO_TRACKS" else last
signal.signal(signal.SIGTERM, lambda *_: ended.append(1))
network = lcm.LCM(sys.argv[1])
for channel in types:
    network.subscribe(channel, take)
print("listens", flush=True)
while not ended:
    try:
        network.handle_timeout(100)
    except OSError: # the signal came while it waited
        pass
print(*(counts[channel] for channel in types), last.scan if last else 0)
PYTHON

# The lists of tracks of a log, byte by byte.
cat >tracks_of.py <<'PYTHON'
import sys
import lcm
sys.path.insert(0, "bindings")
import rhotrack
for event in lcm.EventLog(sys.argv[1]):
    if event.channel == "RHO_TRACKS":
        rhotrack.track_list_t.decode(event.data)
        print(event.data.hex())
PYTHON

wait_for() { # text, file: ten seconds at most
    for _ in $(seq 100); do
        grep -q "$1" "$2" && return 0
        sleep 0.1
    done
    return 1
}

live() { # m4 or m7: stock.lcm, heard, console
    local node logger listener machine=mps2-an386
    [ "$1" = m4 ] || machine=mps2-an500
    rm -f stock.lcm console heard
    qemu-system-arm -M "$machine" -display none -monitor none -serial file:console \
        -nic tap,ifname=node,script=no,downscript=no \
        -kernel "$images/$1/radar.elf" </dev/null 2>qemu.err &
    node=$!
    ip netns exec logger /usr/bin/lcm-logger --lcm-url="$lcm_url" -f stock.lcm >/dev/null 2>&1 &
    logger=$!
    ip netns exec logger "$python" listen.py "$lcm_url" >heard 2>listen.err &
    listener=$!
    wait_for listens heard && wait_for 'the node listens' console || echo \
        'listener or node did not start'
    sleep 0.5
    ip netns exec radar /usr/bin/lcm-logplayer --lcm-url="$lcm_url" --speed="$speed" popup.lcm \
        >/dev/null 2>player.err
    sleep 1.5
    kill -TERM "$listener"
    wait "$listener"
    kill -INT "$logger"
    wait "$logger"
    kill "$node"
    wait "$node" 2>/dev/null
}

same_tracks() {
    "$python" tracks_of.py stock.lcm >stock.tracks && "$python" tracks_of.py expected.lcm \
        >expected.tracks &&
        [ -s stock.tracks ] && cmp stock.tracks expected.tracks
}

# lists of tracks as many as in the log, peaks as scans, states and work of the node, what it has
# learned of its radar and of tracks' lives; up to the last scan
heard_all() {
    local tracks peaks states works learned lives last
    read -r tracks peaks states works learned lives last < <(tail -n 1 heard)
    echo "heard: $tracks $peaks $states $works $learned $lives $last"
    [ "$tracks" -eq "$(wc -l <stock.tracks)" ] && [ "$peaks" -eq "$scans" ] && [ "$states" -ge 2 ] \
        &&
        [ "$works" -ge 2 ] && [ "$learned" -ge 2 ] && [ "$lives" -ge 2 ] && [ "$last" -eq "$scans" ]
}

for core in m4 m7; do
    live "$core"
    check "Cortex-${core^^}: lcm-logger has the tracks of the replay, byte for byte" same_tracks
    check "Cortex-${core^^}: the Python package heard all of them" heard_all
    read_status stock.lcm
    check "Cortex-${core^^}: it says that it took $scans scans, all good" test \
        "$(status_of scans_accepted) $(status_of messages_bad) $(status_of scans_lost) $(
            status_of scan)" = "$scans 0 0 $scans"
    check "Cortex-${core^^}: its stack is at most $stack_most bytes, as it says itself" test \
        "$(sed -n 's/^stack *\([0-9]*\).*/\1/p' console | tail -n 1)" -le "$stack_most"
    check "Cortex-${core^^}: it measures its steps" test \
        "$(status_of longest_step_us | cut -d. -f1)" -gt 0
done
finish
