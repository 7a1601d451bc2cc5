#!/bin/bash
# SPDX-License-Identifier: MIT
# CSV files as others write them: separators, decimal commas, names, units, times, angles, and what
# is said of those that cannot be read. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# One target, seen at t = 0, 2 .. 58 s, in the program's own form and in others.
python3 - <<'EOF'
import datetime, math

def write(name, header, row):
    with open(name, "w") as file:
        file.write(header + "\n")
        for k in range(30):
            x, y, t = 3000 + 300 * k, 8000 - 200 * k, 2 * k
            file.write(row(t, x, y, math.hypot(x, y), math.degrees(math.atan2(x, y))) + "\n")

def iso(t):
    time = datetime.datetime.fromtimestamp(1709251170 + t, datetime.timezone.utc)
    return time.strftime("%Y-%m-%dT%H:%M:%S.250")

write("xy.csv", "t_s,sensor_id,x_m,y_m", lambda t, x, y, r, a: f"{t},0,{x},{y}")
write("polar.csv", "t_s,sensor_id,range_m,azimuth_deg",
      lambda t, x, y, r, a: f"{t},0,{r:.3f},{a:.5f}")
write("epoch.csv", "t_s,sensor_id,range_m,azimuth_deg",
      lambda t, x, y, r, a: f"{1709251170 + t}.25,0,{r:.3f},{a:.5f}")
write("european.csv", "\ufeffTime;Radar;Range [km];Azimuth [°];Remark",
      lambda t, x, y, r, a: f"{t},0;0;{r / 1000:.6f};{a:.5f};a, b".replace(".", ","))
write("tabs.tsv", "# a comment\nTime (s)\tRange [m]\tAzimuth (deg)",
      lambda t, x, y, r, a: f"{t}\t{r:.3f}\t{a:.5f}")
write("blanks.txt", "  TIME_MS   X    Y", lambda t, x, y, r, a: f"  {1000 * t}   {x}    {y}  ")
write("turns.csv", "t_s,sensor_id,range_m,azimuth_deg",
      lambda t, x, y, r, a: f"{t},0,{r:.3f},{a + 720:.5f}")
write("iso.csv", "timestamp,range,az_deg", lambda t, x, y, r, a: f"{iso(t)}Z,{r:.3f},{a:.5f}")
write("zone.csv", "timestamp,range,az_deg",
      lambda t, x, y, r, a: f"{iso(t + 19800)}+05:30,{r:.3f},{a:.5f}")
write("nautical.csv", "t_s,RANGE_NMI,Theta (deg)",
      lambda t, x, y, r, a: f"{t},{r / 1852:.9f},{a:.5f}")
write("plain_place.csv", "t_s,sensor_id,lat_deg,lon_deg",
      lambda t, x, y, r, a: f"{t},0,{50 + y / 111200:.8f},{8 + x / 71500:.8f}")
write("place.csv", "time;Latitude;lng",
      lambda t, x, y, r, a: f"{t};{50 + y / 111200:.8f};{8 + x / 71500:.8f}".replace(".", ","))
EOF

# A last digit differs where a unit is converted; tracks agree to a decimetre.
near() { # tracks, tracks
    python3 - "$@" <<'EOF'
import csv, sys
one, other = (list(csv.DictReader(open(name))) for name in sys.argv[1:])
assert len(one) == len(other) > 20
for a, b in zip(one, other):
    assert a["t_s"] == b["t_s"] and a["status"] == b["status"]
    assert abs(float(a["x_m"]) - float(b["x_m"])) < 0.1, (a, b)
    assert abs(float(a["y_m"]) - float(b["y_m"])) < 0.1, (a, b)
EOF
}

like() { # file, file in the program's own form, options...
    run track "$2" -o own.tracks.csv "${@:3}"
    run track "$1" -o tracks.csv "${@:3}"
    check "$1 is as $2" near own.tracks.csv tracks.csv
    run convert "$2" own.lcm "${@:3}"
    run convert "$1" other.lcm "${@:3}"
    run track other.lcm -o tracks.csv "${@:3}"
    check "$1 as a log, too" near own.tracks.csv tracks.csv
}

like european.csv polar.csv
like tabs.tsv polar.csv
like blanks.txt xy.csv
like turns.csv polar.csv
like nautical.csv polar.csv
like iso.csv epoch.csv
like zone.csv epoch.csv
like place.csv plain_place.csv --set origin_lat_deg=50 --set origin_lon_deg=8

# pi with six decimals is more than a half turn of float32
bearing='t_s,sensor_id,range_m,azimuth_rad\n'
printf "${bearing}1,1,5000,3.141593\n" >six.csv
printf "${bearing}1,1,5000,-3.1415923\n" >wrapped.csv
for name in six wrapped; do
    run convert "$name.csv" "$name.lcm"
    run convert "$name.lcm" "$name.back.csv"
done
check 'pi with six decimals' cmp six.back.csv wrapped.back.csv

# ---- --columns ----
as() { # NAME, file in the program's own form, file, columns
    run track "$2" -o own.tracks.csv
    run track "$3" -o tracks.csv --columns "$4"
    check "$1" near own.tracks.csv tracks.csv
}
sed '1s/.*/Zeit;Ost;Nord/; s/,0,/;/; s/,/;/' xy.csv >german.csv
as '--columns: names that are no words' xy.csv german.csv 't_s=Zeit,x_m=Ost,y_m=Nord'
awk -F, 'NR == 1 { print "t_s,sensor_id,R,azimuth_deg" } NR > 1 {
    printf "%s,%s,%.9f,%s\n", $1, $2, $3 / 1852, $4 }' polar.csv >miles.csv
as '--columns: a name with a unit beside known names' polar.csv miles.csv 'range_nmi=R'
columns() { # NAME, options of --columns, message (a pattern)
    run track german.csv --columns "$2"
    check "--columns: $1" says 2 "rhotrack: $3"
}
columns 'a name that nobody reads' 't_s=Zeit,x_n=Ost,y_m=Nord' \
    "--columns 'x_n=Ost': rhotrack reads no column 'x_n', did you mean 'x_m'*"
columns 'no pair' 'Zeit' "--columns 'Zeit': give NAME=COLUMN*"
columns 'a column that is not there' 't_s=Zeit,x_m=East,y_m=Nord' \
    "german.csv:1: --columns: there is no column 'East'; the file has: Zeit, Ost, Nord"
awk -F, 'NR == 1 { print "t_s,target_id,x_m,y_m" } NR > 1 { print }' xy.csv >truth_of_xy.csv
run track xy.csv german.csv --columns 't_s=Zeit,x_m=Ost,y_m=Nord' -o tracks.csv
check '--columns: a file without any of them is read as it is, beside one with them' exits 0
for command in track initiate 'convert'; do
    # shellcheck disable=SC2046
    run $command xy.csv --columns 't_s=Ziet' $([ $command = convert ] && echo out.lcm)
    check "--columns: a name that no file has, $command" says 2 \
        "rhotrack: --columns: no file has a column 'Ziet'; there are: t_s, sensor_id, x_m, y_m"
done
run plot scans xy.csv -o out.svg --columns 't_s=Ziet'
check '--columns: a name that no file has, plot' says 2 "rhotrack: --columns: no file has *"
run evaluate truth_of_xy.csv own.tracks.csv --columns 't_s=Ziet' --json
check '--columns: a name that no file has, evaluate' grep -q \
    "^rhotrack: --columns: no file has a column 'Ziet'; there are: " stderr
check '--columns: evaluate ends with 2' exits 2
status=0
"$program" track - --columns 't_s=Ziet' -o tracks.csv <xy.csv 2>stderr >stdout || status=$?
check '--columns: a name that a pipe does not have' grep -q \
    "^rhotrack: --columns: no file has " stderr
check '--columns: a pipe ends with 2' exits 2
run track xy.csv --columns 'x_m=y_m'
check '--columns: two of a name' says 2 \
    "rhotrack: xy.csv:1: --columns: the file already has a column 'x_m'"

# ---- places on the earth without an origin ----
run track plain_place.csv -o tracks.csv
check 'the first place is the origin, and it is said' grep -q \
    'rhotrack: plain_place.csv: the origin is origin_lat_deg=50.0719425, '\
'origin_lon_deg=8.0419580, origin_alt_m=0' stderr
run track plain_place.csv -o own.tracks.csv --set origin_lat_deg=50.07194245 \
    --set origin_lon_deg=8.04195804
check 'the tracks are those of that origin' near own.tracks.csv tracks.csv
check 'an origin that is set is not said' sh -c '! grep -q "origin is" stderr'
run track plain_place.csv -o map.geojson
check 'GeoJSON needs no more' json map.geojson \
    'abs(o["features"][0]["geometry"]["coordinates"][0][0] - 8.05) < 0.05'
printf 't_s,target_id,lat_deg,lon_deg\n1,1,50,8\n' >truth.csv
run evaluate truth.csv tracks.csv
check 'evaluate: no origin is guessed for a truth' says 2 \
    "rhotrack: truth.csv:1: column 'lat_deg': origin_lat_deg and origin_lon_deg are not set*"

# ---- compass azimuths in radians, bearings in degrees ----
# A radar that turns clockwise once in 4 s: a target at each of 20 azimuths.
python3 - <<'EOF'
import math
with open("compass.csv", "w") as file, open("degrees.csv", "w") as other:
    file.write("t_s,sensor_id,range_m,azimuth_rad\n")
    other.write("t_s,sensor_id,range_m,azimuth_deg\n")
    for turn in range(12):
        for k in range(20):
            t, azimuth = 4 * turn + 0.2 * k, (k + 0.5) * math.pi / 10
            range_m = 9000 + 400 * k + 150 * t
            file.write(f"{t:.3f},0,{range_m:.3f},{azimuth:.7f}\n")
            other.write(f"{t:.3f},0,{range_m:.3f},{math.degrees(azimuth):.6f}\n")
with open("radians.csv", "w") as file, open("bearing_degrees.csv", "w") as other:
    file.write("t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sigma_rad\n")
    other.write("Time;Sensor;sensor_x_km;sensor_y_km;Bearing [°];sigma_deg\n")
    for k in range(40):
        for sensor, x in enumerate((-10000, 10000)):
            bearing = math.atan2(20000 - 100 * k, 150 * k - x)
            file.write(f"{2 * k},{sensor},{x},0,{bearing:.8f},0.002\n")
            compass = (90 - math.degrees(bearing)) % 360
            other.write(f"{2 * k};{sensor};{x / 1000};0;{compass:.7f};{math.degrees(0.002):.8f}\n"
                        .replace(".", ","))
EOF
turns="--set scan_interval_s=4"
# shellcheck disable=SC2086
run track compass.csv $turns -o tracks.csv
check 'compass radians are said' grep -q \
    '^rhotrack: compass.csv: azimuth_rad goes from 0 to 2 pi and rises with time, '\
'as that of a compass does; .* --columns azimuth_compass_rad=azimuth_rad$' stderr
# shellcheck disable=SC2086
run track degrees.csv $turns -o own.tracks.csv
check 'degrees are not' sh -c '! grep -q compass stderr'
# shellcheck disable=SC2086
run track compass.csv $turns --columns azimuth_compass_rad=azimuth_rad -o tracks.csv
check 'and read as the line says' near own.tracks.csv tracks.csv
check 'and no longer said' sh -c '! grep -q compass stderr'
sed 's/,azimuth_rad/,az/; t; s/[^,]*$/1/' compass.csv | sed '1s/az/azimuth_rad/' >still.csv
# shellcheck disable=SC2086
run track still.csv $turns -o tracks.csv
check 'azimuths that stand still are no compass' sh -c '! grep -q compass stderr'
run track radians.csv -o own.tracks.csv
run track bearing_degrees.csv -o tracks.csv
check 'bearings in degrees, clockwise from north' near own.tracks.csv tracks.csv
run convert bearing_degrees.csv bearings.lcm
run track bearings.lcm -o tracks.csv
check 'as a log, too' near own.tracks.csv tracks.csv

# ---- no track, and why ----
why() { # NAME, file, the reason (a pattern of grep), options...
    run track "$2" -o tracks.csv "${@:4}"
    check "no track: $1" grep -Eq "^rhotrack: no track: $3" stderr
    check "no track: $1: it is no failure" exits 0
}
printf 't_s,sensor_id,x_m,y_m\n1,1,,\n2,1,,\n3,1,,\n' >empty.csv
why 'no plots' empty.csv 'the 3 scans hold no plots'
head -3 xy.csv >short.csv
why 'too few scans' short.csv '2 scans, and a start needs plots in 3 \(min_scans\) of 7 \(scans\)'
head -4 xy.csv >four.csv
why 'too few scans, as set' four.csv '3 scans, and a start needs plots in 5 ' --set min_scans=5
why 'a turning radar, rows with a time each' degrees.csv \
    '[0-9]+ of 240 scans have one plot each, 0.2 s apart; .* scan_interval_s' \
    --set scan_interval_s=0
printf '[sensor 0]\nx_m = 0\ny_m = 0\nrange_max_m = 500\n' >near.ini
why 'outside the coverage' xy.csv '30 of 30 plots lie outside the .*range_max_m' --config near.ini
why 'too fast' xy.csv 'this method found no .*: scans 2 s apart, 1 plots a scan, v_max_mps=20, ' \
    --set v_max_mps=20
awk 'NR == 1 {print; next} {print; for (i = 0; i < 40; i++) print $0}' xy.csv >crowd.csv
why 'a limit of work' crowd.csv 'work_max=100 ended [0-9]* of [0-9]* scans before all plots' \
    --set work_max=100
run track xy.csv -o tracks.csv
check 'with tracks nothing is said of none' sh -c '! grep -q "no track" stderr'

# ---- a known header stays as it is ----
printf 't_s,sensor_id,x_m,y_m,time,range_km,lat\n1,1,2,3,x,y,z\n' >extra.csv
run track extra.csv
check 'columns of other names beside a known header are ignored' exits 0
# Two radars, the second with another clock: their tracks differ where the sensor is not read.
awk -F, -v OFS=, 'NR == 1 { print; next } { $2 = NR % 2 + 1; print }' xy.csv >two.csv
for name in sensor Radar radar_id; do
    sed "1s/sensor_id/$name/" two.csv >other.csv
    run track two.csv -o own.tracks.csv --set sensor.2.time_bias_s=0.5
    run track other.csv -o tracks.csv --set sensor.2.time_bias_s=0.5
    check "a column '$name' beside a known header is the sensor" cmp own.tracks.csv tracks.csv
    run convert other.csv other.lcm
    run convert other.lcm back.csv
    check "a column '$name' in messages, too" test "$(cut -d, -f2 back.csv | sort -u | wc -l)" -eq 3
done
printf 't_s,sensor,sensor_id,x_m,y_m\n1,north,1,2,3\n' >both.csv
run track both.csv
check 'beside a sensor_id it is ignored' exits 0

# ---- what is refused ----
refuse() { # name, LINE: what (a pattern), text as for printf
    # shellcheck disable=SC2059
    printf "$3" >bad.csv
    run track bad.csv
    check "$1" says 2 "rhotrack: bad.csv:$2"
}
refuse 'an angle without a unit is not guessed' \
    "1: no column 'azimuth_rad' (or az_rad); the file has: t_s, range_m, azimuth; "\
"did you mean 'azimuth'? --columns 'azimuth_deg=azimuth' (clockwise from north) "\
"or 'azimuth_rad=azimuth' (counter-clockwise from east)" \
    'time,range,azimuth\n1,2,3\n'
refuse 'a time of no calendar' "2: t_s '2024-13-01T00:00:00Z' is not a number" \
    'timestamp,x,y\n2024-13-01T00:00:00Z,1,2\n'
refuse 'a zone that is none' "2: t_s '2024-03-01T00:00:00X' is not a number" \
    'timestamp,x,y\n2024-03-01T00:00:00X,1,2\n'
refuse 'two decimal commas' "2: x_m '1,2,3' is not a number" 't_s;x;y\n1;1,2,3;2\n'
refuse 'a short row of blanks' '3: short row: 2 cells, the header has 3' 't_s x y\n1 2 3\n2 3\n'
refuse 'a name misspelt' \
    "1: no column 'azimuth_rad' (or az_rad); the file has: t_s, range_m, azimut_deg; "\
"did you mean 'azimut_deg'? --columns 'azimuth_deg=azimut_deg' (clockwise from north)" \
    'time,range,azimut_deg\n1,2,3\n'
refuse 'degrees of a compass are not suggested as radians' \
    "1: no column 'azimuth_rad' (or az_rad); the file has: t_s, range_m, azimuth_compass_deg; "\
"did you mean 'azimuth_compass_deg'? --columns 'azimuth_deg=azimuth_compass_deg' "\
"(clockwise from north)" \
    't_s,range_m,azimuth_compass_deg\n1,2,3\n'
refuse 'a name that is like no other' \
    "1: no column 't_s' (or t, time, timestamp, datetime); the file has: Zeitpunkt, x_m, y_m; "\
"--columns t_s=NAME takes another" \
    'Zeitpunkt,x,y\n1,2,3\n'
refuse 'a unit that is not known' \
    "1: no column 'x_m' (or x); the file has: t_s, x_furlong, y_furlong; "\
"did you mean 'x_furlong'? --columns 'x_m=x_furlong'" \
    'time,x_furlong,y_furlong\n1,2,3\n'
finish
