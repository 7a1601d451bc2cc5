# SPDX-License-Identifier: MIT
#
# How the scenes beside it begin: $program, $seconds, and a folder that is gone at the end, as is all
# that was started.
set -eu
program=$(realpath "${RHOTRACK:-$(dirname "$0")/../../build/rhotrack}")
seconds=${1:-30}
folder=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT
cd "$folder"
