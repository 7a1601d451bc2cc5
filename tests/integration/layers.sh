#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/layers.py passes on the sources as they are, and goes red for each kind of forbidden
# include.
# Runs beside others.
set -eu
cd "$(dirname "$0")/../.."
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT

fresh_copy() {
    rm -rf "${copy:?}"/*
    cp -R src include "$copy"
}

must_fail() { # what, the message expected
    local output
    if output=$(tools/gates/layers.py "$copy" "$copy/build"); then
        echo "layers.py did not see: $1"
        exit 1
    fi
    grep -qF -- "$2" <<<"$output" || { echo "layers.py saw $1, but said: $output"; exit 1; }
}

fresh_copy
tools/gates/layers.py "$copy" "$copy/build"

seed() { # file (relative to the copy), line, the message expected
    fresh_copy
    echo "$2" >>"$copy/$1"
    must_fail "$2 in $1" "$1:$(wc -l <"$copy/$1"): $3"
}
seed include/rhotrack/detail/linalg.h '#include "rhotrack/tracker.h"' \
    'base may not include rhotrack/tracker.h of tracker'
seed include/rhotrack/detail/gate.h '#include "rhotrack/detail/window.h"' \
    'association may not include'
seed src/window/window.c '#include "rhotrack/detail/kalman.h"' 'window may not include'
seed src/tracker/coverage.c '#include "rhotrack/operator.h"' \
    'tracker may not include rhotrack/operator.h of step'
seed src/base/angle.c '#include <stdio.h>' 'system header <stdio.h>'
seed src/base/angle.c '#include "../tracker/step.h"' 'base may not include ../tracker/step.h'
seed include/rhotrack/tracker.h '#include "../../src/tracker/step.h"' 'private header'
seed src/base/angle.c '#include SOME_MACRO' 'include of a macro'
seed src/base/angle.c '#include "rhotrack/nothing.h"' 'there is no header'

fresh_copy
printf 'int rho_one(void)\n{\n#if RHO_SECTORS\n    return 1;\n#endif\n    return 0;\n}\n' \
    >>"$copy/src/base/angle.c"
must_fail 'a condition inside a function' \
    "src/base/angle.c:$(($(wc -l <"$copy/src/base/angle.c") - 4)): #if inside a function"

fresh_copy
mkdir "$copy/src/strangers"
touch "$copy/src/strangers/stranger.c"
must_fail 'a room without a row' 'src/strangers/stranger.c:1: room strangers has no row'

fresh_copy
printf '/* #include <stdio.h> */\n' >>"$copy/src/base/angle.c"
tools/gates/layers.py "$copy" "$copy/build" >/dev/null || { echo \
    'layers.py reads comments'; exit 1; }

fresh_copy
sed -i 's/^## Rooms/## Other/' "$copy/src/DESIGN.md"
must_fail 'a missing table' 'no table of rooms'
# Objects, each needing a function of the other.
needs() { # folder of the build, file, its own function, the function that it needs
    mkdir -p "$copy/$(dirname "$2")" "$copy/build/$1/$(dirname "$2")"
    printf 'int %s(void);\nint %s(void);\nint %s(void) { return %s(); }\n' "$4" "$3" "$3" "$4" \
        >"$copy/$2"
    ${CC:-gcc} -c -o "$copy/build/$1/${2%.c}.o" "$copy/$2"
}
fresh_copy
needs embedded src/base/angle.c one two
needs embedded src/base/approx.c two one
must_fail 'a circle of two files' \
    'circle of 2 files: src/base/angle.c needs src/base/approx.c (two); src/base/approx.c needs'
fresh_copy
needs program tools/rhotrack/io/one.c one two
needs program tools/rhotrack/live/two.c two three
needs program tools/rhotrack/three.c three one
must_fail 'a circle of three files' 'circle of 3 files: tools/rhotrack/io/one.c'
fresh_copy
needs program tools/rhotrack/main.c one two
needs program tools/lab/c/two.c two three
must_fail 'a product that needs the lab' \
    'tools/rhotrack/main.c needs tools/lab/c/two.c of the lab (two)'
echo 'layers.py sees what it must'
