#!/bin/bash
# SPDX-License-Identifier: MIT
#
# The main job on real data: the radar plots of three aircraft (tests/vectors/radar-table3.csv)
# among 100 clutter plots a scan, and two recordings of a harbour (tools/scenes/harbour), through
# the tracker. Prints the tracks beside the truth, and writes OUTPUT/index.html with pictures and
# pages.
# Usage: RHOTRACK=program demo.sh OUTPUT
set -euo pipefail
program=${RHOTRACK:-build/rhotrack}
out=${1:-build/demo}

"$program" simulate radar --seed 1 -o "$out"
"$program" track "$out/plots.csv" --config "$out/scenario.ini" \
    -o "$out/tracks.csv" --json >"$out/track.json"
"$program" evaluate "$out/truth.csv" "$out/tracks.csv" >"$out/evaluation.txt"
"$program" plot tracks "$out/plots.csv" "$out/truth.csv" "$out/tracks.csv" -o "$out/map.svg"
"$program" plot tracks "$out/plots.csv" "$out/truth.csv" "$out/tracks.csv" -o "$out/map.html"
"$program" plot parameter-space "$out/plots.csv" "$out/tracks.csv" -o "$out/parameter-space.svg"
"$program" plot scans "$out/plots.csv" -o "$out/scans.svg"
"$program" plot errors "$out/truth.csv" "$out/tracks.csv" -o "$out/errors.svg"

# What is known of that radar and of boats, before anything was tracked; a track farther from a
# vessel than 40 m is not its.
scenes=$(dirname "$0")/scenes/harbour
for scene in 2 16; do
    name=harbour-$scene
    "$program" track "$scenes/$scene/plots.csv" --set sigma_m=7 --set v_max_mps=15 \
        --set accel_max_mps2=1 \
        -o "$out/$name-tracks.csv" --json >"$out/$name.json"
    "$program" evaluate "$scenes/$scene/truth.csv" "$out/$name-tracks.csv" --set gospa_cutoff_m=40 \
        >"$out/$name.txt"
    "$program" plot tracks "$scenes/$scene/plots.csv" "$scenes/$scene/truth.csv" \
        "$out/$name-tracks.csv" -o "$out/$name.svg"
    "$program" plot tracks "$scenes/$scene/plots.csv" "$scenes/$scene/truth.csv" \
        "$out/$name-tracks.csv" -o "$out/$name.html"
done

# One line a track of the last scan: the target nearest to it, both states, and the error.
compare() {
    awk -F, -v found="$1" '
        function heading(vx, vy) { a = atan2(vx, vy) * 57.29577951; return a < 0 ? a + 360 : a }
        FNR == 1 { file++; for (i = 1; i <= NF; i++) column[file, $i] = i; next }
        file == 1 && $column[1, "t_s"] >= last_truth {
            last_truth = $column[1, "t_s"]; id = $column[1, "target_id"]
            tx[id] = $column[1, "x_m"]; ty[id] = $column[1, "y_m"]
            tvx[id] = $column[1, "vx_mps"]; tvy[id] = $column[1, "vy_mps"]; next }
        file == 2 && $column[2, "status"] != "tentative" { id = $column[2, "track_id"]
            if (!(id in first)) { order[++n] = id; first[id] = $column[2, "t_s"] }
            last[id] = $column[2, "t_s"]; x[id] = $column[2, "x_m"]; y[id] = $column[2, "y_m"]
            vx[id] = $column[2, "vx_mps"]; vy[id] = $column[2, "vy_mps"]
            hits[id] = $column[2, "hits"] }
        END {
            for (k = 1; k <= n; k++) {
                id = order[k]; best = -1
                for (t in tx) { d = sqrt((x[id] - tx[t]) ^ 2 + (y[id] - ty[t]) ^ 2)
                    if (last[id] == last_truth && (best < 0 || d < error)) { best = t; error = d } }
                if (best < 0 || error > 300) { wrong++; continue }
                printf found, id, first[id], hits[id], x[id] / 1e3, y[id] / 1e3,
                    sqrt(vx[id] ^ 2 + vy[id] ^ 2), heading(vx[id], vy[id]), best + 1,
                    tx[best] / 1e3, ty[best] / 1e3, sqrt(tvx[best] ^ 2 + tvy[best] ^ 2),
                    heading(tvx[best], tvy[best]), error
            }
            if (found ~ /^ /)
                printf "\n%d of %d targets tracked, %d false tracks\n", n - wrong, length(tx), wrong
        }' "$out/truth.csv" "$out/tracks.csv"
}

figure() { awk -v name="$1" '$1 == name { printf "%.3g", $2 }' "$out/${2:-evaluation}.txt"; }
number() { sed -n "s/.*\"$1\":[^0-9]*\([0-9]*\).*/\1/p" "$out/$2.json" | head -n 1; }

# One line a scene of the harbour.
harbour() {
    local scene name
    for scene in 2 16; do
        name=harbour-$scene
        # shellcheck disable=SC2059
        printf "$1" "$scene" "$(number scans "$name")" "$(number plots "$name")" \
            "$(figure targets_found "$name")" \
            "$(figure completeness "$name")" "$(figure switches "$name")" \
            "$(figure rmse_m "$name")" \
            "$(figure false_per_scan "$name")"
    done
}
mean_us=$(number mean_us track)
plots=$(number plots track)

table() {
    printf '\n%s\n' "Three aircraft, 7 scans 10 s apart, $plots plots of which 21 are theirs:"
    printf '\n%54s | %s\n' 'track at the last scan' 'truth'
    printf '%6s %6s %5s %8s %8s %6s %8s | %6s %8s %8s %6s %8s %8s\n' track 'from s' plots 'x km' \
        'y km' \
        m/s heading target 'x km' 'y km' m/s heading 'error m'
    compare ' %5d %6d %5d %8.2f %8.2f %6.0f %7.0f° | %6d %8.2f %8.2f %6.0f %7.0f° %8.0f\n'
    printf 'The truth is the real plots, with their noise. %s us a scan.\n' "$mean_us"
    printf '\n%s\n\n' "Two vessels in a harbour, each with a satellite receiver, seen by a small \
ferry's radar, 1.68 s a turn:"
    printf '%6s %6s %6s %8s %8s %9s %8s %13s\n' scene turns plots tracked 'of time' switches \
        'error m' 'others a turn'
    harbour '%6d %6d %6d %3d of 2 %8.2f %9d %8.1f %13.1f\n'
    printf 'Others are boats, quays and buoys without truth, and clutter.\n'
    printf '\nPictures and figures: %s/index.html\n' "$out"
    printf 'To zoom and to play:  %s/map.html, harbour-2.html, harbour-16.html\n' "$out"
}

row='<tr><td>%d</td><td>%d</td><td>%d</td><td>%.2f</td><td>%.2f</td><td>%.0f</td><td>%.0f</td>'
row+='<td>%d</td>'
row+='<td>%.2f</td><td>%.2f</td><td>%.0f</td><td>%.0f</td><td>%.0f</td></tr>\n'
harbour_row='<tr><td>%d</td><td>%d</td><td>%d</td><td>%d of 2</td><td>%.2f</td><td>%d</td>'
harbour_row+='<td>%.1f</td><td>%.1f</td></tr>\n'
page() {
    cat <<HTML
<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>rhotrack: real radar plots in clutter</title>
<style>body{font:16px/1.5 system-ui,Helvetica,Arial,sans-serif;color:#222;max-width:72rem;
margin:2rem auto;padding:0 1rem}
h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2.2rem;border-bottom:1px solid #ccc}
table{border-collapse:collapse;margin:1rem 0}
th,td{padding:.25rem .8rem;text-align:right;border-bottom:1px solid #e4e4e4}
th{border-bottom:2px solid #888}.b{border-left:2px solid #bbb}
figure{margin:1.5rem 0}img{max-width:100%;height:auto}figcaption{color:#555}</style></head><body>
<h1>Three real aircraft among 100 clutter plots a scan</h1>
<p>Seven scans of a single radar, 10 s apart: $plots plots, of which 21 are the aircraft's. The
tracker reads them scan by scan; a track needs five scans' votes, so the first report is at the
fifth scan. One scan takes $mean_us us here.</p>
<table><tr><th colspan="7">track at the last scan</th><th colspan="6" class="b">truth</th></tr>
<tr><th>track</th><th>from s</th><th>plots</th>
<th>x km</th><th>y km</th><th>m/s</th><th>heading °</th>
<th class="b">target</th><th>x km</th><th>y km</th><th>m/s</th><th>heading °</th>
<th>error m</th></tr>
$(compare "$row")</table>
<p>Targets tracked: $(figure targets_found) of $(figure targets). Tracks without a target a scan:
$(figure false_per_scan). Mean error of the tracks' positions (rms): $(figure rmse_m) m.</p>
<h2>Plots and tracks</h2>
<figure><img src="map.svg" alt="Map of plots, truth and tracks">
<figcaption>Each track begins on the line that five scans voted for (dotted) and follows the
aircraft (circles); the grey plots are clutter.</figcaption></figure>
<p><a href="map.html">The same to zoom and to play</a>, with the history of each track.</p>
<h2>Parameter space</h2>
<figure><img src="parameter-space.svg" alt="Votes over rho and theta, with the tracks' lines">
<figcaption>Every plot votes for all lines through it, a sinusoid; the tracks' lines (circles) are
not where most curves cross, but where plots of different scans agree on place and
time.</figcaption></figure>
<h2>Plots by time</h2>
<figure><img src="scans.svg" alt="Plots coloured by time">
<figcaption>What the radar delivers: all plots, coloured by their scan's
time.</figcaption></figure>
<h2>Errors</h2>
<figure><img src="errors.svg" alt="Position errors over time">
<figcaption>Distance from each aircraft's plot to its track, from confirmation
on.</figcaption></figure>
<h1>Two vessels in a harbour</h1>
<p>Two recordings of a turning marine radar on a small ferry, 1.68 s a turn, in a harbour of quays,
buoys, wakes and other boats: scenarios 2 and 16 of the
<a href="https://github.com/Autoferry/sensor_fusion_dataset">Autoferry sensor fusion data set</a>
of NTNU (CC0). Two vessels carried a satellite receiver, which is the truth here. The tracker is
told that plots err by 7 m and that boats go up to 15 m/s and pull 1 m/s²; a track within 40 m of a
vessel counts as its.</p>
<table><tr><th>scene</th><th>turns</th><th>plots</th>
<th>vessels tracked</th><th>of their time</th><th>switches</th>
<th>error m (rms)</th><th>other tracks a turn</th></tr>
$(harbour "$harbour_row")</table>
<p>Other tracks are those of boats, quays and buoys without truth, and of clutter: the recording
does not tell them apart.</p>
<figure><img src="harbour-2.svg" alt="Map of plots, truth and tracks in the harbour, scene 2">
<figcaption>Scene 2: a research vessel and a leisure craft cross before the ferry, one in the
other's shadow. Truth is drawn as black circles under their tracks; the ferry lies at (-400, -30).
Of what is seen beyond them there is no truth.</figcaption></figure>
<figure><img src="harbour-16.svg" alt="Map of plots, truth and tracks in the harbour, scene 16">
<figcaption>Scene 16: two boats come from both sides and pass round the ferry, close to each
other.</figcaption></figure>
<p>To zoom and to play: <a href="harbour-2.html">scene 2</a>,
<a href="harbour-16.html">scene 16</a>.</p>
</body></html>
HTML
}

page >"$out/index.html.part"
mv "$out/index.html.part" "$out/index.html"
table
