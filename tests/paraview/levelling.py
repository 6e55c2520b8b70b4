# SPDX-License-Identifier: GPL-3.0-or-later
"""Level Scan gives what 'semsurf level' gives."""
from support import DATA, FOLDER, abort_and_rerun, array, expect, fetch, matrix, progress_of, quiet, refuses, run, same, \
    semsurf, simple


def scan():
    return simple.AFMScanReader(FileName=str(DATA / "block.gsf"))


def equals_the_command():
    ways = {"hough": {}, "plane": {"Method": "Plane"},
            "polynomial": {"Method": "Polynomial", "Degree": 3}}
    for method, properties in ways.items():
        options = ["--level-degree", 3] if method == "polynomial" else []
        semsurf("level", DATA / "block.gsf", "--level-method", method, *options, "-o", "level.txt")
        got = quiet(simple.LevelScan(Input=scan(), **properties))
        same(array(got, got.GetPointData().GetScalars().GetName()), matrix(FOLDER / "level.txt"), method)


def rows_equal_the_command():
    semsurf("level", DATA / "noisy.gsf", "--rows", "median", "-o", "rows.txt")
    got = quiet(simple.LevelScan(Input=simple.AFMScanReader(FileName=str(DATA / "noisy.gsf")), Rows="Median"))
    same(array(got, got.GetPointData().GetScalars().GetName()), matrix(FOLDER / "rows.txt"), "rows")
    expect(array(got, "substrate").mean() > 0.1, "the substrate is marked")


def refuses_what_is_wrong():
    first = simple.LevelScan(Input=scan())   # its output has the substrate, too
    level = simple.LevelScan(Input=first, Scalars=["POINTS", "nothing"])
    refuses(level, "Scalars", "no array 'nothing'", "one of 'Height', 'substrate'")
    level.Scalars = ["POINTS", "Height"]
    quiet(level)
    refuses(simple.LevelScan(Input=simple.Wavelet()), "Input", "21 layers along z")


def tells_and_aborts():
    surface = simple.SampleSurface(Shape="Rough", Width=1998, Depth=1998)
    surface.UpdatePipeline()
    level = simple.LevelScan(Input=surface)
    expect(len(progress_of(level)) > 3, "there is progress")
    whole = array(fetch(level), "z_nm").copy()
    level.Tolerance = 0.5
    abort_and_rerun(level)
    level.Tolerance = 0
    same(array(fetch(level), "z_nm"), whole, "after an abort")


def arrays_are_found():
    """However a filter was made: ParaView takes the first choice from the active source, not from the input."""
    semsurf("level", DATA / "block.gsf", "-o", "level.txt")
    want = matrix(FOLDER / "level.txt")
    same(array(quiet(simple.LevelScan(Input=scan())), "Height"), want, "before its input was read")
    other = simple.SampleSurface()
    other.UpdatePipeline()
    same(array(quiet(simple.LevelScan(Input=scan())), "Height"), want, "made while another source is active")
    same(array(quiet(simple.LevelScan(scan())), "Height"), want, "with its input as an argument")


run(equals_the_command, arrays_are_found, rows_equal_the_command, refuses_what_is_wrong, tells_and_aborts)
