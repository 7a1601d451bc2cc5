#!/bin/bash
# SPDX-License-Identifier: MIT
# Names of files, columns, sensors and scenes that a shell, gnuplot or HTML would run are names:
# each output is as that under a plain name, and nothing else comes of them. Runs beside others.
here=$(realpath "$(dirname "$0")")
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"

# shellcheck disable=SC2016
names=($'a\n!touch RUN\n#' $'a\'\nsystem("touch RUN")\n#' '`touch RUN`' '$(touch RUN)'
    '|touch RUN #' '<touch RUN #' "'; touch RUN; '" '"; touch RUN; "' '%s%n%1$n'
    '&amp;' '--><script>')

# No command of a name was run since the last check.
nothing_ran() { ! find . -name RUN -print -delete | grep .; }

# is_as FILE: the last run ended well, and its output $hostile, with FILE's ending, is the same.
is_as() { exits 0 && cmp "$1" "./$hostile.${1##*.}" && nothing_ran; }

run simulate polar --seed 3 -o in
run track in/plots.csv --config in/scenario.ini -o tracks.csv
printf '[sensor 1]\nname = %s\n' '</script>`touch RUN`&' >sensor.ini
mkdir '<' # "</script>" is a folder and a file
names+=('</script><script>')

# ---- pictures, pages and maps: the names of inputs and outputs ----
draws() { # picture, output
    run plot tracks in/plots.csv in/truth.csv "$1" --config in/scenario.ini --config sensor.ini \
        -o "$2"
}
origin=(--set origin_lat_deg=50 --set origin_lon_deg=8)
endings='html geojson json'
draws tracks.csv plain.html
if command -v gnuplot >/dev/null; then
    endings+=' svg png'
    draws tracks.csv plain.svg
    draws tracks.csv plain.png
else
    echo 'skipped: pictures of hostile names: gnuplot is not installed'
fi
run convert tracks.csv plain.geojson --kind tracks "${origin[@]}"
run evaluate in/truth.csv tracks.csv --json
cp stdout plain.json
# columns that nobody reads, and their cells
awk -F, -v OFS=, 'NR == 1 { print $0, "</script><script>`touch RUN`", "$(touch RUN)\047" }
    NR > 1 { print $0, "</script>`touch RUN`", "|touch RUN" }' tracks.csv >columns.csv
for hostile in "${names[@]}"; do
    cp columns.csv "./$hostile.csv"
    for ending in $endings; do
        file=./$hostile
        case $ending in
            geojson) run convert "$file.csv" "$file.geojson" --kind tracks "${origin[@]}" ;;
            json) run evaluate in/truth.csv "$file.csv" --json && cp stdout "$file.json" ;;
            *) draws "$file.csv" "$file.$ending" ;;
        esac
        check "$ending under the name ${hostile@Q}" is_as "plain.$ending"
    done
done
check 'nothing is left beside the outputs' test "$(find . -name '*.gnuplot' -o -name '*.part')" = ''

# ---- pictures of other commands, in this folder: a name begins the path ----
if command -v gnuplot >/dev/null; then
    hostile='|touch RUN #'
    run evaluate in/truth.csv tracks.csv -o plain.svg
    run evaluate in/truth.csv tracks.csv -o "$hostile.svg"
    check 'evaluate draws under any name' is_as plain.svg
    for kind in scans errors parameter-space; do
        run plot $kind in/plots.csv in/truth.csv tracks.csv --config in/scenario.ini -o plain.svg
        for hostile in '|touch RUN #' '<touch RUN #' $'a\n!touch RUN\n#'; do
            run plot $kind in/plots.csv in/truth.csv tracks.csv --config in/scenario.ini \
                -o "$hostile.svg"
            check "plot $kind under the name ${hostile@Q}" is_as plain.svg
        done
    done
    printf '#!/bin/sh\nfor word; do echo "$word"; done >>words\ncat >/dev/null\n' >gnuplot
    chmod +x gnuplot
    PATH=$PWD:$PATH run plot scans in/plots.csv -o 'name.svg'
    check 'gnuplot is given no name' sh -c 'test -s words && ! grep -q name words'
    printf '#!/bin/sh\necho half; exit 1\n' >gnuplot
    PATH=$PWD:$PATH run plot scans in/plots.csv -o half.svg
    check 'a picture that gnuplot gives up' says 1 'rhotrack: half.svg: gnuplot could not draw it'
    check 'is not left, in no part' sh -c '! ls | grep half'
fi

# ---- a scene's name and texts ----
printf '{"version": 1, "text": "%s", "duration_s": 60, "radars": [{"turn_s": 4, "range_m":
    [1000, 60000], "sigma_range_m": 30, "sigma_azimuth_rad": 0.003, "pd": 0.95}]}' \
    '`touch RUN`</script>\n[sensor 1]\npd = 0.1' >scene.json
cp scene.json $'scene\npd = 0.125\n#.json'
run simulate ./scene.json -o plain
run simulate $'./scene\npd = 0.125\n#.json' -o hostile
check 'a scene of any name is simulated' exits 0
for scene in plain hostile; do
    run config --config $scene/scenario.ini
    cp stdout $scene.config
done
check 'its settings are the same' writes_same_as plain.config
check 'its name is one line' test "$(grep -c '^#' hostile/scenario.ini)" -eq \
    "$(grep -c '^#' plain/scenario.ini)"

# ---- names of sensors, which metrics and lines have ----
for hostile in $'a\nb' 'a"} 1' 'a\' $'a\e[2J'; do
    run config --set "sensor.1.name=$hostile"
    check "no name of a sensor: ${hostile@Q}" says 2 'rhotrack: --set sensor.1.name=*'
done
hostile='</script>`touch RUN`$(touch R)'
run config --set "sensor.1.name=$hostile" --json
check 'other names are quoted in JSON' env NAME="$hostile" python3 -c 'import json, os
assert json.load(open("stdout"))["sensor.1.name"]["value"] == os.environ["NAME"]'

# ---- the demo's page ----
if command -v gnuplot >/dev/null; then
    for hostile in '$(touch RUN)`touch RUN`' $'a\n!touch RUN\n#' '</script>"'\''&'; do
        status=0
        RHOTRACK=$program "$here/../../tools/demo.sh" "./$hostile" >stdout 2>stderr || status=$?
        check "the demo in a folder ${hostile@Q}" exits 0
        check 'its page has no name' sh -c '! grep -F -e RUN -e "</script>" "$0"' \
            "./$hostile/index.html"
    done
fi
check 'nothing ran' nothing_ran
finish
