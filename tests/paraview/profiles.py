# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines, edges and holes are measured as by the command, to the last bit, and shown where they are in the image."""
import csv
import json
import os

from support import FOLDER, abort_and_rerun, array, column, expect, fetch, numpy, refuses, run, \
    same, semsurf, simple, text, vtk_to_numpy

os.environ["SEMSURF_CACHE"] = str(FOLDER / "cache")   # of few cascades, which nobody else asks for
PIXEL, HEIGHT = 4, 30
FEW = {"Height": HEIGHT, "Energy": 300, "Angle": 85, "AngleRange": 3, "TopRadius": 0, "FootRadius": 0, "Rounds": 1,
       "Electrons": 10, "MiddleElectrons": 10}
OPTIONS = ["--height", "30nm", "--energy", "300eV", "--angle", "85deg", "--angle-range", "3deg", "--top-radius", "0nm",
           "--foot-radius", "0nm", "--rounds", 1, "--electrons", 10, "--middle-electrons", 10, "--material", "Si", "--no-picture",
           "-q"]


def make_image(name, width, depth, distance_from_wall):
    """What an SEM shows of walls of 84 degrees, 30 nm high: NAME.exr."""
    y, x = numpy.mgrid[0:depth + 1, 0:width + 1] * 1.0
    heights = numpy.clip(distance_from_wall(x, y) * numpy.tan(numpy.radians(84)) + HEIGHT / 2, 0, HEIGHT)
    numpy.savetxt(FOLDER / f"{name}.txt", heights[::-1], fmt="%.4f")
    half_x, half_y = width // (2 * PIXEL) * PIXEL, depth // (2 * PIXEL) * PIXEL
    semsurf("simulate", f"{name}.txt", "--height-pitch", "1nm", "--energy", "300eV", "--pixel-size", f"{PIXEL}nm",
            f"--region=-{half_x},-{half_y},{half_x},{half_y}", "--electrons", 100, "--seed", 5, "-o", f"{name}.exr", "-q")


def make_files():
    make_image("line", 144, 72, lambda x, y: 20 - abs(x - 72))
    make_image("edge", 72, 72, lambda x, y: x - 36)
    make_image("hole", 120, 120, lambda x, y: numpy.hypot(x - 60, y - 60) - 25)


def sem(name, channel="SE"):
    return simple.SEMImageReader(FileName=str(FOLDER / f"{name}.exr"), Channel=channel)


def numbers(source):
    table = fetch(source, 4)
    return {name: (value, error) for name, value, error in
            zip(column(table, "quantity"), column(table, "value"), column(table, "standard_error"))}


def rows_of(file):
    with open(FOLDER / file, encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


def expect_column(got, rows, name, tolerance, what):
    wanted = [float(row[name]) if row[name] else numpy.nan for row in rows]
    expect(numpy.allclose(got, wanted, rtol=tolerance, atol=tolerance, equal_nan=True), f"{what}: other numbers")


def lines_equal_the_command():
    semsurf("profile", "line.exr", *OPTIONS, "-o", "line", code=None)
    want = json.loads((FOLDER / "line" / "profile.json").read_text())
    source = simple.MeasureProfile(Input=sem("line"), **FEW)
    told = []
    source.GetClientSideObject().AddObserver("ProgressEvent", lambda caller, event: told.append(caller.GetProgress()))
    heights = abort_and_rerun(source)
    expect(len(told) > 3, "there is progress")
    got = numbers(source)
    for name, of in [("width_nm", want["width_nm"])] + list(want["wall"].items()):
        same(got[name], (of["value"], of["standard_error"]), name)
    same(got["threshold_width_nm"][0], want["threshold_method"]["widths_nm"][0]["value"], "the threshold method's width")
    same(got["gain"][0], want["gain"], "the gain")
    expect(bool(got["trusted"][0]) == want["trusted"], "the verdict")
    surface = fetch(simple.XMLImageDataReader(FileName=[str(FOLDER / "line" / "surface.vti")]))
    for name in ("z_nm", "deviation_nm"):
        same(array(heights, name).astype(numpy.float32), array(surface, name), name)
    expect(text(heights, "trusted") == ("yes" if want["trusted"] else "no"), "it says whether it is to be trusted")
    expect(text(heights, "option.profile.height_nm") == "30" and text(heights, "material") == "Si", "it says how it was made")

    triangles = fetch(source, 1)
    same(vtk_to_numpy(triangles.GetPoints().GetData())[:, 2], array(heights, "z_nm").ravel(), "heights of the triangles")
    expect(triangles.GetPointData().GetScalars().GetName() == "height", "heights are shown")
    compared = fetch(source, 3)
    signal, fitted, residual = (array(compared, name) for name in ("signal", "fitted", "residual"))
    same(signal, array(fetch(sem("line")), "SE"), "the image")
    expect(numpy.corrcoef(signal.ravel(), fitted.ravel())[0, 1] > 0.8, "the fit is like the image")
    same(residual, signal - fitted, "the residual")

    rows = rows_of("line/edges.csv")
    table = fetch(source, 5)
    same(column(table, "row"), [int(row["row"]) for row in rows], "the rows")
    for edge in (1, 2):
        for name in (f"edge_{edge}_nm", f"edge_{edge}_error_nm", f"edge_{edge}_threshold_nm"):
            expect_column(column(table, name), rows, name, 6e-5, name)
    expect(numpy.allclose(column(table, "along_nm"), PIXEL * numpy.arange(len(rows))), "rows are a pixel apart")
    edges = fetch(source, 2)
    places = vtk_to_numpy(edges.GetPoints().GetData())
    expect(edges.GetNumberOfLines() == 2, "a line for each edge")
    expect((places[:, 2] == HEIGHT).all(), "at the upper end of the walls")
    first = vtk_to_numpy(edges.GetPointData().GetArray("edge")) == 1
    expect(numpy.allclose(places[first, 0], column(table, "edge_1_nm")), "where the table says")
    lowest = heights.GetOrigin()[1] + heights.GetExtent()[2] * PIXEL
    expect(numpy.allclose(places[first, 1], lowest + column(table, "along_nm")), "in its row")

    table, rows = fetch(source, 6), rows_of("line/profiles.csv")
    for wall in ("left", "right"):
        its = [i for i, row in enumerate(rows) if row["wall"] == wall]
        for name in ("measured", "standard_error", "fitted"):
            values = column(table, f"{wall}_{name}")
            expect_column(values[its], [rows[i] for i in its], name, 1e-5, f"{wall} {name}")
            expect(numpy.isfinite(values).sum() == len(its), f"{name} of other walls is elsewhere")
    table, rows = fetch(source, 7), rows_of("line/spectrum.csv")
    for name in ("frequency_per_nm", "edge_density_nm3", "edge_fitted_nm3", "width_density_nm3"):
        expect_column(column(table, name), rows, name, 1e-5, name)


def further_images_tell_more():
    """An edge by two detectors."""
    semsurf("profile", "edge.exr", "--sem-channel", "SE", *OPTIONS, "--kind", "edge", "--sem", "edge.exr:BSE", "--view-signal", "SE",
            "--view-signal", "BSE", "-o", "edge", code=None)
    want = json.loads((FOLDER / "edge" / "profile.json").read_text())
    source = simple.MeasureProfile(Input=[sem("edge"), sem("edge", "BSE")], Kind="Edge", ViewSignal="SE;BSE", **FEW)
    got = numbers(source)
    for name, of in want["wall"].items():
        same(got[name], (of["value"], of["standard_error"]), name)
    same(got["view_2_gain"][0], want["fitted_views"][0]["gain"], "the second image's gain")
    expect("width_nm" not in got, "an edge has no width")
    expect(numpy.isfinite(column(fetch(source, 6), "view_2_fitted")).sum() > 10, "the second image's mean profile")


def holes_are_circles():
    source = simple.MeasureProfile(Input=sem("hole"), Kind="Hole", **FEW)
    got = numbers(source)
    expect(abs(got["width_nm"][0] - 50) < 8, f"the hole's diameter is {got['width_nm'][0]}")
    edges = fetch(source, 2)
    places = vtk_to_numpy(edges.GetPoints().GetData())
    radii = numpy.hypot(places[:, 0] - got["hole_x_nm"][0], places[:, 1] - got["hole_y_nm"][0])
    expect(numpy.allclose(radii, vtk_to_numpy(edges.GetPointData().GetArray("place_nm"))), "lines run around the hole")
    lines = vtk_to_numpy(edges.GetLines().GetConnectivityArray())
    expect(lines[0] == lines[-1] and len(lines) == len(places) + 1, "the circle is closed")
    bottom = array(fetch(source), "z_nm")
    expect(bottom[bottom.shape[0] // 2, bottom.shape[1] // 2] == 0 and bottom[0, 0] == HEIGHT, "the middle is deep")


def wrong_properties_are_refused():
    image = sem("line")
    refuses(simple.MeasureProfile(Input=image), "Height", "no upright view", "AFM")
    refuses(simple.MeasureProfile(Input=image, **{**FEW, "Material": ""}), "Material", "missing")
    refuses(simple.MeasureProfile(Input=image, **{**FEW, "Signal": "CL"}), "Signal", "CL")
    refuses(simple.MeasureProfile(Input=image, **{**FEW, "Angle": 20}), "Angle", "45")
    refuses(simple.MeasureProfile(Input=image, Tilt="3,3", **FEW), "Tilt", "2 values")
    refuses(simple.MeasureProfile(Input=[image, image], Kind="Hole", ViewSignal="SE;BSE-right", **FEW), "Kind", "all of SE or BSE")
    level = simple.SampleSurface(Shape="Mesa", FeatureHeight=0.1, Width=90, Depth=90)
    refuses(simple.MeasureProfile(Input=image, AFM=level, **{**FEW, "Height": 0}), "AFM", "levels")
    flat = simple.Calculator(Input=image, Function="1", ResultArrayName="SE")
    refuses(simple.MeasureProfile(Input=flat, **FEW), "Input", "no line is seen")


make_files()
run(lines_equal_the_command, further_images_tell_more, holes_are_circles, wrong_properties_are_refused)
