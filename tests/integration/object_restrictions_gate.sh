#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/object_restrictions.py passes on a clean little library, and goes red for each thing
# that it forbids, with file and function.
# Runs beside others.
set -eu
cd "$(dirname "$0")/../.."
BUILD=$(mktemp -d)
export BUILD
copy=$BUILD/copy
trap 'rm -rf "$BUILD"' EXIT
mkdir -p "$copy/src/base"
faults=0

if ! command -v arm-none-eabi-gcc >/dev/null; then
    echo 'skipped: gates: no arm-none-eabi-gcc here (tools/setup.sh installs it)'
    exit 0
fi

look() { # targets, source text of the only module
    printf '%s\n' "$2" >"$copy/src/base/sample.c"
    tools/gates/object_restrictions.py --target "$1" "$copy" >"$BUILD/output" 2>&1
}

must_pass() { # what, source
    look m0plus,m4f,m7 "$2" || {
        echo "object_restrictions.py refuses $1:"
        cat "$BUILD/output"
        exit 1
    }
}

must_fail() { # what, targets, source, the finding expected
    if look "$2" "$3"; then
        echo "object_restrictions.py did not see $1"
        exit 1
    fi
    grep -qF -- "$4" "$BUILD/output" || { echo "object_restrictions.py saw $1, but said:"; cat \
        "$BUILD/output"; exit 1; }
    faults=$((faults + 1))
}

must_pass 'arithmetic and copies' '#include <stdint.h>
#include <string.h>
float rho_f(float v, int64_t t) { return v / 3.0f + (float)(int32_t)(t / 1000) * v; }
void rho_copy(float *to, const float *from, int n) { memmove(to, from, (unsigned)n * sizeof *to); }
static int twice(int n) { return 2 * n; }
int rho_g(int n)
{
    static const char *const names[] = {"a", "b"};
    return twice(n) + names[n & 1][0];
}'

must_fail 'a heap' m4f '#include <stdlib.h>
void *rho_new(void) { return malloc(8); }' 'src/base/sample.c:2: rho_new: calls malloc (heap)'
must_fail 'free' m4f '#include <stdlib.h>
void rho_old(void *at) { free(at); }' 'src/base/sample.c:2: rho_old: calls free (heap)'
must_fail 'stdio' m4f '#include <stdio.h>
void rho_say(int n) { printf("%d", n); }' 'src/base/sample.c:2: rho_say: calls printf (stdio)'
must_fail 'errno' m4f '#include <errno.h>
int rho_last(void) { return errno; }' 'src/base/sample.c:2: rho_last: calls __errno (errno)'
must_fail 'a constant without f, soft float' m0plus \
    'float rho_f(float v) { return v * 0.1; }' \
    'src/base/sample.c:1: rho_f: calls __aeabi_dmul (double arithmetic)'
must_fail 'a constant without f, single precision in hardware' m4f \
    'float rho_f(float v) { return v * 0.1; }' \
    'src/base/sample.c:1: rho_f: calls __aeabi_f2d (double arithmetic)'
must_fail 'a float made of 64 bits' m0plus,m4f '#include <stdint.h>
float rho_f(int64_t v) { return (float)v; }' \
    'src/base/sample.c:2: rho_f: calls __aeabi_l2f (float and 64 bits'
must_fail '64 bits made of a float' m4f '#include <stdint.h>
int64_t rho_f(float v) { return (int64_t)v; }' \
    'src/base/sample.c:2: rho_f: calls __aeabi_f2lz (float and 64 bits'
must_fail 'libm, double' m7 '#include <math.h>
float rho_f(float v) { return (float)atan2(v, 2); }' \
    'src/base/sample.c:2: rho_f: calls atan2 (libm, double)'
must_fail 'libm, float' m4f '#include <math.h>
float rho_f(float v) { return expf(v); }' 'src/base/sample.c:2: rho_f: calls expf (libm, float)'
must_fail 'a square root that sets errno' m4f '#include <math.h>
float rho_f(float v) { return sqrtf(v); }' 'src/base/sample.c:2: rho_f: calls sqrtf (libm, float)'
must_fail 'a foreign function' m4f 'int other(int n);
int rho_f(int n) { return other(n) + 1; }' \
    "src/base/sample.c:2: rho_f: calls other (not the library's)"
must_fail 'a foreign object' m4f 'extern int level;
int rho_f(void) { return level; }' "src/base/sample.c: refers to level (not the library's)"
must_fail 'a counter of its own' m4f 'static int count;
int rho_next(void) { return ++count; }' 'src/base/sample.c: count: mutable global'
must_fail 'a static in a function' m4f \
    'int rho_next(void) { static int last = 3; return ++last; }' \
    'src/base/sample.c: last.0: mutable global'
must_fail 'a public variable' m4f 'int rho_level = 3;' \
    'src/base/sample.c: rho_level: mutable global'
must_fail 'recursion' m4f \
    'int rho_f(int n) { return n < 2 ? 1 : rho_f(n - 1) + rho_f(n - 2); }' \
    'src/base/sample.c:1: rho_f: recursion: rho_f > rho_f'
tail='int rho_f(int n, int sum) { return n == 0 ? sum : rho_f(n - 1, sum + n); }'
must_fail 'recursion that -Os makes a loop' m4f "$tail" 'rho_f > rho_f [Cortex-M4F -O0]'
must_fail 'two functions that call each other' m4f 'int rho_g(int n);
int rho_f(int n) { return n == 0 ? 1 : 3 * rho_g(n - 1); }
int rho_g(int n) { return n == 0 ? 0 : 5 * rho_f(n - 1); }' \
    'src/base/sample.c:2: rho_f: recursion: rho_f > rho_g > rho_f'
must_fail 'an array of variable length' m4f 'void rho_fill(char *at, int n);
int rho_f(int n) { char room[n]; rho_fill(room, n); return room[0]; }' \
    'src/base/sample.c:2: rho_f: frame grows at run time'
must_fail 'alloca' m4f 'void rho_fill(char *at, int n);
void rho_f(int n) { rho_fill(__builtin_alloca((unsigned)n), n); }' \
    'src/base/sample.c:2: rho_f: frame grows at run time'
must_fail 'a function pointer' m4f \
    'int rho_f(int (*of)(int), int n) { return of(n) + 1; }' \
    'src/base/sample.c:1: rho_f: calls by a pointer'
must_fail 'code that does not compile' m4f 'int rho_f(' 'src/base/sample.c:1'
echo "object_restrictions.py: $faults seeded faults seen"
