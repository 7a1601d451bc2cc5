#!/bin/bash
# SPDX-License-Identifier: MIT
# Instructions that the library executes for typical jobs (tools/instructions): on this machine,
# counted by valgrind, and on Cortex-M4F and M7 under QEMU, where arm-none-eabi-gcc and
# qemu-system-arm are installed: mean and worst of several inputs, with upper limits on the M4F.
# Then the cost of the initiator's window with a covariance for each plot compared with isotropic
# noise, instructions of the accumulator a vote, and growth of a step from 1000 to 5000 plots in one
# area. Exit 1 where a limit is exceeded; under CI=true also where Cortex-M is not counted.
# Environment: BUILD, CC.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${BUILD:-build} most_ratio=1.5 most_growth=7 failed=0

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# ---- programs -------------------------------------------------------------------------------

for job in filters one_track_gate tracker one_track_hypotheses initiation \
    passive wire zone_counts_step; do
    ${CC:-gcc} -std=c11 -O2 -ffp-contract=off -Iinclude -Wl,-z,now -o "$folder/$job" \
        "tools/instructions/$job.c" \
        "$build/librhotrack.a"
done
${CC:-gcc} -std=c11 -O2 -ffp-contract=off -Iinclude -DRHO_PROFILE_WORKSTATION -Wl,-z,now -o \
    "$folder/hough" \
    tools/instructions/hough.c "$build/workstation/librhotrack.a"
${CC:-gcc} -std=c11 -O2 -ffp-contract=off -Iinclude -DRHO_PROFILE_WORKSTATION -Wl,-z,now -o \
    "$folder/growth" \
    tools/instructions/growth.c "$build/workstation/librhotrack.a"
cores=''
if command -v arm-none-eabi-gcc >/dev/null && command -v qemu-system-arm >/dev/null; then
    cores='m4 m7'
    make --no-print-directory -s BUILD="$build" job-images >"$folder/make" 2>&1 || { cat \
        "$folder/make"; exit 1; }
fi

# ---- counting -------------------------------------------------------------------------------

# count_here PROGRAM ARGUMENTS: counts instructions on this machine with valgrind. Sets $calls, $sum
# and $max; the program's output is in $folder/said.
count_here() {
    local program=$1
    shift
    valgrind --tool=callgrind --collect-atstart=no --callgrind-out-file="$folder/out" \
        "$folder/$program" "$@" \
        >"$folder/said" 2>"$folder/stderr" || { cat "$folder/stderr" >&2; exit 1; }
    sum=$(awk '/Collected/ {print $NF}' "$folder/stderr") max=''
    calls=$(sed -n 's/^calls \([0-9]*\).*/\1/p' "$folder/said")
}

# count_on m4|m7 PROGRAM ARGUMENTS: counts instructions under QEMU, with results as count_here
count_on() {
    local core=$1 program=$2
    shift 2
    tools/firmware/emulate.sh "$core" "$build/firmware/$core/jobs/$program.elf" "$@" \
        >"$folder/said" ||
        { cat "$folder/said" >&2; exit 1; }
    read -r calls sum max < <(sed -n \
        's/^calls \([0-9]*\) sum \([0-9]*\) max \([0-9]*\)/\1 \2 \3/p' "$folder/said")
}

# print_counts TEXT UNIT LIMIT JOB ARGUMENTS: prints one line of a table with the counts of a job
# divided by UNIT (tracks). LIMIT: upper limit of the mean on the M4F; -: none.
print_counts() {
    local text=$1 unit=$2 bar=$3 here mean='-' worst='-' other='-' verdict=''
    shift 3
    count_here "$@"
    here=$((sum / calls / unit))
    if [ -n "$cores" ]; then
        count_on m7 "$@"
        other=$((sum / calls / unit))
        count_on m4 "$@"
        mean=$((sum / calls / unit)) worst=$((max / unit))
        if [ "$bar" != - ]; then
            verdict="  (at most $bar)"
            [ "$sum" -le $((bar * calls * unit)) ] || { verdict+=' MISSED'; failed=1; }
        fi
    fi
    printf '%-62s %11s %11s %11s %11s%s\n' "$text" "$here" "$mean" "$worst" "$other" "$verdict"
}

print_head() { printf '\n%-62s %11s %11s %11s %11s\n' "$1" "$(uname -m)" M4F 'M4F worst' M7; }

if [ -z "$cores" ]; then
    echo 'skipped: no arm-none-eabi-gcc or no qemu-system-arm here: nothing is counted on Cortex-M'
    [ "${CI:-}" != true ] || failed=1
fi
echo "Executed instructions, embedded profile, -O2: ${CC:-gcc} here," \
    "$(arm-none-eabi-gcc -dumpfullversion 2>/dev/null || echo no) arm-none-eabi-gcc"

print_head 'filters, a step'
print_counts 'Kalman: predict, 3 updates of an element' 1 1450 filters predict+3
print_counts 'Kalman: predict, 6 updates of an element' 1 2400 filters predict+6
print_counts 'the same, axes coupled' 1 2400 filters coupled+6
print_counts 'Kalman: predict, polar plot in 3-D with range rate' 1 - filters predict+polar
print_counts 'Kalman + input + Hough gate, 4 clutter plots' 1 5000 filters input+hough

print_head 'a track by itself, a scan: prediction, gate over 4 plots, update'
print_counts 'nearest: polar plots with range rate' 1 7000 \
    one_track_gate nearest polar 4
print_counts 'hough behind nearest, input estimation: places and velocities' 1 - \
    one_track_gate hough cartesian 4

print_head 'the whole tracker with 8 tracks, a track and scan (no initiation)'
print_counts 'nearest: polar plots with range rate, 4 in the gate' 8 - tracker nearest polar 4 1
print_counts 'hough, input estimation: places and velocities, 4' 8 - tracker hough cartesian 4 1
print_counts 'best: places and velocities, the target alone' 8 - tracker best cartesian 1 1
print_counts 'best: the same, 4 in the gate' 8 - tracker best cartesian 4 1
print_counts 'best: polar plots with range rate, the target alone' 8 16000 tracker best polar 1 1
print_counts 'best: the same, 4 in the gate' 8 78000 tracker best polar 4 1

print_head 'a radar with 8 tracks and 32 plots a turn, gate best, a step'
print_counts 'the turn at once' 1 - tracker best polar 4 1
print_counts 'a sector of 32' 1 - tracker best polar 4 32

print_head 'the default, hypotheses over imm, a track and scan: places in 3-D'
print_counts 'isotropic noise, the target alone' 1 - one_track_hypotheses 1 0
print_counts 'isotropic noise, 4 in the gate' 1 30000 one_track_hypotheses 4 0
print_counts 'isotropic noise, 10 in the gate' 1 60000 one_track_hypotheses 10 0
print_counts 'noise of its own, the target alone' 1 - one_track_hypotheses 1 1
print_counts 'noise of its own, 4 in the gate' 1 - one_track_hypotheses 4 1
print_counts 'noise of its own, 10 in the gate' 1 - one_track_hypotheses 10 1

print_head 'initiation, window of 7 scans of 4 x 2.5 km, 3 targets'
for clutter in 0 10 100; do
    print_counts "batch, $clutter clutter plots a scan, isotropic noise" 1 - \
        initiation batch isotropic "$clutter" 5
    print_counts "newest, $clutter, min_scans 0, isotropic noise" 1 - initiation newest isotropic \
        "$clutter" 5
    print_counts "newest, $clutter, min_scans 0, own covariances" 1 - \
        initiation newest own "$clutter" 5
done
count_here initiation batch isotropic 100 5
isotropic=$sum
sed 's/^/last batch: /; /calls/d' "$folder/said"
count_here initiation batch own 100 5
awk -v own="$sum" -v isotropic="$isotropic" -v most="$most_ratio" 'BEGIN {
    ratio = own / isotropic
    printf "batch of 100, own covariances over isotropic: %.2f (at most %s)\n", ratio, most
    exit ratio > most }' || failed=1

print_head 'passive batch: 3 sensors, 8 frames'
print_counts '4 targets, 1 false bearing a look' 1 - passive 4 1 10
print_counts '8 false bearings a look, as many as there is room for' 1 - passive 0 8 3

print_head 'zones: 16 with all tracks in them, a track and step'
print_counts 'beside the turn above: 1.2 % of its step' 32 1000 zone_counts_step

print_head 'messages'
print_counts 'plot_scan_t of 34 plots, 1401 bytes, encoded: 20 a byte at most' 1 28020 wire encode
print_counts 'the same, decoded' 1 - wire decode
print_counts 'the same, its values checked' 1 - wire validate
print_counts 'the same, assembled: decoded, checked, made plots' 1 - wire take
print_counts 'track_list_t of 9 tracks, from a report' 1 - wire publish

# print_vote_cost POINTS: a line of the accumulator's cost, with and without pruning
print_vote_cost() {
    local plain votes
    count_here hough "$1" plain
    plain=$sum
    count_here hough "$1" pruned
    votes=$(sed -n 's/^\([0-9]*\) votes/\1/p' "$folder/said")
    awk -v points="$1" -v plain="$plain" -v pruned="$sum" -v votes="$votes" 'BEGIN {
        printf "%-8s %12s %12s %15.2f %15.2f\n", points, pruned, plain, pruned / votes, \
            plain / votes }'
}

printf '\naccumulator, workstation profile, %s: 5 m x 1 mrad, 30 x 30 km, 7 scans, 5 votes\n' \
    "$(uname -m)"
printf '%-8s %12s %12s %15s %15s\n' points instructions 'not pruned' 'a vote' 'not pruned'
print_vote_cost 30
print_vote_cost 300
print_vote_cost 3000

# print_growth V_MIN V_MAX: a line with the cost of steps of 1000 and 5000 plots a scan, and of the
# search alone
print_growth() {
    local plots few=0 few_search=0 search
    for plots in 1000 5000; do
        count_here growth "$plots" "$1" "$2"
        grep -q '^0 partial' "$folder/said" || { echo "growth: a partial step"; failed=1; }
        search=$(callgrind_annotate --inclusive=yes "$folder/out" |
            awk '/rho_initiator_search_within/ {gsub(",", "", $1); print $1; exit}')
        [ "$plots" = 1000 ] && few=$sum few_search=$search
    done
    awk -v speeds="$1 to $2" -v few="$few" -v many="$sum" -v calls="$calls" -v most="$most_growth" \
        -v few_search="$few_search" -v search="$search" 'BEGIN {
        printf "%-12s %12.0f %12.0f %8.2f %8.2f  (at most %s)\n", speeds, few / calls, \
            many / calls, many / few, search / few_search, most
        exit many > most * few }' || failed=1
}

printf '\na step in clutter spread evenly over 500 x 500 km, workstation profile, %s\n' \
    "$(uname -m)"
printf '%-12s %12s %12s %8s %8s\n' 'speeds, m/s' '1000 plots' '5000 plots' times 'search'
print_growth 50 300
print_growth 0 700
exit "$failed"
