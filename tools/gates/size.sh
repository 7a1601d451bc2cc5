#!/bin/sh
# SPDX-License-Identifier: MIT
# What the library costs, and what must fit: size.sh [--bars | --update]; see tools/gates/size.py.
exec "$(dirname "$0")/size.py" "$@"
