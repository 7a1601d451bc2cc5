#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/layers.py passes on the sources as they are, and goes red for each kind of forbidden include.
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
    if output=$(tools/layers.py "$copy"); then
        echo "layers.py did not see: $1"
        exit 1
    fi
    grep -qF -- "$2" <<<"$output" || { echo "layers.py saw $1, but said: $output"; exit 1; }
}

fresh_copy
tools/layers.py "$copy"

seed() { # file (relative to the copy), line, the message expected
    fresh_copy
    echo "$2" >>"$copy/$1"
    must_fail "$2 in $1" "$1:$(wc -l <"$copy/$1"): $3"
}
seed include/rhotrack/linalg.h '#include "rhotrack/tracker.h"' 'linalg may not include tracker'
seed include/rhotrack/gate.h '#include "rhotrack/window.h"' 'gate may not include window'
seed src/base/status.c '#include "rhotrack/types.h"' 'status may not include types'
seed src/base/angle.c '#include <stdio.h>' 'system header <stdio.h>'
seed src/base/angle.c '#include "../tracker/private.h"' 'private header'
seed src/base/angle.c '#include SOME_MACRO' 'include of a macro'

fresh_copy
touch "$copy/src/base/stranger.c"
must_fail 'a file without a module' 'src/base/stranger.c:1: belongs to no module'

fresh_copy
printf '/* #include <stdio.h> */\n' >>"$copy/src/base/angle.c"
tools/layers.py "$copy" >/dev/null || { echo 'layers.py reads comments'; exit 1; }

fresh_copy
sed -i 's/^## Modules/## Other/' "$copy/src/DESIGN.md"
must_fail 'a missing table' 'no module table'
echo 'layers.py sees what it must'
