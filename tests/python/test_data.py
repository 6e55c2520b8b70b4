# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays in and out, and how objects show themselves."""
import numpy
import pytest

import semsurf
from conftest import CUBE, FACES, bumps


def letter():
    """An F, 5 rows and 4 columns, row 0 the lowest."""
    f = numpy.zeros((5, 4))
    f[:, 0] = f[4, :] = f[2, 1] = 1
    return f


def test_heights_are_shared_and_row_0_is_the_lowest(tmp_path):
    field = semsurf.HeightField(letter(), pitch=(2, 3), origin=(10, -5))
    assert numpy.array_equal(field.heights, letter())
    assert field.heights.base is field and numpy.shares_memory(field.heights, field.heights)
    field.heights[0, 0] = 7
    assert field.heights[0, 0] == 7
    assert field.pitch == (2, 3) and field.origin == (10, -5) and field.shape == (5, 4)
    assert field.extent == (9, 17, -6.5, 8.5)
    semsurf.write_heights(tmp_path / "f.txt", semsurf.HeightField(letter()))
    numbers = [line for line in (tmp_path / "f.txt").read_text().splitlines() if line and line[0] != "#"]
    assert [float(n) for n in numbers[0].split()] == [1, 1, 1, 1], "files begin at the top"
    assert numpy.array_equal(semsurf.read_heights(tmp_path / "f.txt").heights, letter())


def test_views_outlive_their_object():
    view = semsurf.HeightField(letter()).heights
    assert numpy.array_equal(view, letter())


def test_holes():
    z = letter()
    z[1, 2] = numpy.nan
    field = semsurf.HeightField(z)
    assert not field.valid[1, 2] and field.valid.sum() == z.size - 1
    field = semsurf.HeightField(letter(), valid=letter() > 0)
    assert numpy.array_equal(field.valid, letter() > 0)
    assert semsurf.HeightField(letter()).valid.all()


def test_numpy_takes_heights():
    field = semsurf.HeightField(letter())
    assert numpy.asarray(field).sum() == letter().sum()
    assert numpy.asarray(field, dtype=numpy.float32).dtype == numpy.float32


@pytest.mark.parametrize("values", [numpy.zeros(3), numpy.zeros((2, 3, 4)), numpy.zeros((0, 3)), "no", None])
def test_what_is_no_height_field_is_refused(values):
    with pytest.raises(semsurf.Error):
        semsurf.HeightField(values)


def test_pitch_is_a_number_or_a_text():
    assert semsurf.HeightField(letter(), pitch="2nm").pitch == (2, 2)
    assert semsurf.HeightField(letter(), pitch="0.1um").pitch == (100, 100)
    assert semsurf.HeightField(letter(), pitch=("1nm", 3)).pitch == (1, 3)
    with pytest.raises(semsurf.UsageError) as error:
        semsurf.HeightField(letter(), pitch="2 parsecs")
    assert error.value.field == "pitch"


def test_meshes_are_shared(cube):
    assert cube.vertices.shape == (8, 3) and cube.vertices.dtype == numpy.float64
    assert cube.triangles.shape == (12, 3) and cube.triangles.dtype == numpy.uint32
    assert cube.vertices.base is cube and numpy.array_equal(cube.triangles, FACES)
    assert cube.bounds == ((0, 0, 0), (100, 100, 100))


@pytest.mark.parametrize("triangles", [[(0, 1, 8)], [(0, 1, -1)], [(0, 1)], [(0, 1, 2**33)]])
def test_wrong_triangles_are_refused(triangles):
    with pytest.raises(semsurf.InvalidInput):
        semsurf.Mesh(CUBE, triangles)


def test_images_are_shared():
    image = semsurf.Image({"SE": letter(), "SE.stderr": letter() / 10}, pitch=2, units={"SE": "1"},
                          record={"beam.energy_ev": 1000})
    assert image.channels == ["SE", "SE.stderr"] and list(image) == image.channels and "SE" in image
    assert image["SE"].base is image and image["SE"].dtype == numpy.float32
    assert numpy.allclose(image.stderr("SE"), letter() / 10)
    assert image.record == {"beam.energy_ev": "1000"} and image.shape == (5, 4)
    with pytest.raises(KeyError, match="SE.stderr"):
        image["BSE"]


def test_tips():
    tip = semsurf.Tip([[-3, -2, -3], [-1, 0, -1], [-3, -2, -3]], pitch=2)
    assert tip.apex == (1, 1) and tip.pitch == (2, 2) and tip.heights.max() == 0


@pytest.mark.parametrize("what", ["heights", "cube", "image", "tip"])
def test_objects_show_themselves(what, request, heights):
    made = {"heights": lambda: heights, "cube": lambda: request.getfixturevalue("cube"),
            "image": lambda: semsurf.Image({"SE": letter()}),
            "tip": lambda: semsurf.tip(shape="ball:20nm")}[what]()
    assert repr(made).startswith("<semsurf.") and "\n" not in repr(made)
    page = made._repr_html_()
    assert page.startswith("<div>") and page.endswith("</div>") and len(page) < 100_000
    assert ("data:image/png;base64" in page) == (what != "cube")


def test_plots(heights, cube):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from matplotlib import pyplot
    assert heights.plot().get_xlabel() == "x / nm"
    assert semsurf.Image({"SE": letter()}).plot("SE").get_title() == "SE"
    axes = pyplot.subplots()[1]
    assert semsurf.tip(shape="cone:10nm,15deg").plot(axes) is axes
    cube.plot()
    pyplot.close("all")


def test_findings_are_attributes(heights):
    found = semsurf.level(heights).found
    assert found.tilt_deg == found["tilt_deg"] and "roughness" in dir(found)
    assert "tilt_deg" in repr(found) and "<table>" in found._repr_html_()
    with pytest.raises(AttributeError, match="tilt_deg"):
        found.nothing


def test_what_is_masked_or_infinite_is_a_hole():
    masked = numpy.ma.masked_array(numpy.zeros((20, 30)), False)
    masked[3, 4] = numpy.ma.masked
    masked.data[3, 4] = 1e6
    infinite = numpy.zeros((20, 30))
    infinite[3, 4] = numpy.inf
    for given in (masked, infinite):
        heights = semsurf.HeightField(given)
        assert not heights.valid[3, 4] and heights.valid.sum() == 599 and numpy.isnan(heights.heights[3, 4])
        with pytest.raises(semsurf.InvalidInput, match="column 4, row 3 is invalid"):
            semsurf.simulate(heights, material="Si", size=(8, 6), electrons=2)


def test_a_hole_is_filled_and_nothing_else():
    z = bumps()
    z[10:13, 20:23] = numpy.nan
    filled = semsurf.clean(semsurf.HeightField(z, pitch=2), spikes="9:1um", fill_holes=True)
    assert filled.valid.all() and numpy.isfinite(filled.heights).all()
    there = numpy.isfinite(z)
    assert numpy.array_equal(filled.heights[there], z[there])


def test_lists_of_numbers_are_heights():
    image = semsurf.simulate([[0, 1, 0], [2, 3, 0], [0, 1, 0]], material="Si", height_pitch="5nm", size=(4, 4), electrons=2)
    assert image.shape == (4, 4)


@pytest.mark.parametrize("call, what", [
    (lambda: semsurf.HeightField(numpy.zeros((0, 0))), "empty"),
    (lambda: semsurf.Mesh(numpy.eye(3), [[0, 1.5, 2]]), "1.5 is no vertex"),
])
def test_arrays_that_cannot_be(call, what):
    with pytest.raises(semsurf.InvalidInput, match=what):
        call()
