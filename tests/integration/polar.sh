#!/bin/bash
# SPDX-License-Identifier: MIT
# Polar plots: simulate polar, track, initiate; the same plots in other forms, from elsewhere, with
# biases. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# ---- simulate polar, track, evaluate ----
simulate() { # folder, options...
    run simulate polar -o "$@"
    run track "$1/plots.csv" --config "$1/scenario.ini" -o "$1/tracks.csv"
    cp stderr "$1/summary"
    run evaluate "$1/truth.csv" "$1/tracks.csv" --json
    cp stdout "$1/figures.json"
}
# 20 of 20 and nothing else at 58 of 60 seeds, not at the first, delays of 2.15 .. 2.8 scans without
# range rates
for seed in 2 3 4 5 6; do
    for rate in 0 1; do
        rates=()
        [ "$rate" = 0 ] || rates=(--set radars.0.sigma_range_rate_mps=1)
        simulate "seed$seed-rate$rate" --seed "$seed" "${rates[@]}" --set targets.0.count=20
        check "seed $seed, range rate $rate: 20 targets, 20 tracks, none false or switched" \
            json "seed$seed-rate$rate/figures.json" \
            '((o["targets_found"], o["tracks"], o["gospa_false"], o["switches"]) ==
                (20, 20, 0, 0) and o["delay_scans"] < 3.5)'
    done
done
head -n 1 seed2-rate0/plots.csv >header
check 'without sigma_range_rate_mps there is no such column' matches "$(cat header)" \
    't_s,sensor_id,range_m,azimuth_rad,sensor_x_m,*'
head -n 1 seed2-rate1/plots.csv >header
check 'with it there is' matches "$(cat header)" \
    't_s,sensor_id,range_m,azimuth_rad,range_rate_mps,sensor_x_m,*'
check 'and scenario.ini has its noise' grep -qx 'sigma_range_rate_mps = 1' seed2-rate1/scenario.ini
cut -d, -f1-4,6- seed2-rate1/plots.csv >without.csv
check 'the other columns are the same' cmp seed2-rate0/plots.csv without.csv

# sum_below FIGURE FILES... : the first half of these have less of it in sum than the second half.
sum_below() {
    python3 -c 'import json, sys
values = [json.load(open(name))[sys.argv[1]] for name in sys.argv[2:]]
half = len(values) // 2
first, second = sum(values[:half]), sum(values[half:])
sys.exit(0 if first < second else f"{first} and {second}")' "$@"
}
# 0.15 .. 0.5 scans at each of 20 seeds
check 'range rates make targets found earlier' sum_below delay_scans seed?-rate1/figures.json \
    seed?-rate0/figures.json
sed 's/^sigma_range_rate_mps.*/sigma_range_rate_mps = 50/' seed2-rate1/scenario.ini >vague.ini
run track seed2-rate1/plots.csv --config vague.ini
check 'their noise has an effect' bash -c '! cmp -s seed2-rate1/tracks.csv stdout'

simulate again --seed 2 --set targets.0.count=20
check 'the same seed gives the same plots' cmp seed2-rate0/plots.csv again/plots.csv
check 'and truth' cmp seed2-rate0/truth.csv again/truth.csv
check 'and settings' cmp seed2-rate0/scenario.ini again/scenario.ini
check 'another seed gives others' bash -c '! cmp -s seed2-rate0/plots.csv seed3-rate0/plots.csv'
check 'and other targets' bash -c '! cmp -s seed2-rate0/truth.csv seed3-rate0/truth.csv'

# Turns open with a row of their own, so a turn without plots is a scan at its time.
simulate dark --seed 1 --set clutter=[] --set radars.0.pd=0
check 'turns without plots are scans' grep -q 'rhotrack: 15 scans, 0 plots, 0 tracks confirmed' \
    dark/summary
simulate thin --seed 1 --set clutter.0.plots=0.3 --set targets=[] --set duration_s=160
plots=$(awk -F, 'NR > 1 && $3 != ""' thin/plots.csv | wc -l)
check 'where some turns have plots, some do not, all count' \
    grep -q "rhotrack: 40 scans, $plots plots" thin/summary
check 'that file has both kinds of turns' awk -F, '$3 != "" { n++; turn[int($1 / 4)]++ }
    END { exit !(length(turn) > 5 && length(turn) < 35) }' thin/plots.csv

simulate odd --seed 1 --set radars.0.turn_s=2.6666667 --set duration_s=40.1
check 'scans have the times of the turns, also of odd ones' json odd/figures.json \
    'o["targets_found"] == 3'
simulate long --seed 1 --set radars.0.turn_s=60 --set duration_s=120
check 'long turns are tracked' grep -q 'rhotrack: 2 scans' long/summary

# ---- the noise of a polar plot is an ellipse: more is known than a circle says ----
judge() { # name; plots.csv or so, options of track...
    local name=$1
    shift
    run track "$@" --config ellipse/scenario.ini -o tracks.csv
    # from 24 s on, when both have found all
    awk -F, 'NR == 1 || $1 > 24' ellipse/truth.csv >truth.csv
    awk -F, 'NR == 1 || $1 > 24' tracks.csv >late_tracks.csv
    run evaluate truth.csv late_tracks.csv --json
    check "$name: the targets are found" json stdout '(o["targets_found"], o["tracks"]) == (30, 30)'
}
for seed in 1 2 3 4 5; do
    simulate ellipse --seed "$seed" --set targets.0.count=30 --set clutter=[]
    judge "seed $seed, polar" ellipse/plots.csv
    cp stdout "polar$seed.json"
    awk -F, 'NR == 1 { print "t_s,sensor_id,x_m,y_m,scan" }
        NR > 1 && $3 == "" { print $1 "," $2 ",,," $9 }
        NR > 1 && $3 != "" { printf "%s,%s,%.3f,%.3f,%s\n", $1, $2, $3 * cos($4), $3 * sin($4), $9 }
        ' ellipse/plots.csv >cartesian.csv
    # 15 m along, 3 mrad across at 20 to 60 km: 100 m is the root of their mean square
    judge "seed $seed, Cartesian" cartesian.csv --set sigma_m=100
    cp stdout "cartesian$seed.json"
done
# its square is 0.92 of the other's, standard deviation 0.04 a seed
check 'polar plots give better tracks than the same plots with one sigma' sum_below rmse_m \
    polar?.json cartesian?.json

# ---- two targets for 20 scans, 10 s apart, the second seen 2.5 s after the first, which goes over
# azimuth pi ---- Columns: t_s,sensor_id,range_m,azimuth_rad; more with heights: elevation_rad.
make_plots() { # heights (0 or 1)
    awk -v heights="$1" '
        function noise(size) { return size * (rand() + rand() + rand() - 1.5) }
        function plot(t, x, y, z,    ground) {
            ground = sqrt(x * x + y * y)
            printf "%.6f,1,%.4f,%.9f", t, sqrt(ground ^ 2 + z ^ 2) + noise(20),
                atan2(y, x) + noise(0.002)
            printf heights ? ",%.9f\n" : "\n", atan2(z, ground) + noise(0.002)
        }
        BEGIN {
            srand(7)
            print "t_s,sensor_id,range_m,azimuth_rad" (heights ? ",elevation_rad" : "")
            for (k = 0; k < 20; k++) {
                t = 10 * k
                plot(t, -40000 - 50 * t, -5030 + 200 * t, 6000 * heights)
                t += 2.5
                plot(t, 30000 - 100 * t, -9000 + 250 * t, 9000 * heights)
            } }'
}
# Numbers of the tracks' columns: 1 t_s, 3 status, 4 x, 5 y, 6 z, 7 vx, 8 vy, 18 plot.
# 100 m and 1 m/s: four sigmas of a line through 20 plots of 1 mrad at 60 km.
last_scan_is_true() { # file
    awk -F, '
        function is_near(row_x, row_y, vx, vy) {
            return ($4 - row_x)^2 + ($5 - row_y)^2 < 100^2 && ($7 - vx)^2 + ($8 - vy)^2 < 1
        }
        $1 == "190.000000" && $3 == "confirmed" {
            n++
            if (is_near(-49500, 32970, -50, 200) && $18 == 0) a++
            if (is_near(11000, 38500, -100, 250) && $18 == 1) b++
        } END { exit !(n == 2 && a == 1 && b == 1) }' "$1"
}
make_plots 0 >plots.csv
# Straight, so that a track led on in time is the same line.
settings=(--set scan_interval_s=9 --set accel_max_mps2=0 --set sigma_azimuth_rad=0.001 \
    --set sigma_range_m=10)
run track plots.csv "${settings[@]}"
cp stdout tracks.csv
cp stderr summary
check 'both targets are confirmed, in place at the time of the scan, with their plots' \
    last_scan_is_true tracks.csv
check 'two rows a scan' grep -q 'rhotrack: 20 scans, 40 plots, 2 tracks confirmed' summary
check 'and no third track' awk -F, 'NR > 1 { seen[$2] } END { exit length(seen) != 2 }' tracks.csv

# ---- the same plots in another form ----
same() { # name, file, options...
    local name=$1
    shift
    run track "$@"
    check "$name" writes_same_as tracks.csv
}
awk -F, '{ print $4 "," $3 "," $2 "," $1 }' plots.csv >form.csv
same 'another order of columns' form.csv "${settings[@]}"
awk -F, '{ print $0 (NR == 1 ? ",sigma_range_m,sigma_azimuth_rad" : ",10,0.001") }' plots.csv \
    >form.csv
same 'columns of sigmas go before --set' form.csv --set scan_interval_s=9 --set accel_max_mps2=0 \
    --set sigma_range_m=99 \
    --set sigma_azimuth_rad=0.1
awk -F, '{ print $0 (NR == 1 ? ",sigma_range_m,sigma_azimuth_rad" : ",,") }' plots.csv >form.csv
same 'empty cells leave the sigmas to --set' form.csv "${settings[@]}"
same "a sensor's own sigmas go before those of all" plots.csv --set scan_interval_s=9 \
    --set accel_max_mps2=0 \
    --set sensor.1.sigma_range_m=10 --set sensor.1.sigma_azimuth_rad=0.001
run track plots.csv --set scan_interval_s=9 --set accel_max_mps2=0
check 'and have an effect' bash -c '! cmp -s tracks.csv stdout'

# The last run gave the reference's tracks, moved by so much, and on by so many seconds.
near() { # reference, tolerance in m, x, y, seconds
    exits 0 && [ "$(wc -l <stdout)" -eq "$(wc -l <"$1")" ] && paste -d, "$1" stdout |
        awk -F, -v tolerance="$2" -v x="$3" -v y="$4" -v on="$5" '
            function is_off(difference, most) { return difference > most || difference < -most }
            NR > 1 && (is_off($19 - $1 - on, 1e-6) || $20 != $2 || $21 != $3 || $36 != $18 ||
                       is_off($22 - $4 - x - $7 * on, tolerance) ||
                       is_off($23 - $5 - y - $8 * on, tolerance) ||
                       is_off($24 - $6, tolerance) || is_off($25 - $7, tolerance / 5) ||
                       is_off($26 - $8, tolerance / 5)) { print; exit 1 }'
}
# ... and not the reference's tracks as they are.
moved() { near "$@" && ! near "$1" "$2" 0 0 0 >/dev/null; }

# Clockwise from north, 0 .. 360.
compass='NR > 1 { $4 = sprintf("%.7f", (450 - $4 * 57.29577951308232) % 360) } { print }'
awk -F, "$compass" OFS=, plots.csv | sed 's/azimuth_rad/azimuth_deg/' >compass.csv
run track compass.csv "${settings[@]}"
check 'azimuth_deg: clockwise from north' near tracks.csv 0.1 0 0 0

# ---- biases ----
shift_plots() { # metres, radians, seconds
    awk -F, -v range="$1" -v azimuth="$2" -v time="$3" 'NR > 1 {
            $1 = sprintf("%.6f", $1 + time)
            $3 = sprintf("%.4f", $3 + range)
            $4 += azimuth
            $4 = sprintf("%.9f",
                $4 > 3.14159265 ? $4 - 6.283185307 : $4 < -3.14159265 ? $4 + 6.283185307 : $4)
        } { print }' OFS=, plots.csv
}
shift_plots 300 0 0 >range.csv
run track range.csv "${settings[@]}" --set sensor.1.range_bias_m=300
check 'a range bias is taken off' near tracks.csv 0.1 0 0 0
run track range.csv "${settings[@]}"
check 'which would be seen' bash -c '! cmp -s tracks.csv stdout'
shift_plots 0 -0.02 0 >azimuth.csv
run track azimuth.csv "${settings[@]}" --set sensor.1.azimuth_bias_rad=-0.02
check 'an azimuth bias is taken off, also over pi' near tracks.csv 0.1 0 0 0
# It is taken off the scans' times, so that the tracks are at the right ones.
shift_plots 0 0 1.5 >late.csv
run track late.csv "${settings[@]}" --set sensor.1.time_bias_s=1.5
check 'a time bias is taken off' near tracks.csv 0.1 0 0 0
shift_plots -200 0.03 -0.75 >biased.csv
printf '[sensor 1]\nrange_bias_m = -200\nazimuth_bias_rad = 0.03\ntime_bias_s = -0.75\n' >biases.ini
run track biased.csv "${settings[@]}" --config biases.ini
check 'all biases together, from an INI file' near tracks.csv 0.1 0 0 0
run track plots.csv "${settings[@]}" --set sensor.2.range_bias_m=300 \
    --set sensor.2.azimuth_bias_rad=0.1
check "another sensor's biases are not this one's" writes_same_as tracks.csv

# ---- places ----
awk -F, '{ print $0 (NR == 1 ? ",sensor_x_m,sensor_y_m" : ",12000,-7000") }' plots.csv >place.csv
run track place.csv "${settings[@]}"
cp stdout placed.csv
check 'columns of the place move all tracks' moved tracks.csv 0.1 12000 -7000 0
run track plots.csv "${settings[@]}" --set sensor.1.x_m=12000 --set sensor.1.y_m=-7000
check 'so do parameters' near placed.csv 0.1 0 0 0
run track place.csv "${settings[@]}" --set sensor.1.x_m=-40000 --set sensor.1.y_m=90000
check 'columns go before parameters' near placed.csv 0.1 0 0 0
awk -F, 'NR > 1 { $5 = $6 = "" } { print }' OFS=, place.csv >form.csv
run track form.csv "${settings[@]}" --set sensor.1.x_m=12000 --set sensor.1.y_m=-7000
check 'empty cells leave the place to parameters' near placed.csv 0.1 0 0 0

# Range rates are seen from the sensor's place; seen from elsewhere they would be other targets'.
awk -F, 'NR > 1 { $6 = 12000; $7 = -7000 } { print }' OFS=, seed2-rate1/plots.csv >elsewhere.csv
sed -e 's/^area_x_min_m.*/area_x_min_m = -53000/' -e 's/^area_x_max_m.*/area_x_max_m = 77000/' \
    -e 's/^area_y_min_m.*/area_y_min_m = -72000/' -e 's/^area_y_max_m.*/area_y_max_m = 58000/' \
    seed2-rate1/scenario.ini >elsewhere.ini
run track elsewhere.csv --config elsewhere.ini
# (a radar that has a place has a range, too, and the clutter map learns by parts of it)
check 'a simulated radar elsewhere, range rates and clutter' moved seed2-rate1/tracks.csv 0.3 \
    12000 -7000 0

# Empty cells once left the tracker with the place of the scan before.
awk -F, 'NR == 1 { print; print "0,1,,,,0,90000,0,0,0," } NR > 1 { $6 = $7 = ""; print }' OFS=, \
    seed2-rate1/plots.csv >form.csv
run track form.csv --config seed2-rate1/scenario.ini -o tracks_form.csv
run evaluate seed2-rate1/truth.csv tracks_form.csv --json
check 'a place is not that of the scan before' json stdout \
    '(o["targets_found"], o["tracks"]) == (20, 20)'

# ---- heights ----
make_plots 1 >high.csv
run track high.csv "${settings[@]}" --set sigma_elevation_rad=0.001
cp stdout high_tracks.csv
check 'with elevations both targets are in place' last_scan_is_true high_tracks.csv
check 'at their heights' awk -F, \
    '$1 == "190.000000" && ($6 - ($18 == 0 ? 6000 : 9000))^2 > 100^2 { exit 1 }' high_tracks.csv
awk -F, 'NR > 1 { $5 = sprintf("%.8f", $5 * 57.29577951308232) } { print }' OFS=, high.csv |
    sed 's/elevation_rad/elevation_deg/' >form.csv
run track form.csv "${settings[@]}" --set sigma_elevation_rad=0.001
check 'elevation_deg' near high_tracks.csv 0.1 0 0 0
awk -F, '{ print $0 (NR == 1 ? ",sensor_x_m,sensor_y_m,sensor_z_m" : ",0,0,700") }' high.csv \
    >form.csv
run track form.csv "${settings[@]}" --set sigma_elevation_rad=0.001
awk -F, 'NR > 1 { $6 -= 700 } { print }' OFS=, stdout >lowered.csv
cp lowered.csv stdout
check "the sensor's height is added" near high_tracks.csv 0.1 0 0 0
run track form.csv "${settings[@]}" --set sigma_elevation_rad=0.001
cp stdout raised.csv
# The height was once lost unless it stood with the place, in columns both.
awk -F, '{ print $0 (NR == 1 ? ",sensor_z_m" : ",700") }' high.csv >form.csv
run track form.csv "${settings[@]}" --set sigma_elevation_rad=0.001
check 'a column of the height alone' writes_same_as raised.csv
awk -F, '{ print $0 (NR == 1 ? ",sensor_x_m,sensor_y_m" : ",0,0") }' high.csv >form.csv
run track form.csv "${settings[@]}" --set sigma_elevation_rad=0.001 --set sensor.1.z_m=700
check 'columns of the place, a parameter of the height' writes_same_as raised.csv

# ---- initiate ----
# Numbers of its columns: 3 x, 4 y, 5 vx, 6 vy. Four sigmas of a line through 7 plots.
both_found() { # x, y of the sensor
    awk -F, -v x="$1" -v y="$2" '
        function is_near(row_x, row_y, vx, vy) {
            return ($3 - x - row_x)^2 + ($4 - y - row_y)^2 < 150^2 &&
                ($5 - vx)^2 + ($6 - vy)^2 < 5^2
        }
        NR > 1 {
            n++
            if (is_near(-49500, 32970, -50, 200)) a++
            if (is_near(11000, 38500, -100, 250)) b++
        } END { exit !(n == 2 && a == 1 && b == 1) }' stdout
}
run initiate plots.csv "${settings[@]}"
check 'initiate finds both targets' both_found 0 0
run initiate compass.csv "${settings[@]}"
check 'initiate: by compass' both_found 0 0
run initiate place.csv "${settings[@]}"
check 'initiate: from elsewhere' both_found 12000 -7000
run initiate range.csv "${settings[@]}" --set sensor.1.range_bias_m=300
check 'initiate: with a bias' both_found 0 0
# 18 .. 20 of 20 and nothing else at each of 20 seeds
awk -F, 'NR == 1 || $1 == "60.000000"' seed2-rate0/truth.csv >truth.csv
for rate in 0 1; do
    run initiate "seed2-rate$rate/plots.csv" --config "seed2-rate$rate/scenario.ini" \
        -o initiated.csv
    run evaluate truth.csv initiated.csv --json
    check "initiate: simulated, range rate $rate" json stdout \
        'o["targets_found"] >= 17 and o["gospa_false"] == 0'
done

awk -F, 'NR > 1 { $3 += 12000; $4 -= 7000 } { print }' OFS=, truth.csv >moved_truth.csv
run initiate elsewhere.csv --config elsewhere.ini -o initiated.csv
run evaluate moved_truth.csv initiated.csv --json
check 'initiate: range rates from elsewhere' json stdout \
    'o["targets_found"] >= 17 and o["gospa_false"] == 0'

# ---- plot ----
run plot scans seed2-rate0/plots.csv seed2-rate0/truth.csv -o scans.svg
check 'plot scans' exits 0
check 'plot scans is well-formed' python3 -c 'import xml.dom.minidom as m; m.parse("scans.svg")'
# It once knew places and biases from columns alone.
run plot scans place.csv -o place.svg
run plot scans plots.csv -o plots.svg
check 'plot scans: columns of the place move them' bash -c '! cmp -s place.svg plots.svg'
run plot scans plots.csv --set sensor.1.x_m=12000 --set sensor.1.y_m=-7000 -o parameters.svg
check 'plot scans: so do parameters' cmp place.svg parameters.svg
printf 't_s,sensor_id,range_m,azimuth_rad\n0,1,30000,1\n1,1,31000,2\n' >two.csv
sed 's/000,/300,/' two.csv >two_range.csv
run plot scans two.csv -o two.svg
run plot scans two_range.csv --set sensor.1.range_bias_m=300 -o two_range.svg
check 'plot scans: a bias is taken off' cmp two.svg two_range.svg

# ---- rotating: sectors ----
# What initiate finds at the start of the last turn is where the targets are then; and so of whole
# turns.
cat >found.py <<'PYTHON'
import csv, math, sys
found = [[float(row[name]) for name in ("t_s", "x_m", "y_m")]
         for row in csv.DictReader(open(sys.argv[1]))]
truth = [[float(row[name]) for name in ("t_s", "x_m", "y_m")]
         for row in csv.DictReader(open(sys.argv[2]))]
for t, x, y in found:
    near = min(math.hypot(x - u, y - v) for at, u, v in truth if abs(at - t) < 1e-3)
    assert near < 300, (t, x, y, near)
assert len(found) == 3, found
PYTHON
run simulate rotating -o sectors
run initiate sectors/plots.csv --config sectors/scenario.ini --json -o found.csv
check 'initiate: the sectors of a turn are one scan' grep -qx \
    'rhotrack: the last 7 of 15 scans are used' stderr
check 'initiate: JSON counts turns' json stdout \
    'o["scans"] == 7 and o["tracks"] == 3 and o["plots"] > 600'
check 'initiate: three targets, where they are' python3 found.py found.csv sectors/truth.csv
run simulate rotating -o turns --set radars.0.sectors=1
run initiate turns/plots.csv --config turns/scenario.ini -o found.csv
check 'initiate: as of whole turns' python3 found.py found.csv turns/truth.csv
run initiate sectors/plots.csv --config sectors/scenario.ini --method iht --set d_rho_m=20 --json
check 'methods of the literature: the same turns' json stdout 'o["scans"] == 7 and o["plots"] > 600'
run simulate two-radars -o late --set duration_s=100 --set radars.0.late_s=3 --set radars.1.late_s=3
run initiate late/plots.csv --config late/scenario.ini --set hold_ms=20
check 'initiate: what comes late is left out and counted' grep -qx \
    'rhotrack: [0-9]* scans that came late are left out' stderr
check 'initiate: and ends well' exits 0
python3 - <<'PYTHON'
rows = list(open("sectors/plots.csv"))
keep = [row for row in rows[1:] if int(row.rstrip().rsplit(",", 2)[1]) > 3 * 32]
open("last.csv", "w").writelines(rows[:1] + keep)
PYTHON
run plot parameter-space sectors/plots.csv --config sectors/scenario.ini -o space.svg
check 'plot parameter-space: the last 12 turns of 15' grep -qx \
    'rhotrack: the last 12 of 15 scans are used' stderr
run plot parameter-space last.csv --config sectors/scenario.ini -o last.svg
check 'plot parameter-space: of sectors' cmp space.svg last.svg
run plot parameter-space /dev/stdin -o stdin.svg
check 'plot parameter-space: not through a pipe' exits 2
run plot parameter-space seed2-rate0/plots.csv --config seed2-rate0/scenario.ini -o space.svg
check 'plot parameter-space: turns whose plots have their own times' grep -qx \
    'rhotrack: the last 12 of 15 scans are used' stderr
awk 'BEGIN {
    print "t_s,sensor_id,x_m,y_m"
    for (k = 0; k < 20; k++) print k ",0," 50 * k "," 900 - 20 * k
}' >one.csv
cut -d, -f1,3,4 one.csv >bare.csv
run plot parameter-space one.csv -o one.svg
run plot parameter-space bare.csv -o bare.svg
check 'plot parameter-space: without sensor_id all is of one sensor' cmp one.svg bare.svg
run track one.csv -o one.out.csv
run track bare.csv -o bare.out.csv
check 'track: the same' cmp one.out.csv bare.out.csv
run track bare.csv --set sensor.3.x_m=100 --set sensor.4.x_m=100
check 'track: not where several sensors are described' says 2 \
    "rhotrack: bare.csv:1: no column 'sensor_id'*"
# Such a file once left the script for gnuplot behind.
{ cat bare.csv; echo 3,1,1; } >back.csv
run plot parameter-space back.csv -o refused.svg
check 'plot parameter-space: times do not go back' says 2 \
    'rhotrack: back.csv:22: time decreases from 19.000000 s to 3.000000 s'
sed '5s/^[^,]*,\(.*\)/3,\1e9/' bare.csv >far.csv
run plot parameter-space far.csv -o refused.svg
check 'plot parameter-space: places as track has them' says 2 \
    'rhotrack: far.csv:5: y_m * is outside *'
check 'plot parameter-space: nothing is left of those' bash -c '! ls refused.svg* 2>/dev/null'

finish
