# SPDX-License-Identifier: MIT
#
# Sourced by publish_demo_scene.sh and publish_paper_method_scene.sh: sets $program and $seconds,
# changes to a temporary folder, and at exit removes it and kills all background jobs.
set -eu
program=$(realpath "${RHOTRACK:-$(dirname "$0")/../../build/rhotrack}")
seconds=${1:-30}
folder=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT
cd "$folder"
