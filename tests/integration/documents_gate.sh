#!/bin/bash
# SPDX-License-Identifier: MIT
# tools/gates/documents_gate.py finds the documents and the width of the code's lines as
# they should be, and goes red for each kind of fault, seeded in a copy. Runs beside others.
here=$(realpath "$(dirname "$0")")
# shellcheck source=tests/integration/checks.bash
. "$here/checks.bash"
root=$(realpath "$here/../..")
gate=$root/tools/gates/documents_gate.py
check 'the documents hold' "$gate"

mkdir documents
(cd "$root" && find . -path './build*' -prune -o -name '*.md' -print0 | xargs -0 cp --parents -t \
    "$folder/documents")
seen() { # document, text at its end, the message expected
    cp "$root/$1" "documents/$1"
    printf '\n%b\n' "$2" >>"documents/$1"
    ! "$gate" documents >said && grep -q -- "$3" said || { cat said; return 1; }
    cp "$root/$1" "documents/$1"
}
words() { printf '%*s' "$1" '' | sed 's/ /word\\n/g'; }
check 'a copy holds' "$gate" documents
check 'a link to no file is seen' seen tests/README.md '[page](no/page.md)' 'no file no/page.md'
check 'a link to no heading is seen' seen README.md '[part](tests/README.md#no-part)' \
    'no heading tests/README.md#no-part'
check 'a C file that is not there is seen' seen tools/README.md '`no_such_file.c`' \
    'no file no_such_file.c'
check 'a function that is not there is seen' seen lcm_types/README.md '`rho_no_such_function`' \
    'type rho_no_such_function'
example='```c\n/* src/base/no_such_file.c */\nint rho_no_such_function(void)\n```\n'
known() { # document, text at its end
    printf '\n%b\n' "$2" >>"documents/$1"
    "$gate" documents >said
    cp "$root/$1" "documents/$1"
    ! grep -q no_such said || { cat said; return 1; }
}
check 'names of an example in the document are known' known src/DESIGN.md \
    "$example"'`no_such_file.c`, `rho_no_such_function`'
check 'a long line is seen' seen tools/lab/README.md "$(printf '%0101d' 0)" ': 101 columns'
check 'a long README is seen' seen README.md "$(words 1200)" '^README.md: .* at most 1200'
check 'a long DESIGN is seen' seen src/DESIGN.md "$(words 14000)" '^src/DESIGN.md: .* at most'
check 'many words are seen' seen tools/README.md "$(words 26000)" '^all documents: .* at most'
table=$(printf '| %0120d |\\n```\\n%0120d\\n```' 0 0)
check 'long lines of code and tables are none' seen README.md "$table\\n$(printf '%0101d' 0)" \
    ': 101 columns'
check 'and are not named' test "$(grep -c columns said)" -eq 1
mkdir -p documents/tests/vectors documents/build-other
for code in code.c code.py code.sh code.java page.js page.html type_t.lcm Makefile \
    CMakeLists.txt; do
    printf '%0100d\n%0101d\n' 0 0 >"documents/tests/$code"
    "$gate" documents >said
    check "of code they are: $code" matches "$(cat said)" "tests/$code:2: 101 columns"
    rm "documents/tests/$code"
done
for data in plots.csv scene.json tests/vectors/made.h page.min.js build-other/code.c; do
    printf '%0101d\n' 0 >"documents/$data"
done
check "not of data, others' code, build folders" "$gate" documents
finish
