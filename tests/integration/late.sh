#!/bin/bash
# SPDX-License-Identifier: MIT
# Plots in the order in which they were received: held for hold_ms, so that late ones are in time; later ones by retrodiction.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Two targets for 40 scans, 4 s apart; every fifth scan comes so many seconds after its time, the others at once.
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
check 'no scan is late at 4 s a scan' json stdout 'o["counters"]["scans_late"] == 0 and o["fates"]["stale"] == 0'

# ---- later ----
run track later.csv --json -o later_tracks.csv
check 'scans that are 5 s late update tracks' json stdout \
    'o["counters"]["scans_retrodicted"] == 6 and o["counters"]["scans_late"] == 0 and o["tracks_confirmed"] == 2'
check 'all their plots are claimed' json stdout 'o["fates"]["stale"] == 0 and o["fates"]["claimed"] + o["fates"]["held"] == 80'
check 'both are tracked to the end' matches "$(tail -n 2 later_tracks.csv | cut -d, -f1,3 | uniq)" 156.000000,confirmed
run track later.csv --set late_max_s=0 --json
check 'with late_max_s 0 they are stale' json stdout \
    'o["counters"]["scans_late"] == 6 and o["counters"]["scans_retrodicted"] == 0 and o["fates"]["stale"] == 12'
run track too_late.csv --json
check 'scans that are 30 s late are stale, but for one near the end' json stdout \
    'o["counters"]["scans_late"] == 5 and o["counters"]["scans_retrodicted"] == 1 and o["tracks_confirmed"] == 2 and sum(o["fates"].values()) == 80'

# ---- several files ----
sed 's/,1,/,2,/' held.csv >second.csv
run track held.csv second.csv --set hold_ms=500 --json -o both.csv
check 'two files are merged by time' json stdout 'o["counters"]["scans_late"] == 0 and o["scans"] == 80'

# ---- refused ----
sed '20s/^\([0-9.]*\),[0-9.]*,/\1,3.000,/' held.csv >bad.csv
run track bad.csv -o out.csv
check 'received_s does not go back' says 2 '*bad.csv:20: received_s goes back from * s to 3.000000 s'
run track bad.csv --keep-going --json
check 'or such rows are skipped' json stdout 'o["rows_skipped"] == 1'
sed '20s/^\([0-9.]*\),[0-9.]*,/\1,,/' held.csv >bad.csv
run track bad.csv -o out.csv
check 'nor is it left out' says 2 "*bad.csv:20: received_s *"
sed '1s/received_s/other/' later.csv >bad.csv
run track bad.csv -o out.csv
check 'without it times do not go back' says 2 '*bad.csv:*: time goes back from * s to * s'
run track in_time.csv --set late_max_s=61
check 'late_max_s is a minute at most' says 2 '*late_max_s*60*'

finish
