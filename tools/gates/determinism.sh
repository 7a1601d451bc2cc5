#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Checks that the program's output is the same bytes whatever the compiler and its optimisation:
# builds it with gcc and clang at -O0 and -O3, runs simulate, track, initiate with every method, and
# maintain on plots and bearings with a fixed seed, and compares all files.
set -eu
cd "$(dirname "$0")/../.."
build=${BUILD:-build}/determinism
scenarios='crossing radar traffic passive-clutter popup'
variants='gcc-O0 gcc-O3 clang-O0 clang-O3'

unset MAKEFLAGS MAKELEVEL MFLAGS
mkdir -p "$build"
# make_variant gcc-O0: builds the program with this compiler and optimisation
make_variant() {
    folder=$build/$1
    make --no-print-directory -s BUILD="$folder" CC="${1%-*}" OPT="-${1#*-}" "$folder/rhotrack" \
        >"$build/$1.log" 2>&1 || { grep -v '^  ' "$build/$1.log"; echo \
        "determinism: $1 does not build"; exit 1; }
}
export -f make_variant
export build
# shellcheck disable=SC2086 # words on purpose
printf '%s\n' $variants | xargs -P "$(nproc)" -I{} bash -euc 'make_variant {}'

# run_scenario VARIANT SCENARIO: runs the commands; their files are in output/SCENARIO
run_scenario() {
    local rhotrack=$build/$1/rhotrack data=$build/$1/output/$2 method files='tracks.csv found.csv' \
        input=plots.csv
    local more=()
    if [ "${2%%-*}" = passive ]; then
        input=bearings.csv
        more=(--set duration_s=200)
    elif [ "$2" = popup ]; then
        more=(--set radars.0.sigma_mps=1)
    fi
    "$rhotrack" simulate "$2" --seed 3 "${more[@]}" -o "$data" &&
        "$rhotrack" track "$data/$input" --covariance -o "$data/tracks.csv" &&
        "$rhotrack" initiate "$data/$input" -o "$data/found.csv" || return 1
    if [ "$2" = crossing ]; then # the area of traffic is too large for cells of 5 m
        for method in ht mht iht nht; do
            "$rhotrack" initiate "$data/plots.csv" --method "$method" -o "$data/$method.csv" \
                || return 1
            files+=" $method.csv"
        done
    fi
    if [ "$2" = popup ]; then
        files=tracks.csv # in the last scans initiate finds no track
        for method in best hough nearest; do
            "$rhotrack" maintain "$data/plots.csv" --gate "$method" --covariance -o \
                "$data/$method.csv" || return 1
            files+=" $method.csv"
        done
    fi
    for file in $files; do
        if [ "$(wc -l <"$data/$file")" -le 1 ]; then
            echo "$data/$file holds no track: there is nothing to compare"
            return 1
        fi
    done
}

for variant in $variants; do
    rm -rf "$build/$variant/output"
    for scenario in $scenarios; do
        mkdir -p "$build/$variant/output/$scenario"
        run_scenario "$variant" "$scenario" >"$build/$variant.log" 2>&1 || {
            cat "$build/$variant.log"
            echo "determinism: $variant fails on scenario $scenario"
            exit 1
        }
    done
    (cd "$build/$variant/output" && find . -type f | sort | xargs sha256sum) \
        >"$build/$variant.sha256"
done

status=0
for variant in $variants; do
    if ! diff "$build/gcc-O0.sha256" "$build/$variant.sha256"; then
        echo "determinism: $variant writes other bytes than gcc-O0"
        status=1
    fi
done
[ "$status" -eq 0 ] || exit 1
cat "$build/gcc-O0.sha256"
echo "determinism: the same bytes from $variants"
