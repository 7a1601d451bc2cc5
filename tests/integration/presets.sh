#!/bin/bash
# SPDX-License-Identifier: MIT
# The program of each preset (tools/examples/presets) is built, and finds its target; the test would
# see settings that are wrong. Runs beside others.
root=$(realpath "$(dirname "$0")/../..")
library=$(cd "$root" && realpath "${BUILD:-build}")/librhotrack.a
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
cp -r "$root/tools/examples/presets" .

finds() { # program: exit code of a build in the folder presets
    cc -std=c99 -Wall -Wextra -Werror -I"$root/include" -o "$1" "presets/$1.c" "$library" -lm ||
        return 3
    status=0
    "./$1" >stdout || status=$?
    exits 0 && grep -q '^track 1, confirmed: ' stdout || { cat stdout; return 1; }
}
presets=$(sed -n 's/^    rho_settings_preset(&settings, RHO_PRESET_\(.*\));/\1/p' presets/*.c |
    sort)
check 'every preset has a program' diff <(echo "$presets") \
    <(sed -n 's/^    RHO_PRESET_\([A-Z_]*\)[, ].*/\1/p' "$root/include/rhotrack/settings.h" | sort)
for file in presets/*.c; do
    check "$(basename "$file" .c) finds its target" finds "$(basename "$file" .c)"
    check '... in 50 lines' test "$(wc -l <"$file")" -le 50
done

papers() {
    cc -std=c99 -Wall -Wextra -Werror -I"$root/include" -o papers \
        "$root/tools/examples/papers/papers.c" "$library" -lm && ./papers >stdout
}
check "each paper's method finds its target" papers

# ---- seeded faults ----
loses() { # program, sed command on the file, file
    cp "$root/tools/examples/presets/$3" presets/
    sed -i "$2" "presets/$3"
    ! cmp -s "presets/$3" "$root/tools/examples/presets/$3" || return 4
    finds "$1"
    [ $? -eq 1 ]
}
check 'seen: a radar whose north mark is not taken off' \
    loses en_route 's/scan.measures, &radar,/scan.measures, NULL,/' preset_example_helpers.h
cp "$root/tools/examples/presets/preset_example_helpers.h" presets/
check 'seen: a sector on the wrong side' loses harbour 's/90.0f - 110.0f/-90.0f/' harbour.c
check 'seen: settings that cannot be' loses drones 's/pd = 0.7f/pd = 7.0f/' drones.c
check '... and which one' grep -q '^pd is 7, not 0.01 .. 0.999' stdout
finish
