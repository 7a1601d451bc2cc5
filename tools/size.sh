#!/bin/bash
# SPDX-License-Identifier: MIT
#
# What the library costs: code and data a module at -Os (embedded profile), the worst stack of each module's functions,
# and the public objects in both profiles. For Cortex-M4F where arm-none-eabi-gcc is there, else for this machine.
# Ends with what must fit, and exit 1 where it does not; `size.sh --bars` says only that. SIZE_FLAGS are added to it.
set -eu
cd "$(dirname "$0")/.."
folder=${BUILD:-build}/size
rm -rf "$folder"
mkdir -p "$folder"

if command -v arm-none-eabi-gcc >/dev/null 2>&1; then
    prefix=arm-none-eabi-
    machine='-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard'
    target='Cortex-M4F'
else
    prefix=''
    machine='-fno-pie' # constant tables of pointers are not to count as data
    target="this machine, $(uname -m) (no arm-none-eabi-gcc here)"
fi
flags="-std=c99 -Os -ffp-contract=off -Iinclude $machine"

# An object with a profile's capacities, and those that the flags set: bytes at most.
fit() { # module, object, text, bytes, flags...
    local module=$1 object=$2 text=$3 most=$4 bytes verdict=ok
    shift 4
    # shellcheck disable=SC2086 # words on purpose
    printf '#include "rhotrack/%s.h"\nchar rho_sizeof[sizeof(struct rho_%s)];\n' "$module" "$object" |
        ${prefix}gcc $flags ${SIZE_FLAGS:-} "$@" -fno-common -x c -c -o "$folder/fit.o" -
    read -r _ bytes _ < <(${prefix}nm -S "$folder/fit.o")
    bytes=$((16#$bytes))
    [ "$bytes" -le "$most" ] || { verdict=MISSED; missed=1; }
    printf '%-66s %9d %9d  %s\n' "struct rho_$object, $text" "$bytes" "$most" "$verdict"
}

passive() { # profile, bytes, sensors, scans, bearings, flags...
    local text="$1, $3 sensors, $4 scans, $5 bearings" most=$2
    local capacities=(-DRHO_MAX_PASSIVE_SENSORS="$3" -DRHO_MAX_PASSIVE_SCANS="$4" -DRHO_MAX_BEARINGS="$5")
    shift 5
    fit passive passive "$text" "$most" "${capacities[@]}" "$@"
}

bars() {
    missed=''
    printf '%-66s %9s %9s\n' 'what must fit' bytes 'at most'
    passive embedded $((48 * 1024)) 2 8 8
    passive workstation $((90 * 1024)) 4 16 16 -DRHO_PROFILE_WORKSTATION
    fit kalman kalman 'state and covariance' 108
    fit track track 'in any of its modes' 512
    fit hypotheses hypothesis 'two models and its plots' 512
    fit feed feed 'two open scans of 256 plots' $((32 * 1024)) -DRHO_MAX_OPEN_SCANS=2 -DRHO_MAX_PLOTS=256
    fit hypotheses hypotheses 'a pool of 96 for 32 tracks' $((48 * 1024)) -DRHO_MAX_HYPOTHESES=96 -DRHO_MAX_TRACKS=32
    [ -z "$missed" ] || { echo 'size: an object is larger than it may be'; exit 1; }
}

if [ "${1:-}" = --bars ]; then
    bars
    exit
fi

row() { printf '%-34s %9s %9s %9s  %9s %s\n' "$@"; }

echo "Code and data in bytes, gcc $(${prefix}gcc -dumpfullversion) -Os, $target."
echo 'Stack: the largest frame of one function; callees come on top.'
echo
row file text data bss frame function
for source in src/*/*.c; do
    [ -f "$source" ] || { echo 'size: no sources'; exit 1; }
    object=$folder/$(basename "$source" .c).o
    # shellcheck disable=SC2086 # words on purpose
    ${prefix}gcc $flags -fstack-usage -c -o "$object" "$source"
    read -r text data bss _ < <(${prefix}size "$object" | tail -n 1)
    # FILE:LINE:COLUMN:FUNCTION <tab> bytes <tab> kind
    read -r frame function < <(
        sort -t "$(printf '\t')" -k2,2nr "${object%.o}.su" | awk -F '[:\t]' 'NR == 1 {print $(NF - 1), $(NF - 2)}')
    row "${source#src/}" "$text" "$data" "$bss" "${frame:-0}" "${function:-}"
done
# shellcheck disable=SC2046 # words on purpose
row 'all' $(${prefix}size -t "$folder"/*.o | tail -n 1 | awk '{print $1, $2, $3}') '' ''

# Sizes of objects without running anything on the target: arrays of that size, read back from the symbol table.
{
    for header in include/rhotrack/*.h; do
        echo "#include \"rhotrack/$(basename "$header")\""
    done
    for object in accumulator classic window initiator frames ghost_matrix passive passive_paper kalman input \
        imm hypothesis hypotheses assignment tracker report feed; do
        echo "char rho_sizeof_$object[sizeof(struct rho_$object)];"
    done
    # HT on 4 x 2.5 km at 5 m x 1 mrad: the object, a window of plots with their times, and 128 peaks
    echo 'char rho_sizeof_classic_and_its_plots[sizeof(struct rho_classic) + 12 * RHO_MAX_SCANS * RHO_MAX_PLOTS +'
    echo '    128 * sizeof(struct rho_accumulator_peak)];'
    echo 'char rho_sizeof_track_slot[sizeof(struct rho_track)];'
    echo 'char rho_sizeof_plot[sizeof(struct rho_plot)];'
} >"$folder/objects.c"

sizes_of() { # profile, flags: name and bytes of each object
    # shellcheck disable=SC2086 # words on purpose
    ${prefix}gcc $flags $2 -fno-common -c -o "$folder/$1.objects" "$folder/objects.c"
    ${prefix}nm -S "$folder/$1.objects" | sed -n 's/^[^ ]* \([0-9a-f]*\) . rho_sizeof_/\1 /p' |
        while read -r hex name; do echo "$name $((16#$hex))"; done | sort
}

echo
echo "Objects in bytes, $target; the caller owns them."
echo
printf '%-34s %12s %12s\n' object embedded workstation
join <(sizes_of embedded '') <(sizes_of workstation -DRHO_PROFILE_WORKSTATION) | while read -r name embedded workstation; do
    printf '%-34s %12d %12d\n' "struct rho_${name%_slot}" "$embedded" "$workstation"
done

echo
bars
