# SPDX-License-Identifier: GPL-3.0-or-later
"""From an AFM scan to a surface and its SEM image, in ParaView: what the mouse does in tests/paraview/gui.

    PV_PLUGIN_PATH=build/lib/semsurf_paraview pvpython samples/paraview_pipeline.py [SCAN] [OUT]

Without a scan one is made: a grating, seen with a blunt tip. In OUT (out/) are then surface.glb and
surface.gsf, and the simulated image as sem.vti.
"""
import pathlib
import sys

from paraview import servermanager, simple

scan_file = sys.argv[1] if len(sys.argv) > 1 else None
out = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "out")
out.mkdir(parents=True, exist_ok=True)

if scan_file:
    scan = simple.AFMScanReader(FileName=scan_file)
else:
    grating = simple.SampleSurface(Shape="Grating", Width=400, Depth=200, FeatureHeight=30, FeatureWidth=60, Period=150)
    scan = simple.DilatebyTip(Input=grating, Tip=simple.AFMTip(Radius=15, TipSize=61, Pitch=2))

level = simple.LevelScan(Input=scan)
# Of a scan with noise: Answer="Sweep" finds the threshold by itself.
tip = simple.EstimateTip(Input=level, Answer="Blind", Threshold=0, ApexTolerance=0, TipSize=31)
eroded = simple.ErodebyTip(Input=level, Tip=tip)
certain = simple.CertaintyMap(Input=level, Tip=tip)
surface = simple.HeightFieldtoSurface(Input=eroded, Simplify=1, Tolerance=0.1)
# Few pixels and electrons, so that it takes seconds; 256 and 200 without saying anything.
sem = simple.SimulateSEM(Input=surface, Materials="Si", Energy=1000, Pixels=64, Electrons=20)

simple.SaveData(str(out / "surface.glb"), proxy=surface)
simple.SaveData(str(out / "surface.gsf"), proxy=eroded)
simple.SaveData(str(out / "sem.vti"), proxy=sem, DataMode="Binary")   # not appended: docs/how-to/paraview.md
certain.UpdatePipeline()
low, high = servermanager.Fetch(certain).GetPointData().GetArray("z_nm" if not scan_file else 0).GetRange()
print(f"{servermanager.Fetch(surface).GetNumberOfCells()} triangles, heights {low:.4g} to {high:.4g} nm")
low, high = servermanager.Fetch(sem).GetPointData().GetArray("SE").GetRange()
print(f"SE yields {low:.3g} to {high:.3g} per electron")
