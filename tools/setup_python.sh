#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Sets up what the tests import (tests/requirements.txt) in $BUILD/venv, where no interpreter at
# hand has it. Without a way to the package index it says so and ends well: what needs the packages
# is reported as skipped.
set -u
cd "$(dirname "$0")/.." || exit 1
export BUILD=${BUILD:-build}
[ -z "$(tests/find_python.sh)" ] || exit 0

echo "python: installing $(sed -nE 's/^([^# ]+==[^# ]+).*/\1/p' tests/requirements.txt |
    paste -s -d ' ') in $BUILD/venv"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { python3 -m venv --system-site-packages "$BUILD/venv" &&
    "$BUILD/venv/bin/python3" -m pip install -q --disable-pip-version-check --retries 1 \
        --timeout 20 \
        -r tests/requirements.txt; } >"$log" 2>&1; then
    tail -n 3 "$log" | sed 's/^/python: /' >&2
    rm -rf "$BUILD/venv"
fi
[ -n "$(tests/find_python.sh)" ] || echo \
    "python: not installed; the tests that need it will be skipped" >&2
exit 0
