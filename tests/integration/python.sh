#!/bin/bash
# SPDX-License-Identifier: MIT
# The package for Python (tools/python): pip builds and installs it, and it passes tests/python, the
# program's bytes among them; make python-dist's wheel and source package work in environments that
# have nothing else, the wheel with every Python at hand.
root=$(realpath "$(dirname "$0")/../..")
build=$(cd "$root" && realpath -m "${BUILD:-build}")
# shellcheck source=tests/integration/checks.bash
. "$(dirname "$0")/checks.bash"
export RHOTRACK=$program PYTHONDONTWRITEBYTECODE=1 PIP_DISABLE_PIP_VERSION_CHECK=1

if ! { python3 -m venv first && first/bin/pip install -q --retries 1 --timeout 20 cffi numpy; } \
    >stderr 2>&1; then
    echo "skipped: python: no environment with cffi and numpy: $(tail -n 1 stderr)"
    finish
fi

pytest() { # environment, arguments...
    "$1/bin/python" -m pytest -q -p no:cacheprovider "${@:2}"
}

install() { # environment, packages...
    "$1/bin/pip" install -q "${@:2}"
}

check 'pip installs the sources' install first "$root/tools/python"
check 'and what the tests import' install first pytest pandas polars matplotlib scipy mcap \
    mcap-ros2-support mcap-protobuf-support foxglove-schemas-protobuf
check 'the package does what it says' pytest first "$root/tests/python/test_python_interface.py"
check 'its bytes are the programs' pytest first "$root/tests/python/test_golden.py"
quick() { # the machine may be busy with something else for a while
    first/bin/python "$root/tests/bench/python_steps.py" || first/bin/python \
        "$root/tests/bench/python_steps.py"
}
check 'scans in memory take little longer than in C' quick
cat detail

# ---- Packages ----
check 'make python-dist' make -s -C "$root" BUILD="$build" python-dist
use='import rhotrack
scans = rhotrack.read("plots.csv", sigma_m=5)
print(len(scans), len(rhotrack.Tracker(sigma_m=5).run(scans)))'
ln -s "$root/tools/scenes/harbour/2/plots.csv" plots.csv
first/bin/python -c "$use" >expected
used() { # name, interpreter, package: in an environment of its own
    "$2" -m venv "$1" && "$1/bin/pip" install -q "$3" && "$1/bin/python" -c "$use" >"$1.out" \
        && cmp expected "$1.out"
}
check 'the source package is built and used' used source python3 "$build"/python/rhotrack-*.tar.gz
seen=' '
for python in /usr/bin/python3 python3.{9..14} \
    "${PYENV_ROOT:-$HOME/.pyenv}"/versions/*/bin/python3; do
    version=$("$python" -c 'import sys, ensurepip
assert sys.version_info >= (3, 9)
print("%d.%d" % sys.version_info[:2])' 2>/dev/null) || continue
    case $seen in *" $version "*) continue ;; esac
    seen+="$version "
    check "the wheel is used by Python $version" used "wheel-$version" "$python" \
        "$build"/python/rhotrack-*.whl
done
finish
