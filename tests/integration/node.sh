#!/bin/bash
# SPDX-License-Identifier: MIT
# node and publish: the same tracks live as from a file, a clean end, logs, other providers, bad
# URLs.
# shellcheck source=tests/integration/loopback.bash
. "$(dirname "$0")/loopback.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# start NAME OPTIONS...: a node with NAME.csv, NAME.lcm, NAME.err; $node is its process. It listens
# when it returns. It waits long for parts and other sensors: on a machine that is busy publish may
# pause for more than 20 ms.
start() {
    local name=$1
    shift
    "$program" node --print --log "$name.lcm" --config scene/scenario.ini --set hold_ms=500 "$@" \
        >"$name.csv" 2>"$name.err" </dev/null &
    node=$!
    wait_until 5 test -s "$name.lcm" # its first status
}

# stop SIGNAL PROCESS: exit code in $status.
stop() {
    status=0
    kill "-$1" "$2"
    wait "$2" || status=$?
}

# Rows of tracks, all columns equal as float32 but for what is made of others (sigma_m, sigma_mps).
same_tracks() { # file of track, file of convert
    python3 - "$1" "$2" <<'PYTHON'
import csv, struct, sys
f32 = lambda text: struct.unpack("f", struct.pack("f", float(text)))[0]
def rows(path):
    table = {}
    for row in csv.DictReader(open(path)):
        if row["status"] != "deleted":
            table.setdefault(round(float(row["t_s"]) * 1e6), []).append(row)
    return table
a, b = rows(sys.argv[1]), rows(sys.argv[2])
assert a and a.keys() == b.keys(), (sorted(a), sorted(b))
words = ("track_id", "status", "hits", "misses", "sensor_id", "plot")
numbers = [q + s for q, s in (("x", "_m"), ("y", "_m"), ("z", "_m"),
                              ("vx", "_mps"), ("vy", "_mps"), ("vz", "_mps"),
                              ("ax", "_mps2"), ("ay", "_mps2"), ("az", "_mps2"))]
for t in a:
    assert len(a[t]) == len(b[t]), t
    for p, q in zip(a[t], b[t]):
        assert [p[w] for w in words] == [q[w] for w in words], (t, p, q)
        assert [f32(p[n]) for n in numbers] == [f32(q[n]) for n in numbers], (t, p, q)
        for n in ("sigma_m", "sigma_mps"):
            assert abs(float(p[n]) - float(q[n])) <= 1e-4 * float(p[n]), (t, n, p, q)
PYTHON
}

"$program" simulate traffic --seed 3 --set targets.0.count=6 --set duration_s=150 \
    --set clutter.0.plots=60 -o scene
run track scene/plots.csv --config scene/scenario.ini
cp stdout tracks.csv
check 'there is something to track' test "$(wc -l <tracks.csv)" -gt 20

# ---- a sensor, two nodes, a stranger who listens ----
start one
one=$node
start two
two=$node
logger=''
if [ -x /usr/bin/lcm-logger ]; then
    /usr/bin/lcm-logger --lcm-url="$LCM_DEFAULT_URL" -f -q stock.lcm >/dev/null 2>&1 &
    logger=$!
    wait_until 5 test -e stock.lcm
    sleep 0.2
    kill -0 "$logger" 2>/dev/null || logger='' # liblcm wants a route to the group
fi
run publish scene/plots.csv --speed 100
check 'publish ends with 0' exits 0
check 'publish says what it sent' matches "$(tail -n 1 stderr)" \
    'rhotrack: 3? messages on 1 channels in ?.? s, 1 passes; * ms late at most'
sleep 0.3
[ -z "$logger" ] || { kill -INT "$logger"; wait "$logger"; } 2>/dev/null
stop INT "$one"
check 'SIGINT ends a node with 0' exits 0
stop TERM "$two"
check 'SIGTERM as well' exits 0
check 'the tracks are those of track' cmp tracks.csv one.csv
check 'both nodes of a machine hear the sensor' cmp tracks.csv two.csv
check 'last words' matches "$(tail -n 1 one.err)" \
    '*Z rhotrack: 3? messages in, * out; 15 steps, * plots, * tracks confirmed; '\
'* us a step, * at most'
run convert one.lcm logged.csv --kind tracks
check 'the log holds the tracks' same_tracks tracks.csv logged.csv
run convert one.lcm plots.csv --kind plots
check 'and the plots' test "$(wc -l <plots.csv)" -eq "$(grep -vc ',,,' scene/plots.csv)"
if [ -n "$logger" ]; then
    run convert stock.lcm stock.csv --kind tracks
    # It hears both nodes: each list twice.
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "epoch") e = i }
        NR == 1 || !seen[$1, $2]++' stock.csv >once.csv
    check 'lcm-logger has recorded the tracks' same_tracks tracks.csv once.csv
fi

# ---- a radar that turns, sector by sector ----
"$program" simulate rotating -o rotating
run track rotating/plots.csv --config rotating/scenario.ini
cp stdout rotating.csv
start turning --config rotating/scenario.ini
run publish rotating/plots.csv --config rotating/scenario.ini --speed 30
check 'rows of a sector may go back behind the one that has its time' exits 0
sleep 0.7
stop INT "$node"
check 'sectors: the tracks are those of track' cmp rotating.csv turning.csv

# count LOG CHANNEL: how often the name stands in the log.
count() { grep -aoF "$2" "$1" | wc -l; }

# ---- status ----
start idle
sleep 1.5
before=$(count idle.lcm RHO_STATUS)
check 'a status at once, and one a second, though nothing comes' test "$before" -ge 2
works=$(count idle.lcm RHO_WORK)
check 'and so with the work' test "$works" -ge "$before"
check 'no sensor is there to be learned of' test "$(count idle.lcm RHO_LEARNED)" -eq 0
check 'lives without a track are a message, too' test "$(count idle.lcm RHO_LIFE)" -ge "$works"
stop INT "$node"
check 'and a last one' test "$(count idle.lcm RHO_STATUS)" -gt "$before"
check 'an idle node ends with 0' exits 0
run node --for 0.2
check '--for ends it' exits 0

# ---- a second run of publish is a restart of its sensors ----
start again
run publish scene/plots.csv --speed 200
run publish scene/plots.csv --speed 200
sleep 0.2
stop INT "$node"
check 'it is followed' grep -q 'sensor restarts: 1' again.err
check 'tracks again' test "$(awk -F, '$1 == "140.000000" && $3 == "confirmed"' again.csv | wc -l)" \
    -ge 10

# ---- a loop goes on ----
start loop
timeout -s INT 1.5 "$program" publish scene/plots.csv --speed 400 --loop 2>/dev/null
sleep 0.2
stop INT "$node"
check 'a loop has times that go on' awk -F, \
    'NR > 1 { if ($1 + 0 < t) exit 1; t = $1 + 0 } END { exit !(t > 300) }' loop.csv
check 'and numbers without gaps' test -z "$(grep -E 'lost|late|restart|double' loop.err)"

# ---- bearings: a node prints each look, a file has a row a time ----
last_rows_of_times() { # FILE
    tac "$1" | awk -F, '!seen[$1, $2]++' | tac
}
"$program" simulate passive-two --seed 2 -o passive
run track passive/bearings.csv --config passive/scenario.ini
cp stdout passive.csv
"$program" convert passive/bearings.csv passive.lcm
run node --lcm 'file://passive.lcm?speed=0' --print --config passive/scenario.ini
check 'tracks of bearings are those of track' cmp <(last_rows_of_times stdout) passive.csv

# Plots between the looks of three finders: all are stepped in the order of time.
"$program" simulate passive-three --seed 4 --set duration_s=200 -o three
awk -F, -v OFS=, 'NR > 1 { $1 = sprintf("%.6f", $1 + 0.012 * $2) } { print }' three/bearings.csv \
    >bearings.csv
awk -F, -v OFS=, 'NR > 1 { $1 = sprintf("%.6f", $1 + 0.02); $2 = 9 } { print }' scene/plots.csv \
    >plots.csv
run track plots.csv bearings.csv --config scene/scenario.ini
cp stdout merged.csv
check 'no scan of a file is late, though looks lie about it' test -z "$(grep late stderr)"
start both
run publish plots.csv bearings.csv --speed 100
sleep 0.2
stop INT "$node"
check 'plots and bearings together as well, though live' cmp merged.csv both.csv
check 'without a loss, but for room to wait for a sensor that has ended' matches \
    "$(grep -Evc 'no route|listens to|no room for more' both.err)" 1

# ---- the papers' pipeline: from files, from a log, live ----
"$program" simulate crossing --seed 4 --set radars.0.sigma_m=0.3 --set duration_s=60 -o sharp
awk -F, -v OFS=, 'NR > 1 { $1 = sprintf("%.6f", $1 + 0.02); $2 = 9 } { print }' sharp/plots.csv \
    >plots.csv
run track plots.csv bearings.csv --config sharp/scenario.ini --pipeline paper
cp stdout paper.csv
check 'plots and bearings start tracks' test "$(awk -F, 'NR > 1 { print $2, $17 == 9 }' paper.csv |
    sort -u | cut -d' ' -f2 | sort -u | wc -l)" = 2
run publish plots.csv bearings.csv --speed 0 --lcm 'file://played-papers.lcm?mode=w'
run node --lcm 'file://played-papers.lcm?speed=0' --print --config sharp/scenario.ini \
    --pipeline paper
check 'the node starts the same from a log' writes_same_as paper.csv
start papers --config sharp/scenario.ini --pipeline paper
run publish plots.csv bearings.csv --speed 100
sleep 0.2
stop INT "$node"
check 'and live' cmp paper.csv papers.csv
run track plots.csv --config sharp/scenario.ini --method iht --gate hough -o iht.csv
check 'one method alone' test \
    "$(awk -F, '$3 == "confirmed"' iht.csv | cut -d, -f2 | sort -u | wc -l)" -ge 1
run track plots.csv --method ihh
check 'an unknown method' says 2 "rhotrack: --method 'ihh' is not one of kernel|ht|mht|iht|nht"
run node --pipeline all --for 0.1
check 'an unknown pipeline' says 2 "rhotrack: --pipeline 'all' is not paper"

# ---- files instead of a network ----
run publish scene/plots.csv --speed 0 --lcm 'file://played.lcm?mode=w'
check 'publish writes a log' exits 0
run node --lcm 'file://played.lcm?speed=0' --print --config scene/scenario.ini
check 'a node reads it, and ends with it' writes_same_as tracks.csv

"$program" convert scene/plots.csv scene.lcm
cp scene.lcm both.lcm
run node --lcm 'file://both.lcm?speed=0' --log ./both.lcm
check 'a node does not log over what it reads' says 2 \
    'rhotrack: node: ./both.lcm would overwrite the input'
run publish scene/plots.csv both.lcm --lcm 'file://both.lcm?mode=w'
check 'nor does publish write over what it plays' says 2 \
    'rhotrack: publish: both.lcm would overwrite the input'
check 'and it is as it was' cmp scene.lcm both.lcm

# Prints a log's first and last time in seconds.
span_of() {
    python3 - "$1" <<'PYTHON'
import struct, sys
data = open(sys.argv[1], "rb").read()
at, times = 0, []
while at < len(data):
    _, _, time, channel, size = struct.unpack_from(">IqqII", data, at)
    at += 28 + channel + size
    times.append(time / 1e6)
print(min(times), max(times))
PYTHON
}

# 12000 messages of one sensor in 20 minutes of a log are no flood, however fast they are read.
awk 'BEGIN { print "t_s,sensor_id,x_m,y_m"
             for (k = 0; k < 12000; k++) printf "%.6f,1,%d,5000\n", 100 + k / 10, 5 * k }' >many.csv
"$program" convert many.csv many.lcm
run node --lcm 'file://many.lcm?speed=0' --log again.lcm
check 'a log that is read without waiting is heard at its own times' grep -q ' 12000 steps' stderr
check 'and so is its log' matches "$(span_of again.lcm)" '100.0 1299.9'

# ---- a hang-up ----
hang_up() { # COMMAND...: $status is its exit code, or 'gone' where the hang-up ended it
    "$@" >/dev/null 2>hung.err &
    local process=$!
    sleep 0.5
    kill -HUP "$process"
    sleep 0.3
    status=0
    kill -TERM "$process" 2>/dev/null || status=gone
    wait "$process" || status=$?
}
hang_up "$program" node
check 'SIGHUP of an operator ends no node (node_log_rotation.sh: its log)' matches "$status" 0
hang_up "$program" publish scene/plots.csv
check 'a hang-up ends publish' matches "$status" gone
hang_up nohup "$program" publish scene/plots.csv
check 'but not beside nohup' matches "$status" 0

run publish scene/plots.csv --speed 0 --lcm 'file:///dev/full?mode=w'
check 'a full disk is told' exits 1
check 'a full disk: what is said' matches "$(tail -n 1 stderr)" 'rhotrack: *No space left on device'

# ---- what is no URL ----
refused() { # name, URL, message
    run node --for 1 --lcm "$2"
    check "$1" exits 2
    check "$1: what is said" matches "$(tail -n 1 stderr)" "*rhotrack: --lcm $2: $3"
}
refused 'no scheme' bogus 'not an LCM URL, *'
refused 'no group' udpm://10.1.2.3:7667 '* is not a multicast group *'
refused 'a port that is none' udpm://239.255.76.67:99999 "port '99999' *"
refused 'an option that is none' 'udpm://239.255.76.67:7667?colour=red' 'unknown option *'
refused 'a ttl that is none' 'udpm://239.255.76.67:7667?ttl=-1' "ttl '-1' *"
refused 'an address that is none' 'udpm://239.255.76.67:7667?sources_allowed=10.9.0.1,ten' \
    "sources_allowed: 'ten' is not an IPv4 address"
refused 'no address' 'udpm://239.255.76.67:7667?sources_allowed=,' 'sources_allowed has no address'
refused 'a provider that is none' nix://there 'liblcm cannot open it'
refused 'a file that is not there' file://nothing.lcm 'liblcm cannot open it'
run publish scene/plots.csv --lcm file://played.lcm
check 'publish does not write where it would read' says 2 \
    'rhotrack: --lcm file://played.lcm: *mode=w*'
run publish nothing.csv
check 'publish without its input' exits 2
run node --log nowhere/at.lcm
check 'a log that cannot be' exits 1
LCM_DEFAULT_URL=bogus run node
check 'the environment is named' says 2 '*Z rhotrack: LCM_DEFAULT_URL bogus: *'

finish
