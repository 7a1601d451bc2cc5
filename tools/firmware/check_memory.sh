#!/bin/bash
# SPDX-License-Identifier: MIT
# Compares flash and RAM (stack included) of the linked radar node images with their budget. Exit 1
# where it is exceeded. The last line is the sentence on the M4 in tools/lab/MEASUREMENTS.md.
# Environment: BUILD.
set -eu
cd "$(dirname "$0")/../.."
flash_most=$((104 * 1024)) ram_most=$((184 * 1024)) failed=0
# group_digits 65536: prints 65 536
group_digits() { sed -E 's/([0-9])([0-9]{3})$/\1 \2/' <<<"$1"; }

printf '%-44s %9s %9s %9s %9s\n' 'radar node' flash 'at most' RAM 'at most'
for core in m4 m7; do
    image=${BUILD:-build}/firmware/$core/radar.elf
    read -r flash ram < <(arm-none-eabi-size -A "$image" | awk '
        $1 ~ /^\.(text|ARM\.exidx|data)$/ {flash += $2}
        $1 ~ /^\.(stack|data|bss)$/ {ram += $2}
        END {print flash + 0, ram + 0}')
    verdict=ok
    if [ "$flash" -eq 0 ] || [ "$flash" -gt "$flash_most" ] || [ "$ram" -eq 0 ] || [ "$ram" -gt \
        "$ram_most" ]; then
        verdict=MISSED
        failed=1
    fi
    printf '%-44s %9d %9d %9d %9d  %s\n' "Cortex-${core^^}, default mode, stack included" "$flash" \
        "$flash_most" "$ram" \
        "$ram_most" "$verdict"
    [ "$core" = m7 ] || said="$(group_digits "$flash") bytes of flash and $(group_digits \
        "$ram") of RAM"
done
echo "$said"
exit "$failed"
