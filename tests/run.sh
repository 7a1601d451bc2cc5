#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Runs test programs and scripts, and counts: tests/run.sh CHECK...
#
# Programs run beside one another, as many as there are processors, and so do scripts that say `Runs
# beside others` in a comment: those need no network, no build and no time of their own. The other
# scripts run one after the other behind them. All are told in the order given, those beside one
# another first. A check passes where it exits with 0. CMocka programs count each of their tests,
# scripts that end with a line `N passed, N failed` count as it says, all others as one. A check
# that is not there (it did not build) is a failure. What a check leaves out is a line `skipped:
# ...` of its own, which is shown, once more at the end, and counts neither way. Output goes to
# $BUILD/log/; of a failure its end is shown, and what stands around the word FAIL or ERROR before.
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
skipped=()

# Sum of the numbers after a CMocka line's tag, as in `[  PASSED  ] 12 test(s).`
cmocka_sum() {
    sed -n "s/^\[  $1  \] \([0-9][0-9]*\) test(s).*/\1/p" "$2" | awk \
        '{sum += $1} END {print sum + 0}'
}

log_of() { # CHECK
    local name=${1#"$BUILD"/}
    printf '%s/log/%s.log' "$BUILD" "${name//\//_}"
}

# Runs a check; its exit code and time go into a file beside its log.
execute() {
    local check=$1 log status=0 start=$EPOCHREALTIME
    log=$(log_of "$check")
    if [ -x "$check" ]; then
        timeout "$seconds_max" "$(realpath "$check")" >"$log" 2>&1 </dev/null || status=$?
    elif [ -f "$check" ]; then
        timeout "$seconds_max" bash "$check" >"$log" 2>&1 </dev/null || status=$?
    else
        echo "not there: it did not build" >"$log"
        status=127
    fi
    echo "$status $(awk "BEGIN {printf \"%.1f\", $EPOCHREALTIME - $start}")" >"$log.part"
    mv "$log.part" "$log.result"
}

report() {
    local check=$1 name=${1#"$BUILD"/} log status good bad counts='' seconds line
    log=$(log_of "$check")
    read -r status seconds <"$log.result"
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
    if [ "$status" -eq 0 ] && [ "$bad" -eq 0 ]; then
        printf 'ok      %-52s %4d  %6s s\n' "$name" "$good" "$seconds"
        while read -r line; do
            printf '        | %s\n' "$line"
            skipped+=("$name: ${line#skipped: }")
        done < <(grep '^skipped: ' "$log")
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
programs=()
early=() # they take longer than most programs
scripts=()
for check in "$@"; do
    rm -f "$(log_of "$check").result"
    if [[ $check != *.sh ]]; then
        programs+=("$check")
    elif grep -qs '^#.*Runs beside others' "$check"; then
        early+=("$check")
    else
        scripts+=("$check")
    fi
done

programs=("${early[@]+"${early[@]}"}" "${programs[@]+"${programs[@]}"}")

told=0
tell_done() { # those next in order
    while [ "$told" -lt "${#programs[@]}" ] && [ -e "$(log_of "${programs[told]}").result" ]; do
        report "${programs[told]}"
        told=$((told + 1))
    done
}
for check in "${programs[@]+"${programs[@]}"}"; do
    while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do
        wait -n || true
        tell_done
    done
    execute "$check" &
done
wait
tell_done
for check in "${scripts[@]+"${scripts[@]}"}"; do
    execute "$check"
    report "$check"
done

if [ "${#skipped[@]}" -gt 0 ]; then
    echo
    printf 'skipped in %s\n' "${skipped[@]}"
fi
if [ "${#failures[@]}" -gt 0 ]; then
    echo
    printf 'failed: %s\n' "${failures[@]}"
fi
echo
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
