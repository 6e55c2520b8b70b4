# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulations: the program's own bytes, of files and of shapes in memory."""
import numpy
import pytest

import semsurf
from conftest import bumps, same_bytes

QUICK = dict(size=(16, 12), electrons=20, seed=3)
QUICK_OPTIONS = ["--size", "16x12", "--electrons", "20", "--seed", "3"]


def same_image(a, b):
    assert list(a) == list(b)
    for name in a:
        assert numpy.array_equal(a[name], b[name], equal_nan=True), name
    assert a.pitch == b.pitch and a.origin == b.origin


def test_a_scene_file_is_as_by_the_program(tmp_path, program, samples):
    program("simulate", samples / "mesa80.toml", *QUICK_OPTIONS, "--energy", "2keV", "-o", "program.exr", "-q")
    image = semsurf.simulate(samples / "mesa80.toml", energy="2keV", output=tmp_path / "python.exr", **QUICK)
    assert same_bytes(tmp_path / "program.exr", tmp_path / "python.exr")
    there = semsurf.read_image(tmp_path / "program.exr")
    same_image(image, there)
    assert image.record == there.record
    assert image.record["beam.energy_ev"] == "2000"


def test_numbers_are_in_the_fields_unit(samples):
    scene = samples / "flat.toml"
    a, b = (semsurf.simulate(scene, energy=energy, tilt=tilt, **QUICK) for energy, tilt in ((2000, 30), ("2keV", "30deg")))
    same_image(a, b)


def test_meshes_in_memory_are_as_their_files(tmp_path, program, cube):
    semsurf.write_mesh(tmp_path / "cube.ply", cube)
    settings = dict(material="Au", substrate="Si", **QUICK)
    program("simulate", "cube.ply", "--material", "Au", "--substrate", "Si", *QUICK_OPTIONS, "-o", "program.exr", "-q")
    there = semsurf.read_image(tmp_path / "program.exr")
    same_image(semsurf.simulate(cube, **settings), there)
    same_image(semsurf.simulate(tmp_path / "cube.ply", **settings), there)
    cube.material = "Au"
    same_image(semsurf.simulate([cube], substrate="Si", material="C", **QUICK), there)


def test_heights_in_memory_are_as_their_files(scan, heights):
    settings = dict(material="Si", edge="flat", **QUICK)
    there = semsurf.simulate(scan, **settings)
    same_image(semsurf.simulate(heights, **settings), there)
    same_image(semsurf.simulate(bumps(), height_pitch=2, **settings), there)


def test_more_channels_are_in_memory_too(samples):
    image = semsurf.simulate(samples / "cube.toml", channels=["z_nm", "normal", "electrons"], **QUICK)
    assert {"SE", "SE.stderr", "BSE", "BSE.stderr", "valid", "z_nm", "electrons"} <= set(image)
    assert image.units["z_nm"] == "nm" and image["electrons"].max() == 20


def test_what_is_found(samples):
    found = semsurf.simulate(samples / "flat.toml", trajectories=3, **QUICK).found
    assert 0 < found.yields.SE.stderr < found.yields.SE.value < 3
    assert found.complete and found.method in ("direct", "replay") and found.electrons == 20
    track = found.tracks[0]
    assert track.points.shape[1] == 3 and len(track.energies) == len(track.points)


def test_physics_is_a_text_or_a_dictionary(samples):
    a, b = (semsurf.simulate(samples / "flat.toml", physics=physics, **QUICK)
            for physics in ("secondaries=off,elastic=browning", {"secondaries": "off", "elastic": "browning"}))
    same_image(a, b)
    assert "secondaries=off" in str(a.record) and a["SE"].mean() < 0.1


@pytest.mark.parametrize("wrong, field, words", [
    (dict(energy="50eV"), "energy", "out of range"),
    (dict(energy="5 parsecs"), "energy", "parsecs"),
    (dict(energy=object()), "energy", "object"),
    (dict(electrons=0), "electrons", "out of range"),
    (dict(electrons="many"), "electrons", "whole number"),
    (dict(edge="round"), "edge", "mirror, flat or periodic"),
    (dict(enrgy="1keV"), None, "energy"),
    (dict(material="Unobtainium"), "material", "Unobtainium"),
    (dict(size=(8, 8), pixel_size=1, region=(0, 0, 8, 8)), None, "region"),
])
def test_errors_name_the_argument(heights, wrong, field, words):
    with pytest.raises(semsurf.UsageError) as error:
        semsurf.simulate(heights, **{"material": "Si", **wrong})
    assert words in str(error.value) and "`" not in str(error.value) and "--" not in str(error.value)
    assert isinstance(error.value, ValueError) and error.value.reason
    if field:
        assert error.value.field == field


def test_an_open_mesh_is_refused(cube):
    opened = semsurf.Mesh(cube.vertices, cube.triangles[1:])
    with pytest.raises(semsurf.InvalidInput):
        semsurf.simulate([opened, cube], material="Si", **QUICK)


def test_no_specimen():
    with pytest.raises(semsurf.UsageError, match="specimen"):
        semsurf.simulate()
    with pytest.raises(semsurf.UsageError, match="two height fields"):
        semsurf.simulate([bumps(), bumps()])


def test_threads_change_nothing(samples):
    same_image(*(semsurf.simulate(samples / "rough.toml", threads=threads, **QUICK) for threads in (1, 2)))


def test_a_function_is_a_detector(samples):
    calls = []

    def lower_left(energy_ev, direction):
        calls.append(energy_ev.shape)
        assert direction.shape == (*energy_ev.shape, 3)
        assert numpy.allclose((direction ** 2).sum(axis=-1), 1)
        return (energy_ev < 50) & (direction[..., 0] < 0)

    image = semsurf.simulate(samples / "cube.toml", detector="lower:energy=..50eV,sector=90deg..270deg,axis=0deg/0deg",
                             acceptance={"own": lower_left, "all": (lambda energy, direction: 1, [0, 50])}, **QUICK)
    assert len(calls) == 1                                              # tabulated, once
    assert numpy.array_equal(image["all"], image["SE"])
    assert numpy.array_equal(image["own"], image["lower"])              # bins of azimuth end at 90 and 270 degrees
    assert "own:" in image.record["detector.4"] and "acceptance=" in image.record["detector.4"]


def test_probabilities_thin_the_counts(samples):
    image = semsurf.simulate(samples / "flat.toml", acceptance={"third": lambda energy, direction: (energy < 50) / 3},
                             size=(16, 12), electrons=400, seed=3)
    se, third = image.found.yields.SE, image.found.yields.third
    electrons = 16 * 12 * 400
    assert abs(third.value - se.value / 3) < 4 * numpy.sqrt(se.value * 2 / 9 / electrons)


@pytest.mark.parametrize("acceptance, what", [
    (lambda energy, direction: energy, "no dictionary"),
    ({"own": 0.5}, "no function"),
    ({"own": lambda energy, direction: energy[0]}, "number for each energy"),
    ({"own": lambda energy, direction: 2 + 0 * energy}, "outside 0 to 1"),
    ({"own": lambda energy, direction: numpy.nan * energy}, "outside 0 to 1"),
    ({"own": (lambda energy, direction: 1, [50, 0])}, "do not rise"),
    ({"own": (lambda energy, direction: 1, "wide")}, "no list of two numbers"),
    ({"a b": lambda energy, direction: 1}, "no name for a channel"),
    ({"SE": lambda energy, direction: 1}, "given twice"),
])
def test_functions_that_are_no_detectors(samples, acceptance, what):
    with pytest.raises(semsurf.UsageError, match=what):
        semsurf.simulate(samples / "flat.toml", acceptance=acceptance, **QUICK)


def test_what_a_detector_raises_comes_through(samples):
    def broken(energy, direction):
        raise KeyError("table")

    with pytest.raises(KeyError, match="table"):
        semsurf.simulate(samples / "flat.toml", acceptance={"own": broken}, **QUICK)
