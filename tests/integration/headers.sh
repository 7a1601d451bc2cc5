#!/bin/bash
# SPDX-License-Identifier: MIT
# Each header compiles alone, twice in one file, as C99, C11, C23 and C++17; rhotrack.h includes
# every public header; every function of the headers links from C++, and a C++ program tracks.
# Runs beside others.
root=$(realpath "$(dirname "$0")/../..")
library=$(cd "$root" && realpath "${BUILD:-build}")/librhotrack.a
# shellcheck source=tests/integration/checks.bash
. "$root/tests/integration/checks.bash"

warnings='-Wall -Wextra -Wpedantic -Wundef -Werror'

headers_of() { # folder
    (cd "$1" && printf '%s\n' rhotrack/*.h rhotrack/detail/*.h)
}

compiles() { # standard, folder, header
    local compiler='gcc -x c'
    [[ $1 != c++* ]] || compiler='g++ -x c++'
    # C wants a declaration in each file, and config.h has none.
    printf '#include "%s"\n#include "%s"\nint nothing;\n' "$3" "$3" |
        $compiler -std="$1" $warnings -I"$2" -fsyntax-only -
}

compile_alone() { # standard, folder: all its headers
    local header wrong=0
    for header in $(headers_of "$2"); do
        compiles "$1" "$2" "$header" || { echo "$header does not compile alone as $1"; wrong=1; }
    done
    return "$wrong"
}

includes_all() { # folder: rhotrack.h names the public headers
    local header wrong=0
    for header in $(cd "$1" && printf '%s\n' rhotrack/*.h); do
        [ "$header" = rhotrack/rhotrack.h ] ||
            grep -qF "#include \"$header\"" "$1/rhotrack/rhotrack.h" ||
            { echo "rhotrack.h does not include $header"; wrong=1; }
    done
    return "$wrong"
}

# A table of all functions of the library that the headers declare, in C++.
link_all() { # folder
    local functions defined
    defined=$(nm --defined-only "$library" | awk '$2 == "T" {print $3}' | sort -u)
    headers_of "$1" | sed 's/.*/#include "&"/' >all.h
    functions=$(gcc -E -P -I"$1" all.h | grep -oE '\brho_[a-z0-9_]+ ?\(' | tr -d ' (' | sort -u |
        comm -12 - <(echo "$defined"))
    [ "$(wc -l <<<"$functions")" -gt 200 ] || { echo "too few functions found"; return 1; }
    { echo '#include "all.h"'
      echo 'using function = void (*)();'
      echo 'extern const function functions[] = {'
      sed 's/.*/    reinterpret_cast<function>(&),/' <<<"$functions"
      echo '};'
      echo 'int main() { return functions[0] == nullptr; }'; } >all.cpp
    g++ -std=c++17 -I. -I"$1" -o all all.cpp "$library" && ./all
}

tracks() { # folder
    g++ -std=c++17 $warnings -I"$1" -o headers "$root/tests/integration/headers.cpp" "$library" &&
        ./headers
}

include=$root/include
for standard in c99 c11 c2x c++17; do
    check "each header alone as $standard" compile_alone "$standard" "$include"
done
check 'rhotrack.h includes all' includes_all "$include"
check 'every function links from C++' link_all "$include"
check 'a C++ program tracks' tracks "$include"

# ---- seeded faults ----
sees() { # file, sed command that seeds the fault, what it says, check...
    rm -rf seeded
    cp -r "$include" seeded
    sed -i "$2" "seeded/rhotrack/$1"
    ! cmp -s "seeded/rhotrack/$1" "$include/rhotrack/$1" || { echo "nothing was seeded"; return 1; }
    if "${@:4}" seeded >said 2>&1; then
        echo 'not seen'
        return 1
    fi
    grep -q -- "$3" said || { cat said; return 1; }
}
check 'seen: a header that lacks an include' \
    sees zones.h '/#include/d' 'rhotrack/zones.h does not compile alone as c99' compile_alone c99
check 'seen: a header without a guard' \
    sees udpm.h '/RHOTRACK_UDPM_H/d; $d' 'udpm.h does not compile alone as c11' compile_alone c11
check 'seen: C that C++ does not know' \
    sees types.h '$i static inline int f(void) { return (struct { int a; }){.a = 1}.a; }' \
    'types.h does not compile alone as c++17' compile_alone c++17
check 'seen: rhotrack.h lacks a header' \
    sees rhotrack.h '/passive_paper/d' 'does not include rhotrack/passive_paper.h' includes_all
check 'seen: a header without extern "C"' \
    sees udpm.h 's/RHO_BEGIN_C//; s/RHO_END_C//' 'undefined reference to .rho_udpm_' link_all
check 'seen: the tracker without extern "C"' \
    sees tracker.h 's/RHO_BEGIN_C//; s/RHO_END_C//' 'undefined reference to .rho_tracker_step' \
    tracks
finish
