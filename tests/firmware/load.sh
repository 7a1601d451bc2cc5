#!/bin/bash
# SPDX-License-Identifier: MIT
# The load of a whole node on a Cortex-M4F, decoding to publishing: instructions a scan, mean and
# worst, on records of scans with 100 clutter plots and 8 targets; and the stack that was used. What
# must hold is stated for the turning radar. LOAD=update writes the rows, flash and RAM into
# tools/lab/MEASUREMENTS.md.
# shellcheck source=tests/firmware/record_and_replay_logs.bash
. "$(dirname "$0")/record_and_replay_logs.bash"
. "$(dirname "$0")/../integration/checks.bash"

mean_most=6000000 worst_most=20000000 stack_most=4096
cpu_hz=168000000

load() { # text, record, settings...: one row; its $mean and $worst, the most $stack of all
    local text=$1 name=$2 row
    shift 2
    "$root/tools/firmware/emulate.sh" m4 "$images/m4/replay.elf" "$name.lcm" out.lcm "$@" >said \
        || { cat said; return 1; }
    read -r partial mean worst used < <(
        sed -n 's/.*partial \([0-9]*\) .*mean \([0-9]*\) max \([0-9]*\) stack '\
'\([0-9]*\).*/\1 \2 \3 \4/p' said)
    partial_steps=$((partial_steps + partial))
    row=$(awk -v text="$text" -v mean="$mean" -v worst="$worst" -v hz="$cpu_hz" 'BEGIN {
        printf "| %s | %.3g M | %.3g M | %.0f |", text, mean / 1e6, worst / 1e6, 1000 * worst / hz
        exit !(mean > 0 && worst >= mean) }') && rows+=("$row") && [ "$used" -gt 0 ] &&
        stack=$((used > stack ? used : stack))
}

# The section `load` of the page.
section() {
    printf '\narm-none-eabi-gcc %s, `-Os -flto`; instructions as QEMU counts them, '\
'100 clutter plots and 8\n' \
        "$(arm-none-eabi-gcc -dumpfullversion)"
    printf 'targets a scan. One cycle an instruction; slow flash adds about half.\n\n'
    printf '| Cortex-M4F | mean | worst | ms at %s MHz |\n|---|---|---|---|\n' $((cpu_hz / 1000000))
    printf '%s\n' "${rows[@]}"
    printf '\nThe image takes %s,\nstart-up, Ethernet, IP and stack included.\n\n' \
        "$(BUILD=$build "$root/tools/firmware/check_memory.sh" | tail -1)"
}

# scene traffic with eight targets and 100 clutter plots a scan: half a side of its area in m,
# seconds between scans, scans
record_traffic() { # name, half a side, interval, scans
    local box="[-$2,$2,-$2,$2]"
    record "$1" traffic plots --set targets.0.count=8 --set clutter.0.plots=100 \
        --set radars.0.interval_s="$3" \
        --set duration_s=$(($3 * $4)) --set area="$box" --set targets.0.box_m="$box" \
        --set targets.0.keep_box_m="$box"
}

record_loads() {
    record turning polar plots --set targets.0.count=8 --set duration_s=240 &&
        record_traffic sparse 250000 10 120 && record_traffic dense 30000 4 60 \
            && record_traffic denser 10000 2 30
}

check 'the records are made' record_loads
rows=()
mean=0 worst=0 stack=0 partial_steps=0
check 'a record of a large area' load '500 x 500 km, 10 s a scan, 50 m' sparse v_min_mps=50 \
    v_max_mps=300 accel_mps2=5
check 'a record of a smaller one' load '60 x 60 km, 4 s, 50 m' dense v_min_mps=50 v_max_mps=300 \
    accel_mps2=5
check 'a record of a small one' load '20 x 20 km, 2 s, 50 m' denser v_min_mps=50 v_max_mps=300 \
    accel_mps2=5
check 'a turning radar, any speed' load \
    'turning radar, 20 to 60 km, 4 s, 15 m x 3 mrad, any speed' turning
check 'a turning radar' load \
    'turning radar, 20 to 60 km, 4 s, 15 m x 3 mrad, targets of 100 to 400 m/s' turning \
    v_min_mps=100 v_max_mps=400 accel_mps2=5
printf '%s\n' "${rows[@]}"
check "the turning radar's mean is at most $mean_most" test "$mean" -gt 0 -a "$mean" -le \
    "$mean_most"
check "its worst is at most $worst_most" test "$worst" -gt 0 -a "$worst" -le "$worst_most"
check 'no step of these was partial' test "$partial_steps" -eq 0
section >section
check 'tools/lab/MEASUREMENTS.md says so' says_the_page load section
check 'flash and RAM are within the budget' env BUILD="$build" \
    "$root/tools/firmware/check_memory.sh"
check "the stack ($stack bytes) is at most $stack_most" test "$stack" -gt 0 -a "$stack" -le \
    "$stack_most"
finish
