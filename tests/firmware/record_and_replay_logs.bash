# SPDX-License-Identifier: MIT
#
# For the scripts beside it: records of simulated sensors as LCM logs, and the images that they are
# played to. Source it before checks.bash. Work goes on in $folder.
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
build=$(cd "$root" && realpath -m "${BUILD:-build}")
images=$build/firmware

# record NAME SCENARIO TABLE OPTIONS...: the log NAME.lcm.
record() {
    local name=$1 scenario=$2 table=$3
    shift 3
    "$program" simulate "$scenario" --seed 3 "$@" -o "$name" >/dev/null &&
        "$program" convert "$name/$table.csv" "$name.lcm" --config "$name/scenario.ini"
}

# The real plots of three aircraft among 100 clutter plots; three passive sensors; one target that
# pulls 10 g; a turning radar.
record_all() {
    record table3 radar plots &&
        record passive passive-three bearings --set duration_s=200 &&
        record popup popup plots --set radars.0.sigma_mps=1 --set clutter.0.count=30 &&
        record turning polar plots --set targets.0.count=8 --set duration_s=120
}

# What the node is told of the targets of a record.
settings_of() {
    case $1 in
    popup) echo v_min_mps=100 v_max_mps=1000 accel_mps2=118 ;;
    *) echo v_min_mps=100 v_max_mps=400 accel_mps2=5 ;;
    esac
}

# Each record and gate once, `NAME GATE` a line.
runs() {
    local name gate
    for name in table3 passive popup turning; do
        for gate in best hough nearest; do
            echo "$name $gate"
        done
    done
}

# replay_all DIR COMMAND...: every run by `COMMAND... IN OUT SETTINGS`, into DIR, and what it said
# into DIR/said. Prints the files' sums.
replay_all() { # directory, command...
    local directory=$1 name gate
    shift
    mkdir -p "$directory"
    while read -r name gate; do
        # shellcheck disable=SC2046 # words on purpose
        "$@" "$name.lcm" "$directory/$name-$gate.lcm" "gate=$gate" $(settings_of \
            "$name") </dev/null ||
            { echo "$name $gate: exit $?"; return 1; }
    done < <(runs) >"$directory/said" 2>&1 || { cat "$directory/said"; return 1; }
    (cd "$directory" && sha256sum ./*.lcm)
}

# memory_of NAME: flash and RAM of a node's image in bytes, stack included; `- -` where none is
# shipped.
memory_of() {
    local image=$images/m4/nodes/$1.elf
    [ "$1" != full ] || image=$images/m4/radar.elf
    [ -e "$image" ] || { echo '- -'; return; }
    arm-none-eabi-size -A "$image" | awk '
        $1 ~ /^\.(text|ARM\.exidx|data)$/ {flash += $2}
        $1 ~ /^\.(stack|data|bss)$/ {ram += $2}
        END {print flash + 0, ram + 0}'
}

# says_the_page SECTION FILE: tools/lab/MEASUREMENTS.md has the file's text in this section, where
# the compiler is Debian 12's. LOAD=update writes it there.
says_the_page() {
    local page=$root/tools/lab/MEASUREMENTS.md
    if [ "${LOAD-}" = update ]; then
        "$root/tools/lab/update_measurements_page.py" --standard-input "$1" <"$2"
    elif [ "$(arm-none-eabi-gcc -dumpfullversion)" = 12.2.1 ]; then
        diff <(sed "/^<!-- $1:/,/^<!-- end of $1 /!d; /^<!--/d" "$page") "$2"
    fi
}
