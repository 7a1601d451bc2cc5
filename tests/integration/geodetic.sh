#!/bin/bash
# SPDX-License-Identifier: MIT
# Latitudes, longitudes and heights: plots, truth and radars on the earth, slant ranges with
# heights, maps. Runs beside others.
scene=$(realpath "$(dirname "$0")/geodetic.py")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

python3 "$scene" >places.ini || exit 1
cat >origin.ini <<'END'
origin_lat_deg = 50
origin_lon_deg = 10
origin_alt_m = 100
v_max_mps = 400
accel_max_mps2 = 5
range_max_m = 400000
sigma_azimuth_rad = 0.0005
sigma_elevation_rad = 0.0005
END
cat origin.ini - >radars.ini <<'END'
[sensor 1]
lat_deg = 50.5
lon_deg = 11
alt_m = 400
[sensor 2]
lat_deg = 49
lon_deg = 8
alt_m = 250
END
cat origin.ini places.ini >places_m.ini

# ---- plots and truth ----
# Plots are exact, with 10 m claimed: tracks lag some metres behind paths that bend with the earth.
# A wrong frame is off by hundreds.
track() { run track "$1.csv" --config "$2" -o "$1.tracks.csv"; } # name, parameters
judge() { run evaluate "$1" "$2" --config origin.ini --json; }   # truth, tracks

# which two radars put in two places
awk -F, 'NR == 1 || $2 == 1' ground.csv >ground1.csv && mv ground1.csv ground.csv
for name in plots plots_m level polar heights ground; do
    case $name in
    plots | plots_m | level) track $name origin.ini ;;
    *) track $name radars.ini ;;
    esac
    check "$name: four tracks" grep -q ' 4 tracks confirmed; lost: 0 invalid, 0 stale, 0 no room' \
        stderr
done
for truth in truth.csv truth_m.csv; do
    for name in plots plots_m; do
        judge $truth $name.tracks.csv
        # the filter's own errors are 0.7 m: it takes the earth's curvature, 0.01 m/s^2, for noise
        check "$name by $truth: on the truth" json stdout \
            'o["targets_found"] == 4 and o["rmse_m"] < 5'
    done
    judge $truth heights.tracks.csv
    check "heights by $truth: on the truth" json stdout \
        'o["targets_found"] == 4 and o["rmse_m"] < 5'
    judge $truth polar.tracks.csv
    check "polar by $truth: on the truth" json stdout 'o["targets_found"] == 4 and o["rmse_m"] < 5'
done
judge level_truth.csv level.tracks.csv
check 'without heights: on the truth without heights' json stdout \
    'o["targets_found"] == 4 and o["rmse_m"] < 5'
# slant ranges taken as ground ranges
judge level_truth.csv ground.tracks.csv
check 'polar without heights: near it' json stdout \
    'o["targets_found"] == 4 and 100 < o["rmse_m"] < 700'
# ---- the origin on the date line, and longitudes beyond 180 ----
shift_lon() {
    awk -F, -v OFS=, -v by="$1" -v wrap="$2" 'NR > 1 { $4 += by; if (wrap && $4 > 180) $4 -= 360
        $4 = sprintf("%.9f", $4) } 1' plots.csv
}
sed 's/origin_lon_deg = 10/origin_lon_deg = 179.93/' origin.ini >line.ini
shift_lon 169.93 1 >wrapped.csv
shift_lon 169.93 0 >onward.csv
check 'the plots lie on both sides of the date line' bash -c \
    "cut -d, -f4 wrapped.csv | grep -q '^-179' && cut -d, -f4 wrapped.csv | grep -q '^179'"
run track wrapped.csv --config line.ini -o wrapped.tracks.csv
check 'the date line is no line' cmp plots.tracks.csv wrapped.tracks.csv
run track onward.csv --config line.ini -o onward.tracks.csv
check 'longitudes go on to 360' cmp plots.tracks.csv onward.tracks.csv

# ---- a radar's place ----
track placed origin.ini
check 'the place by columns is the same as by parameters' cmp polar.tracks.csv placed.tracks.csv
run track polar.csv --config places_m.ini -o metres.csv
judge truth.csv metres.csv
check 'a place in metres: azimuths are not turned, horizons not tilted' json stdout \
    'o["targets_found"] == 0 or o["rmse_m"] > 300'
run track turned.csv --config places_m.ini -o turned.tracks.csv
judge truth.csv turned.tracks.csv
check 'a place in metres, azimuths of the local frame, heights above the ellipsoid: on the truth' \
    json stdout \
    'o["targets_found"] == 4 and o["rmse_m"] < 5'
run config --config radars.ini
check 'config shows the place in metres, too' grep -q '^sensor.1.x_m .* 70[0-9][0-9][0-9]' stdout

# ---- messages hold the local frame ----
for name in plots polar heights; do
    run convert $name.csv $name.lcm --config radars.ini
    check "$name: to a log" exits 0
    run track $name.lcm --config radars.ini -o $name.log.csv
    judge truth.csv $name.log.csv
    check "$name: tracks of the log are on the truth" json stdout \
        'o["targets_found"] == 4 and o["rmse_m"] < 5'
done
run convert plots.lcm back.csv
check 'and back: places in metres, to float32' bash -c \
    "[ \"\$(python3 '$scene' plots back.csv | cut -c1-4)\" = 0.00 ]"
run convert truth.csv truth.lcm --config origin.ini
judge truth.lcm plots.tracks.csv
check 'truth: to a log, and evaluated' json stdout 'o["targets_found"] == 4 and o["rmse_m"] < 5'
run publish heights.csv --lcm 'file://heights.published.lcm?mode=w' --speed 0 --config radars.ini
run track heights.published.lcm --config radars.ini -o published.csv
check 'publish sends the same' cmp published.csv heights.log.csv
run plot tracks truth.csv plots.csv heights.tracks.csv --config origin.ini -o picture.svg
check 'plot draws them' grep -q '</svg>' picture.svg
run initiate plots.csv --config origin.ini
cp stdout initiated
run initiate plots_m.csv --config origin.ini
check 'initiate takes them: as many tracks as in metres' test "$(wc -l <initiated)" -eq \
    "$(wc -l <stdout)"
run maintain heights.csv --config radars.ini
check 'maintain takes them' exits 0

# ---- a node says where its frame is ----
run node --lcm 'file://plots.lcm?speed=0' --config origin.ini --set range_max_m=100000 \
    --log said.lcm
check 'a node: origin in RHO_STATUS' python3 -c '
import struct
log = open("said.lcm", "rb").read()
at = log.rindex(b"RHO_STATUS")
size, = struct.unpack(">I", log[at - 4:at])
origin = struct.unpack(">iii", log[at + 10 + size - 12:at + 10 + size])
assert origin == (500000000, 100000000, 100000), origin'

# ---- a flat earth: without origin, with heights ----
printf 't_s,sensor_id,range_m,azimuth_deg,alt_m,sensor_x_m,sensor_y_m,sensor_z_m\n%s\n' \
    1,1,5000,90,3100,1000,2000,100 >flat.csv
run maintain flat.csv
check 'flat: the ground range of a slant range and a height' matches \
    "$(sed -n 2p stdout | cut -d, -f4-6)" '5000.1*,2000*,3100*'

# ---- noise ----
noisy() { run maintain one.csv --config origin.ini "$@"; }
printf 't_s,sensor_id,range_m,azimuth_deg,alt_m,sensor_lat_deg,sensor_lon_deg,sensor_alt_m\n%s\n' \
    1,1,100000,90,10000,50,10,0 >one.csv
noisy --covariance
height() {
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "cov_z_z") at = i }
        NR == 2 { printf "%.0f", sqrt($at) }' stdout
}
check 'sigma_alt_m is 30' matches "$(height)" 3[01]
noisy --covariance --set sigma_alt_m=100
check 'or what is set' matches "$(height)" 10[0-2]
noisy --covariance --set sigma_alt_m=100 --set sensor.1.sigma_alt_m=60
check 'or the radar has' matches "$(height)" 6[01]
sed '1s/$/,sigma_alt_m/; 2s/$/,200/' one.csv >own.csv
run maintain own.csv --config origin.ini --covariance --set sensor.1.sigma_alt_m=60
check 'or the plot itself' matches "$(height)" 20[0-4]

# ---- maps ----
run track plots.csv --config origin.ini -o map.geojson
check 'track writes a map' is_json map.geojson
check 'a line and a place for each of four tracks' json map.geojson \
    '([f["geometry"]["type"] for f in o["features"]] == 4 * ["LineString", "Point"]
    and o["type"] == "FeatureCollection")'
# farthest of all points; a path that bends with the earth is followed so much late
read -r ground height <<<"$(python3 "$scene" map map.geojson)"
check 'the lines are where the aircraft were' awk -v g="$ground" -v h="$height" \
    'BEGIN { exit !(g < 3 && h < 3) }'
check 'what a place says' json map.geojson '(lambda p: p["track_id"] == 1 and p["kind"] == "place"
    and p["status"] == "confirmed" and p["t_s"] == 116 and abs(p["speed_mps"] - 132.2) < 0.2
    and abs(p["heading_deg"] - 40.7) < 0.2 and abs(p["climb_mps"]) < 0.2 and p["hits"] == 30
    and not p["is_over"])(o["features"][1]["properties"])'
run convert plots.tracks.csv of_csv.geojson --config origin.ini
check 'convert makes the same of the CSV file' cmp map.geojson of_csv.geojson
run track plots.csv --config origin.ini -o tracks.lcm
run convert tracks.lcm of_log.geojson --config origin.ini
check 'and of the log' cmp map.geojson of_log.geojson
run track level.csv --config origin.ini -o level.geojson
check 'tracks without heights have positions without' json level.geojson \
    '(len(o["features"]) == 8
    and {len(c) for f in o["features"] if f["geometry"]["type"] == "LineString"
    for c in f["geometry"]["coordinates"]} == {2})'
read -r ground height <<<"$(python3 "$scene" map level.geojson)"
check 'and are where the aircraft were' awk -v g="$ground" 'BEGIN { exit !(g < 3) }'
run track wrapped.csv --config line.ini -o line.geojson
check 'lines are cut at longitude 180' json line.geojson \
    '(any(f["geometry"]["type"] == "MultiLineString" for f in o["features"])
    and all(abs(a[0] - b[0]) < 1
    for f in o["features"] if f["geometry"]["type"] == "MultiLineString"
    for l in f["geometry"]["coordinates"] for a, b in zip(l, l[1:])))'
run maintain heights.csv --config radars.ini -o one.geojson
check 'maintain writes one, too' json one.geojson \
    '[f["properties"]["kind"] for f in o["features"]] == ["track", "place"]'
printf 't_s,sensor_id,lat_deg,lon_deg\n1,1,50,10\n2,1,,\n' >two.csv
run track two.csv --config origin.ini -o none.geojson
check 'without a track: a map without features' json none.geojson 'o["features"] == []'
json='JSON, but CSV is needed; GeoJSON can only be written: '\
'give the tracks'"'"' CSV file or LCM log'
cp map.geojson nameless
for file in map.geojson nameless; do
    run track "$file"
    check "$file is not read" says 2 "rhotrack: $file:1: $json"
    run convert "$file" map.csv
    check "$file: nor by convert" says 2 "rhotrack: $file:1: $json"
done

# ---- what is refused ----
refuse() { # name, pattern of the message behind the file, file's text, options...
    local name=$1 pattern=$2 text=$3
    shift 3
    # shellcheck disable=SC2059
    printf "$text" >bad.csv
    run track bad.csv "$@" -o out.csv
    check "$name" says 2 "rhotrack: bad.csv:$pattern"
    check "$name: no output" test ! -e out.csv
}
earth='t_s,sensor_id,lat_deg,lon_deg,alt_m\n1,1,50,10,0\n'
slant='t_s,sensor_id,range_m,azimuth_deg,alt_m\n1,1,50000,10,5000\n'
with=(--config radars.ini)
from_pipe() { # a pipe is read once: its first place cannot be looked up before
    status=0
    # shellcheck disable=SC2059
    printf "$1" | "$program" track - >stdout 2>stderr || status=$?
}
from_pipe "$earth"
check 'no origin, from a pipe' says 2 \
    "rhotrack: *:1: column 'lat_deg': origin_lat_deg and origin_lon_deg are not set*"
from_pipe 't_s,sensor_id,range_m,azimuth_deg,sensor_lat_deg,sensor_lon_deg\n1,1,5,5,50,10\n'
check 'no origin of a radar, from a pipe' says 2 \
    "rhotrack: *:1: column 'sensor_lat_deg': origin_lat_deg and*"
printf 't_s,sensor_id,range_m,azimuth_deg,sensor_lat_deg,sensor_lon_deg,sensor_alt_m\n%s\n' \
    1,1,5,5,50,10,70 >radar_place.csv
run track radar_place.csv -o radar_place.tracks.csv
check "a radar's place is the origin, with its height" grep -q \
    'the origin is origin_lat_deg=50.0000000, origin_lon_deg=10.0000000, origin_alt_m=70$' stderr
refuse 'a latitude beyond a pole' '3: lat_deg 90.1 is outside -90 .. 90' "${earth}2,1,90.1,10,0\n" \
    "${with[@]}"
refuse 'a longitude beyond a turn' '3: lon_deg 360.5 is outside -180 .. 360' \
    "${earth}2,1,50,360.5,0\n" "${with[@]}"
refuse 'a longitude below -180' '3: lon_deg -180.5 is outside -180 .. 360' \
    "${earth}2,1,50,-180.5,0\n" "${with[@]}"
refuse 'a height beyond reason' '3: alt_m 2000000 is outside -10000 .. 1000000' \
    "${earth}2,1,50,10,2000000\n" "${with[@]}"
refuse 'no number' "3: lat_deg 'fifty' is not a number" "${earth}2,1,fifty,10,0\n" "${with[@]}"
refuse 'half a place' '3: lon_deg is empty' "${earth}2,1,50,,0\n" "${with[@]}"
refuse 'a height alone' '3: lat_deg is empty' "${earth}2,1,,,7000\n" "${with[@]}"
refuse 'too far away' '3: lat_deg 10, 10 is * km from the origin, farther than 2000 km' \
    "${earth}2,1,10,10,0\n" "${with[@]}"
refuse 'two places' "1: columns 'lat_deg' and 'x_m' exclude each other" \
    't_s,sensor_id,x_m,y_m,lat_deg,lon_deg\n1,1,1,1,50,10\n' "${with[@]}"
refuse 'two heights' "1: columns 'lat_deg' and 'z_m' exclude each other" \
    't_s,sensor_id,lat_deg,lon_deg,z_m\n1,1,50,10,5\n' "${with[@]}"
refuse 'a latitude alone' "1: no column 'lon_deg' beside 'lat_deg'" \
    't_s,sensor_id,lat_deg\n1,1,50\n' "${with[@]}"
refuse 'metres and a height above the ellipsoid' "1: no column 'lat_deg' beside 'alt_m'" \
    't_s,sensor_id,x_m,y_m,alt_m\n1,1,50,10,5\n' "${with[@]}"
refuse 'polar plots with places' "1: columns 'range_m' and 'lat_deg' exclude each other" \
    't_s,sensor_id,range_m,azimuth_deg,lat_deg,lon_deg\n1,1,50,10,5,5\n' "${with[@]}"
refuse 'two sources of heights' "1: columns 'alt_m' and 'elevation_deg' exclude each other" \
    't_s,sensor_id,range_m,azimuth_deg,alt_m,elevation_deg\n1,1,50,10,5,5\n' "${with[@]}"
refuse 'a radar in two places' "1: columns 'sensor_lat_deg' and 'sensor_x_m' exclude each other" \
    't_s,sensor_id,range_m,azimuth_deg,sensor_x_m,sensor_y_m,sensor_lat_deg,sensor_lon_deg\n'\
'1,1,50,10,5,5,5,5\n' "${with[@]}"
refuse 'a height above the range' \
    '3: alt_m 20000 differs from the radar'"'"'s height by more than range_m 9000' \
    "${slant}2,1,9000,10,20000\n" "${with[@]}"
refuse 'the same on a flat earth' \
    '3: alt_m 20000 differs from the radar'"'"'s height by more than range_m 9000' \
    "${slant}2,1,9000,10,20000\n"
# shellcheck disable=SC2059
printf "${slant}2,1,9000,10,20000\n3,1,50000,10,5000\n" >bad.csv
run track bad.csv "${with[@]}" --keep-going -o kept.csv
check 'or skipped and counted' bash -c \
    "[ $status -eq 0 ] && grep -q '2 scans, 2 plots, .*, 1 bad rows skipped' stderr"
printf 't_s,target_id,lat_deg,lon_deg\n1,1,50,10\n1,2,50,\n' >bad.csv
run evaluate bad.csv plots.tracks.csv --config origin.ini
check 'evaluate: a bad place' says 2 'rhotrack: bad.csv:3: lon_deg is empty'
run convert bad.csv bad.lcm --config origin.ini
check 'convert: a bad place' says 2 'rhotrack: bad.csv:3: lon_deg is empty'
run plot tracks bad.csv --config origin.ini -o bad.svg
check 'plot: a bad place' says 2 'rhotrack: bad.csv:3: lon_deg is empty'
run evaluate truth.csv plots.tracks.csv
check 'evaluate: no origin' says 2 "rhotrack: truth.csv:1: column 'lat_deg': origin_lat_deg and*"

set_refuse() { # name, pattern, options...
    local name=$1 pattern=$2
    shift 2
    run track plots_m.csv -o out.csv "$@"
    check "$name" says 2 "rhotrack: $pattern"
}
set_refuse 'half an origin' 'origin_lat_deg is set without origin_lon_deg' --set origin_lat_deg=50
set_refuse 'the other half, where the file has a place' \
    'origin_lon_deg is set without origin_lat_deg' --set origin_lon_deg=10
set_refuse 'a radar without an origin' \
    'sensor 3: lat_deg and lon_deg: origin_lat_deg and origin_lon_deg are not set*' \
    --set sensor.3.lat_deg=50 --set sensor.3.lon_deg=10
set_refuse 'half a radar' 'sensor 3: lat_deg, lon_deg and alt_m go together: lon_deg is not set' \
    --set sensor.3.lat_deg=50 --config origin.ini
set_refuse 'a radar in two places, by parameters' 'sensor 3: its place is given twice*' \
    --set sensor.3.lat_deg=50 --set sensor.3.lon_deg=10 --set sensor.3.x_m=5 --config origin.ini
set_refuse 'a radar too far away' \
    'sensor 3: lat_deg and lon_deg are more than 2000 km from the origin' --set sensor.3.lat_deg=0 \
    --set sensor.3.lon_deg=10 --config origin.ini

run track plots_m.csv -o out.geojson
check 'a map without an origin' says 2 \
    'rhotrack: GeoJSON has latitudes and longitudes: origin_lat_deg and origin_lon_deg are not set*'
check 'no output' test ! -e out.geojson
run track plots.csv --config origin.ini --covariance -o out.geojson
check 'a map with covariances' says 2 \
    'rhotrack: out.geojson: GeoJSON cannot hold covariances (--covariance)'
run track plots.csv --config origin.ini --follow -o out.geojson
check 'a map that is followed' says 2 'rhotrack: out.geojson: GeoJSON is complete only at the end *'
run initiate plots.csv --config origin.ini -o out.geojson
check 'a map of initiated tracks' grep -q \
    'rhotrack: out.geojson: initiate writes CSV files and LCM logs' stderr
run convert plots.csv out.geojson --config origin.ini
check 'a map of plots' says 2 'rhotrack: plots.csv: these are plots; GeoJSON is made of tracks'
run convert tracks.lcm out.geojson --kind plots --config origin.ini
check 'a map of another kind' says 2 'rhotrack: convert: --kind plots: GeoJSON is made of tracks'
check 'nothing was written' test ! -e out.geojson -a ! -e out.csv

finish
