#!/bin/bash
# SPDX-License-Identifier: MIT
# What may be typed: help, version, commands, options, parameters and where their values come from.
# Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

commands='track initiate simulate evaluate plot bench config'
printf 't_s,sensor_id,x_m,y_m\n1,1,2,3\n' >plots.csv

# ---- help and version ----
lists_commands() {
    local c
    exits 0 && [ ! -s stderr ] && for c in $commands; do grep -q "^  $c " stdout || return 1; done
}
run --help
check 'help lists all commands' lists_commands
run -h
check '-h is --help' lists_commands
run --version
check 'version' grep -Eqx 'rhotrack [0-9]+\.[0-9]+\.[0-9]+' stdout
for command in $commands; do
    run "$command" --help
    check "help of $command" grep -q "^Usage: rhotrack $command" stdout
done
for command in track maintain initiate publish convert; do
    run "$command" --help
    for word in 'LCM log' ASTERIX CAT048 lat_deg received_s; do
        check "help of $command: $word" grep -q "$word" stdout
    done
done
for command in track initiate maintain convert publish; do
    run "$command" --help
    check "help of $command names recordings of the network" grep -q \
        'NAME\.pcap, NAME\.pcapng' stdout
done
run publish --help
check 'publish takes received_s' bash -c '! grep -q "no received_s" stdout'
for command in track maintain; do
    run "$command" --help
    check "help of $command: its outputs" grep -q '\.ast ASTERIX (CAT062), \.geojson a map' stdout
done
printf 'pd = 0.7\nsigma_m = 3\n' >one.ini
printf 'pd = 0.6\n' >two.ini
run config --config one.ini --config two.ini --json
check 'of several --config the last one counts' json stdout \
    'o["pd"]["value"] == 0.6 and o["sigma_m"]["value"] == 3'
"$program" --help >/dev/full 2>stderr
status=$?
check 'help on a full disk is a failure' exits 1

# ---- one clear line, exit 2 ----
refuse() { # name, pattern of the line, arguments...
    local name=$1 pattern=$2
    shift 2
    run "$@"
    check "$name" says 2 "rhotrack: $pattern"
}
refuse 'no command' 'no command*--help'
refuse 'unknown command' "unknown command 'xyzzy'*" xyzzy plots.csv
refuse 'misspelt command' "unknown command 'trakc', did you mean 'track'?" trakc plots.csv
refuse 'unknown option before the command' "unknown option '--frob'*" --frob
refuse 'unknown option' "track: unknown option '--frobnicate'*" track --frobnicate plots.csv
refuse 'misspelt option' "track: unknown option '--jsn', did you mean '--json'?" track \
    --jsn plots.csv
refuse 'unknown letter' "track: unknown option '-q'*" track -q plots.csv
refuse 'option of another command' 'track takes no --runs*' track --runs 3 plots.csv
refuse 'option without its value' 'track: --set needs a value' track plots.csv --set
refuse 'option with a value too many' 'track: --json takes no value' track --json=3 plots.csv
refuse 'no input' 'track: too few arguments*' track
refuse 'one input too many' "initiate: 'b.csv' is one argument too many*" initiate plots.csv b.csv
refuse 'config takes no arguments' "config: 'x' is one argument too many*" config x
refuse 'unknown gate' "--gate 'x' is not one of best|hough|nearest|none" track plots.csv --gate x
refuse 'a gate by number' "--gate '1' is not one of best|hough|nearest|none" track plots.csv \
    --gate 1
refuse 'empty gate' "--gate '' is not one of best|hough|nearest|none" track plots.csv --gate ''
refuse 'gate without its value' 'track: --gate needs a value' track plots.csv --gate
refuse 'gate none' \
    'gate none, which draws plots at random, is only for `maintain`; use best, hough or nearest' \
    track plots.csv --gate none
refuse 'gate none, as a parameter' 'gate none, which draws plots at random, *' track plots.csv \
    --set gate=none
refuse 'unknown gate, as a parameter' \
    "--set gate=x: gate 'x' is not one of best|hough|nearest|none" \
    config --set gate=x
refuse 'no plane' "--set planes=: planes '' is not one of xy|xz|yz, or several joined by +" config \
    --set planes=
refuse 'a plane that there is not' \
    "--set planes=xy+yx: planes 'xy+yx' is not one of xy|xz|yz, or several joined by +" \
    config --set planes=xy+yx
refuse 'a cell beyond a quarter turn' \
    '--set gate_theta_deg=91: gate_theta_deg 91 is outside 0.1 .. 90 deg' \
    config --set gate_theta_deg=91
refuse 'track decides on inputs by itself' 'track takes no --no-input-estimation*' \
    track plots.csv --no-input-estimation
refuse 'unknown method' \
    "no method 'passive-papers'; there are: kernel, ht, mht, iht, nht, passive, passive-paper" \
    initiate plots.csv --method passive-papers
refuse 'runs not a number' "--runs 'many' is not a whole number" simulate radar -o runs --runs many
refuse 'no runs' '--runs 0 is outside 1 .. *' simulate radar -o runs --runs 0
refuse 'negative seed' "--seed '-1' is not a whole number" simulate radar -o runs --seed -1

# ---- parameters ----
refuse 'set without =' '--set sigma_m: not of the form key=value' config --set sigma_m
refuse 'set of an unknown name' \
    "--set sigma=1: unknown parameter 'sigma', did you mean 'sigma_m'?" \
    config --set sigma=1
refuse 'set to no number' "--set sigma_m=ten: sigma_m 'ten' is not a number" config \
    --set sigma_m=ten
refuse 'set to nothing' "--set sigma_m=: sigma_m '' is empty" config --set sigma_m=
refuse 'set to nan' "--set sigma_m=nan: sigma_m 'nan' is not finite" config --set sigma_m=nan
refuse 'set beyond the range' '--set pd=1.5: pd 1.5 is outside 0.01 .. 0.999' config --set pd=1.5
refuse 'set to part of a scan' "--set scans=4.5: scans '4.5' is not a whole number" config \
    --set scans=4.5
refuse 'no number of a sensor' \
    "--set sensors_allowed=1 x: sensors_allowed 'x' is not a sensor's number" \
    config --set 'sensors_allowed=1 x'
refuse 'a number of a sensor beyond messages' \
    "*: sensors_allowed '32768' is not a sensor's number" config --set sensors_allowed=32768
printf 'sensors_allowed = 3 -4\n' >allowed.ini
run config --json --config allowed.ini
check 'sensors_allowed in a file' json stdout \
    'o["sensors_allowed"] == {"value": [3, -4], "source": "config"}'
printf 't_s,sensor_id,x_m,y_m\n1,3,10,20\n1,5,30,40\n2,5,30,40\n' >allowed.csv
run convert allowed.csv allowed.lcm
run track allowed.lcm --config allowed.ini -o /dev/null
check 'other sensors are counted' grep -q '2 messages of sensors that are not in sensors_allowed' \
    stderr
refuse 'more votes than scans' 'min_scans 8 is more than scans 7' config --set min_scans=8
refuse 'two votes' 'min_scans 2 is neither 0 nor 3 or more' config --set min_scans=2
refuse 'slowest above fastest' 'v_min_mps 800 is not below v_max_mps 700' config --set v_min_mps=800
refuse 'a part of the area' 'area_x_min_m*: 1 of 4 are set' config --set area_x_min_m=0
refuse 'sensor without a number' "--set sensor.a.pd=.5: 'sensor.a.pd' is not sensor.N.key*" \
    config --set sensor.a.pd=.5
refuse 'unknown key of a sensor' \
    "--set sensor.1.pdd=.5: unknown parameter 'pdd', did you mean 'pd'?" \
    config --set sensor.1.pdd=.5
refuse 'the range of a sensor' 'sensor 1: range_min_m 3000 is not below range_max_m 2000' \
    config --set sensor.1.range_min_m=3000 --set sensor.1.range_max_m=2000

run config
check 'config prints units, defaults and ranges' grep -Eq \
    '^sigma_m +m +10 +0.001 .. 100000 +10 +default' stdout
run config --json
check 'config as JSON' is_json stdout
check 'config tells the source' json stdout \
    '(o["pd"]["value"] == 0.9 and o["pd"]["source"] == "default" and
    o["score_min_nat"]["value"] is None)'

printf '# a comment\nsigma_m = 20\n[rhotrack]\npd = 0.8   # another\n[sensor 3]\npd = 0.7\n' \
    >good.ini
run config --json --config good.ini
check 'config file' json stdout \
    'o["sigma_m"]["value"] == 20 and o["pd"]["value"] == 0.8 and o["pd"]["source"] == "config"'
check 'sensor in the config file' json stdout 'o["sensor.3.pd"]["value"] == 0.7'
run config --json --set sigma_m=30 --config good.ini --set sensor.3.pd=0.6
check 'set goes before the config file in any order' json stdout \
    '(o["sigma_m"]["value"] == 30 and o["sigma_m"]["source"] == "set" and
    o["sensor.3.pd"]["value"] == 0.6)'

# ---- what is said of a scene stands in the scene ----
refuse 'parameters of scenarios that are scenes' \
    "--set num_scans=3: unknown parameter 'num_scans'*" config --set num_scans=3
printf 'sigma_m = 20\n' >trackers.ini
refuse "a tracker's file" \
    'simulate: a scene takes no --config; its parameters are in its settings' \
    simulate polar -o none --config trackers.ini
check 'nothing is written' test ! -e none

refuse_config() { # name, pattern, text of the file
    printf "$3" >bad.ini
    refuse "$1" "bad.ini:$2" config --config bad.ini
}
refuse 'missing config file' 'none.ini: No such file or directory' config --config none.ini
refuse 'config file is a folder' '.: Is a directory' config --config .
refuse_config 'unknown name in a config file' "4: unknown parameter 'x_y'*" \
    'pd = 0.5\n\n# two\nx_y = 1\n'
refuse_config 'unknown section' '2: unknown section \[radar\]*' '[radar]\npd = 0.5\n'
refuse_config 'no number in a config file' "2: pd 'high' is not a number" '\npd = high\n'
refuse_config 'no = in a config file' '3: neither \[section\] nor key = value' '\n\npd\n'
refuse_config 'indented lines are lines' "2: unknown parameter 'pq'*" 'pd = 0.5\n  pq = 0.5\n'
refuse_config 'very long line' '2: line longer than *' "pd = 0.5\n#$(printf '%0500d' 0)\n"

finish
