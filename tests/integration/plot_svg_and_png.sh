#!/bin/bash
# SPDX-License-Identifier: MIT
# Pictures: endings of -o, PNG, thinning of plots, and what a map of tracks has. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

run simulate polar --seed 3 -o in
run track in/plots.csv --config in/scenario.ini --covariance -o tracks.csv
command -v gnuplot >/dev/null || {
    echo 'skipped: pictures: gnuplot is not installed (apt-get install gnuplot-nox)'
    finish
}

# ---- the output is an input, truth alone ----
cp in/plots.csv own.html
run plot scans own.html -o own.html
check 'an input is no output' says 2 'rhotrack: own.html: the output cannot be an input'
check 'and stays as it is' cmp in/plots.csv own.html
run plot tracks in/truth.csv -o truth.html
check 'a page of truth alone' says 2 'rhotrack: plot: a page needs plots, tracks or bearings *'
printf 't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad\n5,1,0,0,1\n20005,1,0,0,2\n' >rays.csv
run plot tracks rays.csv -o rays.svg
check 'bearings have a time, of 10 000 s and more without an exponent' grep -q \
    '2 bearings, 20000 s from t_s = 5 on' rays.svg

# ---- a sector: its radar, 145 points of the arc, its radar, which was once written 145 times ----
mkdir stub
printf '#!/bin/sh\ncp "$1" stub/script\n' >stub/gnuplot
chmod +x stub/gnuplot
printf 't_s,sensor_id,range_m,azimuth_rad\n0,1,500,0.5\n4,1,520,0.5\n' >sector.csv
PATH=$PWD/stub:$PATH run plot scans sector.csv -o sector.svg --set sensor.1.range_max_m=1000 \
    --set sensor.1.sector_from_rad=0 --set sensor.1.sector_to_rad=1
rows_of_coverage() { sed -n '/^\$coverage <</,/^NaN/p' stub/script | grep '^[-0-9]'; }
check 'the outline of a sector has 147 rows' test "$(rows_of_coverage | wc -l)" -eq 147
check 'the radar is its first row and its last' test \
    "$(rows_of_coverage | grep -nx '0 0' | tr '\n' ' ')" = '1:0 0 147:0 0 '

# ---- endings ----
for name in x.gif x.htm x; do
    run plot scans in/plots.csv -o $name
    check "-o $name is refused" says 2 \
        "rhotrack: $name: a picture is NAME.svg, NAME.png or (a page) NAME.html"
    check "-o $name: nothing is written" sh -c "! ls | grep -q '^$name'"
done
size_of() { # the 24 bytes at the begin of a PNG
    python3 -c '
import struct, sys
data = open(sys.argv[1], "rb").read()
assert data[:8] == b"\x89PNG\r\n\x1a\n" and data[-8:-4] == b"IEND"
print(*struct.unpack(">II", data[16:24]))' "$1"
}
for kind in scans tracks errors parameter-space; do
    run plot $kind in/plots.csv in/truth.csv tracks.csv --config in/scenario.ini -o $kind.png
    check "plot $kind writes a PNG, twice the size of the SVG" matches "$(size_of $kind.png)" \
        '2200 1360'
done

# ---- a map of tracks ----
run plot tracks in/plots.csv in/truth.csv tracks.csv --config in/scenario.ini -o tracks.svg
check 'the title counts tracks and plots' grep -Eq \
    '3 tracks, 1526 plots, [0-9.]+ s from t_s = [0-9.]+ on; arrows: [0-9]+ s of motion' tracks.svg
check 'coverage' grep -q '>coverage<' tracks.svg
check 'the radar' grep -q '>S1<' tracks.svg
check 'range rings' grep -Eq '>[0-9]+ km<' tracks.svg
run plot tracks in/plots.csv tracks.csv -o bare.svg
check 'no coverage that nobody said' sh -c '! grep -q ">coverage<" bare.svg'

# ---- relative times ----
awk -F, -v OFS=, 'NR > 1 { $1 += 1790000000 } 1' in/plots.csv >clock.csv
run plot scans clock.csv --config in/scenario.ini -o clock.svg
check "a clock's times are counted from the first on" grep -q 'time (s), from 17900000[0-9.]* on' \
    clock.svg

# ---- many plots ----
awk 'BEGIN {
    srand(1); print "t_s,sensor_id,x_m,y_m"
    for (i = 0; i < 200000; i++) print int(i / 100) ",1," int(1e5 * rand()) "," int(1e5 * rand())
}' >many.csv
run plot scans many.csv -o many.svg
check 'a tenth of 200 000 plots is drawn, and said' grep -q '20000 of 200000 plots drawn' many.svg
check 'and the picture is small' test "$(stat -c %s many.svg)" -lt 4000000
check 'as many marks as it says' test \
    "$(grep -c 'use .* transform=.* color=.rgb(' many.svg)" -eq 20000
run plot scans many.csv -o again.svg
check 'the same ones each time' cmp many.svg again.svg

# ---- a name with a quote ----
mkdir "it's"
for name in "it's/o'clock.svg" "it's/o'clock.png" "it's/o'clock.html"; do
    run plot tracks in/plots.csv tracks.csv --config in/scenario.ini -o "$name"
    check "a quote in the name of a picture: $name" test "$status" -eq 0 -a -s "$name"
done
run evaluate in/truth.csv tracks.csv -o "it's/figures.svg"
check 'a quote in the name of a picture of figures' test "$status" -eq 0 -a -s "it's/figures.svg"
check 'nothing is left beside them' test "$(ls "it's" | wc -l)" -eq 4
finish
