#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""ParaView reads VTP, VTM and PLY with arrays, units, texts and bounds. Usage: check_paraview.py WRITER"""
from samples import close, expect, need, results, run, samples

SCRIPT = """
import json, traceback
from paraview.simple import *
from paraview import servermanager
result = {{}}

def describe(data):
    points, fields = data.GetPointData(), data.GetFieldData()
    kind = data.GetClassName()
    info = dict(kind=kind, points=data.GetNumberOfPoints(), cells=data.GetNumberOfCells(), bounds=list(data.GetBounds()),
                arrays=dict((points.GetArrayName(i), list(points.GetArray(i).GetRange()))
                            for i in range(points.GetNumberOfArrays())),
                active=points.GetScalars().GetName() if points.GetScalars() else None,
                normals=points.GetNormals() is not None, texture=points.GetTCoords() is not None,
                texts=dict((fields.GetAbstractArray(i).GetName(), fields.GetAbstractArray(i).GetValue(0))
                           for i in range(fields.GetNumberOfArrays())))
    from vtkmodules.vtkCommonCore import vtkDataArray
    info['units'] = dict()
    for i in range(points.GetNumberOfArrays()):
        keys = points.GetArray(i).GetInformation()
        if keys.Has(vtkDataArray.UNITS_LABEL()):
            info['units'][points.GetArrayName(i)] = keys.Get(vtkDataArray.UNITS_LABEL())
    return info

for path in {paths}:
    try:
        data = servermanager.Fetch(OpenDataFile(path))
        name = path.rsplit('/', 1)[1]
        if data.IsA('vtkMultiBlockDataSet'):
            from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
            result[name] = [[data.GetMetaData(i).Get(vtkCompositeDataSet.NAME()), describe(data.GetBlock(i))]
                            for i in range(data.GetNumberOfBlocks())]
        else:
            result[name] = describe(data)
    except Exception:
        traceback.print_exc()
print()
print("RESULT " + json.dumps(result), flush=True)
"""


def check_letter(name, got, text, count=1):
    box = [value for pair in zip(expected["low"], expected["high"]) for value in pair]
    box[1] += 500 * (count - 1)
    expect(close(got["bounds"], box), f"{name}: the bounds are {got['bounds']}, not {box}", text)
    expect(got["points"] == count * expected["vertices"], f"{name}: {got['points']} points", text)
    expect(got["cells"] == count * expected["triangles"], f"{name}: {got['cells']} cells", text)
    if name.endswith(".ply"):   # ParaView's reader leaves out what it does not know
        return
    expect(close(got["arrays"]["height"], [0, 25]), f"{name}: the heights are {got['arrays']['height']}", text)
    expect(close(got["arrays"]["certainty"], [0, 1]), f"{name}: the certainties", text)


pvpython = need("pvpython", "python3-paraview")
display = need("xvfb-run", "xvfb xauth")
with samples() as (folder, expected):
    names = [n for n in ["letter.ply", "letter.vtp", "letter.vtm", "pair.vtp", "pair.vtm"] if (folder / n).exists()]
    script = folder / "script.py"
    script.write_text(SCRIPT.format(paths=[str(folder / name) for name in names]))
    output = run([display, "-a", pvpython, script], home=folder)
    found = results(output)
    for name in names:
        expect(name in found, f"{name} was not read", output)
        expect("ERR|" not in output, "ParaView complains", output)
        if name.endswith(".vtm"):
            blocks = found[name]
            wanted = (["letter", "drape of letter", "electron tracks"] if name == "letter.vtm" else
                      ["left", "drape of left", "right", "drape of right"])
            expect([block for block, _ in blocks] == wanted, f"{name}: the blocks", output)
            check_letter(name, blocks[0][1], output)
            expect(blocks[1][1]["kind"] == "vtkImageData" and blocks[1][1]["arrays"]["SE"] == [90, 255],
                   f"{name}: the picture", output)
            if name == "letter.vtm":
                expect(blocks[2][1]["cells"] == 2 and "energy_ev" in blocks[2][1]["arrays"], "the tracks", output)
            continue
        check_letter(name, found[name], output, 2 if name.startswith("pair") else 1)
        if name.endswith(".vtp"):
            got = found[name]
            expect(got["active"] == "height" and got["normals"] and got["texture"], f"{name}: attributes", output)
            expect(got["units"]["height"] == "nm", f"{name}: the unit", output)
            expect(got["texts"]["surface:unit_nm"] == "1", f"{name}: the note", output)
    expect(len(names) in (1, 5), "which files there are")
    print(f"{len(names)} files read")
