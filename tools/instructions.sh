#!/bin/bash
# SPDX-License-Identifier: MIT
# Instructions that the library executes for typical jobs (valgrind), and the initiator's window with each plot's own
# covariance against the isotropic path: at most 1.5 times. Exit 1 where that does not hold. Environment: BUILD, CC.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD:-build} most=1.5

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
${CC:-gcc} -std=c11 -O2 -ffp-contract=off -Iinclude -Wl,-z,now -o "$folder/jobs" tools/instructions/jobs.c "$build/librhotrack.a"

instructions() { # job
    valgrind --tool=callgrind --callgrind-out-file="$folder/out" --toggle-collect=job "$folder/jobs" "$1" \
        >"$folder/stdout" 2>"$folder/stderr" || { cat "$folder/stderr" >&2; exit 1; }
    awk '/Collected/ {print $NF}' "$folder/stderr"
}

row() { # job, text
    local count
    count=$(instructions "$1")
    printf '%-62s %12s\n' "$2" "$count"
    echo "$count" >"$folder/$1"
}

printf '%-62s %12s\n' "job, embedded profile, ${CC:-gcc} -O2" instructions
row predict+3 'Kalman: predict, 3 updates of an axis'
row predict+6 'Kalman: predict, 6 updates of an axis'
row predict+polar 'Kalman: predict, polar plot in 3-D with range rate'
row batch-isotropic 'window of 7 x 100 clutter plots, isotropic noise'
row batch-own 'the same, own covariances'
row batch-own-rate 'the same, own covariances and range rates'
row newest-isotropic 'newest of 7 x 100 clutter plots, min_scans 0, isotropic noise'
row newest-own 'the same, own covariances'
awk -v most="$most" '{count[NR] = $1} END {
    ratio = count[2] / count[1]
    printf "own covariances over isotropic: %.2f (at most %s)\n", ratio, most
    exit ratio > most }' "$folder/batch-isotropic" "$folder/batch-own"
