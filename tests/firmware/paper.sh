#!/bin/bash
# SPDX-License-Identifier: MIT
# The papers' system as a node (tools/firmware/nodes/paper.h) on a Cortex-M4F: the bytes of the same
# node on this machine, the tracks of `rhotrack track --pipeline paper`.
# shellcheck source=tests/firmware/record_and_replay_logs.bash
. "$(dirname "$0")/record_and_replay_logs.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/../integration/checks.bash"

stack_most=4096
check 'a pop-up target is recorded' record popup popup plots --set radars.0.sigma_mps=1
check 'three passive sensors are' record passive passive-three bearings --set duration_s=200

plays() { # record, settings of the node...
    local name=$1 stack
    shift
    "$images/replay-paper" "$name.lcm" "$name-here.lcm" "$@" &&
        "$root/tools/firmware/emulate.sh" m4 "$images/m4/nodes/paper-replay.elf" "$name.lcm" \
            "$name-m4.lcm" "$@" >said && cat said &&
        cmp "$name-here.lcm" "$name-m4.lcm" &&
        stack=$(sed -n 's/.* stack \([0-9]*\).*/\1/p' said) && [ "$stack" -gt 0 ] &&
        [ "$stack" -le "$stack_most" ] &&
        "$program" convert "$name-m4.lcm" "$name-m4.csv" &&
        "$program" track "$name.lcm" --pipeline paper --config "$name/scenario.ini" \
            -o "$name-track.csv" 2>/dev/null
}

# The target keeps its number to the end; what else starts in the clutter ends within ten scans.
keeps_its_number() {
    awk -F, 'NR > 1 {rows[$2]++; last = $2}
             END {for (id in rows) {print id ": " rows[id]; bad += id != last && rows[id] > 10}
                  exit bad || rows[last] < 110}' popup-m4.csv
}

# In accel_max_mps2 they differ, so only the rows of the search are the same.
start_alike() {
    diff <(head -3 passive-m4.csv | cut -d, -f1-16) <(head -3 passive-track.csv | cut -d, -f1-16) &&
        [ "$(cut -d, -f2 passive-m4.csv | sort -u | grep -c '[0-9]')" -eq 2 ]
}

check 'the pop-up target: the same bytes' plays popup v_min_mps=100 v_max_mps=1000 accel_mps2=118
check 'the pop-up target keeps its number' keeps_its_number
check 'three passive sensors: the same bytes' plays passive
check 'they start the two tracks of the program' start_alike
finish
