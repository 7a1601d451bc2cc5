#!/bin/bash
# SPDX-License-Identifier: MIT
# calibrate: figures of simulated radars within 15 %, whatever was stated; what it does not know;
# the harbour, half by half.
# Runs beside others.
harbour=$(realpath "$(dirname "$0")/../../tools/scenes/harbour")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# radar NAME TURN_S SIGMA_RANGE_M SIGMA_AZIMUTH_RAD PD RANGE_M SPEEDS CLUTTER TOLD: five straight
# targets, 105 turns
radar() {
    cat >"$1_scene.json" <<END
{"version": 1, "text": "$1", "duration_s": $(python3 -c "print(105 * $2)"),
 "settings": {"v_max_mps": 400, "accel_max_mps2": 20},
 "radars": [{"turn_s": $2, "range_m": [$6e1, $6e3], "sigma_range_m": $3, "sigma_azimuth_rad": $4,
             "pd": $5, "told": {$9}}],
 "targets": [{"count": 5, "range_m": [$6e2, $(python3 -c "print(.8 * $6e3)")], "speed_mps": $7,
              "keep_range_m": [$(python3 -c "print(.04 * $6e3)"),
                               $(python3 -c "print(.98 * $6e3)")]}],
 "clutter": [{"kind": "uniform", "plots": $8}]}
END
    run simulate "$1_scene.json" --seed 2 -o "$1"
    run calibrate "$1/plots.csv" --config "$1/scenario.ini" --json -o "$1.ini"
    cp stdout "$1.json"
    check "$1: within 15 %" json "$1.json" "(lambda r: all(abs(r[k]['value'] / v - 1) < .15
and 0 <= r[k]['sigma'] < .15 * v for k, v in {'sigma_range_m': $3, 'sigma_azimuth_rad': $4,
'pd': $5, 'clutter_plots': $8, 'turn_s': $2}.items()))(o['radars'][0])"
    check "$1: speeds" json "$1.json" \
        "(lambda r, v: .9 * v[0] < r['slowest_mps']['value'] <= r['fastest_mps']['value']
< 1.1 * v[1])(o['radars'][0], $7)"
    run track "$1/plots.csv" --config "$1/scenario.ini" --config "$1.ini" --json
    check "$1: with the INI file there is little left to learn" json stdout \
        "(lambda l: max(abs(l[k] - 1)
for k in ('sigma_range_factor', 'sigma_cross_factor')) < .2)(o['learned'][0])"
}
radar as_stated 4 30 0.003 0.9 80 '[100, 250]' 50 '"pd": 0.9'
radar half_stated 4 30 0.003 0.7 80 '[100, 250]' 200 \
    '"sigma_range_m": 15, "sigma_azimuth_rad": 0.0015, "pd": 0.95'
radar defaults_off 10 100 0.01 0.85 200 '[80, 250]' 100 \
    '"sigma_range_m": 15, "sigma_azimuth_rad": 0.003'
radar fine 1 5 0.001 0.75 15 '[20, 60]' 20 '"sigma_range_m": 15, "sigma_azimuth_rad": 0.003'
radar coarse 12 200 0.005 0.8 250 '[100, 300]' 30 '"sigma_range_m": 15, "sigma_azimuth_rad": 0.003'
check 'the INI file has what is known, with sigmas' bash -c \
    'grep -q "^sigma_range_m = " as_stated.ini && grep -q "^pd = 0" as_stated.ini &&
    [ "$(grep -c "^# sigma" as_stated.ini)" -eq 5 ]'

# ---- the tracker, of a radar of which nothing was said ----
grep -v "sigma\|pd" fine/scenario.ini >bare.ini
run track fine/plots.csv --config bare.ini --json
check 'a radar is learned from the defaults' json stdout "(lambda l:
.25 < l['sigma_range_factor'] < .45 and .25 < l['sigma_cross_factor'] < .45
and l['pd_stated'] > .89 and min(l['pd']) < .85)(o['learned'][0])"
run track fine/plots.csv --config bare.ini --set sigma_range_m=15 --set sigma_azimuth_rad=0.003 \
    --json
check 'less where they were said' json stdout "o['learned'][0]['sigma_range_factor'] > .69"
run track fine/plots.csv --config bare.ini --set learn_noise_min=1 --set learn_pd_min=1 --json
check 'and nothing where that is off' json stdout \
    "o['learned'][0]['sigma_range_factor'] == 1 and len(set(o['learned'][0]['pd'])) == 1"
# noise is learned from 100 innovations
run simulate half_stated_scene.json --seed 2 --set duration_s=840 -o longer
run track longer/plots.csv --config longer/scenario.ini
check 'the summary says what is not as stated' grep -q \
    "sensor 1's noise is .* times as stated, across .* pd is down to 0" stderr

# ---- outputs ----
run calibrate as_stated/plots.csv --config as_stated/scenario.ini
cp stdout table
check 'a table' grep -Eq '^1 +range noise +[0-9.]+ +[0-9.]+ +m$' table
run calibrate as_stated/plots.csv --config as_stated/scenario.ini -o -
check 'with -o - the INI file is standard output' writes_same_as as_stated.ini
check 'and the table standard error' cmp table stderr
run calibrate as_stated/plots.csv --config as_stated/scenario.ini -o - --json
check 'JSON has no room there' says 2 \
    'rhotrack: calibrate: --json and -o - both write on standard output'
run convert as_stated/plots.csv log.lcm --config as_stated/scenario.ini
run calibrate log.lcm --config as_stated/scenario.ini --json
check 'the same of a log, but for what floats round' json stdout \
    "abs(o['radars'][0]['sigma_range_m']['value'] / $(python3 -c 'import json
print(json.load(open("as_stated.json"))["radars"][0]["sigma_range_m"]["value"])') - 1) < .05"
run simulate two-radars -o two
run calibrate two/plots.csv --config two/scenario.ini --json
check 'two radars, by sectors' json stdout \
    '(len(o["radars"]) == 2
    and all(r["turns"] < .2 * r["scans"] and abs(r["turn_s"]["value"] / t - 1) < 0.01
    for r, t in zip(o["radars"], (10, 4))))'

# ---- what the plots do not tell ----
run simulate fighters --seed 2 -o fighters
run calibrate fighters/plots.csv --config fighters/scenario.ini -o fighters.ini
check 'noise, of targets that turn all the time' grep -q '^radar 1, range noise: not known: ' stdout
check 'in the INI file neither' bash -c \
    '! grep -q "^sigma" fighters.ini && grep -q "^# sigma_range_m: not known" fighters.ini'
head -n 300 as_stated/plots.csv >short.csv
run calibrate short.csv --config as_stated/scenario.ini -o short.ini
check 'anything, of five turns' exits 1
check 'then there is no INI file' test ! -e short.ini
# A radar beside another, which has looked ten times.
python3 - <<'END'
rows = [f"{t},{sensor},{x},{y}" for t in range(80) for sensor in (1, 2) if sensor == 1 or t < 10
        for x, y in ((0, 0), (100 + 9 * t, 200), (300, 900 - 7 * t))]
with open("at_sensor.csv", "w") as file:
    print("t_s,sensor_id,x_m,y_m", *rows, sep="\n", file=file)
with open("only_at_sensor.csv", "w") as file:
    print("t_s,sensor_id,x_m,y_m", *(row for row in rows if ",1," in row or row.endswith(",0,0")),
          sep="\n", file=file)
END
bodies='--set body_max_m=5 --set sigma_range_m=2 --set sigma_azimuth_rad=0.01'
# shellcheck disable=SC2086
run calibrate at_sensor.csv $bodies -o at_sensor.ini
section() { sed -n "/^.sensor $2.$/,/^.sensor /p" "$1"; }
check 'pd of ten looks is neither known nor stated' bash -c "$(declare -f section)
    section at_sensor.ini 2 | grep -qx '# pd: not known' && ! section at_sensor.ini 2 | grep -q ^pd"
check '... that of the other radar is known' bash -c "$(declare -f section)
    section at_sensor.ini 1 | grep -q '^pd = 0.9'"
check 'plots at the sensor have no azimuth noise' \
    test "$(grep -cx 'sigma_azimuth_rad = 0.01' at_sensor.ini)" -eq 2
# shellcheck disable=SC2086
run calibrate only_at_sensor.csv $bodies -o only_at_sensor.ini
check '... and where there are no others, nothing is stated' \
    test "$(section only_at_sensor.ini 2 | grep -c '^# sigma_.*: not known$')" -eq 2
# more radars than a tracker has room for, each with one target
python3 - <<'END'
with open("many.csv", "w") as file:
    print("t_s,sensor_id,x_m,y_m", file=file)
    for t in range(60):
        for sensor in range(1, 81):
            print(f"{t + sensor / 100:.2f},{sensor},{1000 + 20 * t},{1000 + 100 * sensor}",
                  file=file)
END
run calibrate many.csv --json
check '80 radars without places' exits 0
check '... all of them' json stdout 'len(o["radars"]) == 80'
run simulate passive-two -o passive
run calibrate passive/bearings.csv
check 'bearings' says 2 'rhotrack: calibrate takes plots, not bearings'
run calibrate as_stated/plots.csv -o x.csv
check 'another ending' says 2 \
    'rhotrack: x.csv: calibrate writes an INI file, and .csv is the ending of another'
run calibrate as_stated/plots.csv as_stated/plots.csv
check 'an input twice' says 2 \
    'rhotrack: calibrate: as_stated/plots.csv is given twice, and its plots would count twice'
head -n 1 as_stated/plots.csv >none.csv
run calibrate none.csv
check 'no plots' exits 2

# ---- a real radar: what the first half gave, on the second ----
for scene in 2 16; do
    python3 - "$harbour/$scene/plots.csv" <<'END'
import sys
head, *rows = open(sys.argv[1]).read().splitlines()
times = [float(row.split(",")[0]) for row in rows]
middle = (times[0] + times[-1]) / 2
for name, part in (("first", [r for r, t in zip(rows, times) if t < middle]),
                   ("second", [r for r, t in zip(rows, times) if t >= middle])):
    open(name + ".csv", "w").write("\n".join([head, *part]) + "\n")
END
    run calibrate first.csv --set v_max_mps=12 --set accel_max_mps2=0.5 -o first.ini
    run calibrate second.csv --config first.ini --set v_max_mps=12 --set accel_max_mps2=0.5 --json
    check "harbour $scene: squared innovations of the second half" json stdout \
        '0.75 < o["radars"][0]["innovations"] < 1.6'
done
finish
