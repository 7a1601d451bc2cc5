#!/bin/bash
# SPDX-License-Identifier: MIT
# Bad input: exit 2, one line with file and line, and no output file left or touched.
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# The last run said the line, and neither wrote nor touched an output.
refused() { # pattern
    says 2 "rhotrack: $1" && matches "$(echo out*)" 'out.csv' && matches "$(cat out.csv)" before
}

refuse_file() { # name, pattern, path, options...
    for command in track initiate; do
        echo before >out.csv
        run "$command" "${@:3}" -o out.csv
        check "$command: $1" refused "$2"
        rm -f out*
        run "$command" "${@:3}" -o out.csv
        check "$command: $1, no output left" matches "$(echo out*)" 'out\*'
    done
}

refuse() { # name, LINE: what (a pattern), text as for printf
    # shellcheck disable=SC2059
    printf "$3" >bad.csv
    refuse_file "$1" "bad.csv:$2" bad.csv
}

header='t_s,sensor_id,x_m,y_m\n'

# ---- cells ----
refuse 'no number' "3: x_m 'abc' is not a number" "${header}1,1,2,3\n2,1,abc,3\n"
refuse 'trailing text' "2: y_m '3m' is not a number" "${header}1,1,2,3m\n"
refuse 'hexadecimal' "2: x_m '0x10' is not a number" "${header}1,1,0x10,3\n"
refuse 'two points' "2: x_m '1.2.3' is not a number" "${header}1,1,1.2.3,3\n"
refuse 'NaN' "2: x_m 'NaN' is not finite" "${header}1,1,NaN,3\n"
refuse 'Inf' "2: y_m '-inf' is not finite" "${header}1,1,2,-inf\n"
refuse 'beyond float32' "2: x_m '1e39' is out of the range of float32" "${header}1,1,1e39,3\n"
refuse 'beyond double' "2: x_m '1e999' is out of the range of float32" "${header}1,1,1e999,3\n"
refuse 'beyond the limit of positions' '2: x_m 3000000 is outside -2000000 .. 2000000' \
    "${header}1,1,3000000,3\n"
refuse 'time that is no number' "2: t_s 'noon' is not a number" "${header}noon,1,2,3\n"
refuse 'time NaN' "2: t_s 'nan' is not finite" "${header}nan,1,2,3\n"
refuse 'time beyond 4e12 s' "2: t_s '4.1e12' is beyond 4e12 s" "${header}4.1e12,1,2,3\n"
refuse 'no time' '2: t_s is empty' "${header},1,2,3\n"
refuse 'sensor_id with a point' "2: sensor_id '1.5' is not an integer" "${header}1,1.5,2,3\n"
refuse 'sensor_id that is no number' "2: sensor_id '!A' is not an integer" "${header}1,!A,2,3\n"
refuse 'sensor_id too large' "2: sensor_id '4294967296' is out of the range*" \
    "${header}1,4294967296,2,3\n"
refuse 'no sensor_id' '2: sensor_id is empty' "${header}1,,2,3\n"
refuse 'x without y' '2: y_m is empty' "${header}1,1,2,\n"
refuse 'sigma_m zero' '2: sigma_m 0 is outside 0.00100000005 .. 100000' \
    't_s,sensor_id,x_m,y_m,sigma_m\n1,1,2,3,0\n'
refuse 'sigma_m negative' '2: sigma_m -5 is outside *' 't_s,sensor_id,x_m,y_m,sigma_m\n1,1,2,3,-5\n'
refuse 'sigma_m too large' '2: sigma_m 1e6 is outside *' \
    't_s,sensor_id,x_m,y_m,sigma_m\n1,1,2,3,1e6\n'
refuse 'sigma_m that is no number' "2: sigma_m 'x' is not a number" \
    't_s,sensor_id,x_m,y_m,sigma_m\n1,1,2,3,x\n'
refuse 'too fast' '2: vx_mps 30000 is outside *' \
    't_s,sensor_id,x_m,y_m,vx_mps,vy_mps\n1,1,2,3,30000,0\n'
refuse 'vx without vy' '2: vy_mps is missing*' 't_s,sensor_id,x_m,y_m,vx_mps,vy_mps\n1,1,2,3,30,\n'
refuse 'velocity of a part of a scan' \
    '3: height, velocity or range rate must be given in all rows*' \
    't_s,sensor_id,x_m,y_m,vx_mps,vy_mps\n1,1,2,3,30,4\n1,1,5,6,,\n'

# ---- rows ----
refuse 'short row' '2: short row: 3 cells, the header has 4' "${header}1,1,2\n"
refuse 'long row' '3: long row: 5 cells, the header has 4' "${header}1,1,2,3\n2,1,2,3,4\n"
refuse 'time that goes back' '4: time decreases from 2.500000 s to 2.400000 s' \
    "${header}1,1,2,3\n2.5,1,2,3\n2.4,1,2,3\n"
refuse 'time that goes back, other sensor' '3: time decreases from 2.000000 s to 1.000000 s' \
    "${header}2,1,2,3\n1,2,2,3\n"
refuse 'time that goes back by a microsecond' \
    '3: time decreases from 1700000000.000002 s to 1700000000.000001 s' \
    "${header}1700000000.000002,1,2,3\n1700000000.000001,1,2,3\n"
refuse 'quotation mark inside a cell' '2: a quotation mark inside a cell' "${header}1,1,2\"2,3\n"
refuse 'quote without end' '3: a quoted cell has no end' "${header}1,1,2,3\n2,1,\"2,3\n3,1,2,3\n"
refuse 'text of several lines in an error' "2: x_m 'a?b' is not a number" \
    "${header}1,1,\"a\nb\",3\n"

# ---- the file's own lines ----
refuse 'line after comments and blank lines' "7: x_m 'bad' is not a number" \
    "# one\n\n${header}# four\n   \n1,1,2,3\n2,1,bad,3\n"
refuse 'line after a quoted line end' "5: x_m 'bad' is not a number" \
    't_s,sensor_id,x_m,y_m,note\n1,1,2,3,"two\nlines"\n2,1,2,3,\n3,1,bad,3,\n'
refuse 'comment mark inside quotes' "5: x_m 'bad' is not a number" \
    't_s,sensor_id,x_m,y_m,note\n1,1,2,3,"two\n# no comment\nlines"\n3,1,bad,3,\n'
refuse 'line with CR LF' "3: x_m 'bad' is not a number" \
    't_s,sensor_id,x_m,y_m\r\n1,1,2,3\r\n2,1,bad,3\r\n'
refuse 'line with CR' "3: x_m 'bad' is not a number" 't_s,sensor_id,x_m,y_m\r1,1,2,3\r2,1,bad,3\r'
refuse 'last line without an end' "3: x_m 'bad' is not a number" "${header}1,1,2,3\n2,1,bad,3"

# ---- columns ----
refuse 'no column x_m' \
    "1: no column 'x_m' (or x); the file has: t_s, sensor_id, y_m; --columns x_m=NAME takes "\
'another' 't_s,sensor_id,y_m\n1,1,2\n'
refuse 'no column t_s' "2: no column 't_s' (or t, time, *); the file has: when, *" \
    '# comment\nwhen,sensor_id,x_m,y_m\n1,1,2,3\n'
refuse 'a column twice' "1: column 'x_m' occurs twice" 't_s,sensor_id,x_m,y_m,x_m\n1,1,2,3,4\n'
refuse 'vx_mps without vy_mps' "1: no column 'vy_mps' beside 'vx_mps'" \
    't_s,sensor_id,x_m,y_m,vx_mps\n1,1,2,3,4\n'
refuse 'no header' '1: no header row: the first row begins with a number' '1,1,2,3\n2,1,3,4\n'

# ---- bearings ----
bearings='t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad\n'
two="${bearings}0,1,0,0,1\n0,2,100,0,1\n"
refuse 'bearings: no column sensor_x_m' "1: no column 'sensor_x_m' (or sensor_x); the file has: *" \
    't_s,sensor_id,sensor_y_m,bearing_rad\n1,1,2,1\n'
refuse 'bearings: no column sensor_id' "2: no column 'sensor_id' (or sensor, *" \
    '# comment\nt_s,sensor_x_m,sensor_y_m,bearing_rad\n1,1,2,1\n'
refuse 'bearings: half a sector' "1: no column 'sector_to_rad' beside 'sector_from_rad'" \
    't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sector_from_rad\n0,1,0,0,1,0\n'
refuse 'bearings: no angle' '4: bearing_rad 2e6 is outside -1000000 .. 1000000' \
    "${two}1,1,0,0,2e6\n"
refuse 'bearings: NaN' "4: bearing_rad 'nan' is not finite" "${two}1,1,0,0,nan\n"
refuse 'bearings: no number' "4: bearing_rad 'x' is not a number" "${two}1,1,0,0,x\n"
refuse 'bearings: no place' '4: sensor_x_m is empty' "${two}1,1,,0,1\n"
refuse 'bearings: time that goes back' '4: time decreases from 0.000000 s to -1.000000 s' \
    "${two}-1,1,0,0,1\n"
refuse 'bearings: sigma 0' '2: sigma_rad 0 is outside *' \
    't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,sigma_rad\n0,1,0,0,1,0\n'
refuse 'bearings: a scan from two places' \
    "4: the sensor's place differs from that of the scan's first row" "${two}0,2,100,0.5,1\n"
refuse 'bearings: one sensor alone' \
    '2: sensor 1 is the only sensor: positions need bearings of two or more' \
    "${bearings}0,1,0,0,1\n1,1,0,0,1\n"
{ printf "$bearings"; for number in {1..9}; do echo "0,$number,${number}000,0,1"; done; } >nine.csv
refuse_file 'bearings: more sensors than are searched together' \
    '9 passive sensors; at most 8 are searched together' nine.csv
printf "${header}0,9,2,3\n" >plots.csv
echo before >out.csv
run track plots.csv nine.csv -o out.csv
check 'bearings: more sensors than that, beside plots' refused '9 passive sensors; at most 8 *'
printf "${two}1,1,0,0,4e6\n" >bad.csv
run track plots.csv bad.csv -o out.csv
check 'bearings: the second of two inputs' refused 'bad.csv:4: bearing_rad 4e6 is outside *'
run track bad.csv plots.csv -o out.csv
check 'bearings: the first of two inputs' refused 'bad.csv:4: bearing_rad 4e6 is outside *'

printf "${bearings}0,1,0,0,1\\n0,2,0,1000000,1\\n" >apart.csv
run track apart.csv -o apart.tracks.csv
check 'bearings: sensors may be 1000 km apart' exits 0
rm apart.tracks.csv
echo before >out.csv
printf "$two" >once.csv
printf "$two" >again.csv
run track once.csv again.csv -o out.csv
check 'bearings: a scan that two files have' refused \
    'again.csv:2: sensor 1 has another scan at 0.000000 s: line 2 of once.csv'
run track once.csv again.csv --keep-going -o out.csv
check 'bearings: a scan that two files have, left out' says 0 '*2 plots*2 bad rows skipped*'

# ---- polar plots ----
polar='t_s,sensor_id,range_m,azimuth_rad\n'
refuse 'range 0' "2: range_m '0' is not above 0" "${polar}1,1,0,1\n"
refuse 'negative range' "3: range_m '-5' is not above 0" "${polar}1,1,5,1\n2,1,-5,1\n"
refuse 'range beyond the limit' '2: range_m 3e6 is outside -2000000 .. 2000000' \
    "${polar}1,1,3e6,1\n"
refuse 'range without azimuth' '2: azimuth_rad is empty' "${polar}1,1,5,\n"
refuse 'azimuth without range' '2: range_m is empty' "${polar}1,1,,1\n"
refuse 'no azimuth that is believed' '2: azimuth_rad 2e6 is outside *' "${polar}1,1,5,2e6\n"
refuse 'azimuth NaN' "2: azimuth_rad 'nan' is not finite" "${polar}1,1,5,nan\n"
refuse 'no compass' '2: azimuth_deg -2e6 is outside -1000000 .. 1000000' \
    't_s,sensor_id,range_m,azimuth_deg\n1,1,5,-2e6\n'
refuse 'elevation beyond half a turn' '2: elevation_rad 3.2 is outside *' \
    "t_s,sensor_id,range_m,azimuth_rad,elevation_rad\n1,1,5,1,3.2\n"
refuse 'elevation below -90 degrees' '2: elevation_deg -91 is outside -90 .. 180' \
    "t_s,sensor_id,range_m,azimuth_rad,elevation_deg\n1,1,5,1,-91\n"
refuse 'infinite range rate' "2: range_rate_mps 'inf' is not finite" \
    "t_s,sensor_id,range_m,azimuth_rad,range_rate_mps\n1,1,5,1,inf\n"
refuse 'range rate beyond the limit' '2: range_rate_mps 30000 is outside *' \
    "t_s,sensor_id,range_m,azimuth_rad,range_rate_mps\n1,1,5,1,30000\n"
refuse 'range rate of a part of a scan' \
    '3: height, velocity or range rate must be given in all rows*' \
    "t_s,sensor_id,range_m,azimuth_rad,range_rate_mps\n1,1,5,1,3\n1,1,6,1,\n"
for sigma in sigma_range_m sigma_azimuth_rad sigma_elevation_rad; do
    refuse "$sigma zero" "2: $sigma 0 is outside *" \
        "t_s,sensor_id,range_m,azimuth_rad,$sigma\n1,1,5,1,0\n"
    refuse "$sigma negative" "2: $sigma -1 is outside *" \
        "t_s,sensor_id,range_m,azimuth_rad,$sigma\n1,1,5,1,-1\n"
done
refuse 'sigma_range_rate_mps zero' '2: sigma_range_rate_mps 0 is outside *' \
    "t_s,sensor_id,range_m,azimuth_rad,range_rate_mps,sigma_range_rate_mps\n1,1,5,1,1,0\n"
refuse 'both kinds of plots' "1: columns 'range_m' and 'x_m' exclude each other" \
    't_s,sensor_id,range_m,azimuth_rad,x_m,y_m\n1,1,2,3,4,5\n'
refuse 'both azimuths' "1: columns 'azimuth_rad' and 'azimuth_deg' exclude each other" \
    't_s,sensor_id,range_m,azimuth_rad,azimuth_deg\n1,1,2,3,4\n'
refuse 'no azimuth' "1: no column 'azimuth_rad' (or az_rad); *" 't_s,sensor_id,range_m\n1,1,2\n'
refuse 'half a place of a sensor' "1: no column 'sensor_y_m' beside 'sensor_x_m'" \
    't_s,sensor_id,range_m,azimuth_rad,sensor_x_m\n1,1,2,3,4\n'
refuse 'a sensor in two places' "3: the sensor's place differs from that of the scan's first row" \
    't_s,sensor_id,range_m,azimuth_rad,sensor_x_m,sensor_y_m\n1,1,2,3,0,0\n1,1,2,3,0,1\n'
refuse 'a place beyond the limit' \
    '2: range_m 1900000 at azimuth 0 rad is not a valid position *' \
    't_s,sensor_id,range_m,azimuth_rad,sensor_x_m,sensor_y_m\n1,1,1900000,0,1900000,0\n'

# ---- files ----
refuse 'empty file' '1: the file is empty' ''
refuse 'line ends alone' '2: no header row' '\n\n'
refuse 'comments alone' '2: no header row' '# one\n# two\n'
refuse 'header alone' '2: no rows after the header' "# one\n${header}"
refuse 'NUL bytes' '2: not a text file: it has a NUL byte' "${header}1,1,\\0,3\n"
head -c 5000 /dev/urandom >noise.csv
printf '\0' >>noise.csv
refuse_file 'binary noise' 'noise.csv:*' noise.csv
mkdir a_folder
refuse_file 'a folder' 'a_folder: Is a directory' a_folder
refuse_file 'missing file' 'none.csv: No such file or directory' none.csv
refuse_file 'a name with a line end' 'no?ne.csv: No such file or directory' $'no\nne.csv'
printf "${header}1,1,2,3\n" >good.csv
printf "${header}1,1,2,3\n2,1,x,3\n" >second.csv
echo before >out.csv
run track good.csv second.csv -o out.csv
check 'the second of two inputs' refused "second.csv:3: x_m 'x' is not a number"

# Root reads everything, so another user tries.
if [ "$(id -u)" -ne 0 ]; then
    cp good.csv secret.csv && chmod 000 secret.csv
    refuse_file 'unreadable file' 'secret.csv: Permission denied' secret.csv
elif command -v setpriv >/dev/null; then
    cp good.csv secret.csv && chmod 000 secret.csv && chmod 755 .
    cp "$program" program_copy && chmod 755 program_copy
    status=0
    setpriv --reuid=65534 --clear-groups ./program_copy track secret.csv >stdout 2>stderr \
        || status=$?
    check 'track: unreadable file' says 2 'rhotrack: secret.csv: Permission denied'
fi

# ---- a span of range rates ----
printf 't_s,sensor_id,range_m,azimuth_rad,range_rate_mps\n1,1,20000,0.1,3\n' >polar.csv
refuse_span() { # value, pattern: of all sensors and of one, by an option and by a file
    printf '# for all\n[rhotrack]\nrange_rate_span_mps = %s\n' "$1" >all.ini
    printf '[sensor 1]\npd = 0.8\n\nrange_rate_span_mps = %s\n' "$1" >one.ini
    for options in "--set range_rate_span_mps=$1" "--set sensor.1.range_rate_span_mps=$1" \
        '--config all.ini' '--config one.ini'; do
        case $options in
            --set*) place=$options ;;
            *all*) place='all.ini:3' ;;
            *) place='one.ini:4' ;;
        esac
        for command in 'track polar.csv' 'initiate polar.csv' 'maintain polar.csv' config; do
            echo before >out.csv
            # shellcheck disable=SC2086
            run $command $options $([ "$command" = config ] || echo -o out.csv)
            check "$command, $options" refused "$place: range_rate_span_mps $2"
        done
    done
}
refuse_span -1 '-1 is outside 0 .. 40000 m/s'
refuse_span 0.5 '0.5 is neither 0 nor 1 or more'
refuse_span 4.1e4 '4.1e4 is outside 0 .. 40000 m/s'
refuse_span nan "'nan' is not finite"
refuse_span inf "'inf' is not finite"
refuse_span many "'many' is not a number"
run track polar.csv --set range_rate_span_mps=30 --set sensor.1.range_rate_span_mps=0
check 'a span, and none' exits 0

# ---- keep going ----
printf "${header}1,1,2,3\nbad row\n2,1,x,3\n2,1,2,3\n1.5,1,2,3\n2,1,4,5\n"\
"3,1,\"2,3\n4,1,2,3\n4,1,2,3,4\n" >mixed.csv
run track mixed.csv --keep-going --json
check 'keep-going: exit 0' exits 0
check 'keep-going: good rows count, bad ones too' json stdout \
    'o["plots"] == 4 and o["scans"] == 3 and o["rows_skipped"] == 5'
check 'keep-going: the summary counts' grep -q '5 bad rows skipped' stderr
run initiate mixed.csv --keep-going
check 'keep-going: initiate counts' grep -q '5 bad rows skipped' stderr
printf "${header}x,1,2,3\n" >bad.csv
run track bad.csv --keep-going
check 'keep-going: not one good row' says 2 'rhotrack: bad.csv:1: no valid row after the header'
printf "${header}1,1\n" >bad.csv
run track bad.csv --keep-going
check 'keep-going: not one whole row' says 2 \
    'rhotrack: bad.csv:1: no valid row after the header'

# ---- outputs that cannot be ----
run track good.csv -o no_folder/out.csv
check 'output in a folder that is not there' says 1 \
    'rhotrack: no_folder/out.csv: No such file or directory'
run track good.csv -o a_folder
check 'output is a folder' says 1 'rhotrack: a_folder: Is a directory'
"$program" track good.csv >/dev/full 2>stderr
status=$?
check 'standard output on a full disk' exits 1

# ---- the first list of tracks, before which there is none: nothing is counted on from no memory
# (under sanitizers) ----
printf 't_s,track_id,status,x_m,y_m,vx_mps,vy_mps,sigma_m,sigma_mps,hits,misses\n'\
'1,1,confirmed,1,2,3,4,5,6,7,0\n' >tracks.csv
run convert tracks.csv tracks.ast
check 'tracks as CAT062' bash -c '[ '"$status"' -eq 0 ] && test -s tracks.ast'

# ---- noise: whatever the bytes, no crash ----
survives() { # a header, pieces of rows
    local seed
    for seed in $(seq 1 60); do
        awk -v seed="$seed" -v header="$1" -v pieces="$2" 'BEGIN {
            srand(seed); split(pieces, part, " ")
            part[length(part) + 1] = "\n"; part[length(part) + 1] = "\r"
            printf "%s", header
            for (i = 0; i < 300; i++) printf "%s", part[int(rand() * length(part)) + 1] }' >fuzz.csv
        run track fuzz.csv --keep-going
        exits 0 || exits 2 || return 1
        run track fuzz.csv
        exits 0 || exits 2 || return 1
    done
}
check 'rows of random pieces' survives "$header" '0 1 9 . - , , , " # e \n \r x nan 1e9 inf'
check 'bearings of random pieces' survives "$bearings" \
    '0 1 2 . - , , , " # 0,1,0,0,1\n 1,2,9,0,0.5\n \n \r nan 1e9'

finish
