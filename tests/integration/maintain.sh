#!/bin/bash
# SPDX-License-Identifier: MIT
# maintain: one track through each gate, on targets that pull in a beam full of clutter, and what it
# refuses. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# ---- the scenes' files ----
for scene in popup weave; do
    run simulate $scene --seed 3 -o $scene
    check "$scene" exits 0
done
check 'columns of plots with heights' matches "$(head -n 1 popup/plots.csv)" \
    't_s,sensor_id,x_m,y_m,z_m,sigma_m,scan,target_id'
check 'columns of a truth with heights' matches "$(head -n 1 popup/truth.csv)" \
    't_s,target_id,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps'
check 'four clutter plots a scan but in the first three' \
    matches "$(wc -l <popup/plots.csv)" $((1 + 161 * 6 - 3 * 4))
check 'what a tracker may know' grep -q '^accel_max_mps2 = 117.68$' popup/scenario.ini
check 'clutter that moves has no area' bash -c '! grep -q area popup/scenario.ini'
run simulate popup --seed 3 --set radars.0.sigma_mps=1 --set radars.0.pd=0 --set clutter=[] -o empty
check 'a scan that saw nothing has a row' grep -q '^40.000000,1,,,,,,,,,161,$' empty/plots.csv

# ---- each gate, as in the paper: velocities are measured, 1 m and 1 m/s ----
run simulate popup --seed 4 --set radars.0.sigma_mps=1 --set radars.0.sigma_m=1 -o sharp
check 'columns of velocities' matches "$(head -n 1 sharp/plots.csv)" \
    't_s,sensor_id,x_m,y_m,z_m,sigma_m,vx_mps,vy_mps,vz_mps,sigma_mps,scan,target_id'
for gate in best hough nearest none; do
    run maintain sharp/plots.csv --config sharp/scenario.ini --gate $gate -o $gate.csv
    check "$gate" exits 0
    cp stderr $gate.summary
    run evaluate sharp/truth.csv $gate.csv --json
    cp stdout $gate.json
done
check 'one line of summary' matches "$(cat hough.summary)" \
    'rhotrack: 161 scans, 793 plots: 161 claimed, 0 misses, 0 updates refused; '\
'* us a scan, * at most'
check 'columns of tracks' matches "$(head -n 1 hough.csv)" \
    't_s,track_id,status,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps,ax_mps2,ay_mps2,az_mps2,'\
'sigma_m,sigma_mps,hits,misses,sensor_id,plot'
check 'a row a scan, one track, confirmed' awk -F, '
    NR > 1 && ($2 != 1 || $3 != "confirmed" || $15 != NR - 1 || NF != 18) { exit 1 }
    END { exit NR != 162 }' hough.csv
for gate in best hough nearest; do
    check "$gate follows the target" json $gate.json \
        'o["completeness"] == 1 and o["rmse_m"] < 2.5 and o["rmse_mps"] < 15 and o["switches"] == 0'
done
check 'none does not' json none.json 'o["rmse_m"] > 100 and o["rmse_mps"] > 500'
check 'the acceleration is there while it pulls, and not before' awk -F, '
    $1 > 11.5 && $1 < 13.5 && ($12 < 60 || $12 > 130) { exit 1 }
    $1 > 4 && $1 < 9.5 && $12 * $12 > 2500 { exit 1 }' hough.csv
run maintain sharp/plots.csv --config sharp/scenario.ini --no-input-estimation
check 'best is the default' cmp best.csv stdout
check 'and has no input estimation' grep -q \
    '^rhotrack: --no-input-estimation has no effect with --gate best' stderr
run simulate weave --seed 5 --set radars.0.pd=0.9 --set clutter.0.count=10 -o hard
run maintain hard/plots.csv --config hard/scenario.ini -o out.csv
run evaluate hard/truth.csv out.csv --json
check 'best: a target that pulls 10 g, places alone, 10 clutter plots, P_D 0.9' json stdout \
    'o["completeness"] == 1 and o["rmse_m"] < 25'
run maintain sharp/plots.csv --gate none --seed 1
check 'none: the seed decides' writes_same_as none.csv
run maintain sharp/plots.csv --gate none --seed 2
check 'none: another draws others' bash -c '! cmp -s stdout none.csv'
run maintain sharp/plots.csv --set gate=hough
check 'the gate by parameter' writes_same_as hough.csv
run maintain sharp/plots.csv --gate hough --set initial_variance=500 --covariance -o initial.csv
check 'P(0|0) = 500 I' awk -F, 'NR == 2 {
    for (i = 19; i <= 39; i++) { n += $i == 500; bad += $i != 500 && $i != 0 }
    exit !(n == 6 && !bad) }' initial.csv
run maintain sharp/plots.csv --set gate=none --gate hough
check '--gate goes before the parameter' writes_same_as hough.csv
run maintain sharp/plots.csv --gate nearest --no-input-estimation
cp stdout plain.csv
check 'a plain filter has no accelerations' awk -F, 'NR > 1 && ($10 || $11 || $12) { exit 1 }' \
    plain.csv
run maintain sharp/plots.csv --gate hough --set gamma=0.5 --set onset_confidence=0.99 -o forgets.csv
run evaluate sharp/truth.csv forgets.csv --json
check 'forgetting follows more closely' json stdout "o['rmse_mps'] < 0.5 * $(python3 -c '
import json; print(json.load(open("hough.json"))["rmse_mps"])')"
run maintain sharp/plots.csv --gate hough --set planes=xy --set gate_theta_deg=20
check 'planes and cells have an effect' bash -c '! cmp -s stdout hough.csv'
run maintain sharp/plots.csv --gate hough --set planes=yz+xz+xy
check 'planes in any order' writes_same_as hough.csv
run config --set planes=yz+xy
check 'config says which planes' grep -q \
    '^planes .* xy+xz+yz  xy|xz|yz, joined by +  *xy+yz  set ' stdout
run maintain sharp/plots.csv --gate nearest --set input_model=physical --set input_sigma_mps2=100
check 'so have the model and V(0)' bash -c '! cmp -s stdout nearest.csv'
run maintain sharp/plots.csv --gate nearest --set filter_noise_m=5 --set filter_noise_mps=30
check 'so has the noise of the filter' bash -c '! cmp -s stdout nearest.csv'

run maintain sharp/plots.csv --gate hough --json
check 'json: what it must hold' json stdout '(o["gate"], o["input_estimation"], o["scans"],
    o["plots"], o["tracks_confirmed"], o["misses"], o["updates_refused"]) == (
    "hough", True, 161, 793, 1, 0, 0)'
check 'json: fates add up' json stdout '(o["fates"]["claimed"], o["fates"]["held"],
    sum(o["fates"].values()), sorted(o["fates"])) == (
    161, 632, 793, ["claimed", "ghost", "held", "invalid", "no_room", "stale"])'
check 'json: cost' json stdout 'o["max_us"] >= o["mean_us"] > 0 and 0 < o["state_bytes"] <= 560'
run maintain sharp/plots.csv --gate hough --json -o out.csv
check 'json with -o: tracks in the file' cmp hough.csv out.csv
run maintain sharp/plots.csv --gate hough --covariance
cut -d, -f1-18 stdout >first_columns.csv
check 'covariance: the other columns are the same' cmp hough.csv first_columns.csv
check 'covariance: 21 columns more' awk -F, 'NF != 39 { exit 1 }' stdout

# ---- scans ----
run simulate popup --seed 3 --set radars.0.sigma_mps=1 --set radars.0.pd=0.8 --set clutter=[] \
    -o misses
run maintain misses/plots.csv --gate nearest --config misses/scenario.ini --json -o out.csv
check 'misses are counted' json stdout \
    'o["misses"] + o["fates"]["claimed"] == 161 and 10 < o["misses"] < 60'
check 'and their rows coast' awk -F, 'NR > 1 && ($18 == -1) != ($3 == "coasting") { exit 1 }' \
    out.csv
{ head -n 1 misses/plots.csv; echo '-0.5,1,,,,,,,,,0,'; tail -n +2 misses/plots.csv; } >late.csv
run maintain late.csv --gate nearest --config misses/scenario.ini
check 'nothing is written before there is a plot' writes_same_as out.csv

# A target at (10 km, 0) that goes north at 100 m/s; a scan looks at it, the next at the west, where
# there is a plot.
awk 'BEGIN {
    print "t_s,sensor_id,x_m,y_m,sector_from_rad,sector_to_rad"
    for (k = 0; k < 20; k++)
        if (k % 2) print k ",1,-10000," 100 * k ",1.6,4.7"
        else print k ",1,10000," 100 * k ",-1.5,1.5" }' >sectors.csv
run maintain sectors.csv --gate nearest --set input_model=physical
check 'where a sector did not look, no plot is taken and nothing missed' awk -F, '
    NR > 1 && (($1 % 2) != ($18 == -1) || $16 > 0 || $3 != "confirmed") { exit 1 }
    NR > 10 && ($4 < 9950 || $4 > 10050) { exit 1 }' stdout

# Scans that stop for six hours, and for three weeks.
awk 'BEGIN { print "t_s,sensor_id,x_m,y_m"
    for (k = 0; k < 10; k++) print k ",1," 100 * k ",0"
    for (k = 0; k < 10; k++) print 20000 + k ",1," 5000 + 100 * k ",0"
    for (k = 0; k < 10; k++)
        print 2000000 + k ",1,90000,0\n" 2000000 + k ",1," 9000 + 100 * k ",0" }' >gaps.csv
for gate in best nearest; do
    run maintain gaps.csv --gate $gate --set input_model=physical
    check "$gate: after a long gap the track starts again where it was last" awk -F, '
        $1 == "2000009.000000" && (($4 - 9900)^2 > 900 || ($7 - 100)^2 > 100) { exit 1 }
        $2 != 1 && NR > 1 { exit 1 } END { exit NR != 31 }' stdout
    check "$gate: which is counted" grep -q ' [12] updates refused' stderr
done

# Two sensors, one with heights: the same target, 200 m/s to the east at 3 km.
awk 'BEGIN {
    print "t_s,sensor_id,x_m,y_m,z_m"
    for (k = 0; k < 30; k++)
        print k / 2 "," k % 2 "," 5000 + 100 * k ",4000," (k % 2 ? 3000 : "") }' >two.csv
run maintain two.csv --gate nearest --set input_model=physical
check 'plots of two sensors go to one track' awk -F, '
    NR > 1 && ($2 != 1 || $18 != 0 || $17 != NR % 2) { exit 1 }
    END { exit ($4 - 7900)^2 + ($5 - 4000)^2 + ($6 - 3000)^2 > 900 || ($7 - 200)^2 > 400 }' stdout

# A radar's plots, each at its own time, with range rates: a lone target.
run simulate polar --seed 3 --set targets.0.count=1 --set clutter=[] --set radars.0.pd=1 \
    --set radars.0.sigma_range_rate_mps=1 -o polar
run maintain polar/plots.csv --gate nearest --config polar/scenario.ini -o out.csv
run evaluate polar/truth.csv out.csv --json
check 'polar plots' json stdout 'o["completeness"] > 0.9 and o["rmse_m"] < 200'

# ---- what it refuses ----
run maintain popup/plots.csv --gate hough -o none_left.csv
check 'hough without velocities' says 2 \
    "rhotrack: gate hough needs velocities, and the scan at 0.000000 s has none: "\
"give columns 'vx_mps' and 'vy_mps'"
check 'and no output is left' test ! -e none_left.csv
cut -d, -f1-4,6-8,10 sharp/plots.csv >level.csv
run maintain level.csv --gate hough
check 'hough without heights' exits 0
run maintain level.csv --gate hough --set planes=xz+yz
check 'and without a plane left' says 2 \
    'rhotrack: gate hough: the scan at 0.000000 s has no heights, so planes must contain xy'
run maintain popup/plots.csv --gate nearest
check 'places alone and the literal model: it says so' grep -q \
    '^rhotrack: positions alone do not show the inputs of input_model literal' stderr
run maintain popup/plots.csv --gate huogh
check 'an unknown gate' says 2 "rhotrack: --gate 'huogh' is not one of best|hough|nearest|none"
run maintain sharp/plots.csv --set planes=xy+zz
check 'an unknown plane' says 2 \
    "rhotrack: --set planes=xy+zz: planes 'xy+zz' is not one of xy|xz|yz, or several joined by +"
run maintain
check 'no input' says 2 'rhotrack: maintain: too few arguments; usage: *'
run maintain popup/plots.csv weave/plots.csv --gate nearest
check 'two inputs' says 2 "rhotrack: maintain: 'weave/plots.csv' is one argument too many; *"
run maintain nowhere.csv --gate nearest
check 'no such file' says 2 'rhotrack: nowhere.csv: No such file or directory'
printf 't_s,sensor_id,x_m,y_m\n0,1,,\n1,1,,\n' >nothing.csv
run maintain nothing.csv --gate nearest
check 'not one plot' says 2 'rhotrack: nothing.csv: no plot to start the track from'
run simulate passive-two -o passive
run maintain passive/bearings.csv --gate nearest
check 'bearings' says 2 \
    'rhotrack: passive/bearings.csv: maintain takes plots, but this file has bearings'
sed '7s/^[^,]*,1,[^,]*/1,1,12x/' sharp/plots.csv >broken.csv
run maintain broken.csv --gate nearest -o none_left.csv
check 'a bad cell' says 2 "rhotrack: broken.csv:7: x_m*"
check 'and no output is left again' test ! -e none_left.csv
run maintain broken.csv --gate nearest --keep-going --json
check 'with --keep-going it is skipped' json stdout 'o["rows_skipped"] == 1 and o["plots"] == 792'
run maintain sharp/plots.csv --gate nearest --follow
check 'options of others' says 2 \
    'rhotrack: maintain takes no --follow; see rhotrack maintain --help'

# ---- heights in `evaluate`: only where both files have them ----
cut -d, -f1-4,6-7 sharp/truth.csv >flat_truth.csv
run evaluate flat_truth.csv hough.csv --json
check 'a truth without heights' json stdout 'o["rmse_m"] < 2.5 and o["completeness"] == 1'
awk -F, 'NR > 1 { $5 += 100 } { print }' OFS=, sharp/truth.csv >higher.csv
run evaluate higher.csv hough.csv --json
check 'a truth 100 m higher' json stdout '99 < o["rmse_m"] < 101'
awk -F, 'NR > 1 { $8 += 50 } { print }' OFS=, sharp/truth.csv >faster.csv
run evaluate faster.csv hough.csv --json
check 'a truth that climbs 50 m/s faster' json stdout '45 < o["rmse_mps"] < 60'

finish
