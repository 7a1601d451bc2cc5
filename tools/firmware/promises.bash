# SPDX-License-Identifier: MIT
# What a step of each shipped configuration of the node (nodes/) costs at most, as far as a guided
# search for the worst one can tell: `promise_of NAME` sets a step's fixed instructions (a),
# those of a unit of work (b), and what the processor has time for (most): a quarter of the scan
# interval at 168 MHz, for `smallest` 4 million; `full` is any radar's, here one of 4 s. `traffic`
# has half of its interval, which is below a quarter of it at 480 MHz (M7).
shipped='full en_route marine traffic smallest'
promise_of() {
    a=5000000 b=90
    case $1 in
    full) most=168000000 ;;
    en_route) most=420000000 ;;
    marine) most=105000000 ;;
    traffic) a=2900000 most=4200000 ;;
    smallest) a=2200000 most=4000000 ;;
    *) return 1 ;;
    esac
}

# worst_of NAME ARGUMENT...: runs its program (search or sky); sets instructions, work, work_max,
# sky of the worst.
worst_of() {
    local name=$1 line said
    shift
    said=$("$root/tools/firmware/emulate.sh" m4 "$build/firmware/m4/worst/$name.elf" "$@") || {
        echo "$said"
        return 1
    }
    line=$(grep 'instructions, work' <<<"$said" | tail -1)
    read -r instructions work work_max sky < <(sed -n 's/^\([0-9]*\) instructions, work \([0-9]*\) of \([0-9]*\), sky \([0-9a-f]*\)$/\1 \2 \3 \4/p' <<<"$line")
    [ -n "${sky:-}" ]
}
