#!/bin/bash
# SPDX-License-Identifier: MIT
# make budget: flash and RAM of a configuration, by any compiler; files, compilers and macros that
# cannot be are refused with their file and line. Runs beside others.
root=$(realpath "$(dirname "$0")/../..")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
own=$root/tools/examples/my_config.h

budget() { # arguments of make: exit code in $status, output in the files stdout and stderr
    status=0
    make -s -C "$root" BUILD="$folder/build" budget "$@" >stdout 2>stderr </dev/null || status=$?
}
row() { # title, column from the right: its bytes
    sed 's/\([0-9]\) \([0-9]\)/\1\2/g' stdout | awk -v t="$1" -v c="$2" \
        'index($0, "  " t) == 1 {print $(NF - c)}'
}
refused() { # pattern of the message, arguments of make
    budget "${@:2}"
    exits 2 && [ ! -s stdout ] && matches "$(head -1 stderr)" "budget: $1"
}
config() { # lines of a configuration: in the file own.h
    printf '%s\n' "$@" >own.h
}
adds_up() { # column: the rows of flash come to what is said, and that is what the program has
    local sum
    sum=$(sed 's/\([0-9]\) \([0-9]\)/\1\2/g' stdout | awk -v c="$1" \
        '/^RAM/ {exit} /^  / && $1 != "together" {sum += $(NF - c)} END {print sum}')
    [ "$sum" -gt 50000 ] && row together "$1" | head -1 | grep -qx "$sum"
}
as_linked() { # program's folder, column, prefix of the tools
    "${3}size" -A "$folder/build/cross/own-embedded-Os/$1/program" | awk '
        $1 ~ /^\.(text|rodata|ARM\.exidx|data)$/ {flash += $2}
        $1 ~ /^\.(data|bss)$/ {ram += $2}
        END {print flash; print ram}' >linked
    row together "$2" >said
    # The linker aligns sections, and of RISC-V shortens calls.
    paste linked said | tee pairs | awk '
        $1 < 0.99 * $2 || $1 > $2 + 200 {wrong = 1} END {exit wrong || NR != 2}' \
        || { cat pairs; return 1; }
}

# ---- on this machine ----
config '#define RHO_MAX_PLOTS 64' '#define RHO_MAX_TRACKS 200' '#define RHO_SCAN_KINDS 2'
budget RHO_CONFIG_FILE="$folder/own.h" CC=gcc CFLAGS=-fno-pie
check 'the compiler of this machine' exits 0
check 'rooms add up, of scans stepped' adds_up 1
check '... and of the node' adds_up 0
check 'largest is named with its macro' grep -q \
    'stepped:.* in RAM tracks of the tracker, .*(RHO_MAX_TRACKS 200)' stdout
check 'what it is measured with is said' grep -q "^$folder/own.h; gcc .*; -Os -fno-pie$" stdout
before=$(row together 1 | tail -1)
config '#define RHO_MAX_PLOTS 64' '#define RHO_MAX_TRACKS 100' '#define RHO_SCAN_KINDS 2'
budget RHO_CONFIG_FILE="$folder/own.h" CC=gcc CFLAGS=-fno-pie
check 'another file of the name is another configuration' test "$(row together 1 | tail -1)" -lt \
    "$((before - 50000))"

# ---- for other processors ----
if echo '#include <string.h>' | arm-none-eabi-gcc -E - >detail 2>&1; then
    budget RHO_CONFIG_FILE="$own"
    check 'a Cortex-M4F where nothing is said' exits 0
    check 'RAM of the table of tools/examples/README.md' grep -q \
        "^| rho_tracker .* $(row tracker 0) |$" "$root/tools/examples/README.md"
    check 'flash and RAM are those of the linked program' as_linked stepped 1 arm-none-eabi-
    check '... and of the node' as_linked LCM_node 0 arm-none-eabi-
    check 'the stack is said' grep -Eq '^worst stack of rho_tracker_step: 3[0-9]{3} bytes$' stdout
else
    echo 'skipped: no arm-none-eabi-gcc here'
fi
if riscv64-unknown-elf-gcc --specs=picolibc.specs -E -include string.h - </dev/null >detail 2>&1
then
    budget CROSS=riscv64-unknown-elf- \
        CFLAGS='-march=rv32imafc -mabi=ilp32f --specs=picolibc.specs' RHO_CONFIG_FILE="$own"
    check 'RISC-V' exits 0
    check '... as linked' as_linked stepped 1 riscv64-unknown-elf-
else
    echo 'skipped: no riscv64-unknown-elf-gcc here'
fi

# ---- what cannot be ----
check 'no such file' refused 'RHO_CONFIG_FILE=none.h: there is no such file' RHO_CONFIG_FILE=none.h
check 'a folder' refused "RHO_CONFIG_FILE=$folder: there is no such file" RHO_CONFIG_FILE="$folder"
check 'no such compiler' refused 'no avr-none-gcc here; CROSS=*' CROSS=avr-none- \
    RHO_CONFIG_FILE="$own"
config '/* mine */' '#define RHO_MAX_SCANS 5' '#define RHO_MAX_PLOTS 20000 /* many */'
check 'a macro out of range' refused \
    "$folder/own.h:3: RHO_MAX_PLOTS is 20000: RHO_MAX_PLOTS must be 1 .. 16383" \
    RHO_CONFIG_FILE="$folder/own.h" CC=gcc
check '... once' test "$(grep -c 'must be' stderr)" -eq 1
config '/*' '#define RHO_OLD 4' '*/' $'#define RHO_MAX_SCANS 2 /* f\xfcnf */'
check 'macros in a comment are none, whatever letters it has' refused \
    "$folder/own.h:4: RHO_MAX_SCANS is 2: RHO_MAX_SCANS must be 3 .. 12" \
    RHO_CONFIG_FILE="$folder/own.h" CC=gcc
config '#define RHO_SHARES_PLOTS 2'
check 'an option that is neither' refused \
    "$folder/own.h:1: RHO_SHARES_PLOTS is 2: RHO_SHARES_PLOTS must be 0 .. 1" \
    RHO_CONFIG_FILE="$folder/own.h" CC=gcc
check 'a macro out of range on the command line' refused \
    'flags: RHO_MAX_SCANS must be 3 .. 12' CFLAGS=-DRHO_MAX_SCANS=2 CC=gcc
config '#ifndef RHO_OWN_H' '#define RHO_OWN_H' '#define RHO_MAX_PLOT 64' '#endif'
check 'a macro that config.h has not' refused \
    "$folder/own.h:3: config.h has no RHO_MAX_PLOT; the nearest is RHO_MAX_PLOTS" \
    RHO_CONFIG_FILE="$folder/own.h" CC=gcc
config '#define RHO_MAX_SCANS 5' '#include "nowhere.h"'
budget RHO_CONFIG_FILE="$folder/own.h" CC=gcc
check 'what the compiler refuses has its own words' grep -q 'own.h:2:.*nowhere.h' stderr
check '... and ends it' exits 2
finish
