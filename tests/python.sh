#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Prints the interpreter that can import all of tests/requirements.txt, or nothing. tools/python.sh sets one up.
here=$(dirname "${BASH_SOURCE[0]}")
modules=$(sed -nE 's/^([A-Za-z0-9_]+)==.*/import \1/p' "$here/requirements.txt")
for python in python3 /usr/bin/python3 "$(realpath -m "${BUILD:-$here/../build}")/venv/bin/python3"; do
    if (cd / && "$python" -c "$modules") >/dev/null 2>&1; then
        command -v "$python"
        break
    fi
done
