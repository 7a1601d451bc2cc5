#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs size.py, which measures the library's size and checks limits: size.sh [--bars | --update].
exec "$(dirname "$0")/size.py" "$@"
