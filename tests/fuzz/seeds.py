#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes seeds of fuzz targets that are made of vectors in the tree. Usage: seeds.py FOLDER"""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent


def main():
    folder = pathlib.Path(sys.argv[1]) / "fuzz_message"
    folder.mkdir(parents=True, exist_ok=True)
    text = (HERE.parent / "vectors" / "message_vectors.h").read_text(encoding="utf-8")
    for name, golden, lines in re.findall(r'\{"(\w+)", GOLDEN_(\w+),\s*((?:"[0-9a-f]+"\s*)+)', text):
        data = bytes.fromhex("".join(re.findall(r'"([0-9a-f]+)"', lines)))
        (folder / f"{name}-{golden.lower()}").write_bytes(data)


if __name__ == "__main__":
    main()
