#!/bin/bash
# SPDX-License-Identifier: MIT
# track --follow: a file that grows, by whole rows and by half ones; how it ends, and what it
# refuses.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Two targets for 12 scans, 10 s apart, 2 plots a scan.
awk 'BEGIN {
    srand(7)
    print "t_s,sensor_id,x_m,y_m"
    for (k = 0; k < 12; k++) {
        printf "%.1f,1,%.2f,%.2f\n", 10 * k, -9000 + 2000 * k + 20 * (rand() - .5),
            500 * k + 20 * (rand() - .5)
        printf "%.1f,1,%.2f,%.2f\n", 10 * k, 30000 - 1500 * k + 20 * (rand() - .5),
            1000 * k + 20 * (rand() - .5)
    } }' >plots.csv
run track plots.csv -o expected.csv
rows=$(wc -l <expected.csv)

# follow ARGUMENT...: starts in the background; a shell's background jobs ignore SIGINT, which is to
# be as typed.
follow() {
    rm -f out.csv
    env --default-signal=INT "$program" track --follow "$@" >stdout 2>stderr </dev/null &
    job=$!
}

# Until the command succeeds, for 5 s at most.
until_it() {
    for ((i = 0; i < 100; i++)); do
        "$@" && return 0
        sleep 0.05
    done
    return 1
}
has_rows() { [ "$(cat "$1" 2>/dev/null | wc -l)" -ge "$2" ]; } # FILE N
ends_at() { [ "$(tail -n 1 "$1" 2>/dev/null | cut -d, -f1)" = "$2" ]; }    # FILE t_s
ended() { ! kill -0 "$job" 2>/dev/null; }

# Signals the job, if it should still run, and takes its exit code.
finish_job() { # SIGNAL, or nothing
    if [ $# -gt 0 ]; then
        kill -s "$1" "$job"
    fi
    if ! until_it ended; then
        kill -s KILL "$job"
    fi
    status=0
    wait "$job" || status=$?
}

# ---- it grows ----
head -n 5 plots.csv >grow.csv
follow grow.csv -o out.csv --set follow_quiet_s=60
check 'the output is there from the start' until_it has_rows out.csv 1
check 'it goes on' bash -c "! kill -0 $job 2>&1 | grep -q ."
sed -n 6,15p plots.csv >>grow.csv
check 'rows appear while it runs' until_it ends_at out.csv 50.000000
check 'nothing lies beside the output' matches "$(echo out*)" out.csv
sed -n 16p plots.csv | tr -d '\n' | head -c 7 >>grow.csv # half a row
sleep 0.3
sed -n 16p plots.csv | tail -c +8 >>grow.csv
sed -n '17,$p' plots.csv >>grow.csv
check 'up to the last scan but one' until_it ends_at out.csv 100.000000
sleep 0.3
check 'the last scan waits' ends_at out.csv 100.000000
finish_job TERM
check 'SIGTERM: exit 0' exits 0
check 'the same rows as track makes of the whole file' cmp expected.csv out.csv
check 'and the summary' matches "$(cat stderr)" \
    'rhotrack: 12 scans, 24 plots, 2 tracks confirmed; *'

follow plots.csv --json -o out.csv --set follow_quiet_s=60
until_it ends_at out.csv 100.000000
finish_job INT
check 'SIGINT: exit 0, and JSON' json stdout 'o["scans"] == 12 and o["plots"] == 24'
check 'SIGINT: the last scan is tracked' cmp expected.csv out.csv
rm out.csv
env --ignore-signal=INT "$program" track --follow plots.csv -o out.csv >stdout 2>stderr </dev/null &
job=$!
until_it has_rows out.csv 5
kill -s INT $job
sleep 0.3
check 'SIGINT that is ignored stays so' kill -0 $job
finish_job TERM

# ---- the last scan ----
cp plots.csv grow.csv
follow grow.csv -o out.csv --set follow_quiet_s=0.3
check 'after a quiet time the last scan is complete' until_it ends_at out.csv 110.000000
printf '120,1,15000.00,60' >>grow.csv
sleep 0.8
check 'half a row stays out of it, however long it takes' ends_at out.csv 110.000000
printf '00.00\n' >>grow.csv
check 'and is a row when it is whole' until_it ends_at out.csv 120.000000
sleep 0.5
printf '120,1,12000.00,12000.00\n' >>grow.csv
sleep 0.6
finish_job TERM
check 'rows behind the quiet time are a scan of their own' matches "$(cat stderr)" \
    'rhotrack: 14 scans, 26 plots, *'

{ printf 't_s,sensor_id,x_m,y_m,note\n1,1,5,5,"two\n'; } >quoted.csv
follow quoted.csv --set follow_quiet_s=0.1
sleep 0.5
printf 'lines"\n2,1,6,6,\n' >>quoted.csv
sleep 0.3
finish_job TERM
check 'a quoted cell that is not at its end waits' matches "$(cat stderr)" \
    'rhotrack: 2 scans, 2 plots, *'

# Scans by number come mixed: one is complete when its sensor has begun the second one after it.
awk -F, 'NR == 1 { print $0 ",scan"; next }
    { k = int(NR / 2); print $1 + (NR % 2) * 4 "," $2 "," $3 "," $4 "," k }' \
    plots.csv >numbered.csv
run track numbered.csv -o expected_numbered.csv
follow numbered.csv -o out.csv --set follow_quiet_s=60
check 'numbered scans: two behind' until_it ends_at out.csv 90.000000
finish_job TERM
check 'and the same rows in the end' cmp expected_numbered.csv out.csv

# A clock that is 6 s ahead: what the other radar sends comes after a pause that is longer than
# follow_quiet_s.
{
    echo t_s,sensor_id,x_m,y_m
    awk -F, 'NR > 1 {
            print 4 * $1 / 10 "," $1 ",1," $3 "," $4
            print 4 * $1 / 10 + 6.1 "," $1 ",2," $3 "," $4
        }' plots.csv |
        sort -s -t, -n -k 1,1 | cut -d, -f1,3-
} >ahead.csv
ahead=(--set sensor.2.time_bias_s=6 --set sigma_m=50)
run track ahead.csv "${ahead[@]}" -o expected_ahead.csv
check 'clocks that are apart' has_rows expected_ahead.csv 20
middle=$(($(wc -l <ahead.csv) / 2 + 1))
head -n "$middle" ahead.csv >grow.csv
follow grow.csv -o out.csv "${ahead[@]}" --set follow_quiet_s=0.2
sleep 1.2
sed "1,${middle}d" ahead.csv >>grow.csv
sleep 0.5
finish_job TERM
check 'a pause does not undo the order of their times' cmp expected_ahead.csv out.csv

# ---- nothing, or little ----
: >empty.csv
follow empty.csv -o out.csv --set follow_quiet_s=60
sleep 0.2
cat plots.csv >>empty.csv
check 'a file that is still empty' until_it ends_at out.csv 100.000000
finish_job TERM
head -n 1 plots.csv >header.csv
follow header.csv
sleep 0.3
finish_job INT
check 'a header alone: exit 0' matches "$(cat stdout) $status $(cat stderr)" \
    't_s,track_id,*,plot 0 rhotrack: 0 scans, 0 plots, *'

# ---- pipes ----
status=0
cat plots.csv | "$program" track - >stdout 2>stderr || status=$?
check 'standard input, by its name -' writes_same_as expected.csv
status=0
cat plots.csv | "$program" track --follow - >stdout 2>stderr || status=$?
check 'a pipe ends by itself' writes_same_as expected.csv
mkfifo pipe
rm -f out.csv
"$program" track --follow pipe -o out.csv --set follow_quiet_s=60 >stdout 2>stderr &
job=$!
exec 9>pipe
head -n 13 plots.csv >&9
check 'rows appear while a pipe is open' until_it ends_at out.csv 40.000000
sed -n '14,$p' plots.csv >&9
exec 9>&-
finish_job
check 'a named pipe: exit 0 at its end' exits 0
check 'a named pipe: all rows' cmp expected.csv out.csv
status=0
printf 't_s,sensor_id,x_m,y_m\n1,1,x,3\n' | "$program" track - >stdout 2>stderr || status=$?
check 'errors in standard input' says 2 "rhotrack: standard input:2: x_m 'x' is not a number"

# ---- ends ----
over() { # name, pattern, COMMAND...
    cp plots.csv grow.csv
    follow grow.csv -o out.csv --set follow_quiet_s=60
    until_it ends_at out.csv 100.000000
    "${@:3}"
    finish_job
    check "$1: exit 1" exits 1
    check "$1: it says so" matches "$(tail -n 1 stderr)" \
        "rhotrack: grow.csv $2: --follow ends"
    check "$1: all rows are there" cmp expected.csv out.csv
}
over 'truncated' 'has become shorter' truncate -s 30 grow.csv
over 'replaced' 'has been replaced by another file' cp --remove-destination plots.csv grow.csv
over 'removed' 'is gone' rm grow.csv

cp plots.csv grow.csv
follow grow.csv -o out.csv --set follow_quiet_s=60
until_it ends_at out.csv 100.000000
printf '# a comment\n120,1,abc,5\n' >>grow.csv
finish_job
check 'a bad row: exit 2, with its line' says 2 "rhotrack: grow.csv:27: x_m 'abc' is not a number"
check 'a bad row: what was written stays' matches "$(wc -l <out.csv)" $((rows - 2))
cp plots.csv grow.csv
follow grow.csv -o out.csv --set follow_quiet_s=60 --keep-going
printf '120,1,abc,5\n130,1,17000,6500\n140,1,19000,7000\n' >>grow.csv
check 'with --keep-going it goes on' until_it ends_at out.csv 130.000000
finish_job TERM
check 'and counts it' matches "$(cat stderr)" \
    'rhotrack: 14 scans, 26 plots, *, 1 bad rows skipped; *'
cp plots.csv grow.csv
follow grow.csv -o out.csv --set follow_quiet_s=60
printf '5,1,1,1\n' >>grow.csv
finish_job
check 'a row before those that came' says 2 \
    'rhotrack: grow.csv:26: time decreases from 110.000000 s to 5.000000 s'

# ---- refused ----
printf 't_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad\n0,1,0,0,1\n0,2,100,0,1\n' >bearings.csv
run track --follow bearings.csv
check 'bearings' says 2 'rhotrack: bearings.csv:1: --follow takes plots, but this file has bearings'
run convert plots.csv plots.lcm
run track --follow plots.lcm
check 'a log' says 2 'rhotrack: plots.lcm: --follow takes CSV files, but this is an LCM log'
run track --follow plots.csv plots.csv
check 'two inputs' says 2 'rhotrack: --follow takes one input'
ln -s plots.csv same.csv
run track --follow plots.csv -o same.csv
check 'an output that is the input' says 2 'rhotrack: plots.csv: the output cannot be an input'
check 'which is as it was' has_rows plots.csv 25
run track --follow none.csv
check 'no such file' says 2 'rhotrack: none.csv: No such file or directory'
run track --follow plots.csv -o none/out.csv
check 'an output that cannot be' says 1 'rhotrack: none/out.csv: No such file or directory'
run initiate --follow plots.csv
check 'other commands' says 2 'rhotrack: initiate takes no --follow; *'
finish
