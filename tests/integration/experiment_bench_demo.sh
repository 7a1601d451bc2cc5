#!/bin/bash
# SPDX-License-Identifier: MIT
#
# simulate, evaluate, plot, experiment, bench and the demo, as a user types them. Program in
# $RHOTRACK. Runs beside others.
# shellcheck source=tests/integration/checks.bash
root=$(realpath "$(dirname "$0")/../..")
. "$(dirname "$0")/checks.bash"
RHOTRACK=$program
status=0
: >stderr

# expect_exit CODE NAME PROGRAM ARGUMENT...
expect_exit() {
    local code=$1 name=$2
    shift 3
    run "$@"
    check "$name" exits "$code"
}

# --- simulate
for scenario in crossing clutter air-traffic; do
    check "simulate $scenario" "$RHOTRACK" simulate "$scenario" --seed 3 -o "$folder/$scenario"
    check "track $scenario with its scenario.ini" "$RHOTRACK" track "$folder/$scenario/plots.csv" \
        --config "$folder/$scenario/scenario.ini" -o "$folder/$scenario/tracks.csv"
done
"$RHOTRACK" simulate clutter --seed 3 -o "$folder/again"
"$RHOTRACK" simulate clutter --seed 4 -o "$folder/otherwise"
check "the same seed gives the same plots" cmp -s "$folder/clutter/plots.csv" \
    "$folder/again/plots.csv"
check "another seed gives others" sh -c \
    "! cmp -s '$folder/clutter/plots.csv' '$folder/otherwise/plots.csv'"
"$RHOTRACK" simulate crossing --seed 3 --runs 3 -o "$folder/runs"
check "--runs makes a folder a run" test -s "$folder/runs/run-0002/plots.csv"
check "runs differ" sh -c \
    "! cmp -s '$folder/runs/run-0000/plots.csv' '$folder/runs/run-0001/plots.csv'"
expect_exit 2 "an unknown scenario" "$RHOTRACK" simulate nothing -o "$folder/nothing"

# the table in the program and the one in the tests are the same
"$RHOTRACK" simulate radar --seed 1 --set clutter=[] -o "$folder/table"
check "the program's real plots are the vector file's" sh -c "
    cut -d, -f1,3,4 '$folder/table/truth.csv' |
        awk -F, 'NR > 1 { printf \"%d %d %d\\n\", \$1, \$2, \$3 }' | sort >'$folder/a'
    awk -F, '/^[0-9]/ { printf \"%d %d %d\\n\", \$1, \$3, \$4 }' \
        $root/tests/vectors/radar-table3.csv | sort >'$folder/b'
    test \$(wc -l <'$folder/a') -eq 21 && cmp -s '$folder/a' '$folder/b'"

# --- evaluate: two targets over three scans; track 1 is 30 m off, lost to track 2 at the end; track
# 9 is nobody's
cat >"$folder/truth.csv" <<CSV
t_s,target_id,x_m,y_m,vx_mps,vy_mps
0,0,0,0,10,0
0,1,5000,0,0,0
10,0,100,0,10,0
10,1,5000,0,0,0
20,0,200,0,10,0
20,1,5000,0,0,0
CSV
cat >"$folder/tracks.csv" <<CSV
t_s,track_id,status,x_m,y_m,vx_mps,vy_mps
0,1,tentative,0,30,10,0
10,1,confirmed,100,30,10,0
10,9,coasting,90000,0,0,0
20.0005,2,confirmed,200,40,10,3
20,3,confirmed,5000,0,0,0
CSV
evaluate() { "$RHOTRACK" evaluate "$folder/truth.csv" "$folder/tracks.csv" --json \
    --set gospa_cutoff_m=1000; }
value() { evaluate | python3 -c "import json, sys; print(round(json.load(sys.stdin)['$1'], 4))"; }
is() { check "evaluate: $1 is $2" test "$(value "$1")" = "$2"; }
is targets 2
is targets_found 2
is completeness 0.5
is switches 1
is gospa_missed 1
is gospa_false 0.3333
is false_per_hour 180
is delay_scans 1.5
is rmse_m 28.8675
is rmse_mps 1.7321
# squares: 10^6 (two missed); 900 + 10^6 (one missed, one false); 1600
is gospa_m 817.0067
is gospa_localisation_m 28.8675
# two sensors look at 10 s: the second row of track 1 is what counts, whatever stands between
sed -i '/^10,1,/i 10,1,confirmed,400,900,10,0' "$folder/tracks.csv"
is gospa_false 0.3333
is rmse_m 28.8675
is gospa_m 817.0067
printf 't_s,track_id,x_m,y_m\n' >"$folder/none.csv"
check "no track at all is a result" sh -c \
    "'$RHOTRACK' evaluate '$folder/truth.csv' '$folder/none.csv' --json |
    grep -q '\"completeness\":.*0'"
printf 't_s,track_id,x_m,y_m\n99,1,0,0\n' >"$folder/odd.csv"
expect_exit 2 "no time within the truth's" "$RHOTRACK" evaluate "$folder/truth.csv" \
    "$folder/odd.csv"
check "and it names file and line" sh -c \
    "'$RHOTRACK' evaluate '$folder/truth.csv' '$folder/odd.csv' 2>&1 | grep -q 'odd.csv:2: '"

# --- plot
crossing="$folder/crossing"
for kind in scans tracks parameter-space errors; do
    check "plot $kind" "$RHOTRACK" plot "$kind" "$crossing/plots.csv" "$crossing/truth.csv" \
        "$crossing/tracks.csv" \
        -o "$folder/$kind.svg"
    check "plot $kind is well-formed" python3 -c \
        "import xml.dom.minidom as m; m.parse('$folder/$kind.svg')"
done
expect_exit 2 "an unknown picture" "$RHOTRACK" plot nothing "$crossing/plots.csv" -o \
    "$folder/nothing.svg"
expect_exit 2 "a picture of a file that is not there" "$RHOTRACK" plot scans "$folder/nowhere.csv" \
    -o "$folder/nothing.svg"
check "and no picture is left" sh -c "! ls '$folder'/nothing.svg* 2>/dev/null"

# --- experiment: the lab's script of that name
run experiment rotating --help
check 'experiment calls the script' grep -q '^usage: rotating.py .*--runs' stdout
run experiment nothing
check 'an unknown experiment names all there are' says 2 \
    '*nothing*air-traffic*false-alarms*initiation*maneuver*notch*'\
'papers-initiation*passive*polar*real-skies*'
run experiment
check 'and so does none' exits 2
mkdir -p elsewhere/bin && cp "$RHOTRACK" elsewhere/bin/rhotrack
status=0
elsewhere/bin/rhotrack experiment two-radars >stdout 2>stderr || status=$?
check 'without its sources the program says where the script is' says 1 \
    'rhotrack: experiment two-radars is the script tools/lab/two_radars.py of the source '\
'(No such file or directory)'

# --- bench, demo
check "bench kalman --json is JSON" sh -c \
    "'$RHOTRACK' bench kalman --json | python3 -m json.tool >/dev/null"
check "bench initiate" "$RHOTRACK" bench initiate
check "bench hough --json is JSON" sh -c \
    "'$RHOTRACK' bench hough --json | python3 -m json.tool >/dev/null"
check "bench passive --json is JSON" sh -c \
    "'$RHOTRACK' bench passive --json | python3 -m json.tool >/dev/null"
expect_exit 2 "an unknown bench" "$RHOTRACK" bench nothing
RHOTRACK="$RHOTRACK" "$root/tools/demo.sh" "$folder/demo" >"$folder/demo.txt" 2>/dev/null
check "the demo tracks all three aircraft and nothing else" grep -q \
    '^3 of 3 targets tracked, 0 false tracks$' "$folder/demo.txt"
check "the demo's page is there" test -s "$folder/demo/index.html"
# scene, turns, plots, 2 of 2, share of time, switches, error m, others a turn
check "both vessels of both harbour scenes are tracked nearly all the time, as themselves" awk '
    $1 == 2 || $1 == 16 {
        if (NF == 10 && $5 == "of") { n++; bad += $4 != 2 || $7 < 0.9 || $8 > 2 || $9 > 15 }
    }
    END { exit n != 2 || bad }' "$folder/demo.txt"
check "and the page shows the harbour" sh -c "
    grep -q 'harbour-2.svg' '$folder/demo/index.html' &&
    grep -q 'harbour-16.svg' '$folder/demo/index.html' &&
    test -s '$folder/demo/harbour-2.svg' && test -s '$folder/demo/harbour-16.svg'"
finish
