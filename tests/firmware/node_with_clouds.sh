#!/bin/bash
# SPDX-License-Identifier: MIT
# Nodes of point clouds in the emulator: ten people in a room on the node `people`, ten cars of six
# points on the node `traffic`: what they see, what a step costs, and what the node of people takes.
# shellcheck source=tests/firmware/record_and_replay_logs.bash
. "$(dirname "$0")/record_and_replay_logs.bash"
. "$(dirname "$0")/../integration/checks.bash"

flash_most=$((96 * 1024)) ram_most=$((64 * 1024))
quarter=4200000 # instructions of a quarter of a frame of 0.1 s, at 168 MHz

follows() { # node, scene, least completeness, largest distance in m
    "$root/tools/firmware/emulate.sh" m4 "$images/m4/nodes/$1-replay.elf" "$2.lcm" out.lcm \
        radars=1 >said && cat said && "$program" convert out.lcm tracks.csv --kind tracks &&
        "$program" evaluate "$2/truth.csv" tracks.csv --set gospa_cutoff_m="$4" >evaluation &&
        awk -v least="$3" '$1 == "completeness" {print; holds = $2 >= least} END {exit !holds}' \
            evaluation
}

costs() { # largest mean, largest step, most partial steps
    read -r partial mean worst < <(sed -n \
        's/.*partial \([0-9]*\) .*mean \([0-9]*\) max \([0-9]*\) .*/\1 \2 \3/p' said)
    echo "instructions: mean $mean of $1, worst $worst of $2; $partial partial steps"
    [ "$mean" -gt 0 ] && [ "$mean" -le "$1" ] && [ "$worst" -le "$2" ] && [ "$partial" -le "$3" ]
}

fits() {
    local flash ram
    read -r flash ram < <(memory_of people)
    echo "people: $flash bytes of flash, $ram of RAM"
    [ "$flash" -gt 0 ] && [ "$flash" -le "$flash_most" ] && [ "$ram" -le "$ram_most" ]
}

check 'ten people are recorded' record people "$root/tests/firmware/ten-people.json" plots
check 'the node follows them' follows people people 0.97 1
check 'in a quarter of a frame' costs 900000 "$quarter" 1
check 'it fits' fits
check 'ten cars are recorded' record cars cars-in-clouds plots
# its targets are up to 15 m long: cars 11 m apart in a lane, at one speed, may be one
check 'the node of traffic follows them' follows traffic cars 0.65 4
check 'at this cost' costs 550000 2100000 4
finish
