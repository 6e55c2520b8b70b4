# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of `import semsurf` share: the program beside it, and small surfaces."""
import os
import pathlib
import subprocess

import numpy
import pytest

import semsurf

ROOT = pathlib.Path(os.environ.get("SEMSURF_SOURCE", pathlib.Path(__file__).parents[2]))
PROGRAM = os.environ.get("SEMSURF", str(ROOT / "build/bin/semsurf"))


def pytest_configure(config):
    config.addinivalue_line("markers", "long: takes long; only ./check --all runs it")
    config.addinivalue_line("markers", "hand: takes minutes; only ctest -L hand runs it")


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    """Nothing is left in the user's cache."""
    monkeypatch.setenv("SEMSURF_CACHE", str(tmp_path / "cache"))


@pytest.fixture
def program(tmp_path):
    """Runs a command of the program in the test's folder; returns its exit code."""
    def run(*arguments, good=(0,)):
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode in good, done.stderr
        return done.returncode
    return run


@pytest.fixture
def samples():
    return ROOT / "samples"


def bumps(rows=48, columns=64, pitch=2.0):
    """Round bumps on a tilted plane, with noise: nothing of it is the same turned over."""
    y, x = numpy.mgrid[0:rows, 0:columns] * pitch
    z = 0.01 * x + 0.02 * y
    for centre_x, centre_y, height in ((30, 20, 9), (80, 60, 14), (100, 25, 6)):
        z += height * numpy.exp(-((x - centre_x) ** 2 + (y - centre_y) ** 2) / (2 * 9 ** 2))
    return z + numpy.random.default_rng(1).normal(0, 0.05, z.shape)


@pytest.fixture
def heights():
    return semsurf.HeightField(bumps(), pitch=2)


@pytest.fixture
def scan(tmp_path, heights):
    """A file of a scan."""
    path = tmp_path / "scan.txt"
    semsurf.write_heights(path, heights)
    return path


@pytest.fixture
def tip(tmp_path):
    """A file of a tip."""
    path = tmp_path / "tip.gsf"
    semsurf.write_tip(path, semsurf.tip(shape="cone:6nm,20deg", tip_size=11, height_pitch="2nm"))
    return path


CUBE = numpy.array([(x, y, z) for x in (0, 100) for y in (0, 100) for z in (0, 100)], dtype=float)
FACES = numpy.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
                     (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])


@pytest.fixture
def cube():
    return semsurf.Mesh(CUBE, FACES, name="cube")


def same_bytes(a, b):
    return pathlib.Path(a).read_bytes() == pathlib.Path(b).read_bytes()
