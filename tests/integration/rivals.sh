#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/bench/air_traffic_stonesoup.py: what it says where Stone Soup is not installed, and of bad
# input; and its tracks where `make bench-stonesoup` has installed it.
# shellcheck source=tests/integration/checks.bash
root=$(realpath "$(dirname "$0")/../..")
build=$(realpath -m "${BUILD:-$root/build}")
. "$(dirname "$0")/checks.bash"
RHOTRACK=$program
program=$root/tests/bench/air_traffic_stonesoup.py

# As if it were not installed, wherever it may be.
mkdir "$folder/none"
echo 'raise ImportError("none here")' >"$folder/none/stonesoup.py"
export PYTHONPATH=$folder/none PYTHONDONTWRITEBYTECODE=1

printf 't_s,sensor_id,x_m,y_m\n0,0,1,2\n# a comment\n10,0,,\n20,0,3,4\n' >"$folder/plots.csv"
run --help
check "--help needs no package" exits 0
for setting in --method --process-noise --pd --sigma-m --clutter-density --area --scans \
    --min-points --misses; do
    check "--help says $setting" grep -q -e "$setting" stdout
done
run plots.csv -o tracks.csv --method gnn
check "without Stone Soup" says 3 "*stonesoup is not installed*make bench-stonesoup*"
check "without Stone Soup there is no output" test ! -e tracks.csv
run plots.csv -o tracks.csv
check "no method: bad usage" exits 2
run plots.csv -o tracks.csv --method nearest
check "an unknown method: bad usage" exits 2

# refuses NAME PATTERN TEXT
refuses() {
    printf '%b' "$3" >"$folder/bad.csv"
    run bad.csv -o tracks.csv --method gnn
    check "$1" says 2 "air_traffic_stonesoup.py: bad.csv$2"
}
refuses "a place that is no number" ":4: x_m is not a number: 'east'" \
    't_s,x_m,y_m\n# a comment\n0,1,2\n10,east,2\n'
refuses "half a place" ":2: y_m is not a number: ''" 't_s,x_m,y_m\n0,1,\n'
refuses "a short row" ":2: y_m is not a number*" 't_s,x_m,y_m\n0,1\n'
refuses "infinity" ":2: t_s is not a number: 'inf'" 't_s,x_m,y_m\ninf,1,2\n'
refuses "time that goes back" ":3: t_s goes back" 't_s,x_m,y_m\n10,1,2\n0,1,2\n'
refuses "no column" ":1: no column y_m" 't_s,x_m\n0,1\n'
refuses "no plots" ": no plots" 't_s,x_m,y_m\n0,,\n'
refuses "an empty file" ":1: no column t_s" ''
run nowhere.csv -o tracks.csv --method gnn
check "no file" says 2 "*nowhere.csv: *"

# Six straight targets through the real one
unset PYTHONPATH
python=$build/stonesoup/bin/python3
[ -x "$python" ] || python=python3
if "$python" -c 'import stonesoup' 2>/dev/null; then
    "$RHOTRACK" simulate traffic --seed 3 --set targets.0.count=6 --set duration_s=200 \
        --set clutter.0.plots=10 -o "$folder"
    program=$python
    for method in gnn jpda; do
        run "$root/tests/bench/air_traffic_stonesoup.py" plots.csv -o "$method.csv" --method \
            "$method" --scans 15
        check "$method ends well" exits 0
        check "$method: one JSON object" json stdout "(o['method'] == '$method' and o['scans'] == 15 and o['tracks'] >= 6 and
            0 < o['mean_ms'] <= o['max_ms'] and o['stonesoup'] and o['settings']['min_points'] == 3)"
        run "$root/tests/bench/air_traffic_stonesoup.py" plots.csv -o "kept.csv" --method \
            "$method" --scans 15 --keep
        check "$method: kept predictions give the same tracks" cmp "$method.csv" kept.csv
        awk -F, 'NR == 1 || $1 < 150' truth.csv >first.csv
        program=$RHOTRACK
        run evaluate first.csv "$method.csv" --json
        check "$method: evaluate reads its tracks, all targets found" json stdout "(o['targets_found'] == 6 and
            o['completeness'] > .7 and o['switches'] == 0 and o['rmse_m'] < 100 and o['false_per_scan'] < .5)"
        program=$python
    done
else
    echo "skipped: Stone Soup is not installed (make bench-stonesoup)"
fi
finish
