# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration, reconstruction and calibration give the command's numbers to the last bit."""
import csv
import json

from support import FOLDER, SOURCE, abort_and_rerun, array, column, expect, fetch, messages, numpy, progress_of, quiet, \
    refuses, run, same, semsurf, servermanager, simple, text, vtk_to_numpy

MODEL = SOURCE / "samples" / "si-1keV-3nm.json"
SIZE, PITCH = 72, 3


def make_files():
    """A scan with noise of a surface of pads and waves, a sharp tip, and the SEM image of the surface with noise."""
    chance = numpy.random.default_rng(1)
    y, x = numpy.mgrid[0:SIZE, 0:SIZE] * 1.0
    z = 6 * numpy.sin(x / 9) * numpy.cos(y / 13 + 1)
    for cx, cy, r in [(18, 20, 7), (47, 31, 9), (28, 55, 6), (60, 60, 5), (58, 12, 4)]:
        z += 25 / (1 + numpy.exp(numpy.clip((numpy.hypot(x - cx, 1.3 * (y - cy)) - r) * 1.5, -30, 30)))
    numpy.savetxt(FOLDER / "truth.txt", z[::-1])
    numpy.savetxt(FOLDER / "scan.txt", (z + 0.2 * chance.standard_normal(z.shape))[::-1])
    semsurf("predict", "truth.txt", "--height-pitch", "3nm", "--model", MODEL, "-o", "truth.tif", "-q")
    semsurf("tip", "--shape", "cone:2nm,8deg", "--tip-size", 7, "--height-pitch", "3nm", "-o", "tip.txt")
    sem = fetch(simple.SEMImageReader(FileName=str(FOLDER / "truth.tif"), Channel="SE"))
    signal = array(sem, "SE")
    numpy.savetxt(FOLDER / "sem.txt", (500 * signal + 100 + 4 * chance.standard_normal(z.shape))[::-1])
    # Heights of any kind serve as a container that keeps every digit.
    source = simple.AFMScanReader(FileName=str(FOLDER / "sem.txt"), PixelSize=[PITCH, PITCH])
    servermanager.writers.HeightFieldWriter(Input=source, FileName=str(FOLDER / "sem.gsf")).UpdatePipeline()
    semsurf("clean", "sem.gsf", "--median", 1, "-o", "sem.tif", "-q")


def scan():
    return simple.AFMScanReader(FileName=str(FOLDER / "scan.txt"), PixelSize=[PITCH, PITCH])


def sem():
    return simple.SEMImageReader(FileName=str(FOLDER / "sem.tif"), PixelSize=[PITCH, PITCH])


def tip():
    return simple.AFMTipReader(FileName=str(FOLDER / "tip.txt"))


CHAIN = ["--height-pitch", "3nm", "--pixel-size", "3nm", "--level-method", "none", "--tip", "tip.txt", "--model", MODEL]


def registration_equals_the_command():
    semsurf("register", "scan.txt", "sem.tif", *CHAIN, "-o", "transform.json", "-q", code=None)
    want = json.loads((FOLDER / "transform.json").read_text())
    source = simple.RegisterAFMandSEM(Input=scan(), SEM=sem(), Tip=tip(), ModelFile=str(MODEL), LevelMethod="None")
    table = fetch(source, 1)
    values = dict(zip(column(table, "quantity"), column(table, "value")))
    same([values[k] for k in ("xx", "xy", "x0_nm", "yx", "yy", "y0_nm")], want["sem_to_afm"], "the transform")
    expect(bool(values["verified"]) == want["verified"], "the verdict")
    image = fetch(source)
    both = [(a - a[seen].mean()) / a[seen].std() for a in (array(image, "sem"), array(image, "simulated"))
            for seen in [numpy.isfinite(array(image, "sem") + array(image, "simulated"))]]
    expect(numpy.allclose(array(image, "blend"), 0.5 * (both[0] + both[1]), equal_nan=True), "half of each")
    expect(text(image, "sem_to_afm") == text(table, "sem_to_afm"), "the transform goes along")
    expect(numpy.isfinite(array(image, "blend")).mean() > 0.8, "both images, blended")
    sem_part, model_part = array(image, "sem"), array(image, "simulated")
    both = numpy.isfinite(sem_part + model_part)
    expect(numpy.corrcoef(sem_part[both], model_part[both])[0, 1] > 0.5, "the images lie on each other")


PLACES = [(20, 30), (150, 40), (70, 160), (180, 170)]


def marks(of):
    return simple.PolyLineSource(Points=[v for x, y in of for v in (x, y, 0)])


def landmarks_make_the_map():
    places, points = PLACES, marks
    moved = [(x + 6, y - 3) for x, y in places]
    common = dict(Input=scan(), SEM=sem(), Tip=tip(), ModelFile=str(MODEL), LevelMethod="None", LandmarksOnly=1)
    source = simple.RegisterAFMandSEM(SEMLandmarks=points(places), AFMLandmarks=points(moved), **common)
    table = fetch(source, 1)
    values = dict(zip(column(table, "quantity"), column(table, "value")))
    expect(abs(values["x0_nm"] - 6) < 1e-4 and abs(values["y0_nm"] + 3) < 1e-4 and values["landmarks_rms_nm"] < 1e-4, f"{values}")
    refuses(simple.RegisterAFMandSEM(SEMLandmarks=points(places), **common), "SEM Landmarks", "0 AFM Landmarks")
    refuses(simple.RegisterAFMandSEM(**common), "Landmarks Only", "no landmarks")


def reconstruction_equals_the_command():
    semsurf("reconstruct", "--afm", "scan.txt", "--sem", "sem.tif", *CHAIN, "--transform", "1,0,0,0,1,0", "--no-picture",
            "--iterations", 4, "-o", "result", "-q", code=None)
    source = simple.Reconstruct(Input=scan(), SEM=sem(), Tip=tip(), ModelFile=str(MODEL), LevelMethod="None", UseTransform=1,
                                Iterations=4)
    told = progress_of(source)
    expect(len(told) > 3, "there is progress")
    surface = fetch(source)
    want = fetch(simple.XMLImageDataReader(FileName=[str(FOLDER / "result" / "surface.vti")]))
    got = array(surface, "z_nm")
    for name in ("z_nm", "deviation_nm"):
        same(array(surface, name).astype(numpy.float32), array(want, name), name)
    expect(numpy.isfinite(array(surface, "deviation_nm")).all(), "each height's standard deviation")
    triangles = fetch(source, 1)
    expect(triangles.GetNumberOfPoints() == SIZE * SIZE, "the surface as triangles")
    same(vtk_to_numpy(triangles.GetPoints().GetData())[:, 2], got.ravel(), "their heights")
    for port in (2, 3):
        residual = array(fetch(source, port), "residual")
        expect(residual.shape == (SIZE, SIZE) and numpy.abs(residual).max() > 0, f"residual {port}")
    with open(FOLDER / "result" / "history.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    history = fetch(source, 4)
    same(column(history, "afm"), [float(r["afm"]) for r in rows], "the history")
    again = array(abort_and_rerun(source, 0.05), "z_nm")
    same(again, got, "after an abort")


def further_images_are_views():
    semsurf("reconstruct", "--afm", "scan.txt", "--sem", "sem.tif", "--sem", "sem.tif", "--tilt", "2deg", *CHAIN, "--transform",
            "1,0,0,0,1,0", "--no-picture", "--iterations", 2, "--corrections", 0, "-o", "views", "-q", code=None)
    source = simple.Reconstruct(Input=scan(), SEM=[sem(), sem()], Tip=tip(), ModelFile=str(MODEL), LevelMethod="None",
                                UseTransform=1, Iterations=2, Corrections=0, Tilt="2")
    want = fetch(simple.XMLImageDataReader(FileName=[str(FOLDER / "views" / "surface.vti")]))
    same(array(fetch(source), "z_nm").astype(numpy.float32), array(want, "z_nm"), "the surface")
    blocks = fetch(source, 5)
    expect(blocks.GetNumberOfBlocks() == 1, "a block for the view")
    want = fetch(simple.XMLImageDataReader(FileName=[str(FOLDER / "views" / "simulated_sem2.vti")]))
    for name in ("simulated", "residual"):
        same(array(blocks.GetBlock(0), name).astype(numpy.float32), array(want, name), name)


def landmarks_and_methods_reach_the_reconstruction():
    """By conjugate gradients, from landmarks alone, without deviations: as the command does it."""
    places, moved = PLACES, [(x + 6, y - 3) for x, y in PLACES]
    (FOLDER / "pairs.csv").write_text("sem_x_nm,sem_y_nm,afm_x_nm,afm_y_nm\n" +
                                      "".join(f"{a},{b},{c},{d}\n" for (a, b), (c, d) in zip(places, moved)))
    semsurf("reconstruct", "--afm", "scan.txt", "--sem", "sem.tif", *CHAIN, "--landmarks", "pairs.csv", "--accept-registration",
            "--no-picture", "--no-uncertainty", "--method", "conjugate-gradients", "--iterations", 3, "-o", "second", "-q", code=None)
    source = simple.Reconstruct(Input=scan(), SEM=sem(), Tip=tip(), ModelFile=str(MODEL), LevelMethod="None", AcceptRegistration=1,
                                SEMLandmarks=marks(places), AFMLandmarks=marks(moved), Iterations=3, NoUncertainty=1,
                                Optimiser="Conjugate gradients")
    want = fetch(simple.XMLImageDataReader(FileName=[str(FOLDER / "second" / "surface.vti")]))
    same(array(fetch(source), "z_nm").astype(numpy.float32), array(want, "z_nm"), "the surface")
    expect(fetch(source).GetPointData().GetArray("deviation_nm") is None, "no deviations")


def scans_alone_are_reconstructed():
    source = simple.Reconstruct(Input=scan(), Tip=tip(), LevelMethod="None", Iterations=2, NoUncertainty=1)
    expect(array(fetch(source), "z_nm").shape == (SIZE, SIZE), "on the scan's samples")
    expect(fetch(source, 3).GetNumberOfPoints() == 0 or fetch(source, 3).GetPointData().GetNumberOfArrays() == 0, "no SEM")


def calibration_equals_the_command():
    truth = simple.AFMScanReader(FileName=str(FOLDER / "truth.txt"), PixelSize=[PITCH, PITCH])
    predicted = simple.PredictSEM(Input=truth, ModelFile=str(MODEL))
    semsurf("calibrate", "sem.tif", "--pixel-size", "3nm", "--images", "truth.tif", "-o", "fit.json", "-q", code=None)
    want = json.loads((FOLDER / "fit.json").read_text())
    source = simple.CalibrateSEM(Input=sem(), Simulated=predicted)
    table = fetch(source, 1)
    values = dict(zip(column(table, "quantity"), column(table, "value")))
    same([values["gain SE"], values["gain BSE"], values["offset"]],
         [c["gain"] for c in want["channels"]] + [want["offset"]["value"]], "gains and offset")
    image = fetch(source)
    expect(numpy.allclose(array(image, "calibrated") + array(image, "residual"), array(fetch(sem()), sem_name())), "the fit")
    for properties, options in [({"Offset": "90"}, ["--offset", 90]),
                                ({"Black": "120", "White": "700"}, ["--black", 120, "--white", 700]),
                                ({"Fit": "SE"}, ["--fit", "SE"])]:
        semsurf("calibrate", "sem.tif", "--pixel-size", "3nm", "--images", "truth.tif", *options, "-o", "fit.json", "-q", code=None)
        want = json.loads((FOLDER / "fit.json").read_text())
        table = fetch(simple.CalibrateSEM(Input=sem(), Simulated=predicted, **properties), 1)
        got = dict(zip(column(table, "quantity"), column(table, "value")))
        expect(got["gain SE"] != values["gain SE"], f"{properties} change nothing")
        same([got[f"gain {c['name']}"] for c in want["channels"]] + [got["offset"]],
             [c["gain"] for c in want["channels"]] + [want["offset"]["value"]], f"{properties}")
    refuses(simple.CalibrateSEM(Input=sem(), Simulated=predicted, Fit="SE, XX"), "Fit", "'XX'")
    refuses(simple.CalibrateSEM(Input=simple.SampleSurface(), Simulated=predicted), "Simulated", "pixels")


def sem_name():
    return fetch(sem()).GetPointData().GetScalars().GetName()


def wrong_properties_are_refused():
    common = dict(Input=scan(), SEM=sem(), Tip=tip(), LevelMethod="None")
    refuses(simple.RegisterAFMandSEM(ModelFile="", Material="", **common), "Model File", "no model")
    refuses(simple.Reconstruct(ModelFile=str(MODEL), Upsample=9, **common), "Upsample", "1 to 8")
    refuses(simple.Reconstruct(ModelFile=str(MODEL), UseTransform=1, Transform=[0] * 6, **common), "Transform")


make_files()
run(registration_equals_the_command, landmarks_make_the_map, reconstruction_equals_the_command, further_images_are_views,
    landmarks_and_methods_reach_the_reconstruction, scans_alone_are_reconstructed,
    calibration_equals_the_command, wrong_properties_are_refused)
