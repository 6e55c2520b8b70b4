# SPDX-License-Identifier: GPL-3.0-or-later
"""What the ParaView plugin costs beside the library: the time of a filter's Update less that of its library call.

    PV_PLUGIN_PATH=build/lib/semsurf_paraview pvpython bench/bench_paraview.py [REPEATS]

A height field of 1024 x 1024 samples, and a surface of a million triangles. The plugin takes the time of its library
call itself. Inputs are computed before; each figure is the median of REPEATS (5) runs, 3 of those that take seconds.

The clock is right on an idle machine. On a busy one look at the processor's time: the plugin's share is what ParaView's
thread takes (it sleeps while the library works), the library's what all others take. With n threads of the library the
share of an idle machine's clock is at most n times this one.
"""
import statistics
import sys
import time

from paraview import simple
from vtkmodules.vtkCommonCore import vtkInformationKeyLookup

LIBRARY_SECONDS = vtkInformationKeyLookup.Find("LIBRARY_SECONDS", "vtkSemsurf")


def one_update(source):
    """Seconds of the library and beside it: by the clock, then of the processor."""
    filter_ = source.GetClientSideObject()
    filter_.Modified()
    clock, process, thread = time.perf_counter(), time.process_time(), time.thread_time()
    filter_.Update()
    clock, process, thread = (time.perf_counter() - clock, time.process_time() - process, time.thread_time() - thread)
    library = filter_.GetInformation().Get(LIBRARY_SECONDS)
    return library, clock - library, process - thread, thread


def measure(name, source, repeats):
    source.UpdatePipeline()
    runs = [one_update(source) for _ in range(repeats)]
    library, over, processor, over_processor = (1e3 * statistics.median(column) for column in zip(*runs))
    print(f"{name:34} {library:9.1f} {over:8.2f} {100 * over / library:6.2f} "
          f"{processor:11.1f} {over_processor:8.2f} {100 * over_processor / processor:6.2f}", flush=True)


def rough(samples):
    return simple.SampleSurface(Shape="Rough", Width=samples, Depth=samples, Pitch=1)


def main():
    repeats = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    field = rough(1024)
    field.UpdatePipeline()
    width, height, _ = field.GetClientSideObject().GetOutputDataObject(0).GetDimensions()
    sheet = simple.HeightFieldtoSurface(Input=rough(708), Curvature=0)
    sheet.UpdatePipeline()
    triangles = sheet.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells()
    tip = simple.AFMTip(Radius=15, TipSize=31, Pitch=1)
    print(f"{width} x {height} samples, {triangles} triangles, {repeats} runs")
    print(f"{'':34} {'clock ms':>9} {'+ ms':>8} {'%':>6} {'processor':>11} {'+ ms':>8} {'%':>6}")
    measure("Level Scan", simple.LevelScan(Input=field), repeats)
    measure("Level Scan, rows", simple.LevelScan(Input=field, Rows="Median"), repeats)
    measure("Level Scan, mean plane", simple.LevelScan(Input=field, Method="Plane"), repeats)
    measure("Clean Scan, median 3 x 3", simple.CleanScan(Input=field, RemoveSpikes=0, MedianFilter=1), repeats)
    measure("Clean Scan, median 9 x 9",
            simple.CleanScan(Input=field, RemoveSpikes=0, MedianFilter=1, MedianWidth=9), repeats)
    measure("Erode by Tip, 31 x 31", simple.ErodebyTip(Input=field, Tip=tip), repeats)
    measure("Certainty Map, 31 x 31", simple.CertaintyMap(Input=field, Tip=tip), repeats)
    measure("Height Field to Surface", simple.HeightFieldtoSurface(Input=field), repeats)
    measure("Height Field to Surface, 0.1 nm", simple.HeightFieldtoSurface(Input=field, Simplify=1), repeats)
    measure("Simplify Mesh, to a half", simple.SimplifyMesh(Input=sheet, Limit="Triangles", Triangles=triangles // 2),
            min(repeats, 3))
    measure("Check and Repair Mesh, check", simple.CheckandRepairMesh(Input=sheet, Repair=0), min(repeats, 3))


main()
