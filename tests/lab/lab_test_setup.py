# SPDX-License-Identifier: MIT
"""For the tests beside it: the lab's modules can be imported, and a test program counts as
tests/run.sh wants it."""
import importlib
import os
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "lab"))
sys.path.append(os.path.join(os.environ.get("BUILD", ROOT / "build"), "python", "site"))


def need_packages(*more):
    """Ends the program, well, where the lab's packages are not installed (tools/setup.sh lab), or
    "rhotrack" is not built (make python)."""
    try:
        for name in ("matplotlib", "numpy", "scipy", *more):
            importlib.import_module(name)
    except ImportError as error:
        print(f"skipped: no {error.name} (tools/setup.sh lab, make python)\n0 passed, 0 failed")
        sys.exit(0)


class folder(tempfile.TemporaryDirectory):
    """A temporary folder, as a path."""

    def __enter__(self):
        return pathlib.Path(super().__enter__())


def main():
    result = unittest.main(exit=False, verbosity=2).result
    bad = len(result.failures) + len(result.errors)
    sys.stderr.flush()
    print(f"{result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad > 0)
