#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""FreeCAD makes a closed solid of the right volume from STL, and 3MF if it reads that. Usage: check_freecad.py WRITER"""
import shutil

from samples import close, expect, need, results, run, samples

SCRIPT = """
import json, traceback
import Mesh, Part
result = {{}}
try:
    for path in {paths}:
        try:
            mesh = Mesh.Mesh(path)
        except OSError as error:
            if path.endswith(".3mf") and "extension not supported" in str(error):
                print("this FreeCAD does not read 3MF")   # 0.20, of Debian 12
                continue
            raise
        shape = Part.Shape()
        shape.makeShapeFromMesh(mesh.Topology, 0.01)
        solid = Part.Solid(shape)
        result[path] = dict(triangles=mesh.CountFacets, is_solid=mesh.isSolid(), volume=mesh.Volume,
                            closed=solid.isClosed(), valid=solid.isValid(), solid_volume=solid.Volume,
                            low=[mesh.BoundBox.XMin, mesh.BoundBox.YMin, mesh.BoundBox.ZMin],
                            high=[mesh.BoundBox.XMax, mesh.BoundBox.YMax, mesh.BoundBox.ZMax])
except Exception:
    traceback.print_exc()
print()
print("RESULT " + json.dumps(result), flush=True)
import os
os._exit(0)
"""

freecad = shutil.which("FreeCADCmd") or need("freecadcmd", "freecad-python3")
with samples() as (folder, expected):
    paths = [str(folder / name) for name in ["letter.stl", "letter.3mf"] if (folder / name).exists()]
    script = folder / "script.py"
    script.write_text(SCRIPT.format(paths=paths))
    text = run([freecad, script], home=folder)
    found = results(text)
    unread = text.count("this FreeCAD does not read 3MF")
    expect(len(found) >= 1 and len(found) + unread == len(paths), "not all files were read", text)
    for path, body in found.items():
        expect(body["triangles"] == expected["triangles"], f"{path}: the number of triangles", text)
        expect(body["is_solid"] and body["closed"] and body["valid"], f"{path}: it is not a closed solid", text)
        for volume in ["volume", "solid_volume"]:
            expect(close(body[volume], expected["volume"], 1), f"{path}: the volume is {body[volume]} mm3", text)
        expect(close(body["low"] + body["high"], expected["low"] + expected["high"]), f"{path}: the place", text)
    print(f"{len(found)} closed solids" + (", 3MF is not read by this version" if unread else ""))
