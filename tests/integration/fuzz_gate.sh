#!/bin/bash
# SPDX-License-Identifier: MIT
# `make fuzz` can fail: each defect seeded in the codec, a reader or the tracker is found within 40
# s, a hang too, and all pass as they are. Runs beside others.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=${BUILD:-build}
seconds=40
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

flags='-std=c11 -D_GNU_SOURCE -O1 -g -Iinclude -Isrc/wire -Itests -Itools/rhotrack -ffp-contract=off
    -fsanitize=fuzzer,address,undefined,float-cast-overflow -fno-sanitize-recover=all'

# shellcheck disable=SC2086 # words on purpose
build_message() { # codec
    clang $flags -fsanitize=integer -fno-sanitize=unsigned-shift-base -o "$folder/fuzz_message" \
        tests/fuzz/fuzz_message.c "$1" src/wire/message_types.c \
        src/wire/message_names.c src/base/status.c
}

wraps=$(grep -o '__wrap_[a-z_]*' tests/fuzz/catch_reader_fail.c | sort -u |
    sed 's/__wrap_/-Wl,--wrap=/')

# The other parts are the program's own objects.
# shellcheck disable=SC2086
build_of_program() { # target, file of the program
    clang $flags -Itools/rhotrack/scene -DRHO_PROFILE_WORKSTATION $wraps -o "$folder/$1" \
        "tests/fuzz/$1.c" \
        tests/fuzz/catch_reader_fail.c "$2" "$folder/program.a" "$build/workstation/librhotrack.a" \
        -lcsv -linih -lcjson -lproj -lpcap -pthread -lm
}
build_tables() { build_of_program fuzz_tables "$1"; }
build_config() { build_of_program fuzz_config "$1"; }
build_scene() { build_of_program fuzz_scene "$1"; }

# All of the library, small, but the seeded file.
small="$flags -DRHO_CONFIG_FILE=\"tests/fuzz/small_capacities.h\" -I. $(printf -- '-I%s ' src/*/)"
# shellcheck disable=SC2086
build_tracker_small() { # file of the library
    clang ${small/fuzzer,/fuzzer-no-link,} -c -o "$folder/seeded.o" "$1" &&
        clang $small -o "$folder/fuzz_tracker_small" tests/fuzz/fuzz_tracker.c "$folder/seeded.o" \
            "$folder/small.a" -lm
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
    # the room's own header, found beside the file before those of other rooms
    rm -f "$folder/policy.h"
    [ ! -f "${2%/*}/policy.h" ] || cp "${2%/*}/policy.h" "$folder"
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

must_find 'decode takes any count' 's/if \(count > format->max\)/if (0)/'
must_find 'decode takes one element too many' \
    's/if \(count > format->max\)/if (count > format->max + 1u)/'
must_find 'decode takes short messages' \
    's/if \(size - head != rest\)/if (size - head > rest)/'
must_find 'decode does not look whether the head is there' 's/if \(size < head\)/if (0)/'
must_find 'decode takes trailing bytes' \
    's/if \(size - head != rest\)/if (size - head < rest)/'
must_find 'encode takes any count' 's/return RHO_ERROR_COUNT;$/(void)0;/'
must_find 'validate takes any count' 's/if \(count < 0 \|\| count > format->max\)/if (0)/'
must_find 'add goes beyond the list' 's/writer->count >= format->max/0/'
must_find 'add goes beyond the buffer' \
    's/writer->capacity - writer->size < format->element.wire_bytes/0/'

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
if FUZZ_GRACE_SECONDS=1 fuzz fuzz_hangs 1 || ! grep -q '^FAIL fuzz_hangs: exit 137' \
    "$folder/output"; then
    missed 'a target that hangs: not told'
else
    found 'a target that hangs: told'
fi

must_pass fuzz_message src/wire/message_codec.c

# shellcheck disable=SC2086
compile_small() { # file: its object
    local object=$folder/small/${1//\//_}.o
    clang ${small/fuzzer,/fuzzer-no-link,} -c -o "$object" "$1"
}
mkdir -p "$folder/small"
export -f compile_small
export folder small
if ! printf '%s\n' src/*/*.c | xargs -P "$(nproc)" -I FILE bash -c 'compile_small FILE'; then
    missed 'the library, small: it does not build'
fi
ar rcs "$folder/small.a" "$folder"/small/*.o

tracker_must_find() { seeded fuzz_tracker_small "$@"; } # file, what is wrong, sed expression

tracker_must_find src/step/report.c 'a fate that is not counted' \
    's/(RHO_FATE_STALE\] \+= others);/\1 - (others > 2);/'
tracker_must_find src/step/report.c 'a covariance that is none' \
    's/^( +memcpy\(out->covariance, at->kalman.covariance.*)/\1 out->covariance[1] += '\
'9.0f * (out->covariance[0] + out->covariance[2]);/'
tracker_must_find src/step/begin.c \
    'a scan that is too late, and changes the density' \
    's/(counters.scans_late = rho_count.*)/\1 tracker->unclaimed_plots += 1.0f;/'
tracker_must_find src/tracker/track_life.c 'an end that is not told' \
    's/(report->ended\[[^;]*;)/if (track->track_id != 3) \1/'
tracker_must_find src/step/track_starts.c 'an identity that comes again' \
    's/next_track_id == UINT32_MAX \? 1/next_track_id == 7 ? 1/'
tracker_must_find src/initiation/search_budget.c 'a search without its limit' \
    's/return rho_search_work_spent\(search\) > search->limit_units;/return 0;/'
tracker_must_find src/bearings/recent_bearing_frames.c \
    'a batch that is unsound for its times' \
    's/(k > 0 \&\& batch->time_us\[k\] <= )/batch->time_us[k] < 0 || \1/'
tracker_must_find src/step/operator.c 'an identity given to two tracks' \
    's/rho_tracker_find_row\(tracker, new_id\) < RHO_MAX_TRACKS/0/'
tracker_must_find src/estimation/body_extent_filter.c 'a body of negative width' \
    's/(shape->width_m =) (side_length_m)/\1 -\2/'
must_pass fuzz_tracker_small src/step/report.c

objects=$(find "$build/program/tools/rhotrack" -name '*.o' ! -name main.o 2>/dev/null)
if [ -z "$objects" ] || [ ! -f "$build/workstation/librhotrack.a" ]; then
    echo 'skipped: fuzz gate: defects of the readers, as the program is not built'
else
    # shellcheck disable=SC2086
    ar rcs "$folder/program.a" $objects "$build/program/scenes.o"
    seeded fuzz_config tools/rhotrack/settings/parameters.c 'parameters beyond their limits' \
        's/number < text->min \|\| number > text->max/0/'
    seeded fuzz_scene tools/rhotrack/scene/scene_read.c 'a scene whose text is not given back' \
        's/^    free\(text\);$//'
    seeded fuzz_tables tools/rhotrack/io/csv/row_cells.c \
        'numbers beyond their limits' \
        's/number < min \|\| number > max/0/'
    seeded fuzz_tables tools/rhotrack/io/csv/csv_table.c \
        'a table that is not given back' \
        's/free\(table->text\);//'
    must_pass fuzz_tables tools/rhotrack/io/csv/csv_table.c
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
