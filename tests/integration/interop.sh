#!/bin/bash
# SPDX-License-Identifier: MIT
#
# The codec beside stock LCM: the C and the Python that lcm-gen makes of lcm_types/, and the Python
# package lcm, with random messages of each type, both ways. What is not installed is skipped, and
# said to be. Runs beside others.
set -u
cd "$(dirname "$0")/../.." || exit 1
lcm_gen=${LCM_GEN:-/usr/bin/lcm-gen}
python=$(tests/find_python.sh) || exit 1
messages=${INTEROP_MESSAGES:-10000} # of each type and way
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
passed=0
failed=0

# Runs it, and counts its lines `ok` and `FAIL`; a run that ends without is a failure.
count() { # command...
    local status=0 good bad
    "$@" >"$folder/lines" 2>&1 || status=$?
    cat "$folder/lines"
    good=$(grep -c '^ok ' "$folder/lines")
    bad=$(grep -c '^FAIL ' "$folder/lines")
    if [ "$bad" -eq 0 ] && { [ "$status" -ne 0 ] || [ "$good" -eq 0 ]; }; then
        echo "FAIL $*: exit $status"
        bad=1
    fi
    passed=$((passed + good))
    failed=$((failed + bad))
}

check() { # name, command...
    local name=$1
    shift
    # shellcheck disable=SC2016
    count sh -c '"$@" && echo "ok   $0" || { echo "FAIL $0"; exit 1; }' "$name" "$@"
}

# The package lcm with the bindings that this lcm-gen makes.
with_bindings_of() { # lcm-gen
    local bindings
    bindings=$(mktemp -d -p "$folder")
    rm -rf "$folder/in"
    mkdir "$folder/in"
    echo "Python's lcm with bindings of $("$1" --version):"
    "$1" -p --ppath "$bindings" lcm_types/*.lcm >/dev/null
    count "$python" tests/interop/interop.py "$bindings" "$folder/out" "$folder/in" "$messages"
    count "$folder/interop" read "$folder/in" "$messages"
}

check 'message_table.h is what lcm_types/ says' tests/vectors/make_message_table.py --check
if [ ! -x "$lcm_gen" ] || ! echo '#include <lcm/lcm_coretypes.h>' | gcc -E - >/dev/null 2>&1; then
    echo "skipped: interop: no $lcm_gen, or no header of liblcm-dev"
elif ! tests/interop/build.sh "$folder"; then
    echo "FAIL the program of tests/interop does not build"
    failed=$((failed + 1))
else
    count "$folder/interop" c "$messages"
    if [ "$("$lcm_gen" --version)" = 'lcm-gen 1.3.1' ]; then
        tests/vectors/make_message_vectors.sh "$folder/vectors.h"
        check 'message_vectors.h is what lcm-gen 1.3.1 encodes' cmp \
            "$folder/vectors.h" tests/vectors/message_vectors.h
    else
        echo "skipped: interop: message_vectors.h made anew, $lcm_gen is not 1.3.1"
    fi
    if [ -z "$python" ]; then
        echo 'skipped: interop with Python: the package lcm is not installed' \
            '(tools/setup_python.sh)'
    else
        check 'the interpreter is found from any folder' test \
            "$(cd "$folder" && "$OLDPWD/tests/find_python.sh")" = "$python"
        mkdir "$folder/out"
        "$folder/interop" write "$folder/out" "$messages"
        with_bindings_of "$lcm_gen"
        own=$("$python" -c 'import sys; print(sys.prefix + "/bin/lcm-gen")') # of the package
        if [ -x "$own" ]; then
            with_bindings_of "$own"
        fi
    fi
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
