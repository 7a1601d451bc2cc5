#!/bin/bash
# SPDX-License-Identifier: MIT
# CSV files as others write them: separators, decimal commas, names, units, times, angles, and what
# is said of those that cannot be read. Runs beside others.
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# One target, seen at t = 0, 2 .. 58 s, in the program's own form and in others.
python3 - <<'EOF'
import datetime, math

def write(name, header, row):
    with open(name, "w") as file:
        file.write(header + "\n")
        for k in range(30):
            x, y, t = 3000 + 300 * k, 8000 - 200 * k, 2 * k
            file.write(row(t, x, y, math.hypot(x, y), math.degrees(math.atan2(x, y))) + "\n")

def iso(t):
    time = datetime.datetime.fromtimestamp(1709251170 + t, datetime.timezone.utc)
    return time.strftime("%Y-%m-%dT%H:%M:%S.250")

write("xy.csv", "t_s,sensor_id,x_m,y_m", lambda t, x, y, r, a: f"{t},0,{x},{y}")
write("polar.csv", "t_s,sensor_id,range_m,azimuth_deg", lambda t, x, y, r, a: f"{t},0,{r:.3f},{a:.5f}")
write("epoch.csv", "t_s,sensor_id,range_m,azimuth_deg",
      lambda t, x, y, r, a: f"{1709251170 + t}.25,0,{r:.3f},{a:.5f}")
write("european.csv", "\ufeffTime;Radar;Range [km];Azimuth [°];Remark",
      lambda t, x, y, r, a: f"{t},0;0;{r / 1000:.6f};{a:.5f};a, b".replace(".", ","))
write("tabs.tsv", "# a comment\nTime (s)\tRange [m]\tAzimuth (deg)",
      lambda t, x, y, r, a: f"{t}\t{r:.3f}\t{a:.5f}")
write("blanks.txt", "  TIME_MS   X    Y", lambda t, x, y, r, a: f"  {1000 * t}   {x}    {y}  ")
write("turns.csv", "t_s,sensor_id,range_m,azimuth_deg",
      lambda t, x, y, r, a: f"{t},0,{r:.3f},{a + 720:.5f}")
write("iso.csv", "timestamp,range,az_deg", lambda t, x, y, r, a: f"{iso(t)}Z,{r:.3f},{a:.5f}")
write("zone.csv", "timestamp,range,az_deg",
      lambda t, x, y, r, a: f"{iso(t + 19800)}+05:30,{r:.3f},{a:.5f}")
write("nautical.csv", "t_s,RANGE_NMI,Theta (deg)", lambda t, x, y, r, a: f"{t},{r / 1852:.9f},{a:.5f}")
write("plain_place.csv", "t_s,sensor_id,lat_deg,lon_deg",
      lambda t, x, y, r, a: f"{t},0,{50 + y / 111200:.8f},{8 + x / 71500:.8f}")
write("place.csv", "time;Latitude;lng",
      lambda t, x, y, r, a: f"{t};{50 + y / 111200:.8f};{8 + x / 71500:.8f}".replace(".", ","))
EOF

# A last digit differs where a unit is converted; tracks agree to a decimetre.
near() { # tracks, tracks
    python3 - "$@" <<'EOF'
import csv, sys
one, other = (list(csv.DictReader(open(name))) for name in sys.argv[1:])
assert len(one) == len(other) > 20
for a, b in zip(one, other):
    assert a["t_s"] == b["t_s"] and a["status"] == b["status"]
    assert abs(float(a["x_m"]) - float(b["x_m"])) < 0.1, (a, b)
    assert abs(float(a["y_m"]) - float(b["y_m"])) < 0.1, (a, b)
EOF
}

like() { # file, file in the program's own form, options...
    run track "$2" -o own.tracks.csv "${@:3}"
    run track "$1" -o tracks.csv "${@:3}"
    check "$1 is as $2" near own.tracks.csv tracks.csv
    run convert "$2" own.lcm "${@:3}"
    run convert "$1" other.lcm "${@:3}"
    run track other.lcm -o tracks.csv "${@:3}"
    check "$1 as a log, too" near own.tracks.csv tracks.csv
}

like european.csv polar.csv
like tabs.tsv polar.csv
like blanks.txt xy.csv
like turns.csv polar.csv
like nautical.csv polar.csv
like iso.csv epoch.csv
like zone.csv epoch.csv
like place.csv plain_place.csv --set origin_lat_deg=50 --set origin_lon_deg=8

# pi with six decimals is more than a half turn of float32
bearing='t_s,sensor_id,range_m,azimuth_rad\n'
printf "${bearing}1,1,5000,3.141593\n" >six.csv
printf "${bearing}1,1,5000,-3.1415923\n" >wrapped.csv
for name in six wrapped; do run convert "$name.csv" "$name.lcm"; run convert "$name.lcm" "$name.back.csv"; done
check 'pi with six decimals' cmp six.back.csv wrapped.back.csv

# ---- a known header stays as it is ----
printf 't_s,sensor_id,x_m,y_m,time,range_km,lat\n1,1,2,3,x,y,z\n' >extra.csv
run track extra.csv
check 'columns of other names beside a known header are ignored' exits 0

# ---- what is refused ----
refuse() { # name, LINE: what (a pattern), text as for printf
    # shellcheck disable=SC2059
    printf "$3" >bad.csv
    run track bad.csv
    check "$1" says 2 "rhotrack: bad.csv:$2"
}
refuse 'an angle without a unit is not guessed' \
    "1: no column 'azimuth_rad' (or azimuth, az); the file has: t_s, range_m, azimuth" \
    'time,range,azimuth\n1,2,3\n'
refuse 'a time of no calendar' "2: t_s '2024-13-01T00:00:00Z' is not a number" \
    'timestamp,x,y\n2024-13-01T00:00:00Z,1,2\n'
refuse 'a zone that is none' "2: t_s '2024-03-01T00:00:00X' is not a number" \
    'timestamp,x,y\n2024-03-01T00:00:00X,1,2\n'
refuse 'two decimal commas' "2: x_m '1,2,3' is not a number" 't_s;x;y\n1;1,2,3;2\n'
refuse 'a short row of blanks' '3: short row: 2 cells, the header has 3' 't_s x y\n1 2 3\n2 3\n'
refuse 'a unit that is not known' \
    "1: no column 'x_m' (or x); the file has: t_s, x_furlong, y_furlong" \
    'time,x_furlong,y_furlong\n1,2,3\n'
finish
