#!/bin/bash
# SPDX-License-Identifier: MIT
# Zones: two vehicles on a road, one along the lane and one against it, and one that stops in it;
# counts, events, the node's messages; what is refused.
here=$(realpath "$(dirname "$0")")
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"
# shellcheck source=tests/integration/network.bash
. "$here/network.bash"

cat >road.json <<'JSON'
{"version": 1, "duration_s": 40,
 "settings": {"v_max_mps": 40, "accel_max_mps2": 5},
 "radars": [{"interval_s": 0.1, "range_m": [1, 300], "sigma_range_m": 0.3,
             "sigma_azimuth_rad": 0.003, "sigma_range_rate_mps": 0.1}],
 "targets": [
   {"at_m": [-150, 22], "speed_mps": 15, "heading_rad": 0, "until_s": 20},
   {"at_m": [150, 26], "speed_mps": 12, "heading_rad": 3.14159265, "until_s": 25},
   {"at_m": [-120, 34], "speed_mps": 10, "heading_rad": 0,
    "legs": [{"to_speed_mps": 0.3, "along_mps2": 0.4}]}]}
JSON
run simulate road.json -o road
cat >zones.ini <<'INI'
[zone 7]
corners_m = -50 15, 50 15, 50 40, -50 40
heading_rad = 0
margin_m = 2
queue_mps = 1
[zone 8]
corners_m = 200 200, 220 200, 210 220
INI
run track road/plots.csv --config road/scenario.ini --config zones.ini --zone-events events.csv \
    -o tracks.csv --json
check 'a road with zones is tracked' exits 0
check 'one along, one against, one inside in the queue' json stdout '(lambda z: z["entered"] == 3
    and z["left"] == 2 and z["along"] == 1 and z["against"] == 1 and z["ended"] == 0
    and z["inside"] == 1 and z["queued"] == 1 and 6 < z["dwell_mean_s"] < 9)(o["zones"][0])'
check 'the other zone saw nobody' json stdout 'o["zones"][1]["entered"] == 0'
check 'so it says in words' grep -q \
    '^zone 7: 3 entered, 2 left (1 along, 1 against), 0 ended inside; 1 inside, 1 queued' stderr
check 'five events' test "$(grep -c '^[0-9]' events.csv)" -eq 5
check 'of who passed how long it took' awk -F, \
    '$4 == "leaves" {n++; bad += !($7 > 6 && $7 < 9)} END {exit n != 2 || bad}' events.csv

# ---- live: the same counts ----
log=$PWD/node.lcm
run convert road/plots.csv road.lcm --config road/scenario.ini
run node --lcm "file://$PWD/road.lcm?speed=0" --config road/scenario.ini --config zones.ini \
    --log "$log" --for 20
count() { grep -aoF "$1" "$log" | wc -l; }
check 'the node tells of its zones' test "$(count RHO_ZONES)" -ge 1
check 'and of each step with events' test "$(count RHO_ZONE_EVENTS)" -eq 5

# ---- refused ----
refused() { # text of the file, message
    printf '%b' "$1" >bad.ini
    run track road/plots.csv --config bad.ini -o no.csv
    check "refused: $2" says 2 "*$2*"
    check 'and nothing is written' test ! -e no.csv
}
refused '[zone 1]\nmargin_m = 2\n' 'zone 1 has no corners_m'
refused '[zone 1]\ncorners_m = 0 0, 1 x, 3 3\n' \
    "bad.ini:2: corners_m '0 0, 1 x, 3 3' is not 'x y, x y, x y', with 3 to 8 corners"
refused '[zone 1]\ncorners_m = 0 0, 1 1, 2 2\n' 'zone 1: its corners enclose no area'
refused '[zone 1]\nheading_rad = 9\n' "bad.ini:2: heading_rad '9' is not a number of -7 .. 7"
refused '[zone one]\nmargin_m = 2\n' 'is not zone.N.key with a whole number N'
refused '[zone 1]\nname = 2\n' "bad.ini:2: a zone has no 'name'; it has corners_m, heading_rad"
run track road/plots.csv --config road/scenario.ini --zone-events events.csv -o no.csv
check 'events without a zone are refused' says 2 '*--zone-events: no zone is set*'
run track road/plots.csv --config road/scenario.ini --config zones.ini --set zone.7.queue_mps=0 \
    --json -o tracks.csv
check '--set goes before the file' json stdout 'o["zones"][0]["queued"] == 0'
finish
