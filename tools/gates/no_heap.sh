#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Checks that the library contains no heap, stdio, errno, double, mutable globals or external
# symbols: searches the text of src/ and include/ (without comments and strings) and the symbols of
# $BUILD/librhotrack.a. Usage: no_heap.sh [ROOT [LIBRARY]]. Exit 1 where
# anything is found.
set -u
root=${1:-$(dirname "$0")/../..}
library=${2:-${BUILD:-build}/librhotrack.a}
cd "$root" || exit 1

words='malloc|calloc|realloc|free|(__builtin_)?alloca|strdup|\w*printf|puts|putchar|FILE|stdio'
words+='|stdlib|errno|double|goto|setjmp|longjmp'
bad=0

# report HEADING FINDINGS: prints the findings, a line each, and sets bad unless they are empty
report() {
    [ -n "$2" ] || return 0
    printf 'poison: %s\n%s\n' "$1" "$2" | sed '2,$s/^/    /'
    bad=1
}

# code_of FILE: prints its lines with comments and strings blanked, each after FILE:LINE
code_of() {
    perl -0777 -pe 's{(/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*")}{$1 =~ s/[^\n]/ /gr}gse' "$1" | awk \
        -v file="$1" '{print file ":" NR ": " $0}'
}

files=$(find src include -name '*.[ch]' | sort)
[ -n "$files" ] || { echo "poison: no sources under $(pwd)"; exit 1; }
report 'forbidden words in the sources' \
    "$(for file in $files; do code_of "$file"; done | grep -P "^[^ ]+ .*\b($words)\b")"

[ -f "$library" ] || { echo "poison: no $library: run make lib"; exit 1; }
report 'symbols that the library takes from elsewhere' \
    "$(nm -A -u "$library" | sed -nE 's/.*:([^:]+:) +U (.*)/\1 \2/p' | sort -u |
       grep -vE ' (rho_\w+|memcpy|memset|memmove|memcmp|_GLOBAL_OFFSET_TABLE_)$')"
report 'public symbols without the prefix rho_' \
    "$(nm -A -g --defined-only "$library" | sed -nE 's/.*:([^:]+:)[0-9a-f]+ (. .*)/\1 \2/p' |
       grep -vE ' rho_\w+$')"
# .data.rel.ro is allowed: constant tables of pointers, which the dynamic loader relocates once and
# then write-protects.
report 'mutable globals' \
    "$(objdump -t "$library" | awk '/file format/ {object = $1}
       (/ O .*\.(data|bss|tdata|tbss)/ || /\*COM\*/) && !/\.data\.rel\.ro/ {print object, $NF}')"

[ "$bad" -eq 0 ] || exit 1
echo "poison: $(echo "$files" | wc -l) files and $(nm "$library" 2>/dev/null |
    grep -c ' T ') public functions are clean"
