#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""assimp reads the meshes with all their triangles and the right size. Usage: check_assimp.py WRITER"""
import re

from samples import close, expect, need, run, samples


def numbers(output, label):
    found = re.search(rf"{label}\s*:?\s+\(?([-+.\deE ]+)", output)
    expect(found, f"no '{label}' in what assimp prints", output)
    return [float(word) for word in found.group(1).split()]


def extent(path):
    """The size of what assimp makes of a file. Its own 'info' multiplies nodes in the wrong order."""
    converted = path.with_suffix(path.suffix + ".converted.obj")
    run([assimp, "export", path, converted])
    places = [[float(word) for word in line.split()[1:4]] for line in converted.read_text().splitlines()
              if line.startswith("v ")]
    return [max(axis) - min(axis) for axis in zip(*places)]


assimp = need("assimp", "assimp-utils")
with samples() as (folder, expected):
    checked = 0
    # Without electron tracks, which count as faces.
    for name in ["letter.stl", "letter.obj", "letter.ply", "letter.off", "pair.glb", "pair.gltf", "letter.3mf"]:
        if not (folder / name).exists():
            continue
        text = run([assimp, "info", folder / name])
        count = 2 if name.startswith("pair") else 1
        expect(numbers(text, "Faces") == [count * expected["triangles"]], f"{name}: the triangles", text)
        size = extent(folder / name)
        wanted = [h - l for l, h in zip(expected["low"], expected["high"])]
        wanted[0] += 500 * (count - 1)
        if name.endswith((".glb", ".gltf")):   # metres, y up
            size, wanted = [1e3 * s for s in size], [wanted[0], wanted[2], wanted[1]]
        expect(close(size, wanted, 0.01), f"{name}: the size {size} is not {wanted}", text)
        if name.endswith((".obj", ".glb", ".gltf")):
            expect(numbers(text, "Materials")[0] >= 1, f"{name}: the material", text)
        checked += 1
    text = run([assimp, "info", folder / "pair.obj"])
    expect(numbers(text, "Faces") == [2 * expected["triangles"]], "pair.obj: the number of triangles", text)
    expect("left" in text and "right" in text, "pair.obj: the names", text)
    print(f"{checked} formats read")
