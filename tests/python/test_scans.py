# SPDX-License-Identifier: GPL-3.0-or-later
"""AFM scans: functions make the same bytes as the program's commands."""
import numpy
import pytest

import semsurf
from conftest import bumps, same_bytes


def write_and_compare(tmp_path, made, write=semsurf.write_heights, suffix="gsf"):
    write(tmp_path / f"python.{suffix}", made)
    assert same_bytes(tmp_path / "python.gsf", tmp_path / "program.gsf")


@pytest.mark.parametrize("options, keywords", [
    ([], {}),
    (["--rows", "median"], dict(rows="median")),
    (["--level-method", "polynomial", "--level-degree", "1"], dict(level_method="polynomial", level_degree=1)),
    (["--level-tolerance", "0.3nm"], dict(level_tolerance="0.3nm")),
])
def test_level(tmp_path, program, scan, options, keywords):
    program("level", scan, *options, "-o", "program.gsf", "-q")
    flat = semsurf.level(scan, **keywords)
    write_and_compare(tmp_path, flat)
    assert flat.found.roughness.sq_nm > 1 and (flat.found.tilt_deg > 0.5 or "level_degree" in keywords)
    assert flat.record["command"] == "level"


def test_level_with_masks(tmp_path, program, scan, heights):
    high = bumps() > 3
    semsurf.write_image(tmp_path / "high.tif", semsurf.Image({"mask": high}, pitch=2))
    program("level", scan, "--level-method", "plane", "--exclude", tmp_path / "high.tif", "-o", "program.gsf", "-q")
    of_file = semsurf.level(scan, level_method="plane", exclude=tmp_path / "high.tif")
    write_and_compare(tmp_path, of_file)
    for exclude in (high, semsurf.read_image(tmp_path / "high.tif")):
        assert numpy.array_equal(semsurf.level(scan, level_method="plane", exclude=exclude).heights, of_file.heights)
    assert numpy.array_equal(semsurf.level(heights, level_method="plane", use=~high).heights, of_file.heights)
    with pytest.raises(semsurf.InvalidInput, match="size"):
        semsurf.level(heights, use=high[1:])
    with pytest.raises(semsurf.InvalidInput, match="remains"):
        semsurf.level(heights, use=numpy.zeros_like(high))


def test_level_finds_the_substrate(heights):
    found = semsurf.level(heights).found
    assert found.substrate.shape == heights.shape and found.substrate.dtype == bool
    assert 0.4 < found.inlier_share < 1 and found.plane.tilt_deg < 3


def test_the_input_stays_as_it_was(heights):
    before = heights.heights.copy()
    semsurf.level(heights)
    assert numpy.array_equal(heights.heights, before)


@pytest.mark.parametrize("options, keywords", [
    (["--median", "3"], dict(median=3)),
    (["--spikes", "3:0.5nm"], dict(spikes="3:0.5nm")),
    (["--spikes", "3", "--closing", "5"], dict(spikes=3, closing=5)),
    (["--median", "5", "--disc"], dict(median=5, disc=True)),
])
def test_clean(tmp_path, program, scan, options, keywords):
    program("clean", scan, *options, "-o", "program.gsf", "-q")
    clean = semsurf.clean(scan, **keywords)
    write_and_compare(tmp_path, clean)
    assert all(found.changed >= 0 for found in clean.found.values())


def test_clean_refuses_what_makes_no_sense(heights):
    for wrong in ({}, dict(median=4), dict(median="wide"), dict(closing=3, disc=True)):
        with pytest.raises(semsurf.UsageError):
            semsurf.clean(heights, **wrong)


@pytest.mark.parametrize("name", ["erode", "dilate", "open", "close"])
def test_morphology(tmp_path, program, scan, tip, name):
    options, keywords = (["--distance", "1nm"], dict(distance=1)) if name == "erode" else ([], {})
    program(name, scan, "--tip", tip, *options, "-o", "program.gsf", "-q")
    made = getattr(semsurf, name)(scan, tip, **keywords)
    write_and_compare(tmp_path, made)
    in_memory = getattr(semsurf, name)(semsurf.read_heights(scan).heights, tip=semsurf.read_tip(tip), height_pitch=2,
                                       **keywords)
    assert numpy.array_equal(in_memory.heights, made.heights)


def test_a_surface_lies_between_opening_and_closing(heights, tip):
    rounding = 1e-5
    assert (semsurf.open(heights, tip).heights <= heights.heights + rounding).all()
    assert (semsurf.close(heights, tip).heights >= heights.heights - rounding).all()


def test_certainty(tmp_path, program, scan, tip):
    program("certainty", scan, "--tip", tip, "-o", "program.tif", "--eroded", "program.gsf", "-q", good=(0, 4))
    made = semsurf.certainty(scan, tip)
    semsurf.write_image(tmp_path / "python.tif", made)
    assert same_bytes(tmp_path / "python.tif", tmp_path / "program.tif")
    write_and_compare(tmp_path, made.found.eroded)
    assert 0 <= made.found.certain_share <= 1 and made.channels == ["certain", "radius_px", "surface"]


@pytest.mark.parametrize("options, keywords", [
    (["--tip-size", "9"], dict(tip_size=9)),
    (["--tip-size", "9", "--threshold", "0.3nm"], dict(tip_size=9, threshold="0.3nm")),
    (["--tip-size", "9", "--answer", "outer"], dict(tip_size=9, answer="outer")),
])
@pytest.mark.filterwarnings("ignore::semsurf.Doubt")
def test_tip_of_a_scan(tmp_path, program, scan, options, keywords):
    program("tip", scan, *options, "-o", "program.gsf", "-q", good=(0, 4))
    tip = semsurf.tip(scan, **keywords)
    write_and_compare(tmp_path, tip, semsurf.write_tip)
    assert tip.shape == (9, 9) and tip.heights.max() == 0 and tip.found.volume_nm3 > 0


def test_tip_by_its_shape(tmp_path, program):
    program("tip", "--shape", "cone:10nm,15deg", "--tip-size", "15", "--height-pitch", "2nm", "-o", "program.gsf", "-q")
    tip = semsurf.tip(shape="cone:10nm,15deg", tip_size=15, height_pitch="2nm")
    write_and_compare(tmp_path, tip, semsurf.write_tip)
    assert tip.found.radius_nm == pytest.approx(10, rel=0.1)


def test_tip_by_a_known_surface(tmp_path, program, heights, tip):
    semsurf.write_heights(tmp_path / "known.txt", heights)
    semsurf.write_heights(tmp_path / "seen.txt", semsurf.dilate(heights, tip))
    program("tip", "seen.txt", "--characterizer", "known.txt", "--tip-size", "11", "-o", "program.gsf", "-q")
    found = semsurf.tip(tmp_path / "seen.txt", characterizer=tmp_path / "known.txt", tip_size=11)
    write_and_compare(tmp_path, found, semsurf.write_tip)


def test_noise():
    heights = numpy.random.default_rng(3).normal(0, 0.05, (48, 64))
    noise = semsurf.noise(heights, flat=True, height_pitch=2)
    assert noise.sigma_nm == pytest.approx(0.05, abs=5 * noise.sigma_stderr_nm)
    assert abs(noise.alpha) < 5 * noise.alpha_stderr and noise.residual_nm.shape == heights.shape
    assert noise.record["command"] == "noise scan"


def test_noise_of_an_sem_image():
    random = numpy.random.default_rng(2)
    level = numpy.repeat(numpy.repeat([[40, 90], [140, 190]], 64, axis=0), 64, axis=1)
    noise = semsurf.noise_sem(level + random.normal(0, numpy.sqrt(0.2 * level + 3)), pixel_size=1)
    assert noise.slope == pytest.approx(0.2, abs=4 * noise.slope_stderr)
    assert len(noise.means) == len(noise.variances) == len(noise.variances_stderr)
