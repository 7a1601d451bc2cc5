#!/bin/bash
# SPDX-License-Identifier: MIT
# The node that learns walls (RHO_LEARNS_REFLECTORS in its configuration): cars beside a guard rail
# of which nobody told.
# shellcheck source=tests/firmware/record_and_replay_logs.bash
. "$(dirname "$0")/record_and_replay_logs.bash"
. "$(dirname "$0")/../integration/checks.bash"

cat >learns.h <<'H'
#define RHO_MAX_REFLECTORS 4
#define RHO_LEARNS_REFLECTORS 1
#include "nodes/traffic.h"
H
sed 's/LEARNS_REFLECTORS 1/LEARNS_REFLECTORS 0/' learns.h >knows-none.h
build_with() { # configuration
    gcc -std=c99 -O1 -ffp-contract=off -I"$root/include" -I"$root/tools/firmware" -I. \
        -DRHO_CONFIG_FILE="\"$1.h\"" -o "./$1" "$root"/src/*/*.c \
        "$root"/tools/firmware/{lcm_datagram_node,replay}.c \
        "$root"/tools/firmware/board/host/files_host.c
}
check 'a record' record rail guard-rail plots --set reflectors.0.is_told=false
for name in learns knows-none; do
    check "the node that $name builds" build_with $name
    check 'and plays it' "./$name" rail.lcm "$name.lcm" radars=1 v_max_mps=50 accel_mps2=6
    run convert "$name.lcm" "$name.csv" --kind tracks
done
behind() { # file: rows of tracks behind the rail, no car's, in the last 15 s
    awk -F, '$1 > 26 && $3 != "deleted" && $5 > 14.5 && !($5 > 20 && $5 < 22) {n++}
        END {print n + 0}' "$1"
}
check 'images have tracks' test "$(behind knows-none.csv)" -gt 100
check 'and none once the rail is learned' test "$(behind learns.csv)" -le 10
finish
