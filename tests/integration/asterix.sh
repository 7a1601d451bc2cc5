#!/bin/bash
# SPDX-License-Identifier: MIT
# ASTERIX: a simulated radar's plots as a recording come back as they were, are tracked as the CSV
# file is, by turns and by sectors; bad recordings; tracks as CAT062; live over UDP on the loopback.
tests=$(dirname "$(realpath "$0")")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
write="$tests/write_asterix.py"

run simulate polar -o sim --seed 2 --set settings.scan_interval_s=4 --set targets.0.count=20 \
    --set radars.0.sigma_range_rate_mps=1
python3 "$write" sim/plots.csv turns.ast
python3 "$write" sim/plots.csv norths.ast --sectors 1
python3 "$write" sim/plots.csv bare.ast --sectors 0
awk -F, -v OFS=, 'NR == 1 {for (i = 1; i <= NF; i++) if ($i == "range_rate_mps") rate = i}
    NR % 5 == 0 {$rate = ""} {print}' \
    sim/plots.csv >some.csv # as replies without Doppler are
python3 "$write" some.csv some.ast

# ---- The same plots ----
# Ranges to 1/512 NM, azimuths to half of 1/65536 turn, speeds to half a metre a second, times to
# 1/256 s and half a microsecond.
cat >same.py <<'PYTHON'
import csv, math, sys
def plots(path):
    return [row for row in csv.DictReader(open(path)) if row["range_m"]]
want, got = plots(sys.argv[1]), plots(sys.argv[2])
assert len(want) == len(got), (len(want), len(got))
def time(row):
    turn = (0.25 - float(row["azimuth_rad"]) / 2 / math.pi) % 1
    return 43200 + (math.floor(float(row["t_s"]) / 4 + 1e-9) + turn) * 4
want.sort(key=lambda row: (time(row), float(row["range_m"])))
for one, other in zip(want, sorted(got, key=lambda row: float(row["t_s"]))):
    close = [row for row in got if abs(float(row["t_s"]) - time(one)) <= 1 / 256 + 1e-6
             and abs(float(row["range_m"]) - float(one["range_m"])) <= 1852 / 512 + 0.01
             and abs(math.remainder(float(row["azimuth_rad"]) - float(one["azimuth_rad"]),
                                    2 * math.pi)) <= math.pi / 65536 + 1e-6
             and abs(float(row["range_rate_mps"]) - float(one["range_rate_mps"])) <= 0.5 + 1e-3]
    assert close, one
PYTHON
for name in turns norths bare; do
    run convert "$name.ast" "$name.csv"
    check "$name: convert ends well" exits 0
    check "$name: every plot is as it was sent, to the format's steps" python3 same.py \
        sim/plots.csv "$name.csv"
done
run convert turns.ast whole.csv --set asterix_scans=turn
check 'a turn is a scan where that is asked for, and begins with a row that saw nothing' \
    test "$(awk -F, 'NR > 1 && $3 == ""' whole.csv | wc -l)" -eq 15
cp turns.csv sectors.csv
check 'by sectors there are 32 a turn' test "$(awk -F, 'NR > 1 && $3 == ""' sectors.csv | wc -l)" \
    -eq 480
check 'each plot is in its sector, counter-clockwise from .. to' python3 -c '
import csv, math
for row in csv.DictReader(open("sectors.csv")):
    first, last = float(row["sector_from_rad"]), float(row["sector_to_rad"])
    assert abs((last - first) % (2 * math.pi) - math.pi / 16) < 1e-6
    if row["range_m"]:
        assert (float(row["azimuth_rad"]) - first) % (2 * math.pi) <= math.pi / 16 + 1e-6, row'
cp turns.ast no_ending
run convert no_ending no_ending.csv
check 'a recording is known by what is in it' cmp turns.csv no_ending.csv

# A recording that begins between the sectors of a turn, or in the first of them.
cat >begin.py <<'PYTHON'
import sys
data, at, left = open(sys.argv[1], "rb").read(), 0, int(sys.argv[3])
with open(sys.argv[2], "wb") as out:
    while at < len(data):
        size = int.from_bytes(data[at + 1:at + 3], "big")
        if data[at] != 34 or left == 0:
            out.write(data[at:at + size])
        else:
            left -= 1
        at += size
PYTHON
for missing in 1 10; do
    python3 begin.py turns.ast begun.ast "$missing"
    run convert begun.ast begun.csv
    check "without the first $missing sector messages: every plot is there" python3 same.py \
        sim/plots.csv begun.csv
    run track begun.ast --config sim/scenario.ini
    check '... and all tracks' grep -q ' scans, 1821 plots, 20 tracks confirmed' stderr
done
run convert begun.ast begun_turns.csv --set asterix_scans=turn
check '... by turns too' python3 same.py sim/plots.csv begun_turns.csv

# ---- The same tracks ----
run track turns.ast --config sim/scenario.ini -o turns.tracks.csv
check 'sectors: 20 targets, 20 tracks' grep -q '480 scans, 1821 plots, 20 tracks confirmed' stderr
for name in norths bare; do
    run track "$name.ast" --config sim/scenario.ini
    check "$name: 20 targets, 20 tracks" grep -q '15 scans, 1821 plots, 20 tracks confirmed' stderr
done
run track some.ast --config sim/scenario.ini
check 'a plot in five without Doppler: 20 targets, 20 tracks' grep -q \
    '480 scans, 1821 plots, 20 tracks confirmed' stderr
run track turns.csv --config sim/scenario.ini
check 'a recording is tracked as the CSV file that it converts to' writes_same_as turns.tracks.csv
run convert turns.ast turns.lcm
run track turns.lcm --config sim/scenario.ini
check 'and as the log' grep -q '480 scans, 1821 plots, 20 tracks confirmed' stderr
run track whole.csv --config sim/scenario.ini
check 'turns: 20 targets, 20 tracks' grep -q '15 scans, 1821 plots, 20 tracks confirmed' stderr
run initiate turns.ast --config sim/scenario.ini
check 'initiate reads recordings: of 15 turns the last' grep -q 'the last 7 of 15 scans' stderr
run initiate some.ast --config sim/scenario.ini
check 'also where sectors measure other things' grep -q 'the last 7 of 15 scans' stderr
cp turns.ast SHOUTED.AST
run track SHOUTED.AST --config sim/scenario.ini
check 'a name in capitals is the same' writes_same_as turns.tracks.csv
run convert turns.ast SHOUTED.LCM
run track SHOUTED.LCM --config sim/scenario.ini
check 'of outputs as well' grep -q '480 scans, 1821 plots, 20 tracks confirmed' stderr
run plot scans turns.ast -o turns.svg
check 'plot scans reads them' exits 0
run track turns.ast --follow
check 'follow does not' says 2 \
    'rhotrack: turns.ast: --follow takes CSV files, but this is an ASTERIX recording'

# ---- As the network carried it ----
capture="$tests/write_capture.py"
python3 "$capture" turns.ast plain.pcap
python3 "$capture" turns.ast tagged.pcapng --vlan --noise
python3 "$capture" turns.ast cooked.pcap --link cooked --noise
python3 "$capture" turns.ast raw.pcapng --link raw --ipv6
for name in plain.pcap tagged.pcapng cooked.pcap raw.pcapng; do
    run track "$name" --config sim/scenario.ini
    check "$name: the tracks of the recording" writes_same_as turns.tracks.csv
done
run convert tagged.pcapng tagged.csv
check 'convert reads them as well' cmp turns.csv tagged.csv
check 'datagrams of other content are counted' grep -qx \
    'rhotrack: tagged.pcapng: [1-9][0-9]* datagrams that are not ASTERIX left out' stderr
check 'and those of which a part is missing' grep -qx \
    'rhotrack: tagged.pcapng: [1-9][0-9]* datagrams left out: fragments, or truncated' stderr
cp tagged.pcapng no_name
run convert no_name no_name.csv
check 'a network recording is known by what is in it' cmp turns.csv no_name.csv
head -c 100000 plain.pcap >cut.pcap
run convert cut.pcap cut.csv
check 'one that ends within a packet' says 2 'rhotrack: cut.pcap: after packet [0-9]*: truncated *'
check 'leaves nothing behind' test ! -e cut.csv
run convert cut.pcap cut.csv --keep-going
check 'and gives what there is with --keep-going' exits 0
check 'and says so, once' test "$(grep -Ec \
    '^rhotrack: cut.pcap: after packet [0-9]+: .*; the rest is left out$' stderr)" = 1
printf '\60\0\10\377\377\377\0\0' | cat turns.ast - >bad_end.ast
python3 "$capture" bad_end.ast bad.pcap
run convert bad.pcap bad.csv
check 'a bad record has its packet and byte' says 2 \
    'rhotrack: bad.pcap: packet 2318, byte 7 of its content: I048/010 goes beyond its data block'
printf '\324\303\262\241no' >no.pcap
run track no.pcap
check 'no recording at all' says 2 'rhotrack: no.pcap: the network recording cannot be read: *'
printf '\241\262\303\324\0\2\0\4\0\0\0\0\0\0\0\0\0\0\377\377\0\0\0\151' >air.pcap
run track air.pcap
check 'nor one of a link that is not read' says 2 \
    'rhotrack: air.pcap: packets of link type IEEE802_11 cannot be read'

# ---- Places ----
python3 "$write" sim/plots.csv placed.ast --place 47.5,8.5,430 --sac 200 --sic 7
run convert placed.ast placed.csv
check 'the radar is at its place, and has its number' grep -q \
    '^43200.000000,-14329,,,,,47.49999[0-9]*,8.50000[0-9]*,430,' placed.csv
run track placed.ast --config sim/scenario.ini -o placed.tracks.csv
check 'which is the origin where nobody sets one' grep -q '20 tracks confirmed' stderr
origin='rhotrack: placed.ast: the origin is origin_lat_deg=47.4999905, origin_lon_deg=8.5000062, '\
'origin_alt_m=430'
check 'and told' grep -qx "$origin" stderr
for name in y.ast y.geojson; do
    run convert placed.ast $name
    check "it is no list of tracks: $name" says 2 \
        'rhotrack: placed.ast: a recording of radar plots, not of tracks; *'
done
run convert placed.ast placed.csv
check 'by convert too' grep -qx "$origin" stderr
run track placed.ast --config sim/scenario.ini --json
check 'and in JSON' json stdout '(abs(o["origin"]["lat_deg"] - 47.5) < 2e-5
    and abs(o["origin"]["lon_deg"] - 8.5) < 2e-5 and o["origin"]["alt_m"] == 430)'
run track turns.ast --config sim/scenario.ini --json
check 'where there is one' json stdout 'o["origin"] is None'
check 'so that tracks are where they were' python3 -c '
import csv
pairs = zip(csv.DictReader(open("placed.tracks.csv")), csv.DictReader(open("turns.tracks.csv")),
            strict=True)
assert all(a["track_id"] == b["track_id"] and abs(float(a[name]) - float(b[name])) < 0.5
           for a, b in pairs for name in ("x_m", "y_m"))'
run track placed.ast --config sim/scenario.ini --set origin_lat_deg=47 --set origin_lon_deg=8.5 \
    -o south.tracks.csv
check 'another origin moves them by 55.6 km' python3 -c '
import csv
pairs = zip(csv.DictReader(open("placed.tracks.csv")), csv.DictReader(open("south.tracks.csv")))
assert all(abs(float(b["y_m"]) - float(a["y_m"]) - 55588) < 300 for a, b in pairs)'

# A radar that does not say where it stands, beside one that does, in one file or two.
python3 "$write" sim/plots.csv lost.ast --sac 200 --sic 8
cat placed.ast lost.ast >pair.ast
lost='sensor -14328 reports no position and is assumed at the origin; '\
'set sensor.-14328.lat_deg and lon_deg'
for command in track register; do
    run "$command" placed.ast lost.ast --config sim/scenario.ini
    check "$command names a radar without a place" grep -qx "rhotrack: lost.ast: $lost" stderr
done
run convert pair.ast pair.csv --keep-going
check 'so does convert' grep -qx "rhotrack: pair.ast: $lost" stderr
run track placed.ast lost.ast --config sim/scenario.ini --set sensor.-14328.lat_deg=47.5 \
    --set sensor.-14328.lon_deg=8.6
check 'not where the parameters say it' bash -c '! grep -q "where it stands" stderr'
run track lost.ast --config sim/scenario.ini
check 'nor of one radar alone' bash -c '! grep -q "where it stands" stderr'

# ---- Tracks as CAT062 ----
run track turns.ast --config sim/scenario.ini -o tracks.ast --set asterix_sac=25 --set asterix_sic=9
check 'tracks are written' exits 0
cat >cat062.py <<'PYTHON'
import csv, sys
rows = list(csv.DictReader(open(sys.argv[2])))
data, at, records = open(sys.argv[1], "rb").read(), 0, []
def signed(data):
    return int.from_bytes(data, "big", signed=True)
while at < len(data):
    size = int.from_bytes(data[at + 1:at + 3], "big")
    assert data[at] == 62 and 3 < size <= 1400
    end, at = at + size, at + 3
    while at < end:
        spec = []
        while True:
            byte = data[at]; at += 1
            spec += [byte >> (7 - i) & 1 for i in range(7)]
            if not byte & 1:
                break
        have = {i + 1 for i, there in enumerate(spec) if there}
        sizes = {1: 2, 4: 3, 5: 8, 6: 6, 7: 4, 8: 2, 12: 2, 18: 2, 20: 2, 27: 7}
        item = {}
        for place in sorted(have):
            n = sizes.get(place)
            if place == 13:
                n = 1
                while data[at + n - 1] & 1:
                    n += 1
            item[place] = data[at:at + n]; at += n
        records.append(item)
live = [item for item in records if not (len(item[13]) > 1 and item[13][1] & 0x40)]
assert len(live) == len(rows), (len(live), len(rows))
for item, row in zip(live, rows):
    assert tuple(item[1]) == (25, 9)
    assert abs(int.from_bytes(item[4], "big") / 128 - float(row["t_s"])) <= 1 / 256 + 1e-6
    assert int.from_bytes(item[12], "big") == int(row["track_id"]) % 65536
    assert bool(item[13][0] & 2) == (row["status"] == "tentative")
    assert (len(item[13]) > 3 and item[13][3] >> 7) == (row["status"] == "coasting")
    for name, data_of, unit in (("x_m", item[6][:3], 0.5), ("y_m", item[6][3:], 0.5),
                                ("vx_mps", item[7][:2], 0.25), ("vy_mps", item[7][2:], 0.25)):
        assert abs(signed(data_of) * unit - float(row[name])) <= unit / 2 + 1e-4, (name, row)
firsts = sum(len(item[13]) > 1 and item[13][1] >> 5 & 1 for item in records)
assert firsts == len({row["track_id"] for row in rows}), firsts
print(len(records) - len(live), "ends")
PYTHON
check 'each row of the tracks is a record of the same' python3 cat062.py tracks.ast turns.tracks.csv
run track turns.ast --config sim/scenario.ini --covariance -o covariance.csv
run convert covariance.csv converted.ast --set asterix_sac=25 --set asterix_sic=9
check 'convert writes the same' cmp tracks.ast converted.ast
run track placed.ast --config sim/scenario.ini -o placed.tracks.ast
check 'with an origin there are latitudes as well' test "$(wc -c <placed.tracks.ast)" -gt \
    "$(wc -c <tracks.ast)"
if python3 -c 'import asterix.generated' 2>/dev/null; then
    for name in tracks placed.tracks turns norths; do
        check "libasterix reads $name.ast" python3 "$tests/../vectors/make_asterix_vectors.py" \
            --check "$name.ast"
    done
else
    echo 'skipped: libasterix is not installed (its records are in tests/vectors/asterix_vectors.h)'
fi
for command in 'track turns.ast -o' 'convert covariance.csv'; do
    run $command covariance.ast --covariance
    check "$command: no covariances in CAT062" says 2 \
        'rhotrack: covariance.ast: CAT062 cannot hold covariances (--covariance); '\
'it has standard deviations (I062/500) in any case'
    check "$command: no file" test ! -e covariance.ast
done
no_tracks='contains tracks (CAT062), but plots are needed; '\
'evaluate, plot, convert and publish take tracks'
cp tracks.ast nameless
for command in track initiate maintain calibrate; do
    run $command tracks.ast
    check "$command: tracks are no plots" says 2 "rhotrack: tracks.ast: $no_tracks"
    run $command nameless
    check "$command: by any name" says 2 "rhotrack: nameless: $no_tracks"
done

# ---- Tracks from CAT062 ----
run convert tracks.ast back.csv
check 'tracks come back as they were, to the steps of CAT062' \
    python3 - turns.tracks.csv back.csv <<'PYTHON'
import csv, sys
want, got = (list(csv.DictReader(open(path))) for path in sys.argv[1:])
ends = [row for row in got if row["status"] == "deleted"]
got = [row for row in got if row["status"] != "deleted"]
assert len(got) == len(want) > 100, (len(got), len(want), len(ends))
steps = {"t_s": 1 / 256 + 1e-6, "x_m": .2501, "y_m": .2501, "vx_mps": .1251, "vy_mps": .1251}
for one, other in zip(want, got):
    assert (one["status"] == other["status"]
            and int(one["track_id"]) % 65536 == int(other["track_id"]))
    assert all(abs(float(one[name]) - float(other[name])) <= step for name, step in steps.items())
PYTHON
check 'and nothing is said' test ! -s stderr
awk -F, -v OFS=, 'NR > 1 { $1 = sprintf("%.6f", $1 + 43200) } { print }' sim/truth.csv >noon.csv
run evaluate noon.csv turns.tracks.csv --json --set time_tolerance_s=4
mv stdout of_csv
for name in tracks.ast nameless; do
    run evaluate noon.csv $name --json --set time_tolerance_s=4
    check "evaluate $name" python3 - of_csv stdout <<'PYTHON'
import json, sys
want, got = (json.load(open(path)) for path in sys.argv[1:])
for name in ("targets_found", "switches", "pairs", "tracks"):
    assert want[name] == got[name], (name, want[name], got[name])
assert abs(want["gospa_m"] - got["gospa_m"]) < 1 and abs(want["rmse_m"] - got["rmse_m"]) < 1
PYTHON
done
run convert tracks.ast tracks.lcm
run convert tracks.lcm tracks.lcm.csv
check 'tracks as messages' test "$(grep -c confirmed tracks.lcm.csv)" -eq \
    "$(grep -c confirmed back.csv)"
run plot tracks sim/plots.csv tracks.ast -o tracks.svg
check 'a picture of them' grep -Eq '[1-9][0-9]* tracks' tracks.svg
origin='--set origin_lat_deg=50 --set origin_lon_deg=8'
# shellcheck disable=SC2086
run convert tracks.ast tracks.geojson $origin
check 'a map of them' json tracks.geojson 'len(o["features"]) > 10'
cat turns.ast tracks.ast >mixed.ast
run track mixed.ast --config sim/scenario.ini -o mixed.csv
check 'plots and tracks in one recording: plots are tracked' cmp mixed.csv turns.tracks.csv
check 'and the tracks are counted' grep -Eq \
    '^rhotrack: mixed.ast: CAT062 left out: [0-9]+ records in [0-9]+ blocks; these are tracks$' \
    stderr
run evaluate noon.csv mixed.ast --json --set time_tolerance_s=4
check 'its tracks are evaluated' json stdout 'o["targets_found"] > 15'
check 'and the plots are counted, a line a category' test "$(grep -Ec \
    '^rhotrack: mixed.ast: CAT0(34|48) left out: [0-9]+ records in [0-9]+ blocks$' stderr)" -eq 2

# By hand, from EUROCONTROL-SPEC-0149-9: SAC 1, SIC 2, 23:59:59.5 and 00:00:00.5 of the next day,
# track 7, confirmed and then the end of it; 105: 50.25 N 8.5 E; 185: 100, -50.25 m/s; 130: 3048 m.
python3 - <<'PYTHON'
import struct
def record(time, status):
    place = struct.pack(">ii", round(50.25 * 2 ** 25 / 180), round(8.5 * 2 ** 25 / 180))
    return b"\x9b\x0d\x10" + bytes((1, 2)) + time.to_bytes(3, "big") + \
        place + struct.pack(">hh", 400, -201) + b"\x00\x07" + status + struct.pack(">h", 1600)
data = record(86399 * 128 + 64, b"\x00") + record(64, b"\x01\x40")
open("hand.ast", "wb").write(b"\x3e" + struct.pack(">H", len(data) + 3) + data)
PYTHON
# shellcheck disable=SC2086
run convert hand.ast hand.csv $origin
check 'by hand: times, identities, status' test \
    "$(tail -n +2 hand.csv | cut -d, -f1-3 | tr '\n' ' ')" = \
    '86399.500000,7,confirmed 86400.500000,7,deleted '
check 'by hand: place, velocity, source' python3 - <<'PYTHON'
import csv
row = next(csv.DictReader(open("hand.csv")))
x, y, z = (float(row[name]) for name in ("x_m", "y_m", "z_m"))
assert abs(x - 35620) < 80 and abs(y - 27900) < 150 and abs(z - (3048 - 160)) < 40, (x, y, z)
assert float(row["vx_mps"]) == 100 and float(row["vy_mps"]) == -50.25 and row["sensor_id"] == "258"
PYTHON
run convert hand.ast hand.csv
check 'by hand: without an origin' says 2 \
    'rhotrack: hand.ast: its tracks (CAT062) have positions in latitude and longitude only '\
'(I062/105): origin_lat_deg *'
head -c 40 hand.ast >hand_cut.ast
run evaluate sim/truth.csv hand_cut.ast
check 'by hand: a cut one is refused with its byte' grep -q '^rhotrack: hand_cut.ast: byte ' stderr

run convert sim/plots.csv polar.ast
check 'plots are no tracks' says 2 \
    'rhotrack: sim/plots.csv: contains no tracks, and CAT062 holds only tracks'
check 'and leave no file' test ! -e polar.ast

# ---- Bad recordings ----
refused() { # name, bytes as printf has them, message
    printf "$2" >"$1.ast"
    run convert "$1.ast" "$1.out.csv"
    check "$1: refused with its byte" says 2 "rhotrack: $1.ast: $3"
    check "$1: no output" test ! -e "$1.out.csv"
    run track "$1.ast"
    check "$1: track says the same" says 2 "rhotrack: $1.ast: $3"
}
good='\x30\x00\x0e\xf0\x00\x01\x00\x10\x00\x20\x10\x00\x20\x00'
refused empty '' 'byte 0: the file is empty'
refused short "$good\\x30" 'byte 14: a data block has at least 3 bytes, but only 1 are left'
refused cut "$good\\x30\\x00\\x0e\\xf0" \
    'byte 14: a data block of category 48 has 14 bytes, but only 4 are left'
refused length "$good\\x30\\x00\\x02" \
    'byte 15: a data block of category 48 has an invalid length of 2 bytes'
refused overrun "$good\\x30\\x00\\x06\\xf0\\x00\\x01" 'byte 20: I048/140 goes beyond its data block'
refused beyond "$good\\x22\\x00\\x06\\x01\\x01\\x80" \
    'byte 17: the field specification of a record of CAT034 has 3 bytes'
refused other '\x3f\x00\x04\x00' \
    'contains no plot (CAT048, CAT001), north marker or sector crossing (CAT034, CAT002)'
run_piped() { # file, arguments: as run, the file on standard input
    status=0
    "$program" "${@:2}" <"$1" >stdout 2>stderr || status=$?
}
piped='ASTERIX on standard input or through a pipe; it is read twice: give it as a file'
run_piped turns.ast track -
check 'on standard input' says 2 "rhotrack: standard input:1: $piped"
mkfifo pipe
cat turns.ast >pipe &
run track pipe
wait $!
check 'through a pipe' says 2 "rhotrack: pipe:1: $piped"
run_piped turns.lcm track -
check 'a log' says 2 \
    'rhotrack: standard input:1: an LCM log on standard input or through a pipe: give it as a file'
head -c 8 turns.ast >cut
run track cut
check 'a bad first block and no ending' says 2 \
    'rhotrack: cut:1: ASTERIX with a bad first block: rename it to NAME.ast to see where'
run track nowhere.ast
check 'a file that is not there' says 2 'rhotrack: nowhere.ast: No such file or directory'

# Each byte of a recording, one after the other, as another one: never anything but an error with a
# place, or plots.
head -c 600 turns.ast >start.ast
python3 - <<'PYTHON'
data = open("start.ast", "rb").read()
at = 0
while at + 3 <= len(data) and at + int.from_bytes(data[at + 1:at + 3], "big") <= len(data):
    at += int.from_bytes(data[at + 1:at + 3], "big")
open("start.ast", "wb").write(data[:at])
PYTHON
bad=0
for at in $(seq 0 19 580); do
    python3 -c 'import sys
data = bytearray(open("start.ast", "rb").read()); data[int(sys.argv[1]) % len(data)] ^= 0xff
open("changed.ast", "wb").write(data)' "$at"
    run convert changed.ast changed.csv
    [ "$status" -eq 0 ] ||
        { [ "$status" -eq 2 ] && grep -qE '^rhotrack: changed.ast: byte [0-9]+: ' stderr; } ||
        bad=$((bad + 1))
    run convert changed.ast changed.csv --keep-going
    [ "$status" -eq 0 ] || bad=$((bad + 1))
done
check 'changed bytes: an error with its byte or plots; with --keep-going always plots' test "$bad" \
    -eq 0

# A bad record in the middle, and a block whose length is wrong: the rest comes, and is counted.
python3 - <<'PYTHON'
data = open("turns.ast", "rb").read()
blocks, at = [], 0
while at < len(data):
    size = int.from_bytes(data[at + 1:at + 3], "big")
    blocks.append(data[at:at + size]); at += size
middle = next(i for i in range(1000, 2000) if blocks[i][0] == 48)
bad = list(blocks); bad[middle] = bad[middle][:4] + b"\xff" * (len(bad[middle]) - 4)
open("bad_record.ast", "wb").write(b"".join(bad))
bad[middle] = b"\x30\x00\x01garbage"
open("bad_length.ast", "wb").write(b"".join(bad))
open("with_others.ast", "wb").write(b"".join(
    blocks[:middle] + [b"\x3e\x00\x0b\x90\x00\x01\x00\x00\x80\x00\x01",
                       b"\x15\x00\x05ab", b"\x15\x00\x03"] + blocks[middle:]))
PYTHON
for name in bad_record bad_length; do
    run convert "$name.ast" "$name.csv"
    check "$name: refused" bash -c \
        '[ '"$status"' -eq 2 ] && grep -qE "^rhotrack: '"$name"'.ast: byte [0-9]+: " stderr'
    run convert "$name.ast" "$name.csv" --keep-going
    check "$name: with --keep-going one plot less" test \
        "$(awk -F, '$3 != ""' "$name.csv" | wc -l)" -eq 1821
    check "$name: which is said" grep -qE \
        "^rhotrack: $name.ast: [0-9]+ bytes skipped at 1 bad places" stderr
done
run convert with_others.ast with_others.csv
check 'other categories are left out, a line each' diff - stderr <<'LINES'
rhotrack: with_others.ast: CAT021 left out: 2 blocks
rhotrack: with_others.ast: CAT062 left out: 2 records in 1 blocks; these are tracks
LINES
check 'and change nothing' cmp with_others.csv turns.csv

# ---- CAT001 and CAT002 ----
# As the same plots in CAT048, but for ranges in 1/128 NM and times without multiples of 512 s.
sed 's/and abs(float(row\["range_rate_mps.*/]/; s/1852 \/ 512/1852 \/ 256/' same.py >same_old.py
for kind in plots tracks; do
    for sectors in 32 1 0; do
        name=old_${kind}_$sectors
        python3 "$write" sim/plots.csv $name.ast --old $kind --sectors $sectors
        run convert $name.ast $name.csv
        check "$name: convert ends well" exits 0
        if [ $sectors -gt 0 ]; then
            check "$name: every plot is as it was sent" python3 same_old.py sim/plots.csv $name.csv
        fi
        run track $name.ast -o $name.tracks.csv --json
        check "$name: its targets have tracks" json stdout '17 <= o["tracks_confirmed"] <= 23'
    done
    check "$kind: without CAT002 plots become turns, and it is said" grep -q \
        "old_${kind}_0.ast: sensor 1: the rows of a turn .* turns of \(4\|4.00.\|3.99.\) s "\
"by azimuth, clockwise" stderr
    check "$kind: and each line once" test -z "$(sort stderr | uniq -d)"
done
check 'by sectors there are 32 a turn, too' test \
    "$(awk -F, 'NR > 1 && $3 == ""' old_plots_32.csv | wc -l)" -eq 480
python3 "$write" sim/plots.csv midnight.ast --old plots --start 86390
run convert midnight.ast midnight.csv
check 'times go on at midnight, and every 512 s' python3 - <<'PYTHON'
import csv
times = [float(row["t_s"]) for row in csv.DictReader(open("midnight.csv"))]
assert times == sorted(times) and 86389 < times[0] < 86391 and 86445 < times[-1] < 86455, times[-1]
PYTHON
cp old_plots_32.ast old
run convert old old.csv
check 'known by what is in it' cmp old.csv old_plots_32.csv
for name in old_plots_32 old_tracks_32; do
    head -c 20000 $name.ast >cut.ast
    run convert cut.ast cut.csv
    check "$name: a cut one is refused with its byte" grep -q '^rhotrack: cut.ast: byte [0-9]*: ' \
        stderr
done
if python3 -c 'import asterix.generated' 2>/dev/null; then
    for name in old_plots_32 old_tracks_32; do
        check "$name: libasterix reads it" python3 "$tests/../vectors/make_asterix_vectors.py" \
            --check $name.ast
    done
fi

# ---- Live ----
cat >play.py <<'PYTHON'
import socket, sys, time
data, at = open(sys.argv[1], "rb").read(), 0
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
out.sendto(b"\x30\x00\x02", (sys.argv[2], int(sys.argv[3])))
for count in range(10 ** 6):
    if at >= len(data):
        break
    size = int.from_bytes(data[at + 1:at + 3], "big")
    out.sendto(data[at:at + size], (sys.argv[2], int(sys.argv[3])))
    at += size
    if count % 20 == 0:
        time.sleep(0.002)
PYTHON
port=$((20000 + $$ % 20000))
"$program" publish "udp://127.0.0.1:$port" --lcm 'file://live.lcm?mode=w' --set sensor.1.x_m=0 \
    --for 60 >live.out 2>live.err &
live=$!
for _ in $(seq 100); do
    ss -lun 2>/dev/null | grep -q ":$port " && break
    grep -q "$(printf '%04X' "$port")" /proc/net/udp && break
    sleep 0.1
done
python3 play.py turns.ast 127.0.0.1 "$port"
sleep 1
kill -INT "$live"
wait "$live"
check 'publish udp:// ends well' test $? -eq 0
check 'it counted all plots, one bad datagram' grep -q \
    '1 datagrams used up to an error in them' live.err
check 'and sent all sectors' grep -q '2318 datagrams, 1821 plots of 1 radars, 480 scans sent' \
    live.err
run convert live.lcm live.csv
check 'the messages have the plots of the recording, at times of today' python3 -c '
import csv
def plots(path):
    return [row for row in csv.DictReader(open(path)) if row["range_m"]]
one, other = plots("turns.csv"), plots("live.csv")
assert len(one) == len(other)
for a, b in zip(one, other):
    assert ((float(a["t_s"]) - float(b["t_s"])) % 86400 < 1e-3
            or (float(b["t_s"]) - float(a["t_s"])) % 86400 < 1e-3)
    assert abs(float(a["range_m"]) - float(b["range_m"])) < 0.01'
run track live.lcm --config sim/scenario.ini
check 'and are tracked' grep -q '20 tracks confirmed' stderr
run publish udp://127.0.0.1
check 'a URL without a port' says 2 \
    'rhotrack: udp://127.0.0.1: udp://ADDRESS:PORT is needed, with a port from 1 to 65535'
run publish "udp://127.0.0.1:$port" --speed 2
check 'another speed than that of now' says 2 \
    "rhotrack: publish: udp://127.0.0.1:$port is a live input, and --speed is for files"
cp turns.lcm kept.lcm
run publish udp://radar:8600 --lcm 'file://kept.lcm?mode=w'
check 'a bad URL leaves the log as it was' cmp turns.lcm kept.lcm
run publish cut --lcm 'file://kept.lcm?mode=w'
check 'so does a bad input' cmp turns.lcm kept.lcm
run publish turns.csv --lcm 'file://kept.lcm?mode=w' --speed 0
check 'a good one takes its place' bash -c '! cmp -s turns.lcm kept.lcm'
run publish udp://radar:8600
check 'a name' says 2 "rhotrack: udp://radar:8600: 'radar' is not an IPv4 address"

finish
