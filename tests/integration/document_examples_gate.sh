#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/extract_example.sh runs the C blocks of a document, and goes red for one that is
# wrong. Runs beside others.
set -eu
cd "$(dirname "$0")/../.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
library=$(realpath "$(dirname "$RHOTRACK")/librhotrack.a")
export BUILD=$folder/build

document() { # body of main
    printf '# Title\n\n```sh\nnot C\n```\n\n```c\n#include "rhotrack/types.h"\n'\
'int main(void) { %s }\n```\n' "$1"
}

must_fail() { # what, document, the message expected
    printf '%s\n' "$2" >"$folder/document.md"
    if tools/gates/extract_example.sh "$folder/document.md" "$library" >"$folder/output" 2>&1; then
        echo "extract_example.sh did not see $1"
        exit 1
    fi
    grep -qF -- "$3" "$folder/output" || { echo "it saw $1, but said:"; cat \
        "$folder/output"; exit 1; }
}

document 'return rho_status_name(RHO_OK)[0] == 0;' >"$folder/document.md"
tools/gates/extract_example.sh "$folder/document.md" "$library"
must_fail 'an example that fails' "$(document 'return 3;')" 'exits with 3'
must_fail 'a warning, by the line of the document' "$(document 'int unused; return 0;')" \
    'document.md:9'
must_fail 'a document without examples' '# Title' 'no ```c block'
echo 'extract_example.sh sees what it must'
