#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Takes a screenshot of lcm-spy with the viewer opened from it, on a virtual display, while COMMAND
# publishes.
# Usage: screenshot-lcm-spy.sh FILE.png SECONDS COMMAND...     (after `make spy`)
# Needs Debian's xvfb, xdotool and imagemagick, and the packages of `tools/setup.sh spy`. Runs in a
# network namespace of its own.
set -eu
if [ $# -lt 3 ]; then
    sed -n 's/^# Usage: /usage: /p' "$0" >&2
    exit 2
fi
if [ -z "${SPY_OWN_NETWORK-}" ]; then
    SPY_OWN_NETWORK=1 exec unshare -Urn bash "$0" "$@"
fi
ip link set lo up
ip route add 224.0.0.0/4 dev lo
cd "$(dirname "$0")/../.."
file=$1
seconds=$2
shift 2
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT

export DISPLAY=:$((100 + $$ % 100))
Xvfb "$DISPLAY" -screen 0 1280x940x24 >/dev/null 2>&1 &
sleep 1
xsetroot -solid '#20252b' 2>/dev/null || true
make --no-print-directory spy-run &
"$@" &
started=$SECONDS

# wait_for_window NAME: waits until a window of this name is visible, and prints its id
wait_for_window() {
    local found tries
    for tries in $(seq 60); do
        found=$(xdotool search --onlyvisible --name "$1" 2>/dev/null | tail -n 1 || true)
        [ -n "$found" ] && { echo "$found"; return; }
        sleep 0.5
    done
    echo "screenshot: no window '$1' after $tries tries" >&2
    exit 1
}

spy=$(wait_for_window '^LCM Spy')
xdotool windowsize "$spy" 1280 155 windowmove "$spy" 0 0
sleep 7 # until lcm-spy lists the channels
xdotool mousemove 80 92 click --repeat 2 --delay 80 1
view=$(wait_for_window 'rhotrack')
if [ -n "$(xdotool search --onlyvisible --name '^RHO_')" ]; then
    echo 'screenshot: a double-click has opened more than the one window' >&2
    exit 1
fi
xdotool windowsize "$view" 1280 785 windowmove "$view" 0 155
xdotool mousemove 1278 938
sleep $((seconds > SECONDS - started ? seconds - (SECONDS - started) : 1))
import -window root "$file"
convert "$file" +dither -colors 230 -strip "PNG8:$file.part" && mv "$file.part" "$file"
