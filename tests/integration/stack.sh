#!/bin/bash
# SPDX-License-Identifier: MIT
# What the public headers state of stacks is an upper bound, and tools/gates/stack.py goes red where
# it is not, or is missing.
set -euo pipefail # a pipe into tee goes red, too
cd "$(dirname "$0")/../.."
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
faults=0

tools/gates/stack.py --headers | tee "$copy/output"
if grep -q '^skipped' "$copy/output"; then exit 0; fi

must_fail() { # what, file, a sed command on it, the message expected
    local output
    rm -rf "$copy/rhotrack"
    cp -r include/rhotrack "$copy"
    sed -i "$3" "$copy/rhotrack/$2"
    if output=$(tools/gates/stack.py --headers "$copy/rhotrack"); then
        echo "stack.py did not see $1"
        exit 1
    fi
    grep -q -- "$4" <<<"$output" || { echo "stack.py saw $1, but said: $output"; exit 1; }
    faults=$((faults + 1))
}

must_fail 'too small a figure' initiator.h 's/Stack: 168 bytes/Stack: 60 bytes/' \
    'initiator.h:[0-9]*: rho_initiator_init states 60 bytes of stack; it takes [0-9]*: '\
'rho_initiator_init > rho_window_init > memset'
must_fail 'too small a figure for a whole header' detail/gate.h \
    's/Stack: 100 bytes at most/Stack: 8 bytes at most/' 'rho_gate_box states 8 bytes'
must_fail 'too small a figure in kilobytes' tracker.h 's/Stack: 3.8 KB/Stack: 0.9 KB/' \
    'rho_tracker_step states 921 bytes'
must_fail 'a function that states nothing' types.h 's/Stack: 100 bytes at most where.*/Nothing./' \
    'rho_is_coordinate states no stack'

# The path of a function adds up to its bytes.
tools/gates/stack.py --path rho_tracker_step | awk '
    NR == 1 {says = $2}
    NR > 1 {sum += $1}
    END {if (NR < 3 || sum != says) {print "stack.py --path does not add up"; exit 1}}'
echo "stack.py: $faults seeded faults seen"
