#!/bin/bash
# SPDX-License-Identifier: MIT
# RHO_FILTERS: a build with some filters refuses what asks for the others, and gives the full build's bytes of what it has.
# Runs beside others.
set -eu
cd "$(dirname "$0")/../.."
build=${BUILD:-build}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
passed=0
failed=0

lines() { # filters: what such a build says
    # shellcheck disable=SC2046 # a file a word
    ${CC:-gcc} -std=c11 -O1 -ffp-contract=off -Iinclude -DRHO_FILTERS="$1" -Wall -Wextra -Werror -o "$folder/filters" \
        tests/integration/filters.c $(echo src/tracker/tracker*.c src/maintenance/track*.c) "$build/librhotrack.a"
    "$folder/filters"
}

expect() { # name, filters, gates it has as a pattern, outcome of frames that start tracks
    local name=$1 has=$3
    lines "$2" >"$folder/some"
    { grep -E "^gate ($has):" "$folder/all"
      grep -vE "^gate ($has):|^default|^frames" "$folder/all" | sed 's/: .*/: config 811c9dc5 0/'
      echo "default ok"
      echo "frames $4"; } | sort >"$folder/expected"
    if sort "$folder/some" | diff "$folder/expected" - >"$folder/diff"; then
        echo "ok   $name"
        passed=$((passed + 1))
    else
        echo "FAIL $name"
        cat "$folder/diff"
        failed=$((failed + 1))
    fi
}

lines 7 >"$folder/all"
expect 'all filters' 7 '. input .' ok
expect 'hypotheses alone' 4 '0 input .' config
expect 'a Kalman filter alone' 1 '2 input 0' ok
expect 'input estimation alone' 2 '[12] input 1' config
expect 'a Kalman filter, and input estimation' 3 '[12] input .' ok
expect 'input estimation and hypotheses' 6 '0 input .|[12] input 1' config
expect 'hypotheses and a Kalman filter' 5 '0 input .|2 input 0' ok
if ${CC:-gcc} -std=c11 -Iinclude -DRHO_FILTERS=8 -fsyntax-only src/tracker/tracker.c 2>"$folder/said" ||
    ! grep -q 'RHO_FILTERS must be 1 .. 7' "$folder/said"; then
    echo 'FAIL a filter that does not exist'
    failed=$((failed + 1))
else
    echo 'ok   a filter that does not exist'
    passed=$((passed + 1))
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
