#!/bin/bash
# SPDX-License-Identifier: MIT
# The load of a whole node on a Cortex-M4F, decoding to publishing: instructions a scan, mean and worst, on records of scans
# with 100 clutter plots and 8 targets; and the stack that was used. What must hold is stated for the turning radar.
# shellcheck source=tests/firmware/records.bash
. "$(dirname "$0")/records.bash"
. "$(dirname "$0")/../integration/checks.bash"

mean_most=6000000 worst_most=20000000 stack_most=4096
cpu_hz=168000000

load() { # text, record, settings...: one row; $mean, $worst and $stack
    local text=$1 name=$2
    shift 2
    "$root/tools/firmware/emulate.sh" m4 "$images/m4/replay.elf" "$name.lcm" out.lcm "$@" >said || { cat said; return 1; }
    read -r mean worst stack < <(sed -n 's/.*mean \([0-9]*\) max \([0-9]*\) stack \([0-9]*\).*/\1 \2 \3/p' said)
    awk -v text="$text" -v mean="$mean" -v worst="$worst" -v stack="$stack" -v hz="$cpu_hz" 'BEGIN {
        printf "%-62s %10d %10d %8.0f %8d\n", text, mean, worst, 1000 * worst / hz, stack
        exit !(mean > 0 && worst >= mean && stack > 0) }'
}

square() { # half a side in m: the area of a scenario
    echo "--set area_x_min_m=-$1 --set area_x_max_m=$1 --set area_y_min_m=-$1 --set area_y_max_m=$1"
}

record_loads() {
    # shellcheck disable=SC2046 # words on purpose
    record turning polar polar --set targets=8 --set num_scans=60 &&
        record sparse traffic plots --set targets=8 --set clutter_per_scan=100 &&
        record dense traffic plots --set targets=8 --set clutter_per_scan=100 --set interval_s=4 --set num_scans=60 $(square 30000) &&
        record denser traffic plots --set targets=8 --set clutter_per_scan=100 --set interval_s=2 --set num_scans=30 $(square 10000)
}

check 'the records are made' record_loads
{
    printf '%-62s %10s %10s %8s %8s\n' 'a scan of 108 plots, Cortex-M4F, -Os; 168 MHz, 1 a cycle' mean worst 'worst ms' stack
    load '500 x 500 km, 10 s, 50 m' sparse v_min_mps=50 v_max_mps=300 accel_mps2=5
    load '60 x 60 km, 4 s, 50 m' dense v_min_mps=50 v_max_mps=300 accel_mps2=5
    load '20 x 20 km, 2 s, 50 m' denser v_min_mps=50 v_max_mps=300 accel_mps2=5
    load 'turning radar, 20 to 60 km, 4 s, 15 m x 3 mrad, any speed' turning
    load "the same, gate nearest" turning v_min_mps=100 v_max_mps=400 accel_mps2=5 gate=nearest
} 2>&1
load 'turning radar, 20 to 60 km, 4 s, 15 m x 3 mrad' turning v_min_mps=100 v_max_mps=400 accel_mps2=5
check "the turning radar's mean is at most $mean_most" test "$mean" -le "$mean_most"
check "its worst is at most $worst_most" test "$worst" -le "$worst_most"
check "the stack is at most $stack_most bytes" test "$stack" -le "$stack_most"
finish
