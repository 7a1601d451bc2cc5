#!/bin/bash
# SPDX-License-Identifier: MIT
#
# The live side for a few seconds: `publish` plays a simulated radar, `node` tracks what it hears,
# over LCM on this machine. In a network namespace of its own where that is allowed, else on the
# machine's network with ttl 0, which leaves no machine. Usage: RHOTRACK=program demo_live.sh OUTPUT
set -euo pipefail
program=$(realpath "${RHOTRACK:-build/rhotrack}")
out=${1:-build/demo-live}
seconds=8

if [ -z "${RHOTRACK_DEMO_INSIDE:-}" ] && command -v ip >/dev/null && unshare \
    -Urn true 2>/dev/null; then
    RHOTRACK=$program RHOTRACK_DEMO_INSIDE=1 exec unshare -Urn bash "$0" "$out"
fi
if [ -n "${RHOTRACK_DEMO_INSIDE:-}" ]; then
    ip link set lo up && ip route add 224.0.0.0/4 dev lo
fi
# A port of its own, so that nobody else's sensors are heard.
export LCM_DEFAULT_URL="udpm://239.255.76.67:$((20000 + $$ % 10000))?ttl=0"

"$program" simulate traffic --seed 1 --set targets.0.count=8 --set duration_s=600 \
    --set clutter.0.plots=100 -o "$out"
echo "8 aircraft among 100 clutter plots a scan, 60 scans 10 s apart, played 100 times as fast:"

player=''
trap '[ -z "$player" ] || kill "$player" 2>/dev/null || true' EXIT
{
    sleep 0.5
    exec "$program" publish "$out/plots.csv" --speed 100 2>"$out/publish.txt"
} &
player=$!
if [ -t 1 ]; then
    "$program" node --config "$out/scenario.ini" --for "$seconds" --print --log "$out/live.lcm"
else
    "$program" node --config "$out/scenario.ini" --for "$seconds" --log "$out/live.lcm"
fi
kill "$player" 2>/dev/null || true
wait "$player" || true
player=''

"$program" convert "$out/live.lcm" "$out/tracks.csv" --kind tracks 2>/dev/null
"$program" evaluate "$out/truth.csv" "$out/tracks.csv" >"$out/evaluation.txt"
printf '\nThe tracks of the last scan, as they were received and logged:\n'
awk -F, '
    NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; next }
    $c["t_s"] != t { n = 0; t = $c["t_s"] }
    $c["status"] != "tentative" && $c["status"] != "deleted" {
        row[n++] = sprintf("%6d  %-9s %9.2f %9.2f %6.0f %6d", $c["track_id"], $c["status"],
                           $c["x_m"] / 1e3, $c["y_m"] / 1e3,
                           sqrt($c["vx_mps"] ^ 2 + $c["vy_mps"] ^ 2), $c["hits"]) }
    END { printf "%6s  %-9s %9s %9s %6s %6s\n", "track", "status", "x km", "y km", "m/s", "hits"
          for (i = 0; i < n; i++) print row[i] }' "$out/tracks.csv"
figure() { awk -v name="$1" '$1 == name { printf "%.3g", $2 }' "$out/evaluation.txt"; }
printf '\n%s of %s targets found, %s false tracks a scan, %s m rms. The log: %s\n' \
    "$(figure targets_found)" \
    "$(figure targets)" "$(figure false_per_scan)" "$(figure rmse_m)" "$out/live.lcm"
