#!/bin/bash
# SPDX-License-Identifier: MIT
# An operator's commands to a live node: done where the node takes them, else counted and said.
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

# start NAME OPTIONS...: a node with NAME.csv, NAME.err, which has confirmed both tracks when it
# returns.
start() {
    local name=$1
    shift
    "$program" node --print --log "$name.lcm" --set v_max_mps=300 "$@" >"$name.csv" 2>"$name.err" \
        </dev/null &
    node=$!
    wait_until 5 test -s "$name.lcm"
    "$program" publish plots.csv >/dev/null 2>&1 &
    sensor=$!
    wait_until 10 has_both "$name.csv"
}
has_both() { [ "$(tail -n 2 "$1" | grep -c confirmed)" -eq 2 ]; }

stop() {
    kill "$sensor" 2>/dev/null
    wait "$sensor" 2>/dev/null
    status=0
    kill -INT "$node"
    wait "$node" || status=$?
}

# The identity in the newest row of a track with y of this sign, - or digit; its status.
newest() { # file, sign, column
    awk -F, -v sign="$2" -v column="$3" '{ is_minus = substr($5, 1, 1) == "-" }
        is_minus == (sign == "-") && $1 != "t_s" { value = $column } END { print value }' "$1"
}
has_status() { [ "$(newest "$1" + 3)" = "$2" ]; } # of the northern track
rows_of() { tail -n 8 "$1" | awk -F, -v id="$2" '$2 == id' | wc -l; }

# ---- a node that takes commands ----
start open --commands --set sensor.9.range_min_m=200 --snapshot kept
north=$(newest open.csv + 2)
south=$(newest open.csv - 2)
check 'there are two tracks' test "$north" != "$south"

run command renumber "$north" 40
check 'renumber is done' exits 0
check 'and answered' matches "$(cat stdout)" 'done: track 40'
check 'the track has its new identity' test "$(newest open.csv + 2)" = 40
run command freeze 40
check 'freeze is done' exits 0
wait_until 5 has_status open.csv coasting
check 'a frozen track coasts' test "$(newest open.csv + 3)" = coasting
run command thaw 40
check 'thaw is done' exits 0
wait_until 5 has_status open.csv confirmed
check 'a thawed track is seen again' test "$(newest open.csv + 3)" = confirmed
run command exclude x_m=-9000 y_m=-3000 x_max_m=9000 y_max_m=-1000
check 'exclude is done' matches "$(cat stdout)" 'done'
run command exclude x_m=9000 y_m=-3000 x_max_m=-9000 y_max_m=-1000
check 'corners the wrong way round' says 2 \
    'rhotrack: command: exclude: x_max_m=-9000 is not above x_m=9000'
run command exclude x_m=-9000 y_m=-3000 x_max_m=9000 y_max_m=-3000
check 'an area without height' says 2 \
    'rhotrack: command: exclude: y_max_m=-3000 is not above y_m=-3000'
run command exclude x_m=-9000 y_m=-3000 x_m=-8000 x_max_m=9000 y_max_m=-1000
check 'a key twice' says 2 'rhotrack: command: x_m is given twice'
run command drop "$south"
check 'drop is done' matches "$(cat stdout)" "done: track $south"
sleep 1.5
check 'a dropped track is gone, and no other starts in the area' test \
    "$(rows_of open.csv "$south")" -eq 0
check 'the only track is the other one' test "$(tail -n 4 open.csv | cut -d, -f2 | sort -u)" = 40
run command include x_m=0 y_m=-2000
check 'include is done' exits 0
wait_until 5 has_both open.csv
check 'its target is found again' has_both open.csv
run command start x_m=0 y_m=8000 sigma_m=50
check 'start is done' matches "$(cat stdout)" 'done: track ??'
hand=$(sed 's/.* //' stdout)
check 'the track is there' test "$(grep -c ",$hand,confirmed" open.csv)" -ge 1

# ---- settings ----
run command set v_max_mps 250
check 'a setting is changed' matches "$(cat stdout)" 'done: v_max_mps 250, from the next step on'
run command set scans 6
check 'which may begin the window anew' matches "$(cat stdout)" 'done: scans 6, *window begins anew'
run command set v_min_mps 150
check 'targets of 100 m/s are too slow now' exits 0
has_none() { [ "$(tail -n 1 open.csv)" = "$last" ]; }
sleep 1
last=$(tail -n 1 open.csv)
sleep 0.5
check 'and their tracks end' has_none
run command set v_min_mps 10
wait_until 5 has_both open.csv
check 'and come again when they are not' has_both open.csv
run command set pd 1.5
check 'a value outside its range is refused' exits 1
check 'with field and range' matches "$(cat stderr)" \
    'rhotrack: refused: pd 1.5 is not within 0.01 .. 0.999'
run command set v_max_mps 8
check 'and one that does not go with another' matches "$(cat stderr)" \
    'rhotrack: refused: v_min_mps 10 is not within 0 .. 8'
run command set min_scans 4.5
check 'and half a scan' matches "$(cat stderr)" 'rhotrack: refused: min_scans is a whole number'
run command set range_max_m 150
check 'and what a sensor forbids' matches "$(cat stderr)" \
    'rhotrack: refused: a sensor*own range_min_m or range_max_m forbids it'
run command set sigma_range_m 20
check 'noise is of plots to come' matches "$(cat stdout)" \
    'done: sigma_range_m 20, with the next plots*'
run command set pd 0.8
check 'pd of sensors' matches "$(cat stdout)" 'done: pd 0.8, with the next scan of each sensor*'

run command drop 999
check 'a command of no track is refused' exits 1
check 'and the reason is said' matches "$(cat stderr)" 'rhotrack: refused: no such track*'
run command renumber 40 40
check 'an identity that is taken is refused' exits 1
stop
check 'the node ends with 0' exits 0
check 'it says what it has done' grep -q 'Z rhotrack: commands done: 13$' open.err
check 'and refused' grep -q 'Z rhotrack: commands refused: 6' open.err
check 'all are in its log' test "$(grep -ac RHO_COMMAND_ANSWERS open.lcm)" -ge 1

# ---- a snapshot keeps settings, where the node is told the same as before ----
start kept --commands --set sensor.9.range_min_m=200 --snapshot kept
run command set v_min_mps 260
check 'a setting outlives a restart' matches "$(cat stderr)" \
    'rhotrack: refused: v_min_mps 260 is not within 0 .. 250'
stop
start other --commands --set sensor.9.range_min_m=200 --set accel_max_mps2=20 --snapshot kept
check 'a node that is told otherwise begins anew' grep -q \
    'kept: a snapshot with other parameters; tracks begin anew' other.err
run command set v_min_mps 260
check 'with its own settings' exits 0
stop

# ---- a node that takes none ----
start shut
north=$(newest shut.csv + 2)
run command drop "$north" --for 1
check 'without --commands there is no answer' exits 1
check 'which is said' matches "$(cat stderr)" 'rhotrack: no answer in 1 s: no node with --commands*'
run command set pd 0.8 --for 1
check 'nor to a setting' exits 1
check 'the track goes on' test "$(newest shut.csv + 2)" = "$north"
stop
check 'the node counts it' grep -q \
    'commands not taken: the node runs without --commands: 2' shut.err

# ---- bad usage ----
refuse() { # what it says, arguments
    local words=$1
    shift
    run command "$@"
    check "exit 2: command $*" exits 2
    check "says: $words" matches "$(cat stderr)" "rhotrack: command: $words"
}
refuse "unknown action 'dorp', did you mean 'drop'?" dorp 3
refuse "drop needs a track's number" drop
refuse "renumber needs a track's number and a new one" renumber 3
refuse "'0' is not a track's number*" drop 0
refuse "'-3x' is not a track's number*" drop -- -3x
refuse "drop takes no 'x_m=1'*" drop 3 x_m=1
refuse "start needs y_m=VALUE" start x_m=1
refuse "'y_m=b' is not a number" start x_m=1 y_m=b
refuse "x_m is outside its range" start x_m=3e6 y_m=0
refuse "set needs a setting's name and a value" set pd
refuse "no setting 'v_mx_mps', did you mean 'v_max_mps'?" set v_mx_mps 3
refuse "'fast' is not a number" set v_max_mps fast
refuse "'inf' is not a number" set v_max_mps inf
refuse "include takes no 'sigma_m=1'*" include x_m=1 y_m=1 sigma_m=1
finish
