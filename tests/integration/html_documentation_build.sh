#!/bin/bash
# SPDX-License-Identifier: MIT
# make docs writes the pages without a warning, all examples run, no link is broken; the pages hold
# each header's functions, each experiment and each document; and broken links are seen.
# Runs beside others.
here=$(realpath "$(dirname "$0")")
root=$(realpath "$here/../..")
build=$(cd "$root" && realpath -m "${BUILD:-build}")
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"
if ! /usr/bin/python3 -c 'import sphinx, myst_parser, sphinx_gallery, furo, pandas' 2>stderr; then
    echo "skipped: documentation: $(tail -n 1 stderr) (tools/setup.sh docs)"
    finish
fi

html=$build/docs/html
check 'make docs' make -s -C "$root" BUILD="$build" docs
has() { # page, texts...
    local page=$html/$1 text
    for text in "${@:2}"; do grep -qF -- "$text" "$page" || return 1; done
}
check 'the first page is the README' has index.html 'rhotrack turns radar plots into tracks'
functions() { # each that a header declares is an object of its page
    local header name
    for header in "$root"/include/rhotrack/*.h; do
        for name in $(grep -oP '^(?!static)[^ */#].*?\b\Krho_\w+(?=\()' "$header"); do
            grep -q "$name" "$html/include/rhotrack/${header##*/}.html" \
                || { echo "$header: $name"; return 1; }
        done
    done
}
check 'each function of the headers is there' functions
check 'its arguments are links' has include/rhotrack/tracker.h.html \
    'href="types.h.html#c.rho_scan"'
check 'Python has types' has tools/docs/python.html 'rhotrack.Tracker.run' 'Tracks'
experiments() {
    local script
    for script in $(grep -l '^"""Experiment' "$root"/tools/lab/*.py); do
        [ -f "$html/tools/lab/$(basename "$script" .py).html" ] || return 1
    done
}
check 'each experiment has a page' experiments
pictures() {
    local example
    for example in "$root"/tools/docs/examples/*.py; do
        ls "$html/_images/sphx_glr_$(basename "$example" .py)"_00?.png >/dev/null || return 1
    done
}
check 'each example has a picture' pictures

mkdir pages
echo '<a href="b.html#there">b</a>' >pages/a.html
echo '<a id="there" href="a.html"></a>' >pages/b.html
links=$root/tools/docs/links.py
check 'links that hold' "$links" pages
echo '<img src="none.png"><a href="b.html#gone">b</a>' >pages/c.html
broken() { ! "$links" pages >said && grep -q 'no file none.png' said && grep -q 'no anchor' said; }
check 'links that are broken' broken
finish
