#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Prints the interpreter that can import all of tests/requirements.txt, or nothing; from whatever
# folder it is called, BUILD is one of the project's. tools/setup_python.sh sets an interpreter up.
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
modules=$(sed -nE 's/^([A-Za-z0-9_]+)==.*/import \1/p' "$here/requirements.txt")
build=$(cd "$here/.." && realpath -m "${BUILD:-build}")
for python in python3 /usr/bin/python3 "$build/venv/bin/python3"; do
    if (cd / && "$python" -c "$modules") >/dev/null 2>&1; then
        command -v "$python"
        break
    fi
done
