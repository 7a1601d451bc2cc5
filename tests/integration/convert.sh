#!/bin/bash
# SPDX-License-Identifier: MIT
# `convert`: CSV files to LCM logs and back, each kind, real plots; what it refuses, damaged logs,
# other LCM programs. Runs beside others.
types=$(realpath "$(dirname "$0")/../../lcm_types")
vectors=$(realpath "$(dirname "$0")/../vectors")
python=$("$(dirname "$0")/../find_python.sh") || exit 1 # that has the package lcm
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Each value of the first file is in the second, as the same float32; rows that saw nothing may be
# fewer. Columns that are empty or 0 all the way down may be missing, and whose plots they are,
# which no log has.
cat >same.py <<'END'
import csv, struct, sys
def rows(path):
    return list(csv.DictReader(line for line in open(path) if not line.startswith("#")))
def value(text):
    try:
        return struct.pack(">f", float(text) + 0.0) if text else b""
    except ValueError:
        return text
measured = {"x_m", "range_m", "bearing_rad"}
def saw(row):
    return not measured & row.keys() or any(row.get(name) for name in measured)
one, other = rows(sys.argv[1]), rows(sys.argv[2])
if len(one) != len(other):
    one, other = [r for r in one if saw(r)], [r for r in other if saw(r)]
if len(one) != len(other) or not one:
    sys.exit(f"{len(one)} and {len(other)} rows")
skipped = set(sys.argv[3:]) | ({"target_id"} - other[0].keys())
for a, b in zip(one, other):
    if round(float(a["t_s"]) * 1e6) != round(float(b["t_s"]) * 1e6):
        sys.exit(f"times {a['t_s']} and {b['t_s']}")
    for name in a.keys() - {"t_s"} - skipped:
        if value(a[name]) != value(b.get(name, "0" if a[name] else "")):
            sys.exit(f"{name} of {a}: {b.get(name)}")
END
same_values() { python3 same.py "$@"; }

# A file, with the parameters of a configuration, to a log and back, and again: the log is the same.
there_and_back() { # csv, further arguments
    local file=$1
    shift
    run convert "$file" one.lcm "$@"
    exits 0 || return 1
    run convert one.lcm back.csv --covariance
    exits 0 || return 1
    run convert back.csv two.lcm
    exits 0 && cmp one.lcm two.lcm
}

# in_time FILE: in_time.csv, its rows in the order of time, as those of a log are.
in_time() { (head -n 1 "$1" && sed 1d "$1" | sort -s -t, -k 1,1n) >in_time.csv; }

# ---- what simulate makes, and real plots ----
for scenario in crossing radar clutter polar passive-two passive-three passive-clutter popup; do
    run simulate "$scenario" -o "$scenario"
    for file in "$scenario"/{plots,bearings,truth}.csv; do
        [ -f "$file" ] && [ "$(wc -l <"$file")" -gt 1 ] || continue # clutter has no targets
        check "$file: the log is the same" there_and_back "$file" --config "$scenario/scenario.ini"
        in_time "$file"
        check "$file: the values are the same" same_values in_time.csv back.csv
    done
done
run simulate polar -o rates --set radars.0.sigma_range_rate_mps=1 --set settings.scan_interval_s=4
unnumbered rates/plots.csv 5 4 >rates/polar.csv
check 'range rates: the log is the same' there_and_back rates/plots.csv --config rates/scenario.ini

# ---- turns ----
run convert rates/polar.csv rates.lcm
check 'plots with times of their own, without scan_interval_s' matches "$status $(cat stderr)" \
    '0 rhotrack: rates/polar.csv: sensor 1: the rows of a turn differ in time; they are gathered *'
run convert rates/polar.csv rates.lcm --config rates/scenario.ini
check 'with it nothing is said' test "$status" -eq 0 -a ! -s stderr
for scenario in two-radars rotating; do
    run simulate $scenario -o $scenario
    run convert $scenario/plots.csv one.lcm
    check "nor of sectors: $scenario" test "$status" -eq 0 -a ! -s stderr
done
awk 'BEGIN { print "t_s,sensor_id,x_m,y_m"
    for (k = 0; k < 40; k++) print 4 * k ",1," 100 * k ",0" }' >slow.csv
run convert slow.csv one.lcm
check 'nor of a plot every 4 s' test "$status" -eq 0 -a ! -s stderr
awk 'BEGIN { print "t_s,sensor_id,x_m,y_m,scan"
    for (k = 0; k < 40; k++) print k / 4 ",1," 100 * k ",0," k }' >fast.csv
run convert fast.csv one.lcm
check 'nor of scans with numbers' test "$status" -eq 0 -a ! -s stderr

# ---- a log is for no terminal ----
check 'a terminal as standard output is refused' python3 - "$program" <<'END'
import os, pty, subprocess, sys
master, terminal = pty.openpty()
done = subprocess.run([sys.argv[1], "convert", "slow.csv", "-"], stdout=terminal,
                      stderr=subprocess.PIPE, text=True)
assert done.returncode == 2 and done.stderr.startswith(
    "rhotrack: convert: an LCM log is not written on a terminal"), done
END
run convert slow.csv slow.lcm
check 'a pipe will do' bash -c "'$program' convert slow.csv - | cmp - slow.lcm"
in_time rates/plots.csv
check 'range rates: the values are the same' same_values in_time.csv back.csv
run simulate popup -o fast --set radars.0.sigma_mps=1
check 'velocities: the log is the same' there_and_back fast/plots.csv
check 'velocities: the values are the same' same_values fast/plots.csv back.csv
check 'real plots: the log is the same' there_and_back "$vectors/radar-table3.csv"
check 'real plots: the values are the same' same_values "$vectors/radar-table3.csv" back.csv target
run track "$vectors/radar-table3.csv" -o expected.csv
run track back.csv -o found.csv
check 'real plots: the same tracks' cmp expected.csv found.csv
run track polar/plots.csv --config polar/scenario.ini --covariance -o tracks.csv
check 'tracks: the log is the same' there_and_back tracks.csv
check 'tracks: the values are the same' same_values tracks.csv back.csv
run convert polar/plots.csv one.lcm --config polar/scenario.ini
run convert one.lcm back.csv
run track back.csv --config polar/scenario.ini --covariance -o found.csv
check 'own times: the same tracks' cmp tracks.csv found.csv
run track polar/plots.csv --config polar/scenario.ini -o tracks.csv
check 'tracks without covariance: the log is the same' there_and_back tracks.csv
check 'tracks without covariance: the sigmas are the same' same_values tracks.csv back.csv
run convert one.lcm back.csv
check 'without --covariance no column of it' bash -c '! grep -q cov_ back.csv'

# ---- a radar that turns: rows of a scan go back behind the one that has its time ----
run simulate rotating -o rotating
check 'sectors: the log is the same' there_and_back rotating/plots.csv \
    --config rotating/scenario.ini
in_time rotating/plots.csv
check 'sectors: the values are the same' same_values in_time.csv back.csv
run track rotating/plots.csv --config rotating/scenario.ini --covariance -o expected.csv
for file in one.lcm back.csv; do
    run track "$file" --config rotating/scenario.ini --covariance -o found.csv
    check "sectors: the same tracks of $file" cmp expected.csv found.csv
done
run publish rotating/plots.csv --config rotating/scenario.ini --speed 0 --lcm \
    'file://published.lcm?mode=w'
check 'publish takes them' exits 0
run node --lcm 'file://published.lcm?speed=0' --config rotating/scenario.ini --log node.lcm
"$program" convert node.lcm found.csv --kind tracks --covariance 2>stderr
cut -d, -f1-12 expected.csv >expected_states.csv
cut -d, -f1-12 found.csv | grep -v ,deleted, >found_states.csv
check 'sectors: a node makes the same tracks' cmp expected_states.csv found_states.csv

# ---- received_s ----
run simulate two-radars --set duration_s=120 -o late
check 'received_s: the log is the same' there_and_back late/plots.csv --config late/scenario.ini
check 'received_s: the values are the same' same_values late/plots.csv back.csv
run track late/plots.csv --config late/scenario.ini -o expected.csv
run track back.csv --config late/scenario.ini -o found.csv
check 'received_s: the same tracks' cmp expected.csv found.csv
printf \
    't_s,received_s,sensor_id,x_m,y_m\n1,1.5,1,10,20\n3,3.5,1,30,40\n2,4,1,50,60\n2,4,1,70,80\n' \
    >received.csv
run convert received.csv one.lcm
run convert one.lcm back.csv
printf 't_s,sensor_id,x_m,y_m,scan,epoch,received_s\n%s\n%s\n%s\n%s\n' \
    1.000000,1,10,20,1,1,1.500000 \
    3.000000,1,30,40,3,1,3.500000 2.000000,1,50,60,2,1,4.000000 2.000000,1,70,80,2,1,4.000000 \
    >expected.csv
check 'received_s: numbers are in the order of time, rows in that of reception' cmp expected.csv \
    back.csv

# ---- columns ----
printf '%s' 't_s,sensor_id,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps,sigma_m,sigma_mps,snr_db,' >all.csv
cat >>all.csv <<'END'
scan,epoch,sector_from_rad,sector_to_rad,note
-1.5,-32768,,,,,,,,,,-2147483648,2147483647,-1,2,opens
-1.25,-32768,1.1,-2.2,-0,4,5,6,0.1,,12.5,-2147483648,2147483647,-1,2,a
0.000001,-32768,2000000,0,1e-30,4,5,6,,100000,,-2147483648,2147483647,-1,2,b
2.000001,32767,1,2,,,,,,,,5,6,,,c
END
check 'all columns of plots' there_and_back all.csv
check 'all columns of plots: values' same_values all.csv back.csv note
printf '%s' 't_s,sensor_id,range_m,azimuth_rad,elevation_rad,range_rate_mps,snr_db,' \
    'sensor_x_m,sensor_y_m,sensor_z_m,sigma_range_m,sigma_azimuth_rad,sigma_elevation_rad,' >all.csv
cat >>all.csv <<'END'
sigma_range_rate_mps,sector_from_rad,sector_to_rad
1,2,100,3.1415927,1.5,-3,,10,20,30,5,0.01,0.02,0.5,0,1
1,2,101,-3.1415927,-1.5,3,7,10,20,30,6,0.01,0.02,0.5,0,1
1,2,102,0,0,0,,10,20,30,6,0.03,0.02,0.5,0,1
1,2,103,0,0,0,,10,20,30,6,0.03,,0.5,0,1
1,2,104,0,0,0,,10,20,30,6,0.03,,,0,1
1,2,105,0,0,0,,10,20,30,6,0.03,,,0,1
1,3,102,0,,,,0,0,0,,,,,,
END
check 'all columns of polar plots' there_and_back all.csv
check 'all columns of polar plots: values' same_values all.csv back.csv
check 'other sigmas go into parts of their own' python3 -c '
import sys
sys.exit(open("one.lcm", "rb").read().count(b"RHO_POLAR_2") != 5)'
printf 't_s,sensor_id,range_m,azimuth_deg,elevation_deg\n%s%s%s' $'1,2,100,90,45\n' \
    $'1,2,100,180,-45\n' $'1,2,100,0,0\n' >degrees.csv
run convert degrees.csv one.lcm
run convert one.lcm back.csv
printf 't_s,sensor_id,range_m,azimuth_rad,elevation_rad,scan,epoch\n%s%s%s' \
    $'1.000000,2,100,0,0.7853982,1,1\n' $'1.000000,2,100,-1.5707964,-0.7853982,1,1\n' \
    $'1.000000,2,100,1.5707964,0,1,1\n' >expected.csv
check 'degrees clockwise from north' cmp expected.csv back.csv
printf 't_s,sensor_id,range_m,azimuth_rad\n1,2,100,0\n' >placed.csv
run convert placed.csv one.lcm --set sensor.2.x_m=500 --set sensor.2.z_m=7
run convert one.lcm back.csv
check 'a place that is set goes into the log' grep -q '^1.000000,2,100,0,500,0,7,1,1$' back.csv
printf 't_s,track_id,status,x_m,y_m,update_age_us,score_nat,maneuver_probability\n%s%s' \
    $'1,5,confirmed,1,2,250000,12.5,0.75\n' $'1,6,deleted,1,2,0,0,0\n' >tracks.csv
check 'optional columns of tracks' there_and_back tracks.csv
check 'optional columns of tracks: values' same_values tracks.csv back.csv
printf 't_s,track_id,status,x_m,y_m,sigma_m,sigma_mps\n%s%s' \
    $'1,5,confirmed,1,2,0,4\n' $'1,6,confirmed,1,2,4,0\n' >sigmas.csv
check 'a place that is known beside a speed that is not' there_and_back sigmas.csv
check 'a place that is known beside a speed that is not: values' same_values sigmas.csv back.csv
printf 't_s,target_id,x_m,y_m\n1,1,1,2\n' >truth.csv
run evaluate truth.csv tracks.csv
check 'evaluate: a track that is named for the last time does not count' grep -q 'tracks *1$' stdout

# ---- which way ----
run convert crossing/plots.csv one.lcm
cp one.lcm unnamed
run convert unnamed back.csv
check 'a log is known by its content' exits 0
"$program" convert /dev/stdin piped.csv <one.lcm 2>stderr
check 'a log from a pipe' cmp back.csv piped.csv
rm piped.csv
cat one.lcm | "$program" convert /dev/stdin piped.csv 2>stderr
check 'a log from a real pipe' cmp back.csv piped.csv
run convert one.lcm -
check 'a log to standard output' writes_same_as back.csv
run convert one.lcm other.lcm
check 'log to log' says 2 \
    'rhotrack: convert: other.lcm would be an LCM log, the format of the input; *'
run convert crossing/plots.csv other.csv
check 'CSV to CSV' says 2 \
    'rhotrack: convert: other.csv would be a CSV file, the format of the input; *'
run convert crossing/plots.csv other.lcm --kind plots
check '--kind of a CSV file' says 2 \
    'rhotrack: convert: --kind chooses messages of a log, and crossing/plots.csv is a CSV file'
run convert one.lcm
check 'one argument' says 2 'rhotrack: convert: too few arguments; *'

# ---- bad CSV files ----
refused() { # pattern
    says 2 "rhotrack: $1" && matches "$(echo out*)" 'out.lcm' && matches "$(cat out.lcm)" before
}
refuse() { # name, LINE: what (a pattern), text as for printf, further arguments
    local name=$1 pattern=$2 text=$3
    shift 3
    # shellcheck disable=SC2059
    printf "$text" >bad.csv
    echo before >out.lcm
    run convert bad.csv out.lcm "$@"
    check "$name" refused "bad.csv:$pattern"
    rm -f out*
    run convert bad.csv out.lcm "$@"
    check "$name, no output left" matches "$(echo out*)" 'out\*'
}
plots='t_s,sensor_id,x_m,y_m\n'
polar='t_s,sensor_id,range_m,azimuth_rad\n'
bearings='t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sigma_rad\n'
truth='t_s,target_id,x_m,y_m\n'
tracks='t_s,track_id,status,x_m,y_m\n'
refuse 'places on the earth without an origin' \
    "1: column 'lat_deg': origin_lat_deg and origin_lon_deg are not set*" \
    't_s,target_id,lat_deg,lon_deg\n1,1,50,8\n'
refuse 'no kind' '2: neither plots, polar plots, bearings, truth nor tracks: *' \
    '# no\nt_s,sensor_id\n1,2\n'
refuse 'no number' "4: x_m 'abc' is not a number" "# plots\n${plots}1,1,1,1\n1,1,abc,3\n"
refuse 'beyond the range' '3: x_m 3000000 is outside the range of a plot_scan_t' \
    "${plots}1,1,1,1\n1,1,3000000,1\n"
refuse 'infinite' "2: x_m 'inf' is not finite" "${plots}1,1,inf,1\n"
refuse 'sensor beyond int16' \
    "2: sensor_id '32768' is outside -32768 .. 32767, the range of messages" "${plots}1,32768,1,1\n"
refuse 'x without y' '2: y_m is empty' "${plots}1,1,1,\n"
refuse 'no time' '2: t_s is empty' "${plots},1,1,1\n"
refuse 'time that goes back' '3: time decreases from 2.000000 s to 1.000000 s' \
    "${plots}2,1,1,1\n1,2,1,1\n"
refuse 'time that goes back, in another scan' '4: time decreases from 2.000000 s to 1.000000 s' \
    't_s,sensor_id,x_m,y_m,scan\n1,1,1,1,1\n2,1,1,1,2\n1,1,1,1,3\n'
refuse 'received_s that goes back' '3: received_s decreases from 3.000000 s to 2.000000 s' \
    't_s,sensor_id,x_m,y_m,received_s\n1,1,1,1,3\n2,1,1,1,2\n'
refuse 'no received_s' '2: received_s is empty' 't_s,sensor_id,x_m,y_m,received_s\n1,1,1,1,\n'
refuse 'a velocity beyond the range' '2: vy_mps 20001 is outside the range of a plot_scan_t' \
    't_s,sensor_id,x_m,y_m,vx_mps,vy_mps\n1,1,1,1,1,20001\n'
refuse 'vx without vy' '2: vy_mps is missing beside vx_mps' \
    't_s,sensor_id,x_m,y_m,vx_mps,vy_mps\n1,1,1,1,1,\n'
refuse 'velocity and height without vz' '2: vz_mps is missing beside z_m and vx_mps' \
    't_s,sensor_id,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps\n1,1,1,1,5,1,1,\n'
refuse 'height of a part of a scan' '3: height, velocity or range rate must be given in all rows*' \
    't_s,sensor_id,x_m,y_m,z_m\n1,1,1,1,5\n1,1,1,1,\n'
refuse 'a range rate of a Cartesian plot' '2: range_rate_mps cannot be stored in a plot_scan_t' \
    't_s,sensor_id,x_m,y_m,range_rate_mps\n1,1,1,1,5\n'
refuse 'two sectors' "3: sector_to_rad differs from that of the scan's first row" \
    't_s,sensor_id,x_m,y_m,sector_from_rad,sector_to_rad\n1,1,1,1,0,1\n1,1,1,1,0,2\n'
refuse 'half a sector' "1: no column 'sector_to_rad' beside 'sector_from_rad'" \
    't_s,sensor_id,x_m,y_m,sector_from_rad\n1,1,1,1,0\n'
refuse 'no scan number' '2: scan is empty' 't_s,sensor_id,x_m,y_m,scan\n1,1,1,1,\n'
refuse 'a scan number beyond int32' "2: scan '2147483648' is out of the range *" \
    't_s,sensor_id,x_m,y_m,scan\n1,1,1,1,2147483648\n'
refuse 'no azimuth that is believed' '2: azimuth_rad 2e6 is outside *' "${polar}1,1,5,2e6\n"
refuse 'no compass' "2: azimuth_deg '2e6' is outside -1000000 .. 1000000" \
    't_s,sensor_id,range_m,azimuth_deg\n1,1,5,2e6\n'
refuse 'range below 0' '2: range_m -5 is outside the range of a polar_scan_t' "${polar}1,1,-5,1\n"
refuse 'range without azimuth' '2: the azimuth is empty' "${polar}1,1,5,\n"
refuse 'no azimuth' "1: no column 'azimuth_rad' (or az_rad); *" 't_s,sensor_id,range_m\n1,1,5\n'
refuse 'both azimuths' "1: columns 'azimuth_rad' and 'azimuth_deg' exclude each other" \
    't_s,sensor_id,range_m,azimuth_rad,azimuth_deg\n1,1,2,1,1\n'
refuse 'both kinds of plots' "1: columns 'range_m' and 'x_m' exclude each other" \
    't_s,sensor_id,range_m,azimuth_rad,x_m,y_m\n1,1,2,1,1,1\n'
refuse 'a radar in two places' "3: sensor_y_m differs from that of the scan's first row" \
    't_s,sensor_id,range_m,azimuth_rad,sensor_x_m,sensor_y_m\n1,1,5,1,0,0\n1,1,5,1,0,1\n'
refuse 'two sigmas of bearings' "3: sigma_rad differs from that of the scan's other rows: *" \
    "${bearings}1,1,0,0,1,0.1\n1,1,0,0,1,0.2\n"
directions='t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sigma_rad,elevation_rad,'
directions+='sigma_elevation_rad,sensor_z_m\n'
refuse 'elevation beyond half a turn' \
    '2: elevation_rad 3.2 is outside the range of a direction_scan_t' \
    "${directions}1,1,0,0,1,,3.2,,\n"
refuse 'elevation without a bearing' '2: the bearing is empty' "${directions}1,1,0,0,,,1,,\n"
refuse 'two sigmas of elevations' "3: sigma_elevation_rad differs from that of the scan's other *" \
    "${directions}1,1,0,0,1,,1,0.1,\n1,1,0,0,1,,1,0.2,\n"
refuse 'a sensor at two heights' "3: sensor_z_m differs from that of the scan's first row" \
    "${directions}1,1,0,0,1,,1,,5\n1,1,0,0,1,,1,,6\n"
refuse 'more directions than a message has' \
    '66: a scan has more than 64 rows, the limit of a message' \
    "${directions}$(for i in $(seq 65); do printf '1,1,0,0,0.%03d,,1,,\n' "$i"; done)"
refuse 'no bearing that is believed' '2: bearing_rad 4e6 is outside *' \
    "${bearings}1,1,0,0,4e6,0.1\n"
refuse 'more bearings than a message has' \
    '258: a scan has more than 256 rows, the limit of a message' \
    "${bearings}$(for i in $(seq 257); do printf '1,1,0,0,0.%03d,\\n' "$i"; done)"
refuse 'a target that is no number' "2: target_id 'A' is not an integer" "${truth}1,A,1,1\n"
refuse 'truth beyond the range' '3: y_m 2e7 is outside the range of a truth_list_t' \
    "${truth}1,1,1,1\n1,2,1,2e7\n"
refuse 'unknown status' "2: status 'lost' is none of tentative, confirmed, coasting, deleted" \
    "${tracks}1,1,lost,0,0\n"
refuse 'hits beyond int16' "2: hits '40000' is outside -32768 .. 32767, the range of messages" \
    't_s,track_id,status,x_m,y_m,hits\n1,1,confirmed,0,0,40000\n'
refuse 'hits below 0' '2: hits -1 is outside the range of a track_list_t' \
    't_s,track_id,status,x_m,y_m,hits\n1,1,confirmed,0,0,-1\n'
for sigma in -5 1e-19 1e19; do
    refuse "a sigma of $sigma, whose square is no variance" \
        '3: sigma_m is neither 0 nor within 1e-18 .. 1e18' \
        "t_s,track_id,status,x_m,y_m,sigma_m\n1,1,confirmed,0,0,5\n1,2,confirmed,0,0,$sigma\n"
done
refuse 'a sigma of velocity below 0' '2: sigma_mps is neither 0 nor *' \
    't_s,track_id,status,x_m,y_m,sigma_mps\n1,2,confirmed,0,0,-1\n'
printf 't_s,sensor_id,range_m,azimuth_rad,sigma_range_m\n' >parts.csv
for i in $(seq 32768); do echo "1,1,$i,0,$((1 + i % 2))"; done >>parts.csv
echo before >out.lcm
run convert parts.csv out.lcm
check 'more parts than messages number' refused \
    'parts.csv:2: a scan of 32768 parts; messages can number 32767'
run convert parts.csv out.lcm --keep-going
check 'nothing is left' refused 'parts.csv: contains no good scan'
refuse 'header alone' '1: no rows after the header' "$plots"
printf "${plots}1,1,1,1\nx,1,1,1\n1,40000,1,1\n1,1,1\n1,1,3e6,1\n0,1,1,1\n2,1,1,1\n" >mixed.csv
run convert mixed.csv out.lcm --keep-going
check 'keep-going: bad rows are counted' says 0 'rhotrack: 5 bad rows skipped'
run convert out.lcm back.csv
check 'keep-going: the others are there' matches "$(cut -d, -f1-4 back.csv | tr '\n' ' ')" \
    't_s,sensor_id,x_m,y_m 1.000000,1,1,1 2.000000,1,1,1 '

# ---- logs of several kinds, and of others ----
run convert crossing/plots.csv plots.lcm
run convert crossing/truth.csv truth.lcm
cat plots.lcm truth.lcm >both.lcm
echo before >out.csv
run convert both.lcm out.csv
check 'several kinds are listed' says 2 \
    'rhotrack: both.lcm: contains several kinds of messages, and a CSV file holds one '\
'(7 plots, 7 truth): choose by --kind'
check 'several kinds: no output touched' matches "$(cat out.csv)" before
run convert both.lcm out.csv --kind truth
check 'one kind is chosen' says 0 'rhotrack: both.lcm: 7 messages on other channels left out'
check 'one kind is chosen: values' same_values crossing/truth.csv out.csv
run convert both.lcm out.csv --kind tracks
check 'a kind that is not there' says 2 \
    'rhotrack: both.lcm: contains no messages of tracks, but 7 plots, 7 truth'
run convert both.lcm out.csv --kind plot
check 'no kind' says 2 \
    "rhotrack: convert: --kind 'plot' is none of plots, polar, bearings, truth, tracks"
cat truth.lcm truth.lcm >twice.lcm
run convert twice.lcm out.csv
check 'messages that come twice count once' says 0 \
    'rhotrack: twice.lcm: 7 repeated messages left out'
check 'messages that come twice: values' same_values crossing/truth.csv out.csv
: >empty.lcm
run convert empty.lcm out.csv
check 'an empty log' says 2 'rhotrack: empty.lcm: contains no event of an LCM log'
run convert no.lcm out.csv
check 'no log' says 2 'rhotrack: no.lcm: No such file or directory'
cp crossing/plots.csv named.lcm
run convert named.lcm out.csv
check 'a CSV file that is named a log' says 2 \
    'rhotrack: named.lcm: contains no event of an LCM log'

# ---- damage ----
cat >damage.py <<'END'
import sys
data = open("truth.lcm", "rb").read()
size = len(data) // 7
events = [data[i * size:(i + 1) * size] for i in range(7)]
bad = bytearray(events[2])
bad[-4 * 6:-4 * 5] = b"\x7f\xc0\0\0"  # x_m of the last target is not a number
open("garbage.lcm", "wb").write(b"abc" + events[0] + b"defgh" + b"".join(events[1:]))
open("cut.lcm", "wb").write(data[:-10])
open("bad.lcm", "wb").write(b"".join(events[:2]) + bytes(bad) + b"".join(events[3:]))
open("many.lcm", "wb").write(b"x".join(events) + b"x")
END
python3 damage.py
run convert garbage.lcm out.csv
check 'garbage is skipped and reported' matches "$(cat stderr)" \
    $'rhotrack: garbage.lcm: 3 bytes skipped at byte 0\n'\
'rhotrack: garbage.lcm: 5 bytes skipped at byte *'
check 'garbage: nothing is lost' same_values crossing/truth.csv out.csv
run convert many.lcm out.csv
check 'many damaged places: the first, and a sum' matches "$(tail -n +3 stderr)" \
    $'rhotrack: many.lcm: 1 bytes skipped at byte *\n'\
'rhotrack: many.lcm: 7 bytes skipped in 7 places in all'
run convert cut.lcm out.csv
check 'a log that is cut off' matches "$(cat stderr)" \
    $'rhotrack: cut.lcm: * bytes skipped at byte *\nrhotrack: cut.lcm: the last event is cut off'
check 'a log that is cut off: the rest is there' matches \
    "$(wc -l <out.csv) $(wc -l <crossing/truth.csv)" '19 22'
echo before >out.csv
run convert bad.lcm out.csv
check 'a bad message' says 2 \
    'rhotrack: bad.lcm: event 2 at byte *, RHO_TRUTH: x_m is outside the range of a truth_list_t'
check 'a bad message: no output touched' matches "$(cat out.csv)" before
run convert bad.lcm out.csv --keep-going
check 'a bad message is skipped and counted' says 0 'rhotrack: bad.lcm: 1 bad messages skipped'
check 'a bad message: the rest is there' matches "$(wc -l <out.csv)" 19
head -c 100000 /dev/urandom >noise.lcm
run convert noise.lcm out.csv
check 'noise' says 2 'rhotrack: noise.lcm: contains no event of an LCM log'

# ---- other LCM programs ----
cat >others.py <<'END'
import sys, lcm, rhotrack
way, path = sys.argv[1:]
if way == "read":
    plots = []
    for number, event in enumerate(lcm.EventLog(path)):
        scan = rhotrack.plot_scan_t.decode(event.data)
        assert event.eventnum == number and event.timestamp == scan.utime
        assert scan.scan == number + 1
        assert event.channel == f"RHO_PLOTS_{scan.sensor_id}" and scan.kind == scan.POSITION_2D
        plots += [f"{scan.utime / 1e6:.6f},{scan.sensor_id},{p.x_m:.3f},{p.y_m:.3f},{p.sigma_m:g}"
                  for p in scan.plots]
    print("t_s,sensor_id,x_m,y_m,sigma_m", *plots, sep="\n")
else:
    log = lcm.EventLog(path, "w", overwrite=True)
    for i in range(3):
        scan = rhotrack.bearing_scan_t()
        scan.utime, scan.scan, scan.epoch, scan.sensor_id = i * 1000000, i + 8, 2, 4
        scan.sensor_x_m, scan.sensor_y_m, scan.sigma_rad = 10.0, -20.0, 0.125
        scan.bearing_rad = [0.25 * j for j in range(i)]
        scan.num_bearings = i
        log.write_event(99000000 + i, "RHO_BEARINGS_4", scan.encode())
        log.write_event(99000000 + i, "SOMETHING_ELSE", b"anything")
    log.close()
END
if [ -n "$python" ] && [ -x /usr/bin/lcm-gen ]; then
    /usr/bin/lcm-gen -p --ppath . "$types"/*.lcm >/dev/null
    run convert crossing/plots.csv one.lcm
    "$python" others.py read one.lcm >read.csv
    # without target_id, and rows of scans alone
    check "Python's EventLog reads our log" cmp <(cut -d, -f1-5 crossing/plots.csv | grep -v \
        ',,,$') read.csv
    "$python" others.py write python.lcm
    run convert python.lcm out.csv
    check "we read a log by Python's EventLog" says 0 \
        'rhotrack: python.lcm: 3 messages on other channels left out'
    printf '%s\n' t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sigma_rad,scan,epoch \
        0.000000,4,10,-20,,0.125,8,2 \
        1.000000,4,10,-20,0,0.125,9,2 2.000000,4,10,-20,0,0.125,10,2 \
        2.000000,4,10,-20,0.25,0.125,10,2 >expected.csv
    check "we read a log by Python's EventLog: values" cmp expected.csv out.csv
else
    echo 'skipped: no Python package lcm'
fi

finish
