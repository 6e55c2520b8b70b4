#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that messages name fields that there are. Usage: described_fields.py ROOT | described_fields.py --self-test

A message names a field in backticks, `beam.tilt` or `beam.tilt=30deg`, and each reader is told it in words of its own: an
option, a key, a property. That needs a description of a field of this name, as {.name = "beam.tilt", ...}, anywhere in the
sources. Comments are not looked at: they may speak of code.
"""
import pathlib
import re
import sys

FOLDERS = ("libsurf", "mc_sim", "io", "workflow", "cli", "paraview_plugin", "python")
TEXT = re.compile(r"""'(?:[^'\\\n]|\\.)'|//[^\n]*|/\*.*?\*/|R"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)"|"(?P<text>(?:[^"\\\n]|\\.)*)\"""", re.S)
NAMED = re.compile(r"`([a-z_]+(?:\.[a-z_]+)+)(?:=[^`]*)?`")
DESCRIBED = re.compile(r'"([a-z_]+(?:\.[a-z_]+)*)"')


def texts(source):
    for found in TEXT.finditer(source):
        text = found.group("text") if found.group("text") is not None else found.group("raw")
        if text is not None:
            yield found.start(), text


def described(sources):
    """Names that stand alone in a text: a description's first member, or an argument that becomes it."""
    return {name for source in sources.values() for name in DESCRIBED.findall(source)}


def faults(sources):
    known = described(sources)
    for path, source in sorted(sources.items()):
        for start, text in texts(source):
            for name in NAMED.findall(text):
                if name.removeprefix("option.") not in known:   # records call it so
                    line = source.count("\n", 0, start) + 1
                    yield f"{path}:{line}: `{name}` is not described anywhere, so nobody knows how it is given"


def sources_of(root):
    return {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
            for folder in FOLDERS for path in (root / folder).rglob("*") if path.suffix in (".h", ".cpp")}


def self_test():
    good = {"a.cpp": 'visit(b.tilt, {.name = "beam.tilt"}); // `no.field`\nf("`beam.tilt=30deg` and `beam.tilt`");'}
    bad = {"a.cpp": 'f("give `beam.current_noise`");'}
    if list(faults(good)) or len(list(faults(bad))) != 1:
        sys.exit(f"it does not see what it should: {list(faults(good))} {list(faults(bad))}")


if sys.argv[1] == "--self-test":
    self_test()
else:
    found = list(faults(sources_of(pathlib.Path(sys.argv[1]))))
    print("\n".join(found))
    sys.exit(1 if found else 0)
