#!/bin/bash
# SPDX-License-Identifier: MIT
# A guard rail that shows cars a second time: told, by a file or by an option, it has no tracks; and
# none once it is learned.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

run simulate guard-rail --seed 3 -o rail
check 'the scene tells the wall' grep -qx 'reflectors = 0 14 200 14' rail/scenario.ini
run track rail/plots.csv --config rail/scenario.ini --json -o told.csv
check 'plots of images are ghosts' json stdout 'o["fates"]["ghost"] > 300'
run evaluate rail/truth.csv told.csv --set gospa_cutoff_m=3 --json
check 'cars have one track each' json stdout \
    'o["switches"] == 0 and o["completeness"] > 0.97 and o["tracks"] <= 16'
grep -v reflectors rail/scenario.ini >silent.ini
run track rail/plots.csv --config silent.ini --set learn_reflectors=0 --json -o silent.csv
check 'nothing is learned where it is switched off' json stdout '"learned_reflectors" not in o'
run evaluate rail/truth.csv silent.csv --set gospa_cutoff_m=3 --json
check 'where nothing is said images have tracks' json stdout \
    'o["tracks"] > 17 and o["false_per_scan"] > 0.2'
run track rail/plots.csv --config silent.ini --json -o learned.csv
check 'nobody told, the rail is learned' json stdout 'len(o["learned_reflectors"]) == 1 and all(
    abs(y - 14) < 0.5 for y in (o["learned_reflectors"][0]["from_m"][1],
                                o["learned_reflectors"][0]["to_m"][1]))'
check 'the summary says it' grep -q ', a wall is learned: ' stderr
after() { # file: rows of confirmed tracks behind the rail, no car's, in the last 15 s
    awk -F, '$1 > 26 && $3 == "confirmed" && $5 > 14.5 && !($5 > 20 && $5 < 22) {n++}
        END {print n + 0}' "$1"
}
check 'images have tracks' test "$(after silent.csv)" -gt 8
check 'and none once the rail is learned' test "$(after learned.csv)" -le 3
run convert rail/plots.csv rail.lcm --config silent.ini
run node --lcm "file://$PWD/rail.lcm?speed=0" --config silent.ini --snapshot rail.snapshot
check 'a node says so when it is learned' grep -q \
    '^[0-9T:.-]*Z rhotrack: a wall is learned: ' stderr
run node --lcm "file://$PWD/rail.lcm?speed=0" --config silent.ini --snapshot rail.snapshot
check 'and knows it after a restart' grep -q 'a wall is learned: ' stderr
run track rail/plots.csv --config silent.ini --set 'reflectors=0 14 200 14' --json -o option.csv
check 'what is told is not learned' json stdout '"learned_reflectors" not in o'
check 'an option says it' cmp told.csv option.csv
run config --set 'reflectors=0 14 200 14, -5 1e2 5 100.5'
check 'config shows it' grep -q '^reflectors .*0 14 200 14, -5 100 5 100.5' stdout

# ---- bad settings ----
refuse() { # value, message
    run track rail/plots.csv --set "reflectors=$1"
    check "reflectors=$1" says 2 "rhotrack: --set reflectors=$1: reflectors$2"
}
refuse '0 14 200' " '' is not a number"
refuse '0 14 200 x' " 'x' is not a number"
refuse '0 14 200 14 3' ": x y x y of a wall, with commas between walls, not '3'"
refuse '0 14 0.5 14' ': wall 1 is shorter than 1 m'
refuse '0 14 9e9 14' ' 9e9 is outside *'
many=$(printf '0 14 200 14, %.0s' {1..17})
run track rail/plots.csv --set "reflectors=$many"
check 'too many' says 2 '*reflectors: more than 16 walls'
run simulate guard-rail --set 'reflectors.0.to_m=[0.5, 14]' -o none
check 'of a scene' says 2 'rhotrack: guard-rail:*: reflectors?0?.to_m: is less than 1 m from from_m'

finish
