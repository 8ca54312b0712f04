#!/usr/bin/env python3
"""Finds dead links: links.py <folder of HTML or Markdown>...

Each relative link must lead to a file, and its #fragment to an id in that file. Links to other sites are not checked.
Linked SVG files must be well-formed, or browsers show an error in their place.
"""

import argparse
import html.parser
import pathlib
import re
import sys
import urllib.parse
import xml.etree.ElementTree


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.ids = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if value and key in ("href", "src"):
                self.links.append(value)
            if value and key in ("id", "name"):
                self.ids.add(value)


class Markdown:
    def __init__(self, text):
        text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
        self.links = re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", text))
        titles = re.findall(r"^#+ (.*)$", text, re.M)
        self.ids = {re.sub(r"[^\w\- ]", "", t).lower().replace(" ", "-") for t in titles}


def malformed(path):
    """The parse error of an XML file; None if it is well-formed."""
    try:
        xml.etree.ElementTree.parse(path)
    except xml.etree.ElementTree.ParseError as error:
        return error


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="+", type=pathlib.Path)
    paths = parser.parse_args().paths
    read = {}

    def page(path):
        if path not in read:
            read[path] = (Markdown if path.suffix == ".md" else Page)(path.read_text(errors="replace"))
        return read[path]

    files, dead, links = [], [], 0
    for path in paths:
        found = [path] if path.is_file() else sorted(path.rglob("*.html")) + sorted(path.rglob("*.md"))
        if not found:
            sys.exit(f"no HTML or Markdown in {path}")
        files += found
    for path in files:
        for link in page(path).links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or link.startswith("//"):
                continue
            links += 1
            to = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path.resolve()
            if not to.exists():
                dead.append(f"{path}: {link}")
            elif to.suffix == ".svg" and (fault := malformed(to)):
                dead.append(f"{path}: {link} ({fault})")
            elif parts.fragment == "nested-classes":
                pass  # Doxygen links to its list of private nested classes without writing it
            elif parts.fragment and to.suffix in (".html", ".md"):
                if urllib.parse.unquote(parts.fragment) not in page(to).ids:
                    dead.append(f"{path}: {link} (no such heading or id)")
    print("\n".join(dead + [f"{links} links in {len(files)} files, {len(dead)} dead"]))
    sys.exit(1 if dead else 0)


main()
