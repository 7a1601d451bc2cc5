#!/bin/bash
# SPDX-License-Identifier: MIT
# The page of `plot -o NAME.html`: what it holds, and in headless Chromium what a user does with it,
# and how long a million plots take.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
drive="$(realpath "$(dirname "${BASH_SOURCE[0]}")")/page.py"

run simulate polar --seed 3 -o in
run track in/plots.csv --config in/scenario.ini -o tracks.lcm

# ---- files ----
run plot errors in/truth.csv tracks.lcm -o x.html
check 'no page of errors' says 2 \
    'rhotrack: x.html: only plot scans and plot tracks make a page; '\
'plot errors makes NAME.svg or NAME.png'
run plot tracks in/plots.csv in/truth.csv tracks.lcm --config in/scenario.ini -o page.html
check 'a page is written' exits 0
check 'it needs nothing beside it' sh -c '! grep -Eq "<(script|link|img)[^>]*(src|href)=" page.html'
check 'the licence of d3 is in it' grep -q 'Copyright 2010-20.. Mike Bostock' page.html
check 'as many plots as the file has, and their fates' python3 - <<'EOF'
import base64, csv, re, struct
page = open("page.html").read()
def array(name, code):
    data = base64.b64decode(re.search(f'id="{name}">([^<]*)<', page)[1])
    return [value for value, in struct.iter_unpack("<" + code, data)]
rows = [row for row in csv.DictReader(open("in/plots.csv")) if row["range_m"]]
fates = array("plot_fate", "I")
assert len(rows) == len(fates) == len(array("plot_x", "f")) == len(array("plot_y", "f"))
ids = array("track_id", "i")
# the scene says which plots are of targets: most of them are taken by tracks, few of the others
of_target = [int(row["target_id"]) >= 0 for row in rows]
taken = [fate >= 2 for fate in fates]
assert max(fates) == 1 + len(ids) and len(ids) >= 3, (max(fates), ids)
share = sum(a and b for a, b in zip(of_target, taken)) / sum(of_target)
others = sum(b and not a for a, b in zip(of_target, taken)) / (len(rows) - sum(of_target))
assert share > 0.7 and others < 0.05, (share, others)
assert array("scan_first", "I")[-1] == len(rows)
EOF
check 'nothing is said of colours' test ! -s stderr
run simulate overlapping-radars -o biased --set duration_s=60
run track biased/plots.csv --config biased/scenario.ini -o biased.csv \
    --set sensor.1.time_bias_s=0.25
run plot tracks biased/plots.csv biased.csv --config biased/scenario.ini -o biased.html
check 'tracks of other settings: it is said' says 0 \
    'rhotrack: *[0-9] of *[0-9] plots that the tracks took are in no scan of the files, and have *'
run plot tracks biased/plots.csv biased.csv --config biased/scenario.ini -o biased.html \
    --set sensor.1.time_bias_s=0.25
check 'with these settings nothing is said' test "$status" -eq 0 -a ! -s stderr
unnumbered in/plots.csv 4 4 >turns.csv
run track turns.csv --set scan_interval_s=2 -o turns.tracks.csv
run plot tracks turns.csv turns.tracks.csv -o turns.html
check 'other turns: it is said' grep -q 'in no scan of the files' stderr
run track turns.csv -o turns.tracks.csv
run plot tracks turns.csv turns.tracks.csv -o turns.html
check 'turns as track found them: nothing is said' bash -c '! grep -q "in no scan" stderr'
python3 - <<'EOF2'
with open("many.csv", "w") as file:
    file.write("t_s,track_id,status,x_m,y_m\n")
    for track in range(501):
        for k in range(2):
            file.write(f"{k},{track + 1},confirmed,{100 * track},{50 * k}\n")
EOF2
run plot tracks many.csv -o many.html
run plot scans in/plots.csv --config in/scenario.ini -o scans.html
check 'plot scans makes a page, too' exits 0
check 'without tracks' grep -q '<title>rhotrack: 0 tracks, [1-9][0-9]* plots</title>' scans.html

# ---- in a browser ----
command -v chromium >/dev/null || {
    echo 'skipped: page: chromium is not installed (tools/setup.sh browser)'
    finish
}
plots=$(sed -n 's/.*<title>rhotrack: [0-9]* tracks, \([0-9]*\) plots<.*/\1/p' page.html)
browse() { # NAME ARGUMENT...: each line of page.py is a check
    local name=$1 line
    shift
    timeout 120 python3 "$drive" "$@" >drive 2>&1
    echo "exit $?" >>drive
    while read -r line; do
        case $line in
            ok*) check "$name: ${line#ok   }" true ;;
            'exit 0') ;;
            *) check "$name: $line" false ;;
        esac
    done <drive
    check "$name: the browser came to its end" grep -q 'no fault in the script' drive
}
browse page functions page.html "$plots" 1
browse '501 tracks' listed many.html 'The first 500 of 501 tracks; the others are on the map.'
browse '3 tracks' listed page.html ''
# a true 0 was once shown as a missing value
printf 't_s,track_id,status,x_m,y_m,z_m,score_nat\n'\
'0,1,confirmed,0,0,%s,3\n1,1,confirmed,9,9,0,0\n' 5 >climb.csv
sed 's/,5,3$/,0,3/' climb.csv >flat.csv
run plot tracks climb.csv -o climb.html
browse 'score and height of 0' zeros climb.html 'height0 m' 'score0.0 nat'
run plot tracks flat.csv -o flat.html
browse 'score of 0 without heights' zeros flat.html 'score0.0 nat'

awk 'BEGIN {
    srand(1); print "t_s,sensor_id,x_m,y_m"
    for (i = 0; i < 1000000; i++) print int(i / 1000) ",1," int(1e5 * rand()) "," int(1e5 * rand())
}' >many.csv
run plot scans many.csv -o many.html
check 'a million plots are 40 MB at most' test "$(stat -c %s many.html)" -lt 40000000
browse 'a million plots' million many.html
finish
