#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/library_size.sh finds tools/lab/MEASUREMENTS.md true and holds its bars as the sources
# are. It goes red where the page says something else, where code has grown, and where an object is
# too large or does not compile.
set -eu
cd "$(dirname "$0")/../.."
common=$(realpath -m "${BUILD:-build}")
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
faults=0

BUILD=$common tools/gates/library_size.sh >"$copy/sizes" || { cat "$copy/sizes"; exit 1; }
grep '^skipped' "$copy/sizes" || true

must_fail() { # what, the message expected, command...
    local what=$1 message=$2 output
    shift 2
    if output=$("$@" 2>&1); then
        echo "library_size.sh did not see: $what"
        exit 1
    fi
    grep -q -- "$message" <<<"$output" || {
        echo "library_size.sh saw $what, but said: $output"
        exit 1
    }
    faults=$((faults + 1))
}

# The objects that are there are used again: only what a fault changes is compiled.
mkdir "$copy/build"
cp -r "$common/cross" "$copy/build"
export BUILD=$copy/build

bars() { SIZE_FLAGS=$1 tools/gates/library_size.sh --bars; }
must_fail 'more crossings than fit' 'embedded, .* 49152  MISSED' bars -DRHO_MAX_PASSIVE_POINTS=2000
must_fail 'more candidates than fit' 'workstation, .* 131072  MISSED' bars \
    -DRHO_MAX_PASSIVE_CANDIDATES=200
must_fail 'a capacity beyond its range' RHO_MAX_PASSIVE_POINTS_must_be_16 bars \
    -DRHO_MAX_PASSIVE_POINTS=8

if ! grep -q '^skipped' "$copy/sizes"; then
    cp -r src include tools "$copy"
    page=$copy/tools/lab/MEASUREMENTS.md
    compared=(tools/gates/library_size.sh --page "$page")
    "${compared[@]}" >/dev/null || { echo 'library_size.sh refuses a copy'; exit 1; }

    sed -i -E '/^\| report of a step/s/[0-9]{4}/1234/' "$page"
    must_fail 'a figure of the page' '^-| report of a step .* 1234' "${compared[@]}"
    cp tools/lab/MEASUREMENTS.md "$page"
    sed -i '/^| wire /d' "$page"
    must_fail 'a row that is missing' '^+| wire ' "${compared[@]}"
    cp tools/lab/MEASUREMENTS.md "$page"
    sed -i '/written by make size-update/d' "$page"
    must_fail 'a page without its mark' 'no place for .sizes.' "${compared[@]}"
    cp tools/lab/MEASUREMENTS.md "$page"

    sed -i 's/arm-none-eabi-gcc [0-9.]*/arm-none-eabi-gcc 99.1.0/' "$page"
    "${compared[@]}" | grep '^skipped: MEASUREMENTS.md is of arm-none-eabi-gcc 99.1.0' >/dev/null ||
        { echo 'library_size.sh compares with another compiler'; exit 1; }
    cp tools/lab/MEASUREMENTS.md "$page"

    echo 'float rho_more(float v); float rho_more(float v) { return v * v + 1.0f; }' \
        >>"$copy/src/base/angle.c"
    must_fail 'code that has grown' '^+| base and measurement ' "$copy/tools/gates/library_size.sh"
    "$copy/tools/gates/library_size.sh" --update
    "$copy/tools/gates/library_size.sh" >/dev/null || {
        echo 'library_size.sh --update did not write what is'
        exit 1
    }
    cp src/base/angle.c "$copy/src/base"

    sed -i '/^float rho_angle_wrap/,/^{/ s/^{$/{\n    volatile char room[512];\n    room[0] = 0;/' \
        "$copy/src/base/angle.c"
    must_fail 'a stack that has grown' '^+| base .* 5[0-9][0-9] .* rho_angle' \
        "$copy/tools/gates/library_size.sh"
fi
echo "size.sh: $faults seeded faults seen"
