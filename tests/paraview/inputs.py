# SPDX-License-Identifier: GPL-3.0-or-later
"""Data that a filter cannot use are refused, by the name of the input, with what to do; nothing crashes."""
import math

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkMultiBlockDataSet, vtkPolyData
from vtkmodules.util.numpy_support import numpy_to_vtk

from support import array, each, expect, fetch, numpy, quiet, refuses, run, simple

FILTERS = {"LevelScan": {}, "CleanScan": {}, "NoiseModel": {}, "EstimateTip": {"TipSize": 5, "HeightNoise": "0.3"},
           "HeightFieldtoSurface": {}, "LineProfile": {}, "SimulateSEM": {"Pixels": 6, "Electrons": 1}}


def producer(data):
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    return source


def image(size=(20, 15, 1), spacing=(2, 2, 1), values=None, numbers=1, cells=False, turned=False, first=(0, 0, 0)):
    data = vtkImageData()
    data.SetExtent(*(v for f, n in zip(first, size) for v in (f, f + n - 1)))
    data.SetSpacing(*spacing)
    if turned:
        data.SetDirectionMatrix(0, 1, 0, -1, 0, 0, 0, 0, 1)
    count = data.GetNumberOfCells() if cells else data.GetNumberOfPoints()
    made = numpy.sin(0.7 * numpy.arange(count)) if values is None else values(count)
    found = numpy_to_vtk(numpy.ascontiguousarray(numpy.stack([made] * numbers, axis=1)), deep=1)
    found.SetName("heights")
    (data.GetCellData() if cells else data.GetPointData()).AddArray(found)
    return producer(data)


def surface(points, *polygons, lines=()):
    data, places, cells, threads = vtkPolyData(), vtkPoints(), vtkCellArray(), vtkCellArray()
    places.SetDataTypeToDouble()
    for point in points:
        places.InsertNextPoint(point)
    for kind, given in ((cells, polygons), (threads, lines)):
        for corners in given:
            kind.InsertNextCell(len(corners))
            for corner in corners:
                kind.InsertCellPoint(corner)
    data.SetPoints(places)
    data.SetPolys(cells)
    data.SetLines(threads)
    return producer(data)


def images_that_are_no_scans_are_refused():
    kinds = {"at its cells": (lambda: image(cells=True), "Cell Data to Point Data"),
             "vectors": (lambda: image(numbers=3), "one number"),
             "one point": (lambda: image(size=(1, 1, 1)), "1 x 1"), "a line": (lambda: image(size=(1, 9, 1)), "1 x 9"),
             "upright": (lambda: image(size=(9, 1, 9)), "9 layers along z"), "a volume": (lambda: image(size=(9, 9, 3)), "3 layers"),
             "turned": (lambda: image(turned=True), "turned"), "no spacing": (lambda: image(spacing=(0, 2, 1)), "0 nm"),
             "backwards": (lambda: image(spacing=(-2, 2, 1)), "-2 nm"),
             "in metres": (lambda: image(spacing=(2e-9, 2e-9, 1)), "multiply Spacing"),
             "no heights": (lambda: image(values=lambda n: 1e50 * numpy.arange(n)), "no height in nm")}

    def check(_, make, word, name, properties):
        refuses(getattr(simple, name)(Input=make(), **properties), "Input: ", word)
    each([((kind, name), make, word, name, properties) for kind, (make, word) in kinds.items()
          if not (kind in ("in metres", "no heights")) for name, properties in FILTERS.items()], check)
    each([((kind, name), *kinds[kind], name, FILTERS[name]) for kind in ("in metres", "no heights")
          for name in FILTERS if name != "LineProfile"], check)   # profiles are of any image


def images_of_any_kind_are_taken():
    """Whole numbers, other spacings along x and y, an extent that begins elsewhere, a plane above 0."""
    for make in (lambda: image(values=lambda n: numpy.arange(n, dtype=numpy.uint8) % 7),
                 lambda: image(values=lambda n: (numpy.arange(n) % 7).astype(numpy.int32)),
                 lambda: image(spacing=(2, 3, 1)), lambda: image(first=(5, -3, 2))):
        got = array(quiet(simple.LevelScan(Input=make())), "heights")
        expect(got.shape == (15, 20) and numpy.isfinite(got).all(), "levelled")
        expect(quiet(simple.HeightFieldtoSurface(Input=make())).GetNumberOfPoints() == 300, "a surface")


CORNERS = [(0, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0), (10, 10, 15)]


def surfaces_that_are_none_are_refused():
    kinds = {"lines": (lambda: surface(CORNERS, lines=[(0, 1, 2)]), "Give"), "empty": (lambda: surface([]), "Give"),
             "points": (lambda: surface(CORNERS), "Give"), "two corners": (lambda: surface(CORNERS, (0, 1)), "no polygons"),
             "no number": (lambda: surface([(math.nan, 0, 0), *CORNERS], (0, 1, 2)), "nan"),
             "far away": (lambda: surface([(0, 0, 0), (1e200, 0, 0), (0, 1e200, 0)], (0, 1, 2)), "nm")}
    filters = {"CheckandRepairMesh": {}, "SimplifyMesh": {}, "SurfacetoHeightField": {"Samples": 8},
               "SimulateSEM": {"Pixels": 6, "Electrons": 1}}

    def check(_, make, word, name, properties):
        refuses(getattr(simple, name)(Input=make(), **properties), "Input: ", word)
    each([((kind, name), make, word, name, properties) for kind, (make, word) in kinds.items()
          for name, properties in filters.items()], check)
    for upright in ([(0, 0, 0), (5, 0, 0), (5, 0, 9)], [(0, 0, 0)] * 3):
        refuses(simple.SurfacetoHeightField(Input=surface(upright, (0, 1, 2))), "Input: ", "seen from above")
    refuses(simple.SimplifyMesh(Input=surface([(0, 0, 0)] * 3, (0, 1, 2))), "Input: ", "one place")
    bad = surface([(math.nan, 0, 0), *CORNERS], (1, 2, 3))
    refuses(simple.DrapeImageonSurface(Input=bad, Image=image()), "Input: ", "point 0")
    for pitch in (1e-9, -1, 1e9, math.inf):
        refuses(simple.SurfacetoHeightField(Input=surface(CORNERS, (0, 1, 4)), Pitch=pitch), "Pitch: ", "samples")


def blocks_may_be_empty():
    blocks = vtkMultiBlockDataSet()
    blocks.SetNumberOfBlocks(3)
    blocks.SetBlock(1, vtkPolyData())
    refuses(simple.SimulateSEM(Input=producer(blocks), Pixels=6, Electrons=1), "Input: ", "no surface")
    body = fetch(simple.SampleBody(Shape="Sphere", Subdivisions=1))
    blocks.SetBlock(2, body)
    expect(quiet(simple.SimulateSEM(Input=producer(blocks), Pixels=6, Electrons=1)).GetNumberOfPoints() > 0, "the body")


def numbers_out_of_all_bounds_do_not_crash():
    """Embree ends the program for rays that begin nowhere."""
    for name, label in {"Spot": "Spot", "SubstrateTop": "Substrate Top", "Focus": "Focus",
                        "WorkingDistance": "Working Distance"}.items():
        for value in (math.nan, math.inf, 1e300, -1e300):
            source = simple.SimulateSEM(Input=simple.SampleBody(Shape="Sphere"), Substrate="Si", Pixels=4, Electrons=1)
            source.GetProperty(name).SMProperty.SetElement(0, value)
            source.SMProxy.UpdateVTKObjects()
            refuses(source, f"{label}: ")


run(images_that_are_no_scans_are_refused, images_of_any_kind_are_taken, surfaces_that_are_none_are_refused, blocks_may_be_empty,
    numbers_out_of_all_bounds_do_not_crash)
