#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/papers_claims_register.py finds the register of claims as it should be, and goes red
# for each kind of fault, seeded in a copy. Runs beside others.
here=$(realpath "$(dirname "$0")")
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"
root=$(realpath "$here/../..")
gate=$root/tools/gates/papers_claims_register.py
check 'the register holds' "$gate"

table=passive-hough.ini
fresh() {
    rm -rf tables && cp -R "$root/tools/lab/claims" tables && cp "$root/tools/lab/CLAIMS.md" page.md
}
fresh
check 'a copy holds' "$gate" tables page.md
seen() { # file, sed command, the message expected
    sed -i "$2" "$1"
    ! "$gate" tables page.md >said 2>&1 && grep -q -- "$3" said || { cat said; return 1; }
    fresh
}
check 'a file that is not there is seen' seen "tables/$table" \
    's|src/bearings/ghost_matrix.c rho_ghost_fill|src/bearings/ghosts.c rho_ghost_fill|' \
    "$table: \\[step 1.1\\]: no file src/bearings/ghosts.c"
check 'a function that is not there is seen' seen "tables/$table" \
    's/ghost_matrix.c rho_ghost_fill/ghost_matrix.c rho_ghost_pour/' \
    "$table: \\[step 1.1\\]: no function rho_ghost_pour in src/bearings/ghost_matrix.c"
check 'a test that is not there is seen' seen "tables/$table" \
    's/without_single_crossings_nothing_is_removed/without_single_crossings/' \
    "\\[step 2.2\\]: no test without_single_crossings in tests/unit/bearings/test_ghost_matrix.c"
check 'a test in Python that is not there is seen' seen "tables/$table" \
    's/test_the_papers_method$/test_no_method/' \
    'no test test_no_method in tests/lab/test_passive.py'
check 'a test that does not call the code is seen' seen "tables/$table" \
    '/^    tests\/unit\/bearings\/test_ghost_matrix.c figure_1_of_the_paper_keeps/d' \
    "\\[step 1.1\\]: no test of it calls rho_ghost_fill in src/bearings/ghost_matrix.c"
check 'a row that is left out is seen' seen "tables/$table" 's/^\[equation 2\]/[equation 20]/' \
    "$table: no row equation 2"
check 'a key that is none is seen' seen "tables/$table" '0,/^says/s//sais/' 'no key sais'
check 'a row that the page lacks is seen' seen page.md '/^| step 2.3 |/d' \
    "no row \\[step 2.3\\] of .*$table"
check 'a row without a verdict is seen' seen page.md '/^| step 2.3 |/s/\*\*holds\*\*/holds/' \
    "row \\[step 2.3\\] of .*$table has no verdict"
check 'a table that is gone is seen' seen tables/passive-hough.ini 's/^title = .*//' \
    '\[paper\]: no title'
finish
