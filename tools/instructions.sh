#!/bin/bash
# SPDX-License-Identifier: MIT
# Instructions that the library executes for typical jobs (valgrind), and the initiator's window with each plot's own
# covariance against the isotropic path: at most 1.5 times. Then the accumulator's, a vote.
# Exit 1 where that, or what a row may cost at most, does not hold. Environment: BUILD, CC.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD:-build} most=1.5 failed=0

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
${CC:-gcc} -std=c11 -O2 -ffp-contract=off -Iinclude -Wl,-z,now -o "$folder/jobs" tools/instructions/jobs.c "$build/librhotrack.a"
${CC:-gcc} -std=c11 -O2 -ffp-contract=off -Iinclude -Wl,-z,now -o "$folder/maintain" tools/instructions/maintain.c \
    "$build/librhotrack.a"
${CC:-gcc} -std=c11 -O2 -ffp-contract=off -Iinclude -Wl,-z,now -o "$folder/wire" tools/instructions/wire.c "$build/librhotrack.a"
${CC:-gcc} -std=c11 -O2 -ffp-contract=off -Iinclude -DRHO_PROFILE_WORKSTATION -Wl,-z,now -o "$folder/hough" \
    tools/instructions/hough.c "$build/workstation/librhotrack.a"

instructions() { # program arguments
    local program=$1
    shift
    valgrind --tool=callgrind --callgrind-out-file="$folder/out" --toggle-collect=job "$folder/$program" "$@" \
        >"$folder/stdout" 2>"$folder/stderr" || { cat "$folder/stderr" >&2; exit 1; }
    awk '/Collected/ {print $NF}' "$folder/stderr"
}

row() { # job, text, at most
    local count bar=''
    count=$(instructions jobs "$1")
    [ -z "${3-}" ] || bar="  (at most $3)"
    printf '%-62s %12s%s\n' "$2" "$count" "$bar"
    [ -z "${3-}" ] || [ "$count" -le "$3" ] || failed=1
    echo "$count" >"$folder/$1"
}

printf '%-62s %12s\n' "job, embedded profile, ${CC:-gcc} -O2" instructions
row predict+3 'Kalman: predict, 3 updates of an axis' 1450
row predict+6 'Kalman: predict, 6 updates of an axis' 2400
row predict+polar 'Kalman: predict, polar plot in 3-D with range rate'
row input+hough 'Kalman + input + Hough gate, 4 clutter plots: a scan' 5000
row batch-isotropic 'window of 7 x 100 clutter plots, isotropic noise'
row batch-own 'the same, own covariances'
row batch-own-rate 'the same, own covariances and range rates'
row newest-isotropic 'newest of 7 x 100 clutter plots, min_scans 0, isotropic noise'
row newest-own 'the same, own covariances'
awk -v most="$most" '{count[NR] = $1} END {
    ratio = count[2] / count[1]
    printf "own covariances over isotropic: %.2f (at most %s)\n", ratio, most
    exit ratio > most }' "$folder/batch-isotropic" "$folder/batch-own" || failed=1

default() { # plots, 1 for noise of its own, text, at most, wanted but not reached
    local bar=''
    count=$(instructions maintain "$1" "$2")
    read -r scans hypotheses gated <"$folder/stdout"
    count=$((count / scans))
    [ -z "${4-}" ] || bar="  (at most $4)"
    [ -z "${5-}" ] || [ "$count" -le "$5" ] || bar="  (wanted: $5, missed)"
    printf '%-62s %12s%s  %s hypotheses\n' "$3, $gated in the gate" "$count" "$bar" "$hypotheses"
    [ -z "${4-}" ] || [ "$count" -le "$4" ] || failed=1
}

printf '\nthe default, a track and scan: positions in 3-D, mean over 100 scans\n'
default 1 0 'isotropic noise, the target alone'
default 4 0 'isotropic noise' '' 30000
default 10 0 'isotropic noise' 60000
default 1 1 'noise of its own, the target alone'
default 4 1 'noise of its own'
default 10 1 'noise of its own'

wire() { # job, text, at most a byte
    local count size bar=''
    count=$(instructions wire "$1")
    read -r size <"$folder/stdout"
    [ -z "${3-}" ] || bar="  (at most $3)"
    awk -v text="$2" -v count="$count" -v size="$size" -v bar="$bar" -v most="${3:-1e9}" 'BEGIN {
        printf "%-62s %12d %8.2f%s\n", text, count, count / size, bar
        exit count / size > most }' || failed=1
}

printf '\n%-62s %12s %8s\n' 'messages' instructions 'a byte'
wire encode 'plot_scan_t of 34 plots, encoded' 20
wire decode 'the same, decoded'
wire validate 'the same, its values checked'
wire take 'the same, taken by the feed: decoded, checked, made plots'
wire publish 'track_list_t of 9 tracks, from a report'

votes() { # points: a row with and without pruning
    local plain pruned
    plain=$(instructions hough "$1" plain)
    pruned=$(instructions hough "$1" pruned)
    awk -v points="$1" -v plain="$plain" -v pruned="$pruned" '{
        printf "%-8s %12s %12s %15.2f %15.2f\n", points, pruned, plain, pruned / $1, plain / $1 }' "$folder/stdout"
}

printf '\naccumulator, workstation profile: 5 m x 1 mrad, 30 x 30 km, 7 scans, 5 votes\n'
printf '%-8s %12s %12s %15s %15s\n' points instructions 'not pruned' 'a vote' 'not pruned'
votes 30
votes 300
votes 3000
exit "$failed"
