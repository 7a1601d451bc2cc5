#!/bin/bash
# SPDX-License-Identifier: MIT
# Targets that stand: with standing=targets those that never moved are tracks; with clutter, the
# default, the summary counts them, and what came in and stands is one track all the same.
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

follow() { # scene, cut-off of a pair in m, who stands
    local seed
    for seed in 21 22 23 24; do
        run simulate "standing-$1" --seed "$seed" -o in
        run track in/plots.csv --config in/scenario.ini --json -o targets.csv
        check "$3: none is clutter, seed $seed" json stdout 'o["echoes_standing"] == 0'
        run evaluate in/truth.csv targets.csv --set "gospa_cutoff_m=$2" --json
        check "$3 are tracks, and come in as one" json stdout \
            'o["completeness"] > 0.97 and o["switches"] == 0'
        run track in/plots.csv --config in/scenario.ini --set standing=clutter --json -o clutter.csv
        check "$3: one is an echo" json stdout 'o["echoes_standing"] >= 1'
        check 'the summary says it' grep -Eq ', echoes that stand: [1-4];' stderr
        awk -F, 'NR == 1 || $2 == 1' in/truth.csv >moved.csv
        run evaluate moved.csv clutter.csv --set "gospa_cutoff_m=$2" --json
        check 'what came in stays one track' json stdout \
            'o["completeness"] > 0.97 and o["switches"] == 0'
    done
}
follow marine 300 'ships at anchor'
follow harbour 100 'ships at berth'
follow drones 100 'drones that hover'
follow queue 3 'cars in a queue'
follow room 1 'people who sit'
run track in/plots.csv --set standing=ships -o none.csv
check 'another word is refused' exits 2
check 'with the words there are' grep -q 'standing.*clutter|targets' stderr
finish
