#!/bin/bash
# SPDX-License-Identifier: MIT
# RHO_FILTERS: a build with some filters refuses what asks for the others, and gives the full
# build's bytes of what it has. RHO_FAST_UPDATES=0 gives the same bytes. RHO_SEARCHES=0 refuses
# searches.
# Runs beside others.
root=$(realpath "$(dirname "$0")/../..")
build=$(realpath "${BUILD:-$root/build}")
# shellcheck source=tests/integration/checks.bash
. "$root/tests/integration/checks.bash"

lines() { # filters, option...: what such a build says
    ${CC:-gcc} -std=c11 -O1 -ffp-contract=off -I"$root/include" -DRHO_FILTERS="$1" "${@:2}" \
        -Wall -Wextra -Werror -o filters \
        "$root/tests/integration/builds_with_fewer_filters.c" \
        "$root"/src/{base,estimation,tracker,step}/*.c "$build/librhotrack.a" && ./filters
}

is_the_same_in_loops() {
    lines 7 -DRHO_FAST_UPDATES=0 >loops && diff all loops
}

takes() { # filters, gates it has as a pattern
    local has=$2
    lines "$1" >some || return 1
    { grep -E "^gate ($has):" all
      grep -vE "^gate ($has):|^default|^starts" all | sed 's/: .*/: config 811c9dc5 0/'
      echo "default ok"
      echo "starts ok ok"; } | sort >expected
    sort some | diff expected -
}

refuses() { # filters
    ! ${CC:-gcc} -std=c11 -I"$root/include" -DRHO_FILTERS="$1" -fsyntax-only \
        "$root/src/tracker/tracker_setup.c" 2>said &&
        grep -q 'RHO_FILTERS_must_be_1_to_7' said
}

lines 7 >all
check 'all filters' takes 7 '. input .'
check 'hypotheses alone' takes 4 '0 input .'
check 'a Kalman filter alone' takes 1 '2 input 0'
check 'input estimation alone' takes 2 '[12] input 1'
check 'a Kalman filter, and input estimation' takes 3 '[12] input .'
check 'input estimation and hypotheses' takes 6 '0 input .|[12] input 1'
check 'hypotheses and a Kalman filter' takes 5 '0 input .|2 input 0'
lines 7 -DRHO_SEARCHES=0 >without
check 'without searches nothing is to start' grep -x 'starts config config' without
check 'a filter that does not exist' refuses 8
check 'updates without straight code' is_the_same_in_loops
finish
