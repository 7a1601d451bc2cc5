#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/tested.py passes on the sources as they are, and goes red where a room's tests stop
# naming a public function, also where only another room's test names it.
# Runs beside others.
set -eu
cd "$(dirname "$0")/../.."
build=$(realpath "${BUILD:-build}")
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
cp -R include src tests "$copy"
tools/gates/tested.py "$copy" "$build"

forget() { # function, room, files whose tests forget it
    local function=$1 room=$2
    shift 2
    (cd "$copy" && sed -i "s/\\b$function\\b/other_function/g" "$@")
    if tools/gates/tested.py "$copy" "$build" >"$copy/output"; then
        echo "tested.py did not see that no test of $room names $function"
        exit 1
    fi
    grep -qx "tests/unit/$room: no test names $function" "$copy/output" || { cat "$copy/output"
        exit 1; }
    cp -R tests "$copy"
}
forget rho_angle_is_valid_sector base tests/unit/base/test_angle.c
forget rho_window_continues_newest window tests/unit/window/test_window.c
forget rho_tracker_step step tests/unit/*/*.[ch] tests/unit/*.h
grep -q rho_bearing_is_valid tests/unit/estimation/*.c # another room's
forget rho_bearing_is_valid measurement tests/unit/measurement/*.c
echo 'tested.py sees what it must'
