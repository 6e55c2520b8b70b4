# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes: checks, repairs and simplifications are the program's."""
import numpy
import pytest

import semsurf
from conftest import CUBE, FACES, same_bytes


def test_check(cube):
    good = semsurf.check_mesh(cube)
    assert good.closed_and_oriented and good.faults == [] and good.area_nm2 == 60000
    assert good.volume_nm3 == pytest.approx(1e6)
    bad = semsurf.check_mesh(semsurf.Mesh(CUBE, FACES[1:]))
    assert not bad.closed_and_oriented and bad.boundary_edges == 3 and "open" in bad.faults[0]


def test_repair_is_as_by_the_program(tmp_path, program):
    broken = semsurf.Mesh(CUBE, FACES[1:][:, ::1])
    semsurf.write_mesh(tmp_path / "broken.ply", broken)
    program("mesh", "broken.ply", "--repair", "--max-hole", "400nm", "--plain", "-o", "program.off", "-q")
    mended = semsurf.repair_mesh(tmp_path / "broken.ply", max_hole="400nm")
    assert mended.found.sound and mended.found.changed and mended.found.filled_holes == 1
    there = semsurf.read_mesh(tmp_path / "program.off")
    assert numpy.array_equal(mended.vertices, there.vertices) and numpy.array_equal(mended.triangles, there.triangles)
    assert numpy.array_equal(semsurf.repair_mesh(broken, max_hole=400).triangles, mended.triangles)


def test_simplify(tmp_path, program, heights):
    fine = semsurf.mesh_heights(heights)
    assert len(fine.triangles) == 2 * 47 * 63
    semsurf.write_mesh(tmp_path / "fine.off", fine)
    program("mesh", "fine.off", "--mesh-tolerance", "0.5nm", "--plain", "-o", "program.off", "-q")
    coarse = semsurf.simplify(tmp_path / "fine.off", mesh_tolerance="0.5nm")
    there = semsurf.read_mesh(tmp_path / "program.off")
    assert numpy.array_equal(coarse.vertices, there.vertices) and numpy.array_equal(coarse.triangles, there.triangles)
    assert coarse.found.deviation_nm <= 0.5 and coarse.found.triangles_after < coarse.found.triangles_before
    with pytest.raises(semsurf.UsageError):
        semsurf.simplify(fine)


def test_thinned_heights(tmp_path, program, scan):
    program("mesh", scan, "--mesh-tolerance", "0.5nm", "--plain", "-o", "program.off", "-q")
    thin = semsurf.mesh_heights(scan, mesh_tolerance=0.5)
    there = semsurf.read_mesh(tmp_path / "program.off")
    assert len(thin.triangles) == len(there.triangles) and numpy.allclose(thin.bounds, there.bounds)


def test_parts_of_other_libraries(cube):
    """As trimesh and PyVista have them: int64 faces, faces with their number of corners in front."""
    faces = numpy.column_stack([numpy.full(12, 3), FACES]).ravel()
    again = semsurf.Mesh(CUBE.astype(numpy.float32), faces.reshape(-1, 4)[:, 1:])
    assert numpy.array_equal(again.triangles, cube.triangles)


def test_several_bodies_with_values_and_a_picture(tmp_path, cube, samples):
    other = semsurf.Mesh(cube.vertices + [200, 0, 0], cube.triangles)
    path = tmp_path / "two.vtm"
    semsurf.write_mesh(path, {"left": cube, "right": other}, scalars={"high": numpy.arange(8)})
    bodies = semsurf.read_bodies(path)
    assert [body.name for body in bodies] == ["left", "right"]
    assert all(numpy.array_equal(body.found.scalars.high, numpy.arange(8)) for body in bodies)
    assert bodies[1].vertices[:, 0].min() == 200
    image = semsurf.Image({"SE": numpy.outer(numpy.arange(12), numpy.ones(12))}, pitch=10, origin=(-5, -5))
    semsurf.write_mesh(tmp_path / "cube.glb", cube, drape=(image, "SE"))
    assert (tmp_path / "cube.glb").read_bytes()[:4] == b"glTF"
    semsurf.write_mesh(tmp_path / "cube.ply", cube, scalars={"seen": (image, "SE")})
    seen = semsurf.read_bodies(tmp_path / "cube.ply")[0].found.scalars.seen
    assert seen == pytest.approx((cube.vertices[:, 1] + 5) / 10)       # between pixels in proportion


def test_tracks_go_along(tmp_path, program, cube):
    image = semsurf.simulate(cube, material="Si", substrate="Si", size=(16, 12), electrons=5, trajectories=4,
                             output=tmp_path / "cube.exr")
    semsurf.write_mesh(tmp_path / "ours.glb", cube, tracks=image.found.tracks)
    semsurf.write_mesh(tmp_path / "file.glb", cube, tracks=tmp_path / "cube.tracks.vtp")
    assert same_bytes(tmp_path / "ours.glb", tmp_path / "file.glb")
    semsurf.write_mesh(tmp_path / "none.glb", cube, scalars={"a": numpy.zeros(8)})
    assert (tmp_path / "ours.glb").stat().st_size > (tmp_path / "none.glb").stat().st_size + 1000


@pytest.mark.parametrize("tracks, what", [
    ([1], "one is no track"), (3, "no list"), ([{"points": [[0, 0, 0]]}], "has no 'energies'"),
])
def test_what_is_no_track(tmp_path, cube, tracks, what):
    with pytest.raises(semsurf.InvalidInput, match=what):
        semsurf.write_mesh(tmp_path / "a.glb", cube, tracks=tracks)
    assert not (tmp_path / "a.glb").exists()


@pytest.mark.parametrize("name, keywords, what", [
    ("a.stl", {"tracks": []}, "hold no tracks"),
    ("a.stl", {"scalars": {"a": numpy.zeros(8)}}, "hold no scalars"),
    ("a.ply", {"scalars": {"a": numpy.zeros(7)}}, "8 numbers"),
    ("a.ply", {"scalars": {"a": numpy.full(8, numpy.nan)}}, "says nothing"),
    ("a.ply", {"scalars": [1, 2]}, "no dictionary"),
    ("a.glb", {"drape": (semsurf.Image({"a": numpy.ones((4, 4))}), "b")}, "no channel 'b'"),
])
def test_what_cannot_be_laid_on(tmp_path, cube, name, keywords, what):
    with pytest.raises(semsurf.Error, match=what):
        semsurf.write_mesh(tmp_path / name, cube, **keywords)
    assert not (tmp_path / name).exists()


def test_smoothing_keeps_heights_but_not_their_noise(samples):
    y, x = numpy.mgrid[0:40, 0:40] * 2.0
    rough = semsurf.HeightField(numpy.random.default_rng(2).normal(0, 1, x.shape) + 20, pitch=2)
    mesh = semsurf.solid(semsurf.mesh_heights(rough), thickness="30nm")
    assert semsurf.check_mesh(mesh).closed_and_oriented
    smooth = semsurf.smooth(mesh, iterations=20)
    inner = numpy.all((mesh.vertices[:, :2] > 15) & (mesh.vertices[:, :2] < 63), axis=1)     # edges are rounded
    top = inner & (mesh.vertices[:, 2] > 10)
    assert smooth.vertices[top, 2].std() < 0.5 * mesh.vertices[top, 2].std()
    assert smooth.vertices[top, 2].mean() == pytest.approx(mesh.vertices[top, 2].mean(), abs=0.1)


def test_a_solid_is_the_programs(tmp_path, program, scan):
    program("mesh", scan, "--solid", "--thickness", "40nm", "--plain", "-o", "theirs.ply", "--height-pitch", "2nm")
    ours = semsurf.solid(semsurf.mesh_heights(scan, height_pitch="2nm"), thickness=40)
    theirs = semsurf.read_mesh(tmp_path / "theirs.ply")
    assert len(ours.triangles) == len(theirs.triangles)
    assert semsurf.check_mesh(ours).volume_nm3 == pytest.approx(semsurf.check_mesh(theirs).volume_nm3, rel=1e-6)
