#!/bin/bash
# SPDX-License-Identifier: MIT
# node --snapshot: a node that is started again goes on as if it had not ended; what is no snapshot
# of it is told, and what is damaged is set aside.
# Runs beside others.
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
check 'nor anything set aside' sh -c '! ls state.damaged*'
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
# As another program would have written it: other bytes, and their checksum. change AT BYTES
change() {
    python3 - "$@" <<'PYTHON'
import struct, sys, zlib
at, new = int(sys.argv[1]), bytes.fromhex(sys.argv[2])
data = open("kept", "rb").read()[:-4]
data = data[:at] + new + data[at + len(new):]
open("state", "wb").write(data + struct.pack("<I", zlib.crc32(data)))
PYTHON
}
change 8 02
node second.lcm --snapshot state
anew 'a snapshot of another version'
change 12 01010101
node second.lcm --snapshot state
anew 'a snapshot of another build'
cp kept state
node second.lcm --snapshot state --set coast_scans_max=4
check 'other parameters: begins anew' \
    grep -q '^rhotrack: state: a snapshot with other parameters; tracks begin anew$' stderr
check 'none of them is set aside' sh -c '! ls state.damaged*'

# ---- what is damaged ----
damaged() { # NAME, what is said: sets aside the file state, whose bytes stay
    cp state bad
    node second.lcm --snapshot state
    anew "$2; set aside as state.damaged"
    check "$1: its bytes are kept" cmp bad state.damaged
    check "$1: nothing else is left" test "$(echo state.*)" = state.damaged
    rm state.damaged
}
cp kept state
printf '\377' | dd of=state bs=1 seek=70000 conv=notrunc 2>dd.err
damaged 'a byte' 'the snapshot is damaged'
head -c 70000 kept >state
damaged 'cut short' 'the snapshot is damaged'
head -c 5 kept >state
damaged 'cut within its first word' 'not a snapshot'
head -c "$(stat -c %s kept)" /dev/zero >state
damaged 'zeros' 'not a snapshot'
{ head -c 4096 /dev/zero; tail -c +4097 kept; } >state
damaged 'a damaged head' 'not a snapshot'
cp kept state
printf '\0' >>state
damaged 'a byte too many' 'the snapshot is damaged'
cp kept state
printf '\002' | dd of=state bs=1 seek=8 conv=notrunc 2>dd.err
damaged 'a version that is damaged' 'the snapshot is damaged'
change 24 05
damaged 'an image that is none, with its checksum' 'the snapshot is damaged'
: >state
node second.lcm --snapshot state
anew 'the snapshot is empty'
for i in 1 2 3 4 5 6; do
    echo "$i" >state
    node second.lcm --snapshot state
done
check 'four that are damaged are kept' test "$(echo state.damaged*)" = \
    'state.damaged state.damaged.2 state.damaged.3 state.damaged.4'
check 'the first ones and the last one' test "$(cat state.damaged* | tr -d '\n')" = 1236
rm state.damaged*
mkdir state.part
cp kept state
node second.lcm --snapshot state
check 'no room for a part is told' grep -q \
    'rhotrack: state: File exists; the snapshot is not written$' stderr
check 'and leaves the old one' cmp kept state
rmdir state.part
printf 'half of it' >state.part
chmod a-w state.part
node second.lcm --snapshot state
check 'a part that was left over does not matter' exits 0
check 'and goes' test ! -e state.part

# scans that are far older than the snapshot: their clock was set
cp kept state
awk -F, -v OFS=, 'NR > 1 { $1 -= 5000 } 1' scene/plots.csv >earlier.csv
"$program" convert earlier.csv earlier.lcm
node earlier.lcm --snapshot state
check 'sensors with an earlier clock are tracked all the same' sh -c \
    'test "$(wc -l <stdout)" -eq "$(wc -l <all.csv)"'

# ---- what is somebody else's ----
cp first.csv state
node second.lcm --snapshot state
check 'a file that is no snapshot is not written over' cmp -s first.csv state
check 'and told' says 2 'rhotrack: state: not a snapshot, and would be overwritten'
mkdir folder
node second.lcm --snapshot folder
check 'a folder' says 2 'rhotrack: folder: not a regular file; a snapshot cannot be written to it'
cp second.lcm log
refuses() { # NAME, what is said, OPTIONS...
    local name=$1 said=$2
    shift 2
    node second.lcm "$@"
    check "$name" says 2 "$said"
}
refuses 'its own log' 'rhotrack: log: the log cannot be the snapshot' --log log --snapshot log
refuses 'its own clutter map' 'rhotrack: map: the clutter map cannot be the snapshot' \
    --clutter-map map --snapshot map
refuses 'its own config' 'rhotrack: scene/scenario.ini: the config cannot be the snapshot' \
    --snapshot scene/scenario.ini
refuses 'its own input' 'rhotrack: second.lcm: the input cannot be the snapshot' \
    --snapshot second.lcm

# ---- where it cannot be written ----
node second.lcm --snapshot no/folder/state
check 'one that cannot be written is told at once' matches "$(head -n 1 stderr)" \
    'rhotrack: no/folder/state: No such file or directory; the snapshot is not written'
check 'and not again' test "$(grep -c 'is not written' stderr)" -eq 1
check 'tracks go on' sh -c 'test "$(wc -l <stdout)" -gt 1'
check 'and it is exit 1' test "$status" -eq 1
finish
