#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Checks the C examples of a document: each ```c block with a main is compiled with gcc and clang,
# all warnings as errors, linked with the library, and run; it must exit with 0. Blocks without a
# main are only compiled. Usage: extract_example.sh [DOCUMENT [LIBRARY]]
set -eu
cd "$(dirname "$0")/../.."
document=${1:-README.md}
library=${2:-${BUILD:-build}/librhotrack.a}
folder=${BUILD:-build}/examples
flags='-std=c99 -Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow'
flags+=' -Wstrict-prototypes -Werror -Iinclude'

for needed in "$document" "$library"; do
    [ -f "$needed" ] || { echo "examples: there is no $needed"; exit 1; }
done
rm -rf "$folder"
mkdir -p "$folder"

# Each block keeps the line numbers of the document, so that the compiler's messages point into it.
awk -v folder="$folder" -v document="$document" '
    /^```c$/ {
        file = sprintf("%s/example%d.c", folder, ++count)
        printf "#line %d \"%s\"\n", NR + 1, document > file
        next
    }
    /^```/ {if (file) close(file); file = ""}
    file {print > file}' "$document"

programs=0
for source in "$folder"/*.c; do
    [ -f "$source" ] || { echo "examples: $document has no \`\`\`c block"; exit 1; }
    for compiler in gcc clang; do
        program=${source%.c}-$compiler
        # shellcheck disable=SC2086 # words on purpose
        if grep -q '\bmain *(' "$source"; then
            "$compiler" $flags -o "$program" "$source" "$library"
            "$(realpath "$program")" >"$program.out" || { echo \
                "examples: $source exits with $?"; exit 1; }
            programs=$((programs + 1))
        else
            "$compiler" $flags -c -o "$program.o" "$source"
        fi
    done
done
[ "$programs" -gt 0 ] || { echo "examples: no block of $document has a main"; exit 1; }
cat "$folder/example1-gcc.out" 2>/dev/null || true
echo "examples: $programs programs of $document ran"
