#!/bin/bash
# SPDX-License-Identifier: MIT
# On a terminal simulate, track and evaluate end with the command that most users want next; it is
# typed here as it stands. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Runs a command on a terminal; what it says is in the file stderr, the next command in `next`.
terminal() {
    status=0
    python3 -c 'import os, pty, sys
sys.exit(os.waitstatus_to_exitcode(pty.spawn(["/bin/sh", "-c", sys.argv[1]])))' "$1" \
        </dev/null >stdout 2>&1 || status=$?
    tr -d '\r' <stdout >stderr
    sed -n 's/^rhotrack: next: //p' stderr >next
}
next() { matches "$(cat next)" "$1"; }

terminal "'$program' simulate crossing -o 'a scene'"
check 'simulate: track comes next' next \
    "$program track 'a scene/plots.csv' --config 'a scene/scenario.ini' -o 'a scene/tracks.csv'"
terminal "$(cat next)"
check 'typed, it works' exits 0
check 'track: evaluate comes next' next \
    "$program evaluate 'a scene/truth.csv' 'a scene/tracks.csv' --config 'a scene/scenario.ini'"
terminal "$(cat next)"
check 'typed, it works' exits 0
check 'evaluate: a page comes next' next \
    "$program plot tracks 'a scene/truth.csv' 'a scene/plots.csv' 'a scene/tracks.csv' "\
"-o 'a scene/tracks.html' --config 'a scene/scenario.ini'"
terminal "$(cat next)"
check 'typed, it works' test "$status" -eq 0 -a -s 'a scene/tracks.html'
check 'and that is the last' test ! -s next

for scene in radar-and-bearings passive-two popup weave hard-turn; do
    terminal "'$program' simulate $scene -o $scene"
    terminal "$(cat next)"
    check "$scene: a command that works, and finds its targets" grep -Eq \
        ' [1-9][0-9]* tracks confirmed' stderr
    terminal "$(cat next)"
    check "$scene: evaluated" bash -c \
        '[ '"$status"' -eq 0 ] && grep -Eq "^targets_found +[1-9]" stderr'
    terminal "$(cat next)"
    check "$scene: drawn" test "$status" -eq 0 -a -s $scene/tracks.html
done
terminal "'$program' simulate crossing -o many --runs 2"
check 'many runs: the first one' next "$program track many/run-0000/plots.csv --config *"

# Made for maintain, with other limits than the default ones: what was not used is said.
terminal "'$program' track popup/plots.csv -o popup/tracks.csv"
check 'settings beside the plots that are not used are said' grep -q \
    '^rhotrack: popup/scenario.ini is beside the plots but was not used (--config)$' stderr
terminal "'$program' track popup/plots.csv -o popup/tracks.csv --config popup/scenario.ini"
check 'and not where they are' bash -c '! grep -q "was not used" stderr'

# Plots of one's own: no truth, other names.
mkdir mine
cut -d, -f1-6 popup/plots.csv | sed '1s/x_m/Ost/; 1s/y_m/Nord/' >"mine/it's.csv"
terminal \
    "'$program' track \"mine/it's.csv\" -o mine/tracks.csv --columns x_m=Ost,y_m=Nord --set pd=.8"
check "without a truth: a page, with the settings" next \
    "$program plot tracks 'mine/it'\\\\''s.csv' mine/tracks.csv -o mine/tracks.html "\
"--columns x_m=Ost,y_m=Nord --set pd=.8"
terminal "$(cat next)"
check 'typed, it works' test "$status" -eq 0 -a -s mine/tracks.html

terminal "'$program' track popup/plots.csv -o popup/tracks.csv --set range_max_m=1000"
check 'no command comes next without a track' test ! -s next
cp popup/truth.csv mine
terminal "'$program' track \"mine/it's.csv\" -o mine/tracks.csv --columns x_m=Ost,y_m=Nord"
check 'a truth without the columns of --columns: a page, too' next "$program plot tracks *"
terminal "$(cat next)"
check 'typed, it works' exits 0
sed '1s/x_m/Ost/; 1s/y_m/Nord/' popup/truth.csv >mine/truth.csv
terminal "'$program' track \"mine/it's.csv\" -o mine/tracks.csv --columns x_m=Ost,y_m=Nord"
check 'with them: evaluate' next "$program evaluate mine/truth.csv * --columns x_m=Ost,y_m=Nord"
terminal "$(cat next)"
check 'typed, it works' exits 0
head -1 popup/truth.csv >mine/truth.csv
terminal "'$program' track \"mine/it's.csv\" -o mine/tracks.csv --columns x_m=Ost,y_m=Nord"
check 'a truth without targets: a page' next "$program plot tracks *"
terminal "$(cat next)"
check 'typed, it works' exits 0

run track popup/plots.csv -o popup/tracks.csv
check 'nothing of it where standard error is no terminal' bash -c \
    '! grep -q "next: \|not used" stderr'
for args in "track popup/plots.csv" "track popup/plots.csv -o x.lcm" "simulate crossing"; do
    terminal "'$program' $args"
    check "no command comes next: $args" test ! -s next
done

# A demonstration whose targets are found at once and kept: both figures are there, by name.
run simulate radar -o demo
run track demo/plots.csv --config demo/scenario.ini -o demo/tracks.csv
run evaluate demo/truth.csv demo/tracks.csv --json
check 'evaluate: start-up is told apart' json stdout \
    'abs(o["completeness"] - 2 / 7) < 1e-6 and o["completeness_once_found"] == 1'
run evaluate demo/truth.csv demo/tracks.csv
check 'in the text, too' grep -Eq '^completeness_once_found +1$' stdout
awk -F, 'NR == 1 || $2 == 1' demo/tracks.csv >one.csv
run evaluate demo/truth.csv one.csv --json
check 'targets never found count in full' json stdout \
    'abs(o["completeness_once_found"] - 2 / (2 + 7 + 7)) < 1e-6'
finish
