# SPDX-License-Identifier: MIT
#
# For scripts whose nodes and publishers speak to one another over lo: in a network of their own
# where the system allows one, else on a port of their own. Source it before checks.bash.

if [ -z "${RHO_ON_LOOPBACK:-}" ] && command -v ip >/dev/null && unshare -Urn true 2>/dev/null; then
    RHO_ON_LOOPBACK=1 exec unshare -Urn bash "$0"
fi
if [ -n "${RHO_ON_LOOPBACK:-}" ]; then
    ip link set lo up && ip route add 224.0.0.0/4 dev lo
fi
# Also where the network is not this script's own, nobody else is there.
export LCM_DEFAULT_URL="udpm://239.255.76.67:$((20000 + $$ % 10000))?ttl=0"
