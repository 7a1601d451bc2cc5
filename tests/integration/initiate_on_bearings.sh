#!/bin/bash
# SPDX-License-Identifier: MIT
# initiate on bearings: what the methods refuse, and the paper's method (passive-paper).
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

for scenario in passive-two passive-three passive-clutter; do
    run simulate "$scenario" --seed 3 -o "$scenario"
done

# ---- the default search ----
run initiate passive-two/bearings.csv --set scans=2
check 'too few scans' says 2 'rhotrack: --set scans=2: scans 2 is outside 3 .. 12'
run initiate passive-two/bearings.csv --set scans=3 --json
check 'three scans are enough' json stdout '(o["scans"], o["tracks"]) == (3, 2)'
run initiate passive-two/bearings.csv --set range_max_m=999
check 'too short a range' says 2 \
    'rhotrack: range_max_m 999 is outside 1000 .. 500000 m for bearings'
# ---- initiation by the paper's method ----
# A line that is asked for passes within 6 degrees and 3 km of each target's path.
lines_are_near() { # lines, truth
    awk -F, 'function line(x, y, vx, vy) {
            t = atan2(vx, -vy)
            if (t < 0) t += pi
            r = x * cos(t) + y * sin(t)
        }
        BEGIN { pi = atan2(0, -1) }
        NR == FNR { if (FNR > 1) { line($3, $4, $5, $6); theta[$2] = t; rho[$2] = r } next }
        FNR > 1 {
            lines++
            for (i in theta) {
                dt = $8 - theta[i]; dr = $7 - rho[i]
                if (dt > pi / 2 || dt < -pi / 2) {
                    dt = dt > 0 ? dt - pi : dt + pi
                    dr = $7 + rho[i]
                }
                if (dt ^ 2 < (pi / 30) ^ 2 && dr ^ 2 < 9e6) found[i] = 1
            }
        }
        END {
            for (i in theta) { n++; m += found[i] }
            exit !(n > 0 && m == n && lines <= n + 1)
        }' "$2" "$1"
}
run simulate passive-two --seed 3 --set passive.0.sigma_rad=0.0005 \
    --set passive.1.sigma_rad=0.0005 -o sharp
run initiate sharp/bearings.csv --method passive-paper
cp stdout lines.csv
check 'passive-paper: lines along every path' lines_are_near lines.csv sharp/truth.csv
check 'passive-paper: columns' matches "$(head -n 1 lines.csv)" \
    'track_id,t_s,x_m,y_m,vx_mps,vy_mps,rho_m,theta_rad,scans,score,z_m,vz_mps'
check 'passive-paper: votes of 8 scans, at least 4 of 5' \
    awk -F, \
    'NR > 1 && ($10 < 7 || $10 > 8 || $9 < $10 || $2 != 70) { exit 1 } END { exit NR < 2 }' \
    lines.csv
run initiate sharp/bearings.csv --method passive-paper --set votes_min=1
check 'passive-paper: no place or velocity from one scan' \
    awk -F, \
    'NR > 1 && ($9 < 2) != ($3 $4 $5 $6 == "") { exit 1 } $9 == 1 { n++ } END { exit n < 1 }' stdout
run initiate sharp/bearings.csv --method passive-paper --json
check 'passive-paper: JSON' json stdout '(
    (o["method"], o["scans"], o["sensors"], o["votes_min"], o["plots"], o["pairs"]) ==
    ("passive-paper", 8, 2, 7, 32, 32) and o["pairs"] - o["candidates"] == o["ghosts"] and
    o["votes"] == 90 * o["candidates"] and len(o["peak_votes"]) == o["tracks"] == o["lines"] and
    o["peak_votes"] == sorted(o["peak_votes"], reverse=True) and
    o["lines_dropped"] == o["points_dropped"] == 0)'
run initiate sharp/bearings.csv --method passive-paper --json --set votes_min=8.5
check 'passive-paper: votes_min, in whole votes' json stdout \
    '(o["votes_min"], o["tracks"]) == (9, 0)'
run initiate sharp/bearings.csv --method passive-paper --json --set votes_min=1
check 'passive-paper: lines beyond the capacity are counted' json stdout \
    'o["tracks"] == 24 and o["lines_dropped"] > 0'
check 'and said' matches "$(cat stderr)" 'rhotrack: * lines beyond 24 are left out; raise votes_min'
run initiate passive-clutter/bearings.csv --method passive-paper --json --set votes_min=4 \
    --set prune=none
cp stdout scans.json
run initiate passive-clutter/bearings.csv --method passive-paper --json --set votes_min=4 \
    --set prune=none --set vote=counts
check 'passive-paper: crossings can count' json stdout \
    'o["cells"] > json.load(open("scans.json"))["cells"]'
run config --method passive-paper --json
check 'passive-paper: customary values' json stdout \
    '([o[key]["value"] for key in
       ("scans", "d_rho_m", "v_max_mps", "prune", "vote", "votes_min")] ==
      [8, 1000, 450, "literal", "scans", 0] and abs(o["d_theta_rad"]["value"] - 0.0349066) < 1e-6)'
run config --method passive --json
check 'passive: customary values' json stdout \
    '(o["prune"]["value"], o["prune"]["choices"]) == ("safe", "safe|literal|none")'
run initiate passive-two/bearings.csv --method passive-paper --set range_max_m=120000 --json
check 'passive-paper: cells follow from the range, with sensors 20 km apart' json stdout \
    'o["tracks"] >= 2'
run initiate passive-two/bearings.csv --method passive-paper --set range_max_m=130000 \
    --set d_rho_m=1000
check 'passive-paper: cells as set for the range' says 2 \
    'rhotrack: range_max_m 130000 needs 260 cells of d_rho_m 1000; the limit is 256'
run initiate passive-two/bearings.csv --method passive-paper --set range_max_m=120000 \
    --set d_rho_m=1000
check 'passive-paper: cells as set for the sensors' says 2 \
    'rhotrack: sensors 1 and 2 are 20000 m apart; with cells of d_rho_m 1000 and '\
'range_max_m 120000 they may be 16000 m apart at most'
run initiate passive-two/bearings.csv --method passive-paper --set d_theta_rad=0.01
check 'passive-paper: cells for half a turn' says 2 \
    'rhotrack: d_theta_rad 0.01 needs 315 cells over half a turn; the limit is 90'
run initiate passive-two/bearings.csv --method passive-paper --set votes_min=256
check 'passive-paper: votes that it cannot count' says 2 \
    'rhotrack: votes_min 256 is more than 255, the most that passive-paper counts'
run initiate passive-two/bearings.csv --set prune=all
check 'unknown pruning' says 2 \
    "rhotrack: --set prune=all: prune 'all' is not one of safe|literal|none"

finish
