#!/bin/bash
# SPDX-License-Identifier: MIT
#
# `simulate air-traffic` and `formation` as files, and `track` with what they tell.
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

run simulate air-traffic -o sky --seed 3 --set targets.0.flights=20 --set duration_s=500 \
    --set radars.0.sigma_m=40 --set radars.0.pd=0.9 --set "radars.0.told={\"pd\":0.95}"
check "simulate air-traffic" exits 0
check "truth has as many rows a scan" sh -c "
    awk -F, 'NR > 1 { rows[\$1]++ }
        END { for (t in rows) if (rows[t] != 20) exit 1; exit NR != 1001 }' '$folder/sky/truth.csv'"
check "scenario.ini tells the assumed sigma and pd" sh -c "
    grep -qx 'sigma_m = 40' '$folder/sky/scenario.ini' &&
    grep -qx 'pd = 0.95' '$folder/sky/scenario.ini'"
run track sky/plots.csv --config sky/scenario.ini -o sky/tracks.csv
check "track with its scenario.ini" exits 0
check "tracks of aircraft that have gone have no rows" awk -F, '
    $3 == "tentative" && was_confirmed[$2] { exit 1 }
    { was_confirmed[$2] = $3 != "tentative" || was_confirmed[$2] }' sky/tracks.csv
run evaluate sky/truth.csv sky/tracks.csv --json
check "most aircraft have tracks" json stdout 'o["completeness"] > 0.85 and o["false_per_scan"] < 2'
run simulate air-traffic -o again --seed 3 --set targets.0.flights=20 --set duration_s=500 \
    --set radars.0.sigma_m=40 --set radars.0.pd=0.9 --set "radars.0.told={\"pd\":0.95}"
check "the same seed gives the same bytes" diff -r "$folder/sky/plots.csv" "$folder/again/plots.csv"
run simulate formation -o pair --set radars.0.resolution_m=500 --set clutter=[] --set radars.0.pd=1
check "those that fly together give one plot" sh -c "
    awk -F, 'NR > 1 && \$3 { rows[\$1]++ }
        END { for (t in rows) one += rows[t] == 1; exit one < 31 }' '$folder/pair/plots.csv'"
run simulate air-traffic -o bad --set targets.0.crossing_share=2
check "simulate refuses a share above 1" says 2 \
    'rhotrack: air-traffic:*: targets\[0\].crossing_share: 2 is outside 0 .. 1'
check "... and makes nothing" test ! -e "$folder/bad"
run simulate air-traffic -o bad --set targets.0.box_m=[0,9000,0,9000]
check "a box that no flight fits into" says 2 \
    "rhotrack: air-traffic: targets\[0\]: no flight of 400 s fits into box_m*"

finish
