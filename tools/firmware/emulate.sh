#!/bin/bash
# SPDX-License-Identifier: MIT
# Runs an image with its arguments in QEMU: emulate.sh m4|m7 IMAGE.elf ARGUMENT... Exit code and
# console (on standard output) are the image's; arguments must not contain spaces or commas.
# Each instruction takes 64 ns of emulated time, whatever the host's load; QEMU is killed after
# EMULATE_SECONDS (default 120) of the host's time.
set -eu
case ${1-} in
m4) machine=mps2-an386 ;;
m7) machine=mps2-an500 ;;
*)
    echo "emulate: give m4 or m7, an image, arguments" >&2
    exit 2
    ;;
esac
image=${2:?emulate: which image?}
shift 2
arguments=enable=on,target=native,arg=$(basename "$image")
for argument in "$@"; do
    case $argument in
    *[\ ,]*)
        echo "emulate: $argument: no spaces and commas" >&2
        exit 2
        ;;
    esac
    arguments+=",arg=$argument"
done
exec timeout --signal=KILL "${EMULATE_SECONDS:-120}" qemu-system-arm -M "$machine" -display none \
    -monitor none -serial null \
    -icount shift=6 -semihosting-config "$arguments" -kernel "$image" </dev/null 2>&1
