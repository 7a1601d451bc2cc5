#!/bin/bash
# SPDX-License-Identifier: MIT
# RHO_SCAN_KINDS: a build with some kinds of scans refuses messages of the others, gives the full build's bytes of what it has,
# and finds targets whose plots have noise of one axis also without the faster search for these. Runs beside others.
set -eu
cd "$(dirname "$0")/../.."
build=${BUILD:-build}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
passed=0
failed=0

check() { # name, command...
    local name=$1
    shift
    if "$@" >"$folder/said" 2>&1; then
        echo "ok   $name"
        passed=$((passed + 1))
    else
        echo "FAIL $name"
        cat "$folder/said"
        failed=$((failed + 1))
    fi
}

lines() { # kinds: what such a build says
    # shellcheck disable=SC2046 # a file a word
    ${CC:-gcc} -std=c11 -O1 -ffp-contract=off -Iinclude -DRHO_SCAN_KINDS="$1" -Wall -Wextra -Werror -o "$folder/kinds" \
        tests/integration/scan_kinds.c $(echo src/wire/feed*.c src/initiation/initiator*.c) "$build/librhotrack.a"
    "$folder/kinds"
}

same_as_all() { # kinds, the lines' names as a pattern
    lines "$1" >"$folder/some"
    { grep -E "^($2):" "$folder/all"
      grep -E '^kind' "$folder/all" | grep -vE "^($2):" | sed 's/: .*/: type 0 811c9dc5/'
      grep -E '^(radar( bytes)?|one axis):' "$folder/all"; } | sort -u >"$folder/expected"
    grep -E "^(kind .|radar( bytes)?|one axis|$2):" "$folder/some" | sort -u | diff "$folder/expected" -
}

finds_both() {
    grep -q '^radar: ok 2 found' "$folder/all" && grep -q '^one axis: ok 2 found' "$folder/all" &&
        [ "$(grep -c '^kind .: ok 2' "$folder/all")" = 3 ]
}

lines 7 >"$folder/all"
check 'all kinds' finds_both
check 'plots alone' same_as_all 1 'kind 0|one axis bytes'
check 'polar plots alone' same_as_all 2 'kind 1'
check 'plots and polar plots' same_as_all 3 'kind [01]|one axis bytes'
check 'bearings alone' same_as_all 4 'kind 2'
check 'plots and bearings' same_as_all 5 'kind [02]|one axis bytes'
check 'polar plots and bearings' same_as_all 6 'kind [12]'
check 'kinds that do not exist' grep -q 'RHO_SCAN_KINDS must be 1 .. 7' \
    <(${CC:-gcc} -std=c11 -Iinclude -DRHO_SCAN_KINDS=8 -fsyntax-only src/wire/feed.c 2>&1)
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
