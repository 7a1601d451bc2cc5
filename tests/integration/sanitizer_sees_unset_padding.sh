#!/bin/bash
# SPDX-License-Identifier: MIT
# The memory sanitizer's part of `make sanitize` goes red for a byte of padding that two runs could
# differ in.
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v clang >/dev/null; then
    echo "skipped: clang is not installed"
    exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

compare() { # how the struct is made
    cat >"$folder/compare.c" <<END
#include <string.h>

struct padded { int numbers[9]; char letter; };

static __attribute__((noinline)) struct padded make(void)
{
    $1
    memset(made.numbers, 7, sizeof made.numbers);
    made.letter = 'p';
    return made;
}

static void the_bytes_are_the_same(void **state)
{
    struct padded one = make(), other;
    (void)state;
    memcpy(&other, &one, sizeof one);
    assert_memory_equal(&one, &other, sizeof one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_bytes_are_the_same)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
END
    clang -std=c11 -O1 -fsanitize=memory -fno-sanitize-recover=all \
        -include tests/unit/defined_memory.h \
        -o "$folder/compare" "$folder/compare.c" -lcmocka
    "$folder/compare" >"$folder/output" 2>&1
}

compare 'struct padded made; memset(&made, 0, sizeof made);' || { cat "$folder/output"; exit 1; }
if compare 'struct padded made;'; then
    echo "padding that nobody set was not seen"
    exit 1
fi
grep -q 'Uninitialized bytes in __msan_check_mem_is_initialized at offset 37' "$folder/output" \
    || { cat "$folder/output"; exit 1; }
echo "defined memory: 1 seeded fault seen"
