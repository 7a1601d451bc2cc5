#!/bin/bash
# SPDX-License-Identifier: MIT
# track and initiate: what comes out, whatever form the same plots come in.
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Two targets for 12 scans, 10 s apart: (200, 50) m/s and (-150, 100) m/s, some metres of noise; 2
# plots a scan.
awk 'BEGIN {
    srand(7)
    print "t_s,sensor_id,x_m,y_m"
    for (k = 0; k < 12; k++) {
        printf "%.1f,1,%.2f,%.2f\n", 10 * k, -9000 + 2000 * k + 20 * (rand() - .5),
            500 * k + 20 * (rand() - .5)
        printf "%.1f,1,%.2f,%.2f\n", 10 * k, 30000 - 1500 * k + 20 * (rand() - .5),
            1000 * k + 20 * (rand() - .5)
    } }' >plots.csv

run track plots.csv
cp stdout tracks.csv
cp stderr summary
check 'tracks on standard output' exits 0
check 'columns of the tracks' matches "$(head -n 1 tracks.csv)" \
    't_s,track_id,status,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps,ax_mps2,ay_mps2,az_mps2,'\
'sigma_m,sigma_mps,hits,misses,sensor_id,plot'
check 'one line of summary' matches "$(cat summary)" \
    'rhotrack: 12 scans, 24 plots, 2 tracks confirmed; '\
'lost: 0 invalid, 0 stale, 0 no room; * us a scan, * at most'

for command in track initiate; do
    run $command plots.csv --set accel_max_mps2=20 --set v_max_mps=300
    check "$command: looks that hide the turns that were told" grep -q \
        '^rhotrack: looks each 10 s hide turns: with accel_max_mps2=20 ' stderr
done

awk 'BEGIN { print "t_s,x_m,y_m"; for (t = 0; t < 200; t += 5) print t "," 100 * t + t * t ",0" }' \
    >faster.csv
run track faster.csv --set v_max_mps=300
check 'a track that ends since it has become too fast' grep -q \
    ', 1 tracks ended, faster than v_max_mps=300;' stderr

# Column numbers: 1 t_s, 2 track_id, 3 status, 4 x, 5 y, 6 z, 7 vx, 8 vy, 13 sigma_m, 15 hits, 16
# misses, 18 plot.
last_scan_is_true() {
    awk -F, '$1 == "110.000000" && $3 == "confirmed" {
            n++
            if (($7 - 200)^2 + ($8 - 50)^2 < 25 &&
                ($4 - 13000)^2 + ($5 - 5500)^2 < 900 && $18 == 0) a++
            if (($7 + 150)^2 + ($8 - 100)^2 < 25 &&
                ($4 - 13500)^2 + ($5 - 11000)^2 < 900 && $18 == 1) b++
        } END { exit !(n == 2 && a == 1 && b == 1) }' tracks.csv
}
check 'both targets are confirmed, in place, at their velocities, with their plots' \
    last_scan_is_true
check 'unmeasured axes are 0' awk -F, 'NR > 1 && ($6 || $9 || $12) { exit 1 }' tracks.csv
check 'targets that fly straight pull next to nothing' \
    awk -F, 'NR > 1 && ($10 ^ 2 > 4 || $11 ^ 2 > 4) { exit 1 }' tracks.csv
check 'one row a track and scan' awk -F, 'NR > 1 && seen[$1, $2]++ { exit 1 }' tracks.csv
check 'numbers of rows' awk -F, 'NF != 18 { exit 1 }' tracks.csv

# ---- the same plots in another form ----
same() { # name, file
    run track "$2"
    check "$1" writes_same_as tracks.csv
}
sed 's/$/\r/' plots.csv >form.csv
same 'lines with CR LF' form.csv
{ printf '\xEF\xBB\xBF'; cat plots.csv; } >form.csv
same 'a byte order mark' form.csv
awk '{ print "# comment " NR; print; print "" }' plots.csv >form.csv
same 'comments and blank lines' form.csv
awk -F, '{ print $4 "," $2 "," $1 "," $3 }' plots.csv >form.csv
same 'another order of columns' form.csv
awk -F, '{ print (NR == 1 ? "note,more" : "\"quoted, with a comma\nand a line end\",x") "," $0 }' \
    plots.csv >form.csv
same 'extra columns, quoted' form.csv
awk -F, 'NR > 1 { $3 = "\"" $3 "\""; $4 = " " $4 " " } { print }' OFS=, plots.csv >form.csv
same 'quoted numbers and spaces' form.csv
awk -F, 'NR > 1 { $1 = sprintf("%.3e", $1) } { print }' OFS=, plots.csv >form.csv
same 'times with an exponent' form.csv
head -c -1 plots.csv >form.csv
same 'no end of the last line' form.csv
"$program" track /dev/stdin <plots.csv >stdout 2>stderr
status=$?
check 'a pipe' writes_same_as tracks.csv

# ---- as many sensors as a file names ----
# Radars, each with a target of its own, 10 turns: below 256 each starts its tracks; memory for 257
# windows, not for 900.
many_radars() {
    awk -v radars="$1" 'BEGIN { print "t_s,sensor_id,x_m,y_m"
        for (k = 0; k < 10; k++)
            for (s = 1; s <= radars; s++)
                printf "%.3f,%d,%d,%d\n", 4 * k + 0.004 * s, s, 2000 * s, 2000 + 400 * k
    }'
}
many_radars 100 >many.csv
run track many.csv --set v_max_mps=150
check 'a hundred radars: each has a track of its target' \
    matches "$(awk -F, 'NR > 1 { seen[$17] = 1 } END { for (id in seen) n++; print n }' stdout)" 100
many_radars 900 >many.csv
(ulimit -v 2000000 && "$program" track many.csv --set v_max_mps=150 >stdout 2>stderr)
check 'radars beyond 256 share a window' matches "$?" 0
check 'which is told' matches "$(head -n 1 stderr)" \
    'rhotrack: 256 initiation windows are in use: sensor 257 and further ones share another, *'
check 'once' matches "$(grep -c 'windows are in use' stderr)" 1

# ---- outputs ----
run track plots.csv -o out.csv
check 'tracks to a file' cmp tracks.csv out.csv
check 'nothing on standard output then' test ! -s stdout
check 'nothing beside the file' matches "$(echo out*)" out.csv
chmod 640 out.csv && ln -s out.csv link.csv
run track plots.csv -o link.csv
check 'an output that is a link stays one' test -L link.csv
check 'an output keeps its mode' matches "$(stat -c %a out.csv)" 640
run track plots.csv -o /dev/stdout
check 'an output that is no plain file' writes_same_as tracks.csv
echo first >all.csv
"$program" track plots.csv -o /dev/stdout >>all.csv 2>stderr
check 'standard output is appended to' matches "$(head -n 1 all.csv)" first
tail -n +2 all.csv >stdout
check 'all of it' writes_same_as tracks.csv
# A name that leads to a file without one, as a caller's temporary file is.
ln -s "/proc/$$/fd/5" nameless.csv
exec 5>gone.csv
rm gone.csv
run track plots.csv -o nameless.csv
check 'an output without a name' matches "$status" 0
check 'is written itself' cmp tracks.csv "/proc/$$/fd/5"
check 'and the link to it stays' test -L nameless.csv
printf 'sensor_id,x_m,y_m\n1,5000,5000\n' >map.csv
exec 5<>map.csv
rm map.csv
run track plots.csv --clutter-map nameless.csv
check 'no clutter map is written to it' matches "$status $(tail -n 1 stderr)" \
    '1 *nameless.csv: cannot be written: *'
check 'nor is the link to it replaced' test -L nameless.csv
exec 5>&-
cp plots.csv both.csv
run track both.csv -o both.csv
check 'an output that is the input' cmp tracks.csv both.csv

run track plots.csv --json
cp stdout results.json
check 'json: one object' is_json results.json
check 'json: what it must hold' json results.json \
    '((o["scans"], o["plots"], o["tracks_confirmed"]) == (12, 24, 2)
    and o["max_us"] >= o["mean_us"] > 0)'
check 'json: state' json results.json 'o["state_bytes"] > 1000000'
check 'json: fates add up' json results.json \
    '(sorted(o["fates"]) == ["claimed", "ghost", "held", "invalid", "no_room", "stale"]
    and sum(o["fates"].values()) == 24)'
check 'json: the work for new tracks' json results.json \
    '(o["work_worst"] >= o["work"] and o["work_worst"] > 0
    and (o["partial_steps"], o["plots_not_tried"]) == (0, 0))'
check 'json: the rates of lives, of which nothing is learned in so few scans' json results.json \
    '(lambda l: 0.004 < l["death_rate"] < 0.006 and 0.004 < l["hide_rate"] < 0.006
    and 0.2 < l["appear_rate"] < 0.4 and l["lived_scans"] == 0)(o["life"])'
check 'json: both targets exist, and are visible' json results.json \
    '([t["track_id"] for t in o["life"]["tracks"]] == [1, 2] and all(
    0.99 < t["visibility"] <= t["existence"] <= 1 for t in o["life"]["tracks"]))'
run track plots.csv --json --set work_max=1
check 'a limit on it leaves plots out, and says so' json stdout \
    'o["partial_steps"] > 0 and o["plots_not_tried"] > 0'
check '... in the summary' grep -q 'work_max left out plots, [0-9]* times' stderr
run track plots.csv --json -o out.csv
check 'json with -o: tracks in the file' cmp tracks.csv out.csv
check 'json with -o: one object' is_json stdout

run track plots.csv --covariance
cut -d, -f1-18 stdout >first_columns.csv
check 'covariance: the other columns are the same' cmp tracks.csv first_columns.csv
check 'covariance: 21 columns more' awk -F, 'NF != 39 { exit 1 }' stdout
check 'covariance: their names' matches "$(head -n 1 stdout)" \
    '*,plot,cov_x_x,cov_y_x,cov_y_y,*,cov_vz_vz'
check 'covariance: its diagonal gives sigma_m' awk -F, 'NR > 1 {
    s = sqrt(($19 + $21) / 2) - $13; if (s * s > 1e-6 * $13 * $13) exit 1 }' stdout

# ---- gates ----
# The target of Liu's paper, in its beam: the Hough gate holds it from the first to the last scan,
# as `maintain` does, by its own window and by the whole beam. Measured: 100 of 100 and 60 of 60.
one_identity() { # settings...: in all of 20 runs
    local seed
    for seed in {1..20}; do
        rm -rf popup
        run simulate popup --seed "$seed" --set radars.0.sigma_mps=1 -o popup
        run track popup/plots.csv --config popup/scenario.ini --gate hough \
            --set input_estimation=1 "$@" -o popup/tracks.csv
        run evaluate popup/truth.csv popup/tracks.csv --json
        json stdout 'o["switches"] == 0 and o["completeness"] > 0.98' || return
    done
}
check "gate hough: the paper's target keeps its identity" one_identity
check 'so does it with the whole beam' one_identity --set gate_window_m=4e6
check 'and from P(0|0) = 500 I' one_identity --set initial_variance=500
run track plots.csv --gate best
check 'the default gate is best' writes_same_as tracks.csv
for gate in best hough nearest; do
    run track plots.csv --gate $gate
    check "gate $gate: exit 0" exits 0
    cp stdout tracks.csv
    check "gate $gate: both targets, in place, with their plots" last_scan_is_true
    run track plots.csv --set gate=$gate
    check "gate $gate, as a parameter" writes_same_as tracks.csv
    run track plots.csv --set gate=nearest --gate $gate
    check "gate $gate: --gate goes before the parameter" writes_same_as tracks.csv
    run track plots.csv --gate $gate --json
    check "gate $gate: JSON" json stdout '(o["tracks_confirmed"], sum(o["fates"].values()),
        o["counters"]["hypotheses_cut"]) == (2, 24, 0)'
done
run track plots.csv
cp stdout tracks.csv

# A target that flies straight for 12 scans, 2 s apart, then turns with 20 m/s^2; another one
# crosses its way at 150 m/s. One plot of clutter a scan within 400 m of each. Columns of truth.csv:
# and acceleration.
awk 'function error() { return 10 * (rand() + rand() + rand() + rand() - 2) * sqrt(3) }
    BEGIN {
        srand(5); pi = atan2(0, -1)
        print "t_s,sensor_id,x_m,y_m" >"turn.csv"
        print "t_s,target_id,x_m,y_m,ax_mps2,ay_mps2" >"truth.csv"
        x = -10000; y = 2000; heading = 0
        for (k = 0; k < 40; k++) {
            t = 2 * k; px = -4000; py = -4000 + 150 * t
            a = k < 12 ? 0 : 20
            printf "%d,1,%.3f,%.3f,%.3f,%.3f\n", t, x, y, -a * sin(heading),
                a * cos(heading) >"truth.csv"
            printf "%d,2,%.3f,%.3f,0,0\n", t, px, py >"truth.csv"
            printf "%d,1,%.2f,%.2f\n", t, x + error(), y + error() >"turn.csv"
            printf "%d,1,%.2f,%.2f\n", t, px + error(), py + error() >"turn.csv"
            for (i = 0; i < 2; i++) {
                u = 800 * rand() - 400; w = 800 * rand() - 400
                printf "%d,1,%.2f,%.2f\n", t, (i < 1 ? x : px) + u, (i < 1 ? y : py) + w >"turn.csv"
            }
            for (j = 0; j < 200; j++) {
                x += 300 * cos(heading) * 0.01; y += 300 * sin(heading) * 0.01
                heading += a / 300 * 0.01
            }
        }
    }'
# Columns: 10 ax, 11 ay, and of the truth 5, 6. From the fifth scan of the turn on. A tracker
# without an acceleration is off by 20.
pulls_as_the_target() { # FILE
    awk -F, 'NR == FNR {
            if ($2 == 1) { x[$1 + 0] = $3; y[$1 + 0] = $4; ax[$1 + 0] = $5; ay[$1 + 0] = $6 }
            next
        }
        FNR > 1 && $1 >= 34 && $2 == 1 && ($4 - x[$1 + 0])^2 + ($5 - y[$1 + 0])^2 < 10000 {
            n++; sum += ($10 - ax[$1 + 0])^2 + ($11 - ay[$1 + 0])^2
            along += ($10 * ax[$1 + 0] + $11 * ay[$1 + 0]) / 400
        }
        END {
            print n, sqrt(sum / n), along / n
            exit !(n == 23 && sqrt(sum / n) < 12 && along / n > 0.5)
        }' truth.csv "$1"
}
# is_followed FILE: at the last scan both targets have a confirmed track within 60 m, and have had
# it from the start
is_followed() {
    awk -F, 'NR == FNR { x[$2] = $3; y[$2] = $4; next }
        $1 == "78.000000" && $3 == "confirmed" {
            for (i = 1; i <= 2; i++)
                if (($4 - x[i])^2 + ($5 - y[i])^2 < 3600 && $15 + $16 >= 38) found[i] = 1
        }
        END { exit !(found[1] && found[2]) }' truth.csv "$1"
}
run track turn.csv
cp stdout best.csv
check 'best: a turn and a crossing in clutter' is_followed best.csv
check 'best: accelerations in the turn are the target'"'"'s' pulls_as_the_target best.csv
run track turn.csv --gate hough
cp stdout hough.csv
run track turn.csv --gate nearest
cp stdout nearest.csv
check 'hough and nearest choose other plots' bash -c '! cmp -s hough.csv nearest.csv'
check 'without input estimation they know no acceleration' \
    awk -F, 'NR > 1 && FNR > 1 && ($10 || $11 || $12) { exit 1 }' hough.csv nearest.csv
run track turn.csv --gate hough --set planes=xz
check 'planes alone that plots without heights do not have: all the same' writes_same_as hough.csv
run track turn.csv --gate hough --set gate_theta_deg=45
check 'gate_theta_deg has an effect' bash -c '! cmp -s stdout hough.csv'

# ---- where a value comes from: CSV column, --set, --config, default ----
awk -F, '{ print $0 "," (NR == 1 ? "sigma_m" : 25) }' plots.csv >sigma25.csv
printf 'sigma_m = 25\n' >sigma25.ini
printf 'sigma_m = 3\n' >sigma3.ini
run track plots.csv --set sigma_m=25
cp stdout tracks25.csv
check 'sigma_m by --set has an effect' bash -c '! cmp -s tracks.csv tracks25.csv'
run track plots.csv --config sigma25.ini
check 'sigma_m by --config' writes_same_as tracks25.csv
run track plots.csv --set sigma_m=25 --config sigma3.ini
check '--set goes before --config' writes_same_as tracks25.csv
run track sigma25.csv --set sigma_m=3 --config sigma3.ini
check 'the column goes before --set' writes_same_as tracks25.csv
awk -F, 'NR > 1 { $5 = "" } { print }' OFS=, sigma25.csv >empty_sigma.csv
run track empty_sigma.csv --set sigma_m=25
check 'an empty cell leaves it to --set' writes_same_as tracks25.csv
run track plots.csv --set sensor.1.sigma_m=25 --set sigma_m=3
check "a sensor's own goes before that of all" writes_same_as tracks25.csv
run track plots.csv --set sigma_m=10
check 'the default is 10 m' writes_same_as tracks.csv
run track plots.csv --set range_max_m=50000 --set sensor.1.pd=0.8 --json
check 'limits of sensors are taken' exits 0

# ---- scans ----
{ cat plots.csv; for k in {12..21}; do echo "$((10 * k)),1,,"; done; } >ends.csv
run track ends.csv
check 'a scan that saw nothing counts' grep -q 'rhotrack: 22 scans, 24 plots' stderr
check 'and tracks coast' awk -F, '$3 == "coasting" && $18 == -1 { n++ } END { exit !n }' stdout
check 'and end' awk -F, '$1 + 0 >= 210 { exit 1 }' stdout

awk -F, 'NR > 1 { $2 = 2 - NR % 2 } { print }' OFS=, plots.csv >two_sensors.csv
awk -F, 'NR == 1 || $2 == 1' two_sensors.csv >sensor1.csv
awk -F, 'NR == 1 || $2 == 2' two_sensors.csv >sensor2.csv
run track two_sensors.csv
cp stdout two.csv
first=$(awk -F, 'NR == 2 { print $2 }' two_sensors.csv)
run track "sensor$first.csv" "sensor$((3 - first)).csv"
check 'two inputs are merged by time' writes_same_as two.csv
check 'and all of both counts' grep -q 'rhotrack: 24 scans, 24 plots' stderr
run track plots.csv plots.csv --json
check 'equal scans of two inputs stay two' json stdout 'o["scans"] == 24 and o["plots"] == 48'

awk -F, 'NR > 1 { $1 += (NR % 2) * 4 } { print }' OFS=, plots.csv >rotating.csv
run track rotating.csv --json
check 'every t_s a scan' json stdout 'o["scans"] == 24'
run track rotating.csv --set scan_interval_s=9 --json
check 'scan_interval_s joins the rows of a turn' json stdout 'o["scans"] == 12 and o["plots"] == 24'

awk -F, 'NR > 1 { $1 = sprintf("17000%05d.123457", $1) } { print }' OFS=, plots.csv >epoch.csv
run track epoch.csv
check 'large times keep their microseconds' grep -q '^1700000110.123457,' stdout
sed 's/^17000\([0-9]*\).123457/\1.000000/; s/^0*\([0-9]\)/\1/' stdout >shifted.csv
check 'and the tracks are the same' cmp tracks.csv shifted.csv
awk -F, 'NR > 1 { $1 = $1 - 50 } { print }' OFS=, plots.csv >negative.csv
run track negative.csv
check 'times below zero' awk -F, 'NR > 1 && $1 + 0 > 60 { exit 1 } END { exit !(NR > 3) }' stdout
printf 't_s,sensor_id,x_m,y_m\n-4e12,1,2,3\n0,1,2,3\n4e12,1,2,3\n' >far.csv
run track far.csv
check 'the farthest times' exits 0

awk -F, 'NR == 1 { print $0 ",z_m,vx_mps,vy_mps,vz_mps" } NR > 1 {
    print $0 ",3000," (NR % 2 ? "-150,100" : "200,50") ",0" }' plots.csv >full.csv
run track full.csv
check 'height is tracked' awk -F, '$1 == "110.000000" && ($6 < 2970 || $6 > 3030) { exit 1 }' stdout
run initiate full.csv
check 'and initiated' \
    awk -F, 'NR > 1 && ($11 < 2970 || $11 > 3030) { exit 1 } END { exit NR < 2 }' stdout

# ---- initiate ----
run initiate plots.csv
cp stdout initiated.csv
check 'initiate says which scans it takes' matches "$(cat stderr)" \
    'rhotrack: the last 7 of 12 scans are used'
check 'columns of initiated tracks' matches "$(head -n 1 initiated.csv)" \
    'track_id,t_s,x_m,y_m,vx_mps,vy_mps,rho_m,theta_rad,scans,score,z_m,vz_mps'
both_found() {
    awk -F, 'NR > 1 {
            n++
            if (($5 - 200)^2 + ($6 - 50)^2 < 25 && ($3 - 13000)^2 + ($4 - 5500)^2 < 900) a++
            if (($5 + 150)^2 + ($6 - 100)^2 < 25 && ($3 - 13500)^2 + ($4 - 11000)^2 < 900) b++
            rho = $3 * cos($8) + $4 * sin($8)
            if ((rho - $7)^2 > 1 || $8 < 0 || $8 >= 3.14159266 ||
                $2 != "110.000000" || $9 != 7) bad++
        } END { exit !(n == 2 && a == 1 && b == 1 && !bad) }' initiated.csv
}
check 'both targets are found at the last scan, on their lines' both_found
run initiate plots.csv --method kernel --json
check 'initiate: one JSON object' is_json stdout
check 'initiate: what it must hold' json stdout '(o["method"], o["scans"], o["plots"], o["tracks"],
    o["peak_votes"], o["votes"]) == ("kernel", 7, 14, 2, [7, 7], 14)'
check 'initiate: and more' json stdout \
    'all(k in o for k in ["pairs", "candidates", "state_bytes", "wall_us"])'
run initiate plots.csv --json -o out.csv
check 'initiate: tracks in the file' cmp initiated.csv out.csv
run initiate plots.csv --set scans=12
check 'initiate: as many scans as asked for' test ! -s stderr
run initiate plots.csv --set score_min_nat=900
check 'initiate: score_min_nat' matches "$(wc -l <stdout)" 1

finish
