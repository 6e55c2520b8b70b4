# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces are compared as by the command, to the last bit."""
import csv

from support import FOLDER, array, column, expect, fetch, numpy, refuses, run, same, semsurf, \
    simple, text

SIZE, PITCH = 64, 2
FEW = {"Simulations": 400}
OPTIONS = ["--simulations", 400, "--no-picture", "-q"]


def make_scan(name, seed, bump):
    """A rough surface with its own noise, and a bump of 3 nm where something grew: NAME.txt."""
    ground = numpy.random.default_rng(9).normal(0, 30, (SIZE, SIZE))
    for axis in (0, 1):
        for _ in range(3):
            ground = sum(numpy.roll(ground, k, axis) for k in range(-3, 4)) / 7
    z = ground + numpy.random.default_rng(seed).normal(0, 0.3, ground.shape)
    z[30:40, 20:30] += 3 * bump
    numpy.savetxt(FOLDER / f"{name}.txt", z[::-1], fmt="%.5f")


def scan(name):
    return simple.AFMScanReader(FileName=str(FOLDER / f"{name}.txt"), PixelSize=[PITCH, PITCH])


def compare(**properties):
    return simple.CompareSurfaces(Input=scan("before"), After=scan("after"), **{**FEW, **properties})


def rows_of(file):
    with open(file, newline="") as table:
        return list(csv.DictReader(table))


def changes_equal_the_command():
    for properties, options in [({}, []), ({"FalseAlarms": 0.01}, ["--false-alarms", "1%"]),
                                ({"AfterDeviation": 0.3, "BeforeDeviation": 0.3},
                                 ["--after-deviation", "0.3nm", "--before-deviation", "0.3nm"])]:
        semsurf("compare", "before.txt", "after.txt", "--height-pitch", f"{PITCH}nm", *options, *OPTIONS, "-o", "change",
                code=None)
        source = compare(**properties)
        places, want = fetch(source, 1), rows_of(FOLDER / "change/places.csv")
        expect(len(want) == 1, f"{len(want)} places")
        for name in ("x_nm", "y_nm", "mean_nm", "probability"):
            expect(numpy.allclose(column(places, name), [float(row[name]) for row in want], rtol=1e-4, atol=1e-4), name)
        there = simple.OpenDataFile(str(FOLDER / "change/change.vti"))
        image = fetch(source)
        known = array(fetch(there), "valid") > 0
        expect(known.mean() > 0.9, "where there is a difference")
        for name in ("difference", "deviation", "probability", "place"):
            same(numpy.float32(array(image, name))[known], array(fetch(there), name)[known], name)
            expect(numpy.isnan(array(image, name)[~known]).all(), "holes")
        expect(text(places, "verdict") == "changed", "the verdict")


def what_did_not_change_says_so():
    source = simple.CompareSurfaces(Input=scan("before"), After=scan("again"), **FEW)
    expect(fetch(source, 1).GetNumberOfRows() == 0 and text(fetch(source, 1), "verdict") == "unchanged", "nothing changed")


def deviations_of_the_input_count():
    wide = simple.Calculator(Input=scan("after"), Function="2", ResultArrayName="deviation_nm")
    source = simple.CompareSurfaces(Input=scan("before"), After=wide, AfterScalars=["POINTS", "z_nm"], BeforeDeviation=0.3, **FEW)
    expect(numpy.nanmin(array(fetch(source), "deviation")) > 1.9, "the array deviation_nm")


def wrong_properties_are_refused():
    refuses(compare(FalseAlarms=0), "False Alarms", "0.1")
    refuses(compare(SmallestWindow=0), "Smallest Window", "1")
    other = simple.SampleSurface(Shape="Mesa", Width=90, Depth=90, Pitch=2)
    refuses(simple.CompareSurfaces(Input=scan("before"), After=other, **FEW), "After", "cannot be laid")


for name, seed, bump in (("before", 1, 0), ("after", 2, 1), ("again", 3, 0)):
    make_scan(name, seed, bump)
run(changes_equal_the_command, what_did_not_change_says_so, deviations_of_the_input_count, wrong_properties_are_refused)
