#!/bin/bash
# SPDX-License-Identifier: MIT
# node --snapshot: a node that is started again goes on as if it had not ended; what is no snapshot
# of it is told.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# node LOG OPTIONS...: tracks of a log in stdout.
node() {
    local log=$1
    shift
    run node --lcm "file://$log?speed=0" --print --config scene/scenario.ini "$@"
}

"$program" simulate traffic --seed 3 --set targets.0.count=6 --set duration_s=300 \
    --set clutter.0.plots=60 -o scene
"$program" convert scene/plots.csv all.lcm
# both halves, in the middle of the tracks
middle=$(awk -F, 'NR > 1 && $1 != last { last = $1; if (++n == 16) print $1 }' scene/plots.csv)
awk -F, -v t="$middle" 'NR == 1 || $1 < t' scene/plots.csv >first.csv
awk -F, -v t="$middle" 'NR == 1 || $1 >= t' scene/plots.csv >second.csv
"$program" convert first.csv first.lcm
"$program" convert second.csv second.lcm

node all.lcm
cp stdout all.csv
node first.lcm --snapshot state
cp stdout before.csv
check 'a first start says nothing of a snapshot' sh -c '! grep -q snapshot stderr'
check 'and leaves one' test -s state
cp state kept
node second.lcm --snapshot state
cp stdout after.csv
check 'the second says that it goes on' grep -q \
    '^rhotrack: state: tracks continue from the snapshot$' stderr
check 'and ends well' test "$status" -eq 0
check 'before and after are the whole, byte for byte' sh -c \
    'tail -n +2 after.csv | cat before.csv - | cmp - all.csv'
check 'there were tracks to go on with' sh -c \
    "awk -F, -v t=$middle '\$1 == t && \$3 != \"tentative\"' after.csv | grep -q ."
check 'nothing unfinished is left' sh -c '! ls *.part'
node second.lcm
check 'without it tracks begin later' sh -c "! awk -F, -v t=$middle '\$1 == t' stdout | grep -q ."

# ---- what does not fit ----
anew() { # what is said
    check "$1: begins anew" grep -q "^rhotrack: state: $1; tracks begin anew\$" stderr
    check "$1: ends well" test "$status" -eq 0
    node second.lcm --snapshot state
    check "$1: the next one goes on" grep -q \
        '^rhotrack: state: tracks continue from the snapshot$' stderr
}
cp kept state
printf '\377' | dd of=state bs=1 seek=70000 conv=notrunc 2>dd.err
node second.lcm --snapshot state
anew 'the snapshot is damaged'
head -c 70000 kept >state
node second.lcm --snapshot state
anew 'the snapshot is damaged'
cp kept state
printf '\002' | dd of=state bs=1 seek=8 conv=notrunc 2>dd.err
node second.lcm --snapshot state
anew 'a snapshot of another version'
cp kept state
printf '\001\001\001\001' | dd of=state bs=1 seek=12 conv=notrunc 2>dd.err
node second.lcm --snapshot state
anew 'a snapshot of another build'
cp kept state
node second.lcm --snapshot state --set coast_scans_max=4
check 'other parameters: begins anew' \
    grep -q '^rhotrack: state: a snapshot with other parameters; tracks begin anew$' stderr
# scans that are far older than the snapshot: their clock was set
cp kept state
awk -F, -v OFS=, 'NR > 1 { $1 -= 5000 } 1' scene/plots.csv >earlier.csv
"$program" convert earlier.csv earlier.lcm
node earlier.lcm --snapshot state
check 'sensors with an earlier clock are tracked all the same' sh -c \
    'test "$(wc -l <stdout)" -eq "$(wc -l <all.csv)"'
cp first.csv state
node second.lcm --snapshot state
check 'a file that is no snapshot is not written over' cmp -s first.csv state
check 'and told' says 2 'rhotrack: state: not a snapshot, and would be overwritten'
node second.lcm --snapshot no/folder/state
check 'one that cannot be written is told' grep -q \
    ' rhotrack: no/folder/state: No such file or directory; the snapshot is not written$' stderr
check 'and is exit 1' test "$status" -eq 1
finish
