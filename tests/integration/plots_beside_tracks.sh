#!/bin/bash
# SPDX-License-Identifier: MIT
# body_max_m where nobody says it: found by track and calibrate of people, cars, trucks and ships,
# of no targets that give one plot each.
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

asks() { grep -q 'plots beside each track' stderr; }
asks_not() { exits 0 && ! asks; }

# ---- bodies ----
# body NAME SEED LEAST MOST TRACKS_MOST: the length found, and tracks a target with what is found
body() {
    local name="$1, seed $2"
    run simulate "$1" --seed "$2" -o scene
    grep -v body_max_m scene/scenario.ini >unsaid.ini
    run track scene/plots.csv --config unsaid.ini --json -o unsaid.csv
    cp stdout unsaid.json
    check "$name: track finds the length" json unsaid.json \
        "$3 <= o['found_body']['body_max_m'] <= $4 and o['found_body']['plots'] > 1"
    check "$name: and asks for it" grep -Eq \
        '^rhotrack: [0-9.]+ plots beside each track within [0-9.]+ m: body_max_m=[0-9.]+\?$' stderr
    run calibrate scene/plots.csv --config unsaid.ini --json -o found.ini
    cp stdout found.json
    check "$name: calibrate finds the same" python3 -c 'import json
same = [json.load(open(name + ".json"))["found_body"] for name in ("unsaid", "found")]
assert same[0] == same[1], same
assert "body_max_m = %g\n" % same[0]["body_max_m"] in open("found.ini").read()'
    run track scene/plots.csv --config unsaid.ini --config found.ini -o found.csv
    check "$name: nothing is asked any more" asks_not
    run evaluate scene/truth.csv found.csv --set "gospa_cutoff_m=$3" --json
    check "$name: a track a target" json stdout \
        "o['completeness'] > .95 and o['tracks'] <= $5 * o['targets']"
}
for seed in 1 2; do
    body people $seed 0.6 1.2 2
    body cars-in-clouds $seed 4 8 1.2
    check 'clutter is what no car gave' json found.json \
        '2 < o["radars"][0]["clutter_plots"]["value"] < 8'
    body trucks $seed 10 22.5 1.2
    body ships-250m $seed 200 450 1.2
done
check 'a radar: the noise is not known, and stays as stated' bash -c \
    'grep -A1 "^# as stated" found.ini | grep -q "^sigma_range_m = 5$"'
run calibrate scene/plots.csv --config scene/scenario.ini -o told.ini
check 'a run with a length that was told' exits 0
check 'a length that was told is not looked for' bash -c '! grep -q body_max_m told.ini'
check 'noise neither' grep -q '^radar 1, range noise: not known: the extent of targets' stdout
run track scene/plots.csv --config scene/scenario.ini --json
check 'track runs with it, too' exits 0
check '... and does not look for it' bash -c '! grep -q found_body stdout'

# ---- targets of one plot each ----
# alone NAME FILE: tracks, and no body
alone() {
    run simulate "$2" -o scene
    run track scene/plots.csv --config scene/scenario.ini --json
    check "$1: nothing is asked" asks_not
    check "$1: of two tracks or more" json stdout \
        'o["tracks_confirmed"] >= 2 and "found_body" not in o'
    run calibrate scene/plots.csv --config scene/scenario.ini -o found.ini
    check "$1: nothing is written" bash -c 'test -s found.ini && ! grep -q body_max_m found.ini'
}
# rows NUMBER STEP_X_M STEP_Y_M SPEED_MPS DURATION_S RADAR: targets of one velocity, in a row
rows() {
    python3 - "$@" >rows.json <<'END'
import json, sys
number, x_m, y_m, speed_mps, duration_s = map(float, sys.argv[1:6])
print(json.dumps({
    "version": 1, "text": "targets that move together", "duration_s": duration_s,
    "settings": {"v_max_mps": 10 * speed_mps, "accel_max_mps2": speed_mps / 2},
    "radars": [json.loads(sys.argv[6])],
    "targets": [{"at_m": [4 * speed_mps + i * x_m, 4 * speed_mps + i * y_m],
                 "speed_mps": speed_mps, "heading_rad": 0} for i in range(int(number))],
    "clutter": [{"kind": "uniform", "plots": 10}]}))
END
}
road='{"interval_s": 0.1, "range_m": [5, 500], "sigma_range_m": 0.2, "sigma_azimuth_rad": 0.01}'
sky='{"turn_s": 4, "range_m": [500, 90000], "sigma_range_m": 30, "sigma_azimuth_rad": 0.003}'
rows 8 11 0 5 40 "$road"
alone 'a convoy of eight cars, 11 m apart' rows.json
rows 2 0 500 150 400 "$sky"
alone 'two aircraft, 500 m apart' rows.json
rows 4 -300 500 150 400 "$sky"
alone 'four aircraft in echelon' rows.json
alone 'a queue at a traffic light' traffic-light
alone 'aircraft among towers' towers
alone 'boats among waves' starts-among-waves
finish
