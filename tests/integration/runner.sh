#!/bin/bash
# SPDX-License-Identifier: MIT
# tests/run.sh counts truly: passes, failures, crashes, programs that are missing.
set -eu
cd "$(dirname "$0")/../.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export BUILD=$folder

check() { # name, text of the script
    printf '#!/bin/sh\n%s\n' "$2" >"$folder/$1"
    chmod +x "$folder/$1"
}

must_say() { # closing line, exit code, checks...
    local line=$1 code=$2 status=0
    shift 2
    tests/run.sh "${@/#/$folder/}" >"$folder/output" 2>&1 || status=$?
    if [ "$(tail -n 1 "$folder/output")" != "$line" ] || [ "$status" -ne "$code" ]; then
        echo "run.sh $*: expected '$line' and exit $code, got exit $status and:"
        cat "$folder/output"
        exit 1
    fi
}

check plain 'exit 0'
check wrong 'exit 3'
check crash 'echo "[       OK ] a"; kill -SEGV $$'
check cmocka 'echo "[  PASSED  ] 4 test(s)." >&2'
check cmocka_wrong \
    'echo "[  PASSED  ] 2 test(s)."; echo "[  FAILED  ] 3 test(s), listed below:"; exit 3'
check counting 'echo "6 passed, 2 failed"; exit 1'

must_say '1 passed, 0 failed' 0 plain
must_say '6 passed, 2 failed' 1 counting
must_say '5 passed, 0 failed' 0 plain cmocka
must_say '0 passed, 1 failed' 1 wrong
must_say '0 passed, 1 failed' 1 crash
must_say '1 passed, 1 failed' 1 plain missing
must_say '7 passed, 4 failed' 1 cmocka wrong cmocka_wrong plain
check skipping 'echo "skipped: no such tool"; echo "0 passed, 0 failed"'
must_say '0 passed, 0 failed' 0 skipping
grep -qF '| skipped: no such tool' "$folder/output" || { echo \
    'run.sh does not show what was skipped'; exit 1; }
tail -n 4 "$folder/output" | grep -q '^skipped in .*: no such tool$' || { echo \
    'run.sh does not sum up what was skipped'; exit 1; }

# Two that wait for one another pass beside one another alone.
meet() { # own name, the other's
    printf 'touch %s/met-%s\nfor _ in $(seq 30); do\n    [ -e %s/met-%s ] && exit 0\n'\
'    sleep 0.1\ndone\nexit 1\n' "$folder" "$1" "$folder" "$2"
}
if [ "$(nproc)" -gt 1 ]; then
    check one.sh "# Meets the other. Runs beside others.
$(meet one other)"
    check other.sh "# Runs beside others.
$(meet other one)"
    must_say '2 passed, 0 failed' 0 one.sh other.sh
    rm "$folder"/met-*
    check one.sh "$(meet one other)"
    check other.sh "$(meet other one)"
    must_say '1 passed, 1 failed' 1 one.sh other.sh
fi
echo 'run.sh counts what it must'
