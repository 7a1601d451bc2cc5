#!/bin/bash
# SPDX-License-Identifier: MIT
# Plots in the order in which they were received: held for hold_ms, so that late ones are in time;
# later ones by retrodiction. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Two targets for 40 scans, 4 s apart; every fifth scan comes so many seconds after its time, the
# others at once.
scans() { # DELAY_S, or nothing: without the column
    echo "t_s,${1:+received_s,}sensor_id,x_m,y_m"
    awk -v delay="${1-}" 'BEGIN {
        srand(7)
        for (k = 0; k < 40; k++) {
            t = 4 * k
            received = t + (k > 8 && k % 5 == 3 ? delay : 0)
            for (i = 0; i < 2; i++) {
                x = -9000 + 800 * k + 30000 * i + 20 * (rand() - .5)
                y = 500 * k + 20 * (rand() - .5)
                printf "%s %.3f,%s1,%.2f,%.2f\n", received, t, delay == "" ? "" : received ",", x, y
            }
        } }' | sort -s -n -k 1,1 | cut -d' ' -f2
}
scans >in_time.csv
scans 0.3 >held.csv
scans 5 >later.csv
scans 30 >too_late.csv
run track in_time.csv -o expected.csv

# ---- held ----
run track held.csv -o held_tracks.csv --set hold_ms=500
check 'scans that are 300 ms late are in time where hold_ms is 500' cmp held_tracks.csv expected.csv
run track held.csv --set hold_ms=0 --json
check 'no scan is late at 4 s a scan' json stdout \
    'o["counters"]["scans_late"] == 0 and o["fates"]["stale"] == 0'

# ---- later ----
run track later.csv --json -o later_tracks.csv
check 'scans that are 5 s late update tracks' json stdout \
    '(o["counters"]["scans_retrodicted"] == 6 and o["counters"]["scans_late"] == 0 and
    o["tracks_confirmed"] == 2)'
check 'all their plots are claimed' json stdout \
    'o["fates"]["stale"] == 0 and o["fates"]["claimed"] + o["fates"]["held"] == 80'
check 'both are tracked to the end' matches "$(tail -n 2 later_tracks.csv | cut -d, -f1,3 | uniq)" \
    156.000000,confirmed
run track later.csv --set late_max_s=0 --json
check 'with late_max_s 0 they are stale' json stdout \
    '(o["counters"]["scans_late"] == 6 and o["counters"]["scans_retrodicted"] == 0 and
    o["fates"]["stale"] == 12)'
run track too_late.csv --json
check 'scans that are 30 s late are stale, but for one near the end' json stdout \
    '(o["counters"]["scans_late"] == 5 and o["counters"]["scans_retrodicted"] == 1 and
    o["tracks_confirmed"] == 2 and sum(o["fates"].values()) == 80)'

# ---- several files ----
sed 's/,1,/,2,/' held.csv >second.csv
run track held.csv second.csv --set hold_ms=500 --json -o both.csv
check 'two files are merged by time' json stdout \
    'o["counters"]["scans_late"] == 0 and o["scans"] == 80'

# ---- time biases ----
# A second radar of the same targets, half a second later, whose clock is 1 s behind: in one file as
# its clock says, in one of its own, in the order of reception, as logs, and through a node.
shifted() { # SECONDS
    awk -F, -v by="$1" 'NR > 1 { $1 = sprintf("%.3f", $1 + by); $2 = 2 } NR > 1 { print }' OFS=, \
        in_time.csv
}
{ cat in_time.csv; shifted 0.5; } | (read -r header && echo "$header" && sort -s -t, -n -k 1,1) \
    >right.csv
{ cat in_time.csv; shifted -0.5; } | (read -r header && echo "$header" && sort -s -t, -n -k 1,1) \
    >behind.csv
{ head -n 1 in_time.csv; shifted -0.5; } >behind_alone.csv
awk -F, 'NR == 1 { print "received_s," $0; next }
    { print ($2 == 1 ? $1 : sprintf("%.3f", $1 + 1)) "," $0 }' behind.csv |
    (read -r header && echo "$header" && sort -s -t, -n -k 1,1) >behind_received.csv
run track right.csv -o expected.csv --json
check 'the right times: nothing is late' json stdout \
    'o["counters"]["scans_retrodicted"] == 0 and o["scans"] == 80'
settings=(--set sensor.2.time_bias_s=-1)
same() { # file, arguments
    run track "$@" "${settings[@]}" -o biased.csv && exits 0 && cmp biased.csv expected.csv
}
check 'a clock that is behind: the same tracks' same behind.csv
check 'from two files' same in_time.csv behind_alone.csv
check 'from two files, the other first' same behind_alone.csv in_time.csv
check 'in the order of reception' same behind_received.csv
run convert behind.csv behind.lcm
check 'from a log' same behind.lcm --set sensor.1.pd=0.9
run convert behind_received.csv received.lcm
check 'from a log of the order of reception' same received.lcm --set sensor.1.pd=0.9
run publish behind_received.csv --lcm 'file://published.lcm?mode=w' --speed 0
run node --lcm 'file://published.lcm?speed=0' "${settings[@]}" --set sensor.1.pd=0.9 --log node.lcm
check 'a node counts nothing late' bash -c '! grep -q late stderr'
"$program" convert node.lcm node.csv --kind tracks 2>stderr
check 'and has the same tracks' python3 -c '
import csv
def rows(name):
    return [(round(float(r["t_s"]) * 1e6), r["track_id"], round(float(r["x_m"]), 1),
             round(float(r["y_m"]), 1), r["hits"])
            for r in csv.DictReader(open(name)) if r["status"] != "deleted"]
one, other = rows("expected.csv"), rows("node.csv")
assert one == other and one, (
    len(one), len(other), [x for x in zip(one, other) if x[0] != x[1]][:3])'
run track behind_received.csv --json -o biased.csv
check 'not told of it, its scans are late' json stdout 'o["counters"]["scans_retrodicted"] > 30'
settings=(--set sensor.1.time_bias_s=1 --set sensor.2.time_bias_s=-9)
{ sed 1d in_time.csv | awk -F, '{ $1 = sprintf("%.3f", $1 + 1); print }' OFS=,; shifted -8.5; } \
    | sort -s -t, -n -k 1,1 |
    (head -n 1 in_time.csv; cat) >apart.csv
check 'clocks that are 10 s apart, in one file' same apart.csv
run convert apart.csv apart.lcm
check 'in a log' same apart.lcm

# ---- more than a assembler has room for: 11 sectors a second, some 3 s late ----
run simulate two-radars --set radars.0.late_s=3 --set radars.1.late_s=3 \
    --set settings.hold_ms=3000 --set duration_s=150 --seed 5 -o busy
run convert busy/plots.csv busy.lcm --config busy/scenario.ini
for late_max_s in 20 0; do
    run track busy.lcm --config busy/scenario.ini --set late_max_s=$late_max_s --json
    check "a log's scans wait for hold_ms, late_max_s $late_max_s" json stdout \
        'o["fates"]["stale"] == 0 and o["counters"]["scans_retrodicted"] == 0 and o["scans"] > 1600'
done
run node --lcm 'file://busy.lcm?speed=0' --config busy/scenario.ini --log node.lcm
check 'a node says how many could not' grep -q \
    'Z rhotrack: scans that did not wait for hold_ms (no room for more): [1-9]' stderr
run node --lcm 'file://busy.lcm?speed=0' --config busy/scenario.ini --set hold_ms=500 --log node.lcm
check 'and nothing where there is room' bash -c '! grep -q "no room for more" stderr'

# ---- each row received on its own: a radar that turns, whose plots are gathered over a turn ----
run simulate doppler --set settings.scan_interval_s=4 -o turning
unnumbered turning/plots.csv 5 4 >turning/polar.csv
turning=(--config turning/scenario.ini)
run track turning/polar.csv "${turning[@]}" -o expected.csv
awk -F, 'NR == 1 { print $0 ",received_s"; next } { printf "%s,%.6f\n", $0, $1 + 0.05 }' \
    turning/polar.csv >evenly.csv
awk -F, 'BEGIN { srand(3) } NR == 1 { print $0 ",received_s"; next }
    {
        received = $1 + 0.4 * rand()
        last = received > last ? received : last
        printf "%s,%.6f\n", $0, last
    }' \
    turning/polar.csv >unevenly.csv
for file in evenly unevenly; do
    for option in '' --keep-going; do
        run track $file.csv "${turning[@]}" $option -o found.csv
        check "track, received $file $option: the same tracks" cmp found.csv expected.csv
        check "track, received $file $option: nothing is skipped" bash -c '! grep -q skipped stderr'
        run convert $file.csv $file.lcm "${turning[@]}" $option
        check "convert, received $file $option: nothing is said" bash -c '! test -s stderr'
        run track $file.lcm "${turning[@]}" -o found.csv
        check "convert, received $file $option: as many scans" grep -q \
            "rhotrack: $(awk -F, 'NR > 1 && $3 == ""' turning/polar.csv | wc -l) scans" stderr
    done
    run initiate turning/polar.csv "${turning[@]}"
    mv stdout expected_lines.csv
    run initiate $file.csv "${turning[@]}"
    check "initiate, received $file: the same" writes_same_as expected_lines.csv
done
# ---- what is said of it ----
# Two radars by sectors, a fifth of the scans 300 ms late: all are used, none is lost.
run simulate two-radars --set duration_s=60 --seed 2 -o two
run convert two/plots.csv two.lcm
run track two.lcm --config two/scenario.ini -o two_tracks.csv
check 'a log out of order: all is used' grep -Eqx \
    'rhotrack: two.lcm: [0-9]{2,} scans out of order' stderr
check 'nothing is said to be lost or late' bash -c '! grep -Eq "lost$|dropped|scans late" stderr'
# The 40th scan of radar 2 is lost.
lost=$(awk -F, \
    'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i } $at["sensor_id"] == 2 { print $at["scan"] }' \
    two/plots.csv |
    sort -nu | sed -n 40p)
awk -F, -v lost="$lost" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; print; next }
    !($at["sensor_id"] == 2 && $at["scan"] == lost)' two/plots.csv >gap.csv
run convert gap.csv gap.lcm
run track gap.lcm --config two/scenario.ini -o two_tracks.csv
check 'one that is lost is counted once' grep -Eqx \
    'rhotrack: gap.lcm: [0-9]+ scans out of order, 1 scans lost' stderr
run node --lcm 'file://gap.lcm?speed=10' --config two/scenario.ini
check 'a node says the same at its end' bash -c \
    'grep -q "Z rhotrack: scans lost: 1$" stderr &&
    grep -q "Z rhotrack: scans out of order: [0-9]" stderr'
check 'and before that what is lost, once, and nothing of what is late' \
    matches "$(grep 'scans .*so far' stderr)" \
    '*Z rhotrack: scans lost: 1 so far, the last one of sensor ?'
run track gap.lcm --config two/scenario.ini --set late_max_s=0 --set hold_ms=0 -o two_tracks.csv
check 'what is not used is dropped' grep -Eq \
    '^rhotrack: gap.lcm: .*[0-9]+ scans late, dropped, [0-9]+ scans lost' stderr

run track later.csv
check 'more can be held' matches "$(cat stderr)" '*too late; hold_ms waits longer)*'
run track too_late.csv --set hold_ms=10000 --set late_max_s=10
check 'not where hold_ms is at its largest' matches "$(cat stderr)" \
    '*too late; late_max_s takes older ones)*'
run track too_late.csv --set hold_ms=10000 --set late_max_s=60
check 'nor more where late_max_s is, too' matches "$(cat stderr)" '*, 0 too late); *'

# ---- refused ----
sed '20s/^\([0-9.]*\),[0-9.]*,/\1,3.000,/' held.csv >bad.csv
run track bad.csv -o out.csv
check 'received_s does not go back' says 2 \
    '*bad.csv:20: received_s decreases from * s to 3.000000 s'
run track bad.csv --keep-going --json
check 'or such rows are skipped' json stdout 'o["rows_skipped"] == 1'
sed '20s/^\([0-9.]*\),[0-9.]*,/\1,,/' held.csv >bad.csv
run track bad.csv -o out.csv
check 'nor is it left out' says 2 "*bad.csv:20: received_s *"
sed '1s/received_s/other/' later.csv >bad.csv
run track bad.csv -o out.csv
check 'without it times do not go back' says 2 '*bad.csv:*: time decreases from * s to * s'
awk -F, 'NR == 1 { print "t_s,received_s,sensor_id,x_m,y_m"; next }
    { print $1 "," ($1 + (NR == 13 ? 0.5 : 0)) "," $2 "," $3 "," $4 }' in_time.csv >bad.csv
run track bad.csv -o out.csv
check 'rows of a scan without a number have one received_s' says 2 \
    "*bad.csv:13: received_s is 20.500000 s, but 20.000000 s in the scan's other rows: *"
run convert bad.csv out.lcm
check 'convert says so, too' says 2 \
    "*bad.csv:13: received_s is 20.500000 s, but 20.000000 s in the scan's other rows: *"
awk -F, 'NR == 1 { print $0 ",scan" } NR > 1 { print $0 "," int(NR / 2) }' bad.csv >numbered.csv
run track numbered.csv -o out.csv
check 'those of one with a number may differ' exits 0
printf 't_s,sensor_id,x_m,y_m\n4e12,1,1,1\n' >bad.csv
run track bad.csv --set sensor.1.time_bias_s=-10
check 'a time that is beyond what is believed once its bias is off' says 2 \
    "*bad.csv:2: t_s minus the sensor's time_bias_s is beyond 4e12 s"
run track in_time.csv --set late_max_s=61
check 'late_max_s is a minute at most' says 2 '*late_max_s*60*'

finish
