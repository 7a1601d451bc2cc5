#!/bin/bash
# SPDX-License-Identifier: MIT
# initiate by the papers' methods: facts of the paper's data, what is refused, and what is said of
# limits. Runs beside others.
table3=$(realpath "$(dirname "$0")/../vectors/radar-table3.csv")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Table 1 without noise: x, vx, y, vy of three targets, 7 scans 2 s apart.
awk 'BEGIN {
    print "t_s,sensor_id,x_m,y_m"
    n = split("300 280 400 49 3000 -173.2 300 -100 2100 -173.2 1300 -100", s, " ")
    for (k = 0; k < 7; k++)
        for (i = 1; i < n; i += 4)
            printf "%d,1,%.6f,%.6f\n", 2 * k, s[i] + 2 * k * s[i + 1], s[i + 2] + 2 * k * s[i + 3]
    }' >table1.csv

# facts NAME FILE METHOD EXPRESSION [KEY=VALUE]
facts() {
    local more=()
    [ $# -lt 5 ] || more=(--set "$5")
    run initiate "$2" --method "$3" --json "${more[@]}"
    check "$1" json stdout "$4"
}
facts 'Table 1, ideal: HT peaks 7' table1.csv ht \
    'o["peak_votes"][:4] == [7, 7, 7] and o["votes"] == 21 * 3142'
facts 'Table 1, ideal: MHT peaks 6' table1.csv mht \
    'o["peak_votes"] == [6, 6, 6] and o["votes"] == 54'
facts 'Table 1, ideal: IHT peaks 6' table1.csv iht \
    'o["peak_votes"] == [6, 6, 6] and o["votes"] == o["candidates"]'
facts 'Table 1, ideal: NHT, reading A, peaks 5' table1.csv nht \
    'o["peak_votes"] == [5, 5, 5] and o["votes"] == 15' nht_reading=a
facts 'Table 1, ideal: NHT, reading C, peaks 5' table1.csv nht \
    'o["peak_votes"] == [5, 5, 5] and o["votes"] == 15 * 289'
pairs='(o["scans"], o["plots"], o["pairs"], o["candidates"]) == (7, 21, 54, 21)'
facts 'Table 3: HT' "$table3" ht "$pairs and max(o['peak_votes']) == 3 and o['votes'] == 21 * 3142"
facts 'Table 3: MHT' "$table3" mht "$pairs and max(o['peak_votes']) == 1 and o['votes'] == 54"
facts 'Table 3: IHT' "$table3" iht "$pairs and max(o['peak_votes']) == 1 and o['votes'] == 21"
facts 'Table 3: NHT casts one vote of .0533' "$table3" nht \
    "$pairs and o['votes'] == 1 and abs(o['peak_votes'][0] - .0533) < 5e-5 and o['tracks'] == 1" \
    nht_reading=a
facts 'peaks are in descending order' "$table3" ht \
    '(o["peak_votes"] == sorted(o["peak_votes"], reverse=True) and
    o["tracks"] == len(o["peak_votes"]))'
facts 'what JSON must hold' "$table3" nht \
    'o["method"] == "nht" and all(k in o for k in ["state_bytes", "wall_us"])'

# ---- tracks ----
run initiate table1.csv --method iht
check 'columns' matches "$(head -n 1 stdout)" \
    'track_id,t_s,x_m,y_m,vx_mps,vy_mps,rho_m,theta_rad,scans,score,z_m,vz_mps'
are_table1() {
    awk -F, 'NR > 1 {
            n++
            if (($3 - 3660)^2 + ($4 - 988)^2 + ($5 - 280)^2 + ($6 - 49)^2 < .01) a++
            if (($3 - 921.6)^2 + ($4 + 900)^2 + ($5 + 173.2)^2 + ($6 + 100)^2 < .01) b++
            if (($3 - 21.6)^2 + ($4 - 100)^2 + ($5 + 173.2)^2 + ($6 + 100)^2 < .01) c++
            if ($2 != "12.000000" || $9 != 7 || $10 != 6) bad++
            off = $3 * cos($8) + $4 * sin($8) - $7
            if (off > 5 || off < -5) bad++
        } END { exit !(n == 3 && a == 1 && b == 1 && c == 1 && !bad) }' "$1"
}
check 'the fit through the plots that voted is the target, at the last scan' are_table1 stdout
run initiate table1.csv --method ht --set tau=0.9
check 'HT: likewise, above a higher share' awk -F, \
    'NR > 1 && $9 == 7 && $10 == 7 { n++ } END { exit n != 3 }' stdout
run initiate table1.csv --method kernel --json
check 'the work of a batch' json stdout '(
    (o["work"], o["partial_steps"], o["plots_not_tried"]) == (o["work_worst"], 0, 0) and
    o["work"] > 0)'
run initiate table1.csv --method kernel --json --set work_max=1
check 'a limit on it leaves plots out' json stdout \
    'o["partial_steps"] == 1 and o["plots_not_tried"] > 0'
run initiate table1.csv --method iht --json -o out.csv
check 'tracks in the file, with --json' are_table1 out.csv
{ head -n 1 table1.csv; echo '0,1,1000,0'; echo '2,1,,'; } >one.csv
run initiate one.csv --method ht
check 'one scan that voted has a line but no place or velocity' \
    awk -F, 'NR > 1 && ($9 != 1 || $3 $4 $5 $6 != "" || $7 == "") { exit 1 } END { exit NR < 2 }' \
    stdout
for method in ht mht iht nht; do
    { head -n 1 table1.csv; echo '0,1,,'; } >none.csv
    run initiate none.csv --method $method --json
    check "$method: no plots" json stdout \
        '(o["scans"], o["votes"], o["peak_votes"], o["tracks"]) == (1, 0, [], 0)'
done
run initiate table1.csv --method iht --set scans=5
check 'more scans than asked for are said' matches "$(cat stderr)" \
    'rhotrack: the last 5 of 7 scans are used'

# ---- thresholds and parameters ----
facts 'votes_min' table1.csv iht 'o["peak_votes"] == []' votes_min=6.5
facts 'tau 0 leaves every cell that no better one is near' table1.csv mht \
    'len(o["peak_votes"]) > 3' tau=0
facts 'v_max of a user goes before the paper'"'"'s' table1.csv iht \
    'o["peak_votes"] == [6, 6]' v_max_mps=250
facts 'distinct scans can count' "$table3" ht 'max(o["peak_votes"]) == 3' vote=scans
facts 'wider tolerances' "$table3" nht 'o["votes"] > 1' eps_theta_rad=0.03
facts 'a large falsity lets no pair vote' "$table3" nht 'o["votes"] == 0' lambda_k=1000
run config --method nht --json
check 'config prints the method'"'"'s customary values' json stdout \
    '(o["v_min_mps"]["value"], o["v_max_mps"]["value"], o["vote"]["value"],
      o["nht_reading"]["value"], o["v_min_mps"]["source"]) == (100, 400, "counts", "c", "method")'
run config
check 'config names the choices' grep -Eq '^nht_reading .* c +a\|c +c +default' stdout

# ---- refusals ----
refused() { # name, pattern, arguments...
    local name=$1 pattern=$2
    shift 2
    run "$@"
    check "$name" says 2 "rhotrack: $pattern"
}
refused 'unknown method' \
    "no method 'houg'; there are: kernel, ht, mht, iht, nht, passive, passive-paper" initiate \
    table1.csv --method houg
for method in passive passive-paper; do
    refused "plots for method $method" \
        "table1.csv:1: plots, not bearings (column 'x_m'): *" \
        initiate table1.csv --method $method
done
refused 'unknown reading' "--set nht_reading=b: nht_reading 'b' is not one of a|c" initiate \
    table1.csv --set nht_reading=b
refused 'unknown vote' "--set vote=1: vote '1' is not one of scans|counts" initiate table1.csv \
    --set vote=1
refused 'too fine cells' \
    'plots 34397 m from the origin need 68796 cells of rho at d_rho_m 1, and 16384 is the '\
'limit: d_rho_m 4.2 is enough' \
    initiate "$table3" --method ht --set d_rho_m=1
# What is suggested does.
for range in 99999 100000 123456 250000 1999999; do
    printf 't_s,sensor_id,x_m,y_m\n0,1,%s,0\n2,1,500,0\n' $range >far.csv
    run initiate far.csv --method mht
    check "plots as far as $range m: cells follow" exits 0
    run initiate far.csv --method mht --set d_rho_m=1 --set eps_rho_m=100
    cell=$(sed 's/.*d_rho_m \([0-9.e+]*\) is enough/\1/' stderr)
    run initiate far.csv --method mht --set "d_rho_m=$cell" --set eps_rho_m=1000
    check "plots as far as $range m: d_rho_m $cell" exits 0
done
refused 'too wide tolerances' '2 eps_rho_m is more than 255 cells of d_rho_m 5' \
    initiate table1.csv --method nht --set eps_rho_m=700
printf 't_s,sensor_id,x_m,y_m\n0,1,1,1\n2000000000,1,5,5\n' >long.csv
refused 'scans of sixty years' 'the scans used span 2e+09 s; a batch spans at most 9e+08 s' \
    initiate long.csv --method iht
refused 'speeds' 'v_min_mps 500 is not below v_max_mps 400' initiate table1.csv --method iht \
    --set v_min_mps=500

# ---- pictures of the plane ----
run plot parameter-space table1.csv --method nht -o tif.svg
check 'the neutrosophic plane has four pictures' exits 0
for title in 'votes, C' 'truth, C_T' 'indeterminacy, C_I' 'falsity, C_F'; do
    check "one is of $title" grep -q "nht: $title" tif.svg
done
run plot parameter-space table1.csv --method iht -o iht.svg
check 'another method has one' test "$(grep -c 'votes, C\|truth' iht.svg)" = 1
run plot parameter-space table1.csv --method kernel -o x.svg
check 'and the default none' says 2 \
    'rhotrack: plot parameter-space: kernel has no accumulator of plots; '\
'ht, mht, iht and nht have one'
run plot tracks table1.csv --method nht -o x.svg
check 'nor has another picture' says 2 'rhotrack: plot tracks: --method is for parameter-space'
check 'what is refused leaves no picture' test ! -e x.svg

finish
