#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/codegen: what is checked in is what it writes, a change of either is named, and each of its
# rules is kept. Runs beside others.
set -u
cd "$(dirname "$0")/../.." || exit 1
top=$(pwd)
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
passed=0
failed=0

fresh() {
    rm -rf "$copy/tree"
    mkdir -p "$copy/tree/include/rhotrack" "$copy/tree/src/wire"
    cp -r lcm_types "$copy/tree"
    cp include/rhotrack/message.h "$copy/tree/include/rhotrack"
    cp src/wire/message_types.c src/wire/message_names.c "$copy/tree/src/wire"
}

codegen() { # arguments
    status=0
    "$top/tools/codegen/generate_lcm_codec.py" "$@" "$copy/tree" >"$copy/output" 2>&1 || status=$?
}

says() { # text; none: no output at all
    ! grep -q Traceback "$copy/output" || return
    if [ -n "$1" ]; then grep -qF -- "$1" "$copy/output"; else [ ! -s "$copy/output" ]; fi
}

expect() { # name, exit code, what it says
    if [ "$status" -eq "$2" ] && says "${3-}"; then
        echo "ok   $1"
        passed=$((passed + 1))
    else
        echo "FAIL $1: exit $status, expected $2 and '${3-}', got:"
        head -n 5 "$copy/output" | sed 's/^/     /'
        failed=$((failed + 1))
    fi
}

# ---- What is checked in ----

fresh
codegen --check
expect 'the tree as it is' 0

stale() { # file
    fresh
    sed -i '$ s/$/ /' "$copy/tree/$1"
    codegen --check
    expect "$1 edited by hand" 1 "$1: not what lcm_types/ says; run make codegen"
    codegen
    expect "$1 written anew" 0 "codegen: $1"
    status=0
    cmp "$1" "$copy/tree/$1" >"$copy/output" 2>&1 || status=$?
    expect '... as it was' 0
}
stale include/rhotrack/message.h
stale src/wire/message_types.c
stale src/wire/message_names.c

changed() { # what, sed expression for plot_t.lcm, file that it changes
    fresh
    sed -i "$2" "$copy/tree/lcm_types/plot_t.lcm"
    codegen --check
    expect "$1 changes $3" 1 "$3: not what lcm_types/ says"
}
changed "a member's name" 's/snr_db/snr_dB/' lcm_types/README.md
changed "a member's name" 's/snr_db/snr_dB/' src/wire/message_names.c
changed "a member's type" 's/float   snr_db/int32_t snr_db/' include/rhotrack/message.h
changed "a member's range" 's/-1000 \.\. 1000/-1000 .. 1001/' src/wire/message_types.c
changed 'a comment' 's/east, m/eastwards, m/' include/rhotrack/message.h
fresh
sed -i 's,^    int32_t dt_us.*,&\n    // what follows,' "$copy/tree/lcm_types/plot_t.lcm"
codegen --check
expect 'a comment in a line and column of its own belongs to no member' 0

fresh
rm "$copy/tree/src/wire/message_types.c"
codegen --check
expect 'a generated file that is not there' 1 'src/wire/message_types.c: not what'
fresh
rm "$copy"/tree/lcm_types/*.lcm
codegen --check
expect 'no .lcm files' 1 'lcm_types: no .lcm files'
fresh
sed -i '/made by tools.codegen/d' "$copy/tree/lcm_types/README.md"
codegen --check
expect 'a README without the table' 1 'README.md: no lines'
codegen --nonsense
expect 'an option that is not there' 1 'Usage:'

# ---- Rules ----

# The lines stand in a struct of their own; the message names the file, and the line where it is one
# member's.
refuse() { # what, line of the file, text, the struct's lines...
    local what=$1 line=$2 text=$3
    shift 3
    fresh
    { printf '// Odd.\npackage rhotrack;\nstruct odd_t\n{\n'; printf '%s\n' "$@"; printf '}\n'; } \
        >"$copy/tree/lcm_types/odd_t.lcm"
    codegen
    expect "$what" 1 "lcm_types/odd_t.lcm:$line: $text"
}
one='int32_t x;'
refuse 'a list that is not last' 8 'a: a list must be the last member' \
    'const int16_t MAX_A = 2;' "$one" 'int16_t num;' 'float a[num];' 'float b;'
refuse 'a count of 32 bits' 8 'a: its int16_t count must stand right before it' \
    'const int16_t MAX_A = 2;' "$one" 'int32_t num;' 'float a[num];'
refuse 'a count elsewhere' 9 'a: its int16_t count must stand right before it' \
    'const int16_t MAX_A = 2;' 'int16_t num;' "$one" 'int16_t y;' 'float a[num];'
refuse 'a list without capacity' 7 'const int16_t MAX_A is missing' "$one" 'int16_t num;' \
    'float a[num];'
refuse 'a capacity of 0' 8 'MAX_A is not within' 'const int16_t MAX_A = 0;' "$one" 'int16_t num;' \
    'float a[num];'
refuse 'a member with members' 6 'p: only a list may have members of its own' "$one" 'plot_t p;'
refuse 'an array of structs' 6 'p: only a list may have members of its own' "$one" 'plot_t p[3];'
refuse 'a type that is not known' 8 'a: there is no struct blob_t without a list' \
    'const int16_t MAX_A = 2;' "$one" 'int16_t num;' 'blob_t a[num];'
refuse 'a list of lists' 8 'a: there is no struct bearing_scan_t without a list' \
    'const int16_t MAX_A = 2;' "$one" 'int16_t num;' 'bearing_scan_t a[num];'
refuse 'a list of bare integers' 8 'a: a list of bare numbers must be of float' \
    'const int16_t MAX_A = 2;' "$one" 'int16_t num;' 'int16_t a[num];'
refuse 'double' 5 'd: only a list may have members of its own, and no double' 'double d;'
refuse 'a string' 5 's: only a list may have members of its own, and no string' 'string s;'
refuse 'an array of nothing' 5 'a: an array of nothing' 'float a[0];'
refuse 'two dimensions' 5 'no member that is understood' 'float a[2][3];'
refuse 'a message beyond a datagram' 1 \
    '1480 bytes with header and channel do not fit a datagram of 1472' \
    'const int16_t MAX_A = 359;' 'int16_t x;' 'int16_t num;' 'float a[num];'
refuse 'no semicolon' 5 'no ; at the end' 'int32_t x'
refuse 'a struct without members' 1 'odd_t has no members'
refuse 'another struct in the file' 7 'one struct a file' "$one" '}' 'struct more_t' '{' "$one"
refuse 'a constant that is no number' 5 'no constant that is understood' 'const int8_t A = B;' \
    "$one"
refuse 'a choice that is no constant' 5 's: C is no constant of odd_t' 'int8_t s; // one {C}'
refuse 'a choice beyond 30' 6 's: C is not within 0 .. 30' 'const int8_t C = 31;' \
    'int8_t s; // one {C}'
refuse 'a range before other words' 5 'x: no range [min .. max]' 'int32_t x; // [0 .. 1] m'
refuse 'choices before other words' 6 'x: no range [min .. max]' 'const int8_t A = 1;' \
    'int8_t x; // {A} now'
refuse 'a range that a later line ends' 5 'x: no range of int32_t: 2 .. 1' 'int32_t x; // m' \
    '           // [2 .. 1]'
refuse 'words in a line of their own behind a range' 5 'x: no range [min .. max]' \
    'int32_t x; // m [1 .. 2]' '           // too'
refuse 'a range that is none' 5 'x: no range [min .. max]' 'int32_t x; // m [0..1]'
refuse 'a range the wrong way round' 5 'x: no range of int32_t: 2 .. 1' 'int32_t x; // [2 .. 1]'
refuse 'a range beyond the type' 5 'x: no range of int8_t: 0 .. 128' 'int8_t x; // [0 .. 128]'
refuse 'a range of fractions' 5 'x: no range of int16_t: 0 .. 1e3' 'int16_t x; // [0 .. 1e3]'
refuse 'a range of words' 5 'x: no range of float: 0 .. n - 1' 'float x; // [0 .. n - 1]'
refuse 'a range below what is not there' 5 'x: no range, as there is no int16_t n' \
    'int16_t x; // [0 .. n - 1]'
refuse 'a range of an array of integers' 5 'x: an array of integers has no range' \
    'int16_t x[3]; // [0 .. 9]'
refuse 'a time with a range of its own' 5 'x: a time is within' 'int64_t x; // [0 .. 9]'
refuse 'a member twice' 5 'x is there twice' "$one" "$one"
refuse 'an array that no run holds' 5 'a: an array of more than 255' 'float a[256];'
refuse 'a constant beyond its type' 5 'a constant beyond its type' 'const int8_t A = 128;' "$one"
refuse 'a comment that ends one in C' 5 'x: the comment would end' 'int32_t x; // a */ b'

fresh
sed -i 's/^struct plot_t/struct plots_t/' "$copy/tree/lcm_types/plot_t.lcm"
codegen
expect "a struct of another name than its file's" 1 \
    'plot_t.lcm:1: struct plots_t belongs into plots_t.lcm'
fresh
sed -i '/^package/d' "$copy/tree/lcm_types/plot_t.lcm"
codegen
expect 'no package' 1 'plot_t.lcm:1: package rhotrack is missing'
fresh
sed -i 's/^package.*/package;/' "$copy/tree/lcm_types/plot_t.lcm"
codegen
expect 'a package without a name' 1 'plot_t.lcm:1: package rhotrack is missing'

heading() { # what, text, the first line of plot_t.lcm behind its licence
    fresh
    sed -i "2s,.*,$3,; 3d" "$copy/tree/lcm_types/plot_t.lcm"
    codegen
    expect "$1" 1 "lcm_types/plot_t.lcm:1: $2"
}
heading 'no comment' 'a comment before the package is missing' ''
heading 'a comment that would end one in C' 'the comment before the package would end' \
    '// One */ plot.'
heading 'a channel without its end' 'no channel that is understood' '// One plot. Channel RHO_PLOT'

# ---- What it makes of rules that no struct has yet ----

# Constants of which one begins as another does.
fresh
sed -i \
    's/POSITION_2D = 2/POSITION = 1, POSITION_2D = 2/; s/{POSITION_2D,/{POSITION, POSITION_2D,/' \
    "$copy/tree/lcm_types/plot_scan_t.lcm"
codegen
expect 'a constant that begins as another one does' 0 'codegen: src/wire/message_types.c'
status=0
grep -F -A 1 'plot_scan, kind), 1, 1, MESSAGE_ONE_OF' "$copy/tree/src/wire/message_types.c" |
    tr -s '\n ' ' ' >"$copy/output" || status=$?
expect '... has its own value' 0 '1 << 1 | 1 << 2 | 1 << 3 | 1 << 4 | 1 << 6'

# ---- What it leaves in a program ----

# One message that is decoded and one that is written: no table of a third one is linked.
cat >"$copy/two.c" <<'END'
#include "rhotrack/message.h"
int main(int count, char **words)
{
    static struct rho_message_plot_scan scan;
    static uint8_t buffer[RHO_MESSAGE_TRACK_LIST_MAX_SIZE];
    const struct rho_message_track_list_head head = {.scan = count};
    const struct rho_message_track track = {.hits = 1};
    struct rho_message_writer writer;
    return rho_message_plot_scan_decode((const uint8_t *)words[0], (size_t)count, &scan) |
           rho_message_plot_scan_validate(&scan, NULL) |
           rho_message_track_list_begin(&writer, buffer, sizeof buffer, &head) |
           rho_message_track_list_add(&writer, &track);
}
END
status=0
{ ${CC:-gcc} -std=c99 -Os -ffunction-sections -fdata-sections -Wl,--gc-sections -Iinclude \
    -o "$copy/two" "$copy/two.c" src/wire/message_*.c src/base/value_checks.c &&
    nm "$copy/two" >"$copy/symbols"; } 2>"$copy/output" || status=$?
sed -nE 's/.* ([a-z_]+_(runs|ints|floats|format|rules|names))$/\1/p' "$copy/symbols" | sort \
    >"$copy/tables"
printf '%s\n' {plot,plot_scan}_{floats,ints,runs} {plot_scan,track_list}_format plot_scan_rules \
    {track,track_list}_runs | sort | diff - "$copy/tables" >>"$copy/output" 2>&1 || status=1
expect 'no table of other messages in a program' 0 ''
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
