#!/bin/bash
# SPDX-License-Identifier: MIT
# RHO_SCAN_KINDS: a build with some kinds of scans refuses messages of the others, gives the full
# build's bytes of what it has, and finds targets whose plots have noise of one axis also without
# the faster search for these. Runs beside others.
root=$(realpath "$(dirname "$0")/../..")
build=$(realpath "${BUILD:-$root/build}")
# shellcheck source=tests/integration/checks.bash
. "$root/tests/integration/checks.bash"

lines() { # kinds: what such a build says
    ${CC:-gcc} -std=c11 -O1 -ffp-contract=off -I"$root/include" -DRHO_SCAN_KINDS="$1" -Wall \
        -Wextra -Werror -o kinds \
        "$root/tests/integration/builds_with_fewer_scan_kinds.c" "$root"/src/wire/scan_*.c \
        "$root"/src/{window,initiation}/*.c \
        "$build/librhotrack.a" && ./kinds
}

same_as_all() { # kinds, the lines' names as a pattern
    lines "$1" >some || return 1
    { grep -E "^($2):" all
      grep -E '^kind' all | grep -vE "^($2):" | sed 's/: .*/: type 0 811c9dc5/'
      grep -E '^(radar( bytes)?|one axis):' all; } | sort -u >expected
    grep -E "^(kind .|radar( bytes)?|one axis|$2):" some | sort -u | diff expected -
}

finds_both() {
    grep -q '^radar: ok 2 found' all && grep -q '^one axis: ok 2 found' all &&
        [ "$(grep -c '^kind .: ok 2' all)" = 4 ]
}

lines 7 >all
check 'all kinds' finds_both
check 'plots alone' same_as_all 1 'kind 0|one axis bytes'
check 'polar plots alone' same_as_all 2 'kind 1'
check 'plots and polar plots' same_as_all 3 'kind [01]|one axis bytes'
check 'bearings alone' same_as_all 4 'kind [23]'
check 'plots and bearings' same_as_all 5 'kind [023]|one axis bytes'
check 'polar plots and bearings' same_as_all 6 'kind [123]'
check 'kinds that do not exist' grep -q 'RHO_SCAN_KINDS_must_be_1_to_7' \
    <(${CC:-gcc} -std=c11 -I"$root/include" -DRHO_SCAN_KINDS=8 -fsyntax-only \
    "$root/src/wire/scan_assembler.c" 2>&1)
finish
