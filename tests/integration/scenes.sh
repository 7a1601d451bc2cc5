#!/bin/bash
# SPDX-License-Identifier: MIT
# Scenes: what `simulate` says of mistakes in them, that seeds make bytes, what the files hold, and
# that each scene that ships simulates and can be tracked, evaluated and drawn. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
scenes=$(realpath "$(dirname "$program")/../tools/scenes")

# ---- mistakes ----
radar='"radars": [{"turn_s": 4, "sigma_range_m": 30, "sigma_azimuth_rad": 0.003}]'
start="{\"version\": 1, \"duration_s\": 40, $radar"
refuse() { # name, pattern behind the file, text
    printf '%s' "$3" >wrong.json
    run simulate wrong.json -o none
    check "$1" says 2 "rhotrack: wrong.json:$2"
    check "$1: nothing is written" test ! -e none
}
refuse 'an empty file' '1: not valid JSON: it ends too early*' ''
refuse 'a file that ends too early' '2: not valid JSON: it ends too early*' $'{"version": 1,\n'
refuse 'no JSON' "3: not valid JSON near '*uration_s: 3}'" \
    $'{"version": 1,\n"text": "",\nduration_s: 3}'
refuse 'a list' '1: a scene is a JSON object*' '[1]'
refuse 'more text' '2: more text after the end of the scene' "$start}"$'\n}'
refuse 'no version' '1: version is missing' '{}'
refuse 'another version' '1: version: this program knows version 1' '{"version": 2}'
refuse 'no duration' '1: duration_s is missing' '{"version": 1}'
refuse 'no sensors' '1: no sensors*' '{"version": 1, "duration_s": 9}'
refuse 'a text for a number' '1: duration_s: must be a number, but is a text' \
    '{"version": 1, "duration_s": "9"}'
refuse 'infinite' '1: duration_s: inf is outside*' '{"version": 1, "duration_s": 1e999}'
refuse 'out of range, with line and place' '3: radars?0?.turn_s: -4 is outside 0.001 .. 3600' \
    $'{"version": 1, "duration_s": 9, "radars": [\n{\n"turn_s": -4}]}'
refuse 'an unknown key' "2: radar: unknown key, did you mean 'radars'?" "$start,"$'\n"radar": []}'
refuse 'an unknown key of a radar' "1: radars?0?.colour: unknown key" \
    "${start%\}\]}, \"colour\": 3}]}"
refuse 'a key twice' '1: version: occurs twice' "$start, \"version\": 1}"
refuse 'two things that exclude each other' '1: radars?0?.interval_s: does not go with turn_s' \
    "${start%\}\]}, \"interval_s\": 3}]}"
refuse 'a deep place' '4: targets?1?.legs?1?.for_s: -1 is outside 0 .. 1000000' \
    "$start, \"targets\": ["$'\n{"count": 1, "range_m": 9, "speed_mps": 3},'\
$'{"at_m": [1, 2], "velocity_mps": [1, 1],\n"legs": [{"for_s": 1},\n{"for_s": -1}]}]}'
refuse 'a leg without an end' '1: targets?0?.legs?0?: has no end*' \
    "$start, \"targets\": [{\"at_m\": [1, 2], \"velocity_mps\": [1, 1], \"legs\": [{}]}]}"
refuse 'a parent that is not there' '1: targets?0?.parent: targets?3? is not an earlier path' \
    "$start, \"targets\": [{\"parent\": 3, \"from_s\": 1}]}"
refuse 'flights as a parent' '1: targets?1?.parent: targets?0? is not an earlier path' \
    "$start, \"targets\": [{\"flights\": 2, \"box_m\": [-1e5, 1e5, -1e5, 1e5], \"least_s\": 20}, "\
"{\"parent\": 0, \"from_s\": 0}]}"
refuse 'a group without speed' '1: targets?0?: speed_mps is missing' \
    "$start, \"targets\": [{\"count\": 3, \"range_m\": 5}]}"
refuse 'half a number of targets' '1: targets?0?.count: 2.5 is not a whole number' \
    "$start, \"targets\": [{\"count\": 2.5}]}"
refuse 'a span the wrong way' '1: clutter?0?.range_m: the first, 5, is above the second, 2' \
    "$start, \"clutter\": [{\"kind\": \"uniform\", \"plots\": 5, \"range_m\": [5, 2]}]}"
refuse 'an unknown kind' "1: clutter?0?.kind: 'rain' is none of uniform, cell, *" \
    "$start, \"clutter\": [{\"kind\": \"rain\"}]}"
refuse 'a density of no area' '1: clutter?0?: needs box_m*' \
    "$start, \"clutter\": [{\"kind\": \"uniform\", \"plots_per_km2\": 1}]}"
refuse 'no such sensor' '1: events?0?.sensors: there is no sensor 2' \
    "$start, \"events\": [{\"kind\": \"mask\", \"sensors\": [2]}]}"
refuse 'two sensors of a number' '1: passive?0?.sensor_id: sensor 1 is defined twice' \
    "$start, \"passive\": [{\"sensor_id\": 1}]}"
refuse 'an unknown setting' "1: settings.v_mix: unknown parameter*" \
    "$start, \"settings\": {\"v_mix\": 3}}"
refuse 'a setting out of range' '1: settings.pd: *' "$start, \"settings\": {\"pd\": 3}}"
refuse 'platforms' '1: platforms: sensors that move are not simulated yet' \
    "$start, \"platforms\": [{}]}"
refuse 'radars of two kinds' '1: radars?1?: all radars must measure*' \
    "${start%]}, {\"interval_s\": 2, \"sigma_m\": 10}], \"area\": [0, 1, 0, 1]}"
plane='{"version": 1, "duration_s": 9, "radars": [{"interval_s": 2, "sigma_m": 10, "sigma_mps": 1}]'
refuse 'clutter in x and y without an area' '1: clutter?0?: needs box_m*' \
    "$plane, \"clutter\": [{\"kind\": \"uniform\", \"plots\": 5}]}"
refuse 'clutter without velocities' \
    '1: clutter?0?.kind: has no velocities, which sensor 1 measures*' \
    "$plane, \"clutter\": [{\"kind\": \"cell\", \"plots\": 5, \"at_m\": [0, 0], \"radius_m\": 9}]}"
refuse 'heights of a radar that has none' '1: targets: heights are for radars with sigma_m, or *' \
    "$start, \"targets\": [{\"at_m\": [1, 2, 3], \"velocity_mps\": [1, 1]}]}"
refuse 'a pull beside a turn' '1: targets?0?.legs?0?.turn_degps: does not go with accel_mps2' \
    "$plane, \"targets\": [{\"at_m\": [1, 2], \"velocity_mps\": [1, 1], "\
"\"legs\": [{\"for_s\": 1, \"accel_mps2\": [1, 2], \"turn_degps\": 3}]}]}"
refuse 'one point' '1: targets?0?.points: must be two or more*' \
    "$plane, \"targets\": [{\"points\": [[0, 1, 2]]}]}"
refuse 'points that go back in time' '1: targets?0?.points: times must increase' \
    "$plane, \"targets\": [{\"points\": [[1, 1, 2], [1, 2, 3]]}]}"
refuse 'points and legs' '1: targets?0?.legs: does not go with points' \
    "$plane, \"targets\": [{\"points\": [], \"legs\": []}]}"
refuse 'too much' '1: 2.5e+07 scans *' \
    "{\"version\": 1, \"duration_s\": 1e5, \"radars\": [{\"interval_s\": 0.004, "\
"\"sigma_range_m\": 30, \"sigma_azimuth_rad\": 0.003}]}"
refuse 'a goal that is none' "1: goal.completness: unknown key, did you mean 'completeness'?" \
    "$start, \"goal\": {\"completness\": 3}}"
refuse 'flights without a box' '1: targets?0?: box_m is missing' \
    "$start, \"targets\": [{\"flights\": 3}]}"
refuse 'flights that last no time' '1: targets?0?: least_s is missing' \
    "$start, \"targets\": [{\"flights\": 3, \"box_m\": [0, 9, 0, 9]}]}"
refuse 'flights and a count' '1: targets?0?.flights: does not go with count' \
    "$start, \"targets\": [{\"flights\": 3, \"count\": 3}]}"
group="$start, \"targets\": [{\"count\": 1, \"range_m\": 5, \"speed_mps\": 3"
refuse 'a disc of three numbers' '1: targets?0?.keep_discs_m?0?: *' \
    "$group, \"keep_discs_m\": [[1, 2, 3]]}]}"
refuse 'a disc inside out' '1: targets?0?.keep_discs_m: must be ?x, y, from, to?' \
    "$group, \"keep_discs_m\": [[1, 2, 4, 3]]}]}"
refuse 'a share of no disc' '1: targets?0?.keep_all_share: needs keep_discs_m' \
    "$group, \"keep_all_share\": 0.5}]}"
refuse 'a beginning the wrong way' '1: radars?0?.start_s: the first, 4, is above the second, 2' \
    "${start%\}\]}, \"start_s\": [4, 2]}]}"
refuse 'range rates of two kinds' \
    '1: clutter?0?.range_rate_sigma_mps: does not go with range_rate_max_mps' \
    "$start, \"clutter\": [{\"kind\": \"uniform\", \"plots\": 5, "\
"\"range_rate_max_mps\": 5, \"range_rate_sigma_mps\": 1}]}"
for keep in '"keep_discs_m": [[0, 0, 60, 70]]' '"spacing_m": 200'; do
    printf '%s' "$start, \"targets\": [{\"count\": 2, \"range_m\": 50, \"speed_mps\": 0, $keep}]}" \
        >wrong.json
    run simulate wrong.json -o none
    check "no room: $keep" says 2 \
        'rhotrack: wrong.json: targets?0?: none of 10000 random paths keeps *'
done
printf '%s' "$start, \"targets\": [{\"count\": 1, \"range_m\": 50, \"speed_mps\": 30, "\
"\"keep_range_m\": 60}]}" >wrong.json
run simulate wrong.json -o none
check 'paths that cannot be' says 2 'rhotrack: wrong.json: targets?0?: none of 10000 random paths *'
run simulate nowhere.json -o none
check 'no such file' says 2 'rhotrack: nowhere.json: *'
run simulate towrs -o none
check 'no such scene' says 2 'rhotrack: no scene `towrs`, did you mean `towers`?*'
printf 'v_min_mps = 3\n' >some.ini
run simulate towers --config some.ini -o none
check 'a scene takes no parameters' says 2 'rhotrack: simulate: a scene takes no --config*'
for set in radars '=3' 'radars[1].pd=3' 'radars[x]=3' 'radars.pd=3' 'radars[0.pd=3' 'nothing.at=3' \
    'version.x=3' 'radars[0].pd.x=1'; do
    run simulate towers --set "$set" -o none
    check "no place: $set" says 2 "rhotrack: --set *"
done
run simulate towers --set radar.0.pd=3 -o none
check 'no place: the nearest' says 2 "rhotrack: --set radar.0.pd=3: the scene has no such key: "\
"'radar', did you mean 'radars'?"
run simulate towers --set radars.1.pd=3 -o none
check 'no place: how many there are' says 2 \
    "rhotrack: --set radars.1.pd=3: the scene has no such element: '1' of a list of 1"
run simulate towers --set 'radars[0].pd=3' -o none
check 'a value out of range by --set' says 2 'rhotrack: towers:*: radars?0?.pd: 3 is outside 0 .. 1'
run simulate towers --set 'radars[0].range=3' -o none
check 'an unknown key by --set' says 2 "rhotrack: towers:*: radars?0?.range: unknown key*"
run simulate towers --set 'clutter[2]={"kind": "uniform", "plots": 3}' --set settings.gate=nearest \
    --set duration_s=40 \
    --set 'radars.0.told={"pd": 0.5}' -o changed
check '--set' bash -c 'grep -qx "gate = nearest" changed/scenario.ini &&
    grep -qx "pd = 0.5" changed/scenario.ini && ! grep -q ^44 changed/plots.csv'

# ---- seeds and bytes ----
cat >all.json <<'END'
{
  "version": 1, "text": "a bit of everything", "duration_s": 120,
  "settings": {"v_min_mps": 20, "v_max_mps": 400, "accel_max_mps2": 30, "gate": "best"},
  "radars": [
    {"turn_s": 4, "range_m": [1000, 80000], "sigma_range_m": 30, "sigma_azimuth_rad": 0.003,
     "sigma_range_rate_mps": 1, "range_rate_span_mps": 100, "pd": [[20000, 0.95], [80000, 0.6]],
     "resolution_m": 200, "resolution_rad": 0.01, "told": {"pd": 0.8, "sigma_range_m": 60}},
    {"sensor_id": 7, "at_m": [40000, 5000], "turn_s": 5, "sectors": 8, "start_s": 1.3,
     "is_counter_clockwise": true, "sigma_range_m": 50, "sigma_azimuth_rad": 0.002,
     "azimuth_bias_rad": 0.001, "time_bias_s": 0.1}
  ],
  "passive": [
    {"sensor_id": 8, "at_m": [0, -20000], "interval_s": 2, "sigma_rad": 0.002, "false_bearings": 1}
  ],
  "targets": [
    {"at_m": [20000, 10000], "velocity_mps": [-200, 30],
     "legs": [{"for_s": 20}, {"turn_deg": 60, "across_mps2": 10}]},
    {"parent": 0, "from_s": 30, "speed_change_mps": 50},
    {"count": 6, "range_m": [5000, 60000], "speed_mps": [50, 300], "life_s": [40, 80],
     "is_replaced": true, "turns": {"every_s": [10, 30], "across_mps2": [5, 20]},
     "speed_changes": {"every_s": 20, "along_mps2": 3},
     "stops": {"every_s": 50, "for_s": 5, "along_mps2": 10}}
  ],
  "clutter": [
    {"kind": "uniform", "plots": 20},
    {"kind": "cell", "plots": 20, "at_m": [-20000, 0], "radius_m": 3000, "velocity_mps": [10, 3],
     "range_rate_sigma_mps": 2},
    {"kind": "standing", "count": 10, "pd": 0.5},
    {"kind": "spikes", "born_per_s": 0.5, "life_s": [5, 20], "pd": 0.8,
     "box_m": [-9000, 9000, 5000, 20000]},
    {"kind": "strobe", "plots": 20, "azimuth_rad": 2, "width_rad": 0.05, "azimuth_radps": 0.001,
     "sensors": [1]},
    {"kind": "flock", "count": 10, "at_m": [9000, -9000], "radius_m": 2000, "velocity_mps": [5, 5],
     "speed_mps": 3, "pd": 0.6},
    {"kind": "second-time-around", "unambiguous_range_m": 80000, "pd": 0.6,
     "targets": [{"count": 3, "range_m": [90000, 140000], "speed_mps": 200}]}
  ],
  "events": [
    {"kind": "outage", "from_s": 50, "until_s": 60, "sensors": [7]},
    {"kind": "mask", "sector_rad": [1, 1.2]},
    {"kind": "fades", "per_hour": 60, "for_s": [5, 15]},
    {"kind": "split", "share": 0.3, "range_m": [50, 100], "azimuth_sigmas": [-2, 2]}
  ]
}
END
run simulate all.json --seed 3 -o all
check 'a bit of everything' exits 0
run simulate all.json --seed 3 -o again
check 'the same seed, the same bytes' diff -r all again
run simulate all.json --seed 4 -o other
for file in plots bearings truth; do
    check "another seed, another $file.csv" bash -c "! cmp -s all/$file.csv other/$file.csv"
done
check 'bytes that do not change with machine or compiler' matches \
    "$(cat all/plots.csv all/bearings.csv all/truth.csv all/paths.csv | cksum)" \
    '931175272 555584'
run simulate all.json --seed 3 --runs 2 -o runs
check 'runs: the first' diff -r all runs/run-0000
check 'runs: the second' bash -c '! cmp -s all/plots.csv runs/run-0001/plots.csv'

# ---- files ----
check 'columns of plots' matches "$(head -n 1 all/plots.csv)" \
    't_s,sensor_id,range_m,azimuth_rad,range_rate_mps,sensor_x_m,sensor_y_m,'\
'sector_from_rad,sector_to_rad,scan,received_s,target_id'
check 'columns of bearings' matches "$(head -n 1 all/bearings.csv)" \
    't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad,scan,received_s,target_id'
check 'columns of the truth' matches "$(head -n 1 all/truth.csv)" \
    't_s,target_id,x_m,y_m,vx_mps,vy_mps'
check 'columns of the paths' matches "$(head -n 1 all/paths.csv)" \
    't_s,target_id,x_m,y_m,vx_mps,vy_mps,is_covered'
check 'what a tracker is told' matches "$(sed 's/#.*//' all/scenario.ini | tr '\n' ';')" \
    ';v_min_mps = 20;v_max_mps = 400;accel_max_mps2 = 30;gate = best;;'\
'\[sensor 1\];x_m = 0.000;y_m = 0.000;pd = 0.8;sigma_range_m = 60;sigma_azimuth_rad = 0.003;'\
'sigma_range_rate_mps = 1;range_rate_span_mps = 100;range_min_m = 1000;range_max_m = 80000;;'\
'\[sensor 7\];x_m = 40000.000;*'
check 'truth: the paths that are covered' bash -c \
    "diff <(grep ',1\$' all/paths.csv | sed 's/,1\$//') <(tail -n +2 all/truth.csv)"
run config --config all/scenario.ini
check 'scenario.ini is good' exits 0

# ---- all that ship ----
for file in "$scenes"/*/*.json; do
    name=$(basename "$file" .json)
    run simulate "$name" -o "$name"
    check "$name simulates" exits 0
    rm -rf from-file
    run simulate "$file" -o from-file
    check "$name: the file is what ships" diff -r -I '^#' "$name" from-file
    for input in plots bearings; do
        [ -e "$name/$input.csv" ] || continue
        head -n 3000 "$name/$input.csv" >part.csv
        run track part.csv --config "$name/scenario.ini" -o tracks.csv
        check "$name: $input are tracked" exits 0
    done
done
sed -n '/^```json/,/^```/{/^```/!p}' "$scenes/README.md" >example.json
run simulate example.json -o example
check 'the example of the manual simulates' exits 0
run track example/plots.csv --config example/scenario.ini -o tracks.csv
check 'and has tracks' test "$(wc -l <tracks.csv)" -gt 10
check 'each scene that ships says what it is' test -z "$(grep -L '"text"' "$scenes"/*/*.json)"
sim() { run simulate "$1" -o "$1" && run track "$1/plots.csv" --config "$1/scenario.ini" -o \
    "$1/tracks.csv"; }
sim helicopters
run evaluate helicopters/truth.csv helicopters/tracks.csv --json
check 'helicopters are found' json stdout 'o["completeness"] > 0.9 and o["targets"] == 12'
run track radar-and-bearings/plots.csv radar-and-bearings/bearings.csv \
    --config radar-and-bearings/scenario.ini -o both.csv
check 'a radar and passive sensors together' exits 0
run evaluate radar-and-bearings/truth.csv both.csv --json
check 'and find the targets' json stdout 'o["completeness"] > 0.9 and o["targets"] == 8'
run plot scans helicopters/plots.csv -o scans.svg
check 'a picture of the plots' exits 0
run plot tracks helicopters/truth.csv helicopters/tracks.csv -o tracks.svg
check 'a picture of the tracks' exits 0

finish
