# SPDX-License-Identifier: GPL-3.0-or-later
"""Links of the documentation lead somewhere: python3 links.py ROOT.

Every relative link and picture of every page is there, with its heading, and every page is reached from README.md in two
clicks; pages for developers in three.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1]).resolve()
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
OUTSIDE = re.compile(r"[a-z]+:")
CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)


def pages():
    yield from (ROOT / name for name in ("README.md", "CHANGELOG.md"))
    yield from sorted((ROOT / "docs").rglob("*.md"))


def anchors_of(text):
    """As GitHub makes them of headings."""
    heads = re.findall(r"^#+ +(.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", head).lower()).replace(" ", "-") for head in heads}


def links_of(page):
    for link in LINK.findall(CODE.sub("", page.read_text())):
        if not OUTSIDE.match(link):
            path, _, anchor = link.partition("#")
            yield link, (page.parent / path).resolve() if path else page, anchor


def main():
    texts = {page: page.read_text() for page in pages()}
    faults, links = [], {}
    for page in texts:
        links[page] = set()
        for link, target, anchor in links_of(page):
            where = f"{page.relative_to(ROOT)}: {link}"
            if not target.exists():
                faults.append(f"{where}: there is no such file")
            elif anchor and target in texts and anchor not in anchors_of(texts[target]):
                faults.append(f"{where}: there is no such heading")
            links[page].add(target / "README.md" if target.is_dir() else target)
    reached, clicks = {ROOT / "README.md": 0}, 0
    while clicks < 3:
        clicks += 1
        for page in [page for page, at in reached.items() if at == clicks - 1]:
            for target in links.get(page, ()):
                reached.setdefault(target, clicks)
    for page in texts:
        most = 3 if page.is_relative_to(ROOT / "docs/development") else 2
        if reached.get(page, 9) > most and page.name != "CHANGELOG.md":
            faults.append(f"{page.relative_to(ROOT)}: README.md does not lead to it in {most} clicks")
    print("\n".join(faults) or f"{len(texts)} pages, {sum(map(len, links.values()))} links")
    return 1 if faults else 0


sys.exit(main())
