# SPDX-License-Identifier: MIT
# Upper bounds of a step's instructions for each shipped configuration of the node (nodes/), checked
# by a guided search for the worst step. `step_cost_limits_of NAME` sets the fixed instructions of a
# step (a), those of a unit of work (b), and the instructions that the processor has time for
# (most): a quarter of the scan interval at 168 MHz; 4 million for `smallest`; `full` is taken with
# 4 s a scan; `traffic` has 0.56 of its interval, which is less than a quarter of it at 480 MHz
# (M7). Of `finders` a step is a second, of four looks with a search for tracks in bearings.
shipped='full en_route marine traffic people smallest finders'
step_cost_limits_of() {
    a=5000000 b=90
    case $1 in
    full) most=168000000 ;;
    en_route) most=420000000 ;;
    marine) most=105000000 ;;
    traffic) a=3500000 most=4700000 ;;
    people) a=2200000 most=4200000 ;;
    smallest) a=2200000 most=4000000 ;;
    finders) a=15000000 b=180 most=42000000 ;;
    *) return 1 ;;
    esac
}

# worst_of NAME ARGUMENT...: runs the configuration's worst-case program (a search, or one sky) in
# QEMU; sets instructions, work, work_max and sky of the worst step found.
worst_of() {
    local name=$1 line said
    shift
    said=$("$root/tools/firmware/emulate.sh" m4 "$build/firmware/m4/worst/$name.elf" "$@") || {
        echo "$said"
        return 1
    }
    line=$(grep 'instructions, work' <<<"$said" | tail -1)
    read -r instructions work work_max sky < <(
        sed -n 's/^\([0-9]*\) instructions, work \([0-9]*\) of \([0-9]*\), '\
'sky \([0-9a-f]*\)$/\1 \2 \3 \4/p' <<<"$line")
    [ -n "${sky:-}" ]
}
