# SPDX-License-Identifier: GPL-3.0-or-later
"""Many scans, grids of settings, libraries, charts, pages: what takes or gives more than one."""
import csv
import json
import re

import numpy
import pytest

import semsurf
from conftest import bumps, same_bytes


def test_survey_gives_the_programs_table(tmp_path, program, heights):
    (tmp_path / "scans").mkdir()
    for name, factor in (("one", 1), ("two", 1.5)):
        semsurf.write_heights(tmp_path / f"scans/{name}.gsf",
                              semsurf.HeightField(factor * heights.heights, pitch=2))
    program("survey", "scans", "-o", "theirs.csv", "--tip-size", 9, "--draws", 2)
    ours = semsurf.survey(tmp_path / "scans", tip_size=9, draws=2, csv=tmp_path / "ours.csv")
    assert ours[1].roughness_nm == pytest.approx(1.5 * ours[0].roughness_nm, rel=0.05)
    theirs = (tmp_path / "theirs.csv").read_text().replace("scans/", "")
    assert (tmp_path / "ours.csv").read_text().replace(f"{tmp_path}/scans/", "") == theirs
    alone = semsurf.survey(heights, tip_size=9, draws=2)[0]
    assert alone.tip_radius_nm == pytest.approx(ours[0].tip_radius_nm, rel=0.01)


def test_survey_goes_on_after_a_scan_that_cannot_be_read(tmp_path, heights):
    semsurf.write_heights(tmp_path / "good.gsf", heights)
    with pytest.warns(semsurf.Doubt, match="nowhere"):
        rows = semsurf.survey([tmp_path / "nowhere.gsf", tmp_path / "good.gsf", 2 * heights.heights], no_tip=True)
    assert len(rows) == 2 and rows[0].tip_radius_nm is None and rows[0].file.endswith("good.gsf")
    (tmp_path / "empty").mkdir()
    with pytest.warns(semsurf.Doubt, match="empty"):
        assert len(semsurf.survey([tmp_path / "empty", heights], no_tip=True)) == 1
    with pytest.raises(semsurf.FileError, match="nowhere"):
        semsurf.survey(tmp_path / "nowhere.gsf")


def test_sweep_gives_the_programs_bytes_and_goes_on(tmp_path, program, samples):
    program("sweep", samples / "cube.toml", "--vary", "tilt=0deg:30deg:30deg", "--vary", "energy=500eV,1keV", "--size",
            "8x8", "--electrons", 20, "-o", "theirs")
    ours = semsurf.sweep(samples / "cube.toml", vary={"tilt": "0deg:30deg:30deg", "energy": ["500eV", "1keV"]},
                         size=(8, 8), electrons=20, output=tmp_path / "ours")
    assert ours.done == 4 and ours.found == 0 and ours.untrustworthy == 0
    for name in ("sweep.csv", "tilt_30deg,energy_1keV.exr"):
        assert same_bytes(tmp_path / "theirs" / name, tmp_path / "ours" / name)
    again = semsurf.sweep(samples / "cube.toml", vary={"tilt": "0deg:30deg:30deg", "energy": ["500eV", "1keV"]},
                          size=(8, 8), electrons=20, output=tmp_path / "ours")
    assert again.found == 4
    with open(ours.table) as table:
        assert [row["energy"] for row in csv.DictReader(table)] == ["500eV", "1keV"] * 2


@pytest.mark.parametrize("vary, what", [({}, "nothing varies"), ({"tilts": [0]}, "tilt"), ({"output": ["a"]}, "cannot"),
                                        ({"tilt": "0:60"}, "no range"), ({"tilt": []}, "no value"),
                                        ({"tilt": [0, 95]}, "tilt")])
def test_sweep_says_what_is_wrong_before_it_begins(tmp_path, samples, vary, what):
    with pytest.raises(semsurf.UsageError, match=what):
        semsurf.sweep(samples / "cube.toml", vary=vary, output=tmp_path / "ours", size=(8, 8))
    assert not (tmp_path / "ours").exists()


def test_sweep_takes_each_setting_once(tmp_path, samples):
    for keywords, what in (({"tilt": 5}, "vary has it"), ({"restart": True}, "no such argument")):
        with pytest.raises(semsurf.UsageError, match=what):
            semsurf.sweep(samples / "cube.toml", vary={"tilt": [0, 30]}, output=tmp_path / "ours", **keywords)
    with pytest.raises(semsurf.UsageError, match="no list"):
        semsurf.sweep(samples / "cube.toml", vary={"tilt": 3}, output=tmp_path / "ours")


def test_sweep_takes_no_specimen_in_memory(tmp_path, cube):
    with pytest.raises(semsurf.UsageError, match="memory"):
        semsurf.sweep(cube, vary={"tilt": [0, 30]}, output=tmp_path / "ours")


def test_libraries_are_built_and_listed(tmp_path):
    built = semsurf.build_libraries(["Si"], energy="500eV", cascades=2048)
    assert built[0].made == 2048 and built[0].title == "Si at 500 eV"
    assert semsurf.build_libraries("Si", energy="500eV", cascades=2048)[0].made == 0
    there = semsurf.libraries(check=True)
    assert there.folder == str(tmp_path / "cache") and there.damaged == []
    assert [(one.material, one.energy_ev, one.cascades) for one in there.libraries] == [("Si", 500, 2048)]
    with pytest.raises(semsurf.UsageError, match="Sii"):
        semsurf.build_libraries("Sii")


def test_libraries_are_removed(tmp_path):
    semsurf.build_libraries("Si", energy="500eV,1keV", cascades=2048)
    foretold = semsurf.remove_libraries("Si", energy="1keV", dry_run=True)
    assert len(semsurf.libraries().libraries) == 2
    removed = semsurf.remove_libraries("Si", energy="1keV")
    assert removed.files == foretold.files > 0 and removed.bytes == foretold.bytes > 0
    assert [one.energy_ev for one in semsurf.libraries().libraries] == [500]
    with pytest.raises(semsurf.UsageError, match="Did you mean Si"):
        semsurf.remove_libraries("Sj")
    with pytest.raises(semsurf.UsageError, match="not given"):
        semsurf.remove_libraries()
    assert len(semsurf.remove_libraries(all=True).libraries) == 1
    assert semsurf.libraries().libraries == []


def test_a_page_shows_objects_and_files(tmp_path, heights, cube, samples):
    image = semsurf.simulate(heights, material="Si", size=(16, 12), electrons=5)
    semsurf.write_heights(tmp_path / "scan.gsf", heights)
    page = semsurf.view({"measured": heights, "a cube": cube, "seen": image, "file": tmp_path / "scan.gsf"},
                        tmp_path / "page.html", title="All", drape=(image, "SE"), scalar={"map": (image, "BSE")})
    assert page.surfaces == 3 and page.images == 1
    html = (tmp_path / "page.html").read_text()
    assert page.bytes == len(html.encode()) and "<title>All" in html
    for name in ("measured", "a cube", "seen"):
        assert name in html


def test_a_page_of_a_file_is_the_programs(tmp_path, program, scan):
    program("view", scan, "-o", "theirs.html", "--title", "scan", "--height-pitch", "2nm")
    semsurf.view(scan, tmp_path / "ours.html", title="scan", height_pitch="2nm")
    assert same_bytes(tmp_path / "theirs.html", tmp_path / "ours.html")


def test_a_page_says_what_is_wrong(tmp_path, heights):
    with pytest.raises(semsurf.InvalidInput, match="over no surface"):
        far = semsurf.Image({"a": bumps()}, origin=(1e6, 0))
        semsurf.view(heights, tmp_path / "page.html", drape=far)
    with pytest.raises(semsurf.UsageError, match="no channel 'b'"):
        semsurf.view(heights, tmp_path / "page.html", drape=(far, "b"))
    with pytest.raises(semsurf.UsageError, match="html"):
        semsurf.view(heights, tmp_path / "page.pdf")
    assert not (tmp_path / "page.html").exists()


@pytest.mark.long
def test_a_sample_is_the_programs(tmp_path, program):
    assert "terrain" in semsurf.sample()
    program("sample", "terrain", "-o", "theirs", "--size", "32x24", "--electrons", 8)
    ours = semsurf.sample(name="terrain", output=tmp_path / "ours", size=(32, 24), electrons=8)
    for name in ("afm.gsf", "sem.tif", "truth.gsf"):
        assert same_bytes(tmp_path / "theirs" / name, tmp_path / "ours" / name)
    truth = json.loads((tmp_path / "ours/truth.json").read_text())
    assert ours.transform.shape == (2, 3) and ours.sem.endswith("sem.tif") and truth


@pytest.mark.long
def test_a_chart_has_the_programs_points(tmp_path, samples):
    chart = semsurf.chart(samples / "flat.toml", output=tmp_path / "chart", quick=True, methods="direct,replay",
                          size=(16, 12), compared=100)
    assert {point.family for point in chart.points} >= {"replay"}
    assert all(numpy.isfinite(point.rms.SE) for point in chart.points)
    assert (tmp_path / "chart/chart.svg").exists() and re.search(r"chart\.svg", " ".join(chart.written))
