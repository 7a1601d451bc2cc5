#!/bin/bash
# SPDX-License-Identifier: MIT
# Two radars with biases: simulate two-radars, register, and tracks with what it found; what it
# refuses. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# ---- simulate two-radars ----
prompt=(--set radars.0.late_share=0 --set radars.1.late_share=0)
whole=(--set radars.0.sectors=1 --set radars.1.sectors=1)
run simulate two-radars -o late
check 'a fifth of the scans arrives 300 ms late, and none before it ends' awk -F, '
    NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    $(at["received_s"]) + 0 < last { exit 1 } { last = $(at["received_s"]) }
    $(at["range_m"]) == "" { scans++; after = $(at["received_s"]) - $1; late += after > 0.299
        if (after < -1e-6 || (after > 1e-6 && after < 0.299) || after > 0.301) exit 1 }
    END { exit !(scans == 6688 && late / scans > 0.17 && late / scans < 0.23) }' late/plots.csv
check 'scenario.ini says how long to wait' grep -qx 'hold_ms = 300' late/scenario.ini
check 'and nothing of the biases' bash -c '! grep -q bias late/scenario.ini'
check 'the sectors of each radar are numbered from 1, each once' awk -F, '
    NR > 1 && $3 == "" {
        if (seen[$2 "," $9]++) exit 1
        count[$2]++
        if ($9 + 0 > most[$2]) most[$2] = $9 + 0
    }
    END { for (s in count) if (count[s] != most[s] || count[s] < 1900) exit 1 }' late/plots.csv
run simulate two-radars "${prompt[@]}" -o sectors
check 'without late data there is no column received_s' bash -c \
    '! head -n 1 sectors/plots.csv | grep -q received_s'
run simulate two-radars "${prompt[@]}" "${whole[@]}" -o turns
run track turns/plots.csv --config turns/scenario.ini
check 'whole turns are scans' grep -q 'rhotrack: 20[89] scans' stderr

# ---- register ----
good='len(o["radars"]) == 2
and all(abs(r["range_bias_m"] - s * 50) < 4 * r["range_bias_sigma_m"] < 20
and abs(r["azimuth_bias_rad"] - s * 0.00174533) < 4 * r["azimuth_bias_sigma_rad"] < 0.0006
for r, s in zip(o["radars"], (1, -1)))
and abs(o["radars"][1]["time_bias_s"]) < 4 * o["radars"][1]["time_bias_sigma_s"]
and o["radars"][0]["time_bias_s"] == 0 and o["reference_sensor"] == 1 and o["targets"] >= 19'
good=${good//$'\n'/ }
for kind in sectors turns; do
    run register "$kind/plots.csv" --config "$kind/scenario.ini" --json -o "$kind.ini"
    cp stdout "$kind.json"
    check "$kind: biases within their sigmas" json "$kind.json" "$good"
done
awk -F, 'NR == 1 || $2 == 1' sectors/plots.csv >first.csv
awk -F, 'NR == 1 || $2 == 2' sectors/plots.csv >second.csv
run register second.csv first.csv --config sectors/scenario.ini --json
check 'two files are as one' cmp stdout sectors.json
run register sectors/plots.csv --config sectors/scenario.ini --config sectors.ini --json
check 'with the biases configured they come out again, in all' json stdout "$good"
run register sectors/plots.csv --config sectors/scenario.ini --set reference_sensor=2
check 'another reference' grep -q '^the time of radar 2 counts as right' stdout
run register sectors/plots.csv --config sectors/scenario.ini
check 'a table' bash -c \
    'grep -Eq "^ +1 .* 0\.0000 +-$" stdout && grep -q "^20 targets in common" stdout'

# ---- a clock that is off ----
run simulate two-radars "${prompt[@]}" --set radars.1.time_bias_s=-1 -o behind
check 'then the file is in the order of arrival' bash -c \
    'head -n 1 behind/plots.csv | grep -q received_s'
run track behind/plots.csv --config behind/scenario.ini --json -o raw.csv
check 'which track reads; scans that are said to be a second old are late' json stdout \
    'o["counters"]["scans_retrodicted"] > 1000 and o["scans"] == 6688'
run register behind/plots.csv --config behind/scenario.ini --json -o behind.ini
off='(lambda b: abs(b["time_bias_s"] + 1) < 4 * b["time_bias_sigma_s"] < 0.1)(o["radars"][1])'
check 'register finds it' json stdout "$off and ${good%% and abs(o\[\"radars\"\]\[1*}"
run register behind/plots.csv --config behind/scenario.ini --config behind.ini --json
check 'and finds it again, in all, where it is told of it' json stdout "$off"
run track behind/plots.csv --config behind/scenario.ini --config behind.ini --json -o right.csv
check 'with it nothing is late but by what it is not known to' json stdout \
    '(o["counters"]["scans_retrodicted"] + o["counters"]["scans_late"] < 60 and
    o["fates"]["stale"] < 60)'
run evaluate behind/truth.csv right.csv --json
check 'tracks are at other times than the truth then, which is led to them' json stdout \
    'o["completeness"] > 0.95 and o["tracks"] == 20 and o["rmse_m"] < 120'
run evaluate behind/truth.csv right.csv --set time_tolerance_s=0.1 --json
check 'within time_tolerance_s they are judged' json stdout \
    'o["completeness"] > 0.95 and o["tracks"] == 20 and o["rmse_m"] < 120'
for kind in truth exact shifted; do
    awk -v kind=$kind 'BEGIN {
        print kind == "truth" ? "t_s,target_id,x_m,y_m" : "t_s,track_id,x_m,y_m,vx_mps,vy_mps"
        by = kind == "shifted" ? 0.02 : 0
        for (k = 0; k < 10; k++) {
            if (kind == "truth") { printf "%d,1,%d,0\n", k, 100 * k }
            else { printf "%.2f,1,%.3f,3,100,0\n", k + by, 100 * (k + by) + 5 * k }
        } }' >$kind.csv
done
run plot errors truth.csv exact.csv -o exact.svg
check 'plot errors draws them' test -s exact.svg
sed 's/,3,100,0$/,4,100,0/' exact.csv >other.csv
run plot errors truth.csv other.csv -o other.svg
check 'plot errors: others look otherwise' bash -c \
    'test -s other.svg && ! cmp -s exact.svg other.svg'
run plot errors truth.csv -o none.svg
check 'plot errors: no track, no picture' says 2 \
    'rhotrack: plot errors: no target has a track within *'
run plot errors truth.csv shifted.csv -o shifted.svg --set time_tolerance_s=0.05
check 'plot errors: tracks are led to the truth' cmp shifted.svg exact.svg
rm shifted.svg
run plot errors truth.csv shifted.csv -o shifted.svg
check 'plot errors: or refused' says 2 \
    'rhotrack: shifted.csv:2: the truth has no time within 1 ms of this row (time_tolerance_s)'
check 'plot errors: then nothing is left' bash -c '! ls shifted.svg* none.svg* 2>/dev/null'
run convert behind/plots.csv behind.lcm --config behind/scenario.ini
run track behind.lcm --config behind/scenario.ini --config behind.ini --json -o log.csv
check 'and from a log' json stdout \
    'o["counters"]["scans_retrodicted"] + o["counters"]["scans_late"] < 60 and o["scans"] == 6688'
run register behind.lcm --config behind/scenario.ini --config behind.ini --json
check 'register of the log' json stdout "$off"

# ---- what comes very late ----
run simulate two-radars --set radars.0.late_s=15 --set radars.1.late_s=15 "${whole[@]}" -o very_late
run track very_late/plots.csv --config very_late/scenario.ini --set hold_ms=10000 --json \
    -o tracks.csv
check 'what comes later still is late' json stdout \
    'o["counters"]["scans_retrodicted"] > 10 and o["counters"]["scans_late"] == 0'

# ---- what it is for ----
run track turns/plots.csv --config turns/scenario.ini -o raw.csv
run evaluate turns/truth.csv raw.csv --json
cp stdout raw.json
run track turns/plots.csv --config turns/scenario.ini --config turns.ini -o right.csv
run evaluate turns/truth.csv right.csv --set time_tolerance_s=0.1 --json
check 'tracks are nearer to the truth with them' json stdout \
    "o[\"rmse_m\"] < 0.9 * $(python3 -c \
        'import json; print(json.load(open("raw.json"))["rmse_m"])')"

# ---- what it refuses ----
run register first.csv --config sectors/scenario.ini
check 'one radar' says 2 'rhotrack: register: the input has only one radar; *'
run simulate parallel -o cartesian
run register cartesian/plots.csv
check 'Cartesian plots' says 2 \
    'rhotrack: register: sensor 1: its plots are not in range and azimuth'
run simulate passive-two -o passive
run register passive/bearings.csv
check 'bearings' says 2 'rhotrack: register takes plots in range and azimuth, not bearings'
run register sectors/plots.csv --config sectors/scenario.ini --set reference_sensor=7
check 'a reference that is not there' says 2 \
    'rhotrack: reference_sensor 7: the input has no plots of this radar'
cut -d, -f1-4,7-9 sectors/plots.csv >placeless.csv
run register placeless.csv
check 'radars without places' says 2 'rhotrack: register: radars * and * have no known place; *'
run simulate two-radars "${prompt[@]}" --set targets=[] -o empty
run register sectors/plots.csv --config sectors/scenario.ini -o sectors_again.ini
mv stdout table
run register sectors/plots.csv --config sectors/scenario.ini -o -
check 'with -o - the INI file is standard output' writes_same_as sectors_again.ini
check 'and the table standard error' cmp table stderr
run register sectors/plots.csv --config sectors/scenario.ini -o - --json
check 'JSON has no room there' says 2 \
    'rhotrack: register: --json and -o - both write on standard output'
run register empty/plots.csv --config empty/scenario.ini -o none.ini
check 'no common target' says 1 'rhotrack: register: no target was tracked by two radars *'
check 'no file then' test ! -e none.ini
run simulate two-radars "${prompt[@]}" --set targets.0.count=1 --set duration_s=120 -o one
run register one/plots.csv --config one/scenario.ini -o none.ini
check 'one target for two minutes tells nothing' exits 1
check 'each bias is said to be not known' test "$(grep -c 'not known' stdout)" -eq 5
check 'no file then either' test ! -e none.ini
ln -s sectors/plots.csv link.csv
run register first.csv second.csv ./second.csv --config sectors/scenario.ini
check 'a file twice' says 2 \
    'rhotrack: register: ./second.csv is given twice, and its plots would count twice'
run register sectors/plots.csv link.csv --config sectors/scenario.ini
check 'by another name' says 2 'rhotrack: register: link.csv is given twice, *'
for ending in csv lcm ast geojson svg JSON; do
    run register sectors/plots.csv --config sectors/scenario.ini -o "none.$ending"
    check "an INI file by the name of $ending" says 2 \
        "rhotrack: none.$ending: register writes an INI file, and "\
".${ending,,} is the ending of another"
    check "and no file: $ending" test ! -e "none.$ending"
done
finish
