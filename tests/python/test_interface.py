# SPDX-License-Identifier: GPL-3.0-or-later
"""Names, signatures, texts, the stub, progress and errors."""
import inspect
import logging
import os
import pydoc
import re
import subprocess
import sys
import threading
import time
import warnings

import pytest

import semsurf
from conftest import PROGRAM, ROOT, bumps

FUNCTIONS = [f["name"] for f in semsurf._semsurf.described_functions()]
# What is no keyword: files that are arguments or results here, and what is said by calling.
NO_KEYWORDS = {
    "help", "quiet", "output",
    "step", "substrate-mask", "eroded", "plot", "also", "csv",                 # results and lists are objects here
    "no-level", "afm-noise",
    "repair", "scale", "smooth", "solid", "thickness", "plain", "scalar", "drape", "tracks", "out-unit",
    "list",                                                                    # what a call without a name gives
    "magnification", "true-size", "z-exaggeration", "pixel-size",              # steps of `semsurf mesh`
}
COMMANDS = {"simulate": ["simulate"], "level": ["level"], "clean": ["clean"], "tip": ["tip"], "erode": ["erode"],
            "dilate": ["dilate"], "open": ["open"], "close": ["close"], "certainty": ["certainty"],
            "noise": ["noise", "scan"], "predict": ["predict"], "estimate": ["estimate"], "train": ["train"],
            "register": ["register"], "reconstruct": ["reconstruct"], "profile": ["profile"], "compare": ["compare"],
            "refine": ["refine"],
            "survey": ["survey"], "sample": ["sample"], "sweep": ["sweep"], "chart": ["chart"], "view": ["view"],
            "noise_counts": ["noise", "counts"], "build_libraries": ["library", "build"],
            "remove_libraries": ["library", "remove"]}


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_a_keyword(name):
    text = subprocess.run([PROGRAM, *COMMANDS[name], "--help"], capture_output=True, text=True).stdout
    options = set(re.findall(r"^  (?:-\w,)?--([a-z0-9-]+)", text, re.MULTILINE)) - NO_KEYWORDS
    assert len(options) > 2
    known = set(inspect.signature(getattr(semsurf, name)).parameters)
    missing = {option for option in options if option.replace("-", "_") not in known}
    assert not missing


@pytest.mark.parametrize("name", FUNCTIONS)
def test_help_teaches(name):
    function = getattr(semsurf, name)
    signature = inspect.signature(function)
    text = pydoc.render_doc(function, renderer=pydoc.plaintext)
    assert "Parameters" in text and "Returns" in text and function.__module__ == "semsurf"
    for parameter in signature.parameters:
        assert re.search(rf"^    {parameter} : ", text, re.MULTILINE), parameter
    assert "`--" not in text and not re.search(r"`[a-z]+\.[a-z_]+`", text)


def test_parameters_are_described():
    energy = semsurf.parameters("simulate").energy
    assert energy.unit == "ev" and energy["default"] == "'1keV'" and energy.range == "100eV to 30keV"
    assert semsurf.parameters(semsurf.level).level_method.choices == ["hough", "plane", "polynomial", "none"]


def test_the_stub_is_up_to_date():
    written = subprocess.run([sys.executable, "-B", ROOT / "python/tools/write_stub.py"], capture_output=True, text=True,
                             check=True).stdout
    assert written == (ROOT / "python/semsurf/__init__.pyi").read_text(), \
        "python/tools/write_stub.py > python/semsurf/__init__.pyi writes it anew"
    compile(written, "__init__.pyi", "exec")


def test_import_is_quick_and_loads_neither_numpy_nor_matplotlib():
    code = ("import time, sys; start = time.process_time(); import semsurf; print(time.process_time() - start); "
            "print([m for m in ('numpy', 'matplotlib', 'inspect', 'logging') if m in sys.modules])")
    best = 9
    for _ in range(3):
        seconds, loaded = subprocess.run([sys.executable, "-B", "-S", "-c", code], capture_output=True, text=True,
                                         check=True).stdout.splitlines()
        best = min(best, float(seconds))
        assert loaded == "[]"
    assert best < 0.3


def test_progress_is_a_function_or_a_bar(samples, capfd):
    said = []
    semsurf.simulate(samples / "cube.toml", size=(24, 24), electrons=20, method="direct",
                     progress=lambda *what: said.append(what))
    assert said and said[-1][0] <= said[-1][1] and said[-1][2] == "primaries"
    semsurf.simulate(samples / "cube.toml", size=(24, 24), electrons=20, method="direct", progress=True)
    assert "primaries" in capfd.readouterr().err
    with pytest.raises(semsurf.UsageError, match="progress"):
        semsurf.level(bumps(), progress=3)


def test_an_error_in_the_users_function_stops_the_work(samples):
    class Mine(Exception):
        pass

    def fail(*what):
        raise Mine

    start = time.monotonic()
    with pytest.raises(Mine):
        semsurf.simulate(samples / "cube.toml", size=(512, 512), electrons=10000, method="direct", progress=fail)
    assert time.monotonic() - start < 20


def test_other_threads_run_meanwhile(samples):
    ticks = []
    done = threading.Event()

    def tick():
        while not done.wait(0.01):
            ticks.append(1)

    thread = threading.Thread(target=tick)
    thread.start()
    semsurf.simulate(samples / "cube.toml", size=(24, 24), electrons=50, method="direct", threads=1)
    done.set()
    thread.join()
    assert len(ticks) > 3


def test_notes_are_logged_and_doubts_are_warnings(caplog, heights):
    with caplog.at_level(logging.INFO, "semsurf"):
        semsurf.simulate(heights, size=(8, 8), electrons=10)
    assert any("material" in message and "`" not in message for message in caplog.messages)
    flat = semsurf.tip(shape="cone:200nm,60deg", tip_size=81, height_pitch=2)
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        semsurf.erode(heights, flat)
    assert [w for w in seen if issubclass(w.category, semsurf.Doubt) and w.filename == __file__]


def test_arguments_are_checked():
    with pytest.raises(semsurf.UsageError, match="Is level_method meant"):
        semsurf.level(bumps(), levelmethod="plane")
    with pytest.raises(semsurf.UsageError, match="by place"):
        semsurf.level(bumps(), 3)
    with pytest.raises(semsurf.UsageError, match="scan"):
        semsurf.level()
    with pytest.raises(semsurf.UsageError, match="twice"):
        semsurf.level(bumps(), scan=bumps())
    with pytest.raises(semsurf.UsageError, match="level_method"):
        semsurf.level(bumps(), level_degree=2)


def test_no_program_is_started(samples):
    """Of children that were waited for nothing is counted."""
    code = ("import resource, semsurf, sys\n"
            "image = semsurf.simulate(sys.argv[1], size=(8, 8), electrons=10, channels='z_nm')\n"
            "semsurf.materials(material='Si'); repr(image); image._repr_html_()\n"
            "used = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
            "assert used.ru_minflt == used.ru_maxrss == 0 and used.ru_utime == 0, used\n")
    subprocess.run([sys.executable, "-B", "-c", code, samples / "flat.toml"], check=True, env=os.environ)


def test_materials():
    all_of_them = semsurf.materials()
    assert {"Si", "Au", "SiO2"} <= set(all_of_them)
    assert semsurf.materials(material="Si") == all_of_them.Si and all_of_them.Si.density_g_cm3 == pytest.approx(2.33, abs=0.01)
    with pytest.raises(semsurf.UsageError, match="Sj"):
        semsurf.materials(material="Sj")


@pytest.mark.parametrize("call, field", [
    (lambda: semsurf.simulate(), "specimen"), (lambda: semsurf.level(None), "scan"),
    (lambda: semsurf.erode(bumps()), "tip"), (lambda: semsurf.level(bumps(), progress=3), "progress"),
    (lambda: semsurf.view([], "a.html"), "items"),
    (lambda: semsurf.sweep("samples/cube.toml", vary={}, output="a"), "vary"),
])
def test_errors_name_arguments_that_are_no_keywords(call, field):
    with pytest.raises(semsurf.UsageError) as caught:
        call()
    assert caught.value.field == field
