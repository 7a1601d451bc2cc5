#!/bin/bash
# SPDX-License-Identifier: MIT
#
# `evaluate` as a user types it: figures, JSON, the table of targets, rows over time, the picture,
# what it refuses, large files. Program in $RHOTRACK. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Target 1: none, track 5 (3 m off), none, track 5 (4 m), track 6 (12 m). Target 2 from 10 s on:
# track 8, always 5 m off (3, 4); its covariance is 5 m^2 on both axes. Track 9 is nobody's.
cat >truth.csv <<CSV
t_s,target_id,x_m,y_m,vx_mps,vy_mps
0,1,0,0,10,0
10,1,100,0,10,0
20,1,200,0,10,0
30,1,300,0,10,0
40,1,400,0,10,0
10,2,5000,0,0,0
20,2,5000,0,0,0
30,2,5000,0,0,0
40,2,5000,0,0,0
CSV
cat >tracks.csv <<CSV
t_s,track_id,status,x_m,y_m,vx_mps,vy_mps,cov_x_x,cov_y_x,cov_y_y
10,5,confirmed,100,3,10,0,,,
10,8,confirmed,5003,4,0,1,5,0,5
20,8,coasting,5003,4,0,2,5,0,5
20,9,confirmed,0,90000,,,,,
30,5,coasting,300,4,13,4,,,
30,8,confirmed,5003,4,0,3,5,0,5
40,6,confirmed,400,12,10,0,,,
40,8,confirmed,5003,4,0,4,5,0,5
CSV

# ---- figures ----

run evaluate truth.csv tracks.csv --json
mv stdout figures
check 'JSON' is_json figures
check 'the names that others rely on' json figures 'all(name in o for name in """gospa_m
    gospa_localisation_m gospa_missed gospa_false ospa_m completeness false_per_scan false_per_hour
    switches delay_scans rmse_m rmse_mps nees targets targets_found""".split())'
check 'identities: one switch, one fragment, one false track' json figures \
    '(o["switches"] == 1 and o["fragments"] == 1 and o["false_tracks"] == 1
    and abs(o["false_per_hour"] - 90) < 1e-9)'
check 'delays of one scan and none' json figures 'o["delay_scans"] == 0.5 and o["delay_s"] == 5'
# 3 4 5 5 5 5 12
check 'errors of place' json figures \
    '(o["pairs"] == 7 and o["median_m"] == 5 and abs(o["p95_m"] - 9.9) < 1e-9
    and abs(o["rmse_m"] - (269 / 7) ** .5) < 1e-9)'
# 0 0 1 2 3 4 5
check 'errors of velocity' json figures \
    '(o["median_mps"] == 2 and abs(o["p95_mps"] - 4.7) < 1e-9
    and abs(o["rmse_mps"] - (55 / 7) ** .5) < 1e-9)'
check 'NEES where there is a covariance' json figures \
    'abs(o["nees"] - 5) < 1e-9 and o["nees_inside"] == 1'
check 'its ratio is over its two axes' json figures \
    'abs(o["place_ratio"] - 2.5) < 1e-9 and o["velocity_ratio"] is None'
# a covariance of the velocity of 10 m2/s2 on both axes, at errors of 1 and 3 m/s: .1 and .9 over 2;
# an error of 2 coasts
awk -F, -v OFS=, '{
    print $0 (NR == 1 ? ",cov_vx_vx,cov_vy_vx,cov_vy_vy" : $2 == 8 && $1 < 40 ? ",10,0,10" : ",,,")
}' tracks.csv >velocity.csv
run evaluate truth.csv velocity.csv --json
check 'velocities have one, too' json stdout \
    '(abs(o["velocity_ratio"] - (.1 + .4 + .9) / 6) < 1e-9 and o["velocity_inside"] == 1
    and o["nees"] == 5)'
check 'told apart: straight, coasting, none that turns' json stdout \
    '[(m["pairs"], m["rmse_m"])
    for m in (o["by_motion"][n] for n in ("straight", "turning", "coasting"))] == [
    (4, (203 / 4) ** .5), (0, None), (2, (41 / 2) ** .5)]'
check 'told apart: the ratio of velocities' json stdout \
    '(abs(o["by_motion"]["straight"]["velocity_ratio"] - .45) < 1e-9
    and abs(o["by_motion"]["coasting"]["velocity_ratio"] - .2) < 1e-9)'
sed 's/^30,2,5000,0,0,0/30,2,5000,0,0,.3/' truth.csv >turn.csv
run evaluate turn.csv velocity.csv --json
check 'a change of velocity by .3 m/s in 10 s is a turn' json stdout \
    'o["by_motion"]["turning"]["pairs"] == 2 and o["by_motion"]["straight"]["pairs"] == 2'
run evaluate turn.csv velocity.csv --json --set turning_mps2=.05
check '... above another limit none' json stdout \
    'o["by_motion"]["turning"]["pairs"] == 0 and o["by_motion"]["straight"]["pairs"] == 4'
run evaluate truth.csv tracks.csv --set turning_mps2=-1
check 'a limit below 0' says 2 "*turning_mps2*"
sed '3s/,10,0,10$/,10,0,x/' velocity.csv >bad.csv
run evaluate truth.csv bad.csv
check 'a covariance of the velocity that is none' says 2 'rhotrack: bad.csv:3: *'
run evaluate tracks.csv truth.csv
check 'tracks in the place of the truth' says 2 \
    'rhotrack: tracks.csv has tracks and truth.csv truth: evaluate TRUTH TRACKS'
run evaluate tracks.csv tracks.csv --json
check 'tracks may be compared with tracks' exits 0
check 'GOSPA' json figures 'abs(o["gospa_m"] ** 2 - (3 * 5e5 + 269) / 5) < 1e-6'
check 'numbers and times' json figures \
    '(o["targets"], o["targets_found"], o["tracks"], o["scans"], o["first_s"], o["last_s"]) == (
    2, 2, 4, 5, 0, 40)'

check 'by target: both, by identity' json figures \
    '[t["target_id"] for t in o["by_target"]] == [1, 2]'
check 'by target: times' json figures \
    '[[t[n] for n in ("first_s", "found_s", "kept_until_s", "last_s")] for t in o["by_target"]] == [
    [0, 10, 40, 40], [10, 10, 40, 40]]'
check 'by target: identities' json figures \
    '[(t["scans"], t["completeness"], t["switches"], t["fragments"], t["delay_scans"])
    for t in o["by_target"]] == [(5, .6, 1, 1, 1), (4, 1, 0, 0, 0)]'
check 'by target: errors' json figures \
    '[t["median_m"] for t in o["by_target"]] == [4, 5] and o["by_target"][0]["nees"] is None'
check 'over time: every scan' json figures \
    '[s["t_s"] for s in o["over_time"]] == [0, 10, 20, 30, 40]'
check 'over time: numbers' json figures \
    '[[s[n] for n in ("targets", "tracks", "pairs", "gospa_missed", "gospa_false")]
    for s in o["over_time"]] == [[1, 0, 0, 1, 0], [2, 2, 2, 0, 0], [2, 2, 1, 1, 1],
    [2, 2, 2, 0, 0], [2, 2, 2, 0, 0]]'
check 'over time: when the identity changed' json figures \
    '[(s["switches"], s["fragments"]) for s in o["over_time"]] == [
    (0, 0), (0, 0), (0, 0), (0, 1), (1, 0)]'

sed '/^30,1,/i 30,1,9999,9999,10,0' truth.csv >twice.csv
run evaluate twice.csv tracks.csv --json
check 'of a target that is there twice at one time the last row counts' cmp stdout figures

# ---- text, rows, picture ----

run evaluate truth.csv tracks.csv
check 'text: the figures alone' sh -c \
    "test \$(wc -l <stdout) -eq 39 && grep -q '^median_m  *5$' stdout"
run evaluate truth.csv tracks.csv --by-target
check 'text: a table of targets behind them' sh -c \
    "grep -Eq '^ +2 +10.0 +40.0 +10.0 +40.0 +1.000 +0 +0 +5.0 ' stdout"
run evaluate truth.csv tracks.csv -o over.csv
cat >expected <<CSV
t_s,targets,tracks,pairs,gospa_m,gospa_localisation_m,gospa_missed,gospa_false,ospa_m,\
switches,fragments,rmse_m,rmse_mps,nees,velocity_ratio
0.000000,1,0,0,707.106781,0,1,0,1000,0,0,,,,
10.000000,2,2,2,5.83095189,5.83095189,0,0,4.12310563,0,0,4.12310563,0.707106781,5,
20.000000,2,2,1,1000.0125,5,1,1,707.11562,0,0,5,2,5,
30.000000,2,2,2,6.40312424,6.40312424,0,0,4.52769257,0,1,4.52769257,4.12310563,5,
40.000000,2,2,2,13,13,0,0,9.19238816,1,0,9.19238816,2.82842712,5,
CSV
check 'rows over time' cmp over.csv expected
check 'and the figures beside them' grep -q '^gospa_m' stdout
run evaluate truth.csv tracks.csv -o over.svg --json
check 'a picture beside JSON, without a word of gnuplot' sh -c \
    "test ! -s stderr && grep -q '</svg>' over.svg && grep -q 'missed targets' over.svg"
check 'which is the same' cmp stdout figures
sed 's/target_id/track_id/' truth.csv >itself.csv
run evaluate truth.csv itself.csv -o zero.svg
check 'all GOSPA 0: a picture, too' sh -c \
    "test ! -s stderr && grep -q '</svg>' zero.svg && grep -q '^gospa_m  *0$' stdout"
head -2 truth.csv >single.csv
run evaluate single.csv <(head -1 tracks.csv) -o single.svg
check 'one time without a track: a picture, too' sh -c \
    "test ! -s stderr && grep -q '</svg>' single.svg"
awk -F, -v OFS=, 'NR > 1 { $1 += 1790000000 } 1' truth.csv >late_truth.csv
awk -F, -v OFS=, 'NR > 1 { $1 += 1790000000 } 1' tracks.csv >late.csv
run evaluate late_truth.csv late.csv -o late.svg
check 'times of clocks are counted from the first on' grep -q 'from 1790000000 on' late.svg
check 'and said in full' grep -q '^last_s  *1790000040$' stdout

# ---- what it refuses ----

run evaluate truth.csv tracks.csv -o over.png
check 'another ending' says 2 "rhotrack: evaluate: -o 'over.png' is neither NAME.svg*NAME.csv*"
cp tracks.csv own.csv
run evaluate truth.csv own.csv -o own.csv
check 'its own input' says 2 'rhotrack: own.csv: the output cannot be an input'
check '... is as it was' cmp own.csv tracks.csv
run evaluate truth.csv tracks.csv -o nowhere/over.csv
check 'a folder that is not there' exits 1
# refuses NAME FILE LINE SED: that tracks file line, changed so, is named, and what stood under -o
# stays.
refuses() {
    sed "$3$4" tracks.csv >"$2"
    echo 'as it was' >kept.csv
    run evaluate truth.csv "$2" -o kept.csv
    check "$1" says 2 "rhotrack: $2:$3: *"
    check "$1: nothing is written" test "$(cat kept.csv)" = 'as it was'
}
refuses 'a time that is none' time.csv 3 's/^10,/ten,/'
refuses 'tracks of another recording' other.csv '2' 's/$/0/; 2,$s/^/9/'
refuses 'an identity that is none' id.csv 5 's/,9,/,9.5,/'
refuses 'an unknown status' status.csv 2 's/confirmed/sure/'
refuses 'a place that is none' place.csv 6 's/,300,/,x,/'
refuses 'a covariance that is none' covariance.csv 4 's/,5$/,y/'

# ---- a truth of other times than the tracks' ----

# own_times FILE: two targets, a row a second for a minute, the second one .4 s behind the first.
own_times() {
    awk 'BEGIN {
        print "t_s,target_id,x_m,y_m"
        for (k = 0; k < 60; k++) {
            print k ",1," 15 * k ",0"
            print k + .4 ",2," 12 * (k + .4) ",7000"
        }
    }' >"$1"
}
# tracks_of FROM UNTIL STEP FILE: tracks of both, without error.
tracks_of() {
    awk -v from="$1" -v until="$2" -v step="$3" 'BEGIN {
        print "t_s,track_id,x_m,y_m,vx_mps,vy_mps"
        for (t = from; t <= until + 1e-9; t += step) {
            printf "%.6f,3,%.3f,0,15,0\n%.6f,4,%.3f,7000,12,0\n", t, 15 * t, t, 12 * t
        }
    }' >"$4"
}
own_times own.csv
tracks_of 1 59 1 at_first.csv
run evaluate own.csv at_first.csv --json -o own.csv.svg
check 'each target at its own times: no false track' json stdout \
    '(o["false_per_scan"] == 0 and o["false_tracks"] == 0 and o["rmse_m"] < 1e-9
    and o["switches"] == 0 and o["completeness"] > .98)'
check 'each target at its own times: the scans of the tracks, and one before them' json stdout \
    '[s["t_s"] for s in o["over_time"]] == list(range(60)) and o["delay_scans"] == .5'
check 'each target at its own times: by target' json stdout \
    '[(t["first_s"], t["last_s"], t["scans"], t["completeness"]) for t in o["by_target"]] == [
    (0, 59, 60, 59 / 60), (1, 59, 59, 1)]'
check 'each target at its own times: a picture' grep -q '</svg>' own.csv.svg
run evaluate own.csv at_first.csv -o rows.csv
check 'each target at its own times: rows over time' sh -c \
    "test \$(wc -l <rows.csv) -eq 61 && tail -1 rows.csv | grep -q '^59.000000,2,2,2,0,'"
tracks_of 0.77 58.77 0.5 elsewhere.csv
run evaluate own.csv elsewhere.csv --json
check 'tracks at times that the truth lacks' json stdout \
    '(o["false_per_scan"] == 0 and o["rmse_m"] < 1e-3 and o["scans"] == 119
    and o["completeness"] == 234 / 236)'
awk -F, 'NR == 1 || $1 <= 10.1 || $1 >= 50' elsewhere.csv >twice.csv
sed -i 's/^\(5.\.[0-9]*\),3/\1,13/; s/^\(5.\.[0-9]*\),4/\1,14/' twice.csv
run evaluate own.csv twice.csv --json
check 'where no track lives there are scans, too' json stdout \
    '(o["scans"] == 119 and o["completeness"] == 74 / 236
    and o["switches"] == 2 and o["fragments"] == 2)'

# Tracks that go on while the second target is away for 20 s, and 6 s longer than both.
awk -F, '$2 != 2 || $1 < 20 || $1 > 40' own.csv >away.csv
tracks_of 1 65 1 longer.csv
run evaluate away.csv longer.csv --json
check 'in a gap, and after its last row, there is no target' json stdout \
    '[s["gospa_false"] for s in o["over_time"]] == [0] * 20 + [1] * 21 + [0] * 19 + [2] * 6'
run evaluate away.csv longer.csv --json --set truth_gap_s=25
check 'a gap is longer than truth_gap_s' json stdout \
    '[s["gospa_false"] for s in o["over_time"]] == [0] * 60 + [2] * 6'
run evaluate own.csv at_first.csv --json --set truth_gap_s=.9
check 'every interval may be one' json stdout 'o["pairs"] == 59 and o["completeness"] > .98'
run evaluate own.csv at_first.csv --set truth_gap_s=-1
check 'a gap below 0' says 2 '*truth_gap_s*'

# A turn at 8 m/s^2, a row each 4 s: the velocities say where it was between.
awk 'BEGIN {
    print "t_s,target_id,x_m,y_m,vx_mps,vy_mps" >"bent.csv"
    print "t_s,track_id,x_m,y_m,vx_mps,vy_mps" >"bent_tracks.csv"
    for (t = 0; t <= 24; t++) {
        row = "1," 200 * t "," 4 * t * t ",200," 8 * t
        if (t % 4 == 0) print t "," row >"bent.csv"
        print t "," row >"bent_tracks.csv"
    }
}'
run evaluate bent.csv bent_tracks.csv --json
check 'a second sensor between: places and velocities' json stdout \
    'o["scans"] == 25 == o["pairs"] and o["rmse_m"] < 1e-6 and o["rmse_mps"] < 1e-6'
cut -d, -f1-4 bent.csv >straight.csv
run evaluate straight.csv bent_tracks.csv --json
check '... without velocities straight' json stdout \
    '(abs(max(s["rmse_m"] for s in o["over_time"]) - 16) < 1e-6 and o["rmse_mps"] is None)'
run evaluate bent_tracks.csv bent.csv
check 'the other way round these are tracks' exits 2
sed 's/target_id/track_id/' bent.csv >slow_tracks.csv
sed 's/track_id/target_id/' bent_tracks.csv >fast.csv
run evaluate fast.csv slow_tracks.csv --json
check 'rows of the truth between any two scans are no scans' json stdout \
    'o["scans"] == 7 and o["completeness"] == 1'
awk -F, 'NR == 1 || $1 != 12' bent_tracks.csv >missed.csv
run evaluate fast.csv missed.csv --json
check 'a scan without a track is one, where truth and tracks share their times' json stdout \
    'o["scans"] == 25 and abs(o["completeness"] - 24 / 25) < 1e-9'

# ---- 1000 targets, 200 scans: 400 000 rows ----

awk 'BEGIN {
    print "t_s,target_id,x_m,y_m,vx_mps,vy_mps" >"large_truth.csv"
    print "t_s,track_id,x_m,y_m,vx_mps,vy_mps" >"large.csv"
    for (t = 0; t < 200; t++) for (i = 0; i < 1000; i++) {
        x = i % 40 * 5000 + 200 * t; y = int(i / 40) * 5000
        print 10 * t "," i "," x "," y ",20,0" >"large_truth.csv"
        print 10 * t "," 3 * i "," x + 3 "," y - 4 ",20,1" >"large.csv"
    }
}'
in_little_memory() (ulimit -v 300000 && "$program" evaluate large_truth.csv large.csv --json \
    >stdout)
check 'large files in 300 MB' in_little_memory
check 'large files: every pair' json stdout \
    '(o["pairs"] == 200000 and o["completeness"] == 1 and abs(o["p95_m"] - 5) < 1e-9
    and o["median_mps"] == 1 and len(o["by_target"]) == 1000)'

finish
