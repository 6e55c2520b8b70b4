# SPDX-License-Identifier: GPL-3.0-or-later
"""Every number of every proxy set to NaN, infinity and far out of its range, as scripts can: refused by the property's
label, or a result without NaN; what is no number never goes unnoticed where it would be used."""
import json
import math
import os
import pathlib
import select
import subprocess
import sys

from support import DATA, FOLDER, SOURCE, expect, messages, numpy, run, servermanager, simple, vtk_to_numpy

MODEL = str(SOURCE / "samples" / "si-1keV-3nm.json")
PROXIES = json.loads(pathlib.Path(__file__).with_name("proxies.json").read_text())
FAR = [math.nan, math.inf, -math.inf, 1e300, -1e300]
INT = 2**31


def field():
    return simple.SampleSurface(Shape="Rough", Width=69, Depth=57, Pitch=3, CorrelationLength=9, RmsHeight=4)


def tip():
    return simple.AFMTip(TipSize=5, Radius=5, Pitch=3)


def body():
    return simple.SampleBody(Shape="Sphere", Subdivisions=1)


def cases():
    """A proxy, a maker, and whether it may be run as it is: what takes minutes may not, and there only what must be
    refused is tried."""
    scan, probe, sphere = field(), tip(), body()
    sheet = simple.HeightFieldtoSurface(Input=scan, Curvature=0)
    sem = simple.PredictSEM(Input=scan, ModelFile=MODEL)
    for kind in ("Hough", "Polynomial"):
        yield "Level", lambda: simple.LevelScan(Input=scan, Method={"Hough": 0, "Polynomial": 2}[kind]), True
    yield "Clean", lambda: simple.CleanScan(Input=scan, MedianFilter=1, Closing=1), True
    for answer, more in [("Sweep", {"HeightNoise": "0.3", "Sweep": "0.1,2,3"}), ("Blind", {}),
                         ("Outer", {"HeightNoise": "0.3"})]:
        yield "EstimateTip", lambda: simple.EstimateTip(Input=scan, TipSize=3, Answer=answer, **more), True
    for operation in ("Erode", "Dilate", "Open", "Close"):
        yield operation, lambda: getattr(simple, f"{operation}byTip")(Input=scan, Tip=probe), True
    yield "Certainty", lambda: simple.CertaintyMap(Input=scan, Tip=probe), True
    for flat in (0, 1):
        yield "Noise", lambda: simple.NoiseModel(Input=scan, Flat=flat), True
    yield "Register", lambda: simple.RegisterAFMandSEM(Input=scan, SEM=sem, Tip=probe, Material="Si"), False
    yield "Reconstruct", lambda: simple.Reconstruct(Input=scan, SEM=sem, Tip=probe, Material="Si", UseTransform=1), False
    yield "Profile", lambda: simple.MeasureProfile(Input=sem, Height=20), False
    yield "Calibrate", lambda: simple.CalibrateSEM(Input=sem, Simulated=sem, Offset="-1", Black="-1"), True
    yield "Compare", lambda: simple.CompareSurfaces(Input=scan, After=scan, Simulations=50), True
    yield "Predict", lambda: simple.PredictSEM(Input=scan, ModelFile=MODEL), True
    yield "Estimate", lambda: simple.EstimateSEM(Input=sem), False
    yield "Drape", lambda: simple.DrapeImageonSurface(Input=sheet, Image=scan), True
    yield "LineProfile", lambda: simple.LineProfile(Input=scan, SEM=sem, Surface=sheet, Samples=9), True
    yield "ToSurface", lambda: simple.HeightFieldtoSurface(Input=scan, Simplify=1, Solid=1), True
    for by in ({"Samples": 9}, {"Pitch": 5}):
        yield "ToHeightField", lambda: simple.SurfacetoHeightField(Input=sheet, **by), True
    yield "RepairMesh", lambda: simple.CheckandRepairMesh(Input=sheet), True
    for limit in (0, 1):
        yield "SimplifyMesh", lambda: simple.SimplifyMesh(Input=sphere, Limit=limit, Triangles=40), True
    yield "ScanReader", lambda: simple.AFMScanReader(FileName=str(DATA / "block.gsf")), True
    yield "SemReader", lambda: simple.SEMImageReader(FileName=str(DATA / "fei.tif")), True
    yield "MeshReader", lambda: simple.SurfaceMeshReader(FileName=str(DATA / "cube.off")), True
    for budget in ({"Electrons": 1}, {"Budget": "Accuracy", "Accuracy": 0.9, "AccuracyFloor": 0.5}):
        yield "Simulate", lambda: simple.SimulateSEM(Input=sphere, Substrate="Si", Pixels=3, Trajectories=1, **budget), True
    for shape in range(8):
        yield "SampleSurface", lambda: simple.SampleSurface(Shape=shape, Width=60, Depth=50, Pitch=3, FeatureWidth=12, Period=40,
                                                            CorrelationLength=9), True
    for shape in range(3):
        yield "SampleBody", lambda: simple.SampleBody(Shape=shape, Subdivisions=1, Segments=5), True
    for shape in range(4):
        yield "TipSource", lambda: simple.AFMTip(Shape=shape, TipSize=5, StemRadius=2, StemHalfAngle=5), True
    small = {"Kind": "Secant", "Electrons": 2, "ModelFile": str(FOLDER / "bounds.json")}
    yield "TrainBuiltIn", lambda: simple.TrainSEMModelonBuiltinSurfaces(Surfaces=2, SurfaceSize=16, **small), True
    yield "TrainBuiltIn", lambda: simple.TrainSEMModelonBuiltinSurfaces(Surfaces=2, SurfaceSize=16, Budget=1, Accuracy=0.9,
                                                                        **small), False
    yield "Train", lambda: simple.TrainSEMModel(Input=[scan, scan], Images=[sem, sem], **small), True
    yield "Train", lambda: simple.TrainSEMModel(Input=[scan, scan], Images=[sem, sem], Budget=1, Accuracy=0.9, **small), True
    yield "SurfaceWriter", lambda: servermanager.writers.SurfaceWriter(Input=sphere, FileName=str(FOLDER / "bounds.glb")), True


def numbers(source, runs):
    """Name, property, index and the values to try of each number."""
    iterator = source.SMProxy.NewPropertyIterator()
    iterator.Begin()
    while not iterator.IsAtEnd():
        item, name = iterator.GetProperty(), iterator.GetKey()
        iterator.Next()
        if item.GetInformationOnly() or item.GetIsInternal() or not item.GetCommand() or item.GetRepeatable():
            continue
        if item.IsA("vtkSMDoubleVectorProperty"):
            for index in range(item.GetNumberOfElements()):
                yield name, item, index, FAR if runs else FAR[:3]
        elif item.IsA("vtkSMIntVectorProperty"):
            domain = item.GetDomain("range") or item.GetDomain("enum")
            if not domain:
                continue
            # Within its range a large number may ask for much work.
            low = domain.GetMinimum(0) if domain.IsA("vtkSMIntRangeDomain") else 0
            values = [-INT, low - 1]
            if domain.IsA("vtkSMEnumerationDomain"):
                values += [domain.GetNumberOfEntries(), INT - 1]
            elif domain.GetMaximumExists(0):
                values += [domain.GetMaximum(0) + 1, INT - 1]
            yield name, item, 0, [v for v in values if -INT <= v < INT]


def arrays(source):
    """All numbers of all outputs, and whether there are any."""
    found = {}
    algorithm = source.GetClientSideObject()
    for port in range(algorithm.GetNumberOfOutputPorts()):
        data = algorithm.GetOutputDataObject(port)
        if data is None:
            continue
        if data.IsA("vtkTable"):
            sets = {"rows": data.GetRowData()}
        else:
            sets = {"points": data.GetPointData(), "cells": data.GetCellData()}
            if data.IsA("vtkPolyData") and data.GetPoints():
                found[port, "places"] = vtk_to_numpy(data.GetPoints().GetData()).copy()
        for kind, held in sets.items():
            for i in range(held.GetNumberOfArrays()):
                array = held.GetArray(i)
                if array and array.GetNumberOfTuples() > 0:
                    found[port, kind, array.GetName()] = vtk_to_numpy(array).copy()
    return found


def update(source):
    with messages() as said:
        try:
            source.UpdatePipeline()
        except RuntimeError:
            pass
    return said[0]


def blank(values):
    """Where there is no number: NaN stands for what lies beyond an image, and is there without a fault, too."""
    return {key: int(numpy.isnan(v).sum()) for key, v in values.items() if v.dtype.kind == "f" and numpy.isnan(v).any()}


def look_at(number, proxy, make, runs):
    """Tries all of a case in the child; says what it is about to try, so that a crash and a hang have a name."""
    first = make()
    told = update(first) if runs else ""
    if "ERR" in told:
        yield f"wrong as it is: {told[:300]}"
        return
    usual = arrays(first) if runs and hasattr(first.GetClientSideObject(), "GetOutputDataObject") else {}
    for name, item, index, values in list(numbers(first, runs)):
        if not runs and (proxy, name) in UNUSED:
            continue
        before, label = item.GetElement(index), item.GetXMLLabel()
        for value in values:
            what = f"{proxy}.{name}[{index}] = {value}"
            print(f"TRY {number} {what}", flush=True)
            item.SetElement(index, value)
            first.SMProxy.UpdateVTKObjects()
            said = update(first)
            finite = isinstance(value, int) or math.isfinite(value)
            if "ERR" in said:
                if f"{label}: " not in said and f"{label} " not in said:
                    yield f"{what}: the message does not name it: {said.splitlines()[-1][:250]}"
                if not finite:
                    print(f"REFUSED {proxy}.{name}", flush=True)
                continue
            if not runs:
                yield f"{what}: not refused"
                continue
            got = arrays(first)
            if not finite:
                print(f"TAKEN {proxy}.{name}", flush=True)
                same = got.keys() == usual.keys() and all(
                    numpy.array_equal(got[k], usual[k], equal_nan=got[k].dtype.kind == "f") for k in got)
                if not same:
                    yield f"{what}: not refused, and another result"
            elif blank(got).keys() - blank(usual).keys() and (proxy, name) not in BEYOND:
                yield f"{what}: NaN in {blank(got).keys() - blank(usual).keys()}"
        item.SetElement(index, before)
    first.SMProxy.UpdateVTKObjects()


def child(first):
    for number, (proxy, make, runs) in enumerate(cases()):
        if number < first:
            continue
        print(f"CASE {number} {proxy}", flush=True)
        for fault in look_at(number, proxy, make, runs):
            print(f"FAULT case {number}, {' '.join(fault.split())}", flush=True)
    print("END", flush=True)


def watched(first):
    """Lines of a child that begins with that case; the last one is END, or where it crashed or was ended for taking too
    long."""
    process = subprocess.Popen(["pvpython", __file__, str(first)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                               env={k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMIX_", "PRTE_"))})
    waiting, lines = b"", ["nothing"]
    try:
        while lines[-1] != "END":
            if not select.select([process.stdout], [], [], SECONDS)[0]:
                yield f"FAULT not refused, nor done in {SECONDS} s: {lines[-1]}"
                return
            more = os.read(process.stdout.fileno(), 65536)
            if not more:
                yield f"FAULT it crashes: {lines[-1]}"
                return
            *whole, waiting = (waiting + more).split(b"\n")
            for line in whole:
                lines.append(line.decode(errors="replace"))
                yield lines[-1]
    finally:
        process.kill()
        process.wait()


def all_numbers_are_looked_at():
    faults, seen, refused, taken, first = [], set(), set(), set(), 0
    while first is not None:
        start, first = first, None
        for line in watched(start):
            kind, _, rest = line.partition(" ")
            if kind == "CASE":
                number, proxy = rest.split()
                seen.add(proxy)
                current = int(number)
            elif kind == "FAULT":
                faults.append(rest)
                if rest.startswith(("not refused, nor", "it crashes")):
                    first = current + 1
            elif kind in ("REFUSED", "TAKEN"):
                (refused if kind == "REFUSED" else taken).add(rest)
    wanted = {name.split("/Semsurf")[1] for name in PROXIES}
    none = wanted - seen - {"SceneReader", "TipReader", "HeightFieldWriter"}
    expect(not none, f"no case has {none}")
    # What a mode does not use may be anything, but some case uses it.
    faults += [f"{name} is never refused, whatever it is" for name in sorted(taken - refused)]
    expect(not faults, f"{len(faults)} faults:\n" + "\n".join(faults))


# Places may lie beyond the images: NaN there is the answer.
BEYOND = {("Drape", "Transform"), ("LineProfile", "Transform"), ("LineProfile", "Point1"), ("LineProfile", "Point2")}
# What another choice of the same case does without; a case that runs uses it.
UNUSED = {("TrainBuiltIn", "Electrons")}
# For one attempt, on a busy machine.
SECONDS = 30

if len(sys.argv) > 1:
    child(int(sys.argv[1]))
    sys.stdout.flush()
    os._exit(0)
run(all_numbers_are_looked_at)
