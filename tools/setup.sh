#!/bin/sh
# SPDX-License-Identifier: MIT
# Installs the Debian packages that rhotrack is built and tested with, those that are missing. Quick
# when none is. `setup.sh firmware`: the compilers and emulators for other processors instead;
# `setup.sh spy`: what the viewer for lcm-spy (make spy) needs; `setup.sh lab`: what the experiments
# in Python (make experiments) import; `setup.sh docs`: what the documentation (make docs) is
# written with; `setup.sh python`: what the package for Python is built with; `setup.sh packages`:
# what the other packages are; `setup.sh browser`: what the pages of `plot -o NAME.html` are tested
# in.
set -eu

packages='
gcc                 # compiler
g++                 # tests: programs in C++ use the library, too
libc6-dev           # its C library
clang               # second compiler: warnings, sanitizers, determinism
libclang-rt-14-dev  # the sanitizers of clang
clang-tidy          # make lint
clang-format        # make format, make lint
cppcheck            # make lint
make                # build
binutils            # ar, nm, size
pkg-config          # test of the installed library
cmake               # ... and of the CMake package
libcsv-dev          # the program reads CSV
libinih-dev         # ... and INI
libcjson-dev        # ... and writes JSON
libproj-dev         # ... and knows latitude and longitude
libpcap-dev         # ... and reads network recordings
liblcm-dev          # LCM: providers other than UDP multicast
libcmocka-dev       # unit and scenario tests
liblcm-bin          # lcm-gen: tests of the codec beside the C and the Python that it makes
gnuplot-nox         # pictures
librsvg2-bin        # pictures: SVG to PNG
python3             # make layers, reference vectors
python3-prometheus-client # reads the metrics of a node as Prometheus does
python3-venv        # what tests import goes to build/venv (tools/setup_python.sh)
valgrind            # memory checks, instruction counts
iproute2            # tests on networks of their own: hosts on a bridge
nftables            # ... and the loss on it
'
firmware_packages='
gcc-arm-none-eabi            # make firmware, size, gates: Cortex-M and Cortex-R
libnewlib-arm-none-eabi      # ... and its C library
gcc-riscv64-unknown-elf      # make size, gates: RISC-V
picolibc-riscv64-unknown-elf # ... and the headers of its C library
qemu-system-arm              # runs the images
gcc-arm-linux-gnueabihf      # the same bytes on other processors ...
libc6-dev-armhf-cross
gcc-s390x-linux-gnu          # ... of the other byte order, 64 bits
libc6-dev-s390x-cross
gcc-powerpc-linux-gnu        # ... and 32
libc6-dev-powerpc-cross
qemu-user                    # runs what they compile
'
spy_packages='
openjdk-17-jdk      # the viewer is Java, and shows windows
liblcm-bin          # lcm-gen -j
liblcm-java         # LCM and lcm-spy
libjchart2d-java    # ... which draws with it
'
lab_packages='
python3             # tools/lab
python3-numpy       # ... arrays
python3-scipy       # ... pairing of tracks and targets
python3-matplotlib  # ... pictures
python3-cffi-backend # ... the package rhotrack (make python)
'
docs_packages='
python3-sphinx          # make docs
python3-myst-parser     # ... reads the documents
python3-sphinx-gallery  # ... runs the examples
furo                    # ... looks well on a phone, too
python3-numpy           # what the examples import
python3-scipy
python3-pandas
python3-matplotlib
python3-cffi-backend
'
python_packages='
python3-venv        # environments of their own: pip brings cffi, numpy and the build
python3-pip         # make python
python3-dev         # headers of Debian Python
'
browser_packages='
chromium            # opens pages, driven over a pipe
'
packages_packages='
dpkg-dev            # make deb
debhelper
help2man            # ... the manual page
lintian             # tests of packages
meson
ninja-build
libxml2-utils       # xmllint
'
case ${1:-} in
'') ;;
firmware) packages=$firmware_packages ;;
spy) packages=$spy_packages ;;
lab) packages=$lab_packages ;;
docs) packages=$docs_packages ;;
python) packages=$python_packages ;;
browser) packages=$browser_packages ;;
packages) packages=$packages_packages ;;
*)
    echo "setup: unknown: $1 (there is: firmware, spy, lab, docs, python, packages, browser)" >&2
    exit 2
    ;;
esac

missing=''
for package in $(printf '%s' "$packages" | sed 's/#.*//'); do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$state" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if ! command -v apt-get >/dev/null 2>&1; then
    echo "setup: this is not a Debian system (no apt-get)." \
        "Please install what corresponds to:$missing" >&2
    exit 1
fi
if [ "$(id -u)" -eq 0 ]; then
    as_root=''
elif command -v sudo >/dev/null 2>&1; then
    as_root='sudo'
else
    echo "setup: not root, and no sudo. Please have an administrator run: apt-get install$missing" \
        >&2
    exit 1
fi

install_missing() {
    # shellcheck disable=SC2086 # words on purpose
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q \
        --no-install-recommends $missing
}

echo "setup: installing$missing"
# The package lists are fetched only where those at hand do not do.
if ! install_missing; then
    echo "setup: trying again with fresh package lists"
    $as_root apt-get update -q
    install_missing || {
        echo "setup: could not install:$missing" >&2
        exit 1
    }
fi
