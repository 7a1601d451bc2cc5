#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/size.sh holds its bars as the sources are, and goes red where an object is too large or does not compile.
set -eu
cd "$(dirname "$0")/../.."
BUILD=$(mktemp -d)
export BUILD
trap 'rm -rf "$BUILD"' EXIT

tools/size.sh --bars

must_fail() { # what, flags, the message expected
    local output
    if output=$(SIZE_FLAGS=$2 tools/size.sh --bars 2>&1); then
        echo "size.sh did not see: $1"
        exit 1
    fi
    grep -q -- "$3" <<<"$output" || { echo "size.sh saw $1, but said: $output"; exit 1; }
}

must_fail 'more crossings than fit' -DRHO_MAX_PASSIVE_POINTS=2000 'embedded, .* 49152  MISSED'
must_fail 'more candidates than fit' -DRHO_MAX_PASSIVE_CANDIDATES=200 'workstation, .* 92160  MISSED'
must_fail 'a capacity beyond its range' -DRHO_MAX_PASSIVE_POINTS=8 'RHO_MAX_PASSIVE_POINTS must be'
echo 'size.sh: 3 seeded faults seen'
