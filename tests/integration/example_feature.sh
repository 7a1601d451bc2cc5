#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/example_feature.py builds and runs the worked example of src/DESIGN.md, and goes red
# for one that is too large, that cannot be applied, or that does not change what it says.
# Runs beside others.
here=$(realpath "$(dirname "$0")")
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"
root=$(realpath "$here/../..")
gate=$root/tools/gates/example_feature.py
unset BUILD
mkdir copy

# A feature: an unknown status has the name that a new file gives.
header='```c
/* src/base/unknown.h */
#define UNKNOWN_NAME "no status"
```'
included='```diff
--- a/src/base/status.c
+++ b/src/base/status.c
@@
-#include "rhotrack/types.h"
+#include "rhotrack/types.h"
+#include "unknown.h"
@@
-    return value < RHO_NUM_STATUS ? status_names[value] : "unknown";
+    return value < RHO_NUM_STATUS ? status_names[value] : UNKNOWN_NAME;
```'
program='```c
/* tests/unknown_status.c */
#include <string.h>
#include "rhotrack/types.h"
int main(void) { return strcmp(rho_status_name((enum rho_status)99), "no status") != 0; }
```'
far=$'#include "rhotrack/tracker.h"\n'
many=$(printf '/* */%.0s\n' {1..40})$'\n'
document() { # blocks
    printf '# Design\n\n## Where does my feature go?\n\nText.\n'
    printf '\n%s\n' "$@"
    printf '\n## Other\n\n```c\nnot C\n```\n'
}
holds() { # words of the message, blocks
    document "${@:2}" >document.md
    "$gate" document.md copy >said 2>&1 && grep -qF -- "$1" said || { cat said; return 1; }
}
fails() { # words of the message, blocks
    local status=0
    document "${@:2}" >document.md
    "$gate" document.md copy >said 2>&1 || status=$?
    [ "$status" -eq 1 ] && grep -qF -- "$1" said || { cat said; return 1; }
}

check 'an example holds' holds '2 files, 4 added lines' "$header" "$included" "$program"
check 'one without its list fails' fails 'its test fails with the feature' "$header" "$program"
check 'one whose test the library passes fails' fails 'its test passes without the feature' \
    "$header" "$included" "${program/!= 0/> 99}"
check 'one that does not compile fails' fails 'the library does not build' "${header/NAME/OTHER}" \
    "$included" "$program"
check 'one of a forbidden include fails' fails 'may not include' "$included" "$program" \
    "${header/\#define/$far#define}"
check 'one whose place is not there fails' fails '0 places with the lines of a hunk' "$header" \
    "${included/types.h/typos.h}" "$program"
check 'one of three files fails' fails '3 files' "$header" "${header/unknown/other}" "$included" \
    "$program"
check 'one of many lines fails' fails '44 added lines, at most 40' "$included" "$program" \
    "${header/\#define/$many#define}"
check 'one without a test fails' fails 'no block is a test program' "$header" "$included"
check 'one without a name fails' fails 'at line 7 names no file' "${header/src/a file}" "$program"
check 'a document without the section is told' eval '! "$gate" "$root/CHANGELOG.md" >said &&
    grep -q "has no section" said'

if grep -q '^#* Where does my feature go?$' "$root/src/DESIGN.md"; then
    check 'the example of src/DESIGN.md holds' "$gate" "$root/src/DESIGN.md" copy
else
    echo 'skipped: src/DESIGN.md has no worked example'
fi
finish
