# SPDX-License-Identifier: GPL-3.0-or-later
"""Every block of Python in docs/how-to/python.md: those with a mark before them are run, the others are compiled. Blocks of
docs/tutorials/python.md are run one after the other, and what the page prints is compared."""
import re
import sys

import numpy
import pytest

import semsurf
from conftest import ROOT, bumps

sys.path.insert(0, str(ROOT / "tests/docs"))
from run_page import missing  # noqa: E402

TUTORIAL = ROOT / "docs/tutorials/python.md"
PAGE = (ROOT / "docs/how-to/python.md").read_text()
BLOCKS = [(m.group(1), m.group(2), PAGE.count("\n", 0, m.start(2)))
          for m in re.finditer(r"(?:<!-- run: (\w+) -->\n)?```python\n(.*?)```", PAGE, re.DOTALL)]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Where the page's files are."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "samples").symlink_to(ROOT / "samples")
    semsurf.write_heights("scan.txt", bumps(), height_pitch=2)
    semsurf.write_heights("fine.gsf", bumps(), height_pitch=3)
    return tmp_path


def test_the_page_has_blocks():
    assert len(BLOCKS) >= 7 and sum(bool(mark) for mark, *_ in BLOCKS) >= 6


@pytest.mark.parametrize("mark, code, line", BLOCKS, ids=[f"line {line}" for *_, line in BLOCKS])
@pytest.mark.filterwarnings("ignore::semsurf.Doubt")
def test_block(mark, code, line, folder, capsys):
    program = compile("\n" * line + code.replace("scan.gwy", "scan.txt"), "docs/how-to/python.md", "exec")
    if not mark:
        return
    exec(program, {})
    said = capsys.readouterr().out
    if mark == "errors":
        assert said.strip() in code, "the page says what is printed"
    if mark == "mesh":
        assert "closed" in said
    if mark == "scan":
        assert (folder / "surface.gsf").exists() or "Si" in said


def test_the_page_names_what_there_is():
    for name in re.findall(r"`semsurf\.(\w+)", PAGE):
        assert hasattr(semsurf, name), name
    assert numpy.ndim(bumps()) == 2


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::semsurf.Doubt")
def test_tutorial(folder, capsys, monkeypatch):
    pytest.importorskip("matplotlib", reason="python3-matplotlib is not there").use("Agg")
    page = TUTORIAL.read_text()
    names, said = {}, ""
    for block in re.finditer(r"^```(python|text)\n(.*?)^```", page, re.MULTILINE | re.DOTALL):
        kind, body = block.groups()
        if kind == "python":
            exec(compile("\n" * page.count("\n", 0, block.start(2)) + body, str(TUTORIAL), "exec"), names)
            said = capsys.readouterr().out
        else:
            assert missing(body, said) is None, said
    for picture in re.findall(r"images/python_(\w+\.png)", page):
        assert (folder / picture).stat().st_size > 5000
