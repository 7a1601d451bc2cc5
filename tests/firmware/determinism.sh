#!/bin/bash
# SPDX-License-Identifier: MIT
# Records give the same bytes everywhere: tracks (identities, states, covariances), peaks (votes,
# scores), fates. Compared are Cortex-M4F and M7 (QEMU), x86-64 by gcc and clang at -O0 to -O3,
# armhf, and big-endian s390x and powerpc (qemu-user).
# shellcheck source=tests/firmware/record_and_replay_logs.bash
. "$(dirname "$0")/record_and_replay_logs.bash"
. "$(dirname "$0")/../integration/checks.bash"

check 'the records are made' record_all

sources=("$root"/src/*/*.c \
    "$root"/tools/firmware/{lcm_datagram_node,replay}.c \
    "$root"/tools/firmware/board/host/files_host.c)
build_replay() { # file, compiler, flags...
    local file=$1
    shift
    "$@" -std=c99 -ffp-contract=off -I"$root/include" -I"$root/tools/firmware" -o "$file" \
        "${sources[@]}"
}
export -f build_replay
for variant in gcc-O0 gcc-O1 gcc-O2 gcc-O3 clang-O0 clang-O1 clang-O2 clang-O3 \
    arm-linux-gnueabihf-gcc-O2 s390x-linux-gnu-gcc-O2 powerpc-linux-gnu-gcc-O2; do
    case $variant in
    # by itself gcc computes float as double there
    s390x-*) echo "$variant ${variant%-*} -${variant##*-} -static -fexcess-precision=fast" ;;
    *linux*) echo "$variant ${variant%-*} -${variant##*-} -static" ;;
    *) echo "$variant ${variant%-*} -${variant##*-}" ;;
    esac
done >variants
export root
# the array does not travel: as words
printf '%s\n' "${sources[@]}" >sources
build_all() {
    xargs -P "$(nproc)" -L 1 bash -c 'mapfile -t sources <sources; build_replay "./$0" "$@"' \
        <variants
}
check 'all variants build' build_all

# start NAME COMMAND...: all records by it, beside the others, into out-NAME and sums-NAME.
start() {
    local name=$1
    shift
    while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n; done
    replay_all "out-$name" "$@" >"sums-$name" &
}

# same_as_first SUMS NAME: the sums of the first variant that ran are what all others are compared
# with.
same_as_first() { diff "$reference" "$1"; }

reference=sums-gcc-O0
first_runs() { replay_all out-gcc-O0 ./gcc-O0 >"$reference" && [ "$(wc -l <"$reference")" -eq \
    "$(runs | wc -l)" ]; }
check 'gcc-O0 plays all of them' first_runs
others=$(cut -d' ' -f1 variants | grep -vx gcc-O0)
for core in m4 m7; do
    start "$core" "$root/tools/firmware/emulate.sh" "$core" "$images/$core/replay.elf"
done
for variant in $others; do
    case $variant in
    arm-*) run=(qemu-arm "./$variant") ;;
    s390x-*) run=(qemu-s390x "./$variant") ;;
    powerpc-*) run=(qemu-ppc "./$variant") ;;
    *) run=("./$variant") ;;
    esac
    start "$variant" "${run[@]}"
done
wait
for variant in $others; do
    check "$variant: $(wc -l <"sums-$variant") logs, the bytes of gcc-O0" same_as_first \
        "sums-$variant"
done
for core in m4 m7; do
    check "Cortex-${core^}: the bytes of gcc-O0" same_as_first "sums-$core"
done

# Not the same nothing: every run has reports of tracks, and the gates do not all decide alike.
has_tracks() { awk '$1 != "steps" || $4 == 0 {bad = 1; print} END {exit bad || NR != 12}' \
    out-gcc-O0/said; }
check 'every run has tracks' has_tracks
check 'the gates differ where plots are ambiguous' test "$(sort -u -k1,1 "$reference" | wc -l)" \
    -ge 8

# The comparison can fail: the last bit of one constant of src/base/approx.c is another one.
seeded() {
    mkdir -p seeded &&
        sed 's/1.6666654611e-1f/1.6666656101e-1f/' "$root/src/base/approx.c" >seeded/approx.c &&
        ! cmp -s seeded/approx.c "$root/src/base/approx.c" &&
        sed "s|.*/src/base/approx.c|$PWD/seeded/approx.c|" sources >seeded/sources &&
        mapfile -t sources <seeded/sources &&
        build_replay ./seeded/replay gcc -O2 &&
        replay_all seeded/out ./seeded/replay >seeded/sums &&
        ! cmp -s seeded/sums "$reference"
}
check 'one bit of a constant would be seen' seeded
echo "sum over all: $(sha256sum <"$reference" | cut -c1-16)"
finish
