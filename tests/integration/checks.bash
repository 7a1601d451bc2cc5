# SPDX-License-Identifier: MIT
#
# For the scripts beside it: runs the program ($RHOTRACK) and counts checks. Work goes on in
# $folder, a new one.
set -u
program=$(realpath "${RHOTRACK:-$(dirname "${BASH_SOURCE[0]}")/../../build/rhotrack}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
passed=0
failed=0
status=0 # of no run so far
: >stderr

# Runs the program: exit code in $status, output in the files stdout and stderr.
run() {
    status=0
    "$program" "$@" >stdout 2>stderr </dev/null || status=$?
}

# check NAME COMMAND...: passes where the command exits with 0.
check() {
    local name=$1
    shift
    if "$@" >detail 2>&1; then
        echo "ok   $name"
        passed=$((passed + 1))
    else
        echo "FAIL $name"
        echo "     exit $status, standard error: $(head -c 300 stderr)"
        head -n 5 detail | sed 's/^/     /'
        failed=$((failed + 1))
    fi
}

# wait_until SECONDS COMMAND...: until it succeeds.
wait_until() {
    local tries=$(($1 * 20))
    shift
    until "$@" 2>/dev/null; do
        [ $((tries -= 1)) -gt 0 ] || return 1
        sleep 0.05
    done
}

# The last run ended with this exit code.
exits() { [ "$status" -eq "$1" ]; }

# The last run ended with 0, and its output is the same as that file.
writes_same_as() { exits 0 && cmp "$1" stdout; }

# The last run ended with the code and said one line on standard error, which matches the pattern,
# and no output.
says() {
    exits "$1" && [ ! -s stdout ] && [ "$(wc -l <stderr)" -eq 1 ] && matches "$(cat stderr)" "$2"
}

# matches TEXT PATTERN
matches() {
    # shellcheck disable=SC2053
    [[ $1 == $2 ]] || { echo "got:      $1"; echo "expected: $2"; return 1; }
}

is_json() { python3 -m json.tool "$1" /dev/null; }

# json FILE EXPRESSION: the Python expression of the object o holds.
json() {
    python3 -c 'import json, sys
o = json.load(open(sys.argv[1]))
sys.exit(0 if eval(sys.argv[2]) else str(o))' "$1" "$2"
}

finish() {
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
    exit
}

# unnumbered PLOTS COLUMNS TURN_S: simulated plots of a radar that turns, in a form without numbers
# of scans: these first columns, and each turn's own row at its start.
unnumbered() {
    awk -F, -v OFS=, -v columns="$2" -v turn="$3" '
        NR > 1 && $3 == "" { $1 = sprintf("%.6f", $1 - turn) } { NF = columns; print }' "$1"
}
