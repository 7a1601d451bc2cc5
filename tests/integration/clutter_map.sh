#!/bin/bash
# SPDX-License-Identifier: MIT
# Echoes that come back, in a file: saved by one run, known by the next one from the first scan on;
# by hand; track and node; what is refused; drawn; published. And a build without the map.
# Runs beside others.
here=$(realpath "$(dirname "$0")")
. "$here/checks.bash"

# A turning radar with 30 towers that are seen half of the time, two targets, and clutter: seeds
# differ in noise and clutter alone.
make_scene() { # seed file scans
    python3 - "$@" <<'PYTHON'
import math, random, sys
seed, path, scans = int(sys.argv[1]), sys.argv[2], int(sys.argv[3])
place = random.Random(7)
towers = [(100e3 * math.sqrt(place.uniform(.02, .8)), place.uniform(-3.1, 3.1)) for _ in range(30)]
draw = random.Random(seed)
with open(path, "w") as plots:
    print("t_s,sensor_id,range_m,azimuth_rad", file=plots)
    def see(t, r, a):
        r, a = r + draw.gauss(0, 30), a + draw.gauss(0, .003)
        if 0 < r < 100e3:
            print(f"{t},1,{r:.2f},{math.remainder(a, 2 * math.pi):.7f}", file=plots)
    for k in range(scans):
        t = 4 * k
        for x, y, vx, vy in ((-30e3, -20e3, 120, 60), (10e3, 60e3, 20, -150)):
            if draw.random() < .9:
                see(t, math.hypot(x + vx * t, y + vy * t), math.atan2(y + vy * t, x + vx * t))
        for r, a in towers:
            if draw.random() < .5:
                see(t, r, a)
        for _ in range(25):
            see(t, 99e3 * math.sqrt(draw.random()), draw.uniform(-math.pi, math.pi))
with open("towers.csv", "w") as by_hand:
    print("sensor_id,x_m,y_m", file=by_hand)
    for r, a in towers:
        print(f"1,{r * math.cos(a):.1f},{r * math.sin(a):.1f}", file=by_hand)
PYTHON
}

# Rows of confirmed and coasting tracks more than 1.5 km from both targets.
false_rows() { # tracks
    awk -F, 'function far(x, y) { return ($4 - x) ^ 2 + ($5 - y) ^ 2 > 1500 ^ 2 }
             NR > 1 && $3 != "tentative" && far(-30e3 + 120 * $1, -20e3 + 60 * $1) &&
                 far(10e3 + 20 * $1, 60e3 - 150 * $1) { n++ }
             END { print n + 0 }' "$1"
}

echoes() { grep -c '^1,' "$1"; } # map

cat >scene.ini <<'INI'
v_min_mps = 30
v_max_mps = 350
accel_max_mps2 = 20
[sensor 1]
pd = 0.9
sigma_range_m = 30
sigma_azimuth_rad = 0.003
range_max_m = 100000
INI
make_scene 1 first.csv 100
make_scene 2 second.csv 60

# ---- one run teaches the next ----
run track first.csv --config scene.ini --clutter-map map.csv -o tracks.csv
check 'a map that is not there yet' matches "$(head -n 1 stderr)" \
    'rhotrack: map.csv: does not exist yet; the clutter map starts empty'
check 'the run itself' exits 0
check 'the towers are known' test "$(echoes map.csv)" -ge 29 -a "$(echoes map.csv)" -le 31
check 'nothing else is beside it' test "$(echo map.csv*)" = map.csv
run track second.csv --config scene.ini -o blind.csv
run track second.csv --config scene.ini --clutter-map map.csv -o seeing.csv --json
check 'the next run knows them' matches "$(head -n 1 stderr)" 'rhotrack: map.csv: [23][0-9] echoes'
check 'no false track from the first scan on' test "$(false_rows seeing.csv)" -eq 0
check 'which there were without it' test "$(false_rows blind.csv)" -gt 0
check 'two targets' test "$(awk -F, '$3 == "confirmed" && $1 == 232' seeing.csv | wc -l)" -eq 2
check 'counted' json stdout '28 <= o["echoes_known"] <= 40 and o["counters"]["echoes_dropped"] == 0'
check 'and knows them afterwards' test "$(echoes map.csv)" -ge 29
cp map.csv once.csv
: >nothing.csv
echo 't_s,sensor_id,range_m,azimuth_rad' >nothing.csv
echo '0,9,50000,1' >>nothing.csv
run track nothing.csv --config scene.ini --clutter-map once.csv
check 'what nobody looked at comes back as it was' diff <(grep '^1,' map.csv) <(grep '^1,' once.csv)

# ---- by hand ----
cp towers.csv hand.csv
run track second.csv --config scene.ini --clutter-map hand.csv -o tracks.csv
check 'by hand: no false track from the first scan on' test "$(false_rows tracks.csv)" -eq 0
printf 'sensor_id,lat_deg,lon_deg,hits\n1,48.01,11.02,40\n' >earth.csv
run track nothing.csv --config scene.ini --set origin_lat_deg=48 --set origin_lon_deg=11 \
    --clutter-map earth.csv
check 'by hand: on the earth' awk -F, \
    '$1 == 1 { n = $2 > 1485 && $2 < 1500 && $3 > 1105 && $3 < 1120 && $6 == 40 } END { exit !n }' \
    earth.csv
printf 'hits,y_m,x_m,sensor_id,sigma_m,note\n8,-2,1,1,12,a mast\n' >order.csv
run track nothing.csv --config scene.ini --clutter-map order.csv
check 'columns in any order, and others' grep -q '^1,1,-2,12,12,8,' order.csv
printf 'sensor_id,x_m,y_m\n1,30000,0\n5,30000,0\n' >sigma.csv
run track nothing.csv --config scene.ini --clutter-map sigma.csv
check 'sigmas: the sensor'\''s, or 30 m' test \
    "$(grep -c -e '^1,30000,0,30,90,6,' -e '^5,30000,0,30,30,6,' sigma.csv)" -eq 2

# ---- track and node ----
"$program" convert second.csv second.lcm --config scene.ini
cp map.csv a.csv
cp map.csv b.csv
run track second.lcm --config scene.ini --clutter-map a.csv -o a.tracks.csv
run node --lcm 'file://second.lcm?speed=0' --config scene.ini --clutter-map b.csv --log said.lcm
check 'node: ends well' exits 0
check 'node: reads it' matches "$(head -n 1 stderr)" 'rhotrack: b.csv: [23][0-9] echoes'
check 'node: the same map' cmp a.csv b.csv
check 'and it has changed' test "$(cmp -s map.csv a.csv; echo $?)" -eq 1
check 'node: on RHO_CLUTTER' python3 -c '
import struct, sys
log = open("said.lcm", "rb").read()
at = log.rindex(b"RHO_CLUTTER") + len("RHO_CLUTTER") + 8
total, part, parts, count = struct.unpack_from(">hhhh", log, at + 16)
x, y, vx, vy, sigma_range, sigma_cross, chance = struct.unpack_from(">7f", log, at + 24 + 6)
sys.exit(not (28 <= total <= 40 and part == 0 and count == min(total, 40) and .3 < chance < .8
              and 0 < sigma_range < 60))'

# ---- a picture ----
run plot clutter-map map.csv -o map.svg
check 'a picture' grep -q 'echoes of sensor 1' map.svg
run plot clutter-map map.csv second.csv -o map.svg --config scene.ini
check 'a picture with plots' grep -q '>plots<' map.svg
run plot clutter-map second.csv -o other.svg
check 'a picture of something else' says 2 \
    "rhotrack: second.csv:1: column 't_s' does not belong in a clutter map"
check 'is none' test ! -e other.svg
run plot clutter-map map.csv towers.csv -o other.svg
check 'a picture with a map beneath' exits 2

# ---- what is refused ----
refuse() { # name, map, what is said
    printf '%b' "$2" >bad.csv
    cp bad.csv kept.csv
    rm -f out.csv
    run track nothing.csv --config scene.ini --clutter-map bad.csv -o out.csv
    check "$1" says 2 "rhotrack: bad.csv:$3"
    check "$1: nothing is written" test ! -e out.csv
    check "$1: the file stays" cmp bad.csv kept.csv
}
head='sensor_id,x_m,y_m,sigma_m,hits,region,unseen,looks,returns\n'
refuse 'no columns' 'a,b\n1,2\n' "1: no column 'sensor_id'*"
refuse 'plots' 't_s,sensor_id,x_m,y_m\n1,1,2,3\n' "1: column 't_s' does not belong in a clutter map"
refuse 'no place' "${head}1,,3,4,6,,,,\n" '2: x_m is empty'
refuse 'a place beyond all' "${head}1,2,3e6,4,6,,,,\n" '2: y_m 3e6 is outside *'
refuse 'NaN' "# why\n${head}1,nan,3,4,6,,,,\n" '3: x_m *nan* *'
refuse 'no sensor' "${head},2,3,4,6,,,,\n" '2: sensor_id is empty'
refuse 'half a sensor' "${head}1.5,2,3,4,6,,,,\n" "2: sensor_id '1.5' *"
refuse 'no sigma' "${head}1,2,3,0,6,,,,\n" '2: sigma_m 0 is outside *'
refuse 'no hits' "${head}1,2,3,4,0,,,,\n" '2: hits 0 is outside 1 .. 65535'
refuse 'too many hits' "${head}1,2,3,4,65536,,,,\n" '2: hits 65536 is outside 1 .. 65535'
refuse 'both kinds of rows' "${head}1,2,3,4,6,,1,2,1\n" \
    '2: a row has either a sensor, as an echo, or looks, not both'
refuse 'more returns than looks' "${head},,,,6,,1,2,3\n" '2: returns 3 is outside 0 .. 2'
refuse 'a region beyond' "${head},,,,6,64,1,2,1\n" '2: region 64 is outside 0 .. 63'
refuse 'looks below none' "${head},,,,6,,1,-2,1\n" '2: looks -2 is outside *'
refuse 'no gap' "${head},,,,6,,0,2,1\n" '2: unseen 0 is outside 1 .. 255'
refuse 'a second row that is bad' "${head}1,2,3,4,6,,,,\n1,2,3,4,x,,,,\n" "3: hits 'x' *"
refuse 'an empty file' '' '*'
run node --lcm 'file://second.lcm?speed=0' --clutter-map second.csv
check 'node: plots' says 2 "rhotrack: second.csv:1: column 't_s' does not belong in a clutter map"
run node --lcm 'file://second.lcm?speed=0' --clutter-map .
check 'node: a folder' says 2 \
    'rhotrack: .: not a regular file; a clutter map cannot be written to it'

# ---- what is damaged: track refuses, node sets it aside ----
damaged() { # NAME, what is said behind the file's name; damages the file damaged.csv
    cp damaged.csv kept.csv
    run track nothing.csv --config scene.ini --clutter-map damaged.csv
    check "$1: track" says 2 "rhotrack: damaged.csv:$2"
    check "$1: track leaves it" cmp damaged.csv kept.csv
    run node --lcm 'file://second.lcm?speed=0' --config scene.ini --clutter-map damaged.csv
    check "$1: node runs" exits 0
    check "$1: node says it once" matches "$(grep -a damaged.csv stderr)" \
        "rhotrack: damaged.csv:$2; set aside as damaged.csv.damaged; the clutter map starts empty"
    check "$1: its bytes are kept" cmp damaged.csv.damaged kept.csv
    check "$1: nothing else is left" test "$(echo damaged.csv.*)" = damaged.csv.damaged
    run track nothing.csv --config scene.ini --clutter-map damaged.csv
    check "$1: the new one is good" exits 0
    rm -f damaged.csv.damaged
}
sum=' the checksum is wrong: damaged, or changed by hand (remove the lines of # then)'
sed '5s/,/,1/' map.csv >damaged.csv
damaged 'a digit too many' "$sum"
sed '$d' map.csv >damaged.csv
damaged 'cut short' "$sum"
head -c 150 map.csv >damaged.csv
damaged 'cut in its head' '*'
tr '\0-\377' '\0' <map.csv >damaged.csv
damaged 'zeros' '*'
{ head -c 64 /dev/zero; tail -c +65 map.csv; } >damaged.csv
damaged 'a damaged head' "$sum"
printf 'sensor_id,x_m,y_m\n1,2\n' >damaged.csv
damaged 'by hand, and wrong' '2: *'
: >bad.csv
run node --lcm 'file://second.lcm?speed=0' --config scene.ini --clutter-map bad.csv
check 'an empty file: node runs' exits 0
check 'an empty file: node says it' matches "$(head -n 1 stderr)" \
    'rhotrack: bad.csv: is empty; the clutter map starts empty'
run plot clutter-map kept.csv -o map.svg
check 'a picture of one that is damaged' exits 2
sed '/^#/d; 5s/,/,1/' map.csv >damaged.csv
run track nothing.csv --config scene.ini --clutter-map damaged.csv
check 'without the lines of # it can be changed by hand' exits 0
sed '2d;$d' map.csv >damaged.csv
run track nothing.csv --config scene.ini --clutter-map damaged.csv
check 'as earlier versions wrote it, it is read' matches "$(head -n 1 stderr)" \
    'rhotrack: damaged.csv: [23][0-9] echoes'
# a snapshot's map goes before the file, which is checked all the same
run node --lcm 'file://second.lcm?speed=0' --config scene.ini --snapshot state
cp second.csv damaged.csv
run node --lcm 'file://second.lcm?speed=0' --config scene.ini --snapshot state \
    --clutter-map damaged.csv
check 'beside a snapshot: plots are refused' exits 2
check 'beside a snapshot: and are not written over' cmp second.csv damaged.csv
echo broken >damaged.csv
run node --lcm 'file://second.lcm?speed=0' --config scene.ini --snapshot state \
    --clutter-map damaged.csv
check 'beside a snapshot: a damaged one is set aside' grep -q \
    '; set aside as damaged.csv.damaged; the snapshot has the clutter map$' stderr

# ---- what cannot be its file ----
run track second.csv --clutter-map second.csv
check 'the input' says 2 'rhotrack: second.csv: the input cannot be the clutter map'
run track second.csv --clutter-map new.csv -o new.csv
check 'the output' says 2 'rhotrack: new.csv: the output cannot be the clutter map'
run node --lcm 'file://second.lcm?speed=0' --clutter-map new.lcm --log new.lcm
check 'node: the log' says 2 'rhotrack: new.lcm: the log cannot be the clutter map'
run node --lcm 'file://second.lcm?speed=0' --clutter-map second.lcm
check 'node: what is read' says 2 'rhotrack: second.lcm: the input cannot be the clutter map'
run track second.csv --clutter-map .
check 'a folder' says 2 'rhotrack: .: not a regular file; a clutter map cannot be written to it'
run track second.csv --clutter-map nowhere/map.csv -o out.csv
check 'a folder that is not there' exits 1
check 'is said' matches "$(tail -n 1 stderr)" 'rhotrack: nowhere/map.csv: cannot be written: *'
check 'before anything is written' test ! -e out.csv
run maintain second.csv --clutter-map map.csv
check 'another command' says 2 'rhotrack: maintain takes no --clutter-map*'

# ---- a build without the map ----
(
    cd "$here/../.." || exit 1 # in a shell of its own: checks write where they are
    ${CC:-gcc} -std=c11 -O1 -ffp-contract=off -Wall -Wextra -Werror -Iinclude -DRHO_MAX_ECHOES=0 \
        -o "$folder/without" \
        tests/unit/tracker/test_tracker.c src/*/*.c -lcmocka -lm 2>"$folder/stderr"
)
check 'a build without the map tracks' "$folder/without"

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
