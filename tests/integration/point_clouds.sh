#!/bin/bash
# SPDX-License-Identifier: MIT
# Clouds of points as mmWave radars write them: numbers of frames as times, frames without points,
# polar noise of Cartesian plots, and the guide in tools/README.md. Runs beside others.
guide=$(realpath "$(dirname "$0")/../../tools/README.md")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# Two people of 0.24 m radius walk in circles in a room, 20 s at 10 Hz: up to 15 points each, with
# heights, the radar 1.5 m above the floor. Between frames 99 and 140 nobody is seen.
python3 - <<'EOF'
import math, random

random.seed(4)
cloud, truth = [], []
for frame in range(200):
    t = frame / 10
    for person, (x0, y0, turn) in enumerate(((-1.5, 3.0, 1.0), (1.5, 4.5, -1.0))):
        a = 2 * person + turn * t
        px, py = x0 + math.cos(a), y0 + math.sin(a)
        vx, vy = -turn * math.sin(a), turn * math.cos(a)
        truth.append(f"{t:.1f},{person + 1},{px:.4f},{py:.4f}")
        for _ in range(15 if frame < 100 or frame >= 140 else 0):
            side, place = random.uniform(0, 2 * math.pi), 0.24 * math.sqrt(random.random())
            x, y = px + place * math.cos(side), py + place * math.sin(side)
            z = random.uniform(0, 1.8) - 1.5
            ground, r = math.hypot(x, y), math.hypot(x, y, z)
            doppler = (x * vx + y * vy) / r + random.gauss(0, 0.3)
            seen = r + random.gauss(0, 0.05)
            azimuth = math.atan2(y, x) + random.gauss(0, 0.03)
            elevation = math.atan2(z, ground) + random.gauss(0, 0.05)
            level = seen * math.cos(elevation)
            cloud.append((frame, level * math.cos(azimuth), level * math.sin(azimuth),
                          seen * math.sin(elevation), doppler, random.uniform(8, 25)))

def write(name, header, rows):
    with open(name, "w") as file:
        print(header, *rows, sep="\n", file=file)

write("truth.csv", "t_s,target_id,x_m,y_m", truth)
write("points.csv", "frame,x,y,z,doppler,snr",
      ["%d,%.4f,%.4f,%.4f,%.3f,%.1f" % row for row in cloud])
write("flat.csv", "FrameNumber,x,y,Doppler", ["%d,%.4f,%.4f,%.3f" % (*row[:3], row[4])
                                              for row in cloud])
write("named.csv", "Bild,x,y,v", ["%d,%.4f,%.4f,%.3f" % (*row[:3], row[4]) for row in cloud])
write("places.csv", "frame,x,y", ["%d,%.4f,%.4f" % row[:3] for row in cloud])
# times, and the empty looks as rows
times = ["%.1f,%.4f,%.4f,%.3f" % (row[0] / 10, *row[1:3], row[4]) for row in cloud]
before = sum(row[0] < 100 for row in cloud)
write("times.csv", "t_s,x_m,y_m,range_rate_mps",
      times[:before] + ["%.1f,,," % (frame / 10) for frame in range(100, 130)] + times[before:])
write("both.csv", "frame,t_s,x_m,y_m,range_rate_mps", ["7," + row for row in times])
write("only_times.csv", "t_s,x_m,y_m,range_rate_mps", times)
write("polar.csv", "frame,range_m,azimuth_rad,range_rate_mps",
      ["%d,%.7f,%.7f,%.3f" % (row[0], math.hypot(*row[1:3]), math.atan2(row[2], row[1]), row[4])
       for row in cloud])
EOF

# ---- the guide ----
sed -n '/^## mmWave point clouds$/,/^## P/{ /^```sh$/,/^```$/{ /^```/!p; }; }' "$guide" >guide.sh
check 'the guide has three commands' test "$(sed ':a; /\\$/{ N; s/\\\n//; ba; }' guide.sh |
    wc -l)" -eq 3
mkdir bin
ln -s "$program" bin/rhotrack
status=0
PATH=$PWD/bin:$PATH bash -eu guide.sh >stdout 2>stderr </dev/null || status=$?
check 'its commands work' exits 0
check '... and make a picture' grep -q '<html' room.html
run evaluate truth.csv tracks.csv --set gospa_cutoff_m=1 --json
cp stdout figures.json
# for 4 of 20 s nobody can be seen, and tracks end
check 'each person has a track while seen' json figures.json \
    'o["completeness"] > 0.75 and o["false_per_scan"] < 0.05'
tracks() { awk -F, 'NR > 1 { id[$2] } END { n = 0; for (i in id) n++; print n }' "$1"; }
check '... a new one after the pause, and few others' test "$(tracks tracks.csv)" -le 6
run track flat.csv --config room.ini -o flat.tracks.csv
check 'without heights: two tracks, and two after the pause' \
    test "$(tracks flat.tracks.csv)" -eq 4

# ---- frames as times ----
check 'frames without rows are counted' grep -qx 'rhotrack: flat.csv: 30 frames without good rows '\
'count as looks without plots, 10 not, being past the first 30 of a gap' stderr
run track times.csv --config room.ini -o times.tracks.csv
check 'times are numbers over the rate, and missing numbers are empty looks' \
    cmp flat.tracks.csv times.tracks.csv
run track named.csv --config room.ini -o named.tracks.csv --columns frame=Bild,range_rate_mps=v
check '--columns names them' cmp flat.tracks.csv named.tracks.csv
run track both.csv --config room.ini -o both.tracks.csv
run track only_times.csv --config room.ini -o only_times.tracks.csv
check 'beside times they do not count' cmp only_times.tracks.csv both.tracks.csv
cat flat.csv |
    "$program" track - --follow --config room.ini -o followed.tracks.csv >stdout 2>stderr
check 'through a pipe that is followed' cmp flat.tracks.csv followed.tracks.csv
run convert places.csv places.lcm --config room.ini
check 'to a log' exits 0
check '... which says so, too' grep -q '^rhotrack: places.csv: 30 frames without good rows' stderr
run convert places.lcm back.csv
check '... has the empty looks' test "$(grep -c ',,,' back.csv)" -eq 30
for command in calibrate 'initiate' 'maintain' 'plot scans'; do
    # shellcheck disable=SC2046,SC2086
    run $command flat.csv --config room.ini $(case $command in
        maintain) echo -o one.csv ;; plot*) echo -o scans.svg ;; esac)
    check "$command reads frames" exits 0
done

# ---- polar noise of Cartesian plots ----
run track polar.csv --config room.ini -o polar.tracks.csv
near() { # tracks, tracks: they differ by rounding
    python3 - "$@" <<'EOF'
import csv, sys
one, other = (list(csv.DictReader(open(name))) for name in sys.argv[1:])
assert len(one) == len(other) > 200, (len(one), len(other))
assert len({row["track_id"] for row in one}) == len({row["track_id"] for row in other})
for a, b in zip(one, other):
    assert a["t_s"] == b["t_s"] and a["track_id"] == b["track_id"]
    for name in ("x_m", "y_m"):
        assert abs(float(a[name]) - float(b[name])) < 3 * float(a["sigma_m"]), (a, b)
EOF
}
check 'places have the stated noise of polar plots' near flat.tracks.csv polar.tracks.csv
run track flat.csv --config room.ini --set sigma_m=0.3 -o wide.tracks.csv
check 'sigma_m goes before it' test "$(cmp -s flat.tracks.csv wide.tracks.csv; echo $?)" -eq 1
awk -F, -v OFS=, 'NR == 1 { print $0, "sigma_m" } NR > 1 { print $0, "0.3" }' flat.csv >stated.csv
run track stated.csv --config room.ini -o stated.tracks.csv
check '... as a column, too' cmp wide.tracks.csv stated.tracks.csv
awk -F, -v OFS=, 'NR == 1 { print $0, "sigma_range_m", "sigma_azimuth_rad" }
    NR > 1 { print $0, "0.05", "0.03" }' flat.csv >columns.csv
run track columns.csv --config room.ini --set sigma_range_m=9 --set sigma_azimuth_rad=0.2 \
    -o columns.tracks.csv
check 'polar sigmas as columns go before parameters' cmp flat.tracks.csv columns.tracks.csv
cut -d, -f1-5 columns.csv >half.csv
grep -v '^sigma_[ra]' room.ini >unsaid.ini
fixed='--config unsaid.ini --set learn_noise_min=1 --set learn_noise_max=1'
# shellcheck disable=SC2086
run track flat.csv $fixed -o default.tracks.csv
for half in half.csv 'flat.csv --set sigma_range_m=0.05' 'flat.csv --set sigma_azimuth_rad=0.03'; do
    # shellcheck disable=SC2086
    run track $half $fixed -o half.tracks.csv
    check "one of the two does not count: $half" cmp default.tracks.csv half.tracks.csv
done

printf 't_s,x_m,y_m\n0,2e6,2e6\n' >corner.csv
run track corner.csv --set sigma_range_m=1 --set sigma_azimuth_rad=0.1 -o corner.tracks.csv
check 'a place beyond the range of polar plots' says 2 \
    'rhotrack: corner.csv:2: the place is too far from the sensor'

# ---- errors ----
run track flat.csv
check 'frames without a rate' says 2 "rhotrack: flat.csv:1: no column 't_s'; of plots 'frame' \
tells the time, and needs frame_rate_hz: *"
rate='--set frame_rate_hz=10'
refused() { # NAME, last row of frame,x,y, message (a pattern)
    printf 'frame,x,y\n5,1,2\n7,1,2\n%s\n' "$2" >bad.csv
    for command in 'track bad.csv -o bad.tracks.csv' 'convert bad.csv bad.lcm'; do
        # shellcheck disable=SC2086
        run $command $rate
        check "$1, ${command%% *}" says 2 "rhotrack: bad.csv:4: $3"
    done
}
refused 'a number that goes back' 6,1,2 "frame '6' is less than one before it: where the radar \
counted anew, a new file has to begin"
refused 'a part of a frame' 7.5,1,2 "frame '7.5' is not an integer"
refused 'a time in place of a number' 2026-01-01T00:00:00Z,1,2 "frame '2026*' is not an integer"
refused 'no number' ,1,2 'frame is empty'
refused 'a number beyond 32 bits' 2147483648,1,2 "frame '2147483648' is out of the range of *"
# shellcheck disable=SC2086
run track bad.csv $rate --keep-going -o kept.csv
check 'a bad number can be left out' exits 0
check '... and is counted' grep -q '1 bad row' stderr
printf 'frame,x,y\n-2147483648,1,2\n2147483647,1,2\n' >far.csv
# shellcheck disable=SC2086
run track far.csv $rate -o far.tracks.csv
check 'a gap of all numbers ends' exits 0
check '... and says how many' grep -q ' 30 frames .*, 4294967264 not, ' stderr
printf 'frame,x,y\n5,1,2\n6,bad,2\n7,1,2\n' >one.csv
# shellcheck disable=SC2086
run track one.csv $rate --keep-going -o one.tracks.csv
check 'one frame, whose row was refused' grep -qx \
    'rhotrack: one.csv: 1 frame without good rows counts as looks without plots' stderr
printf 't_s,target_id,x_m,y_m\n0,1,1,2\n1,1,2,2\n' >short_truth.csv
printf 'frame,track_id,x_m,y_m\n0,1,1,2\n10,1,2,2\n' >frames.csv
# shellcheck disable=SC2086
run evaluate short_truth.csv frames.csv $rate
check 'tracks have times' says 2 "rhotrack: frames.csv:1: no column 't_s' (or *"
run track flat.csv --set frame_rate_hz=0
check 'a rate of 0' says 2 '*frame_rate_hz*0.01 .. 1000*'
printf 'frame,sensor_id,x,y\n1,1,1,2\n1,2,1,2\n9,1,1,2\n9,2,1,2\n' >two.csv
# shellcheck disable=SC2086
run track two.csv $rate -o two.tracks.csv
check 'between rows of two sensors nothing is known' test "$(grep -c frames stderr)" -eq 0
finish
