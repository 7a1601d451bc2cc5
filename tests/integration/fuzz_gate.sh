#!/bin/bash
# SPDX-License-Identifier: MIT
# `make fuzz` can fail: each defect seeded in the codec or a reader is found within 20 s, a hang too, and both pass as they are.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=${BUILD:-build}
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

flags='-std=c11 -D_GNU_SOURCE -O1 -g -Iinclude -Isrc/wire -Itools/rhotrack -ffp-contract=off
    -fsanitize=fuzzer,address,undefined,float-cast-overflow -fno-sanitize-recover=all'

# shellcheck disable=SC2086 # words on purpose
build_message() { # codec
    clang $flags -fsanitize=integer -fno-sanitize=unsigned-shift-base -o "$folder/fuzz_message" \
        tests/fuzz/fuzz_message.c "$1" src/wire/message.c src/wire/message_names.c src/base/status.c
}

wraps=$(grep -o '__wrap_[a-z_]*' tests/fuzz/refusal.c | sort -u | sed 's/__wrap_/-Wl,--wrap=/')

# The other parts are the program's own objects.
# shellcheck disable=SC2086
build_tables() { # reader
    clang $flags -DRHO_PROFILE_WORKSTATION $wraps -o "$folder/fuzz_tables" tests/fuzz/fuzz_tables.c tests/fuzz/refusal.c "$1" \
        "$folder/program.a" "$build/workstation/librhotrack.a" -lcsv -linih -lcjson -lproj -pthread -lm
}

fuzz() { # target, seconds
    BUILD=$folder FUZZ_SECONDS_EACH=$2 tests/fuzz/run.sh "$folder/$1" >"$folder/output" 2>&1
}

found() { # what
    echo "ok   $1"
    passed=$((passed + 1))
}

missed() { # what, and what the fuzzer said
    echo "FAIL $1"
    [ -f "$folder/output" ] && cat "$folder/output"
    failed=$((failed + 1))
}

seeded() { # target, file, what is wrong, sed expression that makes it so
    local start=$SECONDS
    sed -E "$4" "$2" >"$folder/seeded.c"
    if cmp -s "$2" "$folder/seeded.c" || ! "build_${1#fuzz_}" "$folder/seeded.c"; then
        missed "$3: not seeded"
    elif fuzz "$1" "$seconds" || ! grep -q "^FAIL $1" "$folder/output"; then
        missed "$3: not found in $seconds s"
    else
        found "$3: found after $((SECONDS - start)) s, build included"
    fi
    rm -rf "$folder/fuzz"
}

must_find() { seeded fuzz_message src/wire/message_codec.c "$@"; } # what is wrong, sed expression

must_find 'decode takes any count' 's/if \(\*count > format->max\)/if (0)/'
must_find 'decode takes one element too many' 's/if \(\*count > format->max\)/if (*count > format->max + 1u)/'
must_find 'decode takes short messages' 's/size - head < rest \? RHO_ERROR_SHORT/0 ? RHO_ERROR_SHORT/'
must_find 'decode does not look whether the head is there' 's/if \(size < head\)/if (0)/'
must_find 'decode takes trailing bytes' 's/size - head > rest \? RHO_ERROR_TRAILING/0 ? RHO_ERROR_TRAILING/'
must_find 'encode takes any count' 's/return RHO_ERROR_COUNT;$/(void)0;/'
must_find 'validate takes any count' 's/if \(count < 0 \|\| count > format->max\)/if (0)/'
must_find 'add goes beyond the list' 's/writer->count >= format->max/0/'
must_find 'add goes beyond the buffer' 's/writer->capacity - writer->size < format->element.wire_bytes/0/'

must_pass() { # target, file
    if "build_${1#fuzz_}" "$2" && fuzz "$1" 5; then
        found "$1: nothing found in $2 as it is, 5 s"
    else
        missed "$1, $2 as it is"
    fi
    rm -rf "$folder/fuzz"
}
# A target that hangs fails, and the others are still run.
printf '#!/bin/bash\ntrap "" TERM\nwhile :; do sleep 1; done\n' >"$folder/fuzz_hangs"
chmod +x "$folder/fuzz_hangs"
if FUZZ_GRACE_SECONDS=1 fuzz fuzz_hangs 1 || ! grep -q '^FAIL fuzz_hangs: exit 137' "$folder/output"; then
    missed 'a target that hangs: not told'
else
    found 'a target that hangs: told'
fi

must_pass fuzz_message src/wire/message_codec.c

objects=$(find "$build/program/tools/rhotrack" -name '*.o' ! -name main.o 2>/dev/null)
if [ -z "$objects" ] || [ ! -f "$build/workstation/librhotrack.a" ]; then
    echo 'skipped: fuzz gate: defects of the readers, as the program is not built'
else
    # shellcheck disable=SC2086
    ar rcs "$folder/program.a" $objects
    seeded fuzz_tables tools/rhotrack/row_check.c 'numbers beyond their limits' 's/number < min \|\| number > max/0/'
    seeded fuzz_tables tools/rhotrack/table.c 'a table that is not given back' 's/free\(table->text\);//'
    must_pass fuzz_tables tools/rhotrack/table.c
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
