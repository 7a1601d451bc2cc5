#!/bin/bash
# SPDX-License-Identifier: MIT
# The library in other people's builds: what make and CMake install, where, and what it says; the
# examples of tools/examples, each built and run here, and for a Cortex-M4F where its compiler is;
# capacities that do not agree.
root=$(realpath "$(dirname "$0")/../..")
build=$(cd "$root" && realpath -m "${BUILD:-build}")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"

cortex='-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard'
own=$folder/examples/my_config.h
version=$(awk '$2 ~ /^RHO_VERSION_[MP]/ {v = v s $3; s = "."} END {print v}' \
    "$root/include/rhotrack/rhotrack.h")
cp -r "$root/tools/examples" .
rm -rf examples/*/build examples/*/example
unset DESTDIR PKG_CONFIG_PATH PKG_CONFIG_LIBDIR PKG_CONFIG_SYSROOT_DIR RHOTRACK

# Runs a command quietly: exit code in $status, output in the files stdout and stderr.
go() {
    status=0
    "$@" >stdout 2>stderr </dev/null || status=$?
}

tracks() { # program, tracker's bytes: it finds its track, and has that size
    go "$1" && exits 0 && grep -q 'tracks: 1; .* confirmed, at 3500 m, 250 m/s' stdout &&
        grep -qE "tracker $2," stdout || { cat stdout; return 1; }
}

install_by_make() { # stage, arguments...
    local stage=$1
    shift
    go make -s -j2 -C "$root" BUILD="$build" DESTDIR="$stage" "$@"
    exits 0
}

no_files_but() { # folder, pattern of their paths
    ! find "$1" ! -type d | sed "s|^$1||" | grep -vE "$2" >unexpected \
        || { cat unexpected; return 1; }
}

# The rows of the table of tools/examples/README.md, without spaces: object|embedded|own.
ram() { # object, column
    sed 's/, where scans.*messages//; s/ //g' "$root/tools/examples/README.md" | awk -F '|' \
        -v o="$1" -v c="$2" '$2 == o {print $c}'
}
embedded=$(ram rho_tracker 3)
small=$(ram rho_tracker 4)

# ---- make install ----
usual='^/opt/rt/(bin/rhotrack|lib/librhotrack\.a|lib/pkgconfig/rhotrack\.pc'
usual+='|lib/cmake/rhotrack/rhotrackConfig(Version)?\.cmake)$'
usual+='|^/opt/rt/(include/rhotrack/(detail/)?[a-z_]+\.h|share/doc/rhotrack/LICENSE)$'
usual+='|^/opt/rt/(lib/systemd/system/rhotrack-node\.service|etc/rhotrack/node\.ini)$'
stage=$folder/stage
(umask 077 && install_by_make "$stage" install PREFIX=/opt/rt)
status=$?
check 'make install' exits 0
check 'nothing is put elsewhere' no_files_but "$stage" "$usual"
is_whole() {
    local file
    for file in bin/rhotrack lib/librhotrack.a lib/pkgconfig/rhotrack.pc \
        lib/cmake/rhotrack/rhotrackConfig.cmake; do
        [ -s "$stage/opt/rt/$file" ] || { echo "no $file"; return 1; }
    done
    diff -r "$root/include/rhotrack" "$stage/opt/rt/include/rhotrack" && cmp "$root/LICENSE" \
        "$stage/opt/rt/share/doc/rhotrack/LICENSE"
}
check 'all is there, and headers are as they were' is_whole
check 'everybody may read it' test -z "$(find "$stage/opt" ! -perm -444 -o -type d ! -perm -555)"
leaks_nothing() { ! grep -rlF -e "$stage" -e "$root" "$@"; }
check 'no file knows where it was staged or built' leaks_nothing "$stage/opt"
no_placeholders() { ! grep -rnE '@[A-Z_]+@' "$1"/lib/pkgconfig "$1"/lib/cmake "$1"/lib/systemd; }
check 'templates are filled in' no_placeholders "$stage/opt/rt"
go "$stage/opt/rt/bin/rhotrack" --version
check 'the installed program runs, version of rhotrack.h' test "$(cat stdout)" = \
    "rhotrack $version"


# ---- the service ----
service=$stage/opt/rt/lib/systemd/system/rhotrack-node.service
check 'the service runs the installed program with its settings' grep -q \
    '^ExecStart=/opt/rt/bin/rhotrack node --config /opt/rt/etc/rhotrack/node.ini ' "$service"
if command -v systemd-analyze >/dev/null; then
    sed "s|=/opt/rt/bin|=$stage/opt/rt/bin|" "$service" >rhotrack-node.service
    go systemd-analyze verify ./rhotrack-node.service
    check 'systemd takes it' exits 0
else
    echo 'skipped: install.sh: no systemd-analyze here'
fi
sed 's/^#\([a-z]\)/\1/; s/^#\(\[\)/\1/' "$stage/opt/rt/etc/rhotrack/node.ini" >all.ini
go "$stage/opt/rt/bin/rhotrack" config --config all.ini
check 'its settings are taken, those behind # as well' exits 0
echo 'v_max_mps = 500' >"$stage/opt/rt/etc/rhotrack/node.ini"
install_by_make "$stage" install-program PREFIX=/opt/rt
check 'settings that are there stay' grep -qx 'v_max_mps = 500' \
    "$stage/opt/rt/etc/rhotrack/node.ini"

# ---- pkg-config ----
export PKG_CONFIG_LIBDIR=$stage/opt/rt/lib/pkgconfig
says_flags() { # arguments..., the words expected
    local words=${*: -1}
    test "$(pkg-config "${@:1:$#-1}" rhotrack | xargs)" = "$words" || { pkg-config \
        "${@:1:$#-1}" rhotrack; return 1; }
}
check 'pkg-config: flags' says_flags --cflags --libs '-I/opt/rt/include -L/opt/rt/lib -lrhotrack'
check 'pkg-config: version' says_flags --modversion "$version"
PKG_CONFIG_SYSROOT_DIR=$stage go make -C examples/pkg_config
check 'pkg-config example builds from a stage' exits 0
check '... and tracks' tracks examples/pkg_config/example "$embedded"
mv "$stage/opt/rt" moved
export PKG_CONFIG_LIBDIR=$folder/moved/lib/pkgconfig
go make -B -C examples/pkg_config PKG_CONFIG='pkg-config --define-prefix'
check 'pkg-config example builds from a tree that was moved' exits 0
check '... and tracks' tracks examples/pkg_config/example "$embedded"

# ---- other capacities than the library's ----
refuses() { go "$1" && exits 1 && grep -qx 'tracker: size' stdout || { cat stdout; return 1; }; }
for flags in -DRHO_MAX_TRACKS=31 -DRHO_PROFILE_WORKSTATION \
    "-I.. -DRHO_CONFIG_FILE='\"my_config.h\"'"; do
    go make -B -C examples/pkg_config PKG_CONFIG='pkg-config --define-prefix' CFLAGS="$flags"
    check "an application with $flags builds" exits 0
    check '... and is told RHO_ERROR_SIZE' refuses examples/pkg_config/example
done

# ---- capacities of one's own, installed ----
odd='PREFIX=/usr LIBDIR=/usr/lib/odd INCLUDEDIR=/inc/odd DOCDIR=/usr/doc-rt'
# shellcheck disable=SC2086 # words on purpose
install_by_make "$folder/own" install-lib $odd RHO_CONFIG_FILE="$own" BUILD="$folder/build-own" \
    OPT=-O0
check 'make install-lib with RHO_CONFIG_FILE, in odd folders' exits 0
check 'nothing is put elsewhere' no_files_but own \
    '^/usr/lib/odd/(librhotrack\.a|(pkgconfig|cmake)/.*)$'\
'|^/inc/odd/rhotrack/(detail/)?[a-z_]+\.h$|^/usr/doc-rt/LICENSE$'
check 'no file knows where it was staged or built' leaks_nothing own -e "$folder"
export PKG_CONFIG_LIBDIR=$folder/own/usr/lib/odd/pkgconfig
check 'pkg-config: odd folders' says_flags --cflags --libs '-I/inc/odd -L/usr/lib/odd -lrhotrack'
PKG_CONFIG_SYSROOT_DIR=$folder/own go make -B -C examples/pkg_config
check 'an application that knows nothing of them builds' exits 0
check '... has these capacities, and tracks' tracks examples/pkg_config/example "$small"
unset PKG_CONFIG_LIBDIR
# shellcheck disable=SC2086 # words on purpose
install_by_make "$folder/own" install-lib $odd BUILD="$folder/build-own" OPT=-O0 RHO_CONFIG_FILE=
check 'without it the library is compiled anew' exits 0
go cc -std=c99 -Iown/inc/odd -o embedded examples/main.c own/usr/lib/odd/librhotrack.a
check '... and tracks' tracks ./embedded "$embedded"

refuses_to_install() { # pattern, arguments...
    go make -s -C "$root" BUILD="$build" DESTDIR="$folder/none" "${@:2}" install-lib
    exits 2 && [ ! -e none ] && matches "$(cat stderr)" "*$1*"
}
check 'PREFIX that is no path' refuses_to_install 'begin with /' PREFIX=here
check 'unknown PROFILE' refuses_to_install 'PROFILE is' PROFILE=desktop
check 'PROFILE and RHO_CONFIG_FILE' refuses_to_install \
    'is for PROFILE=embedded' PROFILE=workstation \
    RHO_CONFIG_FILE="$own" BUILD="$folder/build-own"
check 'capacities by -D' refuses_to_install 'would not be installed' \
    LIBRARY_CFLAGS=-DRHO_MAX_TRACKS=4

# ---- the workstation profile, and make uninstall ----
install_by_make "$folder/big" install PREFIX=/opt/rt PROFILE=workstation
check 'make install PROFILE=workstation' exits 0
go cc -std=c99 -Ibig/opt/rt/include -o big-example examples/main.c big/opt/rt/lib/librhotrack.a
check 'an application that knows nothing of it builds' exits 0
check '... and tracks' tracks ./big-example '[0-9]{7}'
: >big/opt/rt/include/rhotrack/mine.h
install_by_make "$folder/big" uninstall PREFIX=/opt/rt
check 'make uninstall' exits 0
left() { test "$(find big ! -type d)" = "$1" || { find big; return 1; }; }
check '... takes everything but what it did not install' left big/opt/rt/include/rhotrack/mine.h
rm big/opt/rt/include/rhotrack/mine.h
install_by_make "$folder/big" uninstall PREFIX=/opt/rt
check '... and its own folders' test -z "$(find big -name '*rhotrack*')"
# shellcheck disable=SC2086 # words on purpose
install_by_make "$folder/own" uninstall $odd
check '... where folders are odd' test -z "$(find own ! -type d -o -name '*rhotrack*')"

# ---- copies of include/ and src/ ----
mkdir copies
cp -r "$root/include" "$root/src" copies/
go make -s -j2 -C examples/drop_in RHOTRACK="$folder/copies" CFLAGS=-O0
check 'drop-in example builds' exits 0
check '... has its own capacities, and tracks' tracks examples/drop_in/example "$small"

# ---- CMake ----
configure() { # source, binary, options...: without what the environment says
    go cmake -S "$1" -B "$2" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "${@:3}"
    exits 0
}
make_by_cmake() { # binary
    go cmake --build "$1" -j2
    exits 0
}
takes() { # folder of the package: find_package has the versions that it should have, and no others
    local minor=${version%.*}
    local good="$version;$version EXACT;$minor;$minor...9.5;0.0...$version" \
        bad="0.0;0.2;1;1.1;$minor.99;$minor.1...9.5;0.0...<$version"
    mkdir -p ask
    cat >ask/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.19)
project(ask C)
foreach(version IN LISTS VERSIONS ITEMS "")
    separate_arguments(words UNIX_COMMAND "\${version}")
    find_package(rhotrack \${words} CONFIG QUIET PATHS "$1" NO_DEFAULT_PATH)
    message("'\${version}' \${rhotrack_FOUND}")
    unset(rhotrack_DIR CACHE)
endforeach()
END
    configure ask "asked-$passed" "-DVERSIONS=$good;$bad" || return 1
    grep "^'" stderr >answers
    # shellcheck disable=SC2086 # words on purpose
    (IFS=';'; printf "'%s' 1\n" $good; printf "'%s' 0\n" $bad; echo "'' 1") | diff - answers
}
same_flags() { # commands of the library's files: C99, and these at the end, after the application's
    grep '"command".*/src/' "$1" >commands && [ "$(wc -l <commands)" -ge 50 ] &&
        ! grep -vE -- '-ffast-math .* -fno-fast-math -ffp-contract=off .*-std=c99 ' commands
}
natively_by_cmake() {
    configure examples/find_package found -DCMAKE_PREFIX_PATH="$folder/moved"
    check 'find_package finds a tree that was moved' exits 0
    make_by_cmake found
    check 'find_package example builds' exits 0
    check '... and tracks' tracks found/example "$embedded"
    check 'versions: those of the same 0.y alone' takes "$folder/moved/lib/cmake/rhotrack"

    configure "$root" cmake-build -DCMAKE_BUILD_TYPE=Debug -DRHOTRACK_CONFIG_FILE="$own" \
        -DCMAKE_INSTALL_LIBDIR=lib
    check 'CMake configures the library with RHOTRACK_CONFIG_FILE' exits 0
    make_by_cmake cmake-build
    check '... builds it' exits 0
    DESTDIR=$folder/cmade go cmake --install cmake-build --prefix /opt/rt
    check '... and installs it' exits 0
    check 'nothing is put elsewhere' no_files_but cmade "$usual|/rhotrackConfig-debug.cmake$"
    check 'no file knows where it was staged or built' leaks_nothing -I cmade -e "$folder"
    check 'templates are filled in' no_placeholders cmade/opt/rt
    check 'versions: those of the same 0.y alone' takes "$folder/cmade/opt/rt/lib/cmake/rhotrack"
    configure examples/find_package found-own -DCMAKE_PREFIX_PATH="$folder/cmade/opt/rt" \
        && make_by_cmake found-own
    check 'find_package example builds with it' exits 0
    check '... has the capacities, and tracks' tracks found-own/example "$small"
    export PKG_CONFIG_LIBDIR=cmade/opt/rt/lib/pkgconfig
    check 'pkg-config says the same of it' says_flags --cflags --libs \
        '-I/opt/rt/include -L/opt/rt/lib -lrhotrack'
    check '... and its version' says_flags --modversion "$version"
    unset PKG_CONFIG_LIBDIR

    configure examples/add_subdirectory added -DRHOTRACK="$root" -DCMAKE_BUILD_TYPE=Debug \
        -DRHOTRACK_PROFILE=workstation
    make_by_cmake added
    check 'add_subdirectory example builds' exits 0
    check '... has the profile, and tracks' tracks added/example '[0-9]{7}'
    DESTDIR=$folder/added-stage go cmake --install added --prefix /opt/rt
    check '... and installs nothing of the library' test ! -e added-stage
    configure examples/add_subdirectory flags -DRHOTRACK="$root" \
        -DCMAKE_C_FLAGS='-ffast-math -ffp-contract=fast'
    check 'no fused operations, no fast-math, whatever the application compiles with' same_flags \
        flags/compile_commands.json
    configure "$root" wrong -DRHOTRACK_PROFILE=desktop
    check 'unknown RHOTRACK_PROFILE' grep -q 'RHOTRACK_PROFILE is embedded or workstation' stderr
    configure "$root" wrong2 -DRHOTRACK_CONFIG_FILE="$folder/none.h"
    check 'a RHOTRACK_CONFIG_FILE that is not there' grep -q 'there is no .*none.h' stderr
}
if command -v cmake >/dev/null 2>&1; then
    natively_by_cmake
else
    echo 'skipped: CMake: not installed'
fi

# ---- RAM ----
nm_bytes() { # symbol, file, nm
    local bytes
    bytes=$("$3" -S "$2" | awk -v symbol="$1" '$4 == symbol {print $2}')
    echo $((16#${bytes:-0}))
}
sizeof() { # object, compiler and flags...: its bytes
    local header=${1#rho_}
    [ "$header" != report ] || header=tracker
    printf '#include "rhotrack/%s.h"\nchar object[sizeof(struct %s)];\n' "$header" "$1" |
        "${@:2}" -std=c99 -I"$root/include" -fno-common -x c -c -o object.o - \
            && nm_bytes object object.o nm
}
holds_table() { # compiler and flags...
    local object bytes sums=(0 0 0 0 0) column
    for object in rho_tracker rho_initiator rho_report rho_scan_assembler; do
        for column in 3 4; do
            bytes=$(if [ "$column" = 3 ]; then sizeof "$object" "$@"; else sizeof "$object" "$@" \
                "-DRHO_CONFIG_FILE=\"$own\""; fi)
            [ "$bytes" = "$(ram "$object" "$column")" ] || { echo \
                "$object: $bytes bytes, not $(ram "$object" "$column")"; return 1; }
            [ "$object" = rho_scan_assembler ] || sums[column]=$((sums[column] + bytes))
        done
    done
    [ "${sums[3]} ${sums[4]}" = "$(ram together 3) $(ram together 4)" ] || { echo \
        "together: ${sums[*]}"; return 1; }
}

# ---- for a Cortex-M4F ----
has_fused() { arm-none-eabi-objdump -d "$@" | grep -qP '\tvfn?m[as]'; }
has_none_fused() { [ -s "$1" ] && arm-none-eabi-objdump -d "$@" >listing && [ -s listing ] \
    && ! has_fused "$@"; }
ram_of() { # program, column: its static objects take what the table says
    local object bytes
    for object in tracker initiator report; do
        bytes=$(nm_bytes "$object" "$1" arm-none-eabi-nm)
        [ "$bytes" = "$(ram "rho_$object" "$2")" ] || { echo \
            "$object: $bytes bytes, not $(ram "rho_$object" "$2")"; return 1; }
    done
}
for_cortex() {
    # shellcheck disable=SC2086 # words on purpose
    check 'the table of RAM is true' holds_table arm-none-eabi-gcc $cortex
    rm -rf examples/drop_in/build examples/drop_in/example
    go make -s -j2 -C examples/drop_in RHOTRACK="$folder/copies" CC=arm-none-eabi-gcc \
        CFLAGS="-Os $cortex -ffp-contract=fast" LDFLAGS=--specs=rdimon.specs
    check 'drop-in example links for a Cortex-M4F' exits 0
    check '... with the RAM of the table' ram_of examples/drop_in/example 4
    check '... and no fused operation, whatever the application compiles with' has_none_fused \
        examples/drop_in/build/src/*/*.o
    install_by_make "$folder/m4" install-lib PREFIX=/opt/m4 BUILD="$folder/build-m4" \
        CC=arm-none-eabi-gcc AR=arm-none-eabi-ar \
        OPT=-O0 CFLAGS="$cortex"
    check 'make install-lib for a Cortex-M4F' exits 0
    # shellcheck disable=SC2086 # words on purpose
    go arm-none-eabi-gcc $cortex -Im4/opt/m4/include -o m4-example examples/main.c -Lm4/opt/m4/lib \
        -lrhotrack --specs=rdimon.specs
    check '... and an application links with it' exits 0
    command -v cmake >/dev/null 2>&1 || return
    configure examples/find_package m4-found -DCMAKE_PREFIX_PATH="$folder/m4/opt/m4"
    check 'find_package for this machine does not take it' grep -q 'pointers of 4 bytes' stderr
    configure examples/add_subdirectory m4-added -DRHOTRACK="$root" -DCMAKE_BUILD_TYPE=Debug \
        -DCMAKE_TOOLCHAIN_FILE=cortex-m4f.cmake
    make_by_cmake m4-added
    check 'add_subdirectory example links for a Cortex-M4F' exits 0
    check '... with the RAM of the table' ram_of m4-added/example 3
}
if echo '#include <stdio.h>' | arm-none-eabi-gcc -E - >detail 2>&1; then
    for_cortex
else
    echo 'skipped: Cortex-M4F: no arm-none-eabi-gcc with newlib here'
    check 'the table of RAM is true' holds_table cc
fi

finish
