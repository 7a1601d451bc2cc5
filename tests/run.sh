#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Runs test programs and scripts, one after the other, and counts: tests/run.sh CHECK...
#
# A check passes where it exits with 0. CMocka programs count each of their tests, scripts that end with a line
# `N passed, N failed` count as it says, all others as one. A check that is not there (it did not build) is a failure.
# What a check leaves out is a line `skipped: ...` of its own, which is shown, and counts neither way.
# Output goes to $BUILD/log/; of a failure its end is shown, and what stands around the word FAIL or ERROR before.
# The last line is `N passed, N failed`; exit 1 where anything failed.
set -u
cd "$(dirname "$0")/.." || exit 1

export BUILD=${BUILD:-build}
RHOTRACK=$(realpath -m "$BUILD/rhotrack")
export RHOTRACK
export LC_ALL=C
unset MAKEFLAGS MAKELEVEL MFLAGS

seconds_max=600 # of one check
passed=0
failed=0
failures=()

# Sum of the numbers after a CMocka line's tag, as in `[  PASSED  ] 12 test(s).`
cmocka_sum() {
    sed -n "s/^\[  $1  \] \([0-9][0-9]*\) test(s).*/\1/p" "$2" | awk '{sum += $1} END {print sum + 0}'
}

run_check() {
    local check=$1 name=${1#"$BUILD"/} log status=0 good bad counts='' start=$EPOCHREALTIME seconds
    log=$BUILD/log/${name//\//_}.log
    if [ -x "$check" ]; then
        timeout "$seconds_max" "$(realpath "$check")" >"$log" 2>&1 </dev/null || status=$?
    elif [ -f "$check" ]; then
        timeout "$seconds_max" bash "$check" >"$log" 2>&1 </dev/null || status=$?
    else
        echo "not there: it did not build" >"$log"
        status=127
    fi
    good=$(cmocka_sum PASSED "$log")
    bad=$(cmocka_sum FAILED "$log")
    if [[ $(tail -n 1 "$log") =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]]; then
        good=${BASH_REMATCH[1]}
        bad=${BASH_REMATCH[2]}
        counts=yes
    fi
    if [ -z "$counts" ] && [ "$good" -eq 0 ] && [ "$status" -eq 0 ]; then
        good=1 # it does not count
    fi
    if [ "$bad" -eq 0 ] && [ "$status" -ne 0 ]; then
        bad=1 # ended before its own count
    fi
    passed=$((passed + good))
    failed=$((failed + bad))
    seconds=$(awk "BEGIN {printf \"%.1f\", $EPOCHREALTIME - $start}")
    if [ "$status" -eq 0 ] && [ "$bad" -eq 0 ]; then
        printf 'ok      %-52s %4d  %6s s\n' "$name" "$good" "$seconds"
        sed -n 's/^skipped: /        | &/p' "$log"
        return
    fi
    failures+=("$name")
    printf 'FAILED  %-52s %4d  %6s s  (exit %d)\n' "$name" "$bad" "$seconds" "$status"
    {
        head -n -15 "$log" | grep -A 3 -E 'FAIL|ERROR' | head -n 40
        tail -n 15 "$log"
    } | sed 's/^/        | /'
}

mkdir -p "$BUILD/log"
for check in "$@"; do
    run_check "$check"
done

if [ "${#failures[@]}" -gt 0 ]; then
    echo
    printf 'failed: %s\n' "${failures[@]}"
fi
echo
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
