#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the packages of other build systems, from the templates beside, one list of sources
(src/*/*.c) and one version (include/rhotrack/rhotrack.h).

Usage: write_source_packages.py [--packager 'NAME <MAIL>'] [--url URL] FOLDER
FOLDER gets:
  rhotrack-VERSION/         the sources, as CMake, Meson, Conan, ESP-IDF and Zephyr take them
  rhotrack-VERSION.tar.gz   the same
  arduino/rhotrack/         a library for Arduino and PlatformIO
  vcpkg/rhotrack/           a port to overlay
  rhotrack.rhotrack.VERSION.pack  for CMSIS
  debian/                   for `make deb`
What is there of these is written anew.
"""
import argparse
import email.utils
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import time
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
HOME = HERE.parent.parent
DESCRIPTION = "Tracks from radar plots and bearings, without a heap"


def version():
    text = (HOME / "include/rhotrack/rhotrack.h").read_text(encoding="utf-8")
    return ".".join(re.findall(r"^#define RHO_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)$", text, re.M))


def sources():
    return sorted(path.relative_to(HOME).as_posix() for path in HOME.glob("src/*/*.c"))


def macros():
    """(name, default, least, most, comment) of config.h's macros whose embedded default is a
    number."""
    text = (HOME / "include/rhotrack/config.h").read_text(encoding="utf-8")
    ranges = {
        name: (least, most) for name, least, most in
        re.findall(r"RHO_CONFIG_RANGE\((RHO_\w+), (\d+), (\d+)\)", text) +
        re.findall(r'#error "(RHO_\w+) must be [^"]*?(\d+) \.\. (\d+)"', text)
    }
    comment = ""
    pattern = r"/\*(.*?)\*/|^#ifndef (RHO_\w+)\n#define \2 +([^\n]*)$"
    for found in re.finditer(pattern, text, re.S | re.M):
        if found[1] is not None:
            comment = re.sub(r"\s*\n \*? ?", " ", found[1]).strip()
            continue
        default = re.fullmatch(r"(?:RHO_CONFIG_PICK\()?(\d+)(?:, \d+\))?", found[3].strip())
        if default and found[2] in ranges:
            yield found[2], default[1], *ranges[found[2]], comment


def kconfig():
    entries = []
    for name, default, least, most, comment in macros():
        words = comment.split(". ")[0].rstrip(".")
        entries.append(f"config {name}\n\tint \"{name}\"\n\tdefault {default}\n"
                       f"\trange {least} {most}\n\thelp\n\t  {words}.\n")
    return "\n".join(entries)


def licences():
    """The licences of Debian's copyright file: that of rhotrack, and that of d3."""
    texts = {"Expat": (HOME / "LICENSE").read_text(encoding="utf-8").split("\n\n", 2)[2],
             "ISC": (HOME / "tools/rhotrack/picture/interactive_map_page/d3.LICENSE").read_text(
                 encoding="utf-8").split("\n\n", 1)[1]}
    return "\n\n".join(f"License: {name}\n" + "\n".join(
        f" {line}" if line else " ." for line in text.strip().splitlines())
                       for name, text in texts.items())


def last_change():
    """Seconds: of the last commit, or SOURCE_DATE_EPOCH; 0 where there is neither."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    if epoch and not re.fullmatch(r"[0-9]{1,10}", epoch):
        sys.exit(f"package: SOURCE_DATE_EPOCH={epoch}: it is seconds")
    said = epoch or subprocess.run(
        ["git", "-C", str(HOME), "log", "-1", "--format=%ct"], capture_output=True, text=True,
        check=False).stdout.strip()
    return int(said or 0)


def fill_in(template, target, values):
    """A template with its values; @SOURCES(...X...)@ is a line a source, @MACROS(...)@ a macro."""
    text = template.read_text(encoding="utf-8")
    lists = {"SOURCES": sources(), "MACROS": [row[0] for row in macros()]}
    text = re.sub(r"@(SOURCES|MACROS)\((.*)\)@", lambda found: "\n".join(
        found[2].replace("X", item) for item in lists[found[1]]), text)
    text = re.sub(r"@([A-Z_]+)@", lambda found: values[found[1]], text)
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text, encoding="utf-8")
    shutil.copymode(template, target)


def fill_in_all(kind, target, values):
    for template in sorted((HERE / kind).rglob("*")):
        if template.is_file():
            fill_in(template, target / template.relative_to(HERE / kind), values)


def copy(names, target):
    """Files and folders of the repository."""
    for name in names:
        if (HOME / name).is_dir():
            shutil.copytree(HOME / name, target / name, dirs_exist_ok=True)
        else:
            shutil.copy(HOME / name, target / name)


def files_of(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file())


def write_tar(folder, time_s):
    """The same bytes for the same files."""

    def same(entry):
        entry.mtime, entry.uid, entry.gid, entry.uname, entry.gname = time_s, 0, 0, "", ""
        return entry

    with open(f"{folder}.tar.gz", "wb") as out:
        pack = subprocess.Popen(["gzip", "-9n"], stdin=subprocess.PIPE, stdout=out)
        with tarfile.open(fileobj=pack.stdin, mode="w|") as tar:
            for path in files_of(folder):
                tar.add(path, path.relative_to(folder.parent), filter=same)
        pack.stdin.close()
        if pack.wait() != 0:
            sys.exit("package: gzip failed")


def write_tree(target, values, time_s):
    tree = target / f"rhotrack-{values['VERSION']}"
    tree.mkdir()
    copy(["include", "src", "tools/install", "CMakeLists.txt", "LICENSE", "CHANGELOG.md"], tree)
    fill_in_all("tree", tree, values)
    write_tar(tree, time_s)
    return tree


def write_arduino(target, values):
    """Arduino looks for headers and sources in one folder."""
    library = target / "arduino" / "rhotrack"
    shutil.copytree(HOME / "src", library / "src", ignore=shutil.ignore_patterns("*.md"))
    shutil.copytree(HOME / "include/rhotrack", library / "src/rhotrack")
    copy(["LICENSE"], library)
    fill_in_all("arduino", library, values)


def write_vcpkg(target, values):
    port = target / "vcpkg" / "rhotrack"
    fill_in_all("vcpkg", port, values)
    shutil.copy(target / f"rhotrack-{values['VERSION']}.tar.gz", port)


def write_zip(name, files, time_s):
    """Of (path, name in it): the same bytes for the same files. It knows no year before 1980."""
    with zipfile.ZipFile(name, "w", zipfile.ZIP_DEFLATED) as pack:
        for path, place in files:
            entry = zipfile.ZipInfo(str(place), max(time.gmtime(time_s)[:6], (1980, 1, 1, 0, 0, 0)))
            entry.external_attr = 0o100644 << 16
            pack.writestr(entry, path.read_bytes(), zipfile.ZIP_DEFLATED)


def write_pack(target, tree, values, time_s):
    name = target / f"rhotrack.rhotrack.{values['VERSION']}.pack"
    described = target / "rhotrack.rhotrack.pdsc"
    fill_in(HERE / "cmsis/rhotrack.rhotrack.pdsc", described, values)
    files = [path for part in ["include", "src", "LICENSE", "CHANGELOG.md"]
             for path in files_of(tree / part) or [tree / part]]
    write_zip(name, [(described, described.name),
                     (HERE / "cmsis/rhotrack_config.h", "config/rhotrack_config.h"),
                     *((path, path.relative_to(tree)) for path in files)], time_s)
    described.unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--packager", default="rhotrack developers <packager@rhotrack.invalid>")
    parser.add_argument("--url", default="https://rhotrack.invalid")
    parser.add_argument("folder", type=pathlib.Path)
    options = parser.parse_args()
    if not re.fullmatch(r"[^<>\n]+ <[^<>@\s]+@[^<>\s]+>", options.packager):
        sys.exit(f"package: --packager {options.packager}: it is NAME <MAIL>")
    if not re.fullmatch(r"https?://[^\s<>\"'&\\]+", options.url):
        sys.exit(
            f"package: --url {options.url}: it is http(s)://PLACE, without quotes, &, < and \\")
    target, time_s = options.folder.absolute(), last_change()
    values = {
        "VERSION": version(), "DESCRIPTION": DESCRIPTION, "URL": options.url,
        "PACKAGER": options.packager, "DATE": time.strftime("%Y-%m-%d", time.gmtime(time_s)),
        "RFC_DATE": email.utils.formatdate(time_s), "KCONFIG": kconfig(), "LICENSES": licences(),
        "HOME": str(HOME), "PROGRAM": str(target / "deb/objects/rhotrack"),
        "OBJECTS": str(target / "deb/objects").removeprefix(f"{HOME}/"), # as the Makefile names it
    }
    for path in [target / "arduino", target / "vcpkg", target / "debian",
                 *target.glob("rhotrack-[0-9]*.[0-9]*.[0-9]*"),
                 *target.glob("rhotrack.rhotrack.*.pack")]:
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
    target.mkdir(parents=True, exist_ok=True)
    tree = write_tree(target, values, time_s)
    write_arduino(target, values)
    write_vcpkg(target, values)
    write_pack(target, tree, values, time_s)
    fill_in_all("debian", target / "debian", values)


if __name__ == "__main__":
    main()
