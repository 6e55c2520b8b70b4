# SPDX-License-Identifier: GPL-3.0-or-later
"""Models learnt in ParaView are the files of `semsurf train`."""
import json

from support import DATA, FOLDER, abort_and_rerun, array, column, expect, fetch, numpy, progress_of, quiet, refuses, run, same, \
    semsurf, simple, touch

SMALL = {"Kind": "Secant", "Surfaces": 2, "SurfaceSize": 16, "Electrons": 2}


def scan():
    return simple.AFMScanReader(FileName=str(DATA / "block.gsf"))


def own(name, **properties):
    return simple.TrainSEMModelonBuiltinSurfaces(ModelFile=str(FOLDER / name), **properties)


def model(name):
    return json.loads((FOLDER / name).read_text())


def of(table, quantity):
    return column(table, "value")[column(table, "quantity").index(quantity)]


def files_equal_the_command():
    """To the last byte, the command it is made by included."""
    common = "train --material Si --energy 1000eV --pixel-size 3nm --kind"
    for number, (properties, options) in enumerate([
            (SMALL | {"HoldOut": 1}, "secant --surfaces 2 --surface-size 16 --hold-out 1 --electrons 2"),
            ({"Kind": "Facet network", "Surfaces": 2, "SurfaceSize": 16, "Electrons": 2, "Scales": "5,7", "Hidden": "3,2",
              "Iterations": 9, "Decay": 1e-3, "ModelError": 0.05, "Edge": "Flat", "Seed": 4},
             "facet-network --scales 5,7 --hidden 3,2 --iterations 9 --decay 0.001 --model-error 0.05 --surfaces 2 "
             "--surface-size 16 --edge flat --electrons 2 --seed 4"),
            ({"Kind": "Filter bank", "Surfaces": 2, "SurfaceSize": 16, "Electrons": 2, "Scales": "5", "MultiResolution": 1,
              "LeastEigenvalue": 0},
             "filter-bank --scales 5 --least-eigenvalue 0 --surfaces 2 --surface-size 16 --electrons 2 --multi-resolution"),
            ({"Kind": "Slope table", "TableElectrons": 50}, "slope-table --table-electrons 50")]):
        errors = quiet(train := own(f"ours{number}.json", **properties))
        semsurf(*common.split(), *options.split(), "-q", "-o", f"theirs{number}.json")
        expect((FOLDER / f"ours{number}.json").read_bytes() == (FOLDER / f"theirs{number}.json").read_bytes(),
               f"{properties}: another file than the command's")
        record = model(f"theirs{number}.json")["training"]
        scenes = record["scenes"]
        expect(column(errors, "surface")[:len(scenes)] == [s["name"] for s in scenes], "a row for each surface")
        for i, scene in enumerate(scenes):
            off = scene["residuals"][0]
            expect(column(errors, "SE_rms_off")[i] == off["rms"] / off["mean_signal"], "how far it is off")
        expect(of(fetch(train, 1), "kind") == model(f"theirs{number}.json")["kind"], "the second table says what it is")


def surfaces_are_learnt_and_predicted_with():
    """On heights of one's own, then images of them as Simulate SEM gives them, then of a microscope."""
    name = str(FOLDER / "heights.json")
    train = simple.TrainSEMModel(Input=[scan(), scan()], ModelFile=name, Kind="Ikeuchi secant", Electrons=2, HoldOut=1)
    table = quiet(train)
    expect(column(table, "surface") == ["surface-1", "surface-2", "all learnt from", "all held out"],
           f"rows: {column(table, 'surface')}")
    expect(list(column(table, "held_out")) == [0, 1, 0, 1], "the last is held out")
    semsurf("train", DATA / "block.gsf", "--kind", "ikeuchi-secant", "--electrons", 2, "-q", "-o", "theirs.json")
    train.Input, train.HoldOut = [scan()], 0
    expect(quiet(train).GetNumberOfRows() == 2, "one input less")
    same(model("heights.json")["parameters"]["channels"][0]["flat_yield"],
         model("theirs.json")["parameters"]["channels"][0]["flat_yield"], "what the command learns")
    predicted = quiet(simple.PredictSEM(Input=scan(), ModelFile=name))
    expect(array(predicted, "SE").min() > 0, "an image by it")

    heights = fetch(scan())
    pitch, (x0, x1, y0, y1) = heights.GetSpacing()[0], heights.GetBounds()[:4]
    half = 0.5 * pitch
    images = simple.SimulateSEM(Input=scan(), Region=[x0 - half, y0 - half, x1 + half, y1 + half], PixelSize=pitch, Electrons=4)
    given = simple.TrainSEMModel(Input=scan(), Images=images, ModelFile=str(FOLDER / "given.json"), Kind="Secant")
    quiet(given)
    expect(of(fetch(given, 1), "images_simulated") == "0", "none is simulated")
    expect(not (FOLDER / "given.training").exists(), "nor kept")
    learnt = model("given.json")["training"]["residuals"][1]["mean_signal"]
    expect(abs(learnt - array(fetch(images), "BSE").mean()) < 1e-6, "BSE is learnt from the array BSE")
    given.Signal = "BSE"
    expect(of(quiet_second(given), "channels") == "signal", "a microscope's one channel")
    given.Images = None
    refuses(given, "Signal", "no Images")


def quiet_second(train):
    quiet(train)
    return fetch(train, 1)


def images_are_kept_over_an_abort():
    train = own("stopped.json", Kind="Secant", Surfaces=3, SurfaceSize=24, Electrons=40)
    table = abort_and_rerun(train, after=0.3)
    expect(table.GetNumberOfRows() == 4, "all are there in the end")
    expect(int(of(fetch(train, 1), "images_found")) >= 1, "what was simulated before is used again")
    undisturbed = own("whole.json", Kind="Secant", Surfaces=3, SurfaceSize=24, Electrons=40)
    told = progress_of(undisturbed)
    expect(len(told) >= 3, f"progress: {told}")
    expect((FOLDER / "stopped.json").read_bytes() == (FOLDER / "whole.json").read_bytes(), "the abort does not show")
    touch(undisturbed)
    quiet(undisturbed)
    expect(of(fetch(undisturbed, 1), "images_found") == "3", "run again, nothing is simulated")


def wrong_properties_are_refused():
    refuses(simple.TrainSEMModelonBuiltinSurfaces(), "Model File", "no file is named")
    refuses(own("model.exr"), "Model File", "does not end in .json")
    refuses(own("a.json", **SMALL | {"PixelSize": 0}), "Pixel Size", "above zero")
    refuses(own("a.json", **SMALL | {"HoldOut": 2}), "Hold Out", "leave none to learn on")
    refuses(own("a.json", **SMALL | {"Hidden": "4"}), "Hidden", "a model 'secant' has none", "add Kind facet-network")
    refuses(own("a.json", Kind="Facet network", Scales="6"), "Scales", "Choose among 5,7")
    refuses(own("a.json", Kind="Facet network", Hidden="4,0"), "Hidden", "'0' is out of range")
    refuses(own("a.json", Energy=50), "Energy", "100eV to 30keV")
    refuses(own("a.json", Material="Unobtainium"), "Material", "Unobtainium")
    refuses(own("a.json", Kind="Stopping points", Spot=2), "Spot", "knows of no spot")
    two = {"ModelFile": str(FOLDER / "a.json"), "Kind": "Secant", "Electrons": 2}
    refuses(simple.TrainSEMModel(Input=[scan(), scan()], Images=scan(), **two), "Images", "1 of 2 surfaces")
    refuses(simple.TrainSEMModel(Input=scan(), Images=scan(), **two), "image of surface-1", "no channel 'SE'")
    refuses(simple.TrainSEMModel(Input=scan(), PixelSize=0.4, **two), "surface-1", "Pixel Size")
    expect(not (FOLDER / "a.json").exists(), "nothing is written")


run(files_equal_the_command, surfaces_are_learnt_and_predicted_with, images_are_kept_over_an_abort,
    wrong_properties_are_refused)
