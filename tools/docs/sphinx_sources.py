#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lays out what Sphinx reads.

Usage: sphinx_sources.py FOLDER BUILD
FOLDER gets the documents of the repository at their places; a page for each header, for each
experiment of the lab with its measured figures and the pictures of its last run (BUILD/experiment),
and for each other file that a document links.
"""
import ast
import os
import pathlib
import re
import shutil
import sys
import textwrap

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from headers import Reference  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LINK = re.compile(r"\[([^\]]*)\]\(([^)\s#]+)((?:#[^)\s]*)?)\)")
LANGUAGES = {".c": "c", ".h": "c", ".py": "python", ".cmake": "cmake", ".txt": "cmake"}


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def titled(title, text):
    return f"{title}\n{'=' * len(title)}\n\n{text}\n"


def documents():
    return [path.relative_to(ROOT) for path in sorted(ROOT.rglob("*.md"))
            if not re.match(r"build|\.git/", path.relative_to(ROOT).as_posix())]


def document(folder, path):
    """A document whose links lead to pages of the site."""
    def led(match):
        target = (ROOT / path.parent / match[2]).resolve()
        if re.match(r"\w+:", match[2]):
            return match[0]
        name = target.relative_to(ROOT).as_posix()
        if name == "README.md":
            name = "index.md"
        elif name == "include/rhotrack":
            name = "tools/docs/c.md"
        elif (target / "README.md").exists():
            name += "/README.md"
        elif target.is_dir():
            return match[1]
        elif target.suffix in (".svg", ".png"):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(target, folder / name)
        elif target.suffix != ".md":
            source(folder, name)
            name += ".rst"
        return f"[{match[1]}]({os.path.relpath(name, path.parent)}{match[3]})"
    write(folder / path, LINK.sub(led, (ROOT / path).read_text(encoding="utf-8")))


def source(folder, name):
    """A page that shows a file."""
    page = folder / f"{name}.rst"
    if not page.exists():
        language = LANGUAGES.get(pathlib.PurePath(name).suffix, "make" if "Makefile" in name
                                 else "text")
        text = (ROOT / name).read_text(encoding="utf-8")
        write(page, ":orphan:\n\n" + titled(name, f".. code-block:: {language}\n\n"
                                            + textwrap.indent(text, "   ")))


def headers(folder):
    include = ROOT / "include"
    found = {path.relative_to(include).as_posix(): path.read_text(encoding="utf-8")
             for path in sorted(include.rglob("*.h"))}
    reference = Reference(found)
    for path in found:
        write(folder / "include" / f"{path}.rst", reference.page(path))


def experiments(folder, build):
    """A page for each script of the lab that users run, and the list of them."""
    cards, measured = [], (ROOT / "tools/lab/MEASUREMENTS.md").read_text(encoding="utf-8")
    for path in sorted((ROOT / "tools/lab").glob("*.py")):
        text = path.read_text(encoding="utf-8")
        about = ast.get_docstring(ast.parse(text)) or ""
        if not os.access(path, os.X_OK) or path.stem == "update_measurements_page":
            continue
        name = path.stem.replace("_", "-")
        section = re.search(rf"<!-- experiment {name}: .*?-->(.*?)<!-- end of", measured, re.DOTALL)
        out = [f"# {name}", about, f"```sh\nmake python && tools/lab/{path.name}\n```"]
        for picture in sorted((build / "experiment" / name).glob("**/*.svg")):
            shutil.copy(picture, folder / "tools/lab" / f"{path.stem}-{picture.name}")
            out.append(f"![{picture.stem}]({path.stem}-{picture.name})")
        out += ["## Figures", section[1].strip()] if section else []
        out += ["## The script", f"````python\n{text}````\n"]
        write(folder / "tools/lab" / f"{path.stem}.md", "\n\n".join(out))
        cards.append(path.stem)
    write(folder / "tools/lab/experiments.rst", titled(
        "Experiments", ".. toctree::\n   :maxdepth: 1\n\n" + "\n".join(f"   {one}"
                                                                       for one in cards)))


def main(folder, build):
    folder, build = pathlib.Path(folder).resolve(), pathlib.Path(build).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    for path in documents():
        document(folder, path)
    contents = (folder / "tools/docs/index.md").read_text(encoding="utf-8")
    write(folder / "index.md", (folder / "README.md").read_text(encoding="utf-8") + contents)
    (folder / "tools/docs/index.md").unlink()
    (folder / "README.md").unlink()
    headers(folder)
    experiments(folder, build)


if __name__ == "__main__":
    main(*sys.argv[1:])
