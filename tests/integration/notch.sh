#!/bin/bash
# SPDX-License-Identifier: MIT
# A radar that is blind near zero Doppler: targets that stop or pass tangentially keep their
# identity where the notch is said, in the file of settings or by an option.
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

run simulate traffic-light --seed 3 -o light
check 'the scene tells the notch' grep -qx 'notch_mps = 0.3' light/scenario.ini
run track light/plots.csv --config light/scenario.ini -o told.csv
run evaluate light/truth.csv told.csv --set gospa_cutoff_m=5 --json
check 'cars that stop are kept' json stdout 'o["switches"] == 0 and o["completeness"] > 0.98'
grep -v notch_mps light/scenario.ini >silent.ini
run track light/plots.csv --config silent.ini -o silent.csv
run evaluate light/truth.csv silent.csv --set gospa_cutoff_m=5 --json
check 'where nothing is said they are lost' json stdout 'o["completeness"] < 0.8'
run track light/plots.csv --config silent.ini --set sensor.1.notch_mps=0.3 -o one.csv
check 'an option says it of a sensor' cmp told.csv one.csv
run track light/plots.csv --config silent.ini --set notch_mps=0.3 -o all.csv
check 'and of all' cmp told.csv all.csv
run convert light/plots.csv light.lcm
run track light.lcm --config light/scenario.ini -o log.csv
run evaluate light/truth.csv log.csv --set gospa_cutoff_m=5 --set time_tolerance_s=0.01 --json
check 'the same from a log of messages' json stdout \
    'o["switches"] == 0 and o["completeness"] > 0.98'

run simulate notch --seed 5 -o air
run track air/plots.csv --config air/scenario.ini -o air.csv
run evaluate air/truth.csv air.csv --json
check 'aircraft that pass tangentially are kept' json stdout \
    'o["switches"] == 0 and o["completeness"] > 0.97'

# ---- nobody tells of the notch: it is learned, and not taken for a bad radar ----
many=(--set targets.0.count=60 --set duration_s=1500 --set 'targets.0.range_m=[30000, 75000]')
run simulate notch --seed 5 "${many[@]}" --set 'radars.0.told={"notch_mps": 0}' -o many
run track many/plots.csv --config many/scenario.ini --json -o learned.csv
check 'the notch is learned' json stdout '9 < o["learned"][0]["notch_mps"] < 13'
# but for a ring of which few looks were counted
check 'P_D is not' json stdout \
    'sum(pd > 0.88 for pd in o["learned"][0]["pd"]) >= 5 and min(o["learned"][0]["pd"]) > 0.7'
check 'the summary says it' grep -q ', sensor 1 is blind within 11.3 m/s of zero Doppler' stderr
run track many/plots.csv --config many/scenario.ini --set learn_pd_min=1 --json -o stated.csv
check 'nothing is learned where that is switched off' json stdout \
    '"notch_mps" not in o["learned"][0]'
run evaluate many/truth.csv learned.csv --json
check 'aircraft are kept' json stdout 'o["completeness"] > 0.94 and o["switches"] < 30'
run evaluate many/truth.csv stated.csv --json
check 'and else lost' json stdout 'o["completeness"] < 0.92 and o["switches"] > 38'
run simulate notch --seed 5 "${many[@]}" --set radars.0.notch_mps=0 -o none
run track none/plots.csv --config none/scenario.ini --json -o none.csv
check 'no notch is learned where there is none' json stdout '"notch_mps" not in o["learned"][0]'

# ---- bad settings ----
for bad in notch_mps=-1 sensor.1.notch_mps=x blind_speed_mps=1e9; do
    run track light/plots.csv --set $bad
    check "$bad" says 2 "rhotrack: --set $bad: *"
done
run track light/plots.csv --set notch_mps=10 --set blind_speed_mps=20
check 'blind speeds overlap' says 2 \
    'rhotrack: blind_speed_mps 20 is not more than twice notch_mps 10'
run track light/plots.csv --set sensor.1.notch_mps=10 --set sensor.1.blind_speed_mps=15
check 'of a sensor' says 2 \
    'rhotrack: sensor 1: blind_speed_mps 15 is not more than twice notch_mps 10'
run simulate notch --set radars.0.blind_speed_mps=20 -o none
check 'of a scene' says 2 \
    'rhotrack: notch:*: radars?0?.blind_speed_mps: must be more than twice notch_mps'

finish
