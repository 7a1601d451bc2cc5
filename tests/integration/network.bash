# SPDX-License-Identifier: MIT
#
# For scripts that need a network: they go on in one of their own (namespaces of user, network and
# mounts), where multicast goes over lo. Where the system allows none they say so and end: `skipped:
# ...`. Source it before checks.bash, with the script's arguments.

tests_folder=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
lcm_url='udpm://239.255.76.67:7667?ttl=1'

if [ -z "${RHO_IN_NETWORK:-}" ]; then
    if ! unshare -Urnm --fork true 2>/dev/null; then
        echo "skipped: $(basename "$0"): no network namespaces here (unshare -Urnm)"
        echo '0 passed, 0 failed'
        exit 0
    fi
    RHO_IN_NETWORK=1 exec unshare -Urnm --fork --kill-child bash "$0" "$@"
fi
mount -t tmpfs tmpfs /run
ip link set lo up
ip route add 224.0.0.0/4 dev lo

# One host more: add_host NAME NUMBER: namespace NAME with 10.9.0.NUMBER, on the bridge.
add_host() {
    ip link show bridge >/dev/null 2>&1 || {
        ip link add bridge type bridge mcast_snooping 0
        ip link set bridge up
    }
    ip netns add "$1"
    ip -n "$1" link set lo up
    connect_host "$@"
}

# The host's interface eth0, new, with its address and a route for multicast.
connect_host() { # name, number
    ip link add "to-$1" type veth peer name eth0 netns "$1"
    ip link set "to-$1" master bridge up
    ip -n "$1" link set eth0 up
    address_host "$@"
}

address_host() { # name, number
    ip -n "$1" addr add "10.9.0.$2/24" dev eth0
    ip -n "$1" route add 224.0.0.0/4 dev eth0
}

# What others send to a host is lost, so many of a thousand datagrams of LCM.
lose() { # host, per mille
    local own
    own=$(ip -n "$1" -4 -o address show eth0 | sed 's/.*inet \([0-9.]*\).*/\1/')
    ip netns exec "$1" nft -f - <<NFT
table ip loss
delete table ip loss
table ip loss {
    chain input {
        type filter hook input priority 0; policy accept;
        ip saddr != $own ip daddr 239.255.76.67 numgen random mod 1000 < $2 counter drop
    }
}
NFT
}

lost() { ip netns exec "$1" nft list table ip loss | sed -n \
    's/.*counter packets \([0-9]*\).*/\1/p'; }

# The Python that has the package lcm, as $python, and the messages' bindings by lcm-gen in the
# folder bindings; where there is no such Python the script ends. After checks.bash.
need_bindings() {
    local type
    python=$("$tests_folder/find_python.sh") || exit 1
    [ -n "$python" ] || { echo "skipped: $(basename "$0"): no Python package lcm"; finish; }
    for type in "$tests_folder"/../lcm_types/*.lcm; do
        "${LCM_GEN:-/usr/bin/lcm-gen}" -p --ppath bindings "$type" || exit 1
    done
}

# The newest RHO_STATUS of a log as NAME=VALUE lines in the file status, by the Python bindings of
# lcm-gen. A step_max_us is of one second, and the newest may be idle: longest_step_us is that of
# all.
read_status() { # log
    "$python" - "$1" >status <<'PYTHON'
import sys
import lcm
sys.path.insert(0, "bindings")
import rhotrack
last, longest_us = None, 0.0
for event in lcm.EventLog(sys.argv[1]):
    if event.channel == "RHO_STATUS":
        last = rhotrack.status_t.decode(event.data)
        longest_us = max(longest_us, last.step_max_us)
for name in last.__slots__:
    print(f"{name}={getattr(last, name)}")
print(f"longest_step_us={longest_us}")
PYTHON
}

status_of() { sed -n "s/^$1=//p" status; }
