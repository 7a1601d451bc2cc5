#!/bin/bash
# SPDX-License-Identifier: MIT
# --show: what tracks and the papers' methods think, in logs of track and of node, from files and
# live; read by the Python that lcm-gen makes. Tracks are the same with it.
# shellcheck source=tests/integration/loopback.bash
. "$(dirname "$0")/loopback.bash"
root=$(realpath "$(dirname "$0")/../..")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

${LCM_GEN:-/usr/bin/lcm-gen} -p --ppath gen "$root"/lcm_types/*.lcm >/dev/null

cat >shown.py <<'PYTHON'
"""Messages of a log by channel, decoded: shown.py LOG EXPRESSION, which sees m and the log as c."""
import collections, struct, sys

sys.path.insert(0, "gen")
import rhotrack

TYPES = {"RHO_GHOSTS": rhotrack.ghost_matrix_t, "RHO_ACCUMULATOR": rhotrack.accumulator_t,
         "RHO_PLANE": rhotrack.plane_t, "RHO_HYPOTHESES": rhotrack.hypotheses_t,
         "RHO_TRACKS": rhotrack.track_list_t}

def read(path):
    data, at, found = open(path, "rb").read(), 0, collections.defaultdict(list)
    while at < len(data):
        _, _, _, channel, size = struct.unpack_from(">IqqII", data, at)
        at += 28
        name = data[at:at + channel].decode()
        body = data[at + channel:at + channel + size]
        at += channel + size
        if name in TYPES:
            found[name].append(TYPES[name].decode(body))
    return found

def same(a, b):
    """Two logs' messages, but for the boot number."""
    def plain(value):
        if isinstance(value, (list, tuple)):
            return [plain(one) for one in value]
        if hasattr(value, "__slots__"):
            return {name: plain(getattr(value, name)) for name in value.__slots__
                    if name != "epoch"}
        return value
    return all(plain(a[name]) == plain(b[name]) for name in TYPES if name != "RHO_TRACKS")

c = read(sys.argv[1])
ghosts, votes, planes, hypotheses = (c[name] for name in list(TYPES)[:4])
sys.exit(not eval(sys.argv[2]))
PYTHON
shown() { exits 0 && python3 shown.py "$@"; }

# Radar plots of little noise, and bearings of three sensors.
"$program" simulate crossing --seed 4 --set radars.0.sigma_m=0.3 --set duration_s=60 -o sharp
"$program" simulate passive-three --seed 3 -o passive
all=ghosts,votes,hypotheses

# ---- from files ----
run track sharp/plots.csv --config sharp/scenario.ini --pipeline paper -o plain.lcm
run track sharp/plots.csv --config sharp/scenario.ini --pipeline paper --show "$all" -o plots.lcm
check 'plots: accumulators of four scans' shown plots.lcm \
    'len(votes) > 5 and all(v.method == 4 and v.num_scans >= 4 for v in votes)'
check 'a plane in four parts each' shown plots.lcm \
    'len(planes) == 4 * len(votes) and max(max(r.votes) for p in planes for r in p.rows) == 127'
check 'the lines that start tracks are named' shown plots.lcm \
    '{x.track_id for v in votes for x in v.cells} - {0} == {t.track_id
    for l in c["RHO_TRACKS"] for t in l.tracks}'
check 'tracks start by truth, indeterminacy and falsity' shown plots.lcm \
    'any(h.evidence == 2 and h.support > 0.2 for h in hypotheses)'
check 'and have evidence of their plots' shown plots.lcm \
    '(any(h.evidence == 1 for h in hypotheses)
    and all(h.evidence == 0 or abs(h.support + h.shared + h.clutter - 1) < 1e-4
    for h in hypotheses))'
check 'no bearings, no ghosts' shown plots.lcm 'not ghosts'
for log in plain plots; do
    run convert "$log.lcm" "$log.csv" --kind tracks
    check "tracks of $log.lcm" exits 0
done
check 'tracks are the same' cmp plain.csv plots.csv
run plot tracks sharp/plots.csv plots.lcm -o plots.svg
check 'and can be drawn' exits 0

run track passive/bearings.csv --config passive/scenario.ini --pipeline paper --show "$all" \
    -o bearings.lcm
check 'bearings: a ghost matrix of each pair and frame' shown bearings.lcm \
    '(len(ghosts) == 3 * 8
    and {(g.sensor_a_id, g.sensor_b_id) for g in ghosts} == {(1, 2), (1, 3), (2, 3)})'
check 'ghosts say what they were pruned for' shown bearings.lcm \
    '(len({e.reason for g in ghosts for e in g.elements}) > 2
    and all(e.delta_rad > 0 for g in ghosts for e in g.elements if e.reason == 0))'
check 'accumulators of all pairs, and of each' shown bearings.lcm \
    '([v.has_pair for v in votes] == [0, 1, 1, 1] and votes[0].method == 5
    and votes[0].num_cells > 0)'

run track sharp/plots.csv --config sharp/scenario.ini --show hypotheses -o default.lcm
check 'the default method shows its hypotheses alone' shown default.lcm \
    '(len(hypotheses) > 10 and not votes and not planes
    and any(h.num_hypotheses > 1 for h in hypotheses))'
check 'whose models and shares add up to 1' shown default.lcm \
    'all(abs(h.calm + h.steady + h.maneuver - 1) < 1e-4
    and abs(sum(x.share for x in h.hypotheses) - 1) < 1e-4 for h in hypotheses)'

# 12 planes a second are too many: what is left out is counted and told.
awk -F, -v OFS=, 'NR > 1 { $1 /= 400 } { print }' sharp/plots.csv >fast.csv
run track fast.csv --method ht --set v_max_mps=20000 --show votes -o fast.lcm
check 'a rate is kept' shown fast.lcm \
    '50 <= len(votes) + len(planes) < 70 and votes[-1].not_sent >= 0'
check 'and what is left out is said' matches "$(cat stderr)" \
    '*messages of --show beyond its rate: *'

# ---- the node: a log, and live ----
run publish sharp/plots.csv passive/bearings.csv --speed 0 --lcm 'file://played.lcm?mode=w'
run node --lcm 'file://played.lcm?speed=0' --config sharp/scenario.ini --pipeline paper \
    --show "$all" --log first.lcm
run node --lcm 'file://played.lcm?speed=0' --config sharp/scenario.ini --pipeline paper \
    --show "$all" --log second.lcm
check 'a node shows all of it' shown first.lcm 'ghosts and votes and planes and hypotheses'
check 'the same each time' shown first.lcm 'same(c, read("second.lcm"))'

"$program" node --config sharp/scenario.ini --pipeline paper --show "$all" --set hold_ms=500 \
    --log live.lcm >/dev/null 2>live.err </dev/null &
node=$!
wait_until 5 test -s live.lcm
"$program" node --for 3 --log listener.lcm >/dev/null 2>listener.err </dev/null &
listener=$!
wait_until 5 test -s listener.lcm
run publish sharp/plots.csv --config sharp/scenario.ini --speed 50
sleep 0.7
kill -INT "$node"
status=0
wait "$node" || status=$?
check 'live, too' shown live.lcm 'votes and planes and hypotheses'
wait "$listener"
check 'another node does not take them for its own' matches "$(cat listener.err)" '*messages in*'
check 'nor for bad ones' test "$(grep -c 'wrong type\|bad' listener.err)" = 0

# ---- such a log is an input as any other ----
run node --lcm 'file://live.lcm?speed=0' --config sharp/scenario.ini --print
check 'a node reads it' exits 0
run publish live.lcm --speed 0 --lcm 'file://again.lcm?mode=w'
check 'publish plays it' shown again.lcm 'len(votes) == len(read("live.lcm")["RHO_ACCUMULATOR"])'
run track live.lcm --config sharp/scenario.ini
check 'track reads its plots' exits 0

# ---- refused ----
run track sharp/plots.csv --show gosts -o x.lcm
check 'an unknown word' says 2 "rhotrack: --show: 'gosts' is not ghosts, votes or hypotheses"
run track sharp/plots.csv --show votes, --method iht -o x.lcm
check 'an empty word' says 2 "rhotrack: --show: '' is not ghosts, votes or hypotheses"
run track sharp/plots.csv --show votes -o x.lcm
check 'votes of the default methods' says 2 \
    'rhotrack: --show votes: the methods kernel and passive have no accumulator; '\
'ht, mht, iht, nht and passive-paper have one (--method)'
run node --show ghosts --method iht --for 0.1
check 'ghosts of others than passive-paper' says 2 \
    'rhotrack: --show ghosts: of the methods only passive-paper has a ghost matrix '\
'(--method passive-paper or --pipeline paper)'
run track sharp/plots.csv --show hypotheses -o x.csv
check 'messages in CSV' says 2 'rhotrack: --show writes messages: it needs -o NAME.lcm'
run track sharp/plots.csv --show hypotheses
check 'and on standard output' says 2 'rhotrack: --show writes messages: it needs -o NAME.lcm'
check 'nothing is left behind' test ! -e x.lcm -a ! -e x.csv

finish
