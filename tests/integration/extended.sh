#!/bin/bash
# SPDX-License-Identifier: MIT
# Targets that give several plots a scan: one track each where the longest is said, with its extent.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

run simulate trucks --seed 3 --set duration_s=20 -o road
check 'the scene says the longest body' grep -qx 'body_max_m = 15' road/scenario.ini
check 'the truth has sizes' grep -q '^[0-9.]*,0,.*,12.000,2.500$' road/truth.csv
run track road/plots.csv --config road/scenario.ini --json -o told.csv
check 'no plot is lost' json stdout 'o["fates"]["no_room"] == 0 and o["partial_steps"] == 0'
check 'the columns are behind the others' sh -c \
    "head -1 told.csv | grep -q 'sensor_id,plot,length_m,width_m,heading_rad,sigma_length_m'"
run evaluate road/truth.csv told.csv --set gospa_cutoff_m=3 --json
check 'each vehicle has one track' json stdout \
    'o["switches"] == 0 and o["completeness"] > 0.97 and o["tracks"] <= o["targets"] + 2'
grep -v body_max_m road/scenario.ini >silent.ini
run track road/plots.csv --config silent.ini -o silent.csv
run evaluate road/truth.csv silent.csv --set gospa_cutoff_m=3 --json
check 'where nothing is said each has several' json stdout 'o["tracks"] > 3 * o["targets"]'
check 'and no columns more' sh -c "head -1 silent.csv | grep -q 'sensor_id,plot\$'"
run track road/plots.csv --config silent.ini --set body_max_m=15 -o option.csv
check 'an option says it' cmp told.csv option.csv
check 'a truck is 12 m long' awk -F, '
    $1 > 6 && $1 < 8 && $2 == 1 { n++; bad += $19 < 10.5 || $19 > 13.5 || $20 < 1.5 || $20 > 4 }
    END { exit n < 20 || bad > 0 }' told.csv

# ---- messages: of each step, in logs and of a node ----
count() { grep -aoF "$2" "$1" | wc -l; }
run track road/plots.csv --config road/scenario.ini -o told.lcm
steps=$(tail -n +2 told.csv | cut -d, -f1 | uniq | wc -l)
check 'a log has the bodies of each step' test "$(count told.lcm RHO_BODIES)" -ge "$steps"
run convert road/plots.csv road.lcm --config road/scenario.ini
run node --lcm "file://$PWD/road.lcm?speed=0" --config road/scenario.ini --log told-live.lcm
check 'a node sends them' test \
    "$(count told-live.lcm RHO_BODIES)" -eq "$(count told.lcm RHO_BODIES)"
run node --lcm "file://$PWD/road.lcm?speed=0" --config silent.ini --log silent.lcm
check 'and none where nothing is said' test "$(count silent.lcm RHO_BODIES)" -eq 0

# ---- bad settings ----
for bad in body_max_m=-1 body_max_m=x body_max_m=1e9; do
    run track road/plots.csv --set $bad
    check "$bad" says 2 "rhotrack: --set $bad: *"
done
body='targets.0.body={"length_m": 2, "width_m": 3, "scatterers": 2}'
run simulate trucks --set "$body" -o none
check 'a body wider than long' says 2 \
    'rhotrack: trucks:*: targets?0?.body.width_m: is more than length_m'
run simulate trucks --set 'targets.0.body={"length_m": 2, "width_m": 1}' -o none
check 'no scatterers' says 2 'rhotrack: trucks:*: targets?0?.body*scatterers*'

finish
