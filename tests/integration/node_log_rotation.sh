#!/bin/bash
# SPDX-License-Identifier: MIT
# node --log over months: files of a size and of a time, the oldest ones removed, SIGHUP, a reader
# that follows, a log that is removed, a folder that is gone, a disk that is full for a while, and
# a terminal that is closed.
# shellcheck source=tests/integration/loopback.bash
. "$(dirname "$0")/loopback.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

# events.py FILE...: one line an event: its number, its time in s and its file; any byte that is no
# part of a whole event is an error.
cat >events.py <<'PYTHON'
import struct, sys
for name in sys.argv[1:]:
    data, at = open(name, "rb").read(), 0
    while at < len(data):
        sync, number, time, channel, size = struct.unpack_from(">IQqII", data, at)
        at += 28 + channel + size
        assert sync == 0xEDA1DA01 and at <= len(data), (name, at)
        print(number, time / 1e6, name)
PYTHON
# Numbers go on from 0 without a gap over all files, in this order.
is_whole() {
    python3 events.py "$@" >events && awk '$1 != NR - 1 { print; exit 1 } END { exit NR < 50 }' \
        events
}
stamp='-[0-9]*T[0-9]*.[0-9][0-9][0-9]Z.lcm'

"$program" simulate radar --set duration_s=600 --set radars.0.interval_s=2 -o scene
"$program" convert scene/plots.csv record.lcm
record() { # OPTIONS...
    run node --lcm 'file://record.lcm?speed=0' --config scene/scenario.ini "$@"
}

# ---- files of a size ----
mkdir sizes
record --log sizes/node.lcm --set log_file_mb=0.05
check 'a size: ends well' exits 0
# shellcheck disable=SC2086 # patterns
check 'a size: all events are there, in the order of the names' is_whole sizes/node$stamp \
    sizes/node.lcm
check 'a size: no file is larger' test -z "$(find sizes -size +50000c)"
check "a size: nor much smaller ($(find sizes -type f | wc -l) files)" test "$(find sizes -type f \
    -size -40000c | wc -l)" -le 3 -a "$(find sizes -type f | wc -l)" -gt 5
# shellcheck disable=SC2086
run convert "$(echo sizes/node$stamp | cut -d' ' -f2)" read.csv --kind tracks
check 'a size: each is a log of its own' exits 0

# ---- files of a time ----
mkdir times
record --log times/node.lcm --set log_file_s=60
# shellcheck disable=SC2086
check 'a time: all events are there' is_whole times/node$stamp times/node.lcm
check 'a time: each file has a minute of its own' awk '{ minute = int($2 / 60) }
    $3 == file && minute != last { exit 1 } $3 != file { files++ }
    { file = $3; last = minute } END { exit files != 10 }' events
check 'a time: names say when they begin' test -s times/node-19700101T000100.000Z.lcm

# ---- earlier files that are kept ----
mkdir kept
touch kept/node-19690101T000000.000.lcm kept/nodes-19690101T000000.000Z.lcm kept/node.lcm.txt
record --log kept/node.lcm --set log_file_s=60 --set log_files=2
check 'two are kept, and other names with them' matches "$(cd kept && echo *)" \
    'node-19690101T000000.000.lcm node-19700101T000700.000Z.lcm '\
'node-19700101T000800.000Z.lcm node.lcm node.lcm.txt nodes-19690101T000000.000Z.lcm'

# ---- the log of an earlier run ----
cp times/node.lcm before.lcm
record --log times/node.lcm --set log_file_s=3600
check 'a log with limits is not written over by the next run' cmp before.lcm \
    "$(find times -name 'node-20*')"
: >wrong
run node --log wrong --set log_file_mb=-1
check 'a size below 0' says 2 'rhotrack: --set log_file_mb=-1: log_file_mb -1 is outside *'

# ---- live ----
# start OPTIONS...: a node with the log live/node.lcm; $node is its process.
start() {
    rm -rf live
    mkdir -p live
    "$program" node --config scene/scenario.ini --log live/node.lcm "$@" 2>node.err </dev/null &
    node=$!
    wait_until 5 test -s live/node.lcm
}
stop() {
    kill -TERM "$node"
    status=0
    wait "$node" || status=$?
}
play() { run publish scene/plots.csv --speed "${1:-200}"; }

start
play
mv live/node.lcm live/first.lcm
kill -HUP "$node"
check 'SIGHUP opens the name again' wait_until 2 test -e live/node.lcm
play
kill -HUP "$node"
sleep 1.5
size=$(stat -c %s live/node.lcm)
check 'SIGHUP leaves a log that is there' test "$size" -gt 100000
stop
check 'and ends no node' exits 0
check 'nothing is lost by it' is_whole live/first.lcm live/node.lcm
start --set log_file_mb=0.1
cat >follow.py <<'PYTHON'
import glob, os, struct, time
def next_file(inode):
    """The one behind it, or None: it is still written, or the names have changed meanwhile."""
    earlier = sorted(glob.glob("live/node-*.lcm"))
    for i, name in enumerate(earlier):
        if os.stat(name).st_ino == inode:
            try:
                behind = open((earlier[i + 1:] + ["live/node.lcm"])[0], "rb")
            except FileNotFoundError:
                return None
            return behind if sorted(glob.glob("live/node-*.lcm")) == earlier else None
    return None
def events():
    here, behind, data = open("live/node.lcm", "rb"), None, b""
    open("follows", "w").close()
    while True:
        piece = here.read()
        data += piece
        while len(data) >= 28:
            _, number, _, channel, size = struct.unpack_from(">IQqII", data)
            if len(data) < 28 + channel + size:
                break
            data = data[28 + channel + size:]
            yield number
        if piece:
            continue
        if behind:
            assert not data, "half an event at the end of a file"
            here, behind = behind, None
            continue
        behind = next_file(os.fstat(here.fileno()).st_ino)
        if not behind:
            if os.path.exists("followed"):
                return
            time.sleep(0.002)
count = 0
for number in events():
    assert number == count, (number, count)
    count += 1
print(count)
PYTHON
python3 follow.py >follow.out 2>follow.err &
reader=$!
wait_until 10 test -e follows
play
sleep 1.2
touch followed
wait "$reader"
stop
check "a reader that follows misses nothing ($(cat follow.out follow.err) events, $(find live \
    -name 'node-*' | wc -l) files put away)" test "$(cat follow.out)" -gt 500 -a \
    "$(find live -name 'node-*' | wc -l)" -gt 3

# ---- removed ----
start
rm live/node.lcm
check 'a log that is removed begins anew' wait_until 4 test -s live/node.lcm
check 'which is said' grep -q 'Z rhotrack: live/node.lcm: was removed; the log begins anew$' \
    node.err
rm -r live
gone='live/node.lcm: No such file or directory; tracking goes on without the log; '
gone+='the next attempt is in 60 s'
check 'a folder that is gone is said' wait_until 4 grep -q "$gone" node.err
play
mkdir live
kill -HUP "$node"
check 'SIGHUP tries again' wait_until 3 test -s live/node.lcm
check 'and says so' wait_until 2 grep -q 'live/node.lcm: the log goes on$' node.err
stop
check 'exit 1: events are missing' exits 1
check 'tracks went on' grep -Eq ' [1-9][0-9]* tracks confirmed' node.err
check 'the events are counted' grep -Eq 'events not logged: [1-9]' node.err
check 'it was said once' test "$(grep -c 'goes on without' node.err)" -eq 1

# ---- files that cannot be put away: the log goes on in the same one ----
mkdir -p locked
if [ "$(id -u)" -ne 0 ] || unshare -m sh -c 'mount -t tmpfs none locked' 2>/dev/null; then
    # shellcheck disable=SC2016 # that shell's
    unshare -m bash -c 'mount -t tmpfs none locked && cp sizes/node.lcm locked &&
        mount --bind locked/node.lcm locked/node.lcm && # a mount is not renamed
        "$0" node --lcm "file://record.lcm?speed=0" --config scene/scenario.ini \
        --log locked/node.lcm --set log_file_mb=0.05; echo $? >code
        cp locked/node.lcm stays.lcm' "$program" 2>node.err
    check 'one that cannot be put away is said once' test "$(grep -c \
        'locked/node.lcm: cannot be renamed, or an earlier file cannot be removed: '\
'Device or resource busy' \
        node.err)" -eq 1
    earlier=$(stat -c %s sizes/node.lcm)
    check 'the log of an earlier run stays in it' cmp -n "$earlier" sizes/node.lcm stays.lcm
    tail -c +$((earlier + 1)) stays.lcm >added.lcm
    check 'and all events are added' is_whole added.lcm
else
    echo 'skipped: files that cannot be put away: no mounts here'
fi

# ---- a disk that is full for a while ----
if unshare -m sh -c 'mkdir -p disk && mount -t tmpfs -o size=64k none disk' 2>/dev/null; then
    # shellcheck disable=SC2016 # that shell's
    unshare -m bash -c 'mount -t tmpfs -o size=64k none disk && head -c 60000 /dev/zero >disk/other
        "$0" node --config scene/scenario.ini --log disk/node.lcm 2>node.err & node=$!
        until [ -s disk/node.lcm ]; do sleep 0.1; done
        "$0" publish scene/plots.csv --speed 200 2>/dev/null
        mount -o remount,size=8m disk
        kill -HUP $node; sleep 2.5; kill -TERM $node; wait $node
        cp disk/node.lcm filled.lcm' "$program" </dev/null
    check 'a full disk is said' grep -q \
        'disk/node.lcm: No space left on device; tracking goes on' node.err
    check 'and that the log goes on' grep -q 'disk/node.lcm: the log goes on$' node.err
    check 'all of its events are whole' python3 events.py filled.lcm
else
    echo 'skipped: a disk that is full for a while: no mounts here'
fi

# ---- a terminal that is closed ----
cat >terminal.py <<'PYTHON'
import os, pty, signal, sys, time
process, terminal = pty.fork()
if process == 0:
    os.execv(sys.argv[1], [sys.argv[1], "node", "--log", "terminal.lcm"])
while not os.path.exists("terminal.lcm") or os.path.getsize("terminal.lcm") == 0:
    time.sleep(0.05)
os.rename("terminal.lcm", "moved.lcm")
os.kill(process, signal.SIGHUP)
time.sleep(0.7)
print("stays" if os.waitpid(process, os.WNOHANG)[0] == 0 else "ended",
      os.path.exists("terminal.lcm"))
os.close(terminal)
time.sleep(1.0)
ended, code = os.waitpid(process, os.WNOHANG)
print("ended" if ended else "stays", code)
if not ended:
    os.kill(process, signal.SIGKILL)
PYTHON
check 'a node in a terminal takes SIGHUP, and ends with the terminal' matches \
    "$(python3 terminal.py "$program")" 'stays True
ended 0'

finish
