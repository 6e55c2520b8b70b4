# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulated images are the command's to the last bit, whether made at once, live, or of several bodies."""
import time

from support import DATA, FOLDER, abort_and_rerun, array, column, each, expect, fetch, numpy, progress_of, quiet, refuses, \
    refuses_until, run, same, semsurf, simple, text, touch, vtk_to_numpy

CHANNELS = ["SE", "SE.stderr", "BSE", "BSE.stderr", "valid"]


def sphere(**properties):
    return simple.SampleBody(Shape="Sphere", Radius=50, Subdivisions=3, **properties)


def command(*args):
    """The channels of what the command makes."""
    semsurf("simulate", *args, "-o", "out.tif", "-q", "--checkpoint", "off")
    source = simple.SEMImageReader(FileName=str(FOLDER / "out.tif"))
    images = {}
    for name in CHANNELS:
        source.Channel = name
        # The reader makes holes of what is not valid.
        images[name] = numpy.nan_to_num(array(fetch(source), name)).astype(numpy.float32)
    return images


def same_as(data, wanted, what):
    for name in CHANNELS:
        same(array(data, name), wanted[name], f"{what}: {name}")


def images_equal_the_command():
    body = sphere()
    simple.SaveData(str(FOLDER / "sphere.off"), proxy=body)
    for properties, options in [
            (dict(Electrons=5, Pixels=32), ["--size", "32x32", "--electrons", 5]),
            (dict(Electrons=5, PixelSize=4, Materials="Au", Substrate="Si", Tilt=30, Energy=2000, Seed=7),
             ["--pixel-size", "4nm", "--electrons", 5, "--material", "Au", "--substrate", "Si", "--tilt", "30deg", "--energy",
              "2keV", "--seed", 7]),
            (dict(Budget="Accuracy", Accuracy=0.2, Pixels=24), ["--size", "24x24", "--accuracy", "20%"])]:
        data = quiet(simple.SimulateSEM(Input=body, **properties))
        same_as(data, command("sphere.off", *options), f"{properties}")
    expect(text(data, "state") == "done" and text(data, "simulation.accuracy") == "0.2", "it says how it was made")
    expect(array(data, "SE.stderr").max() > 0, "there are standard errors")


def every_property_is_the_option():
    """Each changes the image, and to what the command's option makes of it."""
    simple.SaveData(str(FOLDER / "small.off"), proxy=sphere())
    size = ["--size", "10x10", "--electrons", 4]
    plain = command("small.off", "--substrate", "Si", *size)

    def check(properties, *options):
        wanted = command("small.off", *([] if "Substrate" in properties else ["--substrate", "Si"]),
                         *([] if "--accuracy" in options else size if "--region" not in options else size[2:]), *options)
        given = {"Pixels": 10, "Electrons": 4, "Substrate": "Si", **properties}
        same_as(fetch(simple.SimulateSEM(Input=sphere(), **given)), wanted, "it is not the command's")
        expect(wanted["SE"].shape != plain["SE"].shape or (wanted["SE"] != plain["SE"]).any() or
               (wanted["SE.stderr"] != plain["SE.stderr"]).any(), "it changes nothing")
    each([({"Spot": 20}, "--spot", "20nm"), ({"Tilt": 30, "Azimuth": 50}, "--tilt", "30deg", "--azimuth", "50deg"),
          ({"Convergence": 5, "Focus": 100}, "--convergence", "5deg", "--focus", "100nm"),
          ({"WorkingDistance": 500}, "--working-distance", "500nm"), ({"SubstrateTop": 30}, "--substrate-z", "30nm"),
          ({"Physics": "elastic=browning,secondaries=off"}, "--physics", "elastic=browning,secondaries=off"),
          ({"Region": [-20, -40, 40, 10], "PixelSize": 5}, "--region", "-20,-40,40,10", "--pixel-size", "5nm"),
          ({"Budget": "Accuracy", "Accuracy": 0.5, "AccuracyFloor": 0.3}, "--size", "10x10", "--accuracy", "50%",
           "--accuracy-floor", "0.3")], check)
    scan = simple.AFMScanReader(FileName=str(DATA / "block.gsf"))
    mirrored = fetch(simple.SimulateSEM(Input=scan, Pixels=20, Electrons=5, Tilt=60))
    width, height, _ = mirrored.GetDimensions()
    for edge in ("flat", "periodic"):
        wanted = command(DATA / "block.gsf", "--size", f"{width}x{height}", "--electrons", 5, "--edge", edge, "--tilt", "60deg")
        data = fetch(simple.SimulateSEM(Input=scan, Pixels=20, Electrons=5, Edge=edge.capitalize(), Tilt=60))
        same_as(data, wanted, edge)
        expect((array(data, "SE") != array(mirrored, "SE")).any(), f"{edge} changes nothing")


def heights_equal_the_command():
    scan = simple.AFMScanReader(FileName=str(DATA / "block.gsf"))
    data = quiet(simple.SimulateSEM(Input=scan, Pixels=20, Electrons=5))
    width, height, _ = data.GetDimensions()
    same_as(data, command(DATA / "block.gsf", "--size", f"{width}x{height}", "--electrons", 5), "a scan")


def bodies_have_materials():
    ball, box = sphere(), simple.SampleBody(Shape="Box", Size=[60, 60, 20], Base=[120, 0, 0])
    group = simple.GroupDatasets(Input=[ball, box])
    data = quiet(simple.SimulateSEM(Input=group, Materials="Au, C", Electrons=10, PixelSize=5))
    image = array(data, "BSE")
    gold, carbon = image[:, : image.shape[1] // 3].mean(), image[:, -image.shape[1] // 4:].mean()
    expect(gold > 2 * carbon > 0, f"gold is brighter: {gold} and {carbon}")
    whole = quiet(simple.SimulateSEM(Input=group, Materials="C", Electrons=10, PixelSize=5))
    expect(array(whole, "BSE").max() < image.max(), "the last name is for all that are left")


def tracks_and_detectors():
    source = simple.SimulateSEM(Input=sphere(), Pixels=16, Electrons=5, Trajectories=20, Detectors="SE1; quadrants")
    lines = quiet(source, 1)
    energies = vtk_to_numpy(lines.GetPointData().GetArray("energy_ev"))
    expect(lines.GetNumberOfLines() >= 20 and energies.max() <= 1016 and energies.min() >= 0, "tracks with energies")
    expect(len(set(vtk_to_numpy(lines.GetCellData().GetArray("electron")))) == 20, "of 20 primaries")
    table = quiet(source, 2)
    names = column(table, "detector")
    expect(names[:3] == ["SE", "BSE", "SE1"] and len(names) == 7, f"{names}")
    yields = column(table, "yield")
    expect(abs(yields[1] - yields[3:].sum()) < 1e-12, "four quadrants make BSE")
    image = fetch(source)
    errors = column(table, "standard_error")
    for name, mean, error in zip(names, yields, errors):
        pixels = array(image, name)[array(image, "valid") > 0].astype(float)
        expect(abs(pixels.mean() - mean) < 1e-4 * mean, f"the yield of {name} is {mean}, the image's mean {pixels.mean()}")
        expect(0 < error < 0.5 * mean, f"the standard error of {name}: {error} of {mean}")
    ways = [lines.GetCell(i).GetPointIds() for i in range(lines.GetNumberOfCells())]
    ends = [(energies[way.GetId(0)], energies[way.GetId(way.GetNumberOfIds() - 1)]) for way in ways if way.GetNumberOfIds() > 3]
    expect(sum(begin > end for begin, end in ends) > len(ends) / 2 > 5, "electrons lose energy on their way")
    quadrants = array(image, "BSE-left")
    expect(quadrants.shape == (16, 16), "an image for each")
    source.Trajectories = 0
    expect(fetch(source, 1).GetNumberOfPoints() == 0, "no tracks unless asked for")


def needs_update(source):
    needs = source.SMProxy.GetProperty("NeedsUpdate")
    source.SMProxy.UpdatePropertyInformation(needs)
    return needs.GetElement(0)


def live_images_refine():
    body = sphere()
    properties = dict(Pixels=64, Electrons=100)
    plain = quiet(simple.SimulateSEM(Input=body, **properties))
    source = simple.SimulateSEM(Input=body, Live=1, **properties)
    begin = time.monotonic()
    first = quiet(source)
    seconds = time.monotonic() - begin
    expect(seconds < 3, f"the first image takes {seconds} s")   # on a busy machine; bench/ has the figure
    expect(text(first, "state") in ("coarse", "refining"), text(first, "state"))
    expect((array(first, "SE") > 0).mean() > 0.3, "it shows the specimen")
    states = [text(first, "state")]
    while states[-1] != "done":
        expect(time.monotonic() - begin < 120, f"no end: {states[-1]}")
        if not needs_update(source):
            time.sleep(0.02)
            continue
        touch(source)
        data = fetch(source)
        states.append(text(data, "state"))
    expect(len(states) > 2, f"there are steps: {states}")
    expect(not needs_update(source), "what is done needs no update")
    for name in CHANNELS:
        same(array(data, name), array(plain, name), f"live: {name}")
    source.Seed = 2
    expect(text(fetch(source), "state") != "done", "another seed begins anew")
    source.Live = 0
    expect(text(fetch(source), "state") == "done", "without Live all is done at once")


def wrong_properties_are_refused():
    def wrong(*words, **properties):
        refuses(simple.SimulateSEM(Input=sphere(), **{"Pixels": 8, "Electrons": 1, **properties}), *words)
    wrong("Energy", "100eV to 30keV", Energy=50)
    wrong("Materials", "'Xx'", Materials="Xx")
    wrong("Substrate", "'Xx'", Substrate="Xx")
    wrong("Electrons", "out of range", Electrons=0)
    wrong("Accuracy", "0.01% to 100%", Budget="Accuracy", Accuracy=2)
    wrong("Detectors", "no value", Detectors="nonsense:")
    wrong("Tilt", "90", Tilt=95)
    wrong("Region", "empty", Region=[5, 0, 1, 1])
    refuses(simple.SimulateSEM(Input=simple.Line()), "Input", "no surface")
    refuses_until(simple.SimulateSEM(Input=simple.SampleSurface(), Pixels=8, Electrons=1, Energy=50), ["Energy"], Energy=1000)


def progress_and_abort():
    def check(budget):
        source = simple.SimulateSEM(Input=sphere(), Pixels=64, **budget)
        expect(len(progress_of(source)) > 3, f"{budget}: there is progress")
        whole = array(fetch(source), "SE").copy()
        source.Seed = 2
        source.Seed = 1
        same(array(abort_and_rerun(source, 0.1), "SE"), whole, f"{budget}: after an abort")
    for budget in ({"Electrons": 60, "Method": "Direct"}, {"Electrons": 200, "Method": "Replay"},
                   {"Budget": "Accuracy", "Accuracy": 0.1}):
        check(budget)


run(images_equal_the_command, every_property_is_the_option, heights_equal_the_command, bodies_have_materials, tracks_and_detectors, live_images_refine,
    wrong_properties_are_refused, progress_and_abort)
