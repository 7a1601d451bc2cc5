#!/bin/bash
# SPDX-License-Identifier: MIT
# node with --snapshot and --clutter-map on disks that are full, read-only, gone or slow, at its
# start and while it runs: tracks go on, each failure and its end is said once, and the last good
# files stay. What is written is on the disk before it gets its name.
# shellcheck source=tests/integration/network.bash
. "$(dirname "$0")/network.bash"
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
export LCM_DEFAULT_URL=$lcm_url
trap 'kill $(jobs -p) 2>/dev/null; umount -l disk 2>/dev/null; rm -rf "$folder"' EXIT

# The node's minutes are seconds: its monotonic clock goes 60 times as fast. While there is a file
# `slow`, fsync waits. The file `calls` has what each process syncs and renames.
cat >minutes.c <<'C'
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
static void note(const char *what)
{
    const int file = open(CALLS, O_WRONLY | O_CREAT | O_APPEND, 0666);
    dprintf(file, "%d %s\n", (int)getpid(), what);
    close(file);
}
int clock_gettime(clockid_t clock, struct timespec *now)
{
    const long result = syscall(SYS_clock_gettime, clock, now);
    if (clock == CLOCK_MONOTONIC) {
        const long long ns = (now->tv_sec * 1000000000LL + now->tv_nsec) * 60;
        now->tv_sec = ns / 1000000000;
        now->tv_nsec = ns % 1000000000;
    }
    return (int)result;
}
int fsync(int file)
{
    struct stat status;
    while (access(SLOW, F_OK) == 0) {
        usleep(10000);
    }
    fstat(file, &status);
    note(S_ISDIR(status.st_mode) ? "folder" : "file");
    return (int)syscall(SYS_fsync, file);
}
int rename(const char *from, const char *to)
{
    note("rename");
    return (int)syscall(SYS_renameat, AT_FDCWD, from, AT_FDCWD, to);
}
C
if ! gcc -shared -fPIC -DCALLS="\"$folder/calls\"" -DSLOW="\"$folder/slow\"" -o minutes.so \
    minutes.c 2>/dev/null; then
    echo 'skipped: state_on_bad_disks.sh: no gcc here'
    finish
fi

"$program" simulate range-24ghz -o scene --set duration_s=60 >/dev/null
# The counts of steps in the network's RHO_WORK, in the file steps.
cat >listen.py <<'PYTHON'
import os, socket, struct
here = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
here.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
here.bind(("239.255.76.67", 7667))
here.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                socket.inet_aton("239.255.76.67") + socket.inet_aton("127.0.0.1"))
open("listens", "w").close()
while True:
    data = here.recv(65536)
    if data[8:17] == b"RHO_WORK\0":
        with open("steps.new", "w") as out:
            print(struct.unpack(">Qqii8q", data[17:])[4], file=out)
        os.rename("steps.new", "steps")
PYTHON
python3 listen.py &
wait_until 10 test -e listens
"$program" publish scene/plots.csv --config scene/scenario.ini --speed 15 --loop 2>/dev/null &

# start OPTIONS...: a node that steps when it returns; $node is its process.
start() {
    rm -f steps
    LD_PRELOAD=./minutes.so "$program" node --config scene/scenario.ini --set hold_ms=500 "$@" \
        2>node.err </dev/null &
    node=$!
    wait_until 10 has_stepped 0
}
has_stepped() { [ "$(cat steps)" -gt "$1" ]; }
end_node() {
    kill -TERM "$node"
    status=0
    wait "$node" || status=$?
    cp node.err stderr
}
goes_on() { # NAME
    local before
    before=$(cat steps)
    check "$1: the node lives" kill -0 "$node"
    check "$1: tracks go on" wait_until 10 has_stepped $((before + 20))
}
said() { grep -c -- "$1" node.err; } # PATTERN: in how many lines
is_newer() { [ "$1" -nt stamp ]; }
# Both files are written anew from now on.
are_saved() {
    touch stamp
    sleep 0.05
    wait_until 10 is_newer disk/state/snapshot && wait_until 10 is_newer disk/state/map
}
are_kept() { cmp disk/state/snapshot good.snapshot && cmp disk/state/map good.map; }
# failing NAME REASON: a fault that is there for some of the node's minutes
failing() {
    check "$1: the snapshot is said not to be written" wait_until 10 grep -q \
        " rhotrack: disk/state/snapshot: $2; the snapshot is not written$" node.err
    check "$1: the clutter map, too" wait_until 10 grep -q \
        " rhotrack: disk/state/map: $2; the clutter map is not written$" node.err
    goes_on "$1"
    sleep 2.5
    check "$1: each is said once" test "$(said ": $2; the")" -eq 2
}
working() { # NAME, how often before
    check "$1: the end is said" wait_until 10 ends_said $((2 * ($2 + 1)))
    check "$1: both are written again" are_saved
    check "$1: nothing unfinished is left" wait_until 5 has_no_part
}
has_no_part() { [ -z "$(find disk/state -name '*.part')" ]; }
ends_said() { [ "$(said 'is written again$')" -eq "$1" ]; }
keep_good() {
    cp disk/state/snapshot good.snapshot
    cp disk/state/map good.map
}

mkdir disk
mount -t tmpfs -o size=40m none disk
mkdir disk/state
start --snapshot disk/state/snapshot --clutter-map disk/state/map
check 'a good disk: both are written' are_saved
is_synced_in_order() { # each process: the file, its name, the folder; it may be under way
    awk '{ did[$1] = did[$1] " " $2 }
         END { for (i in did) { whole += did[i] == " file rename folder"
                                if (index(" file rename folder", did[i]) != 1) { exit 1 } }
               exit whole < 2 }' calls || { cat calls; return 1; }
}
check 'a good disk: file, name and folder are synced in this order' is_synced_in_order

# ---- full: whatever becomes free is taken, too ----
touch fill
while [ -e fill ]; do
    dd if=/dev/zero bs=64k
    dd if=/dev/zero bs=1
    sleep 0.02
done >>disk/filler 2>/dev/null &
filler=$!
failing 'a full disk' 'No space left on device'
keep_good
sleep 2
check 'a full disk: the last good files stay' are_kept
check 'a full disk: and are whole' python3 -c '
import sys, zlib
state, text = open("good.snapshot", "rb").read(), open("good.map", "rb").read()
assert zlib.crc32(state[:-4]) == int.from_bytes(state[-4:], "little")
assert text[-18:] == b"# CRC-32 %08x\n" % zlib.crc32(text[:-18])'
rm fill
wait "$filler"
rm disk/filler
working 'room again' 0

# ---- read-only ----
until mount -o remount,ro disk 2>/dev/null; do sleep 0.01; done
keep_good
failing 'a read-only disk' 'Read-only file system'
check 'a read-only disk: the last good files stay' are_kept
mount -o remount,rw disk
working 'writable again' 1

# ---- the folder is gone ----
mv disk/state disk/away
failing 'no folder' 'No such file or directory'
mv disk/away disk/state
working 'a folder again' 2

# ---- slow ----
touch slow
check 'a slow disk: the snapshot is said to be late' wait_until 10 grep -q \
    ' rhotrack: disk/state/snapshot: the disk is slow; the snapshot is not written yet$' node.err
check 'a slow disk: the clutter map, too' wait_until 10 grep -q \
    ' rhotrack: disk/state/map: the disk is slow; the clutter map is not written yet$' node.err
goes_on 'a slow disk'
sleep 2.5
check 'a slow disk: each is said once' test "$(said 'the disk is slow; ')" -eq 2
rm slow
working 'a quick disk' 3
end_node
check 'what went wrong and is well again is no failure at the end' exits 0

# ---- killed amid a save, by a disk that does not answer ----
touch slow
start --snapshot disk/state/snapshot --clutter-map disk/state/map
check 'a part is under way' wait_until 10 test -s disk/state/snapshot.part
keep_good
kill -KILL "$node"
wait "$node" 2>/dev/null
rm slow
sleep 0.5
check 'killed: the last good files stay' are_kept
start --snapshot disk/state/snapshot --clutter-map disk/state/map
check 'killed: the next one goes on' grep -q 'tracks continue from the snapshot$' node.err
check 'killed: and writes over what was left' are_saved
end_node
check 'killed: the next one ends well' exits 0
check 'killed: nothing piles up' test "$(ls disk/state | tr '\n' ' ')" = 'map snapshot '

# ---- a bad disk at the start ----
printf '\0\0\0\0' >disk/state/snapshot
printf '\0\0\0\0' >disk/state/map
mount -o remount,ro disk
start --snapshot disk/state/snapshot --clutter-map disk/state/map --log disk/state/node.lcm
why='it cannot be set aside (Read-only file system), and is not written'
check 'read-only and damaged: the snapshot is said' grep -qF \
    "rhotrack: disk/state/snapshot: not a snapshot; $why; tracks begin anew" node.err
check 'read-only and damaged: the clutter map is said' grep -qF \
    "; $why; the clutter map starts empty" node.err
check 'read-only and damaged: the log is said' wait_until 10 grep -q \
    'disk/state/node.lcm: Read-only file system; tracking goes on without the log' node.err
goes_on 'read-only and damaged'
mount -o remount,rw disk
end_node
check 'read-only and damaged: a failure at the end' exits 1
printf '\0\0\0\0' >four
check 'read-only and damaged: the snapshot stays as it is' cmp four disk/state/snapshot
check 'read-only and damaged: the clutter map, too' cmp four disk/state/map
start --snapshot disk/state/snapshot --clutter-map disk/state/map
goes_on 'writable and damaged'
check 'writable and damaged: both are set aside' test "$(ls disk/state | grep damaged |
    tr '\n' ' ')" = 'map.damaged snapshot.damaged '
check 'writable and damaged: and written anew' are_saved
end_node
check 'writable and damaged: ends well' exits 0

# ---- the end: a disk that is slow for two seconds, and a snapshot of many sensors ----
start --snapshot disk/state/snapshot --clutter-map disk/state/map
touch slow stamp
(sleep 2 && rm slow) &
end_node
check 'slow at the end: ends well' exits 0
check 'slow at the end: the snapshot is written' is_newer disk/state/snapshot
check 'slow at the end: the clutter map, too' is_newer disk/state/map
start --snapshot here.snapshot
python3 - >many.csv <<'PYTHON'
print("t_s,sensor_id,x_m,y_m,sigma_m")
for sensor in range(100, 140):
    print(f"{sensor / 1000},{sensor},{sensor * 100},5000,10")
PYTHON
run publish many.csv
end_node
check '40 unknown numbers: ends well' exits 0
check '40 unknown numbers: the snapshot has 40 windows, mostly empty' test \
    "$(stat -c %s here.snapshot)" -gt $((4 * 1024 * $(du -k here.snapshot | cut -f 1)))
start --snapshot here.snapshot
end_node
check '40 unknown numbers: its successor goes on from it' test "$(said anew)" -eq 0
finish
