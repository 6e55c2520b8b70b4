# SPDX-License-Identifier: GPL-3.0-or-later
"""Does what a page says: python3 run_page.py PAGE.md SEMSURF [--pictures] [--readers-files | --readers-images].

Blocks of `sh` are run in one new folder, with `samples` there and SEMSURF as `semsurf`. With --readers-files or --readers-images,
readers_files.sh makes there first what the reader would bring. A block of `text` after them is what
they print, among other things: each of its lines is there, in this order, with numbers that are alike (5 %, or 40 % after ±:
processors round otherwise). With --pictures, pictures of the page, images/PAGE_NAME.png, are made anew from NAME.png
or FOLDER/NAME.png. Exit code 1 says what differs.
"""
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

if __name__ == "__main__":   # tests/python uses missing()
    PAGE, PROGRAM = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```(sh|text)\n(.*?)^```", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
NEAR, NEAR_ERROR = 0.05, 0.4
# A command that fails ends its block; 4 says that the result is written, but not to be trusted.
STOP_AT_ERRORS = "trap 'code=$?; [ $code -eq 4 ] || exit $code' ERR\n"


def parts(line):
    """The words between numbers, and the numbers with how near they have to be."""
    numbers = [(float(m.group()), NEAR_ERROR if "±" in line[max(0, m.start() - 2):m.start()] else NEAR) for m in NUMBER.finditer(line)]
    return [" ".join(word.split()) for word in NUMBER.split(line)], numbers


def alike(wanted, line):
    (words, numbers), (there, found) = parts(wanted), parts(line)
    if len(found) < len(numbers) or there[:len(words) - 1] != words[:-1] or not there[len(words) - 1].startswith(words[-1]):
        return False
    return all(math.isclose(a, b, rel_tol=near, abs_tol=0.011 if near == NEAR_ERROR else 1e-9)
               for (a, near), (b, _) in zip(numbers, found))


def missing(wanted, said):
    """The first line that is not printed."""
    lines = iter(said.splitlines())
    for line in wanted.splitlines():
        if line.strip() and not any(alike(line, one) for one in lines):
            return line
    return None


def run(folder):
    said, commands = "", 0
    environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"}
    if kind := next((a for a in sys.argv if a in ("--readers-files", "--readers-images")), None):
        script = pathlib.Path(__file__).with_name("readers_files.sh")
        subprocess.run(["bash", script, kind.removeprefix("--readers-")], cwd=folder, env=environment, check=True)
    text = PAGE.read_text()
    for block in BLOCK.finditer(text):
        kind, body = block.groups()
        line = text.count("\n", 0, block.start()) + 2
        if kind == "sh":
            done = subprocess.run(["bash", "-c", STOP_AT_ERRORS + body], cwd=folder, env=environment, text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT)
            said, commands = done.stdout, commands + 1
            if done.returncode not in (0, 4):
                sys.exit(f"{PAGE.name}:{line}: exit code {done.returncode}\n{body}{said}")
        elif commands and (lost := missing(body, said)) is not None:
            sys.exit(f"{PAGE.name}:{line}: this line is not printed:\n{lost}\nbut\n{said}")
    print(f"{PAGE.name}: {commands} blocks of commands")


def take_pictures(folder):
    for picture in re.findall(r"\]\((images/[^)]+)\)", PAGE.read_text()):
        name = pathlib.Path(picture).name.removeprefix(PAGE.stem + "_")
        found = next(iter([*folder.glob(name), *folder.glob("*/" + name)]), None)
        if not found:
            sys.exit(f"{PAGE.name}: nothing makes {name}")
        shutil.copy(found, PAGE.parent / picture)
        print(f"written {picture}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="semsurf-page-") as name:
        (pathlib.Path(name) / "samples").symlink_to(ROOT / "samples")
        run(pathlib.Path(name))
        if "--pictures" in sys.argv:
            take_pictures(pathlib.Path(name))
