# SPDX-License-Identifier: MIT
"""For the tests beside it: the lab's modules can be imported, and a test program counts as
tests/run.sh wants it."""
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "lab"))


def need_packages():
    """Ends the program, well, where the lab's packages are not installed (make experiments installs
    them)."""
    try:
        import matplotlib, numpy, scipy  # noqa: F401
    except ImportError as error:
        print(f"skipped: no {error.name} (tools/setup.sh lab)\n0 passed, 0 failed")
        sys.exit(0)


def main():
    result = unittest.main(exit=False, verbosity=2).result
    bad = len(result.failures) + len(result.errors)
    sys.stderr.flush()
    print(f"{result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad > 0)
