#!/bin/bash
# SPDX-License-Identifier: MIT
# `make fuzz` can fail: each seeded defect of the codec is found within 20 s, and the codec as it is passes.
set -u
cd "$(dirname "$0")/../.." || exit 1
seconds=20
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
passed=0
failed=0

if ! echo 'int LLVMFuzzerTestOneInput(const char *d, unsigned long n) { return d && n > 9; }' |
    clang -x c -fsanitize=fuzzer,address -o "$folder/probe" - 2>/dev/null; then
    echo 'skipped: fuzz gate: no clang with libFuzzer'
    echo '0 passed, 0 failed'
    exit 0
fi

build() { # codec
    clang -std=c11 -O1 -g -Iinclude -Isrc/wire -ffp-contract=off -fsanitize=fuzzer,address,undefined,integer \
        -fno-sanitize=unsigned-shift-base -fno-sanitize-recover=all -o "$folder/fuzz_message" \
        tests/fuzz/fuzz_message.c "$1" src/wire/message.c src/wire/message_names.c src/base/status.c
}

fuzz() {
    BUILD=$folder FUZZ_SECONDS_EACH=$1 tests/fuzz/run.sh "$folder/fuzz_message" >"$folder/output" 2>&1
}

must_find() { # what is wrong, sed expression that makes it so
    local start=$SECONDS
    sed -E "$2" src/wire/message_codec.c >"$folder/codec.c"
    if cmp -s src/wire/message_codec.c "$folder/codec.c" || ! build "$folder/codec.c"; then
        echo "FAIL $1: not seeded"
        failed=$((failed + 1))
    elif fuzz "$seconds" || ! grep -q '^FAIL fuzz_message' "$folder/output"; then
        echo "FAIL $1: not found in $seconds s"
        cat "$folder/output"
        failed=$((failed + 1))
    else
        echo "ok   $1: found after $((SECONDS - start)) s, build included"
        passed=$((passed + 1))
    fi
    rm -rf "$folder/fuzz"
}

must_find 'decode takes any count' 's/if \(\*count > format->max\)/if (0)/'
must_find 'decode takes one element too many' 's/if \(\*count > format->max\)/if (*count > format->max + 1u)/'
must_find 'decode takes short messages' 's/size - head < rest \? RHO_ERROR_SHORT/0 ? RHO_ERROR_SHORT/'
must_find 'decode does not look whether the head is there' 's/if \(size < head\)/if (0)/'
must_find 'decode takes trailing bytes' 's/size - head > rest \? RHO_ERROR_TRAILING/0 ? RHO_ERROR_TRAILING/'
must_find 'encode takes any count' 's/return RHO_ERROR_COUNT;$/(void)0;/'
must_find 'validate takes any count' 's/if \(count < 0 \|\| count > format->max\)/if (0)/'
must_find 'add goes beyond the list' 's/writer->count >= format->max/0/'
must_find 'add goes beyond the buffer' 's/writer->capacity - writer->size < format->element.wire_bytes/0/'

build src/wire/message_codec.c
if fuzz 5; then
    echo 'ok   the codec as it is: nothing found in 5 s'
    passed=$((passed + 1))
else
    echo 'FAIL the codec as it is:'
    cat "$folder/output"
    failed=$((failed + 1))
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
