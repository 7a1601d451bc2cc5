#!/bin/bash
# SPDX-License-Identifier: MIT
# node as those who run it see it: a file that is played twice, two senders of one sensor, a second
# node, plots that come as scans of one plot each.
# shellcheck source=tests/integration/loopback.bash
. "$(dirname "$0")/loopback.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# start NAME OPTIONS...: a node with NAME.csv, NAME.lcm, NAME.err; $node is its process.
start() {
    local name=$1
    shift
    "$program" node --print --log "$name.lcm" --set hold_ms=300 "$@" >"$name.csv" 2>"$name.err" \
        </dev/null &
    node=$!
    wait_until 5 test -s "$name.lcm" # its first status
}

stop() {
    kill -INT "$node"
    wait "$node"
}

# Confirmed tracks of the first and of the second half, which begins where time goes back.
halves() { # CSV
    awk -F, 'NR > 1 && $1 + 0 < t { half = 1 } { t = $1 + 0 }
        $3 == "confirmed" && !seen[half + 0, $2]++ { count[half + 0]++ }
        END { print count[0] + 0, count[1] + 0 }' "$1"
}

# ---- a file played twice gives its tracks twice, without false ones ----
twice() { # NAME FILE SPEED TRACKS OPTIONS...
    local name=$1 file=$2 speed=$3 tracks=$4
    shift 4
    start "$name" "$@"
    run publish "$file" --speed "$speed" "$@"
    run publish "$file" --speed "$speed" "$@"
    sleep 0.6
    stop
    check "$name: its tracks twice" matches "$(halves "$name.csv")" "$tracks $tracks"
    check "$name: the restart is told" test "$(grep -c \
        '^20[0-9T:.-]*Z rhotrack: sensor 1 starts again: a restart, or a recording played again$' \
        "$name.err")" = 1
    check "$name: and nothing else" test \
        "$(grep -Ec 'scans|bad|stale|double|suspect' "$name.err")" = 0
}
"$program" simulate radar -o radar # seven scans, 10 s apart
twice seven radar/plots.csv 50 3
"$program" simulate radar --set duration_s=25 --set radars.0.interval_s=1 -o short
twice short short/plots.csv 25 3 --config short/scenario.ini
"$program" convert short/plots.csv short.log.lcm
twice log short.log.lcm 25 3 --config short/scenario.ini # the same numbers, times and epoch
steps=$(sed -n 's/.*; \([0-9]*\) steps, .*/\1/p' log.err)
check 'no scan is lost by it' test "$steps" = 50

# ---- each line has its time, and a sensor its name ----
printf '[sensor 1]\nname = north tower\n' >names.ini
"$program" convert short/plots.csv again.lcm
start named --config short/scenario.ini --config names.ini --set sensor.7.name=never
before=$(date -u +%Y-%m-%dT%H:%M:%S)
run publish again.lcm --speed 25
run publish again.lcm --speed 25
python3 - <<'PYTHON'
import os, socket, struct, urllib.parse
address = urllib.parse.urlsplit(os.environ["LCM_DEFAULT_URL"])
here = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
here.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
for channel in (b"RHO_POLAR_7", b"RHO_POLAR_many"):
    here.sendto(struct.pack(">II", 0x4C433032, 1) + channel + b"\0nothing",
                (address.hostname, address.port))
PYTHON
sleep 0.6
stop
after=$(date -u +%Y-%m-%dT%H:%M:%S)
check 'the name stands behind the number' grep -q \
    'Z rhotrack: sensor 1 (north tower) starts again: a restart' named.err
check 'what is counted is said with its last sensor' grep -q \
    'Z rhotrack: messages bad: 1 so far, the last one of sensor 7 (never)$' \
    named.err
check 'each line has a time of this run' awk -v from="$before" -v to="$after" '
    $1 !~ /^[0-9-]+T[0-9:]+\.[0-9][0-9][0-9]Z$/ || $2 != "rhotrack:" ||
    substr($1, 1, 19) < from || substr($1, 1, 19) > to { exit 1 }
    END { exit NR < 3 }' named.err
check 'config shows names' sh -c "'$program' config --config names.ini |
    grep -q '^sensor.1.name .* north tower  *config '"
for name in "$(printf 'a\001b')" "$(printf %40s name)" ''; do
    run config --set "sensor.1.name=$name"
    check 'what is no name is refused' says 2 'rhotrack: --set sensor.1.name=*: name * *'
done
# in the journal of systemd, which has its own
JOURNAL_STREAM=$(stat -c %d:%i journal 2>/dev/null || { : >journal; stat -c %d:%i journal; }) \
    "$program" node --for 0.1 2>>journal </dev/null
check 'the journal gets lines without a time' grep -q '^rhotrack: 0 messages in' journal

# ---- two senders of one sensor ----
"$program" simulate radar --seed 9 --set duration_s=25 --set radars.0.interval_s=1 -o other
start two --config short/scenario.ini
"$program" publish short/plots.csv --speed 10 2>/dev/null &
first=$!
sleep 0.5
"$program" publish other/plots.csv --speed 10 2>/dev/null &
second=$!
named() {
    grep -Eq 'rhotrack: sensor 1 has two senders: [0-9.]+:[0-9]+ and [0-9.]+:[0-9]+; ' two.err
}
check 'two senders are named within 2 s' wait_until 2 named
wait "$first" "$second"
stop
check 'once' test "$(grep -c 'has two senders' two.err)" = 1

# ---- of a radar that turns slowly: the first one is heard again much later ----
start slow --config radar/scenario.ini
"$program" publish radar/plots.csv 2>/dev/null &
first=$!
sleep 1
"$program" publish radar/plots.csv --set sigma_m=11 2>/dev/null &
second=$!
told() {
    grep -q 'Z rhotrack: sensor 1 has another sender, .*: a restart, or two at once$' slow.err
}
check 'another sender of a slow radar is told within 2 s' wait_until 2 told
kill "$first" "$second"
stop

# ---- a second node ----
start one
one=$node
start more
named() { grep -q ' rhotrack: another node publishes tracks here: ' "$1.err"; }
check 'a second node is named within 2 s' wait_until 2 named one
check 'by both' wait_until 2 named more
stop
node=$one
stop
check 'a node that is alone does not name itself' bash -c '! grep -q "another node" seven.err'

# ---- rows of a turn, each with a time of its own ----
"$program" simulate rotating -o rotating
{
    echo t_s,sensor_id,range_m,azimuth_rad
    awk -F, -v OFS=, 'NR > 1 && $3 != "" { NF = 4; print }' rotating/plots.csv | sort -t, -n -k1,1
} >plots.csv
start rows --config rotating/scenario.ini
run publish plots.csv --speed 40 --set scan_interval_s=0
check 'publish says that scans have one plot' grep -q \
    '^rhotrack: plots.csv: 1575 of 1576 scans have one plot each: '\
'set scan_interval_s if they are parts of one scan$' stderr
stop
check 'and so does the node, once' test "$(grep -c \
    ' rhotrack: sensor 1: 19 of 20 scans have one plot each: ' rows.err)" = 1
check 'no restart is said of it' bash -c '! grep -q "begins again" rows.err'

finish
