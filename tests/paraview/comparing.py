# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes, predictions, and what lays images on surfaces and beside them."""
from support import DATA, FOLDER, SOURCE, abort_and_rerun, array, column, expect, fetch, numpy, progress_of, quiet, refuses, refuses_until, run, \
    same, semsurf, simple, text, vtk_to_numpy

MODEL = SOURCE / "samples" / "si-1keV-3nm.json"


def scan():
    return simple.AFMScanReader(FileName=str(DATA / "block.gsf"))


def channel(name):
    return array(fetch(simple.SEMImageReader(FileName=str(FOLDER / "out.tif"), Channel=name)), name).astype(numpy.float32)


def scenes_are_simulated_as_they_say():
    (FOLDER / "two.toml").write_text("""
[beam]
energy = "2keV"
[substrate]
material = "C"
z = -1
[[material]]
name = "heavy"
formula = "PtAu"
density_g_cm3 = 20
[[body]]
material = "heavy"
shape = "box"
lower = [-10, -10, 0]
upper = [10, 10, 20]
[[body]]
material = "Si"
shape = "sphere"
radius = 10
center = [30, 0, 10]
""")
    scene = simple.SceneReader(FileName=str(FOLDER / "two.toml"))
    blocks = quiet(scene)
    expect(blocks.GetNumberOfBlocks() == 2 and text(blocks, "substrate.material") == "C", "blocks and a substrate")
    expect(text(blocks.GetBlock(0), "material") == "heavy" and text(blocks.GetBlock(1), "material") == "Si", "materials")
    data = quiet(simple.SimulateSEM(Input=scene, Energy=2000, PixelSize=3, Electrons=5))
    semsurf("simulate", "two.toml", "--pixel-size", "3nm", "--electrons", 5, "-o", "out.tif", "-q", "--checkpoint", "off")
    for name in ("SE", "BSE", "BSE.stderr"):
        same(array(data, name), numpy.nan_to_num(channel(name)), name)


def predictions_equal_the_command():
    semsurf("predict", DATA / "block.gsf", "--model", MODEL, "--resample", "-o", "out.tif", "-q")
    data = fetch(simple.PredictSEM(Input=scan(), ModelFile=str(MODEL)))
    for name in ("SE", "BSE"):
        same(array(data, name), channel(name), name)
    expect(text(data, "material.1.name") == "Si", "it says what it holds for")
    for edge in ("flat", "periodic"):
        semsurf("predict", DATA / "block.gsf", "--model", MODEL, "--resample", "--edge", edge, "-o", "out.tif", "-q")
        got = array(fetch(simple.PredictSEM(Input=scan(), ModelFile=str(MODEL), Edge=edge.capitalize())), "SE")
        same(got, channel("SE"), edge)
        expect((got != array(data, "SE")).any(), f"{edge} changes nothing")


def predictions_tell_and_abort():
    surface = simple.SampleSurface(Shape="Rough", Width=6000, Depth=3000, Pitch=3, CorrelationLength=9)
    source = simple.PredictSEM(Input=surface, ModelFile=str(MODEL))
    expect(len(progress_of(source)) > 2, "there is progress")
    whole = array(fetch(source), "SE").copy()
    same(array(abort_and_rerun(source), "SE"), whole, "after an abort")


def images_are_draped():
    heights = fetch(scan())
    surface = simple.HeightFieldtoSurface(Input=scan())
    draped = quiet(simple.DrapeImageonSurface(Input=surface, Image=scan()))
    name = heights.GetPointData().GetScalars().GetName()
    same(array(draped, name), array(heights, name).ravel().astype(numpy.float32), "each vertex lies on a sample")
    places = vtk_to_numpy(draped.GetPointData().GetTCoords())
    width, height, _ = heights.GetDimensions()
    expect(numpy.allclose(places[0], [0.5 / width, 0.5 / height]), f"the corner's texture is {places[0]}")
    pitch = heights.GetSpacing()[0]
    moved = quiet(simple.DrapeImageonSurface(Input=surface, Image=scan(), Transform=[1, 0, pitch, 0, 1, 0]))
    got, want = array(moved, name).reshape(height, width), array(heights, name).astype(numpy.float32)
    same(got[:, 1:], want[:, :-1], "moved to the right by a sample")
    expect(numpy.isnan(got[:, 0]).all(), "nothing lies left of it")
    rim = quiet(simple.DrapeImageonSurface(Input=surface, Image=scan(), Transform=[1, 0, 0.4 * pitch, 0, 1, -0.4 * pitch]))
    got = array(rim, name).reshape(height, width)
    expect(numpy.isfinite(got).all(), "half a pixel beyond the centres still belongs to the image")
    expect(got[-1, 0] == want[-1, 0], f"the corner is its pixel's: {got[-1, 0]}, {want[-1, 0]}")


def profiles_show_all():
    heights = fetch(scan())
    name = heights.GetPointData().GetScalars().GetName()
    z = array(heights, name)
    x0, x1, y0, y1 = heights.GetBounds()[:4]
    pitch = heights.GetSpacing()
    y = y0 + 20 * pitch[1]
    width = z.shape[1]
    profile = simple.LineProfile(Input=scan(), SEM=scan(), Surface=simple.HeightFieldtoSurface(Input=scan()),
                                 Point1=[x0, y, 0], Point2=[x1, y, 0], Samples=width, Transform=[1, 0, pitch[0], 0, 1, 0])
    table = quiet(profile)
    expect(numpy.allclose(column(table, "scan"), z[20], rtol=0, atol=1e-9), "the scan's row")
    expect(numpy.allclose(column(table, "surface_nm"), z[20], rtol=0, atol=1e-9), "the surface's")
    sem = column(table, "sem")
    expect(numpy.isnan(sem[0]) and numpy.allclose(sem[2:], z[20][1:-1], atol=1e-9), "the SEM's, moved")
    expect(abs(column(table, "distance_nm")[-1] - (x1 - x0)) < 1e-9, "the line's length")
    alone = quiet(simple.LineProfile(Input=scan()))
    expect(alone.GetNumberOfRows() == 500 and alone.GetNumberOfColumns() == 4, "across the middle, alone")


def wrong_properties_are_refused():
    refuses_until(simple.PredictSEM(Input=scan()), ["Model File", "no model"], ModelFile=str(MODEL))
    refuses_until(simple.PredictSEM(Input=scan(), ModelFile=str(MODEL), Resample=0), ["Input", "3 nm"], Resample=1)
    refuses(simple.LineProfile(Input=scan(), Samples=1), "Samples", "2 to 1000000")
    refuses(simple.DrapeImageonSurface(Input=simple.SampleBody(), Image=scan(), Transform=[0] * 6), "Transform")
    (FOLDER / "bad.toml").write_text("[beem]\n")
    refuses(simple.SceneReader(FileName=str(FOLDER / "bad.toml")), "beem")


run(scenes_are_simulated_as_they_say, predictions_equal_the_command, predictions_tell_and_abort, images_are_draped, profiles_show_all,
    wrong_properties_are_refused)
