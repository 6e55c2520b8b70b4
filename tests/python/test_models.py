# SPDX-License-Identifier: GPL-3.0-or-later
"""Fast models: predictions, trainings and guided estimates are the program's."""
import json

import numpy
import pytest

import semsurf
from conftest import bumps, same_bytes


def test_predict(tmp_path, program, samples):
    semsurf.write_heights(tmp_path / "scan.gsf", bumps(), height_pitch=3)
    model = samples / "si-1keV-3nm.json"
    program("predict", "scan.gsf", "--model", model, "--edge", "flat", "-o", "program.exr", "-q")
    image = semsurf.predict(tmp_path / "scan.gsf", model=model, edge="flat", output=tmp_path / "python.exr")
    assert same_bytes(tmp_path / "program.exr", tmp_path / "python.exr")
    in_memory = semsurf.predict(semsurf.read_heights(tmp_path / "scan.gsf"), model=model, edge="flat")
    for name in image:
        assert numpy.array_equal(in_memory[name], image[name])
    assert image.found.scope.material == "Si" and "SE" in image
    with pytest.raises(semsurf.UsageError) as error:
        semsurf.predict(bumps(), height_pitch=3, model=model, energy="3keV")
    assert error.value.reason
    with pytest.raises(semsurf.UsageError, match="model"):
        semsurf.predict(bumps())


def test_estimate(tmp_path, program, samples):
    counts = dict(size=(24, 20), electrons=16, channels="counts,electrons,z_nm,normal,material")
    image = semsurf.simulate(samples / "rough.toml", output=tmp_path / "few.exr", **counts)
    program("estimate", "few.exr", "-o", "program.exr", "-q")
    guided = semsurf.estimate(tmp_path / "few.exr")
    there = semsurf.read_image(tmp_path / "program.exr")
    for made in (guided, semsurf.estimate(image)):
        assert list(made) == list(there)
        for name in there:
            assert numpy.array_equal(made[name], there[name], equal_nan=True)
    assert guided.found.gains.SE.electrons >= 1
    with pytest.raises(semsurf.InvalidInput):
        semsurf.estimate(semsurf.Image({"SE": bumps()}))


def test_train_from_images(tmp_path, program):
    """A filter bank learnt from an image that is given: no simulation."""
    surface = semsurf.HeightField(bumps(64, 64), pitch=3)
    semsurf.write_heights(tmp_path / "a.txt", surface)
    image = semsurf.predict(surface, model=str(semsurf_model()))
    semsurf.write_image(tmp_path / "a.exr", image)
    settings = ["--material", "Si", "--energy", "1keV", "--pixel-size", "3nm", "--kind", "filter-bank", "--scales", "5,7"]
    program("train", "a.txt", "--images", "a.exr", *settings, "-o", "program.json", "-q")
    keywords = dict(material="Si", energy="1keV", pixel_size="3nm", kind="filter-bank", scales=(5, 7))
    trained = semsurf.train(tmp_path / "a.txt", images=tmp_path / "a.exr", output=tmp_path / "python.json", **keywords)
    assert trained.kind == "filter bank" and trained.channels == ["SE", "BSE"] and trained.residuals.SE.rms >= 0
    a, b = (json.loads((tmp_path / name).read_text()) for name in ("program.json", "python.json"))
    assert without_paths(a) == without_paths(b)
    again = semsurf.train(surface, images=image, output=tmp_path / "memory.json", **keywords)
    assert again.residuals == trained.residuals
    with pytest.raises(semsurf.UsageError) as error:
        semsurf.train(surface, images=image, **keywords)
    assert error.value.field == "output"


def semsurf_model():
    from conftest import ROOT
    return ROOT / "samples/si-1keV-3nm.json"


def without_paths(model):
    """The command in the record names the file that was written."""
    return json.loads(json.dumps(model).replace("python.json", "program.json"))
