#!/bin/bash
# SPDX-License-Identifier: MIT
# Turning radars whose rows have a time each: gathered into turns without being asked, by azimuths
# or by gaps, and said; where that cannot be, an option is named. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# A radar's plots as they come: the beam turns, and each plot has the time when it passes.
cat >radar.py <<'EOF2'
import math, random

FULL = 2 * math.pi

def radar(seed, turn=4.0, sense=-1, targets=12, clutter=10, azimuth_noise=0.003, blind=None,
          wander=0.0, sensor=1, seconds=120, decimals=6, near=5e3, far=40e3, start=0.0, speed=150):
    draw = random.Random(seed)
    north, rows, movers = draw.uniform(0, FULL), [], []
    for k in range(targets):
        range_m, azimuth = draw.uniform(near, far), FULL * (k + draw.random()) / targets
        heading, v = draw.uniform(0, FULL), draw.uniform(0.5, 1) * speed
        movers.append((range_m * math.cos(azimuth), range_m * math.sin(azimuth),
                       v * math.cos(heading), v * math.sin(heading)))
    begin = start
    for n in range(int(seconds / turn)):
        duration = turn * (1 + wander * math.sin(0.7 * n))
        for x, y, vx, vy in movers:
            t = begin
            for _ in range(5):
                px, py = x + vx * (t - start), y + vy * (t - start)
                azimuth = math.atan2(py, px)
                t = begin + duration * ((sense * (azimuth - north)) % FULL) / FULL
            rows.append((t, math.hypot(px, py) + draw.gauss(0, 15),
                         azimuth + draw.gauss(0, azimuth_noise)))
        for _ in range(clutter):
            share = draw.random()
            rows.append((begin + duration * share, draw.uniform(near, far),
                         north + sense * FULL * share + draw.gauss(0, azimuth_noise)))
        begin += duration
    return [(round(t, decimals), sensor, range_m, azimuth % FULL) for t, range_m, azimuth in rows
            if not blind or not blind[0] <= azimuth % FULL <= blind[1]]

def write(name, rows, place=None, extra=lambda row: ""):
    header = "x_m,y_m" if place else "range_m,azimuth_deg"
    with open(name, "w") as file:
        more = extra(None)
        file.write(f"t_s,sensor_id,{header}{more}\n")
        for row in sorted(rows, key=lambda row: row[0]):
            t, sensor, range_m, azimuth = row
            pair = ((place[0] + range_m * math.cos(azimuth), place[1] + range_m * math.sin(azimuth))
                    if place else (range_m, (90 - math.degrees(azimuth)) % 360))
            file.write(f"{t:.6f},{sensor},{pair[0]:.2f},{pair[1]:.4f}{extra(row)}\n")

write("clockwise.csv", radar(1))
write("other_way.csv", radar(2, sense=1))
write("blind_sector.csv", radar(3, blind=(1.0, 3.0)))
write("jitter.csv", radar(4, azimuth_noise=0.03))
write("gusts.csv", radar(5, wander=0.02))
write("two.csv", radar(6) + radar(7, turn=10.0, sensor=2, start=1.3))
write("few.csv", radar(8, targets=3, clutter=0))
write("dense.csv", radar(9, turn=2.5, clutter=200, decimals=3))
write("tenths.csv", radar(10, turn=2.5, clutter=200, decimals=1))
write("seconds.csv", radar(11, clutter=30, decimals=0))
write("near.csv", radar(12, turn=1.25, near=200, far=3000, speed=15))
write("fastest.csv", radar(15, turn=0.5, seconds=40, near=200, far=3000, speed=15))
write("places.csv", radar(13), place=(0, 0))
write("elsewhere.csv", radar(13), place=(30000, 20000))
write("one_direction.csv", radar(14, targets=60, clutter=40, blind=(0.9, 6.2)))
write("heights.csv", radar(15),
      extra=lambda row: ",alt_m" if row is None else ",500" if int(row[2]) % 3 else ",")
write("one_target.csv", radar(16, targets=1, clutter=0))
# Scans of a staring radar, whose plots have times of their own.
targets = [(6000 + 1500 * k, 0.5 + 0.1 * k, 25 * k - 100) for k in range(8)]
write("staring.csv", [(0.5 * n + 0.001 * k, 1, r + 0.5 * v * n, a)
                      for n in range(60) for k, (r, a, v) in enumerate(targets)])
# One target that goes round the radar; scans as they are.
write("circle.csv", [(t, 1, 3000, -FULL * t / 60) for t in range(300)])
write("pair.csv", [(t, 1, 500 + 15 * k, -FULL * t / 20) for t in range(300) for k in range(2)])
write("scans.csv", [(4 * n, 1, 8000 + 30 * n + 900 * k, k) for n in range(30) for k in range(10)])
draw = random.Random(17)
write("staring_rows.csv", [(0.1 * n + draw.uniform(0, 0.09) * (n % 7 > 2), 1,
                            5000 + 2000 * (n % 5) + 5 * n, 0.3 + 0.2 * draw.randrange(5))
                           for n in range(400)])
EOF2
python3 radar.py

own='the rows of a turn differ in time; they are gathered into'
turns() { # NAME, file, how (a pattern of grep -E), least number of tracks
    run track "$2" -o tracks.csv --json
    check "$1: said" grep -Eq "^rhotrack: $2: sensor 1: $own $3; scan_interval_s=0 " stderr
    check "$1: tracks" json stdout "$4 <= o['tracks_confirmed'] <= $4 + 3"
    run convert "$2" scans.lcm
    check "$1: the same as messages" grep -Eq "^rhotrack: $2: sensor 1: $own $3; " stderr
    run track scans.lcm --json -o tracks.csv
    check "$1: tracks of these" json stdout "$4 <= o['tracks_confirmed'] <= $4 + 3"
}
turns 'clockwise' clockwise.csv 'turns of (4|4.00.|3.99.) s by azimuth, clockwise' 12
turns 'counter-clockwise' other_way.csv \
    'turns of (4|4.00.|3.99.) s by azimuth, counter-clockwise' 12
turns 'a blind sector' blind_sector.csv 'turns of (4|4.00.|3.99.) s by azimuth, clockwise' 8
turns 'azimuths of 2 degrees noise' jitter.csv \
    'turns of (4|4.0..?|3.99.) s by azimuth, clockwise' 12
turns 'gusts of wind' gusts.csv 'turns of (4|4.0..?|3.9..?) s by azimuth, clockwise' 12
turns 'three plots a turn' few.csv 'turns of (4|4.00.|3.99.) s by azimuth, clockwise' 3
turns '200 plots a turn' dense.csv 'turns of (2.5|2.50.|2.49.) s by azimuth, clockwise' 12
turns 'times in tenths of seconds' tenths.csv \
    'turns of (2.5|2.50.|2.49.) s by azimuth, clockwise' 12
turns 'times in whole seconds' seconds.csv 'turns of (4|4.00.|3.99.) s by azimuth, clockwise' 12
turns 'a near radar' near.csv 'turns of 1.2[45].? s by azimuth, clockwise' 12
turns 'the fastest' fastest.csv 'turns of (0.5|0.50..?|0.49..?) s by azimuth, clockwise' 12
turns 'places, not ranges' places.csv 'turns of (4|4.00.|3.99.) s by azimuth, clockwise' 12
turns 'all in one direction' one_direction.csv \
    'scans, [34].[0-9]* s apart, by the gaps between them' 8
turns 'a staring radar' staring.csv 'scans, 0.5 s apart, by the gaps between them' 8

run track two.csv -o tracks.csv --json
check 'two radars in one file: both said' bash -c \
    'grep -q "sensor 1: .* turns of 4.* s by" stderr &&
    grep -q "sensor 2: .* turns of \(10\|10.0.\|9.99.\) s by" stderr'
check 'two radars in one file: 30 and 12 turns' json stdout '41 <= o["scans"] <= 45'
check 'two radars in one file: tracks' json stdout '24 <= o["tracks_confirmed"] <= 40'
run track heights.csv -o tracks.csv --json
check 'some rows have heights: they are one turn' json stdout \
    '30 <= o["scans"] <= 31 and 12 <= o["tracks_confirmed"] <= 15'
run convert heights.csv heights.lcm
check 'and messages, each with its own' exits 0
cp clockwise.csv growing.csv
(sleep 1; kill -INT $BASHPID) 2>/dev/null
timeout -s INT 2 "$program" track growing.csv --follow -o tracks.csv 2>stderr
check 'a file that grows' grep -Eq ' 3[01] scans, [0-9]+ plots, 1[2-5] tracks confirmed' stderr

# What the option says counts, and what is not known is said.
run track clockwise.csv --set scan_interval_s=0 -o tracks.csv
check 'scan_interval_s=0: each row is a scan, and nothing is said' bash -c \
    '! grep -q "gathered into" stderr && grep -q "^rhotrack: no track: .* scan_interval_s" stderr'
run track clockwise.csv --set scan_interval_s=3.9 -o tracks.csv
check 'scan_interval_s=3.9: as it says' bash -c '! grep -q "gathered into" stderr'
run track elsewhere.csv -o tracks.csv
check 'a radar whose place is not known: the options are named' grep -q \
    '^rhotrack: elsewhere.csv: sensor 1: each row has its own time, 0.1[0-9]* s apart, and '\
'neither azimuths (seen from its place, sensor.1.x_m and y_m) nor gaps show .*: '\
'set scan_interval_s ' stderr
run track elsewhere.csv -o tracks.csv --json --set sensor.1.x_m=30000 --set sensor.1.y_m=20000
check 'its place is an answer' json stdout '12 <= o["tracks_confirmed"] <= 15'
run track elsewhere.csv -o tracks.csv --json --set scan_interval_s=3.9
check 'and scan_interval_s is one' json stdout '10 <= o["tracks_confirmed"] <= 18'
run track - -o tracks.csv
check 'a pipe is not looked at twice' bash -c \
    "'$program' track - -o tracks.csv <clockwise.csv 2>&1 |
    grep -q 'no track: .* scan_interval_s with the time of a turn'"

# What is no turn stays as it is: the same bytes as with each time a scan, and no word.
for name in scans circle pair one_target staring_rows; do
    run track $name.csv -o tracks.csv
    check "$name: nothing is said" bash -c '! grep -q "gathered into" stderr'
    run track $name.csv -o other.csv --set scan_interval_s=0
    check "$name: as it is" cmp tracks.csv other.csv
done
run track clockwise.csv -o tracks.csv
run track clockwise.csv --set frame_rate_hz=10 -o other.csv
check 'a rate of frames is nothing to a file with times' exits 0
check '... which has the same tracks' cmp tracks.csv other.csv
run convert clockwise.csv turns.lcm
run convert clockwise.csv framed.lcm --set frame_rate_hz=10
check '... and messages' cmp turns.lcm framed.lcm
sed '1s/^t_s/frame/; 1!s/^\([0-9]*\)[.0-9]*/\1/' clockwise.csv >frames.csv
run track frames.csv --set frame_rate_hz=1 -o tracks.csv
check 'numbers of frames count' exits 0
check '... and no turns are looked for' bash -c '! grep -q "gathered into" stderr'
run convert frames.csv frames.lcm --set frame_rate_hz=1
check '... nor in messages' bash -c '[ -s frames.lcm ] && ! grep -q "gathered into" stderr'
sed '1s/$/,scan/; 1!s/$/,1/' clockwise.csv >numbered.csv
run convert numbered.csv numbered.lcm
check 'numbers of scans count' bash -c '! grep -q "gathered into" stderr'
sed '1s/$/,sector_from_rad,sector_to_rad/; 1!s/$/,0,1/' clockwise.csv >sectors.csv
run track sectors.csv -o tracks.csv
check 'and sectors' bash -c '! grep -q "gathered into" stderr'

# A plot that goes back in time is refused in a turn as elsewhere.
{
    head -n 300 clockwise.csv
    sed -n '290s/$/1/p' clockwise.csv
    tail -n +301 clockwise.csv
} >back.csv
run track back.csv
check 'time that goes back within a turn' grep -q \
    '^rhotrack: back.csv:301: time decreases from ' stderr
finish
