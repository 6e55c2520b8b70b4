#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""admesh finds a closed body without faults in the STL file. Usage: check_admesh.py WRITER"""
import re

from samples import close, expect, need, run, samples


def number(output, label):
    found = re.search(rf"{re.escape(label)}\s*[:=]\s*([-+.\deE]+)", output)
    expect(found, f"no '{label}' in what admesh prints", output)
    return float(found.group(1))


admesh = need("admesh", "admesh")
with samples() as (folder, expected):
    text = run([admesh, folder / "letter.stl"])
    expect(number(text, "Number of facets") == expected["triangles"], "the number of triangles", text)
    for fault in ["Total disconnected facets", "Degenerate facets", "Edges fixed", "Facets removed", "Facets added",
                  "Facets reversed", "Backwards edges", "Normals fixed"]:
        expect(number(text, fault) == 0, fault, text)
    expect(number(text, "Number of parts") == 1, "the number of parts", text)
    expect(close(number(text, "Volume"), expected["volume"], 1), "the volume", text)
    for i, axis in enumerate("XYZ"):
        expect(close(number(text, f"Min {axis}"), expected["low"][i]), f"the least {axis}", text)
        expect(close(number(text, f"Max {axis}"), expected["high"][i]), f"the largest {axis}", text)
