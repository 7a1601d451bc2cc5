#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs library_size.py, which measures the library's size and checks limits:
# library_size.sh [--bars | --update]
exec "$(dirname "$0")/library_size.py" "$@"
