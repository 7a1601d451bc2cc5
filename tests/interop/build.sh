#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Builds the program of interop.c in a folder, with the C that lcm-gen makes: tests/interop/build.sh
# FOLDER LCM_GEN=/usr/bin/lcm-gen: by its full path, as the Python package lcm puts another lcm-gen
# first on PATH.
set -eu
folder=$(realpath -m "$1")
cd "$(dirname "$0")/../.."
lcm_gen=${LCM_GEN:-/usr/bin/lcm-gen}
mkdir -p "$folder/gen"
"$lcm_gen" -c --c-no-pubsub --c-cpath "$folder/gen" --c-hpath "$folder/gen" lcm_types/*.lcm \
    >/dev/null
(cd "$folder/gen" && printf '#include "%s"\n' rhotrack_*.h) >"$folder/gen/lcm_gen.h"
# -w: lcm-gen's C is not ours; it reads floats through pointers to integers, hence
# -fno-strict-aliasing.
flags="-std=gnu11 -O2 -ffp-contract=off -Iinclude -Itests -I$folder/gen"
for source in "$folder"/gen/*.c; do
    # shellcheck disable=SC2086 # words on purpose
    gcc $flags -w -fno-strict-aliasing -c -o "${source%.c}.o" "$source"
done
# shellcheck disable=SC2086
gcc $flags -Wall -Wextra -Werror -o "$folder/interop" tests/interop/interop.c src/wire/message*.c \
    src/base/status.c \
    "$folder"/gen/*.o
