#!/bin/bash
# SPDX-License-Identifier: MIT
#
# The main job on real data: the radar plots of three aircraft (tests/vectors/radar-table3.csv) among 100 clutter plots a
# scan, through the tracker. Prints the tracks beside the truth, and writes OUTPUT/index.html with pictures.
# Usage: RHOTRACK=program demo.sh OUTPUT
set -euo pipefail
program=${RHOTRACK:-build/rhotrack}
out=${1:-build/demo}

"$program" simulate radar --seed 1 --set clutter_per_scan=100 -o "$out"
"$program" track "$out/plots.csv" --config "$out/scenario.ini" \
    -o "$out/tracks.csv" --json >"$out/track.json"
"$program" evaluate "$out/truth.csv" "$out/tracks.csv" >"$out/evaluation.txt"
"$program" plot tracks "$out/plots.csv" "$out/truth.csv" "$out/tracks.csv" -o "$out/map.svg"
"$program" plot parameter-space "$out/plots.csv" "$out/tracks.csv" -o "$out/parameter-space.svg"
"$program" plot scans "$out/plots.csv" -o "$out/scans.svg"
"$program" plot errors "$out/truth.csv" "$out/tracks.csv" -o "$out/errors.svg"

# One line a track of the last scan: the target nearest to it, both states, and the error.
compare() {
    awk -F, -v found="$1" '
        function heading(vx, vy) { a = atan2(vx, vy) * 57.29577951; return a < 0 ? a + 360 : a }
        FNR == 1 { file++; for (i = 1; i <= NF; i++) column[file, $i] = i; next }
        file == 1 && $column[1, "t_s"] >= last_truth { last_truth = $column[1, "t_s"]; id = $column[1, "target_id"]
            tx[id] = $column[1, "x_m"]; ty[id] = $column[1, "y_m"]
            tvx[id] = $column[1, "vx_mps"]; tvy[id] = $column[1, "vy_mps"]; next }
        file == 2 && $column[2, "status"] != "tentative" { id = $column[2, "track_id"]
            if (!(id in first)) { order[++n] = id; first[id] = $column[2, "t_s"] }
            last[id] = $column[2, "t_s"]; x[id] = $column[2, "x_m"]; y[id] = $column[2, "y_m"]
            vx[id] = $column[2, "vx_mps"]; vy[id] = $column[2, "vy_mps"]; hits[id] = $column[2, "hits"] }
        END {
            for (k = 1; k <= n; k++) {
                id = order[k]; best = -1
                for (t in tx) { d = sqrt((x[id] - tx[t]) ^ 2 + (y[id] - ty[t]) ^ 2)
                    if (last[id] == last_truth && (best < 0 || d < error)) { best = t; error = d } }
                if (best < 0 || error > 300) { wrong++; continue }
                printf found, id, first[id], hits[id], x[id] / 1e3, y[id] / 1e3,
                    sqrt(vx[id] ^ 2 + vy[id] ^ 2), heading(vx[id], vy[id]), best + 1, tx[best] / 1e3,
                    ty[best] / 1e3, sqrt(tvx[best] ^ 2 + tvy[best] ^ 2), heading(tvx[best], tvy[best]), error
            }
            if (found ~ /^ /) printf "\n%d of %d targets tracked, %d false tracks\n", n - wrong, length(tx), wrong
        }' "$out/truth.csv" "$out/tracks.csv"
}

figure() { awk -v name="$1" '$1 == name { printf "%.3g", $2 }' "$out/evaluation.txt"; }
mean_us=$(sed -n 's/.*"mean_us":[^0-9]*\([0-9]*\).*/\1/p' "$out/track.json")
plots=$(sed -n 's/.*"plots":[^0-9]*\([0-9]*\).*/\1/p' "$out/track.json")

table() {
    printf '\n%s\n' "Three aircraft, 7 scans 10 s apart, $plots plots of which 21 are theirs:"
    printf '\n%54s | %s\n' 'track at the last scan' 'truth'
    printf '%6s %6s %5s %8s %8s %6s %8s | %6s %8s %8s %6s %8s %8s\n' track 'from s' plots 'x km' 'y km' \
        m/s heading target 'x km' 'y km' m/s heading 'error m'
    compare ' %5d %6d %5d %8.2f %8.2f %6.0f %7.0f° | %6d %8.2f %8.2f %6.0f %7.0f° %8.0f\n'
    printf 'Errors contain the slight turns that a straight truth line leaves out. %s us a scan.\n' "$mean_us"
    printf 'Pictures and figures: %s/index.html\n' "$out"
}

row='<tr><td>%d</td><td>%d</td><td>%d</td><td>%.2f</td><td>%.2f</td><td>%.0f</td><td>%.0f</td><td>%d</td>'
row+='<td>%.2f</td><td>%.2f</td><td>%.0f</td><td>%.0f</td><td>%.0f</td></tr>\n'
page() {
    cat <<HTML
<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>rhotrack: real radar plots in clutter</title>
<style>body{font:16px/1.5 system-ui,Helvetica,Arial,sans-serif;color:#222;max-width:72rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2.2rem;border-bottom:1px solid #ccc}
table{border-collapse:collapse;margin:1rem 0}th,td{padding:.25rem .8rem;text-align:right;border-bottom:1px solid #e4e4e4}
th{border-bottom:2px solid #888}.b{border-left:2px solid #bbb}
figure{margin:1.5rem 0}img{max-width:100%;height:auto}figcaption{color:#555}</style></head><body>
<h1>Three real aircraft among 100 clutter plots a scan</h1>
<p>Seven scans of a single radar, 10 s apart: $plots plots, of which 21 are the aircraft's. The tracker reads them scan by
scan; a track needs five scans' votes, so the first report is at the fifth scan. One scan takes $mean_us us here.</p>
<table><tr><th colspan="7">track at the last scan</th><th colspan="6" class="b">truth</th></tr>
<tr><th>track</th><th>from s</th><th>plots</th><th>x km</th><th>y km</th><th>m/s</th><th>heading °</th>
<th class="b">target</th><th>x km</th><th>y km</th><th>m/s</th><th>heading °</th><th>error m</th></tr>
$(compare "$row")</table>
<p>Targets tracked: $(figure targets_found) of $(figure targets). Tracks without a target a scan:
$(figure false_per_scan). Mean error of the tracks' positions (rms): $(figure rmse_m) m.</p>
<h2>Plots and tracks</h2>
<figure><img src="map.svg" alt="Map of plots, truth and tracks"><figcaption>Each track begins on the line that five scans
voted for (dotted) and follows the aircraft (circles); the grey plots are clutter.</figcaption></figure>
<h2>Parameter space</h2>
<figure><img src="parameter-space.svg" alt="Votes over rho and theta, with the tracks' lines"><figcaption>Every plot votes for
all lines through it, a sinusoid; the tracks' lines (circles) are not where most curves cross, but where plots of
different scans agree on place and time.</figcaption></figure>
<h2>Plots by time</h2>
<figure><img src="scans.svg" alt="Plots coloured by time"><figcaption>What the radar delivers: all plots, coloured by their
scan's time.</figcaption></figure>
<h2>Errors</h2>
<figure><img src="errors.svg" alt="Position errors over time"><figcaption>Distance from each aircraft's plot to its track,
from confirmation on.</figcaption></figure>
</body></html>
HTML
}

page >"$out/index.html.part"
mv "$out/index.html.part" "$out/index.html"
table
