#!/bin/bash
# SPDX-License-Identifier: MIT
# The worst scans of each shipped configuration that a guided search finds
# (tools/instructions/worst.c), in QEMU, against what is promised (tools/firmware/promises.bash).
# Prints a table and the skies that were found; a sky worse than those kept in
# tests/firmware/worst_skies.txt belongs there. Exit 1 where a promise does not hold. Environment:
# BUILD, WORST_SEED (default 1), WORST_SKIES (300), WORST_NODES (all).
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$(realpath "${BUILD:-$root/build}")
export EMULATE_SECONDS=${EMULATE_SECONDS:-3600}
. "$root/tools/firmware/promises.bash"
failed=0
printf '%-10s %12s %12s %12s %12s %7s\n' node 'worst found' 'its work' promised 'time for' 'verdict'
for name in ${WORST_NODES:-$shipped}; do
    promise_of "$name"
    worst_of "$name" search "${WORST_SEED:-1}" "${WORST_SKIES:-300}" || {
        echo "worst.sh: $name: the search ended before its time" >&2
        exit 1
    }
    promised=$((a + b * work_max)) verdict=ok
    if [ "$instructions" -gt "$promised" ] || [ "$instructions" -gt "$most" ]; then
        verdict=BROKEN failed=1
    fi
    printf '%-10s %12d %12d %12d %12d %7s  %s\n' "$name" "$instructions" "$work" "$promised" \
        "$most" "$verdict" "$sky"
done
exit "$failed"
