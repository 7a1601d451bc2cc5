#!/bin/bash
# SPDX-License-Identifier: MIT
# What a step of each shipped configuration of the node costs at most
# (tools/firmware/step_cost_limits.bash) holds for the worst scans that were found
# (worst_skies.txt), and for a few that are drawn now; the limit on work is why. The smallest node
# also runs here on a record, and fits. LOAD=update writes the worst steps into
# tools/lab/MEASUREMENTS.md.
# shellcheck source=tests/firmware/record_and_replay_logs.bash
. "$(dirname "$0")/record_and_replay_logs.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/../integration/checks.bash"
# shellcheck source=tools/firmware/step_cost_limits.bash
. "$root/tools/firmware/step_cost_limits.bash"
export EMULATE_SECONDS=300
smallest_flash=$((60 * 1024)) smallest_ram=$((64 * 1024))

keeps() { # the promise, and what the processor has time for
    printf '%-10s %10d of %10d promised, %10d in time\n' "$1" "$instructions" \
        "$((a + b * work_max))" "$most"
    [ "$instructions" -gt 0 ] && [ "$instructions" -le "$((a + b * work_max))" ] &&
        [ "$instructions" -le "$most" ]
}

declare -A worst promised time_for
keeps_under() { # name, sky
    step_cost_limits_of "$1" && worst_of "$1" sky "$2" && keeps "$1" || return 1
    promised[$1]=$((a + b * work_max)) time_for[$1]=$most
    [ "$instructions" -le "${worst[$1]:-0}" ] || worst[$1]=$instructions
}

# The section `worst` of the page.
section() {
    local name flash ram
    printf '\nMillions of instructions of the worst step in the skies that are kept, of finders '\
'the worst second,\nfour looks; bytes of the image with its stack; Cortex-M4F, arm-none-eabi-gcc '\
'%s.\n\n' \
        "$(arm-none-eabi-gcc -dumpfullversion)"
    printf '| node | worst found | promised | time for | flash | RAM |\n|---|---|---|---|---|---|\n'
    for name in $shipped; do
        read -r flash ram < <(memory_of "$name")
        [ -z "${worst[$name]-}" ] || awk -v name="$name" -v worst="${worst[$name]}" \
            -v promised="${promised[$name]}" \
            -v most="${time_for[$name]}" -v flash="$flash" -v ram="$ram" \
            'BEGIN { printf "| %s | %.3g | %.3g | %.3g | %s | %s |\n", name, worst / 1e6,
                promised / 1e6, most / 1e6, flash, ram }'
    done
    printf '\n'
}

keeps_drawn() { # name
    step_cost_limits_of "$1" && worst_of "$1" search 7 3 && keeps "$1"
}

# The smallest node follows eight targets among 40 clutter plots, in the emulator, and no step costs
# more than it may.
runs_on_a_record() {
    step_cost_limits_of smallest &&
        record small polar plots --set targets.0.count=8 --set duration_s=120 \
            --set clutter.0.plots=40 &&
        "$root/tools/firmware/emulate.sh" m4 "$images/m4/nodes/smallest-replay.elf" small.lcm \
            out.lcm >said && cat said &&
        read -r reports instructions < <(sed -n \
            's/.*reports \([0-9]*\) .*max \([0-9]*\) .*/\1 \2/p' said) &&
        [ "$reports" -gt 0 ] && [ "$instructions" -le "$most" ]
}

fits() {
    local flash ram
    read -r flash ram < <(memory_of smallest)
    echo "smallest: $flash bytes of flash, $ram of RAM"
    [ "$flash" -gt 0 ] && [ "$flash" -le "$smallest_flash" ] && [ "$ram" -le "$smallest_ram" ]
}

while read -r name sky; do
    [ "$name" = '#' ] || check "$name keeps its promise: $sky" keeps_under "$name" "$sky"
done <"$root/tests/firmware/worst_skies.txt"
for name in $shipped; do
    check "$name keeps it when others are drawn" keeps_drawn "$name"
done
section >section
check 'tools/lab/MEASUREMENTS.md says so' says_the_page worst section
check 'the smallest node runs on a record' runs_on_a_record
check 'it fits' fits
finish
