# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers and writers: what is written is read again, also by the program."""
import json
import subprocess

import numpy
import pytest

import semsurf
from conftest import PROGRAM, bumps


@pytest.mark.parametrize("suffix, digits", [(".gsf", 5), (".tif", 5), (".txt", 15), (".vti", 5)])
def test_heights(tmp_path, heights, suffix, digits):
    path = tmp_path / f"heights{suffix}"
    semsurf.write_heights(path, heights, record={"semsurf.version": "1", "note": "by hand"})
    there = semsurf.read_heights(path)
    assert numpy.allclose(there.heights, heights.heights, rtol=10.0 ** -digits, atol=10.0 ** -digits)
    assert there.pitch == (2, 2) and there.record.get("note") == "by hand"


def test_arrays_are_written_with_their_pitch(tmp_path):
    semsurf.write_heights(tmp_path / "a.gsf", bumps(), height_pitch="3nm")
    assert semsurf.read_heights(tmp_path / "a.gsf").pitch == (3, 3)


@pytest.mark.parametrize("suffix", [".exr", ".tif", ".vti"])
def test_images(tmp_path, suffix):
    image = semsurf.Image({"SE": bumps(), "SE.stderr": bumps() / 10}, pitch=2, origin=(5, 6),
                          record={"beam.energy_ev": "1000"})
    path = tmp_path / f"image{suffix}"
    semsurf.write_image(path, image)
    there = semsurf.read_image(path)
    assert there.channels == ["SE", "SE.stderr"]
    assert numpy.array_equal(there["SE"], image["SE"]) and there.origin == (5, 6)
    assert there.record["beam.energy_ev"] == "1000"


def test_a_png_shows_the_channel_that_is_named(tmp_path):
    image = semsurf.Image({"a": bumps(), "b": -bumps()})
    semsurf.write_image(tmp_path / "b.png", image, channel="b")
    shown = semsurf.read_image(tmp_path / "b.png")
    assert numpy.corrcoef(shown[shown.channels[0]].ravel(), bumps().ravel())[0, 1] < -0.99


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply", ".off", ".glb", ".3mf", ".vtp"])
def test_meshes(tmp_path, cube, suffix):
    path = tmp_path / f"cube{suffix}"
    semsurf.write_mesh(path, cube)
    there = semsurf.read_mesh(path)
    assert len(there.triangles) == 12 and numpy.allclose(there.bounds, cube.bounds, atol=1e-4)
    assert semsurf.check_mesh(there).closed_and_oriented


def test_units_of_meshes(tmp_path, cube):
    semsurf.write_mesh(tmp_path / "cube.ply", cube, unit="um")
    assert numpy.allclose(semsurf.read_mesh(tmp_path / "cube.ply").bounds, cube.bounds)
    (tmp_path / "plain.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    assert semsurf.read_mesh(tmp_path / "plain.off", unit="um").bounds[1] == (1000, 1000, 0)


def test_tips(tmp_path, tip):
    there = semsurf.read_tip(tip)
    assert there.shape == (11, 11) and there.apex == (5, 5) and there.pitch == (2, 2)
    semsurf.write_tip(tmp_path / "again.gsf", there)
    assert numpy.array_equal(semsurf.read_tip(tmp_path / "again.gsf").heights, there.heights)


def test_microscope_images(tmp_path):
    semsurf.write_image(tmp_path / "sem.tif", semsurf.Image({"signal": 100 + bumps()}, pitch=2))
    image = semsurf.read_sem_image(tmp_path / "sem.tif")
    assert image.pitch == (2, 2) and image.channels == ["signal", "valid"]
    assert semsurf.read_sem_image(tmp_path / "sem.tif", pixel_size="3nm").pitch == (3, 3)


def test_files_that_are_not_there(tmp_path):
    for read, name in ((semsurf.read_heights, "nothing.gsf"), (semsurf.read_image, "nothing.exr"),
                       (semsurf.read_mesh, "nothing.stl"), (semsurf.read_tip, "nothing.gsf")):
        with pytest.raises(semsurf.FileError) as error:
            read(tmp_path / name)
        assert isinstance(error.value, OSError) and "nothing" in str(error.value)
    with pytest.raises(semsurf.UsageError):
        semsurf.write_heights(tmp_path / "heights.doc", bumps())


def test_info_says_what_files_hold(tmp_path, heights):
    semsurf.write_heights(tmp_path / "scan.gsf", heights)
    found = semsurf.info(tmp_path / "scan.gsf")
    assert found.kind == "heights" and (found.width, found.height) == heights.heights.shape[::-1]
    assert found.channels[0].highest_nm == pytest.approx(heights.heights.max(), rel=1e-5)
    with pytest.raises(semsurf.FileError, match="nowhere.exr"):
        semsurf.info(tmp_path / "nowhere.exr")


def test_info_is_what_the_program_prints(samples):
    for name in ("pyramid.stl", "mesa80.toml", "si-1keV-10nm.json"):
        printed = subprocess.run([PROGRAM, "info", "--json", samples / name], capture_output=True, check=True, text=True)
        assert json.loads(printed.stdout) == [semsurf.info(samples / name)]
