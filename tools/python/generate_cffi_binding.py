# SPDX-License-Identifier: MIT
"""Writes the C of the module rhotrack._native: all of the library's headers, and
python_interface.h.

Usage: generate_cffi_binding.py OUTPUT COMPILER INCLUDE (the folder with rhotrack/). The headers say
what Python sees, so that nothing is declared twice: the preprocessor resolves capacities, and cffi
reads what it leaves.
"""
import re
import subprocess
import sys
from pathlib import Path

from cffi import FFI

HERE = Path(__file__).resolve().parent
FLAGS = ["-std=c11", "-DRHO_PROFILE_WORKSTATION"]
SOURCE = '#include "python_interface.h"\n#include "rhotrack/detail/angle.h"\n'
MACROS = ("RHO_MAX_PLOTS", "RHO_MAX_BEARINGS", "RHO_HOUGH_VOTE", "RHO_PAPER_RHO_CELLS",
          "RHO_MEASURES_RANGE_RATE", "RHO_LEARNED_REFLECTORS")


def declarations(compiler, include):
    """What the headers declare, without those of the system, inline functions, and tests of
    capacities."""
    command = [compiler, "-E", *FLAGS, f"-I{include}", f"-I{HERE}", "-x", "c", "-"]
    text = subprocess.run(command, input=SOURCE, capture_output=True, text=True, check=True).stdout
    lines, is_own = [], False
    for line in text.splitlines():
        if marker := re.match(r'#.*"(.*?)"', line):
            is_own = "/rhotrack/" in marker[1] or marker[1].endswith(
                "python_interface.h")
        elif is_own:
            lines.append(line)
    text = re.sub(r"static inline [^{;]*\{.*?\n\}|__attribute__\(\(\w+\)\)|"
                  r"typedef char \w+_must_be_[^;]*;", "", "\n".join(lines), flags=re.DOTALL)
    return re.sub(r"\[([^]]*\?[^]]*)\]", lambda size: f"[{chosen(size[1])}]", text)


def chosen(size):
    """The size of an array whose conditional expressions cffi does not read."""
    size, num = re.sub(r"\((\d+)u?\)", r"\1", f"({size})").replace("/", "//"), 1
    while num:
        size, num = re.subn(r"\(([^()?]+)\?([^()?:]+):([^()?]+)\)",
                            r"((\2) if \1 else (\3))", size)
    return eval(size)


def main(output, compiler, include):
    ffi = FFI()
    ffi.cdef(declarations(compiler, include))
    ffi.cdef("\n".join(f"#define {name} ..." for name in MACROS))
    ffi.cdef('extern "Python" void node_sent(void *, const char *, const uint8_t *, size_t);')
    ffi.set_source("rhotrack._native", SOURCE)
    ffi.emit_c_code(output)


main(*sys.argv[1:])
