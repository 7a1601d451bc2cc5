#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/papers_claims_faults.py: where a function of src that the papers' register names is
# emptied, a test of each of its rows fails; a row whose test looks at something else is seen.
here=$(realpath "$(dirname "$0")")
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"
root=$(realpath "$here/../..")
gate=$root/tools/gates/papers_claims_faults.py
BUILD=$(cd "$root" && realpath "${BUILD:-build}")
export BUILD
check "each row's tests notice" "$gate"

cp -R "$root/tools/lab/claims" tables
sed -i '/^\[step 2.6\]/,/^$/ {/clean_scans_keep/d}' tables/passive-hough.ini
is_seen() {
    ! "$gate" --tables "$PWD/tables" --only prune_single >said && cat said &&
        [ "$(cat said)" = "$PWD/tables/passive-hough.ini: [step 2.6]: no test of it fails where \
prune_single_crossings in src/bearings/ghost_matrix.c is empty" ]
}
check 'a row whose test is of something else is seen' is_seen
finish
