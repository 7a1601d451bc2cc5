#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Follows every link of a folder of HTML pages to the file and the anchor that it names.

Usage: links.py FOLDER
Prints a line for each that leads nowhere; exit 1 if there is one. Links to other hosts are left.
"""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """What a page links, and the anchors that it has."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ("href", "src") and value:
                self.links.append(urllib.parse.urlsplit(value))
            elif name == "id" or (name == "name" and tag == "a"):
                self.anchors.add(value)


def main(folder):
    folder = pathlib.Path(folder).resolve()
    pages = {path: Page(path) for path in folder.rglob("*.html")}
    count, faults = 0, []
    for path, page in pages.items():
        for link in page.links:
            if link.scheme or link.netloc:
                continue
            count += 1
            target = path.parent / urllib.parse.unquote(link.path) if link.path else path
            target = target.resolve()
            anchor = urllib.parse.unquote(link.fragment)
            if not target.is_file():
                faults.append(f"{path.relative_to(folder)}: no file {link.geturl()}")
            elif anchor and target in pages and anchor not in pages[target].anchors:
                faults.append(f"{path.relative_to(folder)}: no anchor {link.geturl()}")
    print("\n".join(faults) or f"documentation: {len(pages)} pages, {count} links hold")
    return bool(faults) or not pages


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
