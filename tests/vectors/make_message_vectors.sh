#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Writes message_vectors.h beside itself: what the C of lcm-gen 1.3.1 (Debian's liblcm-bin,
# liblcm-dev) encodes. With an argument: writes it there instead.
set -eu
cd "$(dirname "$0")/../.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tests/interop/build.sh "$folder"
"$folder/interop" vectors >"$folder/message_vectors.h"
cp "$folder/message_vectors.h" "${1:-tests/vectors/message_vectors.h}"
