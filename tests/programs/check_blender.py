#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender imports the meshes with the right size, upright, with their picture. Usage: check_blender.py WRITER"""
from samples import close, expect, need, results, run, samples

# Debian's glTF importer was written for an older NumPy.
SCRIPT = """
import json, traceback
import numpy
numpy.bool = bool
numpy.object = object
import bpy
importers = dict(stl=lambda p: bpy.ops.import_mesh.stl(filepath=p),
                 ply=lambda p: bpy.ops.import_mesh.ply(filepath=p),
                 obj=lambda p: bpy.ops.wm.obj_import(filepath=p, forward_axis='Y', up_axis='Z'),
                 glb=lambda p: bpy.ops.import_scene.gltf(filepath=p),
                 gltf=lambda p: bpy.ops.import_scene.gltf(filepath=p))
result = {{}}
for path in {paths}:
    try:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        importers[path.rsplit('.', 1)[1]](path)
        bpy.context.view_layer.update()
        low, high, triangles, names, attributes = [1e30] * 3, [-1e30] * 3, 0, [], []
        for item in bpy.data.objects:
            if item.type != 'MESH' or not item.data.polygons:
                continue
            names.append(item.name)
            attributes += [a.name for a in item.data.attributes]
            triangles += len(item.data.polygons)
            for vertex in item.data.vertices:
                place = item.matrix_world @ vertex.co
                low = [min(a, b) for a, b in zip(low, place)]
                high = [max(a, b) for a, b in zip(high, place)]
        pictures = [list(p.size) for p in bpy.data.images if p.size[0] > 0]
        result[path.rsplit('/', 1)[1]] = dict(low=low, high=high, triangles=triangles, names=names,
                                             pictures=pictures, attributes=attributes)
    except Exception:
        traceback.print_exc()
print()
print("RESULT " + json.dumps(result), flush=True)
"""

blender = need("blender", "blender")
with samples() as (folder, expected):
    names = [n for n in ["letter.stl", "letter.ply", "letter.obj", "pair.obj", "letter.glb", "letter.gltf", "pair.glb"]
             if (folder / n).exists()]
    script = folder / "script.py"
    script.write_text(SCRIPT.format(paths=[str(folder / name) for name in names]))
    text = run([blender, "--background", "--factory-startup", "--python", script], home=folder)
    found = results(text)
    for name in names:
        expect(name in found, f"{name} was not read", text)
        got = found[name]
        count = 2 if name.startswith("pair") else 1
        factor = 1000 if name.endswith(("glb", "gltf")) else 1   # Blender's unit is the metre
        size = [factor * (h - l) for l, h in zip(got["low"], got["high"])]
        wanted = [h - l for l, h in zip(expected["low"], expected["high"])]
        wanted[0] += 500 * (count - 1)
        expect(close(size, wanted, 0.01), f"{name}: the size {size} is not {wanted}", text)
        expect(got["triangles"] == count * expected["triangles"], f"{name}: {got['triangles']} triangles", text)
        if name.endswith(("obj", "glb", "gltf")):
            expect([30, 25] in got["pictures"], f"{name}: its pictures are {got['pictures']}", text)
        if count == 2:
            expect(any("left" in n for n in got["names"]) and any("right" in n for n in got["names"]),
                   f"{name}: the names are {got['names']}", text)
    print(f"{len(names)} files read")
