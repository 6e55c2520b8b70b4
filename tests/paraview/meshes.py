# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces made, mended, thinned, written and read are the commands'."""
import json

from support import DATA, FOLDER, array, column, each, expect, fetch, messages, numpy, quiet, refuses, refuses_until, run, \
    same, semsurf, servermanager, simple, text, vtk_to_numpy


def scan():
    return simple.AFMScanReader(FileName=str(DATA / "block.gsf"))


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def corners(data):
    return vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def read(name):
    return fetch(simple.SurfaceMeshReader(FileName=str(FOLDER / name)))


def surfaces_equal_the_command():
    for properties, options in [({}, []), ({"Simplify": 1}, ["--tolerance", "0.1nm"]), ({"Solid": 1}, ["--solid"]),
                                ({"Solid": 1, "Thickness": 3}, ["--solid", "--thickness", "3nm"])]:
        semsurf("mesh", DATA / "block.gsf", *options, "-o", "surface.ply")
        got, want = quiet(simple.HeightFieldtoSurface(Input=scan(), **properties)), read("surface.ply")
        same(points(got), points(want), f"{properties}: points")
        same(corners(got), corners(want), f"{properties}: triangles")
        for name in ("height", "curvature"):
            same(array(got, name), array(want, name), f"{properties}: {name}")


def there_and_back():
    scan_data = fetch(scan())
    surface = simple.HeightFieldtoSurface(Input=scan())
    back = quiet(simple.SurfacetoHeightField(Input=surface, Pitch=1))
    off = array(back, "z_nm") - array(scan_data, "Height")
    expect(numpy.abs(off).max() < 1e-12, f"heights are {numpy.abs(off).max()} nm off")
    sphere = quiet(simple.SurfacetoHeightField(Input=simple.SampleBody(Shape="Sphere", Radius=50), Samples=101))
    expect(sphere.GetDimensions() == (101, 101, 1), f"samples: {sphere.GetDimensions()}")
    expect(numpy.isnan(array(sphere, "z_nm")[0, 0]) and array(sphere, "valid")[0, 0] == 0, "corners are holes")
    expect(abs(numpy.nanmax(array(sphere, "z_nm")) - 100) < 0.5, "its top")


def mending_equals_the_command():
    damaged = simple.Clip(Input=simple.SampleBody(Shape="Sphere", Radius=50))
    damaged.ClipType.Origin, damaged.ClipType.Normal = [0, 0, 98], [0, 0, 1]
    surface = simple.ExtractSurface(Input=damaged)
    simple.SaveData(str(FOLDER / "open.off"), proxy=surface)
    mended = simple.CheckandRepairMesh(Input=surface)
    semsurf("mesh", "open.off", "--repair", "-o", "mended.off")
    want = read("mended.off")
    got = quiet(mended)
    expect(len(corners(got)) == len(corners(want)), f"{len(corners(got))} triangles, not {len(corners(want))}")
    table = quiet(mended, 1)
    row = column(table, "quantity").index("boundary_edges")
    expect(column(table, "before")[row] > 10 and column(table, "after")[row] == 0, "the hole is filled")
    mended.Repair = 0
    expect(column(fetch(mended, 1), "after")[row] == column(table, "before")[row], "counting changes nothing")


def every_repair_is_the_option():
    """A mesh with each of the faults: a part too small, a flat triangle, a gap, a hole."""
    corners_of = numpy.array([[x, y, z] for z in (0, 40) for y in (0, 40) for x in (0, 40)], float)
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    points_, cells = [], []

    def add(face, shift=(0, 0, 0), size=1):
        first = len(points_)
        points_.extend(size * corners_of[k] + numpy.array(shift) for k in face)
        cells.append([first + k for k in range(len(face))])
    for number, face in enumerate(faces):
        if number != 1:                        # a hole on top
            add(face, (0.3 if number == 5 else 0, 0, 0))   # and a gap
        add(face, (100, 0, 0), 0.05)           # a small part
    first = len(points_)
    points_.extend(numpy.array(p, float) for p in ((300, 0, 0), (310, 0, 0), (305, 0.01, 0), (305, -20, 0)))
    cells.extend([[first, first + 1, first + 2], [first + 1, first, first + 3]])   # a sliver
    lines = ["OFF", f"{len(points_)} {len(cells)} 0", *(" ".join(map(repr, map(float, p))) for p in points_),
             *(f"{len(c)} {' '.join(map(str, c))}" for c in cells)]
    (FOLDER / "faulty.off").write_text("\n".join(lines) + "\n")
    reader = simple.SurfaceMeshReader(FileName=str(FOLDER / "faulty.off"))
    seen = set()

    def check(properties, *options):
        semsurf("mesh", "faulty.off", "--repair", *options, "-o", "whole.off")
        got, want = fetch(simple.CheckandRepairMesh(Input=reader, **properties)), read("whole.off")
        same(points(got), points(want), "points")
        same(corners(got), corners(want), "triangles")
        result = points(got).tobytes() + corners(got).tobytes()
        expect(result not in seen, "it changes nothing")
        seen.add(result)
    each([({},), ({"Stitch": 0.5}, "--stitch", "0.5nm"), ({"MaxHole": 1000}, "--max-hole", "1um"),
          ({"MinComponent": 10}, "--min-component", "10nm"), ({"Sliver": 0.1}, "--sliver", "0.1nm")], check)


def crossings_are_resolved_as_the_command_does():
    both = simple.AppendGeometry(Input=[simple.SampleBody(Shape="Sphere", Radius=50, Subdivisions=2, Base=[x, 0, 0]) for x in (0, 60)])
    simple.SaveData(str(FOLDER / "crossing.off"), proxy=both)
    reader = simple.SurfaceMeshReader(FileName=str(FOLDER / "crossing.off"))
    results = []
    for properties, options in [({}, []), ({"KeepIntersections": 1}, ["--keep-intersections"])]:
        semsurf("mesh", "crossing.off", "--repair", *options, "-o", "whole.off", code=None)
        mended, want = simple.CheckandRepairMesh(Input=reader, **properties), read("whole.off")
        results.append(fetch(mended))
        same(points(results[-1]), points(want), f"{properties}: points")
        same(corners(results[-1]), corners(want), f"{properties}: triangles")
        table = quiet(mended, 1)
        row = column(table, "quantity").index("self_intersections")
        before, after = column(table, "before")[row], column(table, "after")[row]
        expect(before > 10 and (after > 10) == bool(properties), f"{properties}: {before} crossings before, {after} after")
    expect(len(corners(results[0])) != len(corners(results[1])), "it changes nothing")


def thinning_equals_the_command():
    body = simple.SampleBody(Shape="Sphere", Radius=50, Subdivisions=4)
    simple.SaveData(str(FOLDER / "sphere.off"), proxy=body)
    semsurf("mesh", "sphere.off", "--tolerance", "1nm", "-o", "thin.off")
    got, want = quiet(simple.SimplifyMesh(Input=body, MeshTolerance=1)), read("thin.off")
    same(corners(got), corners(want), "triangles")
    same(points(got), points(want), "points")
    few = quiet(simple.SimplifyMesh(Input=body, Limit="Triangles", Triangles=100))
    expect(few.GetNumberOfPolys() <= 100, f"{few.GetNumberOfPolys()} triangles")
    both = quiet(simple.SimplifyMesh(Input=body, Limit="Both", Triangles=600, MeshTolerance=3))
    semsurf("mesh", "sphere.off", "--tolerance", "3nm", "--triangles", 600, "-o", "both.off")
    same(points(both), points(read("both.off")), "with both limits")
    expect(both.GetNumberOfPolys() > fetch(simple.SimplifyMesh(Input=body, MeshTolerance=3)).GetNumberOfPolys(),
           "the number is reached first")


def extremes(path):
    """Of the positions that a glTF file says, and what its nodes make of them."""
    content = path.read_bytes()
    length = int.from_bytes(content[12:16], "little")
    said = json.loads(content[20:20 + length])
    place = said["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
    accessor = said["accessors"][place]
    return [*accessor["min"], *accessor["max"],
            *[v for node in said["nodes"] for key in ("scale", "matrix", "translation") for v in node.get(key, [])]]


def files_are_read_back():
    surface = simple.HeightFieldtoSurface(Input=scan())
    want = fetch(surface)
    for name, exact in [("all.glb", False), ("all.gltf", False), ("all.3mf", False), ("all.off", True)]:
        simple.SaveData(str(FOLDER / name), proxy=surface)
        got = read(name)
        expect(got.GetNumberOfPoints() == want.GetNumberOfPoints(), f"{name}: {got.GetNumberOfPoints()} points")
        expect(numpy.allclose(points(got), points(want), rtol=0, atol=0 if exact else 1e-5), f"{name}: places")
        if name != "all.3mf" and name != "all.off":
            expect(numpy.allclose(array(got, "curvature"), array(want, "curvature"), atol=1e-6), f"{name}: curvature")
    thin = simple.SimplifyMesh(Input=surface, MeshTolerance=1)
    simple.SaveData(str(FOLDER / "thin.glb"), proxy=thin)
    expect(float(text(fetch(thin), "deviation_nm")) > 0, "what is said of it")
    expect(text(read("thin.glb"), "deviation_nm") == text(fetch(thin), "deviation_nm"), "goes along into the file")
    tip = simple.AFMTip(TipSize=9)
    servermanager.writers.HeightFieldWriter(Input=tip, FileName=str(FOLDER / "tip.gsf")).UpdatePipeline()
    back = fetch(simple.AFMScanReader(FileName=str(FOLDER / "tip.gsf")))
    expect(text(back, "tip") == text(fetch(tip), "tip") == "structuring function", "and of heights")
    simple.SaveData(str(FOLDER / "true.glb"), proxy=surface, Magnification=1)
    expect(numpy.allclose(points(read("true.glb")), points(want), atol=1e-5), "true size")
    # What semsurf reads it undoes; the bytes are the command's.
    semsurf("mesh", DATA / "block.gsf", "-o", "block.ply")
    block = simple.SurfaceMeshReader(FileName=str(FOLDER / "block.ply"))
    for name, properties, options in [("a", {}, []), ("b", {"Magnification": 1000}, ["--magnification", 1000]),
                                      ("c", {"ZExaggeration": 3}, ["--z-exaggeration", 3])]:
        simple.SaveData(str(FOLDER / f"{name}1.off.glb"), proxy=block, **properties)
        semsurf("mesh", DATA / "block.gsf", *options, "-o", f"{name}2.off.glb")
        ours, theirs = ((FOLDER / f"{name}{k}.off.glb").stat().st_size for k in (1, 2))
        bounds = [extremes(FOLDER / f"{name}{k}.off.glb") for k in (1, 2)]
        same(bounds[0], bounds[1], f"{properties}: the extremes in the file, {ours} and {theirs} bytes")
    simple.SaveData(str(FOLDER / "saved.gsf"), proxy=scan())
    expect((FOLDER / "saved.gsf").stat().st_size > 12000, "saved by extension")
    for name in ("heights.gsf", "heights.txt"):   # by extension, text goes to ParaView's own writer
        servermanager.writers.HeightFieldWriter(Input=scan(), FileName=str(FOLDER / name)).UpdatePipeline()
        back = fetch(simple.AFMScanReader(FileName=str(FOLDER / name)))
        original = fetch(scan())
        same(array(back, back.GetPointData().GetScalars().GetName()),
             array(original, original.GetPointData().GetScalars().GetName()), name)


def inputs_are_not_written_over():
    semsurf("level", DATA / "block.gsf", "--level-method", "none", "-o", "own.gsf")
    before = (FOLDER / "own.gsf").read_bytes()
    (FOLDER / "link.gsf").symlink_to("own.gsf")
    source = simple.LevelScan(Input=simple.AFMScanReader(FileName=str(FOLDER / "own.gsf")))
    for name in ("own.gsf", "link.gsf"):
        writer = servermanager.writers.HeightFieldWriter(Input=source, FileName=str(FOLDER / name))
        with messages() as said:
            try:
                writer.UpdatePipeline()
            except RuntimeError:
                pass
        expect("an input" in said[0], f"{name}: {said[0]}")
    expect((FOLDER / "own.gsf").read_bytes() == before, "the scan is as it was")


def vtk_files_are_inline():
    """Debian's ParaView reads appended data as nothing."""
    surface = simple.HeightFieldtoSurface(Input=scan())
    simple.SaveData(str(FOLDER / "inline.vtp"), proxy=surface, DataMode="Binary")
    expect(fetch(simple.XMLPolyDataReader(FileName=[str(FOLDER / "inline.vtp")])).GetNumberOfPoints() == 3000, "VTP")
    semsurf("mesh", DATA / "block.gsf", "-o", "ours.vtp")
    expect(fetch(simple.XMLPolyDataReader(FileName=[str(FOLDER / "ours.vtp")])).GetNumberOfPoints() == 3000, "ours")


def wrong_properties_are_refused():
    surface = simple.HeightFieldtoSurface(Input=scan())
    refuses(simple.HeightFieldtoSurface(Input=scan(), Simplify=1, Tolerance=-1), "Tolerance", "below 0")
    refuses(simple.SimplifyMesh(Input=surface, Limit="Triangles", Triangles=3), "Triangles", "4 to 1e9")
    refuses_until(simple.SurfacetoHeightField(Input=surface, Samples=1), ["Samples", "2 to 16384"], Samples=20)
    refuses(simple.CheckandRepairMesh(Input=surface, Sliver=-1), "Sliver", "0nm or more")
    refuses(simple.SimplifyMesh(Input=simple.Line()), "Input", "no polygons")
    refuses(simple.HeightFieldtoSurface(Input=simple.SurfacetoHeightField(
        Input=simple.SampleBody(Shape="Sphere"), Samples=20)), "height field", "hole")


run(surfaces_equal_the_command, there_and_back, mending_equals_the_command, every_repair_is_the_option,
    crossings_are_resolved_as_the_command_does, thinning_equals_the_command,
    files_are_read_back, inputs_are_not_written_over, vtk_files_are_inline, wrong_properties_are_refused)
