#!/bin/bash
# SPDX-License-Identifier: MIT
# Bearings: simulate passive-..., the bearings files that `plot scans` takes and refuses, what
# `initiate` and `track` make of them, alone and beside a radar's plots, and pictures.
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# ---- simulate ----
for scenario in passive-two passive-three passive-clutter; do
    run simulate "$scenario" --seed 3 -o "$scenario"
    check "simulate $scenario" exits 0
    check "$scenario: the header" matches "$(head -n 1 "$scenario/bearings.csv")" \
        't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,scan,target_id'
    check "$scenario: no plots" test ! -e "$scenario/plots.csv"
    check "$scenario: scenario.ini has the noise" grep -qx 'sigma_rad = 0.0017453293' \
        "$scenario/scenario.ini"
    run config --config "$scenario/scenario.ini"
    check "$scenario: which is a parameter" exits 0
    run simulate "$scenario" --seed 3 -o again
    check "$scenario: the same seed, the same bytes" diff -r "$scenario" again
    run simulate "$scenario" --seed 4 -o again
    check "$scenario: another seed, others" bash -c \
        "! cmp -s $scenario/bearings.csv again/bearings.csv"
done
# rows of a sensor: 8 scans of 2 targets, all seen
per_sensor() { awk -F, \
    'NR > 1 { n[$2 " at " $3 + 0 " " $4 + 0]++ } END { for (s in n) print s ": " n[s] }' "$1" \
    | sort | tr '\n' ';'; }
check 'passive-two: two sensors, no miss' matches "$(per_sensor passive-two/bearings.csv)" \
    '1 at 0 -10000: 16;2 at 0 10000: 16;'
check 'passive-three: a third' matches "$(per_sensor passive-three/bearings.csv)" \
    '1 at 0 -10000: 16;2 at 0 10000: 16;3 at 10000 0: 16;'
run simulate passive-three --set \
    'passive.3={"at_m": [-10000, 0], "interval_s": 10, "sigma_rad": 0.002, "pd": 1}' \
    --set targets.0.count=5 --set duration_s=30 -o more
check 'a fourth sensor, more targets, fewer scans' matches "$(per_sensor more/bearings.csv)" \
    '1 at 0 -10000: 15;2 at 0 10000: 15;3 at 10000 0: 15;4 at -10000 0: 15;'
run simulate passive-two --set passive.0.pd=0 --set passive.1.pd=0 -o blind
check 'sensors that see nothing say so' matches \
    "$(per_sensor blind/bearings.csv)$(grep -c ',$' blind/bearings.csv)" \
    '1 at 0 -10000: 8;2 at 0 10000: 8;16'
run simulate passive-clutter --seed 3 --runs 2 -o runs
check 'runs' cmp -s passive-clutter/bearings.csv runs/run-0000/bearings.csv
run simulate passive-two --set passive.0.sigma_elevation_rad=0.001 --set passive.0.z_m=30 \
    --set targets.0='{"at_m": [0, 0, 3000], "velocity_mps": [200, 10, 5]}' --seed 3 -o up
check 'elevations of one sensor of two' matches "$(awk -F, \
    'NR > 1 { n[$2 " " $5 + 0 " " ($7 == "")]++ } END { for (s in n) print s }' up/bearings.csv \
    | sort | tr '\n' ';')" '1 30 0;2 0 1;'
check 'elevations: the header' matches "$(head -n 1 up/bearings.csv)" \
    't_s,sensor_id,sensor_x_m,sensor_y_m,sensor_z_m,bearing_rad,elevation_rad,scan,target_id'
check 'elevations: the noise' grep -qx 'sigma_elevation_rad = 0.001' up/scenario.ini
run convert up/bearings.csv up.lcm
run track up/bearings.csv --config up/scenario.ini -o up.csv
check 'elevations are tracked' exits 0
run track up.lcm --config up/scenario.ini -o log.csv
check 'tracks of a log of directions are those of the file' cmp up.csv log.csv
check 'and there are some' grep -q confirmed log.csv
# the truth is at 3350 m, climbing by 5 m/s
run initiate up/bearings.csv --config up/scenario.ini
check 'initiate: heights of elevations' awk -F, \
    'NR > 1 && $11 > 3300 && $11 < 3400 && $12 > 3 && $12 < 7 { n++ } END { exit n != 1 }' stdout
run initiate passive-two/bearings.csv
check 'and none of bearings alone' \
    awk -F, 'NR > 1 && $11 $12 != "" { exit 1 } END { exit NR < 2 }' stdout
check 'runs differ' bash -c '! cmp -s runs/run-0000/bearings.csv runs/run-0001/bearings.csv'

# ---- good files ----
takes() { # name, text as for printf, options...
    # shellcheck disable=SC2059
    printf "$2" >good.csv
    run plot scans good.csv -o good.svg "${@:3}"
    check "$1" exits 0
}

header='t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad\n'
takes 'one sensor alone, which track and initiate refuse' "${header}0,1,0,0,0.5\n1,1,0,0,1\n"
takes 'two sensors' "${header}0,1,0,0,0.5\n0,2,100,0,1\n"
takes 'pi and -pi' "${header}0,1,0,0,3.14159265\n0,2,100,0,-3.14159265\n"
takes 'scans that saw nothing' "${header}0,1,0,0,\n0,2,100,0,\n"
takes 'other columns, another order' \
    'bearing_rad,note,sensor_y_m,sensor_x_m,sensor_id,t_s\n1,a,0,0,1,0\n1,b,9,0,2,0\n'
takes 'all columns' \
    't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sigma_rad,sector_from_rad,sector_to_rad,'\
'snr_db\n0,1,0,0,1,0.01,-1,2,9\n0,2,9,0,1,,,,\n'
takes 'a place that is written in another way' "${header}0,1,0.10,0,1\n0,2,9,0,1\n1,1,0.1,-0,1\n"
takes 'sensors a metre apart' "${header}0,1,0,0,1\n0,2,1,0,1\n"
takes 'sensors in one place' "${header}0,1,0,0,1\n0,2,0,0,1\n"
takes 'a sensor that moves' "${header}0,1,0,0,1\n0,2,100,0,1\n1,1,0,0.5,1\n1,2,100,0,1\n"
takes 'a sensor that moves where it saw nothing' \
    "${header}0,1,0,0,1\n0,2,100,0,1\n1,1,7,0,\n1,2,100,0,\n"
takes 'sensors that change places' "${header}0,1,0,0,1\n0,2,9,0,1\n1,1,9,0,1\n1,2,0,0,1\n"
printf "${header}0,1,0,0,1\n1,1,0,0,1\n" >one.csv
printf "${header}0,2,0,9,1\n1,2,0,9,1\n" >two.csv
run plot scans one.csv two.csv -o good.svg
check 'a file a sensor' exits 0
printf "${header}2,2,9,9,1\n3,1,0,3,1\n" >later.csv
run plot scans one.csv later.csv -o good.svg
check 'a sensor that another file has elsewhere' exits 0

# ---- bad files ----
refused() { # pattern
    says 2 "rhotrack: $1" && [ ! -e out.svg ]
}

refuse() { # name, LINE: what (a pattern), text as for printf, options...
    # shellcheck disable=SC2059
    printf "$3" >bad.csv
    run plot scans bad.csv -o out.svg "${@:4}"
    check "$1" refused "bad.csv:$2"
}

good="${header}0,1,0,0,1\n0,2,100,0,1\n"
refuse 'no bearing that is believed' '4: bearing_rad -2e6 is outside *' "${good}1,1,0,0,-2e6\n"
refuse 'a bearing that is no number' "2: bearing_rad 'north' is not a number" \
    "${header}0,1,0,0,north\n"
refuse 'a bearing NaN' "2: bearing_rad 'nan' is not finite" "${header}0,1,0,0,nan\n"
refuse 'no time' '2: t_s is empty' "${header},1,0,0,1\n"
refuse 'a time that is no number' "2: t_s 'noon' is not a number" "${header}noon,1,0,0,1\n"
refuse 'a sensor that is no number' "2: sensor_id '!A' is not an integer" "${header}0,!A,0,0,1\n"
refuse 'no sensor' '2: sensor_id is empty' "${header}0,,0,0,1\n"
refuse 'no place' '2: sensor_x_m is empty' "${header}0,1,,0,1\n"
refuse 'half a place' '2: sensor_y_m is empty' "${header}0,1,0,,1\n"
refuse 'a place beyond the limit' '2: sensor_x_m 3000000 is outside -2000000 .. 2000000' \
    "${header}0,1,3000000,0,1\n"
refuse 'a place NaN' "2: sensor_y_m 'nan' is not finite" "${header}0,1,0,nan,1\n"
refuse 'time that goes back' '4: time decreases from 0.000000 s to -1.000000 s' \
    "${good}-1,1,0,0,1\n"
refuse 'time that goes back, in a row without bearing' '4: time decreases *' "${good}-1,1,0,0,\n"
for place in 101,0 100,0.5; do
    refuse "a scan from two places: 100,0 and $place" \
        "4: the sensor's place differs from that of the scan's first row" "${good}0,2,$place,1\n"
done
refuse 'a scan from two places, in a row without bearing' "4: the sensor's place differs *" \
    "${good}0,2,101,0,\n"
for number in $(seq 1 65); do echo "0,$number,0,${number}00,1"; done >many
refuse 'more sensors than 64' '66: sensor 65 is beyond the limit of 64 sensors' \
    "$header$(cat many)\n"
for sigma in 0 -1 0.6 1e-7; do
    refuse "sigma_rad $sigma" "2: sigma_rad $sigma is outside 9.99999997e-07 .. 0.5" \
        "t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sigma_rad\n0,1,0,0,1,$sigma\n"
done
refuse 'a sector that is not that of the scan' \
    "3: the sector differs from that of the scan's first row" \
    't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sector_from_rad,sector_to_rad\n'\
'0,1,0,0,1,-1,1\n0,1,0,0,1,-1,2\n'
refuse 'half a sector, in a row' '2: sector_to_rad is empty' \
    't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sector_from_rad,sector_to_rad\n0,1,0,0,1,-1,\n'
refuse 'half a sector, in the header' "1: no column 'sector_to_rad' beside 'sector_from_rad'" \
    't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sector_from_rad\n0,1,0,0,1,0\n'
high="${header%\\n},elevation_rad,sigma_elevation_rad,sensor_z_m\n"
refuse 'elevation beyond half a turn' '2: elevation_rad 3.2 is outside *' "${high}0,1,0,0,1,3.2,,\n"
refuse 'elevation without a bearing' '2: bearing_rad is empty' "${high}0,1,0,0,,1,,\n"
refuse 'no noise of elevations' '2: sigma_elevation_rad 0 is outside *' "${high}0,1,0,0,1,1,0,\n"
refuse 'a height NaN' "2: sensor_z_m 'nan' is not finite" "${high}0,1,0,0,1,1,,nan\n"
refuse 'a scan from two heights' "3: the sensor's place differs *" \
    "${high}0,1,0,0,1,1,,5\n0,1,0,0,1,1,,6\n"
refuse 'two units of elevation' "1: columns 'elevation_rad' and 'elevation_deg' exclude *" \
    "${high%\\n},elevation_deg\n0,1,0,0,1,1,,,1\n"
refuse 'snr_db that is no number' "2: snr_db 'loud' is not a number" \
    't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,snr_db\n0,1,0,0,1,loud\n'
refuse 'a short row' '4: short row: 4 cells, the header has 5' "${good}1,1,0,0\n"
for column in t_s sensor_id sensor_x_m sensor_y_m; do
    refuse "no column $column" "1: no column '$column'*" \
        "$(printf '%s' "$header" | sed "s/\(^\|,\)$column/\1other/")0,1,0,0,1\n"
done
refuse 'header alone' '1: no rows after the header' "$header"
refuse 'comments are lines too' '5: bearing_rad 4e6 is outside *' \
    "# one\n\n${header}# four\n0,1,0,0,4e6\n"
printf "${header}0,2,9,9,1\n1,1,0,3,1\n" >second.csv
run plot scans one.csv second.csv -o out.svg
check 'a scan that another file has from elsewhere' refused \
    'second.csv:3: sensor 1 has another scan at 1.000000 s: line 3 of one.csv'

# ---- parameters ----
run config --set sigma_rad=0.6
check 'sigma_rad beyond its range' says 2 '*sigma_rad 0.6 is outside 1e-06 .. 0.5 rad'
run config --set sensor.2.sigma_rad=0
check "a sensor's sigma_rad beyond its range" says 2 '*sigma_rad 0 is outside 1e-06 .. 0.5 rad'
run config
check 'sigma_rad and frame_tolerance_s have defaults' bash -c "
    grep -Eq '^sigma_rad +rad +0.00175 +1e-06 .. 0.5 +0.00175 +default' stdout &&
    grep -Eq '^frame_tolerance_s +s +0.05 ' stdout"

# ---- who takes no bearings ----
run initiate passive-two/bearings.csv --method iht
check 'a method of plots refuses them by name' says 2 \
    'rhotrack: passive-two/bearings.csv: contains bearings, but method iht takes plots; *'

# ---- initiation ----
# Each target has a track within a kilometre at the last scan, and there are no others.
are_found() { # tracks, truth
    awk -F, 'NR == FNR { if (FNR > 1) { x[$2] = $3; y[$2] = $4 } next }
        FNR > 1 {
            tracks++
            for (i in x) if (($3 - x[i])^2 + ($4 - y[i])^2 < 1e6) { found[i] = 1; $0 = "" }
        }
        END {
            for (i in x) { n++; m += found[i] }
            exit !(n > 0 && tracks == n && m == n)
        }' "$2" "$1"
}
for scenario in passive-two passive-three; do
    run initiate $scenario/bearings.csv --config $scenario/scenario.ini
    cp stdout found.csv
    check "$scenario: every target is found, and nothing else" are_found found.csv \
        $scenario/truth.csv
done
check 'columns' matches "$(head -n 1 found.csv)" \
    'track_id,t_s,x_m,y_m,vx_mps,vy_mps,rho_m,theta_rad,scans,score,z_m,vz_mps'
run initiate passive-three/bearings.csv --method passive --json
check 'JSON' json stdout '(
    (o["method"], o["scans"], o["sensors"], o["tracks"]) == ("passive", 8, 3, 2) and
    o["pairs"] - o["candidates"] == o["ghosts"] and
    o["peak_votes"] == sorted(o["peak_votes"], reverse=True))'
run initiate passive-two/bearings.csv --set scans=5
check 'the last scans' matches "$(cat stderr)" 'rhotrack: the last 5 of 8 *'
for range_m in 120000 500000; do
    run initiate passive-two/bearings.csv --set range_max_m=$range_m --json
    check "a range of $range_m m" json stdout 'o["tracks"] == 2'
    run track passive-two/bearings.csv --set range_max_m=$range_m --json -o tracks.csv
    check "in track as well: $range_m m" json stdout 'o["tracks_confirmed"] == 2'
done
for kind in parameter-space errors; do
    run plot "$kind" passive-two/bearings.csv passive-two/truth.csv -o out.svg
    check "plot $kind refuses bearings by name" refused \
        "plot $kind: bearings (column 'bearing_rad') are shown only by plot scans and plot tracks"
done

# ---- track ----
# evaluate says: every target is found, by a track of its own that never changes, and there is no
# other one. Tracks of the first few looks are uncertain by a kilometre.
are_tracked() { # truth, tracks
    run evaluate "$1" "$2" --json --set gospa_cutoff_m=2000
    exits 0 && json stdout '((o["targets_found"], o["tracks"], o["switches"],
        o["false_per_scan"]) == (o["targets"], o["targets"], 0, 0))'
}
for scenario in passive-two passive-three passive-clutter; do
    for seed in 3 4 5; do
        run simulate "$scenario" --set duration_s=200 --seed $seed -o long
        run track long/bearings.csv --config long/scenario.ini -o tracks.csv
        check "track $scenario, seed $seed: exit 0" exits 0
        check "track $scenario, seed $seed: all targets, nothing else" are_tracked long/truth.csv \
            tracks.csv
    done
done
check 'one line of summary' matches "$(run track long/bearings.csv -o tracks.csv; cat stderr)" \
    'rhotrack: 20 scans, * plots, 4 tracks confirmed; lost: 0 invalid, 0 stale, 0 no room; '\
'* us a scan, * at most'
# hides COMMAND INPUT OPTIONS...
hides() {
    run "$@" --set v_max_mps=300 -o turns.csv
    exits 0 && grep -q '^rhotrack: looks each 10 s hide turns: with accel_max_mps2=20 a target at '\
'v_max_mps=300 turns by 38 degrees ' stderr
}
does_not_hide() { ! hides "$@" && exits 0 && ! grep -q turn stderr; }
for command in track initiate; do
    check "$command: turns that were told are hidden" hides $command long/bearings.csv \
        --set accel_max_mps2=20
    check "$command: gentle turns are not" does_not_hide $command long/bearings.csv \
        --set accel_max_mps2=10
    check "$command: of turns that nobody told nothing is said" does_not_hide $command \
        long/bearings.csv
done
check 'tracks from the third frame on' matches "$(sed -n 2p tracks.csv | cut -d, -f1,3)" \
    '20.000000,confirmed'
run track long/bearings.csv --config long/scenario.ini --covariance -o tracks.csv
run evaluate long/truth.csv tracks.csv --json
check 'the covariance is plausible' json stdout '0.5 < o["nees"] < 4'
run track long/bearings.csv --config long/scenario.ini --json
check 'JSON: one object' is_json stdout
check 'JSON: frames, none misses a sensor' json stdout \
    '(o["scans"], o["frames"], o["frames_incomplete"]) == (20, 20, 0)'
check 'JSON: fates add up' json stdout \
    'o["fates"]["claimed"] > 60 and sum(o["fates"].values()) == o["plots"]'
check 'JSON: what was held' json stdout \
    '4 <= o["counters"]["plots_initiated"] <= o["fates"]["held"]'
# a pool of 6 000 hypotheses of some 400 bytes, and 2 000 tracks; with the initiator of plots it
# were 7 million
check 'JSON: the objects in use' json stdout '2400000 < o["state_bytes"] < 6200000'
awk -F, '!($1 == "150.000000" && $2 == 2)' long/bearings.csv >incomplete.csv
run track incomplete.csv --config long/scenario.ini -o tracks.csv
check 'a frame that misses a sensor is counted' matches "$(cat stderr)" \
    '* 0 no room, 1 frames miss a sensor; *'
check 'and harms no track' are_tracked long/truth.csv tracks.csv
awk -F, 'NR == 1 || $2 == 1' long/bearings.csv >one.csv
awk -F, 'NR == 1 || $2 == 2' long/bearings.csv >two.csv
run track long/bearings.csv -o tracks.csv
run track two.csv one.csv -o tracks2.csv
check 'a file a sensor gives the same' cmp tracks.csv tracks2.csv
{ cat long/bearings.csv; echo '200,1,0,-10000,4e6,21,'; } >skip.csv
run track skip.csv --keep-going -o tracks2.csv
check 'keep-going skips a bad row' matches "$(cat stderr)" '*, 1 bad rows skipped; *'
check 'and counts the others' cmp tracks.csv tracks2.csv

# ---- track: sensors that look and stand as they like ----
# Bearings of two targets every 10 s, of SENSORS: "NUMBER,X_M,Y_M,VX_MPS,VY_MPS,PHASE_S;...". All
# files have the same noise.
see() { # NAME, SENSORS
    awk -v name="$1" -v list="$2" 'function noise(  i, sum) {
            for (i = 0; i < 12; i++) sum += rand(); return sum - 6
        }
        BEGIN {
            srand(5)
            x[1] = 60000; y[1] = 15000; vx[1] = -200; vy[1] = -60
            x[2] = 50000; y[2] = -25000; vx[2] = -120; vy[2] = 150
            count = split(list, sensors, ";")
            print "t_s,target_id,x_m,y_m" >(name ".truth.csv")
            print "t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad" >(name ".csv")
            for (k = 0; k <= 40; k++) for (i = 1; i <= 2; i++)
                printf "%d,%d,%d,%d\n", 5 * k, i, x[i] + 5 * k * vx[i],
                    y[i] + 5 * k * vy[i] >(name ".truth.csv")
            for (k = 0; k < 20; k++) for (s = 1; s <= count; s++) {
                split(sensors[s], at, ",")
                t = 10 * k + at[6]; px = at[2] + t * at[4]; py = at[3] + t * at[5]
                for (i = 1; i <= 2; i++) {
                    bearing = atan2(y[i] + t * vy[i] - py, x[i] + t * vx[i] - px)
                    printf "%.1f,%d,%.2f,%.2f,%.7f\n", t, at[1], px, py,
                        bearing + 0.00175 * noise() >(name ".csv")
                }
            }
        }'
    run track "$1.csv" --set v_max_mps=450 --set accel_max_mps2=5 -o "$1.tracks.csv"
    check "$1: exit 0" exits 0
}
error_of() { # NAME
    run evaluate "$1.truth.csv" "$1.tracks.csv" --json
    python3 -c 'import json; print(round(json.load(open("stdout"))["rmse_m"] or 1e9))'
}
is_as_good_as() { # NAME, PERCENT of the error of `together`
    are_tracked "$1.truth.csv" "$1.tracks.csv" || return
    echo "error $(error_of "$1") m, of sensors that look together $(error_of together) m"
    [ "$(error_of "$1")" -lt $(($(error_of together) * $2 / 100)) ]
}
see together '1,0,-10000,0,0,0;2,0,10000,0,0,0'
check 'sensors that look together' is_as_good_as together 101
see apart '1,0,-10000,0,0,0;2,0,10000,0,0,1'
check 'sensors that look 1 s apart' is_as_good_as apart 125
run track apart.csv -o again.csv
check 'and say nothing of their frames' says 0 \
    'rhotrack: 40 scans, 80 plots, 2 tracks confirmed; lost: 0 invalid, 0 stale, 0 no room; *'
check 'whose tracks start as early' matches "$(sed -n 2p apart.tracks.csv | cut -d, -f1)" \
    "$(sed -n 2p together.tracks.csv | cut -d, -f1 | cut -c 1)?.000000"
run initiate apart.csv --json
check 'and that initiate finds' json stdout '(o["sensors"], o["tracks"]) == (2, 2)'
check 'in as many looks of each' matches "$(cat stderr)" \
    'rhotrack: the last 16 of 40 frames are used'
see turns '1,0,-10000,0,0,0;2,0,10000,0,0,5'
check 'sensors that take turns' is_as_good_as turns 125
see moving '1,0,-10000,20,30,0;2,0,10000,30,-20,0'
check 'sensors that move' is_as_good_as moving 125
see moving-turns '1,0,-10000,20,30,0;2,0,10000,30,-20,4'
check 'sensors that move and take turns' is_as_good_as moving-turns 140
see pair '1,0,-10000,0,0,0;2,0,10000,0,0,0;3,10000,0,0,0,0;4,10000,0,0,0,0'
check 'two sensors at one place beside two others' is_as_good_as pair 100
see five '1,0,-10000,0,0,0;2,0,10000,0,0,0;3,10000,0,0,0,0;4,-10000,0,0,0,0;5,5000,-20000,0,0,0'
check 'five sensors' is_as_good_as five 75
run initiate five.csv --json
check 'and initiate' json stdout '(o["sensors"], o["tracks"]) == (5, 2)'
see one-place '1,0,0,0,0,0;2,0,0,0,0,0'
check 'one place alone gives no track' matches "$(wc -l <one-place.tracks.csv)" 1
run initiate one-place.csv --json
check 'and initiate finds none' json stdout '(o["sensors"], o["tracks"]) == (2, 0)'
run track one-place.csv pair.csv
check 'a scan that two files state' says 2 'rhotrack: pair.csv:2: sensor 1 has another scan at *'
awk -F, -v OFS=, 'NR == 13 { $3 += 1 } { print }' together.csv >torn.csv
run track torn.csv -o torn.tracks.csv
check 'a scan whose rows state two places' says 2 \
    "rhotrack: torn.csv:13: the sensor's place differs from that of the scan's first row"
run track torn.csv --keep-going --json -o torn.tracks.csv
check 'of which one is left out' json stdout '(o["plots"], o["tracks_confirmed"]) == (79, 2)'

# ---- track: a radar's plots and bearings ----
# Two targets for 20 scans, 10 s apart, of a radar with 300 m of noise, and 5 s later of two passive
# sensors with 1.75 mrad.
awk 'function noise(  i, sum) { for (i = 0; i < 12; i++) sum += rand(); return sum - 6 }
    BEGIN {
        srand(11); pi = atan2(0, -1)
        x[1] = 60000; y[1] = 15000; vx[1] = -200; vy[1] = -60
        x[2] = 50000; y[2] = -25000; vx[2] = -120; vy[2] = 150
        print "t_s,target_id,x_m,y_m" >"truth.csv"
        print "t_s,sensor_id,x_m,y_m" >"plots.csv"
        print "t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad" >"bearings.csv"
        for (k = 0; k < 40; k++)
            for (i = 1; i <= 2; i++) {
                t = 5 * k; px = x[i] + vx[i] * t; py = y[i] + vy[i] * t
                printf "%d,%d,%.2f,%.2f\n", t, i, px, py >"truth.csv"
                if (k % 2 == 0)
                    printf "%d,9,%.2f,%.2f\n", t, px + 300 * noise(),
                        py + 300 * noise() >"plots.csv"
                else for (s = 1; s <= 2; s++)
                    printf "%d,%d,0,%d,%.7f\n", t, s, 20000 * s - 30000,
                        atan2(py - 20000 * s + 30000, px) + 0.00175 * noise() >"bearings.csv"
            }
    }'
given='--set sigma_m=300 --set v_max_mps=450 --set accel_max_mps2=5 --set min_scans=5'
# shellcheck disable=SC2086 # words on purpose
for files in 'plots.csv' 'bearings.csv' 'plots.csv bearings.csv'; do
    run track $files $given -o tracks.csv
    check "$files: exit 0" exits 0
    check "$files: one track a target" are_tracked truth.csv tracks.csv
done
# shellcheck disable=SC2086
run track plots.csv bearings.csv $given --json -o both.csv
check 'both: scans and frames' json stdout '(o["scans"], o["frames"], o["plots"]) == (40, 20, 120)'
check 'both: two tracks in all' json stdout \
    '(o["tracks_confirmed"], o["counters"]["tracks_started"]) == (2, 2)'
check 'both: most plots and bearings are claimed' json stdout 'o["fates"]["claimed"] > 90'
check 'both: the radar and the passive sensors' matches \
    "$(cut -d, -f17 both.csv | tail -n 8 | sort -u | tr '\n' ' ')" '2 9 '
# shellcheck disable=SC2086
run track bearings.csv plots.csv $given
check 'both: the order of the files does not matter' writes_same_as both.csv
is_better() { # the last 50 s are nearer to the truth than with the radar alone, by a third
    error() {
        awk -F, 'NR == FNR { x[$1 + 0, $2] = $3; y[$1 + 0, $2] = $4; next }
            FNR > 1 && $1 >= 150 {
                least = 1e18
                for (i = 1; i <= 2; i++) {
                    d = ($4 - x[$1 + 0, i])^2 + ($5 - y[$1 + 0, i])^2
                    if (d < least) least = d
                }
                sum += least; n++
            }
            END { printf "%d\n", sqrt(sum / n) }' truth.csv "$1"
    }
    echo "with both $(error both.csv) m, with the radar $(error radar.csv) m"
    [ "$(error both.csv)" -lt $(($(error radar.csv) * 7 / 10)) ]
}
# shellcheck disable=SC2086
run track plots.csv $given -o radar.csv
check 'both: better than the radar alone' is_better
awk -F, 'NR == 1 || $2 == 1' bearings.csv >one.csv
# shellcheck disable=SC2086
run track plots.csv one.csv $given -o tracks.csv
check 'one passive sensor may be alone beside a radar' exits 0
check 'and its bearings find no tracks of their own' are_tracked truth.csv tracks.csv
run track one.csv
check 'but not alone' says 2 'rhotrack: one.csv:2: sensor 1 is the only sensor: positions need *'

# ---- more targets than there is room for: it is said, and few tracks are false ----
crowd() { # targets
    cat >crowd.json <<EOF
{"version": 1, "duration_s": 400, "settings": {"v_max_mps": 300, "accel_max_mps2": 5},
 "area": [-60000, 60000, -60000, 60000], "passive": [
  {"at_m": [50000, 0], "interval_s": 10, "sigma_rad": 0.002, "pd": 0.9, "range_m": [0, 150000]},
  {"at_m": [-25000, 43300], "interval_s": 10, "sigma_rad": 0.002, "pd": 0.9,
   "range_m": [0, 150000]},
  {"at_m": [-25000, -43300], "interval_s": 10, "sigma_rad": 0.002, "pd": 0.9,
   "range_m": [0, 150000]}],
 "targets": [{"count": $1, "box_m": [-30000, 30000, -30000, 30000], "speed_mps": [100, 250]}]}
EOF
    run simulate crowd.json -o crowd
    run track crowd/bearings.csv -o tracks.csv
}
crowd 40
check 'forty targets: bearings and crossings without room are said' says 0 \
    'rhotrack: * [1-9]* tracks confirmed; * [1-9]* no room, candidates of tracks beyond * [1-9]*'
run evaluate crowd/truth.csv tracks.csv --json
check 'and most are tracked, with few false tracks' json stdout \
    'o["completeness"] > 0.6 and o["false_per_scan"] < 4'
crowd 8
check 'eight targets: none is without room' says 0 \
    'rhotrack: * [1-9]* tracks confirmed; * 0 no room; *'

# ---- plot ----
picture() { # what it is, FILES and options...
    run plot scans "${@:2}" -o picture.svg
    check "plot scans: $1" exits 0
    check "plot scans: $1: well-formed" python3 -c \
        'import xml.dom.minidom as m; m.parse("picture.svg")'
}
picture 'bearings and truth' passive-three/bearings.csv passive-three/truth.csv
for number in 1 2 3; do
    check "plot scans names sensor $number" grep -q "sensor $number" picture.svg
done
check 'and the truth' grep -q truth picture.svg
run track passive-three/bearings.csv -o under.csv
run plot tracks passive-three/bearings.csv under.csv -o picture.svg
check 'plot tracks has bearings under their tracks' sh -c \
    "grep -q 'sensor 3' picture.svg && grep -q 'track 1' picture.svg &&
    grep -q '48 bearings' picture.svg"
picture 'bearings alone' passive-two/bearings.csv
cp picture.svg far.svg
picture 'bearings alone, as far as the sensors see' passive-two/bearings.csv --set range_max_m=30000
check 'which is another picture' bash -c '! cmp -s far.svg picture.svg'
picture "one sensor's own range" passive-two/bearings.csv --set sensor.1.range_max_m=30000
check 'which is another picture' bash -c '! cmp -s far.svg picture.svg'
picture 'sensors that saw nothing' blind/bearings.csv blind/truth.csv

finish
