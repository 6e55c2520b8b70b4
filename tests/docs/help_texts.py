# SPDX-License-Identifier: GPL-3.0-or-later
"""Every help text makes sense alone, as completion, ParaView and Python show it: it names its noun and does not begin with a word
that leans on the line above it. Usage: help_texts.py ROOT"""
import pathlib
import re
import sys

# Beginnings that lean on another text, and clauses in place of a noun.
LEANING = re.compile(r"^(Of|Nor|Or|And|Also|Instead|Likewise|That|This|These|Those|It|They|Its|Their|Same|The same|As|So|But|Else|"
                     r"What|Which|How|Where|Whether|By how|Over how|Said|Say what|To write)\b")
OPTION = re.compile(r"^\| `([^|`]*(?:\\\|[^|`]*)*)` \| (.*) \|$")
KEY = re.compile(r"^\| `([^`]*)` \| `[^`]*` \| .* \| ([^|]*) \|$")
DOCUMENTATION = re.compile(r"<Documentation[^>]*>(.*?)</Documentation>", re.DOTALL)


def texts(root):
    """(where, name, text) of all help texts."""
    for page, row in (("commands.md", OPTION), ("scene_files.md", KEY)):
        for number, line in enumerate((root / "docs/reference" / page).read_text().splitlines(), 1):
            if match := row.match(line):
                yield f"docs/reference/{page}:{number}", match[1], match[2].strip()
    for file in sorted((root / "paraview_plugin/xml").glob("*.xml")):
        source = file.read_text()
        for match in DOCUMENTATION.finditer(source):
            yield f"{file.relative_to(root)}:{source.count(chr(10), 0, match.start()) + 1}", "", " ".join(match[1].split())
        for match in re.finditer(r' help="([^"]*)"', source):
            yield f"{file.relative_to(root)}:{source.count(chr(10), 0, match.start()) + 1}", "", match[1]


def main():
    found = list(texts(pathlib.Path(sys.argv[1])))
    faults = [(where, name, text) for where, name, text in found if LEANING.match(text)]
    for where, name, text in faults:
        print(f"{where}: {name}: '{text}' leans on another text")
    print(f"{len(found)} help texts, {len(faults)} that do not stand alone")
    return 1 if faults or len(found) < 300 else 0


if __name__ == "__main__":
    sys.exit(main())
