#!/bin/bash
# SPDX-License-Identifier: MIT
# The packages of tools/packaging: each has the version of rhotrack/rhotrack.h and all sources; each
# is built by its tool where that is to be had, else as its tool would do it; its program tracks. Of
# the Debian packages lintian finds nothing, and they are installed in a folder. Runs beside others.
root=$(realpath "$(dirname "$0")/../..")
build=$(cd "$root" && realpath -m "${BUILD:-build}")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
unset RHOTRACK DESTDIR PKG_CONFIG_PATH PKG_CONFIG_LIBDIR
packages=$folder/packages
version=$(awk '$2 ~ /^RHO_VERSION_[MP]/ {v = v s $3; s = "."} END {print v}' \
    "$root/include/rhotrack/rhotrack.h")
tree=$packages/rhotrack-$version
main=$root/tools/examples/main.c
quick='-DCMAKE_BUILD_TYPE=Debug'

go() { # command: exit code in $status, output in the files stdout and stderr
    status=0
    "$@" >stdout 2>stderr </dev/null || status=$?
    exits 0
}
tracks() { # program: it finds its track; the bytes of its tracker are in the file bytes
    go "$1" && grep -q 'tracks: 1; .* confirmed, at 3500 m, 250 m/s' stdout \
        && sed -n 's/.*tracker \([0-9]*\),.*/\1/p' stdout >bytes
}
cmake_builds() { # source, binary, options...
    go cmake -S "$1" -B "$2" "$quick" "${@:3}" && go cmake --build "$2" -j2
}

# ---- one version, one list of sources ----
descriptions() { # folder: the files that state a version, in it
    local found=$1/described
    mkdir -p "$found"
    unzip -p "$1"/*.pack rhotrack.rhotrack.pdsc >"$found/rhotrack.pdsc"
    printf '%s\n' "$found/rhotrack.pdsc" "$1"/rhotrack-*/{conanfile.py,meson.build} \
        "$1"/rhotrack-*/{idf_component.yml,zephyr/Kconfig} "$1"/arduino/rhotrack/library.* \
        "$1"/vcpkg/rhotrack/* "$1/debian/changelog" | grep -v 'tar.gz$'
}
all_state() { # folder, version
    local file wrong=0
    for file in $(descriptions "$1"); do
        grep -qF "$2" "$file" || { echo "$file does not state $2"; wrong=1; }
    done
    return "$wrong"
}
mkdir other
(cd "$root" && cp -r --parents include src tools/packaging tools/install CMakeLists.txt LICENSE \
    CHANGELOG.md tools/rhotrack/picture/interactive_map_page "$folder/other")
sed -i 's/\(VERSION_MAJOR\) .*/\1 7/; s/\(VERSION_MINOR\) .*/\1 8/; s/\(VERSION_PATCH\) .*/\1 9/' \
    other/include/rhotrack/rhotrack.h
echo 'int rho_another;' >other/src/base/another.c
check 'packages of another version' go other/tools/packaging/write_source_packages.py others
check '... all state it' all_state others 7.8.9
says_no_other() { ! grep -lF "$version" $(descriptions others); }
check '... and none the one of this one' says_no_other
has_another() { grep -q another.c others/rhotrack-7.8.9/{meson.build,zephyr/CMakeLists.txt} \
    && grep -q another.c others/described/rhotrack.pdsc; }
check 'a new source is in their lists' has_another
check 'the Python package has this version' grep -qx "version = \"$version\"" \
    "$root/tools/python/pyproject.toml"
check '... and says so' grep -qx "__version__ = \"$version\"" \
    "$root/tools/python/rhotrack/__init__.py"

check 'packages' go "$root/tools/packaging/write_source_packages.py" "$packages"
check '... of this version' all_state "$packages" "$version"
check 'made again, they are the same' eval 'mv "$packages" first && sleep 2 && go \
    "$root/tools/packaging/write_source_packages.py" "$packages" &&
    diff -r -x described first "$packages"'
refused() { # words of the message, options
    ! go "$root/tools/packaging/write_source_packages.py" "${@:2}" none && [ ! -e none ] \
        && grep -qF -e "$1" stderr
}
check 'a packager without an address is refused' refused 'NAME <MAIL>' --packager nobody
check 'an address that files of packages would take apart' refused \
    '--url https://x/?a=1&b: it is http' --url 'https://x/?a=1&b'
SOURCE_DATE_EPOCH=noon check 'a time that is none' refused 'SOURCE_DATE_EPOCH=noon: it is seconds'
! go make -s -C "$root" BUILD="$folder/made" packages PACKAGER="O'Neil"
check "make passes on a packager's apostrophe" grep -q "packager O'Neil: it is NAME" stderr

# ---- CMake, Meson ----
cp -r "$root/tools/examples" .
check 'CMake builds the tree' cmake_builds examples/add_subdirectory cmade -DRHOTRACK="$tree"
check '... and its program tracks' tracks cmade/example
cp bytes embedded
if command -v meson >/dev/null && command -v ninja >/dev/null; then
    check 'Meson builds the tree' eval 'go meson setup --buildtype=debug mesoned "$tree" \
        --prefix="$folder/meson" --libdir=lib -Dprofile=workstation && go ninja -C mesoned'
    check '... and installs it' go meson install -C mesoned
    check '... with its profile, and a program tracks' eval \
        'go cc -o meson-example "$main" $(PKG_CONFIG_LIBDIR=meson/lib/pkgconfig pkg-config \
        --cflags --libs rhotrack) && tracks ./meson-example && [ "$(cat bytes)" -gt 1000000 ]'
    mkdir -p sub/subprojects
    cp -r "$tree" sub/subprojects/rhotrack
    cp "$main" sub
    cat >sub/meson.build <<'END'
project('app', 'c')
executable('app', 'main.c', dependencies: dependency('rhotrack', fallback: 'rhotrack'))
END
    check '... as a subproject, with capacities of its own' eval 'go meson setup --buildtype=debug \
        subbed sub -Drhotrack:config_file="$folder/examples/my_config.h" && go ninja -C subbed'
    check '... that tracks' eval 'tracks subbed/app && [ "$(cat bytes)" -lt "$(cat embedded)" ]'
else
    echo 'skipped: packages: no meson here (tools/setup.sh packages installs it)'
fi

# ---- Arduino, PlatformIO ----
arduino=$packages/arduino/rhotrack/src
check 'one include path is enough' eval 'go cc -std=c99 -O0 -ffp-contract=off -I"$arduino" \
    -o arduino "$main" "$arduino"/*/*.c && tracks ./arduino'

# ---- ESP-IDF ----
mkdir esp zephyr port
cat >esp/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.16)
project(app C)
function(idf_component_register)
    cmake_parse_arguments(it "" "" "SRCS;INCLUDE_DIRS" ${ARGN})
    add_library(component STATIC ${it_SRCS})
    target_include_directories(component PUBLIC ${it_INCLUDE_DIRS})
    set(COMPONENT_LIB component PARENT_SCOPE)
endfunction()
set(ESP_PLATFORM 1)
add_subdirectory("${TREE}" component)
add_executable(app "${MAIN}")
target_link_libraries(app component)
END
check 'ESP-IDF: the component is built' cmake_builds esp esped -DTREE="$tree" -DMAIN="$main"
check '... and its program tracks' tracks esped/app

# ---- Zephyr ----
cat >zephyr/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.20)
project(app C)
add_library(interface INTERFACE)
function(zephyr_include_directories)
    target_include_directories(interface INTERFACE ${ARGN})
endfunction()
function(zephyr_compile_definitions)
    target_compile_definitions(interface INTERFACE ${ARGN})
endfunction()
function(zephyr_library_named name)
    add_library(${name} STATIC)
    target_link_libraries(${name} PUBLIC interface)
endfunction()
function(zephyr_library_compile_options)
    target_compile_options(rhotrack PRIVATE ${ARGN})
endfunction()
function(zephyr_library_sources)
    target_sources(rhotrack PRIVATE ${ARGN})
endfunction()
include("${CONFIG}")
add_subdirectory("${TREE}/zephyr" module)
add_executable(app "${MAIN}")
target_link_libraries(app rhotrack)
END
# The defaults of Kconfig, but for 8 tracks.
sed -n 's/^config \(.*\)/\1/p; s/^\tdefault //p' "$tree/zephyr/Kconfig" | paste - - |
    sed 's/^\(.*\)\t\(.*\)$/set(CONFIG_\1 \2)/; s/\(MAX_TRACKS\) .*/\1 8)/
        $a set(CONFIG_RHOTRACK y)' >config.cmake
check 'Kconfig has the capacities' test "$(wc -l <config.cmake)" -ge 40
check 'Zephyr: the module is built' cmake_builds zephyr zephyred -DTREE="$tree" -DMAIN="$main" \
    -DCONFIG="$folder/config.cmake"
check '... and tracks, with the capacities of Kconfig' eval \
    'tracks zephyred/app && [ "$(cat bytes)" -lt $(($(cat embedded) - 10000)) ]'
module_fits() {
    python3 - "$tree" <<'END'
import pathlib, sys
tree = pathlib.Path(sys.argv[1])
lines = [line.split(": ") for line in (tree / "zephyr/module.yml").read_text().splitlines()]
said = {key.strip(): value for key, *value in lines}
assert said["name"] == ["rhotrack"] and (tree / said["cmake"][0] / "CMakeLists.txt").is_file()
assert (tree / said["kconfig"][0]).is_file()
assert {key for key in said if key[0] != "#"} == {"name", "build:", "cmake", "kconfig"}, said
END
}
check 'module.yml names what is there' module_fits

# ---- vcpkg ----
cat >port/run.cmake <<'END'
cmake_minimum_required(VERSION 3.20)
function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(vcpkg_check_linkage)
endfunction()
function(vcpkg_extract_source_archive out kind archive)
    run(tar xzf ${archive} --strip-components 1)
    set(${out} "${CMAKE_CURRENT_BINARY_DIR}" PARENT_SCOPE)
endfunction()
function(vcpkg_cmake_configure)
    cmake_parse_arguments(it "" "SOURCE_PATH" "OPTIONS" ${ARGN})
    run("${CMAKE_COMMAND}" -S "${it_SOURCE_PATH}" -B built -DCMAKE_BUILD_TYPE=Debug
        "-DCMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR}" -DCMAKE_INSTALL_LIBDIR=lib ${it_OPTIONS})
endfunction()
function(vcpkg_cmake_install)
    run("${CMAKE_COMMAND}" --build built -j2 --target install)
endfunction()
function(vcpkg_cmake_config_fixup kind path)
    run("${CMAKE_COMMAND}" -E rename "${CURRENT_PACKAGES_DIR}/${path}"
        "${CURRENT_PACKAGES_DIR}/share/rhotrack")
endfunction()
function(vcpkg_fixup_pkgconfig)
endfunction()
function(vcpkg_install_copyright kind file)
    run("${CMAKE_COMMAND}" -E copy "${file}" "${CURRENT_PACKAGES_DIR}/share/rhotrack/copyright")
endfunction()
set(FEATURES core workstation)
include("${CURRENT_PORT_DIR}/portfile.cmake")
END
port() {
    (cd port && cmake -DCURRENT_PORT_DIR="$packages/vcpkg/rhotrack" \
        -DCURRENT_PACKAGES_DIR="$folder/vcpkg" -P run.cmake >"$folder/stdout" 2>"$folder/stderr")
}
check 'vcpkg: the port is built' port
check '... and tracks, with its feature' eval 'go cc -o vcpkged -Ivcpkg/include "$main" \
    vcpkg/lib/librhotrack.a && tracks ./vcpkged && [ "$(cat bytes)" -gt 1000000 ]'
check '... its licence is there' cmp "$root/LICENSE" vcpkg/share/rhotrack/copyright
check '... and is described' json "$packages/vcpkg/rhotrack/vcpkg.json" \
    "o['name'] == 'rhotrack' and o['version-semver'] == '$version' and all(
        set(d) == {'name', 'host'} for d in o['dependencies'])"

# ---- CMSIS ----
pack_is_whole() {
    python3 - "$packages/rhotrack.rhotrack.$version.pack" "$root" <<'END'
import pathlib, sys, zipfile
import xml.etree.ElementTree as xml
pack, root = zipfile.ZipFile(sys.argv[1]), pathlib.Path(sys.argv[2])
described = xml.fromstring(pack.read("rhotrack.rhotrack.pdsc"))
names = [one.get("name") for one in described.iter("file")]
missing = [name for name in names if not any(there.startswith(name) for there in pack.namelist())]
sources = {path.relative_to(root).as_posix() for path in root.glob("src/*/*.c")}
assert not missing and sources <= set(names) and len(sources) > 100, missing
END
}
check 'CMSIS: the pack has what it describes' pack_is_whole

# ---- tools of the package index ----
tools=$build/packages-tools
if [ -x "$tools/bin/conan" ] || { python3 -m venv "$tools" && "$tools/bin/pip" install -q \
    --disable-pip-version-check --retries 1 --timeout 20 conan platformio idf-component-manager \
    kconfiglib; } >stderr 2>&1; then
    export CONAN_HOME=$folder/conan PLATFORMIO_CORE_DIR=$folder/pio IDF_TOOLS_PATH=$folder/idf
    conan() { go "$tools/bin/conan" "$@"; }
    check 'Conan builds its package' eval \
        'conan profile detect && conan create "$tree" -s build_type=Debug'
    check '... and a program with it' eval 'conan install --requires "rhotrack/$version" \
        -s build_type=Debug -g CMakeDeps -g CMakeToolchain -of conaned && cmake_builds \
        examples/find_package conaned/built \
        -DCMAKE_TOOLCHAIN_FILE="$folder/conaned/conan_toolchain.cmake"'
    check '... that tracks' tracks conaned/built/example
    platformio_takes() { # file
        "$tools/bin/python" - "$1" <<'END'
import sys
from platformio.package.manifest.parser import ManifestParserFactory
from platformio.package.manifest.schema import ManifestSchema
ManifestSchema.load_spdx_licenses = staticmethod(lambda: {"licenses": [{"licenseId": "MIT"}]})
ManifestSchema().load_manifest(ManifestParserFactory.new_from_file(sys.argv[1]).as_dict())
END
    }
    check 'PlatformIO: its schema takes library.json' platformio_takes \
        "$packages/arduino/rhotrack/library.json"
    check '... and that of Arduino' platformio_takes "$packages/arduino/rhotrack/library.properties"
    check 'ESP-IDF: its tool takes the manifest' eval \
        'cd "$tree" && go "$tools/bin/compote" manifest lint; cd "$folder"; exits 0'
    kconfig_takes() {
        printf 'mainmenu "test"\nsource "%s"\n' "$tree/zephyr/Kconfig" >Kconfig
        printf 'CONFIG_RHOTRACK=y\nCONFIG_RHO_MAX_TRACKS=8\n' >set.config
        "$tools/bin/python" -c 'import kconfiglib
known = kconfiglib.Kconfig("Kconfig", warn_to_stderr=False)
known.load_config("set.config")
assert known.syms["RHO_MAX_TRACKS"].str_value == "8" and not known.warnings, known.warnings
assert known.syms["RHO_MAX_SCANS"].str_value == "7"
known.syms["RHO_MAX_SCANS"].set_value("13")
assert known.syms["RHO_MAX_SCANS"].str_value == "7"'
    }
    check 'Zephyr: Kconfig is right, with its ranges' kconfig_takes
else
    rm -rf "$tools"
    echo "skipped: packages: no Conan, PlatformIO: $(tail -n 1 stderr)"
fi

# ---- Debian ----
debian() {
    local stage=$folder/debian
    mkdir -p "$stage/var/lib/dpkg"/{updates,info}
    touch "$stage/var/lib/dpkg"/{status,available}
    check 'make deb' go make -s -C "$root" BUILD="$build" deb
    check '... without a finding of lintian' eval 'go lintian --allow-root --fail-on \
        error,warning "$build"/packages/*.deb && [ ! -s stdout ]'
    go dpkg --root="$stage" --force-not-root --force-depends --force-script-chrootless \
        --log=/dev/null -i "$build"/packages/*.deb
    check '... are installed' exits 0
    go "$stage/usr/bin/rhotrack" --version
    check '... the program runs, and has the version' grep -qx "rhotrack $version" stdout
    check '... and its manual' eval \
        'zcat "$stage"/usr/share/man/man1/rhotrack.1.gz | grep -q simulate'
    check '... service and settings are there' test -s \
        "$stage/lib/systemd/system/rhotrack-node.service" -a -s "$stage/etc/rhotrack/node.ini"
    check '... a program is built with the library, and tracks' eval \
        'go cc -o debianed "$main" $(PKG_CONFIG_SYSROOT_DIR=$stage PKG_CONFIG_LIBDIR=$(echo \
        "$stage"/usr/lib/*/pkgconfig) pkg-config --cflags --libs rhotrack) && tracks ./debianed'
    go dpkg --root="$stage" --force-not-root --force-script-chrootless --log=/dev/null -P rhotrack \
        librhotrack-dev
    check '... and go without a trace' test -z "$(find "$stage" -name '*rhotrack*')"
}
if command -v lintian >/dev/null && command -v dh >/dev/null && command -v help2man >/dev/null; then
    debian
else
    echo 'skipped: packages: no lintian, debhelper or help2man (tools/setup.sh packages)'
fi
finish
