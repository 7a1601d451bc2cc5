#!/bin/bash
# SPDX-License-Identifier: MIT
# Files as newcomers have them: without a sensor's number, with names of stations, bearings beside
# ranges, places in degrees, records that come twice, sensors that stare, the zenith;
# presets of kinds of radars; outputs in formats that are not written. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
same() { cmp "$1" "$2"; }
tracks() { tail -n +2 "$1" | cut -d , -f 2 | sort -u | wc -l; } # numbers in a file of tracks
track() { # INPUT OUTPUT OPTIONS...
    run track "$1" -o "$2" "${@:3}"
    [ "$status" -eq 0 ]
}

# ---- a file without a sensor's number ----
python3 - >bare.csv <<'PYTHON'
import random
random.seed(46)
print("t_s,x_m,y_m")
for k in range(30):
    for n in range(2):
        print(f"{4 * k},{-9000 + 800 * k + random.gauss(0, 5):.2f},"
              f"{3000 * n + 200 + random.gauss(0, 5):.2f}")
PYTHON
sed '1s/t_s,/t_s,sensor_id,/; 2,$s/,/,3,/' bare.csv >three.csv
check 'without a number: tracked' track bare.csv bare.out
check 'two targets' matches "$(tracks bare.out)" 2
run calibrate bare.csv -o found.ini
check 'calibrate finds its values' exits 0
check 'which track takes' track bare.csv found.out --config found.ini
check 'two targets with these' matches "$(tracks found.out)" 2
printf '[sensor 3]\npd = 0.95\n' >three.ini
track three.csv three.out --config three.ini
check 'of the only sensor that is described' track bare.csv lone.out --config three.ini
check 'as with its number in the file' same three.out lone.out
run convert bare.csv bare.lcm --config three.ini
check 'convert does so, too' track bare.lcm lone.out --config three.ini
check 'and the tracks are the same' same three.out lone.out
printf '[sensor 4]\npd = 0.9\n' >>three.ini
run track bare.csv --config three.ini
check 'of two that are described: which?' says 2 "rhotrack: bare.csv:1: no column 'sensor_id' *"
run convert bare.csv none.lcm --config three.ini
check 'convert asks, too' says 2 "rhotrack: bare.csv:1: no column 'sensor_id' *"

# ---- a range beside a bearing: a radar, clockwise from north ----
python3 - <<'PYTHON'
import math, random
random.seed(47)
with open("marine.csv", "w") as marine, open("polar.csv", "w") as polar:
    print("Time (UTC);Bearing [deg];Range [NM]", file=marine)
    print("t_s,azimuth_deg,range_m", file=polar)
    for k in range(20):
        for n in range(3):
            x_m, y_m = -6000 + 30 * k + random.gauss(0, 5), 2000 * n - 1500 + random.gauss(0, 5)
            bearing = round(math.degrees(math.atan2(x_m, y_m)) % 360, 3)
            range_nm = round(math.hypot(x_m, y_m) / 1852, 5)
            print(f"2024-05-03T09:{k // 20:02}:{3 * k % 60:02}Z;{bearing};{range_nm}", file=marine)
            print(f"2024-05-03T09:{k // 20:02}:{3 * k % 60:02}Z,{bearing},{range_nm * 1852:.4f}",
                  file=polar)
PYTHON
track marine.csv marine.out --preset marine
check 'a bearing with a range: three ships' matches "$(tracks marine.out)" 3
check 'in the quadrants where they are' awk -F, 'NR > 1 && $4 > -5000 {exit 1}' marine.out
track polar.csv polar.out --preset marine
join -t, <(cut -d, -f1,2,4,5 marine.out | sed 's/,/ /; s/,/,/' | sort) \
    <(cut -d, -f1,2,4,5 polar.out | sed 's/,/ /; s/,/,/' | sort) | awk -F, 'NR > 1 {
    if (($2 - $4) ^ 2 + ($3 - $5) ^ 2 > 1) bad = 1; n++ } END {exit bad || n < 40}'
check 'as with an azimuth, to a metre' test $? -eq 0
run calibrate marine.csv
check 'calibrate takes it' exits 0

# ---- bearings: places in degrees, of described stations, stations' names ----
python3 - <<'PYTHON'
import math, random
random.seed(48)
stations = (("DF-North", 1, 52.07, 13.0), ("DF West", 2, 52.0, 12.91), ("DF/East", 3, 51.99, 13.1))
names = [open(name + ".csv", "w") for name in ("by_name", "by_number", "placeless")]
print("time,station,station_lat,station_lon,bearing_deg", file=names[0])
print("t_s,sensor_id,sensor_lat_deg,sensor_lon_deg,bearing_deg", file=names[1])
print("t_s,station,bearing_deg", file=names[2])
for k in range(12):
    for name, number, lat, lon in stations:
        for n in range(2):
            east = (12.97 + 0.05 * n + 0.001 * k - lon) * 111320 * math.cos(math.radians(52.03))
            north = (52.04 - 0.02 * n - lat) * 111240
            bearing = math.degrees(math.atan2(east, north)) % 360 + random.gauss(0, 0.05)
            print(f"{k}.{number},{name},{lat},{lon},{bearing:.3f}", file=names[0])
            print(f"{k}.{number},{number},{lat},{lon},{bearing:.3f}", file=names[1])
            print(f"{k}.{number},{name},{bearing:.3f}", file=names[2])
with open("stations.ini", "w") as out:
    print("origin_lat_deg = 52.07\norigin_lon_deg = 13", file=out)
    for name, number, lat, lon in stations:
        print(f"[sensor {number}]\nname = {name}\nlat_deg = {lat}\nlon_deg = {lon}", file=out)
PYTHON
options=(--set sigma_rad=0.001 --set origin_lat_deg=52.07 --set origin_lon_deg=13)
track by_number.csv by_number.out "${options[@]}"
check 'stations in degrees: two tracks' matches "$(tracks by_number.out)" 2
track by_name.csv by_name.out "${options[@]}"
check 'with names: the same' same by_number.out by_name.out
check 'and it says which is which' matches "$(grep -c ': sensor [123] is DF' stderr)" 3
run convert by_name.csv by_name.lcm "${options[@]}"
check 'convert has names and degrees' track by_name.lcm again.out "${options[@]}"
check 'and the same tracks' same by_number.out again.out
run initiate by_name.csv "${options[@]}"
check 'initiate takes them' exits 0
run plot scans by_name.csv -o scans.svg "${options[@]}"
check 'plot scans takes them' exits 0
track by_number.csv described.out --set sigma_rad=0.001 --config stations.ini
check 'described by name, with places: the same tracks' track placeless.csv placeless.out \
    --set sigma_rad=0.001 --config stations.ini
check 'to the last byte' same described.out placeless.out
run convert placeless.csv placeless.lcm --config stations.ini
check 'through a log, too' track placeless.lcm again.out --set sigma_rad=0.001 \
    --config stations.ini
check 'to the last byte through a log' same described.out again.out
sed '/sensor 3/,$d' stations.ini >two.ini
why='*: sensor_x_m, sensor_y_m are empty, and \[sensor 3\] has no place'
run track placeless.csv --config two.ini
check 'one that is not described is named' matches "$(tail -n 1 stderr)" "$why"
run convert placeless.csv none.lcm --config two.ini
check 'convert names it' matches "$(tail -n 1 stderr)" "$why"
sed '3s/DF-North/7/' by_name.csv >mixed.csv
run track mixed.csv "${options[@]}"
check 'a number among names is refused' matches "$(tail -n 1 stderr)" \
    "*mixed.csv:3: sensor_id '7' is no name, as those before it are"
sed '4s/,2,/,two,/' by_number.csv >mixed.csv
run track mixed.csv "${options[@]}"
check 'a name among numbers is refused' matches "$(tail -n 1 stderr)" \
    "*mixed.csv:4: sensor_id 'two' is not an integer, as those before it are"
printf 't_s,sensor_id,x_m,y_m\n0,\e[31mred,1,2\n' >escape.csv
run track escape.csv
check 'a name that would colour the terminal is none' exits 2
{
    echo t_s,sensor_id,x_m,y_m
    for k in {1..300}; do echo "$k,radar $k,1,2"; done
} >many.csv
run track many.csv
check 'names without end' matches "$(tail -n 1 stderr)" '*is one name of a sensor too many'

# ---- over the zenith ----
{
    echo t_s,sensor_id,range_m,azimuth_deg,elevation_deg
    for k in {0..14}; do echo "$k,1,$((900 + k)),20,$((78 + 2 * k))"; done
} >over.csv
{
    echo t_s,sensor_id,range_m,azimuth_deg,elevation_deg
    for k in {0..6}; do echo "$k,1,$((900 + k)),20,$((78 + 2 * k))"; done
    for k in {7..14}; do echo "$k,1,$((900 + k)),200,$((102 - 2 * k))"; done
} >folded.csv
track over.csv over.out
track folded.csv folded.out
near() { # files of tracks that differ by rounding
    paste -d, "$1" "$2" | awk -F, 'NR > 1 {for (i = 4; i <= 9; i++) {d = $i - $(i + 18);
        if (d * d > 1e-4) bad = 1}} END {exit bad || NR < 10}'
}
check 'an elevation of 92 degrees is one of 88 on the other side' near over.out folded.out
check 'one track goes through' matches "$(tracks over.out)" 1
run convert over.csv over.lcm
check 'convert folds it' track over.lcm log.out
check 'to the same track' near over.out log.out
sed '5s/,84$/,181/' over.csv >beyond.csv
run track beyond.csv
check 'beyond half a turn is refused' matches "$(tail -n 1 stderr)" \
    'rhotrack: beyond.csv:5: elevation_deg 181 is outside -90 .. 180'

# ---- records that come twice; empty slots ----
track three.csv once.out
awk '{print} NR > 1 {print}' three.csv >twice.csv
check 'each row twice' track twice.csv twice.out
check 'the tracks of once' same once.out twice.out
check 'and it is counted' grep -q \
    'twice.csv: 60 rows say again what another one of their sensor and time says' stderr
# The second line's record comes behind others of the scan.
awk -F, 'NR == 1 {print; next} $1 != t {printf "%s", held; held = ""; t = $1}
    {print; held = held $0 "\n"} END {printf "%s", held}' three.csv >behind.csv
track behind.csv behind.out
check 'behind the other rows of the scan' same once.out behind.out
python3 - >slots.csv <<'PYTHON'
import random
random.seed(49)
print("t_s,sensor_id,x_m,y_m")
for k in range(80):
    rows = []
    if not 20 <= k < 24:
        rows.append(f"{2 + 0.05 * k + random.gauss(0, .02):.3f},{3 - 0.02 * k:.3f}")
    rows += ["0,0"] * (3 - len(rows))
    for row in rows:
        print(f"{k / 10},1,{row}")
PYTHON
track slots.csv slots.out --set sigma_m=0.05 --set v_max_mps=4
check 'empty slots make no track' matches "$(tracks slots.out)" 1
check 'none at the origin' awk -F, 'NR > 1 && $4 * $4 + $5 * $5 < 1 {exit 1}' slots.out
check 'they are counted' grep -q 'slots.csv: 163 rows at 0, 0 are empty slots' stderr
check 'their scans are looks; the first slot was a plot' grep -q \
    'rhotrack: 80 scans, 77 plots, 1 tracks' stderr
printf 't_s,x_m,y_m\n' >anchored.csv
for k in {0..19}; do echo "$k,0,0"; done >>anchored.csv
track anchored.csv anchored.out --set standing=targets
check 'one plot at 0, 0 a scan is a plot' matches "$(tracks anchored.out)" 1

# ---- a sensor that stares, with pauses ----
python3 - >stares.csv <<'PYTHON'
import random
random.seed(50)
print("t_s,sensor_id,x_m,y_m")
for k in range(900):
    if k % 60 >= 45:
        continue
    rows = [(10 + 0.06 * k, 2 + 0.05 * k), (90 - 0.07 * k, 8.0)]
    rows = [row for row in rows if random.random() < 0.6]
    for x_m, y_m in rows:
        print(f"{k / 10},1,{x_m + random.gauss(0, .2):.3f},{y_m + random.gauss(0, .2):.3f}")
    if not rows:
        print(f"{k / 10},1,,")
PYTHON
track stares.csv stares.out --set v_max_mps=10 --set sigma_m=0.2
check 'each of its times is a scan' grep -q 'rhotrack: 675 scans' stderr
check 'two walk there, seen again after the pauses' test "$(tracks stares.out)" -le 4

# ---- CAT001: the source in a block's first record alone ----
python3 - <<'PYTHON'
def block(records):
    body = b"".join(records)
    return bytes([1]) + (len(body) + 3).to_bytes(2, "big") + body
def record(k, source):  # I001/010, /020, /040, /141
    spec = bytes([(0x80 if source else 0) | 0x40 | 0x20 | 0x02])
    return (spec + (bytes([7, 9]) if source else b"") + bytes([0x10])
            + (12800 + 40 * k).to_bytes(2, "big") + (9000 + 300 * k).to_bytes(2, "big")
            + (1000 + 512 * k).to_bytes(2, "big"))
with open("once.ast", "wb") as once, open("each.ast", "wb") as each:
    for first in range(0, 12, 3):
        once.write(block([record(k, k == first) for k in range(first, first + 3)]))
        each.write(block([record(k, True) for k in range(first, first + 3)]))
PYTHON
run convert each.ast each.csv
check 'CAT001: twelve plots' test "$(wc -l <each.csv)" -eq 13
run convert once.ast once.csv
check 'with the source in the first record alone: the same' same each.csv once.csv

# ---- presets ----
for kind in en_route approach marine coastal_harbour drone_defence traffic; do
    run config --preset "$kind"
    check "--preset $kind" grep -q '^v_max_mps .* preset ' stdout
done
track polar.csv set.out --set v_max_mps=50 --set accel_max_mps2=3 --set pd=0.8 \
    --set range_min_m=40 --set range_max_m=44000 --set coast_scans_max=10 --set standing=targets \
    --set late_max_s=5 --set sigma_azimuth_rad=0.009 --set learn_noise_min=0.1 \
    --set learn_noise_max=10 --set sigma_range_m=15
track polar.csv preset.out --preset marine
check 'a preset is its settings, of a noise that is not stated' same set.out preset.out
track polar.csv one.out --preset marine --set v_max_mps=30
printf 'v_max_mps = 30\npreset = marine\n' >marine.ini
track polar.csv other.out --config marine.ini
check 'an INI file has it, whatever comes first' same one.out other.out
run config --config marine.ini
check 'and its own values win' grep -q '^v_max_mps .* 30  config ' stdout
run config --set preset=traffic --config marine.ini
check 'the last one counts' grep -q '^range_max_m .* 44000  preset ' stdout
run convert polar.csv polar.lcm
run node --lcm 'file://polar.lcm?speed=0' --preset marine --print
check 'a node takes it' exits 0
check 'and has as many tracks' matches "$(tracks stdout)" "$(tracks preset.out)"
run track polar.csv --preset maritime
check 'one that there is not' says 2 "rhotrack: --preset: 'maritime' is none of en_route, *"
run track polar.csv --set preset=
check 'none at all' says 2 "rhotrack: --set preset=: '' is none of en_route, *"

# ---- formats that are not written ----
for name in tracks.kml tracks.MCAP tracks.pcap tracks.parquet; do
    run track polar.csv -o "$name"
    check "track -o $name" says 2 "rhotrack: $name: *is no format that is written here; there are *"
    run convert polar.out "$name"
    check "convert $name" says 2 "rhotrack: $name: *is no format that is written here; there are *"
    check "no $name is there" test ! -e "$name"
done
run initiate polar.csv -o lines.kml
check 'initiate -o lines.kml' matches "$(tail -n 1 stderr)" \
    'rhotrack: lines.kml: *there are NAME.csv and NAME.lcm'
finish
