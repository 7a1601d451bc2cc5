#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Runs fuzz targets one after the other: tests/fuzz/run.sh PROGRAM...
#
# FUZZ_SECONDS=60 in all, or FUZZ_SECONDS_EACH. Seeds: corpus/<target>/ beside this script and
# $BUILD/fuzz/seeds/<target>/ (seeds.py, and a dictionary <target>.dict beside them). What is found
# new is kept in $BUILD/fuzz/corpus/<target>/, where the next run goes on; an input that breaks
# something in $BUILD/fuzz/findings/. A target that has not ended FUZZ_GRACE_SECONDS=60 after its
# time hangs, and has failed. The last line is `N passed, N failed`.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=${BUILD:-build}/fuzz
seconds=${FUZZ_SECONDS_EACH:-$((${FUZZ_SECONDS:-60} / ($# > 0 ? $# : 1)))}
grace_seconds=${FUZZ_GRACE_SECONDS:-60}
passed=0
failed=0

tests/fuzz/seeds.py "$build/seeds"
mkdir -p "$build/findings" "$build/log"
for program in "$@"; do
    name=$(basename "$program")
    log=$build/log/$name.log
    mkdir -p "$build/corpus/$name"
    # libFuzzer writes to the first folder.
    folders=("$build/corpus/$name")
    for seeds in "tests/fuzz/corpus/$name" "$build/seeds/$name"; do
        [ -d "$seeds" ] && folders+=("$seeds")
    done
    options=()
    [ -f "$build/seeds/$name.dict" ] && options+=("-dict=$build/seeds/$name.dict")
    if timeout --kill-after=1 $((seconds + grace_seconds)) "$program" \
        -max_total_time="$seconds" -max_len=4096 \
        -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 -verbosity=1 \
        -artifact_prefix="$build/findings/$name-" "${options[@]}" "${folders[@]}" >"$log" 2>&1; then
        printf 'ok   %-20s %10s runs, %5s inputs kept, %d s\n' "$name" \
            "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
            "$(find "$build/corpus/$name" -type f | wc -l)" "$seconds"
        passed=$((passed + 1))
    else
        status=$?
        summary=$(sed -n 's/^SUMMARY: //p' "$log" | head -n 1)
        printf 'FAIL %s: %s\n' "$name" \
            "${summary:-exit $status, 124 and 137 where it did not end by itself}"
        sed -n 's/.*Test unit written to \(.*\)/     again: '"${program//\//\\/}"' \1/p' "$log"
        grep -E '^invariant|^line|^ *#[0-9]+ |ERROR|runtime error' "$log" | head -n 12 | sed \
            's/^/     | /'
        failed=$((failed + 1))
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
