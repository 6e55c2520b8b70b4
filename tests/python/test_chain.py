# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration, reconstruction and profiles: the numbers are the program's."""
import json

import numpy
import pytest

import semsurf
from conftest import ROOT, bumps

MODEL = ROOT / "samples/si-1keV-10nm.json"


def test_arguments_are_checked_before_any_work(heights):
    image = semsurf.Image({"signal": bumps()}, pitch=10)
    for wrong, words in ((dict(), "material"), (dict(material="Si"), "energy"),
                         (dict(model=MODEL, level_degree=2), "level_method"),
                         (dict(model=MODEL, landmarks_only=True), "landmarks"),
                         (dict(model=MODEL, output="transform.json"), "memory"),
                         (dict(model=MODEL, landmarks=[(0, 0)]), "columns")):
        with pytest.raises(semsurf.Error, match=words):
            semsurf.register(heights, image, **wrong)
    with pytest.raises(semsurf.UsageError, match="pixel_size"):
        semsurf.register(heights, bumps(), model=MODEL)
    with pytest.raises(semsurf.UsageError, match="neither"):
        semsurf.reconstruct()
    with pytest.raises(semsurf.UsageError, match="energy"):
        semsurf.profile(image, material="Si")


@pytest.fixture
def scene(tmp_path, program):
    """A scan and an SEM image of one place, small."""
    program("sample", "pads", "--size", "96x72", "--electrons", "40", "-o", "scene", "-q")
    return tmp_path / "scene"


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::semsurf.Doubt")
def test_register_and_reconstruct(tmp_path, program, scene):
    afm, sem, truth = scene / "afm.gsf", scene / "sem.tif", scene / "truth.gsf"
    program("register", "--afm", afm, "--sem", sem, "--model", MODEL, "-o", "program.json", "-q", good=(0, 4))
    registered = semsurf.register(afm, sem, model=MODEL, output=tmp_path / "python.json")
    assert (tmp_path / "program.json").read_bytes() == (tmp_path / "python.json").read_bytes()
    assert registered.transform.shape == registered.transform_stderr.shape == (2, 3)

    settings = ["--model", MODEL, "--corrections", "0", "--no-picture"]
    program("reconstruct", "--afm", afm, "--sem", sem, "--truth", truth, *settings, "-o", "result", "-q", good=(0, 4))
    made = semsurf.reconstruct(semsurf.read_heights(afm), semsurf.read_image(sem), truth=truth, model=MODEL, corrections=0)
    if made.surface is None:
        return
    surface = semsurf.read_heights(tmp_path / "result/surface.gsf")
    assert numpy.allclose(made.surface.heights, surface.heights, atol=1e-3)
    report = json.loads((tmp_path / "result/report.json").read_text())
    assert made.verdict == report["verdict"]
    assert made.stderr.shape == made.surface.shape


@pytest.mark.hand
@pytest.mark.filterwarnings("ignore::semsurf.Doubt")
def test_profile(tmp_path, program):
    """A line of 60 nm, simulated, then measured."""
    x = numpy.arange(160) * 2.0
    line = 40 / (1 + numpy.exp(-numpy.clip((30 - abs(x - 160)) / 1.0, -50, 50)))
    image = semsurf.simulate(numpy.tile(line, (32, 1)), height_pitch=2, material="Si", electrons=60, size=(160, 32))
    semsurf.write_image(tmp_path / "line.tif", semsurf.Image({"SE": image["SE"]}, pitch=2))
    settings = ["--height", "40nm", "--material", "Si", "--energy", "1keV", "--electrons", "60",
                "--middle-electrons", "400", "--rounds", "1", "--no-picture"]
    program("profile", "line.tif", *settings, "-o", "result", "-q", good=(0, 4))
    made = semsurf.profile(semsurf.read_image(tmp_path / "line.tif"), height="40nm", material="Si", energy="1keV",
                           electrons=60, middle_electrons=400, rounds=1)
    assert made.left.width_nm.value == pytest.approx(60, abs=8) and made.left.width_nm.stderr > 0
    there = semsurf.read_heights(tmp_path / "result/surface.gsf")
    assert numpy.allclose(made.surface.heights, there.heights, atol=1e-3)
