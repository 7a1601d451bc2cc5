# SPDX-License-Identifier: MIT
"""Cross-compiles the library for its target processors and reads sizes and symbols of the objects;
used by library_size.py, stack.py, object_restrictions.py and configuration_sizes.py.

Objects are in $BUILD/cross/<target>-<profile><optimisation>/ and are kept until a source, a header,
the compiler or a flag changes. The flags in SIZE_FLAGS are added to every compilation.
"""
import concurrent.futures
import fcntl
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys

HOME = pathlib.Path(__file__).resolve().parent.parent.parent
FLAGS = "-std=c99 -ffp-contract=off -Iinclude"
GRAPH = "-fstack-usage -fcallgraph-info=su"
PROFILES = {"embedded": "", "workstation": "-DRHO_PROFILE_WORKSTATION"}


class Target:
    """A target processor: its title, the prefix of its compiler, and the flags that select it."""

    graph = GRAPH

    def __init__(self, title, prefix, flags):
        self.title, self.prefix, self.flags = title, prefix, flags.split()

    def tool(self, name):
        return self.prefix + name

    def is_installed(self):
        return shutil.which(self.tool("gcc")) is not None

    def version(self):
        return run_or_exit([self.tool("gcc"), "-dumpfullversion"]).strip()


ARM, RISCV = "arm-none-eabi-", "riscv64-unknown-elf-"
TARGETS = {
    "m0plus": Target("Cortex-M0+", ARM, "-mcpu=cortex-m0plus -mthumb"),
    "m4f": Target("Cortex-M4F", ARM, "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard"),
    "m7": Target("Cortex-M7", ARM, "-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard"),
    "r5f": Target("Cortex-R5F", ARM, "-mcpu=cortex-r5 -mfpu=vfpv3-d16 -mfloat-abi=hard"),
    "rv32": Target("RISC-V", RISCV, "-march=rv32imafc -mabi=ilp32f --specs=picolibc.specs"),
    # Used where no cross-compiler is installed. Not position-independent, so that constant tables
    # of pointers do not count as data.
    "host": Target("this machine", "", "-fno-pie"),
}


def missing_compilers(names):
    """The compilers of these targets that are not installed."""
    return sorted({TARGETS[name].tool("gcc") for name in names if not TARGETS[name].is_installed()})


def run_or_exit(command, **options):
    """Runs a command and returns its standard output; where it fails, exits with 1 and its
    messages."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout


def cross_folder():
    """The folder $BUILD/cross for all objects, created if missing."""
    folder = pathlib.Path(os.environ.get("BUILD", "build")).absolute() / "cross"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


class Build:
    """All sources of a root compiled for one target: objects is {stem: object file}, with gcc's
    stack files .su and .ci beside each. Everything is compiled anew where the text `also`
    changes."""

    def __init__(self, target, root=".", profile="embedded", optimisation="-Os", also=""):
        self.name, self.target, self.root = target, TARGETS[target], pathlib.Path(root)
        self.flags = [*FLAGS.split(), *self.target.graph.split(), optimisation, *self.target.flags,
                      *PROFILES[profile].split(), *os.environ.get("SIZE_FLAGS", "").split()]
        self.folder, self.also = cross_folder() / f"{target}-{profile}{optimisation}", also
        self.sources = sorted(self.root.glob("src/*/*.c"))
        if not self.sources:
            sys.exit(f"no sources under {self.root.absolute()}")
        self.objects = {source.stem: self.folder / f"{source.stem}.o" for source in self.sources}
        self.folder.mkdir(parents=True, exist_ok=True)
        with open(self.folder / "lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.compile_changed()

    def compile_changed(self):
        """Compiles the objects that are out of date, on all processors."""
        common = hashlib.sha256(" ".join([self.target.version(), *self.flags, self.also]).encode())
        for header in sorted([*self.root.glob("include/**/*.h"), *self.root.glob("src/**/*.h")]):
            common.update(header.read_bytes())
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(lambda source: self.compile_if_changed(source, common.copy()),
                          self.sources))

    def compile_if_changed(self, source, key):
        """Compiles one source unless its object was made from the same content and flags."""
        key.update(source.read_bytes())
        made_of = self.folder / f"{source.stem}.key"
        if made_of.is_file() and made_of.read_text(encoding="utf-8") == key.hexdigest():
            return
        command = [
            self.target.tool("gcc"), *self.flags, "-c", "-o",
            str(self.objects[source.stem].absolute()),
            str(source.relative_to(self.root))
        ]
        run_or_exit(command, cwd=self.root)
        made_of.write_text(key.hexdigest(), encoding="utf-8")

    def text_sizes(self):
        """{stem: bytes of code and constants}; exits with 1 where an object has data or bss."""
        found = {}
        for line in run_or_exit([self.target.tool("size"),
                            *map(str, self.objects.values())]).splitlines()[1:]:
            text, data, bss, *_, name = line.split()
            if int(data) + int(bss) > 0:
                sys.exit(f"{pathlib.Path(name).stem}.c has {data} bytes of data, {bss} of bss")
            found[pathlib.Path(name).stem] = int(text)
        return found

    def symbols(self):
        """(source, type, name) of every symbol of every object, types as printed by nm."""
        sources = {
            str(self.objects[source.stem]): source.relative_to(self.root)
            for source in self.sources
        }
        for line in run_or_exit([self.target.tool("nm"), "-A", *sources]).splitlines():
            made, symbol = line.split(":", 1)
            yield sources[made], symbol.split()[-2], symbol.split()[-1]


def sizes_of_expressions(target, expressions, flags=()):
    """{name: value} of constant expressions on a target: compiles arrays of these sizes, and reads
    them with nm."""
    lines = [
        f'#include "{header.relative_to("include")}"'
        for header in sorted(pathlib.Path("include").glob("**/*.h"))
    ]
    lines += [f"char sized_{name}[{expression}];" for name, expression in expressions.items()]
    made = str(cross_folder() / f"sizes-{os.getpid()}.o")
    run_or_exit([
        TARGETS[target].tool("gcc"), "-std=c99", "-Iinclude", "-fno-common", *TARGETS[target].flags,
        *os.environ.get("SIZE_FLAGS", "").split(), *flags, "-x", "c", "-c", "-o", made, "-"
    ], input="\n".join(lines) + "\n")
    listed = run_or_exit([TARGETS[target].tool("nm"), "-S", made])
    os.remove(made)
    return {
        name: int(size, 16)
        for size, name in re.findall(r"^\w+ (\w+) \w sized_(\w+)$", listed, re.MULTILINE)
    }
