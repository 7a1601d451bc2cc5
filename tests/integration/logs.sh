#!/bin/bash
# SPDX-License-Identifier: MIT
# LCM logs where CSV files go: the commands do the same with both, byte for byte.
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# make SCENARIO NAME OPTIONS...: NAME.csv and truth.csv of a scenario, and the same as logs, in a
# folder of that name
make_files() {
    local scenario=$1 name=$2
    shift 2
    run simulate "$scenario" --seed 3 "$@" -o "$scenario"
    run convert "$scenario/$name.csv" "$scenario/in.lcm" --config "$scenario/scenario.ini"
    check "$scenario: $name.csv as a log" exits 0
    run convert "$scenario/truth.csv" "$scenario/truth.lcm"
    check "$scenario: truth.csv as a log" exits 0
    mv "$scenario/$name.csv" "$scenario/in.csv"
}

# The last run was good (else a file of an earlier one would do), and two files are the same.
made_same() { exits 0 && cmp "$1" "$2"; }

# ---- the tracker ----

same_tracks() { # scenario, options
    local scenario=$1
    shift
    run track "$scenario/in.csv" --config "$scenario/scenario.ini" --covariance "$@" -o \
        "$scenario/tracks.csv"
    check "$scenario $*: tracks of the CSV file" exits 0
    run track "$scenario/in.lcm" --config "$scenario/scenario.ini" --covariance "$@" -o \
        "$scenario/same.csv"
    check "$scenario $*: tracks of the log" exits 0
    check "$scenario $*: there are some, and they are the same" \
        sh -c "test \$(wc -l <'$scenario/tracks.csv') -gt 5 &&
            cmp '$scenario/tracks.csv' '$scenario/same.csv'"
}

make_files radar plots
make_files polar plots --set radars.0.sigma_range_rate_mps=1
make_files weave plots --set duration_s=15
make_files passive-three bearings --set duration_s=140
same_tracks radar --gate nearest
same_tracks polar --gate hough
for scenario in radar polar weave passive-three; do
    same_tracks "$scenario"
done

# A CSV file of a log says which rows are one scan, whatever their own times.
run convert polar/in.lcm polar/numbered.csv
run track polar/numbered.csv --config polar/scenario.ini --covariance -o polar/same.csv
check 'rows of one number are one scan' made_same polar/tracks.csv polar/same.csv
cat >late.csv <<CSV
t_s,sensor_id,x_m,y_m,scan
1.0,1,0,0,7
3.0,1,10,0,7
2.0,1,20,0,7
4.0,1,30,0,8
3.9,1,40,0,9
CSV
run track late.csv
check 'a scan may hold times in any order, scans may not' says 2 \
    'rhotrack: late.csv:6: time decreases from 4.000000 s to 3.900000 s'
# A scan may begin before the last plots of the one before; its utime may be within it.
for first in 0.0 -0.6; do
    python3 - "$first" >mixed.csv <<'PYTHON'
import sys
rows = [(i + float(sys.argv[1]) + 0.3 * k, 100 * (i + 0.3 * k), 3000 * k, i)
        for i in range(8) for k in range(5)]
rows += [(float(i), "", "", i) for i in range(8)]
print("t_s,sensor_id,x_m,y_m,scan")
for t_s, x_m, y_m, scan in sorted(rows, key=lambda row: (row[0], str(row[1]))):
    print(f"{t_s:.6f},1,{x_m},{y_m},{scan}")
PYTHON
    run convert mixed.csv mixed.lcm
    run track mixed.lcm --covariance -o tracks.csv
    run track mixed.csv --covariance -o same.csv
    check "scans that begin at $first s and overlap: none is torn apart" grep -q \
        'rhotrack: 8 scans, 40 plots' stderr
    check "scans that begin at $first s and overlap: the same as out of a log" made_same \
        tracks.csv same.csv
done

# two radars and their targets' bearings together, all in one log
run track radar/in.csv passive-three/in.csv -o both.csv
check 'plots and bearings of two files' exits 0
run track radar/in.lcm passive-three/in.lcm -o both.again.csv
check 'the same of two logs' made_same both.csv both.again.csv
# merge LOG...: their events in the order of time, as of one recording
merge() {
    python3 - "$@" <<'PYTHON'
import struct, sys
events = []
for path in sys.argv[1:]:
    data, at = open(path, "rb").read(), 0
    while at < len(data):
        utime, channel, size = struct.unpack_from(">qII", data, at + 12)
        end = at + 28 + channel + size
        events.append((utime, data[at:end]))
        at = end
sys.stdout.buffer.write(
    b"".join(event for utime, event in sorted(events, key=lambda event: event[0])))
PYTHON
}
merge radar/in.lcm passive-three/in.lcm radar/truth.lcm >mixed.lcm
run track mixed.lcm -o both.again.csv
check 'the same of one log with plots, bearings and truth' made_same both.csv both.again.csv

# ---- tracks as a log, evaluate ----

# Times and places of truth are float32 in the log.
same_figures() {
    python3 -c 'import json
a, b = json.load(open("figures")), json.load(open("again"))
def differ(x, y):
    if isinstance(x, dict):
        return x.keys() != y.keys() or any(differ(x[k], y[k]) for k in x)
    if isinstance(x, list):
        return [len(i) for i in x] != [len(i) for i in y]
    return x != y and abs(x - y) > 1e-4 * abs(x)
off = [k for k in a if differ(a[k], b[k])]
exit(str(off) if off or not a["targets_found"] else 0)'
}

for scenario in radar polar weave; do
    run track "$scenario/in.lcm" --config "$scenario/scenario.ini" -o "$scenario/tracks.lcm"
    check "$scenario: tracks as a log" exits 0
    run convert "$scenario/tracks.lcm" "$scenario/back.csv" --covariance
    check "$scenario: as a CSV file again" exits 0
    check "$scenario: its rows are those of the CSV file" sh -c "
        cut -d, -f1-12,15-39 '$scenario/tracks.csv' >a
        grep -v ,deleted, '$scenario/back.csv' | cut -d, -f1-12,15-39 >b
        cmp a b"
    run evaluate "$scenario/truth.csv" "$scenario/tracks.csv" --json
    cp stdout figures
    run evaluate "$scenario/truth.lcm" "$scenario/tracks.lcm" --json
    cp stdout again
    check "$scenario: evaluate finds the same in logs" same_figures
done
run track radar/in.lcm --config radar/scenario.ini -o .lcm
check 'a log that is named .lcm and nothing else' cmp radar/tracks.lcm .lcm
run evaluate radar/truth.lcm radar/in.lcm
check 'evaluate: a log without tracks' says 2 \
    'rhotrack: radar/in.lcm: contains no messages of tracks *'

# ---- the others ----

run initiate radar/in.csv --config radar/scenario.ini
cp stdout found.csv
run initiate radar/in.lcm --config radar/scenario.ini
check 'initiate' writes_same_as found.csv
run initiate passive-three/in.csv
cp stdout found.csv
run initiate passive-three/in.lcm
check 'initiate, bearings' writes_same_as found.csv
for method in ht nht; do
    run initiate radar/in.csv --method "$method"
    cp stdout found.csv
    run initiate radar/in.lcm --method "$method"
    check "initiate --method $method" writes_same_as found.csv
done
run initiate radar/in.lcm --config radar/scenario.ini -o peaks.lcm
check 'initiate: peaks as a log' sh -c 'grep -q RHO_PEAKS peaks.lcm'
run maintain weave/in.csv --config weave/scenario.ini
cp stdout one.csv
run maintain weave/in.lcm --config weave/scenario.ini
check 'maintain' writes_same_as one.csv
run maintain weave/in.lcm --config weave/scenario.ini -o one.lcm
run convert one.lcm one.again.csv
check 'maintain: its track as a log' sh -c "
    cut -d, -f1-12,15-18 one.csv >a; cut -d, -f1-12,15-18 one.again.csv >b; cmp a b"
run maintain passive-three/in.lcm
check 'maintain: bearings are refused' says 2 \
    'rhotrack: passive-three/in.lcm: maintain takes plots, but this file has bearings'
head -c 500 /dev/zero >garbage.bytes
run plot tracks radar/in.lcm radar/tracks.lcm radar/truth.lcm -o map.svg
check 'plot' sh -c 'grep -q "<svg" map.svg'
cat garbage.bytes passive-three/in.lcm radar/tracks.lcm radar/in.lcm >node.lcm
run plot tracks node.lcm -o map.svg
check 'plot: tracks of a log with bearings, too; damage is told once' says 0 \
    'rhotrack: node.lcm: 500 bytes skipped at byte 0'
run plot errors passive-three/in.lcm -o map.svg
check 'plot: a log of bearings alone' says 2 \
    'rhotrack: plot errors: bearings * are shown only by plot scans and plot tracks'
run plot tracks peaks.lcm -o map.svg
check 'plot: nothing to draw in it' says 2 \
    'rhotrack: peaks.lcm: contains no messages of plots, bearings, truth or tracks'

# ---- what may be wrong with a log ----

cat garbage.bytes radar/in.lcm >damaged.lcm
run track radar/in.lcm -o whole.csv
run track damaged.lcm -o again.csv
check 'damage at the start is skipped and told' matches "$(cat stderr)" \
    '*damaged.lcm: 500 bytes skipped*'
check 'and what follows is read' made_same whole.csv again.csv
python3 - <<'PYTHON'
import struct
data, at = open("radar/in.lcm", "rb").read(), 0
with open("double.lcm", "wb") as double:
    while at < len(data):
        channel, size = struct.unpack_from(">II", data, at + 20)
        end = at + 28 + channel + size
        double.write(2 * data[at:end])
        at = end
PYTHON
run track double.lcm -o again.csv
check 'every message twice: told' matches "$(cat stderr)" '*double.lcm: * duplicate scans or parts*'
check 'and taken once' made_same whole.csv again.csv
cat radar/in.lcm radar/in.lcm >two.lcm
run track two.lcm
check 'two recordings in one' says 2 \
    "rhotrack: two.lcm: the sensors' clock is set anew at * s: the log may hold two recordings; *"
merge radar/in.lcm passive-three/in.lcm >mixed.lcm
cat garbage.bytes mixed.lcm >damaged.lcm
run track damaged.lcm -o again.csv
check 'a log with plots and bearings: damage is told once' matches \
    "$(head -n 1 stderr) $(grep -c skipped stderr)" \
    'rhotrack: damaged.lcm: 500 bytes skipped at byte 0 1'
printf 't_s,sensor_id,x_m,y_m\n' >pause.csv
for t in 0 1 2 3 4 9000 9001 9002 9003 9004 9005; do echo "$t,1,$t,5"; done >>pause.csv
run convert pause.csv pause.lcm
run track pause.lcm
check 'a log with a long pause goes on behind it' matches "$(tail -n 1 stderr)" \
    'rhotrack: 9 scans, 9 plots, *'
check 'and says what the pause cost' grep -q 'rhotrack: pause.lcm: 2 scans with bad times' stderr
mkfifo pipe.lcm
for command in track initiate maintain; do
    cat radar/in.lcm >pipe.lcm 2>pipe.error &
    run "$command" pipe.lcm
    check "$command: a log through a pipe" says 2 \
        'rhotrack: pipe.lcm: an LCM log is read twice and cannot come through a pipe'
    kill $! 2>/dev/null
done
run track radar/truth.lcm
check 'a log without scans' says 2 'rhotrack: radar/truth.lcm: contains no scan of a sensor (*'
run track none.lcm
check 'a log that is not there' says 2 'rhotrack: none.lcm: No such file or directory'
finish
