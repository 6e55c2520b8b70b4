# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparisons, calibrations, counts, dry runs, copies."""
import copy
import json
import pickle

import numpy
import pytest

import semsurf
from conftest import bumps


def changed(heights, by):
    y, x = numpy.mgrid[0:heights.shape[0], 0:heights.shape[1]] * 2.0
    return heights.heights + by * ((x - 40) ** 2 + (y - 60) ** 2 < 144)


def test_compare_finds_a_change_and_nothing_where_there_is_none(heights):
    noise = numpy.random.default_rng(3).normal(0, 0.05, heights.shape)
    same = semsurf.compare(heights, semsurf.HeightField(heights.heights + noise, pitch=2))
    assert same.verdict == "unchanged" and same.places == [] and same.reasons == []
    other = semsurf.compare(heights, semsurf.HeightField(changed(heights, 1) + noise, pitch=2))
    assert other.verdict == "changed"
    place = other.places[0]
    assert place.centre_nm == pytest.approx((40, 60), abs=3)
    assert abs(place.mean - 1) < 0.05 and 0 < place.mean_stderr < 0.05 and place.probability > 0.95
    assert other.difference.shape == other.stderr.shape == other.probability.shape == other.before.shape


def test_compare_gives_the_programs_report(tmp_path, program, heights):
    semsurf.write_heights(tmp_path / "a.gsf", heights)
    semsurf.write_heights(tmp_path / "b.gsf", semsurf.HeightField(changed(heights, 1), pitch=2))
    program("compare", "a.gsf", "b.gsf", "-o", "theirs")
    ours = semsurf.compare(tmp_path / "a.gsf", tmp_path / "b.gsf", output=tmp_path / "ours")
    assert (tmp_path / "theirs/places.csv").read_bytes() == (tmp_path / "ours/places.csv").read_bytes()
    assert len(ours.written) == 4
    with pytest.raises(semsurf.UsageError, match="memory"):
        semsurf.compare(heights, tmp_path / "b.gsf", output=tmp_path / "other")


def test_calibrate_finds_gains_and_offset(tmp_path, program, heights):
    image = semsurf.simulate(heights, material="Si", size=(32, 24), electrons=30)
    noise = numpy.random.default_rng(4).normal(0, 5, image.shape)
    seen = semsurf.Image({"grey": 900 * image["SE"] + 300 * image["BSE"] + 120 + noise}, pitch=image.pitch,
                         origin=image.origin)
    found = semsurf.calibrate(seen, image, output=tmp_path / "ours.json")
    assert found.trusted and found.outcome == "trusted"
    for value, truth in ((found.gains.SE, 900), (found.gains.BSE, 300), (found.offset, 120)):
        assert abs(value.value - truth) < 4 * value.stderr and value.stderr < 20
    assert found.residual["residual"].std() == pytest.approx(5, rel=0.1)
    semsurf.write_image(tmp_path / "seen.tif", seen)
    semsurf.write_image(tmp_path / "image.exr", image)
    program("calibrate", "seen.tif", "--images", "image.exr", "-o", "theirs.json")
    ours, theirs = (json.loads((tmp_path / name).read_text()) for name in ("ours.json", "theirs.json"))
    assert ours["channels"] == theirs["channels"] and ours["offset"] == theirs["offset"]
    mask = numpy.zeros(image.shape)
    with pytest.raises(semsurf.InvalidInput, match="no sample"):
        semsurf.calibrate(seen, image, use=mask)


def test_counts_are_of_every_trial(samples):
    found = semsurf.noise_counts(samples / "flat.toml", electrons=[1, 20], trials=300)
    assert [(s.detector, s.electrons) for s in found.sets[:2]] == [("SE", 1), ("BSE", 1)]
    for one in found.sets:
        assert one.counts.sum() == 300
        assert one.mean == pytest.approx((numpy.arange(len(one.counts)) * one.counts).sum() / 300)


def test_a_dry_run_tells_and_makes_no_image(samples):
    told = semsurf.simulate(samples / "cube.toml", size=(16, 16), electrons=10, dry_run=True)
    assert told.size == (16, 16) and told.seconds.value > 0 and told.memory_bytes > 1e6
    assert told.method in ("direct", "replay")


def test_predict_takes_a_scene(tmp_path, program, samples):
    program("predict", samples / "mesa80.toml", "--model", samples / "si-1keV-3nm.json", "--resample", "-o",
            "theirs.exr", "-q")
    with pytest.warns(semsurf.Doubt):
        ours = semsurf.predict(samples / "mesa80.toml", model=samples / "si-1keV-3nm.json", resample=True)
    assert numpy.array_equal(ours["SE"], semsurf.read_image(tmp_path / "theirs.exr")["SE"])
    with pytest.raises(semsurf.UsageError, match="scene"):
        semsurf.predict(samples / "mesa80.toml", model=samples / "si-1keV-3nm.json", height_pitch="2nm")


def objects(samples):
    holes = bumps()
    holes[3, 4] = numpy.nan
    yield semsurf.HeightField(holes, pitch=(2, 3), origin=(5, 6), record={"note": "by hand"})
    yield semsurf.tip(shape="cone:6nm,20deg", tip_size=11, height_pitch="2nm")
    yield semsurf.read_mesh(samples / "pyramid.stl")
    yield semsurf.simulate(samples / "cube.toml", size=(8, 8), electrons=5)


def arrays_of(made):
    if isinstance(made, semsurf.Image):
        return [made[name] for name in made.channels]
    if isinstance(made, semsurf.Mesh):
        return [made.vertices, made.triangles]
    return [made.heights] + ([made.valid] if isinstance(made, semsurf.HeightField) else [])


@pytest.mark.parametrize("again", [lambda o: pickle.loads(pickle.dumps(o)), copy.deepcopy], ids=["pickle", "deepcopy"])
def test_objects_are_copied_with_all_they_hold(samples, again):
    for made in objects(samples):
        copied = again(made)
        assert type(copied) is type(made) and copied.record == made.record and copied.found == made.found
        for a, b in zip(arrays_of(made), arrays_of(copied), strict=True):
            assert numpy.array_equal(a, b, equal_nan=a.dtype.kind == "f") and not numpy.shares_memory(a, b)
        if hasattr(made, "pitch"):
            assert copied.pitch == made.pitch
        if hasattr(made, "origin"):
            assert copied.origin == made.origin
