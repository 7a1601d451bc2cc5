#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/no_heap.sh passes on a clean little library, and goes red for
# each thing that it forbids.
set -eu
cd "$(dirname "$0")/../.."
top=$(pwd)
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
mkdir -p "$copy/src/base" "$copy/include/rhotrack"

build() { # source text of the only module
    printf '%s\n' "$1" >"$copy/src/base/sample.c"
    rm -f "$copy/sample.a"
    gcc -std=c99 -O1 -c -o "$copy/sample.o" "$copy/src/base/sample.c"
    ar rcs "$copy/sample.a" "$copy/sample.o"
}

must_pass() { # what, source
    build "$2"
    "$top/tools/gates/no_heap.sh" "$copy" "$copy/sample.a" >"$copy/output" ||
        { echo "no_heap.sh refuses $1:"; cat "$copy/output"; exit 1; }
}

must_fail() { # what, source, the heading expected, the finding expected
    build "$2"
    if "$top/tools/gates/no_heap.sh" "$copy" "$copy/sample.a" \
        >"$copy/output"; then
        echo "no_heap.sh did not see $1"
        exit 1
    fi
    { grep -qF -- "$3" "$copy/output" && grep -qF -- "    $4" "$copy/output"; } ||
        { echo "no_heap.sh saw $1, but said:"; cat "$copy/output"; exit 1; }
}

must_pass 'clean code' 'float rho_twice(float v) { return v + v; }'
must_pass 'words in comments and strings' \
    'const char *rho_name(void) { return "free"; } /* never malloc(), no double */'
must_pass 'a constant table of pointers' \
    'static const char *const names[] = {"a", "b"}; '\
'const char *rho_name(int i) { return names[i]; }'
word() { # source: its last line has the word
    must_fail "$1" "$1" 'forbidden words in the sources' \
        "src/base/sample.c:$(wc -l <<<"$1"): $(tail -n 1 <<<"$1")"
}
word 'double rho_twice(float v) { return v + v; }'
word 'void *malloc(unsigned long); void *rho_new(void) { return malloc(8); }'
word 'void free(void *); void rho_old(void *at) { free(at); }'
word 'int rho_f(int n) { volatile char *room = __builtin_alloca((unsigned)n); return room[0]; }'
word '#include <stdio.h>'
word 'int printf(const char *, ...); void rho_say(const char *text) { printf(text); }'
word '#include <errno.h>
int rho_last(void) { return errno; }'
word 'int rho_f(int n) { if (n) goto end; n = 1; end: return n; }'
must_fail 'a function of libm' 'float sinf(float); float rho_f(float v) { return sinf(v); }' \
    'takes from elsewhere' 'sample.o: sinf'
must_fail 'a counter of its own' \
    'int rho_count(void); static int n; int rho_count(void) { return ++n; }' \
    'mutable globals' 'sample.o: n'
must_fail 'a public variable' 'int rho_level = 3;' 'mutable globals' 'sample.o: rho_level'
must_fail 'a name without prefix' 'int helper(int v); int helper(int v) { return v; }' \
    'without the prefix' 'sample.o: T helper'
echo 'no_heap.sh sees what it must'
