#!/bin/bash
# SPDX-License-Identifier: MIT
# Each attack in SECURITY.md names a test, and that is there: a file, and where a name follows it a
# test in it. Runs beside others.
# shellcheck source=tests/integration/checks.bash
here=$(realpath "$(dirname "$0")")
. "$here/checks.bash"
root=$here/../..

awk -F'|' '/^## Attacks/ { on = 1 } /^\*\*What it costs/ { on = 0 }
    on && /^\|/ && !/^\|[- |]*$/ { print $(NF - 1) "|" $2 }' "$root/SECURITY.md" |
    grep -v '^ test |' >rows
check 'there are attacks' test "$(wc -l <rows)" -ge 12
while IFS='|' read -r cell attack; do
    file=$(sed -n 's/^ *`\([^`]*\)`.*/\1/p' <<<"$cell")
    name=$(sed -n 's/^ *`[^`]*` *\([a-z0-9_]*\) *$/\1/p' <<<"$cell")
    check "$file has ${name:-it}:$attack" grep -qw -e "${name:-.}" "$root/${file:-none}"
done <rows
finish
