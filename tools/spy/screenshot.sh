#!/bin/sh
# SPDX-License-Identifier: MIT
#
# Takes a picture of the viewer without a display while COMMAND publishes: the viewer listens for
# SECONDS and paints itself to a file.
# Usage: screenshot.sh FILE.png SECONDS COMMAND...     (after `make spy`)
# From the environment: BUILD; SIZE=1280x800; SELECT=TRACK, 0 for the track with most hypotheses.
# Where the system allows it, viewer and COMMAND run in a network namespace of their own, so that no
# other LCM traffic gets into the picture.
set -eu
if [ $# -lt 3 ]; then
    sed -n 's/^# Usage: /usage: /p' "$0" >&2
    exit 2
fi
here=$(cd "$(dirname "$0")/../.." && pwd)
spy=${BUILD:-$here/build}/spy
jars=${LCM_JARS:-/usr/share/java/lcm.jar}

if [ -z "${SPY_OWN_NETWORK-}" ]; then
    export SPY_OWN_NETWORK=1
    multicast='ip link set lo up && ip route add 224.0.0.0/4 dev lo'
    if unshare -Urn sh -c "$multicast" 2>/dev/null; then
        exec unshare -Urn sh -c "$multicast"' && exec "$@"' own "$0" "$@"
    fi
    echo "screenshot: no network of its own, other LCM traffic may be in the picture" >&2
fi

file=$1
seconds=$2
shift 2
"$@" &
publisher=$!
trap 'kill "$publisher" 2>/dev/null || true' EXIT
java -Djava.net.preferIPv4Stack=true -cp "$jars:$spy/rhotrack-types.jar:$spy/rhotrack-spy.jar" \
    rhotrack.spy.Viewer \
    --png "$file" --after "$seconds" --size "${SIZE:-1280x800}" ${SELECT:+--select "$SELECT"}
# A palette halves the file; the picture looks the same.
if command -v convert >/dev/null 2>&1; then
    convert "$file" +dither -colors 220 -strip "PNG8:$file.part" && mv "$file.part" "$file"
fi
