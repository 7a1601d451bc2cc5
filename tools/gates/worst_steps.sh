#!/bin/bash
# SPDX-License-Identifier: MIT
# Searches for the most expensive step of each shipped node configuration
# (tools/instructions/worst_*_search.c, in QEMU) and compares it with the promised upper bound
# (tools/firmware/step_cost_limits.bash). Prints a table with the sky (generated traffic) of each; a
# worse sky than those kept in tests/firmware/worst_skies.txt is to be added there. Exit 1 where a
# bound is exceeded. Environment: BUILD, WORST_SEED (default 1), WORST_SKIES (300), WORST_NODES
# (all).
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$(realpath "${BUILD:-$root/build}")
export EMULATE_SECONDS=${EMULATE_SECONDS:-3600}
. "$root/tools/firmware/step_cost_limits.bash"
failed=0
printf '%-10s %12s %12s %12s %12s %7s\n' node 'worst found' 'its work' promised 'time for' 'verdict'
for name in ${WORST_NODES:-$shipped}; do
    step_cost_limits_of "$name"
    worst_of "$name" search "${WORST_SEED:-1}" "${WORST_SKIES:-300}" || {
        echo "worst_steps.sh: $name: the search ended before its time" >&2
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
