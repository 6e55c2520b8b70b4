# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes: checks, repairs and simplifications are the program's."""
import numpy
import pytest

import semsurf
from conftest import CUBE, FACES


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
