# SPDX-License-Identifier: GPL-3.0-or-later
"""Files are read as the library reads them; a letter F shows every flip."""
import os
import pathlib

from support import DATA, FOLDER, SOURCE, array, expect, fetch, matrix, messages, numpy, quiet, refuses, refuses_until, \
    run, same, semsurf, simple

REAL = pathlib.Path(os.environ.get("SEMSURF_TEST_DATA", "/nowhere"))


def letter_f():
    """An F, 5 x 7, upright in the picture: its arms go right, the long one at the top."""
    rows = ["11111", "10000", "10000", "11100", "10000", "10000", "10000"]
    return numpy.array([[float(c) for c in row] for row in rows])


def the_letter_stands_upright():
    picture = letter_f()
    numpy.savetxt(FOLDER / "f.txt", picture)   # row 0 on top, as in a file
    data = quiet(simple.AFMScanReader(FileName=str(FOLDER / "f.txt"), PixelSize=[2, 3]))
    name = data.GetPointData().GetScalars().GetName()
    same(array(data, name), picture[::-1], "the letter")
    expect(data.GetBounds() == (0, 8, 0, 18, 0, 0), f"its place: {data.GetBounds()}")
    surface = fetch(simple.HeightFieldtoSurface(Input=simple.AFMScanReader(FileName=str(FOLDER / "f.txt"))))
    top_left = [p for p in range(surface.GetNumberOfPoints()) if surface.GetPoint(p)[:2] == (0, 6)][0]
    expect(surface.GetPoint(top_left)[2] == 1, "the surface's corner")
    back = fetch(simple.SurfacetoHeightField(Input=simple.HeightFieldtoSurface(
        Input=simple.AFMScanReader(FileName=str(FOLDER / "f.txt"))), Pitch=1))
    same(array(back, "z_nm"), picture[::-1], "the letter, seen from above")


def scans_are_in_nm():
    semsurf("level", DATA / "block.gsf", "--level-method", "none", "-o", "block.txt")
    data = quiet(simple.AFMScanReader(FileName=str(DATA / "block.gsf")))
    same(array(data, "Height"), matrix(FOLDER / "block.txt"), "heights")
    from vtkmodules.vtkCommonCore import vtkDataArray
    keys = data.GetPointData().GetArray("Height").GetInformation()
    expect(keys.Get(vtkDataArray.UNITS_LABEL()) == "nm", "the unit")


def holes_are_marked():
    (FOLDER / "holes.txt").write_text("1 2 3\n4 nan 6\n7 8 9\n")
    data = quiet(simple.AFMScanReader(FileName=str(FOLDER / "holes.txt")))
    values = array(data, data.GetPointData().GetScalars().GetName())
    expect(numpy.isnan(values[1, 1]) and numpy.isfinite(values).sum() == 8, "one hole")
    expect((array(data, "valid") == [[1, 1, 1], [1, 0, 1], [1, 1, 1]]).all(), "the mask")


def sem_images_have_their_place():
    size = ["--size", "6x4", "--electrons", 1]
    semsurf("simulate", SOURCE / "samples" / "flat.toml", *size, "-o", "sem.tif", "-q")
    data = quiet(simple.SEMImageReader(FileName=str(FOLDER / "sem.tif"), Channel="BSE"))
    expect(data.GetDimensions() == (6, 4, 1), f"size: {data.GetDimensions()}")
    ours = fetch(simple.SEMImageReader(FileName=str(FOLDER / "sem.tif"), PixelSize=[7, 9]))
    expect(ours.GetSpacing()[:2] == (7, 9), f"another pixel size: {ours.GetSpacing()}")
    refuses(simple.SEMImageReader(FileName=str(FOLDER / "sem.tif"), Channel="nothing"), "nothing")


def images_with_counts_are_estimated():
    semsurf("simulate", SOURCE / "samples" / "flat.toml", "--size", "24x20", "--electrons", 32, "--channels",
            "counts,electrons,z_nm,normal,material", "-o", "counts.exr", "-o", "counts.vti", "-q")
    semsurf("estimate", "counts.exr", "-o", "estimated.vti", "-q")
    counts, want = [simple.XMLImageDataReader(FileName=[str(FOLDER / name)]) for name in ("counts.vti", "estimated.vti")]
    there = fetch(simple.EstimateSEM(Input=counts))
    for name in ("SE", "SE.stderr", "SE.radius"):
        same(array(there, name), array(fetch(want), name), name)
    refuses(simple.EstimateSEM(Input=simple.SampleSurface(Shape="Rough", Width=60, Depth=60, Pitch=3, CorrelationLength=9)),
            "no counts")


def units_and_parts_are_read():
    (FOLDER / "one.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n")
    data = fetch(simple.SurfaceMeshReader(FileName=str(FOLDER / "one.off"), Unit=1000))
    expect(data.GetBounds()[:4] == (0, 1000, 0, 2000), f"in um: {data.GetBounds()}")
    numpy.savetxt(FOLDER / "units.txt", letter_f())
    heights = fetch(simple.AFMScanReader(FileName=str(FOLDER / "units.txt"), HeightUnit=5))
    same(array(heights, heights.GetPointData().GetScalars().GetName()), 5 * letter_f()[::-1], "in units of 5 nm")
    semsurf("simulate", SOURCE / "samples" / "flat.toml", "--size", "6x4", "--electrons", 1, "-o", "size.tif", "-q")
    sizes = fetch(simple.SEMImageReader(FileName=str(FOLDER / "size.tif"), PixelSize=[7, 9])).GetSpacing()
    expect(sizes[:2] == (7, 9), f"{sizes}")


def wrong_files_are_refused():
    refuses_until(simple.AFMScanReader(FileName=str(FOLDER / "missing.gsf")), ["missing.gsf"],
                  FileName=str(DATA / "block.gsf"))
    (FOLDER / "empty.gsf").write_text("")
    refuses(simple.AFMScanReader(FileName=str(FOLDER / "empty.gsf")), "empty.gsf", "empty")
    refuses(simple.SurfaceMeshReader(FileName=str(FOLDER / "missing.off")), "missing.off")
    refuses(simple.AFMTipReader(FileName=str(FOLDER / "missing.gsf")), "missing.gsf")
    refuses(simple.SEMImageReader(FileName=str(FOLDER / "missing.tif")), "missing.tif")


def a_stated_unit_is_overridden_on_request_only():
    semsurf("mesh", DATA / "cube.off", "-o", "stated.stl")
    reader = simple.SurfaceMeshReader(FileName=str(FOLDER / "stated.stl"), Unit=1000)
    refuses(reader, "stated.stl", "says that its unit is 1.00 nm")
    reader.OverrideUnit = 1
    bounds = fetch(reader).GetBounds()
    expect(abs(bounds[1] - bounds[0] - 40e3) < 1, f"in um: {bounds}")
    refuses(simple.SurfaceMeshReader(FileName=str(FOLDER / "stated.stl"), OverrideUnit=1), "Override Unit")


def a_file_that_changes_is_read_again():
    path = FOLDER / "changing.txt"
    path.write_text("1 2\n3 4\n")
    reader = simple.AFMScanReader(FileName=str(path))
    fetch(reader)
    path.write_text("1 2 3\n4 5 6\n")
    os.utime(path, (1, 1))
    reader.GetClientSideObject().Modified()
    expect(fetch(reader).GetDimensions() == (3, 2, 1), "the new size")


def channels_can_be_chosen():
    if not REAL.is_dir():
        return print("skipped: SEMSURF_TEST_DATA is not set")
    reader = simple.AFMScanReader(FileName=str(REAL / "afm" / "AR_20211011_4ch.gwy"))
    data = quiet(reader)
    names = [data.GetPointData().GetArrayName(i) for i in range(data.GetPointData().GetNumberOfArrays())]
    expect(len(names) >= 4, f"channels: {names}")
    reader.Channels = [names[1]]
    left = fetch(reader).GetPointData()
    expect(left.GetNumberOfArrays() == 1 and left.GetArrayName(0) == names[1], "the one that was chosen")


def real_scans_are_the_commands():
    if not REAL.is_dir():
        return print("skipped: SEMSURF_TEST_DATA is not set")
    for path in sorted((REAL / "afm").iterdir()):
        with messages():
            data = fetch(simple.AFMScanReader(FileName=str(path)))
        semsurf("level", path, "--level-method", "none", "-q", "-o", "real.txt")
        same(array(data, data.GetPointData().GetScalars().GetName()), matrix(FOLDER / "real.txt"), path.name)


run(the_letter_stands_upright, scans_are_in_nm, holes_are_marked, sem_images_have_their_place, images_with_counts_are_estimated, units_and_parts_are_read,
    wrong_files_are_refused,
    a_stated_unit_is_overridden_on_request_only, a_file_that_changes_is_read_again, channels_can_be_chosen, real_scans_are_the_commands)
